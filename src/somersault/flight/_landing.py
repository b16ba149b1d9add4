"""How a flight ended."""

from __future__ import annotations

from dataclasses import dataclass

from somersault._core.array import Array


@dataclass(frozen=True)
class Landing:
    """The end of a flight: when it was, how the body stood and moved, and why it ended.

    Attributes
    ----------
    time : float
        s.
    somersault, tilt, twist : float
        rad, with all whole turns since takeoff.
    quaternion : ndarray, (4,)
        Scalar first, body to inertial.
    angular_velocity : ndarray, (3,)
        In body axes, rad/s.
    joints : dict of str to float
        Joint coordinates by name, rad or m.
    ended : str
        "duration", "event", "too many steps" or "not finite".
    """

    time: float
    somersault: float
    tilt: float
    twist: float
    quaternion: Array
    angular_velocity: Array
    joints: dict[str, float]
    ended: str
