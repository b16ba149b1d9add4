"""Robots that run and flip, on the ground of MuJoCo: a controller of named states, compiled."""

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
from somersault.robot._controller import Controller
from somersault.robot._leg import Leg
from somersault.robot._maneuvers import MANEUVERS, maneuver, usual
from somersault.robot._robot import Machine, Robot
from somersault.robot._run import Event, Run, run, run_of
from somersault.robot._runs import Runs
from somersault.robot._spec import KEYS, parse_runs, read_runs
from somersault.robot._states import Exit, Now, State
from somersault.robot._twist import Twist
from somersault.robot._units import similar, unit

__all__ = [
    "KEYS",
    "MANEUVERS",
    "Change",
    "Control",
    "Controller",
    "End",
    "Errors",
    "Event",
    "Exit",
    "Flip",
    "Hips",
    "Leg",
    "Machine",
    "Now",
    "Plant",
    "Push",
    "Robot",
    "Run",
    "Running",
    "Runs",
    "Start",
    "State",
    "Twist",
    "maneuver",
    "parse_runs",
    "read_runs",
    "run",
    "run_of",
    "similar",
    "unit",
    "usual",
]
