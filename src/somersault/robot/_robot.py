"""A robot: a model file, and which of its parts are legs."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import sha256
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance, shown, text
from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault._core.numbers import number
from somersault.model import load, shipped
from somersault.robot._leg import Leg
from somersault.robot._soundness import base_of, check_alike, check_leg, check_world, motor_of

_NO_ROBOTS = (".urdf", ".biomod", ".osim")


@dataclass(frozen=True)
class Robot:
    """A robot that runs on two telescoping legs.

    Parameters
    ----------
    model : str
        The name of a shipped model or an MJCF file, with ground, contacts and actuators.
    left, right : Leg
        Its legs.
    shortest, longest : float
        Lengths of the legs from hip to sole, m.
    """

    model: str = "biped"
    left: Leg = field(default_factory=lambda: Leg.called("left"))
    right: Leg = field(default_factory=lambda: Leg.called("right"))
    shortest: float = 0.647
    longest: float = 0.862

    def __post_init__(self) -> None:
        model = text("model of a robot", self.model)
        if Path(model).suffix.lower() in _NO_ROBOTS:
            raise SomersaultError(
                f"{Path(model).name} is no robot that runs: that takes an MJCF file (.xml) with "
                "ground, contacts and actuators, like the model biped"
            )
        for side in ("left", "right"):
            instance(f"{side} leg", getattr(self, side), Leg)
        if shared := set(self.left.parts) & set(self.right.parts):
            raise SomersaultError(
                f"left and right leg cannot both have {shown(min(shared)[1])}; name the "
                "parts of each"
            )
        ends = number("shortest", self.shortest), number("longest", self.longest)
        if not 0 < ends[0] < ends[1]:
            raise SomersaultError(
                f"a robot's legs reach from shortest to longest, and here from {self.shortest} to "
                f"{self.longest} m; correct them"
            )

    @property
    def legs(self) -> tuple[Leg, Leg]:
        """Left and right."""
        return self.left, self.right

    @cached_property
    def machine(self) -> Machine:
        """The robot as MuJoCo runs it."""
        return Machine(self)


@dataclass(frozen=True, eq=False)
class Straight:
    """A robot with straight legs of a length.

    Parameters
    ----------
    inertias : array (3,)
        About the torso's axes through the centre of mass, kg m².
    rise : float
        Of the centre of mass above the hips, m.
    """

    inertias: Array
    rise: float


PERIOD = 0.001
"""Of the controller, s."""


class Machine:
    """A robot compiled by MuJoCo, with sensors, and the numbers that its controller needs.

    Parameters
    ----------
    robot : Robot

    Attributes
    ----------
    model : Model
        Its bodies.
    mujoco : mujoco.MjModel
    hips : array (2, 3)
        Where the hips are in the torso's axes, m.
    resting : array (2,)
        Length of each leg with its slide at zero, m.
    stiffness, stop : float
        Of a leg's spring and of its stop, N/m.
    stop_damping : float
        Of the stop, N s/m.
    mass : float
        kg.
    short, long : Straight
        The robot with its legs as short and as long as they can be.
    """

    def __init__(self, robot: Robot) -> None:
        import mujoco

        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SomersaultWarning)  # ground and actuators play a part
            self.model = load(robot.model)  # within limits of time and memory, whatever the file
        path = _path(robot.model)
        mujoco.set_mju_user_warning(lambda _: None)  # else it writes a log where one stands
        try:
            spec = mujoco.MjSpec.from_file(str(path))
            spec.memory = spec.njmax = spec.nconmax = spec.nstack = -1
            plain = spec.compile()
        except (ValueError, RuntimeError, OSError, mujoco.FatalError) as error:
            reason = " ".join(str(error).split()).rstrip(".")
            raise SomersaultError(
                f"{path.name} cannot be read as a robot: {reason[:300]}; correct the file"
            ) from None
        self.file = path
        self.digest = sha256(path.read_bytes()).hexdigest()
        base = base_of(path.name, plain)
        for side, leg in zip(("left", "right"), robot.legs, strict=True):
            check_leg(path.name, plain, side, leg)
        check_world(path.name, plain, [leg.foot for leg in robot.legs])
        check_alike(path.name, plain, robot.left, robot.right)
        self.mujoco = _with_sensors(spec, base, robot)
        m = self.mujoco
        data = mujoco.MjData(m)
        mujoco.mj_resetData(m, data)
        data.qpos[:7] = (0, 0, 0, 1, 0, 0, 0)
        mujoco.mj_kinematics(m, data)
        mujoco.mj_comPos(m, data)
        self.mass = float(m.body_mass[1:].sum())
        feet = [m.geom(leg.foot).id for leg in robot.legs]
        self.hips = np.array([data.joint(leg.hip[0]).xanchor for leg in robot.legs])
        lowest = [data.geom_xpos[foot][2] - m.geom_size[foot][0] for foot in feet]
        self.resting = np.array([h[2] - z for h, z in zip(self.hips, lowest, strict=True)])
        self.stiffness = float(m.actuator(robot.left.spring).gainprm[0])
        self.stop = float(m.actuator(robot.left.stop).gainprm[0])
        self.stop_damping = -float(m.actuator(robot.left.stop).biasprm[2])
        self._check_lengths(robot, path.name)
        self._weigh(robot, data)
        self.steps = max(1, round(PERIOD / m.opt.timestep))
        if abs(self.steps * m.opt.timestep - PERIOD) > 1e-9:
            raise SomersaultError(
                f"{path.name} has a timestep of {m.opt.timestep:g} s, which does not divide the "
                f"controller's {PERIOD:g} s; make it 0.0005"
            )
        self.address_of = {
            side: _Addresses(m, leg)
            for side, leg in zip(("left", "right"), robot.legs, strict=True)
        }

    def _check_lengths(self, robot: Robot, name: str) -> None:
        m = self.mujoco
        for side, leg, resting in zip(("left", "right"), robot.legs, self.resting, strict=True):
            low, high = resting + m.joint(leg.slide).range
            if m.joint(leg.slide).limited and not (low <= robot.shortest and robot.longest <= high):
                raise SomersaultError(
                    f"the {side} leg of {name} reaches from {low:.3g} to {high:.3g} m, not from "
                    f"{robot.shortest:g} to {robot.longest:g}; correct the range of {leg.slide} or "
                    "the robot's lengths"
                )

    def _weigh(self, robot: Robot, data: Any) -> None:
        """What the tuck servo knows, from the mass matrix with straight legs of two lengths."""
        import mujoco

        m = self.mujoco
        lower = [int(m.jnt_bodyid[m.joint(leg.slide).id]) for leg in robot.legs]
        self.lower_leg = float(sum(m.body_mass[b] for b in lower))
        self.offset = float(np.mean([
            length - (hip[2] - data.xipos[b][2])
            for length, hip, b in zip(self.resting, self.hips, lower, strict=True)
        ]))  # fmt: skip
        whole = np.zeros((m.nv, m.nv))
        mujoco.mj_crb(m, data)
        mujoco.mj_fullM(m, data, whole)
        com = data.subtree_com[1]
        pitch = whole[4, 4] - self.mass * float(com[0] ** 2 + com[2] ** 2)
        hips = [int(m.joint(leg.hip[0]).dofadr[0]) for leg in robot.legs]
        away = self.lower_leg * (float(self.resting.mean()) - self.offset) ** 2
        self.inertia = pitch - away
        self.inertias = np.diag(whole)[3:6].copy()
        rotors = float(m.dof_armature[hips].sum())
        self.leg_inertia = float(whole[hips, hips].sum()) - rotors - away
        self.short, self.long = (
            self._straight(robot, data, length) for length in (robot.shortest, robot.longest)
        )

    def _straight(self, robot: Robot, data: Any, length: float) -> Straight:
        """The robot with straight legs of a length."""
        import mujoco

        m = self.mujoco
        for leg, resting in zip(robot.legs, self.resting, strict=True):
            data.qpos[int(m.joint(leg.slide).qposadr[0])] = length - resting
        mujoco.mj_kinematics(m, data)
        mujoco.mj_comPos(m, data)
        mujoco.mj_crb(m, data)
        whole = np.zeros((m.nv, m.nv))
        mujoco.mj_fullM(m, data, whole)
        com = data.subtree_com[1]
        away = self.mass * (com @ com - com**2)
        return Straight(np.diag(whole)[3:6] - away, float(com[2] - self.hips[:, 2].mean()))


class _Addresses:
    """Where a leg's numbers stand in MuJoCo's arrays."""

    def __init__(self, m: Any, leg: Leg) -> None:
        joints = [m.joint(name) for name in (*leg.hip, leg.slide)]
        self.positions = [int(joint.qposadr[0]) for joint in joints]
        self.rates = [int(joint.dofadr[0]) for joint in joints]
        motors = [motor_of(m, name) for name in leg.hip]
        self.motors = motors
        self.limits = [(float(m.actuator_ctrlrange[k][1])) for k in motors]
        self.range = [(float(j.range[0]), float(j.range[1])) for j in joints[:3]]
        self.pistons = [int(m.actuator(name).id) for name in (leg.spring, leg.stop)]


def _path(model: str) -> Path:
    """The file of a model that `load` has read."""
    if model in shipped():
        return Path(str(files("somersault.model") / "shipped" / f"{model}.xml"))
    return Path(model)


def _with_sensors(spec: Any, base: str, robot: Robot) -> Any:
    """The model with what the controller senses: of the whole, and of each foot."""
    import mujoco

    kinds = mujoco.mjtSensor
    for kind in (kinds.mjSENS_SUBTREECOM, kinds.mjSENS_SUBTREELINVEL):
        spec.add_sensor(type=kind, objtype=mujoco.mjtObj.mjOBJ_BODY, objname=base)
    for side, leg in zip(("left", "right"), robot.legs, strict=True):
        foot = spec.geom(leg.foot)
        place = f"{side} sole"
        foot.parent.add_site(
            name=place, pos=foot.pos, size=[1.2 * foot.size[0]] * 3,
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
        )  # fmt: skip
        spec.add_sensor(
            type=kinds.mjSENS_FRAMEPOS, objtype=mujoco.mjtObj.mjOBJ_GEOM, objname=leg.foot
        )
        spec.add_sensor(type=kinds.mjSENS_TOUCH, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=place)
    return spec.compile()


SENSORS = 14
"""Numbers sensed: centre of mass and its velocity, and of each foot its place and its force."""
