"""sundog: an OpenCL renderer for meshes, solids, glass and fractals.

    import sundog
    film = sundog.render("scenes/spheres.json", devices="cpu", aovs=["depth"])
    film.save("spheres.png")
    pixels = film.image.pixels          # numpy, linear RGBA, without a copy

A scene is a file, a dict like its JSON (docs/reference/scene-reference.md), or a Scene.
"""

import atexit as _atexit
import ctypes as _ctypes

try:
    # Drivers are loaded by the system's own loader, which all modules of a process share.
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
    choose_devices,
    devices,
    render,
    threads_left_behind,
    version,
    wait_for_threads,
)

_atexit.register(wait_for_threads)  # while what the drivers' threads use is still there
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
    "render",
    "threads_left_behind",
    "version",
    "wait_for_threads",
]
