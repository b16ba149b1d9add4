"""Meshes of fewer triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from somersault._core.array import Array
from somersault.model.shapes._mesh import Mesh
from somersault.model.shapes._shape import Shape

_LEAST = 200  # triangles that a mesh may keep, however many there are of others


def lighter(rows: Sequence[Sequence[Shape]], most: int, least: int = _LEAST) -> list[list[Shape]]:
    """Rows of shapes with about so many triangles at most in all meshes, each coarser by as much;
    `least` triangles each may keep."""
    total = sum(len(shape.faces) for row in rows for shape in row if isinstance(shape, Mesh))
    share = min(1.0, most / total) if total else 1.0
    return [
        [
            coarser(shape, max(least, int(share * len(shape.faces))))
            if isinstance(shape, Mesh)
            else shape
            for shape in row
        ]
        for row in rows
    ]


def coarser(mesh: Mesh, most: int) -> Mesh:
    """A mesh of at most so many triangles: corners that stand in one cell of a lattice are one.

    Of a mesh that is all crumbs, smaller than the cells, the largest triangles are left.
    """
    if len(mesh.faces) <= most:
        return mesh
    low = mesh.vertices.min(0)
    size = float(np.ptp(mesh.vertices, axis=0).max()) or 1.0
    cells = int(np.sqrt(most)) + 4
    while True:
        grid = np.minimum((mesh.vertices - low) * (cells / size), cells - 1).astype(np.int64)
        keys = (grid[:, 0] * cells + grid[:, 1]) * cells + grid[:, 2]
        _, place, count = np.unique(keys, return_inverse=True, return_counts=True)
        place = place.reshape(-1)
        faces = place[mesh.faces]
        a, b, c = faces.T
        faces = faces[(a != b) & (b != c) & (c != a)]
        if len(faces):  # of those that have become one, one
            order = np.sort(faces, 1)
            name = (order[:, 0] * len(count) + order[:, 1]) * len(count) + order[:, 2]
            faces = faces[np.unique(name, return_index=True)[1]]
        if len(faces) <= most or cells <= 2:
            break
        cells = max(2, int(cells * min(0.9, np.sqrt(most / len(faces)))))
    if not 0 < len(faces) <= most:
        return _largest(mesh, most)
    middles = [np.bincount(place, mesh.vertices[:, k]) / count for k in range(3)]
    return replace(mesh, vertices=np.stack(middles, -1), faces=faces)


def _largest(mesh: Mesh, most: int) -> Mesh:
    """Its largest triangles."""
    one, two, three = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    areas: Array = np.linalg.norm(np.cross(two - one, three - one), axis=1)
    faces = mesh.faces[np.sort(np.argsort(areas)[-most:])]
    kept, place = np.unique(faces, return_inverse=True)
    return replace(mesh, vertices=mesh.vertices[kept], faces=place.reshape(-1, 3))
