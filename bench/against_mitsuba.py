#!/usr/bin/env python3
"""Path tracing against Mitsuba 3 (PyPI mitsuba): the same scenes, in turn, one thread each. Prints the means of the whole picture and of
4x4 regions in standard errors of their difference, and samples a second of both. Usage:

    bench/against_mitsuba.py SUNDOG [--scenes cornell,glass,environment,ice] [--samples 64] [--seeds 8] [--device 0:0/1] [--variant llvm_ad_rgb]

The standard error is that of Mitsuba's pictures with different seeds, and is taken to be as large for sundog with as many samples.
"""
import argparse
import json
import math
import os
import subprocess
import tempfile
import time

import numpy as np

SIZE, DEPTH = 256, 32
WHITE, RED, GREEN = [0.725, 0.71, 0.68], [0.63, 0.065, 0.05], [0.14, 0.45, 0.091]


def room():
    """Boxes about the room x -1..1, y 0..2, z -1..1, which is open towards the camera."""
    return [("box", {"min": [-1.1, -0.1, -1.1], "max": [1.1, 0, 1]}, "white"), ("box", {"min": [-1.1, 2, -1.1], "max": [1.1, 2.1, 1]}, "white"),
            ("box", {"min": [-1, 0, -1.1], "max": [1, 2, -1]}, "white"), ("box", {"min": [-1.1, 0, -1.1], "max": [-1, 2, 1]}, "red"),
            ("box", {"min": [1, 0, -1.1], "max": [1.1, 2, 1]}, "green")]


def turned(center, half, degrees):
    return {"min": [-h for h in half], "max": half, "turn": degrees, "center": center}


SCENES = {
    "cornell": room() + [("box", turned([-0.35, 0.6, -0.3], [0.3, 0.6, 0.3], 17), "white"),
                         ("box", turned([0.35, 0.3, 0.35], [0.3, 0.3, 0.3], -17), "white")],
    "glass": room() + [("sphere", {"center": [0.42, 0.401, 0.3], "radius": 0.4}, "glass"),
                       ("sphere", {"center": [-0.45, 0.451, -0.35], "radius": 0.45}, "mirror")],
    "environment": [("box", {"min": [-10, -0.1, -10], "max": [10, 0, 10]}, "ground"),
                    ("sphere", {"center": [-0.65, 0.601, 0], "radius": 0.6}, "clay"),
                    ("sphere", {"center": [0.65, 0.601, 0], "radius": 0.6}, "mirror")],
    "ice": room() + [("box", turned([0, 0.601, 0.1], [0.5, 0.6, 0.5], 25), "shell"),
                     ("box", turned([0, 0.601, 0.1], [0.35, 0.45, 0.35], 25), "liquid")],
}
COLORS = {"white": WHITE, "red": RED, "green": GREEN, "ground": [0.4, 0.4, 0.4], "clay": [0.6, 0.25, 0.15]}
# index inside and outside, absorption inside and outside
INTERFACES = {"glass": (1.5, 1.0, None, None), "shell": (1.5, 1.0, [0.4, 0.15, 0.1], None), "liquid": (1.33, 1.5, [0.5, 4.0, 5.0], [0.4, 0.15, 0.1])}
MIRROR = [0.95, 0.95, 0.95]
LAMP = {"center": [0, 1.99, 0], "size": [0.5, 0.4], "radiance": [17.0, 12.0, 4.0]}


def camera_of(name):
    if name == "environment":
        return {"position": [0, 1.4, 5], "target": [0, 0.45, 0], "fov": 35.0}
    return {"position": [0, 1, 3.9], "target": [0, 1, 0], "fov": 39.3}


