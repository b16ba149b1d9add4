"""How a flight begins: attitude, what spins it, and what each joint does."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal, get_args

import numpy as np

from somersault._core.checks import by_name, instance
from somersault._core.errors import SomersaultError
from somersault._core.numbers import MOST, number, numbers
from somersault.model import LIMIT_SLACK, Joint, Model
from somersault.model._mirror import sides
from somersault.motion._path import Path, check, moves, value

Motion = Literal["locked", "free", "sprung", "prescribed", "compliant"]
_ON_PATHS = ("prescribed", "compliant")


@dataclass(frozen=True)
class JointTakeoff:
    """One joint at takeoff and after.

    "locked" holds its angle; "free" swings; "sprung" has stiffness (N m/rad), damping
    (N m s/rad) and a rest angle, or with `hold` is pretensioned so that at its takeoff angle
    it balances the nominal spin; "prescribed" moves smoothly through `angles` at `times` (s),
    at rest at each, or along a `path`; "compliant" is a spring and a damper about such a path,
    beside the torque of the takeoff's motor tape, and with `following` its stiffness and
    damping are those of an inertia of 1 kg m², and are multiplied by what is outboard of the joint
    in the path's own pose, as it changes. `pretension` (N m) is a constant torque beside the
    spring's and beside what `hold` gives. A ball's `angle` is a rotation vector and its `rate` an
    angular velocity, both along its body's axes. A joint that moves freely goes through its
    limits unless it has a `stop_stiffness` (N m/rad) there, with a `stop_damping` (N m s/rad).
    What is None comes from the model: sprung where it has stiffness or is given some, else locked
    at the pose in which the file draws it.
    """

    motion: Motion | None = None
    angle: float | Sequence[float] | None = None
    rate: float | Sequence[float] = 0.0
    stiffness: float | None = None
    damping: float | None = None
    rest: float | None = None
    pretension: float = 0.0
    hold: bool = False
    times: Sequence[float] = ()
    angles: Sequence[float] = ()
    path: Path | None = None
    following: bool = False
    stop_stiffness: float = 0.0
    stop_damping: float = 0.0


@dataclass(frozen=True)
class Takeoff:
    """The start of a flight. SI units and radians.

    Attitude by `somersault`, `tilt`, `twist`, about the model's `axes` (2, 1, 3 unless it says
    otherwise), or by a `quaternion` (body to inertial). One of
    `spin` (rad/s about the inertial axis of somersault, the rate of the nominal steady spin:
    Φ̇ = spin, and Θ̇ and Ψ̇ are `tilt_rate` and `twist_rate`, whatever the attitude),
    `angular_velocity` (body axes) or `angular_momentum` (inertial axes, kg m²/s).
    `velocity` is that of the centre of mass (m/s). `tape` is the angular momentum (body
    axes, kg m²/s) at takeoff of the nominal flight whose joint torques are replayed to compliant
    joints: that of the same paths, exactly followed.
    """

    somersault: float = 0.0
    tilt: float = 0.0
    twist: float = 0.0
    quaternion: Sequence[float] | None = None
    spin: float | None = None
    tilt_rate: float = 0.0
    twist_rate: float = 0.0
    angular_velocity: Sequence[float] | None = None
    angular_momentum: Sequence[float] | None = None
    velocity: Sequence[float] = (0.0, 0.0, 0.0)
    tape: Sequence[float] | None = None
    joints: Mapping[str, JointTakeoff] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", by_name("takeoff joints", self.joints))
        for name, joint in self.joints.items():
            instance(f"takeoff of joint {name}", joint, JointTakeoff)
        for name in ("somersault", "tilt", "twist", "tilt_rate", "twist_rate"):
            number(f"takeoff {name}", getattr(self, name))
        for name, size in (
            ("quaternion", 4),
            ("angular_velocity", 3),
            ("angular_momentum", 3),
            ("velocity", 3),
            ("tape", 3),
        ):
            if getattr(self, name) is not None or name == "velocity":
                most = np.inf if name == "quaternion" else MOST  # of any length
                numbers(f"takeoff {name}", getattr(self, name), size, most)
        given = [
            name
            for name in ("spin", "angular_velocity", "angular_momentum")
            if getattr(self, name) is not None
        ]
        if len(given) > 1:
            raise SomersaultError(f"takeoff gives {' and '.join(given)}; give one of them")
        if self.spin is not None and number("takeoff spin", self.spin) == 0:
            raise SomersaultError("takeoff spin must be a rate in rad/s that is not zero")
        if self.spin is None and (self.tilt_rate or self.twist_rate):
            raise SomersaultError("takeoff tilt_rate and twist_rate go with spin; give that too")
        if self.quaternion is not None:
            if self.somersault or self.tilt or self.twist:
                raise SomersaultError("takeoff gives both angles and a quaternion; give one")
            if not np.any(self.quaternion):
                raise SomersaultError("takeoff quaternion is zero, which is no attitude")


def require_takeoff(takeoff: Any) -> None:
    """SomersaultError for anything that is not a takeoff."""
    if not isinstance(takeoff, Takeoff):
        raise SomersaultError(f"a takeoff is a somersault.Takeoff, and not {takeoff!r}")


@dataclass(frozen=True)
class Kind:
    """What the equations must know of a joint: its motion, whether its gains follow its path, and
    whether it has stops."""

    motion: Motion
    following: bool = False
    stopped: bool = False


@dataclass(frozen=True)
class JointPlan:
    """A joint's takeoff with everything the model leaves to it filled in."""

    joint: Joint
    motion: Motion
    position: tuple[float, ...]
    rate: tuple[float, ...]
    stiffness: float
    damping: float
    rest: float
    pretension: float = 0.0
    hold: bool = False
    times: tuple[float, ...] = ()
    angles: tuple[float, ...] = ()
    given: Path | None = None
    following: bool = False
    stops: tuple[float, ...] = ()
    """Lower and upper limit, stiffness and damping beyond them."""

    @property
    def on_path(self) -> bool:
        """Whether it is moved, or pulled, along a path."""
        return self.motion in _ON_PATHS

    @property
    def kind(self) -> Kind:
        """What the equations must know of it."""
        return Kind(self.motion, self.following, bool(self.stops))


