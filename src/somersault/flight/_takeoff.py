"""How a flight begins: attitude, what spins it, and what each joint does."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from somersault._errors import SomersaultError
from somersault.flight._moves import extremes
from somersault.model import Joint, Model

Motion = Literal["locked", "free", "sprung", "prescribed"]


@dataclass(frozen=True)
class JointTakeoff:
    """One joint at takeoff and after.

    "locked" holds its angle; "free" swings; "sprung" has stiffness (N m/rad), damping
    (N m s/rad) and a rest angle, or with `hold` the rest angle at which the spring balances
    the nominal spin; "prescribed" moves smoothly through `angles` at `times` (s), at rest at
    each. What is None comes from the model: sprung where it has stiffness, else locked at
    the pose in which the file draws it.
    """

    motion: Motion | None = None
    angle: float | None = None
    rate: float = 0.0
    stiffness: float | None = None
    damping: float | None = None
    rest: float | None = None
    hold: bool = False
    times: Sequence[float] = ()
    angles: Sequence[float] = ()


@dataclass(frozen=True)
class Takeoff:
    """The start of a flight. SI units and radians.

    Attitude by `somersault`, `tilt`, `twist`, or by a `quaternion` (body to inertial). One of
    `spin` (rad/s of the nominal steady spin: the angular momentum is that of the takeoff pose
    turning so about its principal axis nearest 2, along inertial axis 2, whatever the
    attitude), `angular_velocity` (body axes) or `angular_momentum` (inertial axes, kg m²/s).
    `velocity` is that of the centre of mass (m/s).
    """

    somersault: float = 0.0
    tilt: float = 0.0
    twist: float = 0.0
    quaternion: Sequence[float] | None = None
    spin: float | None = None
    angular_velocity: Sequence[float] | None = None
    angular_momentum: Sequence[float] | None = None
    velocity: Sequence[float] = (0.0, 0.0, 0.0)
    joints: Mapping[str, JointTakeoff] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in ("somersault", "tilt", "twist"):
            if not math.isfinite(getattr(self, name)):
                raise SomersaultError(f"takeoff {name} is not a finite number; give one in rad")
        for name, size in (
            ("quaternion", 4),
            ("angular_velocity", 3),
            ("angular_momentum", 3),
            ("velocity", 3),
        ):
            value = getattr(self, name)
            if value is not None and (
                np.shape(value) != (size,) or not np.all(np.isfinite(np.asarray(value, float)))
            ):
                raise SomersaultError(f"takeoff {name} must be {size} finite numbers")
        given = [
            name
            for name in ("spin", "angular_velocity", "angular_momentum")
            if getattr(self, name) is not None
        ]
        if len(given) > 1:
            raise SomersaultError(f"takeoff gives {' and '.join(given)}; give one of them")
        if self.spin is not None and (not math.isfinite(self.spin) or self.spin == 0):
            raise SomersaultError("takeoff spin must be a rate in rad/s that is not zero")
        if self.quaternion is not None:
            if self.somersault or self.tilt or self.twist:
                raise SomersaultError("takeoff gives both angles and a quaternion; give one")
            if np.linalg.norm(self.quaternion) == 0:
                raise SomersaultError("takeoff quaternion is zero, which is no attitude")


@dataclass(frozen=True)
class JointPlan:
    """A joint's takeoff with everything the model leaves to it filled in."""

    joint: Joint
    motion: Motion
    position: tuple[float, ...]
    rate: float
    stiffness: float
    damping: float
    rest: float
    hold: bool
    times: tuple[float, ...]
    angles: tuple[float, ...]


def plans(model: Model, joints: Mapping[str, JointTakeoff]) -> tuple[JointPlan, ...]:
    """One plan a joint, in the model's order; SomersaultError for what does not fit."""
    for name in joints:
        model.joint(name)
    return tuple(_plan(joint, joints.get(joint.name, JointTakeoff())) for joint in model.joints)


def _plan(joint: Joint, given: JointTakeoff) -> JointPlan:
    where = f"joint {joint.name}"
    motion: Motion = given.motion or ("sprung" if joint.stiffness > 0 else "locked")
    if motion not in ("locked", "free", "sprung", "prescribed"):
        raise SomersaultError(
            f"{where}: {motion!r} is no motion; use locked, free, sprung or prescribed"
        )
    numbers = (given.angle, given.rate, given.stiffness, given.damping, given.rest)
    if not all(x is None or math.isfinite(x) for x in numbers):
        raise SomersaultError(f"{where} has a number that is not finite")
    if joint.kind == "ball" and (
        given.angle is not None or given.rate or motion == "prescribed" or given.hold
    ):
        raise SomersaultError(
            f"{where} is a ball: it can be locked, free or sprung from the pose it is drawn in"
        )
    if motion == "prescribed":
        return _prescribed(joint, given, where)
    if given.times or given.angles:
        raise SomersaultError(f"{where} has times or angles but is {motion}, not prescribed")
    angle = joint.reference if given.angle is None else given.angle
    _within(joint, angle, angle, where)
    if motion == "locked" and given.rate:
        raise SomersaultError(f"{where} is locked, so it has no rate; leave rate out")
    stiffness, damping = (
        (joint.stiffness if given.stiffness is None else given.stiffness)
        if motion == "sprung"
        else 0.0,
        0.0 if motion == "locked" else joint.damping if given.damping is None else given.damping,
    )
    if given.hold and (motion != "sprung" or stiffness == 0 or given.rest is not None):
        raise SomersaultError(f"{where}: hold needs a spring, and no rest angle of its own")
    rest = joint.rest if given.rest is None else given.rest
    position = joint.home if joint.kind == "ball" else (angle,)
    return JointPlan(
        joint, motion, position, given.rate, stiffness, damping, rest, given.hold, (), ()
    )


def _prescribed(joint: Joint, given: JointTakeoff, where: str) -> JointPlan:
    times, angles = np.asarray(given.times, float), np.asarray(given.angles, float)
    try:
        low, high = extremes(times, angles)
    except SomersaultError as mistake:
        raise SomersaultError(f"{where}: its prescribed path {mistake}") from None
    _within(joint, low, high, where)
    if given.angle is not None or given.rate:
        raise SomersaultError(f"{where} is prescribed, so its angle and rate come from its path")
    return JointPlan(
        joint, "prescribed", (float(angles[0]),), 0.0, 0.0, 0.0, 0.0, False,
        tuple(times.tolist()), tuple(angles.tolist()),
    )  # fmt: skip


def _within(joint: Joint, low: float, high: float, where: str) -> None:
    if joint.limits is None:
        return
    least, most = joint.limits
    if low < least - 1e-9 or high > most + 1e-9:
        worst = low if low < least - 1e-9 else high
        raise SomersaultError(
            f"{where}: angle {worst:g} is outside its limits {least:g} to {most:g}"
        )
