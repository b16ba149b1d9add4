"""Steady spins and their linear equations against differences of MuJoCo's own accelerations.

Deviation coordinates are built here anew: the base is turned by a small rotation vector from a
frame that turns steadily about the principal axis, the joints stand a little off their pose,
torques hold them, and what MuJoCo accelerates is differenced.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import mujoco
import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment
from scipy.spatial.transform import Rotation
from shares import every
from trees import mujoco_addresses, random_tree, to_mujoco

from somersault.model import Model, load
from somersault.stability import LinearSpin, Spin, spin

TREES = 30
TURNS = {"tilt": 0, "somersault": 1, "twist": 2}
STEP = 2e-3  # of the five-point differences
AXES = (1, 2, 3)


def pose_of(model: Model, rng: np.random.Generator) -> dict[str, float]:
    """Every joint somewhere; a ball by its rotation vector."""
    sizes = {"hinge": 1.0, "slide": 0.2, "ball": 0.8}
    pose = {}
    for joint in model.joints:
        home = 0.0 if joint.kind == "ball" else joint.reference
        for speed in model.speeds[model.speed_slice(joint.name)]:
            pose[speed] = home + sizes[joint.kind] * rng.normal()
    return pose


@dataclass(frozen=True)
class Case:
    """A random body in the air, its spin, and springs and dampers on its joints."""

    spun: Spin
    pose: dict[str, float]
    stiffness: dict[str, float]
    damping: dict[str, float]


def random_case(number: int) -> Case:
    """The body of that number, always the same; every sixth has balls."""
    rng = np.random.default_rng([4, number])
    kinds = ("hinge", "slide", "ball") if number % 6 == 0 else ("hinge", "slide")
    model = random_tree(rng, bodies=2 + number % 3, free=True, kinds=kinds)
    pose = pose_of(model, rng)
    names = [joint.name for joint in model.joints]
    stiffness = dict(zip(names, rng.uniform(-1, 4, len(names)), strict=True))
    damping = dict(zip(names, rng.uniform(0, 1, len(names)), strict=True))
    return Case(spin(model, AXES[number % 3], pose), pose, stiffness, damping)


class Spinning:
    """A model in MuJoCo, spinning at Ω about a principal axis in a pose, torques holding it."""

    def __init__(self, spun: Spin, rate: float = 1.0, own: bool = False) -> None:
        """With `own` the model's springs and dampers act, and the torques allow for them."""
        model = spun.model
        self.spun, self.rate, self.count = spun, rate, len(model.speeds)
        bare = [replace(b, joints=tuple(map(_bare, b.joints))) for b in model.bodies]
        self.m = to_mujoco(model if own else replace(model, bodies=tuple(bare)))
        self.d = mujoco.MjData(self.m)
        q_at, self.v_at = mujoco_addresses(model, self.m)
        self.home = np.zeros(self.m.nq)
        self.home[3] = 1.0
        self.home[q_at] = spun.pose
        self.axis = spun.principal_axes[:, spun.axis - 1]
        self.torques = np.array([spun.holding_torques[s] for s in model.speeds]) * rate**2
        self.springs = self.dampers = np.zeros(self.count)
        if own:
            self.d.qpos[:] = self.home
            mujoco.mj_forward(self.m, self.d)
            self.torques = self.torques - self.d.qfrc_spring[self.v_at]

    def sprung(self, springs: np.ndarray, dampers: np.ndarray) -> Spinning:
        """Springs slack in the pose, and dampers, N m/rad and N m s/rad, as applied forces."""
        self.springs, self.dampers = springs, dampers
        return self

    def accelerations(self, x: np.ndarray, dx: np.ndarray) -> np.ndarray:
        """ẍ of the deviations x: turns about the principal axes, then the joints.

        Exact to first order in either where the other is zero: with δ̇ = 0 the base turns at
        exp(−δ) e Ω and its δ̈ is its ω̇; with δ = 0 it turns at e Ω + δ̇ and δ̈ = ω̇ + δ̇ × e Ω.
        """
        m, d, axes, steady = self.m, self.d, self.spun.principal_axes, self.axis * self.rate
        turn, turn_rate = axes @ x[:3], axes @ dx[:3]
        small = np.zeros(m.nv)
        small[3:6], small[self.v_at] = turn, x[3:]
        d.qpos[:] = self.home
        mujoco.mj_integratePos(m, d.qpos, small, 1.0)
        d.qvel[:] = 0.0
        d.qvel[3:6] = Rotation.from_rotvec(-turn).apply(steady) + turn_rate
        d.qvel[self.v_at] = dx[3:]
        d.qfrc_applied[:] = 0.0
        d.qfrc_applied[self.v_at] = self.torques - self.springs * x[3:] - self.dampers * dx[3:]
        mujoco.mj_forward(m, d)
        turned = axes.T @ (d.qacc[3:6] + np.cross(turn_rate, steady))
        return np.concatenate([turned, d.qacc[self.v_at]])

    @property
    def first_order(self) -> np.ndarray:
        """[−M⁻¹K, −M⁻¹C] by five-point differences, over turns 1, 2, 3 and the joint speeds."""
        n = 3 + self.count

        def at(step: np.ndarray) -> np.ndarray:
            return self.accelerations(step[:n], step[n:])

        columns = [8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h)) for h in STEP * np.eye(2 * n)]
        return np.column_stack(columns) / (12 * STEP)


