"""Which flight is in which lane: a lane whose flight is over takes the next one.

Flights stand in rows and are taken from a queue that all threads share, so no lane waits for a
slower neighbour and no thread for another. Which lane flies a flight does not show in it.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

from somersault.engine import _step as one
from somersault.engine._clock import CLOCK, time_of
from somersault.engine._flow import (
    DOUBLE,
    INTEGER,
    LANE_BITS,
    POINTER,
    Code,
    Flow,
    copier,
    double,
    integer,
)
from somersault.engine._step import Rows
from somersault.engine._vectors import LANES

LAST_MORE = 3  # numbers in a row of `Job.last` after the outputs: time, status, steps


class Job(ctypes.Structure):
    """What `fly` is asked for: flights, and where to put what becomes of them.

    `first` (count, outputs) has states and watched rows at time 0. In its piece p the parameters
    of flight i that change are `table` [i table_by + p changing …], until `ends` [i ends_by + p];
    those that stay are `still` [i still_by …]. Where flights have a clock the ends are what it
    shows, but for the last one. `out` (count, sample_count, outputs) receives what
    there is at each of `samples` [i samples_by …], or was at the end of a flight that ended before;
    `last` (count, outputs + 3) what there is at the end, when that was, the status and the steps.
    Every `tick`, from time 0 on, what flights carry is given anew.
    `next` holds the flight that is next; where `stop` is no longer 0 all flights are given up. That
    is all that threads share.
    """

    _fields_ = (
        ("first", ctypes.c_void_p),
        ("still", ctypes.c_void_p),
        ("still_by", ctypes.c_int64),
        ("table", ctypes.c_void_p),
        ("table_by", ctypes.c_int64),
        ("ends", ctypes.c_void_p),
        ("ends_by", ctypes.c_int64),
        ("samples", ctypes.c_void_p),
        ("samples_by", ctypes.c_int64),
        ("out", ctypes.c_void_p),
        ("last", ctypes.c_void_p),
        ("next", ctypes.c_void_p),
        ("stop", ctypes.c_void_p),
        ("count", ctypes.c_int64),
        ("sample_count", ctypes.c_int64),
        ("pieces", ctypes.c_int64),
        ("tolerance", ctypes.c_double),
        ("most_steps", ctypes.c_double),
        ("first_step", ctypes.c_double),
        ("tick", ctypes.c_double),
    )


# What is left to be done for a lane when it has been served.
_NOTHING, _SLOPE, _TICK, _LEAVE = range(4)

# Integers kept for each lane: the flight it flies, its piece, and what is next of samples and
# ticks.
_FLIGHT, _PIECE, _SAMPLE, _NEXT_TICK = range(4)


class _Lane:
    """Writes what is done for one lane, at the end of `flow`; `places` are its job, block, trial,
    control and integers, and its number. `copy` is `copier`'s and `root` the square root, `clock`
    the first row of the clock's if there is one."""

    def __init__(
        self, flow: Flow, rows: Rows, changing: int, clock: int | None, places: Sequence[Any],
        copy: Any, root: Any,
    ) -> None:  # fmt: skip
        self._flow, self._rows, self._changing, self._clock = flow, rows, changing, clock
        self._copy, self._root = copy, root
        self._at_job, self._x, self._z, self._c, self._integers, self._lane = places

    def _job(self, name: str) -> Any:
        return self._flow.field(Job, self._at_job, name)

    def _entry(self, array: str, flight: Any, count: Any) -> Any:
        """A place in what an array of the job has of a flight."""
        of_flight = self._flow.mul(flight, self._job(f"{array}_by"))
        return self._flow.place(self._job(array), of_flight, count)

    def _place(self, block: Any, row: int) -> Any:
        """The lane's place in a row of a block."""
        return self._flow.place(block, integer(row * LANES), self._lane)

    def _control(self, row: int) -> Any:
        return self._place(self._c, row)

    def _which(self, integers: int) -> Any:
        return self._place(self._integers, integers)

    def _status_is(self, value: float) -> Any:
        status = self._flow.read(self._control(one.STATUS))
        return self._flow.fcmp_ordered("==", status, double(value))

    def serve(self, left: Any) -> None:
        """See to a lane that stopped; what is then left to be done for it goes to `left`."""
        flow = self._flow
        flow.store(integer(_NOTHING), left)
        with flow.repeated() as served:
            with flow.if_then(self._status_is(one.FLYING)):
                flow.leave_if(self._goes_on(left), served)
            with flow.if_then(flow.not_(self._status_is(one.EMPTY))):
                self._finish()
            flight = flow.atomic_rmw("add", self._job("next"), integer(1), "monotonic")
            with flow.if_then(flow.icmp_signed(">=", flight, self._job("count"))):
                flow.store(double(one.EMPTY), self._control(one.STATUS))
                flow.store(integer(_LEAVE), left)
                flow.branch(served)
            self._begin(flight)
            flow.store(integer(_SLOPE), left)

    def _goes_on(self, left: Any) -> Any:
        """Whether the flight goes on, after the samples and the ends of pieces that it has reached
        were seen to; if so, until when is set."""
        flow = self._flow
        flight, time = flow.read(self._which(_FLIGHT), INTEGER), flow.read(self._control(one.TIME))
        until, pieces = self._control(one.UNTIL), self._job("pieces")
        with flow.repeated() as shown:
            sample = flow.read(self._which(_SAMPLE), INTEGER)
            flow.store(double(float("inf")), until)
            flow.leave_if(flow.icmp_signed(">=", sample, self._job("sample_count")), shown)
            due = flow.read(self._entry("samples", flight, sample))
            flow.store(due, until)
            flow.leave_if(flow.fcmp_unordered("<", time, due), shown)
            self._show(flight, sample)
            flow.store(flow.add(sample, integer(1)), self._which(_SAMPLE))
        last = flow.sub(pieces, integer(1))
        over = flow.read(self._entry("ends", flight, last))
        self._not_beyond(until, over)
        due = flow.read(until)
        with flow.repeated() as settled:
            flow.store(due, until)
            piece = flow.read(self._which(_PIECE), INTEGER)
            flow.leave_if(flow.icmp_signed(">=", piece, last), settled)
            end = self._time_of(flow.read(self._entry("ends", flight, piece)))
            self._not_beyond(until, end)
            flow.leave_if(flow.fcmp_unordered("<", time, end), settled)
            following = flow.add(piece, integer(1))
            flow.store(following, self._which(_PIECE))
            self._begin_piece(flight, following)
            flow.store(integer(_SLOPE), left)
        if self._rows.carried:
            self._tick(time, left)
        return flow.fcmp_ordered("<", time, over)

    def _time_of(self, end: Any) -> Any:
        """When a piece ends that is not the last."""
        if self._clock is None:
            return end
        rows = range(self._clock, self._clock + CLOCK)
        clock = [self._flow.read(self._place(self._x, row)) for row in rows]
        return time_of(self._flow, self._root, clock, end)

    def _not_beyond(self, until: Any, time: Any) -> None:
        """See that the next step does not go beyond a time, unless that is none."""
        flow, other = self._flow, self._flow.read(until)
        sooner = flow.fcmp_ordered("<", time, other)
        flow.store(flow.select(sooner, time, other), until)

    def _tick(self, time: Any, left: Any) -> None:
        """See to a tick that was reached, and that the next one is not missed."""
        flow, until, which = self._flow, self._control(one.UNTIL), self._which(_NEXT_TICK)

        def due() -> Any:
            return flow.fmul(flow.sitofp(flow.read(which, INTEGER), DOUBLE), self._job("tick"))

        with flow.repeated() as ahead:
            flow.leave_if(flow.fcmp_unordered("<", time, due()), ahead)
            flow.store(flow.add(flow.read(which, INTEGER), integer(1)), which)
            flow.store(integer(_TICK), left)
        self._not_beyond(until, due())

    def _finish(self) -> None:
        """Hand back how a flight ended, also as all samples that it did not reach."""
        flow, outputs = self._flow, self._rows.outputs
        flight = flow.read(self._which(_FLIGHT), INTEGER)
        sample = flow.read(self._which(_SAMPLE), INTEGER)
        with flow.counted(sample, self._job("sample_count")) as missed:
            self._show(flight, missed)
        row = flow.mul(flight, integer(outputs + LAST_MORE))
        last = flow.place(self._job("last"), row)
        self._keep(last)
        for k, control in enumerate((one.TIME, one.STATUS, one.STEPS), outputs):
            flow.store(flow.read(self._control(control)), flow.place(last, integer(k)))

    def _begin(self, flight: Any) -> None:
        """Put a flight into the lane, at time 0."""
        flow, rows = self._flow, self._rows
        start = flow.place(self._job("first"), flow.mul(flight, integer(rows.outputs)))
        self._fill(self._x, 0, start, rows.state)
        self._fill(
            self._x, rows.before_watched, flow.place(start, integer(rows.state)), rows.watched
        )
        self._fill(self._z, rows.moving, flow.place(start, integer(rows.moving)), rows.carried)
        flow.store(double(0.0), self._place(self._x, rows.state))
        still = self._entry("still", flight, integer(0))
        for block in (self._x, self._z):
            row = rows.state + 1 + self._changing
            self._fill(block, row, still, rows.parameters - self._changing)
        self._begin_piece(flight, integer(0))
        for row in (one.TIME, one.STEPS, one.HELD_BACK):
            flow.store(double(0.0), self._control(row))
        flow.store(double(one.FLYING), self._control(one.STATUS))
        flow.store(self._job("first_step"), self._control(one.STEP))
        flow.store(flight, self._which(_FLIGHT))
        flow.store(integer(0), self._which(_PIECE))
        flow.store(integer(0), self._which(_SAMPLE))
        flow.store(integer(0), self._which(_NEXT_TICK))

    def _begin_piece(self, flight: Any, piece: Any) -> None:
        """Put the parameters of a piece into the lane."""
        parameters = self._entry("table", flight, self._flow.mul(piece, integer(self._changing)))
        for block in (self._x, self._z):
            self._fill(block, self._rows.state + 1, parameters, self._changing)

    def _show(self, flight: Any, sample: Any) -> None:
        """Hand back what there is now as that of a sample."""
        flow = self._flow
        row = flow.add(flow.mul(flight, self._job("sample_count")), sample)
        self._keep(flow.place(self._job("out"), flow.mul(row, integer(self._rows.outputs))))

    def _keep(self, to: Any) -> None:
        """Store the state and what is watched at a place, side by side."""
        rows = self._rows
        self._take(0, to, rows.state)
        self._take(rows.before_watched, self._flow.place(to, integer(rows.state)), rows.watched)

    def _fill(self, block: Any, row: int, source: Any, count: int) -> None:
        """Copy numbers that stand side by side into the lane, from a row of a block on."""
        to, side, lane = self._place(block, row), integer(1), integer(LANES)
        self._flow.call(self._copy, [to, lane, source, side, integer(count)])

    def _take(self, row: int, to: Any, count: int) -> None:
        """Copy the lane's numbers, from a row of the block on, to a place side by side."""
        source, side, lane = self._place(self._x, row), integer(1), integer(LANES)
        self._flow.call(self._copy, [to, side, source, lane, integer(count)])


