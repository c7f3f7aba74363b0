"""The scenes that sundog and its peers among path tracers render, each number stated once, and sundog's scene
files.

y up, right-handed, linear Rec.709, 256x256 pixels, box filter of one pixel, paths of up to 32 surfaces. In
both programs, walls and the ground are boxes whose inner faces are the scenes' quads, and spheres are exact.
The sky is a picture of 512x256 pixels with -z in its middle and +x right of it.
"""
import math
import os
import shutil

import numpy as np

SIZE, DEPTH = 256, 32
NAMES = ("cornell", "glass", "environment", "textured", "textured_flat", "ice")
TEXTURED = ("textured", "textured_flat")  # with vertex normals, and without
UNDER_SKY = ("environment", *TEXTURED)
BARREL = os.path.join("scenes", "metal_barrel")  # in the folder of assets
BARREL_SCALE = 1.2 / 90.21511

COLORS = {"white": [0.725, 0.71, 0.68], "red": [0.63, 0.065, 0.05], "green": [0.14, 0.45, 0.091], "ground": [0.4, 0.4, 0.4],
          "clay": [0.6, 0.25, 0.15]}
# Index of refraction inside and outside, absorption inside and outside.
INTERFACES = {"glass": (1.5, 1.0, None, None), "shell": (1.5, 1.0, [0.4, 0.15, 0.1], None), "liquid": (1.33, 1.5, [0.5, 4.0, 5.0], [0.4, 0.15, 0.1])}
MIRROR = [0.95, 0.95, 0.95]
METAL, METAL_ALPHA = [0.9, 0.75, 0.5], 0.2  # single-scattering GGX, this colour at every angle
LAMP = {"center": [0, 1.99, 0], "size": [0.5, 0.4], "radiance": [17.0, 12.0, 4.0]}  # faces down, black behind


def room():
    """Boxes around the room x -1..1, y 0..2, z -1..1, which is open towards the camera."""
    return [("box", {"min": [-1.1, -0.1, -1.1], "max": [1.1, 0, 1]}, "white"), ("box", {"min": [-1.1, 2, -1.1], "max": [1.1, 2.1, 1]}, "white"),
            ("box", {"min": [-1, 0, -1.1], "max": [1, 2, -1]}, "white"), ("box", {"min": [-1.1, 0, -1.1], "max": [-1, 2, 1]}, "red"),
            ("box", {"min": [1, 0, -1.1], "max": [1.1, 2, 1]}, "green")]


def turned(center, half, degrees):
    """A box turned about +y, counter-clockwise seen from above."""
    return {"min": [-h for h in half], "max": half, "turn": degrees, "center": center}


GROUND = ("box", {"min": [-10, -0.1, -10], "max": [10, 0, 10]}, "ground")
OBJECTS = {
    "cornell": room() + [("box", turned([-0.35, 0.6, -0.3], [0.3, 0.6, 0.3], 17), "white"),
                         ("box", turned([0.35, 0.3, 0.35], [0.3, 0.3, 0.3], -17), "white")],
    "glass": room() + [("sphere", {"center": [0.42, 0.401, 0.3], "radius": 0.4}, "glass"),
                       ("sphere", {"center": [-0.45, 0.451, -0.35], "radius": 0.45}, "mirror")],
    "environment": [GROUND, ("sphere", {"center": [-0.65, 0.601, 0], "radius": 0.6}, "clay"),
                    ("sphere", {"center": [0.65, 0.601, 0], "radius": 0.6}, "metal")],
    "textured": [GROUND, ("mesh", {"file": "mesh.obj", "flat": False}, "barrel")],
    "textured_flat": [GROUND, ("mesh", {"file": "flat.obj", "flat": True}, "barrel")],
    "ice": room() + [("box", turned([0, 0.601, 0.1], [0.5, 0.6, 0.5], 25), "shell"),
                     ("box", turned([0, 0.601, 0.1], [0.35, 0.45, 0.35], 25), "liquid")],
}


def camera_of(name):
    if name in UNDER_SKY:
        return {"position": [0, 1.4, 5], "target": [0, 0.45, 0], "fov": 35.0}
    return {"position": [0, 1, 3.9], "target": [0, 1, 0], "fov": 39.3}


def find_barrel():
    """The folder of the barrel's model in $SUNDOG_ASSETS, or else in ../shared/assets beside the source tree;
    or None."""
    tree = os.path.join(os.path.dirname(os.path.abspath(__file__)), *[".."] * 3)
    folder = os.path.join(os.environ.get("SUNDOG_ASSETS") or os.path.join(tree, "..", "shared", "assets"), BARREL)
    return folder if os.path.exists(os.path.join(folder, "mesh.obj")) else None


