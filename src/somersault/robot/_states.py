"""States, each with a name, what it commands, and the conditions on which it ends."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from somersault.robot._commands import Command
from somersault.robot._control import Symbolic
from somersault.robot._robot import Machine
from somersault.robot._sensed import Sensed, SensedLeg


@dataclass(frozen=True)
class Now:
    """All that a state may look at.

    Parameters
    ----------
    sensed : Sensed
        The robot.
    kept : mapping
        What was remembered, by name.
    control : Symbolic
        The numbers of the controller.
    machine : Machine
    since : expression
        How long the state has lasted, s.
    clock : expression
        Time since the start, s.
    shortest, longest : float
        Lengths of the legs, m.
    """

    sensed: Sensed
    kept: Mapping[str, Any]
    control: Symbolic
    machine: Machine
    since: Any
    clock: Any
    shortest: float
    longest: float

    def is_active(self, leg: SensedLeg) -> Any:
        """Whether it is the leg whose turn it is."""
        return self.kept["side"] == leg.side


@dataclass(frozen=True)
class Exit:
    """When a state ends, which follows, and what is remembered from then on."""

    when: Any
    to: str
    keep: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class State:
    """What a robot does for a while.

    Parameters
    ----------
    name : str
        "tuck".
    step : str
        Of Table 3.2: "approach", "hurdle", "flip", "landing", "following".
    commands : callable
        Of `Now`: a `Command` for the left leg and one for the right.
    exits : callable
        Of `Now`: an `Exit` for each way in which it can end, the first that holds being taken.
    keeps : callable, optional
        Of `Now`: what is remembered anew in every period, by name.
    """

    name: str
    step: str
    commands: Callable[[Now], Sequence[Command]]
    exits: Callable[[Now], Sequence[Exit]]
    keeps: Callable[[Now], Mapping[str, Any]] = lambda now: {}
