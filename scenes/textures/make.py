#!/usr/bin/env python3
"""Makes the images of this folder: tiles with fine joints (repeats), a dial with a clear outside that shows where up
and right are, and a leaf with alpha."""
import math
import os
import struct
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))


def write_png(name, size, pixel, alpha):
    rows = [b"\0" + bytes(v for x in range(size) for v in pixel((x + 0.5) / size, 1 - (y + 0.5) / size)) for y in range(size)]
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    with open(os.path.join(HERE, name), "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 6 if alpha else 2, 0, 0, 0))
                  + chunk(b"IDAT", zlib.compress(b"".join(rows), 9)) + chunk(b"IEND", b""))


def tiles(u, v):
    i, j = int(u * 4), int(v * 4)
    x, y = u * 4 % 1, v * 4 % 1
    if min(x, y, 1 - x, 1 - y) < 0.035:
        return (70, 66, 60)
    return [(214, 202, 180), (196, 120, 84), (122, 138, 132), (226, 216, 200)][(i * 3 + j * 5 + i * j) % 4]


def dial(u, v):
    x, y = 2 * u - 1, 2 * v - 1
    r, angle = math.hypot(x, y), math.atan2(y, x)
    if r > 0.92:
        return (236, 232, 222)
    if r > 0.84:
        return (40, 60, 96)
    if abs(x) < 0.07 and 0 < y < 0.7 or 0.4 < y < 0.75 and abs(x) < 0.75 - y:
        return (190, 44, 40)  # the arrow points up
    if x > 0.45 and abs(y) < 0.06:
        return (40, 120, 60)  # the bar lies to the right
    return (236, 208, 120) if int((angle + math.pi) / math.pi * 12) % 2 else (226, 188, 92)


def leaf(u, v):
    x, y = 2 * u - 1, v
    half = 0.8 * math.sin(math.pi * min(max(y, 0), 1)) ** 0.8 * (1 - 0.45 * y)
    vein = abs(x) < 0.03 or abs((y * 7 - abs(x) * 4) % 1 - 0.5) < 0.05
    inside = abs(x) < half * (0.93 + 0.07 * math.cos(40 * y))
    return (96, 132, 44, 255 if inside else 0) if vein else (62, 110, 34, 255 if inside else 0)


write_png("tiles.png", 256, tiles, False)
write_png("dial.png", 128, dial, False)
write_png("leaf.png", 128, leaf, True)
