"""One run of a robot, as a history."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import file_path, instance, text, whole_number
from somersault._core.datasets import save_history
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault._core.stages import stage
from somersault.attitude import unwrapped_angles
from somersault.history import summary
from somersault.model import Model
from somersault.robot._control import Control
from somersault.robot._controller import REMEMBERED
from somersault.robot._maneuvers import usual
from somersault.robot._robot import PERIOD, SENSORS, Robot
from somersault.robot._runs import ENDINGS, Runs, reported
from somersault.simulation import ENDED
from somersault.view import Filmed

if TYPE_CHECKING:
    import xarray as xr

SAMPLES = 200
"""Of a second, unless another number is asked for."""


@dataclass(frozen=True)
class Event:
    """A state that began.

    Attributes
    ----------
    time : float
        s.
    state : str
        "hurdle", "tuck" …
    """

    time: float
    state: str


@dataclass(frozen=True, eq=False)
class Run(Filmed):
    """One run, as `run` returns it. It is a `somersault.history.History`.

    Attributes
    ----------
    robot : Robot
    model : Model
        Of its bodies, with their shapes.
    times : ndarray, (T,)
        s.
    positions, rates : ndarray
        MuJoCo's, (T, nq) and (T, nv).
    sensed : ndarray, (T, 14)
        Centre of mass and its velocity, and of each foot its place and the force on it.
    kept : mapping of str to ndarray, (T,)
        What the controller remembers, by name.
    drive : ndarray, (T, nu)
        What the actuators are told.
    outcome : mapping of str to float
        What an ensemble reports of a run, by name.
    ended : str
        "ran on", "time over", "fell landing" …
    events : tuple of Event
        The states that it was in, one after another.
    """

    robot: Robot
    model: Model
    times: Array
    positions: Array
    rates: Array
    sensed: Array
    kept: Mapping[str, Array]
    drive: Array
    outcome: Mapping[str, float]
    ended: str
    events: tuple[Event, ...]

    def __repr__(self) -> str:
        return f"{summary(self)}, {self.ended}"

    @property
    def base_position(self) -> Array:
        """Of the torso's frame, m, (T, 3)."""
        return self.positions[:, :3]

    @property
    def base_quaternion(self) -> Array:
        """Scalar first, torso to inertial, (T, 4)."""
        return self.positions[:, 3:7]

    @cached_property
    def joint_coordinates(self) -> Array:
        """In the order of `model.coordinates`, (T, coordinates)."""
        m = self.robot.machine.mujoco
        columns = [int(m.joint(name).qposadr[0]) for name in self.model.coordinates]
        return self.positions[:, columns]

    @cached_property
    def angles(self) -> Array:
        """Somersault, tilt and twist, unwrapped, rad, (T, 3)."""
        return unwrapped_angles(self.base_quaternion, self.model.axes)

    @property
    def fell(self) -> bool:
        """Whether the robot fell."""
        return self.ended in ("some steps", "fell landing", "fell before")

    @property
    def speed(self) -> Array:
        """Forwards, of the centre of mass, along the heading that was wanted, m/s, (T,)."""
        heading = self.kept["heading"]
        return self.sensed[:, 3] * np.cos(heading) + self.sensed[:, 4] * np.sin(heading)

    def began(self, state: str) -> float:
        """When a state first began.

        Parameters
        ----------
        state : str

        Returns
        -------
        float
            s; NaN where it never did.
        """
        wanted = text("state", state)
        return next((e.time for e in self.events if e.state == wanted), float("nan"))

    @cached_property
    def dataset(self) -> xr.Dataset:
        """The history as a labelled dataset over `time`."""
        import xarray as xr

        angles, rad = self.angles, {"units": "rad"}
        joints = self.model.coordinates
        m = self.robot.machine.mujoco
        actuators = [m.actuator(k).name for k in range(m.nu)]
        return xr.Dataset(
            {
                "somersault": ("time", angles[:, 0], rad),
                "tilt": ("time", angles[:, 1], rad),
                "twist": ("time", angles[:, 2], rad),
                "quaternion": (("time", "component"), self.base_quaternion, {"units": "1"}),
                "joint_angle": (("time", "joint"), self.joint_coordinates, {"units": "rad or m"}),
                "base_position": (
                    ("time", "inertial_axis"), self.base_position, {"units": "m"},
                ),
                "angular_velocity": (
                    ("time", "body_axis"), self.rates[:, 3:6], {"units": "rad/s"},
                ),
                "speed": ("time", self.speed, {"units": "m/s"}),
                "drive": (("time", "actuator"), self.drive, {"units": "N m or m"}),
                "state": ("time", self.kept["state"].astype("i4"), {"units": "1"}),
            },
            {
                "time": ("time", self.times, {"units": "s"}),
                "component": list("wxyz"), "body_axis": [1, 2, 3], "inertial_axis": [1, 2, 3],
                "joint": list(joints), "actuator": actuators,
            },
            {"model": self.model.name, "axes": list(self.model.axes), "ended": self.ended},
        )  # fmt: skip

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the history to a file, whole or not at all.

        Parameters
        ----------
        path : path-like
            A NetCDF file (.nc), which `somersault.read_recording` reads, or a table (.csv).

        Raises
        ------
        SomersaultError
            For a file of another kind.
        """
        save_history(self.dataset, path)


def run(
    robot: str | os.PathLike[str] | Robot = "biped",
    duration: float = 10.0,
    control: Control | None = None,
    *,
    flip: float | None = None,
    samples: int = SAMPLES,
) -> Run:
    """Run a robot, and let it somersault on the way.

    Parameters
    ----------
    robot : str, path or Robot
        "biped", a file of a robot whose parts are called like its, or a `Robot`.
    duration : float
        s; less where the robot falls.
    control : Control, optional
        The numbers of its controller; those of `usual` by default.
    flip : float, optional
        When it is to somersault, s: the first step after that is the hurdle.
    samples : int
        In a second, at most 1000.

    Returns
    -------
    Run

    Raises
    ------
    SomersaultError
        For a robot that cannot run; one that falls is a result.

    Examples
    --------
    >>> from somersault.robot import run
    >>> short = run("biped", duration=1.0)
    >>> short.fell, short.events[1].state
    (False, 'compression')
    """
    chosen = robot if isinstance(robot, Robot) else Robot(str(file_path("robot", robot)))
    if control is None:
        control = usual(chosen.model)
    numbers = instance("control", control, Control)
    if flip is not None:
        numbers = replace(numbers, flip=replace(numbers.flip, at=number("flip", flip)))
    return run_of(Runs(chosen, numbers, duration), samples)


def run_of(runs: Runs, samples: int = SAMPLES) -> Run:
    """The nominal one of some runs.

    Parameters
    ----------
    runs : Runs
    samples : int
        In a second, at most 1000.

    Returns
    -------
    Run

    Raises
    ------
    SomersaultError
        For a robot that cannot run.
    """
    instance("runs", runs, Runs)
    each = whole_number("samples", samples, 1, round(1 / PERIOD))
    if round(1 / PERIOD) % each:
        raise SomersaultError(f"samples must divide 1000, and are {each}; give 200, say")
    every = round(1 / PERIOD) // each
    m = runs.robot.machine.mujoco
    row = np.array(list(runs.values.values()))
    with stage("compiling the controller"):
        runs.controller.loop.compile()
    with stage("running"):
        (lane,), (record,) = runs.carried_out(row[None], every)
    widths = [m.nq, m.nv, SENSORS, len(REMEMBERED), len(row), m.nu]
    parts = np.split(record, np.cumsum(widths), axis=1)
    kept = dict(zip(REMEMBERED, parts[3].T, strict=True))
    end = {name: np.array([x]) for name, x in zip(REMEMBERED, lane.kept, strict=True)}
    outcome = reported(end)
    ended = ENDINGS.words[int(outcome.pop(ENDED)[0])]
    return Run(
        runs.robot, runs.robot.machine.model, kept["clock"], parts[0], parts[1], parts[2], kept,
        parts[5], {name: float(x[0]) for name, x in outcome.items()}, ended,
        _events(runs, kept),
    )  # fmt: skip


def _events(runs: Runs, kept: Mapping[str, Array]) -> tuple[Event, ...]:
    """When each state began: the clock less how long it has lasted."""
    codes = kept["state"].astype(int)
    first = np.flatnonzero(np.diff(codes, prepend=-1))
    began = kept["clock"] - kept["since"]
    return tuple(Event(float(began[k]), runs.controller.names[codes[k]]) for k in first)
