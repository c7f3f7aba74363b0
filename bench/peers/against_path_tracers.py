#!/usr/bin/env python3
"""Means of path traced pictures against LuxCore (PyPI pyluxcore) and Blender's Cycles (PyPI bpy): the scenes of bench/peers/mitsuba/peer_scenes.py that
have no sky, in sundog and in each of them. Usage:

    bench/peers/against_path_tracers.py SUNDOG [--peers luxcore,cycles] [--scenes cornell,glass,ice] [--python-cycles INTERPRETER] [options]

A row a peer and scene, as the part `means` of bench/peers/against_mitsuba.py has it: the whole and 4x4 regions, three channels each, in standard errors of
both programs together. A peer renders --passes pictures of --samples each, whose differences give its standard errors, on one thread in an
interpreter that has its package. Both see spheres as 196,608 triangles with smooth normals, and 32 surfaces; nothing is clamped or filtered.

Under a sky with a small sun neither is a reference: they have rare samples of great weight there, so these scenes are left out.
Within a minute: --scenes cornell --passes 2 --samples 16 --converged 64.
"""
import argparse
import datetime
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "mitsuba")
sys.path.insert(0, FOLDER)
import figures
import peer_scenes
import programs

PEERS = ("luxcore", "cycles")
SCENES = tuple(name for name in peer_scenes.NAMES if name not in peer_scenes.UNDER_SKY)


def render_peer(peer, name, folder, args):
    """The peer's passes; its version and seconds are printed."""
    out = os.path.join(folder, f"{name}-{peer}.npz")
    script = os.path.join(FOLDER, peer + "_passes.py")
    command = [getattr(args, "python_" + peer), script, name, out, str(args.passes), str(args.samples)]
    # LuxCore looks at every OpenCL driver, and its allocator ends the program in some: it finds none in this folder.
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=os.environ | {"OCL_ICD_VENDORS": folder})
    if done.returncode:
        sys.exit(f"{' '.join(command)} ended with {done.returncode}:\n{done.stdout[-2000:]}")
    with np.load(out) as found:
        print(f"  {peer} {found['version']}: {args.passes} passes of {args.samples} samples, {float(found['seconds']):.1f} s", flush=True)
        return found["parts"].astype(float)


def compare(peer, name, folder, ours, args):
    theirs = figures.stored_picture(args.pictures, f"{name}-{peer}", args.passes * args.samples, lambda: render_peer(peer, name, folder, args))
    by_parts = figures.errors_by_parts(theirs)
    means = figures.compare_means(ours, theirs) | {"date": datetime.date.today().isoformat(), "samples": args.converged, "samples_of_peer": theirs.samples,
                                                   "passes_of_peer": len(theirs.parts), "peers_errors_by_passes": by_parts}
    print(f"  {peer}, {theirs.samples} samples in {len(theirs.parts)} passes, whose means differ {by_parts:.2f} times as its pixels say; sundog, {ours.samples}")
    figures.tell_means(means)
    sys.stdout.flush()
    return means


def some_of(known):
    def listed(text):
        names = text.split(",")
        if unknown := set(names) - set(known):
            raise argparse.ArgumentTypeError(f"{', '.join(sorted(unknown))}: wanted some of {', '.join(known)}")
        return names
    return listed


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sundog")
    parser.add_argument("--peers", type=some_of(PEERS), default=list(PEERS))
    parser.add_argument("--scenes", type=some_of(SCENES), default=list(SCENES))
    for peer in PEERS:
        parser.add_argument(f"--python-{peer}", default=sys.executable, help="interpreter that has numpy and the peer's package")
    parser.add_argument("--passes", type=int, default=8, help="at least 2")
    parser.add_argument("--samples", type=int, default=32, help="of each pass")
    parser.add_argument("--converged", type=int, default=2048, help="samples of sundog's pictures")
    parser.add_argument("--device", default="0:0/1")
    parser.add_argument("--json", help="a file that is there already keeps what is not made again")
    parser.add_argument("--pictures", help="folder that keeps the pictures for the next run")
    args = parser.parse_args()
    if args.passes < 2:
        parser.error("--passes: one pass has no standard error")
    return args


def main():
    args = arguments()
    results = {}
    if args.json and os.path.exists(args.json):
        with open(args.json) as file:
            results = json.load(file)
    with tempfile.TemporaryDirectory() as folder:
        for name in args.scenes:
            print(name, flush=True)
            sundog = programs.Sundog(name, folder, args.sundog, args.device)
            ours = figures.stored_picture(args.pictures, f"{name}-sundog", args.converged, lambda: sundog.halves(args.converged))
            for peer in args.peers:
                results.setdefault(name, {})[peer] = compare(peer, name, folder, ours, args)
                if args.json:
                    with open(args.json, "w") as file:
                        json.dump(results, file, indent=1)


if __name__ == "__main__":
    main()
