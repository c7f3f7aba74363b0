#!/usr/bin/env python3
"""Makes the meshes of this folder: a spruce of height 1, its needles and wood, and the snow on its boughs."""
import math
import os
import random

HERE = os.path.dirname(os.path.abspath(__file__))
WHORLS, STEPS, TRUNK = 17, 4, 7


class Spruce:
    def __init__(self, seed):
        self.dice = random.Random(seed)
        self.points, self.needles, self.snow = [], [], []

    def add(self, point):
        self.points.append(point)
        return len(self.points)

    def strip(self, faces, a, b):
        for i in range(len(a) - 1):
            faces += [(a[i], b[i], b[i + 1]), (a[i], b[i + 1], a[i + 1])]

    def bough(self, height, angle, length, droop):
        """A bent kite: a spine from the trunk to the tip, and a row of points on either side."""
        cosine, sine = math.cos(angle), math.sin(angle)
        place = lambda p: self.add((p[0] * cosine - p[1] * sine, height + p[2], p[0] * sine + p[1] * cosine))
        spine, left, right = [], [], []
        for i in range(STEPS + 1):
            t = i / STEPS
            out, up = length * t, length * (0.06 * math.sin(math.pi * t) - droop * t * t)
            wide = 0.27 * length * math.sin(math.pi * (0.12 + 0.88 * t)) * (1 + self.dice.uniform(-0.25, 0.25))
            spine.append((out, 0, up))
            left.append((out + 0.03 * length, wide, up - 0.09 * length - 0.2 * wide))
            right.append((out + 0.03 * length, -wide, up - 0.09 * length - 0.2 * wide))
        rows = [[place(p) for p in row] for row in (left, spine, right)]
        self.strip(self.needles, rows[0], rows[1])
        self.strip(self.needles, rows[1], rows[2])
        lift = 0.035 * length
        cover = lambda side: [place((p[0], 0.72 * p[1], q[2] + 0.72 * (p[2] - q[2]) + 0.25 * lift))
                              for p, q in zip(side[1:], spine[1:])]
        ridge = [place((p[0], 0, p[2] + lift)) for p in spine[1:]]
        self.strip(self.snow, cover(left), ridge)
        self.strip(self.snow, ridge, cover(right))

    def grow(self):
        for k in range(WHORLS):
            t = k / (WHORLS - 1)
            height, reach, count = 0.1 + 0.86 * t ** 0.92, 0.27 * (1 - t) ** 0.85 + 0.02, round(11 - 6 * t)
            turn = self.dice.uniform(0, 2 * math.pi)
            for j in range(count):
                self.bough(height + self.dice.uniform(-0.012, 0.012),
                           turn + 2 * math.pi * (j + self.dice.uniform(-0.25, 0.25)) / count,
                           reach * self.dice.uniform(0.82, 1.1), 0.62 - 0.5 * t)
        turns = [2 * math.pi * i / TRUNK for i in range(TRUNK)]
        ring = [self.add((0.022 * math.cos(a), 0, 0.022 * math.sin(a))) for a in turns]
        top = self.add((0, 1.02, 0))
        self.needles += [(ring[i - 1], top, ring[i]) for i in range(TRUNK)]

    def write(self, name, what, faces):
        index = {p: k + 1 for k, p in enumerate(sorted({p for face in faces for p in face}))}
        with open(os.path.join(HERE, name), "w", encoding="ascii") as out:
            out.write(f"# A spruce of height 1: {what}. Made by make.py.\n")
            out.writelines("v %.4f %.4f %.4f\n" % self.points[p - 1] for p in index)
            out.writelines("f %d %d %d\n" % tuple(index[p] for p in face) for face in faces)


spruce = Spruce(4)
spruce.grow()
spruce.write("spruce_needles.obj", "needles and wood", spruce.needles)
spruce.write("spruce_snow.obj", "the snow on its boughs", spruce.snow)
