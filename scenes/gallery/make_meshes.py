#!/usr/bin/env python3
"""Writes the meshes of the gallery's scenes: lathes with exact normals, a wind-swept field of snow, a spruce.

    pip install numpy; scenes/gallery/make_meshes.py [FOLDER]
"""
import os
import shutil
import struct
import sys

import numpy as np

OUT = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))


def write_ply(name, v, n, f, uv=None):
    v = np.asarray(v, "<f4"); n = np.asarray(n, "<f4"); f = np.asarray(f, "<i4")
    props = ["x", "y", "z", "nx", "ny", "nz"]
    data = [v, n]
    if uv is not None:
        props += ["s", "t"]; data.append(np.asarray(uv, "<f4"))
    head = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(v)
    head += "".join("property float %s\n" % p for p in props)
    head += "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % len(f)
    body = np.concatenate(data, 1).astype("<f4").tobytes()
    faces = np.zeros(len(f), dtype=[("n", "u1"), ("i", "<i4", 3)]); faces["n"] = 3; faces["i"] = f
    path = os.path.join(OUT, name)
    with open(path, "wb") as o:
        o.write(head.encode()); o.write(body); o.write(faces.tobytes())
    print(name, len(v), "vertices", len(f), "triangles", os.path.getsize(path) // 1024, "KiB")


def round_corners(points, steps=6):
    """points: (r, y[, fillet]) — corners rounded by quadratic Bezier over the distance `fillet`."""
    P = [(np.array(p[:2], float), p[2] if len(p) > 2 else 0.0) for p in points]
    out = []
    for i, (p, fillet) in enumerate(P):
        if fillet <= 0 or i == 0 or i == len(P) - 1:
            out.append(p); continue
        a, b = P[i - 1][0] - p, P[i + 1][0] - p
        la, lb = np.linalg.norm(a), np.linalg.norm(b)
        da, db = min(fillet, 0.49 * la), min(fillet, 0.49 * lb)
        s, e = p + a / la * da, p + b / lb * db
        for t in np.linspace(0, 1, steps + 1):
            out.append((1 - t) ** 2 * s + 2 * t * (1 - t) * p + t * t * e)
    return np.array(out)


def lathe(name, profile, segments=96, crease=40.0, radius=None):
    """Profile (r, y) from the axis at the bottom, outside up, back to the axis: a closed solid.
    Normals are those of the profile, split where it turns by more than `crease` degrees.
    radius(angle, r, y) may change r, for facets; then normals are differences."""
    p = np.asarray(profile, float)
    keep = np.r_[True, np.linalg.norm(np.diff(p, axis=0), axis=1) > 1e-6]; p = p[keep]
    seg = np.diff(p, axis=0); ln = np.linalg.norm(seg, axis=1)
    nrm = np.stack([seg[:, 1], -seg[:, 0]], 1) / ln[:, None]      # outwards for a profile that goes up on the outside
    ang = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    V, N, F = [], [], []

    def ring(pt, n):
        base = len(V)
        if pt[0] < 1e-9:
            for a in ang:
                V.append((0, pt[1], 0)); N.append((0, np.sign(n[1]) or 1, 0))
        else:
            for a in ang:
                r = radius(a, pt[0], pt[1]) if radius else pt[0]
                V.append((r * np.cos(a), pt[1], r * np.sin(a)))
                N.append((n[0] * np.cos(a), n[1], n[0] * np.sin(a)))
        return base
    cos = np.cos(np.radians(crease))
    for i in range(len(seg)):
        n0 = nrm[i]; n1 = nrm[i]
        if i > 0 and nrm[i - 1] @ nrm[i] > cos:
            w = nrm[i - 1] * ln[i - 1] ** -1 + nrm[i] * ln[i] ** -1; n0 = w / np.linalg.norm(w)
        if i + 1 < len(seg) and nrm[i + 1] @ nrm[i] > cos:
            w = nrm[i + 1] * ln[i + 1] ** -1 + nrm[i] * ln[i] ** -1; n1 = w / np.linalg.norm(w)
        a, b = ring(p[i], n0), ring(p[i + 1], n1)
        for k in range(segments):
            l = (k + 1) % segments
            if p[i][0] > 1e-9: F.append((a + k, b + k, a + l))
            if p[i + 1][0] > 1e-9: F.append((a + l, b + k, b + l))
    V, N, F = np.array(V), np.array(N), np.array(F)
    t = V[F]; g = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
    area = np.linalg.norm(g, axis=1); F = F[area > 1e-12]; g = g[area > 1e-12]
    # faces must agree with the normals
    s = np.einsum("ij,ij->i", g, N[F].mean(1)); F[s < 0] = F[s < 0][:, ::-1]
    if radius: return write_plain(name, V, F)
    write_ply(name, V, N, F)


def value_noise(x, z, seed):
    def h(i, j):
        n = (i.astype(np.int64) * 374761393 + j.astype(np.int64) * 668265263 + seed * 362437) & 0xffffffff
        n = ((n ^ (n >> 13)) * 1274126177) & 0xffffffff
        return ((n ^ (n >> 16)) & 0xffff) / 65535.0
    i, j = np.floor(x), np.floor(z); u, v = x - i, z - j
    u, v = u ** 3 * (u * (6 * u - 15) + 10), v ** 3 * (v * (6 * v - 15) + 10)
    return (h(i, j) * (1 - u) + h(i + 1, j) * u) * (1 - v) + (h(i, j + 1) * (1 - u) + h(i + 1, j + 1) * u) * v


def snow_height(X, Z):
    c, s = np.cos(0.5), np.sin(0.5)
    U, W = X * c + Z * s, -X * s + Z * c
    fine = 0.03 * value_noise(U / 0.42, W / 0.3, 4) + 0.010 * value_noise(U / 0.13, W / 0.13, 5)
    H = 0.9 * value_noise(U / 9, W / 5, 1) + 0.42 * value_noise(U / 3.4, W / 1.8, 2) + 0.12 * value_noise(U / 1.3, W / 0.8, 3) + fine
    r = np.hypot(X, Z)
    flat = np.clip((r - 0.9) / 2.6, 0, 1); flat = flat * flat * (3 - 2 * flat)
    H = (H - 0.72) * 0.62 * flat + fine * (1 - flat) + 0.045 * np.exp(-((r - 1.25) / 0.28) ** 2) - 0.012
    far = np.clip((r - 12) / 24, 0, 1)      # hills
    return H + far ** 1.6 * (3.2 * value_noise(X / 11 + 7, Z / 11 + 3, 8) + 0.6 * value_noise(X / 4, Z / 4, 9))


def snow(name, n=180, size=40.0):
    """A height field, finer towards the middle; flat under the block."""
    t = np.linspace(-1, 1, n); g = np.sign(t) * np.abs(t) ** 2.2 * size
    X, Z = np.meshgrid(g, g, indexing="ij")
    H = snow_height(X, Z)
    dx = np.gradient(H, g, axis=0); dz = np.gradient(H, g, axis=1)
    N = np.stack([-dx, np.ones_like(H), -dz], -1); N /= np.linalg.norm(N, axis=-1, keepdims=True)
    V = np.stack([X, H, Z], -1)
    I = np.arange(n * n).reshape(n, n)
    a, b, cc, d = I[:-1, :-1].ravel(), I[1:, :-1].ravel(), I[1:, 1:].ravel(), I[:-1, 1:].ravel()
    F = np.vstack([np.stack([a, cc, b], 1), np.stack([a, d, cc], 1)])
    write_ply(name, V.reshape(-1, 3), N.reshape(-1, 3), F)


def spruce_parts(rnd, layers, spikes):
    """Points, normals and triangles of a snowy spruce of unit height: rings of drooping spikes."""
    V, F = [], []
    for i in range(layers):
        t = i / layers; y = 0.10 + 0.86 * t; R = 0.235 * (1 - t) ** 0.9 + 0.012
        for k in range(spikes):
            a = 2 * np.pi * (k + rnd.random() * 0.7) / spikes; w = 2.2 * np.pi / spikes * 0.62; q = R * (0.75 + 0.45 * rnd.random())
            b = len(V)
            V += [(0, y + 0.11, 0), (0.72 * q * np.cos(a - w), y - 0.01, 0.72 * q * np.sin(a - w)),
                  (q * np.cos(a), y - 0.045 - 0.03 * rnd.random(), q * np.sin(a)), (0.72 * q * np.cos(a + w), y - 0.01, 0.72 * q * np.sin(a + w))]
            F += [(b, b + 2, b + 1), (b, b + 3, b + 2)]
    V, F = np.array(V), np.array(F)
    g = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]); N = np.zeros_like(V)
    for j in range(3): np.add.at(N, F[:, j], g)
    return V, N / np.linalg.norm(N, axis=1)[:, None], F


