"""A gymnast and the floor as MuJoCo simulates them, and what a law needs to know of the moment."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.ground._gymnast import Floor, Gymnast
from somersault.model import mjcf

STEP = 0.001
"""Of the simulation, s."""
GRAVITY = 9.81
"""m/s²."""
BASE = 3
"""Coordinates of the base: along, up, and turned."""


class Machine:
    """A gymnast over a floor, compiled.

    Coordinates are those of the base (x and z of its frame, and its turn forwards), then the joints
    in the model's order.

    Parameters
    ----------
    gymnast : Gymnast
    floor : Floor

    Attributes
    ----------
    mujoco : mujoco.MjModel
    mass : float
        kg.
    strength : ndarray, (4,)
        Of the joints in the model's order, N m.
    """

    def __init__(self, gymnast: Gymnast, floor: Floor) -> None:
        import mujoco

        model, feet = gymnast.model, gymnast.feet
        spec = mujoco.MjSpec.from_string(mjcf(model))
        spec.option.gravity = [0.0, 0.0, -GRAVITY]
        spec.option.timestep = STEP
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        foot = next(b for b in model.bodies if any(j.name == gymnast.ankle for j in b.joints))
        shank = model.bodies[foot.parent]
        touch: dict[str, Any] = {
            "friction": [floor.friction, 0.005, 0.0001],
            "solref": [floor.softness, 1.0],
            "conaffinity": 1,
        }
        for geom in spec.geoms:
            # The calf ends in the ankle, which a soft floor may reach.
            if geom.parent.name not in (foot.name, shank.name):
                for name, value in touch.items():
                    setattr(geom, name, value)
        spec.worldbody.add_geom(
            name="floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[5, 5, 0.1], contype=1, **touch
        )
        # The model's foot points down where its ankle is at zero, the sole backwards.
        x = feet.rounding - feet.ankle
        for name, z in (("heel", feet.heel - feet.rounding), ("toes", feet.rounding - feet.toes)):
            spec.body(foot.name).add_geom(
                name=name, type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[feet.rounding, 0, 0],
                pos=[x, foot.com[1], z], mass=0.0, contype=0, **touch,
            )  # fmt: skip
        try:
            self.mujoco = spec.compile()
        except ValueError as error:
            reason = " ".join(str(error).split()).rstrip(".")
            raise SomersaultError(
                f"{model.name} cannot land: {reason[:200]}; change the model"
            ) from None
        m = self.mujoco
        order = [int(m.joint(name).dofadr[0]) for name in gymnast.joints]
        self.shoulder, self.hip, self.knee, self.ankle = order
        s = gymnast.strength
        self.strength = np.empty(len(order))
        self.strength[np.array(order) - BASE] = s.shoulder, s.hip, s.knee, s.ankle
        self.places = [int(m.joint(name).qposadr[0]) for name in model.coordinates]
        self.limited = [
            (int(m.jnt_dofadr[k]), m.jnt_range[k].tolist()) for k in np.flatnonzero(m.jnt_limited)
        ]
        self.mass = float(m.body_subtreemass[1])
        self.foot = int(m.body(foot.name).id)
        self.soles = [int(m.geom(name).id) for name in ("heel", "toes")]
        self.floor = int(m.geom("floor").id)
        self.rounding = feet.rounding

    def fallen_on(self, data: Any) -> str | None:
        """The body besides the feet that touches the floor."""
        for one, other in zip(data.contact.geom1, data.contact.geom2, strict=True):
            geom = int(other if one == self.floor else one)
            if geom not in self.soles:
                return str(self.mujoco.body(int(self.mujoco.geom_bodyid[geom])).name)
        return None


@lru_cache(maxsize=8)
def machine(gymnast: Gymnast, floor: Floor) -> Machine:
    """A gymnast over a floor, compiled once."""
    return Machine(gymnast, floor)


class Moment:
    """Where everything is, and how it answers to forces; written anew at each tick.

    Attributes
    ----------
    q, u : ndarray, (7,)
        Coordinates and rates.
    mass_matrix : ndarray, (7, 7)
    bias : ndarray, (7,)
        What gravity and the rates ask of the forces.
    centre, velocity : ndarray, (3,)
        Of the centre of mass, m, m/s.
    spin, inertia : float
        Angular momentum about the centre of mass, forwards, kg m²/s, and moment of inertia, kg m².
    heel, toes, sole : ndarray, (3,)
        The ends of the sole and its middle, m.
    pitch : float
        Of the foot, toes down, rad.
    """

    def __init__(self, machine: Machine, data: Any) -> None:
        self._machine, self._data = machine, data
        size = machine.mujoco.nv
        self.mass_matrix = np.zeros((size, size))
        self.foot_along, self.foot_turn, self._along_dot, self._turn_dot = np.zeros((4, 3, size))
        self._centre, self._spin, self._point = np.zeros((3, 3, size))
        self.drop = np.array([0.0, 0.0, machine.rounding])

    def read(self) -> None:
        """Read it all after `mj_forward`."""
        import mujoco

        m, d, place = self._machine.mujoco, self._data, self._machine
        mujoco.mj_fullM(m, d, self.mass_matrix)
        mujoco.mj_jacSubtreeCom(m, d, self._centre, 1)
        mujoco.mj_angmomMat(m, d, self._spin, 1)
        self.q, self.u, self.bias = d.qpos, d.qvel, d.qfrc_bias
        self.centre, self.velocity = d.subtree_com[1], self._centre @ d.qvel
        self.spin, self.inertia = float(self._spin[1] @ d.qvel), float(self._spin[1, 2])
        self.heel, self.toes = (d.geom_xpos[sole] - self.drop for sole in place.soles)
        self.sole = (self.heel + self.toes) / 2
        length = self.toes - self.heel
        self.pitch = float(np.arctan2(-length[2], length[0]))
        mujoco.mj_jac(m, d, self.foot_along, self.foot_turn, self.sole, place.foot)
        mujoco.mj_jacDot(m, d, self._along_dot, self._turn_dot, self.sole, place.foot)

    def foot_motion(self) -> tuple[Array, Array, Array]:
        """Of the sole's middle: the Jacobian of its way along, up and round, (3, 7), its velocity,
        and its acceleration when all rates stay."""
        ways = np.array([self.foot_along[0], self.foot_along[2], self.foot_turn[1]])
        change = np.array([self._along_dot[0], self._along_dot[2], self._turn_dot[1]])
        return ways, ways @ self.u, change @ self.u

    def pushed(self, x: float, along: float, up: float) -> Array:
        """Generalised forces of a force on the foot at a place on the floor, (7,)."""
        import mujoco

        place = np.array([x, 0.0, self.sole[2]])
        mujoco.mj_jac(
            self._machine.mujoco, self._data, self._point, None, place, self._machine.foot
        )
        return np.asarray(along * self._point[0] + up * self._point[2])
