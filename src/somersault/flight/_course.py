"""Flights from one knot of their paths to the next.

Between knots every path is one polynomial, whose coefficients are parameters of the equations, as
are those of the motor tape; no step of the integration goes across a knot. Without paths a flight
is one piece.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from somersault._core.array import Array
from somersault.engine import MOST_STEPS, Pieces, Solution
from somersault.flight._start import Starts, momentum
from somersault.flight._system import System
from somersault.flight.behaviours import JointPlan
from somersault.motion import Path


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
        paths = [
            (plan.joint.name, path)
            for plan in plans
            for path in plan.does.paths(plan.joint, begun.values, len(begun.q))
        ]
        for name, path in paths:
            path.check_known(name, duration)
        self._changing = [path for _, path in paths] + ([] if tape is None else [tape])
        self._tape = tape
        self._still = self._lasting(begun)

    def _lasting(self, begun: Starts) -> Array:
        """Parameters that stay as they are, (N, …)."""
        model = self._system.model
        parts = [begun.bodies]
        for plan in self._plans:
            where = model.coordinate_slice(plan.joint.name)
            parts.append(plan.does.lasting(plan.joint, begun.values, begun.q[:, where]))
        if self._system.layout.bound:
            parts.append(momentum(self._system, begun))
        return np.concatenate(parts, 1)

    @cached_property
    def knots(self) -> Array:
        """0, all knots that the flights go past, and the duration, (N or 1, K).

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
            every=self._system.layout.every,
        )  # fmt: skip
