"""The closed curve that angular momentum draws in a body that tumbles (A.4), in any axis order.

The curve goes round one principal axis, `c`: the minor one above the separatrix's energy, the
major one below it. `a` is the axis at the other end and `b` the middle one. Then

    ω_a = ±ω_am cn u,   ω_b = ±ω_bm sn u,   ω_c = ±ω_cm dn u,   u = u0 + C t,

which is A.8–A.12 for c = 1 and A.13–A.17 for c = 3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from somersault._core.array import Array
from somersault.rigid._euler import excess_energy
from somersault.rigid._jacobi import Elliptic, elliptic, first_kind, quarter_period


@dataclass(frozen=True, eq=False)
class Orbit:
    """ω against time in elliptic functions, with the squared direction cosines it reaches."""

    axes: tuple[int, int, int]
    """a, b and c as places 0, 1, 2."""
    greatest: Array
    """±ω_am, ±ω_bm, ±ω_cm in the order of the body's axes (3,), rad/s: A.3 to A.7."""
    reach: Array
    """Squares of the greatest direction cosines of h, in the body's order (3,)."""
    rate: float
    """C = du/dt, 1/s: A.11 and A.16."""
    kc: float
    """Complementary modulus, √(1 − k²) of A.12 and A.17; 0 on the separatrix."""
    start: float
    """u0."""
    excess: tuple[float, float, float]
    """(2T I − h²) of the three axes, relative to h², in the body's order."""

    @cached_property
    def quarter(self) -> float:
        """K, a quarter of the orbit in u; infinite on the separatrix."""
        return quarter_period(self.kc)

    def elliptic(self, t: Array) -> Elliptic:
        """sn, cn, dn at times t (…), s."""
        return elliptic(self.start + self.rate * t, self.kc)

    def omega(self, at: Elliptic) -> Array:
        """ω (…, 3), rad/s, on the half orbit that is counted from −K to K."""
        a, b, c = self.axes
        values = np.empty((*np.shape(at.v), 3))
        for place, function in ((a, at.cn), (b, at.sn), (c, at.dn)):
            values[..., place] = self.greatest[place] * function
        return values

    def flips(self, at: Elliptic) -> Array:
        """Signs (…, 3) that turn values of that half orbit into those at `at`."""
        sign = np.where(at.turns % 2 == 1, -1.0, 1.0)
        signs = np.empty((*np.shape(sign), 3))
        signs[...] = sign[..., None]
        signs[..., self.axes[2]] = 1.0
        return signs


def orbit(inertias: Array, omega: Array) -> Orbit | None:
    """The orbit through ω (3,), or None where ω does not change: h along a principal axis.

    The invariants are differences that nearly cancel near the separatrix, near the pure spins
    and for nearly symmetric bodies. They are taken over fractions, and only then rounded.
    """
    i = [Fraction(x) for x in inertias.tolist()]
    w = [Fraction(x) for x in omega.tolist()]
    if all((i[p] - i[q]) * w[p] * w[q] == 0 for p, q in ((0, 1), (1, 2), (2, 0))):
        return None
    minor, b, major = (int(p) for p in np.argsort(inertias, kind="stable"))
    above, squared = excess_energy(inertias, omega)
    a, c = (major, minor) if above >= 0 else (minor, major)
    span, ab, bc = abs(i[a] - i[c]), abs(i[a] - i[b]), abs(i[b] - i[c])
    x = abs(above)
    y = i[b] * ab * w[b] ** 2 + i[c] * span * w[c] ** 2  # |2T I_a − h²|
    z = i[a] * span * w[a] ** 2 + i[b] * bc * w[b] ** 2  # |2T I_c − h²|
    sign_a, sign_c = math.copysign(1, omega[a]), math.copysign(1, omega[c])
    even = (b - a) % 3 == 1
    # A.8–A.15 ask for s1 s2 s3 = −1 with I1 > I2 > I3; this is that in any order of axes
    sign_b = -sign_a * sign_c * (1 if even == (i[a] > i[c]) else -1)
    greatest = np.empty(3)
    greatest[a] = sign_a * _root(z / (i[a] * span))
    greatest[b] = sign_b * _root(z / (i[b] * bc))
    greatest[c] = sign_c * _root(y / (i[c] * span))
    if not greatest.all():  # so near a principal axis that the numbers end
        return None
    reach = np.empty(3)
    reach[a] = float(i[a] * z / (span * squared))
    reach[b] = float(i[b] * z / (bc * squared))
    reach[c] = float(i[c] * y / (span * squared))
    kc = _root(x * span / (y * bc))
    sn, cn, dn = (min(1.0, abs(float(omega[p] / greatest[p]))) for p in (b, a, c))
    if kc == cn == 0:
        return None
    start = math.asinh(sn / cn) if kc == 0 else first_kind(sn, cn, dn)
    sign = 1 if above >= 0 else -1
    excess = [0.0, 0.0, 0.0]
    excess[a], excess[b], excess[c] = (
        sign * float(value / squared) for value in (y, x, -z)
    )  # 2T I − h² is positive for the inertias above h²/2T
    return Orbit(
        (a, b, c),
        greatest,
        reach,
        _root(y * bc / (i[a] * i[b] * i[c])),
        kc,
        math.copysign(start, omega[b] * sign_b),
        (excess[0], excess[1], excess[2]),
    )


def _root(value: Fraction) -> float:
    """Square root, scaled so that the fraction itself may lie beyond what a float can hold."""
    half = (value.numerator.bit_length() - value.denominator.bit_length()) // 2
    return math.ldexp(math.sqrt(value / Fraction(4) ** half), half)