def write_sky(path):
    """A sky and a sun, equirectangular, as RGBE: -z in the middle, +x right of it."""
    h, w = 256, 512
    y = np.cos((np.arange(h) + 0.5) / h * math.pi)[:, None] * np.ones((1, w))
    up = np.sqrt(np.clip(y, 0, 1))[..., None]
    image = (1 - up) * np.array([0.9, 0.85, 0.8]) + up * np.array([0.15, 0.3, 0.7])
    image[y < 0] = (0.2, 0.18, 0.15)
    s = np.array([0.5, 0.75, 0.6]) / np.linalg.norm([0.5, 0.75, 0.6])
    row, column = int(math.acos(s[1]) / math.pi * h), int((0.5 + math.atan2(s[0], -s[2]) / (2 * math.pi)) * w)
    image[row - 1:row + 2, column - 1:column + 2] = [3000, 2700, 2200]
    mantissa, exponent = np.frexp(image.max(axis=2))
    scaled = np.floor(image * (mantissa * 256 / image.max(axis=2))[..., None])
    rgbe = np.dstack([scaled, exponent + 128]).astype(np.uint8)
    with open(path, "wb") as out:
        out.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (h, w) + rgbe.tobytes())


def sundog_scene(name, samples):
    camera = camera_of(name)
    materials = {key: {"color": color, "ambient": 0, "diffuse": 1} for key, color in COLORS.items()}
    materials["mirror"] = {"ambient": 0, "diffuse": 0, "reflection": {"color": MIRROR}}
    media = {}
    for rank, (key, (inside, _, absorption, _)) in enumerate(INTERFACES.items()):
        media[key] = {"ior": inside, "absorption": absorption or [0, 0, 0], "priority": rank}
        materials[key] = {"type": "dielectric", "medium": key}
    objects = []
    for kind, numbers, material in SCENES[name]:
        numbers = dict(numbers)
        thing = {"type": kind, "material": material}
        if "turn" in numbers:
            thing["transform"] = [{"rotate": {"axis": [0, 1, 0], "degrees": numbers.pop("turn")}}, {"translate": numbers.pop("center")}]
        objects.append({**thing, **numbers})
    scene = {"camera": camera, "image": {"width": SIZE, "height": SIZE}, "media": media, "materials": materials, "objects": objects,
             "render": {"integrator": "path", "max_depth": DEPTH, "samples": samples, "sampler": "independent"}}
    if name == "environment":
        scene["environment"] = {"type": "image", "file": "sky.hdr"}
    else:
        scene["lights"] = [{"type": "rectangle", "position": LAMP["center"], "direction": [0, -1, 0], "up": [0, 0, -1],
                            "size": LAMP["size"], "color": LAMP["radiance"]}]
    return scene


def mitsuba_scene(mi, name, folder):
    T = mi.ScalarTransform4f

    def rgb(c):
        return {"type": "rgb", "value": list(c)}

    def medium(sigma):
        return {"type": "homogeneous", "albedo": 0.0, "sigma_t": rgb([v / max(sigma) for v in sigma]), "scale": max(sigma)}

    camera = camera_of(name)
    scene = {"type": "scene", "integrator": {"type": "volpath" if name == "ice" else "path", "max_depth": DEPTH + 1},
             "sensor": {"type": "perspective", "fov": camera["fov"], "fov_axis": "y", "near_clip": 0.01, "far_clip": 1000.0,
                        "to_world": T().look_at(origin=camera["position"], target=camera["target"], up=[0, 1, 0]),
                        "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}, "pixel_format": "rgb",
                                 "component_format": "float32"},
                        "sampler": {"type": "independent", "sample_count": 64}}}
    if name == "environment":
        scene["sky"] = {"type": "envmap", "filename": os.path.join(folder, "sky.hdr"), "to_world": T().rotate([0, 1, 0], 180)}
    else:
        to_world = T().translate(LAMP["center"]).rotate([1, 0, 0], 90).scale([LAMP["size"][0] / 2, LAMP["size"][1] / 2, 1])
        scene["lamp"] = {"type": "rectangle", "to_world": to_world, "bsdf": {"type": "diffuse", "reflectance": rgb([0, 0, 0])},
                         "emitter": {"type": "area", "radiance": rgb(LAMP["radiance"])}}
    for i, (kind, numbers, material) in enumerate(SCENES[name]):
        if kind == "sphere":
            shape = {"type": "sphere", "center": numbers["center"], "radius": numbers["radius"]}
        else:
            low, high = np.array(numbers["min"], float), np.array(numbers["max"], float)
            middle = np.array(numbers.get("center", [0, 0, 0]), float) + (low + high) / 2
            to_world = T().translate(middle.tolist()).rotate([0, 1, 0], numbers.get("turn", 0)).scale(((high - low) / 2).tolist())
            shape = {"type": "cube", "to_world": to_world}
        if material in COLORS:
            shape["bsdf"] = {"type": "diffuse", "reflectance": rgb(COLORS[material])}
        elif material == "mirror":
            shape["bsdf"] = {"type": "conductor", "material": "none", "specular_reflectance": rgb(MIRROR)}
        else:
            inside, outside, absorbs, absorbs_outside = INTERFACES[material]
            shape["bsdf"] = {"type": "dielectric", "int_ior": inside, "ext_ior": outside}
            if absorbs:
                shape["interior"] = medium(absorbs)
            if absorbs_outside:
                shape["exterior"] = medium(absorbs_outside)
        scene[f"thing{i}"] = shape
    return mi.load_dict(scene)


