"""Callers' code that a checker of types must accept: mypy --strict typed_python.py."""

import numpy as np
import sundog

scene = sundog.example(sundog.examples()[0])
scene.add_mesh("doubles", np.zeros((3, 3)), np.array([[0, 1, 2]]), normals=None, uvs=np.zeros((3, 2)))
scene.add_mesh("held", np.zeros((3, 3), np.float32), np.zeros((1, 3), np.uint32))
image = sundog.Image(np.zeros((2, 2, 4)))
brighter = image.pixels * 2
try:
    scene.check()
except sundog.Error as error:
    text: str = error.kind + error.file + error.place + error.reason + error.log
    number: int = error.status
