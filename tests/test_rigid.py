"""One rigid body: inertia ratios, gyric form, energies, the map; the formulas of A.4 as printed."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import ellipj, ellipk

from somersault import attitude, rigid
from somersault._core.errors import SomersaultError
from somersault.rigid import RigidMotion
from somersault.rigid._jacobi import elliptic, first_kind, quarter_period, third_kind

many = settings(derandomize=True, max_examples=100, deadline=None)
inertias = st.tuples(*[st.floats(0.02, 1.0)] * 3).map(lambda m: sum(m) - np.array(m))
distinct = inertias.filter(
    lambda i: np.ptp(np.sort(i)[:2]) > 0.01 and np.ptp(np.sort(i)[1:]) > 0.01
)
LAYOUT = (12.0, 11.2, 0.9)
"""About tilt, somersault and twist axis, kg m²: near a human's."""


@many
@given(inertias)
def test_ratios_come_back_and_stay_in_the_unit_square(i: np.ndarray) -> None:
    k1, k3 = rigid.inertia_ratios(*i)
    assert -1 < k1 < 1
    assert -1 < k3 < 1
    np.testing.assert_allclose(rigid.inertias_from_ratios(k1, k3), i / i[1], rtol=1e-11)


@many
@given(distinct)
def test_the_quadrant_is_the_rank_of_the_second_inertia(i: np.ndarray) -> None:
    k = rigid.inertia_ratios(*i)
    quadrant, rank = rigid.quadrant(*k), np.argsort(np.argsort(i))[1]
    assert quadrant == {2: 1, 0: 3, 1: 4 if i[0] > i[2] else 2}[rank]
    grows = np.isfinite(rigid.growth_angle(*k))
    assert grows == (rank == 1)
    assert grows == (rigid.gyric_roots(*k).real.max() > 0)


def test_quadrants_and_growth_of_named_points() -> None:
    k1, k3 = np.array([0.5, -0.5, -0.5, 0.5, 0.0, 0.5]), np.array([0.5, 0.5, -0.5, -0.5, 0.5, 0.0])
    assert rigid.quadrant(k1, k3).tolist() == [1, 2, 3, 4, 0, 0]
    least = np.log(10) / 0.5
    expected = [np.inf, least, np.inf, least, np.inf, np.inf]
    np.testing.assert_allclose(rigid.growth_angle(k1, k3), expected)
    assert rigid.growth_angle(1, -1) == pytest.approx(2.302585)  # the most unstable (figure 2-4)
    assert rigid.growth_angle(0.5, -0.5, N=np.e) == pytest.approx(2)


@many
@given(inertias)
def test_gyric_matrices_are_eulers_equations_near_a_somersault(i: np.ndarray) -> None:
    """2.1 with 2.4 and 2.2 linearised by finite differences, at a spin rate that is not 1."""
    spin, step = 1.7, 1e-6
    m, g, k = rigid.gyric_matrices(*i)

    def torque(x: np.ndarray, v: np.ndarray, acceleration: np.ndarray) -> np.ndarray:
        """I ω̇ + ω × Iω about axes 1 and 3, for tilt and twist x in a frame that spins about 2."""

        def omega(x: np.ndarray, v: np.ndarray) -> np.ndarray:
            angles, rates = [0.0, *x], [0.0, *v]
            turned = attitude.direction_cosines(*angles) @ [0, spin, 0]
            return attitude.body_rates(angles, rates) + turned

        h = 1e-4
        late = omega(x + h * v + h * h / 2 * acceleration, v + h * acceleration)
        early = omega(x - h * v + h * h / 2 * acceleration, v - h * acceleration)
        return (i * ((late - early) / (2 * h) - rigid.euler_rates(i, omega(x, v))))[[0, 2]]

    none, axes = np.zeros(2), np.eye(2)
    for matrix, place in ((k * spin**2, 0), (g * spin, 1), (m, 2)):
        for column in range(2):
            small = [none, none, none]
            small[place] = step * axes[column]
            np.testing.assert_allclose(
                torque(*small) / step, matrix[:, column], rtol=1e-4, atol=1e-4
            )


def test_the_characteristic_equation_is_2_12() -> None:
    """det(M s² + G s + K) over I1 I3 against (s² + 1)(s² + k1 k3), with symbols."""
    i1, i2, i3, s = sp.symbols("I1 I2 I3 s")
    gyric = i2 - i3 - i1
    system = sp.Matrix([[i1 * s**2 + i2 - i3, -gyric * s], [gyric * s, i3 * s**2 + i2 - i1]])
    product = (i2 - i3) / i1 * (i2 - i1) / i3
    found = sp.expand(system.det() / (i1 * i3) - (s**2 + 1) * (s**2 + product))
    assert sp.simplify(found) == 0


