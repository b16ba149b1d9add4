"""What a joint does at ticks, at which it senses the body."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from somersault._core.array import Array
from somersault.flight.behaviours._here import Here


@dataclass(frozen=True)
class Senses:
    """What is sensed of the body at a tick.

    `known` are the quantities by name; `normal` gives a normal deviate, another one each time.
    """

    known: Mapping[str, Any]
    normal: Callable[[], Any]


class Sensing(Protocol):
    """A joint's behaviour at ticks: a behaviour gives itself as its `sensing`.

    `every` is the time between ticks (s), `carried` how many numbers it carries from one to the
    next, `noisy` whether it senses with noise.
    """

    @property
    def every(self) -> float:
        """The time between ticks, s."""

    @property
    def carried(self) -> int:
        """How many numbers it carries from tick to tick."""

    @property
    def noisy(self) -> bool:
        """Whether it senses with noise."""

    def at_takeoff(self, q: Array, u: Array) -> Array:
        """What it carries before the first tick, which is at takeoff.

        Parameters
        ----------
        q : ndarray, (count, coordinates)
        u : ndarray, (count, speeds)
            Its own, at takeoff.

        Returns
        -------
        ndarray, (count, carried)
        """

    def tick(self, here: Here, senses: Senses) -> list[Any]:
        """What it carries from a tick on.

        Parameters
        ----------
        here : Here
        senses : Senses

        Returns
        -------
        list
        """
