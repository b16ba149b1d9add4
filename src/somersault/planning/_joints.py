"""The joints that move in a plan, among all that a model has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault.model import Model


@dataclass(frozen=True, eq=False)
class Moving:
    """Which joints move, within what bounds.

    Parameters
    ----------
    model : Model
    joints : tuple of str
        Hinges and slides that move by themselves.
    still : array (coordinates,)
        Where all that does not move stands.
    low, high : array (joints,)
        Their ranges, rad or m.
    weakest, strongest : array (joints,)
        Bounds of their torques, N m or N.
    fastest : array (joints,)
        Of their rates, rad/s or m/s.
    """

    model: Model
    joints: tuple[str, ...]
    still: Array
    low: Array
    high: Array
    weakest: Array
    strongest: Array
    fastest: Array

    @property
    def units(self) -> Array:
        """What torques are measured in: the greatest that each joint has."""
        return np.maximum(np.abs(self.weakest), np.abs(self.strongest))

    def coordinates(self, q: Sequence[Any]) -> list[Any]:
        """Coordinates of all joints, numbers or symbols."""
        result: list[Any] = self.still.tolist()
        moving = dict(zip(self.joints, q, strict=True))
        for joint in self.model.joints:
            place = self.model.coordinate_slice(joint.name).start
            if joint.name in moving:
                result[place] = moving[joint.name]
            elif joint.follows is not None and joint.follows.leader in moving:
                follow = joint.follows
                result[place] = follow.offset + follow.factor * moving[follow.leader]
        return result

    def speeds(self, u: Sequence[Any]) -> list[Any]:
        """Speeds of all joints, or their accelerations."""
        result: list[Any] = [0.0] * len(self.model.speeds)
        for place, (which, factor) in self._driven.items():
            result[place] = u[which] if factor == 1.0 else factor * u[which]
        return result

    def loads(self, torques: Sequence[Any]) -> list[Any]:
        """What acts at the joints that move, of what all need: gears pass theirs on."""
        result: list[Any] = [0.0] * len(self.joints)
        for place, (which, factor) in self._driven.items():
            result[which] = result[which] + factor * torques[place]
        return result

    @property
    def _driven(self) -> dict[int, tuple[int, float]]:
        """For the place of each speed that is not zero the joint that decides it, and by what
        factor."""
        result = {}
        for joint in self.model.joints:
            name, factor = joint.name, 1.0
            if joint.follows is not None:
                name, factor = joint.follows.leader, joint.follows.factor
            if name in self.joints:
                place = self.model.speed_slice(joint.name).start
                result[place] = (self.joints.index(name), factor)
        return result
