#!/usr/bin/env python3
"""How much light normals that are not the geometry's should return near the terminator: nothing taken, Chiang and others 2019 ("Taming the
Shadow Terminator"), and Conty Estevez and others 2019 (Ray Tracing Gems, chapter 12), against the surface that the normals stand for. Needs
numpy. Lambert's cosine, errors over many lights: root of the mean square, and the mean.

    bench/terminators.py
"""
import numpy as np


def chiang(geometric, shading, between):
    g = np.clip(geometric / np.maximum(shading * between, 1e-6), 0, 1)
    return -g**3 + g**2 + g


def conty(geometric, shading, between):
    alpha2 = np.clip(0.125 * (1 - between**2) / np.maximum(between**2, 1e-9), 0, 1)
    tan2 = (1 - geometric**2) / np.maximum(geometric**2, 1e-12)
    return 2 / (1 + np.sqrt(1 + alpha2 * tan2))


FACTORS = {"nothing": lambda geometric, shading, between: np.ones_like(shading), "Chiang": chiang, "Conty Estevez": conty}


def unit(a):
    return a / np.linalg.norm(a, axis=-1, keepdims=True)


def ball(levels):
    """An icosahedron, each face cut into four `levels` times: points on the unit sphere, faces."""
    t = (1 + 5**0.5) / 2
    points = [unit(np.array(p, float)) for p in ((-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t),
                                                 (t, 0, -1), (t, 0, 1), (-t, 0, -1), (-t, 0, 1))]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
             (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(levels):
        middles, cut = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                points.append(unit(points[a] + points[b]))
                middles[key] = len(points) - 1
            return middles[key]
        for a, b, c in faces:
            x, y, z = middle(a, b), middle(b, c), middle(c, a)
            cut += [(a, x, z), (b, y, x), (c, z, y), (x, y, z)]
        faces = cut
    return np.array(points), np.array(faces)


def report(what, errors):
    for name, found in errors.items():
        squares, means = zip(*found)
        print(f"| {what} | {name} | {np.sqrt(np.mean(squares)):.4f} | {np.mean(means):+.4f} |")


def faceted_ball(levels):
    """Interpolated normals on flat faces against the sphere."""
    points, faces = ball(levels)
    edge = 12
    corners = np.array([((i + 1 / 3) / edge, (j + 1 / 3) / edge) for i in range(edge) for j in range(edge - i)])
    weights = np.c_[corners, 1 - corners.sum(1)]
    shading_normals = unit(np.einsum("kc,fcx->fkx", weights, points[faces]))
    a, b, c = (points[faces[:, i]] for i in range(3))
    normals = unit(np.cross(b - a, c - a))
    between = np.einsum("fkx,fx->fk", shading_normals, normals)
    random, errors = np.random.default_rng(1), {name: [] for name in FACTORS}
    for _ in range(40):
        light = unit(random.normal(size=3))
        shading, geometric = shading_normals @ light, (normals @ light)[:, None] + 0 * between
        sphere = np.maximum(shading, 0)
        for name, factor in FACTORS.items():
            seen = sphere * np.where(geometric > 0, factor(np.maximum(geometric, 1e-6), shading, between), 0)
            errors[name].append((((seen - sphere)**2).mean(), (seen - sphere).mean()))
    report(f"ball of {len(faces)} faces", errors)


def bumps(slope):
    """Normals of waves of that greatest slope on a flat surface against the waves themselves, with their shadows."""
    count, periods = 4000, 9
    x = np.arange(count) / count
    heights, slopes = slope * np.cos(2 * np.pi * x) / (2 * np.pi), -slope * np.sin(2 * np.pi * x)
    normals = unit(np.c_[-slopes, np.ones(count)])
    errors = {name: [] for name in FACTORS}
    for elevation in np.radians(np.linspace(1, 89, 45)):
        for side in (1, -1):
            light = np.array([side * np.cos(elevation), np.sin(elevation)])
            # A point is lit where none on its way to the light is higher than the way.
            over = np.tile(heights, periods) - side * np.arange(periods * count) / count * np.tan(elevation)
            most = np.maximum.accumulate(over[::-side])[::-side]
            lit = (over >= most - 1e-9)[periods // 2 * count:(periods // 2 + 1) * count]
            shading = normals @ light
            true = np.maximum(shading, 0) * lit
            for name, factor in FACTORS.items():
                seen = np.maximum(shading, 0) * factor(np.full(count, light[1]), shading, normals[:, 1])
                errors[name].append((((seen - true)**2).mean(), (seen - true).mean()))
    report(f"waves of slope {slope}", errors)


print("| surface | taken by | error | mean |\n|---|---|---|---|")
for level in (0, 1, 2):
    faceted_ball(level)
for steepness in (0.1, 0.2, 0.4):
    bumps(steepness)
