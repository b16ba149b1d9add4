"""Torques and energy of joint springs and dampers, over symbols.

A hinge's or slide's spring gives −k (q − rest); a ball's gives −k times the rotation vector
from rest (as in MJCF); a damper gives −b times the joint's speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import casadi as ca

from somersault.dynamics._vector import Scalar, Vec, add, dot, is_zero, mul, scale, sub
from somersault.model._types import Joint, Model

_KINDS = ("stiffness", "rest", "damping")


def parameter_names(model: Model) -> list[str]:
    """Every spring and damper number that can be kept symbolic."""
    return [
        f"{kind}.{joint.name}"
        for joint in model.joints
        for kind in _KINDS
        if kind != "rest" or joint.kind != "ball"
    ]


def parameter_value(model: Model, name: str) -> float:
    """The number that a model has for one of `parameter_names`."""
    kind, _, joint = name.partition(".")
    return getattr(model.joint(joint), kind)


def torques(
    model: Model, q: Sequence[Scalar], speeds: Sequence[Scalar], symbols: Mapping[str, Any]
) -> list[Scalar]:
    """What springs and dampers do at each joint speed, N m (N for a slide)."""
    result: list[Scalar] = []
    for joint in model.joints:
        stretch = _stretch(model, joint, q, symbols)
        own = list(speeds[model.speed_slice(joint.name)])
        spring = scale(_number(joint, "stiffness", symbols), stretch)
        damper = scale(_number(joint, "damping", symbols), own)
        result += [sub(0.0, add(s, d)) for s, d in zip(spring, damper, strict=True)]
    return result


def energy(model: Model, q: Sequence[Scalar], symbols: Mapping[str, Any]) -> Scalar:
    """½ k (stretch)², summed, in J."""
    result: Scalar = 0.0
    for joint in model.joints:
        stretch = _stretch(model, joint, q, symbols)
        half = mul(0.5, _number(joint, "stiffness", symbols))
        result = add(result, mul(half, dot(stretch, stretch)))
    return result


def _number(joint: Joint, kind: str, symbols: Mapping[str, Any]) -> Scalar:
    return symbols.get(f"{kind}.{joint.name}", float(getattr(joint, kind)))


def _stretch(model: Model, joint: Joint, q: Sequence[Scalar], symbols: Mapping[str, Any]) -> Vec:
    """How far the joint is from rest, along each of its speeds."""
    if is_zero(_number(joint, "stiffness", symbols)):
        return [0.0] * joint.speeds
    own = q[model.coordinate_slice(joint.name)]
    if joint.kind != "ball":
        return [sub(own[0], _number(joint, "rest", symbols))]
    return _rotation_vector(own)


def _rotation_vector(quaternion: Sequence[Any]) -> Vec:
    """Axis times angle of a unit quaternion, of the shorter way round.

    The tiny number under the root makes the value and its derivative right at no rotation.
    """
    w, x, y, z = quaternion
    length = ca.sqrt(x * x + y * y + z * z + 1e-300)
    # q and −q are one rotation: measured from the nearer of the two.
    ratio = 2 * ca.atan2(length, ca.fabs(w)) / length * (1 - 2 * (w < 0))
    return [ratio * x, ratio * y, ratio * z]
