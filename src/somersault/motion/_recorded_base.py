"""Where a recording has the base: its attitude and position, measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.attitude import AXES, Axes, quaternion_from_matrix, unwrapped_angles
from somersault.model import Model, base_on_its_joints, body_frames

_UNIT = 1e-3  # how far the length of a recorded quaternion may be from 1


@dataclass(frozen=True, eq=False)
class RecordedBase:
    """The base's pose as it was recorded, sample by sample; nothing is filtered.

    Parameters
    ----------
    times : ndarray, (T,)
        In the motion's time, s.
    positions : ndarray, (T, 3)
        Of the base frame's origin, in the recording's own axes of the ground, m.
    quaternions : ndarray, (T, 4)
        Scalar first, from the base's axes to those of the ground; without changes of sign.
    axes : tuple of int, optional
        The base's axes of somersault, tilt and twist.
    """

    times: Array
    positions: Array
    quaternions: Array
    axes: Axes = AXES

    @cached_property
    def angles(self) -> Array:
        """Somersault, tilt and twist, unwrapped, (T, 3), rad; attitudes must be less than a quarter
        turn apart."""
        return unwrapped_angles(self.quaternions, self.axes)

    def part(self, first: float, last: float) -> RecordedBase:
        """The samples between two times; time 0 is then the first of these times.

        Parameters
        ----------
        first, last : float
            s.

        Returns
        -------
        RecordedBase
        """
        chosen = (self.times >= first) & (self.times <= last)
        return replace(
            self,
            times=self.times[chosen] - first,
            positions=self.positions[chosen],
            quaternions=self.quaternions[chosen],
        )

    def at_times(self, factor: float, delay: float) -> RecordedBase:
        """The same poses at other times.

        Parameters
        ----------
        factor : float
            Times are multiplied by it.
        delay : float
            Added to them after that, s.

        Returns
        -------
        RecordedBase
        """
        return replace(self, times=self.times * factor + delay)

    def mirrored(self) -> RecordedBase:
        """The same poses seen in a mirror across the axis of somersault.

        Returns
        -------
        RecordedBase
        """
        across = np.ones(3)
        across[self.axes[0] - 1] = -1.0
        turned = self.quaternions * np.concatenate([[1.0], -across])
        return replace(self, positions=self.positions * across, quaternions=turned)


def from_numbers(times: Array, positions: Array, quaternions: Array, axes: Axes) -> RecordedBase:
    """A base by recorded quaternions (T, 4) and positions (T, 3).

    Raises SomersaultError for quaternions that are not of unit length.
    """
    lengths = np.linalg.norm(quaternions, axis=1, keepdims=True)
    wrong = int(np.argmax(np.abs(lengths - 1)))
    if abs(lengths[wrong, 0] - 1) > _UNIT:
        raise SomersaultError(
            f"the base's quaternion at {times[wrong]:g} s has the length {lengths[wrong, 0]:.4g}, "
            "not 1; divide it by its length, or leave its columns out"
        )
    return RecordedBase(times, positions, _one_sign(quaternions / lengths), axes)


def from_coordinates(
    model: Model, times: Array, values: Mapping[str, Array]
) -> tuple[RecordedBase, list[str]]:
    """A base by the coordinates (T,) of the joints that hold it in the model's file.

    Also the names of those that are not recorded, which stand at their default.
    """
    held = base_on_its_joints(model)
    assert held is not None
    q = np.tile(held.home, (len(times), 1))
    missing = []
    for joint in held.joints:
        if joint.name in values:
            q[:, held.coordinate_slice(joint.name)] = values[joint.name][:, None]
        else:
            missing.append(joint.name)
    turns, places = body_frames(held, q)
    quaternions = _one_sign(quaternion_from_matrix(turns[:, -1]))
    return RecordedBase(times, places[:, -1], quaternions, model.axes), missing


def _one_sign(quaternions: Array) -> Array:
    """The same attitudes, each quaternion on the side of the one before."""
    turned = np.sum(quaternions[1:] * quaternions[:-1], axis=1) < 0
    signs = np.concatenate([[1.0], np.cumprod(np.where(turned, -1.0, 1.0))])
    return np.asarray(quaternions * signs[:, None])
