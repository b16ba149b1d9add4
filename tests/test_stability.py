"""Spins and their stability, by what physics says of them whatever the numbers are."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment
from trees import random_rotation, random_tree

from somersault.model import Body, Model, load
from somersault.model._weld import as_matrix, as_vector
from somersault.stability import Spin, spin

ORIGIN = (0.0, 0.0, 0.0)
RANKS = ("minor", "intermediate", "major")
TURNS = ("tilt", "somersault", "twist")
GROWS = 1e-6  # what counts as growth, in units of the spin rate
few = settings(derandomize=True, max_examples=25, deadline=None)
spreads = st.tuples(*[st.floats(0.05, 1.0)] * 3)  # of mass along each axis


def rigid(inertias: np.ndarray) -> Model:
    return Model("rigid", True, (Body("body", -1, 1.0, ORIGIN, as_matrix(np.diag(inertias))),))


def inertias_of(spread: tuple[float, float, float]) -> np.ndarray:
    """Principal inertias that some body can have, none equal to another."""
    inertias = sum(spread) - np.array(spread)
    gaps = np.abs(np.subtract.outer(inertias, inertias))[np.triu_indices(3, 1)]
    assume(gaps.min() > 0.02 * inertias.max())
    return inertias


@cache
def tree(number: int) -> Spin:
    """A random body of two to four parts with hinges and slides, in some pose."""
    rng = np.random.default_rng([7, number])
    model = random_tree(rng, 2 + number % 3, True, ("hinge", "slide"))
    sizes = {joint.name: 0.2 if joint.kind == "slide" else 1.0 for joint in model.joints}
    pose = {j.name: j.reference + sizes[j.name] * rng.normal() for j in model.joints}
    return spin(model, RANKS[number % 3], pose)


def pose_of(spun: Spin) -> dict[str, float]:
    return dict(zip(spun.model.coordinates, spun.pose.tolist(), strict=True))


def numbers(spun: Spin, low: float, high: float, seed: int = 0) -> dict[str, float]:
    """A number for each joint, as springs and dampers take them."""
    rng = np.random.default_rng(seed)
    return {joint.name: rng.uniform(low, high) for joint in spun.model.joints}


def roots_of(m: np.ndarray, c: np.ndarray, k: np.ndarray) -> np.ndarray:
    n = len(m)
    below = -np.linalg.solve(m, np.hstack([k, c]))
    return np.linalg.eigvals(np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), below]))


def assert_same_roots(one: np.ndarray, other: np.ndarray, tolerance: float = 1e-8) -> None:
    """The same set in any order; the double zero, which rounding splits, more roughly."""
    assert len(one) == len(other)
    gap = np.abs(one[:, None] - other[None, :])
    allowed = np.where(np.abs(one) < 1e-5, 1e-5, tolerance * (1 + np.abs(one).max()))
    assert np.all(gap[linear_sum_assignment(gap)] < allowed)


# ------------------------------------------------------------------ one rigid body, chapter 2


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
    assert_same_roots(system.roots, np.array([1j, -1j, root, -root, 0, 0]))
    assert system.stable == (product > 0) == (axis != "intermediate")
    grown = np.exp(2 * np.pi * np.sqrt(max(-product, 0.0)))
    assert system.growth_per_somersault == pytest.approx(grown, rel=1e-7)
    assert system.energy_signature == ("definite" if axis != "intermediate" else "unstable")
    low, high = system.potential
    assert {"minor": high < 0, "intermediate": low < 0 < high, "major": low > 0}[axis]


# -------------------------------------------------------------------- energy and damping


def springs(number: int) -> list[dict[str, float]]:
    """Soft, middling and stiff springs for the joints of a tree, some of them negative."""
    ranges = [(-1, 1), (0, 2), (1, 4), (3, 30), (20, 90)]
    return [numbers(tree(number), *r, seed=number + s) for s in range(4) for r in ranges]


@pytest.mark.parametrize("number", range(12))
def test_damping_destroys_what_is_gyroscopic_and_only_that(number: int) -> None:
    """Thomson, Tait and Chetaev, and the parity of negative directions of the energy."""
    spun = tree(number)
    damping = numbers(spun, 0.05, 0.2, number)
    for stiffness in springs(number):
        system = spun.linear(stiffness)
        damped = spun.linear(stiffness, damping)
        negative = int(np.sum(system.potential < 0))
        assert damped.energy_signature == system.energy_signature
        if system.energy_signature == "definite":
            assert negative == 0
            assert system.stable
            assert damped.growth_rate <= GROWS
        elif system.energy_signature == "gyroscopic":
            assert negative > 0
            assert negative % 2 == 0
            assert system.stable
            assert damped.growth_rate > 1e-9
        else:
            assert not system.stable
            assert damped.growth_rate > 1e-9
        if negative % 2:
            assert system.energy_signature == "unstable"
            assert np.any((np.abs(system.roots.imag) < 1e-9) & (system.roots.real > GROWS))


def test_the_trees_are_of_all_three_sorts() -> None:
    found = Counter(
        (tree(n).linear(stiffness).energy_signature) for n in range(12) for stiffness in springs(n)
    )
    assert min(found[name] for name in ("definite", "gyroscopic", "unstable")) > 10


def test_modes_of_negative_energy_are_those_that_damping_feeds() -> None:
    """Each oscillation's signature says which way a small damper moves its root."""
    fed = 0
    for number in range(12):
        spun = tree(number)
        for stiffness in springs(number):
            system = spun.linear(stiffness)
            if system.energy_signature != "gyroscopic":
                continue
            after = spun.linear(stiffness, dict.fromkeys(stiffness, 1e-5)).roots
            for mode in system.modes:
                gaps = np.sort(np.abs(system.roots - mode.root))
                moved = after[np.argmin(np.abs(after - mode.root))] - mode.root
                if mode.energy and gaps[1] > 1e-2 and abs(moved.real) > 1e-11:
                    assert np.sign(moved.real) == -mode.energy
                    fed += mode.energy < 0
    assert fed > 20


