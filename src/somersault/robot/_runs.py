"""Many runs of a robot, as an ensemble asks for them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.canonical import canonical
from somersault._core.checks import instance, text
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.robot._control import NEVER, Control, least_of
from somersault.robot._controller import FELL, RAN_ON, REMEMBERED, Controller
from somersault.robot._half_twist import HalfTwist
from somersault.robot._plant import Lane, advance
from somersault.robot._robot import PERIOD, Robot
from somersault.robot._running import running
from somersault.robot._somersault import Somersault, hurdle_is_due
from somersault.robot._units import unit
from somersault.simulation import ENDED, Endings, Name, Numbers, Target, Variable

ENDINGS = Endings(
    ("ran on", "some steps", "fell landing", "fell before", "time over", "broke off", "no start"),
    ("broke off", "no start"),
    "no start",
    good=("ran on",),
)
FEW_STEPS = 3
"""Steps after a landing from which an attempt counts as one of some steps, not as a fall."""

_VARIABLES = {
    "steps_after": Variable("1", "i4", words="steps after the somersault"),
    "landing_inclination": Variable("rad", words="of the legs at touchdown, beta"),
    "landing_wanted": Variable("rad", words="inclination that the legs were to have"),
    "landing_somersault": Variable("rad", words="somersault angle at touchdown"),
    "landing_tilt": Variable("rad", words="tilt at touchdown"),
    "landing_twist": Variable("rad", words="twist at touchdown"),
    "landing_rate": Variable("rad/s", words="of the body at touchdown"),
    "greatest_tilt": Variable("rad", words="greatest tilt in the air, either way"),
    "lift_off_rate": Variable("rad/s", words="of the body at lift-off"),
    "servo_rate": Variable("rad/s", words="of the body as the tuck servo begins"),
    "mean_rate": Variable("rad/s", words="of the body, lift-off to touchdown"),
    "lift_off_speed": Variable("m/s", words="upwards"),
    "lift_off_estimate": Variable("m/s", words="what the robot took its lift-off speed to be"),
    "lift_off_forward": Variable("m/s", words="speed forwards at lift-off"),
    "flight_time": Variable("s", words="lift-off to touchdown"),
    "time": Variable("s", words="when the run ended"),
}
_LONGEST = 1_000.0  # s
_LENGTHS = (
    ("running", "leg_length"), ("running", "idle_length"), ("flip", "leg_length"),
    ("flip", "held_length"),
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Runs:
    """Runs of a robot that differ in some numbers: a `somersault.simulation.Simulation`.

    Parameters
    ----------
    robot : Robot
    control : Control
        The nominal numbers.
    duration : float
        After which a run is over, s.
    """

    robot: Robot = field(default_factory=Robot)
    control: Control = field(default_factory=Control)
    duration: float = 20.0
    packages = ("somersault", "casadi", "llvmlite", "mujoco", "numpy")
    endings = ENDINGS
    together = 64

    def __post_init__(self) -> None:
        instance("robot", self.robot, Robot)
        instance("control", self.control, Control)
        if not 0 < number("duration", self.duration) <= _LONGEST:
            raise SomersaultError(
                f"duration of a run is up to {_LONGEST:g} s, and here {self.duration:g}; change it"
            )
        _check_lengths(self.robot, self.control)
        for table, what in (("flip", "somersault"), ("change", "change"), ("push", "push")):
            at = getattr(self.control, table).at
            if self.duration <= at < NEVER:
                raise SomersaultError(
                    f"the {what} is to be at {at:g} s, but the run is over at {self.duration:g}; "
                    f"make {table}.at less, or the duration longer"
                )

    def __getstate__(self) -> dict[str, Any]:
        return {"robot": replace(self.robot), "control": self.control, "duration": self.duration}

    @property
    def name(self) -> str:
        """The model's."""
        return self.robot.machine.file.stem

    @cached_property
    def specification(self) -> dict[str, Any]:
        """All that decides the numbers, as plain data."""
        return {
            "robot": canonical(self.robot),
            "file": self.robot.machine.digest,
            "control": canonical(self.control),
            "duration": self.duration,
        }

    @property
    def values(self) -> dict[Name, float]:
        """The nominal numbers."""
        return {(table, name): x for (table, name), x in self.control.numbers().items()}

    @property
    def variables(self) -> dict[str, Variable]:
        """What is reported of each run."""
        return _VARIABLES

    @property
    def times(self) -> Array:
        """Nothing is reported over time."""
        return np.empty(0)

    def targets(self, path: str) -> tuple[Target, ...]:
        """The number that a name means: its table and name, "errors.torque".

        Parameters
        ----------
        path : str

        Returns
        -------
        tuple of Target

        Raises
        ------
        SomersaultError
            For a name that is not there.
        """
        name = tuple(text("the name of a number", path).split("."))
        numbers = self.control.numbers()
        if name not in numbers:
            there = [number for table, number in numbers if table == name[0]]
            known = f"[{name[0]}] has {', '.join(there)}"
            if not there:
                known = f"its tables are {', '.join(dict.fromkeys(t for t, _ in numbers))}"
            raise SomersaultError(f"{path} is no number of a run; {known}")
        return (Target(name, unit=unit(*name)),)

    def with_varied(self, names: tuple[Name, ...]) -> Runs:
        """The same runs: any number may be varied."""
        _ = self.controller  # refuses a robot that cannot run, before anything is written
        return self

    def sound(self, values: Numbers, count: int) -> Array:
        """Whether each run can begin: no number is too small, legs reach, and it is in the air.

        Parameters
        ----------
        values : mapping of tuple to float or ndarray, (count,)
        count : int

        Returns
        -------
        ndarray of bool, (count,)
        """
        good = np.ones(count, bool)
        for (table, name), value in values.items():
            if least := least_of(str(table), str(name)):
                good &= least.allows(np.asarray(value))
        for place in _LENGTHS:
            length = np.asarray(values[place])
            good &= (self.robot.shortest <= length) & (length <= self.robot.longest)
        return good & (np.asarray(values["start", "height"]) > self.robot.shortest)

    @property
    def controller(self) -> Controller:
        """Its controller, compiled once for all runs of a robot."""
        return _controller(self.robot, self.robot.machine.digest, self.control.twist.angle != 0)

    def run(self, values: Numbers, count: int) -> Mapping[str, Array]:
        """Run, and report.

        Parameters
        ----------
        values : mapping of tuple to float or ndarray, (count,)
            The numbers of the runs.
        count : int
            How many.

        Returns
        -------
        dict of str to ndarray, (count,)
        """
        rows = np.stack([np.broadcast_to(x, count) for x in map(values.get, self.values)], -1)  # type: ignore[arg-type]
        lanes, _ = self.carried_out(rows)
        ends = np.array([lane.kept for lane in lanes])
        return reported(dict(zip(REMEMBERED, ends.T, strict=True)))

    def carried_out(self, rows: Array, every: int = 0) -> tuple[list[Lane], list[Array]]:
        """Runs whose numbers are rows in the order of `values`.

        Parameters
        ----------
        rows : ndarray, (count, numbers)
        every : int
            What is sensed and done is recorded once in so many periods; 0 for never.

        Returns
        -------
        lanes, records : list
            Where each robot is at the end, and what was recorded of it.
        """
        lanes = [Lane(self.robot) for _ in rows]
        systems = [lane.begin(row) for lane, row in zip(lanes, rows, strict=True)]
        periods, steps = round(self.duration / PERIOD), self.robot.machine.steps
        _, records = self.controller.loop.run(advance(), systems, periods, steps, every)
        return lanes, records