@many
@given(distinct)
def test_roots_solve_the_gyric_system(i: np.ndarray) -> None:
    m, g, k = rigid.gyric_matrices(*i)
    np.testing.assert_array_equal(g, -g.T)
    for root in rigid.gyric_roots(*rigid.inertia_ratios(*i)):
        system = m * root**2 + g * root + k
        assert abs(np.linalg.det(system)) < 1e-12 * max(1, abs(np.linalg.norm(system)) ** 2)


def test_stacks_of_bodies() -> None:
    i = np.random.default_rng(0).uniform(0.9, 1.1, (3, 4, 5))
    assert rigid.gyric_matrices(*i)[1].shape == (4, 5, 2, 2)
    assert rigid.gyric_roots(*rigid.inertia_ratios(*i)).shape == (4, 5, 4)
    assert rigid.inertias_from_ratios(*rigid.inertia_ratios(*i)).shape == (4, 5, 3)
    assert rigid.euler_rates(i.T, np.ones(3)).shape == (5, 4, 3)


def test_eulers_equations_are_2_1_term_by_term() -> None:
    i, w = np.array([2.0, 3.0, 4.0]), np.array([0.5, -0.7, 1.1])
    expected = [
        (i[1] - i[2]) * w[1] * w[2] / i[0],
        (i[2] - i[0]) * w[2] * w[0] / i[1],
        (i[0] - i[1]) * w[0] * w[1] / i[2],
    ]
    np.testing.assert_allclose(rigid.euler_rates(i, w), expected, rtol=1e-15)


@many
@given(inertias, st.integers(0, 2**32 - 1))
def test_energies_are_between_their_bounds_and_name_the_kind(i: np.ndarray, seed: int) -> None:
    w = np.random.default_rng(seed).normal(size=3)
    h, energy = np.linalg.norm(i * w), 0.5 * np.sum(i * w * w)
    least, middle, greatest = rigid.energy_bounds(i, h)
    assert least * (1 - 1e-14) <= energy <= greatest * (1 + 1e-14)
    if abs(energy - middle) > 1e-12 * middle:
        assert rigid.kind_of_motion(i, w) == ("minor" if energy > middle else "major")


def test_kinds_on_the_edge() -> None:
    i = (4.0, 3.0, 1.5)
    assert rigid.kind_of_motion(i, (3.0, 5.0, 4.0)) == "separatrix"  # 4·1·3² = 1.5·1.5·4²
    assert rigid.kind_of_motion(i, (3.0, 5.0, np.nextafter(4.0, 5))) == "minor"
    assert rigid.kind_of_motion(i, (np.nextafter(3.0, 4), 5.0, -4.0)) == "major"
    assert rigid.kind_of_motion(i, (3.0, 5.0, 4.001)) == "minor"
    assert rigid.kind_of_motion(i, (3.0, 5.0, 4.001), tolerance=1e-2) == "separatrix"
    assert rigid.kind_of_motion(i, (0, -2, 0)) == "separatrix"
    assert rigid.kind_of_motion(i, (0, 0, 2)) == "minor"
    assert rigid.kind_of_motion(i, (2, 0, 0)) == "major"
    assert rigid.kind_of_motion((2, 2, 1), (1, 1, 0)) == "separatrix"
    assert rigid.kind_of_motion((2, 2, 2), (1, 2, 3)) == "separatrix"


@many
@given(distinct, st.floats(0.001, 0.999), st.booleans(), st.floats(0.1, 10))
def test_energy_curves_lie_on_both_surfaces(
    i: np.ndarray, part: float, above: bool, momentum: float
) -> None:
    least, middle, greatest = rigid.energy_bounds(i, momentum)
    energy = middle + part * ((greatest if above else least) - middle)
    curve = rigid.energy_curve(i, energy, 100, momentum)
    assert curve.shape == (2, 100, 3)
    np.testing.assert_allclose(np.sum(curve**2, -1), 1, atol=1e-14)
    np.testing.assert_allclose(momentum**2 * np.sum(curve**2 / i, -1) / 2, energy, rtol=1e-12)
    np.testing.assert_allclose(curve[:, 0], curve[:, -1], atol=1e-14)
    circled = np.argmin(i) if above else np.argmax(i)
    assert np.all(curve[0, :, circled] > 0)
    assert np.all(curve[1, :, circled] < 0)
    angle = np.unwrap(np.arctan2(*np.delete(curve[0], circled, -1).T))
    assert abs(angle[-1] - angle[0]) == pytest.approx(2 * np.pi)


