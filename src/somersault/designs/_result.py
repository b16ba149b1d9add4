"""What a design came to: the best candidate, how sharp it is, and how it does on other starts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, one_of, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.designs._candidates import CANDIDATE, Candidates
from somersault.designs._choose import FIGURE
from somersault.designs._surface import Surface
from somersault.designs._trial import MOST_SEED, MOST_SIZE, Outcome, Trial
from somersault.ensembles import Vary, sensitivity
from somersault.simulation import ENDED

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_MOST_STEPS = 1_001
_FEWEST, _MOST_GROUPS = 64, 1_000_000
CANDIDATES = ("first", "best")


@dataclass(frozen=True, eq=False, repr=False)
class Design:
    """The best candidate of a search, as `design` returns it.

    Attributes
    ----------
    trial : Trial
        What was run for each candidate in the search.
    held_out : Trial
        The same from starts that the search has not seen.
    table : ndarray, (2, chosen)
        What the first and the best candidate choose.
    parts : ndarray, (chosen,)
        Where the best is between its bounds, 0 to 1.
    generations : list of (ndarray, Outcome)
        Candidates, as parts of their ways (P, chosen), and what they came to.
    rows : mapping of str to ndarray, (2, N)
        What is reported of both from the held-out starts.
    polished : float, optional
        The figure, on the starts of the search, to which least squares came after it; None where
        the best is the search's own.
    """

    trial: Trial
    held_out: Trial
    table: Array
    parts: Array
    generations: list[tuple[Array, Outcome]]
    rows: dict[str, Array]
    polished: float | None = None

    def __repr__(self) -> str:
        chosen = ", ".join(f"{name} {value:.4g}" for name, value in self.best.items())
        return f"<Design: {chosen}; {self.words}>"

    @property
    def words(self) -> str:
        """The figure on held-out starts, in words."""
        low, high = self.interval
        unit = self.trial.unit(self.trial.objective)
        figure = f"{self.figure:.4g} {'' if unit == '1' else unit}".rstrip()
        return (
            f"{self.trial.objective.words} {figure} ({low:.4g} to {high:.4g} with 95 % "
            f"confidence), at first {self.first_figure:.4g}"
        )

    @property
    def best(self) -> dict[str, float]:
        """What is chosen, by name."""
        return dict(zip(self.trial.chosen, self.table[1].tolist(), strict=True))

    @property
    def figures(self) -> Array:
        """The objective's figure of the first and the best candidate on held-out starts, (2,)."""
        return self.held_out.figures(self.rows)

    @property
    def figure(self) -> float:
        """The best candidate's figure on held-out starts."""
        return float(self.figures[1])

    @property
    def first_figure(self) -> float:
        """That of the candidate with which the search began."""
        return float(self.figures[0])

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % confidence interval of `figure`."""
        return self.held_out.interval(self.trial.objective, {n: x[1] for n, x in self.rows.items()})

    @property
    def cases(self) -> tuple[Candidates, ...]:
        """All that is run, with what is chosen in it: one simulation, or several."""
        return self.held_out.source.candidates(self.table[1:])[0].cases

    @property
    def simulation(self) -> Candidates:
        """What is run, with what is chosen in it: for `so.ensemble`. Of several, the first."""
        return self.cases[0]

    @property
    def numbers(self) -> dict[tuple[Any, ...], float]:
        """The numbers of the simulation that the best candidate sets, by name."""
        return {name: float(x[0]) for name, x in self.simulation.numbers.items()}

    @cached_property
    def dataset(self) -> xr.Dataset:
        """What is reported of the first and the best candidate from held-out starts, labelled."""
        import xarray as xr

        planned = self.held_out.ensemble(self.held_out.simulation, self.held_out.vary)
        varied = planned.varied(0, planned.count)
        count = len(self.held_out.source.cases)
        known = self.trial.simulation.variables
        data = {}
        for name, x in self.rows.items():
            of = known.get(name)
            words = {} if of is None else {"units": of.unit, "long_name": of.words}
            data[name] = ((CANDIDATE, "start"), x, words)
        coordinates: dict[str, Any] = {CANDIDATE: list(CANDIDATES)}
        coordinates |= {n: ("start", np.tile(x, count)) for n, x in varied.items()}
        if count > 1:
            coordinates["case"] = ("start", np.repeat(np.arange(count), planned.count))
        return xr.Dataset(data, coordinates, {"objective": self.trial.objective.words})

    @property
    def history(self) -> xr.Dataset:
        """How the search went: the best figure so far, and what each generation came to."""
        import xarray as xr

        objective = self.trial.objective
        figures = np.array([outcome.figures for _, outcome in self.generations])
        costs = np.array([np.where(o.beyond > 0, np.inf, o.costs) for _, o in self.generations])
        best = np.minimum.accumulate(costs.min(1))
        parts = np.array([candidates for candidates, _ in self.generations])
        values = np.stack(
            [one.value(parts[..., k]) for k, one in enumerate(self.trial.chosen.values())], -1
        )
        along = ("generation", CANDIDATE)
        return xr.Dataset(
            {
                "figure": (along, figures),
                "best": ("generation", np.where(np.isinf(best), np.nan, best)
                         * (-1 if objective.rises else 1),
                         {"units": self.trial.unit(objective)}),
                "chosen": ((*along, "quantity"), values),
            },
            {"quantity": list(self.trial.chosen)},
            {"objective": objective.words},
        )  # fmt: skip

    @property
    def worst_start(self) -> dict[str, float]:
        """The held-out start from which the best candidate does worst, by what varies."""
        objective = self.trial.objective
        bad = objective.badness(self.rows[objective.quantity][1].astype(float))
        lost = self.held_out.failed(self.rows[ENDED])[1] | np.isnan(bad)
        at = int(np.argmax(np.where(lost, np.inf, bad)))
        data = self.dataset
        return {str(n): float(data[n][at]) for n in data.coords if n != CANDIDATE}

    def around(self, steps: int = 9, reach: float = 0.2) -> xr.Dataset:
        """How sharp the optimum is: the figure along each chosen quantity, the others staying.

        Parameters
        ----------
        steps : int
            How many values of each.
        reach : float
            How far to each side, as a part of its range.

        Returns
        -------
        xarray.Dataset
            `figure` and `value` over `quantity` and `step`, from held-out starts.
        """
        import xarray as xr

        steps, reach = _window(steps, reach)
        chosen = list(self.trial.chosen.values())
        by = np.linspace(-reach, reach, steps)
        parts = np.tile(self.parts, (len(chosen), steps, 1))
        for k in range(len(chosen)):
            parts[k, :, k] = np.clip(self.parts[k] + by, 0.0, 1.0)
        table = self.held_out.table(parts.reshape(-1, len(chosen)))
        figures = self.held_out.figures(self.held_out.run(table))
        values = np.stack([one.value(parts[k, :, k]) for k, one in enumerate(chosen)])
        along = ("quantity", "step")
        return xr.Dataset(
            {"figure": (along, figures.reshape(len(chosen), steps)), "value": (along, values)},
            {"quantity": list(self.trial.chosen), "step": by},
            {"objective": self.trial.objective.words},
        )

    def map(
        self, x: str, y: str, steps: int = 21, reach: float = 0.2, progress: bool = False
    ) -> xr.Dataset:
        """The figure over two of the chosen quantities about the best, the others staying.

        Parameters
        ----------
        x, y : str
            Names of what is chosen.
        steps : int
            How many values of each.
        reach : float
            How far to each side, as a part of its range; no further than the bounds.
        progress : bool
            Whether a bar shows how far it is.

        Returns
        -------
        xarray.Dataset
            `figure` over the two, dims (y, x), from held-out starts.

        Raises
        ------
        SomersaultError
            For what is not chosen, and for a quantity against itself.
        """
        import xarray as xr

        steps, reach = _window(steps, reach)
        unit = self.trial.unit(self.trial.objective)
        for name in (x, y):
            one_of("what a map is over", name, self.trial.chosen)
        if x == y:
            raise SomersaultError(f"a map of {x} against itself shows nothing; name two quantities")
        ways = {name: np.linspace(*self._near(name, reach), steps) for name in (x, y)}
        chosen = self.trial.chosen
        vary = {name: Vary(sets=name, values=way) for name, way in ways.items()}
        fixed = {n: Vary(sets=n, values=[part]) for n, part in self._parts.items() if n not in ways}
        data = Surface(self.held_out).over(vary | fixed, None, "sobol", 0, progress)
        figures = data[FIGURE].squeeze([str(n) for n in fixed], drop=True)
        return xr.Dataset(
            {FIGURE: ((y, x), figures.transpose(y, x).values, {"units": unit})},
            {n: (n, chosen[n].value(way), {"units": chosen[n].unit}) for n, way in ways.items()},
            {"objective": self.trial.objective.words},
        )

    def sensitivity(
        self, size: int = 256, reach: float = 1.0, *, confidence: float = 0.95, seed: int = 0,
        progress: bool = False,
    ) -> xr.Dataset:  # fmt: skip
        """Which of the chosen quantities matter: Sobol' indices of the figure over the bounds.

        Parameters
        ----------
        size : int
            How many groups of candidates are drawn, of two more than quantities are chosen (64 at
            least), each judged on the starts of the search.
        reach : float
            How far to each side of the best, as a part of the range; with 1 all between the bounds.
        confidence : float
            Of the half-widths, between 0 and 1.
        seed : int
            From which candidates are drawn.
        progress : bool
            Whether a bar shows how far it is.

        Returns
        -------
        xarray.Dataset
            As `ensembles.sensitivity` gives it: over `input`, what matters most first,
            `first_order` and `total`, and their half-widths.
        """
        whole_number("size", size, _FEWEST, _MOST_GROUPS)
        _, reach = _window(2, reach)
        vary = {n: Vary(sets=n, uniform=self._near(n, reach)) for n in self._parts}
        drawn = size * (len(vary) + 2)
        data = Surface(self.trial).over(vary, drawn, "saltelli", seed, progress)
        return sensitivity(data, FIGURE, confidence, seed)

    @property
    def _parts(self) -> dict[str, float]:
        """Where the best is between its bounds, by name."""
        return dict(zip(self.trial.chosen, self.parts.tolist(), strict=True))

    def _near(self, name: str, reach: float) -> tuple[float, float]:
        """The window about the best, within the bounds."""
        return max(self._parts[name] - reach, 0.0), min(self._parts[name] + reach, 1.0)

    def plot(self, steps: int = 9, reach: float = 0.2) -> Figure:
        """A picture: how the search went, and how sharp the optimum is along each quantity.

        Parameters
        ----------
        steps, reach
            As for `around`.

        Returns
        -------
        matplotlib.figure.Figure
        """
        from somersault.designs._plot import plot

        return plot(
            self.history, self.around(steps, reach), self.trial.chosen, self.best, self.figure,
            self.interval, self.polished,
        )  # fmt: skip

    def plot_map(
        self, x: str, y: str, steps: int = 21, reach: float = 0.2, progress: bool = False
    ) -> Figure:
        """A picture of the figure over two of the chosen quantities, and where the best is.

        Parameters
        ----------
        x, y, steps, reach, progress
            As for `map`.

        Returns
        -------
        matplotlib.figure.Figure
        """
        from somersault.designs._plot import plot_map

        data = self.map(x, y, steps, reach, progress)
        return plot_map(data, self.trial.chosen, self.best)

    def on(
        self, *, simulation: Any = None, vary: Mapping[str, Vary] | None = None,
        size: int | None = None, seed: int | None = None, sequence: str | None = None,
    ) -> Design:  # fmt: skip
        """The same design judged on other starts.

        Parameters
        ----------
        simulation : optional
            Something else with the same numbers, as of another angular momentum; another function,
            where one makes what is run.
        vary : mapping of str to Vary, optional
            Another scatter.
        size, seed, sequence : optional
            Of the starts, as for `design`: 2 at least.

        Returns
        -------
        Design

        Raises
        ------
        SomersaultError
            As `design`, for what cannot be run or scattered.
        """
        held_out = self.held_out
        changes: dict[str, Any] = {
            "source": None if simulation is None else held_out.source.of(simulation),
            "vary": None if vary is None else by_name("vary", vary),
            "size": None if size is None else whole_number("size", size, 2, MOST_SIZE),
            "seed": None if seed is None else whole_number("seed", seed, 0, MOST_SEED),
            "sequence": sequence,
        }
        other = replace(held_out, **{n: x for n, x in changes.items() if x is not None})
        other.check()
        return replace(self, held_out=other, rows=other.run(self.table))


def _window(steps: int, reach: float) -> tuple[int, float]:
    """How many values and how far from the best; SomersaultError for what is none."""
    whole_number("steps", steps, 2, _MOST_STEPS)
    if not 0 < number("reach", reach) <= 1:
        raise SomersaultError(f"reach must be above 0 and at most 1, and is {reach:g}")
    return steps, reach
