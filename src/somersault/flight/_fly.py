"""`fly`: one free flight, from takeoff to landing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number, numbers
from somersault.attitude import Axes, angles_from_quaternion
from somersault.engine import STATUS
from somersault.flight._flight import Flight
from somersault.flight._start import Start, start
from somersault.flight._system import System, system
from somersault.flight._takeoff import Takeoff, kinds, plans, require_takeoff
from somersault.flight._tape import course as course_of
from somersault.model import Model, load

Event = Literal["quarter twist"]
TOLERANCE_PER_ACCURACY = 1 / 20  # measured: eight somersaults add up about ten step errors
STEPS = 100_000  # of one flight's integration
_STEPS_A_POINT = 20  # more, for each point that samples or turns need
_MOST_STEPS = 10**9
_FINEST_TURN = 0.6  # rad between the points that turns are counted on
_MOST_POINTS = 5_000_000
_MOST_REFINEMENTS = 24
_MOST_PARTS = 16  # of a gap at once
_CLOSEST = 1e-6  # cos Θ: a path nearer the singularity than this is taken to go through


def fly(
    model: str | Model,
    takeoff: Takeoff | None = None,
    duration: float = 1.0,
    *,
    gravity: Sequence[float] = (0.0, 0.0, 0.0),
    accuracy: float = 1e-9,
    samples: int | Sequence[float] | Array | None = None,
    until: Event | None = None,
    steps: int = STEPS,
) -> Flight:
    """The free flight of a model from a takeoff, for `duration` seconds.

    `gravity` (m/s², inertial axes) moves the centre of mass and nothing else. `accuracy` (rad)
    is the attitude error to stay below over a flight of some somersaults; a body that tumbles
    multiplies errors as it does all deviations. `samples` is how many evenly spaced times are
    kept, the ends included, or the times themselves; by default 100 a second. `until`
    "quarter twist" ends the flight when twist passes ±π/2 (the body's axis of somersault at right
    angles to the inertial one), found to rounding. A flight that is not done after `steps` steps of
    the integration, and twenty more for every sample and every 0.6 rad that it may turn, is given
    up, `ended` by "too many steps": a joint in gimbal lock, or a spring too stiff. Raises
    SomersaultError for anything that does not fit.
    """
    model = load(model)
    takeoff = Takeoff() if takeoff is None else takeoff
    require_takeoff(takeoff)
    duration = flight_time(duration)
    times = _times(duration, samples)
    g = numbers("gravity", gravity, 3)
    check_ending(accuracy, until, steps)
    joints = plans(model, takeoff.joints)
    chosen = system(model, kinds(joints), until, tape=takeoff.tape is not None)
    begun = start(chosen, takeoff, joints)
    return _flown(chosen, begun, takeoff, times, duration, g, accuracy, steps)


def flight_time(duration: float) -> float:
    """A duration in s; SomersaultError for one that is no flight."""
    if number("duration", duration) <= 0:
        raise SomersaultError(f"duration {duration:g} s is no flight; give a positive number")
    return float(duration)


def check_ending(accuracy: float, until: str | None, steps: int) -> None:
    """SomersaultError unless a flight can be flown so accurately, until such an event, in so many
    steps."""
    if not 1e-14 <= number("accuracy", accuracy) <= 1e-2:
        raise SomersaultError(f"accuracy {accuracy:g} rad is out of reach; give 1e-14 to 1e-2")
    if until is not None and not (isinstance(until, str) and until == "quarter twist"):
        raise SomersaultError(f"until {until!r} is no event; use 'quarter twist'")
    whole_number("steps", steps, 1, _MOST_STEPS)


def _times(duration: float, samples: int | Sequence[float] | Array | None) -> Array:
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
    steps: int,
) -> Flight:
    """Solve on points that are close enough to count turns on, if need be again on closer ones."""
    many = begun.many
    course = course_of(chosen, takeoff, begun.plans, many, duration)
    first = chosen.start(many.quaternion, many.omega, many.q, many.u)
    points = _first_points(chosen, begun, np.union1d(times, [0.0, duration]))
    for _ in range(_MOST_REFINEMENTS):
        solution = course.solve(
            first, points, accuracy * TOLERANCE_PER_ACCURACY,
            most_steps=steps + _STEPS_A_POINT * len(points),
        )  # fmt: skip
        end, status = float(solution.end[0]), float(solution.status[0])
        flown = points < end
        states = np.concatenate([solution.states[0][flown], solution.final])
        moments = np.append(points[flown], end)
        parts = _needed(states, chosen.model.axes)
        if np.all(parts <= 1) or len(points) + parts.sum() > _MOST_POINTS:
            break
        points = np.union1d(_divided(moments, parts), points)
    kept = np.isin(points[flown], times)
    # The end is kept where it was asked for, and where something cut the flight short.
    keep = np.append(kept, status != 0 or times[-1] == duration)
    return Flight(
        chosen, begun, np.asarray(takeoff.velocity, float), gravity, moments, states, keep,
        course, STATUS[status], int(solution.steps[0]),
    )  # fmt: skip


def _first_points(chosen: System, begun: Start, points: Array) -> Array:
    """The points with more between them where the body turns far, by its rate at takeoff."""
    least = np.linalg.eigvalsh(chosen.equations.inertia(begun.q))[0]
    fastest = np.linalg.norm(begun.momentum) / least + np.abs(begun.u).sum()
    parts = np.ceil(np.diff(points) * fastest / _FINEST_TURN)
    return np.append(
        _divided(points, np.clip(parts, 1, _MOST_POINTS // len(points)).astype(int)), points[-1]
    )


def _divided(points: Array, parts: Array) -> Array:
    """The points but the last, each gap after one divided evenly into so many parts."""
    start = np.cumsum(parts) - parts
    within = (np.arange(parts.sum()) - np.repeat(start, parts)) / np.repeat(parts, parts)
    return np.repeat(points[:-1], parts) + np.repeat(np.diff(points), parts) * within


def _needed(states: Array, axes: Axes) -> Array:
    """Into how many parts each gap must be divided for its turns to be counted rightly.

    Near tilt ±π/2 somersault and twist run as fast as the body turns over cos Θ, so it must
    turn by less than half of cos Θ from point to point: then no pole lies between.
    """
    q = states[:, :4] / np.linalg.norm(states[:, :4], axis=1, keepdims=True)
    # The distance of unit quaternions keeps its digits where their product would not.
    apart = np.minimum(
        np.linalg.norm(q[1:] - q[:-1], axis=1), np.linalg.norm(q[1:] + q[:-1], axis=1)
    )
    turn = 4 * np.arcsin(np.minimum(apart / 2, 1.0))
    upright = np.abs(np.cos(angles_from_quaternion(q, axes)[:, 1]))
    near = np.maximum(np.minimum(upright[1:], upright[:-1]), _CLOSEST)
    return np.clip(np.ceil(2 * turn / near), 1, _MOST_PARTS).astype(int)
