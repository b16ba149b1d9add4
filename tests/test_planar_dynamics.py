"""Planar models have the dynamics that MuJoCo and biorbd give them, and hold in their plane."""

from __future__ import annotations

import warnings
from importlib.metadata import distribution
from pathlib import Path

import casadi as ca
import mujoco
import numpy as np
import pytest
from planes import InMujoco, in_plane, random_chain, random_planar_tree, random_takeoff, turn
from trees import mujoco_addresses, quiet, random_inertia

import somersault as so
from somersault.dynamics import Equations, constrained_dynamics, forward_dynamics, link_tree
from somersault.model import Model

PLANES = (1, 2, 3)


def accelerations(model: Model, *at: np.ndarray) -> np.ndarray:
    """At coordinates, speeds, torques and gravity; by CasADi, without compiling."""
    function = Equations(model).expression("forward_dynamics").function()
    return np.array(function(*at, [])).ravel()


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("seed", range(10))
def test_forward_dynamics_are_those_of_mujoco_on_two_slides_and_a_hinge(
    seed: int, plane: int
) -> None:
    rng = np.random.default_rng([seed, plane])
    model = (random_chain if seed % 2 else random_planar_tree)(rng, plane)
    begun = random_takeoff(rng, model)
    angle, rate, torques = rng.normal(), rng.normal(), rng.normal(size=len(model.speeds))
    velocity, world = rng.normal(size=3), 9.81 * rng.normal(size=3)
    theirs, attitude = InMujoco(model), turn(plane, angle)
    theirs.m.opt.gravity[:] = world
    theirs.d.qpos[2], theirs.d.qvel[2] = angle, rate
    theirs.d.qvel[:2] = velocity[theirs.along]
    theirs.d.qpos[theirs.q_at], theirs.d.qvel[theirs.v_at] = begun["q"], begun["u"]
    theirs.d.qfrc_applied[theirs.v_at] = torques
    mujoco.mj_forward(theirs.m, theirs.d)
    omega = rng.normal(size=3)  # of which what is across the plane does not count
    omega[plane - 1] = rate
    v = np.concatenate([omega, attitude.T @ velocity, begun["u"]])
    found = accelerations(model, begun["q"], v, torques, attitude.T @ world)
    out = [k for k in range(3) if k != plane - 1] + [3 + plane - 1]
    assert np.all(found[out] == 0.0)
    expected = theirs.d.qacc
    size = np.abs(expected).max()
    assert found[plane - 1] == pytest.approx(expected[2], abs=1e-9 * size)
    np.testing.assert_allclose(
        (attitude @ found[3:6])[theirs.along], expected[:2], rtol=0, atol=1e-9 * size
    )
    np.testing.assert_allclose(found[6:], expected[theirs.v_at], rtol=0, atol=1e-9 * size)


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("seed", range(3))
def test_articulated_bodies_and_the_mass_matrix_agree_in_a_plane(seed: int, plane: int) -> None:
    """Two algorithms: the articulated-body one, and the projected equations of geared joints."""
    rng = np.random.default_rng([seed, plane])
    model = random_planar_tree(rng, plane)
    begun, tree = random_takeoff(rng, model), link_tree(model)
    omega, gravity = rng.normal(size=3).tolist(), rng.normal(size=3).tolist()
    moving = (tree, [ca.DM(x) for x in begun["q"]], omega, begun["u"].tolist(),
              rng.normal(size=len(model.speeds)).tolist(), gravity)  # fmt: skip
    one, other = (
        np.concatenate([np.array(ca.DM(ca.vertcat(*part))).ravel() for part in three])
        for three in (forward_dynamics(*moving), constrained_dynamics(*moving, {}, {}))
    )
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-9 * np.abs(other).max())


PUBLIC = {
    "gymnasium": ("half_cheetah", "hopper", "walker2d_v5", "point"),
    "dm_control": ("cheetah", "hopper", "walker"),
}


@pytest.mark.parametrize(
    ("package", "name"), [(package, name) for package, names in PUBLIC.items() for name in names]
)
@pytest.mark.filterwarnings("ignore::somersault._core.errors.SomersaultWarning")
def test_public_walkers_are_planar_and_move_as_in_mujoco(package: str, name: str) -> None:
    """By the file itself, as MuJoCo reads it."""
    pytest.importorskip(package)
    files = distribution(package).files or []
    file = next(f for f in files if f.name == f"{name}.xml" and "maze" not in str(f))
    model, rng = so.load(Path(str(file.locate()))), np.random.default_rng(len(name))
    assert (model.free, model.plane) == (True, 3 if name == "point" else 2)
    m = mujoco.MjModel.from_xml_path(str(file.locate()))
    quiet(m)
    d = mujoco.MjData(m)
    base = mujoco.mj_name2id(m, mujoco.mjtObj.mjOBJ_BODY, model.bodies[0].name)
    q_at, v_at = mujoco_addresses(model, m)
    d.qpos[:] = m.qpos0 + 0.5 * rng.normal(size=m.nq)
    d.qvel[:], d.qfrc_applied[v_at] = rng.normal(size=m.nv), rng.normal(size=len(v_at))
    mujoco.mj_forward(m, d)
    attitude = d.xmat[base].reshape(3, 3)
    velocity, acceleration = np.zeros((2, 6))  # of the base's origin: turning, then moving
    mujoco.mj_objectVelocity(m, d, mujoco.mjtObj.mjOBJ_XBODY, base, velocity, 1)
    v = np.concatenate([velocity, d.qvel[v_at]])
    gravity = attitude.T @ m.opt.gravity
    found = accelerations(model, d.qpos[q_at], v, d.qfrc_applied[v_at], gravity)
    mujoco.mj_rnePostConstraint(m, d)
    mujoco.mj_objectAcceleration(m, d, mujoco.mjtObj.mjOBJ_XBODY, base, acceleration, 1)
    acceleration[3:] += gravity  # which stands as an upward acceleration in it
    expected = np.concatenate([acceleration, d.qacc[v_at]])
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


