"""The compiled equations of a flight: a model, and what each of its joints is doing.

The centre of mass falls by itself, so it is no part of the state; a joint that is locked or
prescribed is none either (`_layout`). Angles, springs and paths are parameters: flights that
differ only in numbers share one compiled right-hand side.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cached_property, lru_cache
from typing import Any

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.dynamics import Equations
from somersault.engine import Integrator, Kernel
from somersault.flight._layout import Layout
from somersault.flight._playback import Playback
from somersault.flight._symbols import Symbols
from somersault.flight._watch import Quantities, longest, torques, values, watch
from somersault.flight.behaviours import JointTakeoff
from somersault.model import FREE_IT, Model


@lru_cache(maxsize=32)
def system(
    model: Model,
    kinds: tuple[JointTakeoff, ...],
    event: str | None,
    bodies: tuple[str, ...] = (),
    extremes: tuple[str, ...] | None = None,
    tape: bool = False,
    playback: Playback | None = None,
) -> System:
    """The system of a model in flight whose joints are of these kinds, compiled once.

    `bodies` names numbers of the bodies that differ between flights, as `Equations` does. With
    `tape` the torques of the nominal motion act at compliant joints. `playback` is the kind of
    law by which paths and tape are played.
    """
    if not model.free:
        raise SomersaultError(f"{model.name} has a fixed base, so it cannot fly; {FREE_IT}")
    for joint, kind in zip(model.joints, kinds, strict=True):
        if tape and kind.nominal().in_state:
            raise SomersaultError(
                f"joint {joint.name} is on no path, so there is no motor tape to replay; make "
                "it compliant, prescribed or locked, or leave the takeoff's tape out"
            )
    if playback is not None and not (tape or any(kind.path_count for kind in kinds)):
        raise SomersaultError(
            "nothing in this takeoff goes along a path, so there is nothing to replay; "
            "prescribe joints, or leave its replay out"
        )
    return System(Symbols(model, kinds, bodies, tape, playback), event is not None, extremes)


@lru_cache(maxsize=64)
def reader(names: tuple[str, ...], system: System) -> Kernel:
    """The quantities of (angles, state, time, parameters), compiled; once for a system."""
    layout, axes = system.layout, system.model.axes
    quantities = system.known(names)
    return Kernel(values(names, quantities, layout.state, layout.parameters, axes))


class System:
    """Right-hand side, and what can be read from a state.

    With an `event` it ends where the gauge changes sign. `extremes`, unless it is None, are what is
    watched besides the turns (`_watch`).
    """

    def __init__(
        self, symbols: Symbols, event: bool, extremes: tuple[str, ...] | None = None
    ) -> None:
        self.symbols, self.model, self.bodies = symbols, symbols.model, symbols.bodies
        self.kinds = tuple(slot.kind for slot in symbols.layout.slots)
        self.event, self.extremes = event, extremes

    @property
    def layout(self) -> Layout:
        """Where numbers stand in states and parameters."""
        return self.symbols.layout

    @cached_property
    def equations(self) -> Equations:
        """Momentum, energy and inertia of the model."""
        return Equations(self.model, self.bodies)

    def _function(self, name: str, value: Any) -> ca.Function:
        return ca.Function(name, [self.symbols.x], [ca.cse(ca.densify(value))])

    @cached_property
    def integrator(self) -> Integrator:
        """DOP853 for these equations, with the event's gauge and what is watched."""
        s, where = self.symbols, self.layout
        slope = self._function("slope", s.slope)
        tick = None if s.tick is None else self._function("tick", s.tick)
        gauge = None if not self.event else self._function("gauge", s.gauge)
        clock = where.replay.start if where.replay else None
        if self.extremes is None:
            return Integrator(slope, gauge, changing=where.changing, tick=tick, clock=clock)
        axes = self.model.axes
        return Integrator(
            slope,
            gauge,
            watch(self.extremes, self.known(self.extremes), where.state, where.parameters, axes),
            self._function("longest", longest(s.quaternion, s.omega, axes)),
            where.changing,
            tick,
            clock,
        )

    def start(self, quaternion: Array, omega: Array, q: Array, u: Array, sensed: Array) -> Array:
        """States from full joint coordinates and speeds, (N, state), with room behind them for
        what is watched, (N, state + watched); `sensed` is what is carried of the body."""
        moving = [slot.joint.name for slot in self.layout.slots if slot.kind.in_state]
        parts = [quaternion] if self.model.free else []
        if not self.layout.bound:
            if self.model.free:
                parts.append(omega)
            parts += [q[:, self.model.coordinate_slice(name)] for name in moving]
            parts += [u[:, self.model.speed_slice(name)] for name in moving]
        if self.layout.every is not None:
            parts += [sensed, *self._carried(q, u)]
        rows = np.empty((len(quaternion), self.integrator.outputs))
        np.concatenate(parts, 1, out=rows[:, : self.layout.state])
        return rows

    def _carried(self, q: Array, u: Array) -> Iterator[Array]:
        for slot in self.layout.slots:
            if slot.kind.sensing is not None:
                name = slot.joint.name
                its_q, its_u = self.model.coordinate_slice(name), self.model.speed_slice(name)
                yield slot.kind.sensing.at_takeoff(q[:, its_q], u[:, its_u])

    # ----------------------------------------------------------- from states to quantities

    def quantities(self, y: Any, t: Any, p: Any) -> dict[str, Any]:
        """Angular velocity, joint coordinates and rates by name, symbolic, as functions of state,
        time and parameters; a rate's name is its joint speed's with "_rate"."""
        values = self._reading(ca.vertcat(y, t, p))
        return {name: values[k] for k, name in enumerate(self.symbols.quantities)}

    def known(self, names: Iterable[str]) -> Quantities:
        """`quantities`, with what acts at the joints if some of the names are of that."""
        return self._with_torques if set(names) & set(torques(self.model)) else self.quantities

    def _with_torques(self, y: Any, t: Any, p: Any) -> dict[str, Any]:
        acting = self._acting(ca.vertcat(y, t, p))
        named = {name: acting[6 + k] for k, name in enumerate(torques(self.model))}
        return {**named, **self.quantities(y, t, p)}

    @cached_property
    def _acting(self) -> ca.Function:
        return self._function("acting", self.symbols.inverse)

    @cached_property
    def _reading(self) -> ca.Function:
        s = self.symbols
        return self._function("reading", ca.vertcat(*s.quantities.values()))

    def read(self, states: Array, times: Array, parameters: Array) -> tuple[Array, Array, Array]:
        """ω (N, 3), joint coordinates (N, coordinates) and speeds (N, speeds) of states (N, …)."""
        x = np.concatenate([states, times[:, None], parameters], 1)
        values = np.array(self._reading.map(len(x))(x.T)).T
        return tuple(np.split(values, [3, 3 + len(self.model.coordinates)], 1))  # type: ignore[return-value]

    @cached_property
    def loads(self) -> Kernel:
        """Moment and force on the base (both zero in free flight), then joint torques, of (state,
        time, parameters)."""
        return Kernel(self._acting)
