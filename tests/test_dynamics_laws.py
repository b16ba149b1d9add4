"""What must hold of the dynamics whoever computes them: laws, closed forms, derivatives."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from trees import (
    State,
    assert_close,
    coordinate_rates,
    random_inertia,
    random_state,
    random_tree,
    unit,
)

from somersault import SomersaultError
from somersault.dynamics import Equations
from somersault.model import GROUND, Body, Joint, Model, load

SEEDS = range(6)
POINT = ((0.0, 0.0, 0.0),) * 3
ROUND = ((0.4, 0.0, 0.0), (0.0, 0.4, 0.0), (0.0, 0.0, 0.4))
ORIGIN = (0.0, 0.0, 0.0)
UP = (0.0, 0.0, 1.0)
repeatable = settings(derandomize=True, deadline=None, max_examples=60)
angles = st.floats(-10.0, 10.0)


@cache
def tree(seed: int, free: bool) -> Equations:
    """Equations of a random tree of three to five bodies."""
    rng = np.random.default_rng([64, seed])
    return Equations(random_tree(rng, bodies=3 + seed % 3, free=free))


def states(equations: Equations, seed: int, gravity: bool = True) -> State:
    return random_state(equations.model, np.random.default_rng([65, seed]), gravity)


def single(mass: float, com: Any, inertia: Any, *joints: Joint) -> Model:
    """One body, hung from the ground by `joints` or, without any, in the air."""
    return Model("single", not joints, (Body("body", GROUND, mass, com, inertia, joints=joints),))


# ------------------------------------------------------------------------------ derivatives


@pytest.mark.parametrize("argument", ["q", "v", "torques", "gravity", "parameters"])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_derivative_is_that_of_the_value(seed: int, argument: str) -> None:
    model = tree(seed, free=seed != 1).model
    joint = next(joint for joint in model.joints if joint.kind != "ball")
    parts = [f"bodies.{model.bodies[0].name}.mass", f"bodies.{model.bodies[-1].name}.com.2"]
    parts += [f"bodies.{model.bodies[1].name}.inertia.12"]
    parts += [f"joints.{joint.name}.{kind}" for kind in ("stiffness", "rest", "damping")]
    equations = Equations(model, parts)
    state = states(equations, seed)
    at = {name: getattr(state, name) for name in ("q", "v", "torques", "gravity")}
    at["parameters"] = equations.values + 0.3
    exact = equations.evaluate(equations.derivative("forward_dynamics", argument), **at)
    step = 1e-5 * np.eye(len(at[argument]))
    ahead = equations.forward_dynamics(**{**at, argument: at[argument] + step})
    behind = equations.forward_dynamics(**{**at, argument: at[argument] - step})
    assert_close(exact, (ahead - behind).T / 2e-5, 1e-6)


def test_derivative_of_a_ball_spring_at_rest_is_its_stiffness() -> None:
    """The rotation vector has a removable singularity there: q = (1, r/2) to first order."""
    model = single(1.0, ORIGIN, ROUND, Joint("ball", "ball", stiffness=3.0))
    equations = Equations(model)
    for small in (0.0, 1e-200, 1e-150, 1e-12, 1e-6):
        q = np.array([1.0, small, 0.0, 0.0])
        by_q = equations.evaluate(equations.derivative("forward_dynamics", "q"), q=q)
        assert_close(by_q[:, 1:], -2 * 3.0 / 0.4 * np.eye(3), 1e-10)


# ------------------------------------------------------------------------------- parameters


def _another(model: Model, rng: np.random.Generator) -> Model:
    """The same tree with every mass, com, inertia, spring and damper another."""
    bodies = []
    for body in model.bodies:
        mass = float(rng.uniform(0.3, 4.0))
        joints = tuple(
            replace(
                joint,
                stiffness=float(rng.uniform(0.5, 9.0)),
                damping=float(rng.uniform(0.1, 2.0)),
                rest=0.0 if joint.kind == "ball" else float(rng.normal()),
            )
            for joint in body.joints
        )
        com = tuple(float(x) for x in 0.2 * rng.normal(size=3))
        inertia = random_inertia(rng, mass)
        bodies.append(replace(body, mass=mass, com=com, inertia=inertia, joints=joints))
    return replace(model, bodies=tuple(bodies))


def _tilted(model: Model) -> Model:
    """The same tree with the first joint of its last body moving along no coordinate axis."""
    last = model.bodies[-1]
    oblique = replace(last.joints[0], kind="hinge", axis=(0.48, 0.6, 0.64))
    bodies = (*model.bodies[:-1], replace(last, joints=(oblique, *last.joints[1:])))
    return replace(model, bodies=bodies)


def _open(model: Model) -> list[str]:
    names = []
    for body in model.bodies:
        names += [f"bodies.{body.name}.mass", *(f"bodies.{body.name}.com.{k}" for k in (1, 2, 3))]
        names += [f"bodies.{body.name}.inertia.{k}" for k in ("11", "12", "13", "22", "23", "33")]
    for joint in model.joints:
        names += [f"joints.{joint.name}.stiffness", f"joints.{joint.name}.damping"]
        names += [] if joint.kind == "ball" else [f"joints.{joint.name}.rest"]
    return names


@pytest.mark.parametrize("free", [True, False], ids=["free", "fixed"])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_open_parameters_give_what_a_model_with_those_numbers_gives(seed: int, free: bool) -> None:
    """Every number open at once, with oblique axes and others in all of these trees."""
    model = _tilted(random_tree(np.random.default_rng([66, seed]), bodies=3, free=free))
    other = _another(model, np.random.default_rng([67, seed]))
    names = _open(model)
    open_, fixed, rewritten = Equations(model, names), Equations(model), Equations(other)
    wanted = Equations(other, names).values
    state = states(fixed, seed)
    moving = (state.q, state.v, state.torques, state.gravity)
    assert_close(open_.forward_dynamics(*moving), fixed.forward_dynamics(*moving), 1e-11)
    changed = open_.forward_dynamics(*moving, parameters=wanted)
    assert_close(changed, rewritten.forward_dynamics(*moving), 1e-11)
    assert np.abs(changed - fixed.forward_dynamics(*moving)).max() > 0.1
    whole = ("inertia",) if free else ()
    for name in ("mass_matrix", "spring_energy", "outboard_inertia", *whole):
        value = getattr(open_, name)(state.q, parameters=wanted)
        assert_close(value, getattr(rewritten, name)(state.q), 1e-12)
    for name in ("momentum", "kinetic_energy"):
        value = getattr(open_, name)(state.q, state.v, parameters=wanted)
        assert_close(value, getattr(rewritten, name)(state.q, state.v), 1e-12)


def test_a_parameter_alone_is_open() -> None:
    """A sweep of one number, a sample for each value."""
    names = ["joints.left_shoulder.stiffness", "joints.left_shoulder.rest"]
    equations = Equations(load("furrer"), names)
    q, v = np.array([1.3, -1.3]), np.zeros(8)
    swept = np.stack([np.linspace(0.0, 50.0, 5), np.full(5, 1.0)], -1)
    accelerations = equations.forward_dynamics(q, v, parameters=swept)
    for (stiffness, rest), ours in zip(swept, accelerations, strict=True):
        torques = [-stiffness * (1.3 - rest), 0.0]
        assert_close(ours, Equations(load("furrer")).forward_dynamics(q, v, torques), 1e-12)


def test_an_open_mass_takes_its_inertia_along_unless_that_is_open_too() -> None:
    model = _tilted(random_tree(np.random.default_rng([66, 3]), bodies=3, free=True))
    state = states(Equations(model), 3)
    body = model.bodies[-1]
    mass = f"bodies.{body.name}.mass"

    def of(factor: float, inertia: float) -> Any:
        denser = tuple(tuple(inertia * x for x in row) for row in body.inertia)
        other = replace(body, mass=factor * body.mass, inertia=denser)
        return Equations(replace(model, bodies=(*model.bodies[:-1], other))).mass_matrix(state.q)

    alone = Equations(model, [mass]).mass_matrix(state.q, parameters=[1.7 * body.mass])
    assert_close(alone, of(1.7, 1.7), 1e-12)
    both = Equations(model, [mass, f"bodies.{body.name}.inertia.11"])
    given = both.mass_matrix(state.q, parameters=[1.7 * body.mass, body.inertia[0][0]])
    assert_close(given, of(1.7, 1.0), 1e-12)
    assert np.abs(alone - given).max() > 1e-3


# ----------------------------------------------------------------------------- closed forms


@cache
def _pendulum() -> Equations:
    hinge = Joint("hinge", "hinge", axis=(1.0, 0.0, 0.0), anchor=(0.0, 0.0, 0.5))
    inertia = ((0.03, 0.0, 0.0), (0.0, 0.03, 0.0), (0.0, 0.0, 0.01))
    return Equations(single(2.0, ORIGIN, inertia, hinge))


@repeatable
@given(angle=angles, speed=angles, g=st.floats(0.0, 30.0))
def test_pendulum(angle: float, speed: float, g: float) -> None:
    """q'' = -m g l sin q / (I + m l²), whatever its speed."""
    ours = _pendulum().forward_dynamics([angle], [speed], gravity=[0.0, 0.0, -g])
    expected = -2.0 * g * 0.5 * np.sin(angle) / (0.03 + 2.0 * 0.25)
    assert ours[0] == pytest.approx(expected, rel=1e-12, abs=1e-12)


@repeatable
@given(w1=angles, w2=angles, w3=angles)
def test_rigid_body_turns_by_eulers_equations(w1: float, w2: float, w3: float) -> None:
    """Playter (1994), eq. 2.1, without moments; and its origin circles its centre of mass."""
    i1, i2, i3 = 12.9, 11.1, 2.2
    inertia = ((i1, 0.0, 0.0), (0.0, i2, 0.0), (0.0, 0.0, i3))
    com = np.array([0.02, -0.03, 0.1])
    omega = np.array([w1, w2, w3])
    ours = _rigid().forward_dynamics([], [w1, w2, w3, 0.3, -0.2, 5.0])
    alpha = [(i2 - i3) / i1 * w2 * w3, (i3 - i1) / i2 * w3 * w1, (i1 - i2) / i3 * w1 * w2]
    np.testing.assert_allclose(ours[:3], alpha, rtol=1e-12, atol=1e-12)
    origin = -np.cross(alpha, com) - np.cross(omega, np.cross(omega, com))
    np.testing.assert_allclose(ours[3:], origin, rtol=1e-12, atol=1e-12)
    assert _rigid().model.bodies[0].inertia == inertia


@cache
def _rigid() -> Equations:
    inertia = ((12.9, 0.0, 0.0), (0.0, 11.1, 0.0), (0.0, 0.0, 2.2))
    return Equations(single(65.8, (0.02, -0.03, 0.1), inertia))


def test_two_bodies_on_a_spring_swing_with_their_reduced_mass() -> None:
    slide = Joint("spring", "slide", axis=UP, stiffness=7.0, rest=0.2, damping=0.4)
    bodies = (
        Body("below", GROUND, 2.0, ORIGIN, ROUND),
        Body("above", 0, 3.0, ORIGIN, ROUND, joints=(slide,)),
    )
    v = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 4.0, 0.6])
    ours = Equations(Model("pair", True, bodies)).forward_dynamics([0.5], v)
    force = -7.0 * (0.5 - 0.2) - 0.4 * 0.6
    np.testing.assert_allclose(ours, [0, 0, 0, 0, 0, -force / 2, force / 2 + force / 3], atol=1e-12)


def test_everything_falls_alike() -> None:
    """Uniform gravity moves a free tree's base by g and nothing else."""
    equations = tree(2, free=True)
    state = states(equations, 2)
    falling = equations.forward_dynamics(state.q, state.v, state.torques, state.gravity)
    floating = equations.forward_dynamics(state.q, state.v, state.torques)
    expected = np.zeros(len(state.v))
    expected[3:6] = state.gravity
    np.testing.assert_allclose(falling - floating, expected, atol=1e-10)


