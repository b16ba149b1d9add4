"""A replay rate by a law: how fast paths and the motor tape are played, by what is sensed.

After Playter (1994), section 7.3: "a simple active controller that changed the replay rate of a set
of pre-recorded actions based on perceived errors".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import MOST, numbers
from somersault.engine import CLOCK, clock_at
from somersault.flight._watch import ANGLES, RATES
from somersault.flight.behaviours import (
    Law,
    Senses,
    between,
    bounded,
    checked_all,
    declared,
    quantity,
    side_by_side,
)
from somersault.laws import Formula
from somersault.simulation import Name, Numbers

ERRORS = {f"{name}_error": name for name in (*ANGLES, *RATES)}
"""What is sensed of the body, less what it was in the nominal flight at the same phase."""
_BOUNDS = ("least", "most", "most_acceleration")


@dataclass(frozen=True)
class Replay(Law):
    """How fast the paths of joints and the motor tape are played, by a law.

    The time of paths and tape is the `phase` (s), which is 0 at takeoff and goes at the rate that
    the law says, 1 being that of the clock. Between two ticks its acceleration is constant: the one
    that brings it to that rate by the next tick, as far as the bounds allow; so joints that are
    prescribed have no jumps in their rates. The law is worked out, and acts, as that of
    `JointTakeoff.rate_law`. It also senses `phase`, `phase_rate` and errors: `somersault_error`,
    `tilt_error`, `twist_error` (rad) and `somersault_rate_error` … (rad/s), what is sensed less
    what it was at the same phase in the nominal flight, in which paths are followed exactly and
    played at the rate of the clock.

    Parameters
    ----------
    law : str
        Such as "1 + k * twist_error".
    gains : mapping of str to float
        Of the law, by name.
    noise : mapping of str to float
        Standard deviations with which quantities are sensed, by name; an error is one of them.
    every : float
        s between ticks; the first is at takeoff.
    delay : float
        s until a command is acted on, a whole number of ticks. Before that the rate stays.
    rate : float
        At takeoff.
    least, most : float
        The rate is never below or above; above 0.
    most_acceleration : float
        Of the phase, 1/s.
    nominal_angles : sequence of float, (3,), optional
        Somersault, tilt and twist (rad) at takeoff of the nominal flight.
    nominal_momentum : sequence of float, (3,), optional
        Its angular momentum (inertial axes, kg m²/s). Without these two the nominal flight is that
        of the takeoff itself, in an ensemble that of the takeoff of which numbers are varied;
        `off_nominal` keeps the one that there was.

    Raises
    ------
    SomersaultError
        For what is no such law, and for bounds that leave no rate.

    Examples
    --------
    >>> import somersault as so
    >>> late = so.Replay(law="1 + k * twist_error", gains={"k": 0.5}, delay=0.1)
    >>> late.waits
    5
    """

    rate: float = quantity("1", default=1.0)
    least: float = quantity("1", default=0.5)
    most: float = quantity("1", default=2.0)
    most_acceleration: float = quantity("1/s", default=MOST, least=0.0)
    nominal_angles: Sequence[float] | None = None
    nominal_momentum: Sequence[float] | None = None

    def __post_init__(self) -> None:
        changes = checked_all("replay", self)
        for name in ("nominal_angles", "nominal_momentum"):
            given = getattr(self, name)
            if given is not None:
                changes[name] = tuple(numbers(f"replay: {name}", given, 3).tolist())
        for name, value in changes.items():
            object.__setattr__(self, name, value)
        for name, value in self.checked_times("replay").items():
            object.__setattr__(self, name, value)
        if (self.nominal_angles is None) != (self.nominal_momentum is None):
            raise SomersaultError(
                "replay has one of nominal_angles and nominal_momentum; give both, or neither"
            )
        if not 0 < self.least <= self.rate <= self.most:
            raise SomersaultError(
                f"replay begins at the rate {self.rate:g} and is bounded by least = {self.least:g} "
                f"and most = {self.most:g}; give 0 < least <= rate <= most"
            )

    def kind(self) -> Replay:
        """The same without its numbers: flights of one kind share their equations.

        Returns
        -------
        Replay
        """
        return Replay(law=self.law, every=self.every, delay=self.delay, **self.empty_tables)

    @property
    def errors(self) -> tuple[str, ...]:
        """The errors that its law has."""
        return tuple(name for name in ERRORS if name in Formula(self.law).names)

    # --------------------------------------------------------------------------- numbers

    @property
    def numbers(self) -> dict[Name, float | Array]:
        """Those that may differ between flights, by names such as ("replay", "gains", "k")."""
        result: dict[Name, float | Array] = {}
        for name in declared(self):
            value = getattr(self, name)
            if isinstance(value, Mapping):
                result |= {("replay", name, key): x for key, x in value.items()}
            else:
                result["replay", name] = value
        return result

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of its numbers in equations."""
        return (*self.tables, *_BOUNDS)

    def lasting(self, values: Numbers, count: int) -> Array:
        """Numbers of `parameters`.

        Parameters
        ----------
        values : mapping of tuple to float or ndarray, (count,)
            The numbers of the flights.
        count : int
            How many flights.

        Returns
        -------
        ndarray, (count, parameters)
        """
        names: list[Name] = [("replay", *name.split(".", 1)) for name in self.parameters]
        return side_by_side(values, names, count)

    def sound(self, values: Numbers, count: int) -> Array:
        """Whether the numbers of each flight are such as could be asked for by themselves.

        Parameters
        ----------
        values, count
            As for `lasting`.

        Returns
        -------
        ndarray of bool, (count,)
        """
        names: list[Name] = [("replay", name) for name in ("rate", *_BOUNDS)]
        rate, least, most, acceleration = side_by_side(values, names, count).T
        return (least > 0) & (least <= rate) & (rate <= most) & (acceleration >= 0)

    # ----------------------------------------------------------------------------- ticks

    @property
    def carried(self) -> int:
        """How many numbers it carries from tick to tick: the phase as a clock, and the commands
        that wait."""
        return CLOCK + self.waits

    def at_takeoff(self, values: Numbers, count: int) -> Array:
        """What it carries before the first tick.

        Parameters
        ----------
        values, count
            As for `lasting`.

        Returns
        -------
        ndarray, (count, carried)
        """
        first = np.zeros((count, self.carried))
        rate = np.broadcast_to(values["replay", "rate"], count)
        first[:, 2] = rate
        first[:, CLOCK:] = rate[:, None]
        return first

    def tick(
        self, carried: Sequence[Any], time: Any, numbers: Mapping[str, Any], senses: Senses
    ) -> list[Any]:
        """What it carries from a tick on.

        Parameters
        ----------
        carried : sequence of casadi.SX, (carried,)
        time : casadi.SX
        numbers : mapping of str to casadi.SX
            Of its `parameters`.
        senses : Senses

        Returns
        -------
        list of casadi.SX, (carried,)
        """
        command = self.command("replay", numbers, senses)
        wanted, *waiting = [*carried[CLOCK:], command]
        phase, rate, _ = clock_at(carried[:CLOCK], time)
        by = between(wanted, numbers["least"], numbers["most"]) - rate
        return [time, phase, rate, bounded(by / self.every, numbers["most_acceleration"]), *waiting]


def pinned(
    replay: Replay | None, angles: Sequence[float], momentum: Sequence[float]
) -> Replay | None:
    """A replay whose nominal flight takes off so, unless it has one."""
    if replay is None or replay.nominal_angles is not None:
        return replay
    return replace(replay, nominal_angles=tuple(angles), nominal_momentum=tuple(momentum))
