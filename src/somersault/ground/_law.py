"""The numbers of the law by which a gymnast lands."""

from __future__ import annotations

from dataclasses import dataclass

from somersault.ground._gymnast import positive

_MAY_BE_ZERO = (
    "height_stiffness", "height_damping", "place_stiffness", "place_damping", "attitude_stiffness",
    "momentum_damping", "lean", "arms", "arm_stiffness", "arm_damping", "margin",
)  # fmt: skip


@dataclass(frozen=True)
class LandingLaw:
    """How a gymnast lands: a path of the centre of mass, and feedback of what it does besides.

    *Feed-forward.* The centre of mass is braked evenly, `braking` deciding over what depth, but
    never to below `lowest`; then it rises to `height` within `rise`.

    *Feedback.* The floor's force along the ground is to bring the centre of mass over the middle of
    the feet, and the centre of pressure is to bring the trunk to its lean and the angular momentum
    to rest. Where the centre of pressure would have to leave the feet, it goes to their end, and
    the attitude waits for the balance: `attitude_weight` says how little it counts then. What the
    joints must do for such a force, with the feet flat and within the joints' ranges, follows from
    the equations of motion. Torques end at the gymnast's strength. The law knows everything at
    once: no reaction time is in it.

    Parameters
    ----------
    braking : float
        m/s².
    lowest : float
        Height of the centre of mass above the floor, m.
    height : float
        Standing, m.
    rise : float
        s.
    height_stiffness, height_damping : float
        About the path up, 1/s², 1/s.
    place_stiffness, place_damping : float
        Of the centre of mass along the ground, 1/s², 1/s.
    attitude_stiffness, momentum_damping : float
        Of the trunk's lean, 1/s², and of the angular momentum, 1/s.
    attitude_error : float
        Beyond which an error of the lean counts no more, rad.
    attitude_weight : float
        Of the angular acceleration (rad/s²) against that of the centre of mass (m/s²).
    lean : float
        Of the trunk in the crouch, rad.
    lean_depth : float
        How far below `height` the lean is all there, m.
    lean_rate : float
        At which the lean that is wanted changes, rad/s.
    arms : float
        Shoulder angle, rad.
    arm_stiffness, arm_damping : float
        1/s², 1/s.
    foot_stiffness, foot_damping : float
        With which the feet are kept flat on the floor, 1/s², 1/s.
    friction : float
        Coefficient that is relied on.
    margin : float
        By which the centre of pressure stays within heel and toes, m.
    most_force : float
        That is asked of the legs, in weights.
    """

    braking: float = 40.0
    lowest: float = 0.45
    height: float = 0.93
    rise: float = 0.8
    height_stiffness: float = 60.0
    height_damping: float = 15.0
    place_stiffness: float = 15.0
    place_damping: float = 8.0
    attitude_stiffness: float = 20.0
    momentum_damping: float = 16.0
    attitude_error: float = 0.3
    attitude_weight: float = 0.05
    lean: float = 0.8
    lean_depth: float = 0.4
    lean_rate: float = 1.0
    arms: float = 1.4
    arm_stiffness: float = 40.0
    arm_damping: float = 12.0
    foot_stiffness: float = 200.0
    foot_damping: float = 30.0
    friction: float = 0.8
    margin: float = 0.005
    most_force: float = 8.8

    def __post_init__(self) -> None:
        positive(self, "a landing law", _MAY_BE_ZERO)
