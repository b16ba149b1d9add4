"""The compiled equations of a flight: a model, and what each of its joints is doing.

The centre of mass falls by itself, so it is no part of the state (`_symbols`); a joint that is
locked or prescribed is none either. Angles, springs and paths are parameters: flights that
differ only in numbers share one compiled right-hand side.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from typing import Any

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.dynamics import Equations
from somersault.engine import Integrator, Kernel
from somersault.flight._symbols import Symbols, moves_freely
from somersault.flight._takeoff import Kind
from somersault.flight._watch import VELOCITIES, longest, watch
from somersault.model import Model
from somersault.model._types import FREE_IT


@lru_cache(maxsize=32)
def system(
    model: Model,
    joints: tuple[Kind, ...],
    event: str | None,
    bodies: tuple[str, ...] = (),
    extremes: tuple[str, ...] | None = None,
    tape: bool = False,
) -> System:
    """The system of a model whose joints move in these ways, compiled once."""
    return System(model, joints, event, bodies, extremes, tape)


class System:
    """Right-hand side, layout of states and parameters, and what can be read from a state.

    `bodies` names numbers of the bodies that differ between flights, as `Equations` does.
    `extremes`, unless it is None, are what is watched beside the turns (`_watch`). With `tape`
    the torques of the nominal motion act at compliant joints.
    """

    def __init__(
        self,
        model: Model,
        joints: tuple[Kind, ...],
        event: str | None,
        bodies: tuple[str, ...] = (),
        extremes: tuple[str, ...] | None = None,
        tape: bool = False,
    ) -> None:
        if not model.free:
            raise SomersaultError(f"{model.name} has a fixed base, so it cannot fly; {FREE_IT}")
        loose = [j.name for j, k in zip(model.joints, joints, strict=True) if k.motion in _LOOSE]
        if tape and loose:
            raise SomersaultError(
                f"joint {loose[0]} is on no path, so there is no motor tape to replay; make it "
                "compliant, prescribed or locked, or leave the takeoff's tape out"
            )
        self.model, self.kinds, self.event = model, joints, event
        self.bodies, self.extremes = bodies, extremes
        self.symbols = Symbols(model, joints, bodies, tape)
        self.state, self.parameters = self.symbols.state, self.symbols.parameters

    @cached_property
    def equations(self) -> Equations:
        """Momentum, energy and inertia of the model."""
        return Equations(self.model, self.bodies)

    def _function(self, name: str, value: Any) -> ca.Function:
        return ca.Function(name, [self.symbols.x], [ca.cse(ca.densify(value))])

    @cached_property
    def integrator(self) -> Integrator:
        """DOP853 for these equations, with the event's gauge and what is watched."""
        s = self.symbols
        slope = self._function("slope", s.slope)
        gauge = None if self.event is None else self._function("gauge", s.gauge)
        if self.extremes is None:
            return Integrator(slope, gauge, changing=s.changing)
        return Integrator(
            slope,
            gauge,
            watch(self.extremes, self.quantities, self.state, self.parameters, self.model.axes),
            self._function("longest", longest(s.quaternion, s.omega, self.model.axes)),
            s.changing,
        )

    def start(self, quaternion: Array, omega: Array, q: Array, u: Array) -> Array:
        """States from full joint coordinates and speeds, (N, state), with room behind them for
        what is watched, (N, state + watched)."""
        q_keep, u_keep = self._kept()
        parts = [quaternion]
        if not self.symbols.bound:
            parts += [omega, q[:, q_keep], u[:, u_keep]]
        rows = np.empty((len(quaternion), self.integrator.outputs))
        np.concatenate(parts, 1, out=rows[:, : self.state])
        return rows

    def _kept(self) -> tuple[list[int], list[int]]:
        q_keep: list[int] = []
        u_keep: list[int] = []
        for joint, kind in zip(self.model.joints, self.kinds, strict=True):
            if moves_freely(kind):
                where = self.model.coordinate_slice(joint.name)
                q_keep += range(where.start, where.stop)
                where = self.model.speed_slice(joint.name)
                u_keep += range(where.start, where.stop)
        return q_keep, u_keep

    # ----------------------------------------------------------- from states to quantities

    def quantities(self, y: Any, t: Any, p: Any) -> dict[str, Any]:
        """Angular velocity, joint coordinates and rates by name, symbolic, as functions of state,
        time and parameters; a rate's name is its joint speed's with "_rate"."""
        s = self.symbols
        found = self._reading(ca.vertcat(y, t, p))
        rates = [f"{name}_rate" for name in s.model.speeds]
        names = [*VELOCITIES, *s.model.coordinates, *rates]
        return {name: found[k] for k, name in enumerate(names)}

    @cached_property
    def _reading(self) -> ca.Function:
        s = self.symbols
        return self._function("reading", ca.vertcat(*s.omega, *s.position, *s.rate))

    def read(self, states: Array, times: Array, parameters: Array) -> tuple[Array, Array, Array]:
        """ω (N, 3), joint coordinates (N, coordinates) and speeds (N, speeds) of states (N, …)."""
        x = np.concatenate([states, times[:, None], parameters], 1)
        found = np.array(self._reading.map(len(x))(x.T)).T
        return tuple(np.split(found, [3, 3 + len(self.model.coordinates)], 1))  # type: ignore[return-value]

    @cached_property
    def loads(self) -> Kernel:
        """Moment and force on the base (both zero in free flight), then joint torques, of (state,
        time, parameters)."""
        return Kernel(self._function("loads", self.symbols.loads))


_LOOSE = ("free", "sprung")
