"""What is chosen in a design, and which numbers that moves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance, name_list, one_of, shown, text
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number, numbers
from somersault.ensembles import check_name
from somersault.simulation import Name, Simulation

FIGURE = "figure"
"""What an objective's figure is called where it is reported."""

_SCALES = ("linear", "log")


@dataclass(frozen=True)
class Choose:
    """One quantity that a design chooses, and the numbers that it moves.

    Where a function makes what is run, a quantity that moves no number is given to that function.

    Parameters
    ----------
    between : (low, high)
        Its bounds.
    sets, adds_to : str or sequence of str
        The numbers that it sets, or is added to, by names as in `Vary`. A name of a joint's number
        may have a * for joints alike: "joints.*shoulder*.stiffness".
    multiplies : str, sequence of str, or mapping of str to float
        The numbers that are multiplied by it, each by a power of it where a mapping gives one: a
        natural frequency goes into stiffness with the power 2 and into damping with 1.
    start : float, optional
        Where the search begins; by default in the middle.
    scale : {"linear", "log"}
        How it is searched; "log" for what may be many times more or less.
    unit : str

    Examples
    --------
    >>> import somersault as so
    >>> powers = {"joints.shoulder.stiffness": 2, "joints.shoulder.damping": 1}
    >>> frequency = so.Choose(between=(0.3, 3.0), multiplies=powers, scale="log")
    >>> round(float(frequency.value(0.5)), 3)
    0.949
    """

    between: Sequence[float] = ()
    sets: str | Sequence[str] = ()
    adds_to: str | Sequence[str] = ()
    multiplies: str | Sequence[str] | Mapping[str, float] = ()
    start: float | None = None
    scale: Literal["linear", "log"] = "linear"
    unit: str = ""

    def checked(self, name: str, given: bool = False) -> Choose:
        """The same, if it makes sense.

        Parameters
        ----------
        name : str
            What it is called, for what is refused.
        given : bool
            Whether a function is given what moves no number.

        Returns
        -------
        Choose

        Raises
        ------
        SomersaultError
            For empty bounds, for what moves no number, and for what can be no name.
        """
        where = f"choose.{name}"
        check_name("choose", name)
        if name == FIGURE:
            raise SomersaultError(f"{where}: that name is taken; call the quantity otherwise")
        instance(where, self, Choose)
        text(f"{where}.unit", self.unit)
        one_of(f"{where}.scale", self.scale, _SCALES)
        bounds = numbers(f"{where}.between", self.between)
        if bounds.shape != (2,) or not bounds[0] < bounds[1]:
            raise SomersaultError(
                f"{where}.between must be two numbers, low below high, and is {shown(self.between)}"
            )
        low, high = bounds.tolist()
        if self.scale == "log" and low <= 0:
            raise SomersaultError(
                f"{where} is searched on a log scale from {low:g}; begin above 0, or search it on "
                "a linear one"
            )
        if not self.moves and not given:
            raise SomersaultError(
                f"{where} moves no number; say what it sets, adds_to or multiplies, by names like "
                "'joints.shoulder.stiffness'"
            )
        for path, power in self.powers.items():
            number(f"{where}.multiplies.{path}", power)
        start = self.start
        if start is not None and not low <= number(f"{where}.start", start) <= high:
            raise SomersaultError(f"{where} starts at {start:g}, outside {low:g} to {high:g}")
        return self

    @property
    def powers(self) -> dict[str, float]:
        """The power with which each number is multiplied by it."""
        if isinstance(self.multiplies, Mapping):
            return dict(self.multiplies)
        return dict.fromkeys(_names("multiplies", self.multiplies), 1.0)

    @property
    def moves(self) -> list[tuple[str, str, float]]:
        """How it moves each number: "sets", "adds" or "multiplies", its name, and the power."""
        plain = [("sets", path, 1.0) for path in _names("sets", self.sets)]
        plain += [("adds", path, 1.0) for path in _names("adds_to", self.adds_to)]
        return plain + [("multiplies", path, power) for path, power in self.powers.items()]

    def value(self, part: Any) -> Any:
        """Its value at a part of the way from the lower bound to the upper.

        Parameters
        ----------
        part : float or ndarray
            0 to 1.

        Returns
        -------
        float or ndarray
        """
        low, high = (float(x) for x in self.between)
        if self.scale == "log":
            return low * (high / low) ** part
        return low + (high - low) * part

    def part(self, value: float) -> float:
        """Where on its way a value is: the inverse of `value`.

        Parameters
        ----------
        value : float

        Returns
        -------
        float
        """
        low, high = (float(x) for x in self.between)
        if self.scale == "log":
            return float(np.log(value / low) / np.log(high / low))
        return (value - low) / (high - low)

    @property
    def begins(self) -> float:
        """Where the search begins, as a part of the way."""
        return 0.5 if self.start is None else self.part(self.start)


@dataclass(frozen=True)
class Move:
    """How a chosen quantity moves one number of a simulation."""

    how: str
    name: Name
    factor: float
    offset: float
    power: float

    def of(self, value: Array, before: Any) -> Any:
        """The number, for values of the quantity, where it was `before`."""
        if self.how == "multiplies":
            return before * value**self.power
        by = self.factor * value
        return before + by if self.how == "adds" else by + self.offset


def moves_of(simulation: Simulation, name: str, chosen: Choose) -> tuple[Move, ...]:
    """The numbers of a simulation that a chosen quantity moves; SomersaultError, naming it, for a
    number that is not there."""
    try:
        return tuple(
            Move(how, target.name, target.factor, target.offset, power)
            for how, path, power in chosen.moves
            for target in simulation.targets(path)
        )
    except SomersaultError as mistake:
        raise SomersaultError(f"choose.{name}: {mistake}") from None


def table_of(chosen: Mapping[str, Choose], parts: Array) -> Array:
    """The values (P, chosen) of candidates at parts of their ways between the bounds."""
    return np.stack([one.value(parts[:, k]) for k, one in enumerate(chosen.values())], 1)


def _names(what: str, given: Any) -> tuple[str, ...]:
    if isinstance(given, str):
        return (given,) if given else ()
    return () if isinstance(given, tuple) and not given else name_list(what, given)
