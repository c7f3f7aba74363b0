#!/usr/bin/env python3
"""Makes the images and meshes of this folder: cobbles as heights (16 bits), normals and colours, which repeat; a
tube and a ball. ball_normal.png is baked: sundog bake ball_high.json ball.obj -o ball_normal.png --size 256

The stones are the cells of points on a jittered grid, rounded towards the joints between them.
"""
import math
import os
import random
import struct
import zlib

CELLS, SIZE = 5, 160
HERE = os.path.dirname(os.path.abspath(__file__))


def write_png(name, rows, colour, bits):
    """Rows of samples of one kind: colour 0 is grey, 2 RGB."""
    form = ">%dH" if bits == 16 else "%dB"
    data = b"".join(b"\0" + struct.pack(form % len(row), *row) for row in rows)
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    width = len(rows[0]) // (3 if colour == 2 else 1)
    with open(os.path.join(HERE, name), "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), bits, colour, 0, 0, 0))
                  + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b""))


def cobbles():
    """For each texel its height in [0, 1] and its stone."""
    dice = random.Random(7)
    points = {(i, j): (i + 0.5 + 0.34 * dice.uniform(-1, 1) + 0.5 * (j % 2), j + 0.5 + 0.3 * dice.uniform(-1, 1))
              for i in range(CELLS) for j in range(CELLS + 1)}
    rows = []
    for y in range(SIZE):
        row = []
        for x in range(SIZE):
            px, py = (x + 0.5) * CELLS / SIZE, (y + 0.5) * (CELLS + 1) / SIZE
            near = []
            for (i, j), (qx, qy) in points.items():
                dx = (px - qx + CELLS / 2) % CELLS - CELLS / 2
                dy = (py - qy + (CELLS + 1) / 2) % (CELLS + 1) - (CELLS + 1) / 2
                near.append((math.hypot(dx, dy), (i, j)))
            near.sort()
            gap = min(max((near[1][0] - near[0][0] - 0.06) / 0.42, 0.0), 1.0)
            row.append((math.sqrt(1 - (1 - gap) ** 2) * (1 - 0.1 * near[0][0]), near[0][1]))
        rows.append(row)
    return rows


def write_mesh(name, columns, rows, point, normal):
    """A grid of u and v in [0, 1], each corner with a point and a normal."""
    with open(os.path.join(HERE, name), "w") as out:
        grid = [(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
        for kind, place in (("v", point), ("vt", lambda u, v: (u, v)), ("vn", normal)):
            for u, v in grid:
                out.write(kind + "".join(" %.5g" % (x + 0.0) for x in place(u, v)) + "\n")
        for j in range(rows):
            for i in range(columns):
                a = j * (columns + 1) + i + 1
                out.write("f" + "".join(" %d/%d/%d" % (k, k, k) for k in (a, a + 1, a + columns + 2, a + columns + 1)) + "\n")


def on_tube(u, v):
    return math.cos(2 * math.pi * u), 0, -math.sin(2 * math.pi * u)


def on_ball(u, v):
    r = math.sin(math.pi * v)
    return r * math.cos(2 * math.pi * u), -math.cos(math.pi * v), -r * math.sin(2 * math.pi * u)


def main():
    write_mesh("tube.obj", 48, 1, lambda u, v: (on_tube(u, v)[0], v, on_tube(u, v)[2]), on_tube)
    write_mesh("ball.obj", 24, 12, on_ball, on_ball)
    stones = cobbles()
    height = [[h for h, _ in row] for row in stones]
    write_png("cobbles_height.png", [[round(65535 * h) for h in row] for row in height], 0, 16)
    # Heights of 1 are HEIGHT of the image's edge.
    steep, normals, colours = 0.055 * SIZE, [], []
    dice = random.Random(3)
    tints = {cell: dice.uniform(0.75, 1.1) for row in stones for _, cell in row}
    for y in range(SIZE):
        normals.append([])
        colours.append([])
        for x in range(SIZE):
            dx = (height[y][(x + 1) % SIZE] - height[y][x - 1]) / 2 * steep
            dy = (height[y - 1][x] - height[(y + 1) % SIZE][x]) / 2 * steep
            length = math.sqrt(dx * dx + dy * dy + 1)
            normals[-1] += [round(127.5 + 127.5 * v / length) for v in (-dx, -dy, 1)]
            h, cell = stones[y][x]
            stone = min(h * 3, 1.0)
            for joint, full in ((70, 178), (62, 150), (54, 122)):
                colours[-1].append(round(joint + (full * tints[cell] - joint) * stone))
    write_png("cobbles_normal.png", normals, 2, 8)
    write_png("cobbles_color.png", colours, 2, 8)


main()
