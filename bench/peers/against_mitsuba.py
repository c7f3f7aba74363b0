#!/usr/bin/env python3
"""Compares path tracing with Mitsuba 3 (PyPI mitsuba) on the scenes of bench/peers/mitsuba/peer_scenes.py.
Usage:

    bench/peers/against_mitsuba.py SUNDOG [--scenes cornell,glass] [--parts means,errors,times] [--json FILE] [options]

Dr.Jit finds LLVM by itself, or by DRJIT_LIBLLVM_PATH. `textured` needs the barrel's model in $SUNDOG_ASSETS
or ../shared/assets; `textured_flat` lacks its vertex normals, which the programs treat differently at
silhouettes.

means   compares the whole and 4x4 regions of both converged pictures, three channels each, in standard errors
        of the difference: how many of these 51 exceed three, the greatest, and the chance of each if they
        were 51 independent normal numbers (they are fewer: channels are correlated)
errors  the root mean square error, of linear colour in 0..1, at each of --counts samples, against the mean of
        both programs' converged pictures, whose noise is subtracted (Mitsuba under a sky: against its own
        picture, as its rows of texels lie elsewhere); and the samples that reach 0.02, from a line through
        two points in logarithms
times   samples a second at --samples, and the seconds of pictures with the samples that reach 0.02, comparing
        the fastest way of each program. All ways take turns, one thread each: medians, and the range of the
        ratios of single rounds. Valid only on an idle machine

If a lamp shines through glass, `sundog caustics` renders with photons too; its error includes the blur of
their radius.

An existing --json FILE keeps the parts that are not measured again; `times` needs `errors` from the FILE or
this run. --pictures DIR keeps the converged pictures for the next run. A run of a minute: --scenes cornell
--samples 16 --converged 64 --counts 4,16 --rounds 1.
"""
import argparse
import datetime
import json
import os
import platform
import statistics
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "mitsuba"))
import figures
import peer_scenes
import programs

# Way: program, sampler, whether with photons.
WAYS = {"sundog sobol": ("sundog", "sobol", False), "sundog independent": ("sundog", "independent", False),
        "sundog caustics": ("sundog", "sobol", True), "Mitsuba independent": ("mitsuba", "independent", False),
        "Mitsuba multijitter": ("mitsuba", "multijitter", False)}
WITH_CAUSTICS = ("glass",)  # scenes whose lamp shines through glass
PASS = 256  # samples of each Mitsuba pass, to bound its memory
PARTS = ("means", "errors", "times")


