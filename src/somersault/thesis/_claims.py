"""One checked number or statement of the thesis, with ours next to it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True, slots=True)
class Claim:
    """What the thesis says, what the computation says, and whether they agree.

    Make one with `number` or `statement`, which compute `holds`.

    Attributes
    ----------
    id : str
        As in claims.json, "fig4-9.range-low".
    where : str
        The figure, table, equation or section of the thesis.
    claim : str
        What is claimed, in a sentence.
    thesis, computed : float or str
        The thesis's number and ours, or short texts.
    unit : str
        Of the numbers; "1" for none, empty for texts.
    tolerance : float or None
        How far the numbers may be apart; None for texts.
    holds : bool
        Whether they agree.
    note : str
        How it was checked, or why it differs.
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

    @property
    def own(self) -> bool:
        """Whether the thesis says nothing of it: an aim of the package's own."""
        return is_own(self.thesis)

    def record(self) -> dict[str, Any]:
        """The claim as claims.json has it.

        Returns
        -------
        dict
        """
        return asdict(self)


def is_own(thesis: float | str) -> bool:
    """Whether what stands for the thesis's side of a claim means that it says nothing."""
    return thesis in ("not said", "not tried", "(not in the thesis)")


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
    """A claim about a number: it holds when ours is within the tolerance of the thesis's.

    Parameters
    ----------
    id, where, claim : str
        As in `Claim`.
    thesis : float
        As printed.
    computed : float
        As computed here; NaN never holds.
    unit : str
        Of both, "1" for none.
    tolerance : float
        In that unit.
    note : str
        How it was checked, or why it differs.

    Returns
    -------
    Claim

    Examples
    --------
    >>> from somersault.thesis import number
    >>> number("fig4-5.k1", "§4.3.1", "k1 at Γ = 1.3 rad", 0.65, 0.687, "1", 0.005).holds
    False
    """
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
    """A claim in words, which holds or not by what the computation shows.

    Parameters
    ----------
    id, where, claim : str
        As in `Claim`.
    thesis, computed : str
        What the thesis says and what the computation shows, in a few words.
    holds : bool
        Computed from data, never typed.
    note : str
        How it was checked, or why it differs.

    Returns
    -------
    Claim

    Raises
    ------
    TypeError
        If `holds` is anything but a truth value.

    Examples
    --------
    >>> from somersault.thesis import statement
    >>> roots = [0.2, -0.2]
    >>> unstable = max(roots) > 0
    >>> statement("fig", "§4.1", "the layout is unstable", "unstable", "grows", unstable).holds
    True
    """
    import numpy as np

    if not isinstance(holds, bool | np.bool_):
        raise TypeError(f"claim {id}: whether it holds must be computed, as a truth value")
    return Claim(id, where, claim, thesis, computed, "", None, bool(holds), note)


def failed(claims: Iterable[Claim]) -> list[Claim]:
    """Those that do not hold."""
    return [claim for claim in claims if not claim.holds]
