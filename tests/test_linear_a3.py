"""The derived linear equations against those the thesis prints (chapters 2 and 4, appendix A.3)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import scipy.optimize
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from reference_a3 import (
    ATHLETES,
    FURRER,
    SIMPLEST,
    growth_rate,
    matrices,
    nondimensional,
    springs,
)

from somersault.model import Body, Model, as_matrix
from somersault.stability import spin, stable_ranges

ORIGIN = (0.0, 0.0, 0.0)
TURNS = ("tilt", "somersault", "twist")
RANKS = ("minor", "intermediate", "major")
FIVE = ("tilt", "twist", "antisymmetric shoulder", "somersault", "symmetric shoulder")
ANGLES = np.linspace(0, 3, 13)
SUBSYSTEMS = {None: (0, 1, 2, 3, 4), "tilt": (0, 1, 2), "somersault": (3, 4)}
EDGE = 1e-6  # of a stable range
few = settings(derandomize=True, max_examples=25, deadline=None)
spreads = st.tuples(*[st.floats(0.05, 1.0)] * 3)  # of mass along each axis


# ------------------------------------------------------------------ one rigid body, eqs. 2.11–2.14


@few
@given(spreads, st.sampled_from((1, 2, 3)))
def test_rigid_body_is_equation_2_11(spread: tuple[float, float, float], axis: int) -> None:
    inertias = inertias_of(spread)
    spun = spin(rigid(inertias), axis)
    system = spun.linear()
    first, about, last = (axis - 2) % 3, axis - 1, axis % 3  # 1, 2, 3 for a somersault
    at = np.ix_(*[[system.coordinates.index(TURNS[i]) for i in (first, last)]] * 2)
    i1, i2, i3 = inertias[[first, about, last]]
    gyric = np.array([[0, -(i2 - i3 - i1)], [i2 - i3 - i1, 0]])
    near = {"rtol": 0, "atol": 1e-9 * inertias.max()}
    np.testing.assert_allclose(system.M[at], np.diag([i1, i3]), **near)
    np.testing.assert_allclose(system.G[at], gyric, **near)
    np.testing.assert_allclose(system.K[at], np.diag([i2 - i3, i2 - i1]), **near)
    assert spun.inertia_ratios == pytest.approx({"k1": (i2 - i3) / i1, "k3": (i2 - i1) / i3})


@few
@given(spreads, st.sampled_from(RANKS))
def test_rigid_body_roots_and_energy(spread: tuple[float, float, float], axis: str) -> None:
    """Eqs. 2.12–2.14: ±i and ±√(−k1 k3), so only the intermediate axis is unstable."""
    spun = spin(rigid(inertias_of(spread)), axis)
    system = spun.linear()
    product = float(np.prod(list(spun.inertia_ratios.values())))
    root = np.emath.sqrt(-product)
    polynomial = np.poly([1j, -1j, root, -root, 0, 0])
    np.testing.assert_allclose(np.poly(system.roots), polynomial, rtol=0, atol=1e-9)
    assert system.stable == (product > 0) == (axis != "intermediate")
    grown = np.exp(2 * np.pi * np.sqrt(max(-product, 0.0)))
    assert system.growth_per_somersault == pytest.approx(grown, rel=1e-7)
    assert system.energy_signature == ("definite" if axis != "intermediate" else "unstable")
    low, high = system.potential
    assert {"minor": high < 0, "intermediate": low < 0 < high, "major": low > 0}[axis]


@pytest.mark.parametrize(("gap", "stable"), [(3e-10, False), (3e-12, False), (3e-15, True)])
def test_growth_counts_where_it_can_be_known(gap: float, stable: bool) -> None:
    """√(gap/3) = 1e-5 and 1e-6 are growth; 3e-8, what rounding makes of a double root, is none."""
    system = spin(rigid(np.array([1.0, 1.0 + gap, 1.5])), 2).linear()
    assert system.growth_rate == pytest.approx(np.sqrt(gap / 3), rel=0.1, abs=1e-7)
    assert system.stable == stable


def rigid(inertias: np.ndarray) -> Model:
    return Model("rigid", True, (Body("body", -1, 1.0, ORIGIN, as_matrix(np.diag(inertias))),))


def inertias_of(spread: tuple[float, float, float]) -> np.ndarray:
    """Principal inertias that some body can have, none equal to another."""
    inertias = sum(spread) - np.array(spread)
    gaps = np.abs(np.subtract.outer(inertias, inertias))[np.triu_indices(3, 1)]
    assume(gaps.min() > 0.02 * inertias.max())
    return inertias


# ------------------------------------------------------------- five degrees of freedom, A.3


def assert_equal(name: str, angle: float) -> None:
    """M, G, K of a model at an arm angle are the printed ones, entry by entry."""
    system = spin(name, 2, {"shoulder": angle}).linear()
    assert set(system.coordinates) == set(FIVE)
    order = [system.coordinates.index(coordinate) for coordinate in FIVE]
    at = np.ix_(order, order)
    for ours, printed in zip(
        (system.M, system.G, system.K), matrices(ATHLETES[name], angle), strict=True
    ):
        np.testing.assert_allclose(ours[at], printed, rtol=0, atol=1e-9 * np.abs(printed).max())


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("name", ATHLETES)
def test_every_element_at_many_arm_angles(name: str, angle: float) -> None:
    assert_equal(name, angle)


@few
@given(st.sampled_from(sorted(ATHLETES)), st.floats(0, 3))
def test_every_element_at_any_arm_angle(name: str, angle: float) -> None:
    assert_equal(name, angle)


@pytest.mark.parametrize("name", ATHLETES)
def test_the_order_and_the_zeros_are_those_of_the_thesis(name: str) -> None:
    """Eqs. 4.2–4.6: where they print 0 there is nothing, so the system falls in two."""
    system = spin(name, 2, {"shoulder": 1.3}).linear({"shoulder": 1.1}, {"shoulder": 0.5})
    assert system.coordinates == FIVE
    assert system.subsystems == (FIVE[:3], FIVE[3:])
    athlete = ATHLETES[name]
    m, g, k = matrices(athlete, 1.3)
    printed = {"M": m, "G": g, "K": k}
    printed |= {"D": springs(athlete, 0.5), "K_springs": springs(athlete, 1.1)}
    for what, wanted in printed.items():
        ours, scale = getattr(system, what), np.abs(wanted).max()
        assert np.abs(ours[wanted == 0]).max() < 1e-12 * scale, what
        assert np.abs(ours[wanted != 0]).min() > 1e-3 * scale, what
        np.testing.assert_allclose(ours, wanted, rtol=0, atol=1e-9 * scale)


def test_furrer_at_1_3() -> None:
    """Numbers computed apart from all of this, to the four decimals given."""
    system = spin("furrer", 2, {"shoulder": 1.3}).linear()
    m = {(0, 0): 12.9553, (0, 2): 0.8831, (1, 1): 2.1582, (2, 2): 0.7657}
    m |= {(3, 3): 11.0645, (4, 4): 0.7156}
    g = {(0, 1): 4.0490, (1, 2): -2.1036, (3, 4): 1.2416}
    k = {(0, 0): 8.9063, (0, 2): -1.2204, (1, 1): -1.8908, (2, 2): -0.8802, (4, 4): -0.8260}
    for matrix, numbers in ((system.M, m), (system.G, g), (system.K, k)):
        for place, number in numbers.items():
            assert matrix[place] == pytest.approx(number, abs=5.1e-5)


def test_shoulder_inertias() -> None:
    """I_sh: 0.384934 kg m² for Furrer, and 3.02e-4 for the weighted doll (section 5.5)."""
    assert FURRER.shoulder_inertia == pytest.approx(0.384934, abs=5e-7)
    for name, athlete in ATHLETES.items():
        for angle in (0.0, 1.3, 2.9):
            inertias = spin(name, 2, {"shoulder": angle}).outboard_inertias
            assert dict(inertias) == pytest.approx(
                dict.fromkeys(("left_shoulder", "right_shoulder"), athlete.shoulder_inertia)
            )
    assert ATHLETES["doll_weighted"].shoulder_inertia == pytest.approx(3.02e-4, rel=5e-3)


# ---------------------------------------------------------------------- the simplest model


def test_simplest_model_is_table_4_2() -> None:
    system = spin("simplest").linear().subsystem("tilt")
    assert system.coordinates == ("tilt", "twist", "arm")
    for ours, printed in zip((system.M, system.G, system.K), SIMPLEST.matrices(), strict=True):
        np.testing.assert_allclose(ours, printed, rtol=0, atol=1e-12)


def test_simplest_model_is_equation_4_11() -> None:
    """The non-dimensional equations have the roots of the model they come from."""
    numbers = SIMPLEST.nondimensional()
    spun = spin("simplest")
    assert spun.inertia_ratios == pytest.approx({k: numbers[k] for k in ("k1", "k3")})
    for stiffness in (-0.5, 0.3, 1.02, 2.0):
        m, g, k = nondimensional(
            numbers["k1"], numbers["k3"], numbers["I_rel"], numbers["kl1"], stiffness
        )
        growth = spun.linear({"arm": stiffness}).growth_rate
        assert growth == pytest.approx(float(growth_rate(m, g, k)), abs=1e-7)


def test_simplest_model_with_table_4_3_is_stable_from_0_98_to_1_08() -> None:
    """Section 4.4.2 prints the range; the model that ships differs only by its k1 and k3."""
    at = np.linspace(0.9, 1.2, 3001)
    m, g, _ = nondimensional(0.65, -0.87, 0.06, -0.99, 0.0)
    k = np.array([nondimensional(0.65, -0.87, 0.06, -0.99, x)[2] for x in at])
    stable = at[growth_rate(m, g, k) < EDGE]
    assert (stable.min(), stable.max()) == pytest.approx((0.976, 1.080), abs=1e-3)


def test_simplest_model_stable_range() -> None:
    m, g, k = SIMPLEST.matrices()
    arm = np.diag([0.0, 0.0, SIMPLEST.Il[0]])
    wanted = edges(lambda x: growth_rate(m, g, k + x[:, None, None] * arm), -1.0, 2.0)
    assert_same_ranges(stable_ranges("simplest", ("stiffness.arm", -1.0, 2.0)), wanted)
    assert len(wanted) == 1


# --------------------------------------------------------------------------- stable ranges

Growth = Callable[[np.ndarray], np.ndarray]


def edges(growth: Growth, low: float, high: float) -> list[tuple[float, float]]:
    """Where it is stable, from a scan of our own and halving."""
    at = np.linspace(low, high, 601)
    inside = growth(at) < EDGE
    found = [low] if inside[0] else []
    for i in np.flatnonzero(inside[1:] != inside[:-1]):
        found.append(scipy.optimize.bisect(lambda x: crossing(growth, x), at[i], at[i + 1]))
    found += [high] if inside[-1] else []
    return list(zip(found[::2], found[1::2], strict=True))


def crossing(growth: Growth, x: float) -> float:
    return 1.0 if float(growth(np.array([x]))[0]) > EDGE else -1.0


def assert_same_ranges(ours: list[tuple[float, float]], wanted: list[tuple[float, float]]) -> None:
    assert len(ours) == len(wanted)
    np.testing.assert_allclose(
        np.reshape(ours, (-1, 2)), np.reshape(wanted, (-1, 2)), rtol=0, atol=1e-6
    )


@pytest.mark.parametrize("subsystem", SUBSYSTEMS)
@pytest.mark.parametrize("angle", [0.2, 0.5, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.3, 2.6, 2.9])
def test_stable_ranges_are_those_of_the_printed_equations(
    angle: float, subsystem: str | None
) -> None:
    """The systems of five, three and two degrees of freedom, every island and every edge."""
    name = "doll_weighted" if angle in (0.5, 1.4, 2.0) else "furrer"
    at = np.ix_(SUBSYSTEMS[subsystem], SUBSYSTEMS[subsystem])
    m, g, k = (matrix[at] for matrix in matrices(ATHLETES[name], angle))
    spring = springs(ATHLETES[name], 1.0)[at]
    ours = stable_ranges(
        name,
        ("stiffness.shoulder", -2.0, 4.0),
        fixed={"pose.shoulder": angle},
        subsystem=subsystem,
        samples=601,
    )
    wanted = edges(lambda x: growth_rate(m, g, k + x[:, None, None] * spring), -2.0, 4.0)
    assert_same_ranges(ours, wanted)


@pytest.mark.parametrize(
    ("angle", "low", "high"),
    [(1.2, 0.94, 1.34), (1.4, 0.82, 1.32), (1.6, 0.56, 1.12), (1.8, 0.18, 0.74)],
)
def test_furrer_stable_stiffnesses_in_steps_of_0_02(angle: float, low: float, high: float) -> None:
    spun = spin("furrer", 2, {"shoulder": angle})
    steps = np.arange(-100, 201) * 0.02
    stable = [x for x in steps if spun.linear({"shoulder": x}).stable]
    assert (stable[0], stable[-1]) == pytest.approx((low, high))
    assert len(stable) == round((high - low) / 0.02) + 1


@pytest.mark.parametrize("angle", [0.4, 2.6])
def test_furrer_has_no_stable_stiffness_with_the_arms_down_or_up(angle: float) -> None:
    pose = {"pose.shoulder": angle}
    assert stable_ranges("furrer", ("stiffness.shoulder", -2.0, 4.0), fixed=pose) == []


def test_rigid_furrer_grows_by_ten_in_2_97_rad() -> None:
    """Section 4.3.1 with table 4.1's own numbers: k1 = 0.687, k3 = −0.876."""
    spun = spin("furrer", 2, {"shoulder": 1.3})
    assert spun.inertia_ratios == pytest.approx({"k1": 0.687, "k3": -0.876}, abs=5e-4)
    assert np.log(10) / spun.linear(lock="all").growth_rate == pytest.approx(2.97, abs=5e-3)
