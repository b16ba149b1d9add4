"""Runs described in a TOML file: which robot, and the numbers of its controller."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

from somersault._core.checks import file_path, shown
from somersault._core.errors import SomersaultError
from somersault.robot._control import (
    Change,
    Control,
    End,
    Errors,
    Flip,
    Hips,
    Plant,
    Push,
    Running,
    Start,
)
from somersault.robot._maneuvers import maneuver, usual
from somersault.robot._robot import Robot
from somersault.robot._runs import Runs
from somersault.robot._twist import Twist
from somersault.spec import (
    Unfit,
    model_beside,
    read_as,
    read_toml,
    require_table,
    structured,
    structured_within,
)


@dataclass(frozen=True)
class Keys:
    """The keys of a SPEC of a run."""

    robot: Robot
    maneuver: str = "somersault"
    duration: float = Runs.duration
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


KEYS = tuple(Keys.__dataclass_fields__)
"""The keys of a SPEC of a run."""


def read_runs(path: Path) -> Runs:
    """The run in a TOML file, a SPEC as `somersault run` takes it.

    Parameters
    ----------
    path : pathlib.Path
        The robot's file is looked for in the same folder.

    Returns
    -------
    Runs

    Raises
    ------
    SomersaultError
        Naming the key, for what does not fit.
    """
    file = file_path("the SPEC", path)
    return parse_runs(read_toml(file), file.parent)


def parse_runs(given: Mapping[str, Any], beside: Path) -> Runs:
    """The run in a SPEC's tables.

    Parameters
    ----------
    given : mapping
        As TOML has it.
    beside : pathlib.Path
        The folder in which the robot's file is looked for.

    Returns
    -------
    Runs

    Raises
    ------
    SomersaultError
        Naming the key, for what does not fit.
    """
    require_table(given)
    folder = file_path("beside", beside)
    if "robot" not in given:
        raise SomersaultError('robot is missing; a SPEC of a run has robot = "biped", or a file')
    for table in ("vary", "sample"):
        if table in given:
            raise SomersaultError(
                f"[{table}] is of a SPEC of many runs; give it to somersault ensemble"
            )
    tables = _over(_numbers(given), given)
    tables["robot"] = _found(tables["robot"], folder)
    keys = structured(tables, Keys)
    control = Control(**{table.name: getattr(keys, table.name) for table in fields(Control)})
    return Runs(keys.robot, control, keys.duration)


def _numbers(given: Mapping[str, Any]) -> Control:
    """Those that a SPEC's tables change."""
    if "maneuver" in given:
        return maneuver(given["maneuver"])
    robot = given["robot"]
    model = robot.get("model") if isinstance(robot, Mapping) else robot
    return usual(model) if isinstance(model, str) else Control()


def _over(numbers: Control, given: Mapping[str, Any]) -> dict[str, Any]:
    """A SPEC's tables, with those numbers of a maneuver that they do not have."""
    tables = dict(given)
    for table, of_maneuver in asdict(numbers).items():
        own = tables.get(table, {})
        tables[table] = {**of_maneuver, **own} if isinstance(own, Mapping) else own
    return tables


def _found(robot: Any, beside: Path) -> Any:
    """The robot's table, with its file beside the SPEC."""
    table = {"model": robot} if isinstance(robot, str) else robot
    if not isinstance(table, Mapping):
        raise SomersaultError(f"robot must be a name, a file or a table, and is {shown(robot)}")
    return {**table, "model": model_beside(table["model"], beside)} if "model" in table else table


def _hip(value: Any, _: Any) -> tuple[str, str, str]:
    names = structured_within(value, tuple[str, ...])
    if len(names) != 3:
        raise Unfit("the names of three joints", value)
    return names


read_as(tuple[str, str, str], _hip)
