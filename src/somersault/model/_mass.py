"""Whether the motions of a model all take energy: its mass matrix must be positive definite.

Bodies without mass between joints, point masses, slender rods, and inertias that no rigid body has
are all in files that people publish. None of them does harm as long as the whole moves as a body
can, so nothing is asked of a single body and everything of the whole mass matrix. It is looked at
in numbers, in the pose that the file draws and in a few others: a matrix that is singular in all
of them belongs to a joint that moves nothing, or to a body that cannot turn; one that is singular
in the drawn pose alone, such as three hinges in gimbal lock, is no mistake. The equations of motion
have a mass matrix of their own, by composite bodies (`dynamics._composite`), which the tests hold
against this one.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.model._kinematics import body_frames, body_velocities
from somersault.model._model import Model

_POSES = 3  # besides the drawn one
_ROUNDING = 1e-12  # of a matrix whose diagonal is 1
_BASE = ("turning its base", "moving its base")


def mass_matrix(model: Model, q: ArrayLike) -> Array:
    """M in T = ½ uᵀ M u of the speeds of a free base (ω, then v of its origin) and of the joints.

    By the velocities of all bodies at unit speeds: M = Σ m JᵥᵀJᵥ + J_ωᵀ R I Rᵀ J_ω, and armatures.
    Joints count as if none followed another.

    Parameters
    ----------
    model : Model
    q : array_like, (coordinates,)
        Joint coordinates.

    Returns
    -------
    ndarray, (speeds, speeds)
        With the base's six speeds first where it is free.
    """
    q, count = np.asarray(q, float), len(model.speeds)
    rotations, origins = body_frames(model, q)
    angular, linear = body_velocities(model, np.broadcast_to(q, (count, len(q))), np.eye(count))
    if model.free:
        turning = np.broadcast_to(np.eye(3)[:, None], (3, len(model.bodies), 3))
        angular = np.concatenate([turning, np.zeros_like(turning), angular])
        linear = np.concatenate([np.cross(turning, origins), turning, linear])
    masses = np.array([body.mass for body in model.bodies])
    arms = np.einsum("bij,bj->bi", rotations, np.array([body.com for body in model.bodies]))
    centres = linear + np.cross(angular, arms)
    inertias = np.array([body.inertia for body in model.bodies])
    inertias = rotations @ inertias @ np.swapaxes(rotations, -1, -2)
    size = len(centres)
    moved = (masses[:, None] * centres).reshape(size, -1)
    turned = np.einsum("bij,ubj->ubi", inertias, angular).reshape(size, -1)
    matrix = moved @ centres.reshape(size, -1).T + turned @ angular.reshape(size, -1).T
    rotors = [joint.armature for joint in model.joints for _ in range(joint.speeds)]
    return matrix + np.diag([0.0] * (6 * model.free) + rotors)


@lru_cache(maxsize=64)
def check_mass_matrix(model: Model) -> None:
    """Refuse a model some motion of which would take no energy, or less than none.

    Raises
    ------
    SomersaultError
        Naming the joint that moves most in it.
    """
    follow, names = _independent(model)
    if not names:
        return
    random = np.random.default_rng(0)
    lowest = -np.inf
    for number in range(1 + _POSES):
        q = model.home if number == 0 else _some_pose(model, random)
        matrix = follow.T @ mass_matrix(model, q) @ follow
        scale = np.sqrt(np.maximum(np.diag(matrix), 1e-300))
        with np.errstate(over="ignore"):  # a positive matrix has no entry beyond 1 then
            scaled = np.clip(matrix / scale / scale[:, None], -2.0, 2.0)
        values, vectors = np.linalg.eigh(scaled)
        if values[0] > lowest:
            lowest, motion = values[0], vectors[:, 0]
        if values[0] < -_ROUNDING or np.any(np.diag(matrix) < 0):
            motion = vectors[:, 0]
            raise SomersaultError(
                f"{model.name}: {_named(motion, names)} would have negative kinetic energy, so its "
                "masses and inertias cannot be right; correct them"
            )
    if lowest < _ROUNDING:
        raise SomersaultError(
            f"{model.name}: {_named(motion, names)} moves no mass, so no torque decides how; give "
            "what moves a mass and an inertia, or fix the joint"
        )


def _independent(model: Model) -> tuple[Array, list[str]]:
    """How all speeds follow from those that follow no other, and the names of these."""
    ahead = 6 * model.free
    rows = len(model.speeds)
    names = [_BASE[way // 3] for way in model.base_ways]
    columns = [np.eye(ahead + rows)[way] for way in model.base_ways]
    for joint in model.joints:
        if joint.follows is not None:
            continue
        for k in range(joint.speeds):
            column = np.zeros(ahead + rows)
            column[ahead + model.speed_slice(joint.name).start + k] = 1.0
            for other in model.joints:
                if other.follows is not None and other.follows.leader == joint.name:
                    at = ahead + model.speed_slice(other.name).start
                    column[at] = other.follows.factor
            columns.append(column)
            names.append(f"joint {joint.name!r}")
    return np.array(columns).T, names


def _some_pose(model: Model, random: np.random.Generator) -> Array:
    values: list[float] = []
    for joint in model.joints:
        if joint.kind == "ball":
            quaternion = random.normal(size=4)
            values += (quaternion / np.linalg.norm(quaternion)).tolist()
        else:
            away = random.uniform(-1.0, 1.0)
            low, high = joint.limits or (joint.reference - 1.0, joint.reference + 1.0)
            values.append((low + high) / 2 + away * (high - low) / 2)
    return np.array(values)


def _named(motion: Array, names: list[str]) -> str:
    """The joint that has the greatest part in a motion, or the base if that has all of it."""
    joints = [k for k, name in enumerate(names) if name not in _BASE]
    largest = int(np.argmax(np.abs(motion)))
    if joints and np.abs(motion[joints]).max() > 1e-3:
        largest = max(joints, key=lambda k: abs(motion[k]))
    return names[largest]