def kinds(plans: tuple[JointPlan, ...]) -> tuple[Kind, ...]:
    """What each joint does: flights that do the same share their equations."""
    return tuple(plan.kind for plan in plans)


def plans(model: Model, joints: Mapping[str, JointTakeoff]) -> tuple[JointPlan, ...]:
    """One plan a joint, in the model's order; SomersaultError for what does not fit.

    A left–right pair may be named once, by its common name; the right side is mirrored.
    """
    given = by_joint(model, joints)
    return tuple(_plan(joint, given.get(joint.name, JointTakeoff())) for joint in model.joints)


def by_joint(model: Model, joints: Mapping[str, JointTakeoff]) -> dict[str, JointTakeoff]:
    """Takeoffs by the joints' own names, pairs spelled out; SomersaultError as of `plans`."""
    given: dict[str, JointTakeoff] = {}
    for name, takeoff in joints.items():
        both = sides(model, name)
        first = next(iter(both))
        for joint, (factor, offset) in both.items():
            model.joint(joint)
            if joint in given:
                raise SomersaultError(f"joint {joint} is given twice, alone and with its pair")
            image = joint != first
            given[joint] = _mirrored(takeoff, first, factor, offset) if image else takeoff
    return given


def _mirrored(takeoff: JointTakeoff, left: str, factor: float, offset: float) -> JointTakeoff:
    def image(angle: Any) -> float | None:
        return None if angle is None else offset + factor * number(f"joint {left}", angle)

    return replace(
        takeoff,
        angle=image(takeoff.angle),
        rate=factor * number(f"joint {left}: rate", takeoff.rate),
        rest=image(takeoff.rest),
        pretension=factor * number(f"joint {left}: pretension", takeoff.pretension),
        angles=[image(angle) or 0.0 for angle in numbers(f"joint {left}: angles", takeoff.angles)],
        path=takeoff.path.image(factor, offset) if isinstance(takeoff.path, Path) else takeoff.path,
    )


def _plan(joint: Joint, given: JointTakeoff) -> JointPlan:
    plan = _moving(joint, given)
    stiffness, damping = (
        number(f"joint {joint.name}: {name}", getattr(given, name))
        for name in ("stop_stiffness", "stop_damping")
    )
    if not stiffness and not damping:
        return plan
    if stiffness <= 0 or damping < 0:
        raise SomersaultError(
            f"joint {joint.name} needs a positive stop_stiffness for its stops, and a stop_damping "
            "that is not negative"
        )
    if plan.motion in ("locked", "prescribed") or joint.limits is None:
        reason = "has no limits" if joint.limits is None else f"is {plan.motion}"
        raise SomersaultError(f"joint {joint.name} {reason}, so stops would do nothing")
    return replace(plan, stops=(*joint.limits, stiffness, damping))


def _moving(joint: Joint, given: JointTakeoff) -> JointPlan:
    where = f"joint {joint.name}"
    for name in ("stiffness", "damping", "rest"):
        if getattr(given, name) is not None:
            number(f"{where}: {name}", getattr(given, name))
    motion = _motion(joint, given, where)
    for name in ("hold", "following"):
        if not isinstance(getattr(given, name), bool | np.bool_):
            raise SomersaultError(f"{where}: {name} must be true or false")
    if given.hold and (motion != "sprung" or given.rest is not None):
        raise SomersaultError(f"{where}: hold is for a sprung joint without a rest of its own")
    pretension = number(f"{where}: pretension", given.pretension)
    if pretension and motion in ("locked", *_ON_PATHS):
        raise SomersaultError(f"{where} is {motion}, so its pretension would do nothing")
    if joint.kind == "ball" and pretension:
        raise SomersaultError(f"{where} is a ball, which takes no pretension; leave it out")
    if joint.kind == "ball" and (given.rest is not None or given.hold or motion in _ON_PATHS):
        raise SomersaultError(
            f"{where} is a ball: it can be locked, free or sprung about the pose it is drawn in"
        )
    if motion in _ON_PATHS:
        return _along_path(joint, motion, given, where)
    if len(given.times) or len(given.angles) or given.path is not None or given.following:
        raise SomersaultError(
            f"{where} has a path or times but is {motion}, not prescribed or compliant"
        )
    position, rate = _position(joint, given, where)
    if motion == "locked" and (any(rate) or given.damping):
        raise SomersaultError(f"{where} is locked; leave its rate and damping out")
    stiffness = damping = 0.0
    if motion == "sprung":
        stiffness = joint.stiffness if given.stiffness is None else given.stiffness
    if motion != "locked":
        damping = joint.damping if given.damping is None else given.damping
    rest = position[0] if given.hold else joint.rest if given.rest is None else given.rest
    return JointPlan(
        joint, motion, position, rate, stiffness, damping, rest, pretension, given.hold
    )


