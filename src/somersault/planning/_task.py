"""What a plan has to keep to, in numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault.model import Model
from somersault.planning._joints import Moving

ANGLES = ("somersault", "tilt", "twist")
RATES = ("spin", "tilt_rate", "twist_rate")  # of these, at takeoff
Range = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Task:
    """Everything that was asked of a plan, checked; (low, high) where it is a range.

    Parameters
    ----------
    model : Model
    moving : Moving
        The joints that move, and their bounds.
    takeoff, landing : array (3, 2)
        Somersault, tilt and twist at the ends, rad.
    aloft : array (3, 2)
        The same in between.
    rates : array (3, 2), optional
        Rates of the three at takeoff, rad/s.
    momentum : array (3, 2), optional
        Angular momentum in inertial axes, kg m²/s.
    start, end : array (joints, 2)
        Coordinates of the joints that move at the ends, rad or m.
    rest_at_end : bool
        Whether they rest at landing; at takeoff they do.
    duration : (float, float)
        s.
    most : int, optional
        Which of the three angles is to be as great as can be at landing; else the effort is to be
        small.
    effort : float
        What the mean square of the torques in a second, in units of their bounds, counts beside
        that angle, rad.
    """

    model: Model
    moving: Moving
    takeoff: Array
    landing: Array
    aloft: Array
    rates: Array | None
    momentum: Array | None
    start: Array
    end: Array
    rest_at_end: bool
    duration: Range
    most: int | None
    effort: float

    @property
    def count(self) -> int:
        """How many joints move."""
        return len(self.moving.joints)


def within(bounds: Array) -> Array:
    """A number in each range (…, 2): the middle, the end that it has, or zero."""
    low, high = np.moveaxis(bounds, -1, 0)
    with np.errstate(invalid="ignore"):
        middle = (low + high) / 2
    nearest = np.clip(0.0, low, high)
    return np.where(np.isfinite(middle), middle, nearest)
