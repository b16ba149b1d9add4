"""What a segment of a `.bioMod` file looks like.

Meanings follow biorbd's own reader (pyomeca/biorbd, src/ModelReader.cpp): points and triangles of
the segment's own, or a file; `meshrt` and `meshscale` move what stands above them.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from somersault._core.array import Array
from somersault.model._vectors import as_matrix, as_vector
from somersault.model.read._drawn import Drawn
from somersault.model.shapes import Color, Mesh, Shape

_SIDES = 6  # of what is drawn along a line
_THICK = 0.02  # its radius, over the line's extent


@dataclass(slots=True)
class Look:
    """Points, corners of triangles among them, or the name of a file; and the moves of what stands
    above them, each with the number of points then."""

    points: list[list[float]] = field(default_factory=list)
    patches: list[list[float]] = field(default_factory=list)
    file: str = ""
    color: Color | None = None
    moves: list[tuple[int, Array]] = field(default_factory=list)

    def take(self, file: str) -> None:
        """Show a file, without the moves above it."""
        self.file = file
        self.moves.clear()

    def move(self, linear: Array, shift: Array) -> None:
        """Move all that there is by a linear map and a shift."""
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = linear, shift
        self.moves.append((len(self.points), frame))

    def paint(self, color: list[float]) -> None:
        """Give it a colour of red, green and blue."""
        red, green, blue = (min(max(x, 0.0), 1.0) for x in color)
        self.color = red, green, blue, 1.0

    def shape(self, drawn: Drawn) -> Shape | None:
        """All of it; nothing for less than two points."""
        points, frame = self._moved()
        if self.file:
            return drawn.file(
                self.file.replace("\\", "/"),
                form=as_matrix(frame[:3, :3]),
                position=as_vector(frame[:3, 3]),
                color=self.color,
            )
        if self.patches:
            faces = np.array(self.patches, int)
            mirrored = np.linalg.det(frame[:3, :3]) < 0
            faces = faces[:, ::-1] if mirrored else faces
            return Mesh(vertices=points, faces=faces, color=self.color)
        return _line(points, self.color) if len(points) > 1 else None

    def _moved(self) -> tuple[Array, Array]:
        """The points, each moved by what stands below it, and all moves together, (4, 4)."""
        points = np.array(self.points).reshape(-1, 3)
        frame, end = np.eye(4), len(points)
        for count, move in reversed([(0, np.eye(4)), *self.moves]):
            points[count:end] = points[count:end] @ frame[:3, :3].T + frame[:3, 3]
            frame, end = frame @ move, min(count, end)
        return points, frame


def _line(points: Array, color: Color | None) -> Shape | None:
    """A thin rod along each edge of a line, as biorbd's viewer draws a line; none for a point."""
    points = points[np.r_[True, np.any(np.diff(points, axis=0) != 0, 1)]]
    if len(points) < 2:
        return None
    start, along = points[:-1], np.diff(points, axis=0)
    side = np.eye(3)[np.argmin(np.abs(along), 1)]
    one = np.cross(along, side)
    one /= np.linalg.norm(one, axis=1, keepdims=True)
    two = np.cross(along, one)
    two /= np.linalg.norm(two, axis=1, keepdims=True)
    angle = 2 * np.pi * np.arange(_SIDES) / _SIDES
    radius = _THICK * float(np.ptp(points, axis=0).max())
    ring = radius * (np.cos(angle)[:, None, None] * one + np.sin(angle)[:, None, None] * two)
    vertices = np.concatenate([start + ring, start + along + ring])  # (2 sides, edges, 3)
    here = np.arange(_SIDES)
    after = (here + 1) % _SIDES
    sides = [
        np.stack([here, after, after + _SIDES], -1),
        np.stack([here, after + _SIDES, here + _SIDES], -1),
    ]
    cap = np.stack([np.zeros(_SIDES - 2, int), here[1:-1], here[2:]], -1)
    faces = np.concatenate([*sides, cap[:, ::-1], cap + _SIDES])
    edges = np.arange(len(start))
    return Mesh(
        vertices=vertices.reshape(-1, 3),
        faces=(faces[:, None] * len(start) + edges[None, :, None]).reshape(-1, 3),
        color=color,
    )
