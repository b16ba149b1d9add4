"""A compiled function over many samples that stand in rows, eight of them in the lanes at a time.

Rows are turned into lanes, and lanes into rows, four numbers of each at a time, by the thread that
computes with them: nothing but arguments and results crosses the memory.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from llvmlite import ir

from somersault.engine._flow import DOUBLE, INTEGER, POINTER, Code, Flow, integer
from somersault.engine._vectors import LANES

_WIDE = 4  # numbers of a row that are moved at once
_INDEX = ir.IntType(32)


def samples(widths: Sequence[int], outputs: int) -> str:
    """LLVM text of `void samples(const double **from, const i64 *strides, double *out, i64 count,
    i64 first, i64 end)`, which calls @kernel for the blocks from `first` to before `end`.

    Argument k of sample i is the `widths[k]` numbers at from[k] + i strides[k], side by side; a
    stride of 0 gives all samples the same. `out` (count, outputs) receives the results. A last
    block that is not full has the last sample in the lanes that are left, whose results are
    written more than once.
    """
    code = Code()
    kernel = code.declared("kernel", [POINTER, POINTER])
    gathers = [_gather(code, f"gather_{k}", width) for k, width in enumerate(widths)]
    scatter = _scatter(code, outputs)
    flow, (addresses, strides, out, count, first, end) = code.written(
        "samples", [POINTER, POINTER, POINTER, INTEGER, INTEGER, INTEGER]
    )
    x, y = (flow.room(DOUBLE, max(n, 1) * LANES) for n in (sum(widths), outputs))
    last = flow.sub(count, integer(1))
    moving = []
    for k, gather in enumerate(gathers):
        rows = flow.place(x, integer(sum(widths[:k]) * LANES))
        source = flow.read(flow.place(addresses, integer(k)), POINTER)
        stride = flow.read(flow.place(strides, integer(k)), INTEGER)
        flow.call(gather, [rows, source, stride, integer(0), last])
        moves = flow.icmp_signed("!=", stride, integer(0))
        moving.append((gather, rows, source, stride, moves))
    with flow.counted(first, end) as block:
        sample = flow.mul(block, integer(LANES))
        for gather, rows, source, stride, moves in moving:
            with flow.if_then(moves):
                flow.call(gather, [rows, source, stride, sample, last])
        flow.call(kernel, [x, y])
        flow.call(scatter, [y, out, integer(outputs), sample, last])
    flow.ret_void()
    return str(code)


def _gather(code: Code, name: str, width: int) -> Any:
    """gather(block, rows, stride, first, last): eight rows of memory into the lanes of a block."""
    flow, (block, *where) = code.written(name, [POINTER, POINTER, INTEGER, INTEGER, INTEGER])
    rows = _lane_rows(flow, *where)
    for column, wide in _groups(width):
        kind = ir.VectorType(DOUBLE, wide)
        pieces = [flow.load(flow.place(r, integer(column)), align=8, typ=kind) for r in rows]
        halves = [_joined(flow, pieces[r], pieces[r + 4], wide) for r in range(4)]
        for k, lanes in enumerate(_transposed(flow, halves)[:wide]):
            flow.store(lanes, flow.place(block, integer((column + k) * LANES)), align=64)
    flow.ret_void()
    return flow.function


def _scatter(code: Code, width: int) -> Any:
    """scatter(block, rows, stride, first, last): the lanes of a block into eight rows of memory."""
    flow, (block, *where) = code.written("scatter", [POINTER, POINTER, INTEGER, INTEGER, INTEGER])
    rows = _lane_rows(flow, *where)
    vector = ir.VectorType(DOUBLE, LANES)
    for column, wide in _groups(width):
        places = [flow.place(block, integer((column + k) * LANES)) for k in range(wide)]
        lanes = [flow.load(place, align=64, typ=vector) for place in places]
        halves = _transposed(flow, [*lanes, *lanes[:1] * (_WIDE - wide)])
        for r, row in enumerate(rows):
            start = 4 * (r // 4)
            piece = _shuffled(flow, halves[r % 4], halves[r % 4], range(start, start + wide))
            flow.store(piece, flow.place(row, integer(column)), align=8)
    flow.ret_void()
    return flow.function


def _lane_rows(flow: Flow, rows: Any, stride: Any, first: Any, last: Any) -> list[Any]:
    """Where the row of each lane starts; beyond the last row it is that."""
    places = []
    for lane in range(LANES):
        row = flow.add(first, integer(lane))
        row = flow.select(flow.icmp_signed("<", row, last), row, last)
        places.append(flow.place(rows, flow.mul(row, stride)))
    return places


def _groups(width: int) -> list[tuple[int, int]]:
    """Columns in groups of four, by their first and their number; the last group may overlap."""
    if width < _WIDE:
        return [(0, width)] if width else []
    return [(min(start, width - _WIDE), _WIDE) for start in range(0, width, _WIDE)]


def _joined(flow: Flow, low: Any, high: Any, wide: int) -> Any:
    """Two pieces of up to four numbers as the halves of a vector of eight."""
    halves = ([start + min(k, wide - 1) for k in range(_WIDE)] for start in (0, wide))
    return _shuffled(flow, low, high, [index for half in halves for index in half])


def _transposed(flow: Flow, rows: list[Any]) -> list[Any]:
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
