"""The numbers of a twist within a somersault, as a SPEC has them."""

from __future__ import annotations

from dataclasses import dataclass

from somersault.robot._least import NotNegative


@dataclass(frozen=True)
class Twist:
    """[twist]: a twist within the somersault (§6.4).

    Parameters
    ----------
    angle : float
        By which the body is to have turned to its left when it lands, rad; 0 for no twist.
    wind_up : float
        By which it is turned the other way in the hurdle's stance, rad.
    lean : float
        To its right, in the flip step, rad.
    pitch_rate, yaw_rate : float
        About the body's own axes, at which the flip step aims, rad/s.
    lift_off_speed : float
        Upwards, that goes with `pitch_rate`, m/s.
    pace : float
        By how much of a part that it lifts off more slowly it is to turn faster.
    pitch_damping, roll_stiffness, roll_damping, yaw_damping : float
        Of the flip step, N m/rad and N m s/rad.
    torque : float
        Greatest moment about the vertical, N m.
    straddle : float
        In the air, of the right leg to the front and of the left to the back, rad.
    straddle_gain : float
        By how much more for each rad that the twist is foreseen to be too great.
    sideways_gain : float
        m of foot to the side for each m/s, at landing.
    landing_roll_stiffness, landing_roll_damping, landing_yaw_damping : float
        N m/rad and N m s/rad.
    turn_rate : float
        At which the heading on which it lands is turned to that which is wanted, rad/s.
    """

    angle: float = 0.0
    wind_up: float = 0.0
    lean: float = 0.0
    pitch_rate: float = 7.0
    yaw_rate: float = 5.0
    lift_off_speed: NotNegative = 3.8
    pace: NotNegative = 0.0
    pitch_damping: NotNegative = 400.0
    roll_stiffness: NotNegative = 1800.0
    roll_damping: NotNegative = 135.0
    yaw_damping: NotNegative = 100.0
    torque: NotNegative = 150.0
    straddle: float = 0.0
    straddle_gain: NotNegative = 0.0
    sideways_gain: NotNegative = 0.07
    landing_roll_stiffness: NotNegative = 1000.0
    landing_roll_damping: NotNegative = 135.0
    landing_yaw_damping: NotNegative = 50.0
    turn_rate: NotNegative = 1.0
