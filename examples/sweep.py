#!/usr/bin/env python3
"""Times a frame for each size of work-group, and checks that the picture stays the same:

    sweep.py SCENE [--device SPEC] [--size WxH] [--repeat N] [--plot FILE.png]
"""

import argparse
import statistics

import numpy as np
import sundog

options = argparse.ArgumentParser(description="Times a frame for each size of work-group.")
options.add_argument("scene")
options.add_argument("--device", help="as `sundog render --device`; without it the fastest")
options.add_argument("--size", default="320x240")
options.add_argument("--repeat", type=int, default=3)
options.add_argument("--plot", help="a picture of the table (matplotlib)")
given = options.parse_args()

scene = sundog.Scene(given.scene)
scene["/image/width"], scene["/image/height"] = map(int, given.size.split("x"))
device = sundog.choose_devices(given.device)[0]
groups = [(1, 1), (8, 1), (16, 1), (32, 1), (64, 1), (128, 1), (8, 8), (16, 8)]

wanted = sundog.render(scene, devices=device).image.pixels
rows = []
for group in groups:
    times = []
    for _ in range(given.repeat + 1):
        film = sundog.render(scene, devices=device, work_group=group)
        if not np.array_equal(film.image.pixels, wanted):
            raise SystemExit(f"{group}: another picture")
        times.append(film.figures["devices"][0]["kernel_ms"])
    rows.append((f"{group[0]}x{group[1]}", statistics.median(times[1:])))  # the first one warms up

best = min(ms for _, ms in rows)
print(f"{scene['/image/width']}x{scene['/image/height']} on {device.label}")
print("| work-group | ms | times the best |\n|---|---|---|")
for name, ms in rows:
    print(f"| {name} | {ms:.1f} | {ms / best:.2f} |")

if given.plot:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.bar([name for name, _ in rows], [ms for _, ms in rows])
    plt.xlabel("work-group")
    plt.ylabel("kernel time of a frame, ms")
    plt.title(device.label, fontsize=8)
    plt.savefig(given.plot, dpi=120)
