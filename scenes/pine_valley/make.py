#!/usr/bin/env python3
"""Writes heights.png beside it: a valley with a clearing, as heights of 16 bits."""
import math
import pathlib
import random
import struct
import zlib

SIZE = 128


def noise_field(cells, seed):
    rng = random.Random(seed)
    grid = [[rng.random() for _ in range(cells + 2)] for _ in range(cells + 2)]

    def at(u, v):
        x, y = u * cells, v * cells
        i, j = int(x), int(y)
        s, t = (f * f * (3 - 2 * f) for f in (x - i, y - j))
        top = grid[j][i] + s * (grid[j][i + 1] - grid[j][i])
        low = grid[j + 1][i] + s * (grid[j + 1][i + 1] - grid[j + 1][i])
        return top + t * (low - top)

    return at


octaves = [(noise_field(4 * 2**k, k), 0.5**k) for k in range(5)]


def height(u, v):
    hills = sum(weight * (field(u, v) - 0.5) for field, weight in octaves)
    bed = 0.5 + 0.12 * math.sin(5 * v)  # the valley's middle
    slope = min(1.0, abs(u - bed) * 1.9) ** 1.5
    away = min(1.0, 1.3 * max(0.0, 0.75 - v))
    return max(0.0, min(1.0, 0.12 + 0.62 * slope * (0.35 + away) + 0.3 * hills * (0.15 + slope)))


rows = b"".join(
    b"\0" + b"".join(struct.pack(">H", round(65535 * height((x + 0.5) / SIZE, (y + 0.5) / SIZE))) for x in range(SIZE))
    for y in range(SIZE))


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


header = struct.pack(">IIBBBBB", SIZE, SIZE, 16, 0, 0, 0, 0)
png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
pathlib.Path(__file__).with_name("heights.png").write_bytes(png)
