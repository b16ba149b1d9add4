"""Flights from one knot of their paths to the next.

Between knots every path is one polynomial, whose coefficients are parameters of the equations, as
are those of the motor tape; no step of the integration goes across a knot. Without paths a flight
is one piece. Where paths are replayed by a law, knots are reached at phases, not at times.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from somersault._core.array import Array
from somersault.engine import CLOCK, MOST_STEPS, Pieces, Solution, clock_at
from somersault.flight._start import Starts, momentum
from somersault.flight._system import System
from somersault.flight.behaviours import JointPlan
from somersault.motion import Path


class Course:
    """The parameters of N flights as time goes on, and the times at which they change.

    `tape` has the torques of all compliant joints side by side, `nominal` what is sensed of the
    nominal flight and a replay's law compares with. `changing` are the paths, then these two;
    `still` (N, …) are the parameters that stay as they are.
    """

    def __init__(
        self,
        system: System,
        plans: tuple[JointPlan, ...],
        begun: Starts,
        duration: float,
        tape: Path | None = None,
        nominal: Path | None = None,
    ) -> None:
        self.duration = duration
        self._system, self._plans = system, plans
        paths = [
            (plan.joint.name, path)
            for plan in plans
            for path in plan.does.paths(plan.joint, begun.values, len(begun.q))
        ]
        self._replayed = system.layout.replay
        fastest = float(np.max(begun.values["replay", "most"])) if self._replayed else 1.0
        for name, path in paths:
            path.check_known(name, fastest * duration)
        others = [path for path in (tape, nominal) if path is not None]
        self.changing = [path for _, path in paths] + others
        self._tape = tape
        self.still = self._lasting(begun)

    def _lasting(self, begun: Starts) -> Array:
        """Parameters that stay as they are, (N, …)."""
        model = self._system.model
        parts = [begun.bodies]
        playback = self._system.symbols.playback
        if playback is not None:
            parts.append(playback.lasting(begun.values, len(begun.q)))
        for plan in self._plans:
            where = model.coordinate_slice(plan.joint.name)
            parts.append(plan.does.lasting(plan.joint, begun.values, begun.q[:, where]))
        if self._system.layout.bound:
            parts.append(momentum(self._system, begun))
        return np.concatenate(parts, 1)

    @cached_property
    def knots(self) -> Array:
        """0, all knots that the flights go past, and the duration, (N or 1, K); all but the last
        are phases where there is a replay.

        Where flights have knots of their own some intervals have no length.
        """
        if self._tape is not None and not self._replayed:  # its pieces end at all knots
            return np.atleast_2d(self._tape.knots)
        every = [np.atleast_2d(p.knots) for p in self.changing]
        rows = max([1, *(len(k) for k in every)])
        ends = [np.zeros((rows, 1)), np.full((rows, 1), self.duration)]
        if self._replayed:  # the duration is no phase, and may be before the last knots or after
            ends.pop()
        whole = np.concatenate(ends + [np.broadcast_to(k, (rows, k.shape[1])) for k in every], 1)
        whole = np.sort(np.clip(whole, 0.0, np.inf if self._replayed else self.duration), 1)
        whole = np.unique(whole)[None] if rows == 1 else whole
        if not self._replayed:
            return whole
        return np.concatenate([whole, np.full((rows, 1), self.duration)], 1)

    def phase(self, times: Array, states: Array) -> tuple[Array, Array]:
        """The phase, at which paths and tape are, and its rate, at times (…) and states (…, n)."""
        if not self._replayed:
            return times, np.ones_like(times)
        clock = np.moveaxis(states[..., self._replayed[:CLOCK]], -1, 0)
        phase, rate, _ = clock_at(list(clock), times)
        return phase, rate

    def now(self, phases: Array) -> Array:
        """Parameters that change, at phases (N or 1, K) and a little after, (N or 1, K, …)."""
        parts = [np.empty((*phases.shape, 0))]
        for one in self.changing:
            since, coefficients = one.at(phases)
            parts += [since[..., None], coefficients]
        rows = max(len(part) for part in parts)
        return np.concatenate([np.broadcast_to(p, (rows, *p.shape[1:])) for p in parts], 2)

    def parameters(self, times: Array, states: Array) -> Array:
        """Those that hold at times (N, K) and states (N, K, n) and a little after: (N, K,
        parameters)."""
        still = np.broadcast_to(self.still[:, None], (*times.shape, self.still.shape[1]))
        return np.concatenate([self.now(self.phase(times, states)[0]), still], 2)

    def solve(
        self, first: Array, samples: Array, tolerance: float, most_steps: int = MOST_STEPS,
    ) -> Solution:  # fmt: skip
        """From rows of `System.start`, with states at `samples` (K,) or (N, K)."""
        pieces = Pieces(self.knots[:, 1:], self.now(self.knots[:, :-1]))
        return self._system.integrator.solve(
            first, self.still, samples, tolerance, pieces=pieces, most_steps=most_steps,
            every=self._system.layout.every,
        )  # fmt: skip