def test_several_joints_are_as_many_bodies_without_mass() -> None:
    """A shoulder of three hinges in one body, and the same through two massless ones."""
    rng = np.random.default_rng(5)
    axes = [tuple(float(x) for x in unit(rng, 3)) for _ in range(3)]
    hinges = [Joint(f"hinge{k}", "hinge", axis=axis) for k, axis in enumerate(axes)]
    base = Body("base", GROUND, 3.0, (0.1, 0.0, 0.0), ROUND)
    arm = Body("arm", 0, 1.5, (0.0, 0.1, -0.3), ROUND, (0.0, 0.2, 0.4), joints=tuple(hinges))
    chain = (
        Body("first", 0, 0.0, ORIGIN, POINT, arm.position, joints=(hinges[0],)),
        Body("second", 1, 0.0, ORIGIN, POINT, joints=(hinges[1],)),
        replace(arm, parent=2, position=ORIGIN, joints=(hinges[2],)),
    )
    together, apart = Model("a", True, (base, arm)), Model("b", True, (base, *chain))
    state = random_state(together, rng)
    moving = (state.q, state.v, state.torques, state.gravity)
    ours = Equations(together).forward_dynamics(*moving)
    assert_close(Equations(apart).forward_dynamics(*moving), ours, 1e-12)


