"""Systems outside, each advanced by a compiled function of its own, under one compiled controller.

Eight systems stand in the lanes at a time. Each control period their numbers are gathered from
where they keep them, the controller computes for all eight at once, its results are put where the
systems look for them, and each system is advanced so many times. All of it is one call of machine
code, which holds no lock of the interpreter. What a lane gets never depends on its neighbours.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np
from llvmlite import ir

from somersault._core.array import Array
from somersault.engine._expression import expression
from somersault.engine._flow import (
    DOUBLE,
    INTEGER,
    NOTHING,
    POINTER,
    Code,
    Flow,
    copier,
    double,
    integer,
)
from somersault.engine._machine import compiled, compiled_function
from somersault.engine._threads import heeded_stop, together
from somersault.engine._vectors import LANES, module

_ADVANCE = ir.FunctionType(NOTHING, [POINTER, POINTER])


class _Job(ctypes.Structure):
    """Eight systems. `places` has the addresses of lane 0's parts, lane 1's and so on, first of
    what is read and then of what is written; `systems` the two arguments of `advance`.

    `records` are where what was read and written goes every `every` periods; `running` is 1 for a
    lane that goes on, and `done` counts its periods. `stop` points to 0 until all is to stop.
    """

    _fields_ = (
        ("stop", ctypes.c_void_p),
        ("advance", ctypes.c_void_p),
        ("systems", ctypes.c_void_p),
        ("places", ctypes.c_void_p),
        ("records", ctypes.c_void_p),
        ("running", ctypes.c_void_p),
        ("done", ctypes.c_void_p),
        ("periods", ctypes.c_int64),
        ("times", ctypes.c_int64),
        ("every", ctypes.c_int64),
    )


@dataclass
class System:
    """A system that is advanced by a function in C of two pointers.

    Parameters
    ----------
    first, second : int
        The addresses that the function takes.
    reads, writes : sequence of array
        Where the controller's arguments stand, and where its results go: arrays of doubles, side by
        side, as many as the controller has. One may stand in both.
    """

    first: int
    second: int
    reads: Sequence[Array]
    writes: Sequence[Array]


class ClosedLoop:
    """A controller and how it is joined to the systems that it controls.

    Parameters
    ----------
    controller : casadi.Function
        Of dense vectors, to one: whether the system is done (0 or 1), and then what is written.
    writes : sequence of int
        How many numbers each part that is written has.
    """

    def __init__(self, controller: ca.Function, writes: Sequence[int]) -> None:
        self.reads = tuple(controller.nnz_in(k) for k in range(controller.n_in()))
        self.writes = tuple(writes)
        if controller.nnz_out(0) != 1 + sum(self.writes):
            raise ValueError(
                "a controller returns whether it is done, and then all that is written"
            )
        self._controller = controller

    @property
    def recorded(self) -> int:
        """How many numbers are recorded at a time: what is read and then what is written."""
        return sum(self.reads) + sum(self.writes)

    @cached_property
    def _run(self) -> Any:
        text = module([expression(self._controller, "controller")])
        return compiled_function(
            compiled(text, _loop(self.reads, self.writes)), "loop", ctypes.c_void_p
        )

    def compile(self) -> None:
        """Compile it now, rather than at the first run."""
        _ = self._run

    def run(
        self,
        advance: int,
        systems: Sequence[System],
        periods: int,
        times: int,
        every: int = 0,
    ) -> tuple[Array, list[Array]]:
        """Advance systems until each is done or the periods are over, on all threads.

        Parameters
        ----------
        advance : int
            The address of `void advance(void *, void *)`.
        systems : sequence of System
        periods : int
            The most there are.
        times : int
            How often a system is advanced in a period.
        every : int
            What is read and written is recorded once in so many periods; 0 for never.

        Returns
        -------
        done : array of int
            How many periods each system ran.
        records : list of array
            Of each system, (R, `recorded`).

        Raises
        ------
        ValueError
            For parts that are not as the controller has them.
        """
        for system in systems:
            _check(system.reads, self.reads)
            _check(system.writes, self.writes)
        rows = -(-periods // every) if every else 0
        records = [np.empty((rows, self.recorded)) for _ in systems]
        done = np.zeros(-(-len(systems) // LANES) * LANES, np.int64)
        stop, jobs, held = heeded_stop(), [], []
        for first in range(0, len(systems), LANES):
            block = slice(first, min(first + LANES, len(systems)))
            arrays = _arrays(systems[block], records[block])
            held.append(arrays)  # as long as the jobs have their addresses
            addresses = [a.ctypes.data for a in (*arrays, done[first:])]
            jobs.append((ctypes.byref(_Job(
                stop.address, advance, *addresses, periods, times, every or periods + 1
            )),))  # fmt: skip
        together(self._run, jobs, stop)
        done = done[: len(systems)]
        if every:
            records = [r[: -(-int(n) // every)] for r, n in zip(records, done, strict=True)]
        return done, records


def _arrays(systems: Sequence[System], records: Sequence[Array]) -> tuple[Array, ...]:
    """Of a block: the systems, the places of their parts, their records, and which lanes run. Lanes
    that are left have the last system, and stand still."""
    last = len(systems) - 1
    lanes = [systems[min(k, last)] for k in range(LANES)]
    running = (np.arange(LANES) <= last).astype(np.int64)
    return (
        np.array([[s.first, s.second] for s in lanes], np.int64),
        np.array([[a.ctypes.data for a in (*s.reads, *s.writes)] for s in lanes], np.int64),
        np.array([records[min(k, last)].ctypes.data for k in range(LANES)], np.int64),
        running,
    )


def _check(arrays: Sequence[Array], widths: Sequence[int]) -> None:
    if tuple(a.size for a in arrays) != tuple(widths):
        raise ValueError(f"parts of {tuple(a.size for a in arrays)} numbers are not of {widths}")
    if any(a.dtype != np.float64 or not a.flags.c_contiguous for a in arrays):
        raise ValueError("parts of a system are doubles that stand side by side")


def _loop(reads: Sequence[int], writes: Sequence[int]) -> str:
    """LLVM text of `void loop(Job *)`, which calls @controller."""
    code = Code()
    controller = code.declared("controller", [POINTER, POINTER])
    copy = copier(code)
    flow, (job,) = code.written("loop", [POINTER])
    inputs, outputs = sum(reads), 1 + sum(writes)
    x, y = (flow.room(DOUBLE, integer(n * LANES)) for n in (inputs, outputs))
    places, records, running, done, systems = (
        flow.field(_Job, job, name) for name in ("places", "records", "running", "done", "systems")
    )
    advance = flow.field(_Job, job, "advance", _ADVANCE.as_pointer())
    every, times = flow.field(_Job, job, "every"), flow.field(_Job, job, "times")
    now, record, left = (flow.room(INTEGER) for _ in range(3))
    flow.store(integer(0), now)
    flow.store(integer(0), record)
    parts = len(reads) + len(writes)
    lane_step, side = integer(LANES), integer(1)

    def part(lane: Any, k: int) -> Any:
        at = flow.place(places, flow.mul(lane, integer(parts)), integer(k))
        return flow.read(at, POINTER)

    with flow.repeated() as over:
        period = flow.read(now, INTEGER)
        flow.leave_if(flow.icmp_signed(">=", period, flow.field(_Job, job, "periods")), over)
        stopped = flow.read(flow.field(_Job, job, "stop"), INTEGER)
        flow.leave_if(flow.icmp_signed("!=", stopped, integer(0)), over)
        flow.store(flow.add(period, integer(1)), now)
        with flow.counted(integer(0), integer(LANES)) as lane:
            first = 0
            for k, width in enumerate(reads):
                to = flow.place(x, integer(first * LANES), lane)
                flow.call(copy, [to, lane_step, part(lane, k), side, integer(width)])
                first += width
        flow.call(controller, [x, y])
        shown = flow.and_(
            flow.icmp_signed("==", flow.srem(period, every), integer(0)),
            flow.icmp_signed("<=", every, flow.field(_Job, job, "periods")),
        )
        flow.store(integer(0), left)
        with flow.counted(integer(0), integer(LANES)) as lane:
            runs = flow.read(flow.place(running, lane), INTEGER)
            with flow.if_then(flow.icmp_signed("!=", runs, integer(0))):
                with flow.if_then(shown):
                    row = flow.mul(flow.read(record, INTEGER), integer(inputs + outputs - 1))
                    to = flow.place(flow.read(flow.place(records, lane), POINTER), row)
                    flow.call(copy, [to, side, flow.place(x, lane), lane_step, integer(inputs)])
                    after, source = flow.place(to, integer(inputs)), flow.place(y, lane_step, lane)
                    flow.call(copy, [after, side, source, lane_step, integer(outputs - 1)])
                first = 1
                for k, width in enumerate(writes, len(reads)):
                    source = flow.place(y, integer(first * LANES), lane)
                    flow.call(copy, [part(lane, k), side, source, lane_step, integer(width)])
                    first += width
                counter = flow.place(done, lane)
                flow.store(flow.add(flow.read(counter, INTEGER), integer(1)), counter)
                is_done = flow.fcmp_unordered("!=", flow.read(flow.place(y, lane)), double(0.0))
                with flow.if_else(is_done) as (then, otherwise):
                    with then:
                        flow.store(integer(0), flow.place(running, lane))
                    with otherwise:
                        flow.store(integer(1), left)
                        _advance(flow, advance, systems, lane, times)
        flow.leave_if(flow.icmp_signed("==", flow.read(left, INTEGER), integer(0)), over)
        with flow.if_then(shown):
            flow.store(flow.add(flow.read(record, INTEGER), integer(1)), record)
    flow.ret_void()
    return str(code)


def _advance(flow: Flow, advance: Any, systems: Any, lane: Any, times: Any) -> None:
    pair = flow.place(systems, flow.mul(lane, integer(2)))
    first, second = (flow.read(flow.place(pair, integer(k)), POINTER) for k in range(2))
    with flow.counted(integer(0), times):
        flow.call(advance, [first, second])
