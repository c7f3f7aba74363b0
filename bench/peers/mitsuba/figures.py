"""Statistics of pictures: differences of regions in standard errors, errors against a reference, samples for
an error."""
import math
import os

import numpy as np

GRID = 4  # regions along each edge
CHANNELS = "RGB"
ERROR = 0.02  # root mean square, linear, clipped to 0..1


class Picture:
    """The mean of parts with independent samples, and each pixel's variance from the parts. `samples`: of all
    parts."""

    def __init__(self, parts, samples):
        self.parts, self.samples, self.mean = parts, samples, parts.mean(0)
        self.variance = parts.var(0, ddof=1) / len(parts)


def stored_picture(folder, name, samples, make):
    """The Picture of the parts that an earlier run kept in the folder, or else of make(). `folder` may be
    None."""
    path = folder and os.path.join(folder, f"{name}-{samples}.npy")
    if path and os.path.exists(path):
        return Picture(np.load(path).astype(float), samples)
    parts = np.array(make())
    if path:
        os.makedirs(folder, exist_ok=True)
        np.save(path, parts.astype(np.float32))
    return Picture(parts, samples)


def region_means(values):
    """Means of the whole picture, then of GRID x GRID regions, row by row, per channel."""
    step = values.shape[0] // GRID
    cells = [values[y:y + step, x:x + step] for y in range(0, GRID * step, step) for x in range(0, GRID * step, step)]
    return np.array([cell.mean((0, 1)) for cell in [values] + cells])


def region_errors(picture):
    """Standard errors of region_means(), as pixels are independent."""
    step = picture.mean.shape[0] // GRID
    pixels = np.array([picture.mean.shape[0] * picture.mean.shape[1]] + [step * step] * (GRID * GRID))[:, None]
    return np.sqrt(region_means(picture.variance) / pixels)


def beyond(z):
    """The chance that a normal number is farther from 0 than z."""
    return math.erfc(z / math.sqrt(2))


def chance_of(count, trials, p):
    """The chance that at least `count` of `trials` independent trials of chance p succeed."""
    return 1 - sum(math.comb(trials, k) * p**k * (1 - p)**(trials - k) for k in range(count))


def name_of_region(index):
    return "whole" if index == 0 else f"row {(index - 1) // GRID + 1} column {(index - 1) % GRID + 1}"


def compare_means(ours, theirs):
    """Compares the means of two Pictures. All lists are by region (the whole first) and channel."""
    mean_a, mean_b = region_means(ours.mean), region_means(theirs.mean)
    error = np.hypot(region_errors(ours), region_errors(theirs))
    off = np.divide(mean_a - mean_b, error, out=np.zeros_like(error), where=error > 0)
    count, greatest = int((np.abs(off) > 3).sum()), float(np.abs(off).max())
    apart = math.sqrt(((clipped(ours.mean) - clipped(theirs.mean))**2).mean())
    region, channel = np.unravel_index(np.abs(off).argmax(), off.shape)
    per_cent, error_per_cent = 100 * (mean_a / mean_b - 1), 100 * error / mean_b
    return {
        "figures": off.size, "beyond_3": count, "chance_of_as_many": chance_of(count, off.size, beyond(3)),
        "greatest": greatest, "chance_of_as_great": chance_of(1, off.size, beyond(greatest)),
        "greatest_in": f"{name_of_region(region)} {CHANNELS[channel]}", "greatest_per_cent": float(per_cent[region, channel]),
        "pictures_apart": apart, "apart_by_noise_alone": math.sqrt(clipped_noise(ours) + clipped_noise(theirs)),
        "root_mean_square_of_regions": float(np.sqrt((off[1:]**2).mean())),
        "whole_per_cent": per_cent[0].tolist(), "whole_error_per_cent": error_per_cent[0].tolist(), "whole_standard_errors": off[0].tolist(),
        "median_error_of_regions_per_cent": float(np.median(error_per_cent[1:])),
        "means": mean_a.tolist(), "means_of_peer": mean_b.tolist(), "standard_errors": error.tolist(), "off": off.tolist(),
    }


def tell_means(m):
    whole = ", ".join(f"{d:+.3f} ({s:+.1f})" for d, s in zip(m["whole_per_cent"], m["whole_standard_errors"]))
    print(f"  means   whole R, G, B off by per cent (standard errors) {whole}; regions' error {m['median_error_of_regions_per_cent']:.2f} %\n"
          f"          {m['beyond_3']} of {m['figures']} beyond 3 (chance of as many {m['chance_of_as_many']:.2g}); greatest {m['greatest']:.2f} in "
          f"{m['greatest_in']}, {m['greatest_per_cent']:+.2f} % (chance of as great {m['chance_of_as_great']:.2g}); "
          f"root mean square {m['root_mean_square_of_regions']:.2f}\n"
          f"          root mean square difference of pixels {m['pictures_apart']:.4f}, by noise alone {m['apart_by_noise_alone']:.4f}")


def clipped(image):
    return np.clip(image, 0, 1)


def clipped_noise(picture):
    """The mean square error of the clipped mean, from the clipped parts, as clipping reduces their noise."""
    parts = clipped(picture.parts)
    return float((parts.var(0, ddof=1) / len(parts)).mean())


class Reference:
    """The mean of Pictures, weighted by samples. Its noise is subtracted from squared errors."""

    def __init__(self, *pictures):
        self.samples = sum(p.samples for p in pictures)
        self.image = sum(p.samples / self.samples * p.mean for p in pictures)
        self.noise = sum((p.samples / self.samples)**2 * clipped_noise(p) for p in pictures)

    def facts(self):
        return {"samples": self.samples, "noise": math.sqrt(self.noise)}

    def error_of(self, image, contained=0):
        """The picture's root mean square error. `contained`: number of its samples that the reference
        contains; they are removed from it."""
        left = self.samples - contained
        against = (self.samples * self.image - contained * image) / left
        square = float(((clipped(image) - clipped(against))**2).mean())
        return math.sqrt(max(square - self.noise * self.samples / left, 0))


def samples_for_error(points):
    """The samples that give ERROR, and whether they lie outside of the measured range: from a line through
    the logarithms of the two points (samples, error) around it, or else of the two nearest."""
    points = sorted(points)
    at = next((i for i in range(1, len(points)) if points[i][1] <= ERROR), len(points) - 1)
    (n0, e0), (n1, e1) = points[at - 1], points[at]
    if not e1 < e0:
        return math.inf, True
    samples = n0 * (e0 / ERROR)**(math.log(n1 / n0) / math.log(e0 / e1))
    return samples, not points[0][0] <= samples <= points[-1][0]
