"""Units of the numbers of a run, and the numbers for a robot of another size."""

from __future__ import annotations

from dataclasses import fields, replace

from somersault._core.checks import instance, shown, text
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.robot._control import NEVER, Control

_BY_TABLE = {"plant": "1", "push": "N"}
_BY_NAME = {
    "at": "s", "duration": "s", "hold": "s", "window": "s", "stance_time": "s", "speed_gain": "s",
    "landing_gain": "s", "speed": "m/s", "hurdle_speed": "m/s", "lift_off_speed": "m/s",
    "landing_speed": "m/s", "speed_change": "m/s", "landing_lift_off": "m/s",
    "piston_speed": "m/s", "forward": "m/s", "sideways": "m/s", "upward": "m/s",
    "turn_rate": "rad/s", "roll_rate": "rad/s", "pitch_rate": "rad/s", "yaw_rate": "rad/s",
    "sideways_gain": "s", "torque": "N m", "height": "m", "leg_length": "m",
    "idle_length": "m", "held_length": "m", "fall_height": "m", "foot": "m", "foot_offset": "m",
    "landing_foot": "m", "width": "m", "turning_friction": "m", "roll": "rad", "pitch": "rad",
    "hurdle_pitch": "rad", "feet_back": "rad", "attitude": "rad", "angle": "rad", "wind_up": "rad",
    "lean": "rad", "straddle": "rad",
}  # fmt: skip
_OF_ERRORS = {
    "lift_off_speed": "1", "torque": "1", "thrust": "1", "roll": "rad/s", "pitch": "rad/s",
    "yaw": "rad/s",
}  # fmt: skip
_OF_LEG_SPRINGS = {"leg_spring": "N/m", "leg_rest": "m", "leg_damping": "N s/m"}
# By which powers of mass and length a number grows, where gravity stays what it is.
_POWERS = {
    "1": (0.0, 0.0), "rad": (0.0, 0.0), "rad/s": (0.0, -0.5), "m": (0.0, 1.0), "s": (0.0, 0.5),
    "m/s": (0.0, 0.5), "N": (1.0, 0.0), "N m": (1.0, 1.0), "N m/rad": (1.0, 1.0),
    "N m s/rad": (1.0, 1.5),
    "N/m": (1.0, -1.0), "N s/m": (1.0, -0.5),
}  # fmt: skip


def unit(table: str, name: str) -> str:
    """The unit of a number of `Control`.

    Parameters
    ----------
    table, name : str
        "running", "speed".

    Returns
    -------
    str
    """
    if (text("table", table), text("name", name)) not in Control().numbers():
        raise SomersaultError(
            f"a run has no number {shown(name)} in a table {shown(table)}; see Control"
        )
    if name in ("at", "duration"):
        return "s"
    if table == "errors" and name in _OF_ERRORS:
        return _OF_ERRORS[name]
    if table == "flip" and name in _OF_LEG_SPRINGS:
        return _OF_LEG_SPRINGS[name]
    if table != "plant" and name.endswith("_damping"):
        return "N m s/rad"
    if table != "plant" and name.endswith("_stiffness"):
        return "N m/rad"
    return _BY_TABLE.get(table) or _BY_NAME.get(name, "1")


def similar(control: Control, mass: float, length: float) -> Control:
    """The numbers with which a robot of another size does the same.

    Each grows with mass and length as its unit does, where gravity stays what it is: a robot that
    is similar in all its parts, springs and actuators included, then moves exactly alike. For one
    of other proportions they are a beginning.

    Parameters
    ----------
    control : Control
        That of the first robot.
    mass, length : float
        Of the other, in parts of the first one's.

    Returns
    -------
    Control
        Lengths of legs among them: check that the other robot's legs reach them.

    Raises
    ------
    SomersaultError
        Unless both are positive.

    Examples
    --------
    >>> from somersault.robot import Control, similar
    >>> similar(Control(), mass=8.0, length=2.0).running.leg_length
    1.6
    """
    instance("control", control, Control)
    if not (number("mass", mass) > 0 and number("length", length) > 0):
        raise SomersaultError(
            f"a robot's mass and length must be positive, and are {mass} and {length} of another's"
        )
    tables = {}
    for table in fields(Control):
        numbers = getattr(control, table.name)
        changed = {}
        for each in fields(numbers):
            powers = _POWERS[unit(table.name, each.name)]
            value = getattr(numbers, each.name)
            if value >= NEVER:
                continue
            try:
                changed[each.name] = value * mass ** powers[0] * length ** powers[1]
            except OverflowError:
                raise SomersaultError(
                    f"no robot is {mass:g} times as heavy and {length:g} times as long as another; "
                    "give parts of its mass and length"
                ) from None
        tables[table.name] = replace(numbers, **changed)
    return Control(**tables)
