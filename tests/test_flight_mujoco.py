"""Flights against MuJoCo's, and against angular momentum kept by its mass matrix.

MuJoCo's Runge–Kutta steps go over its own equations of the whole body in world axes, springs,
dampers and all. Joints that are locked are not there in its model: their bodies stand where
its own kinematics put them. Prescribed joints have no equal in it; there ω = A⁻¹(Rᵀh − B q̇),
with A and B from its mass matrix, is integrated by SciPy.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import mujoco
import mujoco.rollout
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import PPoly
from trees import InMujoco, State, mujoco_addresses, random_tree, to_mujoco, unit

from somersault.attitude import matrix_from_quaternion, quaternion_conjugate, quaternion_product
from somersault.flight import Flight, JointTakeoff, Takeoff, fly
from somersault.model import Joint, Model, as_matrix, as_vector, load, shipped

SECONDS = 2.0
STEP = 1e-3  # s; halved until what Runge–Kutta misses by is a tenth of WITHIN
WITHIN = 1e-8
TREES = 50


@dataclass(frozen=True)
class End:
    """Attitude, angular velocity in body axes, joints' coordinates and speeds by joint name."""

    quaternion: np.ndarray
    omega: np.ndarray
    joints: dict[str, np.ndarray]
    rates: dict[str, np.ndarray]


def ours(flight: Flight) -> End:
    model = flight.system.model
    q, u = (rows[-1] for rows in flight._joints)
    return End(
        flight.landing.quaternion,
        flight.landing.angular_velocity,
        {j.name: q[model.coordinate_slice(j.name)] for j in model.joints},
        {j.name: u[model.speed_slice(j.name)] for j in model.joints},
    )


@dataclass(frozen=True)
class Tree(Model):
    """Bodies as MJCF has them: unlike in other models, some may have no joint."""

    def __post_init__(self) -> None:
        """Nothing is refused."""


def theirs(model: Tree, flight: Flight, step: float) -> End:
    """MuJoCo's flight of `model`, whose joints are some of the flight's, from the same start."""
    m = to_mujoco(model, step)
    m.opt.enableflags = 0
    begun, whole, d = flight.start, flight.system.model, mujoco.MjData(m)
    d.qpos[3:7], d.qvel[3:6] = begun.quaternion, begun.omega
    for joint in model.joints:
        at, speed = (getattr(m.joint(joint.name), name)[0] for name in ("qposadr", "dofadr"))
        d.qpos[at : at + joint.coordinates] = begun.q[whole.coordinate_slice(joint.name)]
        d.qvel[speed : speed + joint.speeds] = begun.u[whole.speed_slice(joint.name)]
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    state = np.zeros((1, mujoco.mj_stateSize(m, kind)))
    mujoco.mj_getState(m, d, state[0], kind)
    states, _ = mujoco.rollout.rollout(m, d, state, nstep=round(SECONDS / step))
    mujoco.mj_setState(m, d, states[0, -1], kind)
    return End(
        d.qpos[3:7].copy(),
        d.qvel[3:6].copy(),
        {j.name: d.joint(j.name).qpos.copy() for j in model.joints},
        {j.name: d.joint(j.name).qvel.copy() for j in model.joints},
    )


def apart(one: np.ndarray, other: np.ndarray) -> float:
    """Angle of the turn from one attitude to another, rad."""
    turn = quaternion_product(quaternion_conjugate(one / np.linalg.norm(one)), other)
    return float(2 * np.linalg.norm(turn[1:]))


def distance(one: End, other: End) -> dict[str, float]:
    """Largest differences of attitude (rad), angular velocity, joints and joint speeds."""
    joints = [0.0]
    for name, value in other.joints.items():
        own = one.joints[name]
        joints.append(apart(own, value) if len(value) == 4 else float(np.abs(own - value).max()))
    rates = [float(np.abs(one.rates[name] - v).max()) for name, v in other.rates.items()]
    return {
        "attitude": apart(one.quaternion, other.quaternion),
        "omega": float(np.abs(one.omega - other.omega).max()),
        "joints": max(joints),
        "rates": max([0.0, *rates]),
    }


def assert_same(flight: Flight, model: Tree) -> None:
    """Ours is MuJoCo's to 1e-8, and MuJoCo's own error is a tenth of that or less."""
    step, fine, own_error = STEP, theirs(model, flight, STEP), np.inf
    while own_error > 0.1 * WITHIN:
        step, coarse = step / 2, fine
        fine = theirs(model, flight, step)
        own_error = distance(coarse, fine)["attitude"] / 15  # Richardson, of order four
        assert step > 3e-5, own_error
    for what, value in distance(ours(flight), fine).items():
        scale = 1.0 if what in ("attitude", "joints") else 20.0  # rates are as much larger
        assert value < scale * WITHIN, what


