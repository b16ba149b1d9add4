"""Many solutions of ẏ = f(y, t, p), adaptive, compiled, each with its own step and fate."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np

from somersault._array import Array
from somersault.dynamics import _integrator_llvm as _l
from somersault.dynamics._kernel import aligned, compiled, packed, pool, threads, unpacked
from somersault.dynamics._llvm import LANES, llvm_function

STATUS = {
    _l.FLYING: "duration",
    _l.EVENT: "event",
    _l.TOO_MANY_STEPS: "too many steps",
    _l.BROKEN: "not finite",
}
MOST_STEPS = 1_000_000
FIRST_STEP = 1e-3  # s; what it is costs a step or two
_BLOCKS_A_TASK = 4  # at least
_TASKS_A_THREAD = 16  # at most: lanes differ in how long they take
_STEPS_AT_A_TIME = 48
_WORTH_CLOSING_UP = 0.7  # of the lanes: while more of them fly they stay where they are
_NO_LIMIT = 2**62
_MOST_TRIALS = 60  # of the search for an event


@dataclass(frozen=True)
class Solution:
    """What became of N starts at K sample times.

    `states` (N, K, n): at the samples; after a lane has ended, its last state. `end` (N,) is
    when it ended, `final` (N, n) its state then, `status` (N,) a code of `STATUS`, `steps`
    (N,) how many it took, `step` (N,) the length it would go on with. `watched` (N, K, w) and
    `watched_final` (N, w) are what was watched until then.
    """

    states: Array
    end: Array
    final: Array
    status: Array
    steps: Array
    step: Array
    watched: Array
    watched_final: Array


class Integrator:
    """DOP853 for one right-hand side, compiled when it is first used.

    `slope` is a CasADi function of one vector (state, time, parameters) that gives the
    state's rate; `gauge`, of the same vector, a number whose change of sign ends a flight.
    `watch` gives the watched numbers after a step from `Rows.look`, and `longest`, of the first
    vector, bounds each step while something is watched.
    """

    def __init__(
        self,
        slope: ca.Function,
        gauge: ca.Function | None = None,
        watch: ca.Function | None = None,
        longest: ca.Function | None = None,
    ) -> None:
        self.state: int = slope.nnz_out(0)
        self.inputs: int = slope.nnz_in(0)
        self._slope, self._gauge, self._watch, self._longest = slope, gauge, watch, longest
        watched = 0 if watch is None else watch.nnz_out(0)
        self._rows = _l.Rows(self.state, self.inputs - self.state - 1, watched)

    @cached_property
    def _engine(self):  # must outlive the functions taken from it
        functions = {
            "rhs": self._slope,
            "gauge": self._gauge,
            "watch": self._watch,
            "longest": self._longest,
        }
        text = "".join(llvm_function(f, name) for name, f in functions.items() if f is not None)
        return compiled(_l.integrator_module(text, self._rows, self._gauge is not None))

    @cached_property
    def _fly(self):
        p, i = ctypes.c_void_p, ctypes.c_int64
        address = self._engine.get_function_address("fly")
        return ctypes.CFUNCTYPE(None, p, p, p, p, i, i, i)(address)

    @cached_property
    def _step(self):
        p, i = ctypes.c_void_p, ctypes.c_int64
        return ctypes.CFUNCTYPE(None, p, p, p, i)(self._engine.get_function_address("step"))

    def solve(
        self,
        start: Array,
        parameters: Array,
        samples: Array,
        tolerance: float,
        end: Array | None = None,
        *,
        begin: Array | None = None,
        step: Array | None = None,
        watched: Array | None = None,
        most_steps: float | Array = MOST_STEPS,
    ) -> Solution:
        """From `start` (N, n) with `parameters` (N, m), at increasing `samples` (K,).

        Lanes begin at times `begin` (N,), 0 by default, with first steps `step` (N,). `tolerance`
        bounds each step's error in every state, relative to 1 + |state|; `end` (N,) ends lanes
        before the last sample. An event is found to rounding. `watched` (N, w) is what was
        watched before. A lane that has taken `most_steps` (all the
        same, or (N,)) ends.
        """
        count, before = len(start), self._rows.before_watched
        times = np.zeros((count, 1)) if begin is None else np.asarray(begin)[:, None]
        seen = np.zeros((count, 0)) if watched is None else watched
        x = packed(np.concatenate([start, times, parameters, seen], 1))
        control = aligned((len(x), _l.CONTROL_ROWS, LANES))
        control[...] = 0.0
        control[:, _l.TIME] = x[:, self.state]
        control[:, _l.STEP] = FIRST_STEP if step is None else packed(step[:, None])[:, 0]
        control[:, _l.END] = np.inf if end is None else packed(np.asarray(end)[:, None])[:, 0]
        control[:, _l.TOLERANCE] = tolerance
        control[:, _l.LIMIT] = packed(np.broadcast_to(most_steps, count)[:, None])[:, 0]
        samples = np.ascontiguousarray(samples, float)
        if len(samples) == 1:
            whole, flat = self._to_the_end(x, control, samples, count)
            out = np.concatenate([whole[:, : self.state], whole[:, before:]], 1)[:, None]
        else:
            out = self._run(x, control, samples, _NO_LIMIT)
            out = np.moveaxis(out, -1, 1).reshape(-1, len(samples), self._rows.outputs)[:count]
            flat = unpacked(control, count)
        final, stopped = out[:, -1].copy(), flat[:, _l.TIME].copy()
        held = np.flatnonzero(flat[:, _l.STATUS] == _l.EVENT)
        if held.size:
            final[held], stopped[held] = self._events(
                final[held], stopped[held], parameters[held], flat[held, _l.STEP]
            )
        n = self.state
        return Solution(
            out[..., :n], stopped, final[:, :n], flat[:, _l.STATUS],
            flat[:, _l.STEPS].astype(int), flat[:, _l.STEP], out[..., n:], final[:, n:],
        )  # fmt: skip

    def _to_the_end(
        self, x: Array, control: Array, samples: Array, count: int
    ) -> tuple[Array, Array]:
        """Inputs (count, rows) and controls (count, rows) at the end, a few steps at a time.

        Lanes that have arrived leave, and the others close up, so that few wait for a slow
        neighbour. What a lane computes does not depend on it.
        """
        whole = np.empty((count, self._rows.inputs))
        flat = np.empty((count, _l.CONTROL_ROWS))
        left = np.arange(count)
        while True:
            self._run(x, control, samples, _STEPS_AT_A_TIME)
            ends = np.minimum(control[:, _l.END], samples[0])
            on = (control[:, _l.STATUS] == _l.FLYING) & (control[:, _l.TIME] < ends)
            on = on.ravel()[: left.size]
            if on.sum() > _WORTH_CLOSING_UP * left.size:
                continue
            rows, controls = unpacked(x, left.size), unpacked(control, left.size)
            whole[left[~on]], flat[left[~on]] = rows[~on], controls[~on]
            left = left[on]
            if not left.size:
                return whole, flat
            x, control = packed(rows[on]), packed(controls[on])

    def _run(self, x: Array, control: Array, samples: Array, most: int) -> Array:
        out = aligned((len(x), len(samples), self._rows.outputs, LANES))

        def part(a: int, b: int) -> None:
            self._fly(
                x[a:b].ctypes.data, control[a:b].ctypes.data, samples.ctypes.data,
                out[a:b].ctypes.data, len(samples), b - a, most,
            )  # fmt: skip

        _in_parts(part, len(x))
        return out

    def _events(
        self, outputs: Array, times: Array, parameters: Array, steps: Array
    ) -> tuple[Array, Array]:
        """Outputs and times at which the gauge is zero, within one step of each state.

        By the Illinois form of regula falsi on the length of a single whole step, which has
        the full order of the method, so that nothing is interpolated.
        """
        count, n = len(outputs), self.state
        rows = np.concatenate([outputs[:, :n], times[:, None], parameters, outputs[:, n:]], 1)
        whole = _Single(self, rows, n)
        low, high = np.zeros(count), steps.copy()
        g_low, g_high = whole.gauge_after(low), whole.gauge_after(high)
        left, some = np.arange(count), whole
        for _ in range(_MOST_TRIALS):
            a, b, ga, gb = low[left], high[left], g_low[left], g_high[left]
            with np.errstate(invalid="ignore", divide="ignore"):
                middle = b - gb * (b - a) / (gb - ga)
            middle = np.where(np.isfinite(middle), middle, (a + b) / 2)
            g = some.gauge_after(middle)
            same = g * gb > 0
            g_low[left] = np.where(same, ga / 2, gb)
            low[left] = np.where(same, a, b)
            high[left], g_high[left] = middle, g
            # A lane that has converged goes, so that it neither waits nor changes any more.
            on = (np.abs(middle - low[left]) > 1e-15 * (1 + times[left])) & (g != 0)
            if not on.any():
                break
            if not on.all():
                left = left[on]
                some = _Single(self, rows[left], n)
        whole.gauge_after(high)
        return whole.outputs, times + high


class _Single:
    """Whole single steps of any length from some states."""

    def __init__(self, integrator: Integrator, rows: Array, state: int) -> None:
        self._step, self._count = integrator._step, len(rows)
        self._x = packed(rows)
        self._control = aligned((len(self._x), _l.CONTROL_ROWS, LANES))
        self._control[...] = 0.0
        self._control[:, _l.TIME] = self._x[:, state]
        self._y = aligned((len(self._x), integrator._rows.outputs, LANES))

    def gauge_after(self, length: Array) -> Array:
        """The gauge (N,) after steps so long (N,)."""
        self._control[:, _l.STEP] = packed(length[:, None])[:, 0]
        x, control, y = self._x, self._control, self._y

        def part(a: int, b: int) -> None:
            self._step(x[a:b].ctypes.data, control[a:b].ctypes.data, y[a:b].ctypes.data, b - a)

        _in_parts(part, len(x))
        return control[:, _l.GAUGE].flatten()[: self._count]

    @property
    def outputs(self) -> Array:
        """States and watched rows after the last steps, (N, …)."""
        return unpacked(self._y, self._count)


def _in_parts(part: Callable[[int, int], None], blocks: int) -> None:
    """Call part(a, b) for all blocks, shared out among the threads."""
    task = max(_BLOCKS_A_TASK, -(-blocks // (threads() * _TASKS_A_THREAD)))
    edges = [*range(0, blocks, task), blocks]
    if len(edges) <= 2 or threads() == 1:
        part(0, blocks)
    else:
        list(pool().map(part, edges[:-1], edges[1:]))
