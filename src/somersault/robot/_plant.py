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
from somersault.robot._robot import Leg, Robot
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
        self.model = _changed(robot, given, data)
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


def _changed(robot: Robot, given: Mapping[Name, float], data: Any) -> Any:
    """The robot's model with what [plant] changes of it. What `data` holds is overwritten."""
    machine = robot.machine
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
    for side, leg, hip in zip(machine.address_of, robot.legs, machine.hips, strict=True):
        lower, *upper = _outwards_in(m, torso, leg)
        m.body_pos[[lower, *upper][-1], 1] += (parts["hip_spacing"] - 1) * hip[1]
        m.body_mass[upper] *= parts["upper_leg_mass"]
        m.body_inertia[upper] *= parts["upper_leg_mass"]
        _resize(m, m.geom(leg.foot).id, m.site(f"{side} sole").id, parts["foot_radius"])
    if any(parts[name] != 1 for name in ("hip_spacing", "upper_leg_mass")):
        import mujoco

        mujoco.mj_setConst(m, data)  # masses of subtrees among others, by which it is sensed
    return m


def _outwards_in(m: Any, torso: int, leg: Leg) -> list[int]:
    """The bodies of a leg from that which slides to that which is hinged to the torso."""
    bodies, body = [], int(m.jnt_bodyid[m.joint(leg.slide).id])
    while body != torso:
        bodies.append(body)
        body = int(m.body_parentid[body])
    return bodies


def _resize(m: Any, foot: int, site: int, factor: float) -> None:
    """A ball of another radius, with its lowest point, of a straight leg, where it was, and with it
    the place that feels the ground."""
    if factor == 1:
        return
    rise = (factor - 1) * float(m.geom_size[foot, 0])
    for size in (m.geom_size, m.geom_rbound, m.geom_aabb):
        size[foot] *= factor
    m.site_size[site] *= factor
    m.geom_pos[foot, 2] += rise
    m.site_pos[site, 2] += rise
    m.geom_sameframe[foot] = m.site_sameframe[site] = 0  # else their places may be its body's
    body = m.geom_bodyid[foot]
    boxes = slice(m.body_bvhadr[body], m.body_bvhadr[body] + m.body_bvhnum[body])
    m.bvh_aabb[boxes, 3:] += 2 * abs(rise)  # in which contacts are sought: wide enough
