"""One of the scenes without a sky by Blender's Cycles (PyPI bpy), on one thread. Usage:

    cycles_passes.py SCENE OUT.npz PASSES SAMPLES

OUT gets `parts` (PASSES x height x width x 3, linear, each of SAMPLES samples a pixel by a seed of its own), `seconds` and `version`.
"""
import math
import os
import sys
import tempfile
import time

import bpy
import mathutils
import numpy as np

import triangles
from peer_scenes import COLORS, DEPTH, INTERFACES, LAMP, MIRROR, OBJECTS, SIZE, camera_of


class Nodes:
    """A material's tree with an output alone."""

    def __init__(self, material):
        self.tree = material.node_tree
        self.tree.nodes.clear()
        self.output = self.tree.nodes.new("ShaderNodeOutputMaterial")

    def add(self, kind, **inputs):
        node = self.tree.nodes.new("ShaderNode" + kind)
        for name, value in inputs.items():
            node.inputs[name].default_value = value
        return node

    def link(self, source, target):
        self.tree.links.new(source, target)


def opaque(color):
    return (*color, 1)


def shining(nodes):
    """From the front alone: the strength is one less `Backfacing`."""
    node = nodes.add("Emission", Color=opaque(LAMP["radiance"]))
    front = nodes.add("Math")
    front.operation = "SUBTRACT"
    front.inputs[0].default_value = 1
    nodes.link(nodes.add("NewGeometry").outputs["Backfacing"], front.inputs[1])
    nodes.link(front.outputs[0], node.inputs["Strength"])
    return node


def interface(nodes, inside, outside, absorbs, absorbs_outside):
    """Absorptions of nested meshes add up, so the inner one has what it absorbs beyond the outer one."""
    if absorbs:
        beyond = np.array(absorbs) - (absorbs_outside or 0)
        density = float(beyond.max())
        volume = nodes.add("VolumeAbsorption", Color=opaque(1 - beyond / density), Density=density)
        nodes.link(volume.outputs[0], nodes.output.inputs["Volume"])
    return nodes.add("BsdfGlass", Color=opaque([1, 1, 1]), Roughness=0, IOR=inside / outside)


def make_material(key):
    material = bpy.data.materials.new(key)
    material.use_nodes = True
    nodes = Nodes(material)
    if key in COLORS:
        node = nodes.add("BsdfDiffuse", Color=opaque(COLORS[key]), Roughness=0)
    elif key == "lamp":
        node = shining(nodes)
        material.cycles.emission_sampling = "FRONT"
    elif key == "mirror":
        node = nodes.add("BsdfAnisotropic", Color=opaque(MIRROR), Roughness=0)
    else:
        node = interface(nodes, *INTERFACES[key])
    nodes.link(node.outputs[0], nodes.output.inputs["Surface"])
    return material


def add_object(mesh, material):
    data = bpy.data.meshes.new("mesh")
    data.from_pydata(mesh.points.tolist(), [], mesh.triangles.tolist(), shade_flat=mesh.normals is None)
    if mesh.normals is not None:
        data.normals_split_custom_set_from_vertices(mesh.normals.tolist())
    data.materials.append(material)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("thing", data))


def add_camera(name):
    view = camera_of(name)
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle, data.clip_start, data.clip_end = "VERTICAL", math.radians(view["fov"]), 0.01, 1000
    back = (mathutils.Vector(view["position"]) - mathutils.Vector(view["target"])).normalized()
    right = mathutils.Vector((0, 1, 0)).cross(back).normalized()
    camera = bpy.data.objects.new("camera", data)
    camera.matrix_world = mathutils.Matrix.Translation(view["position"]) @ mathutils.Matrix((right, back.cross(right), back)).transposed().to_4x4()
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def add_darkness():
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.color = (0, 0, 0)
    for node in world.node_tree.nodes:
        if node.bl_idname == "ShaderNodeBackground":
            node.inputs["Strength"].default_value = 0
    bpy.context.scene.world = world


def set_up(samples):
    """Without what makes Cycles biased: clamping, glossy filters, adaptive samples, the denoiser. The box filter has the width of a pixel. Its usual
    samples are blue noise, by which pixels depend on each other; here they come from tables, an experimental setting. Short passes of tables depend
    too: docs/measurements/path_tracing.md has figures of every pattern. SOBOL_BURLEY puts regions of `cornell` up to 2 % off at 32 samples, alike with every seed."""
    scene, preferences = bpy.context.scene, bpy.context.preferences
    preferences.view.show_developer_ui = preferences.experimental.use_cycles_debug = True
    scene.render.engine = "CYCLES"
    render, cycles = scene.render, scene.cycles
    render.resolution_x = render.resolution_y = SIZE
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", 1
    render.image_settings.file_format, render.image_settings.color_mode, render.image_settings.color_depth = "OPEN_EXR", "RGB", "32"
    render.dither_intensity = 0
    render.use_persistent_data = True
    cycles.device, cycles.samples = "CPU", samples
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_guiding = cycles.use_fast_gi = cycles.use_auto_tile = False
    cycles.pixel_filter_type, cycles.sampling_pattern = "BOX", "TABULATED_SOBOL"
    for kind in ("max", "diffuse", "glossy", "transmission", "volume"):
        setattr(cycles, kind + "_bounces", DEPTH)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = cycles.light_sampling_threshold = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True


def make_scene(name, samples):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    set_up(samples)
    add_camera(name)
    add_darkness()
    things = [(triangles.of_object(kind, numbers), material) for kind, numbers, material in OBJECTS[name]] + [(triangles.lamp(), "lamp")]
    materials = {key: make_material(key) for key in {material for _, material in things}}
    for mesh, material in things:
        add_object(mesh, materials[material])


def read(path):
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Linear Rec.709"
    pixels = np.empty(SIZE * SIZE * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(SIZE, SIZE, 4)[::-1, :, :3]


def render(folder, seed):
    scene = bpy.context.scene
    scene.cycles.seed = seed
    scene.render.filepath = os.path.join(folder, f"{seed}.exr")
    bpy.ops.render.render(write_still=True)
    return read(scene.render.filepath)


def main():
    name, out, passes, samples = sys.argv[1], os.path.abspath(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
    make_scene(name, samples)
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        parts = [render(folder, seed) for seed in range(1, passes + 1)]
    np.savez(out, parts=parts, seconds=time.perf_counter() - start, version=bpy.app.version_string)


main()