def _bare(joint: object) -> object:
    return replace(joint, stiffness=0.0, damping=0.0)  # type: ignore[type-var]


def system_matrix(system: LinearSpin) -> np.ndarray:
    """[−M⁻¹(K + K′), −M⁻¹(G + D)] over turns 1, 2, 3 and the model's joint speeds."""
    names = (*TURNS, *system.spin.model.speeds)
    order = [system.coordinates.index(name) for name in names]
    at = np.ix_(order, order)
    right = np.hstack([(system.K + system.K_springs)[at], (system.G + system.D)[at]])
    return -np.linalg.solve(system.M[at], right)


def roots_of(half: np.ndarray) -> np.ndarray:
    n = len(half)
    return np.linalg.eigvals(np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), half]))


def assert_same_roots(ours: np.ndarray, theirs: np.ndarray, tolerance: float) -> None:
    """Paired off; the double zero, which rounding splits, aside."""
    ours, theirs = (r[np.argsort(np.abs(r))][2:] for r in (ours, theirs))
    gap = np.abs(ours[:, None] - theirs[None, :])
    assert gap[linear_sum_assignment(gap)].max() < tolerance * np.abs(ours).max()


@pytest.mark.parametrize("number", every(range(TREES), 3))
def test_random_trees(number: int) -> None:
    """All that is known of one body at once, as compiling its equations takes longest."""
    case = random_case(number)
    check_linear_equations(case)
    check_own_springs_and_dampers(case)
    for axis in AXES:
        spun = spin(case.spun.model, axis, case.pose)
        check_steady(spun)
        check_principal_inertias(spun)


def check_linear_equations(case: Case) -> None:
    spun, speeds = case.spun, case.spun.model.speeds
    system = spun.linear(case.stiffness, case.damping)
    inertia = np.array([spun.outboard_inertias[speed] for speed in speeds])
    owner = [speed if speed in case.stiffness else speed[:-2] for speed in speeds]
    springs, dampers = (
        np.array([numbers[name] for name in owner]) * inertia
        for numbers in (case.stiffness, case.damping)
    )
    theirs = Spinning(spun).sprung(springs, dampers).first_order
    ours = system_matrix(system)
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-7 * np.abs(ours).max())
    assert_same_roots(system.roots, roots_of(theirs), 1e-6)


def check_own_springs_and_dampers(case: Case) -> None:
    """At a rate in rad/s, MuJoCo's own spring and damper code with the model's rest angles.

    A ball's spring is not linear about a pose far from its rest, so there the pose is home.
    """
    spun, rate = case.spun, 2.7
    if any(joint.kind == "ball" and joint.stiffness for joint in spun.model.joints):
        spun = spin(spun.model, spun.axis)
    ours = system_matrix(spun.linear(rate=rate))
    half = Spinning(spun, rate, own=True).first_order
    n = 3 + len(spun.model.speeds)
    theirs = np.hstack([half[:, :n] / rate**2, half[:, n:] / rate])
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-7 * np.abs(ours).max())


def check_steady(spun: Spin) -> None:
    """With the holding torques nothing accelerates, not the body and not a joint."""
    nothing = np.zeros(3 + len(spun.model.speeds))
    spinning = Spinning(spun, 1.7)
    held = spinning.accelerations(nothing, nothing)
    spinning.torques = np.zeros_like(spinning.torques)
    let_go = spinning.accelerations(nothing, nothing)
    assert np.abs(held).max() < 1e-10 * np.abs(let_go).max()


def check_principal_inertias(spun: Spin) -> None:
    """The composite inertia out of MuJoCo's mass matrix, its translation eliminated."""
    spinning = Spinning(spun)
    spinning.accelerations(*np.zeros((2, 3 + len(spun.model.speeds))))
    moved = np.zeros((6, spinning.m.nv))
    for row, unit_speed in zip(moved, np.eye(spinning.m.nv), strict=False):
        mujoco.mj_mulM(spinning.m, spinning.d, row, unit_speed)
    along = moved[:3, 3:6]
    inertia = moved[3:6, 3:6] - along.T @ np.linalg.solve(moved[:3, :3], along)
    values, axes = spun.principal_inertias, spun.principal_axes
    np.testing.assert_allclose(np.sort(values), np.linalg.eigvalsh(inertia), rtol=1e-10)
    np.testing.assert_allclose(
        axes @ np.diag(values) @ axes.T, inertia, rtol=0, atol=1e-10 * values.max()
    )
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1)


@pytest.mark.parametrize("name", ["furrer", "simplest", "human_pike", "book"])
def test_shipped_models(name: str) -> None:
    """The mirrored coordinates have the roots that MuJoCo's left and right joints have."""
    model = load(name)
    pose = {"shoulder": 1.4} if name == "furrer" else {}
    for axis in AXES:
        spun = spin(model, axis, pose)
        system = spun.linear(dict.fromkeys(pose, 0.7))
        inertia = np.array([spun.outboard_inertias[speed] for speed in model.speeds])
        springs = 0.7 * inertia * (name == "furrer")
        theirs = roots_of(Spinning(spun).sprung(springs, 0 * springs).first_order)
        assert_same_roots(system.roots, theirs, 1e-5)
