"""What the readers of mesh files give: surfaces of one colour each."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.model.read._xml import Element, parse_xml
from somersault.model.shapes import Color


class Part(NamedTuple):
    """Vertices (n, 3) and faces (m, 3) in the numbers of a file, and its colour if it has one."""

    vertices: Array
    faces: Array
    color: Color | None = None


def fans(corners: Array, sizes: Array) -> Array:
    """Triangles (m, 3) of polygons that have so many `corners` each, one polygon after another.

    Raises
    ------
    ValueError
        For polygons with more corners, or fewer, than there are.
    """
    if sizes.size and (sizes.min() < 0 or sizes.sum() > len(corners)):
        raise ValueError("polygons without corners")
    starts = np.cumsum(sizes) - sizes
    counts = np.maximum(sizes - 2, 0)
    first = np.repeat(starts, counts)
    within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    return corners[np.stack([first, first + within + 1, first + within + 2], -1)]


def numbers(text: str | bytes, kind: type = float) -> Array:
    """The numbers that a text consists of; ValueError if there is anything else in it."""
    return np.fromiter(map(kind, text.split()), kind)


def xml(data: bytes) -> tuple[Element, str]:
    """Root element and text of an XML file, within bounds and without entities; what else it is
    stays unsaid."""
    try:
        return parse_xml("a mesh", data)
    except SomersaultError:
        raise SomersaultError("is not plain XML") from None
