"""Many solutions of ẏ = f(y, t, p), adaptive, compiled, each with its own step and fate."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

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
_MOST_STEPS = 1_000_000
_FIRST_STEP = 1e-3  # s; what it is costs a step or two
_BLOCKS_A_TASK = 4
_STEPS_AT_A_TIME = 48
_NO_LIMIT = 2**62


@dataclass(frozen=True)
class Solution:
    """What became of N starts at K sample times.

    `states` (N, K, n): at the samples; after a lane has ended, its last state. `end` (N,) is
    when it ended, `final` (N, n) its state then, `status` (N,) a code of `STATUS`, `steps`
    (N,) how many it took.
    """

    states: Array
    end: Array
    final: Array
    status: Array
    steps: Array


class Integrator:
    """DOP853 for one right-hand side, compiled when it is first used.

    `slope` is a CasADi function of one vector (state, time, parameters) that gives the
    state's rate; `gauge`, of the same vector, a number whose change of sign ends a flight.
    """

    def __init__(self, slope: ca.Function, gauge: ca.Function | None = None) -> None:
        self.state: int = slope.nnz_out(0)
        self.inputs: int = slope.nnz_in(0)
        self._slope, self._gauge = slope, gauge

    @cached_property
    def _engine(self):  # must outlive the functions taken from it
        text = llvm_function(self._slope, "rhs")
        if self._gauge is not None:
            text += llvm_function(self._gauge, "gauge")
        return compiled(
            _l.integrator_module(text, self.state, self.inputs, self._gauge is not None)
        )

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
    ) -> Solution:
        """From `start` (N, n) at time 0 with `parameters` (N, m), at increasing `samples` (K,).

        `tolerance` bounds each step's error in every state, relative to 1 + |state|; `end`
        (N,) ends lanes before the last sample. An event is found to rounding.
        """
        count = len(start)
        x = packed(np.concatenate([start, np.zeros((count, 1)), parameters], 1))
        control = aligned((len(x), _l.CONTROL_ROWS, LANES))
        control[...] = 0.0
        control[:, _l.STEP] = _FIRST_STEP
        control[:, _l.END] = np.inf if end is None else packed(np.asarray(end)[:, None])[:, 0]
        control[:, _l.TOLERANCE] = tolerance
        control[:, _l.LIMIT] = _MOST_STEPS
        if self._gauge is not None:
            control[:, _l.GAUGE] = self._gauges(x)
        samples = np.ascontiguousarray(samples, float)
        if len(samples) == 1:
            whole, flat = self._to_the_end(x, control, samples, count)
            states = whole[:, None, : self.state]
        else:
            out = self._run(x, control, samples, _NO_LIMIT)
            states = np.moveaxis(out, -1, 1).reshape(-1, len(samples), self.state)[:count]
            flat = unpacked(control, count)
        final, times = states[:, -1].copy(), flat[:, _l.TIME].copy()
        held = np.flatnonzero(flat[:, _l.STATUS] == _l.EVENT)
        if held.size:
            final[held], times[held] = self._events(
                final[held], times[held], parameters[held], flat[held, _l.STEP]
            )
        return Solution(states, times, final, flat[:, _l.STATUS], flat[:, _l.STEPS].astype(int))

    def _to_the_end(
        self, x: Array, control: Array, samples: Array, count: int
    ) -> tuple[Array, Array]:
        """States (count, inputs) and controls (count, rows) at the end, a few steps at a time.

        Lanes that have arrived leave, and the others close up, so that none waits for a slow
        neighbour. What a lane computes does not depend on it.
        """
        whole, flat = unpacked(x, count).copy(), unpacked(control, count).copy()
        left = np.arange(count)
        while left.size:
            self._run(x, control, samples, _STEPS_AT_A_TIME)
            whole[left] = unpacked(x, left.size)
            flat[left] = unpacked(control, left.size)
            ends = np.minimum(flat[left, _l.END], samples[0])
            on = (flat[left, _l.STATUS] == _l.FLYING) & (flat[left, _l.TIME] < ends)
            left = left[on]
            if left.size:
                x, control = packed(whole[left]), packed(flat[left])
        return whole, flat

    def _run(self, x: Array, control: Array, samples: Array, most: int) -> Array:
        out = aligned((len(x), len(samples), self.state, LANES))

        def part(bounds: tuple[int, int]) -> None:
            a, b = bounds
            self._fly(
                x[a:b].ctypes.data, control[a:b].ctypes.data, samples.ctypes.data,
                out[a:b].ctypes.data, len(samples), b - a, most,
            )  # fmt: skip

        edges = [*range(0, len(x), _BLOCKS_A_TASK), len(x)]
        if len(edges) <= 2 or threads() == 1:
            part((0, len(x)))
        else:
            list(pool().map(part, pairwise(edges)))
        return out

    def _gauges(self, x: Array) -> Array:
        assert self._gauge is not None
        flat = np.moveaxis(x, -1, 1).reshape(-1, self.inputs)
        return np.array(self._gauge.map(len(flat))(flat.T)).reshape(-1, LANES)

    def _events(
        self, states: Array, times: Array, parameters: Array, steps: Array
    ) -> tuple[Array, Array]:
        """States and times at which the gauge is zero, within one step of each state.

        By the Illinois form of regula falsi on the length of a single whole step, which has
        the full order of the method, so that nothing is interpolated.
        """
        count = len(states)
        x = packed(np.concatenate([states, times[:, None], parameters], 1))
        control = aligned((len(x), _l.CONTROL_ROWS, LANES))
        control[...] = 0.0
        control[:, _l.TIME] = x[:, self.state]
        y = aligned((len(x), self.state, LANES))

        def after(length: Array) -> tuple[Array, Array]:
            control[:, _l.STEP] = packed(length[:, None])[:, 0]
            self._step(x.ctypes.data, control.ctypes.data, y.ctypes.data, len(x))
            trial = x.copy()
            trial[:, : self.state] = y
            trial[:, self.state] += control[:, _l.STEP]
            return self._gauges(trial).ravel()[:count], unpacked(y, count)

        low, high = np.zeros(count), steps.copy()
        g_low, g_high = after(low)[0], after(high)[0]
        middle, found = high.copy(), np.zeros(count, bool)
        for _ in range(60):
            with np.errstate(invalid="ignore", divide="ignore"):
                trial = high - g_high * (high - low) / (g_high - g_low)
            trial = np.where(np.isfinite(trial), trial, (low + high) / 2)
            # A lane that has converged stays, so that it owes nothing to its neighbours.
            middle = np.where(found, middle, trial)
            g, _ = after(middle)
            same = g * g_high > 0
            g_low = np.where(same, g_low / 2, g_high)
            low = np.where(same, low, high)
            high, g_high = middle, g
            found = found | (np.abs(high - low) <= 1e-15 * (1 + times)) | (g == 0)
            if found.all():
                break
        return after(middle)[1], times + middle