def test_twist_is_monotonic_above_the_separatrix_and_oscillates_below() -> None:
    least, middle, greatest = rigid.energy_bounds(LAYOUT, 1.0)
    _, twist = rigid.tilt_and_twist(rigid.energy_curve(LAYOUT, (middle + greatest) / 2))
    assert np.ptp(np.unwrap(twist, axis=-1), axis=-1) == pytest.approx(2 * np.pi)
    _, twist = rigid.tilt_and_twist(rigid.energy_curve(LAYOUT, (least + middle) / 2))
    assert np.all((twist[0] > 0) & (twist[0] < np.pi))  # “between 0 and ±π”
    assert np.all((twist[1] < 0) & (twist[1] > -np.pi))


def test_curves_at_the_ends_and_of_symmetric_bodies() -> None:
    least, middle, greatest = rigid.energy_bounds(LAYOUT, 1.0)
    np.testing.assert_allclose(rigid.energy_curve(LAYOUT, greatest)[0, :, 2], 1, atol=1e-12)
    np.testing.assert_allclose(rigid.energy_curve(LAYOUT, least)[1, :, 0], -1, atol=1e-12)
    through = rigid.energy_curve(LAYOUT, middle)
    assert np.abs(through[..., 1]).max() == pytest.approx(1, abs=1e-6)
    for body, place in (((2.0, 2.0, 1.0), 2), ((1.0, 1.5, 1.5), 0), ((1.0, 1.8, 1.0), 1)):
        low, equator, high = rigid.energy_bounds(body, 1.0)
        curve = rigid.energy_curve(body, (low + high) / 2)
        assert np.ptp(curve[0, :, place]) < 1e-12  # a circle of latitude
        flat = rigid.energy_curve(body, equator)
        np.testing.assert_allclose(flat[..., place], 0, atol=1e-7)
        circles = rigid.separatrix(body)
        np.testing.assert_allclose(circles[..., place], 0, atol=1e-15)


@many
@given(distinct)
def test_the_separatrix_is_two_circles_of_the_middle_energy(i: np.ndarray) -> None:
    circles = rigid.separatrix(i, 73)
    _, middle, _ = rigid.energy_bounds(i, 1.0)
    np.testing.assert_allclose(np.sum(circles**2, -1), 1, atol=1e-14)
    np.testing.assert_allclose(np.sum(circles**2 / i, -1) / 2, middle, rtol=1e-12)
    np.testing.assert_allclose(circles[:, 0], np.eye(3)[[np.argsort(i)[1]] * 2], atol=1e-15)
    ranks = np.linalg.svd(circles)[1]
    assert np.all(ranks[:, 2] < 1e-13 * ranks[:, 0])  # each in a plane through the centre
    assert np.linalg.matrix_rank(np.concatenate(circles), tol=1e-6) == 3


