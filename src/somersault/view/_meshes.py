"""The triangles of a model, few enough to be drawn often."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.model import Model, model_shapes
from somersault.model.shapes import Color, Mesh, Shape, lighter, loft
from somersault.view._canvas import Surface

TRUNK, LIMBS = (0.36, 0.53, 0.74), (0.90, 0.69, 0.46)  # of what has no colour of its own
_MOST_FACES = 60_000  # of a whole model
_TRUNK = 0.2  # of the mass: a body that has more is of the trunk
_MOST_READ = 20_000_000
_RAYS = 256  # between which a surface bulges by less than a hundredth of its size


@dataclass(frozen=True, eq=False)
class Figure:
    """What a model looks like: a surface, and for each of its corners the body it moves with, its
    place and its unit normal in that body's axes, (n,), (n, 3) and (n, 3)."""

    surface: Surface
    bodies: Array
    points: Array
    normals: Array

    @cached_property
    def far(self) -> Array:
        """Which corners stand farthest out on their bodies, in directions all around."""
        rays = _around(_RAYS).astype(np.float32)
        points = self.points.astype(np.float32)
        far = []
        for body in np.unique(self.bodies):
            rows = np.flatnonzero(self.bodies == body)
            far += [rows[np.argmax(points[rows] @ some.T, 0)] for some in np.split(rays, 8)]
        return np.unique(np.concatenate(far))


def _around(count: int) -> Array:
    """Unit vectors (count, 3), evenly all around: along a spiral by the golden angle."""
    height = 1 - (2 * np.arange(count) + 1) / count
    turn = np.pi * (3 - np.sqrt(5)) * np.arange(count)
    across = np.sqrt(1 - height**2)
    return np.stack([across * np.cos(turn), across * np.sin(turn), height], -1)


def figure_of(model: Model, most: int = _MOST_FACES) -> Figure:
    """The triangles of a model's shapes; meshes with very many are made coarser.

    Raises
    ------
    SomersaultError
        For a model of so many triangles that even this would take minutes.
    """
    rows = model_shapes(model)
    count = sum(len(shape.faces) for row in rows for shape in row if isinstance(shape, Mesh))
    if count > _MOST_READ:
        raise SomersaultError(
            f"{model.name} has meshes of {count} triangles, too many to draw; give meshes of "
            f"at most {_MOST_READ} in all"
        )
    bodies, points, normals, faces, paints = [], [], [], [], []
    start = 0
    trunk = of_trunk(model)
    for body, shape in ((k, shape) for k, row in enumerate(lighter(rows, most)) for shape in row):
        surface = shape.triangles
        bodies.append(np.full(len(surface.vertices), body))
        points.append(surface.vertices)
        normals.append(surface.normals)
        faces.append(surface.faces + start)
        closed = float(_closed(shape))
        paint = (*colour_of(shape.color, trunk[body]), closed)
        paints.append(np.tile(paint, (len(surface.faces), 1)))
        start += len(surface.vertices)
    if not start:
        raise SomersaultError(f"{model.name} has no shapes to be drawn")
    return Figure(
        Surface(np.concatenate(faces), np.concatenate(paints)),
        np.concatenate(bodies), np.concatenate(points), np.concatenate(normals),
    )  # fmt: skip


def of_trunk(model: Model) -> list[bool]:
    """Which bodies have the trunk's colour: the base, and those that are heavy."""
    return [k == 0 or body.mass > _TRUNK * model.mass for k, body in enumerate(model.bodies)]


def colour_of(own: Color | None, trunk: bool) -> tuple[float, float, float]:
    """Of a shape: its own, or the one that parts of its kind have."""
    if own is not None:
        return own[0], own[1], own[2]
    return TRUNK if trunk else LIMBS


def _closed(shape: Shape) -> bool:
    """Whether each edge of a surface has a face on either side, so that its inside is hidden."""
    if not isinstance(shape, Mesh):
        return True
    surface = shape.triangles
    size = float(np.ptp(surface.vertices, axis=0).max()) or 1.0
    places = np.round(surface.vertices / (1e-6 * size)).astype(np.int64)
    keys = places @ np.array([1, 2_000_003, 4_000_037_000_009])
    _, place = np.unique(keys, return_inverse=True)
    corners = place.reshape(-1)[surface.faces].astype(np.int64)
    count = int(place.max()) + 1
    ways = [corners[:, a] * count + corners[:, b] for a, b in ((0, 1), (1, 2), (2, 0))]
    back = [corners[:, b] * count + corners[:, a] for a, b in ((0, 1), (1, 2), (2, 0))]
    return np.array_equal(np.sort(np.concatenate(ways)), np.sort(np.concatenate(back)))


def arrow() -> Mesh:
    """An arrow of length 1 along axis 3, as thick as an arrow of a body's size should be."""
    angle = np.linspace(0, 2 * np.pi, 21)[:-1]
    around = np.stack([np.cos(angle), np.sin(angle), np.zeros(20)], -1)
    profile = [(0.016, 0.0), (0.016, 0.86), (0.042, 0.86), (0.001, 1.0)]
    return loft([radius * around + [0.0, 0.0, height] for radius, height in profile])
