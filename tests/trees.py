"""Random trees of bodies, the same trees in MuJoCo, and our own values for comparison.

The tests of the dynamics compare three independent programs on the same machine; what is
common to those comparisons stands here: the random model, a random state of it in our
variables (angular velocity of the base, velocity of its origin, both in its own axes, joint
speeds), and the translation of both into each program's variables, always by joint name.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import mujoco
import numpy as np

from somersault.attitude import matrix_from_quaternion
from somersault.dynamics import Equations
from somersault.model import GROUND, Body, Joint, Model, as_matrix, as_vector, load, mjcf

KINDS = ("hinge", "slide", "ball")


# --------------------------------------------------------------------------- random models


def random_tree(
    rng: np.random.Generator,
    bodies: int | None = None,
    free: bool | None = None,
    kinds: tuple[str, ...] = KINDS,
    *,
    armature: bool = True,
) -> Model:
    """A tree of two to seven bodies (or so many) that no symmetry makes easy.

    Axes, anchors, frames and references are arbitrary in half of the cases and along the
    coordinate axes or zero in the other half, as hand-written models have them. Joints of
    one body never coincide, so that the mass matrix is regular.
    """
    if bodies is None:
        bodies = int(rng.choice(np.arange(2, 8), p=[0.25, 0.25, 0.2, 0.1, 0.1, 0.1]))
    free = bool(rng.integers(2)) if free is None else free
    made: list[Body] = []
    for index in range(bodies):
        base = free and index == 0
        parent = GROUND if index == 0 else int(rng.integers(0 if free else GROUND, index))
        mass = float(rng.uniform(0.3, 4.0))
        made.append(
            Body(
                name=f"body{index}",
                parent=parent,
                mass=mass,
                com=_offset(rng, 0.2),
                inertia=random_inertia(rng, mass),
                position=(0.0, 0.0, 0.0) if base else _offset(rng, 0.5),
                rotation=as_matrix(np.eye(3) if base else _frame(rng)),
                joints=() if base else _joints(rng, index, kinds, armature),
            )
        )
    return Model("random", free, tuple(made))


def random_rotation(rng: np.random.Generator) -> np.ndarray:
    """A rotation matrix, uniform over all attitudes."""
    return matrix_from_quaternion(unit(rng, 4))


def unit(rng: np.random.Generator, size: int) -> np.ndarray:
    """A direction in that many dimensions, uniform over the sphere."""
    vector = rng.normal(size=size)
    return vector / np.linalg.norm(vector)


def random_inertia(rng: np.random.Generator, mass: float) -> Any:
    """Inertia of some cloud of mass: in any axes, and within the triangle inequality."""
    spread = mass * rng.uniform(0.02, 0.3, 3) ** 2
    axes = np.eye(3) if rng.integers(2) else random_rotation(rng)
    inertia = axes @ np.diag(spread.sum() - spread) @ axes.T
    return as_matrix((inertia + inertia.T) / 2)


def _offset(rng: np.random.Generator, size: float) -> Any:
    vector = rng.normal(size=3) * size
    return as_vector(vector * (rng.uniform(size=3) < 0.6))


def _frame(rng: np.random.Generator) -> np.ndarray:
    return random_rotation(rng) if rng.integers(2) else np.eye(3)


def _joints(rng: np.random.Generator, body: int, kinds: Any, armature: bool) -> tuple[Joint, ...]:
    count = int(rng.choice([1, 2, 3], p=[0.7, 0.2, 0.1]))
    joints: list[Joint] = []
    for number in range(count):
        kind = str(rng.choice(kinds))
        turning = [joint for joint in joints if joint.kind != "slide"]
        if kind != "slide" and any("ball" in (kind, joint.kind) for joint in turning):
            # A ball leaves nothing to turn about; MuJoCo too wants it alone.
            kind = "slide" if "slide" in kinds else kind
        if kind == "ball" and turning:
            break
        axis = _axis(rng, [np.array(joint.axis) for joint in joints if joint.kind == kind])
        joints.append(_joint(rng, f"joint{body}_{number}", kind, axis, armature))
    return tuple(joints)


def _axis(rng: np.random.Generator, taken: list[np.ndarray]) -> np.ndarray:
    """A direction well out of the span of those taken by joints of the same kind."""
    while True:
        axis = unit(rng, 3)
        if rng.integers(2):
            axis = np.eye(3)[rng.integers(3)] * rng.choice([-1.0, 1.0])
        span = np.linalg.svd(np.array([*taken, axis]), compute_uv=False)
        if span[-1] > 0.4:
            return axis


def _joint(
    rng: np.random.Generator, name: str, kind: Any, axis: np.ndarray, armature: bool
) -> Joint:
    ball, size = kind == "ball", 0.2 if kind == "slide" else 1.0

    def sometimes(value: float) -> float:
        return value if rng.integers(2) else 0.0

    return Joint(
        name=name,
        kind=kind,
        axis=(1.0, 0.0, 0.0) if ball else as_vector(axis),
        anchor=_offset(rng, 0.2),
        reference=0.0 if ball else sometimes(size * rng.normal()),
        stiffness=sometimes(rng.uniform(1.0, 20.0)),
        rest=0.0 if ball else sometimes(size * rng.normal()),
        damping=sometimes(rng.uniform(0.1, 2.0)),
        armature=sometimes(rng.uniform(0.01, 0.2)) if armature else 0.0,
    )


# --------------------------------------------------------------------------- random states


@dataclass(frozen=True)
class State:
    """Where a model is, how it moves and what acts on it, in our variables."""

    attitude: np.ndarray  # quaternion, base to world
    q: np.ndarray
    v: np.ndarray
    torques: np.ndarray
    gravity: np.ndarray  # in the base's axes

    @property
    def turn(self) -> np.ndarray:
        """Base components to world components."""
        return matrix_from_quaternion(self.attitude)


def random_state(model: Model, rng: np.random.Generator, gravity: bool = True) -> State:
    """Any attitude, joints about home, speeds, torques and gravity of order one to ten."""
    q = np.concatenate([np.zeros(0), *(_coordinates(joint, rng) for joint in model.joints)])
    return State(
        attitude=unit(rng, 4) if model.free else np.array([1.0, 0.0, 0.0, 0.0]),
        q=q,
        v=rng.normal(size=6 * model.free + len(model.speeds)) * 2,
        torques=rng.normal(size=len(model.speeds)) * 5,
        gravity=9.81 * unit(rng, 3) * gravity,
    )


def _coordinates(joint: Joint, rng: np.random.Generator) -> np.ndarray:
    if joint.kind == "ball":
        return unit(rng, 4)
    return np.array(joint.home) + (0.3 if joint.kind == "slide" else 1.0) * rng.normal(size=1)


def coordinate_rates(model: Model, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """d q/dt at the speeds v: a ball's quaternion turns with half the rate (0, ω) on its right."""
    own = v[6 * model.free :]
    rates = np.zeros(len(q))
    for joint in model.joints:
        at, speed = model.coordinate_slice(joint.name), model.speed_slice(joint.name)
        if joint.kind == "ball":
            w, axis, omega = q[at][0], q[at][1:], own[speed]
            rates[at] = 0.5 * np.array(
                [-axis @ omega, *(w * omega + np.cross(axis, omega))],
            )
        else:
            rates[at] = own[speed]
    return rates


