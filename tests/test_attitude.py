"""Attitudes by the axioms of the rotation group, against scipy, and through the singularity."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from somersault import attitude
from somersault._core.errors import SomersaultError

many = settings(derandomize=True, max_examples=100, deadline=None)
QUARTER = np.pi / 2
turns = st.floats(-20.0, 20.0)
tilts = st.one_of(
    st.floats(-QUARTER, QUARTER),
    st.sampled_from([QUARTER, -QUARTER, 0.0]),
    st.builds(lambda e, s: s * (QUARTER - 10.0**e), st.floats(-16, -3), st.sampled_from([1, -1])),
)
angle_triples = st.tuples(turns, tilts, turns)


@st.composite
def quaternions(draw: st.DrawFn) -> np.ndarray:
    """Unit quaternions: anywhere, near the identity, half turns."""
    seed = draw(st.integers(0, 2**32 - 1))
    vector = np.random.default_rng(seed).normal(size=4)
    kind = draw(st.sampled_from(["any", "near", "half", "axis"]))
    if kind == "near":
        vector = np.array([1, *vector[1:] * 10.0 ** draw(st.floats(-18, -2))])
    if kind == "half":
        vector[0] = draw(st.sampled_from([0.0, 1e-17, -1e-9]))
    if kind == "axis":
        vector = np.eye(4)[seed % 4]
    return vector / np.linalg.norm(vector)


def apart(a: np.ndarray, b: np.ndarray) -> float:
    """Distance of attitudes: a quaternion and its negative are one."""
    return float(np.minimum(np.abs(a - b).max(-1), np.abs(a + b).max(-1)).max())


@many
@given(quaternions(), quaternions(), quaternions())
def test_quaternions_are_a_group(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> None:
    product, one = attitude.quaternion_product, np.array([1.0, 0, 0, 0])
    np.testing.assert_allclose(product(product(p, q), r), product(p, product(q, r)), atol=1e-15)
    np.testing.assert_allclose(product(p, one), p, atol=0)
    np.testing.assert_allclose(product(one, p), p, atol=0)
    np.testing.assert_allclose(product(p, attitude.quaternion_conjugate(p)), one, atol=1e-15)
    of = attitude.matrix_from_quaternion
    np.testing.assert_allclose(of(product(p, q)), of(p) @ of(q), atol=2e-15)


@many
@given(quaternions())
def test_matrices_are_rotations_and_come_back(q: np.ndarray) -> None:
    matrix = attitude.matrix_from_quaternion(q)
    np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=2e-15)
    assert np.linalg.det(matrix) == pytest.approx(1, abs=2e-15)
    np.testing.assert_allclose(matrix, Rotation.from_quat(np.roll(q, -1)).as_matrix(), atol=2e-15)
    back = attitude.quaternion_from_matrix(matrix)
    assert apart(back, q) < 1e-15
    assert back[0] >= 0


@many
@given(angle_triples)
@example((0.3, QUARTER, 0.5))
@example((0.3, -QUARTER, 0.5))
@example((0.0, 0.0, 0.0))
def test_angles_mean_three_turns_in_order(angles: tuple[float, float, float]) -> None:
    q = attitude.quaternion_from_angles(*angles)
    ours = attitude.matrix_from_quaternion(q)
    np.testing.assert_allclose(ours, Rotation.from_euler("YXZ", angles).as_matrix(), atol=5e-15)
    np.testing.assert_allclose(ours.T, attitude.direction_cosines(*angles), atol=5e-15)


@many
@given(st.one_of(quaternions(), angle_triples.map(lambda a: attitude.quaternion_from_angles(*a))))
def test_every_attitude_has_angles_that_give_it_back(q: np.ndarray) -> None:
    found = attitude.angles_from_quaternion(q)
    assert np.all(np.abs(found) <= np.array([np.pi, QUARTER, np.pi]) + 1e-15)
    assert apart(attitude.quaternion_from_angles(*found), q) < 1e-15
    np.testing.assert_array_equal(attitude.angles_from_quaternion(-q)[1], found[1])
    by_matrix = attitude.angles_from_matrix(attitude.matrix_from_quaternion(q).T)
    assert apart(attitude.quaternion_from_angles(*by_matrix), q) < 3e-15


@many
@given(st.tuples(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1)))
def test_angles_come_back(angles: tuple[float, float, float]) -> None:
    q = attitude.quaternion_from_angles(*angles)
    np.testing.assert_allclose(attitude.angles_from_quaternion(q), angles, atol=2e-14)
    cosines = attitude.direction_cosines(*angles)
    np.testing.assert_allclose(attitude.angles_from_matrix(cosines), angles, atol=2e-14)


@pytest.mark.parametrize("side", [1, -1])
def test_at_the_singularity_the_twist_is_zero(side: int) -> None:
    q = attitude.quaternion_from_angles(0.7, side * QUARTER, 0.4)
    expected = [0.7 - side * 0.4, side * QUARTER, 0.0]
    np.testing.assert_allclose(attitude.angles_from_quaternion(q), expected, atol=1e-15)


def test_stacks_are_carried_along() -> None:
    angles = np.random.default_rng(1).uniform(-1, 1, (2, 5, 3))
    q = attitude.quaternion_from_angles(*np.moveaxis(angles, -1, 0))
    assert q.shape == (2, 5, 4)
    np.testing.assert_allclose(attitude.angles_from_quaternion(q), angles, atol=1e-14)
    matrices = attitude.matrix_from_quaternion(q)
    assert matrices.shape == (2, 5, 3, 3)
    assert apart(attitude.quaternion_from_matrix(matrices), q) < 1e-15
    assert attitude.direction_cosines(angles[..., 0], 0.0, 0.0).shape == (2, 5, 3, 3)
    np.testing.assert_array_equal(attitude.unwrapped_angles(q)[1], attitude.unwrapped_angles(q[1]))


@many
@given(
    st.tuples(turns, st.floats(-1.5, 1.5), turns),
    st.tuples(*[st.floats(-3.0, 3.0)] * 3),
)
def test_rates_are_those_of_the_cosines(
    angles: tuple[float, float, float], rates: tuple[float, float, float]
) -> None:
    """Ċ_bi = −ω× C_bi, by central differences of 2.2; then 2.3 inverts 2.4."""
    at, rate, step = np.array(angles), np.array(rates), 1e-5
    ahead, behind = (attitude.direction_cosines(*(at + s * step * rate)) for s in (1, -1))
    skew = -(ahead - behind) / (2 * step) @ attitude.direction_cosines(*at).T
    omega = attitude.body_rates(at, rate)
    np.testing.assert_allclose([skew[2, 1], skew[0, 2], skew[1, 0]], omega, atol=3e-8)
    np.testing.assert_allclose(attitude.angle_rates(at, omega), rate, rtol=1e-12, atol=1e-12)


def test_the_printed_inverse_lost_its_fraction_bars() -> None:
    """2.3 with SΨ/CΘ where it prints SΨ CΘ is the inverse of 2.4; as printed it is not."""
    tilt, twist = sp.symbols("theta psi")
    s, c = sp.sin, sp.cos
    body = sp.Matrix(
        [[0, c(twist), s(twist) * c(tilt)], [0, -s(twist), c(twist) * c(tilt)], [1, 0, -s(tilt)]]
    )

    def inverse(across: sp.Expr) -> sp.Matrix:
        return sp.Matrix(
            [
                [s(twist) * s(tilt) * across, c(twist) * s(tilt) * across, 1],
                [c(twist), -s(twist), 0],
                [s(twist) * across, c(twist) * across, 0],
            ]
        )

    assert sp.simplify(inverse(1 / c(tilt)) * body) == sp.eye(3)
    assert sp.simplify(inverse(c(tilt)) * body) != sp.eye(3)
    numbers = {tilt: 0.4, twist: -1.1}
    ours = [attitude.angle_rates([0, 0.4, -1.1], e)[[2, 1, 0]] for e in np.eye(3)]
    np.testing.assert_allclose(
        np.array(inverse(1 / c(tilt)).subs(numbers), float), np.transpose(ours), atol=1e-15
    )


@many
@given(st.integers(0, 2**32 - 1))
def test_unwrapping_finds_any_smooth_path(seed: int) -> None:
    """Fourier paths of somersault, tilt and twist with tilt running through ±π/2 again and again.

    Somersault and twist are slow there, so that the path goes through and not by.
    """
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 1, 3001)
    waves = sum(
        rng.normal(size=(3, 1)) * np.sin(2 * np.pi * k * t + rng.uniform(0, 6, (3, 1)))
        for k in (1, 2)
    )
    path = (waves + rng.uniform(-25, 25, (3, 1)) * t).T
    found = attitude.unwrapped_angles(attitude.quaternion_from_angles(*path.T))
    assert (
        apart(attitude.quaternion_from_angles(*found.T), attitude.quaternion_from_angles(*path.T))
        < 1e-13
    )
    second = (
        np.round((path[0, 1] - found[0, 1]) / np.pi) % 2 == 1
        or abs(found[0, 1] - path[0, 1]) > 1e-9
    )
    travelled = path - path[0]
    direction = np.array([1.0, 1.0, 1.0])
    if abs(np.cos(found[0, 1]) - np.cos(path[0, 1])) > 1e-9 and second:
        direction[1] = -1.0  # the same attitudes from the other representation
    np.testing.assert_allclose(found - found[0], travelled * direction, atol=1e-9)


def test_unwrapping_counts_somersaults_and_twists() -> None:
    t = np.linspace(0, 1, 400)
    path = np.stack([2 * np.pi * 3 * t, 0.3 * np.sin(9 * t), -2 * np.pi * 4.5 * t], -1)
    q = attitude.quaternion_from_angles(*path.T)
    signs = np.where(np.arange(400) % 3, 1, -1)[:, None]
    np.testing.assert_allclose(attitude.unwrapped_angles(signs * q), path, atol=1e-12)


def test_unwrapping_sees_a_cartwheel_through_samples_at_the_singularity() -> None:
    """Tilt alone goes round twice, and samples lie on ±π/2 exactly."""
    tilt = np.pi * np.arange(0, 65) / 16
    q = attitude.quaternion_from_angles(0.3, tilt, 0.5)
    found = attitude.unwrapped_angles(q)
    np.testing.assert_allclose(
        found, np.stack([0 * tilt + 0.3, tilt, 0 * tilt + 0.5], -1), atol=1e-14
    )
    begin = attitude.unwrapped_angles(q[8:])  # starts at tilt π/2, so either way up
    assert apart(attitude.quaternion_from_angles(*begin.T), q[8:]) < 1e-14
    np.testing.assert_allclose(np.ptp(begin, axis=0), [0, np.ptp(tilt[8:]), 0], atol=1e-13)


def test_a_path_by_the_singularity_turns_half_a_somersault_and_half_a_twist() -> None:
    tilt = QUARTER - 0.01
    axis = np.linspace(-1, 1, 4001)  # from one side of the pole to the other
    q = attitude.quaternion_product(
        attitude.quaternion_from_angles(0, QUARTER, 0),
        attitude.quaternion_product(
            attitude.quaternion_from_angles(0, axis, 0), attitude.quaternion_from_angles(0.01, 0, 0)
        ),
    )
    fine = attitude.unwrapped_angles(q)
    assert np.abs(np.diff(fine, axis=0)).max() < 0.2
    assert fine[:, 1].max() == pytest.approx(tilt, abs=1e-6)
    assert abs(fine[-1, 0] - fine[0, 0]) == pytest.approx(np.pi, abs=0.1)
    coarse = attitude.unwrapped_angles(q[100::200])  # cannot tell by from through
    assert coarse[-1, 1] == pytest.approx(QUARTER + 0.95, abs=0.02)
    assert apart(attitude.quaternion_from_angles(*coarse.T), q[100::200]) < 1e-14


def test_a_path_of_one_singular_sample_and_bad_samples() -> None:
    q = attitude.quaternion_from_angles(0.2, QUARTER, 0.0)[None]
    np.testing.assert_allclose(attitude.unwrapped_angles(q), [[0.2, QUARTER, 0]], atol=1e-15)
    with pytest.raises(SomersaultError, match="finite"):
        attitude.unwrapped_angles(q * np.nan)
