"""Robots in MuJoCo, ready to run: what the numbers of a run say of their bodies and their start."""

from __future__ import annotations

import copy
import ctypes
import os
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault.engine import System
from somersault.robot._control import Control
from somersault.robot._controller import REMEMBERED
from somersault.robot._robot import Machine, Robot
from somersault.simulation import Name

_NUMBERS = tuple(Control().numbers())
_KEPT = tuple(REMEMBERED)


@cache
def advance() -> int:
    """The address of MuJoCo's `void mj_step(const mjModel *, mjData *)`."""
    import mujoco

    folder = Path(mujoco.__file__).parent
    names = [n for n in os.listdir(folder) if n.startswith(("libmujoco", "mujoco.dll"))]
    library = ctypes.CDLL(str(folder / min(names, key=len)))
    return int(ctypes.cast(library.mj_step, ctypes.c_void_p).value or 0)


class Lane:
    """Room for one robot that runs, used for one run after another."""

    def __init__(self, robot: Robot) -> None:
        import mujoco

        self._robot = robot
        self.model: Any = robot.machine.mujoco
        self.data = mujoco.MjData(self.model)
        self.kept = np.zeros(len(_KEPT))
        self._numbers = np.zeros(len(_NUMBERS))

    def begin(self, numbers: Array) -> System:
        """A run with these numbers, in the order of `Control.numbers`."""
        import mujoco

        given: dict[Name, float] = dict(zip(_NUMBERS, numbers.tolist(), strict=True))
        robot, data = self._robot, self.data
        self.model = _changed(robot.machine, given)
        mujoco.mj_resetData(self.model, data)
        _place(data, given)
        mujoco.mj_forward(self.model, data)
        self._numbers[:] = numbers
        self.kept[:] = list(REMEMBERED.values())
        length = given["running", "leg_length"], given["running", "idle_length"]
        for name, value in zip(("left_piston", "right_piston"), length, strict=True):
            self.kept[_KEPT.index(name)] = value
        torso = int(self.model.jnt_bodyid[0])
        return System(
            self.model._address, data._address,
            [data.qpos, data.qvel, data.sensordata, self.kept, self._numbers],
            [data.ctrl, data.xfrc_applied[torso], self.kept],
        )  # fmt: skip


def _place(data: Any, given: Mapping[Name, float]) -> None:
    """The robot in the air, its left foot first."""
    what = {name: value for (table, name), value in given.items() if table == "start"}
    half = np.array([what["roll"], what["pitch"]]) / 2
    (sr, sp), (cr, cp) = np.sin(half), np.cos(half)
    data.qpos[:7] = (0, 0, what["height"], cp * cr, cp * sr, sp * cr, -sp * sr)
    data.qvel[:6] = (
        what["forward"], what["sideways"], 0.0, what["roll_rate"], what["pitch_rate"],
        what["yaw_rate"],
    )  # fmt: skip


def _changed(machine: Machine, given: Mapping[Name, float]) -> Any:
    """The robot's model with what [plant] changes of it."""
    parts = {name: value for (table, name), value in given.items() if table == "plant"}
    if all(value == 1 for value in parts.values()):
        return machine.mujoco
    m = copy.copy(machine.mujoco)
    m.geom_friction[:, 0] *= parts["friction"]
    m.geom_friction[:, 1] *= parts["turning_friction"]
    torso = int(m.jnt_bodyid[0])
    for axis, name in enumerate(("roll_inertia", "pitch_inertia", "yaw_inertia")):
        m.body_inertia[torso, axis] *= parts[name]
    for address in machine.address_of.values():
        springs: Sequence[int] = address.pistons
        m.actuator_gainprm[springs, 0] *= parts["stiffness"]
        m.actuator_biasprm[springs, 1] *= parts["stiffness"]
        m.actuator_biasprm[springs, 2] *= parts["damping"]
        m.actuator_ctrlrange[address.motors] *= parts["torque"]
    return m
