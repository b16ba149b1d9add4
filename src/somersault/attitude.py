"""Somersault, tilt and twist; quaternions; direction cosines.

Attitude is the 2-1-3 sequence of Playter (1994), eq. 2.2: somersault Φ about the inertial 2
axis, then tilt Θ about the carried 1 axis, then twist Ψ about the body's 3 axis. `C_bi`
takes inertial components to body components. Quaternions are scalar first and turn body
components into inertial ones, so `matrix_from_quaternion(q)` is `C_bi` transposed.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from somersault._array import Array


def matrix_from_quaternion(quaternion: ArrayLike) -> Array:
    """Rotation matrix (…, 3, 3) of unit quaternions (…, 4)."""
    w, x, y, z = np.moveaxis(np.asarray(quaternion, float), -1, 0)
    return np.stack(
        [
            np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], -1),
            np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], -1),
            np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], -1),
        ],
        -2,
    )
