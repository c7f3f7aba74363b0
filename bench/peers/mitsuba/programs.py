"""Renders a scene of peer_scenes.py with sundog or Mitsuba 3. render() returns the picture, linear RGB of
height x width x 3, and its seconds without loading, compilation and upload.
"""
import json
import os
import subprocess
import time

import numpy as np

from peer_scenes import (BARREL_SCALE, COLORS, DEPTH, INTERFACES, LAMP, METAL, METAL_ALPHA, MIRROR, OBJECTS, SIZE, UNDER_SKY, camera_of, make_sky,
                         sky_between_edges, sundog_scene)


def read_pfm(path):
    with open(path, "rb") as file:
        kind, size, scale = file.readline().strip(), file.readline().split(), float(file.readline())
        assert kind == b"PF" and scale < 0
        return np.frombuffer(file.read(), "<f4").reshape(int(size[1]), int(size[0]), 3)[::-1].astype(float)


class Sundog:
    def __init__(self, name, folder, program, device):
        self.name, self.folder, self.program, self.device = name, folder, program, device

    def render(self, sampler, samples, caustics=False):
        scene, out, stats = (os.path.join(self.folder, self.name + end) for end in (".json", ".pfm", ".stats.json"))
        with open(scene, "w") as file:
            json.dump(sundog_scene(self.name, samples, sampler, caustics), file)
        subprocess.run([self.program, "render", scene, "-o", out, "--stats", stats, "--quiet", "--device", self.device], check=True)
        with open(stats) as file:
            return read_pfm(out), json.load(file)["seconds"]["render"]

    def halves(self, total):
        """Two parts of independent samples. sundog's sample i is the same in every picture, so the second
        half is the difference of the whole and the first half."""
        first, whole = (self.render("independent", n)[0] for n in (total // 2, total))
        return [first, 2 * whole - first]


def rgb(color):
    return {"type": "rgb", "value": list(color)}


def absorbing(sigma):
    """An absorbing medium. Mitsuba wants an RGB in 0..1, so the greatest value becomes the scale."""
    return {"type": "homogeneous", "albedo": 0.0, "sigma_t": rgb([v / max(sigma) for v in sigma]), "scale": max(sigma)}


def register_correlated_metal(mi):
    """Registers `correlated_metal`: Mitsuba's roughconductor with height-correlated masking and shadowing
    (Heitz 2014, "Understanding the Masking-Shadowing Function", equation 99) instead of the product of both.
    """
    import drjit as dr

    def smith_lambda(w):
        tangent = dr.maximum(1 - w.z**2, 0) / w.z**2
        return (dr.sqrt(1 + METAL_ALPHA**2 * tangent) - 1) / 2

    def gain(wi, wo):
        i, o = smith_lambda(wi), smith_lambda(wo)
        return dr.select((wi.z > 0) & (wo.z > 0), (1 + i) * (1 + o) / (1 + i + o), 0)

    class CorrelatedMetal(mi.BSDF):
        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            self.metal = mi.load_dict(mitsuba_metal())
            self.m_flags, self.m_components = self.metal.flags(), [self.metal.flags(0)]

        def sample(self, ctx, si, sample1, sample2, active=True):
            drawn, weight = self.metal.sample(ctx, si, sample1, sample2, active)
            return drawn, weight * gain(si.wi, drawn.wo)

        def eval(self, ctx, si, wo, active=True):
            return self.metal.eval(ctx, si, wo, active) * gain(si.wi, wo)

        def pdf(self, ctx, si, wo, active=True):
            return self.metal.pdf(ctx, si, wo, active)

        def eval_pdf(self, ctx, si, wo, active=True):
            value, density = self.metal.eval_pdf(ctx, si, wo, active)
            return value * gain(si.wi, wo), density

        def to_string(self):
            return "CorrelatedMetal[]"

    mi.register_bsdf("correlated_metal", CorrelatedMetal)


def mitsuba_metal():
    return {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": METAL_ALPHA, "specular_reflectance": rgb(METAL)}


def mitsuba_surface(material, folder, same_model):
    if material in COLORS:
        return {"bsdf": {"type": "diffuse", "reflectance": rgb(COLORS[material])}}
    if material == "mirror":
        return {"bsdf": {"type": "conductor", "material": "none", "specular_reflectance": rgb(MIRROR)}}
    if material == "metal":
        return {"bsdf": {"type": "correlated_metal"} if same_model else mitsuba_metal()}
    if material == "barrel":
        texture = {"type": "bitmap", "filename": os.path.join(folder, "diffuse.png"), "filter_type": "bilinear"}
        return {"bsdf": {"type": "diffuse", "reflectance": texture}}
    inside, outside, absorbs, absorbs_outside = INTERFACES[material]
    surface = {"bsdf": {"type": "dielectric", "int_ior": inside, "ext_ior": outside}}
    if absorbs:
        surface["interior"] = absorbing(absorbs)
    if absorbs_outside:
        surface["exterior"] = absorbing(absorbs_outside)
    return surface


def mitsuba_shape(mi, kind, numbers, folder):
    T = mi.ScalarTransform4f
    if kind == "sphere":
        return {"type": "sphere", "center": numbers["center"], "radius": numbers["radius"]}
    if kind == "mesh":
        return {"type": "obj", "filename": os.path.join(folder, numbers["file"]), "face_normals": numbers["flat"], "to_world": T().scale(BARREL_SCALE)}
    low, high = np.array(numbers["min"], float), np.array(numbers["max"], float)
    middle = np.array(numbers.get("center", [0, 0, 0]), float) + (low + high) / 2
    to_world = T().translate(middle.tolist()).rotate([0, 1, 0], numbers.get("turn", 0)).scale(((high - low) / 2).tolist())
    return {"type": "cube", "to_world": to_world}


def mitsuba_camera(mi, name, sampler):
    camera = camera_of(name)
    film = {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}, "pixel_format": "rgb", "component_format": "float32"}
    return {"type": "perspective", "fov": camera["fov"], "fov_axis": "y", "near_clip": 0.01, "far_clip": 1000.0, "film": film,
            "to_world": mi.ScalarTransform4f().look_at(origin=camera["position"], target=camera["target"], up=[0, 1, 0]),
            "sampler": {"type": sampler, "sample_count": 64}}


def mitsuba_sky(mi, folder, same_model):
    """The sky. `same_model`: interpolated as in sundog. Otherwise the file, as users of Mitsuba have it: its
    multijittered samples then have an eighth less noise."""
    picture = {"bitmap": mi.Bitmap(sky_between_edges(make_sky()))} if same_model else {"filename": os.path.join(folder, "sky.hdr")}
    return {"type": "envmap", "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], 180)} | picture


def mitsuba_scene(mi, name, folder, sampler, same_model):
    T = mi.ScalarTransform4f
    # Mitsuba's volpath samples distances by one channel's absorption. Red, of which the liquid absorbs a
    # tenth, then gets rare samples with weights of hundreds, and 512 samples determine neither its mean nor
    # its error.
    scene = {"type": "scene", "integrator": {"type": "volpathmis" if name == "ice" else "path", "max_depth": DEPTH + 1},
             "sensor": mitsuba_camera(mi, name, sampler)}
    if name in UNDER_SKY:
        scene["sky"] = mitsuba_sky(mi, folder, same_model)
    else:
        to_world = T().translate(LAMP["center"]).rotate([1, 0, 0], 90).scale([LAMP["size"][0] / 2, LAMP["size"][1] / 2, 1])
        scene["lamp"] = {"type": "rectangle", "to_world": to_world, "bsdf": {"type": "diffuse", "reflectance": rgb([0, 0, 0])},
                         "emitter": {"type": "area", "radiance": rgb(LAMP["radiance"])}}
    for i, (kind, numbers, material) in enumerate(OBJECTS[name]):
        scene[f"thing{i}"] = mitsuba_shape(mi, kind, numbers, folder) | mitsuba_surface(material, folder, same_model)
    return mi.load_dict(scene)


def load_mitsuba(variant):
    """Loads Mitsuba with one thread."""
    import mitsuba as mi
    mi.set_variant(variant)
    mi.set_log_level(mi.LogLevel.Error)
    import drjit
    drjit.set_thread_count(1)
    register_correlated_metal(mi)
    return mi


class Mitsuba:
    """A scene in Mitsuba. `same_model`: with sundog's models of sky and metal, for means; otherwise with
    Mitsuba's own, for errors and times."""

    def __init__(self, name, folder, mi, same_model):
        self.name, self.folder, self.mi, self.same_model, self.scenes = name, folder, mi, same_model, {}

    def render(self, sampler, samples, seed=0):
        if sampler not in self.scenes:
            self.scenes[sampler] = mitsuba_scene(self.mi, self.name, self.folder, sampler, self.same_model)
        start = time.perf_counter()
        image = np.array(self.mi.render(self.scenes[sampler], spp=samples, seed=seed), float)
        return image, time.perf_counter() - start

    def samples_made(self, sampler):
        """The last render's samples a pixel: `multijitter` rounds them up to a grid."""
        return self.scenes[sampler].sensors()[0].sampler().sample_count()
