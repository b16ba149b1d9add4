"""`fly`: one free flight, from takeoff to landing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np

from somersault._array import Array
from somersault._errors import SomersaultError
from somersault.attitude import angles_from_quaternion
from somersault.dynamics._integrator import STATUS
from somersault.flight._flight import Flight
from somersault.flight._numbers import number, numbers
from somersault.flight._start import Start, start
from somersault.flight._system import System, kinds, system
from somersault.flight._takeoff import Takeoff, plans
from somersault.model import Model, load

Event = Literal["quarter twist"]
TOLERANCE_PER_ACCURACY = 1 / 20  # measured: eight somersaults add up about ten step errors
_FINEST_TURN = 0.6  # rad between the points that turns are counted on
_MOST_POINTS = 5_000_000
_MOST_REFINEMENTS = 4
_CLOSEST = 0.02  # cos Θ: a path nearer the singularity than this is taken to go through


def fly(
    model: str | Model,
    takeoff: Takeoff | None = None,
    duration: float = 1.0,
    *,
    gravity: Sequence[float] = (0.0, 0.0, 0.0),
    accuracy: float = 1e-9,
    samples: int | Sequence[float] | Array | None = None,
    until: Event | None = None,
) -> Flight:
    """The free flight of a model from a takeoff, for `duration` seconds.

    `gravity` (m/s², inertial axes) moves the centre of mass and nothing else. `accuracy` (rad)
    is the attitude error to stay below over a flight of some somersaults; a body that tumbles
    multiplies errors as it does all deviations. `samples` is how many evenly spaced times are
    kept, the ends included, or the times themselves; by default 100 a second. `until`
    "quarter twist" ends the flight when twist passes ±π/2 (body axis 2 at right angles to
    inertial axis 2), found to rounding. Raises SomersaultError for anything that does not fit.
    """
    model = load(model)
    takeoff = takeoff or Takeoff()
    duration = number("duration", duration)
    times = _times(duration, samples)
    g = numbers("gravity", gravity, 3)
    if not 1e-14 <= number("accuracy", accuracy) <= 1e-2:
        raise SomersaultError(f"accuracy {accuracy:g} rad is out of reach; give 1e-14 to 1e-2")
    if until not in (None, "quarter twist"):
        raise SomersaultError(f"until {until!r} is no event; use 'quarter twist'")
    joints = plans(model, takeoff.joints)
    chosen = system(model, kinds(joints), until)
    begun = start(chosen, takeoff, joints)
    return _flown(chosen, begun, takeoff, times, duration, g, accuracy)


def _times(duration: float, samples: int | Sequence[float] | Array | None) -> Array:
    if duration <= 0:
        raise SomersaultError(f"duration {duration:g} s is no flight; give a positive number")
    if samples is None:
        samples = int(min(max(2, math.ceil(100 * duration) + 1), 100_001))
    if isinstance(samples, int | np.integer) and not isinstance(samples, bool):
        if not 2 <= samples <= _MOST_POINTS:
            raise SomersaultError(f"samples must be 2 to {_MOST_POINTS}, and is {samples}")
        return np.linspace(0.0, duration, int(samples))
    times = numbers("samples", samples)
    if not times.size or np.any(np.diff(times) <= 0) or times[0] < 0 or times[-1] > duration:
        raise SomersaultError("samples must be times that increase from 0 or later to the duration")
    return times


def _flown(
    chosen: System,
    begun: Start,
    takeoff: Takeoff,
    times: Array,
    duration: float,
    gravity: Array,
    accuracy: float,
) -> Flight:
    """Solve on points that are close enough to count turns on, if need be again on closer ones."""
    parameters = chosen.parameter_vector(begun.plans)
    first = chosen.start(begun.quaternion, begun.omega, begun.q, begun.u)
    points = np.union1d(times, [0.0, duration])
    parts = _first_parts(chosen, begun, points)
    for _ in range(_MOST_REFINEMENTS):
        fine, index = _divided(points, parts)
        solution = chosen.integrator.solve(
            first[None], parameters[None], fine, accuracy * TOLERANCE_PER_ACCURACY
        )
        end = float(solution.end[0])
        flown = fine < end
        states = np.concatenate([solution.states[0][flown], solution.final])
        needed = _needed(states, fine[flown], index, len(points))
        if np.all(needed <= 1) or parts.sum() > _MOST_POINTS:
            break
        parts = np.minimum(parts * needed, _MOST_POINTS // len(points) + 1)
    kept = np.isin(fine[flown], times)
    status = float(solution.status[0])
    # The end is kept where it was asked for, and where something cut the flight short.
    keep = np.append(kept, status != 0 or times[-1] == duration)
    return Flight(
        chosen, begun, np.asarray(takeoff.velocity, float), gravity, np.append(fine[flown], end),
        states, keep, parameters, STATUS[status], int(solution.steps[0]),
    )  # fmt: skip


def _first_parts(chosen: System, begun: Start, points: Array) -> Array:
    """Into how many parts each gap must be divided, by how fast the body turns at takeoff."""
    least = np.linalg.eigvalsh(chosen.equations.inertia(begun.q))[0]
    fastest = np.linalg.norm(begun.momentum) / least + np.abs(begun.u).sum()
    gaps = np.diff(points, prepend=0.0)
    parts = np.ceil(gaps * fastest / _FINEST_TURN)
    return np.clip(parts, 1, _MOST_POINTS // len(points) + 1).astype(int)


def _divided(points: Array, parts: Array) -> tuple[Array, Array]:
    """Points with each gap before one divided evenly, and which gap each belongs to."""
    index = np.repeat(np.arange(len(points)), parts)
    last = np.cumsum(parts) - 1
    within = (np.arange(len(index)) - np.repeat(last - parts, parts)) / np.repeat(parts, parts)
    gaps = np.diff(points, prepend=0.0)
    fine = points[index] - gaps[index] * (1 - within)
    fine[last] = points
    return fine, index


def _needed(states: Array, times: Array, index: Array, gaps: int) -> Array:
    """By how much each gap must be divided further for its turns to be counted rightly.

    Near tilt ±π/2 somersault and twist run as fast as the body turns over cos Θ.
    """
    q = states[:, :4] / np.linalg.norm(states[:, :4], axis=1, keepdims=True)
    cosine = np.abs(np.einsum("tk,tk->t", q[1:], q[:-1]))
    turn = 2 * np.arccos(np.minimum(cosine, 1.0))
    tilt = angles_from_quaternion(q)[:, 1]
    upright = np.cos(tilt)
    worst = turn / np.maximum(np.minimum(upright[1:], upright[:-1]), _CLOSEST)
    needed = np.ones(gaps, int)
    np.maximum.at(needed, index[1 : len(turn) + 1], np.ceil(worst[: len(index) - 1]).astype(int))
    return needed
