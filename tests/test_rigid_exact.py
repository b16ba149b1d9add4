"""The exact motion of a rigid body against integration, quadrature and closed forms of others."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from somersault import attitude
from somersault._core.errors import SomersaultError
from somersault.rigid import RigidMotion, inertia_ratios
from somersault.rigid._quadrature import period_and_somersault

SOMERSAULTS = 20
BITS = 128  # of the fixed-point reference, behind the point
EXACT_SEPARATRIX = ((4.0, 3.0, 1.5), (3.0, -2.0, 4.0))  # 4·1·3² = 1.5·1.5·4²
some = settings(derandomize=True, max_examples=40, deadline=None)
seeds = st.integers(0, 2**32 - 1)


def body(rng: np.random.Generator) -> np.ndarray:
    """Inertias that some body has, in any order."""
    spread = rng.uniform(0.02, 1, 3)
    return spread.sum() - spread


def motion(seed: int) -> RigidMotion:
    """A random body in any attitude, at 1 rad/s and more."""
    rng = np.random.default_rng(seed)
    return RigidMotion(body(rng), 1.7 * unit(rng, 3), unit(rng, 4))


def near_separatrix(seed: int, distance: float) -> RigidMotion:
    """A random body with 2T I_mid/h² − 1 near `distance`."""
    rng = np.random.default_rng([seed, 3])
    i, w = body(rng), rng.normal(size=3)
    low, mid, high = np.argsort(i)
    for _ in range(60):
        squared = np.sum((i * w) ** 2)
        part = i[high] * (i[high] - i[mid]) * w[high] ** 2 + distance * squared
        if part < 0:
            w[high] *= 2
        else:
            w[low] = np.copysign(np.sqrt(part / (i[low] * (i[mid] - i[low]))), w[low])
    made = RigidMotion(i, w / np.linalg.norm(w), unit(rng, 4))
    h = np.linalg.norm(made.momentum)
    assert 2 * made.energy * i[mid] / h**2 - 1 == pytest.approx(distance, rel=0.1, abs=1e-15)
    return made


def unit(rng: np.random.Generator, n: int) -> np.ndarray:
    vector = rng.normal(size=n)
    return vector / np.linalg.norm(vector)


def times(of: RigidMotion, samples: int = 200) -> np.ndarray:
    """Twenty somersaults about the angular momentum."""
    return np.linspace(0, SOMERSAULTS * 2 * np.pi / of.mean_rates[0], samples)


def integrated(of: RigidMotion, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """ω and quaternion by an embedded Runge–Kutta method of order 8."""

    one, two, three = of.inertias.tolist()
    gains = (two - three) / one, (three - one) / two, (one - two) / three

    def rates(_: float, state: np.ndarray) -> list[float]:
        x, y, z, a, b, c, d = state.tolist()
        return [
            gains[0] * y * z, gains[1] * z * x, gains[2] * x * y,
            0.5 * (-b * x - c * y - d * z), 0.5 * (a * x + c * z - d * y),
            0.5 * (a * y + d * x - b * z), 0.5 * (a * z + b * y - c * x),
        ]  # fmt: skip

    start = np.concatenate([of.omega0, of.attitude0])
    found = solve_ivp(
        rates, (0, at[-1]), start, method="DOP853", t_eval=at, rtol=1e-13, atol=1e-14
    ).y.T
    return found[:, :3], found[:, 3:]


def summed(of: RigidMotion, end: float, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """ω and quaternion by Taylor series of order 36, over whole numbers of 2⁻¹²⁸.

    Double precision cannot follow a motion near the separatrix: there the time of each half
    twist hangs on the digits in which energies differ.
    """
    order = 36
    one, two, three = (Fraction(x) for x in of.inertias.tolist())
    gains = [fixed(x) for x in ((two - three) / one, (three - one) / two, (one - two) / three)]
    step = fixed(Fraction(end) / steps)
    values = [fixed(x) for x in (*of.omega0.tolist(), *of.attitude0.tolist())]
    path = [values]
    for _ in range(steps):
        series = np.zeros((7, order + 1), object)
        series[:, 0] = values
        w, q = series[:3], series[3:]
        for n in range(order):

            def product(a: np.ndarray, b: np.ndarray, last: int = n) -> int:
                return int(a[: last + 1] @ b[last::-1]) >> BITS

            for r in range(3):
                made = gains[r] * product(w[r - 2], w[r - 1]) >> BITS
                w[r, n + 1] = (made * step >> BITS) // (n + 1)
            (x, y, z), (a, b, c, d) = w, q
            turning = (
                -product(b, x) - product(c, y) - product(d, z),
                product(a, x) + product(c, z) - product(d, y),
                product(a, y) + product(d, x) - product(b, z),
                product(a, z) + product(b, y) - product(c, x),
            )
            q[:, n + 1] = [(made * step >> BITS + 1) // (n + 1) for made in turning]
        values = [int(row.sum()) for row in series]
        path.append(values)
    found = np.array([[float(Fraction(x, 1 << BITS)) for x in row] for row in path])
    return found[:, :3], found[:, 3:]


def fixed(x: float | Fraction) -> int:
    exact = Fraction(x)
    return (exact.numerator << BITS) // exact.denominator


def same_attitude(a: np.ndarray, b: np.ndarray, within: float) -> None:
    assert np.minimum(np.abs(a - b).max(-1), np.abs(a + b).max(-1)).max() < within


@pytest.mark.parametrize("seed", range(30))
def test_twenty_somersaults_agree_with_integration(seed: int) -> None:
    """Both kinds, all orders of inertias, h in any direction; the integrator is good to 2e-12."""
    made = motion(seed)
    at = times(made)
    omega, quaternion = integrated(made, at)
    np.testing.assert_allclose(made.omega(at), omega, atol=1e-11)
    np.testing.assert_allclose(made.quaternion(at), quaternion, atol=1e-11)


def test_the_thirty_motions_are_of_all_kinds() -> None:
    kinds = {(m.kind, m.monotonic_twist) for m in map(motion, range(30))}
    assert len(kinds) == 4
    assert {tuple(np.argsort(motion(s).inertias)) for s in range(30)} == {
        (0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)
    }  # fmt: skip


@pytest.mark.parametrize("distance", [1e-2, -1e-3, 1e-4, -1e-6, 1e-8, -1e-8, 1e-12, -1e-15])
def test_twenty_somersaults_near_the_separatrix(distance: float) -> None:
    made = near_separatrix(round(-np.log10(abs(distance))), distance)
    end, steps = float(times(made)[-1]), 450
    omega, quaternion = summed(made, end, steps)
    at = np.arange(steps + 1) * (end / steps)
    np.testing.assert_allclose(made.omega(at), omega, atol=1e-13)
    np.testing.assert_allclose(made.quaternion(at), quaternion, atol=1e-13)


def test_an_ordinary_motion_is_as_exact() -> None:
    made = motion(4)
    end = float(times(made)[-1])
    omega, quaternion = summed(made, end, 450)
    at = np.arange(451) * (end / 450)
    np.testing.assert_allclose(made.omega(at), omega, atol=1e-13)
    np.testing.assert_allclose(made.quaternion(at), quaternion, atol=1e-13)


@some
@given(seeds)
def test_momentum_and_energy_stay(seed: int) -> None:
    made = motion(seed)
    at = np.linspace(-1000, 1000, 501)
    omega = made.omega(at)
    np.testing.assert_allclose(0.5 * np.sum(made.inertias * omega**2, -1), made.energy, rtol=1e-13)
    turn = attitude.matrix_from_quaternion(made.quaternion(at))
    h = (turn @ (made.inertias * omega)[..., None])[..., 0]
    np.testing.assert_allclose(h, np.tile(made.momentum, (501, 1)), atol=1e-13)
    np.testing.assert_allclose(np.linalg.norm(made.quaternion(at), axis=-1), 1, atol=1e-14)


@some
@given(seeds, st.floats(-50, 50), st.floats(-50, 50))
def test_a_motion_goes_on_from_where_it_is(seed: int, first: float, then: float) -> None:
    made = motion(seed)
    later = RigidMotion(made.inertias, made.omega(first), made.quaternion(first))
    np.testing.assert_allclose(later.omega(then), made.omega(first + then), atol=2e-11)
    np.testing.assert_allclose(later.quaternion(then), made.quaternion(first + then), atol=2e-11)


@some
@given(seeds)
def test_time_runs_backwards(seed: int) -> None:
    """−ω from the same attitude retraces the past."""
    made = motion(seed)
    back = RigidMotion(made.inertias, -made.omega0, made.attitude0)
    at = np.linspace(0, 40, 100)
    np.testing.assert_allclose(back.omega(at), -made.omega(-at), atol=1e-12)
    same_attitude(back.quaternion(at), made.quaternion(-at), 1e-12)


@some
@given(seeds, st.floats(1e-3, 1e3), st.floats(1e-3, 1e3))
def test_only_inertia_ratios_and_somersaults_matter(seed: int, heavy: float, fast: float) -> None:
    made = motion(seed)
    other = RigidMotion(heavy * made.inertias, fast * made.omega0, made.attitude0)
    at = np.linspace(0, 30, 50)
    np.testing.assert_allclose(other.omega(at / fast), fast * made.omega(at), atol=2e-11 * fast)
    same_attitude(other.quaternion(at / fast), made.quaternion(at), 1e-11)
    assert other.period * fast == pytest.approx(made.period, rel=1e-11)
    assert other.twists_per_somersault == pytest.approx(made.twists_per_somersault, abs=1e-12)


@some
@given(seeds)
def test_names_of_axes_do_not_matter(seed: int) -> None:
    """Relabelling 1, 2, 3 → 2, 3, 1 and mirroring in the 1-3 plane relabel and mirror ω."""
    made, at = motion(seed), np.linspace(0, 30, 50)
    turned = RigidMotion(np.roll(made.inertias, 1), np.roll(made.omega0, 1))
    np.testing.assert_allclose(turned.omega(at), np.roll(made.omega(at), 1, -1), atol=1e-12)
    mirror = np.array([-1, 1, -1])
    other = RigidMotion(made.inertias, mirror * made.omega0, made.attitude0)
    np.testing.assert_allclose(other.omega(at), mirror * made.omega(at), atol=1e-12)


@settings(some, max_examples=200)
@given(seeds)
def test_rotation_numbers_agree_with_quadrature(seed: int) -> None:
    made = motion(seed)
    period, somersault = period_and_somersault(made.inertias, made.omega0)
    assert made.period == pytest.approx(period, rel=1e-11)
    assert made.mean_rates[0] * made.period == pytest.approx(somersault, rel=1e-10)
    found = made.twists_per_somersault
    assert found == pytest.approx(made.twists_per_somersault_quadrature(), rel=1e-10)
    assert (found != 0) == made.monotonic_twist
    np.testing.assert_allclose(made.omega(made.period), made.omega0, atol=1e-12)
    start, end = made.momentum_angles([0.0, made.period])
    assert end[0] - start[0] == pytest.approx(somersault, rel=1e-10)
    assert end[2] - start[2] == pytest.approx(found * somersault, abs=1e-10)
    assert end[1] == pytest.approx(start[1], abs=1e-10)


@some
@given(seeds, st.sampled_from([1, -1]))
def test_angles_about_the_momentum_are_continuous_and_in_closed_form(seed: int, way: int) -> None:
    rng = np.random.default_rng(seed)
    made = RigidMotion.from_momentum(body(rng), way * 1.5, unit(rng, 4))
    np.testing.assert_allclose(made.momentum, [0, way * 1.5, 0], atol=1e-14)
    at = np.linspace(0, 12 * np.pi / made.mean_rates[0], 20001)
    angles, quaternion = made.angles(at), made.quaternion(at)
    same_attitude(attitude.quaternion_from_angles(*angles.T), quaternion, 1e-12)
    if np.abs(np.cos(angles[:, 1])).min() > 0.02:
        np.testing.assert_allclose(angles, attitude.unwrapped_angles(quaternion), atol=1e-9)
    assert np.all(np.diff(way * angles[:, 0]) > 0)  # A.22: the precession has one sign
    np.testing.assert_array_equal(made.angles(at[::400]), angles[::400])
    np.testing.assert_allclose(made.angles(at[7]), angles[7], atol=1e-12)
    assert np.abs(made.angles(0.0)).max() <= np.pi + 1e-12


@some
@given(seeds)
def test_angles_in_any_inertial_axes_follow_the_path(seed: int) -> None:
    made = motion(seed)
    at = np.array([3.0, -2.0, 0.0, 11.0])
    found = made.angles(at)
    same_attitude(attitude.quaternion_from_angles(*found.T), made.quaternion(at), 1e-12)
    path = np.linspace(0, 11, 40001)
    fine = attitude.unwrapped_angles(made.quaternion(path))
    if np.abs(np.cos(fine[:, 1])).min() > 0.05:
        np.testing.assert_allclose(found[[2, 3]], fine[[0, -1]], atol=1e-10)
    assert made.angles(np.zeros((2, 3))).shape == (2, 3, 3)


@some
@given(seeds)
def test_the_momentum_frame_is_a_constant_turn_away(seed: int) -> None:
    made = motion(seed)
    at = np.linspace(-30, 30, 200)
    within = attitude.quaternion_from_angles(*made.momentum_angles(at).T)
    frame = attitude.quaternion_product(made.quaternion(at), attitude.quaternion_conjugate(within))
    same_attitude(frame, frame[0], 1e-12)
    along = attitude.matrix_from_quaternion(frame[0]) @ [0, 1, 0]
    np.testing.assert_allclose(along, made.momentum / np.linalg.norm(made.momentum), atol=1e-12)
    assert abs(frame[0, 2]) < 1e-12  # the shortest turn has no part about 2


@pytest.mark.parametrize("symmetric", [(0.04, 0.04, 0.02), (0.02, 0.02, 0.03)])
@pytest.mark.parametrize("place", [0, 1, 2])
def test_a_free_cylinder_precesses_and_spins(
    symmetric: tuple[float, float, float], place: int
) -> None:
    """I = 0.04, J = 0.02 kg m²: Drake's free body, and a plate; its closed form is two turns.

    The transverse ω moves in the body, so the axis of rotation is not constant.
    """
    inertias = np.roll(symmetric, place + 1)  # the body's axis at `place`
    across, along = symmetric[0], symmetric[2]
    rng = np.random.default_rng(place)
    w0, q0 = 5 * unit(rng, 3), unit(rng, 4)
    made, at = RigidMotion(inertias, w0, q0), np.linspace(0, 20, 300)
    precession = inertias * w0 / across
    spin = np.eye(3)[place] * w0[place] * (1 - along / across)
    closed = attitude.quaternion_product(
        attitude.quaternion_product(q0, turn(precession, at)), turn(spin, at)
    )
    np.testing.assert_allclose(made.quaternion(at), closed, atol=1e-12)
    back = attitude.matrix_from_quaternion(turn(spin, at))
    expected = np.einsum("tji,j->ti", back, precession + spin)
    np.testing.assert_allclose(made.omega(at), expected, atol=1e-12)
    assert np.ptp(made.omega(at), axis=0).max() > 1
    assert made.period == pytest.approx(2 * np.pi / np.linalg.norm(spin), rel=1e-13)
    if place == 2:
        ratio = spin[2] / np.linalg.norm(precession)
        assert made.twists_per_somersault == pytest.approx(ratio, rel=1e-13)
        assert made.twists_per_somersault_quadrature() == pytest.approx(ratio, rel=1e-12)


def turn(rate: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Quaternions (time, 4) of a steady turn."""
    size = np.linalg.norm(rate)
    half = 0.5 * size * at[:, None]
    return np.concatenate([np.cos(half), np.sin(half) * rate / size], -1)


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9, 1e-12, 2e-16])
@pytest.mark.parametrize("base", [(0.04, 0.04, 0.02), (0.02, 0.02, 0.03), (0.03, 0.03, 0.03)])
def test_symmetric_and_spherical_bodies_are_limits(
    base: tuple[float, float, float], gap: float
) -> None:
    """Nearly equal inertias differ from equal ones by about the gap, and nothing else breaks."""
    w0, q0, at = [1.0, 2.0, -1.5], [0.1, 0.2, 0.3, 0.4], np.linspace(-5, 5, 99)
    limit = RigidMotion(base, w0, q0)
    for sign in ([1, 0, 0], [0, 1, 0], [-1, 0, 0], [1, 0, -1]):
        near = RigidMotion(np.array(base) * (1 + gap * np.array(sign)), w0, q0)
        np.testing.assert_allclose(near.omega(at), limit.omega(at), atol=60 * gap + 1e-13)
        np.testing.assert_allclose(near.quaternion(at), limit.quaternion(at), atol=60 * gap + 1e-13)


