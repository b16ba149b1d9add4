"""A somersault's flight once more, from its joint torques: by MuJoCo and by our own equations."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault.flight import Takeoff, fly
from somersault.flight.behaviours import Torque
from somersault.robot import Run
from somersault.thesis.ch3._runs import nominal

_AWAY = 0.004  # s after the feet have left the ground, and before they are back
_STEP = 5e-5  # s of MuJoCo's
_FREE = ("contact", "limit", "actuation")


@dataclass(frozen=True, eq=False)
class Reflown:
    """A flight from the same state with the same torques.

    Attributes
    ----------
    times : ndarray, (T,)
        s.
    run, mujoco, ours : ndarray, (T, 4 + joints)
        Attitude (a quaternion) and joints: as the run had them, and from the torques.
    """

    times: Array
    run: Array
    mujoco: Array
    ours: Array

    def apart(self, one: Array, other: Array) -> tuple[float, float]:
        """The greatest angle between two attitudes and difference of two joints, rad and m."""
        dots = np.abs(np.sum(one[:, :4] * other[:, :4], axis=1))
        angle = 2 * np.arccos(np.clip(dots, -1, 1))
        return float(angle.max()), float(np.abs(one[:, 4:] - other[:, 4:]).max())


@cache
def reflown() -> Reflown:
    """The nominal somersault's flight."""
    return refly(nominal())


def refly(run: Run) -> Reflown:
    """The flight of a run that was recorded each millisecond."""
    first = run.began("tuck") + _AWAY
    last = run.began("landing compression") - _AWAY
    rows = np.flatnonzero((run.times >= first) & (run.times <= last))
    times = run.times[rows] - run.times[rows[0]]
    torques = _torques(run, rows)
    state = np.concatenate([run.base_quaternion, run.joint_coordinates], 1)[rows]
    joints = run.model.coordinates
    driven = {
        name: Torque(
            angle=float(state[0, 4 + k]), rate=float(_rate(run, rows[0], name)),
            times=times.tolist(), torques=torques[:, k].tolist(), stiffness=0.0, damping=0.0,
        )
        for k, name in enumerate(joints)
    }  # fmt: skip
    takeoff = Takeoff(
        quaternion=state[0, :4].tolist(),
        angular_velocity=run.rates[rows[0], 3:6].tolist(),
        joints=driven,
    )
    flown = fly(run.model, takeoff, float(times[-1]), samples=times, accuracy=1e-10)
    ours = np.concatenate([flown.base_quaternion, flown.joint_coordinates], 1)
    return Reflown(times, state, _by_mujoco(run, rows, times, torques), ours)


def _rate(run: Run, row: int, joint: str) -> float:
    return float(run.rates[row, int(run.robot.machine.mujoco.joint(joint).dofadr[0])])


def _columns(run: Run) -> tuple[list[int], list[int]]:
    """Where MuJoCo keeps the model's joints: in positions and in rates."""
    m = run.robot.machine.mujoco
    joints = [m.joint(name) for name in run.model.coordinates]
    return [int(j.qposadr[0]) for j in joints], [int(j.dofadr[0]) for j in joints]


def _torques(run: Run, rows: Array) -> Array:
    """What acted on each joint, of actuators and limits."""
    import mujoco

    m = run.robot.machine.mujoco
    data, (_, speeds) = mujoco.MjData(m), _columns(run)
    found = []
    for k in rows:
        data.qpos, data.qvel, data.ctrl = run.positions[k], run.rates[k], run.drive[k]
        mujoco.mj_forward(m, data)
        acting = data.qfrc_actuator + data.qfrc_constraint
        found.append(acting[speeds])
    return np.array(found)


def _by_mujoco(run: Run, rows: Array, times: Array, torques: Array) -> Array:
    """The flight by MuJoCo's fourth-order integrator, with nothing but these torques."""
    import mujoco

    m: Any = copy.copy(run.robot.machine.mujoco)
    m.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    m.opt.timestep = _STEP
    for name in _FREE:
        m.opt.disableflags |= int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{name.upper()}"))
    data, (places, speeds) = mujoco.MjData(m), _columns(run)
    data.qpos, data.qvel = run.positions[rows[0]], run.rates[rows[0]]
    found = []
    per = round(float(times[1] - times[0]) / _STEP)
    for k in range(len(times)):
        found.append(np.concatenate([data.qpos[3:7], data.qpos[places]]))
        for step in range(per if k + 1 < len(times) else 0):
            share = (step + 0.5) / per  # in the middle of the step, along the straight line
            data.qfrc_applied[speeds] = (1 - share) * torques[k] + share * torques[k + 1]
            mujoco.mj_step(m, data)
    return np.array(found)