@many
@given(st.floats(-1.5, 1.5), st.floats(-3.1, 3.1), st.floats(-3, 3))
def test_points_are_minus_latitude_and_minus_longitude(
    tilt: float, twist: float, somersault: float
) -> None:
    point = rigid.momentum_direction(tilt, twist)
    np.testing.assert_allclose(
        point, attitude.direction_cosines(somersault, tilt, twist)[:, 1], atol=1e-15
    )
    np.testing.assert_allclose(rigid.tilt_and_twist(point), (tilt, twist), atol=1e-13)
    assert np.arcsin(np.clip(point[2], -1, 1)) == pytest.approx(-tilt, abs=1e-7)
    longitude = np.arctan2(-point[0], point[1])  # from 2, positive about 3
    assert longitude == pytest.approx(-twist, abs=1e-12)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: rigid.inertia_ratios(1, -1, 1), "positive"),
        (lambda: rigid.gyric_matrices(1, np.nan, 1), "positive"),
        (lambda: rigid.inertias_from_ratios(1.2, 0), "between"),
        (lambda: rigid.inertias_from_ratios(1, 1), "between"),
        (lambda: rigid.growth_angle(0.5, -0.5, N=1), "above 1"),
        (lambda: rigid.energy_bounds((1, 2, 4), 1), "sum of the other two"),
        (lambda: rigid.energy_bounds((1, 2, 2), 0), "positive"),
        (lambda: rigid.energy_bounds((1, 2), 1), "three principal inertias"),
        (lambda: rigid.kind_of_motion((1, 2, 2), (0, 0, 0)), "not zero"),
        (lambda: rigid.kind_of_motion((1, 2, 2), (0, np.inf, 0)), "finite"),
        (lambda: rigid.energy_curve(LAYOUT, 1.0), "lies between"),
        (lambda: rigid.energy_curve((1, 1, 1), 0.5), "three equal inertias"),
        (lambda: rigid.separatrix((1, 1, 1)), "three equal inertias"),
        (lambda: RigidMotion((1, 1, 3), (1, 0, 0)), "sum of the other two"),
        (lambda: RigidMotion((1, 0, 1), (1, 0, 0)), "positive"),
        (lambda: RigidMotion((1, np.nan, 1), (1, 0, 0)), "positive"),
        (lambda: RigidMotion((1, 1, 1), (0, 0, 0)), "not zero"),
        (lambda: RigidMotion((1, 1, 1), (np.nan, 0, 0)), "finite"),
        (lambda: RigidMotion((1, 1, 1), (1, 0)), "three finite"),
        (lambda: RigidMotion((1, 1, 1), (1, 0, 0), (0, 0, 0, 0)), "quaternion"),
        (lambda: RigidMotion((1, 1, 1), (1, 0, 0), (1, 0, 0)), "quaternion"),
        (lambda: RigidMotion.from_momentum((1, 1, 1), 0.0), "not zero"),
        (lambda: RigidMotion.from_momentum((1, 1, 1), np.inf), "finite"),
        (lambda: RigidMotion.from_momentum((1, 1, 1), (1.0, 2.0)), "one or three"),
        (lambda: RigidMotion((1, 1, 1), (1, 0, 0)).omega(np.nan), "Times"),
        (
            lambda: RigidMotion((1, 1, 1), (1, 0, 0)).twists_per_somersault_quadrature(),
            "no period",
        ),
    ],
)
def test_mistakes_are_told_in_a_sentence(call: object, words: str) -> None:
    with pytest.raises(SomersaultError, match=words) as told:
        call()
    message = str(told.value)
    assert message.endswith(".")
    assert "\n" not in message
    assert "array(" not in message


@pytest.mark.parametrize("above", [True, False])
def test_the_integrals_of_a4_as_printed_with_their_errata(above: bool) -> None:
    """A.3–A.33 with n = L4/L3 for I1 > I2 > I3, integrated by scipy over scaled time."""
    i1, i2, i3, h = 12.0, 11.2, 0.9, 30.0
    energy = 0.5 * h**2 / (0.4 * i2 + 0.6 * i3 if above else 0.3 * i2 + 0.7 * i1)
    i = h**2 / (2 * energy)
    w1 = h * np.sqrt((i - i3) / (i * i1 * (i1 - i3)))
    w3 = h * np.sqrt((i1 - i) / (i * i3 * (i1 - i3)))
    if above:  # A.16, A.17, A.30–A.33
        rate = h * np.sqrt((i2 - i3) * (i1 - i) / (i * i1 * i2 * i3))
        m = (i1 - i2) * (i - i3) / ((i2 - i3) * (i1 - i))
        second, fourth = h * i3 * w3**2 * m, i3**2 * w3**2 * m
    else:  # A.11, A.12, A.26–A.29
        rate = h * np.sqrt((i1 - i2) * (i - i3) / (i * i1 * i2 * i3))
        m = (i2 - i3) * (i1 - i) / ((i1 - i2) * (i - i3))
        second, fourth = h * i3 * w3**2, i3**2 * w3**2
    first, third = h * (2 * energy - i3 * w3**2), h**2 - i3**2 * w3**2

    def precession(tau: float) -> float:
        sn = ellipj(tau, m)[0]
        return (first + second * sn**2) / (third + fourth * sn**2) / rate

    made = RigidMotion((i1, i2, i3), (w1, 0.0, w3))  # A.8–A.10 and A.13–A.15 at τ = 0
    assert made.energy == pytest.approx(energy)
    sn, cn, dn = ellipj(rate * 1.3, m)[:3]
    one, three = (cn, dn) if above else (dn, cn)
    limit = (i - i3) / (i2 - i3) if above else (i1 - i) / (i1 - i2)
    w2 = h * np.sqrt(limit / (i * i2))  # A.5 and A.7; s2 = −1 for s1 = s3 = 1
    np.testing.assert_allclose(made.omega(1.3), [w1 * one, -w2 * sn, w3 * three], rtol=1e-12)
    quarter = ellipk(m)
    assert made.period == pytest.approx(4 * quarter / rate, rel=1e-12)
    somersault = 4 * quad(precession, 0, quarter, epsabs=1e-13, epsrel=1e-13)[0]
    assert made.mean_rates[0] * made.period == pytest.approx(somersault, rel=1e-11)
    part = quad(precession, 0, 1.3 * rate, epsabs=1e-13, epsrel=1e-13, limit=200)[0]
    start, end = made.momentum_angles([0.0, 1.3])
    assert end[0] - start[0] == pytest.approx(part, rel=1e-11)
    w = made.omega(1.3)
    assert end[1] == pytest.approx(-np.arcsin(i3 * w[2] / h), rel=1e-12)  # A.20, with its sign
    assert np.tan(end[2]) == pytest.approx(i1 * w[0] / (i2 * w[1]), rel=1e-10)  # A.21


