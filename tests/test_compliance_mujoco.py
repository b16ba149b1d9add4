"""Compliant flights of the gymnast against MuJoCo's Runge–Kutta steps.

MuJoCo is given the springs and dampers about the paths and the motor tape at every stage of every
step. The tape is its own: SciPy integrates the nominal attitude from angular momentum kept, with
MuJoCo's composite inertia, and MuJoCo's inverse dynamics along that gives the torques.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import PPoly
from test_prescribed import (
    GYMNAST,
    MOVES,
    SECONDS,
    AlongPaths,
    Torques,
    assert_arrives,
    paths,
    prescribed,
)

import somersault as so
from somersault import JointTakeoff, Takeoff
from somersault.attitude import matrix_from_quaternion, quaternion_product

WITHIN = 1e-7
STEP = 0.01 / 32  # s; the knots are at whole steps
ZETA = 0.7


class Nominal(AlongPaths):
    """The flight of joints that follow their paths, by others; and what their motors do."""

    def __init__(self, model: so.Model, given: dict[str, PPoly]) -> None:
        super().__init__(model, given)
        self.knots = sorted({float(t) for p in given.values() for t in p.x if 0 < t < SECONDS})

    def mass(self, q: np.ndarray) -> np.ndarray:
        """MuJoCo's, in the body's axes: linear, angular, joints."""
        m, d = self.m, self.d
        d.qpos[:7], d.qpos[self.q_at] = [0, 0, 0, 1, 0, 0, 0], q
        mujoco.mj_fwdPosition(m, d)
        full = np.zeros((m.nv, m.nv))
        mujoco.mj_fullM(m, d, full)
        order = [*range(6), *self.v_at]
        return full[np.ix_(order, order)]

    def omega(self, t: float, quaternion: np.ndarray, h: np.ndarray) -> np.ndarray:
        """What h, in inertial axes, leaves to the body."""
        q, u, _ = self.wanted(t)
        mass = self.mass(q)
        away = np.linalg.solve(mass[:3, :3], mass[:3, 3:])  # the centre of mass rests
        reduced = mass[3:6, 3:] - mass[3:6, :3] @ away
        turned = matrix_from_quaternion(quaternion / np.linalg.norm(quaternion)).T @ h
        return np.linalg.solve(reduced[:, :3], turned - reduced[:, 3:] @ u)

    def flown(self, quaternion: np.ndarray, h: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Angular velocities at times (T,), knot by knot."""

        def rate(t: float, y: np.ndarray) -> np.ndarray:
            return 0.5 * quaternion_product(y, np.concatenate([[0.0], self.omega(t, y, h)]))

        found = np.empty((len(times), 3))
        state, begun = quaternion, 0.0
        for until in [*self.knots, SECONDS]:
            own = np.flatnonzero((times >= begun - 1e-12) & (times <= until + 1e-12))
            made = solve_ivp(
                rate, (begun, until), state, method="DOP853", rtol=1e-12, atol=1e-13,
                dense_output=True, max_step=0.03,
            )  # fmt: skip
            for k in own:
                found[k] = self.omega(times[k], made.sol(times[k]), h)
            state, begun = made.y[:, -1], until
        return found


class Compliant:
    """Torques of springs and dampers about the nominal motion, with the motor tape, by time."""

    def __init__(self, quaternion: np.ndarray, h: np.ndarray, tape: bool = True) -> None:
        self.nominal = Nominal(GYMNAST, paths())
        self.tick = STEP / 4  # the stages of steps of half the length
        times = np.arange(round(SECONDS / self.tick) + 1) * self.tick
        self.wanted = np.array([self.nominal.wanted(t) for t in times])
        self.tape = np.zeros((len(times), len(GYMNAST.speeds)))
        if tape:
            omegas = self.nominal.flown(quaternion, h, times)
            for k, omega in enumerate(omegas):
                self.tape[k] = self.nominal.torques(omega, *self.wanted[k])

    def inertias(self, q: np.ndarray) -> np.ndarray:
        """Outboard inertias: the diagonal of the mass matrix, all inboard held still."""
        return np.diag(self.nominal.mass(q))[6:].copy()

    def torques(self, gains: Callable[[int], tuple[np.ndarray, np.ndarray]]) -> Torques:
        """Of gains (k, c) at a tick."""
        q_at, v_at = self.nominal.q_at, self.nominal.v_at

        def found(d: mujoco.MjData) -> np.ndarray:
            tick = round(d.time / self.tick)
            (q, u, _), (k, c) = self.wanted[tick], gains(tick)
            return k * (q - d.qpos[q_at]) + c * (u - d.qvel[v_at]) + self.tape[tick]

        return found


@pytest.fixture(scope="module")
def nominal() -> so.Flight:
    return so.fly(GYMNAST, prescribed(), SECONDS, samples=2, accuracy=1e-11)


@pytest.fixture(scope="module")
def taped(nominal: so.Flight) -> Compliant:
    return Compliant(nominal.start.quaternion, nominal.start.momentum)


def off_nominal(takeoff: Takeoff) -> Takeoff:
    """Leant and twisted; the momentum stays in space."""
    return replace(takeoff, tilt=takeoff.tilt - 0.1, twist=takeoff.twist + 0.07)


