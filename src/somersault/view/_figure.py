"""Posed models as solids seen from afar."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault._core.numbers import numbers
from somersault.attitude import AXES, in_sequence
from somersault.attitude import Axes as BodyAxes
from somersault.model import Model, body_frames, centre_of_mass, model_shapes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ROUND = np.linspace(0, 2 * np.pi, 25)[:-1]


def camera(azimuth: float, elevation: float, axes: BodyAxes = AXES) -> Array:
    """Which way one looks.

    Parameters
    ----------
    azimuth, elevation : float
        Of the eye in degrees, from the axis of tilt (front) towards the body's left, and up the
        axis of twist (head).
    axes : tuple of int
        The axes of somersault, tilt and twist.

    Returns
    -------
    ndarray, (3, 3)
        Rows right, up and towards the eye.

    Examples
    --------
    >>> from somersault.view import camera
    >>> camera(0.0, 0.0).round(12).tolist()  # from the front: the body's left is on the right
    [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    """
    a, e = np.radians(numbers("azimuth and elevation", [azimuth, elevation], 2))
    eye = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    seen = np.stack([right, np.cross(eye, right), eye])
    return seen @ np.array(in_sequence(list(np.eye(3)), axes))


def hulls(model: Model, q: Array) -> list[tuple[int, Array, float]]:
    """What there is to see of a posed model: for each of its shapes the body it belongs to, and the
    points (…, n, 3) and radius of its hull, in the base's axes and from the centre of mass."""
    rotations, origins = body_frames(model, q)
    origins = origins - centre_of_mass(model, q)[..., None, :]
    return [
        (
            body,
            shape.hull.points @ np.swapaxes(rotations[..., body, :, :], -1, -2)
            + origins[..., body, None, :],
            shape.hull.radius,
        )
        for body, shapes in enumerate(model_shapes(model))
        for shape in shapes
    ]


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

    Far parts are painted first, each shape as the outline of its hull.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    model : Model
    q : ndarray, (coordinates,)
        Joint coordinates.
    attitude : ndarray, (3, 3)
        From the base's axes to inertial ones.
    view : ndarray, (3, 3)
        A `camera`.
    at : (float, float)
        Where the centre of mass stands in the picture, m.
    color, base : str
        Of what moves against the base, and of the base.

    Examples
    --------
    >>> import numpy as np
    >>> import somersault as so
    >>> from matplotlib.figure import Figure
    >>> model, axes = so.load("furrer"), Figure().subplots()
    >>> q = so.model.pose(model, {"shoulder": 1.3})
    >>> so.view.draw_pose(axes, model, q, np.eye(3), so.view.camera(0.0, 0.0))
    >>> len(axes.patches) > 0
    True
    """
    from matplotlib.patches import Polygon

    drawn = []
    for body, points, radius in hulls(model, q):
        seen = points @ attitude.T @ view.T
        drawn.append((float(seen[:, 2].mean()), seen[:, :2], radius, body))
    for depth, flat, radius, body in sorted(drawn, key=lambda part: part[0]):
        outline = _outline(flat, radius) + np.array(at)
        shade = base if body == 0 else color
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
