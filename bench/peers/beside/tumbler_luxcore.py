#!/usr/bin/env python3
"""tumbler_luxcore.py OUT.npy SECONDS [KEY=VALUE...]: tumbler.json by LuxCore (pip install pyluxcore), so many processor seconds."""
import array, math, resource, sys, time
import numpy as np
import pyluxcore

WIDTH, HEIGHT, TURNS = 960, 720, 512


def rounded(points, steps=12):
    """A profile of (radius, height, rounding) as a line, each rounding an arc."""
    line = []
    for i, (x, y, *r) in enumerate(points):
        p = np.array([x, y], float)
        if not r:
            line.append(p)
            continue
        a, b = (np.array(points[j][:2], float) - p for j in (i - 1, i + 1))
        a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
        half = math.acos(np.dot(a, b)) / 2
        turn, middle = math.pi - 2 * half, p + (a + b) / np.linalg.norm(a + b) * r[0] / math.sin(half)
        start, end = (p + d * r[0] / math.tan(half) - middle for d in (a, b))
        line += [middle + (math.sin((1 - t) * turn) * start + math.sin(t * turn) * end) / math.sin(turn) for t in np.linspace(0, 1, steps)]
    return np.array(line)


def lathe(scene, name, points, lift=0.002):
    line, angles = rounded(points), np.linspace(0, 2 * math.pi, TURNS, endpoint=False)
    along, around = np.gradient(line, axis=0), list(zip(np.cos(angles), np.sin(angles)))
    out = np.stack([along[:, 1], -along[:, 0]], 1) / np.linalg.norm(along, axis=1, keepdims=True)
    ring = lambda pairs, up: [(float(r * x), float(y + up), float(r * z)) for r, y in pairs for x, z in around]
    corners = [(i * TURNS + k, i * TURNS + (k + 1) % TURNS) for i in range(len(line) - 1) for k in range(TURNS)]
    faces = [face for a, b in corners for face in ((a, a + TURNS, b + TURNS), (a, b + TURNS, b))]
    scene.DefineMesh(name, ring(line, lift), faces, ring(out, 0), None, None, None)


def properties(pairs):
    result = pyluxcore.Properties()
    for key, value in pairs.items():
        result.Set(pyluxcore.Property(key, list(value) if isinstance(value, tuple) else value))
    return result


pyluxcore.Init()
scene = pyluxcore.Scene()
lathe(scene, "glass", [(0, 0), (0.32, 0, 0.03), (0.37, 1.3, 0.01), (0.348, 1.303, 0.01), (0.31, 0.16, 0.06), (0, 0.12)])
lathe(scene, "water", [(0, 0.105), (0.32, 0.145, 0.06), (0.345, 0.919, 0.001), (0, 0.92)])
scene.DefineMesh("table", [(x * 30.0, 0.0, z * 30.0) for x, z in ((-1, -1), (1, -1), (1, 1), (-1, 1))], [(0, 2, 1), (0, 3, 2)], None, None, None, None)
middle, front = np.array([-3.6, 3.4, 3.2]), np.array([3.6, -2.7, -3.2]) / np.linalg.norm([3.6, -2.7, -3.2])
side = np.cross(front, [0, 1, 0]) / np.linalg.norm(np.cross(front, [0, 1, 0]))
panel = [tuple(map(float, middle + x * 0.8 * side + y * np.cross(side, front))) for x, y in ((-1, -1), (-1, 1), (1, 1), (1, -1))]
scene.DefineMesh("panel", panel, [(0, 1, 2), (0, 2, 3)], None, None, None, None)
setup = {"camera.type": "perspective", "camera.lookat.orig": (0.62, 2.75, 5.9), "camera.lookat.target": (0.05, 0.45, 0.25),
         "camera.up": (0.0, 1.0, 0.0), "camera.fieldofview": 22.0, "camera.autofocus.enable": 0,
         "camera.screenwindow": (-WIDTH / HEIGHT, WIDTH / HEIGHT, -1.0, 1.0),
         "lights.sky.type": "constantinfinite", "lights.sky.color": (0.12, 0.15, 0.18),
         "lights.lamp.type": "spot", "lights.lamp.position": (-3.2, 7.3, -5.6), "lights.lamp.target": (0.05, 0.3, 0.25),
         "lights.lamp.coneangle": 26.0, "lights.lamp.conedeltaangle": 6.0, "lights.lamp.gain": (220 * math.pi, 191.4 * math.pi, 154 * math.pi),
         "materials.table.type": "matte", "materials.table.kd": (0.30, 0.19, 0.11),
         "materials.panel.type": "matte", "materials.panel.kd": (0.0, 0.0, 0.0), "materials.panel.emission": (1.36, 1.488, 1.6)}
for name, ior, absorption, priority in (("glass", 1.5, (0.06, 0.02, 0.04), 30), ("water", 1.333, (0.03, 0.008, 0.005), 10)):
    setup.update({f"volumes.in_{name}.type": "clear", f"volumes.in_{name}.absorption": absorption, f"volumes.in_{name}.ior": ior,
                  f"volumes.in_{name}.priority": priority, f"materials.{name}.type": "glass", f"materials.{name}.kr": (1.0, 1.0, 1.0),
                  f"materials.{name}.kt": (1.0, 1.0, 1.0), f"materials.{name}.volume.interior": "in_" + name})
for name in ("table", "panel", "glass", "water"):
    setup.update({f"objects.{name}.shape": name, f"objects.{name}.material": name})
scene.Parse(properties({"scene." + key: value for key, value in setup.items()}))
config = properties({"renderengine.type": "PATHCPU", "film.width": WIDTH, "film.height": HEIGHT, "native.threads.count": 2,
                     **{key: 24 for key in ("path.pathdepth.total", "path.pathdepth.diffuse", "path.pathdepth.specular", "path.photongi.photon.maxdepth")},
                     "film.imagepipelines.0.0.type": "INTEL_OIDN", "film.imagepipelines.0.0.sharpness": 0.0,
                     "film.outputs.0.type": "ALBEDO", "film.outputs.0.filename": "albedo.exr",
                     "film.outputs.1.type": "SHADING_NORMAL", "film.outputs.1.filename": "normal.exr"})
for pair in sys.argv[3:]:
    config.SetFromString(pair)
session = pyluxcore.RenderSession(pyluxcore.RenderConfig(config, scene))
session.Start()
while time.sleep(0.2) is None and sum(resource.getrusage(resource.RUSAGE_SELF)[:2]) < float(sys.argv[2]):
    session.UpdateStats()
print(session.GetStats().Get("stats.renderengine.pass").GetInt(), "samples a pixel")
session.Stop()
pixels = array.array("f", [0.0]) * (WIDTH * HEIGHT * 3)
session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB_IMAGEPIPELINE, pixels)
np.save(sys.argv[1], np.frombuffer(pixels, np.float32).reshape(HEIGHT, WIDTH, 3)[::-1])
