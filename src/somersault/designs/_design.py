"""`design`: the passive body that is most reliable over a scatter of starts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.canonical import canonical
from somersault._core.checks import (
    by_name,
    file_path,
    instance,
    list_of,
    shown,
    truth,
    whole_number,
)
from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault._core.numbers import number
from somersault._core.stages import stage
from somersault.designs._candidates import check_apart
from somersault.designs._choose import Choose, moves_of, table_of
from somersault.designs._given import Given
from somersault.designs._journal import Journal
from somersault.designs._limit import Limit
from somersault.designs._made import Made, arguments, check_arguments
from somersault.designs._objective import Objective
from somersault.designs._result import Design
from somersault.designs._search import search
from somersault.designs._source import Source
from somersault.designs._trial import Outcome, Trial
from somersault.ensembles import Vary
from somersault.flight import Maneuver, flights
from somersault.simulation import ENDED, Simulation

if TYPE_CHECKING:
    from collections.abc import Iterator

    from distributed.security import Security

EVALUATIONS = 400
_MOST_EVALUATIONS = 1_000_000
_SIZE, HELD_OUT = 64, 1_024
WIDTH = 0.25
_MOST_SIZE = 10_000_000


def design(
    what: Maneuver | Simulation | Sequence[Any] | Callable[..., Any],
    choose: Mapping[str, Choose],
    vary: Mapping[str, Vary],
    objective: Objective,
    *,
    limits: Sequence[Limit] = (),
    size: int = _SIZE,
    seed: int = 0,
    sequence: str = "sobol",
    evaluations: int = EVALUATIONS,
    population: int | None = None,
    width: float = WIDTH,
    held_out: int = HELD_OUT,
    out: str | Path | None = None,
    threads: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    security: Security | None = None,
    progress: bool = False,
) -> Design:
    """Choose numbers of a body, a motion or a law so that it does well from scattered starts.

    Candidates are compared on the same starts, and the best is judged on others that the search has
    not seen. The search is an evolution with an adapting covariance (CMA-ES; Hansen 2016,
    arXiv:1604.00772). The same call finds the same, bit for bit on one machine.

    Parameters
    ----------
    what : Maneuver, Simulation, a sequence of these, or a function
        What is run: a maneuver, `flight.flights(…)` with what it reports, runs of a robot, or
        anything else that an ensemble can run. Several are cases (angular momenta, say) that are
        each run from all starts and judged as one. A function makes it anew for every candidate,
        of what is chosen: a motion of a few times and angles, say, and the compliance about it.
    choose : mapping of str to Choose
        What is chosen, by name; a function is given, by name, all that moves no number.
    vary : mapping of str to Vary
        The scatter of the starts.
    objective : Objective
        What is to be large or small: `designs.Share`, `Mean` or `Quantile` of something reported.
    limits : sequence of Limit
        What the design must keep to, in the starts of the search.
    size : int
        How many starts each candidate has.
    seed : int
        From which starts and candidates are drawn.
    sequence : {"sobol", "random", "halton"}
        How starts are drawn.
    evaluations : int
        How many candidates are judged at most.
    population : int, optional
        How many candidates a generation has; by default 4 + 3 ln n of n chosen quantities.
    width : float
        How far about the start the first candidates are scattered (standard deviation), as a part
        of each range: little where the start is good already.
    held_out : int
        How many other starts the best and the first are judged on in the end.
    out : str or Path, optional
        A folder that keeps what the search has found, with which the same call goes on after a
        stop.
    threads, workers, scheduler, security
        As for `ensemble`.
    progress : bool
        Whether a bar shows how far it is.

    Returns
    -------
    Design

    Raises
    ------
    SomersaultError
        For empty bounds, numbers or quantities that are not there, a scatter of nothing, limits
        that no candidate keeps to, and a folder that holds another design.

    Examples
    --------
    >>> import somersault as so
    >>> arms = {"shoulder": so.JointTakeoff.sprung(angle=1.3, K=0.2, hold=True)}
    >>> layout = so.Maneuver("furrer", so.Takeoff(spin=8.64, joints=arms), 2.0)
    >>> found = so.design(
    ...     layout,
    ...     {"stiffness": so.Choose(sets="joints.shoulder.K", between=(0.1, 2.0))},
    ...     {"twisted": so.Vary(adds_to="takeoff.twist", normal=[0.0, 0.02])},
    ...     so.designs.Mean("twist", counts_as=3.2),
    ...     size=16, evaluations=24, held_out=64,
    ... )  # fmt: skip
    >>> 0.4 < found.best["stiffness"] < 2.0
    True
    """
    if not isinstance(objective, Objective):
        raise SomersaultError(
            f"objective is {shown(objective)}; give designs.Share, designs.Mean or designs.Quantile"
        )
    objective = objective.checked()
    made = callable(what) and not isinstance(what, Simulation)
    chosen = {
        name: instance(f"choose.{name}", one, Choose).checked(name, given=made)
        for name, one in by_name("choose", choose).items()
    }
    if not chosen:
        raise SomersaultError("nothing is chosen; say what the design may change")
    begins = np.array([one.begins for one in chosen.values()])
    trial = Trial(
        _source(what, chosen, table_of(chosen, begins[None])[0], objective, made),
        dict(by_name("vary", vary)), objective,
        tuple(limit.checked() for limit in list_of("limits", limits, Limit)),
        whole_number("size", size, 1, _MOST_SIZE), whole_number("seed", seed, 0, 2**31), sequence,
    )  # fmt: skip
    trial.check()
    whole_number("evaluations", evaluations, 2, _MOST_EVALUATIONS)
    whole_number("held_out", held_out, 2, _MOST_SIZE)
    if population is not None:
        whole_number("population", population, 2, evaluations)
    if not 0 < number("width", width) <= 1:
        raise SomersaultError(f"width must be above 0 and at most 1, and is {width:g}")
    truth("progress", progress)
    folder = None if out is None else file_path("out", out)
    where = {"threads": threads, "workers": workers, "scheduler": scheduler, "security": security}
    first = trial.planned(trial.table(begins[None]))  # refuses what cannot be run
    journal = Journal(folder, {
        **trial.source.specification, "cases": [one.specification for one in first],
        "versions": first[0].versions, "objective": canonical(objective),
        "objective_kind": objective.kind, "limits": [canonical(limit) for limit in trial.limits],
        "search": {"evaluations": evaluations, "population": population, "width": width},
    })  # fmt: skip

    def outcome(parts: Array) -> Outcome:
        return trial.outcome(trial.table(parts), **where)

    with _bar(evaluations, objective, progress) as told:
        search(begins, width, evaluations, population, seed, journal, outcome, told)
    return _judged(trial, journal, begins, held_out, where)


def _judged(
    trial: Trial, journal: Journal, begins: Array, held_out: int, where: Mapping[str, Any]
) -> Design:
    """The best candidate of a search and the one it began with, on starts of their own."""
    candidates = np.concatenate([parts for parts, _ in journal.generations])
    costs, beyond = (
        np.concatenate([getattr(o, what) for _, o in journal.generations])
        for what in ("costs", "beyond")
    )
    within = beyond <= 0
    if not within.any():
        least = float(beyond.min())
        raise SomersaultError(
            f"none of {len(candidates)} candidates keeps to the limits; the nearest is beyond them "
            f"by {100 * least:.3g} %; widen the bounds, or the limits"
        )
    best = candidates[np.flatnonzero(within)[np.argmin(costs[within])]]
    table = trial.table(np.stack([begins, best]))
    fresh = replace(trial, size=held_out, seed=trial.seed + 1)
    rows = fresh.run(table, **where)
    lost = int(fresh.failed(rows[ENDED])[1].sum())
    if lost:
        called = trial.simulation.endings.called
        note(f"{lost:,} of {held_out:,} held-out {called} of the best failed, and count as such")
    return Design(trial, fresh, table, best, journal.generations, rows)


def _source(
    what: Any, chosen: Mapping[str, Choose], begins: Array, objective: Objective, made: bool
) -> Source:
    """Where candidates come from, of what is run and where the search begins (chosen,)."""
    if made:
        check_arguments(what, chosen)
    read = partial(_simulations, objective=objective)
    cases = read(what(**arguments(chosen, begins)) if made else what)
    if not cases:
        raise SomersaultError("nothing is run; give a Maneuver, or flight.flights(…)")
    if len({tuple(case.variables) for case in cases}) > 1:
        raise SomersaultError("cases report different things; let all of them report the same")
    moves = {name: moves_of(cases[0], name, one) for name, one in chosen.items()}
    check_apart(moves)
    if made:
        return Made(cases, chosen, moves, read, what)
    return Given(cases, chosen, moves, read)


def _simulations(given: Any, objective: Objective) -> tuple[Simulation, ...]:
    """One or several that are run."""
    several = isinstance(given, Sequence) and not isinstance(given, str)
    return tuple(_simulation(one, objective) for one in (given if several else (given,)))


def _simulation(what: Any, objective: Objective) -> Simulation:
    if isinstance(what, Maneuver):
        plain = flights(what)
        if objective.quantity in plain.variables:
            return plain
        return flights(what, report=[objective.quantity])
    if not isinstance(what, Simulation):
        raise SomersaultError(
            f"{shown(what)} is nothing that can be run; give a Maneuver, or flight.flights(…)"
        )
    return what


@contextmanager
def _bar(
    evaluations: int, objective: Objective, shown: bool
) -> Iterator[Callable[[int, Outcome], None]]:
    """A bar on standard error, with the best figure so far."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    best: list[float] = []

    def told(judged: int, outcome: Outcome) -> None:
        good = outcome.figures[outcome.beyond <= 0]
        if good.size:
            pick = max if objective.rises else min
            best[:] = [pick([*best, float(pick(good))])]
        said = f"best {best[0]:.4g}" if best else "none within the limits yet"
        bar.update(task, completed=min(judged, evaluations), said=said)

    columns = (
        TextColumn("{task.completed:,.0f} of {task.total:,.0f} candidates"),
        BarColumn(bar_width=10), TextColumn("{task.fields[said]}"), TimeElapsedColumn(),
    )  # fmt: skip
    with (
        stage(""),
        Progress(*columns, console=Console(stderr=True), transient=True, disable=not shown) as bar,
    ):
        task = bar.add_task("", total=evaluations, said="")
        yield told
