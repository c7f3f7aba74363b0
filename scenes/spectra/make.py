#!/usr/bin/env python3
"""Writes prism.obj and diamond.obj beside this file: python3 scenes/spectra/make.py"""
import itertools
import math
import pathlib

FOLDER = pathlib.Path(__file__).parent


def plane_points(planes):
    """The corners of the convex body dot(n, p) <= d, and for each plane those on it."""
    points = []
    for a, b, c in itertools.combinations(planes, 3):
        (n, d), (m, e), (o, f) = a, b, c
        cross = lambda u, v: (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        mo, on, nm = cross(m, o), cross(o, n), cross(n, m)
        volume = sum(x * y for x, y in zip(n, mo))
        if abs(volume) < 1e-9:
            continue
        p = tuple((d * mo[i] + e * on[i] + f * nm[i]) / volume for i in range(3))
        if any(sum(x * y for x, y in zip(q, p)) > r + 1e-7 for q, r in planes):
            continue
        if all(math.dist(p, q) > 1e-5 for q in points):
            points.append(p)
    return points


def write(name, planes, comment):
    """The body as polygons whose corners turn left as seen from outside."""
    points = plane_points(planes)
    lines = [f"# {comment}"] + ["v {:.7f} {:.7f} {:.7f}".format(*p) for p in points]
    for n, d in planes:
        on = [i for i, p in enumerate(points) if abs(sum(x * y for x, y in zip(n, p)) - d) < 1e-6]
        if len(on) < 3:
            continue
        middle = [sum(points[i][k] for i in on) / len(on) for k in range(3)]
        first = [points[on[0]][k] - middle[k] for k in range(3)]
        side = (n[1] * first[2] - n[2] * first[1], n[2] * first[0] - n[0] * first[2], n[0] * first[1] - n[1] * first[0])

        def angle(i):
            way = [points[i][k] - middle[k] for k in range(3)]
            return math.atan2(sum(x * y for x, y in zip(way, side)), sum(x * y for x, y in zip(way, first)))

        lines.append("f " + " ".join(str(i + 1) for i in sorted(on, key=angle)))
    (FOLDER / name).write_text("\n".join(lines) + "\n")


def facet(elevation, azimuth, through):
    """A plane whose normal has that elevation and azimuth, in degrees, through a point (radius, height) there."""
    e, a = math.radians(elevation), math.radians(azimuth)
    n = (math.cos(e) * math.sin(a), math.sin(e), math.cos(e) * math.cos(a))
    return n, math.cos(e) * through[0] + math.sin(e) * through[1]


def prism(edge=1.1, height=0.5):
    """60 degrees; the edge where light bends least is towards +x, and light goes along -z within."""
    inner = edge * math.sqrt(3) / 4  # from mid-height to the edge
    sides = [((-1, 0, 0), inner)]
    for sign in (1, -1):
        sides.append(((0.5, 0, sign * math.sqrt(3) / 2), inner / 2))
    return sides + [((0, 1, 0), height / 2), ((0, -1, 0), height / 2)]


def brilliant(table=0.56, crown=34.5, pavilion=40.75, girdle=0.015):
    """A round brilliant of radius 1 by Tolkowsky's angles; its widest part is at height 0."""
    bezel = math.tan(math.radians(crown)) * (1 - table) + girdle
    planes = [((0, 1, 0), bezel)]
    for i in range(8):
        planes.append(facet(90 - crown, 45 * i, (1, girdle)))
        planes.append(facet(-(90 - pavilion), 45 * i, (1, -girdle)))
        # A star touches the table's corner; the halves along the girdle are steeper than the mains.
        corner = table / math.cos(math.radians(22.5))
        planes.append(facet(90 - 20.5, 45 * i + 22.5, (corner, bezel)))
        for side in (-11.25, 11.25):
            planes.append(facet(90 - 41.5, 45 * i + 22.5 + side, (1, girdle)))
            planes.append(facet(-(90 - 42.0), 45 * i + 22.5 + side, (1, -girdle)))
    for i in range(64):
        planes.append(facet(0, 360 / 64 * (i + 0.5), (1, 0)))
    return planes


if __name__ == "__main__":
    write("prism.obj", prism(), "A prism of 60 degrees, by make.py")
    write("diamond.obj", brilliant(), "A round brilliant, by make.py")