# --------------------------------------------------------------------------------- MuJoCo


def to_mujoco(model: Model, timestep: float = 1e-3) -> mujoco.MjModel:
    """The same tree, without contact, for the Runge–Kutta integrator."""
    compiled = mujoco.MjModel.from_xml_string(mjcf(model))
    compiled.opt.timestep = timestep
    quiet(compiled)
    return compiled


def quiet(m: mujoco.MjModel) -> None:
    """Leave only what flies: no contacts, limits, gears or actuators; Runge–Kutta; energy on."""
    off = mujoco.mjtDisableBit
    for bit in (off.mjDSBL_CONTACT, off.mjDSBL_LIMIT, off.mjDSBL_ACTUATION, off.mjDSBL_EQUALITY):
        m.opt.disableflags |= int(bit)
    m.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    m.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4


class InMujoco:
    """A MuJoCo model's quantities at a state of ours, in our variables.

    Its free joint has linear velocity in world axes, then angular in the body's; its joints
    come in its own order and are looked up by name.
    """

    def __init__(self, model: Model, m: mujoco.MjModel, state: State) -> None:
        self.m, self.d, self.state = m, mujoco.MjData(m), state
        q_at, v_at = mujoco_addresses(model, m)
        self.to_theirs = np.zeros((m.nv, len(state.v)))  # their speeds = this · our speeds
        self.d.qpos[q_at] = state.q
        ahead = 0
        if model.free:
            kinds = [int(kind) for kind in m.jnt_type]
            free = kinds.index(int(mujoco.mjtJoint.mjJNT_FREE))
            q0, v0, ahead = int(m.jnt_qposadr[free]), int(m.jnt_dofadr[free]), 6
            self.d.qpos[q0 : q0 + 7] = [0.3, -0.2, 0.1, *state.attitude]
            self.to_theirs[v0 : v0 + 3, 3:6] = state.turn
            self.to_theirs[v0 + 3 : v0 + 6, 0:3] = np.eye(3)
        self.to_theirs[v_at, np.arange(len(v_at)) + ahead] = 1.0
        self.d.qvel[:] = self.to_theirs @ state.v
        self.d.qfrc_applied[v_at] = state.torques
        m.opt.gravity[:] = state.turn @ state.gravity
        mujoco.mj_forward(m, self.d)

    @property
    def forward_dynamics(self) -> np.ndarray:
        return self.to_theirs.T @ self.d.qacc

    def inverse_dynamics(self, a: np.ndarray) -> np.ndarray:
        self.d.qacc[:] = self.to_theirs @ a
        mujoco.mj_inverse(self.m, self.d)
        return self.to_theirs.T @ self.d.qfrc_inverse

    @property
    def mass_matrix(self) -> np.ndarray:
        columns = []
        for unit_speed in np.eye(self.m.nv):
            column = np.zeros(self.m.nv)
            mujoco.mj_mulM(self.m, self.d, column, unit_speed)
            columns.append(column)
        return self.to_theirs.T @ np.column_stack(columns) @ self.to_theirs

    @property
    def momentum(self) -> np.ndarray:
        """Of everything; a fixed base's angular momentum about the world's origin."""
        mujoco.mj_subtreeVel(self.m, self.d)
        linear = self.m.body_subtreemass[0] * self.d.subtree_linvel[0]
        angular = self.d.subtree_angmom[0].copy()
        if not _has_free(self.m):
            angular += np.cross(self.d.subtree_com[0], linear)
        return np.concatenate([self.state.turn.T @ angular, self.state.turn.T @ linear])

    @property
    def kinetic_energy(self) -> float:
        mujoco.mj_energyVel(self.m, self.d)
        return float(self.d.energy[1])

    @property
    def spring_energy(self) -> float:
        gravity = self.m.opt.gravity.copy()
        self.m.opt.gravity[:] = 0.0
        mujoco.mj_energyPos(self.m, self.d)
        self.m.opt.gravity[:] = gravity
        return float(self.d.energy[0])


