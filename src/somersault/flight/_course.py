"""Flights from one knot of their prescribed paths to the next.

Between knots every prescribed joint follows one polynomial, whose coefficients are parameters
of the equations, as are those of the motor tape; no step of the integration goes across a knot.
Without prescribed joints a flight is one piece.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from somersault._core.array import Array
from somersault.engine import MOST_STEPS, Pieces, Solution
from somersault.flight._columns import Name, Numbers, path, row
from somersault.flight._start import Starts, momentum
from somersault.flight._system import System
from somersault.flight._takeoff import JointPlan
from somersault.motion._path import Path


class Course:
    """The parameters of N flights as time goes on, and the times at which they change.

    `tape` has the torques of all compliant joints side by side.
    """

    def __init__(
        self,
        system: System,
        plans: tuple[JointPlan, ...],
        begun: Starts,
        duration: float,
        tape: Path | None = None,
    ) -> None:
        self.duration = duration
        self._system, self._plans = system, plans
        paths = {
            plan.joint.name: path(plan, begun.values, len(begun.q))
            for plan in plans
            if plan.on_path
        }
        for name, whole in paths.items():
            whole.check_known(name, duration)
        self._changing = [*paths.values(), *([] if tape is None else [tape])]
        self._tape = tape
        self._still = self._lasting(begun)

    def _lasting(self, begun: Starts) -> Array:
        """Parameters that stay as they are, (N, …)."""
        count, place = len(begun.q), 0
        parts = [begun.bodies]
        for plan in self._plans:
            if plan.motion == "compliant":
                names: list[Name] = [(g, plan.joint.name) for g in ("stiffness", "damping")]
                parts.append(row(begun.values, names, count))
            elif plan.motion == "locked":
                parts.append(begun.q[:, place : place + plan.joint.coordinates])
            elif plan.motion != "prescribed":
                parts.append(_spring(plan, begun.values, count))
            if plan.stops:
                parts.append(np.tile(plan.stops, (count, 1)))
            place += plan.joint.coordinates
        if self._system.symbols.bound:
            parts.append(momentum(self._system, begun))
        return np.concatenate(parts, 1)

    @cached_property
    def knots(self) -> Array:
        """The times from 0 to the end between which all is smooth, (N or 1, K).

        Where flights have knots of their own some intervals have no length.
        """
        if self._tape is not None:  # its pieces end at all knots
            return np.atleast_2d(self._tape.knots)
        every = [np.atleast_2d(p.knots) for p in self._changing]
        rows = max([1, *(len(k) for k in every)])
        ends = [np.zeros((rows, 1)), np.full((rows, 1), self.duration)]
        whole = np.concatenate(ends + [np.broadcast_to(k, (rows, k.shape[1])) for k in every], 1)
        whole = np.sort(np.clip(whole, 0.0, self.duration), 1)
        return np.unique(whole)[None] if rows == 1 else whole

    def _now(self, times: Array) -> Array:
        """Parameters that change, at times (N or 1, K) and a little after, (N or 1, K, …)."""
        parts = [np.empty((*times.shape, 0))]
        for one in self._changing:
            since, coefficients = one.at(times)
            parts += [since[..., None], coefficients]
        rows = max(len(part) for part in parts)
        return np.concatenate([np.broadcast_to(p, (rows, *p.shape[1:])) for p in parts], 2)

    def parameters(self, times: Array) -> Array:
        """Those that hold at times (N, K) and a little after: (N, K, parameters)."""
        still = np.broadcast_to(self._still[:, None], (*times.shape, self._still.shape[1]))
        return np.concatenate([self._now(times), still], 2)

    def solve(
        self, first: Array, samples: Array, tolerance: float, most_steps: int = MOST_STEPS,
    ) -> Solution:  # fmt: skip
        """From rows of `System.start`, with states at `samples` (K,) or (N, K)."""
        pieces = Pieces(self.knots[:, 1:], self._now(self.knots[:, :-1]))
        return self._system.integrator.solve(
            first, self._still, samples, tolerance, pieces=pieces, most_steps=most_steps,
        )  # fmt: skip


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
