"""Poses of an athlete joint by joint, and keyframes through them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.dynamics import Equations
from somersault.model import Model, load, named_pose
from somersault.model import pose as posed

_SIDES = ("left", "right")


def through(stations: Sequence[tuple[float, Mapping[str, float]]]) -> dict[str, Any]:
    """Keyframes of every joint through poses (rad by joint) at times (s), none to no purpose."""
    keyframes: dict[str, list[tuple[float, float]]] = {}
    for name in stations[0][1]:
        row = [(time, pose[name]) for time, pose in stations]
        kept = [
            (time, angle)
            for k, (time, angle) in enumerate(row)
            if any(row[n][1] != angle for n in (k - 1, k + 1) if 0 <= n < len(row))
        ]
        keyframes[name] = kept or row[:1]
    return keyframes


def named(model: str | Model, name: str) -> dict[str, float]:
    """A named pose of every joint by its own name."""
    pose = named_pose(model, name)
    if "shoulder.1" in pose:
        raise SomersaultError(
            f"{load(model).name} has ball shoulders, which no maneuver moves; give it hinges"
        )
    return both(load(model), pose)


def both(model: Model, pose: Mapping[str, float]) -> dict[str, float]:
    """A pose with pairs that are named by what both sides share written out."""
    there = {joint.name for joint in model.joints}
    angles = {}
    for name, angle in by_name("legs", pose).items():
        meant = [name] if name in there else [f"{side}_{name}" for side in _SIDES]
        for joint in meant:
            model.joint(joint)
            angles[joint] = number(f"joint {name}", angle)
    return angles


def inertia(model: Model, pose: Mapping[str, float]) -> Array:
    """Of the whole body about its centre of mass in a pose, in the base's axes (3, 3)."""
    return Equations(model).inertia(np.asarray(posed(model, pose)))


def seconds(**given: float) -> float:
    """A duration; SomersaultError unless it is positive."""
    ((name, value),) = given.items()
    if number(name, value) <= 0:
        raise SomersaultError(f"{name} {value:g} s is no duration; give a positive number")
    return float(value)
