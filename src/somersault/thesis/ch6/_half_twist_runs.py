"""Runs of the 3D Biped with a weight, of which chapter 6 makes its figures."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import xarray as xr

from somersault.ensembles import ensemble
from somersault.robot import End, Plant, Robot, Run, Runs, maneuver, run
from somersault.thesis.ch3._scatter import HELD_OUT, RUN_ON, scatter

ROBOT = "biped_weighted"
AT = 3.0
"""When the somersault is to begin, s."""

BACKWARDS = 45.0
"""Degrees from facing backwards within which a landing counts as one with half a twist."""


@cache
def nominal() -> Run:
    """A half twist in which nothing goes wrong, each millisecond of it."""
    return run(ROBOT, 18.0, maneuver("half_twist"), flip=AT, samples=1000)


@cache
def weak() -> Run:
    """The same with the hips of the robot in the laboratory."""
    control = maneuver("half_twist")
    strong, own = (Robot(name).machine.address_of["left"].limits for name in (ROBOT, "biped"))
    plant = Plant(torque=max(a / b for a, b in zip(own, strong, strict=True)))
    return run(ROBOT, 12.0, replace(control, plant=plant), flip=AT)


def attempts() -> Runs:
    """Attempts of a half twist, like those of a somersault in chapter 3."""
    control = maneuver("half_twist")
    flip = replace(control.flip, at=AT)
    return Runs(Robot(ROBOT), replace(control, flip=flip, end=End(steps_after=RUN_ON)), 24.0)


@cache
def held_out(size: int) -> xr.Dataset:
    """Attempts on starts, and with errors, that the controller was not tuned on."""
    return ensemble(attempts(), vary=scatter(), size=size, seed=HELD_OUT).dataset
