"""Section 6.4: how far a rigid robot's momentum must be tilted for half a twist in a somersault."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from somersault import rigid
from somersault._core.array import Array
from somersault.attitude import matrix_from_quaternion
from somersault.thesis.ch6._weighted_biped import twisting_tilt

_RATE = 7.0  # rad/s of the somersault; it only sets the scale of time
_STEP = np.radians(0.25)


@dataclass(frozen=True)
class HalfTwist:
    """A rigid body's somersault with half a twist.

    Parameters
    ----------
    momentum : float
        Tilt of the angular momentum from the somersault axis at the start, body upright, rad.
    tilt : float
        The greatest tilt Θ of the body in flight, rad.
    twist_slope : float
        Rad of twist for each rad of momentum's tilt more.
    """

    momentum: float
    tilt: float
    twist_slope: float


def half_twist(inertias: Array) -> HalfTwist:
    """The least tilt of momentum with which an upright body has twisted by half a turn when its
    long axis is back at the top."""
    tilts = np.arange(twisting_tilt(inertias) * 0.8, np.pi / 2, _STEP)
    before, greatest = somersault_once(inertias, float(tilts[0]))
    for tilt in tilts[1:]:
        facing, greatest = somersault_once(inertias, float(tilt))
        step = np.angle(np.exp(1j * (facing - before)))
        if abs(before) > np.pi / 2 and before * facing < 0:
            share = np.angle(np.exp(1j * (np.pi - before))) / step
            return HalfTwist(float(tilt - (1 - share) * _STEP), greatest, float(step / _STEP))
        before = facing
    raise ValueError("no half twist")


def somersault_once(inertias: Array, tilt: float) -> tuple[float, float]:
    """The heading once the long axis has gone round the momentum, and the greatest tilt Θ till
    then, rad."""
    along = np.array([0.0, np.cos(tilt), np.sin(tilt)])
    motion = rigid.RigidMotion.from_momentum(inertias, _RATE * inertias[1] * along)
    times = np.linspace(0.0, 3.2 * np.pi / _RATE, 600)
    turns = matrix_from_quaternion(motion.quaternion(times))
    long = turns[:, :, 2]
    front = np.array([1.0, 0.0, 0.0])
    round_it = np.unwrap(np.arctan2(long @ np.cross(along, front), long @ front))
    gone = np.abs(round_it - round_it[0])
    last = int(np.argmax(gone >= 2 * np.pi))
    end = turns[last]
    heading = np.arctan2(end[1, 0] - end[0, 1], end[0, 0] + end[1, 1])
    return float(heading), float(np.abs(np.arcsin(-turns[: last + 1, 1, 2])).max())
