"""The gymnast with all thirteen joints prescribed, against MuJoCo, pinocchio and closed forms.

The moves are ones of this file's own: asymmetric, all joints moving, tilting and twisting the
body, and none of the motions that ship. Three others fly them: angular momentum kept with
MuJoCo's mass matrix, MuJoCo's Runge–Kutta steps under the torques that its own mass matrix asks
for, and pinocchio's inverse dynamics along the way.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import factorial

import mujoco
import numpy as np
import pytest
from scipy.interpolate import PPoly
from test_flight_mujoco import apart, by_momentum, quintic
from trees import InMujoco, State, mujoco_addresses, to_mujoco

import somersault as so
from somersault import JointTakeoff, SomersaultError, Takeoff
from somersault.attitude import matrix_from_quaternion, quaternion_product
from somersault.rigid import RigidMotion

GYMNAST = so.load("gymnast")
SECONDS = 0.5
# Knots on hundredths of a second, so that no step of a fixed length goes across one.
MOVES: dict[str, tuple[list[float], list[float]]] = {
    "torso_twist": ([0.05, 0.2, 0.38], [0.0, -0.4, 0.2]),
    "left_shoulder_abduction": ([0.08, 0.25, 0.45], [1.4, 0.2, 1.1]),
    "left_shoulder_rotation": ([0.08, 0.25, 0.45], [0.0, 0.6, -0.1]),
    "left_shoulder_flexion": ([0.1, 0.27, 0.45], [0.1, 0.8, 0.0]),
    "left_elbow": ([0.05, 0.25, 0.42], [0.2, 1.7, 0.3]),
    "right_shoulder_abduction": ([0.02, 0.18, 0.4], [1.5, 0.3, 2.2]),
    "right_shoulder_rotation": ([0.02, 0.2, 0.4], [0.1, 0.5, 0.0]),
    "right_shoulder_flexion": ([0.02, 0.22, 0.4], [0.0, 0.6, 1.0]),
    "right_elbow": ([0.1, 0.28, 0.4], [0.0, 1.5, 0.4]),
    "left_hip_flexion": ([0.0, 0.24, 0.33, 0.49], [1.3, 0.1, 0.1, 0.6]),
    "left_hip_abduction": ([0.03, 0.2, 0.36], [0.0, 0.4, 0.1]),
    "right_hip_flexion": ([0.02, 0.25, 0.33, 0.48], [1.2, 0.0, 0.1, 0.5]),
    "right_hip_abduction": ([0.03, 0.2, 0.36], [0.1, -0.3, 0.0]),
}


def paths() -> dict[str, PPoly]:
    """The moves as SciPy has them."""
    return {name: quintic(np.array(t), np.array(a)) for name, (t, a) in MOVES.items()}


def prescribed(**start: object) -> Takeoff:
    """The takeoff of the moves, from an attitude that nothing is aligned with."""
    joints = {n: JointTakeoff("prescribed", times=t, angles=a) for n, (t, a) in MOVES.items()}
    given = {"somersault": 0.3, "tilt": 0.08, "twist": -0.06, "spin": 9.0, **start}
    return Takeoff(**given, joints=joints)


@pytest.fixture(scope="module")
def flight() -> so.Flight:
    return so.fly(GYMNAST, prescribed(), SECONDS, accuracy=1e-11)


# ------------------------------------------------------------- MuJoCo with torques of ours

Torques = Callable[[mujoco.MjData], np.ndarray]


@dataclass(frozen=True)
class Arrival:
    """Attitude, angular velocity in body axes, joint coordinates and speeds in our order."""

    quaternion: np.ndarray
    omega: np.ndarray
    q: np.ndarray
    u: np.ndarray


def moments(step: float, knots: Sequence[float] = ()) -> np.ndarray:
    """Where steps begin and end: no longer than `step`, and none across a knot."""
    corners = [0.0, *sorted(k for k in knots if 0 < k < SECONDS), SECONDS]
    gaps = [(a, b, int(np.ceil((b - a) / step - 1e-9))) for a, b in pairwise(corners)]
    return np.unique(np.concatenate([np.linspace(a, b, n + 1) for a, b, n in gaps]))


def halved(at: np.ndarray) -> np.ndarray:
    """The same with the middle of each step."""
    return np.sort(np.concatenate([at, 0.5 * (at[1:] + at[:-1])]))


def stepped(flight: so.Flight, torques: Torques, at: np.ndarray) -> Arrival:
    """MuJoCo's Runge–Kutta flight from the same start, with joint torques that it asks for.

    They are asked for at every stage, with the stage's time, coordinates and speeds: torques held
    over a step would leave a method of the first order.
    """
    m = to_mujoco(flight.system.model, at[1])
    m.opt.enableflags = 0
    q_at, v_at = mujoco_addresses(flight.system.model, m)
    d = mujoco.MjData(m)
    begun = flight.start
    d.qpos[3:7], d.qvel[3:6] = begun.quaternion, begun.omega
    d.qpos[q_at], d.qvel[v_at] = begun.q, begun.u

    def passive(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        data.qfrc_passive[v_at] += torques(data)

    mujoco.set_mjcb_passive(passive)
    try:
        for d.time, m.opt.timestep in zip(at, np.diff(at), strict=False):
            mujoco.mj_step(m, d)
    finally:
        mujoco.set_mjcb_passive(None)
    return Arrival(d.qpos[3:7].copy(), d.qvel[3:6].copy(), d.qpos[q_at].copy(), d.qvel[v_at].copy())


def assert_arrives(
    flight: so.Flight, torques: Torques, within: float, step: float, knots: Sequence[float] = ()
) -> None:
    """Ours is MuJoCo's, whose own error, by halving its step, is a tenth of that or less."""
    at = moments(step, knots)
    coarse, fine = (stepped(flight, torques, x) for x in (at, halved(at)))
    own = max(apart(coarse.quaternion, fine.quaternion), float(np.abs(coarse.q - fine.q).max()))
    assert own / 15 < 0.1 * within  # of order four
    q, u = (rows[-1] for rows in flight._joints)
    assert apart(fine.quaternion, flight.landing.quaternion) < within
    np.testing.assert_allclose(fine.q, q, rtol=0, atol=within)
    scale = 30.0  # rates are as much larger
    omega = flight.landing.angular_velocity
    np.testing.assert_allclose(fine.omega, omega, rtol=0, atol=scale * within)
    np.testing.assert_allclose(fine.u, u, rtol=0, atol=scale * within)