def welded(model: Tree | Model, flight: Flight, names: set[str]) -> Tree:
    """The model without those joints, where MuJoCo puts the bodies that they hold."""
    m = to_mujoco(model)
    d = mujoco.MjData(m)
    d.qpos[mujoco_addresses(flight.system.model, m)[0]] = flight.start.q
    mujoco.mj_kinematics(m, d)
    bodies = []
    for number, body in enumerate(model.bodies):
        kept = tuple(joint for joint in body.joints if joint.name not in names)
        if body.joints and not kept:
            upper = m.body(model.bodies[body.parent].name).id
            turn = d.xmat[upper].reshape(3, 3).T
            away = turn @ (d.xpos[m.body(body.name).id] - d.xpos[upper])
            rotation = turn @ d.xmat[m.body(body.name).id].reshape(3, 3)
            body = replace(body, position=as_vector(away), rotation=as_matrix(rotation))
        else:
            assert kept == body.joints, f"body {number} is locked in part only"
        bodies.append(replace(body, joints=kept))
    return Tree("tree", model.free, tuple(bodies))


def with_springs(model: Model, given: Mapping[str, JointTakeoff]) -> Tree:
    """The model whose joints have the springs and dampers of the takeoff as their own."""
    named = {"stiffness", "damping", "rest"}

    def own(joint: Joint) -> Joint:
        takeoff = given.get(joint.name, JointTakeoff())
        given_ = {n: getattr(takeoff, n, None) for n in named}
        values = {n: x for n, x in given_.items() if x is not None}
        if takeoff.motion == "free":
            values["stiffness"] = 0.0
        return replace(joint, **values)

    return Tree(
        "tree",
        model.free,
        tuple(replace(b, joints=tuple(own(j) for j in b.joints)) for b in model.bodies),
    )


def mobility(model: Model) -> np.ndarray:
    """What a torque at each joint speed has to move, the rest of the body yielding to it."""
    still = np.zeros(6 + len(model.speeds))
    state = State(np.eye(4)[0], model.home, still, still[6:], np.zeros(3))
    mass = InMujoco(model, to_mujoco(model), state).mass_matrix
    return 1 / np.diag(np.linalg.inv(mass))[6:]


# --------------------------------------------------------------------------- shipped models


def shoulders(**numbers: Any) -> dict[str, JointTakeoff]:
    """Both arms out, neither as the other; angles mirrored, then moved apart."""
    angle, rest = numbers.pop("angle", 1.2), numbers.pop("rest", None)
    return {
        f"{name}_shoulder": JointTakeoff(
            angle=side * angle + 0.1,
            rest=None if rest is None else side * rest + 0.05,
            **numbers,
        )
        for name, side in (("left", 1), ("right", -1))
    }


MOTIONS = {
    "sprung": {"motion": "sprung", "stiffness": 0.9, "rest": 1.4, "rate": 0.4},
    "damped": {"motion": "sprung", "stiffness": 0.6, "damping": 0.1, "rest": 0.9},
    "free": {"motion": "free", "damping": 0.02, "rate": -0.7},
}


def takeoff(joints: dict[str, JointTakeoff]) -> Takeoff:
    return Takeoff(
        somersault=0.4, tilt=0.3, twist=-0.5, angular_velocity=[0.5, 2.6, 0.9], joints=joints
    )


def inside(joint: Joint, angle: float) -> float:
    """The angle, or the joint's limit where that is nearer to zero."""
    low, high = joint.limits or (-np.inf, np.inf)
    return float(np.clip(angle, low, high))


def scaled(name: str, motion: dict[str, Any]) -> dict[str, JointTakeoff]:
    """A motion with its spring and damper times the inertia of the model's joints."""
    model = load(name)
    if not model.joints:
        return {}
    size = 30 * mobility(model).max()
    scale = {"stiffness": size, "damping": size}
    numbers = {what: n * scale[what] if what in scale else n for what, n in motion.items()}
    if len(model.joints) == 1:
        numbers.pop("rest", None)
        return {model.joints[0].name: JointTakeoff(angle=0.4, **numbers)}
    return shoulders(**numbers)


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("name", [n for n in shipped() if 0 < len(load(n).joints) < 3])
def test_shipped_models_with_moving_joints(name: str, motion: str) -> None:
    joints = scaled(name, MOTIONS[motion])
    flight = fly(name, takeoff(joints), SECONDS, accuracy=1e-10)
    moved = flight._joints[0]
    assert np.ptp(moved, axis=0).min() > 0.05  # else the springs were not tested
    assert_same(flight, with_springs(load(name), joints))


