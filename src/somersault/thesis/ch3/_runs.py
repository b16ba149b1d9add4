"""Runs of the 3D Biped that several figures show."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from somersault.robot import Control, Errors, Flip, Run, Running, run

FLIP = 3.0
"""When the somersault is to begin: the first step after that is the hurdle, s."""

OVER = Errors(torque=0.16, lift_off_speed=0.04)
"""What goes wrong in the over-rotated somersault of figure 3-7."""


@cache
def nominal() -> Run:
    """A somersault in which nothing goes wrong, each millisecond of it."""
    return run("biped", 15.0, flip=FLIP, samples=1000)


@cache
def over_rotated() -> Run:
    """One that turns too fast for its tuck servo."""
    return run("biped", 12.0, Control(errors=OVER), flip=FLIP, samples=1000)


@cache
def running() -> Run:
    """Running for thirty seconds."""
    return run("biped", 30.0)


@cache
def at_speed(speed: float) -> Run:
    """Running at another speed."""
    return run("biped", 12.0, Control(running=Running(speed=speed)))


@cache
def with_flip(**numbers: float) -> Run:
    """The nominal somersault with other numbers of [flip]."""
    return run("biped", 12.0, Control(flip=replace(Flip(), **numbers)), flip=FLIP)
