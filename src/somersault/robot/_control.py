"""The numbers of the controller, table by table, as a SPEC has them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any

from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.robot._least import AtLeastOne, Least, NotNegative, Positive, leasts
from somersault.robot._twist import Twist

NEVER = 1e6
"""A time (s), a number of steps, or a speed, that no run reaches: one that was not given."""


@dataclass(frozen=True)
class Running:
    """[running]: an alternating gait (§3.4).

    Parameters
    ----------
    speed : float
        Forwards, m/s.
    turn_rate : float
        Of the heading, rad/s, to the left.
    leg_length, idle_length : float
        Of the leg that is to land, and of the other, m.
    lift_off_speed : float
        Upwards, m/s.
    thrust_factor : float
        By which the energy of lift-off is made greater, for what is lost until then.
    stance_time : float
        For which feet are placed, s.
    speed_gain : float
        m of foot for each m/s of speed that is too much.
    speed_change : float
        That a step is to make in the speed forwards, at most, m/s.
    foot_offset : float
        By which a foot is put down to its own side of the centre of mass, m.
    roll_stiffness, pitch_stiffness, yaw_stiffness : float
        Of the body's attitude in stance, N m/rad.
    roll_damping, pitch_damping, yaw_damping : float
        N m s/rad.
    friction : float
        The force along the ground that the hips may ask for, in parts of the leg's force.
    turning_friction : float
        The moment about a foot that they may ask for, m.
    piston_speed : float
        At which a leg's piston moves, m/s.
    """

    speed: float = 1.0
    turn_rate: float = 0.0
    leg_length: Positive = 0.80
    idle_length: Positive = 0.66
    lift_off_speed: NotNegative = 1.5
    thrust_factor: NotNegative = 1.06
    stance_time: NotNegative = 0.17
    speed_gain: NotNegative = 0.07
    speed_change: NotNegative = NEVER
    foot_offset: float = 0.04
    roll_stiffness: NotNegative = 600.0
    pitch_stiffness: NotNegative = 150.0
    yaw_stiffness: NotNegative = 100.0
    roll_damping: NotNegative = 45.0
    pitch_damping: NotNegative = 45.0
    yaw_damping: NotNegative = 10.0
    friction: NotNegative = 0.6
    turning_friction: NotNegative = 0.025
    piston_speed: NotNegative = 1.5


@dataclass(frozen=True)
class Hips:
    """[hips]: how hip angles are held in the air, by axis of the hip: N m/rad and N m s/rad."""

    y_stiffness: NotNegative = 600.0
    x_stiffness: NotNegative = 350.0
    z_stiffness: NotNegative = 60.0
    y_damping: NotNegative = 18.0
    x_damping: NotNegative = 14.0
    z_damping: NotNegative = 1.5


@dataclass(frozen=True)
class Flip:
    """[flip]: a somersault, by the steps of Table 3.2.

    Parameters
    ----------
    at : float
        The first step after this time is the hurdle, s; never, if it is left out.
    hurdle_speed : float
        Upwards at the lift-off of the hurdle, m/s.
    hurdle_pitch : float
        Of the body in the hurdle's stance, rad.
    foot : float
        How much further in front than for running on the feet land for the flip, m.
    width : float
        Between the feet in the flip step and at landing, m.
    leg_length : float
        With which they land for the flip, m.
    torque : float
        That pitches the body forward in the flip step, N m.
    lift_off_speed : float
        Upwards, for which the springs are compressed, m/s. About four fifths of it are reached.
    piston_speed : float
        m/s.
    feet_back : float
        Hip angle in the air, rad.
    attitude : float
        Somersault angle at which it is to land, rad.
    servo : float
        Whether the tuck servo is on (1), or the legs are held at `held_length` (0).
    held_length : float
        m.
    leg_spring, leg_rest, leg_damping : float
        Instead of either, a soft spring on which each leg hangs while the servo would be at work
        (§7.1), N/m, its length at rest, m, and its damping, N s/m; none with a stiffness of 0.
    window : float
        From how long before the expected landing the feet track the ground, s; none below 0.
    landing_foot : float
        How much further in front than for running on the feet land, m.
    landing_speed : float
        Wanted after the landing, m/s.
    landing_gain : float
        m of foot for each m/s of speed that is too much.
    landing_stiffness, landing_damping : float
        Of pitch while landing, N m/rad and N m s/rad.
    landing_lift_off : float
        Upwards, of the hop after the landing, m/s.
    hold : float
        How long the legs keep their length after that, s.
    """

    at: NotNegative = NEVER
    hurdle_speed: NotNegative = 2.4
    hurdle_pitch: float = -0.15
    foot: float = -0.11
    width: NotNegative = 0.24
    leg_length: Positive = 0.77
    torque: NotNegative = 105.0
    lift_off_speed: NotNegative = 4.0
    piston_speed: NotNegative = 2.0
    feet_back: float = 0.436
    attitude: float = 6.109
    servo: NotNegative = 1.0
    held_length: Positive = 0.78
    leg_spring: NotNegative = 0.0
    leg_rest: NotNegative = 0.5
    leg_damping: NotNegative = 4.0
    window: float = 0.12
    landing_foot: float = 0.05
    landing_speed: float = 0.8
    landing_gain: NotNegative = 0.07
    landing_stiffness: NotNegative = 150.0
    landing_damping: NotNegative = 35.0
    landing_lift_off: NotNegative = 1.3
    hold: NotNegative = 0.08


@dataclass(frozen=True)
class Errors:
    """[errors]: what is sensed or done wrong.

    Parameters
    ----------
    lift_off_speed : float
        By which the speed at lift-off is estimated too high, in parts of it.
    torque, thrust : float
        By which the flip's torque and lift-off speed are too great, in parts of them.
    foot : float
        By which the feet land too far in front for the flip, m.
    forward, sideways, upward : float
        Speed that the body gets, unasked, at the beginning of the hurdle, m/s.
    roll, pitch, yaw : float
        Rate of turning that it gets then, rad/s.
    """

    lift_off_speed: float = 0.0
    torque: float = 0.0
    thrust: float = 0.0
    foot: float = 0.0
    forward: float = 0.0
    sideways: float = 0.0
    upward: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0


@dataclass(frozen=True)
class Change:
    """[change]: another speed or turn from some time on. What is not given stays as it was.

    Parameters
    ----------
    at : float
        s; never, if it is left out.
    speed : float
        Forwards, m/s.
    turn_rate : float
        Of the heading, rad/s, to the left.
    """

    at: NotNegative = NEVER
    speed: float = NEVER
    turn_rate: float = NEVER


@dataclass(frozen=True)
class Push:
    """[push]: a force on the body.

    Parameters
    ----------
    at, duration : float
        s.
    forward, sideways, upward : float
        N, at the torso's centre of mass.
    """

    at: NotNegative = NEVER
    duration: NotNegative = 0.1
    forward: float = 0.0
    sideways: float = 0.0
    upward: float = 0.0


@dataclass(frozen=True)
class End:
    """[end]: what ends a run before its time is over.

    Parameters
    ----------
    fall_height : float
        Of the hips, below which the robot has fallen, m.
    steps_after : float
        Steps after the somersault with which it has succeeded.
    """

    fall_height: NotNegative = 0.4
    steps_after: AtLeastOne = NEVER


@dataclass(frozen=True)
class Start:
    """[start]: how a run begins, in the air over one leg.

    Parameters
    ----------
    forward, sideways : float
        Speed, m/s.
    height : float
        Of the hips, m.
    roll, pitch : float
        rad.
    roll_rate, pitch_rate, yaw_rate : float
        rad/s.
    """

    forward: float = 0.8
    sideways: float = 0.0
    height: Positive = 0.87
    roll: float = 0.0
    pitch: float = 0.0
    roll_rate: float = 0.0
    pitch_rate: float = 0.0
    yaw_rate: float = 0.0


@dataclass(frozen=True)
class Plant:
    """[plant]: the robot itself, in parts of what its file says. The controller does not know.

    Parameters
    ----------
    friction, turning_friction : float
        Of ground and feet.
    stiffness, damping : float
        Of the legs' springs.
    roll_inertia, pitch_inertia, yaw_inertia : float
        Of the torso.
    torque : float
        That the hips' actuators have.
    hip_spacing : float
        Between the hips.
    foot_radius : float
        Of the balls on which it stands; the soles stay where they are.
    upper_leg_mass : float
        Of the upper legs, and with it their inertia. The robot's mass is not kept.
    """

    friction: NotNegative = 1.0
    turning_friction: NotNegative = 1.0
    stiffness: NotNegative = 1.0
    damping: NotNegative = 1.0
    roll_inertia: Positive = 1.0
    pitch_inertia: Positive = 1.0
    yaw_inertia: Positive = 1.0
    torque: NotNegative = 1.0
    hip_spacing: NotNegative = 1.0
    foot_radius: Positive = 1.0
    upper_leg_mass: Positive = 1.0


@dataclass(frozen=True)
class Control:
    """All numbers of a run."""

    start: Start = field(default_factory=Start)
    plant: Plant = field(default_factory=Plant)
    running: Running = field(default_factory=Running)
    hips: Hips = field(default_factory=Hips)
    flip: Flip = field(default_factory=Flip)
    twist: Twist = field(default_factory=Twist)
    errors: Errors = field(default_factory=Errors)
    change: Change = field(default_factory=Change)
    push: Push = field(default_factory=Push)
    end: End = field(default_factory=End)

    def __post_init__(self) -> None:
        for table in fields(self):
            given = instance(f"control.{table.name}", getattr(self, table.name), _kind(table.name))
            for each in fields(given):
                where = f"{table.name}.{each.name}"
                value, least = (
                    number(where, getattr(given, each.name)),
                    least_of(table.name, each.name),
                )
                if least and not least.allows(value):
                    raise SomersaultError(f"{where} must {least}, and is {value:g}; correct it")

    def numbers(self) -> dict[tuple[str, str], float]:
        """Each by its table and name."""
        return {
            (table.name, each.name): float(getattr(getattr(self, table.name), each.name))
            for table in fields(self)
            for each in fields(getattr(self, table.name))
        }


def least_of(table: str, name: str) -> Least | None:
    """What a number is at least; None where any will do."""
    return leasts(_kind(table)).get(name)


def _kind(table: str) -> Any:
    """The dataclass of a table."""
    return next(field for field in fields(Control) if field.name == table).default_factory


class Symbolic:
    """The tables of `Control` with a symbol for each number, in the order of `numbers`."""

    def __init__(self, symbols: Iterator[Any]) -> None:
        for table in fields(Control):
            kind = _kind(table.name)
            values = {each.name: next(symbols) for each in fields(kind)}
            setattr(self, table.name, kind(**values))

    start: Start
    plant: Plant
    running: Running
    hips: Hips
    flip: Flip
    twist: Twist
    errors: Errors
    change: Change
    push: Push
    end: End
