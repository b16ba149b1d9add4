"""Section 3.3: the equations of tuck servo and landing window, and the flight flown once more."""

from __future__ import annotations

import numpy as np

from somersault.robot import Robot
from somersault.robot import landing_window as window
from somersault.robot import tuck_servo as servo
from somersault.robot.tuck_servo import LiftOff, Somersault, Tuck
from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result
from somersault.thesis.ch3._free_flight import reflown

_LENGTH = 0.75  # m, at which derivatives are compared
_UP = LiftOff(3.32, 0.79, 0.1)  # the mean lift-off of Table 3.3, a tenth of a second ago
_WHAT = Somersault(momentum=12.3, left=5.4, sweep=0.0, lean=-0.1)


def sec_3_3() -> Result:
    """Equations 3.1 to 3.11, and free flight by two programs."""
    tuck = _tuck()
    h, r = 1e-6, _LENGTH - tuck.offset
    difference = (_f(tuck, _LENGTH + h) - _f(tuck, _LENGTH - h)) / (2 * h)
    rate = _WHAT.momentum / float(tuck.whole(_LENGTH))
    fall = float(servo.mismatch_slope(tuck, _UP, _WHAT, _LENGTH)) + (
        _WHAT.left / rate**2 * 2 * tuck.lower_leg * r * rate / float(tuck.whole(_LENGTH))
    )
    printed = fall - _WHAT.left / rate**2 * tuck.lower_leg * r * rate / (
        tuck.inertia + tuck.lower_leg / 2 * r**2
    )
    steps = [_newton(tuck, off) for off in (1.0, printed / difference)]
    inclination, hip = np.radians(-11.0), np.radians(325.0)
    alpha = float(np.degrees(window.hip_angle(inclination, hip)))
    spread = _forgiven(np.radians(-6.0))
    flown = reflown()
    angle, joint = flown.apart(flown.mujoco, flown.ours)
    seconds = float(flown.times[-1])
    claims = (
        number(
            "sec3-3.derivative", "eq. 3.10, 3.11", "the derivative of f by the leg's length",
            round(printed, 6), round(difference, 6), "s/m", 0.01,
            "The printed factor of 2 should be 4, and I_o + m_l r² be I_o + 2 m_l r²: see the "
            "errata. By finite differences of f itself.",
        ),
        statement(
            "sec3-3.newton", "§3.3.1", "Newton's method finds the leg's length within a control "
            "cycle", "each cycle", f"to 1e-9 s in {steps[0]} steps with the corrected slope, "
            f"{steps[1]} with the printed one", steps[0] <= 4 < steps[1],
        ),
        statement(
            "sec3-3.feedback", "§3.3.1", "as the servo goes by the sensed state, it hardly "
            "matters how well robot parameters are known", "reduced", *_insensitive(tuck),
        ),
        statement(
            "sec3-3.sign", "§3.3.2, Figure 3-5", "β = Φ − α, with feet back for α > 0",
            "β = Φ − α", f"Φ = 325° and β = −11° need β = Φ + α with the feet {alpha:.0f}° back",
            alpha < 0, "With β = Φ − α the feet would be 24° in front; the text has them back.",
        ),
        statement(
            "sec3-3.window", "§3.3.2", "the landing window allows for an error of the body's "
            "attitude", "a window", f"hips that turn by ±60° put the foot right from "
            f"{spread[0]:.0f} to {spread[1]:.0f}° about 350°", spread[0] < -40 and spread[1] > 40,
        ),
        statement(
            "sec3-3.twice", "§3.2", "in flight momentum is kept, and joints alone move the body",
            "free flight", f"the flight of figure 3-5, from its joint torques, by our equations "
            f"and by MuJoCo: {angle:.0e} rad and {joint:.0e} apart after {seconds:.2f} s",
            angle < 1e-5 and joint < 1e-4,
        ),
    )  # fmt: skip
    return Result(
        "The tuck servo solves f(l) = 0 for the length of the legs by Newton's method; the landing "
        "window has the feet track the ground.",
        "Both are plain functions of what is sensed, in `somersault.robot.tuck_servo` and "
        "`landing_window`.",
        claims,
    )


def _tuck() -> Tuck:
    m = Robot().machine
    return Tuck(m.inertia, m.leg_inertia, m.lower_leg, m.offset, 0.647, 0.862)


def _f(tuck: Tuck, length: float) -> float:
    return float(servo.mismatch(tuck, _UP, _WHAT, length))


def _newton(tuck: Tuck, off: float) -> int:
    """How many steps of Newton's method it takes, with a slope so many times the servo's."""
    length = 0.65
    for count in range(50):
        if abs(_f(tuck, length)) < 1e-9:
            return count
        length -= _f(tuck, length) / (off * float(servo.mismatch_slope(tuck, _UP, _WHAT, length)))
    return 50


def _insensitive(tuck: Tuck) -> tuple[str, bool]:
    """Landing angles of a somersault whose servo takes I_o for a tenth greater or less, when it is
    asked again each hundredth of a second."""
    landings = []
    for factor in (0.9, 1.0, 1.1):
        believed = Tuck(
            tuck.inertia * factor, tuck.leg_inertia, tuck.lower_leg, tuck.offset, tuck.shortest,
            tuck.longest,
        )  # fmt: skip
        angle, ago, length = 0.9, 0.1, 0.65
        while True:
            rate = _WHAT.momentum / float(tuck.whole(length))
            up = LiftOff(_UP.speed, _UP.height, ago)
            momentum = rate * float(believed.whole(length))
            left = Somersault(momentum, 6.109 - angle, 0.0, _WHAT.lean)
            length = float(servo.leg_length(believed, up, left, length))
            landing = float(servo.flight_time(up, np.cos(_WHAT.lean) * length)) - ago
            if landing < 0.01:
                landings.append(np.degrees(angle + rate * landing))
                break
            angle, ago = angle + 0.01 * rate, ago + 0.01
    spread = float(np.ptp(landings))
    return f"I_o off by ±10 % moves the landing by {spread:.2f}°", spread < 1.0


def _forgiven(lean: float) -> tuple[float, float]:
    """By how many degrees a landing at 350° may be off with the foot right all the same."""
    off = np.arange(-90, 91)
    limit = np.radians(60)
    good = [
        d for d in off
        if bool(window.reaches(window.hip_angle(lean, np.radians(350 + d)), -limit, limit))
    ]  # fmt: skip
    return float(min(good)), float(max(good))