def spruce(name):
    write_ply(name, *spruce_parts(np.random.default_rng(1), 11, 13))


def shore(name, seed=3, count=150):
    """A wood of spruces behind a frozen lake: an arc around the origin, thinner and nearer at its ends."""
    rnd = np.random.default_rng(seed); V, N, F, first = [], [], [], 0
    for i in range(count):
        turn = np.radians(rnd.uniform(-62, 62)); far = rnd.uniform(74, 120) - 34 * (abs(turn) / np.radians(62)) ** 2
        tall = rnd.uniform(4.5, 11) * (1 - 0.25 * np.exp(-(turn / 0.16) ** 2))
        v, n, f = spruce_at(rnd, tall, (far * np.sin(turn), -0.3, -far * np.cos(turn)))
        V.append(v); N.append(n); F.append(f + first); first += len(v)
    write_ply(name, np.vstack(V), np.vstack(N), np.vstack(F))


def spruce_at(rnd, tall, at):
    v, n, f = spruce_parts(rnd, 13, 11); turn = rnd.uniform(0, 2 * np.pi); c, s = np.cos(turn), np.sin(turn)
    m = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return (v * (tall * np.array([0.9, 1, 0.9]))) @ m.T + at, n @ m.T, f


def write_plain(name, V, F):
    """Without normals: sundog makes them by "crease_angle"."""
    key = np.round(V * 1e6).astype(np.int64); _, first, inv = np.unique(key, axis=0, return_index=True, return_inverse=True)
    V = V[first]; F = inv.reshape(-1)[F]; F = F[(F[:, 0] != F[:, 1]) & (F[:, 1] != F[:, 2]) & (F[:, 0] != F[:, 2])]
    head = "ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n" % len(V)
    head += "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % len(F)
    faces = np.zeros(len(F), dtype=[("n", "u1"), ("i", "<i4", 3)]); faces["n"] = 3; faces["i"] = F
    with open(os.path.join(OUT, name), "wb") as o:
        o.write(head.encode()); o.write(V.astype("<f4").tobytes()); o.write(faces.tobytes())
    print(name, len(V), "vertices", len(F), "triangles", os.path.getsize(os.path.join(OUT, name)) // 1024, "KiB")


def tumbler():
    # whisky glass, 1 unit = 10 cm: outside up, rim, inside down to the axis
    outer = [(0, 0), (0.36, 0, 0.04), (0.405, 0.03, 0.05), (0.43, 0.12), (0.455, 0.50), (0.475, 0.95, 0.012), (0.452, 0.955, 0.012), (0.43, 0.50), (0.40, 0.20, 0.10), (0.25, 0.155), (0, 0.15)]
    p = round_corners(outer, 8)
    k = 14
    def facets(a, r, y):
        if r < 0.395 and y < 0.3 or y > 0.49: return r
        outside = r > 0.405 + 0.05 * y
        if not outside: return r
        w = np.clip((y - 0.045) / 0.05, 0, 1) * np.clip((0.46 - y) / 0.05, 0, 1)
        step = 2 * np.pi / k; b = (a % step) - step / 2
        return r * (1 - w) + w * min(r, (r * 1.004) * np.cos(step / 2) / np.cos(b))
    # more rings where the facets run out
    q = []
    for a, b in zip(p[:-1], p[1:]):
        n = max(1, int(np.linalg.norm(b - a) / 0.03))
        for t in range(n): q.append(a + (b - a) * t / n)
    q.append(p[-1])
    lathe("whisky_glass.ply", q, 14 * 12, radius=facets)
    # the whisky reaches half way into the wall; the glass has the higher priority
    level = 0.37
    lathe("whisky.ply", round_corners([(0, 0.10), (0.30, 0.10, 0.08), (0.415, 0.20), (0.434, level)], 6).tolist() + [(0.0, level)], 96)

def build():
    shutil.copy(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../spectra/diamond.obj"), OUT)
    snow("snow_field.ply")
    spruce("spruce.ply")
    shore("shore.ply")
    tumbler()


if __name__ == "__main__":
    build()
