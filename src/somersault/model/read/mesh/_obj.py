"""Wavefront's OBJ: vertices and faces. Its colours are in other files, which are not opened."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from somersault.model.read.mesh._part import Part, fans, numbers

_CONTINUED = re.compile(rb"\\\r?\n")
_VERTEX = re.compile(rb"^[ \t]*v[ \t]+(\S+[ \t]+\S+[ \t]+\S+)", re.MULTILINE)
_FACE = re.compile(rb"^[ \t]*f[ \t]+([^#\r\n]+)", re.MULTILINE)
_ELEMENT = re.compile(rb"^[ \t]*([vf])[ \t]", re.MULTILINE)
_OTHERS = re.compile(rb"/\S*")  # places among texture coordinates and normals


def parts(data: bytes) -> Iterator[Part]:
    """All faces as one surface."""
    data = _CONTINUED.sub(b" ", data)
    vertices = numbers(b" ".join(_VERTEX.findall(data))).reshape(-1, 3)
    polygons = [_OTHERS.sub(b"", face).split() for face in _FACE.findall(data)]
    sizes = np.array([len(polygon) for polygon in polygons], int)
    corners = numbers(b" ".join(b" ".join(polygon) for polygon in polygons), int)
    if corners.size and corners.min() < 0:  # counted back from the last vertex above the face
        kinds = np.array(_ELEMENT.findall(data)) == b"v"
        above = np.repeat(np.cumsum(kinds)[~kinds], sizes)
        corners = np.where(corners < 0, above + corners + 1, corners)
    yield Part(vertices, fans(corners - 1, sizes))
