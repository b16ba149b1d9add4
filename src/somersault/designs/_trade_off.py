"""`trade_off`: what one objective costs in another, over the same candidates and starts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import list_of, truth, whole_number
from somersault._core.errors import SomersaultError
from somersault.designs._choose import Choose
from somersault.designs._front import POPULATION, check_pymoo, front, search_front
from somersault.designs._limit import Limit
from somersault.designs._objective import Objective
from somersault.designs._pareto import TradeOff
from somersault.designs._study import EVALUATIONS, HELD_OUT, SIZE, Size, study
from somersault.designs._trial import Outcome
from somersault.ensembles import Vary, workers_kept
from somersault.flight import Maneuver
from somersault.simulation import Simulation

if TYPE_CHECKING:
    from distributed.security import Security

POINTS = 16
_MOST_POINTS = 10_000


@workers_kept()
def trade_off(
    what: Maneuver | Simulation | Sequence[Any] | Callable[..., Any],
    choose: Mapping[str, Choose],
    vary: Mapping[str, Vary],
    objectives: Sequence[Objective],
    *,
    limits: Sequence[Limit] = (),
    size: int = SIZE,
    seed: int = 0,
    sequence: str = "sobol",
    evaluations: int = EVALUATIONS,
    population: int = POPULATION,
    points: int = POINTS,
    held_out: int = HELD_OUT,
    out: str | Path | None = None,
    threads: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    security: Security | None = None,
    progress: bool = False,
) -> TradeOff:
    """What one objective costs in another: the Pareto front of two or more.

    Candidates are compared on the same starts, and those on the front, that no other is better than
    in all objectives, are judged on other starts. The search is NSGA-II (Deb and others 2002,
    doi:10.1109/4235.996017, by the package `pymoo`). The same call finds the same, bit for bit on
    one machine.

    Parameters
    ----------
    what, choose, vary
        As for `design`.
    objectives : sequence of Objective
        Two or more. Besides what is reported, the quantity of an objective may be something that is
        chosen, as a mass.
    limits, size, seed, sequence, evaluations
        As for `design`.
    population : int
        How many candidates a generation has.
    points : int
        How many points of the front are judged on other starts, spread evenly.
    held_out : int
        How many other starts they are judged on.
    out, threads, workers, scheduler, security, progress
        As for `design`.

    Returns
    -------
    TradeOff

    Raises
    ------
    SomersaultError
        As for `design`; for one objective, or the same twice; without pymoo.

    Examples
    --------
    >>> import somersault as so
    >>> arms = {"shoulder": so.JointTakeoff.sprung(angle=1.3, K=0.5, hold=True)}
    >>> layout = so.Maneuver("furrer", so.Takeoff(spin=8.64, joints=arms), 2.0)
    >>> found = so.designs.trade_off(
    ...     layout,
    ...     {"stiffness": so.Choose(sets="joints.shoulder.K", between=(0.2, 1.5))},
    ...     {"twisted": so.Vary(adds_to="takeoff.twist", normal=[0.0, 0.02])},
    ...     [so.designs.Mean("twist", counts_as=3.2), so.designs.Mean("stiffness")],
    ...     size=16, evaluations=48, held_out=64,
    ... )  # fmt: skip
    >>> twist, stiffness = found.dataset["figure"].values.T
    >>> bool(twist[0] < twist[-1] and stiffness[0] > stiffness[-1])
    True
    """
    aims = tuple(list_of("objectives", objectives, Objective))  # type: ignore[type-abstract]
    if len(aims) < 2:
        raise SomersaultError(
            "a trade-off needs two objectives at least; for one there is somersault.design"
        )
    for one, other in combinations(aims, 2):
        if one == other:
            raise SomersaultError(f"{one.words} is traded off against itself; give two that differ")
    truth("progress", progress)
    whole_number("points", points, 2, _MOST_POINTS)
    check_pymoo()
    much = Size(size, seed, sequence, evaluations, population, held_out)
    sought = study(
        what, choose, vary, aims, limits, much, out, {},
        threads=threads, workers=workers, scheduler=scheduler, security=security,
    )  # fmt: skip

    def outcome(parts: Array) -> Outcome:
        return sought.trial.traded(sought.trial.table(parts), **sought.where)

    with sought.bar(progress) as told:
        search_front(
            sought.begins, len(aims), evaluations, population, seed, sought.journal, outcome,
            lambda judged: told(judged, ""),
        )  # fmt: skip
    candidates, costs = sought.found()
    parts = candidates[front(costs, points)]
    table = sought.trial.table(np.concatenate([sought.begins[None], parts]))
    fresh, rows = sought.judged(table)
    return TradeOff(sought.trial, fresh, table, parts, sought.journal.generations, rows)
