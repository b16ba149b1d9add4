"""Rotations between neighbouring links, written so that they cost little.

A `Turn` takes components in a link's axes to components in its parent's: first a turn about a
coordinate axis (a hinge) or a full rotation (a ball), then a constant rotation. Turning a
symmetric matrix about a coordinate axis this way takes eight operations for the turned
2 × 2 block instead of a general congruence.
"""

from __future__ import annotations

from dataclasses import dataclass

from somersault.dynamics.vectors import (
    Mat,
    Scalar,
    Vec,
    add,
    matmul,
    matvec,
    mul,
    sub,
    symmetric,
    transpose,
)


@dataclass(frozen=True)
class Turn:
    """v_parent = fixed · full · Rot(axis, c, s) · v_link; each part is None where there is none."""

    fixed: Mat | None = None
    full: Mat | None = None
    axis: int = 0
    cosine: Scalar = None
    sine: Scalar = None

    def out(self, v: Vec) -> Vec:
        """A vector's components in the parent's axes."""
        if self.cosine is not None:
            v = _turned(v, self.axis, self.cosine, self.sine)
        if self.full is not None:
            v = matvec(self.full, v)
        return v if self.fixed is None else matvec(self.fixed, v)

    def into(self, v: Vec) -> Vec:
        """A parent's vector in this link's axes."""
        if self.fixed is not None:
            v = matvec(transpose(self.fixed), v)
        if self.full is not None:
            v = matvec(transpose(self.full), v)
        if self.cosine is not None:
            v = _turned(v, self.axis, self.cosine, sub(0.0, self.sine))
        return v

    def out_symmetric(self, a: Mat) -> Mat:
        """R A Rᵀ of a symmetric A."""
        if self.cosine is not None:
            a = _turned_symmetric(a, self.axis, self.cosine, self.sine)
        for rotation in (self.full, self.fixed):
            if rotation is not None:
                a = symmetric(matmul(matmul(rotation, a), transpose(rotation)))
        return a

    def out_matrix(self, a: Mat) -> Mat:
        """R A Rᵀ of any A."""
        if self.cosine is not None:
            rows = transpose([_turned(c, self.axis, self.cosine, self.sine) for c in transpose(a)])
            a = [_turned(row, self.axis, self.cosine, self.sine) for row in rows]
        for rotation in (self.full, self.fixed):
            if rotation is not None:
                a = matmul(matmul(rotation, a), transpose(rotation))
        return a


def _turned(v: Vec, k: int, c: Scalar, s: Scalar) -> Vec:
    i, j = (k + 1) % 3, (k + 2) % 3
    result = list(v)
    result[i] = sub(mul(c, v[i]), mul(s, v[j]))
    result[j] = add(mul(s, v[i]), mul(c, v[j]))
    return result


def _turned_symmetric(a: Mat, k: int, c: Scalar, s: Scalar) -> Mat:
    i, j = (k + 1) % 3, (k + 2) % 3
    result = [list(row) for row in a]
    # With w = c (a_ii − a_jj) − 2 s a_ij the turned block is a_jj + c w, a_ii − c w, a_ij + s w.
    w = sub(mul(c, sub(a[i][i], a[j][j])), mul(add(s, s), a[i][j]))
    result[i][i] = add(a[j][j], mul(c, w))
    result[j][j] = sub(a[i][i], mul(c, w))
    result[i][j] = result[j][i] = add(a[i][j], mul(s, w))
    edge = _turned(a[k], k, c, s)
    for m in (i, j):
        result[k][m] = result[m][k] = edge[m]
    return result
