"""Triangles of the scenes' objects, for peers without spheres and boxes. Seen from outside they turn counter-clockwise."""
import math
from collections import namedtuple

import numpy as np

from peer_scenes import LAMP

CELLS = 128  # along an edge of the cube that becomes a sphere: 196,608 triangles, of 0.99993 of its volume

# points (n, 3), triangles (m, 3) of indices, normals (n, 3) of points or None where faces are flat
Mesh = namedtuple("Mesh", "points triangles normals")


def halve(quads):
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def box(low, high, degrees=0, center=(0, 0, 0)):
    """Turned about +y, counter-clockwise seen from above, then moved. Faces do not share points: a corner has three."""
    quads = []
    for axis in range(3):
        for side in (0, 1):
            corners = np.zeros((4, 3))
            corners[:, axis] = side
            corners[:, (axis + 1) % 3], corners[:, (axis + 2) % 3] = [0, 1, 1, 0], [0, 0, 1, 1]
            quads.append(corners if side else corners[::-1])
    points = np.array(low, float) + np.concatenate(quads) * (np.array(high, float) - low)
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    points = points @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T + center
    return Mesh(points, halve(np.arange(24).reshape(6, 4)), None)


def cube_grid(axis, side):
    """Of one face of the cube -1..1: its points, nearly even as seen from the middle, and its quads."""
    steps = np.tan(np.linspace(-math.pi / 4, math.pi / 4, CELLS + 1))
    u, v = np.meshgrid(steps, steps, indexing="ij")
    points = np.empty((u.size, 3))
    points[:, axis], points[:, (axis + 1) % 3], points[:, (axis + 2) % 3] = side, u.ravel(), v.ravel()
    number = np.arange(u.size).reshape(u.shape)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    return points, quads if side > 0 else quads[:, ::-1]


def sphere(center, radius):
    """Its points lie on the sphere and have its normals."""
    faces = [cube_grid(axis, side) for axis in range(3) for side in (-1, 1)]
    count = (CELLS + 1)**2
    points = np.concatenate([points for points, _ in faces])
    quads = np.concatenate([quads + i * count for i, (_, quads) in enumerate(faces)])
    normals = points / np.linalg.norm(points, axis=1, keepdims=True)
    normals, shared = np.unique(np.round(normals, 12) + 0.0, axis=0, return_inverse=True)  # + 0.0: no negative zeros
    return Mesh(np.array(center) + radius * normals, halve(shared.reshape(-1)[quads]), normals)


def lamp():
    """Faces down."""
    x, z = np.array(LAMP["size"]) / 2
    points = np.array([[-x, 0, -z], [x, 0, -z], [x, 0, z], [-x, 0, z]]) + LAMP["center"]
    return Mesh(points, halve(np.array([[0, 1, 2, 3]])), None)


def of_object(kind, numbers):
    if kind == "sphere":
        return sphere(numbers["center"], numbers["radius"])
    if kind == "box":
        return box(numbers["min"], numbers["max"], numbers.get("turn", 0), numbers.get("center", (0, 0, 0)))
    raise ValueError(f"no triangles for {kind}")