def make_sky():
    """A sky and a sun of 3x3 texels as RGBE bytes with truncated mantissas."""
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
    return np.dstack([scaled, exponent + 128]).astype(np.uint8)


def write_sky(path, rgbe):
    with open(path, "wb") as out:
        out.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % rgbe.shape[:2] + rgbe.tobytes())


def sky_between_edges(rgbe):
    """Converts the sky for Mitsuba 3.9, whose first and last rows of texels lie on the poles; sundog's lie
    half a row inside of them. Returns 2 n + 1 rows: the picture's n, and means between and around them, so
    that Mitsuba's linear interpolation gives sundog's radiance."""
    sky = rgbe[..., :3] * np.exp2(rgbe[..., 3:].astype(float) - 136)
    around = np.concatenate([sky[:1], sky, sky[-1:]])
    rows = np.empty((2 * len(sky) + 1,) + sky.shape[1:], np.float32)
    rows[1::2], rows[0::2] = sky, (around[1:] + around[:-1]) / 2
    return rows


def without_normals(line):
    """A line of an OBJ file without normals; empty for a normal itself."""
    if line.startswith("vn"):
        return ""
    return " ".join(corner.rsplit("/", 1)[0] for corner in line.split()) + "\n" if line.startswith("f ") else line


def write_files(folder):
    """Writes the files that scenes need: the sky, and the barrel's model if found. Returns the scenes that
    can be rendered."""
    write_sky(os.path.join(folder, "sky.hdr"), make_sky())
    barrel = find_barrel()
    if not barrel:
        return [name for name in NAMES if name not in TEXTURED]
    shutil.copyfile(os.path.join(barrel, "diffuse.png"), os.path.join(folder, "diffuse.png"))
    with open(os.path.join(barrel, "mesh.obj")) as model:
        lines = [line for line in model if not line.startswith(("mtllib", "usemtl"))]
    with open(os.path.join(folder, "mesh.obj"), "w") as copy:
        copy.writelines(lines)
    with open(os.path.join(folder, "flat.obj"), "w") as copy:
        copy.writelines(map(without_normals, lines))
    return list(NAMES)


def sundog_materials():
    materials = {key: {"color": color, "ambient": 0, "diffuse": 1} for key, color in COLORS.items()}
    materials["mirror"] = {"ambient": 0, "diffuse": 0, "reflection": {"color": MIRROR}}
    materials["metal"] = {"ambient": 0, "diffuse": 0, "reflection": {"color": METAL}, "roughness": math.sqrt(METAL_ALPHA),
                          "multiple_scattering": False}
    media = {}
    for rank, (key, (inside, _, absorption, _)) in enumerate(INTERFACES.items()):
        media[key] = {"ior": inside, "absorption": absorption or [0, 0, 0], "priority": rank}
        materials[key] = {"type": "dielectric", "medium": key}
    return materials, media


def sundog_object(kind, numbers, material):
    numbers = dict(numbers)
    thing = {"type": kind, "material": material}
    if kind == "mesh":
        return thing | {"mesh": "barrel", "transform": [{"scale": BARREL_SCALE}]}
    if "turn" in numbers:
        thing["transform"] = [{"rotate": {"axis": [0, 1, 0], "degrees": numbers.pop("turn")}}, {"translate": numbers.pop("center")}]
    return thing | numbers


def sundog_scene(name, samples, sampler, caustics=False):
    materials, media = sundog_materials()
    scene = {"camera": camera_of(name), "image": {"width": SIZE, "height": SIZE}, "media": media, "materials": materials,
             "objects": [sundog_object(*thing) for thing in OBJECTS[name]],
             "render": {"integrator": "path", "max_depth": DEPTH, "samples": samples, "sampler": sampler,
                        "caustics": caustics}}
    if name in TEXTURED:
        _, model, _ = OBJECTS[name][-1]
        scene["meshes"] = {"barrel": {"file": model["file"]} | ({"crease_angle": 0} if model["flat"] else {})}
        scene["textures"] = {"barrel": {"type": "image", "file": "diffuse.png", "filter": "bilinear"}}
        materials["barrel"] = {"color": "barrel", "ambient": 0, "diffuse": 1}
    if name in UNDER_SKY:
        scene["environment"] = {"type": "image", "file": "sky.hdr"}
    else:
        scene["lights"] = [{"type": "rectangle", "position": LAMP["center"], "direction": [0, -1, 0], "up": [0, 0, -1],
                            "size": LAMP["size"], "color": LAMP["radiance"]}]
    return scene
