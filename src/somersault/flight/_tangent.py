"""A flight's equations together with their derivative along one direction.

Along a direction of the state at takeoff and of the parameters the state y changes by s, with
ṡ = f_y s + f_p p'. Both are integrated side by side, so that the steps are good for both. Many
directions are many flights, a lane each: each flies the flight itself and its own s.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from typing import Any

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault.engine import Integrator
from somersault.flight._plane import turning
from somersault.flight._system import System
from somersault.flight._watch import longest, named, nearest, watch


@lru_cache(maxsize=16)
def tangent(system: System) -> Tangent:
    """The equations of a system with a direction, compiled once."""
    return Tangent(system)


class Tangent:
    """The equations of a system with a direction.

    The state is what moves, its derivative, what is carried, and its derivative; the parameters are
    those that change, their derivatives, those that stay, and theirs. Turns are watched.
    """

    def __init__(self, system: System) -> None:
        self.system, s = system, system.symbols
        where = system.layout
        self._moving, self._changing = where.sensed.start, where.changing
        self._dy = ca.SX.sym("dy", where.state)
        self._dp = ca.SX.sym("dp", where.parameters)
        self._y = _both(s.y, self._dy, self._moving)
        self._p = _both(s.p, self._dp, self._changing)

    def state(self, y: Array, dy: Array) -> Array:
        """States with their derivatives, (N, 2 state), of both (N, state)."""
        return beside(y, dy, self._moving)

    def apart(self, states: Array) -> tuple[Array, Array]:
        """States and derivatives, (N, state) each, of what `state` joins."""
        m, n = self._moving, self.system.layout.state
        y, dy, carried, d_carried = np.split(states, [m, 2 * m, n + m], -1)
        return np.concatenate([y, carried], -1), np.concatenate([dy, d_carried], -1)

    @cached_property
    def integrator(self) -> Integrator:
        """DOP853 for the state and its derivative."""
        s, where, axes = self.system.symbols, self.system.layout, self.system.model.axes
        slope = self._function("slope", self._with_derivative(s.slope))
        tick = None if s.tick is None else self._function("tick", self._with_derivative(s.tick))
        gauge = self._function("gauge", s.gauge) if self.system.event else None
        clock = where.replay.start + self._moving if where.replay else None
        most = self._function("longest", longest(s.quaternion, s.omega, axes))
        return Integrator(slope, gauge, self._watch, most, 2 * self._changing, tick, clock)

    def _function(self, name: str, value: Any) -> ca.Function:
        x = ca.vertcat(self._y, self.system.symbols.t, self._p)
        return ca.Function(name, [x], [ca.cse(ca.densify(value))])

    def _with_derivative(self, value: Any) -> Any:
        return ca.vertcat(value, self._along(value, self._dy, 0.0))

    def _along(self, value: Any, dy: Any, dt: Any) -> Any:
        """The derivative where the state changes by dy, the time by dt and parameters by theirs."""
        return ca.jtimes(value, self.system.symbols.x, ca.vertcat(dy, dt, self._dp))

    @property
    def _watch(self) -> ca.Function:
        """The turns of the flight itself."""
        where = self.system.layout
        plain = watch(
            (), self.system.quantities, where.state, where.parameters, self.system.model.axes
        )
        y = [ca.SX.sym("y", 2 * where.state) for _ in range(4)]
        t, p = ca.SX.sym("t", 2), ca.SX.sym("p", 2 * where.parameters)
        before = ca.SX.sym("before", 3)
        chosen = [_first(one, self._moving) for one in y]
        seen = plain(ca.vertcat(*chosen, t, _first(p, self._changing), before))
        return ca.Function("watch", [ca.vertcat(*y, t, p, before)], [seen])

    # -------------------------------------------------------------------------- at the landing

    def quantities(self, names: tuple[str, ...], event: bool) -> ca.Function:
        """Derivatives at the landing, by an event or not: of its time, and of quantities there.

        Of (angles near those of the landing, state, time, parameters, derivatives of state and of
        parameters).
        """
        s, axes, near = self.system.symbols, self.system.model.axes, ca.SX.sym("near", 3)
        angles = nearest(s.quaternion, [near[k] for k in range(3)], axes)
        known = named(self.system.known(names), angles, s.y, s.t, s.p, axes)
        return self._landed(near, [known[name] for name in names], event)

    def motion(self, event: bool) -> ca.Function:
        """The same of what `moving_names` has, from the state at the landing itself."""
        s, near = self.system.symbols, ca.SX.sym("near", self.system.layout.state)
        ways = turning(self.system.model)
        turn = _turn([near[k] for k in range(4)], s.quaternion)
        values = [*(turn[k] for k in ways), *(s.omega[k] for k in ways)]
        moving = [slot for slot in self.system.layout.slots if slot.kind.in_state]
        for slot in moving:
            q = [s.y[k] for k in slot.q]
            values += _turn([near[k] for k in slot.q], q) if slot.joint.kind == "ball" else q
        values += [s.y[k] for slot in moving for k in slot.u]
        return self._landed(near, values, event)

    def _landed(self, near: Any, values: list[Any], event: bool) -> ca.Function:
        s = self.system.symbols
        slope = ca.vertcat(s.slope, ca.SX.zeros(self.system.layout.state - self._moving))
        dt: Any = 0.0
        if event:
            dt = -ca.jtimes(s.gauge, s.y, self._dy) / ca.jtimes(s.gauge, s.y, slope)
        derivative = self._along(ca.vertcat(*values), self._dy + slope * dt, dt)
        given = ca.vertcat(near, s.x, self._dy, self._dp)
        return ca.Function("landed", [given], [ca.cse(ca.densify(ca.vertcat(dt, derivative)))])


def moving_names(system: System) -> list[str]:
    """What the motion of a body in flight is described by: small turns about its axes (rad), its
    angular velocity, and the coordinates and speeds of the joints that move freely; of a ball
    small turns again."""
    ways = [way + 1 for way in turning(system.model)]
    moving = [slot.joint for slot in system.layout.slots if slot.kind.in_state]
    of_speed = system.model.speeds
    speeds = [n for joint in moving for n in of_speed[system.model.speed_slice(joint.name)]]
    return [
        *(f"turn_{k}" for k in ways), *(f"angular_velocity_{k}" for k in ways),
        *speeds, *(f"{name}_rate" for name in speeds),
    ]  # fmt: skip


def _turn(before: list[Any], after: list[Any]) -> list[Any]:
    """The small turn, in the body's own axes, from one quaternion to another near it."""
    w, x, y, z = before
    a, b, c, d = after
    size = w * w + x * x + y * y + z * z
    vector = (
        w * b - x * a - y * d + z * c, w * c + x * d - y * a - z * b, w * d - x * c + y * b - z * a,
    )  # fmt: skip
    return [2 * part / size for part in vector]


def _both(one: Any, derivative: Any, first: int) -> Any:
    return ca.vertcat(one[:first], derivative[:first], one[first:], derivative[first:])


def _first(both: Any, first: int) -> Any:
    """What `_both` had first."""
    half = both.numel() // 2
    return ca.vertcat(both[:first], both[2 * first : half + first])


def beside(one: Array, derivative: Array, first: int) -> Array:
    """Numbers (…, n) and their derivatives side by side, the `first` ones before the others."""
    parts = [one[..., :first], derivative[..., :first], one[..., first:], derivative[..., first:]]
    return np.concatenate(parts, -1)