def test_a_sphere_turns_steadily() -> None:
    made, at = RigidMotion((0.3, 0.3, 0.3), (1.0, 2.0, 2.0)), np.linspace(0, 10, 50)
    np.testing.assert_array_equal(made.omega(at), np.tile([1.0, 2.0, 2.0], (50, 1)))
    np.testing.assert_allclose(made.quaternion(at), turn(np.array([1, 2, 2]), at), atol=1e-14)
    angles = made.momentum_angles(at)
    np.testing.assert_allclose(angles - angles[0], np.outer(at, [3, 0, 0]), atol=1e-13)
    assert made.twists_per_somersault == 0
    assert made.period == np.inf
    assert made.kind == "separatrix"


@pytest.mark.parametrize("place", [0, 1, 2])
@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("cone", [0, 1e-160, 1e-100, 1e-12, 1e-7])
def test_pure_spins_are_limits(place: int, way: float, cone: float) -> None:
    """Narrow cones about each axis; about the middle one they open as cosh, which 5 s limit."""
    inertias = np.array([1.0, 0.9, 0.5])
    w0 = np.full(3, cone)
    w0[place] = way
    made, at = RigidMotion(inertias, w0, [0.5, 0.5, -0.5, 0.5]), np.linspace(0, 5, 40)
    steady = RigidMotion(inertias, np.eye(3)[place] * way, [0.5, 0.5, -0.5, 0.5])
    np.testing.assert_allclose(made.omega(at), steady.omega(at), atol=20 * cone + 1e-15)
    np.testing.assert_allclose(made.quaternion(at), steady.quaternion(at), atol=30 * cone + 1e-14)
    if place != 1 and cone > 0:
        one, three = np.delete(inertias, place)
        ratios = inertia_ratios(one, inertias[place], three)
        nutation = np.sqrt(np.prod(ratios))  # ν of section 2.3.2
        assert made.period == pytest.approx(2 * np.pi / nutation, rel=1e-6)
    if place == 2:
        near = RigidMotion(inertias, [1e-7, 0, way])
        assert steady.twists_per_somersault == pytest.approx(near.twists_per_somersault, rel=1e-10)


