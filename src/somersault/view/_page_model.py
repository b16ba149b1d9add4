"""What a page is told of a model's looks."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault.model import Model, model_shapes
from somersault.model.shapes import Mesh, Shape, lighter
from somersault.view._meshes import colour_of, of_trunk

_KINDS = {"f4": "<f4", "u2": "<u2", "u4": "<u4"}
_LEAST = 24  # triangles that each mesh may keep
_BYTES = 40  # of a triangle, or more where edges are sharp


def block(values: Array, kind: str = "f4") -> dict[str, str]:
    """Numbers as the page reads them: little-endian, in base64."""
    data = np.ascontiguousarray(values, _KINDS[kind]).tobytes()
    return {"type": kind, "base64": base64.b64encode(data).decode("ascii")}


def model_record(model: Model, most: int) -> dict[str, Any]:
    """A model by its bodies' names and shapes, whose meshes are made coarser until what they are
    written in is no longer than `most` bytes."""
    rows = model_shapes(model)
    triangles = most // _BYTES
    while True:
        few = lighter(rows, triangles, _LEAST)
        bodies: list[dict[str, Any]] = [
            {"name": body.name, "shapes": [_shape(shape, trunk) for shape in row]}
            for body, row, trunk in zip(model.bodies, few, of_trunk(model), strict=True)
        ]
        size = sum(_size(shape) for body in bodies for shape in body["shapes"])
        if size <= most or triangles < len(rows):
            return {"name": model.name, "bodies": bodies}
        triangles = int(0.9 * triangles * most / size)


def _size(shape: dict[str, Any]) -> int:
    return sum(len(shape[name]["base64"]) for name in ("vertices", "faces") if name in shape)


def _shape(shape: Shape, trunk: bool) -> dict[str, Any]:
    opacity = 1.0 if shape.color is None else shape.color[3]
    color = [*colour_of(shape.color, trunk), opacity]
    if isinstance(shape, Mesh):
        return {**_mesh(shape), "color": color}
    return {
        "kind": shape.kind,
        "sizes": list(shape.sizes),
        "position": list(shape.position),
        "rotation": [list(row) for row in shape.rotation],
        "color": color,
    }


def _mesh(mesh: Mesh) -> dict[str, Any]:
    """By its triangles, in which sharp edges have corners of their own."""
    surface = mesh.triangles
    return {
        "kind": mesh.kind,
        "vertices": block(surface.vertices),
        "faces": block(surface.faces, "u2" if len(surface.vertices) < 2**16 else "u4"),
        "position": [0.0, 0.0, 0.0],
        "rotation": np.eye(3).tolist(),
    }