# ------------------------------------------------------------------- limits and invariance


@pytest.mark.parametrize("number", [0, 1, 4, 8])
def test_a_locked_joint_is_a_very_stiff_spring(number: int) -> None:
    spun = tree(number)
    joints = [joint.name for joint in spun.model.joints]
    for names in ([joints[-1]], joints):
        free = numbers(spun, 0, 2)
        locked = spun.linear({n: free[n] for n in joints if n not in names}, lock=names)
        count = len(locked.roots)
        gaps = []
        for stiffness in (1e5, 1e7):
            roots = spun.linear({**free, **dict.fromkeys(names, stiffness)}).roots
            slow = roots[np.argsort(np.abs(roots))][:count]
            gap = np.abs(slow[:, None] - locked.roots[None, :])
            far = gap[linear_sum_assignment(gap)]
            gaps.append(far[np.abs(slow) > 1e-4].max())
        assert gaps[1] < 1e-4
        assert gaps[1] < 0.1 * gaps[0] + 1e-8
    product = np.prod(list(spun.inertia_ratios.values()))
    root = np.emath.sqrt(-product)
    assert_same_roots(spun.linear(lock="all").roots, np.array([1j, -1j, root, -root, 0, 0]))


def scaled(model: Model, mass: float, length: float) -> Model:
    """Every mass times one number, every length times another."""

    def of_body(body: Body) -> Body:
        turning = mass * length**2
        joints = tuple(
            replace(
                joint,
                anchor=as_vector(np.array(joint.anchor) * length),
                reference=joint.reference * (length if joint.kind == "slide" else 1),
                armature=joint.armature * (mass if joint.kind == "slide" else turning),
            )
            for joint in body.joints
        )
        return replace(
            body,
            mass=body.mass * mass,
            com=as_vector(np.array(body.com) * length),
            inertia=as_matrix(np.array(body.inertia) * turning),
            position=as_vector(np.array(body.position) * length),
            joints=joints,
        )

    return replace(model, bodies=tuple(map(of_body, model.bodies)))


@pytest.mark.parametrize(("mass", "length"), [(7.0, 1.0), (1.0, 0.3), (0.02, 5.0)])
def test_roots_do_not_depend_on_the_units(mass: float, length: float) -> None:
    for number in (0, 3, 7):
        spun = tree(number)
        pose = pose_of(spun)
        for joint in spun.model.joints:
            pose[joint.name] *= length if joint.kind == "slide" else 1
        other = spin(scaled(spun.model, mass, length), spun.axis, pose)
        stiffness, damping = numbers(spun, -1, 3), numbers(spun, 0, 1)
        one, two = (s.linear(stiffness, damping) for s in (spun, other))
        assert_same_roots(one.roots, two.roots)
        assert one.growth_rate == pytest.approx(two.growth_rate, abs=1e-8)


