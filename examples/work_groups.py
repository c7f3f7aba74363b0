# %% [markdown]
# # Work-groups
# How long a frame takes in work-groups of different sizes: the table of sundog's README. Each cell (`# %%`) runs by itself in
# Jupyter, VS Code or Spyder, all of them by `python3 work_groups.py [SCENE] [DEVICE] [WIDTHxHEIGHT] [RUNS]`.

# %% The scene and the device
import statistics
import sys
from pathlib import Path

import numpy as np
import sundog

given = dict(enumerate(sys.argv[1:] if Path(sys.argv[0]).stem == "work_groups" else []))  # a notebook has others
scene = sundog.Scene(given.get(0, "scenes/spheres.json"))
device = sundog.choose_devices(given.get(1) or None)[0]
scene["/image/width"], scene["/image/height"] = map(int, given.get(2, "320x240").split("x"))
runs = int(given.get(3, 9))
film = sundog.render(scene, devices=device)
print(device.label)
film  # a notebook shows the picture

# %% Each size in turn, again and again, so that what disturbs the machine disturbs all of them; every picture has to be the same
sizes = [(1, 1), (4, 1), (16, 1), (64, 1), (256, 1), (8, 8), (16, 16)]
times = {size: [] for size in sizes}
for turn in range(runs + 1):
    for size in sizes:
        made = sundog.render(scene, devices=device, work_group=size)
        assert np.array_equal(made.image.pixels, film.image.pixels), size
        if turn > 0:  # the first one warms up
            times[size].append(made.figures["devices"][0]["kernel_ms"])

# %% The table
medians = {size: statistics.median(ms) for size, ms in times.items()}
best = min(medians.values())
print("| work-group | frame, ms | times the best |\n|---|---|---|")
for (x, y), ms in medians.items():
    print(f"| {x}x{y} | {ms:.1f} | {ms / best:.2f} |")

# %% The same as a picture, where matplotlib is installed
try:
    import matplotlib.pyplot as plt
except ImportError:
    print("pip install matplotlib shows the times as bars")
else:
    plt.boxplot(list(times.values()))
    plt.xticks(range(1, len(sizes) + 1), [f"{x}x{y}" for x, y in sizes])
    plt.xlabel("work-group")
    plt.ylabel("kernel time of a frame, ms")
    plt.show()