def together(each: list[PPoly]) -> PPoly:
    """Paths as one, with the knots of all, which is quicker to evaluate."""
    knots = np.unique(np.concatenate([p.x for p in each] + [[-1.0, 2 * SECONDS]]))
    knots = knots[(knots >= -1.0) & (knots <= 2 * SECONDS)]
    powers = range(max(len(p.c) for p in each))
    rows = [np.stack([p(knots[:-1], k) / factorial(k) for p in each], -1) for k in powers]
    return PPoly(np.array(rows[::-1]), knots)


class AlongPaths:
    """MuJoCo's inverse dynamics of joints that follow paths on a base that nothing holds."""

    def __init__(self, model: so.Model, given: dict[str, PPoly]) -> None:
        self.m = to_mujoco(model)
        # Without springs and dampers MuJoCo does not call back for passive torques: this is
        # asked from within such a call.
        for bit in (mujoco.mjtDisableBit.mjDSBL_SPRING, mujoco.mjtDisableBit.mjDSBL_DAMPER):
            self.m.opt.disableflags |= int(bit)
        self.d = mujoco.MjData(self.m)
        self.q_at, self.v_at = mujoco_addresses(model, self.m)
        self.path = together([given[joint.name] for joint in model.joints])

    def wanted(self, t: float) -> np.ndarray:
        """Values, rates and accelerations of the joints, (3, joints)."""
        return np.array([self.path(t, order) for order in range(3)])

    def loads(self, omega: np.ndarray, q: np.ndarray, u: np.ndarray, a: np.ndarray) -> np.ndarray:
        """What accelerations `a` of base and joints take: linear, angular, joints."""
        m, d = self.m, self.d
        # In the body's axes, its origin at rest: neither attitude nor drift changes torques.
        d.qpos[:7], d.qvel[:3], d.qvel[3:6] = [0, 0, 0, 1, 0, 0, 0], 0.0, omega
        d.qpos[self.q_at], d.qvel[self.v_at] = q, u
        order = [*range(6), *self.v_at]
        d.qacc[order] = a
        mujoco.mj_inverse(m, d)
        return d.qfrc_inverse[order].copy()

    def torques(self, omega: np.ndarray, q: np.ndarray, u: np.ndarray, a: np.ndarray) -> np.ndarray:
        """At the joints, for accelerations `a` of theirs and no load from outside."""
        whole = np.concatenate([np.zeros(6), a])
        held = self.loads(omega, q, u, whole)[:6]
        mass = np.zeros((self.m.nv, self.m.nv))
        mujoco.mj_fullM(self.m, self.d, mass)
        whole[:6] = np.linalg.solve(mass[:6, :6], -held)
        found = self.loads(omega, q, u, whole)
        assert np.abs(found[:6]).max() < 1e-9
        return found[6:]


# ------------------------------------------------------------------------------ the others


