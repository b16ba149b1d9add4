"""`design`: the passive body that is most reliable over a scatter of starts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import truth
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.designs._choose import Choose
from somersault.designs._limit import Limit
from somersault.designs._objective import Objective
from somersault.designs._polish import LeastSquares
from somersault.designs._result import Design
from somersault.designs._search import search
from somersault.designs._study import EVALUATIONS, HELD_OUT, SIZE, WIDTH, Size, study
from somersault.designs._trial import Outcome
from somersault.ensembles import Vary, workers_kept
from somersault.flight import Maneuver
from somersault.simulation import Simulation

if TYPE_CHECKING:
    from distributed.security import Security


@workers_kept()
def design(
    what: Maneuver | Simulation | Sequence[Any] | Callable[..., Any],
    choose: Mapping[str, Choose],
    vary: Mapping[str, Vary],
    objective: Objective,
    *,
    limits: Sequence[Limit] = (),
    size: int = SIZE,
    seed: int = 0,
    sequence: str = "sobol",
    evaluations: int = EVALUATIONS,
    population: int | None = None,
    width: float = WIDTH,
    polish: bool = False,
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
        How many candidates are judged: the search ends with the generation that reaches as many,
        which is judged as a whole, or before if it has settled.
    population : int, optional
        How many candidates a generation has; by default 4 + 3 ln n of n chosen quantities.
    width : float
        How far about the start the first candidates are scattered (standard deviation), as a part
        of each range: little where the start is good already.
    polish : bool
        Whether least squares go on from the best of the search, with all errors of all landings:
        for the mean "landing_error" of flights.
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
    truth("progress", progress)
    if not 0 < number("width", width) <= 1:
        raise SomersaultError(f"width must be above 0 and at most 1, and is {width:g}")
    truth("polish", polish)
    much = Size(size, seed, sequence, evaluations, population, held_out)
    sought = study(
        what, choose, vary, (objective,), limits, much, out, {"width": width},
        threads=threads, workers=workers, scheduler=scheduler, security=security,
    )  # fmt: skip
    squares = LeastSquares(sought) if polish else None
    rises, best = objective.rises, list[float]()

    def outcome(parts: Array) -> Outcome:
        return sought.trial.outcome(sought.trial.table(parts), **sought.where)

    with sought.bar(progress) as told:

        def heard(judged: int, outcome: Outcome) -> None:
            good = outcome.figures[outcome.beyond <= 0]
            if good.size:
                pick = max if rises else min
                best[:] = [pick([*best, float(pick(good))])]
            told(judged, f"best {best[0]:.4g}" if best else "none within the limits yet")

        search(sought.begins, width, evaluations, population, seed, sought.journal, outcome, heard)
    candidates, costs = sought.found()
    parts, polished = candidates[np.argmin(costs)], None
    if squares is not None:
        steps = squares.steps_from(parts)
        came = outcome(steps)
        better = np.where(came.beyond <= 0, came.costs, np.inf)
        if better.min() < costs.min():
            parts = steps[np.argmin(better)]
            polished = float(came.figures[np.argmin(better)])
    table = sought.trial.table(np.stack([sought.begins, parts]))
    fresh, rows = sought.judged(table)
    return Design(sought.trial, fresh, table, parts, sought.journal.generations, rows, polished)
