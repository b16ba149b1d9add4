"""Jacobi's elliptic functions and the integral of the third kind, from the complementary modulus.

Everything is a function of k′ = √(1 − k²), which near the separatrix is what is known to all its
digits: 1 − k′² is not.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from somersault._core.array import Array

_CONVERGED = 1e-8  # of the arithmetic–geometric mean; one more step squares it
_HYPERBOLIC = 1e-9  # k′ (or cn + dn) whose square is lost when added to 1
_SMALL = 1e-100  # below it sn u = u and squares of cotangents would overflow


class Elliptic(NamedTuple):
    """sn, cn and dn of v = u − 2K·turns, which lies in [−K, K], where cn ≥ 0.

    sn u and cn u are those of v times (−1)^turns, dn u is that of v. All are good to a
    relative rounding error, however small cn and dn are.
    """

    v: Array
    turns: Array
    sn: Array
    cn: Array
    dn: Array


def quarter_period(kc: float) -> float:
    """K for a complementary modulus k′ in [0, 1]: infinite for k′ = 0."""
    if kc == 0:
        return math.inf
    a, b = 1.0, kc
    while abs(a - b) > _CONVERGED * a:
        a, b = (a + b) / 2, math.sqrt(a * b)
    return math.pi / (a + b)


def elliptic(u: Array, kc: float) -> Elliptic:
    """Jacobi's functions of arguments u (…), for a complementary modulus k′ in [0, 1]."""
    if kc == 0:
        sech = 1 / np.cosh(np.minimum(np.abs(u), 700.0))
        return Elliptic(u, np.zeros_like(u), np.tanh(u), sech, sech)
    quarter = quarter_period(kc)
    turns = np.round(u / (2 * quarter))
    v = np.clip(u - 2 * quarter * turns, -quarter, quarter)
    size = np.abs(v)
    far = size > quarter / 2  # there, from the other end: sn(K − x) = cn x/dn x and so on
    sn, cn, dn = _first_half(np.where(far, quarter - size, size), kc)
    high = np.where(far, cn / dn, sn)
    cn, dn = np.where(far, kc * sn / dn, cn), np.where(far, kc / dn, dn)
    return Elliptic(v, turns, np.copysign(high, v), cn, dn)


def _first_half(x: Array, kc: float) -> tuple[Array, Array, Array]:
    """sn, cn, dn for 0 ≤ x ≤ K/2: descending Landen steps on cotangents (Bulirsch 1965)."""
    means = []
    a, b = 1.0, kc
    while True:
        means.append((a, b))
        c = (a + b) / 2
        if abs(a - b) <= _CONVERGED * a:
            break
        a, b = c, math.sqrt(a * b)
    tiny = x < _SMALL
    phase = c * np.where(tiny, 1.0, x)
    cot = np.cos(phase) / np.sin(phase)
    scaled = c * cot
    dn = np.ones_like(x)
    for a, b in reversed(means):
        product = cot * scaled
        scaled = scaled * dn
        dn = (b + product) / (a + product)
        cot = scaled / a
    sn = 1 / np.hypot(1.0, scaled)
    return np.where(tiny, x, sn), np.where(tiny, 1.0, scaled * sn), np.where(tiny, 1.0, dn)


def first_kind(sn: float, cn: float, dn: float) -> float:
    """u in [−K, K] at which the functions have these values (cn ≥ 0), by Carlson's R_F."""
    from scipy.special import elliprf  # here, so that a verdict on stability loads no scipy

    if cn + dn < _HYPERBOLIC:
        return math.copysign(math.log(4) - math.log(cn + dn), sn)
    return float(sn * elliprf(cn * cn, dn * dn, 1.0))


def third_kind(at: Elliptic, n: float, kc: float) -> Array:
    """∫ n sn²/(1 + n sn²) du from 0 to u, which is u − Π, for n ≥ 0 (A.4), by Carlson's R_J."""
    from scipy.special import elliprj

    if kc < _HYPERBOLIC:
        part = _hyperbolic(at.v, at.sn, n)
    else:
        part = n / 3 * at.sn**3 * elliprj(at.cn**2, at.dn**2, 1.0, 1 + n * at.sn**2)
    if not np.any(at.turns):
        return part
    return part + 2 * at.turns * complete_third_kind(n, kc)


def complete_third_kind(n: float, kc: float) -> float:
    """K − Π(n): the integral of `third_kind` up to K, for k′ > 0."""
    from scipy.special import elliprj

    if kc < _HYPERBOLIC:
        return float(_hyperbolic(quarter_period(kc), 1.0, n))
    return float(n / 3 * elliprj(0.0, kc * kc, 1.0, 1 + n))


def _hyperbolic(v: Array | float, sn: Array | float, n: float) -> Array:
    """`third_kind` to within k′²: n sn²/(1 + n sn²) is n/(1 + n) (1 − cn²/(1 + n sn²))."""
    root = math.sqrt(n)
    return (n * np.asarray(v) - root * np.arctan(root * np.asarray(sn))) / (1 + n)