@pytest.mark.parametrize("name", shipped())
def test_shipped_models_locked(name: str) -> None:
    model = load(name)
    angles = {j.name: inside(j, 0.6 if "right" not in j.name else -0.9) for j in model.joints}
    joints = {n: JointTakeoff(motion="locked", angle=a) for n, a in angles.items()}
    flight = fly(model, takeoff(joints), SECONDS, accuracy=1e-10)
    assert_same(flight, welded(model, flight, set(angles)))


def test_one_arm_locked_one_sprung() -> None:
    joints = {
        "left_shoulder": JointTakeoff(motion="locked", angle=1.3),
        "right_shoulder": JointTakeoff(motion="sprung", angle=-0.2, stiffness=6.0, rest=-1.0),
    }
    model = load("furrer")
    flight = fly(model, takeoff(joints), SECONDS, accuracy=1e-10)
    assert_same(flight, welded(with_springs(model, joints), flight, {"left_shoulder"}))


# ---------------------------------------------------------------------------- random trees


def calm_tree(number: int) -> tuple[Model, Takeoff, set[str]]:
    """A free tree whose springs oscillate at some rad/s, a takeoff, and its locked joints.

    Joints with stiffness come as the model has them, some of the others are let go by the
    takeoff, and with them go all the joints of some bodies, locked at any angle.
    """
    rng = np.random.default_rng([2024, number])
    model = random_tree(rng, int(rng.integers(2, 4)), True)
    inertia = mobility(model)

    def calmed(joint: Joint) -> Joint:
        own = inertia[model.speed_slice(joint.name)].min()
        sprung = rng.uniform() < 0.7
        return replace(
            joint,
            stiffness=float(own * rng.uniform(2, 6) ** 2) if sprung else 0.0,
            damping=float(own * rng.uniform(0, 2)) if rng.integers(2) else 0.0,
        )

    calm = replace(
        model,
        bodies=tuple(replace(b, joints=tuple(calmed(j) for j in b.joints)) for b in model.bodies),
    )
    joints: dict[str, JointTakeoff] = {}
    locked: set[str] = set()
    for body in calm.bodies:
        hold = rng.uniform() < 0.2
        for joint in body.joints:
            size = 0.1 if joint.kind == "slide" else 0.5
            start: dict[str, Any] = {}
            if joint.kind != "ball":
                start["angle"] = joint.reference + size * float(rng.normal())
            if hold:
                locked.add(joint.name)
                joints[joint.name] = JointTakeoff(motion="locked", **start)
                continue
            if joint.kind != "ball":
                start["rate"] = size * float(rng.normal())
            motion = None if joint.stiffness else "free"
            joints[joint.name] = JointTakeoff(motion=motion, **start)
    spin = float(rng.uniform(2, 3)) * unit(rng, 3)
    return calm, Takeoff(quaternion=unit(rng, 4), angular_velocity=spin, joints=joints), locked


def check_tree(number: int) -> None:
    model, begun, locked = calm_tree(number)
    flight = fly(model, begun, SECONDS, samples=2, accuracy=1e-10)
    assert_same(flight, welded(with_springs(model, begun.joints), flight, locked))


@pytest.mark.parametrize("number", range(6))
def test_random_trees(number: int) -> None:
    check_tree(number)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(6, TREES))
def test_more_random_trees(number: int) -> None:
    check_tree(number)


def test_random_trees_are_of_every_sort() -> None:
    drawn = [calm_tree(number) for number in range(TREES)]
    moving = [j for model, _, locked in drawn for j in model.joints if j.name not in locked]
    held = [j for model, _, locked in drawn for j in model.joints if j.name in locked]
    kinds = {"hinge", "slide", "ball"}
    assert {joint.kind for joint in moving} == {joint.kind for joint in held} == kinds
    for kind in kinds:
        for name in ("stiffness", "damping"):
            own = [getattr(joint, name) != 0 for joint in moving if joint.kind == kind]
            assert 0.2 < np.mean(own) < 0.9


# ----------------------------------------------------------------------- prescribed joints


