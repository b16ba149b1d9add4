"""A surface of triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import MOST
from somersault.model.shapes._shape import Shape, Triangles, strips

_CLOSE = 1e-6  # of a mesh's size: vertices nearer than this are one
_EDGE = np.cos(np.radians(40.0))  # faces that meet more sharply have an edge between them

_CROWD = 128  # faces at a vertex, beyond which they are so narrow that each keeps its own normal
_PAIRS = 2**22  # of faces that share a vertex, looked at at once


@dataclass(frozen=True, kw_only=True, eq=False)
class Mesh(Shape):
    """Triangles by their corners.

    Parameters
    ----------
    vertices : array_like, (n, 3)
        m, in its own axes.
    faces : array_like, (m, 3)
        Places of corners among the vertices, counterclockwise as seen from outside.

    Raises
    ------
    SomersaultError
        For no triangle at all, vertices that are not finite or beyond 1e9 m, and corners that there
        are not.
    """

    vertices: Array = field(repr=False)
    faces: Array = field(repr=False)
    kind: ClassVar[str] = "mesh"

    def __post_init__(self) -> None:
        super().__post_init__()
        vertices = np.array(self.vertices, float)
        faces = np.array(self.faces)
        if vertices.ndim != 2 or vertices.shape[1] != 3 or not np.all(np.abs(vertices) <= MOST):
            raise SomersaultError("a mesh needs finite vertices below 1e9, three numbers each")
        if faces.ndim != 2 or faces.shape[1] != 3 or not faces.size or faces.dtype.kind not in "iu":
            raise SomersaultError("a mesh needs faces, the places of three vertices each")
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise SomersaultError(f"a mesh has a face with a corner outside its {len(vertices)}")
        for name, array in (("vertices", vertices), ("faces", faces.astype(np.int32))):
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @property
    def sizes(self) -> tuple[float, ...]:
        """None: its vertices say all."""
        return ()

    def _mirrored(self) -> Mesh:
        return replace(self, vertices=self.vertices * [1.0, -1.0, 1.0], faces=self.faces[:, ::-1])

    def _surface(self) -> Triangles:
        vertices, faces = _joined(self.vertices, self.faces)
        faces, across = _with_area(vertices, faces)
        normals = _corner_normals(across, faces)
        # One vertex for each corner, but for those that share place and normal.
        corners = np.concatenate([faces.reshape(-1, 1), np.round(normals, 3)], 1)
        _, first, place = np.unique(corners, axis=0, return_index=True, return_inverse=True)
        return Triangles(vertices[faces.reshape(-1)[first]], normals[first], place.reshape(-1, 3))

    def _core(self) -> tuple[Array, float]:
        from scipy.spatial import ConvexHull, QhullError

        try:
            return self.vertices[ConvexHull(self.vertices).vertices], 0.0
        except QhullError:  # flat
            return self.vertices, 0.0


def _joined(vertices: Array, faces: Array) -> tuple[Array, Array]:
    """The same with vertices that stand in one place made one, as many files do not."""
    size = float(np.ptp(vertices, axis=0).max()) or 1.0
    places = np.round(vertices / (_CLOSE * size))
    _, first, place = np.unique(places, axis=0, return_index=True, return_inverse=True)
    return vertices[first], place.reshape(-1)[faces]


def _with_area(vertices: Array, faces: Array) -> tuple[Array, Array]:
    """The faces that are more than a line, and the normals of all of them times twice the area."""
    one, two, three = (vertices[faces[:, k]] for k in range(3))
    across = np.cross(two - one, three - one)
    good = np.linalg.norm(across, axis=1) > 0
    if not good.any():
        return faces, np.tile([0.0, 0.0, 1.0], (len(faces), 1))
    return faces[good], across[good]


def _corner_normals(across: Array, faces: Array) -> Array:
    """Unit normals (3 faces, 3) at the corners of faces with the normals `across`: those of all
    faces there that meet the own one smoothly, by area. In a crowd they are the own one's."""
    flat = across / np.linalg.norm(across, axis=1, keepdims=True)
    corners = faces.reshape(-1)
    order = np.argsort(corners, kind="stable")
    _, starts, counts = np.unique(corners[order], return_index=True, return_counts=True)
    crowded = np.repeat(counts > _CROWD, counts)
    first = np.where(crowded, np.arange(len(order)), np.repeat(starts, counts))
    many = np.where(crowded, 1, np.repeat(counts, counts))
    ends = np.cumsum(many)
    normals = np.zeros((len(corners), 3))
    for some in np.split(
        np.arange(len(order)), np.searchsorted(ends, np.arange(_PAIRS, ends[-1], _PAIRS))
    ):
        # Every pair of faces that share a vertex: for each corner, all the corners at its vertex.
        own = np.repeat(order[some], many[some])
        within = np.arange(len(own)) - np.repeat(np.cumsum(many[some]) - many[some], many[some])
        other = order[np.repeat(first[some], many[some]) + within]
        smooth = np.einsum("ij,ij->i", flat[own // 3], flat[other // 3]) > _EDGE
        np.add.at(normals, own[smooth], across[other[smooth] // 3])
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def loft(sections: Sequence[Array], **options: Any) -> Mesh:
    """A mesh through cross-sections, closed at both ends.

    Parameters
    ----------
    sections : sequence of ndarray, each (n, 3)
        Points around each section, as many and in the same order in all, the lowest first and
        counterclockwise as seen from above.
    **options
        Pose and color, as of any shape.
    """
    size = len(sections[0])
    middles = [np.mean(section, 0, keepdims=True) for section in (sections[0], sections[-1])]
    vertices = np.concatenate([*sections, *middles])
    here = np.arange(size)
    after, top = (here + 1) % size, size * (len(sections) - 1)
    bottom = np.stack([after, here, np.full(size, len(vertices) - 2)], -1)
    lid = np.stack([here + top, after + top, np.full(size, len(vertices) - 1)], -1)
    faces = np.concatenate([strips(len(sections), size), bottom, lid])
    return Mesh(vertices=vertices, faces=faces, **options)
