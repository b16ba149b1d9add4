"""What the control laws are written with: over numbers, or over CasADi symbols of a controller.

A law is one expression for all robots at all times; where it has cases, each is computed and one is
chosen.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import casadi as ca


def is_known(value: Any) -> bool:
    """Whether it is no symbol of a controller."""
    return not isinstance(value, ca.SX | ca.MX | ca.DM)


def choose(condition: Any, yes: Any, no: Any) -> Any:
    """`yes` where the condition holds, else `no`."""
    return ca.if_else(condition, yes, no)


def clip(value: Any, low: Any, high: Any) -> Any:
    """The value, or the limit that it is beyond."""
    return ca.fmin(ca.fmax(value, low), high)


def all_of(*conditions: Any) -> Any:
    """Whether all of them hold."""
    result = conditions[0]
    for condition in conditions[1:]:
        result = ca.logic_and(result, condition)
    return result


def any_of(*conditions: Any) -> Any:
    """Whether one of them holds."""
    result = conditions[0]
    for condition in conditions[1:]:
        result = ca.logic_or(result, condition)
    return result


def vector(values: Sequence[Any]) -> Any:
    """Three components as one vector."""
    return ca.vertcat(*values)


def rotation(quaternion: Any) -> Any:
    """The matrix of a unit quaternion, scalar first: from the body's axes to the world's."""
    w, x, y, z = ca.vertsplit(quaternion)
    return ca.blockcat([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def about(axis: int, angle: Any) -> Any:
    """The matrix of a turn about axis 1, 2 or 3."""
    c, s = ca.cos(angle), ca.sin(angle)
    rows = {
        1: [[1, 0, 0], [0, c, -s], [0, s, c]],
        2: [[c, 0, s], [0, 1, 0], [-s, 0, c]],
        3: [[c, -s, 0], [s, c, 0], [0, 0, 1]],
    }[axis]
    return ca.blockcat([[ca.SX(x) for x in row] for row in rows])


def wrapped(angle: Any) -> Any:
    """The same angle within half a turn of zero."""
    return ca.atan2(ca.sin(angle), ca.cos(angle))
