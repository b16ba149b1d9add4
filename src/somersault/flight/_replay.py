"""A replay rate by a law: how fast paths and the motor tape are played, by what is sensed.

After Playter (1994), section 7.3: "a simple active controller that changed the replay rate of a set
of pre-recorded actions based on perceived errors".
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from somersault._core.errors import SomersaultError
from somersault._core.numbers import MOST, numbers
from somersault.flight.behaviours import Law, checked_all, checked_times, quantity


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
        of the takeoff itself, in an ensemble that of the takeoff of which numbers are varied.
        `Maneuver.replayed` and `off_nominal` give them.

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
        for name, value in checked_times(self, "replay").items():
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