def fly(rows: Rows, changing: int, clock: int | None = None) -> str:
    """LLVM text of `void fly(Job *)`: the flights of the queue, eight at a time, until there are
    none. It calls @step, @renew and, where something is carried, @carry.

    The first `changing` parameters are those that change from piece to piece. `clock` is the first
    row of the clock that says when.
    """
    code = Code()
    memory = [POINTER] * len(one.MEMORY)
    step = code.declared("step", memory, LANE_BITS)
    renew = code.declared("renew", [*memory, LANE_BITS])
    carry = code.declared("carry", [*memory, LANE_BITS]) if rows.carried else None
    serve = _serve(code, rows, changing, clock)
    flow, (job,) = code.written("fly", [POINTER])
    blocks = _memory(flow, rows, job)
    x, z, c = (blocks[name] for name in (one.BLOCK, one.TRIAL, one.CONTROL))
    stop = flow.field(Job, job, "stop")
    integers = flow.room(INTEGER, 4 * LANES)
    active = flow.room(INTEGER)
    stopped, fresh, ticked = (flow.room(LANE_BITS) for _ in range(3))
    flow.store(integer(LANES), active)
    flow.store(LANE_BITS(-1), stopped)
    with flow.repeated() as over:
        flow.store(LANE_BITS(0), fresh)
        with flow.repeated() as served:
            flow.store(LANE_BITS(0), ticked)
            with flow.counted(integer(0), integer(LANES)) as lane:
                place = flow.shl(LANE_BITS(1), flow.trunc(lane, LANE_BITS))
                stands = flow.and_(flow.read(stopped, LANE_BITS), place)
                with flow.if_then(flow.icmp_unsigned("!=", stands, LANE_BITS(0))):
                    left = flow.call(serve, [job, x, z, c, integers, lane])
                    for code_left, lanes in ((_SLOPE, (fresh,)), (_TICK, (fresh, ticked))):
                        with flow.if_then(flow.icmp_signed("==", left, integer(code_left))):
                            for which in lanes:
                                flow.store(flow.or_(flow.read(which, LANE_BITS), place), which)
                    with flow.if_then(flow.icmp_signed("==", left, integer(_LEAVE))):
                        flow.store(flow.sub(flow.read(active, INTEGER), integer(1)), active)
            bits = flow.read(ticked, LANE_BITS)
            flow.leave_if(flow.icmp_unsigned("==", bits, LANE_BITS(0)), served)
            if carry is not None:
                flow.call(carry, [*blocks.values(), bits])
            # What is carried may say when a piece ends, so these lanes are served again.
            flow.store(bits, stopped)
        flow.leave_if(flow.icmp_signed("==", flow.read(active, INTEGER), integer(0)), over)
        bits = flow.read(fresh, LANE_BITS)
        with flow.if_then(flow.icmp_unsigned("!=", bits, LANE_BITS(0))):
            flow.call(renew, [*blocks.values(), bits])
        with flow.repeated() as stopping:
            bits = flow.call(step, blocks.values())
            flow.store(bits, stopped)
            given_up = flow.load_atomic(stop, "monotonic", align=8, typ=INTEGER)
            flow.leave_if(flow.icmp_unsigned("!=", given_up, integer(0)), over)
            flow.leave_if(flow.icmp_unsigned("!=", bits, LANE_BITS(0)), stopping)
    flow.ret_void()
    return str(code)


def _serve(code: Code, rows: Rows, changing: int, clock: int | None) -> Any:
    """serve(job, x, z, c, integers, lane): `_Lane.serve`, as a function."""
    copy, root = copier(code), code.declared("llvm.sqrt.f64", [DOUBLE], DOUBLE)
    flow, arguments = code.written("serve", [*[POINTER] * 5, INTEGER], INTEGER)
    left = flow.room(INTEGER)
    _Lane(flow, rows, changing, clock, arguments, copy, root).serve(left)
    flow.ret(flow.read(left, INTEGER))
    return flow.function


def _memory(flow: Flow, rows: Rows, job: Any) -> dict[str, Any]:
    """Room for a block of flights, with nothing in any lane."""
    blocks = {}
    for name, count in rows.memory.items():
        blocks[name] = flow.room(DOUBLE, count * LANES)
        flow.fill(blocks[name], count * LANES, double(0.0))
    for row, value in (
        (one.STATUS, double(one.EMPTY)),
        (one.TOLERANCE, flow.field(Job, job, "tolerance")),
        (one.MOST_STEPS, flow.field(Job, job, "most_steps")),
    ):
        flow.fill(flow.place(blocks[one.CONTROL], integer(row * LANES)), LANES, value)
    return blocks
