#!/usr/bin/env python3
"""Times the start, from the command to a small picture: without cached kernels, with all of them cached, and
after an edit of a scene's formula. Usage:

    bench/start_up.py SUNDOG [--size N] [--repeats N] [--device SPEC] [--json FILE]

The caches are temporary folders. A picture of 64x64 pixels is one tile, so nothing of it can be seen before
its end. Scenes take turns, so that a change in the machine's load affects all alike.
"""
import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

SCENES = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "scenes")
MAP, OTHER_MAP = '"z = abs(z) - shift"', '"z = abs(z + shift) - 2 * shift"'


def time_start(args, scene, caches):
    """Wall-clock and processor seconds of a render with one sample a pixel (path-traced scenes have many)."""
    command = [args.sundog, "render", scene, "--size", f"{args.size}x{args.size}", "--device", args.device, "--quiet", "--samples", "1",
               "-o", os.path.join(caches, "picture.png")]
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(command, check=True, env=os.environ | {"XDG_CACHE_HOME": caches, "POCL_CACHE_DIR": os.path.join(caches, "pocl")})
    wall, after = time.perf_counter() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def time_round(args, starts):
    def add(name, scene, caches):
        starts.setdefault(name, []).append(time_start(args, scene, caches))

    for name in ("spheres", "cornell_path", "glass_path", "formula"):
        scene = os.path.join(SCENES, name + ".json")
        with tempfile.TemporaryDirectory() as caches:
            add(name + ", no kernel in any cache", scene, caches)
            add(name + ", kernels cached", scene, caches)
            if name == "formula":
                with open(scene) as file:
                    text = file.read()
                if MAP not in text:
                    sys.exit(f"{scene} has no map {MAP}")
                edited = os.path.join(caches, "edited.json")
                with open(edited, "w") as file:
                    file.write(text.replace(MAP, OTHER_MAP))
                add(name + " with another map, all else cached", edited, caches)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sundog")
    parser.add_argument("--size", type=int, default=64)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--json")
    args = parser.parse_args()
    starts = {}
    for _ in range(args.repeats):
        time_round(args, starts)
    print(f"{'':46} {'wall [s]':>9} {'range':>13} {'processor':>10}")
    for name, times in starts.items():
        wall, processor = zip(*times)
        print(f"{name:46} {statistics.median(wall):9.3f} {min(wall):6.3f}-{max(wall):.3f} {statistics.median(processor):10.3f}")
    if args.json:
        with open(args.json, "w") as file:
            json.dump({"size": args.size, "device": args.device, "wall_and_processor_seconds": starts}, file, indent=1)


if __name__ == "__main__":
    main()
