"""The equations of a body that something holds, in gravity and against props."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property, lru_cache
from typing import Any

import casadi as ca

from somersault.dynamics.vectors import Vec
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

    @property
    def gravity(self) -> Vec:
        """What holds the body does not fall."""
        return self._gravity

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