def test_the_separatrix_is_hyperbolic_and_ends_on_the_middle_axis() -> None:
    inertias, w0 = EXACT_SEPARATRIX
    made = RigidMotion(inertias, w0, (0.5, -0.5, 0.5, 0.5))
    assert made.kind == "separatrix"
    assert made.period == np.inf
    at = np.linspace(-3, 3, 200)
    omega, quaternion = integrated(made, at[at >= 0])
    np.testing.assert_allclose(made.omega(at[at >= 0]), omega, atol=1e-10)
    np.testing.assert_allclose(made.quaternion(at[at >= 0]), quaternion, atol=1e-10)
    exact_omega, exact_quaternion = summed(made, 3.0, 60)
    few = np.arange(61) * 0.05
    np.testing.assert_allclose(made.omega(few), exact_omega, atol=2e-14)
    np.testing.assert_allclose(made.quaternion(few), exact_quaternion, atol=2e-14)
    h, final = np.linalg.norm(made.momentum), np.linalg.norm(made.momentum) / 3
    for t in (-40.0, 40.0, 4000.0):
        np.testing.assert_allclose(np.abs(made.omega(t)), [0, final, 0], atol=1e-13)
    assert made.omega(40.0)[1] * made.omega(-40.0)[1] < 0  # from one end to the other
    late = made.momentum_angles([50.0, 60.0])
    np.testing.assert_allclose(np.diff(late, axis=0), [[10 * h / 3, 0, 0]], atol=1e-12)
    assert made.mean_rates == (pytest.approx(h / 3, rel=1e-13), 0.0)
    with pytest.raises(SomersaultError, match="no period"):
        made.twists_per_somersault_quadrature()


