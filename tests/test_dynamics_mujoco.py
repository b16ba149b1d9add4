"""The dynamics against MuJoCo's, which is derived, written and compiled by others.

MuJoCo computes forward dynamics by a factored mass matrix (composite bodies and a recursive
Newton–Euler bias), in world axes: nothing is shared with the algorithm here but the physics.
"""

from __future__ import annotations

import warnings
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path

import mujoco
import numpy as np
import pytest
from shares import every
from trees import (
    TREES,
    Case,
    InMujoco,
    assert_close,
    case,
    drawn,
    evaluated,
    quiet,
    random_state,
    shipped_case,
    to_mujoco,
)

from somersault.dynamics import Equations
from somersault.model import Body, Joint, Model, load, shipped

SHIPPED = files("somersault.model") / "shipped"
BATCH = 10
OTHERS = (  # the larger ones take CasADi's own evaluation, as compiling them takes long
    ("gymnasium", "envs/mujoco/assets/humanoid.xml", True),
    ("gymnasium", "envs/mujoco/assets/humanoidstandup.xml", False),
    ("gymnasium", "envs/mujoco/assets/ant.xml", True),
    ("dm_control", "suite/humanoid.xml", False),
    ("dm_control", "suite/humanoid_CMU.xml", False),
)


def compare(own: Case, m: mujoco.MjModel) -> None:
    theirs = InMujoco(own.model, m, own.state)
    assert_close(own.ours["forward_dynamics"], theirs.forward_dynamics, 1e-10)
    assert_close(own.ours["mass_matrix"], theirs.mass_matrix, 1e-12)
    assert_close(own.ours["momentum"], theirs.momentum, 1e-12)
    assert_close(own.ours["kinetic_energy"], [theirs.kinetic_energy], 1e-12)
    assert_close(own.ours["spring_energy"], [theirs.spring_energy], 1e-12)
    inverse = theirs.inverse_dynamics(own.accelerations)
    assert_close(own.ours["inverse_dynamics"], inverse, 1e-12)


@pytest.mark.parametrize("first", every(range(0, TREES, BATCH), 4))
def test_random_trees(first: int) -> None:
    for number in range(first, first + BATCH):
        own = case(number)
        compare(own, to_mujoco(own.model))


def test_random_trees_are_of_every_sort() -> None:
    """What the two hundred trees hold: a generator gone tame must not pass for agreement."""
    models = [drawn(number)[0] for number in range(TREES)]
    joints = [joint for model in models for joint in model.joints]
    assert {joint.kind for joint in joints} == {"hinge", "slide", "ball"}
    assert {model.free for model in models} == {True, False}
    assert any(len(body.joints) == 3 for model in models for body in model.bodies)
    assert any(sum(body.parent < 0 for body in model.bodies) > 1 for model in models)
    for name in ("stiffness", "damping", "armature", "reference", "rest"):
        assert 0.1 < np.mean([getattr(joint, name) != 0 for joint in joints]) < 0.9


@pytest.mark.parametrize("gravity", [False, True], ids=["free", "falling"])
@pytest.mark.parametrize("name", shipped())
def test_shipped_models(name: str, gravity: bool) -> None:
    m = mujoco.MjModel.from_xml_path(str(SHIPPED / f"{name}.xml"))
    quiet(m)
    compare(shipped_case(name, gravity), m)


@pytest.mark.parametrize(("package", "inside", "compiled"), OTHERS)
def test_models_of_others(package: str, inside: str, compiled: bool) -> None:
    """Files written for MuJoCo, with defaults, welds, actuators and tendons as they come."""
    found = find_spec(package)
    if found is None or found.origin is None:
        pytest.skip(f"{package} is not installed")
    path = Path(found.origin).parent / inside
    m = mujoco.MjModel.from_xml_path(str(path))
    quiet(m)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = load(path)
    state = random_state(model, np.random.default_rng(11))
    theirs = InMujoco(model, m, state)
    names = ("forward_dynamics", "mass_matrix")
    ours = evaluated(Equations(model), state, state.v, compiled, names)
    assert_close(ours["forward_dynamics"], theirs.forward_dynamics, 1e-10)
    assert_close(ours["mass_matrix"], theirs.mass_matrix, 1e-10)


def test_ball_spring_at_half_a_turn() -> None:
    """The energy is largest where both ways round are equally long, and not zero there."""
    unit = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    ball = Joint("ball", "ball", stiffness=3.0)
    model = Model("ball", False, (Body("body", -1, 1.0, (0.0, 0.0, 0.0), unit, joints=(ball,)),))
    half_turn = [0.0, 0.6, 0.0, 0.8]
    energy = Equations(model).spring_energy(half_turn)
    assert energy == pytest.approx(0.5 * 3.0 * np.pi**2, rel=1e-12)
