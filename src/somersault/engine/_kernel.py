"""Compiled functions over many samples at once."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from functools import cached_property
from itertools import accumulate, pairwise

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault.engine._expression import expression
from somersault.engine._machine import compiled, compiled_function
from somersault.engine._samples import Samples, compute
from somersault.engine._threads import threads, together
from somersault.engine._vectors import LANES, module

_WORTH_A_THREAD = 256  # blocks below which a second thread costs more than it gives
_NUMBER = 8  # bytes


class Kernel:
    """A function of vectors as machine code, eight samples at a time on all threads.

    A result does not depend on how many samples are asked with it, nor on the number of threads:
    every lane does the same operations in the same order. The code is compiled at the first call,
    and lives as long as the kernel.

    Parameters
    ----------
    function
        A CasADi function that takes dense vectors and gives one.

    Attributes
    ----------
    widths : tuple of int
        How many numbers each argument has.
    inputs, outputs : int
        How many numbers all arguments have together, and the result.

    Examples
    --------
    >>> import casadi as ca
    >>> x, y = ca.SX.sym("x", 2), ca.SX.sym("y")
    >>> kernel = Kernel(ca.Function("f", [x, y], [x[0] * y + x[1]]))
    >>> kernel([[1.0, 2.0], [3.0, 4.0]], [10.0])
    array([[12.],
           [34.]])
    """

    def __init__(self, function: ca.Function) -> None:
        self.widths = tuple(function.nnz_in(k) for k in range(function.n_in()))
        self.inputs: int = sum(self.widths)
        self.outputs: int = function.nnz_out(0)
        self._function = function

    @cached_property
    def block(self) -> Callable[..., None]:
        """`void kernel(const double *x, double *y)` over one block of lanes, compiled."""
        engine = compiled(module([expression(self._function, "kernel")]))
        return compiled_function(engine, "kernel", ctypes.c_void_p, ctypes.c_void_p)

    def __call__(self, *arguments: ArrayLike) -> Array:
        """The function at each sample.

        Parameters
        ----------
        *arguments
            Arrays (…, width), one for each argument; or one array (…, inputs) that has all of them
            side by side. Leading dimensions broadcast, without copies where an argument is the
            same for all samples.

        Returns
        -------
        array
            (…, outputs).

        Raises
        ------
        ValueError
            For arrays that are not as wide as the arguments.
        """
        arrays = self._separate([np.asarray(argument, float) for argument in arguments])
        lead = np.broadcast_shapes(*(a.shape[:-1] for a in arrays))
        count = math.prod(lead)
        out = np.empty((*lead, self.outputs))
        if out.size:
            self._run([_rows(a, lead, count) for a in arrays], out, count)
        return out

    def _separate(self, arrays: list[Array]) -> list[Array]:
        """One array for each argument."""
        if len(arrays) == 1 < len(self.widths) and arrays[0].shape[-1:] == (self.inputs,):
            edges = accumulate(self.widths, initial=0)
            return [arrays[0][..., a:b] for a, b in pairwise(edges)]
        if [a.shape[-1:] for a in arrays] != [(width,) for width in self.widths]:
            shapes = ", ".join(str(a.shape) for a in arrays)
            raise ValueError(f"arguments of widths {self.widths} cannot be of shape {shapes}")
        return arrays

    def _run(self, rows: list[tuple[Array, int]], out: Array, count: int) -> None:
        widths, addresses, strides = (
            (kind * len(rows))(*numbers)
            for kind, numbers in (
                (ctypes.c_int64, self.widths),
                (ctypes.c_void_p, (array.ctypes.data for array, _ in rows)),
                (ctypes.c_int64, (stride for _, stride in rows)),
            )
        )
        block = self.block
        samples = Samples(
            kernel=ctypes.cast(block, ctypes.c_void_p),  # type: ignore[arg-type]
            arguments=len(rows),
            widths=ctypes.addressof(widths),
            rows=ctypes.addressof(addresses),
            strides=ctypes.addressof(strides),
            inputs=self.inputs,
            outputs=self.outputs,
            count=count,
            out=out.ctypes.data,
        )
        blocks = -(-count // LANES)
        workers = threads() if blocks >= _WORTH_A_THREAD else 1
        edges = [blocks * k // workers for k in range(workers + 1)]
        run, job = compute(), ctypes.byref(samples)
        if workers == 1:
            run(job, 0, blocks)
        else:
            together(run, [(job, *ends) for ends in pairwise(edges)])


def _rows(array: Array, lead: tuple[int, ...], count: int) -> tuple[Array, int]:
    """An argument as rows of numbers that are side by side, and how far one row is from the next:
    0 where all samples have the same. What cannot be read as it is, is copied."""
    width = array.shape[-1]
    if array.size == width:
        return np.ascontiguousarray(array), 0
    if array.shape[:-1] != lead:
        array = np.broadcast_to(array, (*lead, width))
    rows = array.reshape(count, width)
    by_row, by_number = rows.strides
    if by_number != _NUMBER or by_row % _NUMBER or not rows.flags.aligned:
        rows = np.ascontiguousarray(rows)
    return rows, rows.strides[0] // _NUMBER
