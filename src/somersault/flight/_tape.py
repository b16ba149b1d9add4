"""The motor tape: the joint torques of the nominal flight, against time.

It is recorded from the flight that follows the paths exactly: torques by inverse dynamics at
Chebyshev points of short pieces, kept as the polynomials through them. Pieces are so short
that what is left out is hardly more than rounding.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from somersault._array import Array
from somersault.flight._columns import Numbers, numbers
from somersault.flight._course import Course
from somersault.flight._path import TAPE_DEGREE, Path
from somersault.flight._start import Starts, starts
from somersault.flight._system import System, system
from somersault.flight._takeoff import JointPlan, Takeoff, kinds
from somersault.model import Model

_TOLERANCE = 1e-13  # of each step of the nominal flight
_LEFT_OUT = 1e-11  # of the greatest torque: what the last coefficients may be
_LONGEST, _SHORTEST = 0.1, 1e-3  # s of a piece
_COUNT = TAPE_DEGREE + 1
_ANGLES = np.pi * (np.arange(_COUNT) + 0.5) / _COUNT
_POINTS = 0.5 - 0.5 * np.cos(_ANGLES)  # within a piece, 0 to 1


def course(
    chosen: System, takeoff: Takeoff, plans: tuple[JointPlan, ...], begun: Starts, duration: float
) -> Course:
    """The course of N flights, with their motor tapes."""
    if takeoff.tape is None:
        return Course(chosen, plans, begun, duration)
    nominal = tuple(
        replace(plan, motion="prescribed", following=False, stops=()) if plan.on_path else plan
        for plan in plans
    )
    omega = tuple(float(x) for x in takeoff.tape)
    length, edges, torques = _nominal(chosen.model, nominal, omega, duration)
    values = {n: x for n, x in begun.values.items() if n[0] in ("times", "angles", "angle")}
    if any(isinstance(x, np.ndarray) for x in values.values()):
        count = len(begun.q)
        edges, torques = _recorded(chosen.model, nominal, omega, values, count, duration, length)
    played = [
        chosen.model.speed_slice(plan.joint.name).start
        for plan in plans
        if plan.motion == "compliant"
    ]
    return Course(chosen, plans, begun, duration, _tape(edges, torques[..., played]))


@lru_cache(maxsize=64)
def _nominal(
    model: Model, plans: tuple[JointPlan, ...], omega: tuple[float, ...], duration: float
) -> tuple[float, Array, Array]:
    """How long pieces may be, and what is recorded with them. Flights whose motions differ from
    this one in numbers have pieces of the same length."""
    length = _LONGEST
    while True:
        edges, torques = _recorded(model, plans, omega, {}, 1, duration, length)
        last = _combined(_TO_SERIES[-2:], torques)
        most = np.abs(torques).max(initial=0.0)
        if np.abs(last).max(initial=0.0) <= _LEFT_OUT * most or length < _SHORTEST:
            return length, edges, torques
        length /= 2


def _recorded(
    model: Model, plans: tuple[JointPlan, ...], omega: tuple[float, ...], values: Numbers,
    count: int, duration: float, length: float,
) -> tuple[Array, Array]:  # fmt: skip
    """Edges (count, P + 1) of pieces no longer than `length`, and the torques at their points,
    (count, P, points, joint speeds)."""
    own, alone = system(model, kinds(plans), None), Takeoff(angular_velocity=omega)
    begun = starts(own, alone, plans, {**numbers(alone, plans), **values}, count)
    flight = Course(own, plans, begun, duration)
    edges = _divided(flight.knots, length)
    times = edges[:, :-1, None] + np.diff(edges)[..., None] * _POINTS
    times = np.minimum(times.reshape(len(edges), -1), duration)
    first = own.start(begun.quaternion, begun.omega, begun.q, begun.u)
    found = flight.solve(first, times, _TOLERANCE)
    many = np.broadcast_to(times, (count, times.shape[1]))
    x = np.concatenate([found.states, many[..., None], flight.parameters(many)], 2)
    torques = own.loads(x)[..., 6:]
    return edges, torques.reshape(count, -1, _COUNT, torques.shape[-1])


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


def _tape(edges: Array, torques: Array) -> Path:
    """The polynomials through torques (N, P, points, joints), side by side for all joints."""
    span = np.diff(edges)[..., None, None]
    scale = span ** np.arange(_COUNT)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):  # pieces of no length
        powers = _combined(_TO_POWERS, _combined(_TO_SERIES, torques)) / scale
    powers = np.where(span > 0, powers, 0.0)
    before, after = np.zeros_like(powers[:, :1]), np.zeros_like(powers[:, :1])
    before[:, 0, 0] = powers[:, 0, 0]
    after[:, 0, 0] = (powers[:, -1] * scale[:, -1]).sum(-2)
    whole = np.concatenate([before, powers, after], 1).swapaxes(-1, -2)
    return Path(edges, whole.reshape(*whole.shape[:2], -1))


def _combined(matrix: Array, values: Array) -> Array:
    """matrix (m, n) times values (…, n, joints), in one order of adding."""
    return np.stack([sum(w * values[..., k, :] for k, w in enumerate(r)) for r in matrix], -2)


def _powers_of_series() -> Array:
    """Powers of u (rows) in the Chebyshev polynomials of 2 u − 1 (columns)."""
    found = np.zeros((_COUNT, _COUNT))
    found[0, 0], found[:2, 1] = 1.0, (-1.0, 2.0)
    for k in range(2, _COUNT):
        found[1:, k] = 4 * found[:-1, k - 1]
        found[:, k] -= 2 * found[:, k - 1] + found[:, k - 2]
    return found


# From values at the points to the coefficients of Chebyshev polynomials, and on to powers.
_TO_SERIES = 2 / _COUNT * np.cos(np.outer(np.arange(_COUNT), np.pi - _ANGLES))
_TO_SERIES[0] /= 2
_TO_POWERS = _powers_of_series()
