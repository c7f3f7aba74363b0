"""Shows a scene in a notebook: a picture that can be turned, with sliders. Needs anywidget (`pip install anywidget`)."""

import math
import pathlib
import threading
import weakref

import anywidget
import numpy as np
import traitlets

from ._sundog import Error, Scene, Session

_steepest = math.radians(89)  # greatest elevation of the camera above the target


def _turned(camera, across, up, nearer):
    """The camera's position after a turn about its target by these angles; `nearer` divides the distance."""
    target, axis = np.array(camera["target"], float), np.array(camera.get("up", [0, 1, 0]), float)
    axis /= np.linalg.norm(axis)
    way = np.array(camera["position"], float) - target
    distance, height = np.linalg.norm(way), way @ axis
    flat = way - height * axis
    side = np.cross(axis, flat)
    flat = math.cos(across) * flat + math.sin(across) * side
    elevation = math.asin(max(-1.0, min(1.0, height / distance))) + up
    elevation = max(-_steepest, min(_steepest, elevation))
    length = np.linalg.norm(flat)
    if length < 1e-9 * distance:  # straight above the target: any direction will do
        flat = np.cross(axis, [1, 0, 0] if abs(axis[0]) < 0.9 else [0, 1, 0])
        length = np.linalg.norm(flat)
    new = math.cos(elevation) * flat / length + math.sin(elevation) * axis
    return (target + distance / nearer * new).tolist()


def _send_pictures(reference, session):
    """Sends each new picture until the view is closed or gone, or the program ends."""
    revision = 0
    while True:
        session.wait_for_change(revision, 0.5)
        view = reference()
        if view is None or view._closed.is_set() or not threading.main_thread().is_alive():
            return
        snapshot = session.snapshot()
        if snapshot.revision != revision:
            revision = snapshot.revision
            view._show(snapshot)
        del view


class View(anywidget.AnyWidget):
    """The widget that sundog.view() returns, over a session in this process."""

    _esm = pathlib.Path(__file__).parent / "view.js"
    width = traitlets.Int().tag(sync=True)
    height = traitlets.Int().tag(sync=True)
    parameters = traitlets.Dict().tag(sync=True)

    def __init__(self, scene, parameters=None, devices=None):
        self._lock, self._closed = threading.Lock(), threading.Event()
        self._session = None  # for close(), if an error follows
        self._scene = scene.copy() if isinstance(scene, Scene) else Scene(scene)
        if "/camera/position" not in self._scene or "/camera/target" not in self._scene:
            raise ValueError("sundog.view: the scene's camera wants a position and a target to be turned about")
        self._session = Session(devices)
        size = [self._scene[f"/image/{side}"] if f"/image/{side}" in self._scene else usual
                for side, usual in (("width", 640), ("height", 480))]
        sliders = {name: {"least": low, "most": high, "value": float(self._scene[name])}
                   for name, (low, high) in (parameters or {}).items()}
        super().__init__(width=size[0], height=size[1], parameters=sliders)
        self.on_msg(self._heard)
        self._session.start(self._scene)
        # Not a daemon thread: the interpreter would kill it inside the session.
        threading.Thread(target=_send_pictures, args=(weakref.ref(self), self._session)).start()

    @property
    def scene(self):
        """A copy of the scene as it is shown."""
        with self._lock:
            return self._scene.copy()

    @property
    def pixels(self):
        """Waits for the settled picture: (height, width, 4) linear floats."""
        return self._session.finish().pixels

    def set(self, pointer, value):
        """Changes a value of the scene, as the sliders do."""
        self.hear({"set": {pointer: value}})

    def hear(self, message):
        """Handles a message from the page: "set": {pointer: value}, "turn": [radians across, up], "nearer": ratio."""
        across, up = message.get("turn", (0, 0))
        with self._lock:
            scene = self._scene.copy()
            for pointer, value in message.get("set", {}).items():
                scene[pointer] = value
            if "turn" in message or "nearer" in message:
                scene["/camera/position"] = _turned(scene["/camera"], across, up, message.get("nearer", 1))
            self._session.start(scene)
            self._scene = scene

    def _heard(self, _, message, buffers):
        try:
            self.hear(message)
        except (Error, ValueError) as error:  # the page shows it
            self.send({"text": str(error)}, buffers=[])

    def close(self):
        self._closed.set()
        if self._session:
            self._session.cancel()
        super().close()

    def _show(self, snapshot):
        image = snapshot.image
        if snapshot.error:
            self.send({"text": snapshot.error}, buffers=[])
        elif image.width > 0:  # a picture exists
            text = f"{snapshot.samples} samples a pixel, {snapshot.seconds:.2f} s"
            self.send({"text": text}, buffers=[image._repr_png_()])
