"""Shapes that are turned about their own axis 3."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from somersault._core.array import Array
from somersault.model._vectors import Vector
from somersault.model.shapes._shape import Shape, Triangles, circle, positive, revolved

_RINGS = 13  # from pole to pole


def _arc() -> Array:
    """Half a circle of radius 1 (n, 2), from the lowest point to the highest."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, _RINGS)
    arc = np.stack([np.cos(angle), np.sin(angle)], -1)
    arc[[0, -1], 0] = 0.0
    return arc


@dataclass(frozen=True, kw_only=True)
class Sphere(Shape):
    """A sphere.

    Parameters
    ----------
    radius : float
        m.
    **pose
        As of any `Shape`.
    """

    radius: float
    kind: ClassVar[str] = "sphere"

    def __post_init__(self) -> None:
        super().__post_init__()
        positive(self.kind, radius=self.radius)

    @property
    def sizes(self) -> tuple[float, ...]:
        """Its radius."""
        return (self.radius,)

    def _surface(self) -> Triangles:
        return revolved(self.radius * _arc(), _arc())

    def _core(self) -> tuple[Array, float]:
        return np.zeros((1, 3)), self.radius


@dataclass(frozen=True, kw_only=True)
class Ellipsoid(Shape):
    """An ellipsoid.

    Parameters
    ----------
    semi_axes : tuple of float
        m, along its own axes.
    **pose
        As of any `Shape`.
    """

    semi_axes: Vector
    kind: ClassVar[str] = "ellipsoid"

    def __post_init__(self) -> None:
        super().__post_init__()
        positive(self.kind, semi_axes=self.semi_axes)

    @property
    def sizes(self) -> tuple[float, ...]:
        """Its semi-axes."""
        return self.semi_axes

    def _surface(self) -> Triangles:
        vertices, normals, faces = revolved(_arc(), _arc())
        normals = normals / self.semi_axes
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return Triangles(vertices * self.semi_axes, normals, faces)

    def _core(self) -> tuple[Array, float]:
        return self._surface().vertices, 0.0


@dataclass(frozen=True, kw_only=True)
class Capsule(Shape):
    """A cylinder along its axis 3 with half spheres on its ends.

    Parameters
    ----------
    radius : float
        m.
    half_length : float
        Of the cylinder, to each side, m.
    **pose
        As of any `Shape`.
    """

    radius: float
    half_length: float
    kind: ClassVar[str] = "capsule"

    def __post_init__(self) -> None:
        super().__post_init__()
        positive(self.kind, radius=self.radius, half_length=self.half_length)

    @property
    def sizes(self) -> tuple[float, ...]:
        """Radius and half length."""
        return (self.radius, self.half_length)

    def _surface(self) -> Triangles:
        arc, half = _arc(), _RINGS // 2 + 1
        normals = np.concatenate([arc[:half], arc[half - 1 :]])
        profile = self.radius * normals
        profile[:half, 1] -= self.half_length
        profile[half:, 1] += self.half_length
        return revolved(profile, normals)

    def _core(self) -> tuple[Array, float]:
        return np.array([[0.0, 0.0, -self.half_length], [0.0, 0.0, self.half_length]]), self.radius


@dataclass(frozen=True, kw_only=True)
class Cylinder(Shape):
    """A cylinder along its axis 3.

    Parameters
    ----------
    radius : float
        m.
    half_length : float
        To each side, m.
    **pose
        As of any `Shape`.
    """

    radius: float
    half_length: float
    kind: ClassVar[str] = "cylinder"

    def __post_init__(self) -> None:
        super().__post_init__()
        positive(self.kind, radius=self.radius, half_length=self.half_length)

    @property
    def sizes(self) -> tuple[float, ...]:
        """Radius and half length."""
        return (self.radius, self.half_length)

    def _surface(self) -> Triangles:
        r, h = self.radius, self.half_length
        profile = np.array([[0.0, -h], [r, -h], [r, -h], [r, h], [r, h], [0.0, h]])
        normals = np.repeat([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0]], 2, axis=0)
        return revolved(profile, normals)

    def _core(self) -> tuple[Array, float]:
        rim = np.concatenate([self.radius * circle(), np.zeros((len(circle()), 1))], 1)
        end = np.array([0.0, 0.0, self.half_length])
        return np.concatenate([rim - end, rim + end]), 0.0
