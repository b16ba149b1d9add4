"""What the bodies of a `.osim` file look like.

Since version 4 geometry is attached to bodies and to frames on them. Before, a body had a
VisibleObject with files, whose scales and places are joined as OpenSim joins them when it converts
such a file (opensim-org/opensim-core, OpenSim/Simulation/Model/PhysicalFrame.cpp).
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.model._vectors import as_matrix, as_vector
from somersault.model.read._drawn import Drawn
from somersault.model.read._osim_joints import frame
from somersault.model.read._osim_parts import Frames, components
from somersault.model.read._osim_words import Words
from somersault.model.read._xml import Element
from somersault.model.shapes import Box, Color, Cylinder, Ellipsoid, Mesh, Shape, Sphere, loft

_FOLDER = "Geometry"  # beside a model, and where OpenSim is installed
_NO_SURFACE = {"FrameGeometry", "LineGeometry", "Arrow", "PointGeometry", "PathGeometry"}
_TURNED = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # its axis 3 is along y


def geometry_folders(path: Path) -> list[Path]:
    """Where OpenSim looks for geometry that is not beside the model."""
    home = os.environ.get("OPENSIM_HOME", "")
    return [path.parent / _FOLDER, *([Path(home) / _FOLDER] if home else [])]


def body_shapes(words: Words, model: Element, frames: Frames, drawn: Drawn) -> Drawn:
    """The shapes of all bodies."""
    reader = _Reader(words, drawn)
    for element, path in components(model, ""):
        for tag in ("attached_geometry", "geometry"):
            for geometry in element.below(tag):
                body = _owner(frames, path, element)
                drawn.add(body, partial(reader.attached, geometry, frames, path, element))
        for visible in element.all("VisibleObject"):
            name = element.attributes.get("name", "")
            for part in visible.below("GeometrySet", "objects"):
                drawn.add(name, partial(reader.displayed, part, visible))
            for file in words.text(visible, "geometry_files").split():
                drawn.add(name, partial(reader.old, file, visible))
    return drawn


def _owner(frames: Frames, path: str, element: Element) -> str:
    """The body that a frame is fixed to; none where that makes no sense, which is said later."""
    try:
        return frames.find(path, path, element)[0]
    except SomersaultError:
        return ""


class _Reader:
    """Shapes in the axes of their bodies."""

    def __init__(self, words: Words, drawn: Drawn) -> None:
        self._words = words
        self._drawn = drawn
        self._makers: dict[str, Callable[[Element], Shape]] = {
            "Sphere": lambda e: Sphere(radius=words.number(e, "radius", 1.0)),
            "Ellipsoid": lambda e: Ellipsoid(semi_axes=self._vector(e, "radii", (0.5, 1.0, 2.0))),
            "Brick": lambda e: Box(half_sizes=self._vector(e, "half_lengths", (0.5, 0.5, 0.5))),
            "Cylinder": self._cylinder,
            "Cone": self._cone,
        }

    def attached(
        self, geometry: Element, frames: Frames, path: str, owner: Element
    ) -> Shape | None:
        """A geometry of a body or a frame at a path."""
        appearance = self._words.child(geometry, "Appearance")
        looks = geometry if appearance is None else appearance
        if geometry.tag in _NO_SURFACE or self._hidden(looks):
            return None
        _, place = frames.find(path, path, owner)
        scale = self._vector(geometry, "scale_factors", (1.0, 1.0, 1.0))
        color = self._color(looks)
        if geometry.tag == "Mesh":
            return self._file(self._words.text(geometry, "mesh_file"), scale, place, color)
        if geometry.tag not in self._makers:
            raise self._words.error("is of a kind that is not drawn", geometry)
        solid = _stretched(self._makers[geometry.tag](geometry), scale, color)
        return solid.placed(place[:3, 3], place[:3, :3])

    def displayed(self, part: Element, visible: Element) -> Shape | None:
        """A DisplayGeometry of a VisibleObject."""
        if self._hidden(part):
            return None
        scale = np.multiply(
            *(self._vector(e, "scale_factors", (1.0,) * 3) for e in (part, visible))
        )
        file = self._words.text(part, "geometry_file")
        place = self._place(visible) @ self._place(part)
        return self._file(file, as_vector(scale), place, self._color(part))

    def old(self, file: str, visible: Element) -> Shape:
        """A file of a VisibleObject of OpenSim 2.0, which places nothing."""
        return self._file(file, self._vector(visible, "scale_factors", (1.0,) * 3), np.eye(4), None)

    def _file(self, name: str, scale: Any, place: Array, color: Color | None) -> Shape:
        return self._drawn.file(
            name,
            form=as_matrix(np.diag(scale)),
            position=as_vector(place[:3, 3]),
            rotation=as_matrix(place[:3, :3]),
            color=color,
        )

    def _place(self, element: Element) -> Array:
        numbers = self._words.numbers(element, "transform", (0.0,) * 6, 6)
        return frame(numbers[3:], numbers[:3])

    def _vector(self, element: Element, name: str, default: Any) -> Any:
        return tuple(self._words.numbers(element, name, default, 3))

    def _hidden(self, looks: Element) -> bool:
        """Whether it is not to be seen, or only its points are."""
        words = self._words
        surface = words.child(looks, "SurfaceProperties")
        shown = words.number(surface or looks, "representation", 3.0)
        shown = words.number(looks, "display_preference", shown)
        opacity = words.number(looks, "opacity", 1.0)
        return words.text(looks, "visible", "true").lower() == "false" or opacity == 0 or shown == 0

    def _color(self, looks: Element) -> Color | None:
        if self._words.child(looks, "color") is None:
            return None
        red, green, blue = (
            min(max(x, 0.0), 1.0) for x in self._words.numbers(looks, "color", count=3)
        )
        return red, green, blue, min(max(self._words.number(looks, "opacity", 1.0), 0.0), 1.0)

    def _cylinder(self, element: Element) -> Shape:
        return Cylinder(
            radius=self._words.number(element, "radius", 1.0),
            half_length=self._words.number(element, "half_height", 0.5),
            rotation=as_matrix(_TURNED),
        )

    def _cone(self, element: Element) -> Shape:
        """From the middle of its base towards its tip."""
        words = self._words
        along = np.array(self._vector(element, "direction", (1.0, 1.0, 1.0)))
        length = float(np.linalg.norm(along))
        if length == 0:
            raise words.error("has no direction", element)
        along /= length
        one = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
        one /= np.linalg.norm(one)
        turn = np.stack([one, np.cross(along, one), along], -1)
        radius, height = (
            words.number(element, "base_radius", 1.0),
            words.number(element, "height", 1.0),
        )
        angle = np.linspace(0, 2 * np.pi, 25)[:-1]
        ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(24)], -1)
        tip = np.array([0.0, 0.0, height])
        return loft(
            [radius * ring, 1e-3 * radius * ring + tip],
            position=self._vector(element, "origin", (0.0, 0.0, 0.0)),
            rotation=as_matrix(turn),
        )


def _stretched(shape: Shape, scale: Any, color: Color | None) -> Shape:
    """A shape scaled along the axes that it stands in: as a mesh, unless that changes nothing."""
    if scale == (1.0, 1.0, 1.0):
        return replace(shape, color=color)
    surface = shape.triangles
    faces = surface.faces[:, ::-1] if np.prod(scale) < 0 else surface.faces
    return Mesh(vertices=surface.vertices * scale, faces=faces, color=color)
