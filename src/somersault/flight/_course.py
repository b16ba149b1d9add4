"""Flights from one knot of their prescribed paths to the next.

Between knots every prescribed joint follows one polynomial, whose coefficients are parameters
of the equations; no step of the integration goes across a knot. Without prescribed joints a
flight is one piece.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from somersault._array import Array
from somersault.dynamics._integrator import FIRST_STEP, MOST_STEPS, STATUS, Solution
from somersault.flight._columns import Name, Numbers, path, row
from somersault.flight._path import Path
from somersault.flight._start import Starts, momentum
from somersault.flight._symbols import PATH, parameter_count
from somersault.flight._system import System
from somersault.flight._takeoff import JointPlan

_FLYING = next(code for code, word in STATUS.items() if word == "duration")


class Course:
    """The parameters of N flights as time goes on, and the times at which they change."""

    def __init__(
        self, system: System, plans: tuple[JointPlan, ...], begun: Starts, duration: float
    ) -> None:
        self.duration = duration
        self._system, self._plans = system, plans
        count = len(begun.q)
        self._paths: dict[str, Path] = {
            plan.joint.name: path(plan, begun.values, count) for plan in plans if plan.on_path
        }
        for name, whole in self._paths.items():
            whole.check_known(name, duration)
        self._still = self._constants(begun)
        self.ends = self._knots()

    def _constants(self, begun: Starts) -> Array:
        """Parameters that stay, with room for those of paths, (N, parameters)."""
        parts, place = [begun.bodies], 0
        for plan in self._plans:
            if plan.on_path:
                parts.append(np.zeros((len(begun.q), PATH)))
                if plan.motion == "compliant":
                    names: list[Name] = [(g, plan.joint.name) for g in ("stiffness", "damping")]
                    parts.append(row(begun.values, names, len(begun.q)))
                    parts.append(np.tile(plan.stops, (len(begun.q), 1)))
            elif plan.motion == "locked":
                parts.append(begun.q[:, place : place + plan.joint.coordinates])
            else:
                parts.append(_spring(plan, begun.values, len(begun.q)))
                parts.append(np.tile(plan.stops, (len(begun.q), 1)))
            place += plan.joint.coordinates
        if self._system.symbols.bound:
            parts.append(momentum(self._system, begun))
        return np.concatenate(parts, 1)

    def _knots(self) -> Array:
        """When each piece of each flight ends, (count or 1, pieces)."""
        if not self._paths:
            return np.full((1, 1), self.duration)
        every = [np.atleast_2d(p.knots) for p in self._paths.values()]
        rows = max(len(k) for k in every)
        whole = np.concatenate([np.broadcast_to(k, (rows, k.shape[1])) for k in every], 1)
        whole = np.sort(np.clip(whole, 0.0, self.duration), 1)
        if rows == 1:
            whole = np.unique(whole)[None]
            whole = whole[:, whole[0] > 0]
        last = np.full((rows, 1), self.duration)
        return np.concatenate([whole[:, whole[0] < self.duration] if rows == 1 else whole, last], 1)

    def parameters(self, times: Array) -> Array:
        """Those that hold at times (count, K) and a little after: (count, K, parameters)."""
        result = np.repeat(self._still[:, None], times.shape[1], 1)
        place = len(self._system.bodies)
        for plan in self._plans:
            if plan.on_path:
                since, coefficients = self._paths[plan.joint.name].at(times)
                result[..., place] = since
                result[..., place + 1 : place + PATH] = coefficients
            place += parameter_count(plan.joint, plan.kind)
        return result


def _spring(plan: JointPlan, values: Numbers, count: int) -> Array:
    """Stiffness, rest, damping and pretension of a joint that moves freely, (count, 4)."""
    name = plan.joint.name
    own = np.empty((count, 4))
    own[:, 0] = values.get(("stiffness", name), 0.0)
    held = values[("angle", name)] if plan.hold else plan.rest
    own[:, 1] = values.get(("rest", name), held)
    own[:, 2] = values[("damping", name)]
    own[:, 3] = values.get(("pretension", name), 0.0)
    return own


def solve(
    system: System, first: Array, course: Course, samples: Array, tolerance: float,
    watched: Array | None = None, most_steps: float = MOST_STEPS,
) -> Solution:  # fmt: skip
    """From states `first` (N, n) along a course, with states at increasing `samples` (K,).

    The last sample is not before the course ends.
    """
    count = len(first)
    begin = np.zeros(count)
    ends = np.broadcast_to(course.ends, (count, course.ends.shape[1]))
    if ends.shape[1] == 1:
        parameters = course.parameters(begin[:, None])[:, 0]
        return system.integrator.solve(
            first, parameters, samples, tolerance, watched=watched, most_steps=most_steps
        )
    whole: Solution | None = None
    for piece in range(ends.shape[1]):
        end = ends[:, piece]
        parameters = course.parameters(begin[:, None])[:, 0]
        inside = (samples > begin.min()) & (samples <= end.max())
        inside[0] |= piece == 0
        chosen = samples[inside]
        final = piece == ends.shape[1] - 1
        if not chosen.size or (not final and chosen[-1] < end.max()):
            chosen = np.append(chosen, end.max())
        if whole is None:
            found = system.integrator.solve(
                first, parameters, chosen, tolerance, end, watched=watched, most_steps=most_steps
            )
            whole = _opened(found, len(samples))
        else:
            # Lanes that have ended already take no step: they end where they are.
            flying = whole.status == _FLYING
            found = system.integrator.solve(
                whole.final, parameters, chosen, tolerance, np.where(flying, end, begin),
                begin=begin, step=np.where(whole.step > 0, whole.step, FIRST_STEP),
                watched=whole.watched_final, most_steps=np.maximum(most_steps - whole.steps, 1),
            )  # fmt: skip
        whole = _joined(whole, found, samples, inside, begin, piece)
        begin = np.where(whole.status == _FLYING, end, whole.end)
    assert whole is not None
    return whole


def _opened(found: Solution, count: int) -> Solution:
    """A solution with room for the samples of the whole flight, and nothing in it yet."""
    lanes = len(found.end)
    return replace(
        found,
        states=np.empty((lanes, count, found.states.shape[2])),
        watched=np.empty((lanes, count, found.watched.shape[2])),
        status=np.full(lanes, _FLYING),
        steps=np.zeros(lanes, int),
    )


def _joined(
    whole: Solution, found: Solution, samples: Array, inside: Array, begin: Array, piece: int
) -> Solution:
    """A solution with its next piece added."""
    fresh = whole.status == _FLYING
    for k, place in enumerate(np.flatnonzero(inside).tolist()):
        new = fresh & ((samples[place] > begin) | (piece == 0))
        whole.states[new, place] = found.states[new, k]
        whole.watched[new, place] = found.watched[new, k]
    # A lane that has ended shows its last state at all later samples.
    over = fresh & (found.status != _FLYING)
    if over.any():
        later = samples[None, :] > found.end[:, None]
        for place in range(len(samples)):
            which = over & later[:, place]
            whole.states[which, place] = found.final[which]
            whole.watched[which, place] = found.watched_final[which]
    return replace(
        whole,
        end=np.where(fresh, found.end, whole.end),
        final=np.where(fresh[:, None], found.final, whole.final),
        watched_final=np.where(fresh[:, None], found.watched_final, whole.watched_final),
        status=np.where(fresh, found.status, whole.status),
        steps=np.where(fresh, whole.steps + found.steps, whole.steps),
        step=np.where(fresh, found.step, whole.step),
    )
