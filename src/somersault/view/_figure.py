"""Posed models as solids seen from afar."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.attitude import AXES, in_sequence
from somersault.attitude import Axes as BodyAxes
from somersault.model import Body, Model, body_frames, centre_of_mass, load, shipped

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_STICK = 0.02  # radius of a stick, over the size of the model
_ROUND = np.linspace(0, 2 * np.pi, 25)[:-1]


@dataclass(frozen=True, eq=False)
class Solid:
    """All that is within `radius` of the hull of some points (n, 3), in the axes of a body."""

    body: int
    points: Array
    radius: float


# --------------------------------------------------------------------- what they look like


@cache
def solids(model: Model) -> tuple[Solid, ...]:
    """The shapes that a shipped model's file draws; of any other model, sticks."""
    if model.name in shipped() and load(model.name, model.axes) == model:
        found = _drawn(model)
        if found:
            return found
    return _sticks(model)


def _drawn(model: Model) -> tuple[Solid, ...]:
    """Geoms of a shipped model's file, each in the axes of the body that it is part of."""
    from importlib.resources import as_file, files

    import mujoco

    with as_file(files("somersault.model") / "shipped" / f"{model.name}.xml") as path:
        compiled = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(compiled)
    mujoco.mj_kinematics(compiled, data)
    names = [body.name for body in model.bodies]
    found = []
    for geom in range(compiled.ngeom):
        owner = int(compiled.geom_bodyid[geom])
        while owner and compiled.body(owner).name not in names:
            owner = int(compiled.body_parentid[owner])
        core = _core(int(compiled.geom_type[geom]), compiled.geom_size[geom])
        if not owner or core is None:
            continue
        points, radius = core
        world = points @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
        own = (world - data.xpos[owner]) @ data.xmat[owner].reshape(3, 3)
        found.append(Solid(names.index(compiled.body(owner).name), own, radius))
    return tuple(found)


def _core(kind: int, size: Array) -> tuple[Array, float] | None:
    """Points and radius of a geom in its own axes; None for what is no solid here."""
    from mujoco import mjtGeom

    ends = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
    corners = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    rim = np.stack([np.cos(_ROUND), np.sin(_ROUND), 0 * _ROUND], -1)
    if kind == mjtGeom.mjGEOM_SPHERE:
        return np.zeros((1, 3)), float(size[0])
    if kind == mjtGeom.mjGEOM_CAPSULE:
        return ends * size[1], float(size[0])
    if kind == mjtGeom.mjGEOM_BOX:
        return corners * size, 0.0
    if kind == mjtGeom.mjGEOM_CYLINDER:
        return np.concatenate([rim * size[0] + end * size[1] for end in ends]), 0.0
    if kind == mjtGeom.mjGEOM_ELLIPSOID:
        slices = [
            np.column_stack([np.sin(p) * rim[:, :2], np.full(len(rim), np.cos(p))])
            for p in np.linspace(0, np.pi, 13)
        ]
        return np.concatenate(slices) * size, 0.0
    return None


def _sticks(model: Model) -> tuple[Solid, ...]:
    """From each body's joint to its centre of mass and to the joints of its children."""
    segments = []
    for index, body in enumerate(model.bodies):
        com = np.array(body.com)
        start = np.array(body.joints[0].anchor) if body.joints else com
        ends = [com, *(_joint_in(child) for child in model.bodies if child.parent == index)]
        segments += [(index, np.array([start, end])) for end in ends]
    size = max((float(np.abs(points).max()) for _, points in segments), default=0.0) or 1.0
    return tuple(Solid(index, points, _STICK * size) for index, points in segments)


def _joint_in(child: Body) -> Array:
    """A child's joint in its parent's axes."""
    anchor = np.array(child.joints[0].anchor) if child.joints else np.zeros(3)
    return np.array(child.position) + np.array(child.rotation) @ anchor


# ------------------------------------------------------------------------------- pictures


def camera(azimuth: float, elevation: float, axes: BodyAxes = AXES) -> Array:
    """Rows right, up and towards the eye (3, 3); angles in degrees, from the axis of tilt (front)
    towards the body's left and up the axis of twist (head)."""
    a, e = np.radians([azimuth, elevation])
    eye = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    seen = np.stack([right, np.cross(eye, right), eye])
    return seen @ np.array(in_sequence(list(np.eye(3)), axes))


def draw_pose(
    ax: Axes,
    model: Model,
    q: Array,
    attitude: Array,
    view: Array,
    at: tuple[float, float] = (0.0, 0.0),
    color: str = "#56B4E9",
    base: str = "#dfe9f3",
) -> None:
    """A posed model with its centre of mass at a point of the picture, in parallel projection.

    `attitude` (3, 3) takes the base's axes to inertial ones, `view` is a `camera`. The base
    and what moves against it have colours of their own; far parts are painted first.
    """
    from matplotlib.patches import Polygon

    rotations, origins = body_frames(model, q)
    centre = centre_of_mass(model, q)
    drawn = []
    for solid in solids(model):
        inside = origins[solid.body] + solid.points @ rotations[solid.body].T - centre
        seen = inside @ attitude.T @ view.T
        drawn.append((float(seen[:, 2].mean()), seen[:, :2], solid))
    for depth, flat, solid in sorted(drawn, key=lambda part: part[0]):
        outline = _outline(flat, solid.radius) + np.array(at)
        shade = base if solid.body == 0 else color
        ax.add_patch(
            Polygon(
                outline, fc=shade, ec="#000000", lw=0.7, zorder=3 + 1e-3 * depth, joinstyle="round"
            )
        )


def _outline(flat: Array, radius: float) -> Array:
    """The hull (k, 2) of points in the picture, each with a disc around it."""
    from scipy.spatial import ConvexHull

    # A box has sharp corners; the disc of a tenth of a millimetre keeps its hull from degenerating.
    disc = max(radius, 1e-4) * np.stack([np.cos(_ROUND), np.sin(_ROUND)], -1)
    cloud = (flat[:, None, :] + disc).reshape(-1, 2)
    return cloud[ConvexHull(cloud).vertices]