def test_near_the_separatrix_periods_grow_with_the_logarithm() -> None:
    """A tenth of the distance adds ln 10/2 to K, at the exponent of 2.13 about the middle axis."""
    inertias = np.array([4.0, 3.0, 1.5])
    made = [RigidMotion(inertias, [3, 2, 4 * (1 + d)]) for d in 10.0 ** -np.arange(4, 12)]
    h = np.array([np.linalg.norm(m.momentum) for m in made])
    exponent = h / 3 * np.sqrt((4 - 3) * (3 - 1.5) / (4 * 1.5))
    grown = np.diff([m.period for m in made] * exponent)
    np.testing.assert_allclose(grown[2:], 4 * np.log(10) / 2, rtol=1e-3)
    for m in made:
        assert m.period == pytest.approx(period_and_somersault(inertias, m.omega0)[0], rel=1e-4)


# -------------------------------------------------------------------------------- mean tilt


@pytest.mark.parametrize("seed", range(6))
def test_the_mean_tilt_is_that_of_an_adaptive_quadrature(seed: int) -> None:
    of = motion(seed)

    def tilt(t: float) -> float:
        h = of.inertias * of.omega(t)
        return -np.arcsin(h[2] / np.linalg.norm(h))

    wanted, _ = quad(tilt, 0, of.period, epsabs=1e-12, limit=200)
    assert of.mean_tilt == pytest.approx(wanted / of.period, abs=1e-10)


def test_a_steady_tilt_is_its_own_mean_and_the_separatrix_has_none() -> None:
    symmetric = RigidMotion((1.0, 1.0, 0.4), (0.3, 1.0, 0.5))
    h = symmetric.inertias * symmetric.omega0
    assert symmetric.mean_tilt == pytest.approx(-np.arcsin(h[2] / np.linalg.norm(h)))
    assert RigidMotion((3.0, 2.0, 1.0), (0.0, 1.0, 0.0)).mean_tilt == pytest.approx(0)
    with pytest.raises(SomersaultError, match="separatrix"):
        _ = RigidMotion(*EXACT_SEPARATRIX).mean_tilt
