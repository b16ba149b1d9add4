"""Vectors and matrices as model types hold them: tuples, which are values and can be hashed."""

from __future__ import annotations

from typing import TypeAlias

from somersault._core.array import Array

Vector: TypeAlias = tuple[float, float, float]
Matrix: TypeAlias = tuple[Vector, Vector, Vector]

ZERO: Vector = (0.0, 0.0, 0.0)
IDENTITY: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def as_vector(array: Array) -> Vector:
    """Three numbers of an array as the tuple that the model types hold."""
    x, y, z = array.tolist()
    return (x, y, z)


def as_matrix(array: Array) -> Matrix:
    """A 3 x 3 array as the tuple of rows that the model types hold."""
    first, second, third = (as_vector(row) for row in array)
    return (first, second, third)
