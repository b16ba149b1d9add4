"""Roots of sprung joints at rest, and stable ranges of many cases."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from trees import random_tree

import somersault as so
from somersault import SomersaultError
from somersault.dynamics import Equations
from somersault.model import Body, Follow, Joint, Model
from somersault.stability import joint_roots, spin, stable_ranges, stable_ranges_by_case

BOX = ((0.2, 0.0, 0.0), (0.0, 0.3, 0.0), (0.0, 0.0, 0.4))


def two(base: float, tip: float) -> Model:
    """Two bodies on one hinge through both centres of mass, whose inertias about it these are."""

    def round_(size: float) -> tuple:
        return tuple(tuple(size * (i == j) for j in range(3)) for i in range(3))

    at = (0.0, 0.0, 0.0)
    hinge = Joint("hinge", "hinge", (0.0, 1.0, 0.0))
    tip_ = Body("tip", 0, 1.0, at, round_(tip), joints=(hinge,))
    return Model("two", True, (Body("base", -1, 1.0, at, round_(base)), tip_))


def test_two_wheels_on_one_spring() -> None:
    """ω² = k (1/I₁ + 1/I₂), and ζ = b ω / 2k; with the base clamped ω² = k/I₂."""
    k, b, one, other = 3.0, 0.2, 0.5, 0.1
    model = two(one, other)
    square = k * (1 / one + 1 / other)
    roots = joint_roots(model, stiffness={"hinge": k}, damping={"hinge": b})
    zeta = b * np.sqrt(square) / (2 * k)
    wanted = np.sqrt(square) * (-zeta + 1j * np.sqrt(1 - zeta**2))
    assert sorted(roots, key=np.imag) == pytest.approx([wanted.conj(), wanted])
    clamped = so.load(model, base="fixed")
    assert abs(joint_roots(clamped, stiffness={"hinge": k})) == pytest.approx(np.sqrt(k / other))


@pytest.mark.parametrize("seed", range(4))
def test_they_are_the_slow_eigenvalues_of_the_dynamics_themselves(seed: int) -> None:
    """Finite differences of the forward dynamics at rest, which know of no elimination."""
    rng = np.random.default_rng(seed)
    model = random_tree(rng, 3, True, ("hinge", "slide"))
    names = [joint.name for joint in model.joints]
    springs = dict(zip(names, rng.uniform(1, 20, len(names)).tolist(), strict=True))
    dampers = dict(zip(names, rng.uniform(0, 0.5, len(names)).tolist(), strict=True))
    k, d = np.array(list(springs.values())), np.array(list(dampers.values()))
    equations = Equations(model)
    n = len(names)

    own_k, own_d, rest = (
        np.array([getattr(joint, what) for joint in model.joints])
        for what in ("stiffness", "damping", "rest")
    )

    def accelerations(state: np.ndarray) -> np.ndarray:
        """With the model's own springs and dampers taken out, so that the given ones act alone."""
        x, rates = state[:n], state[n:]
        torques = (own_d - d) * rates - k * x + own_k * (model.home + x - rest)
        return equations.forward_dynamics(model.home + x, np.append(np.zeros(6), rates), torques)[
            6:
        ]

    step = 1e-5
    jacobian = np.array(
        [(accelerations(e) - accelerations(-e)) / (2 * step) for e in step * np.eye(2 * n)]
    ).T
    first = np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), jacobian])
    wanted = np.linalg.eigvals(first)
    found = joint_roots(model, stiffness=springs, damping=dampers)
    assert np.abs(found[:, None] - wanted).min(1).max() < 1e-5 * np.abs(wanted).max()
    assert len(found) == 2 * n


def test_pairs_and_locks_by_their_names() -> None:
    sprung = joint_roots("furrer", {"shoulder": 1.0}, stiffness={"shoulder": 2.0})
    sides = {"left_shoulder": 2.0, "right_shoulder": 2.0}
    apart = joint_roots("furrer", {"left_shoulder": 1.0, "right_shoulder": -1.0}, stiffness=sides)
    np.testing.assert_allclose(sprung, apart)
    assert len(joint_roots("furrer", stiffness={"shoulder": 2.0}, lock="left_shoulder")) == 2
    assert not len(joint_roots("furrer", lock="all"))
    with pytest.raises(SomersaultError, match="'elbow'"):
        joint_roots("furrer", stiffness={"elbow": 1.0})


