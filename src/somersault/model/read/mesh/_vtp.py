"""VTK's XML files of surfaces (.vtp), in all their encodings: text, base64, appended, compressed.

https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
"""

from __future__ import annotations

import base64
import lzma
import re
import zlib
from collections.abc import Callable, Iterator

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.model.read._xml import Element
from somersault.model.read.mesh._part import Part, fans, numbers, xml

_KINDS = {
    "Float32": "f4", "Float64": "f8", "Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2",
    "Int32": "i4", "UInt32": "u4", "Int64": "i8", "UInt64": "u8",
}  # fmt: skip
_RAW = re.compile(rb"<AppendedData[^>]*encoding\s*=\s*[\"']raw[\"'][^>]*>")
_MOST_BYTES = 200 * 2**20  # of one array, whatever it says of itself


def parts(data: bytes) -> Iterator[Part]:
    """The polygons and strips of each of its pieces."""
    appended = b""
    if raw := _RAW.search(data):
        begin, end = data.index(b"_", raw.end()) + 1, data.rindex(b"</AppendedData>")
        appended = data[begin:end]
        data = data[: raw.end()] + data[end:]
    root = xml(data)[0]
    if root.tag != "VTKFile" or root.attributes.get("type") != "PolyData":
        raise ValueError("it has another kind of data")
    arrays = _Arrays(root, appended)
    for piece in [] if (poly := root.first("PolyData")) is None else poly.all("Piece"):
        (points,) = (child for child in piece.below("Points") if child.tag == "DataArray")
        vertices = arrays.values(points).astype(float).reshape(-1, 3)
        yield Part(vertices, np.concatenate([_polygons(arrays, piece), _strips(arrays, piece)]))


def _polygons(arrays: _Arrays, piece: Element) -> Array:
    corners, sizes = arrays.cells(piece, "Polys")
    return fans(corners, sizes)


def _strips(arrays: _Arrays, piece: Element) -> Array:
    """Each corner of a strip makes a triangle with the two before it, every other one turned."""
    corners, sizes = arrays.cells(piece, "Strips")
    starts = np.cumsum(sizes) - sizes
    counts = np.maximum(sizes - 2, 0)
    within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    faces = corners[(np.repeat(starts, counts) + within)[:, None] + np.arange(3)]
    return np.where((within % 2 == 1)[:, None], faces[:, [1, 0, 2]], faces)


class _Arrays:
    """The arrays of a file."""

    def __init__(self, root: Element, appended: bytes) -> None:
        self._order = ">" if root.attributes.get("byte_order") == "BigEndian" else "<"
        self._header = np.dtype(self._order + _KINDS[root.attributes.get("header_type", "UInt32")])
        self._unpack = _UNPACKERS[root.attributes.get("compressor", "")]
        section = root.first("AppendedData")
        self._coded = section is not None and section.attributes.get("encoding") == "base64"
        if section is not None and self._coded:
            appended = section.text.strip().removeprefix("_").encode()
        self._appended = appended

    def cells(self, piece: Element, tag: str) -> tuple[Array, Array]:
        """The corners of all cells of a kind, and how many each has."""
        named = {array.attributes.get("Name"): array for array in piece.below(tag)}
        if "connectivity" not in named or "offsets" not in named:
            return np.empty(0, int), np.empty(0, int)
        ends = self.values(named["offsets"]).astype(int)
        return self.values(named["connectivity"]).astype(int), np.diff(ends, prepend=0)

    def values(self, array: Element) -> Array:
        """The numbers of one array."""
        kind = np.dtype(self._order + _KINDS[array.attributes["type"]])
        form = array.attributes.get("format", "ascii").lower()
        if form == "ascii":
            return numbers(array.text, float if kind.kind == "f" else int)
        if form == "binary":
            return np.frombuffer(self._bytes(array.text.strip().encode(), True), kind)
        blob = self._appended[int(array.attributes["offset"]) :]
        return np.frombuffer(self._bytes(blob, self._coded), kind)

    def _bytes(self, blob: bytes, coded: bool) -> bytes:
        """The bytes of the array at the beginning of a blob, which may be in base64."""

        def taken(at: int, count: int) -> tuple[bytes, int]:
            """So many bytes, and where what is behind them begins."""
            end = at + (4 * -(-count // 3) if coded else count)
            part = base64.b64decode(blob[at:end])[:count] if coded else blob[at:end]
            if len(part) < count:
                raise ValueError("it ends early")
            return part, end

        def header(count: int) -> list[int]:
            return np.frombuffer(taken(0, count * width)[0], self._header).tolist()

        width = self._header.itemsize
        if self._unpack is None:
            (length,) = header(1)
            return taken(0, width + length)[0][width:]
        count, block, last = header(3)
        if count * max(block, 1) > _MOST_BYTES:
            raise SomersaultError(f"has an array of more than {_MOST_BYTES >> 20} MB")
        lengths = header(3 + count)[3:]
        packed, _ = taken(taken(0, (3 + count) * width)[1], sum(lengths))
        ends = np.cumsum(lengths).tolist()
        blocks = (packed[end - size : end] for end, size in zip(ends, lengths, strict=True))
        whole = b"".join(self._unpack(each, block) for each in blocks)
        if len(whole) != count * block - (block - last if last else 0):
            raise ValueError("blocks that are not whole")
        return whole


def _inflated(data: bytes, most: int) -> bytes:
    """Never more than that: a few bytes can stand for gigabytes."""
    try:
        return zlib.decompressobj().decompress(data, max(most, 1))
    except zlib.error:
        raise ValueError("it is not what it says") from None


def _expanded(data: bytes, most: int) -> bytes:
    try:
        return lzma.LZMADecompressor(memlimit=_MOST_BYTES).decompress(data, max(most, 1))
    except lzma.LZMAError:
        raise ValueError("it is not what it says") from None


_UNPACKERS: dict[str, Callable[[bytes, int], bytes] | None] = {
    "": None,
    "vtkZLibDataCompressor": _inflated,
    "vtkLZMADataCompressor": _expanded,
}
