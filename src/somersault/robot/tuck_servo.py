"""The tuck servo: which length of the legs ends a somersault at the right angle (§3.3.1).

Everything here is a plain function of what is sensed. Equations are those of Playter (1994), with
the derivative of 3.10 and 3.11 put right: d/dl of h/(I_o + 2 m r²) has a factor of 4, not 2, and
the whole inertia in its denominator.

Two things go beyond the thesis. It takes the present rate of the body for that of the whole robot;
here it is the angular momentum, to which legs that swing contribute. And it lands with the legs as
they are held; here they are swept to where they land, and the body turns further meanwhile by the
share of inertia that the legs have. With legs that neither swing nor will be swept, it is the
servo of the thesis.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import casadi as ca

from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.robot._expressions import clip, is_known

GRAVITY = 9.81
_STEPS = 4  # of Newton's method, each control cycle


def _check_numbers(given: Any) -> None:
    """SomersaultError for what is neither finite nor an expression."""
    for each in fields(given):
        if is_known(value := getattr(given, each.name)):
            number(each.name, value)


@dataclass(frozen=True)
class Tuck:
    """What the servo knows of a robot: its somersault inertia, by the length of its legs.

    Parameters
    ----------
    inertia : float
        Of the whole robot but for the distance of its lower legs, I_o, kg m².
    leg_inertia : float
        Of both legs about the hips, likewise without that distance, kg m².
    lower_leg : float
        Mass of both lower legs, 2 m_l, kg.
    offset : float
        By which the lower leg's centre of mass is nearer to the hip than the foot's sole, l − r, m.
    shortest, longest : float
        Lengths of the legs, m.
    """

    inertia: Any
    leg_inertia: Any
    lower_leg: Any
    offset: Any
    shortest: Any
    longest: Any

    def __post_init__(self) -> None:
        _check_numbers(self)

    def whole(self, length: Any) -> Any:
        """Somersault inertia of the robot, kg m² (3.9)."""
        return self.inertia + self.lower_leg * (length - self.offset) ** 2

    def legs(self, length: Any) -> Any:
        """Inertia of both legs about the hips, kg m²."""
        return self.leg_inertia + self.lower_leg * (length - self.offset) ** 2

    def slope(self, length: Any) -> Any:
        """Derivative of either by the length, kg m."""
        return 2 * self.lower_leg * (length - self.offset)


@dataclass(frozen=True)
class LiftOff:
    """The state that is known of the moment of lift-off.

    Parameters
    ----------
    speed : float
        Upwards, of the centre of mass, m/s.
    height : float
        Of the centre of mass, m.
    ago : float
        How long it is past, s.
    """

    speed: Any
    height: Any
    ago: Any

    def __post_init__(self) -> None:
        _check_numbers(self)


def flight_time(lift_off: LiftOff, landing_height: Any) -> Any:
    """From lift-off until the centre of mass comes down to a height (right of 3.1), s.

    Where it never is as high, the time to the top.
    """
    root = _fall(lift_off, landing_height)
    return (lift_off.speed + root) / GRAVITY


def _fall(lift_off: LiftOff, landing_height: Any) -> Any:
    """The speed downwards at a height."""
    square = lift_off.speed**2 + 2 * GRAVITY * (lift_off.height - landing_height)
    return ca.sqrt(ca.fmax(square, 1e-6))


@dataclass(frozen=True)
class Somersault:
    """A somersault in flight, and how it is to land.

    Parameters
    ----------
    momentum : float
        About the somersault axis, kg m²/s.
    left : float
        How far the body has to turn until it lands, Φ_td − Φ, rad.
    sweep : float
        How far the legs will be swept forward against the body until then, rad.
    lean : float
        The leg's inclination at touchdown, β_td, rad.
    """

    momentum: Any
    left: Any
    sweep: Any
    lean: Any

    def __post_init__(self) -> None:
        _check_numbers(self)
        if is_known(self.momentum) and self.momentum == 0:
            raise SomersaultError("momentum is 0, and a body that does not turn ends no somersault")


def time_to_turn(tuck: Tuck, somersault: Somersault, length: Any) -> Any:
    """Until the body has turned as far as it has to, with legs of a length (left of 3.3), s."""
    inertia = tuck.whole(length)
    still = somersault.left - tuck.legs(length) / inertia * somersault.sweep
    return still * inertia / somersault.momentum


def mismatch(tuck: Tuck, lift_off: LiftOff, somersault: Somersault, length: Any) -> Any:
    """By how much the time until landing exceeds the time to turn, f of 3.5, s."""
    left = flight_time(lift_off, ca.cos(somersault.lean) * length) - lift_off.ago
    return left - time_to_turn(tuck, somersault, length)


def mismatch_slope(tuck: Tuck, lift_off: LiftOff, somersault: Somersault, length: Any) -> Any:
    """Derivative of `mismatch` by the length, s/m (3.8, 3.11)."""
    cosine = ca.cos(somersault.lean)
    fall = -cosine / _fall(lift_off, cosine * length)
    # The time to turn is (left · I − sweep · I_legs) / h, and both inertias have the same slope.
    turn = (somersault.left - somersault.sweep) * tuck.slope(length) / somersault.momentum
    return fall - turn


def leg_length(tuck: Tuck, lift_off: LiftOff, somersault: Somersault, guess: Any) -> Any:
    """The length of the legs with which the somersault ends as the robot lands, by Newton's method.

    Parameters
    ----------
    tuck : Tuck
    lift_off : LiftOff
    somersault : Somersault
    guess : float
        The length that the cycle before gave, m.

    Returns
    -------
    float
        Within what the legs can do: where no length would do, the nearer limit.

    Raises
    ------
    SomersaultError
        For a guess that is no finite number.

    Examples
    --------
    >>> from somersault.robot.tuck_servo import LiftOff, Somersault, Tuck, leg_length, mismatch
    >>> tuck = Tuck(1.02, 0.2, 2 * 0.652, 0.243, 0.647, 0.862)
    >>> lift_off = LiftOff(speed=3.3, height=0.8, ago=0.1)
    >>> somersault = Somersault(momentum=12.5, left=5.4, sweep=0.0, lean=-0.1)
    >>> length = float(leg_length(tuck, lift_off, somersault, 0.7))
    >>> abs(float(mismatch(tuck, lift_off, somersault, length))) < 1e-6
    True
    """
    length = number("guess", guess) if is_known(guess) else guess
    for _ in range(_STEPS):
        f = mismatch(tuck, lift_off, somersault, length)
        slope = mismatch_slope(tuck, lift_off, somersault, length)
        length = clip(length - f / slope, tuck.shortest, tuck.longest)
    return length
