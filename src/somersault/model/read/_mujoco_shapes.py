"""What MuJoCo draws of a compiled model's bodies, as shapes."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from somersault._core.errors import SomersaultError
from somersault.attitude import matrix_from_quaternion
from somersault.model._vectors import as_matrix, as_vector
from somersault.model.shapes import Box, Capsule, Color, Cylinder, Ellipsoid, Mesh, Shape, Sphere

_DRAWN = 3  # groups 0, 1 and 2 are drawn unless one asks for more
_NO_COLOR = (0.5, 0.5, 0.5, 1.0)  # what a geom has that is given none


def body_shapes(m: Any) -> dict[int, tuple[Shape, ...]]:
    """Shapes of each body that has any, in its axes, by the body's number.

    Geoms of the groups that MuJoCo's own viewer draws, but for transparent ones; where there are
    none such, all of them. Planes and height fields are no bodies' shapes.
    """
    there = [g for g in range(m.ngeom) if m.geom_bodyid[g] and _opaque(m, g)]
    drawn = [g for g in there if m.geom_group[g] < _DRAWN] or there
    shapes: dict[int, list[Shape]] = {}
    for g in drawn:
        shape = _shape(m, g)
        if shape is not None:
            shapes.setdefault(int(m.geom_bodyid[g]), []).append(shape)
    return {body: tuple(found) for body, found in shapes.items()}


def _opaque(m: Any, g: int) -> bool:
    color = _color(m, g)
    return color is None or color[3] > 0


def _color(m: Any, g: int) -> Color | None:
    """Its own colour, else its material's, else none."""
    own = tuple(m.geom_rgba[g].tolist())
    if own == _NO_COLOR:
        if m.geom_matid[g] < 0:
            return None
        own = tuple(m.mat_rgba[m.geom_matid[g]].tolist())
    red, green, blue, opacity = (min(max(float(x), 0.0), 1.0) for x in own)
    return red, green, blue, opacity


def _shape(m: Any, g: int) -> Shape | None:
    """None for what is no solid, or has no size."""
    make = _makers().get(int(m.geom_type[g]))
    if make is None:
        return None
    pose = {
        "position": as_vector(m.geom_pos[g]),
        "rotation": as_matrix(matrix_from_quaternion(m.geom_quat[g])),
        "color": _color(m, g),
    }
    try:
        return make(m, g, pose)
    except SomersaultError:  # never refuse a flight for its picture
        return None


@cache
def _makers() -> dict[int, Callable[[Any, int, dict[str, Any]], Shape]]:
    """What makes a shape of a geom in a pose, by the number of its kind."""
    from mujoco import mjtGeom

    def sizes(m: Any, g: int) -> tuple[float, float, float]:
        return as_vector(m.geom_size[g])

    return {
        int(mjtGeom.mjGEOM_SPHERE): lambda m, g, pose: Sphere(radius=sizes(m, g)[0], **pose),
        int(mjtGeom.mjGEOM_ELLIPSOID): lambda m, g, pose: Ellipsoid(semi_axes=sizes(m, g), **pose),
        int(mjtGeom.mjGEOM_BOX): lambda m, g, pose: Box(half_sizes=sizes(m, g), **pose),
        int(mjtGeom.mjGEOM_CAPSULE): lambda m, g, pose: Capsule(
            radius=sizes(m, g)[0], half_length=sizes(m, g)[1], **pose
        ),
        int(mjtGeom.mjGEOM_CYLINDER): lambda m, g, pose: Cylinder(
            radius=sizes(m, g)[0], half_length=sizes(m, g)[1], **pose
        ),
        int(mjtGeom.mjGEOM_MESH): _mesh,
        int(mjtGeom.mjGEOM_SDF): _mesh,
    }


def _mesh(m: Any, g: int, pose: dict[str, Any]) -> Shape:
    """A copy, so that the model does not hold the whole of MuJoCo's.

    MuJoCo has moved the vertices to the mesh's own middle and axes, and the geom with them.
    """
    mesh = int(m.geom_dataid[g])
    first, count = int(m.mesh_vertadr[mesh]), int(m.mesh_vertnum[mesh])
    begin, faces = int(m.mesh_faceadr[mesh]), int(m.mesh_facenum[mesh])
    return Mesh(
        vertices=np.array(m.mesh_vert[first : first + count], float),
        faces=np.array(m.mesh_face[begin : begin + faces]),
        **pose,
    )
