"""A body swung by what holds it, and let go: closed forms, MuJoCo, and what is conserved."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from scipy.special import ellipk
from trees import mujoco_addresses, quiet, to_mujoco

from somersault import SomersaultError
from somersault.dynamics import Equations
from somersault.flight import (
    GRAVITY,
    JointTakeoff,
    Prop,
    Swing,
    fly,
    height_energy,
    released,
    swing,
)
from somersault.model import GROUND, Body, Joint, Model, Mount, load, mounted

G = -GRAVITY[2]
TURNED = ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
CLAMP = Body(
    "clamp", GROUND, 0.4, (0.01, -0.02, -0.08),
    ((6e-4, 1e-5, 0.0), (1e-5, 5e-4, 2e-5), (0.0, 2e-5, 4e-4)), position=(0.1, -0.3, 2.2),
    joints=(Joint("bar", "hinge", (0.0, 1.0, 0.0), stiffness=0.2, rest=6.0),),
)  # fmt: skip


def sprung(stiffness: float = 0.07, rest: float = 0.9, damping: float = 0.0) -> Model:
    """The weighted doll with springs at its shoulders."""
    model = load("doll_weighted")
    body, *arms = model.bodies
    made = []
    for arm in arms:
        joint = arm.joints[0]
        side = 1 if joint.name.startswith("left") else -1
        spring = replace(joint, stiffness=stiffness, rest=side * rest, damping=damping, limits=None)
        made.append(replace(arm, joints=(spring,)))
    return replace(model, bodies=(body, *made))


def one_body(mass: float = 0.7, com: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Model:
    inertia = ((2e-3, 0.0, 0.0), (0.0, 3e-3, 0.0), (0.0, 0.0, 2e-3))
    return Model("brick", True, (Body("brick", GROUND, mass, com, inertia),))


def weightless(**spring: float) -> Body:
    """A hinge without mass of its own."""
    zero = (0.0, 0.0, 0.0)
    hinge = Joint("bar", "hinge", (0.0, 1.0, 0.0), **spring)
    return Body("hinge", GROUND, 0.0, zero, (zero, zero, zero), joints=(hinge,))


# ---------------------------------------------------------------------------- closed forms


@pytest.mark.parametrize("begin", [0.1, 1.0, 2.5, 3.1])
def test_a_physical_pendulum_takes_its_quarter_period(begin: float) -> None:
    length, mass, inertia = 0.4, 0.7, 3e-3
    mount = mounted(one_body(), weightless(), (0.0, 0.0, -length))
    found = swing(mount.held, {"bar": begin}, 20.0, until=("bar", 0.0), accuracy=1e-13)
    slow = np.sqrt(mass * G * length / (inertia + mass * length**2))
    assert found.ended == "event"
    assert found.times[-1] == pytest.approx(ellipk(np.sin(begin / 2) ** 2) / slow, rel=1e-10)
    assert found.u[-1, 0] == pytest.approx(-2 * slow * np.sin(begin / 2), rel=1e-10)


def test_a_torsion_pendulum_oscillates_about_its_rest() -> None:
    mount = mounted(one_body(), weightless(stiffness=0.3, rest=0.5), (0.0, 0.0, -0.4))
    found = swing(mount.held, {"bar": 2.0}, 3.0, gravity=(0, 0, 0), samples=50, accuracy=1e-13)
    rate = np.sqrt(0.3 / (3e-3 + 0.7 * 0.4**2))
    assert found.ended == "duration"
    assert found.q[:, 0] == pytest.approx(0.5 + 1.5 * np.cos(rate * found.times), abs=1e-10)
    torque = found.dataset["spring_torque"].sel(joint="bar")
    assert torque.values == pytest.approx(-0.45 * np.cos(rate * found.times), abs=1e-10)


def test_a_stop_bounces_a_body_back_with_all_its_speed() -> None:
    """Half a period of stop and mass in contact, and the same speed away from it."""
    mount = mounted(one_body(), weightless(), (0.0, 0.0, 0.0))
    stop = Prop(0.0, 1, stiffness=30.0)
    found = swing(
        mount.held, {"bar": 1.0}, 3.0, rates={"bar": -2.0}, gravity=(0, 0, 0),
        stops={"bar": stop}, samples=3001, accuracy=1e-12,
    )  # fmt: skip
    contact = np.pi / np.sqrt(30.0 / 3e-3)
    assert found.q[-1, 0] == pytest.approx(2.0 * (3.0 - 0.5 - contact), abs=1e-6)
    load = found.dataset["stop_torque"].sel(joint="bar").values
    assert load.min() == 0.0
    assert load.max() == pytest.approx(2.0 * np.sqrt(30.0 * 3e-3), rel=1e-3)


def test_a_damped_stop_takes_speed_and_never_pulls() -> None:
    mount = mounted(one_body(), weightless(), (0.0, 0.0, 0.0))
    stops = {"bar": Prop(0.0, -1, stiffness=30.0, damping=2.0)}
    found = swing(
        mount.held, {"bar": -1.0}, 1.0, rates={"bar": 2.0}, gravity=(0, 0, 0), stops=stops,
        samples=3001,
    )  # fmt: skip
    assert -2.0 < found.u[-1, 0] < -0.2
    assert found.stop_torques.max() == 0.0
    energy = found.dataset["energy"].values
    assert np.diff(energy).max() < 1e-6 * energy[0]


# ---------------------------------------------------------------- energy, and MuJoCo


@pytest.fixture(scope="module")
def mount() -> Mount:
    return mounted(sprung(), CLAMP, (0.01, 0.02, -0.35), TURNED)


@pytest.fixture(scope="module")
def swung(mount: Mount) -> Swing:
    """A swing in which everything moves, out of any plane."""
    return swing(
        mount.held, {"bar": -2.0, "left_shoulder": 1.5, "right_shoulder": -1.2}, 0.8,
        rates={"bar": 3.0, "left_shoulder": -2.0}, samples=81, accuracy=1e-13,
    )  # fmt: skip


def test_a_swing_without_dampers_keeps_its_energy(swung: Swing) -> None:
    data = swung.dataset
    span = {name: np.ptp(data[name].values) for name in data if name.endswith("energy")}
    assert span["energy"] < 1e-10 * span["kinetic_energy"]
    assert span["height_energy"] > 1.0


def test_a_damped_swing_loses_energy() -> None:
    held = mounted(sprung(damping=1e-3), CLAMP, (0.0, 0.0, -0.35)).held
    energy = swing(held, {"left_shoulder": 1.0}, 0.5, samples=100).dataset["energy"].values
    assert np.diff(energy).max() < 1e-12


def test_a_swing_is_mujocos(mount: Mount, swung: Swing) -> None:
    m = to_mujoco(mount.held, timestep=1e-4)
    m.opt.gravity[:] = GRAVITY
    m.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    quiet(m)
    d = mujoco.MjData(m)
    at, speeds = mujoco_addresses(mount.held, m)
    d.qpos[at], d.qvel[speeds] = swung.q[0], swung.u[0]
    for _ in range(8000):
        mujoco.mj_step(m, d)
    assert d.qpos[at] == pytest.approx(swung.q[-1], abs=1e-9)
    assert d.qvel[speeds] == pytest.approx(swung.u[-1], abs=1e-8)


# ------------------------------------------------------------------------------- release


def test_letting_go_changes_nothing(mount: Mount, swung: Swing) -> None:
    """Momentum, angular momentum and energy of the doll: the held model's less the clamp's."""
    let = released(swung, mount)
    q, u = swung.q[-1], swung.u[-1]
    held, clamp = Equations(mount.held), Equations(Model("clamp", False, (CLAMP,)))
    before = held.momentum(q, u) - clamp.momentum(q[:1], u[:1])
    energy = held.kinetic_energy(q, u) - clamp.kinetic_energy(q[:1], u[:1])
    height = height_energy(held, q) - height_energy(clamp, q[:1])
    flight = fly(mount.rider, let.takeoff, 1e-3, samples=2)
    v, mass = np.array(let.takeoff.velocity), mount.rider.mass
    assert mass * v == pytest.approx(before[3:], rel=1e-12)
    about_centre = before[:3] - np.cross(let.centre, before[3:])
    assert flight.angular_momentum[0] == pytest.approx(about_centre, abs=1e-14)
    assert flight.kinetic_energy[0] + 0.5 * mass * v @ v == pytest.approx(energy, rel=1e-12)
    assert mass * G * let.centre[2] == pytest.approx(height, rel=1e-12)
    assert flight.spring_energy[0] == pytest.approx(
        held.spring_energy(q) - clamp.spring_energy(q[:1]), rel=1e-12
    )
    assert let.time == swung.times[-1]
    for k, name in enumerate(("left_shoulder", "right_shoulder"), 1):
        joint = let.takeoff.joints[name]
        assert (joint.angle, joint.rate, joint.stiffness) == (q[k], u[k], 0.07)


def test_a_carrier_with_a_slide_and_a_hinge_lets_go_too() -> None:
    joints = (
        Joint("lift", "slide", (0.6, 0.0, 0.8)),
        Joint("bar", "hinge", (0.0, 0.6, 0.8), anchor=(0.1, 0.0, -0.05), reference=0.3),
    )
    carrier = replace(CLAMP, joints=joints, rotation=TURNED)
    mount = mounted(sprung(), carrier, (0.05, 0.0, -0.3), TURNED)
    found = swing(mount.held, {"bar": 0.8, "lift": 0.1}, 0.3, rates={"bar": 4.0, "lift": 1.0})
    let = released(found, mount)
    held, alone = Equations(mount.held), Equations(Model("clamp", False, (carrier,)))
    q, u = found.q[-1], found.u[-1]
    before = held.momentum(q, u) - alone.momentum(q[:2], u[:2])
    flight = fly(mount.rider, let.takeoff, 1e-3, samples=2)
    assert mount.rider.mass * np.array(let.takeoff.velocity) == pytest.approx(before[3:], rel=1e-11)
    about_centre = before[:3] - np.cross(let.centre, before[3:])
    assert flight.angular_momentum[0] == pytest.approx(about_centre, abs=1e-13)


def test_joints_do_in_flight_what_they_are_told(mount: Mount, swung: Swing) -> None:
    told = {"left_shoulder": JointTakeoff("locked"), "right_shoulder": JointTakeoff("free")}
    takeoff = released(swung, mount, told).takeoff
    left, right = (takeoff.joints[name] for name in told)
    assert (left.motion, left.angle) == ("locked", swung.q[-1, 1])
    assert (right.motion, right.angle, right.rate) == ("free", swung.q[-1, 2], swung.u[-1, 2])


def test_a_joint_without_a_spring_is_let_go_free() -> None:
    mount = mounted(load("doll_weighted"), CLAMP, (0.0, 0.0, -0.35))
    takeoff = released(swing(mount.held, {}, 0.1), mount).takeoff
    assert all(joint.motion == "free" for joint in takeoff.joints.values())


# ------------------------------------------------------------------------------ mistakes


def test_mistakes_are_said_in_a_sentence(mount: Mount, swung: Swing) -> None:
    doll = load("doll_weighted")
    with pytest.raises(SomersaultError, match="fixed base already"):
        mounted(mount.held, CLAMP)
    with pytest.raises(SomersaultError, match="must stand on the ground"):
        mounted(doll, replace(CLAMP, joints=()))
    with pytest.raises(SomersaultError, match="something that holds it"):
        swing(doll, {}, 1.0)
    with pytest.raises(SomersaultError, match="no joint 'elbow'"):
        swing(mount.held, {}, 1.0, stops={"elbow": Prop(0.0)})
    with pytest.raises(SomersaultError, match="no joint 'elbow'"):
        swing(mount.held, {}, 1.0, until=("elbow", 0.0))
    with pytest.raises(SomersaultError, match="duration above 0"):
        swing(mount.held, {}, 0.0)
    with pytest.raises(SomersaultError, match="finite numbers"):
        swing(mount.held, {"bar": np.nan}, 1.0)
    with pytest.raises(SomersaultError, match="not of the mount"):
        released(swung, mounted(doll, CLAMP))
    with pytest.raises(SomersaultError, match="no joint 'elbow'"):
        released(swung, mount, {"elbow": JointTakeoff("locked")})
    ball = replace(CLAMP, joints=(Joint("grip", "ball"),))
    with pytest.raises(SomersaultError, match="grip is a ball"):
        swing(mounted(doll, ball).held, {}, 1.0)
