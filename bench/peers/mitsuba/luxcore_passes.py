"""One of the scenes without a sky by LuxCore (PyPI pyluxcore), on one thread. Usage:

    luxcore_passes.py SCENE OUT.npz PASSES SAMPLES

OUT gets `parts` (PASSES x height x width x 3, linear, each of SAMPLES independent samples a pixel by a seed of its own), `seconds` and `version`.
"""
import sys
import time

import numpy as np
import pyluxcore

import triangles
from peer_scenes import COLORS, DEPTH, INTERFACES, LAMP, MIRROR, OBJECTS, SIZE, camera_of

POLL = 0.02  # seconds


def properties(pairs):
    text = "".join(f"{key} = {' '.join(map(str, value)) if isinstance(value, (list, tuple)) else value}\n" for key, value in pairs.items())
    return pyluxcore.Properties().SetFromString(text)


def volume(absorption, index):
    """Its name and its properties. Interfaces of one medium share its volume."""
    name = "medium_" + "_".join(str(v) for v in [index] + absorption).replace(".", "p")
    key = f"scene.volumes.{name}."
    return name, {key + "type": "clear", key + "absorption": absorption, key + "ior": index}


def interface(key, inside, outside, absorbs, absorbs_outside):
    found = {key + "type": "glass", key + "kr": [1, 1, 1], key + "kt": [1, 1, 1], key + "interiorior": inside, key + "exteriorior": outside}
    for side, absorption, index in (("interior", absorbs, inside), ("exterior", absorbs_outside, outside)):
        if absorption:
            found[key + "volume." + side], pairs = volume(absorption, index)
            found |= pairs
    return found


def surface(material):
    key = f"scene.materials.{material}."
    if material in COLORS:
        return {key + "type": "matte", key + "kd": COLORS[material]}
    if material == "lamp":  # shines from its front alone
        return {key + "type": "matte", key + "kd": [0, 0, 0], key + "emission": LAMP["radiance"]}
    if material == "mirror":
        return {key + "type": "mirror", key + "kr": MIRROR}
    return interface(key, *INTERFACES[material])


def camera(name):
    view = camera_of(name)
    # A sample of the film's row y is seen through row y + 1: the window moves by a row.
    row = 2 / SIZE
    return {"scene.camera.type": "perspective", "scene.camera.lookat.orig": view["position"], "scene.camera.lookat.target": view["target"],
            "scene.camera.up": [0, 1, 0], "scene.camera.fieldofview": view["fov"], "scene.camera.autofocus.enable": 0,
            "scene.camera.screenwindow": [-1, 1, -1 - row, 1 - row]}


def make_scene(name):
    scene = pyluxcore.Scene()
    scene.Parse(properties(camera(name)))
    things = [(triangles.of_object(kind, numbers), material) for kind, numbers, material in OBJECTS[name]]
    for i, (mesh, material) in enumerate(things + [(triangles.lamp(), "lamp")]):
        points, normals = ([tuple(v) for v in array.tolist()] if array is not None else None for array in (mesh.points, mesh.normals))
        scene.DefineMesh(f"mesh{i}", points, [tuple(t) for t in mesh.triangles.tolist()], normals, None, None, None)
        scene.Parse(properties(surface(material) | {f"scene.objects.thing{i}.shape": f"mesh{i}", f"scene.objects.thing{i}.material": material}))
    return scene


def settings(samples, seed):
    """Without adaptive samples and clamping. Paths end at a depth that is never reached, or by Russian roulette."""
    depths = {f"path.pathdepth.{kind}": DEPTH for kind in ("total", "diffuse", "glossy", "specular")}
    return depths | {
        "renderengine.type": "PATHCPU", "renderengine.seed": seed, "native.threads.count": 1, "batch.haltspp": samples,
        "sampler.type": "RANDOM", "sampler.random.adaptive.strength": 0, "path.clamping.variance.maxvalue": 0,
        "film.width": SIZE, "film.height": SIZE, "film.filter.type": "NONE",
        "film.outputs.0.type": "RGB", "film.outputs.0.filename": "unused.exr"}


def render(scene, samples, seed):
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties(settings(samples, seed)), scene))
    session.Start()
    while not session.HasDone():
        time.sleep(POLL)
        session.UpdateStats()
    session.Stop()
    image = np.empty(SIZE * SIZE * 3, np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, image)
    return image.reshape(SIZE, SIZE, 3)[::-1]


def main():
    name, out, passes, samples = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    pyluxcore.Init()  # with a handler of messages its interpreter may crash at the end
    scene = make_scene(name)
    start = time.perf_counter()
    parts = [render(scene, samples, seed) for seed in range(1, passes + 1)]
    np.savez(out, parts=parts, seconds=time.perf_counter() - start, version=pyluxcore.Version())


main()
