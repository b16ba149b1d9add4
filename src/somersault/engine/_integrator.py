"""Many solutions of ẏ = f(y, t, p), adaptive, compiled, each with its own step and fate."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault.engine import _lanes
from somersault.engine._expression import Direction, expression
from somersault.engine._machine import compiled, compiled_function
from somersault.engine._step import (
    BROKEN,
    EVENT,
    FLYING,
    TOO_MANY_STEPS,
    Rows,
    carry,
    renew,
    step,
)
from somersault.engine._threads import heeded_stop, threads, together
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

    Attributes
    ----------
    states : array (N, K, n)
        At the samples; after a flight has ended, its last state.
    end : array (N,)
        When each ended.
    final : array (N, n)
        Its state then.
    status : array (N,)
        A code of `STATUS`.
    steps : array (N,)
        How many it took.
    watched : array (N, K, w)
        What was watched until each sample.
    watched_final : array (N, w)
        The same until the end.
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
    (N or 1, P), s, which do not fall; a flight is over with its last piece. Where flights have a
    clock the ends of all but the last are what it shows."""

    ends: Array
    parameters: Array


class Integrator:
    """DOP853 for one right-hand side, compiled when it is first used.

    Parameters
    ----------
    slope
        A CasADi function of one vector (state, time, parameters) that gives the state's rate.
    gauge
        Of the same vector, a number whose change of sign ends a flight.
    watch
        The watched numbers after a step, from the numbers of `Rows.look`.
    longest
        Of the vector of `slope`, a bound on each step while something is watched.
    changing
        How many parameters, the first ones, are those of `Pieces`.
    tick
        Of the vector of `slope`, what the last numbers of the state become at each tick; they have
        no slope, and stay as they are from tick to tick.
    clock
        Where in the state the numbers of the clock begin (`CLOCK`), which are carried, if pieces
        end by one.
    along
        Where the numbers of `slope`'s vector, which is then that of `gauge`, `longest` and `tick`
        too, stand among state, time and parameters, and where their derivatives. What moves is
        then the state and its derivative, and so is what is carried.

    Examples
    --------
    >>> import casadi as ca
    >>> import numpy as np
    >>> x = ca.SX.sym("x", 3)  # y, the time, and a rate
    >>> decay = Integrator(ca.Function("slope", [x], [-x[2] * x[0]]))
    >>> decay.solve(np.ones((1, 1)), np.array([[2.0]]), np.array([0.0, 0.5]), 1e-12).states.round(6)
    array([[[1.      ],
            [0.367879]]])
    """

    def __init__(
        self,
        slope: ca.Function,
        gauge: ca.Function | None = None,
        watch: ca.Function | None = None,
        longest: ca.Function | None = None,
        changing: int = 0,
        tick: ca.Function | None = None,
        clock: int | None = None,
        along: Direction | None = None,
    ) -> None:
        times = 1 if along is None else 2
        carried = 0 if tick is None else times * tick.nnz_out(0)
        self.state: int = times * slope.nnz_out(0) + carried
        self.inputs: int = times * (slope.nnz_in(0) - 1) + 1
        self.changing = changing
        self._slope, self._gauge, self._watch, self._longest = slope, gauge, watch, longest
        self._tick, self._clock, self._along = tick, clock, along
        watched = 0 if watch is None else watch.nnz_out(0)
        self._rows = Rows(self.state, self.inputs - self.state - 1, watched, carried)
        self.outputs: int = self._rows.outputs

    @cached_property
    def _fly(self) -> Callable[..., None]:
        values, slopes = self._along or (None, None)
        functions = (
            ("rhs", self._slope, values, slopes),
            ("gauge", self._gauge, values, None),
            ("watch", self._watch, None, None),
            ("longest", self._longest, values, None),
            ("tick", self._tick, values, slopes),
        )
        texts = [expression(f, name, at, by) for name, f, at, by in functions if f is not None]
        event = self._gauge is not None
        texts += [step(self._rows, event), renew(self._rows, event)]
        texts += [carry(self._rows)] if self._rows.carried else []
        engine = compiled(_lanes.fly(self._rows, self.changing, self._clock), module(texts))
        return compiled_function(engine, "fly", ctypes.c_void_p)

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
        every: float | None = None,
    ) -> Solution:
        """Integrate many starts from time 0.

        Parameters
        ----------
        start : array (N, n + w)
            States, and what was watched before.
        parameters : array (N or 1, m)
            Those that stay as they are.
        samples : array (K,) or (N, K)
            Times, s, that do not fall.
        tolerance
            A bound on each step's error in every state, relative to 1 + |state|.
        end : array (N,), optional
            Ends of flights before the last sample, s.
        pieces
            The parameters that change, and when.
        first_step
            The first step that is tried, s.
        most_steps
            A flight that has taken so many ends.
        every
            Between ticks, the first of which is at 0, s.

        Returns
        -------
        Solution
            At a sample that is at a tick, what was before it. Where the gauge changes sign, an
            event is found to rounding.

        Raises
        ------
        ValueError
            For parameters or states that are not those of these equations.
        """
        count, outputs = len(start), self.outputs
        samples = np.ascontiguousarray(np.atleast_2d(samples), float)
        if pieces is None:
            until = samples[:, -1] if end is None else end
            pieces = Pieces(np.reshape(until, (-1, 1)), np.empty((1, 1, 0)))
        ends = np.minimum(pieces.ends, samples[:, -1:], dtype=float)
        if self._clock is not None:
            ends[:, :-1] = pieces.ends[:, :-1]
        table = np.ascontiguousarray(pieces.parameters, float)
        still = np.ascontiguousarray(parameters, float)
        first = np.ascontiguousarray(start, float)
        lasting = self._rows.parameters - self.changing
        if (table.shape[2], still.shape[1], first.shape[1]) != (self.changing, lasting, outputs):
            raise ValueError("not the parameters, or not the states, of these equations")
        if self._rows.carried and not (every and 0 < every < np.inf):
            raise ValueError("what is carried needs ticks")
        out = np.empty((count, samples.shape[1], outputs))
        last = np.empty((count, outputs + _lanes.LAST_MORE))
        following = np.zeros(1, np.int64)
        job = _lanes.Job(
            first=first.ctypes.data, out=out.ctypes.data, last=last.ctypes.data,
            next=following.ctypes.data, count=count, sample_count=samples.shape[1],
            pieces=ends.shape[1], tolerance=tolerance, most_steps=most_steps,
            first_step=first_step, tick=every or np.inf,
        )  # fmt: skip
        job.arrays = first, still, table, ends, samples, out, last, following
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
        stop = heeded_stop()
        job.stop = stop.address
        helpers = max(1, min(threads(), -(-count // LANES)))
        together(self._fly, [(ctypes.byref(job),)] * helpers, stop)
