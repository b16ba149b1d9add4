"""The momentum sphere: a map of rigid body rotation (section 2.5, figures 2-7 and 2-8).

Points are the direction cosines of the angular momentum in body axes. A body moves so that
the point stays on a curve of constant energy.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats, number, together
from somersault.rigid._euler import energy_bounds
from somersault.rigid._inertia import checked_inertias

_MOST = 10_000_000  # points of a curve
_ROUNDING = 1e-12  # by how much, relatively, an energy may miss its bounds


def energy_curve(
    inertias: ArrayLike, energy: float, points: int = 361, momentum: float = 1.0
) -> Array:
    """Both closed pieces of the curve of one energy on the momentum sphere.

    The first piece is on the positive side of the axis it goes round: the minor one above the
    energy of the separatrix, the major one below. Each ends where it starts. On the separatrix the
    pieces meet on the middle axis with corners; `separatrix` has them as the two circles they are.
    At the least and the greatest energy each piece is one point, repeated.

    Parameters
    ----------
    inertias : array_like, shape (3,)
        Principal inertias, kg m².
    energy : float
        Of rotation, J: within `energy_bounds`.
    points : int
        How many points each piece has.
    momentum : float
        Magnitude of the angular momentum, kg m²/s.

    Returns
    -------
    numpy.ndarray, shape (2, points, 3)
        Direction cosines of the angular momentum in the principal axes.

    Raises
    ------
    SomersaultError
        For an energy that the momentum does not allow, and for a spherical body, which has one
        energy everywhere.

    Examples
    --------
    >>> from somersault.rigid import energy_curve
    >>> energy_curve([4.0, 2.5, 2.0], 0.22, points=5)[0].round(2).tolist()[0]
    [0.49, 0.0, 0.87]
    """
    i = checked_inertias(inertias)
    least, middle, greatest = energy_bounds(i, momentum)
    energy, points = number("energy", energy), whole_number("points", points, 1, _MOST)
    _not_spherical(i)
    if not least * (1 - _ROUNDING) <= energy <= greatest * (1 + _ROUNDING):
        raise SomersaultError(
            f"With this angular momentum the energy lies between {least:g} and {greatest:g} J, "
            f"so {energy:g} J has no curve."
        )
    order = np.argsort(i, kind="stable")
    minor, b, major = (int(p) for p in order)
    above = energy > middle or (energy == middle and i[b] > i[minor])
    a, c = (major, minor) if above else (minor, major)
    # Σ c²/I = 2T/h² and Σ c² = 1, solved for c_a and c_b at c_b = 0 and c_a = 0
    target = 2 * energy / momentum**2
    reach_a = np.clip((1 / i[c] - target) / (1 / i[c] - 1 / i[a]), 0, 1)
    reach_b = np.clip((1 / i[c] - target) / (1 / i[c] - 1 / i[b]), 0, 1)
    phase = np.linspace(0, 2 * np.pi, points)
    curve = np.empty((2, points, 3))
    curve[..., a] = np.sqrt(reach_a) * np.cos(phase)
    curve[..., b] = np.sqrt(reach_b) * np.sin(phase)
    rest = 1 - curve[..., a] ** 2 - curve[..., b] ** 2
    curve[..., c] = np.sqrt(np.maximum(rest, 0)) * np.array([[1.0], [-1.0]])
    return curve


def separatrix(inertias: ArrayLike, points: int = 361) -> Array:
    """The two great circles of the separatrix on the momentum sphere.

    They cross on the middle axis, in planes at ±δ from the minor axis towards the major one,
    tan² δ = (1/I_min − 1/I_mid)/(1/I_mid − 1/I_max). For a symmetric body they are one circle, its
    equator.

    Parameters
    ----------
    inertias : array_like, shape (3,)
        Principal inertias, kg m².
    points : int
        How many points each circle has.

    Returns
    -------
    numpy.ndarray, shape (2, points, 3)
        Direction cosines of the angular momentum in the principal axes; each circle starts and ends
        at the middle axis.

    Raises
    ------
    SomersaultError
        For a spherical body, which has no separatrix.

    Examples
    --------
    >>> from somersault.rigid import separatrix
    >>> separatrix([3.0, 2.0, 1.0], points=5)[0, 0].tolist()
    [0.0, 1.0, 0.0]
    """
    i = checked_inertias(inertias)
    _not_spherical(i)
    points = whole_number("points", points, 1, _MOST)
    minor, b, major = (int(p) for p in np.argsort(i, kind="stable"))
    delta = np.arctan2(np.sqrt(1 / i[minor] - 1 / i[b]), np.sqrt(1 / i[b] - 1 / i[major]))
    phase = np.linspace(0, 2 * np.pi, points)
    curve = np.empty((2, points, 3))
    curve[..., b] = np.cos(phase)
    curve[..., minor] = np.cos(delta) * np.sin(phase)
    curve[..., major] = np.sin(delta) * np.sin(phase) * np.array([[1.0], [-1.0]])
    return curve


def tilt_and_twist(cosines: ArrayLike) -> tuple[Array, Array]:
    """Tilt and twist of points on the momentum sphere (Playter 1994, A.20 and A.21, signs mended).

    Tilt is minus the latitude above the 1-2 plane; twist is minus the longitude, counted
    from axis 2 and positive about axis 3 (figure 2-8).

    Parameters
    ----------
    cosines : array_like, shape (..., 3)
        Direction of the angular momentum in body axes, of any length.

    Returns
    -------
    tilt, twist : numpy.ndarray, shape (...)
        rad: Θ in [−π/2, π/2], Ψ in (−π, π].

    Examples
    --------
    >>> from somersault.rigid import tilt_and_twist
    >>> tilt, twist = tilt_and_twist([0.0, 1.0, -1.0])
    >>> print(f"{tilt:.4f} {twist:.4f}")
    0.7854 0.0000
    """
    c1, c2, c3 = np.moveaxis(floats("cosines", cosines, 3), -1, 0)
    return np.arctan2(-c3, np.hypot(c1, c2)), np.arctan2(c1, c2)


def momentum_direction(tilt: ArrayLike, twist: ArrayLike) -> Array:
    """Direction in body axes of an angular momentum along inertial axis 2.

    It is the second column of C_bi (Playter 1994, eq. 2.2), and the inverse of `tilt_and_twist`.

    Parameters
    ----------
    tilt, twist : array_like
        rad, which broadcast.

    Returns
    -------
    numpy.ndarray, shape (..., 3)
        Direction cosines.

    Examples
    --------
    >>> import numpy as np
    >>> from somersault.rigid import momentum_direction
    >>> momentum_direction(0.0, np.pi / 2).round(3).tolist()
    [1.0, 0.0, -0.0]
    """
    t, w = together(tilt=tilt, twist=twist)
    return np.stack([np.sin(w) * np.cos(t), np.cos(w) * np.cos(t), -np.sin(t)], -1)


def _not_spherical(inertias: Array) -> None:
    if inertias.min() == inertias.max():
        raise SomersaultError(
            "A body with three equal inertias has the same energy about every axis, so there is "
            "no map to draw; give inertias that differ."
        )
