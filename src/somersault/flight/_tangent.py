"""A flight's equations together with their derivative along one direction.

Along a direction of the state at takeoff and of the parameters the state y changes by s, with
ṡ = f_y s + f_p p'. Both are integrated side by side, so that the steps are good for both. Many
directions are many flights, a lane each: each flies the flight itself and its own s. The compiled
equations are those of the flight, with the derivative of each instruction right behind it.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from typing import Any

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault.engine import Direction, Integrator
from somersault.flight._plane import turning
from somersault.flight._system import System
from somersault.flight._watch import longest, named, nearest, watch


@lru_cache(maxsize=16)
def tangent(system: System, on_the_way: bool = True) -> Tangent:
    """The equations of a system with a direction, compiled once. Where nothing changes
    `on_the_way`, neither paths nor the motor tape, they are shorter."""
    return Tangent(system, on_the_way)


class Tangent:
    """The equations of a system with a direction.

    The state is what moves, its derivative, what is carried, and its derivative; the parameters are
    those that change, their derivatives, those that stay, and theirs. Turns are watched.
    """

    def __init__(self, system: System, on_the_way: bool) -> None:
        self.system, self._on_the_way = system, on_the_way
        where = system.layout
        self._moving, self._changing = where.sensed.start, where.changing
        self._dy = ca.SX.sym("dy", where.state)
        self._dp = ca.SX.sym("dp", where.parameters)

    def state(self, y: Array, dy: Array) -> Array:
        """States with their derivatives, (N, 2 state), of both (N, state)."""
        return beside(y, dy, self._moving)

    def apart(self, states: Array) -> tuple[Array, Array]:
        """States and derivatives, (N, state) each, of what `state` joins."""
        return _apart(states, self._moving)

    @cached_property
    def integrator(self) -> Integrator:
        """DOP853 for the state and its derivative."""
        s, where, axes = self.system.symbols, self.system.layout, self.system.model.axes
        slope = _function("slope", s.x, s.slope)
        tick = None if s.tick is None else _function("tick", s.x, s.tick)
        gauge = _function("gauge", s.x, s.gauge) if self.system.event else None
        clock = where.replay.start + self._moving if where.replay else None
        most = _function("longest", s.x, longest(s.quaternion, s.omega, axes))
        return Integrator(
            slope, gauge, self._watch, most, 2 * self._changing, tick, clock, self._places
        )

    @property
    def _places(self) -> Direction:
        """Where state, time and parameters stand, and where their derivatives."""
        n, m = self.system.layout.state, self.system.layout.parameters
        y, dy = _apart(np.arange(2 * n), self._moving)
        time = 2 * n
        p, dp = _apart(np.arange(2 * m) + time + 1, self._changing)
        changes: list[int | None] = dp.tolist()
        if not self._on_the_way:
            changes[: self._changing] = [None] * self._changing
        return Direction([*y.tolist(), time, *p.tolist()], [*dy.tolist(), None, *changes])

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
        return _function("landed", given, ca.vertcat(dt, derivative))


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


def _function(name: str, given: Any, value: Any) -> ca.Function:
    return ca.Function(name, [given], [ca.cse(ca.densify(value))])


def _first(both: Any, first: int) -> Any:
    """What `beside` had first."""
    half = both.numel() // 2
    return ca.vertcat(both[:first], both[2 * first : half + first])


def beside(one: Array, derivative: Array, first: int) -> Array:
    """Numbers (…, n) and their derivatives side by side, the `first` ones before the others."""
    parts = [one[..., :first], derivative[..., :first], one[..., first:], derivative[..., first:]]
    return np.concatenate(parts, -1)


def _apart(both: Array, first: int) -> tuple[Array, Array]:
    """What `beside` put together."""
    half = both.shape[-1] // 2
    one, derivative, rest, of_rest = np.split(both, [first, 2 * first, half + first], -1)
    return np.concatenate([one, rest], -1), np.concatenate([derivative, of_rest], -1)
