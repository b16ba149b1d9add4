"""What an ensemble needs of anything that can be run many times with different numbers.

A flight is one such thing and a robot's attempt another. An ensemble knows of them only what stands
here: the numbers that a run takes, what it reports, how it can end, and how many are run at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np

from somersault._core.array import Array

Name = tuple[str | int, ...]
"""Of one number that a run takes: ("takeoff", "tilt"), ("angle", "left_shoulder") …"""

Numbers = Mapping[Name, "float | Array"]
"""The numbers of N runs, each one for all of them or an array (N,)."""

ENDED = "ended"
"""The variable that says how a run ended, as a code of the simulation's `Endings`."""

LANDING_ERROR = "landing_error"
"""The variable, in rad, that a tolerance is for, where a simulation reports one."""

NOT_RUN = 255
"""The code in `ENDED` of a run that is still to come."""


@dataclass(frozen=True)
class Target:
    """A number that becomes factor · value + offset, or to which factor · value is added.

    Parameters
    ----------
    name : tuple
        Which number.
    factor, offset : float
        A mirrored joint has a factor of −1, for one.
    unit : str, optional
        Of the number; None where it only goes along with another, as the moments of inertia of a
        body go along with its mass.
    """

    name: Name
    factor: float = 1.0
    offset: float = 0.0
    unit: str | None = None


@dataclass(frozen=True)
class Variable:
    """Something that is reported of each run.

    Parameters
    ----------
    unit : str
        "rad", "kg m2/s" …; "1" for what has none.
    dtype : {"f8", "i4", "u1"}
        "f8" for numbers, "i4" for counts, "u1" for codes.
    over_time : bool
        Whether it is an array over the simulation's `times`.
    words : str
        What it is, in words.
    """

    unit: str
    dtype: str = "f8"
    over_time: bool = False
    words: str = ""

    @property
    def fill(self) -> float | int:
        """What stands in the place of a run that is still to come, or could not begin."""
        return {"f8": np.nan, "u1": NOT_RUN}.get(self.dtype, 0)


@dataclass(frozen=True)
class Endings:
    """How a run can end. A code of `ENDED` is a place in `words`.

    Parameters
    ----------
    words : tuple of str
        All endings, at most 255 of them.
    failed : tuple of str
        Those that leave no result: such runs are counted, and never averaged over. A robot that
        falls has not failed in this sense.
    unsound : str
        The one, among `failed`, of a run that cannot begin with the numbers it is given.
    good : tuple of str
        Those in which what was attempted came off, where runs are attempts.
    called : str
        What many of them are called: "flights", "runs" …
    """

    words: tuple[str, ...]
    failed: tuple[str, ...]
    unsound: str
    good: tuple[str, ...] = ()
    called: str = "runs"

    def code(self, word: str) -> int:
        """The code of an ending."""
        return self.words.index(word)


@runtime_checkable
class Simulation(Protocol):
    """Anything that can be run many times with different numbers.

    A value, which may be pickled: workers on other machines are sent it. The numbers of a run must
    depend on nothing but the numbers it is given, not on how many are run at once or on how many
    threads, so that an ensemble is the same bit for bit however it is carried out.
    """

    @property
    def name(self) -> str:
        """Of what is run: a model's name."""

    @property
    def packages(self) -> tuple[str, ...]:
        """The installed packages whose versions decide the last digits."""

    @property
    def specification(self) -> Mapping[str, Any]:
        """All that decides the numbers, as plain data (`_core.canonical`)."""

    @property
    def values(self) -> Numbers:
        """The nominal numbers, before anything is varied."""

    @property
    def variables(self) -> Mapping[str, Variable]:
        """What is reported of each run besides `ENDED`."""

    @property
    def times(self) -> Array:
        """The times, in s, of what is reported over time, (K,); none where nothing is."""

    @property
    def endings(self) -> Endings:
        """How a run can end."""

    @property
    def together(self) -> int:
        """How many runs are best held in memory at once."""

    def targets(self, path: str) -> tuple[Target, ...]:
        """The numbers that a name like "takeoff.tilt" or "joints.shoulder.stiffness" means.

        Raises
        ------
        SomersaultError
            For a name that is not there, with those that are.
        """

    def with_varied(self, names: tuple[Name, ...]) -> Simulation:
        """The same simulation, for runs that differ in these numbers."""

    def sound(self, values: Numbers, count: int) -> Array:
        """Whether each of `count` runs can begin, (count,)."""

    def run(self, values: Numbers, count: int) -> Mapping[str, Array]:
        """The `variables` of `count` runs, each (count,) or over time (count, K), and `ENDED`.

        All of them are sound. It may use `engine.threads()` threads.
        """