def test_a_body_without_joints_is_carried_or_refused() -> None:
    """Readers weld such bodies to their parents; a model made by hand must not lose them."""
    load_ = Body("load", 0, 2.0, ORIGIN, ROUND, position=(0.0, 0.0, 1.0))
    try:
        model = Model("loaded", True, (Body("base", GROUND, 3.0, ORIGIN, ROUND), load_))
    except SomersaultError:
        return
    matrix = Equations(model).mass_matrix([])
    np.testing.assert_allclose(matrix[3:, 3:], 5.0 * np.eye(3), atol=1e-12)


def test_outboard_inertia_of_furrer_is_that_of_table_4_1() -> None:
    """I_sh = Il1 + ml rl3², section 4.4.2, at any pose."""
    ours = Equations(load("furrer")).outboard_inertia([[1.3, -1.3], [0.2, -2.0]])
    np.testing.assert_allclose(ours, 0.128 + 3.743 * 0.262**2, rtol=1e-12)


# --------------------------------------------------------------------------- laws of motion


def _rates(equations: Equations, name: str, state: State, a: np.ndarray) -> np.ndarray:
    """d/dt of a quantity along a motion, by its exact derivatives, in the base's axes."""
    dq = coordinate_rates(equations.model, state.q, state.v)
    dv = a.copy()
    if equations.model.free:  # of the components: less what turning axes make
        dv[3:6] -= np.cross(state.v[:3], state.v[3:6])
    if name == "spring_energy":
        return equations.evaluate(equations.derivative(name, "q"), q=state.q) @ dq
    by_q = equations.evaluate(equations.derivative(name, "q"), q=state.q, v=state.v)
    by_v = equations.evaluate(equations.derivative(name, "v"), q=state.q, v=state.v)
    return by_q @ dq + by_v @ dv


