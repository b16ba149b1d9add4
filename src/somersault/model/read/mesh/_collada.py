"""COLLADA (.dae), by pycollada: the surfaces of its scene, each with the colour of its material.

Lengths are in the unit that the file names. Which axis it says is up does not matter, as it does
not to RViz, Gazebo and pinocchio, for which robots' files are written: a mesh stands in the axes in
which its numbers are. MeshLab writes Y_UP whatever these are, so heeding it would turn more robots
wrong (Go1, Borinot) than right.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from io import BytesIO
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.model.read.mesh._part import Part, fans, xml
from somersault.model.shapes import Color

_MOST_NODES = 20_000  # of a scene, in which one node may stand many times
_MATERIALS = re.compile(r"<bind_material.*?</bind_material>", re.DOTALL)
_DECLARATION = re.compile(r"\A<\?xml[^>]*\?>")


def parts(data: bytes) -> Iterator[Part]:
    """The surfaces of a file, in m."""
    from collada import Collada
    from collada.common import DaeError

    # Bounds, and no entities; and then it is only text, which pycollada would take for a zip.
    text = _DECLARATION.sub("", xml(data)[1])
    try:
        file = Collada(BytesIO(text.encode()), ignore=[DaeError])
        if file.errors:  # an object without its material would be lost
            file = Collada(BytesIO(_MATERIALS.sub("", text).encode()), ignore=[DaeError])
    except (DaeError, AttributeError, TypeError, SyntaxError):
        raise ValueError("it is no scene") from None
    unit = file.assetInfo.unitmeter
    scale = np.diag([*3 * [1.0 if unit is None else float(unit)], 1.0])
    budget = [_MOST_NODES]
    for node in [] if file.scene is None else file.scene.nodes:
        yield from _below(node, scale, budget)


def _below(node: Any, frame: Array, budget: list[int]) -> Iterator[Part]:
    """The surfaces of a node that stands in a frame (4, 4), and of those under it."""
    budget[0] -= 1
    if budget[0] < 0:
        raise SomersaultError(f"has more than {_MOST_NODES} parts")
    geometry = getattr(node, "geometry", None)
    if geometry is not None:
        colors = {link.symbol: _color(link.target) for link in node.materials}
        for primitive in geometry.primitives:
            yield from _surface(primitive, frame, colors)
    elif getattr(node, "children", None) is not None:
        for child in node.children:
            yield from _below(child, frame @ node.matrix, budget)


def _surface(primitive: Any, frame: Array, colors: dict[str, Color | None]) -> Iterator[Part]:
    corners = getattr(primitive, "vertex_index", None)
    if corners is None or primitive.vertex is None:
        return
    sizes = getattr(primitive, "vcounts", None)  # of polygons, where they are no triangles
    if sizes is not None:
        corners = fans(corners.reshape(-1), sizes)
    elif corners.ndim != 2 or corners.shape[1] != 3:  # lines
        return
    vertices = primitive.vertex @ frame[:3, :3].T + frame[:3, 3]
    if np.linalg.det(frame[:3, :3]) < 0:
        corners = corners[:, ::-1]
    yield Part(vertices, corners, colors.get(primitive.material))


def _color(material: Any) -> Color | None:
    """Of a material that has one, and no picture instead."""
    diffuse = getattr(material.effect, "diffuse", None)
    if not isinstance(diffuse, tuple) or len(diffuse) < 3:
        return None
    red, green, blue = (min(max(float(x), 0.0), 1.0) for x in diffuse[:3])
    return red, green, blue, 1.0
