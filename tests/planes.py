"""Random models that move in a plane, and the same ones in MuJoCo."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
from trees import mujoco_addresses, random_inertia, random_tree, to_mujoco, unit

from somersault.attitude import Axes, matrix_from_quaternion
from somersault.flight import Flight
from somersault.model import GROUND, Body, Joint, Model, as_matrix, as_vector

AXES: dict[int, Axes] = {1: (1, 2, 3), 2: (2, 1, 3), 3: (3, 1, 2)}


def turn(plane: int, angle: float) -> np.ndarray:
    """The rotation matrix of a turn about axis `plane`."""
    return matrix_from_quaternion([np.cos(angle / 2), *(np.sin(angle / 2) * np.eye(3)[plane - 1])])


def in_plane(rng: np.random.Generator, plane: int, size: float = 0.3) -> Any:
    """A vector in the plane across axis `plane`."""
    vector = rng.normal(size=3) * size
    vector[plane - 1] = 0.0
    return as_vector(vector)


def random_chain(rng: np.random.Generator, plane: int, bodies: int = 4) -> Model:
    """A tree whose joints all move in the plane across an axis; masses stand out of it too."""
    normal = np.eye(3)[plane - 1]
    made = []
    for index in range(bodies):
        joints = [Joint(f"hinge{index}", "hinge", as_vector(normal * rng.choice([-1.0, 1.0])))]
        if index > 1 and rng.integers(2):
            along = in_plane(rng, plane)
            slide = Joint(f"slide{index}", "slide", as_vector(along / np.linalg.norm(along)))
            joints.insert(int(rng.integers(2)), slide)
        made.append(
            Body(
                name=f"body{index}",
                parent=GROUND if index == 0 else int(rng.integers(index)),
                mass=float(rng.uniform(0.5, 4.0)),
                com=as_vector(rng.normal(size=3) * 0.2),
                inertia=random_inertia(rng, 2.0),
                position=(0.0, 0.0, 0.0) if index == 0 else in_plane(rng, plane),
                rotation=as_matrix(np.eye(3) if index == 0 else turn(plane, rng.normal())),
                joints=() if index == 0 else tuple(_lively(rng, joint) for joint in joints),
            )
        )
    return Model("chain", True, tuple(made), axes=AXES[plane], plane=plane)


def _lively(rng: np.random.Generator, joint: Joint) -> Joint:
    return replace(
        joint,
        anchor=as_vector(rng.normal(size=3) * 0.1),
        stiffness=float(rng.uniform(1.0, 10.0)),
        rest=float(rng.normal() * 0.3),
        armature=float(rng.choice([0.0, 0.1])),
    )


def random_planar_tree(rng: np.random.Generator, plane: int) -> Model:
    """A tree of any joints, balls among them, whose base is held in a plane."""
    model = random_tree(rng, bodies=int(rng.integers(2, 5)), free=True)
    return replace(model, axes=AXES[plane], plane=plane)


def random_takeoff(rng: np.random.Generator, model: Model) -> dict[str, np.ndarray]:
    """Joint coordinates and speeds near home."""
    q = [
        unit(rng, 4) if joint.kind == "ball" else np.array(joint.home) + 0.3 * rng.normal(size=1)
        for joint in model.joints
    ]
    return {"q": np.concatenate([np.zeros(0), *q]), "u": rng.normal(size=len(model.speeds))}


class InMujoco:
    """A planar model in MuJoCo, on two slides along world axes and the hinge across them."""

    def __init__(self, model: Model, step: float = 1e-3) -> None:
        assert model.plane is not None
        self.model, self.m = model, to_mujoco(model, step)
        self.m.opt.enableflags = 0
        self.d = mujoco.MjData(self.m)
        self.q_at, self.v_at = mujoco_addresses(model, self.m)
        self.across = model.plane - 1
        self.along = [k for k in range(3) if k != self.across]

    def begin(self, flight: Flight) -> None:
        """Stand as a flight does at takeoff; where and how fast the base goes is of no account."""
        begun = flight.start
        self.d.qpos[2] = 2 * np.arctan2(begun.quaternion[1 + self.across], begun.quaternion[0])
        self.d.qvel[2] = begun.omega[self.across]
        self.d.qpos[self.q_at], self.d.qvel[self.v_at] = begun.q, begun.u

    def end(self, seconds: float) -> np.ndarray:
        """Angle of the base, joints, rates of both, after so long."""
        for _ in range(round(seconds / self.m.opt.timestep)):
            mujoco.mj_step(self.m, self.d)
        return np.concatenate(
            [
                self.d.qpos[2:3], self.d.qpos[self.q_at], self.d.qvel[2:3], self.d.qvel[self.v_at],
            ]
        )  # fmt: skip
