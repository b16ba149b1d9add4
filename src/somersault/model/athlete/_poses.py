"""The named positions of a gymnast: tuck, pike, layout, arms up, T and wrap."""

from __future__ import annotations

import math
import os
from functools import reduce

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault.attitude import quaternion_product
from somersault.model._load import load
from somersault.model._mirror import mirror_pairs
from somersault.model._model import Model

# Radians, both sides alike; what is not named is 0. In pike and tuck the wrists are beside, or in
# front of, the middle of the shanks (of the mean man; of others to a few centimetres). A tuck of
# straight legs is a pike with the legs drawn close.
_POSES: dict[str, dict[str, float]] = {
    "layout": {"shoulder_abduction": 0.12},
    "T": {"shoulder_abduction": math.pi / 2},
    "arms_up": {"shoulder_abduction": math.pi},
    "wrap": {
        "shoulder_abduction": 0.15,
        "shoulder_rotation": 0.7,
        "shoulder_flexion": 0.7,
        "elbow": 2.1,
    },
    "pike": {
        "hip_flexion": 2.2,
        "shoulder_abduction": 0.2,
        "shoulder_flexion": 1.15,
        "elbow": 0.42,
    },
    "tuck": {
        "hip_flexion": 2.6,
        "shoulder_abduction": 0.15,
        "shoulder_rotation": -0.3,
        "shoulder_flexion": 0.9,
        "elbow": 1.8,
    },
}
_BENT_TUCK = {
    "hip_flexion": 2.4,
    "knee": 2.4,
    "shoulder_abduction": 0.25,
    "shoulder_rotation": 0.35,
    "shoulder_flexion": 0.62,
    "elbow": 0.33,
}
_HINGES = ("shoulder_abduction", "shoulder_rotation", "shoulder_flexion")
_BALL = ("shoulder.1", "shoulder.2", "shoulder.3")
_REST = ("torso_twist", "elbow", "hip_flexion", "hip_abduction")


def named_pose(model: str | os.PathLike[str] | Model, name: str) -> dict[str, float]:
    """Every joint's angle in a position of gymnastics, by the names that both sides share.

    Parameters
    ----------
    model : str, path or Model
        An athlete (`athlete`, `athlete_from_measurements`, "gymnast", or any with joints so named).
    name : {"tuck", "pike", "layout", "arms_up", "T", "wrap"}
        With knees, a tuck bends them.

    Returns
    -------
    dict of str to float
        rad: a pose wherever one is asked for. Change an angle by its name.

    Raises
    ------
    SomersaultError
        For another name, or a model without those joints.

    Examples
    --------
    >>> import somersault as so
    >>> piked = so.named_pose("gymnast", "pike") | {"hip_flexion": 2.0}
    >>> piked["elbow"]
    0.42
    """
    if not isinstance(name, str) or name not in _POSES:
        raise SomersaultError(f"no pose is called {shown(name)}; the poses are {', '.join(_POSES)}")
    body = load(model)
    there = {pair.name for pair in mirror_pairs(body)}
    ball = there >= set(_BALL)
    if missing := _missing(there):
        raise SomersaultError(
            f"{body.name} has no {missing[0]!r}, so it takes no named pose; use 'gymnast' or "
            "an athlete"
        )
    angles = _BENT_TUCK if name == "tuck" and "knee" in there else _POSES[name]
    knee = ("knee",) if "knee" in there else ()
    pose = {joint: angles.get(joint, 0.0) for joint in (*_REST, *knee)}
    shoulder = {joint: angles.get(joint, 0.0) for joint in _HINGES}
    return pose | (_as_ball(*shoulder.values()) if ball else shoulder)


def pose_names(model: Model) -> tuple[str, ...]:
    """The named poses that a model takes.

    Parameters
    ----------
    model : Model

    Returns
    -------
    tuple of str
        None, unless it has an athlete's joints.
    """
    return () if _missing({pair.name for pair in mirror_pairs(model)}) else tuple(_POSES)


def _missing(there: set[str]) -> list[str]:
    """An athlete's joints that are not among these."""
    shoulder = _BALL if there >= set(_BALL) else _HINGES
    return [joint for joint in (*_REST, *shoulder) if joint not in there]


def _as_ball(abduction: float, rotation: float, flexion: float) -> dict[str, float]:
    """The same turn of the left shoulder as a rotation vector."""
    w, *vector = reduce(
        quaternion_product,
        (_turn(abduction, 0), _turn(-rotation, 2), _turn(-flexion, 1)),  # in the hinges' order
    )
    sine = math.hypot(*vector)
    size = 2 * math.atan2(sine, w) / sine if sine else 0.0
    return {name: float(size * part) for name, part in zip(_BALL, vector, strict=True)}


def _turn(angle: float, axis: int) -> Array:
    quaternion = np.zeros(4)
    quaternion[[0, 1 + axis]] = math.cos(angle / 2), math.sin(angle / 2)
    return quaternion
