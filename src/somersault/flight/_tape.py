"""The motor tape: the joint torques of the nominal flight, against time.

It is recorded from the flight that follows the paths exactly: torques by inverse dynamics at
Chebyshev points of short pieces, kept as the polynomials through them. A piece is halved until
what is left out is hardly more than rounding, in each flight by itself. What is sensed of the body
is recorded likewise.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import ClassVar, Protocol

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault.engine import Kernel, Solution
from somersault.flight._course import Course
from somersault.flight._system import System, reader
from somersault.flight._watch import torques
from somersault.model import Model
from somersault.motion import TAPE_DEGREE, Path
from somersault.simulation import Numbers

RECORDED_TO = 1e-13  # of each step of the nominal flight
_LEFT_OUT = 1e-11  # of a piece's greatest torque: what the last coefficients may be,
_LITTLE = 1e-4  # where that is more than so much of the flight's
_LONGEST, _SHORTEST = 0.1, 1e-6  # s of a piece
_AT_ONCE = 2**22  # numbers that a recording of many flights holds
POINTS = TAPE_DEGREE + 1  # in each piece
_ANGLES = np.pi * (np.arange(POINTS) + 0.5) / POINTS
_WITHIN = 0.5 - 0.5 * np.cos(_ANGLES)  # within a piece, 0 to 1


class Flights(Protocol):
    """Some flights with their numbers."""

    @property
    def course(self) -> Course: ...

    @property
    def rows(self) -> Array: ...


class Kept(Protocol):
    """What a tape keeps of flights."""

    @property
    def little(self) -> float:
        """What is left out is told from nothing by its share of so much, at least."""

    def called(self, model: Model) -> tuple[str, ...]:
        """What reports call it."""

    def read(self, system: System, solution: Solution, times: Array, parameters: Array) -> Array:
        """It at the samples of a solution, (N, K, …)."""


@dataclass(frozen=True)
class Torques:
    """The torques at all joint speeds, N m."""

    little: ClassVar[float] = 0.0

    def called(self, model: Model) -> tuple[str, ...]:
        return tuple(torques(model))

    def read(self, system: System, solution: Solution, times: Array, parameters: Array) -> Array:
        x = np.concatenate([solution.states, times[..., None], parameters], 2)
        return system.loads(x)[..., 6:]


@dataclass(frozen=True)
class Sensed:
    """Some of what is sensed of the body, rad and rad/s; its turns must be watched."""

    names: tuple[str, ...]
    little: ClassVar[float] = 1.0

    def called(self, model: Model) -> tuple[str, ...]:
        return self.names

    def read(self, system: System, solution: Solution, times: Array, parameters: Array) -> Array:
        x = [solution.watched, solution.states, times[..., None], parameters]
        return reader(self.names, system)(np.concatenate(x, 2))


class Nominal(Protocol):
    """The flights of which something is recorded: those that follow their paths exactly."""

    @property
    def system(self) -> System: ...

    @property
    def values(self) -> Numbers: ...

    @property
    def duration(self) -> float: ...

    def begun(self, values: Numbers, count: int) -> Flights: ...


@dataclass(frozen=True)
class Tape:
    """Edges of pieces (N, P + 1), some of no length, and the powers of the time since each began
    (N, P, what is kept, powers)."""

    edges: Array
    powers: Array

    def path(self, played: list[int]) -> Path:
        """Some of what is kept side by side; before and after it holds."""
        powers, spans = self.powers[:, :, played], np.diff(self.edges)
        last = spans.shape[1] - 1 - np.argmax(spans[:, ::-1] > 0, 1)
        rows = np.arange(len(last))
        scale = spans[rows, last, None, None] ** np.arange(POINTS)
        before, after = np.zeros((2, len(rows), 1, len(played), POINTS))
        before[..., 0] = powers[:, :1, :, 0]
        after[:, 0, :, 0] = (powers[rows, last] * scale).sum(-1)
        whole = np.concatenate([before, powers, after], 1)
        return Path(self.edges, whole.reshape(*whole.shape[:2], -1))


def recorded(nominal: Nominal, kept: Kept) -> Tape:
    """The tape where nothing is varied."""
    return _exact(nominal, kept, nominal.values, 1, _LONGEST)


def recorded_each(nominal: Nominal, kept: Kept, values: Numbers, count: int, one: Tape) -> Tape:
    """The tapes of many flights, in pieces as long as those of the one tape or shorter.

    `values` has the numbers that differ from the nominal flight's.
    """
    length = float(np.diff(one.edges).max())
    # Of a flight: what inverse dynamics is given, in twice as many pieces.
    size = 2 * one.powers.shape[1] * POINTS * (8 * len(nominal.system.kinds) + 20)
    parts = []
    for some in np.array_split(np.arange(count), -(-count * size // _AT_ONCE)):
        chosen = {n: x[some] if isinstance(x, np.ndarray) else x for n, x in values.items()}
        parts.append(_exact(nominal, kept, {**nominal.values, **chosen}, len(some), length))
    pieces = max(part.powers.shape[1] for part in parts)
    whole = Tape(
        np.full((count, pieces + 1), nominal.duration),
        np.zeros((count, pieces, *parts[0].powers.shape[2:])),
    )
    first = 0
    for part in parts:
        last = first + len(part.edges)
        whole.edges[first:last, : part.edges.shape[1]] = part.edges
        whole.powers[first:last, : part.powers.shape[1]] = part.powers
        first = last
    return whole


def _exact(nominal: Nominal, kept: Kept, values: Numbers, count: int, length: float) -> Tape:
    """The tapes of some flights, in pieces no longer than `length`."""
    flights = nominal.begun(values, count)
    knots = np.broadcast_to(flights.course.knots, (count, flights.course.knots.shape[1]))
    edges = _divided(knots, length)
    while True:
        tape, left_out = _recorded(nominal.system, kept, flights, edges)
        again = left_out & (np.diff(edges) > _SHORTEST)
        if not again.any():
            return tape
        middle = 0.5 * (edges[:, 1:] + edges[:, :-1])
        edges = np.concatenate([edges, np.where(again, middle, nominal.duration)], 1)
        edges = np.sort(edges, 1)
        # What only fills up a row may go where it does in all rows.
        edges = edges[:, : (edges < nominal.duration).sum(1).max() + 1]


def _recorded(system: System, kept: Kept, flights: Flights, edges: Array) -> tuple[Tape, Array]:
    """Tapes in pieces between edges (N, P + 1), and which pieces leave too much out, (N, P)."""
    times, spans = points(edges, flights.course.duration), np.diff(edges)
    solution = flights.course.solve(flights.rows, times, RECORDED_TO)
    begun = solution.states[:, ::POINTS]
    parameters = np.repeat(flights.course.parameters(edges[:, :-1], begun), POINTS, 1)
    values = kept.read(system, solution, times, parameters)
    powers, series = through(edges, values)
    values = values.reshape(*spans.shape, POINTS, -1).swapaxes(2, 3)
    most = np.abs(values).max((2, 3))
    most = np.maximum(most, np.maximum(_LITTLE * most.max(1, keepdims=True), kept.little))
    left_out = np.abs(series[..., POINTS:]).max((2, 3)) > _LEFT_OUT * most
    return Tape(edges, powers), left_out & (spans > 0)


def points(edges: Array, duration: float) -> Array:
    """The times in the pieces between edges (N, P + 1) at which is recorded, (N, P points)."""
    spans = np.diff(edges)[..., None]
    return np.minimum((edges[:, :-1, None] + spans * _WITHIN).reshape(len(edges), -1), duration)


def through(edges: Array, values: Array) -> tuple[Array, Array]:
    """The polynomials through values (N, P points, what is kept): `Tape.powers`, and before them
    what `_polynomials` gives."""
    spans = np.diff(edges)
    series = _polynomials()(values.reshape(*spans.shape, POINTS, -1).swapaxes(2, 3))
    scale = spans[..., None, None] ** np.arange(POINTS)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        powers = series[..., :POINTS] / scale
    return np.where(np.isfinite(powers), powers, 0.0), series  # of pieces of next to no length


def _divided(knots: Array, length: float) -> Array:
    """Knots (N, K) with as many more between them as leaves no piece longer than `length`.

    Where intervals of one flight need fewer than those of another, some have no length.
    """
    parts = np.maximum(np.ceil(np.diff(knots) / length - 1e-9), 1)
    edges = [knots[:, :1]]
    for k in range(parts.shape[1]):
        own = parts[:, k : k + 1]
        through = np.minimum(np.arange(1, int(own.max()) + 1), own) / own
        start, end = knots[:, k : k + 1], knots[:, k + 1 : k + 2]
        edges.append(np.where(through < 1, start + through * (end - start), end))
    return np.concatenate(edges, 1)


@cache
def _polynomials() -> Kernel:
    """From values at the points of a piece to the powers of its time, 0 to 1, and then the last two
    coefficients of the Chebyshev polynomials between.

    Compiled, so that a flight's digits do not depend on how many there are.
    """
    to_series = 2 / POINTS * np.cos(np.outer(np.arange(POINTS), np.pi - _ANGLES))
    to_series[0] /= 2
    to_powers = np.zeros((POINTS, POINTS))  # of the Chebyshev polynomials of 2 u − 1, by columns
    to_powers[0, 0], to_powers[:2, 1] = 1.0, (-1.0, 2.0)
    for k in range(2, POINTS):
        to_powers[1:, k] = 4 * to_powers[:-1, k - 1]
        to_powers[:, k] -= 2 * to_powers[:, k - 1] + to_powers[:, k - 2]
    values = ca.SX.sym("values", POINTS)
    series = ca.DM(to_series) @ values
    both = ca.vertcat(ca.DM(to_powers) @ series, series[-2:])
    return Kernel(ca.Function("polynomials", [values], [ca.densify(both)]))
