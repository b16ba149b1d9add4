"""Sine, cosine, arc tangent and logarithm on vectors, from additions and multiplications.

Sine and cosine are the fdlibm polynomials after a three-part reduction by π/2 (good to 1 ulp for
|x| < 10⁵), as is the logarithm; the arc tangent is the Cephes rational approximation.
"""

from __future__ import annotations

from somersault.engine._vectors import Vectors, number

_TWO_OVER_PI = 0.6366197723675814
_HALF_PI_PARTS = (1.57079632673412561417e00, 6.07710050630396597660e-11, 2.02226624879595063154e-21)
_ROUNDER = 6755399441055744.0  # 1.5 · 2⁵²: adding it leaves the nearest integer in the low bits
_SINE = (
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
)
_COSINE = (
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
)
_ATAN_P = (
    -6.485021904942025371773e1,
    -1.228866684490136173410e2,
    -7.500855792314704667340e1,
    -1.615753718733365076637e1,
    -8.750608600031904122785e-1,
)
_ATAN_Q = (
    1.945506571482613964425e2,
    4.853903996359136964868e2,
    4.328810604912902668951e2,
    1.650270098316988542046e2,
    2.485846490142306297962e1,
    1.0,
)
_LOGARITHM = (
    6.666666666666735130e-01,
    3.999999999940941908e-01,
    2.857142874366239149e-01,
    2.222219843214978396e-01,
    1.818357216161805012e-01,
    1.531383769920937332e-01,
    1.479819860511658591e-01,
)
_LN_2_PARTS = (6.93147180369123816490e-01, 1.90821492927058770002e-10)
_TAN_EIGHTH = 0.41421356237309503  # tan(π/8)


def sine_cosine(v: Vectors, x: str) -> tuple[str, str]:
    """sin x and cos x, which share the reduction of x to within π/4 of a multiple of π/2."""
    shifted = v.multiply_add(x, number(_TWO_OVER_PI), number(_ROUNDER))
    quarter = v.bits(shifted)
    turns = v.sub(shifted, number(_ROUNDER))
    r = x
    for part in _HALF_PI_PARTS:
        r = v.multiply_add(turns, number(-part), r)
    z = v.mul(r, r)
    sine = v.multiply_add(v.mul(z, r), v.polynomial(z, _SINE), r)
    half = v.multiply_add(z, number(-0.5), number(1.0))
    cosine = v.multiply_add(v.mul(z, z), v.polynomial(z, _COSINE), half)
    odd = v.odd(quarter)
    s = _signed(v, v.where(odd, cosine, sine), quarter)
    c = _signed(v, v.where(odd, sine, cosine), v.integers("add", quarter, 1))
    return s, c


def _signed(v: Vectors, value: str, quarter: str) -> str:
    """`value`, negated in the lanes where bit 1 of `quarter` is set."""
    sign = v.integers("shl", v.integers("and", quarter, 2), 62)
    return v.of_bits(v.integers("xor", v.bits(value), sign))


def arc_tangent(v: Vectors, y: str, x: str) -> str:
    """atan2(|y|, x) with the sign of y; 0 at the origin."""
    length = v.size(y)
    steep = v.test("ogt", length, v.size(x))
    top = v.where(steep, v.negative(x), length)
    bottom = v.where(steep, length, x)
    nowhere = v.test("oeq", bottom, number(0.0))
    bottom = v.where(nowhere, number(1.0), bottom)
    # |top / bottom| ≤ 1 here; above tan(π/8) turn by π/4 once more.
    t = v.div(top, bottom)
    size = v.size(t)
    wide = v.test("ogt", size, number(_TAN_EIGHTH))
    turned = v.div(v.sub(size, number(1.0)), v.add(size, number(1.0)))
    u = v.where(wide, turned, size)
    z = v.mul(u, u)
    p, q = v.polynomial(z, _ATAN_P), v.polynomial(z, _ATAN_Q)
    ratio = v.div(v.mul(z, p), q)
    angle = v.multiply_add(u, ratio, u)
    quarter = v.where(wide, number(0.7853981633974483), number(0.0))
    angle = v.add(angle, quarter)
    negative = v.test("olt", t, number(0.0))
    angle = v.where(negative, v.negative(angle), angle)
    behind = v.test("olt", x, number(0.0))
    flat = v.where(behind, number(3.141592653589793), number(0.0))
    offset = v.where(steep, number(1.5707963267948966), flat)
    return v.with_sign(v.add(angle, offset), y)


def logarithm(v: Vectors, x: str) -> str:
    """ln x of a normal number above 0; not a number of others."""
    bits = v.bits(x)
    one = 0x3FF << 52
    fraction = v.of_bits(v.integers("or", v.integers("and", bits, 2**52 - 1), one))
    power = v.whole(v.integers("sub", v.integers("lshr", bits, 52), 1023))
    wide = v.test("ogt", fraction, number(1.4142135623730951))
    fraction = v.where(wide, v.mul(fraction, number(0.5)), fraction)
    power = v.where(wide, v.add(power, number(1.0)), power)
    f = v.sub(fraction, number(1.0))
    s = v.div(f, v.add(f, number(2.0)))
    z = v.mul(s, s)
    half = v.mul(number(0.5), v.mul(f, f))
    series = v.mul(z, v.polynomial(z, _LOGARITHM))
    high, low = (v.mul(power, number(part)) for part in _LN_2_PARTS)
    small = v.sub(v.sub(half, v.multiply_add(s, v.add(half, series), low)), f)
    positive = v.test("ogt", x, number(0.0))
    return v.where(positive, v.sub(high, small), number(float("nan")))
