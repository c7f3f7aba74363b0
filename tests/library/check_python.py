"""The Python package, as installed by pip: check_python.py SCENE [DEVICE]. Ends with an exception where something is wrong."""

import copy
import faulthandler
import os
import pathlib
import pickle
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np
import sundog

device = sys.argv[2] if len(sys.argv) > 2 else None
faulthandler.dump_traceback_later(300, exit=True)  # something waits for the interpreter's lock


def error_of(call):
    try:
        call()
    except sundog.Error as error:
        return error
    raise AssertionError("no error was raised")


def small():
    scene = sundog.Scene({
        "image": {"width": 32, "height": 24, "background": [0.25, 0.5, 1]},
        "camera": {"position": [0, 0, 5], "target": [0, 0, 0]},
        "lights": [{"type": "ambient"}],
        "materials": {"red": {"color": np.array([1.0, 0, 0]), "ambient": 1, "diffuse": 0}},
        "objects": [],
    })
    corners = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]])  # doubles: they are converted
    scene.add_mesh("triangle", corners, np.array([[0, 1, 2]]))
    scene.add({"type": "mesh", "mesh": "triangle", "material": "red", "name": "the triangle"})
    return scene


def long():
    scene = small()
    scene["/image/width"] = scene["/image/height"] = 1024
    scene["/render/samples"] = 65536
    return scene


# Pictures: numpy sees the library's own memory, which outlives the film.
calls = []
film = sundog.render(small(), devices=device, aovs=["depth"], work_group=(8, 1), on_progress=lambda *now: calls.append(now))
assert film.complete and calls[-1][0] == 32 * 24, calls
pixels, depth = film.image.pixels, film.aov("depth").pixels
assert pixels.shape == (24, 32, 4) and pixels.dtype == np.float32 and not pixels.flags.writeable
assert np.shares_memory(pixels, film.image.pixels) and np.shares_memory(np.asarray(film.image), pixels)
assert depth.shape == (24, 32) and abs(depth[12, 16] - 5) < 1e-5
assert film.figures["primary"] == 32 * 24 and film.figures["devices"][0]["share"] == 1
assert film._repr_png_().startswith(b"\x89PNG") and film.image._repr_png_().startswith(b"\x89PNG")
del film
assert np.allclose(pixels[12, 16, :3], [1, 0, 0], atol=1e-6) and pixels[0, 0, 2] == 1
assert np.array_equal(sundog.Image(pixels).pixels, pixels)

# Arrays of the right type are held where they are.
corners, faces = np.zeros((3, 3), np.float32), np.array([[0, 1, 2]], np.uint32)
corners[1, 0] = corners[2, 1] = 1
before = sys.getrefcount(corners), sys.getrefcount(faces)
scene = small()
scene.add_mesh("held", corners, faces)
assert sys.getrefcount(corners) > before[0] and sys.getrefcount(faces) > before[1]
scene.add({"type": "mesh", "mesh": "held", "material": "red"})
sundog.render(scene, devices=device)
del scene
assert (sys.getrefcount(corners), sys.getrefcount(faces)) == before

# A file and a dict are scenes too, and have the same picture.
loaded = sundog.Scene(sys.argv[1])
loaded["/image/width"], loaded["/image/height"] = 40, 30
first = sundog.render(loaded, devices=device).image.pixels
document = loaded.to_dict()
assert np.array_equal(sundog.render(document, devices=device).image.pixels, first)
other = copy.copy(loaded)
other["/image/width"] = 20
assert loaded["/image/width"] == 40 and "/image/width" in other
del other["/image/width"]
assert "/image/width" not in other
other["/image/width"] = None
assert other["/image/width"] is None

# Images and scenes travel between processes, a scene with its meshes and the folder of its files.
travelled = lambda value: pickle.loads(pickle.dumps(value))
assert np.array_equal(travelled(sundog.Image(pixels)).pixels, pixels)
assert np.array_equal(travelled(sundog.Image(pixels[:, :, 0])).pixels, pixels[:, :, 0])
assert travelled(sundog.Session(device).snapshot().image).width == 0
sent, one = small(), np.array([[0, 0, 1.0]] * 3)
sent.add_mesh("shaded", corners, faces, normals=one, uvs=one[:, :2], colors=one)
sent.add({"type": "mesh", "mesh": "shaded", "material": "red"})
of_sent = sundog.render(sent, devices=device).image.pixels
for copied in (travelled(sent), travelled(sundog.Scene(copy.copy(sent)))):
    assert np.array_equal(sundog.render(copied, devices=device).image.pixels, of_sent)
