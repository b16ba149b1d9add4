"""A rigid body's small deviations from steady somersaulting (sections 2.3 and 2.3.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.numbers import together
from somersault.rigid._inertia import inertia_ratios


def gyric_matrices(I1: ArrayLike, I2: ArrayLike, I3: ArrayLike) -> tuple[Array, Array, Array]:
    """M, G and K of M ẍ + Φ̇ G ẋ + Φ̇² K x = 0 over x = (θ, ψ) (Playter 1994, eq. 2.11).

    θ and ψ are the small tilt and twist of a body that somersaults about its axis 2 at the
    rate Φ̇, ω = (θ̇ + Φ̇ ψ, Φ̇ + φ̇, ψ̇ − Φ̇ θ) of eq. 2.8 put into eq. 2.1. M is symmetric and
    positive, G antisymmetric, K symmetric: a conservative gyric system.

    Parameters
    ----------
    I1, I2, I3 : array_like
        Principal inertias, kg m², which broadcast.

    Returns
    -------
    M, G, K : numpy.ndarray, shape (..., 2, 2)
        kg m².

    Raises
    ------
    SomersaultError
        Where an inertia is not positive.

    Examples
    --------
    >>> from somersault.rigid import gyric_matrices
    >>> mass, gyric, stiffness = gyric_matrices(3.0, 2.0, 1.5)
    >>> gyric.tolist()
    [[0.0, 2.5], [-2.5, 0.0]]
    """
    inertia_ratios(I1, I2, I3)
    one, two, three = together(I1=I1, I2=I2, I3=I3)
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
    """The four roots s/Φ̇ of a rigid spin, ±j and ±√(−k1 k3) (Playter 1994, eq. 2.12).

    ±j is the stroboscopic mode: a steady spin about an axis that points elsewhere. Of the
    other two one grows, as in eq. 2.13, where k1 k3 < 0; where k1 k3 > 0 they are ±jν/Φ̇
    with ν of section 2.3.2 (which prints ±ν).

    Parameters
    ----------
    k1, k3 : array_like
        Inertia ratios, which broadcast.

    Returns
    -------
    numpy.ndarray, shape (..., 4)
        Complex, in units of the spin rate.

    Examples
    --------
    >>> from somersault.rigid import gyric_roots
    >>> gyric_roots(0.5, -0.5).real.tolist()
    [0.0, -0.0, 0.5, -0.5]
    """
    a, b = together(k1=k1, k3=k3)
    product = a * b
    mode = np.sqrt(-product.astype(complex))
    steady = np.full_like(mode, 1j)
    return np.stack([steady, -steady, mode, -mode], -1)
