"""A body swung by what holds it, and let go: closed forms, MuJoCo, and what is conserved."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from scipy.integrate import simpson, solve_ivp
from scipy.special import ellipk
from trees import mujoco_addresses, quiet, to_mujoco

from somersault import SomersaultError, SomersaultWarning
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
from somersault.model import (
    GROUND,
    ZERO,
    Body,
    Joint,
    Model,
    Mount,
    athlete,
    load,
    mounted,
    sagittal,
)

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


# ------------------------------------------------------------------- joints that are driven


@pytest.fixture(scope="module")
def gymnast() -> Mount:
    """A gymnast on a bar, seen from the side."""
    hinge = Joint("bar", "hinge", (0.0, 1.0, 0.0))
    bar = Body("bar", GROUND, 0.0, ZERO, (ZERO, ZERO, ZERO), joints=(hinge,))
    flat = sagittal(athlete(1.67, 64, knees=True))
    return mounted(flat, bar, (0.0, 0.0, 0.55), body="upper_arm")


def test_what_goes_along_paths_moves_the_rest_as_mujocos_equations_say(gymnast: Mount) -> None:
    """The bar's angle alone is free: its equation from MuJoCo's mass matrix, by SciPy."""
    paths = {
        "shoulder_flexion": JointTakeoff.prescribed(times=[0.1, 0.6], angles=[3.0, 2.4]),
        "hip_flexion": JointTakeoff.prescribed(times=[0.0, 0.3, 0.8], angles=[-0.3, 0.5, 0.1]),
        "knee": JointTakeoff.locked(angle=0.2),
    }
    found = swing(
        gymnast.held, {"bar": 2.9}, 1.0, rates={"bar": -0.4}, joints=paths, samples=21,
        accuracy=1e-12,
    )  # fmt: skip
    m = to_mujoco(gymnast.held)
    quiet(m)
    m.opt.gravity[:] = GRAVITY
    d = mujoco.MjData(m)
    at, speeds = mujoco_addresses(gymnast.held, m)
    driven = [plan.does.whole() for plan in found.plans[1:3]]  # type: ignore[attr-defined]

    def slope(t: float, y: np.ndarray) -> list[float]:
        given = []
        for path in driven:
            since, powers = path.at(np.array([[t]]))
            one = np.polynomial.Polynomial(np.ravel(powers))
            given.append([float(one.deriv(n)(t - since.item())) for n in range(3)])
        d.qpos[at] = [y[0], given[0][0], given[1][0], 0.2]
        d.qvel[speeds] = [y[1], given[0][1], given[1][1], 0.0]
        mujoco.mj_forward(m, d)
        mass = np.zeros((m.nv, m.nv))
        mujoco.mj_fullM(m, d, mass)
        mass, bias = mass[np.ix_(speeds, speeds)], d.qfrc_bias[speeds]
        known = mass[0, 1] * given[0][2] + mass[0, 2] * given[1][2]
        return [y[1], (-bias[0] - known) / mass[0, 0]]

    whole = solve_ivp(
        slope, (0.0, 1.0), [2.9, -0.4], method="DOP853", rtol=1e-11, atol=1e-11,
        t_eval=found.times,
    )  # fmt: skip
    assert found.q[:, 0] == pytest.approx(whole.y[0], abs=1e-8)
    assert found.u[:, 0] == pytest.approx(whole.y[1], abs=1e-7)


def test_torques_and_dampers_drive_as_in_mujoco(gymnast: Mount) -> None:
    joints = {
        "hip_flexion": JointTakeoff.torque(angle=0.2, torque=30.0, damping=5.0),
        "shoulder_flexion": JointTakeoff.sprung(angle=3.0, stiffness=200.0, rest=2.8, damping=3.0),
    }
    found = swing(gymnast.held, {"bar": 2.0}, 0.6, joints=joints, samples=7, accuracy=1e-12)
    m = to_mujoco(gymnast.held, timestep=1e-4)
    quiet(m)
    m.opt.gravity[:], m.opt.integrator = GRAVITY, mujoco.mjtIntegrator.mjINT_RK4
    d = mujoco.MjData(m)
    at, speeds = mujoco_addresses(gymnast.held, m)
    d.qpos[at] = found.q[0]
    by = {name: speeds[gymnast.held.speed_slice(name).start] for name in joints}
    places = {name: at[gymnast.held.coordinate_slice(name).start] for name in joints}

    def push(m: mujoco.MjModel, d: mujoco.MjData) -> None:
        hip, shoulder = (by[name] for name in joints)
        d.qfrc_passive[hip] += 30.0 - 5.0 * d.qvel[hip]
        stretched = d.qpos[places["shoulder_flexion"]] - 2.8
        d.qfrc_passive[shoulder] += -200.0 * stretched - 3.0 * d.qvel[shoulder]

    mujoco.set_mjcb_passive(push)
    try:
        for _ in range(6000):
            mujoco.mj_step(m, d)
    finally:
        mujoco.set_mjcb_passive(None)
    assert d.qpos[at] == pytest.approx(found.q[-1], abs=1e-7)


def test_energy_comes_from_the_torques_of_what_is_driven(gymnast: Mount) -> None:
    kick = JointTakeoff.prescribed(times=[0.0, 0.5], angles=[-0.3, 0.9])
    found = swing(
        gymnast.held, {"bar": 1.0, "shoulder_flexion": np.pi}, 0.6, joints={"hip_flexion": kick},
        samples=6001, accuracy=1e-12,
    )  # fmt: skip
    at = gymnast.held.speed_slice("hip_flexion").start
    power = found.joint_torques[:, at] * found.u[:, at]
    energy = found.dataset["energy"].values
    work = simpson(power, x=found.times)
    assert abs(work) > 5.0
    assert energy[-1] - energy[0] == pytest.approx(work, abs=1e-6)
    free = [k for k in range(len(found.model.joints)) if k != at]
    assert np.abs(found.joint_torques[:, free]).max() < 1e-9


def test_a_law_senses_other_joints(gymnast: Mount) -> None:
    """The hips bend at a rate once the bar has been passed, and hear of it a tick late."""
    law = JointTakeoff.rate_law(
        angle=0.0, law="where(bar > 2.6, 2, 0)", every=0.02, delay=0.02, most_rate=5.0
    )
    found = swing(
        gymnast.held, {"bar": 2.0, "shoulder_flexion": np.pi}, 0.6, rates={"bar": 2.0},
        joints={"hip_flexion": law}, samples=6001,
    )  # fmt: skip
    bar, hip = found.q[:, 0], found.dataset["angle"].sel(joint="hip_flexion").values
    passed = found.times[np.argmax(bar > 2.6)]
    begins = found.times[np.argmax(hip > 1e-9)]
    assert 0.02 <= begins - passed <= 0.042
    with pytest.raises(SomersaultError, match="twist"):
        swing(
            gymnast.held, {}, 1.0,
            joints={"hip_flexion": JointTakeoff.rate_law(angle=0.0, law="twist")},
        )  # fmt: skip


def test_a_swing_that_breaks_off_says_so_and_is_not_let_go(gymnast: Mount) -> None:
    law = JointTakeoff.angle_law(angle=0.1, law="sqrt(-1 - time)")
    with pytest.warns(SomersaultWarning, match="broke off after 0 s"):
        found = swing(gymnast.held, {"bar": 1.0}, 0.2, joints={"hip_flexion": law})
    with pytest.raises(SomersaultError, match="nothing to let go"):
        released(found, gymnast)


def test_driven_joints_that_make_no_sense_are_refused(gymnast: Mount) -> None:
    still = JointTakeoff.locked(angle=0.2)
    with pytest.raises(SomersaultError, match="leave it out of angles"):
        swing(gymnast.held, {"knee": 0.1}, 1.0, joints={"knee": still})
    with pytest.raises(SomersaultError, match="leave it out of rates"):
        swing(gymnast.held, {}, 1.0, rates={"knee": 0.1}, joints={"knee": still})
    every = {joint.name: JointTakeoff.locked() for joint in gymnast.held.joints}
    with pytest.raises(SomersaultError, match="moves by itself"):
        swing(gymnast.held, {}, 1.0, joints=every)
    with pytest.raises(SomersaultError, match="hold balances a spin"):
        swing(
            gymnast.held, {}, 1.0,
            joints={"knee": JointTakeoff.sprung(angle=0.1, stiffness=1.0, hold=True)},
        )  # fmt: skip
    with pytest.raises(SomersaultError, match="nominal spin"):
        swing(gymnast.held, {}, 1.0, joints={"knee": JointTakeoff.sprung(angle=0.1, K=1.0)})


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