def read_pfm(path):
    with open(path, "rb") as file:
        kind, size, scale = file.readline().strip(), file.readline().split(), float(file.readline())
        assert kind == b"PF" and scale < 0
        return np.frombuffer(file.read(), "<f4").reshape(int(size[1]), int(size[0]), 3)[::-1]


def render_sundog(program, folder, name, samples, device):
    scene, out, stats = (os.path.join(folder, name + end) for end in (".json", ".pfm", ".stats.json"))
    with open(scene, "w") as file:
        json.dump(sundog_scene(name, samples), file)
    subprocess.run([program, "render", scene, "-o", out, "--stats", stats, "--quiet", "--device", device], check=True)
    with open(stats) as file:
        return read_pfm(out).astype(float), json.load(file)["seconds"]["render"]


def regions(image):
    step = SIZE // 4
    return np.array([image.mean((0, 1))] + [image[y:y + step, x:x + step].mean((0, 1)) for y in range(0, SIZE, step) for x in range(0, SIZE, step)])


def compare(mi, args, name, folder):
    scene = mitsuba_scene(mi, name, folder)
    np.array(mi.render(scene, spp=1, seed=999))
    render_sundog(args.sundog, folder, name, 1, args.device)
    means, theirs, ours = [], [], []
    for seed in range(args.seeds):
        start = time.perf_counter()
        image = np.array(mi.render(scene, spp=args.samples, seed=seed), float)
        theirs.append(time.perf_counter() - start)
        means.append(regions(image))
        picture, seconds = render_sundog(args.sundog, folder, name, args.samples, args.device)
        ours.append(seconds)
    picture, _ = render_sundog(args.sundog, folder, name, args.samples * args.seeds, args.device)
    means, found = np.array(means), regions(picture)
    error = means.std(0, ddof=1) / math.sqrt(args.seeds) * math.sqrt(2)
    off = (found - means.mean(0)) / error
    apart = np.abs(found / means.mean(0) - 1)[1:][np.abs(off[1:]) > 3]
    rate = SIZE * SIZE * args.samples / 1e6
    print(f"{name}: mean {found[0].round(5)} against {means.mean(0)[0].round(5)} ({off[0].round(1)} standard errors); "
          f"regions: greatest {np.abs(off[1:]).max():.1f}, {(np.abs(off[1:]) > 3).sum()} of {off[1:].size} beyond 3, these by {100 * max(apart, default=0):.2f} %; "
          f"{rate / np.median(ours):.2f} against {rate / np.median(theirs):.2f} Msamples/s: {np.median(theirs) / np.median(ours):.2f} times", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("sundog")
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--device", default="0:0/1")
    parser.add_argument("--variant", default="llvm_ad_rgb")
    args = parser.parse_args()
    import mitsuba as mi
    mi.set_variant(args.variant)
    if "llvm" in args.variant:
        import drjit
        drjit.set_thread_count(1)
    with tempfile.TemporaryDirectory() as folder:
        write_sky(os.path.join(folder, "sky.hdr"))
        for name in args.scenes.split(","):
            compare(mi, args, name, folder)


if __name__ == "__main__":
    main()