@pytest.mark.parametrize("seed", SEEDS)
def test_momentum_is_kept(seed: int) -> None:
    """Whatever springs, dampers and torques do: ḣ + ω × h = 0 and ṗ + ω × p = m g."""
    equations = tree(seed, free=True)
    state = states(equations, seed)
    a = equations.forward_dynamics(state.q, state.v, state.torques, state.gravity)
    rate = _rates(equations, "momentum", state, a)
    h = equations.momentum(state.q, state.v)
    omega, size = state.v[:3], np.abs(rate).max()
    turning = rate[:3] + np.cross(omega, h[:3])
    moving = rate[3:] + np.cross(omega, h[3:]) - equations.model.mass * state.gravity
    np.testing.assert_allclose(turning, 0, atol=1e-12 * size)
    np.testing.assert_allclose(moving, 0, atol=1e-12 * size)
    assert np.abs(rate).min() > 1e-3


@pytest.mark.parametrize("free", [True, False], ids=["free", "fixed"])
@pytest.mark.parametrize("seed", SEEDS)
def test_power_balance(seed: int, free: bool) -> None:
    """d/dt (kinetic + spring energy) = torques · q̇ - b q̇² + p · g."""
    equations = tree(seed, free)
    state = states(equations, seed)
    a = equations.forward_dynamics(state.q, state.v, state.torques, state.gravity)
    rate = _rates(equations, "kinetic_energy", state, a)
    rate = rate + _rates(equations, "spring_energy", state, a)
    own = state.v[6 * free :]
    damping = np.concatenate([[joint.damping] * joint.speeds for joint in equations.model.joints])
    falling = equations.momentum(state.q, state.v)[3:] @ state.gravity
    given_ = state.torques @ own - damping @ own**2 + falling
    scale = np.abs(state.torques * own).sum() + damping @ own**2 + abs(falling)
    assert rate[0] == pytest.approx(given_, abs=1e-11 * scale)