def _position(
    joint: Joint, given: JointTakeoff, where: str
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Coordinates and speeds of a joint at takeoff."""
    if joint.kind == "ball":
        turn = numbers(f"{where}: angle", (0, 0, 0) if given.angle is None else given.angle, 3)
        still = isinstance(given.rate, float | int) and given.rate == 0
        rate = numbers(f"{where}: rate", (0, 0, 0) if still else given.rate, 3)
        half = np.linalg.norm(turn) / 2
        vector = np.sinc(half / np.pi) / 2 * turn
        return (float(np.cos(half)), *vector.tolist()), tuple(rate.tolist())
    angle = joint.reference if given.angle is None else number(f"{where}: angle", given.angle)
    _within(joint, angle, angle, where)
    return (angle,), (number(f"{where}: rate", given.rate),)


def _motion(joint: Joint, given: JointTakeoff, where: str) -> Motion:
    """What the joint does, asked or taken from the model."""
    if given.damping is not None and given.damping < 0:
        raise SomersaultError(f"{where} has negative damping; dampers are not negative")
    if given.motion is None:
        sprung = joint.stiffness > 0 if given.stiffness is None else True
        return "sprung" if sprung else "locked"
    if not isinstance(given.motion, str) or given.motion not in get_args(Motion):
        raise SomersaultError(
            f"{where}: {given.motion!r} is no motion; use {', '.join(get_args(Motion))}"
        )
    if given.motion == "compliant" and given.rest is not None:
        raise SomersaultError(f"{where} is compliant about its path, so leave its rest out")
    if given.motion not in ("sprung", "compliant") and (given.stiffness or given.rest is not None):
        raise SomersaultError(
            f"{where} is {given.motion}, so its spring would do nothing; leave it out"
        )
    return given.motion


def _along_path(joint: Joint, motion: Motion, given: JointTakeoff, where: str) -> JointPlan:
    if given.angle is not None or given.rate or (given.damping and motion == "prescribed"):
        raise SomersaultError(f"{where} is {motion}: its angle and rate come from its path")
    if given.following and motion != "compliant":
        raise SomersaultError(f"{where} is {motion}, so it has no stiffness that could follow")
    if motion == "compliant" and (given.stiffness is None or given.damping is None):
        raise SomersaultError(f"{where} is compliant; give its stiffness and damping")
    if motion == "compliant" and (given.stiffness or 0.0) < 0:
        raise SomersaultError(f"{where} is compliant; its stiffness must not be negative")
    knots: tuple[float, ...] = ()
    held: tuple[float, ...] = ()
    if given.path is not None:
        if not isinstance(given.path, Path):
            raise SomersaultError(
                f"{where}: path is {type(given.path).__name__}, not one joint's path; of a Motion "
                "take the joints that its prescribed() gives"
            )
        if len(given.times) or len(given.angles):
            raise SomersaultError(f"{where} has both a path and times with angles; give one")
        whole = given.path  # of a `Motion`, which has seen to limits with a slack of its own
    else:
        times = numbers(f"{where}: times", given.times)
        angles = numbers(f"{where}: angles", given.angles)
        try:
            check(times, angles)
        except SomersaultError as mistake:
            raise SomersaultError(f"{where}: its path {mistake}") from None
        knots, held = tuple(times.tolist()), tuple(angles.tolist())
        whole = moves(times, angles)
        # A smooth move does not overshoot its ends.
        _within(joint, min(held), max(held), where)
    angle, rate = value(whole, 0.0)
    return JointPlan(
        joint, motion, (angle,), (rate,), given.stiffness or 0.0, given.damping or 0.0, 0.0,
        times=knots, angles=held, given=given.path, following=given.following,
    )  # fmt: skip


def _within(joint: Joint, low: float, high: float, where: str) -> None:
    if joint.limits is None:
        return
    least, most = joint.limits
    if low < least - LIMIT_SLACK or high > most + LIMIT_SLACK:
        worst = low if low < least - LIMIT_SLACK else high
        raise SomersaultError(
            f"{where}: angle {worst:g} is outside its limits {least:g} to {most:g}"
        )
