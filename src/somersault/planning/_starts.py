"""Many starts of a search: some drawn, others that leap from the best so far, the best refined."""

from __future__ import annotations

from somersault._core.errors import SomersaultError
from somersault._core.stages import stage
from somersault.planning._ipopt import Outcome
from somersault.planning._plan import Attempt
from somersault.planning._processes import Processes, searching
from somersault.planning._search import Draw, Job, Leap, Refine, Search
from somersault.planning._unmet import reason

_COARSE = 40  # nodes on which starts are tried, and the best are refined,
_FINE = 60  # where there are more than so many
_ROUND = 4  # starts
_REFINED = 2  # of the solved starts


def searched(
    here: Search, nodes: int, starts: int, seed: int, count: int
) -> tuple[Outcome, tuple[Attempt, ...]]:
    """The best outcome, and what came of each start.

    Parameters
    ----------
    here : Search
        Of the task.
    nodes, starts, seed : int
        As for `plan`.
    count : int
        Processes at once.

    Raises
    ------
    SomersaultError
        Where no start comes to a plan.
    """
    first = nodes if nodes <= _FINE else _COARSE
    with searching(here, count) as search:
        outcomes = _tried(here, search, first, starts, seed)
        attempts = tuple(Attempt(o.status, o.iterations, o.objective, o.solved) for o in outcomes)
        solved = sorted((o for o in outcomes if o.solved), key=_objective)
        if not solved:
            tried = "the one start" if starts == 1 else f"any of {starts} starts"
            nearest = min(outcomes, key=lambda o: o.missed)
            why = reason(here.grid(first), nearest)
            raise SomersaultError(f"no plan found from {tried}: {why}")
        if first == nodes:
            return solved[0], attempts
        while solved:
            best, solved = solved[:_REFINED], solved[_REFINED:]
            with stage("planning: best starts refined", len(best)) as told_of:
                fine = search.solve([Refine(nodes, first, o.x) for o in best], told_of)
            good = [o for o in fine if o.solved]
            if good:
                return min(good, key=_objective), attempts
    raise SomersaultError(
        f"no plan found: what is solved on {first} nodes is not on {nodes}; give other nodes, or "
        "more starts"
    )


def _tried(
    here: Search, search: Processes, intervals: int, starts: int, seed: int
) -> list[Outcome]:
    """Outcomes of all starts: those that are drawn, and then leaps from the best so far.

    Leaps go in rounds of a fixed size, so that processes do not matter.
    """
    drawn = starts if starts <= _ROUND else max(_ROUND, starts // 3)
    wild = here.task.most is not None
    with stage("planning: starts tried", starts) as told_of:
        draws = [Draw(intervals, (seed, k), wild and k % 2 == 1) for k in range(drawn)]
        outcomes = search.solve(draws, told_of)
        while len(outcomes) < starts:
            numbers = range(len(outcomes), min(len(outcomes) + _ROUND, starts))
            solved = [o for o in outcomes if o.solved]
            jobs: list[Job]
            if solved:
                best = min(solved, key=_objective)
                jobs = [Leap(intervals, best.x, (seed, k)) for k in numbers]
            else:
                jobs = [Draw(intervals, (seed, k), wild and k % 2 == 1) for k in numbers]
            outcomes += search.solve(jobs, told_of)
    return outcomes


def _objective(outcome: Outcome) -> float:
    return outcome.objective
