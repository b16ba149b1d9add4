"""Torques and energy of joint springs and dampers, over symbols.

A hinge's or slide's spring gives −k (q − rest); a ball's gives −k times the rotation vector
from rest (as in MJCF); a damper gives −b times the joint's speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import casadi as ca

from somersault.dynamics._parameters import joint_parameter
from somersault.dynamics.vectors import Scalar, Vec, add, dot, is_zero, mul, scale, sub
from somersault.model import Joint, Model

_KINDS = ("stiffness", "rest", "damping")


def torques(
    model: Model, q: Sequence[Scalar], speeds: Sequence[Scalar], symbols: Mapping[str, Any]
) -> list[Scalar]:
    """What springs and dampers do at each joint speed, N m (N for a slide)."""
    result: list[Scalar] = []
    for joint in model.joints:
        numbers = (_number(joint, kind, symbols) for kind in _KINDS)
        angles = q[model.coordinate_slice(joint.name)]
        result += spring_torques(joint, angles, speeds[model.speed_slice(joint.name)], *numbers)
    return result


def spring_torques(
    joint: Joint,
    q: Sequence[Scalar],
    speeds: Sequence[Scalar],
    stiffness: Scalar,
    rest: Scalar,
    damping: Scalar,
) -> list[Scalar]:
    """What a joint's spring and damper do.

    Parameters
    ----------
    joint : Joint
    q, speeds : sequence
        The joint's own coordinates and speeds.
    stiffness : number
        N m/rad (N/m).
    rest : number
        Where the spring is slack, rad (m).
    damping : number
        N m s/rad (N s/m).

    Returns
    -------
    list
        At each of its speeds, N m (N).
    """
    spring = scale(stiffness, _stretch(joint, q, stiffness, rest))
    damper = scale(damping, list(speeds))
    return [sub(0.0, add(s, d)) for s, d in zip(spring, damper, strict=True)]


def energy(model: Model, q: Sequence[Scalar], symbols: Mapping[str, Any]) -> Scalar:
    """½ k (stretch)², summed, in J."""
    result: Scalar = 0.0
    for joint in model.joints:
        stiffness, rest = (_number(joint, kind, symbols) for kind in ("stiffness", "rest"))
        stretch = _stretch(joint, q[model.coordinate_slice(joint.name)], stiffness, rest)
        result = add(result, mul(mul(0.5, stiffness), dot(stretch, stretch)))
    return result


def _number(joint: Joint, kind: str, symbols: Mapping[str, Any]) -> Scalar:
    return symbols.get(joint_parameter(joint.name, kind), float(getattr(joint, kind)))


def _stretch(joint: Joint, q: Sequence[Scalar], stiffness: Scalar, rest: Scalar) -> Vec:
    """How far the joint is from rest, along each of its speeds."""
    if is_zero(stiffness):
        return [0.0] * joint.speeds
    if joint.kind != "ball":
        return [sub(q[0], rest)]
    return _rotation_vector(q)


def _rotation_vector(quaternion: Sequence[Any]) -> Vec:
    """Axis times angle of a unit quaternion, of the shorter way round.

    The tiny number under the root makes the value and its derivative right at no rotation.
    """
    w, x, y, z = quaternion
    length = ca.sqrt(x * x + y * y + z * z + 1e-300)
    # q and −q are one rotation: measured from the nearer of the two.
    ratio = 2 * ca.atan2(length, ca.fabs(w)) / length * (1 - 2 * (w < 0))
    return [ratio * x, ratio * y, ratio * z]