def quintic(times: np.ndarray, angles: np.ndarray) -> PPoly:
    """The moves as SciPy's polynomials in t - tₖ: 10 s³ - 15 s⁴ + 6 s⁵, and then held."""
    span, step = np.diff(times), np.diff(angles)
    zero = np.zeros_like(span)
    rows = np.array(
        [6 * step / span**5, -15 * step / span**4, 10 * step / span**3, zero, zero, angles[:-1]]
    )
    held = np.array([[0, 0, 0, 0, 0, a] for a in (angles[0], angles[-1])], float).T
    return PPoly(
        np.column_stack([held[:, :1], rows, held[:, 1:]]), [times[0] - 9, *times, times[-1] + 9]
    )


def by_momentum(
    model: Model,
    flight: Flight,
    paths: dict[str, PPoly],
    seconds: float,
    since: tuple[float, np.ndarray] | None = None,
) -> Any:
    """Attitude at the end, and the angular velocity, from h kept and MuJoCo's mass matrix.

    From takeoff on, or from a time and the attitude then.
    """
    m = to_mujoco(model)
    slopes = {name: path.derivative() for name, path in paths.items()}
    names = [joint.name for joint in model.joints]
    h = flight.start.momentum

    def omega(t: float, quaternion: np.ndarray) -> np.ndarray:
        unit_one = quaternion / np.linalg.norm(quaternion)
        q = np.array([paths[name](t) for name in names])
        u = np.array([slopes[name](t) for name in names])
        v = np.concatenate([np.zeros(6), u])
        mass = InMujoco(model, m, State(unit_one, q, v, np.zeros(len(q)), np.zeros(3))).mass_matrix
        # Rows of the base: angular about its origin, then linear; the centre of mass rests.
        wanted = np.linalg.solve(mass[3:6, 3:6], np.column_stack([mass[3:6, :3], mass[3:6, 6:]]))
        reduced = np.column_stack([mass[:3, :3], mass[:3, 6:]]) - mass[:3, 3:6] @ wanted
        turned = matrix_from_quaternion(unit_one).T @ h
        return np.linalg.solve(reduced[:, :3], turned - reduced[:, 3:] @ u)

    def rate(t: float, quaternion: np.ndarray) -> np.ndarray:
        return 0.5 * quaternion_product(quaternion, np.concatenate([[0.0], omega(t, quaternion)]))

    begun, state = (0.0, flight.start.quaternion) if since is None else since
    knots = sorted({float(t) for p in paths.values() for t in p.x if begun < t < seconds})
    for until in [*knots, seconds]:  # the path's third derivative jumps at its knots
        found = solve_ivp(rate, (begun, until), state, method="DOP853", rtol=1e-11, atol=1e-12)
        state, begun = found.y[:, -1], until
    return state / np.linalg.norm(state), omega(seconds, state)


@pytest.mark.parametrize("name", ["furrer", "doll_weighted", "simplest"])
def test_prescribed_joints_keep_the_momentum(name: str) -> None:
    model = load(name)
    moves = [
        (np.array([0.1, 0.5, 0.7, 1.4]), np.array([0.2, 1.3, 1.3, -0.3])),
        (np.array([0.0, 0.9]), np.array([-1.0, -0.1])),
    ]
    given = dict(zip([j.name for j in model.joints], moves, strict=False))
    begun = takeoff(
        {n: JointTakeoff(motion="prescribed", times=t, angles=a) for n, (t, a) in given.items()}
    )
    flight = fly(model, begun, 1.5, accuracy=1e-11)
    paths = {n: quintic(*move) for n, move in given.items()}
    attitude, omega = by_momentum(model, flight, paths, 1.5)
    assert apart(attitude, flight.landing.quaternion) < WITHIN
    np.testing.assert_allclose(flight.landing.angular_velocity, omega, rtol=0, atol=10 * WITHIN)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(3))
def test_prescribed_random_trees_keep_the_momentum(number: int) -> None:
    rng = np.random.default_rng([77, number])
    model = random_tree(rng, 2, True, ("hinge", "slide"))
    given = {}
    for joint in model.joints:
        times = np.cumsum(rng.uniform(0.1, 0.4, 3))
        size = 0.2 if joint.kind == "slide" else 1.0
        given[joint.name] = (times, joint.reference + size * rng.normal(size=3))
    joints = {
        n: JointTakeoff(motion="prescribed", times=t, angles=a) for n, (t, a) in given.items()
    }
    begun = Takeoff(quaternion=unit(rng, 4), angular_velocity=2.5 * unit(rng, 3), joints=joints)
    flight = fly(model, begun, 1.2, accuracy=1e-11)
    attitude, omega = by_momentum(model, flight, {n: quintic(*g) for n, g in given.items()}, 1.2)
    assert apart(attitude, flight.landing.quaternion) < WITHIN
    np.testing.assert_allclose(flight.landing.angular_velocity, omega, rtol=0, atol=10 * WITHIN)
