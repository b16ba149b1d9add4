"""A rigid body's small deviations from steady somersaulting (sections 2.3 and 2.3.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault.rigid._inertia import inertia_ratios


def gyric_matrices(I1: ArrayLike, I2: ArrayLike, I3: ArrayLike) -> tuple[Array, Array, Array]:
    """M, G and K (…, 2, 2), kg m², over (θ, ψ): M ẍ + Φ̇ G ẋ + Φ̇² K x = 0, eq. 2.11.

    θ and ψ are the small tilt and twist of a body that somersaults about its axis 2 at the
    rate Φ̇, ω = (θ̇ + Φ̇ ψ, Φ̇ + φ̇, ψ̇ − Φ̇ θ) of eq. 2.8 put into eq. 2.1. M is symmetric and
    positive, G antisymmetric, K symmetric: a conservative gyric system.

    Raises `SomersaultError` where an inertia is not positive.
    """
    inertia_ratios(I1, I2, I3)
    one, two, three = np.broadcast_arrays(*(np.asarray(i, float) for i in (I1, I2, I3)))
    nil = np.zeros_like(one)
    gyric = two - three - one
    entries = (
        ((one, nil), (nil, three)),
        ((nil, -gyric), (gyric, nil)),
        ((two - three, nil), (nil, two - one)),
    )
    m, g, k = (np.stack([np.stack(row, -1) for row in rows], -2) for rows in entries)
    return m, g, k


def gyric_roots(k1: ArrayLike, k3: ArrayLike) -> Array:
    """The four roots s/Φ̇ (…, 4), complex, of eq. 2.12: ±j and ±√(−k1 k3).

    ±j is the stroboscopic mode: a steady spin about an axis that points elsewhere. Of the
    other two one grows, as in eq. 2.13, where k1 k3 < 0; where k1 k3 > 0 they are ±jν/Φ̇
    with ν of section 2.3.2 (which prints ±ν).
    """
    product = np.asarray(k1, float) * np.asarray(k3, float)
    mode = np.sqrt(-product.astype(complex))
    steady = np.full_like(mode, 1j)
    return np.stack([steady, -steady, mode, -mode], -1)
