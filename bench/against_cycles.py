#!/usr/bin/env python3
"""Textures against Blender's Cycles (PyPI bpy, OpenEXR): the same glTF files there and here, base colour against base colour, which checks
texture coordinates, transforms, wraps and encodings by an importer that no one here wrote. Usage:

    bench/against_cycles.py SUNDOG FILE.gltf... [--size 512] [--device 0:0] [--keep FOLDER]

sundog's side is its AOV `albedo`, Cycles' the same term made of the nodes that its importer links: base (1 - metalness (1 - roughness)^2).
Both look through the pixels' centres. A row a file: the share of pixels that both cover, the mean difference there, the share of them that
differs by more than 0.1 in any channel (edges of nearest texels, and minified textures, which Cycles does not filter), and for
comparison the mean difference if the picture were mirrored.
"""
import argparse
import json
import math
import os
import subprocess
import tempfile

import numpy as np


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sundog")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--device", default="0:0")
    parser.add_argument("--keep", help="folder for the pictures")
    return parser.parse_args()


def read_exr(path):
    import OpenEXR
    with OpenEXR.File(path, separate_channels=True) as file:
        return {name: np.asarray(channel.pixels, dtype=np.float32) for name, channel in file.channels().items()}


def color_of(channels, prefix=""):
    return np.stack([channels[prefix + c] for c in "RGB"], axis=-1)


def bounds_of(bpy):
    from mathutils import Vector
    corners = [o.matrix_world @ Vector(c) for o in bpy.data.objects if o.type == "MESH" for c in o.bound_box]
    low = np.min([list(c) for c in corners], axis=0)
    high = np.max([list(c) for c in corners], axis=0)
    return (low + high) / 2, np.linalg.norm(high - low) / 2


def math_node(tree, operation, a, b):
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = operation
    for socket, value in zip(node.inputs, (a, b)):
        if isinstance(value, float):
            socket.default_value = value
        else:
            tree.links.new(value, socket)
    return node.outputs[0]


def source_of(socket):
    """What feeds a socket; a constant of its own where nothing does."""
    return socket.links[0].from_socket if socket.is_linked else float(socket.default_value)


def images_before(socket):
    """The image nodes that feed a socket."""
    for link in socket.links:
        if link.from_node.bl_idname == "ShaderNodeTexImage":
            yield link.from_node
        for further in link.from_node.inputs:
            yield from images_before(further)


def show_albedo(material):
    """Emission of base (1 - metalness (1 - roughness)^2) in place of the material."""
    tree = material.node_tree
    shader = next((n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled"), None)
    if shader is None:
        return
    smooth = math_node(tree, "SUBTRACT", 1.0, source_of(shader.inputs["Roughness"]))
    mirror = math_node(tree, "MULTIPLY", source_of(shader.inputs["Metallic"]), math_node(tree, "MULTIPLY", smooth, smooth))
    emission = tree.nodes.new("ShaderNodeEmission")
    base = shader.inputs["Base Color"]
    for node in images_before(base):  # the importer has one encoding for all uses of an image
        node.image = node.image.copy()
        node.image.colorspace_settings.name = "sRGB"
    if base.is_linked:
        tree.links.new(base.links[0].from_socket, emission.inputs["Color"])
    else:
        emission.inputs["Color"].default_value = base.default_value
    tree.links.new(math_node(tree, "SUBTRACT", 1.0, mirror), emission.inputs["Strength"])
    output = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])


def render_cycles(path, size, out):
    """The picture, and the camera as sundog's scenes have it (y up)."""
    import bpy
    from mathutils import Vector
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path)
    for o in [o for o in bpy.data.objects if o.type in ("CAMERA", "LIGHT")]:
        bpy.data.objects.remove(o)
    bpy.context.view_layer.update()
    for material in bpy.data.materials:
        show_albedo(material)
    center, radius = bounds_of(bpy)
    fov = 30.0
    toward = Vector((0.45, -0.75, 0.5)).normalized()
    place = Vector(center) + toward * (1.02 * radius / math.sin(math.radians(fov / 2)))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle = math.radians(fov)
    camera.data.clip_start, camera.data.clip_end = radius * 1e-3, radius * 1e3
    camera.location = place
    camera.rotation_euler = (-toward).to_track_quat("-Z", "Y").to_euler()
    scene = bpy.context.scene
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = 1
    scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 0.01
    scene.cycles.max_bounces = 0
    scene.view_settings.view_transform = "Raw"
    scene.render.film_transparent = True
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = out
    bpy.ops.render.render(write_still=True)
    up = lambda v: [v[0], v[2], -v[1]]
    return {"position": up(place), "target": up(center), "fov": fov}


def render_sundog(program, path, camera, size, device, out):
    scene = {"camera": camera, "image": {"width": size, "height": size}, "lights": [{"type": "ambient"}],
             "objects": [{"type": "model", "file": os.path.abspath(path)}]}
    text = os.path.join(os.path.dirname(out), "scene.json")
    with open(text, "w", encoding="utf-8") as file:
        json.dump(scene, file)
    subprocess.run([program, "render", text, "-o", out, "--aov", "albedo", "--aov", "object", "--device", device, "--allow-outside-files",
                    "--quiet"], check=True)


def main():
    a = arguments()
    print(f"{'file':32} {'covered':>8} {'mean':>8} {'> 0.1':>8} {'mirrored':>9}")
    with tempfile.TemporaryDirectory() as scratch:
        folder = os.path.abspath(a.keep or scratch)
        os.makedirs(folder, exist_ok=True)
        for path in a.files:
            name = os.path.splitext(os.path.basename(path))[0]
            theirs_file, ours_file = (os.path.join(folder, f"{name}_{who}.exr") for who in ("cycles", "sundog"))
            camera = render_cycles(os.path.abspath(path), a.size, theirs_file)
            render_sundog(a.sundog, path, camera, a.size, a.device, ours_file)
            theirs, ours = read_exr(theirs_file), read_exr(ours_file)
            both = (theirs["A"] > 0.5) & (ours["object.Y"] >= 0)
            difference = np.abs(color_of(theirs) - color_of(ours, "albedo."))
            mirrored = np.abs(color_of(theirs)[:, ::-1] - color_of(ours, "albedo."))[both & both[:, ::-1]]
            print(f"{name:32} {both.mean():8.3f} {difference[both].mean():8.4f} {(difference[both].max(axis=-1) > 0.1).mean():8.4f} "
                  f"{mirrored.mean():9.4f}", flush=True)


main()
