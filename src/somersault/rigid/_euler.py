"""Euler's equations, the energies a momentum allows, and the two kinds of motion (2.2, 2.5)."""

from __future__ import annotations

from fractions import Fraction
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats, number, require_together
from somersault.rigid._inertia import checked_inertias

Kind = Literal["minor", "major", "separatrix"]


def euler_rates(inertias: ArrayLike, omega: ArrayLike) -> Array:
    """Angular acceleration of a free rigid body: Euler's equations (Playter 1994, eq. 2.1).

    Parameters
    ----------
    inertias : array_like, shape (..., 3)
        Principal inertias, kg m².
    omega : array_like, shape (..., 3)
        Angular velocity in the principal axes, rad/s.

    Returns
    -------
    numpy.ndarray, shape (..., 3)
        ω̇ in the same axes, rad/s².

    Examples
    --------
    >>> from somersault.rigid import euler_rates
    >>> euler_rates([3.0, 2.0, 1.0], [0.1, 5.0, 0.2]).round(3).tolist()
    [0.333, -0.02, 0.5]
    """
    i, w = floats("inertias", inertias, 3), floats("omega", omega, 3)
    require_together({"inertias": i.shape, "omega": w.shape})
    return np.cross(i * w, w) / i


def energy_bounds(inertias: ArrayLike, momentum: float) -> tuple[float, float, float]:
    """Least, separatrix and greatest energy of rotation that an angular momentum allows.

    They are h²/2I of the spins about the major, middle and minor axes (Playter 1994, section 2.5).

    Parameters
    ----------
    inertias : array_like, shape (3,)
        Principal inertias in any order, kg m².
    momentum : float
        Magnitude h of the angular momentum, kg m²/s.

    Returns
    -------
    least, separatrix, greatest : float
        J.

    Raises
    ------
    SomersaultError
        For inertias that no body has or a momentum that is not positive.

    Examples
    --------
    >>> from somersault.rigid import energy_bounds
    >>> energy_bounds([4.0, 2.5, 2.0], 2.0)
    (0.5, 0.8, 1.0)
    """
    checked = np.sort(checked_inertias(inertias))
    if not number("momentum", momentum) > 0:
        raise SomersaultError(
            f"The angular momentum must be positive, not {momentum}; give its magnitude."
        )
    minor, middle, major = (float(momentum**2 / (2 * i)) for i in checked)
    return major, middle, minor


def kind_of_motion(inertias: ArrayLike, omega: ArrayLike, tolerance: float = 0.0) -> Kind:
    """Which principal axis the angular momentum circles, as seen from the body.

    Where axis 3 is the axis circled, twist is monotonic, elsewhere it oscillates (Playter 1994,
    section 2.5). Spins about the middle axis and about the equator of a symmetric body are on the
    separatrix; so is everything that a spherical body does. The comparison is made without
    rounding.

    Parameters
    ----------
    inertias : array_like, shape (3,)
        Principal inertias in any order, kg m².
    omega : array_like, shape (3,)
        Angular velocity in the principal axes, rad/s.
    tolerance : float
        How far T and h²/2I_mid may be apart, relatively, to count as equal.

    Returns
    -------
    {"minor", "major", "separatrix"}
        "minor" for T > h²/2I_mid, "major" for T < h²/2I_mid.

    Raises
    ------
    SomersaultError
        For inertias that no body has or an angular velocity that is zero or not finite.

    Examples
    --------
    >>> from somersault.rigid import kind_of_motion
    >>> kind_of_motion([11.0, 10.5, 0.8], [0.1, 1.0, 5.0])
    'minor'
    """
    checked, rates = checked_inertias(inertias), checked_omega(omega)
    excess, squared = excess_energy(checked, rates)
    if abs(excess) <= Fraction(number("tolerance", tolerance)) * squared:
        return "separatrix"
    return "minor" if excess > 0 else "major"


def excess_energy(inertias: Array, omega: Array) -> tuple[Fraction, Fraction]:
    """2T I_mid − h² and h², exactly.

    Numbers of the machine are fractions; near the separatrix, where the two terms cancel,
    rounding them would move the time of the next half twist.
    """
    i = [Fraction(x) for x in inertias.tolist()]
    w = [Fraction(x) for x in omega.tolist()]
    squared = sum((a * b) ** 2 for a, b in zip(i, w, strict=True)) + Fraction(0)
    twice = sum(a * b * b for a, b in zip(i, w, strict=True)) + Fraction(0)
    return twice * sorted(i)[1] - squared, squared


def checked_omega(omega: ArrayLike) -> Array:
    """An angular velocity (3,), rad/s, that is finite and not zero; else `SomersaultError`."""
    rates = floats("omega", omega)
    if rates.shape != (3,) or not np.all(np.isfinite(rates)):
        raise SomersaultError(
            f"The angular velocity must be three finite numbers in rad/s, not {shown(omega)}."
        )
    if not rates.any():
        raise SomersaultError(
            "A body without angular momentum does not turn; give an angular velocity that is not "
            "zero."
        )
    return rates
