"""Inertia ratios k1 and k3, and what they say of a spin about axis 2 (section 2.3.2)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats, number, together

_FLAT = 1e-9  # by how much, relatively, rounding may break the triangle inequality of a flat body


def checked_inertias(inertias: ArrayLike) -> Array:
    """Three principal inertias (3,) that a body can have, kg m².

    Raises `SomersaultError` unless they are positive and finite and none exceeds the sum of
    the other two (which a flat body reaches).
    """
    values = floats("inertias", inertias)
    if values.shape != (3,):
        raise SomersaultError(
            f"A rigid body has three principal inertias, not an array of shape {values.shape}; "
            "give (I1, I2, I3)."
        )
    if not np.all(np.isfinite(values) & (values > 0)):
        raise SomersaultError(
            f"Principal inertias must be positive and finite, not {_listed(values)}; "
            "give them in kg m²."
        )
    if 2 * values.max() > values.sum() * (1 + _FLAT):
        raise SomersaultError(
            f"No body has principal inertias {_listed(values)}, because none may exceed the sum "
            "of the other two; check their units and order."
        )
    return values


def inertia_ratios(I1: ArrayLike, I2: ArrayLike, I3: ArrayLike) -> tuple[Array, Array]:
    """Inertia ratios k1 = (I2 − I3)/I1 and k3 = (I2 − I1)/I3 (Playter 1994, section 2.3.2).

    Parameters
    ----------
    I1, I2, I3 : array_like
        Principal inertias, kg m², which broadcast; the spin is about axis 2.

    Returns
    -------
    k1, k3 : numpy.ndarray
        Of the shape to which the inertias broadcast, without dimension.

    Raises
    ------
    SomersaultError
        Where an inertia is not positive.

    Examples
    --------
    >>> from somersault.rigid import inertia_ratios
    >>> k1, k3 = inertia_ratios(11.0, 10.5, 0.8)
    >>> print(f"{k1:.3f} {k3:.3f}")
    0.882 -0.625
    """
    one, two, three = together(I1=I1, I2=I2, I3=I3)
    if not np.all((one > 0) & (two > 0) & (three > 0)):
        raise SomersaultError("Principal inertias must be positive; give them in kg m².")
    return (two - three) / one, (two - one) / three


def inertias_from_ratios(k1: ArrayLike, k3: ArrayLike) -> Array:
    """The inertias that have given ratios, over I2: the inverse of `inertia_ratios`.

    Parameters
    ----------
    k1, k3 : array_like
        Inertia ratios, which broadcast.

    Returns
    -------
    numpy.ndarray, shape (..., 3)
        (I1, I2, I3)/I2.

    Raises
    ------
    SomersaultError
        Outside −1 < k < 1, where there is no body (one of the ratios may be ±1: a flat body or a
        needle).

    Examples
    --------
    >>> from somersault.rigid import inertias_from_ratios
    >>> inertias_from_ratios(0.5, -0.5).tolist()
    [1.2, 1.0, 0.4]
    """
    a, b = together(k1=k1, k3=k3)
    if not np.all((np.abs(a) <= 1) & (np.abs(b) <= 1) & (a * b < 1) & (a < 1) & (b < 1)):
        raise SomersaultError("Inertia ratios k1 and k3 lie between −1 and 1; give such a pair.")
    return np.stack([(1 - b) / (1 - a * b), np.ones_like(a), (1 - a) / (1 - a * b)], -1)


def quadrant(k1: ArrayLike, k3: ArrayLike) -> Array:
    """Quadrant of the inertia ratio diagram (Playter 1994, figure 2-2).

    In quadrant 1 I2 is the largest inertia and the spin statically stable; in 3 it is the smallest
    and the spin gyrically stable. In 2 (I1 < I2 < I3) and 4 (I3 < I2 < I1, the layout) the spin is
    about the middle axis and unstable.

    Parameters
    ----------
    k1, k3 : array_like
        Inertia ratios, which broadcast.

    Returns
    -------
    numpy.ndarray of int
        1 to 4, and 0 on the axes of the diagram.

    Examples
    --------
    >>> from somersault.rigid import quadrant
    >>> quadrant([0.7, 0.7], [0.5, -0.9]).tolist()
    [1, 4]
    """
    a, b = (np.sign(k) for k in together(k1=k1, k3=k3))
    inside = np.where(b > 0, np.where(a > 0, 1, 2), np.where(a > 0, 4, 3))
    return np.where(a * b == 0, 0, inside)


def growth_angle(k1: ArrayLike, k3: ArrayLike, N: float = 10.0) -> Array:
    """Somersault angle in which the unstable mode grows by a factor (Playter 1994, eq. 2.14).

    Parameters
    ----------
    k1, k3 : array_like
        Inertia ratios, which broadcast.
    N : float
        The factor, above 1.

    Returns
    -------
    numpy.ndarray
        rad; infinite where k1 k3 ≥ 0, because no mode grows exponentially there.

    Raises
    ------
    SomersaultError
        Unless N > 1.

    Examples
    --------
    >>> from somersault.rigid import growth_angle
    >>> round(float(growth_angle(0.687, -0.876)), 2)
    2.97
    """
    if not number("N", N) > 1:
        raise SomersaultError(f"A mode that grows has a factor N above 1, not {N}.")
    a, b = together(k1=k1, k3=k3)
    product = -a * b
    with np.errstate(divide="ignore"):
        return np.log(N) / np.sqrt(np.maximum(product, 0.0))


def _listed(values: Array) -> str:
    return ", ".join(f"{value:g}" for value in values)
