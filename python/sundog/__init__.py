"""sundog: an OpenCL renderer for meshes, solids, glass and fractals.

    import sundog
    film = sundog.render("scenes/spheres.json", devices="cpu", aovs=["depth"])
    film.save("spheres.png")
    pixels = film.image.pixels          # numpy, linear RGBA, without a copy

A scene is a file, a dict like its JSON (docs/reference/scene-reference.md), or a Scene.
"""

import atexit as _atexit
import ctypes as _ctypes
import pathlib as _pathlib

try:
    # The system's OpenCL loader loads the drivers; all modules of a process share it.
    _ctypes.CDLL("libOpenCL.so.1", mode=_ctypes.RTLD_GLOBAL)
except OSError as _error:
    raise ImportError(
        "sundog needs an OpenCL loader and a driver. On Debian or Ubuntu: "
        "apt-get install ocl-icd-libopencl1 pocl-opencl-icd"
    ) from _error

from ._sundog import (  # noqa: E402
    Device,
    Error,
    Film,
    Image,
    Pick,
    Scene,
    Session,
    Snapshot,
    _end,
    choose_devices,
    devices,
    render,
    threads_left_behind,
    version,
    wait_for_threads,
)

_scenes = _pathlib.Path(__file__).parent / "scenes"


def examples() -> list[str]:
    """The names of the scenes that come with the package."""
    return sorted(file.stem for file in _scenes.glob("*.json") if not file.stem.endswith(".schema"))


def example(name: str) -> Scene:
    """A scene that comes with the package, such as "hollow_ice"."""
    if name not in examples():
        raise ValueError(f"sundog.example: {name!r} is none of {', '.join(examples())}")
    return Scene.load(str(_scenes / f"{name}.json"))


def view(scene, parameters=None, devices=None):
    """A live picture of a scene in a notebook: drag to turn it, scroll to come nearer.

    `scene`: a Scene, a file or a dict whose camera has a position and a target. `parameters`: sliders, by JSON
    pointer, with their least and greatest value: {"/objects/0/parameters/power": (2, 12)}. The view has `set()`,
    `scene` (a copy, as shown), `pixels` (numpy, waits for the settled picture) and `close()`. Needs anywidget.
    """
    from ._view import View

    return View(scene, parameters, devices)


_atexit.register(_end)  # while the objects that the drivers' threads use still exist
__version__ = version()
__all__ = [
    "Device",
    "Error",
    "Film",
    "Image",
    "Pick",
    "Scene",
    "Session",
    "Snapshot",
    "choose_devices",
    "devices",
    "example",
    "examples",
    "render",
    "threads_left_behind",
    "version",
    "view",
    "wait_for_threads",
]
