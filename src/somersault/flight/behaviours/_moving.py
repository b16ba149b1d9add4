"""A joint that moves freely, and the stops at its limits: what such behaviours share."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.dynamics import spring_torques
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._behaviour import Angle, JointTakeoff
from somersault.flight.behaviours._here import Here
from somersault.flight.behaviours._limits import check_limits
from somersault.model import Joint
from somersault.simulation import Name, Numbers

_STOPS = ("stop_stiffness", "stop_damping")


@dataclass(frozen=True)
class Stopped(JointTakeoff):
    """A joint that is part of the state, with elastic stops at its limits where it is given some.

    A stop is a spring (`stop_stiffness`) and a damper (`stop_damping`) beyond a limit, which only
    push.
    """

    in_state: ClassVar[bool] = True

    stop_stiffness: float = _declared.stiffness(default=0.0)
    stop_damping: float = _declared.damping(default=0.0)

    @property
    def stopped(self) -> bool:
        """Whether it has stops."""
        return bool(self.stop_stiffness)

    def settled(self, joint: Joint) -> JointTakeoff:
        plan = self._checked(joint)
        if not plan.stop_stiffness and not plan.stop_damping:
            return plan
        if plan.stop_stiffness <= 0:
            raise SomersaultError(
                f"joint {joint.name} needs a positive stop_stiffness for its stops, and a "
                "stop_damping that is not negative"
            )
        if joint.limits is None:
            raise SomersaultError(f"joint {joint.name} has no limits, so stops would do nothing")
        return plan

    def kind(self) -> Any:
        return replace(super().kind(), stop_stiffness=1.0 if self.stopped else 0.0)

    def parameters(self, joint: Joint) -> tuple[str, ...]:
        return _STOPS if self.stopped else ()

    def numbers(self, joint: Joint) -> dict[Name, float | Array]:
        every = super().numbers(joint)
        return {n: x for n, x in every.items() if self.stopped or n[0] not in _STOPS}

    def loads(self, here: Here) -> list[Any]:
        acting = self.acting(here)
        return [load + _stop(here) for load in acting] if self.stopped else acting

    def acting(self, here: Here) -> list[Any]:
        """What acts at each of its speeds, but for stops: all that such a behaviour must say.

        Parameters
        ----------
        here : Here

        Returns
        -------
        list
            N m (N for a slide), symbols.
        """
        raise NotImplementedError

    @property
    def conservative(self) -> bool:
        return not self.stopped


@dataclass(frozen=True)
class Moving(Stopped):
    """A joint that starts from an `angle` (rad, m) at a `rate`, with a damper of its own.

    Its `pretension` (N m, N) is a constant torque. The damper is the model's unless it is given.
    """

    angle: Angle = _declared.angle()
    rate: Angle = _declared.rate()
    damping: float | None = _declared.damping()
    pretension: float = _declared.torque()

    def settled(self, joint: Joint) -> JointTakeoff:
        plan = super().settled(joint)
        assert isinstance(plan, Moving)
        if joint.kind == "ball" and plan.pretension:
            raise SomersaultError(
                f"joint {joint.name} is a ball, which takes no pretension; leave it out"
            )
        damping = joint.damping if plan.damping is None else plan.damping
        return replace(plan, angle=takeoff_angle(joint, plan.angle), damping=damping)

    def parameters(self, joint: Joint) -> tuple[str, ...]:
        return (*self.springs(joint), "damping", "pretension", *super().parameters(joint))

    def springs(self, joint: Joint) -> tuple[str, ...]:
        """Names of the parameters of its spring.

        Parameters
        ----------
        joint : Joint

        Returns
        -------
        tuple of str
        """
        return ()

    def numbers(self, joint: Joint) -> dict[Name, float | Array]:
        every = super().numbers(joint)
        return {n: x for n, x in every.items() if joint.kind != "ball" or n[0] != "pretension"}

    def begin(self, joint: Joint, values: Numbers, count: int) -> tuple[Array, Array]:
        q, _ = standing(joint, values, count)
        return q, _declared.side_by_side(values, speed_names(joint, "rate"), count)

    def lasting(self, joint: Joint, values: Numbers, q: Array) -> Array:
        if joint.kind == "ball":
            values = {("pretension", joint.name): 0.0, ("rest", joint.name): 0.0, **values}
        return super().lasting(joint, values, q)

    def acting(self, here: Here) -> list[Any]:
        n = here.numbers
        acting = spring_torques(
            here.joint, here.q, here.u, n.get("stiffness", 0.0), n.get("rest", 0.0), n["damping"]
        )
        return [load + n["pretension"] for load in acting]

    def energy(self, joint: Joint, q: Array) -> Array | float:
        return -self.pretension * q[..., 0] if self.pretension else 0.0

    @property
    def conservative(self) -> bool:
        return super().conservative and not self.damping


def takeoff_angle(joint: Joint, angle: Any) -> Any:
    """An angle at takeoff, the model's own where none is given; SomersaultError beyond limits."""
    if joint.kind == "ball":
        return (0.0, 0.0, 0.0) if angle is None else angle
    at = joint.home[0] if angle is None else angle
    check_limits(joint, (at,))
    return at


def standing(joint: Joint, values: Numbers, count: int) -> tuple[Array, Array]:
    """Coordinates (count, c) of a joint's takeoff angle, and no speeds (count, s)."""
    still = np.zeros((count, joint.speeds))
    if joint.kind != "ball":
        return _declared.side_by_side(values, [("angle", joint.name)], count), still
    turn = _declared.side_by_side(values, speed_names(joint, "angle"), count)
    half = 0.5 * np.sqrt(turn[:, 0] ** 2 + turn[:, 1] ** 2 + turn[:, 2] ** 2)
    vector = 0.5 * np.sinc(half / np.pi)[:, None] * turn
    return np.concatenate([np.cos(half)[:, None], vector], 1), still


def speed_names(joint: Joint, what: str) -> list[Name]:
    """Names of the numbers of a quantity that has one for each of a joint's speeds."""
    if joint.kind != "ball":
        return [(what, joint.name)]
    return [(what, joint.name, k) for k in (1, 2, 3)]


def stretch(q: Array, rest: float) -> Array:
    """How far a joint's coordinates (…, 1) or (…, 4) are from rest, (…)."""
    if q.shape[-1] == 1:
        return q[..., 0] - rest
    length = np.linalg.norm(q[..., 1:], axis=-1)
    return 2 * np.arctan2(length, np.abs(q[..., 0]))


def _stop(here: Here) -> Any:
    """A spring and a damper beyond the limits, which only push."""
    assert here.joint.limits is not None
    low, high = here.joint.limits
    k, c = (here.numbers[name] for name in _STOPS)
    q, u = here.q[0], here.u[0]
    below, above = ca.fmax(low - q, 0.0), ca.fmax(q - high, 0.0)
    up = ca.fmax(k * below - c * u, 0.0) * (below > 0.0)
    down = ca.fmax(k * above + c * u, 0.0) * (above > 0.0)
    return up - down
