"""Quaternions and rotation matrices of attitudes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.numbers import floats, require_together


def matrix_from_quaternion(quaternion: ArrayLike) -> Array:
    """Rotation matrices of unit quaternions.

    Parameters
    ----------
    quaternion : array_like, shape (..., 4)
        Scalar first, body to inertial.

    Returns
    -------
    numpy.ndarray, shape (..., 3, 3)
        Body to inertial: C_bi transposed.

    Examples
    --------
    >>> from somersault.attitude import matrix_from_quaternion
    >>> matrix_from_quaternion([0.0, 1.0, 0.0, 0.0]).tolist()
    [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]
    """
    w, x, y, z = np.moveaxis(floats("quaternion", quaternion, 4), -1, 0)
    return stacked(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def quaternion_from_matrix(matrix: ArrayLike) -> Array:
    """Unit quaternions of rotation matrices.

    Each is read from the largest of w², x², y², z² (Shepperd), so half turns are as exact
    as small ones.

    Parameters
    ----------
    matrix : array_like, shape (..., 3, 3)
        Body to inertial.

    Returns
    -------
    numpy.ndarray, shape (..., 4)
        Scalar first, with w ≥ 0.

    Examples
    --------
    >>> import numpy as np
    >>> from somersault.attitude import quaternion_from_matrix
    >>> quaternion_from_matrix(np.diag([1.0, -1.0, -1.0])).tolist()
    [0.0, 1.0, 0.0, 0.0]
    """
    r = floats("matrix", matrix, 3, 3)
    xx, yy, zz = r[..., 0, 0], r[..., 1, 1], r[..., 2, 2]
    wx, wy, wz = (r[..., j, i] - r[..., i, j] for i, j in ((1, 2), (2, 0), (0, 1)))
    yz, zx, xy = (r[..., j, i] + r[..., i, j] for i, j in ((1, 2), (2, 0), (0, 1)))
    products = stacked(  # 4 q qᵀ
        [
            [1 + xx + yy + zz, wx, wy, wz],
            [wx, 1 + xx - yy - zz, xy, zx],
            [wy, xy, 1 - xx + yy - zz, yz],
            [wz, zx, yz, 1 - xx - yy + zz],
        ]
    )
    largest = np.argmax(np.diagonal(products, axis1=-2, axis2=-1), -1)
    row = np.take_along_axis(products, largest[..., None, None], -2)[..., 0, :]
    row = row / np.linalg.norm(row, axis=-1, keepdims=True)
    return np.where(row[..., :1] < 0, -row, row)


def quaternion_product(first: ArrayLike, second: ArrayLike) -> Array:
    """p q of quaternions: the turn q, then the turn p.

    Parameters
    ----------
    first, second : array_like, shape (..., 4)
        p and q, scalar first, which broadcast.

    Returns
    -------
    numpy.ndarray, shape (..., 4)

    Examples
    --------
    >>> from somersault.attitude import quaternion_product
    >>> quaternion_product([0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]).tolist()
    [0.0, 0.0, 0.0, 1.0]
    """
    p, q = floats("first", first, 4), floats("second", second, 4)
    require_together({"first": p.shape, "second": q.shape})
    real = p[..., 0] * q[..., 0] - np.sum(p[..., 1:] * q[..., 1:], -1)
    parts = p[..., :1] * q[..., 1:] + q[..., :1] * p[..., 1:] + np.cross(p[..., 1:], q[..., 1:])
    return np.concatenate([real[..., None], parts], -1)


def quaternion_conjugate(quaternion: ArrayLike) -> Array:
    """The inverse turns of unit quaternions.

    Parameters
    ----------
    quaternion : array_like, shape (..., 4)
        Scalar first.

    Returns
    -------
    numpy.ndarray, shape (..., 4)

    Examples
    --------
    >>> from somersault.attitude import quaternion_conjugate
    >>> quaternion_conjugate([0.8, 0.6, 0.0, 0.0]).tolist()
    [0.8, -0.6, -0.0, -0.0]
    """
    return floats("quaternion", quaternion, 4) * [1.0, -1.0, -1.0, -1.0]


def stacked(rows: list[list[Array]]) -> Array:
    """Matrices (…, 3, 3) of their entries (…)."""
    return np.stack([np.stack(row, -1) for row in rows], -2)
