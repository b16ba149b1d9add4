"""Stanford's PLY, text and binary: vertices and faces, and nothing else that there is of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from somersault._core.array import Array
from somersault.model.read.mesh._part import Part, fans, numbers

_KINDS = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2",
    "int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8",
}  # fmt: skip
_ORDERS = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}
_END = b"end_header\n"


@dataclass(slots=True)
class _Element:
    """So many things with the same properties: a name and a kind each, and of lists also the kind
    of their length."""

    name: str
    count: int
    properties: list[tuple[str, np.dtype, np.dtype | None]] = field(default_factory=list)


def parts(data: bytes) -> Iterator[Part]:
    """The one surface of the file."""
    head, end, body = data.replace(b"\r\n", b"\n", 200).partition(_END)
    if not end or not head.startswith(b"ply"):
        raise ValueError("it has no header")
    text, elements = _header(head.decode("latin-1"))
    if text:  # the same in eight bytes each
        body = numbers(body).tobytes()
    vertices, faces = np.empty((0, 3)), np.empty((0, 3), int)
    at = 0
    for element in elements:
        if element.count > len(body) or not element.properties:
            raise ValueError("it ends early")
        columns, at = _columns(element, body, at)
        if element.name == "vertex":
            vertices = np.stack([np.concatenate(columns[axis]) for axis in "xyz"], -1).astype(float)
        elif element.name == "face":
            corners = columns["vertex_indices" if "vertex_indices" in columns else "vertex_index"]
            sizes = np.array([len(polygon) for polygon in corners], int)
            faces = fans(np.concatenate([np.empty(0), *corners]).astype(int), sizes)
    yield Part(vertices, faces)


def _header(head: str) -> tuple[bool, list[_Element]]:
    """Whether the rest is text, and the elements in the order of the file."""
    order, text, elements = "<", False, list[_Element]()
    for line in head.splitlines():
        words = line.split()
        if words[:1] == ["format"]:
            order, text = _ORDERS[words[1]], words[1] == "ascii"
        elif words[:1] == ["element"]:
            elements.append(_Element(words[1], int(words[2])))
        elif words[:1] == ["property"]:
            named = [word for word in words[1:-1] if word != "list"]
            kinds = [np.dtype("=f8" if text else order + _KINDS[word]) for word in named]
            length = kinds[0] if words[1] == "list" else None
            elements[-1].properties.append((words[-1], kinds[-1], length))
    return text, elements


def _columns(element: _Element, body: bytes, at: int) -> tuple[dict[str, list[Array]], int]:
    """The values of each property, and where the next element begins."""
    if all(length is None for _, _, length in element.properties):
        record = np.dtype([(name, kind) for name, kind, _ in element.properties])
        rows = np.frombuffer(body, record, element.count, at)
        return {name: [rows[name]] for name in record.names or ()}, at + rows.nbytes
    columns: dict[str, list[Array]] = {name: [] for name, _, _ in element.properties}
    for _ in range(element.count):
        for name, kind, length in element.properties:
            count = 1
            if length is not None:
                count = int(np.frombuffer(body, length, 1, at)[0])
                at += length.itemsize
                if count < 0:
                    raise ValueError("a list without a length")
            columns[name].append(np.frombuffer(body, kind, count, at))
            at += count * kind.itemsize
    return columns, at
