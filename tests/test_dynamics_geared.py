"""Forward dynamics of geared joints, against others' mass matrices and against gears by hand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from trees import InMujoco, State, assert_close, random_state, random_tree, to_mujoco

from somersault.dynamics import constrained_dynamics, forward_dynamics, link_tree
from somersault.model import GROUND, Body, Joint, Model

TREES = 60
Driven, Follows = dict[int, float], dict[int, tuple[int, float]]


def without_springs(model: Model) -> Model:
    """The same tree, so that only the torques that are given act at the joints."""
    none = {"stiffness": 0.0, "rest": 0.0, "damping": 0.0}
    bodies = [
        replace(body, joints=tuple(replace(joint, **none) for joint in body.joints))
        for body in model.bodies
    ]
    return replace(model, bodies=tuple(bodies))


def drawn(number: int) -> tuple[Model, State, Driven, Follows]:
    """A random tree of five or more bodies at a state, what is driven, and what follows."""
    rng = np.random.default_rng([1995, number])
    model = without_springs(random_tree(rng, bodies=int(rng.integers(5, 9))))
    driven: Driven = {}
    for joint in model.joints:
        if rng.uniform() < 0.25:
            where = model.speed_slice(joint.name)
            driven |= {k: float(rng.normal()) for k in range(where.start, where.stop)}
    single = [model.speed_slice(j.name).start for j in model.joints if j.kind != "ball"]
    leaders = [k for k in single if rng.uniform() < 0.4]
    follows: Follows = {}
    for k in single:
        if leaders and k not in leaders and k not in driven and rng.uniform() < 0.6:
            follows[k] = int(rng.choice(leaders)), float(rng.normal())
    return model, random_state(model, rng), driven, follows


def ours(model: Model, state: State, driven: Mapping, follows: Mapping | None) -> np.ndarray:
    """Accelerations in the variables of the tests: of a free base, those of its origin."""
    tree, ahead = link_tree(model), 6 * model.free
    speeds, torques = state.v[ahead:].tolist(), state.torques.tolist()
    omega, gravity = state.v[:3].tolist() if model.free else [0.0] * 3, state.gravity.tolist()
    given = (tree, state.q.tolist(), omega, speeds, torques, gravity, driven)
    if follows is None:
        alpha, a, joints = forward_dynamics(*given)
    else:
        alpha, a, joints = constrained_dynamics(*given, follows)
    numbers = [float(x) for x in (*alpha, *a, *joints)]
    if not model.free:
        assert numbers[:6] == [0.0] * 6
        return np.array(numbers[6:])
    r, w = np.array(tree.base_com), np.array(omega)
    numbers[3:6] -= np.cross(numbers[:3], r) + np.cross(w, np.cross(w, r))
    return np.array(numbers)


@pytest.mark.parametrize("number", range(TREES))
def test_projected_equations_of_mujoco(number: int) -> None:
    """Sᵀ M S z = Sᵀ (τ − c − M d), with M and c that MuJoCo computes, solved densely."""
    model, state, driven, follows = drawn(number)
    theirs, size, ahead = InMujoco(model, to_mujoco(model), state), len(state.v), 6 * model.free
    mass, bias = theirs.mass_matrix, theirs.inverse_dynamics(np.zeros(size))
    loads = np.concatenate([np.zeros(ahead), state.torques]) - bias
    known, s = np.zeros(size), np.eye(size)
    for k, (leader, factor) in follows.items():
        s[ahead + k] = factor * s[ahead + leader]
        known[ahead + k] = factor * driven.get(leader, 0.0)
    for k, value in driven.items():
        known[ahead + k] = value
    s = np.delete(s, [ahead + k for k in (*driven, *follows)], axis=1)
    wanted = known + s @ np.linalg.solve(s.T @ mass @ s, s.T @ (loads - mass @ known))
    assert_close(ours(model, state, driven, follows), wanted, 1e-10)


def test_the_trees_are_of_every_sort() -> None:
    cases = [drawn(number) for number in range(TREES)]
    gears = [(follows, driven) for _, _, driven, follows in cases]
    assert {model.free for model, *_ in cases} == {True, False}
    assert np.mean([bool(follows) for follows, _ in gears]) > 0.7
    assert any(leader in driven for follows, driven in gears for leader, _ in follows.values())
    assert any(len({k for k, _ in f.values()}) < len(f) for f, _ in gears)


@pytest.mark.parametrize("number", range(0, TREES, 3))
def test_without_gears_it_is_the_articulated_body_algorithm(number: int) -> None:
    model, state, driven, _ = drawn(number)
    assert_close(ours(model, state, driven, {}), ours(model, state, driven, None), 1e-9)


def test_two_wheels_geared() -> None:
    """(I₁ + m² I₂) q̈₁ = τ₁ + m τ₂, and q̈₂ = m q̈₁."""
    round_ = ((0.5, 0.0, 0.0), (0.0, 0.5, 0.0), (0.0, 0.0, 0.5))
    bodies = [
        Body(name, GROUND, 1.0, (0.0, 0.0, 0.0), round_, joints=(Joint(name, "hinge", armature=a),))
        for name, a in (("first", 0.1), ("second", 0.0))
    ]
    model = Model("wheels", False, tuple(bodies))
    state = State(np.zeros(4), np.zeros(2), np.array([1.0, -3.0]), np.array([2.0, 5.0]), np.ones(3))
    first = (2.0 - 3.0 * 5.0) / (0.6 + 9.0 * 0.5)
    assert_close(ours(model, state, {}, {1: (0, -3.0)}), [first, -3.0 * first], 1e-14)


def test_over_symbols_it_is_the_same() -> None:
    """A factor, accelerations and the state may be symbols."""
    model, state, _, _ = drawn(0)
    n, ahead = len(model.speeds), 6 * model.free
    x = [ca.SX.sym(name, k) for name, k in (("q", len(state.q)), ("v", len(state.v)), ("m", 2))]
    q, v, m = ([part[k] for k in range(part.numel())] for part in x)
    omega, zero = v[:3] if model.free else [0.0] * 3, [0.0] * n
    first, second, third = [
        model.speed_slice(joint.name).start for joint in model.joints if joint.kind != "ball"
    ][:3]
    given = link_tree(model), q, omega, v[ahead:], zero, [0.0] * 3
    _, _, joints = constrained_dynamics(*given, {first: m[0]}, {third: (second, m[1])})
    value = ca.Function("f", x, [ca.vertcat(*joints)])(state.q, state.v, [0.7, -1.3])
    still = replace(state, torques=np.zeros(n), gravity=np.zeros(3))
    wanted = ours(model, still, {first: 0.7}, {third: (second, -1.3)})
    assert_close(np.array(value).ravel(), wanted[ahead:], 1e-12)
