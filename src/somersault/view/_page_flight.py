"""What a page is told of a history: where bodies are, angles and joints, the momentum sphere.

Vectors are along front, left and up, whatever the axes of the model are called.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault.attitude import in_sequence, quaternion_from_matrix
from somersault.history import History
from somersault.model import Model, model_shapes, segment_momenta
from somersault.view._actor import Actor
from somersault.view._page_model import block

_STILL = 5e-3  # rad or m: joints that move less are not shown at first
_MOST_LINES, _STILL_LINES = 7, 2  # that are shown at first, and where none moves
_POSES = 60  # that tell how far the body reaches


def flight_record(history: History, label: str, model: int, most: int) -> dict[str, Any]:
    """A history at `most` samples at most, of the page's model number `model`."""
    count = len(history.times)
    keep = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
    actor = Actor(history, history.times[keep])
    rotations, origins = actor.frames
    momentum = actor.vectors["momentum"]
    reach, floor = _room(actor)
    q = history.joint_coordinates[keep]
    free = history.model.free
    return {
        "label": label,
        "model": model,
        "times": block(actor.moments),
        "frames": block(np.concatenate([origins, quaternion_from_matrix(rotations)], -1)),
        "centre": block(actor.centres),
        "vectors": {
            name: {"values": block(values), "longest": actor.longest[name]}
            for name, values in actor.vectors.items()
        },
        "reach": reach,
        "floor": floor,
        "sphere": _sphere(history.model, q, rotations[:, 0], momentum) if free else None,
        "jointsMove": bool(np.any(np.ptp(q, axis=0) > _STILL)),
        "panels": _panels(history, keep),
    }


def _room(actor: Actor) -> tuple[float, float]:
    """How far the body reaches from its centre of mass, and its lowest point, m."""
    count = len(actor.moments)
    some = np.unique(np.linspace(0, count - 1, min(count, _POSES)).round().astype(int))
    rotations, origins = (values[some] for values in actor.frames)
    reach, floor = 1e-3, np.inf
    for body, shapes in enumerate(model_shapes(actor.history.model)):
        for shape in shapes:
            hull = shape.hull
            points = np.einsum("tij,nj->tni", rotations[:, body], hull.points)
            points += origins[:, body, None]
            away = np.linalg.norm(points - actor.centres[some, None], axis=-1)
            reach = max(reach, float(away.max()) + hull.radius)
            floor = min(floor, float(points[..., 2].min()) - hull.radius)
    return reach, floor


def _sphere(model: Model, q: Array, turns: Array, momentum: Array) -> dict[str, Any]:
    """Principal inertias, and the direction of the angular momentum along the principal axes that
    lie nearest front, left and head. The base's axes stand as `turns` (T, 3, 3) has them."""
    from somersault.stability import principal_axes

    still = np.zeros((len(q), len(model.speeds)))
    unit = [np.broadcast_to(row, (len(q), 3)) for row in np.eye(3)]
    inertia = np.stack([segment_momenta(model, q, row, still).sum(1) for row in unit], -1)
    about = principal_axes((inertia + np.swapaxes(inertia, 1, 2)) / 2)
    parts = np.einsum("tkj,tki,ti->tj", about.axes, np.swapaxes(turns, 1, 2), momentum)
    size = np.linalg.norm(parts, axis=1, keepdims=True)
    direction = np.where(size > 0, parts / np.where(size > 0, size, 1.0), 0.0)
    somersault, tilt, twist = (about.inertias[:, axis - 1] for axis in model.axes)
    return {
        "inertias": block(np.stack([tilt, somersault, twist], -1)),
        "direction": block(np.stack(in_sequence(list(direction.T), model.axes), -1)),
    }


def _panels(history: History, keep: Array) -> list[dict[str, Any]]:
    """Charts: quantities as people read them, turns, degrees, metres."""
    somersault, tilt, twist = history.angles[keep].T
    turn = 2 * np.pi
    panels = []
    if history.model.free:
        panels = [
            _panel("somersault", "turns", 2, [("somersault", somersault / turn)], color=0),
            _panel("tilt", "°", 1, [("tilt", np.degrees(tilt))], color=1),
            _panel("twist", "turns", 2, [("twist", twist / turn)], color=2),
        ]
    for title, unit, digits, kind, scale in (
        ("joints", "°", 1, "hinge", np.degrees(1.0)),
        ("slides", "m", 3, "slide", 1.0),
        ("quaternions", "1", 3, "ball", 1.0),
    ):
        columns = _columns(history.model, kind)
        values = history.joint_coordinates[keep]
        names = [name.replace("_", " ") for name in history.model.coordinates]
        lines = [(names[k], scale * values[:, k]) for k in columns]
        if lines:
            panels.append(_panel(title, unit, digits, lines, _STILL * scale))
    return panels


def _panel(
    title: str,
    unit: str,
    digits: int,
    lines: list[tuple[str, Array]],
    still: float = 0.0,
    color: int = 0,
) -> dict[str, Any]:
    """A chart. Of many lines those are shown at first that move, and not too many."""
    moving = [k for k, (_, values) in enumerate(lines) if np.ptp(values) > still]
    shown = set(moving[:_MOST_LINES] or range(min(len(lines), _STILL_LINES)))
    order = sorted(range(len(lines)), key=lambda k: k not in shown)
    return {
        "title": title,
        "unit": unit,
        "digits": digits,
        "color": color,
        "series": [
            {"name": lines[k][0], "values": block(lines[k][1]), "shown": k in shown} for k in order
        ],
    }


def _columns(model: Model, kind: str) -> list[int]:
    """Which coordinates are those of joints of a kind."""
    return [
        column
        for joint in model.joints
        if joint.kind == kind
        for column in range(len(model.coordinates))[model.coordinate_slice(joint.name)]
    ]
