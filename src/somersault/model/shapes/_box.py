"""A box."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from somersault._core.array import Array
from somersault.model._vectors import Vector
from somersault.model.shapes._shape import Shape, Triangles, positive


@dataclass(frozen=True, kw_only=True)
class Box(Shape):
    """A box.

    Parameters
    ----------
    half_sizes : tuple of float
        How far it reaches to each side along its own axes, m.
    **pose
        As of any `Shape`.
    """

    half_sizes: Vector
    kind: ClassVar[str] = "box"

    def __post_init__(self) -> None:
        super().__post_init__()
        positive(self.kind, half_sizes=self.half_sizes)

    @property
    def sizes(self) -> tuple[float, ...]:
        """Its half sizes."""
        return self.half_sizes

    def _surface(self) -> Triangles:
        vertices: list[Array] = []
        normals: list[Array] = []
        faces: list[list[int]] = []
        for axis in range(3):
            one, two = np.roll(np.eye(3), -axis, 0)[1:]
            for side in (-1.0, 1.0):
                out = side * np.eye(3)[axis]
                corners = [out - side * one - two, out + side * one - two]
                corners += [out + side * one + two, out - side * one + two]
                start = 4 * len(normals)
                faces += [[start, start + 1, start + 2], [start, start + 2, start + 3]]
                vertices.append(np.array(corners) * self.half_sizes)
                normals.append(np.tile(out, (4, 1)))
        return Triangles(np.concatenate(vertices), np.concatenate(normals), np.array(faces))

    def _core(self) -> tuple[Array, float]:
        signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
        return signs * np.array(self.half_sizes), 0.0