def _has_free(m: mujoco.MjModel) -> bool:
    return bool(np.any(m.jnt_type == int(mujoco.mjtJoint.mjJNT_FREE)))


def mujoco_addresses(model: Model, m: mujoco.MjModel) -> tuple[list[int], list[int]]:
    """Where each of our joint coordinates stands in qpos, and each joint speed in qvel."""
    q_at: list[int] = []
    v_at: list[int] = []
    for joint in model.joints:
        theirs = m.joint(joint.name)
        q_at += range(int(theirs.qposadr[0]), int(theirs.qposadr[0]) + joint.coordinates)
        v_at += range(int(theirs.dofadr[0]), int(theirs.dofadr[0]) + joint.speeds)
    return q_at, v_at


# -------------------------------------------------------------------------- the same trees

TREES = 200
COMPILED_EVERY = 20  # of so many trees one is compiled; the rest CasADi evaluates, for speed


@dataclass(frozen=True)
class Case:
    """A model at a state, and our values there by the name of the quantity."""

    model: Model
    state: State
    accelerations: np.ndarray  # any, for inverse dynamics
    ours: dict[str, np.ndarray]


def drawn(number: int) -> tuple[Model, State, np.ndarray]:
    """The random tree of that number, always the same, with a state and accelerations."""
    rng = np.random.default_rng([1994, number])
    model = random_tree(rng)
    state = random_state(model, rng)
    return model, state, rng.normal(size=len(state.v)) * 5


@cache
def case(number: int) -> Case:
    """The random tree of that number with our values."""
    model, state, accelerations = drawn(number)
    ours = evaluated(Equations(model), state, accelerations, number % COMPILED_EVERY == 0)
    return Case(model, state, accelerations, ours)


def shipped_case(name: str, gravity: bool) -> Case:
    """A shipped model at a random state, by the compiled code."""
    model, rng = load(name), np.random.default_rng(7)
    state = random_state(model, rng, gravity)
    accelerations = rng.normal(size=len(state.v)) * 5
    return Case(model, state, accelerations, evaluated(Equations(model), state, accelerations))


QUANTITIES = (
    "forward_dynamics",
    "inverse_dynamics",
    "mass_matrix",
    "momentum",
    "kinetic_energy",
    "spring_energy",
)


def evaluated(
    equations: Equations,
    state: State,
    accelerations: np.ndarray,
    compiled: bool = True,
    quantities: tuple[str, ...] = QUANTITIES,
) -> dict[str, np.ndarray]:
    """Quantities that other programs compute too, by the compiled code or by CasADi."""
    given = {"q": state.q, "v": state.v, "a": accelerations}
    given |= {"torques": state.torques, "gravity": state.gravity}
    result = {}
    for name in quantities:
        expression = equations.expression(name)
        own = {key: given[key] for key in expression.arguments if key in given}
        if compiled:
            value = equations.evaluate(expression, **own)
        else:
            value = np.array(expression.function()(*own.values(), []))
        result[name] = value if name == "mass_matrix" else value[:, 0]
    return result


def assert_close(value: Any, wanted: Any, tolerance: float) -> None:
    """Equal to `tolerance` of the largest entry (and absolutely, where all entries are zero)."""
    wanted = np.asarray(wanted, float)
    size = np.abs(wanted).max(initial=0.0)
    np.testing.assert_allclose(value, wanted, rtol=0, atol=tolerance * (size if size > 0 else 1.0))
