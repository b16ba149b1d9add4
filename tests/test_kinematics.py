"""Where bodies are and how they move, against MuJoCo; what they carry, against the whole's."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from trees import InMujoco, State, assert_close, drawn, random_state, to_mujoco

from somersault.attitude import matrix_from_quaternion
from somersault.dynamics import Equations
from somersault.model import (
    Model,
    body_frames,
    body_velocities,
    centre_of_mass,
    load,
    segment_momenta,
    shipped,
)

BASE = np.array([0.3, -0.2, 0.1])  # where `InMujoco` puts a free base's origin


def close(value: np.ndarray, wanted: np.ndarray) -> None:
    """Equal to rounding of lengths of metres and speeds of metres a second."""
    np.testing.assert_allclose(value, wanted, rtol=1e-12, atol=1e-12)


def check(model: Model, state: State) -> None:
    m = to_mujoco(model)
    d = InMujoco(model, m, state).d
    mujoco.mj_comPos(m, d)
    at = BASE if model.free else np.zeros(3)
    turn = state.turn if model.free else np.eye(3)
    omega, v = (state.v[:3], state.v[3:6]) if model.free else (np.zeros(3), np.zeros(3))
    rotations, origins = body_frames(model, state.q)
    angular, linear = body_velocities(model, state.q, state.v[6 * model.free :])
    for k, body in enumerate(model.bodies):
        theirs = d.body(body.name)
        moving = np.zeros(6)
        kind = int(mujoco.mjtObj.mjOBJ_XBODY)
        mujoco.mj_objectVelocity(m, d, kind, theirs.id, moving, 0)
        close(turn @ rotations[k], theirs.xmat.reshape(3, 3))
        close(at + turn @ origins[k], theirs.xpos)
        close(turn @ (angular[k] + omega), moving[:3])
        close(turn @ (linear[k] + v + np.cross(omega, origins[k])), moving[3:])
    whole = int(m.body(model.bodies[0].name).id) if model.free else 0
    close(at + turn @ centre_of_mass(model, state.q), d.subtree_com[whole])


@pytest.mark.parametrize("number", range(60))
def test_random_trees_stand_and_move_as_in_mujoco(number: int) -> None:
    model, state, _ = drawn(number)
    check(model, state)


@pytest.mark.parametrize("name", shipped())
def test_shipped_models_stand_and_move_as_in_mujoco(name: str) -> None:
    model = load(name)
    check(model, random_state(model, np.random.default_rng(3)))


def test_many_samples_are_each_as_one() -> None:
    model, rng = load("gymnast"), np.random.default_rng(5)
    q = rng.normal(size=(4, 3, len(model.coordinates)))
    u = rng.normal(size=(4, 3, len(model.speeds)))
    omega = rng.normal(size=(4, 3, 3))
    calls: list[tuple[Any, tuple[Any, ...]]] = [
        (lambda *x: body_frames(*x)[0], (q,)),
        (lambda *x: body_frames(*x)[1], (q,)),
        (lambda *x: body_velocities(*x)[0], (q, u)),
        (lambda *x: body_velocities(*x)[1], (q, u)),
        (centre_of_mass, (q,)),
        (segment_momenta, (q, omega, u)),
    ]
    for call, given in calls:
        whole = call(model, *given)
        for place in np.ndindex(4, 3):
            np.testing.assert_allclose(
                whole[place], call(model, *(x[place] for x in given)), rtol=1e-13, atol=1e-14
            )


@pytest.mark.parametrize("number", range(60))
def test_momenta_of_the_segments_sum_to_the_whole_bodys(number: int) -> None:
    """About the centre of mass: the whole's from the equations of motion, less its drift."""
    model, state, _ = drawn(number)
    omega = state.v[:3] if model.free else np.zeros(3)
    momenta = segment_momenta(model, state.q, omega, state.v[6 * model.free :])
    total = Equations(model).momentum(state.q, state.v)
    about = centre_of_mass(
        model, state.q
    )  # from the base's origin, as `momentum` is for a fixed one
    if model.free:
        about = np.zeros(3)  # `momentum` is about the centre of mass already
    assert_close(momenta.sum(-2), total[:3] - np.cross(about, total[3:]), 1e-11)


@pytest.mark.parametrize("number", range(20))
def test_momentum_of_each_segment_is_mujocos(number: int) -> None:
    model, state, _ = drawn(number)
    m = to_mujoco(model)
    d = InMujoco(model, m, state).d
    mujoco.mj_subtreeVel(m, d)
    turn = state.turn if model.free else np.eye(3)
    omega = state.v[:3] if model.free else np.zeros(3)
    momenta = segment_momenta(model, state.q, omega, state.v[6 * model.free :])
    masses = np.array([body.mass for body in model.bodies])
    ids = [m.body(body.name).id for body in model.bodies]
    velocities = []
    for k in ids:
        moving = np.zeros(6)
        mujoco.mj_objectVelocity(m, d, int(mujoco.mjtObj.mjOBJ_BODY), k, moving, 0)
        velocities.append((matrix_from_quaternion(m.body_iquat[k]), moving))
    centre = masses @ d.xipos[ids] / masses.sum()
    drift = masses @ np.array([moving[3:] for _, moving in velocities]) / masses.sum()
    for own, k, mass, (_, moving) in zip(momenta, ids, masses, velocities, strict=True):
        axes = d.ximat[k].reshape(3, 3)
        spin = axes @ (m.body_inertia[k] * (axes.T @ moving[:3]))
        wanted = spin + mass * np.cross(d.xipos[k] - centre, moving[3:] - drift)
        assert_close(turn @ own, wanted, 1e-11)
