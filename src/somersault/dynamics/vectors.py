"""Three-vectors and 3 × 3 matrices whose entries are numbers or symbols.

Entries are floats or CasADi scalars, so that whatever is zero or one in a model vanishes from
its equations while they are written. Vectors and matrices are plain lists (of rows).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Scalar = Any  # float or casadi.SX (1 × 1)
Vec = list[Scalar]
Mat = list[list[Scalar]]


def is_zero(value: Scalar) -> bool:
    """Whether an entry is the number zero (a symbol never is)."""
    return value == 0.0 if isinstance(value, float | int) else bool(value.is_zero())


def mul(a: Scalar, b: Scalar) -> Scalar:
    """a b, and the number 0 where either is zero."""
    return 0.0 if is_zero(a) or is_zero(b) else a * b


def add(a: Scalar, b: Scalar) -> Scalar:
    """a + b without adding zeros."""
    if is_zero(a):
        return b
    return a if is_zero(b) else a + b


def sub(a: Scalar, b: Scalar) -> Scalar:
    """a − b without subtracting zeros."""
    if is_zero(b):
        return a
    return -b if is_zero(a) else a - b


def total(terms: Sequence[Scalar]) -> Scalar:
    """Sum of scalars, left to right."""
    result: Scalar = 0.0
    for term in terms:
        result = add(result, term)
    return result


def dot(a: Sequence[Scalar], b: Sequence[Scalar]) -> Scalar:
    """a · b."""
    return total([mul(x, y) for x, y in zip(a, b, strict=True)])


def cross(a: Sequence[Scalar], b: Sequence[Scalar]) -> Vec:
    """a × b."""
    return [
        sub(mul(a[1], b[2]), mul(a[2], b[1])),
        sub(mul(a[2], b[0]), mul(a[0], b[2])),
        sub(mul(a[0], b[1]), mul(a[1], b[0])),
    ]


def vadd(*vectors: Sequence[Scalar]) -> Vec:
    """Sum of vectors."""
    return [total(parts) for parts in zip(*vectors, strict=True)]


def vsub(a: Sequence[Scalar], b: Sequence[Scalar]) -> Vec:
    """a − b."""
    return [sub(x, y) for x, y in zip(a, b, strict=True)]


def scale(factor: Scalar, vector: Sequence[Scalar]) -> Vec:
    """factor · vector."""
    return [mul(factor, x) for x in vector]


def transpose(a: Sequence[Sequence[Scalar]]) -> Mat:
    """Aᵀ."""
    return [list(row) for row in zip(*a, strict=True)]


def matvec(a: Sequence[Sequence[Scalar]], x: Sequence[Scalar]) -> Vec:
    """A x."""
    return [dot(row, x) for row in a]


def matmul(a: Sequence[Sequence[Scalar]], b: Sequence[Sequence[Scalar]]) -> Mat:
    """A B."""
    columns = transpose(b)
    return [[dot(row, column) for column in columns] for row in a]


def madd(a: Sequence[Sequence[Scalar]], b: Sequence[Sequence[Scalar]]) -> Mat:
    """A + B."""
    return [vadd(x, y) for x, y in zip(a, b, strict=True)]


def symmetric(a: Sequence[Sequence[Scalar]]) -> Mat:
    """The matrix with its upper triangle copied below: what is equal becomes identical."""
    size = range(len(a))
    return [[a[min(i, j)][max(i, j)] for j in size] for i in size]


def tilde(v: Sequence[Scalar]) -> Mat:
    """The matrix of v ×."""
    return [[0.0, sub(0.0, v[2]), v[1]], [v[2], 0.0, sub(0.0, v[0])], [sub(0.0, v[1]), v[0], 0.0]]


def steiner(mass: Scalar, r: Sequence[Scalar]) -> Mat:
    """Inertia of a point mass at r about the origin, m (r·r 1 − r rᵀ)."""
    square = [mul(mass, mul(x, x)) for x in r]
    return symmetric(
        [
            [
                total([square[k] for k in range(3) if k != i])
                if i == j
                else sub(0.0, mul(mass, mul(r[i], r[j])))
                for j in range(3)
            ]
            for i in range(3)
        ]
    )


def solve_symmetric(
    a: Sequence[Sequence[Scalar]], columns: Sequence[Sequence[Scalar]]
) -> list[Vec]:
    """The x with A x = b for each b of `columns`; A symmetric positive definite.

    L D Lᵀ without pivoting, skipping structural zeros.
    """
    n = len(a)
    scaled: Mat = [[0.0] * n for _ in range(n)]  # L D
    lower: Mat = [[0.0] * n for _ in range(n)]
    inverse: Vec = []
    for j in range(n):
        for i in range(j, n):
            scaled[i][j] = sub(a[i][j], dot(lower[i][:j], scaled[j][:j]))
        inverse.append(1.0 / scaled[j][j])
        for i in range(j + 1, n):
            lower[i][j] = mul(scaled[i][j], inverse[j])
    solutions = []
    for b in columns:
        x = list(b)
        for i in range(n):
            x[i] = sub(x[i], dot(lower[i][:i], x[:i]))
        x = [mul(x[i], inverse[i]) for i in range(n)]
        for i in reversed(range(n)):
            x[i] = sub(x[i], dot([lower[k][i] for k in range(i + 1, n)], x[i + 1 :]))
        solutions.append(x)
    return solutions