@lru_cache(maxsize=16)
def _controller(robot: Robot, digest: str, twists: bool) -> Controller:
    """The controller of a robot whose file has a digest."""
    maneuver = HalfTwist() if twists else Somersault()
    return Controller(robot, [*running(hurdle_is_due), *maneuver.states()])


def _check_lengths(robot: Robot, control: Control) -> None:
    """SomersaultError for a length that no leg of the robot has."""
    for table, name in _LENGTHS:
        length = getattr(getattr(control, table), name)
        if not robot.shortest <= length <= robot.longest:
            raise SomersaultError(
                f"{table}.{name} is {length:g} m, which the legs do not reach; give "
                f"{robot.shortest:g} to {robot.longest:g}"
            )


def reported(end: Mapping[str, Array]) -> dict[str, Array]:
    """What is reported, of what is remembered at the end."""
    landed, left = end["turns"] > 0.5, end["lift_off_time"] > 0
    flight = end["landing_time"] - end["lift_off_time"]
    turned = end["landing_somersault"] - end["lift_off_somersault"]
    with np.errstate(divide="ignore", invalid="ignore"):
        derived = {"flight_time": flight, "mean_rate": turned / flight, "time": end["clock"]}
    rows = {}
    for name, variable in _VARIABLES.items():
        values = derived[name] if name in derived else end[name]
        if variable.dtype == "i4":
            rows[name] = np.nan_to_num(values).astype("i4")
        elif name == "time":
            rows[name] = values
        else:
            needs = left if name.startswith("lift_off") or name == "greatest_tilt" else landed
            rows[name] = np.where(needs, values, np.nan)
    return rows | {ENDED: _ended(end)}


def _ended(end: Mapping[str, Array]) -> Array:
    fell = end["over"] == FELL
    landed = end["turns"] > 0.5
    cases = {
        "broke off": ~np.isfinite(end["somersault"]),
        "ran on": end["over"] == RAN_ON,
        "some steps": fell & landed & (end["steps_after"] >= FEW_STEPS),
        "fell landing": fell & landed,
        "fell before": fell,
    }
    codes = [ENDINGS.code(word) for word in cases]
    return np.select(list(cases.values()), codes, ENDINGS.code("time over")).astype("u1")