with tempfile.TemporaryDirectory() as folder:
    pathlib.Path(folder, "one.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    moved = '{"value": "/image/width", "type": "step", "keys": [{"frame": 0, "value": 9}]}'
    document = f'{{"objects": [{{"type": "model", "file": "one.obj"}}], "animate": [{moved}]}}'
    pathlib.Path(folder, "scene.json").write_text(document)
    at_frame = travelled(sundog.Scene.load(pathlib.Path(folder, "scene.json"), frame=3))
    assert sundog.render(at_frame, devices=device).width == 9
del sent, copied  # which hold the arrays

# Errors have facts.
error = error_of(lambda: sundog.Scene({"objects": [{"type": "sphre"}]}).check())
assert error.kind == "scene" and error.place == "/objects/0/type" and error.reason in str(error)
assert error_of(lambda: sundog.render("/none/such.json")).file == "/none/such.json"
assert error_of(lambda: sundog.choose_devices("no such device")).kind == "device"
assert error_of(lambda: sundog.render(small(), aovs=["colour"])).kind == "usage"
assert error_of(lambda: small().add_mesh("m", np.zeros((2, 3)), np.array([[0, 1, 2]]))).kind == "usage"
for bad in (lambda: sundog.Scene({"objects": object()}), lambda: small().add_mesh("m", np.zeros((2, 2)), np.zeros((1, 3)))):
    try:
        bad()
        raise AssertionError("no TypeError")
    except TypeError:
        pass

# A file's name is text, bytes or a Path, also where its bytes are no UTF-8.
with tempfile.TemporaryDirectory() as folder:
    picture = pathlib.Path(folder) / "picture.png"
    sundog.render(pathlib.Path(sys.argv[1]), devices=device, time_limit=0.1).save(picture)
    sundog.Image.load(picture).save(os.fsencode(picture))
    model = pathlib.Path(folder, os.fsdecode(b"caf\xe9.obj"))
    model.write_bytes(b"mtllib caf\xe9.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    scene = sundog.Scene.load(model)
    assert any("caf\udce9.mtl" in warning for warning in scene.check()), scene.check()
    scene["/image/width"] = scene["/image/height"] = 8
    assert any("caf\udce9.mtl" in warning for warning in sundog.render(scene, devices=device).warnings)
    model.unlink()
    assert error_of(lambda: sundog.Scene(bytes(model))).file == str(model)

# Other threads run while a frame is rendered; a callback stops it, and its exceptions come out.
turns = 0
running = True


def turn():
    global turns
    while running:
        turns += 1
        time.sleep(0.005)


other_thread = threading.Thread(target=turn)
other_thread.start()
begun = time.monotonic()
stopped = sundog.render(long(), devices=device, on_progress=lambda *now: time.monotonic() - begun < 0.3)
running = False
other_thread.join()
assert not stopped.complete and turns > 20, turns
try:
    sundog.render(long(), devices=device, on_progress=lambda *now: 1 / 0)
    raise AssertionError("no ZeroDivisionError")
except ZeroDivisionError:
    pass

# Ctrl-C ends a render, and a wait for a session.
session = sundog.Session(device)
for wait in (lambda: sundog.render(long(), devices=device), lambda: session.start(long()) and session.finish()):
    threading.Timer(0.4, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    try:
        wait()
        raise AssertionError("no KeyboardInterrupt")
    except KeyboardInterrupt:
        assert time.monotonic() - begun < 20

# A session draws what render() draws.
session.start(small())
assert session.wait(60) and session.snapshot().state == "settled"
assert np.array_equal(session.finish().pixels, pixels)
assert session.pick(16, 12).object == "the triangle"
assert error_of(lambda: session.start({"objects": 3})).kind == "scene"
for wrong in ([3], [None], b"cpu"):
    try:
        sundog.render(small(), devices=wrong)
        raise AssertionError("no TypeError")
    except TypeError as error:
        assert "wanted a sundog.Device" in str(error)


# The arrays of an animation are let go of by the session's threads, also while the session ends.
def animate(session):
    scene, points, triangle = small(), corners, faces
    scene.add({"type": "mesh", "mesh": "held", "material": "red"})
    for frame in range(5):
        scene.add_mesh("held", points + np.float32(0.1 * frame), triangle)
        session.start(scene)
        session.finish()


session = sundog.Session(device)
animate(session)
session = sundog.Session(device)
animate(session)
session.use_devices(device)
session.use_devices(None)
del session
for _ in range(100):  # the interpreter frees them when it comes to it
    time.sleep(0.01)
assert (sys.getrefcount(corners), sys.getrefcount(faces)) == before


# Ctrl-C and a time limit do not wait for a compiler, whatever is rendered.
def new_formula():
    size = 1 + random.random()
    return {
        "image": {"width": 32, "height": 24}, "lights": [{"type": "ambient"}], "materials": {"m": {}},
        "objects": [{"type": "formula", "distance": f"length(p) - {size:.9f}", "material": "m"}],
    }


threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
begun = time.monotonic()
try:
    sundog.render(new_formula())
except KeyboardInterrupt:
    assert time.monotonic() - begun < 1, time.monotonic() - begun
begun = time.monotonic()
if not sundog.render(new_formula(), time_limit=0.1).complete:
    assert time.monotonic() - begun < 1, time.monotonic() - begun

# After fork() the error says to spawn.
child = os.fork()
if child == 0:
    message = str(error_of(lambda: sundog.render(small())))
    os._exit(0 if "spawn" in message else 1)
assert os.waitpid(child, 0)[1] == 0

# A thread that renders for ever ends with the interpreter, which a signal would end otherwise.
endless = """
import sundog, sys, threading
begun = threading.Event()
scene = {"image": {"width": 1024, "height": 1024}, "render": {"samples": 65536}, "objects": []}
options = {"devices": sys.argv[1] or None, "on_progress": lambda *now: begun.set()}
threading.Thread(target=sundog.render, args=(scene,), kwargs=options, daemon=True).start()
begun.wait()
"""
subprocess.run([sys.executable, "-c", endless, device or ""], check=True, timeout=60)
# So does one that writes an image, or waits for changes.
for busy in ("film.save(sys.argv[1])", "session.wait_for_change(session.snapshot(False).revision, 0.01)"):
    program = f"""
import sundog, sys, threading
film = sundog.render({{"objects": [], "image": {{"width": 1500, "height": 1000}}}}, devices=sys.argv[2] or None)
session, begun = sundog.Session(sys.argv[2] or None), threading.Event()
def work():
    while True:
        begun.set()
        {busy}
threading.Thread(target=work, daemon=True).start()
begun.wait()
"""
    subprocess.run([sys.executable, "-c", program, "busy.exr", device or ""], check=True, timeout=60)

# Scenes of the package, and a live view of one, as its page would move it.
assert "hollow_ice" in sundog.examples()
for wrong in (lambda: sundog.example("no_such"), lambda: sundog.view({"objects": []})):
    try:
        wrong()
        raise AssertionError("no error was raised")
    except ValueError as error:
        assert "no_such" in str(error) or "target" in str(error)
scene = sundog.example("menger")
scene["/image/width"], scene["/image/height"], scene["/render/samples"] = 64, 48, 1
view = sundog.view(scene, {"/camera/fov": (20, 60)}, devices=device)
assert view.parameters["/camera/fov"]["least"] == 20 and (view.width, view.height) == (64, 48)
before, target = view.pixels, np.array(scene["/camera/target"])
assert before.shape == (48, 64, 4)
view.hear({"turn": [0.4, 0.1], "nearer": 2, "set": {"/camera/fov": 30}})
assert not np.array_equal(view.pixels, before)
old, new = np.array(scene["/camera/position"]) - target, np.array(view.scene["/camera/position"]) - target
assert abs(np.linalg.norm(new) * 2 - np.linalg.norm(old)) < 1e-9 and view.scene["/camera/fov"] == 30
flat = lambda way: np.array([way[0], way[2]]) / np.hypot(way[0], way[2])
assert abs(np.arccos(flat(old) @ flat(new)) - 0.4) < 1e-9
view.hear({"turn": [0, 9]})  # no farther than above
assert np.isfinite(view.scene["/camera/position"]).all()
sent = []
view.send = lambda message, buffers: sent.append((message, buffers))
view.set("/camera/fov", 50)
deadline = time.monotonic() + 60
while not any(buffers for _, buffers in sent) and time.monotonic() < deadline:
    time.sleep(0.01)
assert sent and bytes(sent[-1][1][0]).startswith(b"\x89PNG"), sent
assert "fov" in error_of(lambda: view.set("/camera/fov", 500)).place
view._heard(view, {"set": {"/camera/fov": 500}}, [])  # the page shows the error, and the scene before
assert any("fov" in message["text"] for message, _ in sent) and view.scene["/camera/fov"] == 50
view.close()

print("the package works")