def turned(model: Model, turn: np.ndarray) -> Model:
    """The same body with another choice of axes for its base."""

    def out(vector: tuple[float, float, float]) -> tuple[float, float, float]:
        return as_vector(turn @ np.array(vector))

    def of_body(body: Body) -> Body:
        if body.parent < 0:
            inertia = as_matrix(turn @ np.array(body.inertia) @ turn.T)
            return replace(body, com=out(body.com), inertia=inertia)
        if body.parent > 0:
            return body
        rotation = as_matrix(turn @ np.array(body.rotation))
        return replace(body, position=out(body.position), rotation=rotation)

    return replace(model, bodies=tuple(map(of_body, model.bodies)))


@pytest.mark.parametrize("number", [0, 1, 2, 5])
def test_roots_do_not_depend_on_the_base_axes(number: int) -> None:
    spun, axis = tree(number), RANKS[number % 3]
    turn = random_rotation(np.random.default_rng(number))
    other = spin(turned(spun.model, turn), axis, pose_of(spun))
    stiffness, damping = numbers(spun, -1, 3), numbers(spun, 0, 1)
    one, two = (s.linear(stiffness, damping) for s in (spun, other))
    assert_same_roots(one.roots, two.roots)
    np.testing.assert_allclose(one.potential, two.potential, atol=1e-8 * one.potential.max())
    assert dict(spun.holding_torques) == pytest.approx(dict(other.holding_torques), abs=1e-8)
    assert np.sort(spun.principal_inertias) == pytest.approx(np.sort(other.principal_inertias))


def test_mirrored_coordinates_change_no_root() -> None:
    """Against the left and right joints themselves, and against a body that is no mirror image."""
    spun = spin("furrer", 2, {"shoulder": 1.3})
    springs_ = np.diag([0, 0, 0, *np.array(list(spun.outboard_inertias.values()))])
    for stiffness, damping in ((1.2, 0.0), (0.3, 0.4), (-1.0, 0.0)):
        system = spun.linear({"shoulder": stiffness}, {"shoulder": damping})
        rate = spun.gyric_matrix + damping * springs_
        own = spun.stiffness_matrix + stiffness * springs_
        assert_same_roots(system.roots, roots_of(spun.mass_matrix, rate, own), 1e-7)
    body, left, right = load("furrer").bodies
    lame = Model("lame", True, (body, left, replace(right, mass=right.mass * (1 + 1e-5))))
    pose = {"left_shoulder": 1.3, "right_shoulder": -1.3}
    both = dict.fromkeys(pose, 0.4)
    other = spin(lame, 2, pose).linear(both)
    assert set(other.coordinates) == {*TURNS, *pose}
    assert_same_roots(spun.linear(both).roots, other.roots, 1e-4)


@pytest.mark.parametrize("number", range(6))
def test_undamped_roots_are_symmetric(number: int) -> None:
    roots = tree(number).linear(numbers(tree(number), -1, 3)).roots
    for mirrored in (-roots, roots.conj(), -roots.conj()):
        assert_same_roots(roots, mirrored)


def test_the_system_is_a_conservative_gyric_one() -> None:
    """Section 2.3.1: M = Mᵀ > 0, G = −Gᵀ, K = Kᵀ, D ≥ 0 and of the joints alone."""
    for number in range(6):
        spun = tree(number)
        system = spun.linear(numbers(spun, -1, 3), numbers(spun, 0, 1))
        size = np.abs(system.M).max() * 1e-9
        np.testing.assert_allclose(system.M, system.M.T, atol=size)
        np.testing.assert_allclose(system.G, -system.G.T, atol=size)
        np.testing.assert_allclose(system.K, system.K.T, atol=size)
        assert np.linalg.eigvalsh(system.M).min() > 0
        turns = [system.coordinates.index(turn) for turn in TURNS]
        assert not system.D[turns].any()
        assert not system.K_springs[:, turns].any()
