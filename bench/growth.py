#!/usr/bin/env python3
"""How the time and memory of a frame grow with the scene: makes scenes of growing size and prints a table.

    bench/growth.py SUNDOG [--only NAME]... [--folder DIR] [--largest N]

Each scene is rendered at 64x48 once to fill the kernel cache, then once for the table. Columns: seconds of the time ledger
(load, compile, render, total), the process's life beside them, its greatest memory, and the memory of the scene's tables that
`info` reports. --largest leaves out larger scenes; --folder keeps the scenes.
"""
import argparse
import json
import math
import os
import random
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CAMERA = {"position": [0, 2, 9], "target": [0, 0, 0], "fov": 40}
SUN = {"type": "directional", "direction": [-1, -2, -1]}
GREY = {"grey": {"diffuse": {"color": [0.5, 0.5, 0.5], "coefficient": 1}}}


def scene(objects, lights=None, materials=None, integrator="whitted"):
    return {"image": {"width": 64, "height": 48}, "camera": CAMERA, "lights": lights or [SUN], "objects": objects,
            "materials": materials or {}, "render": {"integrator": integrator}}


def places(count, spread=6):
    """Random places in a cube of that side, the same for each call."""
    chance = random.Random(1)
    return [[round(chance.uniform(-spread / 2, spread / 2), 5) for _ in range(3)] for _ in range(count)]


def ball(at, radius, material):
    return {"type": "sphere", "center": at, "radius": radius, "material": material}


def lamps(count, folder):
    floor = {"type": "plane", "point": [0, -1, 0], "normal": [0, 1, 0], "material": "grey"}
    lights = [{"type": "point", "position": at, "color": [1, 1, 1], "intensity": 1 / count} for at in places(count)]
    return scene([floor], lights, GREY, "path")


def apart(count):
    return 2 / count ** (1 / 3)


def balls(count, folder):
    return scene([ball(at, round(apart(count), 5), "grey") for at in places(count)], None, GREY)


def glass_balls(count, folder):
    return scene([ball(at, round(apart(count), 5), "glass") for at in places(count)], None, {"glass": {"type": "dielectric", "ior": 1.5}})


def openpbr(count, folder):
    chance = random.Random(2)
    material = lambda: {"type": "openpbr", "base_color": [round(chance.random(), 3) for _ in range(3)],
                        "specular_roughness": round(chance.random(), 4), "specular_ior": round(chance.uniform(1.3, 2), 3),
                        "base_metalness": chance.choice([0, 0, 1])}
    names = {f"m{i}": material() for i in range(count)}
    return scene([ball(at, round(apart(count) / 2, 5), f"m{i}") for i, at in enumerate(places(count))], None, names, "path")


def write_ply(file, triangles):
    """A bumpy grid without normals, binary."""
    side = max(1, round(math.sqrt(triangles / 2)))
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {(side + 1) ** 2}\nproperty float x\nproperty float y\n"
              f"property float z\nelement face {2 * side * side}\nproperty list uchar int vertex_indices\nend_header\n")
    wave = [0.2 * math.sin(0.05 * i) for i in range(side + 1)]
    with open(file, "wb") as out:
        out.write(header.encode())
        for i in range(side + 1):
            x = 6 * i / side - 3
            out.write(b"".join(struct.pack("<3f", x, wave[i] * wave[k] * 5, 6 * k / side - 3) for k in range(side + 1)))
        for i in range(side):
            row = bytearray()
            for k in range(side):
                a, b = i * (side + 1) + k, (i + 1) * (side + 1) + k
                row += struct.pack("<B3iB3i", 3, a, a + 1, b, 3, b, a + 1, b + 1)
            out.write(row)


def mesh(count, folder):
    file = folder / f"mesh_{count}.ply"
    if not file.exists():
        write_ply(file, count)
    return scene([{"type": "mesh", "mesh": "grid", "material": "grey"}], None, GREY) | {
        "meshes": {"grid": {"file": file.name}}}


def instances(count, folder):
    file = folder / "mesh_small.ply"
    write_ply(file, 1000)
    return scene([{"type": "mesh", "mesh": "grid", "material": "grey", "transform": [{"scale": 0.05}, {"translate": at}]}
                  for at in places(count)], None, GREY) | {"meshes": {"grid": {"file": file.name}}}


KINDS = {"lamps": (lamps, [10, 1000, 10_000]), "balls": (balls, [100, 10_000, 100_000]),
         "glass_balls": (glass_balls, [100, 10_000, 100_000]), "instances": (instances, [100, 10_000, 100_000]),
         "openpbr": (openpbr, [10, 1000, 10_000]), "mesh": (mesh, [10_000, 1_000_000, 10_000_000])}


def run(command):
    """Seconds and MiB of a whole process."""
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    errors = process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(map(str, command))}: {errors.decode()}")
    return time.perf_counter() - begin, used.ru_maxrss / 1024


def measure(sundog, file):
    stats = file.with_suffix(".stats.json")
    command = [sundog, "render", file, "-o", file.with_suffix(".png"), "--stats", stats, "-q"]
    run(command)
    life, memory = run(command)
    figures = json.loads(stats.read_text())
    return figures["seconds"], life, memory, figures["scene"]["bytes"]["total"] / 2**20


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("sundog", type=lambda name: Path(name).resolve())
    options.add_argument("--only", action="append", choices=KINDS)
    options.add_argument("--folder", type=Path)
    options.add_argument("--largest", type=int, default=10**9)
    chosen = options.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = chosen.folder or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        print(f"{'scene':<12}{'size':>10}{'load':>9}{'compile':>9}{'render':>9}{'total':>9}{'life':>9}{'MiB':>8}{'tables':>8}")
        for name in chosen.only or KINDS:
            make, sizes = KINDS[name]
            for size in (size for size in sizes if size <= chosen.largest):
                file = folder / f"{name}_{size}.json"
                file.write_text(json.dumps(make(size, folder)))
                seconds, life, memory, tables = measure(chosen.sundog, file)
                row = [seconds["load"], seconds["compile_scene"], seconds["render"], seconds["total"], life]
                print(f"{name:<12}{size:>10}" + "".join(f"{value:>9.3f}" for value in row) + f"{memory:>8.0f}{tables:>8.0f}", flush=True)


if __name__ == "__main__":
    main()
