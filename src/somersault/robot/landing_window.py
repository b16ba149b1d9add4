"""The landing window: where the feet have to be, whenever the robot may land (§3.3.2).

From shortly before the time at which it expects to land until it does, the robot keeps its feet at
the place under it from which it would go on running, whatever its attitude: the somersault may end
early or late by some tens of degrees, and the legs' inclination is right all the same. Everything
here is a plain function of what is sensed.

The thesis has β = Φ − α with feet back for α > 0, which its own data contradict (figure 3-5: Φ of
325°, β of −11°, feet back). Here a leg's inclination is that of the body plus the hip's angle, and
hip angles are positive with the foot back.
"""

from __future__ import annotations

from typing import Any

import casadi as ca

from somersault.robot._expressions import all_of


def is_open(time_left: Any, before: Any) -> Any:
    """Whether the feet are to track the ground: from so long before the expected landing on, and as
    long as the robot is in the air after it."""
    return time_left < before


def displacement(speed: Any, wanted: Any, stance: Any, gain: Any, further: Any) -> Any:
    """How far in front of the centre of mass a foot is put down, m.

    Parameters
    ----------
    speed : float
        In flight, m/s.
    wanted : float
        The speed to have after the stance, m/s.
    stance : float
        How long a stance takes, s: half of the way that is made meanwhile neither speeds up nor
        slows down.
    gain : float
        m of foot for each m/s that it is too fast.
    further : float
        m.
    """
    return speed * stance / 2 + gain * (speed - wanted) + further


def inclination(displaced: Any, length: Any) -> Any:
    """The leg's inclination with its foot so far in front, β of d = −l sin β (3.2), rad.

    It is positive with the foot back, so that it adds to the body's somersault angle.
    """
    height = ca.sqrt(ca.fmax(length**2 - displaced**2, 1e-6))
    return ca.atan2(-displaced, height)


def hip_angle(wanted: Any, somersault: Any) -> Any:
    """The hip's angle that gives a leg its inclination, α of β = Φ + α, whole turns aside, rad."""
    difference = wanted - somersault
    return ca.atan2(ca.sin(difference), ca.cos(difference))


def reaches(angle: Any, low: Any, high: Any) -> Any:
    """Whether a hip can turn to an angle."""
    return all_of(low <= angle, angle <= high)
