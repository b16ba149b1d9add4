"""Many solutions of ẏ = f(y, t, p), adaptive, compiled, each with its own step and fate."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault.engine import _lanes
from somersault.engine import _step as _l
from somersault.engine._kernel import compiled, pool, threads
from somersault.engine._llvm import LANES, llvm_function

STATUS = {
    _l.FLYING: "duration",
    _l.EVENT: "event",
    _l.TOO_MANY_STEPS: "too many steps",
    _l.BROKEN: "not finite",
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
        self._rows = _l.Rows(self.state, self.inputs - self.state - 1, watched)
        self.outputs: int = self._rows.outputs

    @cached_property
    def _engine(self):  # must outlive the function taken from it
        functions = {
            "rhs": self._slope,
            "gauge": self._gauge,
            "watch": self._watch,
            "longest": self._longest,
        }
        text = "".join(llvm_function(f, name) for name, f in functions.items() if f is not None)
        return compiled(_lanes.module(text, self._rows, self.changing, self._gauge is not None))

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
            last = samples[:, -1] if end is None else end
            pieces = Pieces(np.reshape(last, (-1, 1)), np.empty((1, 1, 0)))
        ends = np.ascontiguousarray(np.minimum(pieces.ends, samples[:, -1:]))
        table = np.ascontiguousarray(pieces.parameters, float)
        still = np.ascontiguousarray(parameters, float)
        first = np.ascontiguousarray(start, float)
        lasting = self._rows.parameters - self.changing
        if (table.shape[2], still.shape[1], first.shape[1]) != (self.changing, lasting, outputs):
            raise ValueError("not the parameters, or not the states, of these equations")
        out = np.empty((count, samples.shape[1], outputs))
        told = np.empty((count, outputs + _lanes.LAST_MORE))
        following = np.zeros(1, np.int64)
        job = np.empty(_lanes.JOB, np.int64)
        for place, array in (
            (_lanes.FIRST, first), (_lanes.STILL, still), (_lanes.TABLE, table),
            (_lanes.ENDS, ends), (_lanes.SAMPLES, samples), (_lanes.OUT, out),
            (_lanes.LAST, told), (_lanes.NEXT, following),
        ):  # fmt: skip
            job[place] = array.ctypes.data
        for place, array in (
            (_lanes.STILL_BY, still), (_lanes.TABLE_BY, table), (_lanes.ENDS_BY, ends),
            (_lanes.SAMPLES_BY, samples),
        ):  # fmt: skip
            job[place] = array[0].size if len(array) > 1 else 0
        job[_lanes.COUNT], job[_lanes.SAMPLE_COUNT] = count, samples.shape[1]
        job[_lanes.PIECES] = ends.shape[1]
        for place, value in (
            (_lanes.TOLERANCE, tolerance), (_lanes.LIMIT, most_steps),
            (_lanes.FIRST_STEP, first_step),
        ):  # fmt: skip
            job.view(float)[place] = value
        self._run(job, count)
        n = self.state
        return Solution(
            out[..., :n], told[:, outputs], told[:, :n], told[:, outputs + 1],
            told[:, outputs + 2].astype(int), out[..., n:], told[:, n:outputs],
        )  # fmt: skip

    def _run(self, job: Array, count: int) -> None:
        """Fly a job on as many threads as there is work for."""
        helpers = min(threads(), -(-count // LANES))
        if helpers <= 1:
            self._fly(job.ctypes.data)
        else:
            list(pool().map(self._fly, [job.ctypes.data] * helpers))
