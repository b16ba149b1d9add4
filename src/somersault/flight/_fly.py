"""`fly`: one free flight, from takeoff to landing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np

from somersault._array import Array
from somersault._errors import SomersaultError
from somersault.dynamics._integrator import STATUS
from somersault.flight._flight import Flight
from somersault.flight._start import Start, start
from somersault.flight._system import System, kinds, system
from somersault.flight._takeoff import JointPlan, Takeoff, plans
from somersault.model import Model, load
from somersault.stability import Spin
from somersault.stability import spin as steady_spin

Event = Literal["quarter twist"]
TOLERANCE_PER_ACCURACY = 1 / 20  # measured: eight somersaults add up about ten step errors
_FINEST_TURN = 0.6  # rad between the points that turns are counted on
_MOST_POINTS = 5_000_000


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
    "quarter twist" ends the flight when the angular momentum's component along body axis 2
    changes sign, found to rounding. Raises SomersaultError for anything that does not fit.
    """
    model = load(model)
    takeoff = takeoff or Takeoff()
    times = _times(duration, samples)
    g = np.asarray(gravity, float)
    if g.shape != (3,) or not np.all(np.isfinite(g)):
        raise SomersaultError("gravity must be 3 finite numbers in m/s²")
    if not 1e-14 <= accuracy <= 1e-2:
        raise SomersaultError(f"accuracy {accuracy:g} rad is out of reach; give 1e-14 to 1e-2")
    if until not in (None, "quarter twist"):
        raise SomersaultError(f"until {until!r} is no event; use 'quarter twist'")
    joints = plans(model, takeoff.joints)
    chosen = system(model, kinds(joints), until)
    nominal = _nominal(model, joints)
    begun = start(chosen, takeoff, joints, nominal)
    return _flown(chosen, begun, takeoff, times, g, accuracy)


def _nominal(model: Model, joints: tuple[JointPlan, ...]) -> Spin:
    angles = {p.joint.name: p.position[0] for p in joints if p.joint.kind != "ball"}
    return steady_spin(model, 2, angles)


def _times(duration: float, samples: int | Sequence[float] | Array | None) -> Array:
    if not math.isfinite(duration) or duration <= 0:
        raise SomersaultError(f"duration {duration} s is no flight; give a positive number")
    if samples is None:
        samples = min(max(2, math.ceil(100 * duration) + 1), 100_001)
    if isinstance(samples, int | np.integer):
        if not 2 <= samples <= _MOST_POINTS:
            raise SomersaultError(f"samples must be 2 to {_MOST_POINTS}, and is {samples}")
        return np.linspace(0.0, duration, int(samples))
    times = np.asarray(samples, float)
    if times.ndim != 1 or not times.size or not np.all(np.isfinite(times)):
        raise SomersaultError("samples must be a number or a row of times")
    if np.any(np.diff(times) <= 0) or times[0] < 0 or times[-1] > duration:
        raise SomersaultError("sample times must increase from 0 or later to the duration")
    return times


def _flown(
    chosen: System, begun: Start, takeoff: Takeoff, times: Array, gravity: Array, accuracy: float
) -> Flight:
    fine, kept = _fine(times, _fastest(chosen, begun))
    parameters = chosen.parameter_vector(begun.plans)
    first = chosen.start(begun.quaternion, begun.omega, begun.q, begun.u)
    solution = chosen.integrator.solve(
        first[None], parameters[None], fine, accuracy * TOLERANCE_PER_ACCURACY
    )
    end = float(solution.end[0])
    flown = fine <= end
    states = np.concatenate([solution.states[0][flown], solution.final])
    moments = np.append(fine[flown], end)
    keep = np.append(kept[flown], True)
    if len(moments) > 1 and moments[-1] == moments[-2]:
        states, moments = states[:-1], moments[:-1]
        keep = np.append(keep[:-2], True)
    return Flight(
        chosen, begun, np.asarray(takeoff.velocity, float), gravity, moments, states, keep,
        parameters, STATUS[float(solution.status[0])] if solution.status[0] else "duration",
        int(solution.steps[0]),
    )  # fmt: skip


def _fastest(chosen: System, begun: Start) -> float:
    """A bound on how fast the body turns, from its momentum, rad/s."""
    least = np.linalg.eigvalsh(chosen.equations.inertia(begun.q))[0]
    return float(np.linalg.norm(begun.momentum) / least + np.abs(begun.u).sum() + 1e-3)


def _fine(times: Array, fastest: float) -> tuple[Array, Array]:
    """The times with enough between them that no turn goes uncounted, and which they are."""
    step = _FINEST_TURN / fastest
    gaps = np.diff(times, prepend=0.0)
    parts = np.minimum(np.maximum(np.ceil(gaps / step), 1), 1e6).astype(int)
    starts = times - gaps
    within = np.concatenate([np.arange(1, n + 1) / n for n in parts])
    fine = np.repeat(starts, parts) + np.repeat(gaps, parts) * within
    last = np.cumsum(parts) - 1
    fine[last] = times
    kept = np.zeros(len(fine), bool)
    kept[last] = True
    return fine, kept
