"""Legs on soft springs, which let them extend when the robot spins faster (§7.1).

The thesis would have liked to try this in the place of its tuck servo: the faster the somersault,
the further a leg that hangs on a spring is drawn out, the greater the inertia, and the slower the
somersault. Everything here is a plain function.
"""

from __future__ import annotations

from typing import Any

from somersault.robot.tuck_servo import Tuck


def pull(stiffness: Any, rest: Any, damping: Any, length: Any, speed: Any) -> Any:
    """The force with which a spring draws the leg in, N."""
    return stiffness * (length - rest) + damping * speed


def corrected(tuck: Tuck, stiffness: Any, rate: Any, length: Any) -> Any:
    """Which part of an error in momentum the springs keep from the somersault rate.

    With g = d ln I / d ln Ω of legs that hang at a length, an error of the momentum in parts of it
    leaves 1/(1 + g) of itself in the rate. A spring just stiffer than m_l Ω² corrects nearly all: a
    governor that turns at one rate whatever its momentum, as long as its legs have somewhere to go.

    Parameters
    ----------
    tuck : Tuck
    stiffness : float
        Of each leg's spring, N/m.
    rate : float
        rad/s.
    length : float
        At which the legs hang at that rate, m.

    Examples
    --------
    >>> from somersault.robot.leg_spring import corrected
    >>> from somersault.robot.tuck_servo import Tuck
    >>> tuck = Tuck(1.02, 0.2, 2 * 0.652, 0.243, 0.647, 0.862)
    >>> [round(corrected(tuck, k, 8.3, 0.78), 2) for k in (50.0, 100.0, 1000.0)]
    [0.89, 0.43, 0.04]
    """
    mass = tuck.lower_leg / 2
    drawn = 2 * mass * (length - tuck.offset) * rate / (stiffness - mass * rate**2)
    gain = tuck.slope(length) / tuck.whole(length) * drawn * rate
    return gain / (1 + gain)