class Bench:
    """A scene in both programs."""

    def __init__(self, name, folder, args, mi):
        self.name, self.args = name, args
        self.ways = [way for way, (_, _, caustics) in WAYS.items() if not caustics or name in WITH_CAUSTICS]
        self.sundog = programs.Sundog(name, folder, args.sundog, args.device)
        self.mitsuba = programs.Mitsuba(name, folder, mi, same_model=False)
        self.same = programs.Mitsuba(name, folder, mi, same_model=True)

    def render(self, way, samples, seed=0):
        """Returns the picture, its seconds and its number of samples."""
        program, sampler, caustics = WAYS[way]
        if program == "sundog":
            return *self.sundog.render(sampler, samples, caustics), samples
        return *self.mitsuba.render(sampler, samples, seed), self.mitsuba.samples_made(sampler)

    def stored(self, key, samples, make):
        """A converged picture, from --pictures if it is there."""
        return figures.stored_picture(self.args.pictures, f"{self.name}-{key}", samples, make)

    @staticmethod
    def passes(program, total):
        each = min(PASS, total // 2)
        return [program.render("independent", each, seed=1000 + i)[0] for i in range(total // each)]

    def converge(self):
        """Converged pictures: sundog's, Mitsuba's with sundog's model, and Mitsuba's with its own sky where
        there is one."""
        total = self.args.converged
        ours = self.stored("sundog", total, lambda: self.sundog.halves(total))
        theirs = self.stored("mitsuba", total, lambda: self.passes(self.same, total))
        if self.name not in peer_scenes.UNDER_SKY:
            return ours, theirs, theirs
        return ours, theirs, self.stored("mitsuba_file", 2 * total, lambda: self.passes(self.mitsuba, 2 * total))


def measure_errors(bench, ours, theirs, of_file):
    """Measures errors, under a sky against each program's own picture. `independent` of sundog repeats its
    converged picture's first samples, so they are removed from the reference."""
    both = figures.Reference(ours, theirs)
    own = both if of_file is theirs else figures.Reference(of_file)
    found = {}
    for way in bench.ways:
        reference = both if WAYS[way][0] == "sundog" else own
        points = []
        for count in bench.args.counts:
            image, _, samples = bench.render(way, count, seed=count)
            points.append((samples, reference.error_of(image, samples if way == "sundog independent" else 0)))
        needed, outside = figures.samples_for_error(points)
        found[way] = {"errors": points, "samples_to_error": needed, "extrapolated": outside}
    return {"reference": both.facts(), "reference_of_mitsuba": own.facts(), "ways": found}


def take_turns(bench, counts):
    """Times pictures in turn: seconds and samples by way. The first round compiles and does not count."""
    seconds, made = {way: [] for way in counts}, {}
    for turn in range(bench.args.rounds + 1):
        for way, count in counts.items():
            _, time, made[way] = bench.render(way, count, seed=turn)
            if turn:
                seconds[way].append(time)
    return seconds, made


def ratios(base, other):
    """The time of `other` divided by that of `base`: ratio of the medians, and range over single rounds."""
    each = [b / a for a, b in zip(base, other)]
    return {"median": statistics.median(other) / statistics.median(base), "least": min(each), "greatest": max(each)}


def measure_times(bench, errors):
    pixels = peer_scenes.SIZE**2
    seconds, made = take_turns(bench, dict.fromkeys(bench.ways, bench.args.samples))
    rates = {way: pixels * made[way] / statistics.median(seconds[way]) for way in bench.ways}
    counts = {way: max(1, round(found["samples_to_error"])) for way, found in errors["ways"].items()
              if found["samples_to_error"] <= bench.args.most_samples}
    until, reached = take_turns(bench, counts)
    result = {"load_average": os.getloadavg()[0], "samples": made, "seconds": seconds, "samples_a_second": rates,
              "rate_against_mitsuba": ratios(seconds["sundog sobol"], seconds["Mitsuba independent"]),
              "until_error": {way: {"samples": reached[way], "seconds": until[way], "median": statistics.median(until[way])} for way in counts}}
    ours, theirs = ([way for way in counts if WAYS[way][0] == program] for program in ("sundog", "mitsuba"))
    if ours and theirs:
        own, peer = (min(ways, key=lambda way: result["until_error"][way]["median"]) for ways in (ours, theirs))
        result |= {"best_own": own, "best_peer": peer, "times_faster_to_error": ratios(until[own], until[peer])}
    return result


def tell_errors(e):
    r, own = e["reference"], e["reference_of_mitsuba"]
    print(f"  errors  reference of {r['samples']} samples, noise {r['noise']:.4f}; for Mitsuba {own['samples']}, {own['noise']:.4f}")
    for way, found in e["ways"].items():
        points = ", ".join(f"{error:.4f} at {n}" for n, error in found["errors"])
        print(f"          {way:20} {points}; {figures.ERROR} at {found['samples_to_error']:.1f}{' (extrapolated)' if found['extrapolated'] else ''}")


def tell_times(t):
    for way, rate in t["samples_a_second"].items():
        until = t["until_error"].get(way)
        to_error = f"{until['median']:.3f} s to {figures.ERROR} with {until['samples']} samples" if until else f"{figures.ERROR} not reached"
        print(f"  times   {way:20} {rate / 1e6:.2f} Msamples/s, {to_error}")

    def told(r):
        return f"{r['median']:.2f} ({r['least']:.2f}..{r['greatest']:.2f})"
    print(f"          samples a second, sundog sobol over Mitsuba independent: {told(t['rate_against_mitsuba'])} times")
    if "best_peer" in t:
        print(f"          time to {figures.ERROR}, {t['best_peer']} over {t['best_own']}: {told(t['times_faster_to_error'])} times")


def describe_run(args, mi):
    version = os.popen(f"'{args.sundog}' --version").read().strip()
    model = [line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")] if os.path.exists("/proc/cpuinfo") else []
    return {"date": datetime.date.today().isoformat(), "processor": model[0] if model else platform.processor(), "cores": os.cpu_count(), "sundog": version,
            "mitsuba": mi.__version__, "variant": args.variant, "device": args.device, "load_average": os.getloadavg()[0]}


def run_scene(bench, parts, result):
    if {"means", "errors"} & set(parts):
        ours, theirs, of_file = bench.converge()
    if "means" in parts:
        result["means"] = figures.compare_means(ours, theirs) | {"samples": bench.args.converged}
        figures.tell_means(result["means"])
    if "errors" in parts:
        result["errors"] = measure_errors(bench, ours, theirs, of_file)
        tell_errors(result["errors"])
    if "times" in parts:
        if "errors" not in result:
            sys.exit("times need errors: add errors to --parts, or give the --json of a run that has them")
        result["times"] = measure_times(bench, result["errors"])
        tell_times(result["times"])


def listed(text):
    return text.split(",")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sundog")
    parser.add_argument("--scenes", type=listed, default=list(peer_scenes.NAMES))
    parser.add_argument("--parts", type=listed, default=list(PARTS))
    parser.add_argument("--converged", type=int, default=1024, help="samples of the converged pictures, of each program")
    parser.add_argument("--counts", type=lambda text: [int(n) for n in listed(text)], default=[4, 16, 64, 256])
    parser.add_argument("--samples", type=int, default=64, help="of the pictures whose rates are taken")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--most-samples", type=int, default=2048, help="above it no picture is made that reaches 0.02")
    parser.add_argument("--device", default="0:0/1")
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--json")
    parser.add_argument("--pictures", help="folder that keeps the converged pictures")
    return parser.parse_args()


def main():
    args = arguments()
    for known, given in ((peer_scenes.NAMES, args.scenes), (PARTS, args.parts)):
        if unknown := set(given) - set(known):
            sys.exit(f"{', '.join(sorted(unknown))}: wanted some of {', '.join(known)}")
    mi = programs.load_mitsuba(args.variant)
    results = {"runs": [], "scenes": {}}
    if args.json and os.path.exists(args.json):
        with open(args.json) as file:
            results = json.load(file)
    results["runs"].append(describe_run(args, mi) | {"parts": args.parts, "scenes": args.scenes})
    with tempfile.TemporaryDirectory() as folder:
        there = peer_scenes.write_files(folder)
        for name in args.scenes:
            if name not in there:
                print(f"{name} is left out: no {peer_scenes.BARREL} in $SUNDOG_ASSETS or ../shared/assets", flush=True)
                continue
            print(name, flush=True)
            run_scene(Bench(name, folder, args, mi), args.parts, results["scenes"].setdefault(name, {}))
            if args.json:
                with open(args.json, "w") as file:
                    json.dump(results, file, indent=1)


if __name__ == "__main__":
    main()
