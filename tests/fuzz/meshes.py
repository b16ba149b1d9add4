"""Writers of mesh files, of every format and in all its forms."""

from __future__ import annotations

import base64
import lzma
import zlib
from typing import Any

import numpy as np


def words(rows: Any) -> str:
    return "\n".join(" ".join(repr(x) for x in row) for row in np.asarray(rows).tolist())


def stl(points: np.ndarray, faces: Any) -> bytes:
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    records = np.zeros(len(faces), kind)
    records["corners"] = points[np.array(faces)]
    return b"solid by its first word".ljust(80) + len(faces).to_bytes(4, "little") + bytes(records)


def stl_text(points: np.ndarray, faces: Any) -> bytes:
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {words([points[k]])}\n" for k in face)
        + "endloop\nendfacet\n"
        for face in faces
    )
    return f"solid a vertex of 1 2 3\n{facets}endsolid\nsolid\nendsolid".encode()


def obj(points: np.ndarray, faces: Any, back: bool = False) -> bytes:
    lines = [f"v {words([p])} 1.0" for p in points] + ["vt 0 0", "vn 0 0 1", "o part", "s off"]
    count = len(points) if back else -1
    lines += ["f " + " ".join(f"{k - count}/1/1" for k in face) for face in faces]
    return ("# made by hand\nmtllib secret.mtl\n" + "\n".join(lines) + "\n").encode()


def ply(points: np.ndarray, faces: Any, form: str = "ascii") -> bytes:
    head = (
        f"ply\nformat {form} 1.0\ncomment x\nelement vertex {len(points)}\nproperty float x\n"
        f"property float y\nproperty float z\nproperty uchar red\nelement face {len(faces)}\n"
        "property list uchar int vertex_indices\nproperty float quality\nend_header\n"
    ).encode()
    if form == "ascii":
        body = words(np.c_[points, np.zeros(len(points))]) + "\n"
        body += "\n".join(f"{len(f)} {' '.join(map(str, f))} 0.5" for f in faces)
        return head + body.encode()
    order = "<" if "little" in form else ">"
    rows = np.zeros(len(points), [("at", order + "f4", 3), ("red", "u1")])
    rows["at"] = points
    body = bytes(rows)
    for face in faces:
        body += bytes([len(face)]) + np.array(face, order + "i4").tobytes()
        body += np.array(0.5, order + "f4").tobytes()
    return head + body


def biomesh(points: np.ndarray, faces: Any) -> bytes:
    head = f"version 2\nnpoints {len(points)}\nnfaces {len(faces)}\n"
    return (
        head + words(np.c_[points, points]) + "\n" + words(np.c_[[3] * len(faces), faces])
    ).encode()


def vtp(
    points: np.ndarray,
    polygons: Any,
    form: str = "ascii",
    pack: str = "",
    strips: Any = (),
    order: str = "<",
    size: str = "UInt32",
    encoding: str = "raw",
) -> bytes:
    """As VTK's documentation has it: https://docs.vtk.org, "XML file formats"."""
    appended = b""
    header = np.dtype(order + {"UInt32": "u4", "UInt64": "u8"}[size])

    def coded(data: bytes) -> bytes:
        return base64.b64encode(data) if form == "binary" or encoding == "base64" else data

    def encoded(array: np.ndarray) -> bytes:
        data = array.tobytes()
        if not pack:
            return coded(np.array([len(data)], header).tobytes() + data)
        squeeze = {"vtkZLibDataCompressor": zlib.compress, "vtkLZMADataCompressor": lzma.compress}
        blocks = [data[k : k + 32] for k in range(0, len(data), 32)]
        packed = [squeeze[pack](block) for block in blocks]
        sizes = [len(blocks), 32, len(data) % 32, *map(len, packed)]
        return coded(np.array(sizes, header).tobytes()) + coded(b"".join(packed))

    def array(name: str, values: Any, kind: str, columns: int = 1) -> str:
        nonlocal appended
        start = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{columns}"'
        data = np.asarray(values, order + {"Float32": "f4", "Int32": "i4"}[kind])
        if form == "ascii":
            return f'{start} format="ascii">{words([data.ravel()])}</DataArray>'
        if form == "binary":
            return f'{start} format="binary">\n {encoded(data).decode()}\n</DataArray>'
        offset, appended = len(appended), appended + encoded(data)
        return f'{start} format="appended" offset="{offset}"/>'

    def cells(tag: str, rows: Any) -> str:
        flat = [k for row in rows for k in row]
        ends = np.cumsum([len(row) for row in rows], dtype=int)
        inner = array("connectivity", flat, "Int32") + array("offsets", ends, "Int32")
        return f"<{tag}>{inner}</{tag}>"

    head = (
        f'<VTKFile type="PolyData" version="1.0" byte_order="{"Little" if order == "<" else "Big"}'
        f'Endian" header_type="{size}"' + (f' compressor="{pack}"' if pack else "") + ">"
        f'<PolyData><Piece NumberOfPoints="{len(points)}" NumberOfPolys="{len(polygons)}">'
        f"<PointData>{array('Normals', points, 'Float32', 3)}</PointData>"
        f"<Points>{array('Points', points, 'Float32', 3)}</Points>"
        f"{cells('Polys', polygons)}{cells('Strips', strips)}</Piece></PolyData>"
    ).encode()
    if form == "appended":
        head += f'<AppendedData encoding="{encoding}">\n_'.encode() + appended + b"</AppendedData>"
    return head + b"</VTKFile>"


DAE = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="{unit}"/><up_axis>{up}</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert><diffuse>
<color>1 0.5 0 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#{effect}"/></material>
</library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="{count}">{points}</float_array><technique_common>
<accessor source="#a" count="{n}" stride="3"><param name="X" type="float"/><param name="Y"
 type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
{primitive}</mesh></geometry></library_geometries>
{nodes}
<library_visual_scenes><visual_scene id="S">{scene}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#S"/></scene></COLLADA>"""
SHOWN = (
    '<instance_geometry url="#g"><bind_material><technique_common>'
    '<instance_material symbol="x" target="#m"/></technique_common></bind_material>'
    "</instance_geometry>"
)


def dae(points: np.ndarray, polygons: Any, **more: Any) -> bytes:
    corners = " ".join(str(k) for face in polygons for k in face)
    sizes = " ".join(str(len(face)) for face in polygons)
    options = {
        "unit": 1, "up": "Y_UP", "effect": "e", "nodes": "",
        "scene": f'<node id="n">{SHOWN}</node>',
        "primitive": f'<polylist material="x" count="{len(polygons)}"><input semantic="VERTEX" '
        f'source="#v" offset="0"/><vcount>{sizes}</vcount><p>{corners}</p></polylist>',
    }  # fmt: skip
    return DAE.format(
        count=points.size, n=len(points), points=words([points.ravel()]), **{**options, **more}
    ).encode()