@pytest.mark.parametrize("free", [True, False], ids=["free", "fixed"])
def test_inverse_dynamics_undoes_forward_dynamics(free: bool) -> None:
    for seed in SEEDS:
        equations = tree(seed, free)
        state = states(equations, seed)
        a = equations.forward_dynamics(state.q, state.v, state.torques, state.gravity)
        loads = equations.inverse_dynamics(state.q, state.v, a, state.gravity)
        expected = np.concatenate([np.zeros(6 * free), state.torques])
        np.testing.assert_allclose(loads, expected, atol=1e-10)


@pytest.mark.parametrize("free", [True, False], ids=["free", "fixed"])
def test_kinetic_energy_is_that_of_the_mass_matrix(free: bool) -> None:
    for seed in SEEDS:
        equations = tree(seed, free)
        state = states(equations, seed)
        matrix = equations.mass_matrix(state.q)
        assert_close(matrix, matrix.T, 1e-15)
        assert np.linalg.eigvalsh(matrix)[0] > 0
        energy = 0.5 * state.v @ matrix @ state.v
        assert equations.kinetic_energy(state.q, state.v) == pytest.approx(energy, rel=1e-12)


def test_inertia_is_the_momentum_of_a_locked_body() -> None:
    """I ω, with the centre of mass wherever the pose puts it."""
    for seed in SEEDS:
        equations = tree(seed, free=True)
        state = states(equations, seed)
        locked = np.where(np.arange(len(state.v)) < 6, state.v, 0.0)
        h = equations.momentum(state.q, locked)[:3]
        assert_close(equations.inertia(state.q) @ state.v[:3], h, 1e-12)


def test_linear_velocity_does_not_enter() -> None:
    equations = tree(0, free=True)
    state = states(equations, 0)
    faster = state.v + np.array([0, 0, 0, 30.0, -20.0, 9.0] + [0.0] * (len(state.v) - 6))
    still = equations.forward_dynamics(state.q, state.v, state.torques)
    np.testing.assert_array_equal(equations.forward_dynamics(state.q, faster, state.torques), still)


# ---------------------------------------------------------------------------------- mistakes


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda e: Equations("furrer", ["bodies.elbow.mass"]), "no parameter 'bodies.elbow.mass'"),
        (lambda e: e.expression("jerk"), "no quantity is called 'jerk'"),
        (lambda e: e.derivative("inertia", "v"), "inertia does not depend on 'v'; it takes q"),
        (lambda e: e.momentum(np.zeros(3), np.zeros(8)), r"momentum: q has shape \(3,\)"),
        (lambda e: e.momentum("ab", np.zeros(8)), "momentum: q must be numbers"),
        (lambda e: e.momentum(np.zeros((2, 2)), np.zeros((3, 8))), r"q \(2, 2\), v \(3, 8\)"),
        (lambda e: e.evaluate(e.expression("inertia"), v=0.0), "inertia takes q, parameters, and"),
        (lambda e: tree(1, free=False).inertia(np.zeros(9)), "has a fixed base"),
    ],
)
def test_mistakes_say_what_is_wrong(call: Any, says: str) -> None:
    with pytest.raises(SomersaultError, match=says):
        call(Equations("furrer"))


def test_a_body_without_joints_has_nothing_outboard() -> None:
    book = Equations("book")
    assert book.outboard_inertia(np.empty((4, 0))).shape == (4, 0)
    assert book.forward_dynamics([], np.zeros((4, 6))).shape == (4, 6)
