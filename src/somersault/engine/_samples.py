"""A compiled function over many samples that stand in rows, eight of them in the lanes at a time.

Rows are turned into lanes, and lanes into rows, four numbers of each at a time, by the thread that
computes with them: nothing but arguments and results crosses the memory. The code is the same for
all functions, and so is compiled once.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from typing import Any

from llvmlite import ir

from somersault.engine._flow import BIT, DOUBLE, INTEGER, NOTHING, POINTER, Code, Flow, integer
from somersault.engine._machine import compiled, compiled_function
from somersault.engine._vectors import LANES

_WIDE = 4  # numbers of a row that are moved at once
_VECTOR, _PART = ir.VectorType(DOUBLE, LANES), ir.VectorType(DOUBLE, _WIDE)
_INDEX = ir.IntType(32)
_KERNEL = ir.FunctionType(NOTHING, [POINTER, POINTER])


class Samples(ctypes.Structure):
    """Samples that a function is computed for, and where to put the results.

    `kernel` is the address of `void kernel(const double *x, double *y)` over one block of lanes.
    Argument k of sample i is the `widths`[k] numbers at `rows`[k] + i `strides`[k], side by side; a
    stride of 0 gives all samples the same. All have `inputs` numbers together. `out` (count,
    outputs) receives the results.
    """

    _fields_ = (
        ("kernel", ctypes.c_void_p),
        ("arguments", ctypes.c_int64),
        ("widths", ctypes.c_void_p),
        ("rows", ctypes.c_void_p),
        ("strides", ctypes.c_void_p),
        ("inputs", ctypes.c_int64),
        ("outputs", ctypes.c_int64),
        ("count", ctypes.c_int64),
        ("out", ctypes.c_void_p),
    )


@cache
def compute() -> Callable[[Any, int, int], None]:
    """`void compute(const Samples *, i64 first, i64 end)`: the blocks from `first` to before `end`.

    A last block that is not full has the last sample in the lanes that are left, whose results are
    written more than once.
    """
    engine = compiled(_text())
    return compiled_function(engine, "compute", ctypes.c_void_p, ctypes.c_int64, ctypes.c_int64)


def _text() -> str:
    code = Code()
    gather, scatter = _gather(code), _scatter(code)
    flow, (samples, first, end) = code.written("compute", [POINTER, INTEGER, INTEGER])
    inputs, outputs, count, out = (
        flow.field(Samples, samples, name) for name in ("inputs", "outputs", "count", "out")
    )
    kernel = flow.field(Samples, samples, "kernel", _KERNEL.as_pointer())
    x, y = (flow.room(DOUBLE, flow.mul(numbers, integer(LANES))) for numbers in (inputs, outputs))
    last = flow.sub(count, integer(1))
    flow.call(gather, [samples, x, integer(0), last, BIT(1)])
    with flow.counted(first, end) as block:
        sample = flow.mul(block, integer(LANES))
        flow.call(gather, [samples, x, sample, last, BIT(0)])
        flow.call(kernel, [x, y])
        flow.call(scatter, [y, out, outputs, sample, last])
    flow.ret_void()
    return str(code)


def _gather(code: Code) -> Any:
    """gather(samples, x, first, last, all): the arguments of eight samples into the lanes of x;
    unless `all`, only those that are not the same for all samples."""
    turn = _turn(code)
    flow, (samples, x, first, last, everything) = code.written(
        "gather", [POINTER, POINTER, INTEGER, INTEGER, BIT]
    )
    widths, rows, strides = (
        flow.field(Samples, samples, name) for name in ("widths", "rows", "strides")
    )
    block = flow.room(POINTER)
    flow.store(x, block)
    with flow.counted(integer(0), flow.field(Samples, samples, "arguments")) as k:
        width = flow.read(flow.place(widths, k), INTEGER)
        stride = flow.read(flow.place(strides, k), INTEGER)
        differs = flow.icmp_signed("!=", stride, integer(0))
        here = flow.read(block, POINTER)
        with flow.if_then(flow.or_(everything, differs)):
            source = flow.read(flow.place(rows, k), POINTER)
            flow.call(turn, [here, source, stride, first, last, width])
        flow.store(flow.place(here, flow.mul(width, integer(LANES))), block)
    flow.ret_void()
    return flow.function


def _turn(code: Code) -> Any:
    """turn(block, rows, stride, first, last, width): eight rows into the lanes of a block."""
    flow, (block, rows, stride, first, last, width) = code.written(
        "turn", [POINTER, POINTER, INTEGER, INTEGER, INTEGER, INTEGER]
    )
    starts = _starts(flow, rows, stride, first, last)
    wide = flow.icmp_signed(">=", width, integer(_WIDE))
    with flow.if_else(wide) as (then, otherwise):
        with then, _groups(flow, width) as column:
            parts = [flow.load(flow.place(start, column), align=8, typ=_PART) for start in starts]
            halves = [_shuffled(flow, parts[r], parts[r + 4], range(LANES)) for r in range(4)]
            for k, lanes in enumerate(_transposed(flow, halves)):
                flow.store(lanes, _lanes_of(flow, block, column, k), align=64)
        with otherwise, flow.counted(integer(0), width) as column:
            lanes = ir.Constant(_VECTOR, ir.Undefined)
            for k, start in enumerate(starts):
                number = flow.read(flow.place(start, column))
                lanes = flow.insert_element(lanes, number, _INDEX(k))
            flow.store(lanes, _lanes_of(flow, block, column), align=64)
    flow.ret_void()
    return flow.function


def _scatter(code: Code) -> Any:
    """scatter(block, rows, width, first, last): the lanes of a block into eight rows."""
    flow, (block, rows, width, first, last) = code.written(
        "scatter", [POINTER, POINTER, INTEGER, INTEGER, INTEGER]
    )
    starts = _starts(flow, rows, width, first, last)
    wide = flow.icmp_signed(">=", width, integer(_WIDE))
    with flow.if_else(wide) as (then, otherwise):
        with then, _groups(flow, width) as column:
            lanes = [
                flow.load(_lanes_of(flow, block, column, k), align=64, typ=_VECTOR)
                for k in range(_WIDE)
            ]
            halves = _transposed(flow, lanes)
            for r, start in enumerate(starts):
                half = range(_WIDE) if r < 4 else range(_WIDE, LANES)
                part = _shuffled(flow, halves[r % 4], halves[r % 4], half)
                flow.store(part, flow.place(start, column), align=8)
        with otherwise, flow.counted(integer(0), width) as column:
            numbers = flow.load(_lanes_of(flow, block, column), align=64, typ=_VECTOR)
            for k, start in enumerate(starts):
                flow.store(flow.extract_element(numbers, _INDEX(k)), flow.place(start, column))
    flow.ret_void()
    return flow.function


def _starts(flow: Flow, rows: Any, stride: Any, first: Any, last: Any) -> list[Any]:
    """Where the row of each lane starts; beyond the last row it is that."""
    places = []
    for lane in range(LANES):
        row = flow.add(first, integer(lane))
        row = flow.select(flow.icmp_signed("<", row, last), row, last)
        places.append(flow.place(rows, flow.mul(row, stride)))
    return places


@contextmanager
def _groups(flow: Flow, width: Any) -> Iterator[Any]:
    """The first column of each group of four; the last group may overlap the one before it."""
    groups = flow.sdiv(flow.add(width, integer(_WIDE - 1)), integer(_WIDE))
    furthest = flow.sub(width, integer(_WIDE))
    with flow.counted(integer(0), groups) as group:
        column = flow.mul(group, integer(_WIDE))
        yield flow.select(flow.icmp_signed("<", column, furthest), column, furthest)


def _lanes_of(flow: Flow, block: Any, column: Any, further: int = 0) -> Any:
    """The row of a block that has the lanes of a column, or of one so much further."""
    return flow.place(block, flow.mul(column, integer(LANES)), integer(further * LANES))


def _transposed(flow: Flow, rows: Sequence[Any]) -> list[Any]:
    """Four vectors whose halves are 4 × 4 matrices each, by rows; the same by columns."""
    first, second = [0, 8, 2, 10, 4, 12, 6, 14], [1, 9, 3, 11, 5, 13, 7, 15]
    low, high = [0, 1, 8, 9, 4, 5, 12, 13], [2, 3, 10, 11, 6, 7, 14, 15]
    a, b, c, d = rows
    even = _shuffled(flow, a, b, first), _shuffled(flow, c, d, first)
    odd = _shuffled(flow, a, b, second), _shuffled(flow, c, d, second)
    return [_shuffled(flow, x, y, half) for half in (low, high) for x, y in (even, odd)]


def _shuffled(flow: Flow, a: Any, b: Any, indices: Sequence[int]) -> Any:
    """Elements of two vectors side by side, by their places."""
    mask = ir.Constant(ir.VectorType(_INDEX, len(indices)), list(indices))
    return flow.shuffle_vector(a, b, mask)
