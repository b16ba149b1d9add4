"""Many solutions of ẏ = f(y, t, p), adaptive, compiled, each with its own step and fate."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault.engine import _lanes
from somersault.engine._expression import expression
from somersault.engine._machine import compiled
from somersault.engine._step import (
    BROKEN,
    EVENT,
    FLYING,
    TOO_MANY_STEPS,
    Rows,
    renew,
    step,
)  # fmt: skip
from somersault.engine._threads import pool, threads
from somersault.engine._vectors import LANES, module

STATUS = {
    FLYING: "duration",
    EVENT: "event",
    TOO_MANY_STEPS: "too many steps",
    BROKEN: "not finite",
}
MOST_STEPS = 1_000_000
_FIRST_STEP = 1e-3  # s; what it is costs a step or two


@dataclass(frozen=True)
class Solution:
    """What became of N starts at K sample times.

    `states` (N, K, n): at the samples; after a lane has ended, its last state. `end` (N,) is
    when it ended, `final` (N, n) its state then, `status` (N,) a code of `STATUS`, `steps`
    (N,) how many it took. `watched` (N, K, w) and `watched_final` (N, w) are what was watched
    until then.
    """

    states: Array
    end: Array
    final: Array
    status: Array
    steps: Array
    watched: Array
    watched_final: Array


@dataclass(frozen=True)
class Pieces:
    """Parameters that change on the way: row p of `parameters` (N or 1, P, c) until `ends`
    (N or 1, P), s, which do not fall; a flight is over with its last piece."""

    ends: Array
    parameters: Array


class Integrator:
    """DOP853 for one right-hand side, compiled when it is first used.

    `slope` is a CasADi function of one vector (state, time, parameters) that gives the
    state's rate; `gauge`, of the same vector, a number whose change of sign ends a flight.
    `watch` gives the watched numbers after a step from `Rows.look`, and `longest`, of the first
    vector, bounds each step while something is watched. The first `changing` parameters are those
    of `Pieces`.
    """

    def __init__(
        self,
        slope: ca.Function,
        gauge: ca.Function | None = None,
        watch: ca.Function | None = None,
        longest: ca.Function | None = None,
        changing: int = 0,
    ) -> None:
        self.state: int = slope.nnz_out(0)
        self.inputs: int = slope.nnz_in(0)
        self.changing = changing
        self._slope, self._gauge, self._watch, self._longest = slope, gauge, watch, longest
        watched = 0 if watch is None else watch.nnz_out(0)
        self._rows = Rows(self.state, self.inputs - self.state - 1, watched)
        self.outputs: int = self._rows.outputs

    @cached_property
    def _engine(self):  # must outlive the function taken from it
        functions = {
            "rhs": self._slope,
            "gauge": self._gauge,
            "watch": self._watch,
            "longest": self._longest,
        }
        texts = [expression(f, name) for name, f in functions.items() if f is not None]
        event = self._gauge is not None
        texts += [step(self._rows, event), renew(self._rows, event)]
        return compiled(_lanes.fly(self._rows, self.changing), module(texts))

    @cached_property
    def _fly(self):
        address = self._engine.get_function_address("fly")
        return ctypes.CFUNCTYPE(None, ctypes.c_void_p)(address)

    def solve(
        self,
        start: Array,
        parameters: Array,
        samples: Array,
        tolerance: float,
        end: Array | None = None,
        *,
        pieces: Pieces | None = None,
        first_step: float = _FIRST_STEP,
        most_steps: int = MOST_STEPS,
    ) -> Solution:
        """From `start` (N, n + w), states and what was watched before, at time 0 with `parameters`
        (N or 1, m), at `samples` (K,) or (N, K), which do not fall.

        `tolerance` bounds each step's error in every state, relative to 1 + |state|; `end` (N,)
        ends flights before the last sample. Of parameters that change, `pieces` has the numbers
        and the ends, and `parameters` the others. An event is found to rounding. A flight that has
        taken `most_steps` ends.
        """
        count, outputs = len(start), self.outputs
        samples = np.ascontiguousarray(np.atleast_2d(samples), float)
        if pieces is None:
            until = samples[:, -1] if end is None else end
            pieces = Pieces(np.reshape(until, (-1, 1)), np.empty((1, 1, 0)))
        ends = np.ascontiguousarray(np.minimum(pieces.ends, samples[:, -1:]))
        table = np.ascontiguousarray(pieces.parameters, float)
        still = np.ascontiguousarray(parameters, float)
        first = np.ascontiguousarray(start, float)
        lasting = self._rows.parameters - self.changing
        if (table.shape[2], still.shape[1], first.shape[1]) != (self.changing, lasting, outputs):
            raise ValueError("not the parameters, or not the states, of these equations")
        out = np.empty((count, samples.shape[1], outputs))
        last = np.empty((count, outputs + _lanes.LAST_MORE))
        following = np.zeros(1, np.int64)
        job = _lanes.Job(
            first=first.ctypes.data, out=out.ctypes.data, last=last.ctypes.data,
            next=following.ctypes.data, count=count, sample_count=samples.shape[1],
            pieces=ends.shape[1], tolerance=tolerance, most_steps=most_steps,
            first_step=first_step,
        )  # fmt: skip
        for name, array in (
            ("still", still), ("table", table), ("ends", ends), ("samples", samples),
        ):  # fmt: skip
            setattr(job, name, array.ctypes.data)
            setattr(job, f"{name}_by", array[0].size if len(array) > 1 else 0)
        self._run(job, count)
        n = self.state
        return Solution(
            out[..., :n], last[:, outputs], last[:, :n], last[:, outputs + 1],
            last[:, outputs + 2].astype(int), out[..., n:], last[:, n:outputs],
        )  # fmt: skip

    def _run(self, job: _lanes.Job, count: int) -> None:
        """Fly a job on as many threads as there is work for."""
        helpers = min(threads(), -(-count // LANES))
        if helpers <= 1:
            self._fly(ctypes.byref(job))
        else:
            list(pool().map(self._fly, [ctypes.byref(job)] * helpers))
