"""What a design is good for: the base of all objectives, a class in a file each."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import text, truth
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number

CONFIDENCE = 0.95
"""Of intervals."""


@dataclass(frozen=True)
class Objective(ABC):
    """A figure of many runs that is to be large.

    Parameters
    ----------
    quantity : str
        What is reported of each run: "landing_error", "time" …
    """

    kinds: ClassVar[dict[str, type[Objective]]] = {}
    """All of them by their names in a SPEC."""
    kind: ClassVar[str]

    quantity: str

    def __init_subclass__(cls, kind: str, **more: object) -> None:
        super().__init_subclass__(**more)
        cls.kind = kind
        Objective.kinds[kind] = cls

    def checked(self) -> Objective:
        """The same, if it makes sense; SomersaultError otherwise.

        Returns
        -------
        Objective
        """
        text("objective.quantity", self.quantity)
        return self

    @abstractmethod
    def figures(self, values: Array, failed: Array) -> Array:
        """The figure of each of P candidates.

        Parameters
        ----------
        values : ndarray, (P, N)
            The quantity, of N runs of each.
        failed : ndarray of bool, (P, N)

        Returns
        -------
        ndarray, (P,)
        """

    @property
    @abstractmethod
    def rises(self) -> bool:
        """Whether it is the better the larger it is."""

    @abstractmethod
    def interval(self, values: Array, failed: Array) -> tuple[float, float]:
        """The interval that holds the figure of all starts with 95 % confidence.

        Parameters
        ----------
        values : ndarray, (N,) or (cases, N)
            Of N starts; runs of several cases from the same start are not independent.
        failed : ndarray of bool

        Returns
        -------
        low, high : float
        """

    @abstractmethod
    def badness(self, values: Array) -> Array:
        """How bad runs that did not fail are: the worse, the larger.

        Parameters
        ----------
        values : ndarray

        Returns
        -------
        ndarray
        """

    @property
    @abstractmethod
    def words(self) -> str:
        """What it is, in words."""

    def costs(self, values: Array, failed: Array) -> Array:
        """What is to be small: the figure, turned over where it is to be large.

        Parameters
        ----------
        values, failed : ndarray, (P, N)

        Returns
        -------
        ndarray, (P,)
        """
        figures = self.figures(values, failed)
        return -figures if self.rises else figures


@dataclass(frozen=True)
class Averaged(Objective, kind=""):
    """A figure of the values themselves, those of runs that failed among them.

    Parameters
    ----------
    largest : bool
        Whether it is to be large, as a lifetime; else small, as an error.
    counts_as : float, optional
        What a run that failed counts as, and a value that is worse. Without it no run may fail.
    """

    largest: bool = False
    counts_as: float | None = None

    def checked(self) -> Objective:
        truth("objective.largest", self.largest)
        if self.counts_as is not None:
            number("objective.counts_as", self.counts_as)
            if self.counts_as < 0 and not self.largest:
                raise SomersaultError(
                    f"objective.counts_as is {self.counts_as:g}, and sizes are not below 0; say "
                    "what a failure counts as, something large"
                )
        return super().checked()

    @property
    def rises(self) -> bool:
        return self.largest

    def badness(self, values: Array) -> Array:
        return -values if self.largest else np.abs(values)

    def counted(self, values: Array, failed: Array) -> Array:
        """The values as they count.

        Parameters
        ----------
        values, failed : ndarray

        Returns
        -------
        ndarray
        """
        size = values if self.largest else np.abs(values)
        lost = failed | ~np.isfinite(values)
        if self.counts_as is None:
            if lost.any():
                raise SomersaultError(
                    f"{int(lost.sum())} runs failed, and the objective does not say what they "
                    "count as; give counts_as"
                )
            return size
        worst = np.maximum if self.largest else np.minimum
        return np.where(lost, self.counts_as, worst(size, self.counts_as))


Objective.kinds.pop("")
