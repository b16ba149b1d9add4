"""One checked number or statement of the thesis, beside ours."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True, slots=True)
class Claim:
    """What the thesis says, what the computation says, and whether they agree.

    `thesis` and `computed` are numbers, with a `unit` and a `tolerance`, or short texts. Make one
    with `number` or `statement`, which compute `holds`.
    """

    id: str
    where: str
    claim: str
    thesis: float | str
    computed: float | str
    unit: str
    tolerance: float | None
    holds: bool
    note: str = ""

    def record(self) -> dict[str, Any]:
        """As it stands in claims.json."""
        return asdict(self)


def number(
    id: str,
    where: str,
    claim: str,
    thesis: float,
    computed: float,
    unit: str,
    tolerance: float,
    note: str = "",
) -> Claim:
    """A number of the thesis: it holds when ours is within the tolerance of it."""
    ours = float(computed)
    # A difference of exactly the tolerance holds, whatever the last binary digit says.
    holds = bool(abs(ours - thesis) <= tolerance * (1 + 1e-9) + 1e-15)
    theirs, shown = (float(f"{value:.9g}") for value in (thesis, ours))
    return Claim(id, where, claim, theirs, shown, unit, float(tolerance), holds, note)


def statement(
    id: str,
    where: str,
    claim: str,
    thesis: str,
    computed: str,
    holds: bool | np.bool_,
    note: str = "",
) -> Claim:
    """A statement of the thesis: `holds` is a truth value computed from data."""
    import numpy as np

    if not isinstance(holds, bool | np.bool_):
        raise TypeError(f"claim {id}: whether it holds must be computed, as a truth value")
    return Claim(id, where, claim, thesis, computed, "", None, bool(holds), note)


def failed(claims: Iterable[Claim]) -> list[Claim]:
    """Those that do not hold."""
    return [claim for claim in claims if not claim.holds]