def test_thirteen_joints_keep_the_momentum(flight: so.Flight) -> None:
    """Against SciPy's integration of h kept, with MuJoCo's composite inertia."""
    attitude, omega = by_momentum(GYMNAST, flight, paths(), SECONDS)
    assert apart(attitude, flight.landing.quaternion) < 1e-8
    np.testing.assert_allclose(flight.landing.angular_velocity, omega, rtol=0, atol=1e-7)
    moved = np.ptp(flight._joints[0], axis=0)
    assert moved.min() > 0.3  # all thirteen
    assert abs(flight.landing.twist - prescribed().twist) > 1.0


def test_mujoco_steps_thirteen_joints_along_their_paths(flight: so.Flight) -> None:
    """Equations of motion, momentum not mentioned: torques that give the paths' accelerations."""
    along = AlongPaths(GYMNAST, paths())

    def torques(d: mujoco.MjData) -> np.ndarray:
        q, u = d.qpos[along.q_at].copy(), d.qvel[along.v_at].copy()
        return along.torques(d.qvel[3:6].copy(), q, u, along.wanted(d.time)[2])

    assert_arrives(flight, torques, 1e-7, 0.01 / 16)


def test_angular_momentum_by_mujoco(flight: so.Flight) -> None:
    """MuJoCo's own sum over the bodies, at every sample, in inertial axes."""
    m = to_mujoco(GYMNAST)
    (q, u), none = flight._joints, np.zeros(len(GYMNAST.speeds))
    found = []
    for k in range(0, len(flight.times), 5):
        v = np.concatenate([flight.angular_velocity[k], np.zeros(3), u[k]])
        quaternion = flight.states[k, :4]
        own = InMujoco(GYMNAST, m, State(quaternion, q[k], v, none, np.zeros(3)))
        found.append(matrix_from_quaternion(quaternion) @ own.momentum[:3])
    size = np.linalg.norm(found[0])
    np.testing.assert_allclose(found, np.tile(found[0], (len(found), 1)), atol=1e-12 * size)
    assert flight.momentum_drift < 1e-12


def test_joint_torques_are_pinocchios(flight: so.Flight) -> None:
    """rnea with the base's acceleration that leaves it free, by pinocchio's own mass matrix."""
    pin = pytest.importorskip("pinocchio")
    from test_dynamics_pinocchio import InPinocchio

    (q, u), none = flight._joints, np.zeros(len(GYMNAST.speeds))
    slopes = [path.derivative(2) for path in (paths()[j.name] for j in GYMNAST.joints)]
    ours, theirs = flight.joint_torques.values, []
    for k, t in enumerate(flight.times):
        v = np.concatenate([flight.angular_velocity[k], np.zeros(3), u[k]])
        own = InPinocchio(GYMNAST, State(flight.states[k, :4], q[k], v, none, np.zeros(3)))
        wanted = np.zeros(len(v))
        wanted[6:] = [float(slope(t)) for slope in slopes]
        held = own.inverse_dynamics(wanted)
        wanted[:6] = np.linalg.solve(own.mass_matrix[:6, :6], -held[:6])
        theirs.append(own.inverse_dynamics(wanted))
    needed = np.array(theirs)
    size = np.abs(needed).max()
    assert size > 50.0  # N m: otherwise little was moved
    assert np.abs(needed[:, :6]).max() < 1e-9
    np.testing.assert_allclose(ours, needed[:, 6:], rtol=0, atol=1e-10 * size)
    assert pin.__version__


def test_nothing_from_outside_is_needed(flight: so.Flight) -> None:
    assert np.abs(flight.external_moment).max() < 1e-9
    assert np.abs(flight._loads[:, 3:6]).max() < 1e-9  # force


# ------------------------------------------------------------------------- attitude alone


@pytest.mark.parametrize("name", [n for n in so.shipped() if n != "furrer"])
def test_a_locked_body_is_a_rigid_body(name: str) -> None:
    """Elliptic functions, about the principal axes of MuJoCo's composite inertia."""
    model = so.load(name)
    at = {}
    for joint in model.joints:
        low, high = joint.limits or (-1.0, 1.0)
        at[joint.name] = float(np.clip(0.4 if "right" in joint.name else 0.7, low, high))
    joints = {n: JointTakeoff("locked", angle=a) for n, a in at.items()}
    begun = Takeoff(
        somersault=0.2, tilt=0.3, twist=-0.4, angular_velocity=(1.0, 5.0, 0.7), joints=joints
    )
    own = so.fly(model, begun, 2.0, accuracy=1e-12)
    assert own.states.shape[1] == 4  # the attitude and nothing else
    still = np.zeros(6 + len(model.speeds))
    q, none = own.start.q, still[6:]
    state = State(own.start.quaternion, q, still, none, np.zeros(3))
    mass = InMujoco(model, to_mujoco(model), state).mass_matrix
    away = mass[:3, 3:6] / mass[3, 3]
    inertia = mass[:3, :3] - mass[:3, 3:6] @ away.T
    moments, axes = np.linalg.eigh((inertia + inertia.T) / 2)
    axes[:, 2] *= np.linalg.det(axes)
    principal = np.zeros(4)
    mujoco.mju_mat2Quat(principal, axes.ravel())
    motion = RigidMotion(
        moments, axes.T @ own.start.omega, quaternion_product(own.start.quaternion, principal)
    )
    back = principal * [1, -1, -1, -1]
    theirs = motion.quaternion(own.times)
    for k in range(0, len(own.times), 20):
        assert apart(quaternion_product(theirs[k], back), own.states[k, :4]) < 1e-10
    omega = motion.omega(own.times) @ axes.T
    np.testing.assert_allclose(own.angular_velocity, omega, rtol=0, atol=1e-9)
    assert own.momentum_drift < 1e-13


