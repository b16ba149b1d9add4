"""What a part of a body looks like: the base of all kinds of shapes, and how they are drawn."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Self, TypeAlias

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.model._vectors import IDENTITY, ZERO, Matrix, Vector, as_matrix, as_vector

Color: TypeAlias = tuple[float, float, float, float]

_AROUND = 24  # sides of what is round


class Triangles(NamedTuple):
    """A surface: `vertices` (n, 3) in m with outward unit `normals` (n, 3), and `faces` (m, 3),
    whose corners run counterclockwise as seen from outside."""

    vertices: Array
    normals: Array
    faces: Array


class Hull(NamedTuple):
    """All that is within `radius` (m) of the hull of some `points` (n, 3)."""

    points: Array
    radius: float


@dataclass(frozen=True, kw_only=True)
class Shape(ABC):
    """Part of what a body looks like. Shapes decide nothing: they are there to be seen.

    Parameters
    ----------
    position : tuple of float
        Where its middle stands in the body's frame, m.
    rotation : tuple of rows
        Columns are its axes in the body's.
    color : tuple of float, optional
        Red, green, blue and opacity, 0 to 1; None leaves it to who draws.
    """

    position: Vector = ZERO
    rotation: Matrix = IDENTITY
    color: Color | None = None

    kind: ClassVar[str]

    def __post_init__(self) -> None:
        numbers = [*self.position, *np.ravel(self.rotation), *(self.color or ())]
        if not np.all(np.isfinite(numbers)):
            raise SomersaultError(f"a {self.kind} has a pose or color that is not finite")
        if self.color is not None and (len(self.color) != 4 or not _within_one(self.color)):
            raise SomersaultError(
                f"a {self.kind} has the color {self.color}; give red, green, blue, opacity, 0 to 1"
            )

    def __getstate__(self) -> dict[str, Any]:
        """Without the surfaces that follow from it: models are sent to other processes."""
        return {own.name: getattr(self, own.name) for own in fields(self)}

    @property
    @abstractmethod
    def sizes(self) -> tuple[float, ...]:
        """Its lengths in m, in the order of MJCF; none for a mesh."""

    @cached_property
    def triangles(self) -> Triangles:
        """Its surface, in the body's axes."""
        vertices, normals, faces = self._surface()
        turn = np.array(self.rotation)
        return Triangles(vertices @ turn.T + self.position, normals @ turn.T, faces)

    @cached_property
    def hull(self) -> Hull:
        """What its outline from afar is the outline of, in the body's axes."""
        points, radius = self._core()
        return Hull(points @ np.array(self.rotation).T + self.position, radius)

    def solids(self) -> tuple[Shape, ...]:
        """What is drawn of it, each of one colour: itself, unless it stands for a file.

        Raises
        ------
        SomersaultError
            For a file that cannot be read.
        """
        return (self,)

    def placed(self, position: Array, rotation: Array) -> Self:
        """The same shape on another body, in whose axes (3, 3) and at whose point (3,) its own
        body's frame stands; its mirror image if the axes are left-handed."""
        turn, shape = rotation @ np.array(self.rotation), self
        if np.linalg.det(rotation) < 0:
            turn, shape = turn * [1.0, -1.0, 1.0], self._mirrored()
        return replace(
            shape,
            position=as_vector(position + rotation @ np.array(self.position)),
            rotation=as_matrix(turn),
        )

    def _mirrored(self) -> Self:
        """Its mirror image across its own axis 2: itself, unless it is a mesh."""
        return self

    @abstractmethod
    def _surface(self) -> Triangles:
        """Its surface in its own axes."""

    @abstractmethod
    def _core(self) -> tuple[Array, float]:
        """Points and radius of its hull in its own axes."""


def positive(kind: str, **lengths: float | Vector) -> None:
    """SomersaultError unless every length of a shape is a positive number."""
    for name, value in lengths.items():
        if not np.all(np.isfinite(value)) or np.min(value) <= 0:
            raise SomersaultError(f"a {kind} has {name} {value}; give positive lengths in m")


def _within_one(color: Color) -> bool:
    return min(color) >= 0 and max(color) <= 1


def circle() -> Array:
    """Points (n, 2) around a circle of radius 1."""
    angle = 2 * np.pi * np.arange(_AROUND) / _AROUND
    return np.stack([np.cos(angle), np.sin(angle)], -1)


def revolved(profile: Array, normals: Array) -> Triangles:
    """The surface of a profile (k, 2), radius and height from the bottom up, turned about axis 3.

    Where two neighbours of the profile are one point, the surface has an edge there: each has its
    own of the `normals` (k, 2).
    """
    ring = circle()
    count, size = len(profile), len(ring)
    vertices = np.empty((count, size, 3))
    turned = np.empty((count, size, 3))
    for rows, (across, up) in ((vertices, profile.T), (turned, normals.T)):
        rows[..., :2] = across[:, None, None] * ring
        rows[..., 2] = up[:, None]
    faces = strips(count, size)
    apart = np.linalg.norm(np.diff(profile, axis=0), axis=1) > 0
    faces = faces[np.repeat(apart, 2 * size)]
    corners = vertices.reshape(-1, 3)[faces]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    return Triangles(vertices.reshape(-1, 3), turned.reshape(-1, 3), faces[area > 0])


def strips(rings: int, size: int) -> Array:
    """Faces (2 (rings − 1) size, 3) between neighbouring rings of `size` points each, the lowest
    first, each counterclockwise as seen from above."""
    here = np.arange(size)
    after = (here + 1) % size
    band = np.stack(
        [np.stack([here, after, after + size], -1), np.stack([here, after + size, here + size], -1)]
    )
    starts = size * np.arange(rings - 1)
    return (starts[:, None, None, None] + band).reshape(-1, 3)
