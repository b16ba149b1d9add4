"""biorbd's own mesh files: the numbers of points and faces, and then those.

Meanings follow its sources (pyomeca/biorbd, src/ModelReader.cpp).
"""

from __future__ import annotations

from collections.abc import Iterator

from somersault.model.read.mesh._part import Part, numbers

_NUMBERS = {1: 3, 2: 6}  # of a point, by the version of the file


def parts(data: bytes) -> Iterator[Part]:
    """The one surface of the file."""
    words = data.split()
    head = {words[k].lower(): int(words[k + 1]) for k in (0, 2, 4)}
    points, faces = head[b"npoints"], head[b"nfaces"]
    width = _NUMBERS.get(head[b"version"], 3)
    end = 6 + width * points
    vertices = numbers(b" ".join(words[6:end])).reshape(points, width)[:, :3]
    corners = numbers(b" ".join(words[end : end + 4 * faces]), int).reshape(faces, 4)
    if (corners[:, 0] != 3).any():
        raise ValueError("faces that are no triangles")
    yield Part(vertices, corners[:, 1:])