def test_cases_are_single_ranges_one_after_the_other() -> None:
    angles = np.array([0.2, 1.1, 1.3, 2.9])
    along = ("stiffness.shoulder", -2.0, 4.0)
    many = stable_ranges_by_case("furrer", along, pose={"shoulder": angles})
    for angle, ranges in zip(angles, many, strict=True):
        one = stable_ranges("furrer", along, pose={"shoulder": float(angle)})
        assert len(ranges) == len(one)
        for ours, theirs in zip(ranges, one, strict=True):
            assert ours == pytest.approx(theirs, abs=1e-9)


def test_each_call_knows_how_many_cases_it_is_for() -> None:
    along = ("stiffness.shoulder", -2.0, 4.0)
    with pytest.raises(SomersaultError, match="stable_ranges_by_case"):
        stable_ranges("furrer", along, pose={"shoulder": [1.0, 1.2]})
    with pytest.raises(SomersaultError, match="stable_ranges for one case"):
        stable_ranges_by_case("furrer", along, pose={"shoulder": 1.0})
    with pytest.raises(SomersaultError, match="varied and fixed at once"):
        stable_ranges("furrer", along, stiffness={"shoulder": 1.0})


# ------------------------------------------------------------------- joints that follow others


def geared(factor: float, offset: float) -> tuple[Model, Model]:
    """A body with an arm of two links, whose second joint follows the first; and the same free."""
    model = random_tree(np.random.default_rng(31), 4, True, ("hinge",))
    leader, follower = model.joints[0].name, model.joints[1].name

    def with_follow(body: Body) -> Body:
        joints = tuple(
            replace(j, follows=Follow(leader, factor, offset)) if j.name == follower else j
            for j in body.joints
        )
        return replace(body, joints=joints)

    return replace(model, bodies=tuple(map(with_follow, model.bodies))), model


@pytest.mark.parametrize("factor", [-1.0, 0.5])
def test_a_joint_that_follows_is_a_gear_without_play(factor: float) -> None:
    """The slow roots of a gear spring that gets ever stiffer, k (q₂ − m q₁)²/2."""
    bound, loose = geared(factor, 0.2)
    leader, follower, *others = [joint.name for joint in loose.joints]
    pose = {leader: 0.3, **dict.fromkeys(others, 0.1)}
    followed = spin(bound, "major", pose)
    free = spin(loose, "major", {**pose, follower: 0.2 + factor * 0.3})
    springs, dampers = dict.fromkeys(loose.speeds, 2.0), {follower: 0.1}
    system = followed.linear(springs, dampers)
    assert len(system.coordinates) == len(loose.joints) + 2
    assert follower not in system.coordinates
    whole = free.linear(springs, dampers)
    gear = np.zeros(len(whole.coordinates))
    gear[whole.coordinates.index(follower)], gear[whole.coordinates.index(leader)] = 1.0, -factor
    gaps = []
    for k in (1e6, 1e8):
        stiff = replace(whole, K_springs=whole.K_springs + k * np.outer(gear, gear))
        slow = stiff.roots[np.argsort(np.abs(stiff.roots))][: len(system.roots)]
        far = np.abs(slow[:, None] - system.roots).min(1)
        gaps.append(far[np.abs(slow) > 1e-3].max())
    assert gaps[1] < 1e-5
    assert gaps[1] < 0.1 * gaps[0] + 1e-8
    assert np.allclose(spin(bound, "major", pose).pose, free.pose)


def test_locking_a_leader_or_what_follows_locks_both() -> None:
    bound, loose = geared(0.5, 0.0)
    leader, follower, *_ = [joint.name for joint in loose.joints]
    names = [spin(bound, "major").linear(lock=name).coordinates for name in (leader, follower)]
    assert names[0] == names[1]
    assert not {leader, follower} & set(names[0])
    assert len(joint_roots(bound, lock=leader)) == 2 * (len(loose.joints) - 2)
