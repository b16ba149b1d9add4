"""Vectors and matrices as model types hold them: tuples, which are values and can be hashed."""

from __future__ import annotations

from typing import TypeAlias

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats

Vector: TypeAlias = tuple[float, float, float]
Matrix: TypeAlias = tuple[Vector, Vector, Vector]

ZERO: Vector = (0.0, 0.0, 0.0)
IDENTITY: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def as_vector(array: Array) -> Vector:
    """An array as the tuple that the model's types hold.

    Parameters
    ----------
    array : ndarray, shape (3,)

    Returns
    -------
    tuple of float
    """
    x, y, z = _shaped("a vector", array, (3,)).tolist()
    return (x, y, z)


def as_matrix(array: Array) -> Matrix:
    """An array as the tuple of rows that the model's types hold.

    Parameters
    ----------
    array : ndarray, shape (3, 3)

    Returns
    -------
    tuple of tuple of float
    """
    first, second, third = (as_vector(row) for row in _shaped("a matrix", array, (3, 3)))
    return (first, second, third)


def _shaped(what: str, array: Array, shape: tuple[int, ...]) -> Array:
    result = floats(what, array)
    if result.shape != shape:
        raise SomersaultError(f"{what} has shape {shape}, and this one {result.shape}")
    return result
