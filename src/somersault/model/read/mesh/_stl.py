"""STL, binary and text."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from somersault.model.read.mesh._part import Part, numbers

_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_HEADER = 84  # bytes, of which the last four are the number of triangles
_NUMBER = rb"[-+.\deE]+"
_VERTEX = re.compile(rb"\bvertex\s+(%b\s+%b\s+%b)" % (3 * (_NUMBER,)), re.IGNORECASE)


def parts(data: bytes) -> Iterator[Part]:
    """All triangles: binary where the length says so, whatever the first word."""
    count = int.from_bytes(data[_HEADER - 4 : _HEADER], "little")
    whole = len(data) >= _HEADER + count * _RECORD.itemsize
    text = data[:1000].lstrip()[:5].lower() == b"solid" and b"facet" in data[:5000].lower()
    if text and len(data) != _HEADER + count * _RECORD.itemsize:
        corners = numbers(b" ".join(_VERTEX.findall(data))).reshape(-1, 3)
        if len(corners) % 3:
            raise ValueError("a triangle is not whole")
    elif whole and len(data) >= _HEADER:
        corners = np.frombuffer(data, _RECORD, count, _HEADER)["corners"].reshape(-1, 3)
    else:
        raise ValueError("it ends early")
    yield Part(corners, np.arange(len(corners)).reshape(-1, 3))
