"""A law of sensed quantities: what everything that follows one shares."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import casadi as ca

from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._sensing import Senses
from somersault.laws import Formula

_MOST_TICKS_OF_DELAY = 1_000
_NEARLY = 1e-9  # of a tick
_NO_TABLE = _declared.Table()


@dataclass(frozen=True)
class Law:
    """A `law`: a formula (`somersault.laws.Formula`) of what is sensed, by name.

    Sensed are somersault, tilt, twist (rad; whole turns are counted), their rates
    (`twist_rate` …), the angular velocity about the body's axes (`angular_velocity_1` …), joint
    coordinates and their rates by name, and `time`; where a replay rate has a law, `phase` and
    `phase_rate` too. Other names are `gains`. The law is worked out
    `every` so many seconds from takeoff on, and acts after its `delay`, which is a whole number of
    them; before that it commands nothing. `noise` gives the standard deviation with which
    a quantity is sensed, by its name; the deviates are those of the takeoff's `noise`.
    """

    law: str = field(default="", kw_only=True, metadata={"structure": True})
    gains: Mapping[str, float] = _declared.quantity("1", default=_NO_TABLE, table=True)
    noise: Mapping[str, float] = _declared.quantity("1", default=_NO_TABLE, table=True)
    every: float = field(default=0.02, kw_only=True, metadata={"structure": True})
    delay: float = field(default=0.0, kw_only=True, metadata={"structure": True})

    @property
    def tables(self) -> tuple[str, ...]:
        """Names of its gains and noise among the parameters of equations: "gains.k" …"""
        named = {"gains": self.gains, "noise": self.noise}
        return tuple(f"{what}.{key}" for what, table in named.items() for key in table)

    @property
    def empty_tables(self) -> dict[str, Any]:
        """Its gains and noise without their numbers, as fields."""
        both = {"gains": self.gains, "noise": self.noise}
        return {what: _declared.Table(dict.fromkeys(table, 0.0)) for what, table in both.items()}

    @property
    def waits(self) -> int:
        """Ticks between sensing and acting."""
        return round(self.delay / self.every)

    @property
    def noisy(self) -> bool:
        """Whether it senses with noise."""
        return bool(self.noise)


def checked_times(law: Law, where: str) -> dict[str, Any]:
    """The times of a law as floats, after a look at the whole of it.

    Parameters
    ----------
    law : Law
        Its gains and noise are numbers.
    where : str
        What a message says has the law.

    Returns
    -------
    dict of str to float
        By their names.

    Raises
    ------
    SomersaultError
        For what is no such law.
    """
    every, delay = (number(f"{where}: {n}", getattr(law, n)) for n in ("every", "delay"))
    _check_times(where, every, delay)
    names = Formula(law.law).names
    idle = sorted(set(law.gains) - names)
    if idle:
        raise SomersaultError(
            f"{where} has the gain {idle[0]}, which its law {law.law!r} does not have; "
            "correct one of them"
        )
    for name, deviation in law.noise.items():
        if name in law.gains:
            raise SomersaultError(
                f"{where} has noise of {name}, which is a gain and not sensed; leave it out"
            )
        if deviation < 0:
            raise SomersaultError(
                f"{where} senses {name} with the standard deviation {deviation:g}; give 0 or more"
            )
    silent = sorted(set(law.noise) - names)
    if silent:
        raise SomersaultError(
            f"{where} senses {silent[0]} with noise, but its law {law.law!r} does not have "
            "it; leave it out"
        )
    return {"every": every, "delay": delay}


def commanded(law: Law, where: str, numbers: Mapping[str, Any], senses: Senses) -> Any:
    """What a law says of what is sensed now.

    Parameters
    ----------
    law : Law
    where : str
        What a message says has the law.
    numbers : mapping of str to casadi.SX
        Of its `tables`.
    senses : Senses

    Returns
    -------
    casadi.SX

    Raises
    ------
    SomersaultError
        For a gain that has the name of something that is sensed.
    """
    known = dict(senses.known)
    for name in law.gains:
        if name in known:
            raise SomersaultError(
                f"{where} has a gain {name}, which is also something that is sensed; give the "
                "gain another name"
            )
        known[name] = numbers[f"gains.{name}"]
    for name in law.noise:
        known[name] = known[name] + numbers[f"noise.{name}"] * senses.normal()
    return Formula(law.law).value(known)


def bounded(value: Any, most: Any) -> Any:
    """A number that is not beyond ±most; one that is none stays so.

    Parameters
    ----------
    value, most : casadi.SX or float

    Returns
    -------
    casadi.SX
    """
    return between(value, -most, most)


def between(value: Any, low: Any, high: Any) -> Any:
    """A number that is not below `low` nor above `high`; one that is none stays so.

    Parameters
    ----------
    value, low, high : casadi.SX or float

    Returns
    -------
    casadi.SX
    """
    return ca.if_else(value > high, high, ca.if_else(value < low, low, value))


def _check_times(where: str, every: float, delay: float) -> None:
    if every <= 0:
        raise SomersaultError(f"{where} senses every {every:g} s; give a time above 0")
    if delay < 0:
        raise SomersaultError(f"{where} has a delay of {delay:g} s; give 0 or more")
    ticks = delay / every
    if ticks > _MOST_TICKS_OF_DELAY:
        raise SomersaultError(
            f"{where} has a delay of {ticks:.0f} ticks; make it shorter, or sense less often"
        )
    if abs(ticks - round(ticks)) > _NEARLY * max(ticks, 1.0):
        raise SomersaultError(
            f"{where} has a delay of {delay:g} s, which is no whole number of the {every:g} s "
            "between its ticks; change one of them"
        )
