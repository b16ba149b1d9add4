"""One flight of a batch, with a history on which every turn is counted."""

from __future__ import annotations

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.stages import stage
from somersault.attitude import SINGULAR, Axes, angles_from_quaternion, cayley_klein
from somersault.engine import STATUS
from somersault.flight._batch import Batch, Begun
from somersault.flight._flight import Flight
from somersault.flight._plane import turning
from somersault.flight._start import Start
from somersault.flight._system import System
from somersault.flight._watch import NEAREST

_STEPS_A_POINT = 20  # more, for each point that samples or turns need
_FINEST_TURN = 0.6  # rad between the points that turns are counted on
_MOST_BYTES = 2**30  # of one flight
_MOST_REFINEMENTS = 24
_MOST_PARTS = 16  # of a gap at once
_A_HALF_TURNS = 1.0  # rad, from point to point, at most


def flown(
    batch: Batch, times: Array, gravity: Array, accuracy: float, steps: int,
    begun: Begun | None = None,
) -> Flight:  # fmt: skip
    """The one flight of a batch, or the one that `begun` has of it, kept at `times` (s).

    It is solved on points that are close enough to count turns on, if need be again on closer ones.
    """
    begun, duration = begun or batch.begun(), batch.duration
    most = _MOST_BYTES // _point_bytes(batch)
    points = _first_points(batch.system, begun.start, np.union1d(times, [0.0, duration]), most)
    for left in reversed(range(_MOST_REFINEMENTS)):
        with stage(f"flying {duration:g} s"):
            solution = begun.solve(points, accuracy, steps + _STEPS_A_POINT * len(points))
        end, status = float(solution.end[0]), float(solution.status[0])
        before = points < end
        states = np.concatenate([solution.states[0][before], solution.final])
        moments = np.append(points[before], end)
        parts = _needed(states, batch.model.axes)
        if not left or np.all(parts <= 1) or len(points) + parts.sum() > most:
            break
        points = np.union1d(_divided(moments, parts), points)
    kept = np.isin(points[before], times)
    # The end is kept where it was asked for, and where something cut the flight short.
    keep = np.append(kept, status != 0 or times[-1] == duration)
    position, velocity = (
        np.asarray(x, float) for x in (batch.takeoff.position, batch.takeoff.velocity)
    )
    return Flight(
        batch.model, batch.system, begun.start, position, velocity, gravity, moments, states, keep,
        begun.course, STATUS[status], int(solution.steps[0]),
    )  # fmt: skip


def _point_bytes(batch: Batch) -> int:
    """Of memory, for a point of a flight and all that is read from it: some copies of the state,
    the parameters and the joints, and what there is of the whole body."""
    layout, model = batch.system.layout, batch.model
    joints = len(model.coordinates) + len(model.speeds)
    return 8 * (40 + 4 * (layout.state + layout.parameters + joints))


def _first_points(chosen: System, begun: Start, points: Array, most: int) -> Array:
    """The points with more between them where the body turns far, by its rate at takeoff.

    SomersaultError for more than `most`, before there are any.
    """
    ways = turning(chosen.model)
    least = np.linalg.eigvalsh(chosen.equations.inertia(begun.q)[np.ix_(ways, ways)])[0]
    fastest = np.linalg.norm(begun.momentum) / least + np.abs(begun.u).sum()
    parts = np.maximum(np.ceil(np.diff(points) * fastest / _FINEST_TURN), 1)
    if not parts.sum() < most:
        turn = fastest * (points[-1] - points[0]) / (2 * np.pi)
        raise SomersaultError(
            f"{chosen.model.name} may turn up to {turn:.2g} times in {points[-1]:g} s, and keep "
            f"{len(points)} samples, where {most} moments fit into the "
            f"{_MOST_BYTES / 2**30:g} GB that a flight may take; make it shorter, slower or more "
            "sparsely sampled"
        )
    return np.append(_divided(points, parts.astype(int)), points[-1])


def _divided(points: Array, parts: Array) -> Array:
    """The points but the last, each gap after one divided evenly into so many parts."""
    start = np.cumsum(parts) - parts
    within = (np.arange(parts.sum()) - np.repeat(start, parts)) / np.repeat(parts, parts)
    return np.repeat(points[:-1], parts) + np.repeat(np.diff(points), parts) * within


def _needed(states: Array, axes: Axes) -> Array:
    """Into how many parts each gap must be divided for its turns to be counted rightly.

    Towards tilt ±π/2 somersault and twist run as fast as the body turns over cos Θ, so it must
    turn by less than half of cos Θ from point to point: then no pole lies between. Where that is
    next to nothing it is enough that the half of the angles that runs off is followed; a path that
    comes nearer than `SINGULAR` goes through.
    """
    q = states[:, :4] / np.linalg.norm(states[:, :4], axis=1, keepdims=True)
    # The distance of unit quaternions keeps its digits where their product would not.
    apart = np.minimum(
        np.linalg.norm(q[1:] - q[:-1], axis=1), np.linalg.norm(q[1:] + q[:-1], axis=1)
    )
    turn = 4 * np.arcsin(np.minimum(apart / 2, 1.0))
    upright = np.abs(np.cos(angles_from_quaternion(q, axes)[:, 1]))
    near = np.minimum(upright[1:], upright[:-1])
    parts = np.clip(np.ceil(2 * turn / np.maximum(near, NEAREST)), 1, _MOST_PARTS).astype(int)
    followed = (near > NEAREST) | (near < SINGULAR) | (_half_turns(q, axes) < _A_HALF_TURNS)
    return np.where(followed, parts, _MOST_PARTS)


def _half_turns(q: Array, axes: Axes) -> Array:
    """The angle by which the half of somersault and twist that runs off turns in each gap."""
    up, down = cayley_klein(q, axes)
    short = np.where(np.abs(down[1:]) < np.abs(up[1:]), [down[:-1], down[1:]], [up[:-1], up[1:]])
    same = np.sign(np.einsum("ti,ti->t", q[1:], q[:-1]))  # q and −q are one attitude
    return np.abs(np.angle(same * short[1] * short[0].conj()))