def gave_way(flight: so.Flight) -> float:
    """The most that a joint leaves its path by."""
    wanted = np.array([[float(paths()[j.name](t)) for j in GYMNAST.joints] for t in flight.times])
    return float(np.abs(flight._joints[0] - wanted).max())


@pytest.mark.parametrize("natural_frequency", [20.0, 45.0])
def test_compliance_in_a_pose(taped: Compliant, natural_frequency: float) -> None:
    pose = so.named_pose("gymnast", "wrap")
    begun = off_nominal(so.compliant(GYMNAST, prescribed(), natural_frequency, ZETA, pose=pose))
    flight = so.fly(GYMNAST, begun, SECONDS, accuracy=1e-11)
    assert gave_way(flight) > 0.01  # else compliance was not tested
    wrapped = [pose[j.name.removeprefix("left_").removeprefix("right_")] for j in GYMNAST.joints]
    inertia = taped.inertias(np.array(wrapped))
    gains = natural_frequency**2 * inertia, 2 * ZETA * natural_frequency * inertia
    assert_arrives(flight, taped.torques(lambda _: gains), WITHIN, STEP)


def test_compliance_that_follows_the_pose(taped: Compliant) -> None:
    begun = off_nominal(so.compliant(GYMNAST, prescribed(), 30.0, 0.5, pose="following"))
    flight = so.fly(GYMNAST, begun, SECONDS, accuracy=1e-11)
    assert gave_way(flight) > 0.01
    inertias = np.array([taped.inertias(q) for q in taped.wanted[:, 0]])
    torques = taped.torques(lambda tick: (900.0 * inertias[tick], 30.0 * inertias[tick]))
    assert_arrives(flight, torques, WITHIN, STEP)


@pytest.mark.slow
def test_compliance_without_a_tape(nominal: so.Flight) -> None:
    begun = off_nominal(so.compliant(GYMNAST, prescribed(), 40.0, ZETA, pose=0.3, tape=False))
    flight = so.fly(GYMNAST, begun, SECONDS, accuracy=1e-11)
    bare = Compliant(nominal.start.quaternion, nominal.start.momentum, tape=False)
    inertia = bare.inertias(bare.nominal.wanted(0.3)[0])
    gains = 40.0**2 * inertia, 2 * ZETA * 40.0 * inertia
    assert_arrives(flight, bare.torques(lambda _: gains), WITHIN, STEP)


@pytest.mark.slow
def test_compliance_beside_prescribed_and_locked_joints() -> None:
    """Elbows and torso on their paths, hip abduction locked, all else compliant about a tape."""
    held = {n: MOVES[n][1][0] for n in ("left_hip_abduction", "right_hip_abduction")}
    exact = ("torso_twist", "left_elbow", "right_elbow")
    given = {**paths(), **{n: PPoly(np.array([[a]]), [-9.0, 9.0]) for n, a in held.items()}}
    whole = prescribed()
    locked = {n: JointTakeoff("locked", angle=a) for n, a in held.items()}
    whole = replace(whole, joints={**whole.joints, **locked})
    soft = so.compliant(GYMNAST, whole, 30.0, ZETA, pose=0.25)
    begun = off_nominal(
        replace(soft, joints={**soft.joints, **{n: whole.joints[n] for n in exact}})
    )
    flight = so.fly(GYMNAST, begun, SECONDS, accuracy=1e-11)
    start = so.fly(GYMNAST, whole, SECONDS, samples=2).start

    own = Nominal(GYMNAST, given)
    tick = STEP / 4
    times = np.arange(round(SECONDS / tick) + 1) * tick
    wanted = np.array([own.wanted(t) for t in times])
    omegas = own.flown(start.quaternion, start.momentum, times)
    tape = np.array([own.torques(w, *x) for w, x in zip(omegas, wanted, strict=True)])
    inertia = np.diag(own.mass(own.wanted(0.25)[0]))[6:].copy()
    names = [j.name for j in GYMNAST.joints]
    driven = np.array([k for k, n in enumerate(names) if n in held or n in exact])
    soft_ones = np.array([k for k in range(len(names)) if k not in driven])
    yields = np.concatenate([np.arange(6), 6 + soft_ones])  # what accelerates as it must

    def torques(d: mujoco.MjData) -> np.ndarray:
        at = round(d.time / tick)
        q, u = d.qpos[own.q_at].copy(), d.qvel[own.v_at].copy()
        pull = 900.0 * (wanted[at, 0] - q) + 2 * ZETA * 30.0 * (wanted[at, 1] - u)
        load = inertia * pull + tape[at]
        a = np.zeros(own.m.nv)
        a[6 + driven] = wanted[at, 2][driven]
        bias = own.loads(d.qvel[3:6].copy(), q, u, a)
        mass = own.mass(q)
        free = -bias
        free[6:] += load
        a[yields] = np.linalg.solve(mass[np.ix_(yields, yields)], free[yields])
        moving = np.zeros(own.m.nv)
        moving[yields] = a[yields]
        load[driven] = (bias + mass @ moving)[6 + driven]
        return load

    assert_arrives(flight, torques, WITHIN, STEP)