def test_prescribed_to_stay_is_locked() -> None:
    angles = {name: a[0] for name, (_, a) in MOVES.items()}
    held = {
        n: JointTakeoff("prescribed", times=[0.1, 0.3], angles=[a, a]) for n, a in angles.items()
    }
    locked = {n: JointTakeoff("locked", angle=a) for n, a in angles.items()}
    ends = [
        so.fly(GYMNAST, Takeoff(tilt=0.1, spin=9.0, joints=joints), 1.0, accuracy=1e-12).landing
        for joints in (held, locked)
    ]
    assert apart(ends[0].quaternion, ends[1].quaternion) < 1e-11


def test_speeding_up_a_motion_without_momentum_turns_no_farther() -> None:
    """At zero momentum attitude depends on the path through shapes alone, not on its speed."""
    model, ends = GYMNAST, []
    for factor in (1.0, 0.3, 2.5):
        joints = {
            n: JointTakeoff("prescribed", times=np.multiply(t, factor), angles=a)
            for n, (t, a) in MOVES.items()
        }
        begun = Takeoff(tilt=0.1, angular_momentum=(0.0, 0.0, 0.0), joints=joints)
        ends.append(so.fly(model, begun, SECONDS * factor, accuracy=1e-12).landing.quaternion)
    assert apart(ends[0], ends[1]) < 1e-11
    assert apart(ends[0], ends[2]) < 1e-11
    start = so.fly(model, begun, SECONDS).states[0, :4]
    assert apart(ends[0], start) > 0.3  # and it has turned


# ------------------------------------------------------------------------------- mistakes


def _joint(**given: object) -> Takeoff:
    return Takeoff(spin=5.0, joints={"left_elbow": JointTakeoff("prescribed", **given)})


@pytest.mark.parametrize(
    ("mistake", "word"),
    [
        (lambda: _joint(), "left_elbow"),
        (lambda: _joint(times=[0.1, 0.2]), "as many times as angles"),
        (lambda: _joint(times=[0.1, 0.2], angles=[0.1, 0.2, 0.3]), "as many times as angles"),
        (lambda: _joint(times=[0.2, 0.1], angles=[0.1, 0.2]), "increase"),
        (lambda: _joint(times=[0.2, 0.2], angles=[0.1, 0.2]), "increase"),
        (lambda: _joint(times=[0.1, np.nan], angles=[0.1, 0.2]), "left_elbow"),
        (lambda: _joint(times=[0.1, 0.2], angles=[0.1, np.nan]), "left_elbow"),
        (lambda: _joint(times=[0.1, np.inf], angles=[0.1, 0.2]), "left_elbow"),
        (lambda: _joint(times=["a", "b"], angles=[0.1, 0.2]), "left_elbow"),
        (lambda: _joint(times=[0.1, 0.2], angles=[0.1, 20.0]), "limits"),
        (lambda: _joint(times=[0.1, 0.2], angles=[0.1, 0.2], angle=0.1), "path"),
        (lambda: _joint(times=[0.1, 0.2], angles=[0.1, 0.2], rate=0.1), "path"),
        (lambda: _joint(times=[0.1, 0.2], angles=[0.1, 0.2], stiffness=3.0), "prescribed"),
        (lambda: _joint(times=[0.1, 0.2], angles=[0.1, 0.2], damping=3.0), "prescribed"),
        (lambda: _joint(times=[0.1, 0.2], angles=[0.1, 0.2], pretension=3.0), "prescribed"),
        (lambda: _joint(times=[0.1, 0.2], angles=[0.1, 0.2], following=True), "prescribed"),
        (lambda: _joint(times=[[0.1, 0.2]], angles=[[0.1, 0.2]]), "left_elbow"),
    ],
)
def test_one_sentence_for_a_path_that_is_none(mistake: Callable[[], Takeoff], word: str) -> None:
    with pytest.raises(SomersaultError) as told:
        so.fly(GYMNAST, mistake(), 0.2)
    assert word in str(told.value)
    assert "\n" not in str(told.value)