# ------------------------------------------------------------------------------------ biorbd


def row(values: np.ndarray) -> str:
    return " ".join(repr(float(x)) for x in np.ravel(values))


def biomod(rng: np.random.Generator, plane: int) -> str:
    """A planar model in biorbd's format, whose inertias are known about the normal alone or whole,
    and which stands turned in the world."""
    across, along = "xyz"[plane - 1], "xyz".replace("xyz"[plane - 1], "")
    along = along[:: rng.choice([-1, 1])]
    normal = np.outer(np.eye(3)[plane - 1], np.eye(3)[plane - 1])
    text = "version 4\n"
    for number in range(5):
        moves = f"translations {along}\n" if number == 0 else ""
        if number > 1 and rng.integers(3) == 0:
            moves = f"translations {along[0]}\n"
        frame = np.eye(4)
        frame[:3, :3] = turn(plane, rng.normal())
        frame[:3, 3] = in_plane(rng, plane)
        inertia = np.array(random_inertia(rng, 2.0))
        inertia = normal * inertia if rng.integers(2) else inertia
        text += (
            f"segment S{number}\nparent {'root' if number == 0 else f'S{rng.integers(number)}'}\n"
            f"RTinMatrix 1\nRT {row(frame)}\n{moves}rotations {across}\n"
            f"mass {rng.uniform(0.5, 4.0)!r}\ncom {row(rng.normal(size=3) * 0.2)}\n"
            f"inertia {row(inertia)}\nendsegment\n"
        )
    return text


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("seed", range(4))
def test_biomod_has_the_mass_matrix_and_forward_dynamics_of_biorbd(
    seed: int, plane: int, tmp_path: Path
) -> None:
    biorbd = pytest.importorskip("biorbd", reason="biorbd, the reference, is optional")
    rng, path = np.random.default_rng([seed, plane]), tmp_path / "planar.bioMod"
    path.write_text(biomod(rng, plane))
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # inertias about the normal alone are no mistake
        model = so.load(path)
    assert (model.plane, model.axes[0], model.free) == (plane, plane, True)
    theirs, root = biorbd.Model(str(path)), model.file_coordinates.root
    names = [dof.to_string() for dof in theirs.nameDof()]
    on_ground = [joint for body in root for joint in body.joints]
    assert names[:3] == [joint.name for joint in on_ground]
    q, u = rng.normal(size=(2, len(names)))
    torques = np.concatenate([np.zeros(3), rng.normal(size=len(names) - 3)])
    for joint in model.joints:
        assert joint.reference == 0.0
    # From the root's coordinates to the base: the world is turned, the base too by its hinge.
    attitude = turn(plane, q[2])
    axes = np.array([joint.axis for joint in on_ground[:2]]).T
    velocity = attitude.T @ axes @ u[:2]
    omega = u[2] * np.eye(3)[plane - 1]
    gravity = attitude.T @ np.array(root[-1].rotation).T @ theirs.getGravity().to_array()
    found = accelerations(
        model, q[3:], np.concatenate([omega, velocity, u[3:]]), torques[3:], gravity
    )
    ours = np.concatenate([axes.T @ attitude @ found[3:6], [found[plane - 1]], found[6:]])
    expected = theirs.ForwardDynamics(q, u, torques).to_array()
    np.testing.assert_allclose(ours, expected, rtol=0, atol=1e-9 * np.abs(expected).max())
    matrix = np.array(Equations(model).expression("mass_matrix").function()(q[3:], []))
    ways = np.zeros((len(names), 6 + len(model.speeds)))
    ways[:2, 3:6], ways[2, plane - 1] = (attitude.T @ axes).T, 1.0
    ways[3:, 6:] = np.eye(len(model.speeds))
    expected = theirs.massMatrix(q).to_array()
    np.testing.assert_allclose(
        ways @ matrix @ ways.T, expected, rtol=0, atol=1e-9 * np.abs(expected).max()
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert so.load(path, base="fixed").coordinates == tuple(names)
