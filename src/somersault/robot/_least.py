"""What a number of a run is at least, declared with its type: `speed_gain: NotNegative = 0.07`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any, get_type_hints

from somersault._core.array import Array


@dataclass(frozen=True)
class Least:
    """What a number is at least.

    Parameters
    ----------
    value : float
    itself : bool
        Whether it may be just that.
    """

    value: float
    itself: bool = True

    def allows(self, number: float | Array) -> Any:
        """Whether a number, or each of an array, is not too small."""
        return number >= self.value if self.itself else number > self.value

    def __str__(self) -> str:
        if self.value == 0:
            return "not be negative" if self.itself else "be positive"
        return f"be at least {self.value:g}" if self.itself else f"be above {self.value:g}"


NotNegative = Annotated[float, Least(0.0)]
Positive = Annotated[float, Least(0.0, itself=False)]
AtLeastOne = Annotated[float, Least(1.0)]


@cache
def leasts(table: type) -> dict[str, Least]:
    """Those of a table's numbers that have one."""
    hints = get_type_hints(table, include_extras=True)
    found = {name: getattr(hint, "__metadata__", ()) for name, hint in hints.items()}
    return {name: marks[0] for name, marks in found.items() if marks}