@pytest.mark.parametrize("kc", [1.0, 0.999, 0.5, 1e-3, 1e-8, 1e-30])
def test_elliptic_functions_against_mpmath(kc: float) -> None:
    with mpmath.workdps(80):
        k = mpmath.sqrt(1 - mpmath.mpf(kc) ** 2)
        m = k * k
        quarter = mpmath.ellipk(m)
        assert quarter_period(kc) == pytest.approx(float(quarter), rel=1e-15)
        for part in (0.0, 1e-6, 0.3, 0.77, 0.999, 1.3, -0.4, 3.9):
            u = float(part * quarter)
            at = elliptic(np.array(u), kc)
            sign = (-1) ** int(at.turns)
            sn, cn, dn = (mpmath.ellipfun(name, u, m=m) for name in ("sn", "cn", "dn"))
            assert sign * float(at.sn) == pytest.approx(float(sn), rel=1e-13)
            assert sign * float(at.cn) == pytest.approx(float(cn), rel=1e-11)
            assert float(at.dn) == pytest.approx(float(dn), rel=1e-11)
            again = first_kind(float(at.sn), float(at.cn), float(at.dn))
            assert again == pytest.approx(float(at.v), rel=1e-13)
            if abs(part) < 1:
                phi = mpmath.asin(sn)
                expected = u - mpmath.ellippi(-0.7, phi, m)
                assert float(third_kind(at, 0.7, kc)) == pytest.approx(
                    float(expected), rel=1e-13, abs=1e-16
                )


def test_the_limit_of_no_complementary_modulus() -> None:
    u = np.linspace(-9, 9, 41)
    zero, tiny = elliptic(u, 0.0), elliptic(u, 1e-150)
    for a, b in zip(zero, tiny, strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-13)
    np.testing.assert_allclose(
        third_kind(zero, 0.4, 0.0), third_kind(tiny, 0.4, 1e-150), rtol=1e-13
    )


def test_the_motion_stays_on_its_curve_of_the_map() -> None:
    made = RigidMotion((1.0, 0.9, 0.5), (0.2, 0.9, -0.6))
    h = float(np.linalg.norm(made.momentum))
    curves = rigid.energy_curve(made.inertias, made.energy, 20001, h).reshape(-1, 3)
    cosines = made.inertias * made.omega(np.linspace(0, made.period, 30)) / h
    nearest = np.linalg.norm(curves[None] - cosines[:, None], axis=-1).min(-1)
    assert nearest.max() < 1e-3


def test_a_motion_does_not_change_with_what_it_was_made_from() -> None:
    inertias, w0 = np.array([1.0, 0.9, 0.5]), np.array([0.1, 1.0, 0.2])
    made = RigidMotion(inertias, w0)
    before = made.omega(2.0)
    w0[:] = 9
    inertias[:] = 9
    np.testing.assert_array_equal(made.omega(2.0), before)
    with pytest.raises(ValueError, match="read-only"):
        made.omega0[0] = 3


def test_the_twist_of_a_spin_about_axis_3_as_the_major_axis_is_a_limit_too() -> None:
    for way in (1.0, -1.0):
        near = RigidMotion((0.5, 0.9, 1.0), (1e-7, 0, way))
        steady = RigidMotion((0.5, 0.9, 1.0), (0, 0, way))
        assert steady.twists_per_somersault == pytest.approx(near.twists_per_somersault, rel=1e-10)
        assert near.twists_per_somersault == pytest.approx(
            near.twists_per_somersault_quadrature(), rel=1e-6
        )
