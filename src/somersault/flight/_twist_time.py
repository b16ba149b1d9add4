"""When a maneuver has twisted so many times."""

from __future__ import annotations

import math

import numpy as np

from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.flight._maneuver import Maneuver

_LONGEST = 20.0  # s: whatever has not twisted until then will not
_FINE = 1e-13  # s


def twist_time(maneuver: Maneuver, twists: float) -> float:
    """When a maneuver has twisted so many times, either way, to rounding.

    It is found by flying until there. Joints are held after their last keyframe.

    Parameters
    ----------
    maneuver : Maneuver
    twists : float
        From takeoff, in whole turns.

    Returns
    -------
    float
        s.

    Raises
    ------
    SomersaultError
        Where the body does not twist so far.

    Examples
    --------
    >>> import somersault as so
    >>> 0.0 < so.flight.twist_time(so.torque_twist(), 0.5) < 1.0
    True
    """
    instance("maneuver", maneuver, Maneuver)
    target = 2 * math.pi * number("twists", twists)
    longest = max(maneuver.duration, 1.0)
    while True:
        flown = maneuver.fly(duration=longest, accuracy=1e-12)
        twist = np.abs(flown.dataset["twist"].values - maneuver.takeoff.twist)
        if twist.max() >= target:
            break
        if longest >= _LONGEST:
            raise SomersaultError(
                f"this maneuver does not twist {twists:g} times in {longest:g} s; tilt it more"
            )
        longest *= 2
    after = int(np.argmax(twist >= target))
    if after == 0:
        return 0.0
    low, high = flown.times[after - 1], flown.times[after]
    from scipy.optimize import brentq

    def missing(time: float) -> float:
        here = maneuver.fly(duration=time, accuracy=1e-12, samples=2).landing.twist
        return abs(here - maneuver.takeoff.twist) - target

    low = max(float(low), 1e-9)
    if missing(low) >= 0:
        return low
    return float(brentq(missing, low, float(high), xtol=_FINE, rtol=1e-14))
