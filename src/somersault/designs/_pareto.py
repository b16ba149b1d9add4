"""What a trade-off came to: the points of the front, on starts that the search has not seen."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import whole_number
from somersault.designs._result import Design
from somersault.designs._trial import Outcome, Trial
from somersault.simulation import ENDED

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False)
class TradeOff:
    """The Pareto front of some objectives, as `trade_off` returns it.

    Attributes
    ----------
    trial : Trial
        What was run for each candidate in the search.
    held_out : Trial
        The same from starts that the search has not seen.
    table : ndarray, (1 + points, chosen)
        What the first candidate and those of the front choose.
    parts : ndarray, (points, chosen)
        Where those of the front are between the bounds, 0 to 1.
    generations : list of (ndarray, Outcome)
        Candidates, as parts of their ways (P, chosen), and what they came to.
    rows : mapping of str to ndarray, (1 + points, N)
        What is reported of them from the held-out starts.
    """

    trial: Trial
    held_out: Trial
    table: Array
    parts: Array
    generations: list[tuple[Array, Outcome]]
    rows: dict[str, Array]

    def __repr__(self) -> str:
        data = self.dataset["figure"]
        ends = [
            f"{self.trial.words(one)} {float(row.min()):.4g} to {float(row.max()):.4g}"
            for one, row in zip(self.trial.objectives, data.values.T, strict=True)
        ]
        return f"<TradeOff: {len(self.parts)} points; {', '.join(ends)}>"

    @cached_property
    def dataset(self) -> xr.Dataset:
        """The front, labelled: what is `chosen` at each point, and for each objective the `figure`
        on held-out starts and its 95 % confidence interval, `low` and `high`. `beaten` are points
        than which another one does better in all objectives on these starts."""
        data = self._labelled(slice(1, None))
        rises = np.array([one.rises for one in self.trial.objectives])
        costs = np.where(rises, -1, 1) * data["figure"].values
        better = (costs[:, None] < costs[None]).all(-1).any(0)
        return data.assign(beaten=("point", better))

    @cached_property
    def first(self) -> xr.Dataset:
        """The same of the candidate with which the search began."""
        return self._labelled(slice(0, 1)).isel(point=0)

    def _labelled(self, places: slice) -> xr.Dataset:
        import xarray as xr

        rows = {name: x[places] for name, x in self.rows.items()}
        aims = self.trial.objectives
        intervals = [
            [
                self.held_out.interval(one, {name: x[k] for name, x in rows.items()})
                for k in range(len(rows[ENDED]))
            ]
            for one in aims
        ]
        low, high = np.moveaxis(np.array(intervals, float), -1, 0).swapaxes(1, 2)
        along = ("point", "objective")
        return xr.Dataset(
            {
                "figure": (along, self.held_out.all_figures(rows)),
                "low": (along, low),
                "high": (along, high),
                "chosen": (("point", "quantity"), self.table[places]),
            },
            {
                "objective": [self.trial.words(one) for one in aims],
                "units": ("objective", [self.trial.unit(one) for one in aims]),
                "quantity": list(self.trial.chosen),
            },
        )

    def design(self, point: int, objective: int = 0) -> Design:
        """A point of the front as a design: to be run, judged on other starts, and looked around.

        Parameters
        ----------
        point : int
            Which, as in `dataset`; from 0.
        objective : int
            By which of the objectives it is judged; from 0.

        Returns
        -------
        Design
        """
        at = whole_number("point", point, 0, len(self.parts) - 1)
        which = whole_number("objective", objective, 0, len(self.trial.objectives) - 1)
        aims = (self.trial.objectives[which],)
        both = [0, 1 + at]
        whole = len(self.generations[0][0])  # the last may be smaller, where little was left to try
        generations = [
            (parts, Outcome(o.figures[:, which], o.costs[:, which], o.beyond))
            for parts, o in self.generations
            if len(parts) == whole
        ]
        return Design(
            replace(self.trial, objectives=aims), replace(self.held_out, objectives=aims),
            self.table[both], self.parts[at], generations,
            {name: x[both] for name, x in self.rows.items()},
        )  # fmt: skip

    def plot(self) -> Figure:
        """A picture: the front with its intervals, and what is chosen along it.

        Returns
        -------
        matplotlib.figure.Figure
        """
        from somersault.designs._plot_front import plot_front

        figures = np.concatenate([o.figures[o.beyond <= 0] for _, o in self.generations])
        return plot_front(self.dataset, self.first, figures, self.parts)
