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
from somersault._core.checks import instance, name_list, shown, text
from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault._core.numbers import number
from somersault.model import load, shipped


@dataclass(frozen=True)
class Leg:
    """Which parts of a model are a leg.

    Parameters
    ----------
    hip : tuple of str
        The hinges about the body's axes 2, 1 and 3, from the torso outwards: fore and aft, sideways
        and about the leg. A motor acts on each.
    slide : str
        The joint by which the leg gets longer.
    foot : str
        The sphere that it stands on.
    spring : str
        The actuator that pushes the leg to its piston's length, of the kind `position`.
    stop : str
        The one that pulls it back to that.

    Examples
    --------
    >>> from somersault.robot import Leg
    >>> Leg.called("left").hip
    ('left_hip_y', 'left_hip_x', 'left_hip_z')
    """

    hip: tuple[str, str, str]
    slide: str
    foot: str
    spring: str
    stop: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "hip", name_list("hip of a leg", self.hip))
        if len(self.hip) != 3:
            raise SomersaultError(f"hip of a leg must be three joints, and is {shown(self.hip)}")
        for part in ("slide", "foot", "spring", "stop"):
            text(f"{part} of a leg", getattr(self, part))

    @classmethod
    def called(cls, side: str) -> Leg:
        """A leg whose parts have the names that they have in the model `biped`.

        Parameters
        ----------
        side : str
            "left" or "right".

        Returns
        -------
        Leg
        """
        side = text("side", side)
        hip = (f"{side}_hip_y", f"{side}_hip_x", f"{side}_hip_z")
        return cls(hip, f"{side}_leg", f"{side}_foot", f"{side}_spring", f"{side}_stop")


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
        text("model of a robot", self.model)
        for side in ("left", "right"):
            instance(f"{side} leg", getattr(self, side), Leg)
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
        base = _base(path.name, plain)
        for side, leg in zip(("left", "right"), robot.legs, strict=True):
            _check_leg(path.name, plain, side, leg)
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
        motors = [_motor(m, name) for name in leg.hip]
        self.motors = motors
        self.limits = [(float(m.actuator_ctrlrange[k][1])) for k in motors]
        self.range = [(float(j.range[0]), float(j.range[1])) for j in joints[:3]]
        self.pistons = [int(m.actuator(name).id) for name in (leg.spring, leg.stop)]


def _motor(m: Any, joint: str) -> int:
    """The actuator on a joint; −1 if there is none."""
    which = m.joint(joint).id
    acting = [k for k in range(m.nu) if m.actuator_trnid[k][0] == which]
    return acting[0] if acting else -1


def _path(model: str) -> Path:
    """The file of a model that `load` has read."""
    if model in shipped():
        return Path(str(files("somersault.model") / "shipped" / f"{model}.xml"))
    return Path(model)


def _base(file: str, m: Any) -> str:
    import mujoco

    free = [k for k in range(m.njnt) if m.jnt_type[k] == mujoco.mjtJoint.mjJNT_FREE]
    if free != [0]:
        raise SomersaultError(
            f"{file} is no robot that runs: it needs one body with a free joint, first of all"
        )
    return str(m.body(int(m.jnt_bodyid[0])).name)


def _is_there(m: Any, kind: Any, name: str) -> bool:
    """Whether a model has something of a kind called so."""
    import mujoco

    try:
        return bool(mujoco.mj_name2id(m, kind, name) >= 0)
    except TypeError:  # a name that is no text in UTF-8
        return False


def _check_leg(file: str, m: Any, side: str, leg: Leg) -> None:
    import mujoco

    for kind, count, names in (
        (mujoco.mjtObj.mjOBJ_JOINT, "joint", (*leg.hip, leg.slide)),
        (mujoco.mjtObj.mjOBJ_GEOM, "foot", (leg.foot,)),
        (mujoco.mjtObj.mjOBJ_ACTUATOR, "actuator", (leg.spring, leg.stop)),
    ):
        for name in names:
            if not _is_there(m, kind, name):
                what = {"foot": "foot, a geom", "actuator": "spring or stop, an actuator"}
                raise SomersaultError(
                    f"{file}: its {side} leg has no {what.get(count, count)} called {name!r}; add "
                    "it to the file, or say what it is called there"
                )
    spring = m.actuator(leg.spring)
    if not (spring.gainprm[0] > 0 and np.isclose(spring.biasprm[1], -spring.gainprm[0])):
        raise SomersaultError(
            f"{file}: {leg.spring} is no spring; make it a position actuator with kp above zero"
        )
    if m.geom_type[m.geom(leg.foot).id] != mujoco.mjtGeom.mjGEOM_SPHERE:
        raise SomersaultError(f"{file}: the foot {leg.foot} must be a sphere")
    for name, axis in zip(
        (*leg.hip, leg.slide), ([0, 1, 0], [1, 0, 0], [0, 0, 1], [0, 0, -1]), strict=True
    ):
        if not np.allclose(m.joint(name).axis, axis, atol=1e-9):
            raise SomersaultError(
                f"{file}: joint {name} must be along {axis}; a leg's hinges turn about axes 2, 1 "
                "and 3, and its slide points down"
            )
    for name in leg.hip:
        motor = _motor(m, name)
        if motor < 0 or not m.actuator_ctrllimited[motor]:
            raise SomersaultError(
                f"{file}: joint {name} needs a motor with a ctrlrange, which says how strong it is"
            )


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
