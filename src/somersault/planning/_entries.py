"""Sparse matrices, put together from their entries."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from somersault._core.array import Array


class Entries:
    """Entries of a matrix, in any order; what comes twice is added."""

    def __init__(self) -> None:
        self._rows: list[Array] = []
        self._columns: list[Array] = []
        self._values: list[Array] = []

    def add(self, row: Array, column: Array, value: Array | float) -> None:
        """More entries; the three broadcast together."""
        row, column, value = np.broadcast_arrays(row, column, value)
        self._rows.append(row.ravel())
        self._columns.append(column.ravel())
        self._values.append(value.ravel())

    def sparse(self, rows: int, columns: int) -> sp.csr_matrix:
        """The matrix."""
        parts = (self._values, self._rows, self._columns)
        values, row, column = (np.concatenate(part) if part else np.zeros(0) for part in parts)
        places = (row.astype(int), column.astype(int))
        return sp.csr_matrix((values, places), (rows, columns))


class Assembly:
    """The entries of a sparse matrix, each a fixed sum of numbers that change.

    Parameters
    ----------
    rows, columns : array (K,)
        Where a number has a part in an entry.
    sources : array (K,)
        Which of the numbers.
    weights : array (K,)
        And how much of it.
    shape : tuple of int
        Of the matrix.
    count : int
        How many numbers there are.
    constant : sparse matrix, optional
        What is added to it.
    """

    def __init__(
        self, rows: Array, columns: Array, sources: Array, weights: Array, shape: tuple[int, int],
        count: int, constant: sp.csr_matrix | None = None,
    ) -> None:  # fmt: skip
        self.shape = shape
        fixed = sp.coo_matrix(shape if constant is None else constant)
        keys = columns * shape[0] + rows
        fixed_keys = fixed.col.astype(int) * shape[0] + fixed.row
        there, place = np.unique(np.concatenate([keys, fixed_keys]), return_inverse=True)
        self.rows, self.columns = there % shape[0], there // shape[0]
        self._constant = np.zeros(len(there))
        np.add.at(self._constant, place[len(keys) :], fixed.data)
        entries = (weights, (place[: len(keys)], sources))
        self._sums = sp.csr_matrix(entries, (len(there), count))

    def values(self, numbers: Array) -> Array:
        """The entries, by columns."""
        return self._constant + self._sums @ numbers


def products(
    left: sp.csr_matrix, of_left: Array, right: sp.csr_matrix, of_right: Array
) -> tuple[Array, Array, Array, Array]:
    """All products of an entry in one row of `left` and one in a row of `right`, for many pairs of
    rows: which pair, the columns of both, and the product."""
    a, b = np.diff(left.indptr)[of_left], np.diff(right.indptr)[of_right]
    pair = np.repeat(np.arange(len(a)), a * b)
    first = np.concatenate([[0], np.cumsum(a * b)[:-1]])
    within = np.arange(len(pair)) - first[pair]
    of_a = left.indptr[of_left][pair] + within // b[pair]
    of_b = right.indptr[of_right][pair] + within % b[pair]
    return pair, left.indices[of_a], right.indices[of_b], left.data[of_a] * right.data[of_b]
