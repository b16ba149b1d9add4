"""Compiled functions over many samples at once."""

from __future__ import annotations

import ctypes
import math
from functools import cached_property
from itertools import pairwise

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault.engine._expression import expression
from somersault.engine._flow import INTEGER, POINTER, Code, integer
from somersault.engine._machine import compiled
from somersault.engine._threads import pool, threads
from somersault.engine._vectors import LANES, module

_ALIGN = 64  # bytes, the width of a block row
_WORTH_A_THREAD = 256  # blocks below which a second thread costs more than it gives


class Kernel:
    """A function of one vector as machine code, eight samples to a call.

    Built from a CasADi function with one dense vector in and one out. Holds the code for as
    long as it lives. Results do not depend on how many samples are asked at once, nor on the
    number of threads: every lane does the same operations in the same order.
    """

    def __init__(self, function: ca.Function) -> None:
        self.inputs: int = function.nnz_in(0)
        self.outputs: int = function.nnz_out(0)
        self._function = function

    @cached_property
    def _compiled(self):  # the engine must outlive the addresses taken from it
        many = _many(self.inputs, self.outputs)
        return compiled(many, module([expression(self._function, "kernel")]))

    @cached_property
    def address(self) -> int:
        """Address of `void kernel(const double *x, double *y)` over one block of lanes."""
        return self._compiled.get_function_address("kernel")

    @cached_property
    def _many(self):
        address = self._compiled.get_function_address("kernel_many")
        return ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64)(address)

    def __call__(self, x: Array) -> Array:
        """The function at each sample: x (…, inputs) gives (…, outputs)."""
        x = np.asarray(x, float)
        count = math.prod(x.shape[:-1])
        if count == 0:
            return np.empty((*x.shape[:-1], self.outputs))
        flat = x.reshape(count, self.inputs)
        result = unpacked(self.blocks(packed(flat)), count)
        return result.reshape(*x.shape[:-1], self.outputs)

    def blocks(self, x: Array, out: Array | None = None) -> Array:
        """The same without repacking: x (blocks, inputs, 8), from `aligned`, gives
        (blocks, outputs, 8)."""
        if out is None:
            out = aligned((len(x), self.outputs, LANES))
        workers = threads() if len(x) >= _WORTH_A_THREAD else 1
        edges = np.linspace(0, len(x), workers + 1).astype(int)
        parts = [(x[a:b], out[a:b]) for a, b in pairwise(edges)]
        if workers == 1:
            self._run(*parts[0])
        else:
            list(pool().map(lambda part: self._run(*part), parts))
        return out

    def _run(self, x: Array, out: Array) -> None:
        self._many(x.ctypes.data, out.ctypes.data, len(x))


def packed(rows: Array) -> Array:
    """Rows (N, m) as blocks of lanes (B, m, 8), the last row repeated to fill."""
    count, width = rows.shape
    full = count // LANES
    result = aligned((-(-count // LANES), width, LANES))
    result[:full] = rows[: full * LANES].reshape(full, LANES, width).swapaxes(1, 2)
    if len(result) > full:
        last = rows[full * LANES :].T
        result[full, :, : last.shape[1]] = last
        result[full, :, last.shape[1] :] = last[:, -1:]
    return result


def unpacked(blocks: Array, count: int) -> Array:
    """The first `count` rows (N, m) of blocks of lanes (B, m, 8)."""
    return blocks.swapaxes(1, 2).reshape(-1, blocks.shape[1])[:count]


def aligned(shape: tuple[int, ...]) -> Array:
    """An empty array whose data start on a 64-byte boundary, as the vector loads need."""
    count = math.prod(shape)
    raw = np.empty(count + _ALIGN // 8)
    start = (-raw.ctypes.data % _ALIGN) // 8
    return raw[start : start + count].reshape(shape)


def _many(inputs: int, outputs: int) -> str:
    """LLVM text of kernel_many(x, y, blocks), which calls @kernel for one block after another."""
    code = Code()
    kernel = code.declared("kernel", [POINTER, POINTER])
    flow, (x, y, blocks) = code.written("kernel_many", [POINTER, POINTER, INTEGER])
    with flow.counted(integer(0), blocks) as block:
        x_block = flow.place(x, flow.mul(block, integer(inputs * LANES)))
        y_block = flow.place(y, flow.mul(block, integer(outputs * LANES)))
        flow.call(kernel, [x_block, y_block])
    flow.ret_void()
    return str(code)
