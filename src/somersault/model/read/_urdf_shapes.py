"""What the links of a URDF file look like: its <visual> elements.

Meanings are urdfdom's and RViz's: a material is known by its name throughout the file, and the
first of a name counts; a mesh that has colours of its own keeps them.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from somersault._core.errors import SomersaultError
from somersault.model._vectors import as_matrix, as_vector
from somersault.model.read._drawn import Drawn
from somersault.model.read._urdf_elements import Elements
from somersault.model.read._xml import Element
from somersault.model.shapes import Box, Capsule, Color, Cylinder, Shape, Sphere


def link_shapes(file: Elements, robot: Element, folder: Path) -> Drawn:
    """The shapes of all links."""
    drawn = Drawn(folder, file.strange)
    looks = _Looks(file, robot, drawn)
    for link in robot.all("link"):
        name = link.attributes.get("name", "")
        for visual in link.all("visual"):
            drawn.add(name, partial(looks.shape, visual, f"link {name!r}"))
    return drawn


class _Looks:
    def __init__(self, file: Elements, robot: Element, drawn: Drawn) -> None:
        self._file = file
        self._drawn = drawn
        self._colors: dict[str, Color | None] = {}
        inner = [
            m for link in robot.all("link") for v in link.all("visual") for m in v.all("material")
        ]
        for material in [*robot.all("material"), *inner]:
            name = material.attributes.get("name", "")
            if name and name not in self._colors and material.first("color") is not None:
                self._colors[name] = self._own(material)

    def _own(self, material: Element) -> Color | None:
        """The colour within a material; none where it makes no sense."""
        color = material.first("color")
        try:
            numbers = None if color is None else self._file.numbers(color, "rgba", "a material", 4)
        except SomersaultError as error:
            self._file.strange.add("colors left out", str(error))
            return None
        if numbers is None:
            return None
        red, green, blue, opacity = (min(max(x, 0.0), 1.0) for x in numbers)
        return red, green, blue, opacity

    def _color(self, visual: Element) -> Color | None:
        material = visual.first("material")
        if material is None:
            return None
        name = material.attributes.get("name", "")
        return self._colors.get(name) if name else self._own(material)

    def shape(self, visual: Element, where: str) -> Shape | None:
        file = self._file
        position, rotation = file.origin(visual, where)
        pose: dict[str, Any] = {
            "position": as_vector(position),
            "rotation": as_matrix(rotation),
            "color": self._color(visual),
        }
        if pose["color"] is not None and pose["color"][3] == 0:
            return None
        geometry = visual.first("geometry")
        if geometry is None or not geometry.children:
            raise SomersaultError(
                f"{file.file}, line {visual.line}: a visual of {where} has no shape"
            )
        kind = geometry.children[0]

        def half(attribute: str) -> float:
            return file.number(kind, attribute, where) / 2

        if kind.tag == "box":
            return Box(half_sizes=as_vector(file.vector(kind, "size", where) / 2), **pose)
        if kind.tag == "sphere":
            return Sphere(radius=file.number(kind, "radius", where), **pose)
        if kind.tag in ("cylinder", "capsule"):
            make = Cylinder if kind.tag == "cylinder" else Capsule
            radius = file.number(kind, "radius", where)
            return make(radius=radius, half_length=half("length"), **pose)
        if kind.tag == "mesh":
            scale = file.vector(kind, "scale", where, (1.0, 1.0, 1.0))
            name = file.word(kind, "filename", where)
            return self._drawn.file(name, form=as_matrix(np.diag(scale)), **pose)
        raise SomersaultError(f"{file.file}, line {kind.line}: {where} has a <{kind.tag[:40]}>")
