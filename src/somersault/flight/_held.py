"""The equations of a body that something holds, in gravity and against props."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property, lru_cache
from typing import Any

import casadi as ca

from somersault.dynamics import constrained_dynamics, forward_dynamics, inverse_dynamics
from somersault.dynamics.vectors import Vec, scale
from somersault.flight._prop import Prop
from somersault.flight._symbols import Symbols
from somersault.flight._system import System
from somersault.flight._watch import VELOCITIES
from somersault.flight.behaviours import JointTakeoff
from somersault.model import Model
from somersault.model import Vector as Numbers

Stops = tuple[tuple[str, Prop], ...]
Until = tuple[str, float] | None


@lru_cache(maxsize=32)
def held_system(
    model: Model, kinds: tuple[JointTakeoff, ...], gravity: Numbers, stops: Stops, until: Until
) -> System:
    """The system of a model with a fixed base, compiled once.

    `until` is a joint and the angle at which its motion ends.
    """
    symbols = HeldSymbols(model, kinds, gravity, dict(stops), until)
    return System(symbols, event=until is not None)


class HeldSymbols(Symbols):
    """State `y`, time `t` and parameters `p` of a model with a fixed base; vectors are in the
    ground's axes."""

    def __init__(
        self, model: Model, kinds: tuple[JointTakeoff, ...], gravity: Numbers,
        stops: Mapping[str, Prop], until: Until,
    ) -> None:  # fmt: skip
        super().__init__(model, kinds, bodies=(), tape=False, playback=None)
        self._gravity, self._stops, self._until = list(gravity), stops, until

    @cached_property
    def omega(self) -> list[Any]:
        """Of the ground: it does not turn."""
        return [0.0, 0.0, 0.0]

    @cached_property
    def torques(self) -> list[Any]:
        """What acts at each joint speed, the props with it."""
        return [
            torque + self._pushed(name)
            for name, torque in zip(self.model.speeds, super().torques, strict=True)
        ]

    def _pushed(self, name: str) -> Any:
        """What a joint's prop gives."""
        if name not in self._stops:
            return 0.0
        known = self.known[name]
        return self._stops[name].torque(known.q[0], known.u[0])

    @cached_property
    def accelerations(self) -> tuple[Vec, Vec, list[Any]]:
        """Of the ground, none, and of all joint speeds."""
        moving = (
            self.tree, self.position, self.omega, self.rate, self.torques, self._gravity,
        )  # fmt: skip
        if self._geared:
            return constrained_dynamics(*moving, self._driven, self._geared)
        return forward_dynamics(*moving, self._driven)

    @cached_property
    def slope(self) -> Any:
        """The rate of the state, but for what is carried."""
        return ca.vertcat(*self.joint_rates)

    @cached_property
    def sensed(self) -> tuple[list[Any], dict[str, Any]]:
        """No angles of the ground; joints and their rates by name."""
        known = {n: x for n, x in self.quantities.items() if n not in VELOCITIES}
        return [0.0, 0.0, 0.0], known

    @cached_property
    def gauge(self) -> Any:
        """How far the joint is from the angle at which the motion ends."""
        assert self._until is not None
        joint, angle = self._until
        return self.known[joint].q[0] - angle

    @cached_property
    def inverse(self) -> Any:
        """Moment and force that the ground needs from outside, none, then what acts at the joints,
        by springs, dampers, muscles and props together."""
        _, _, joints = self.accelerations
        moment, force, torques = inverse_dynamics(
            self.tree, self.position, self.omega, self.rate, [0.0] * 3, scale(-1.0, self._gravity),
            joints,
        )  # fmt: skip
        return ca.vertcat(*moment, *force, *torques)
