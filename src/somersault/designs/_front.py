"""The search for a Pareto front: evolution by non-dominated sorting (NSGA-II)."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.designs._journal import Journal
from somersault.designs._trial import Outcome

POPULATION = 24  # of 12 to 48 the most of a front in 400 candidates, on the layout
_SAME = 0.01  # of the range of a front


def check_pymoo() -> None:
    """SomersaultError without pymoo."""
    if importlib.util.find_spec("pymoo") is None:
        raise SomersaultError("a trade-off needs pymoo; pip install somersault[tradeoffs]")


def search_front(
    begins: Array, objectives: int, evaluations: int, population: int, seed: int, journal: Journal,
    outcome: Callable[[Array], Outcome], told: Callable[[int], None],
) -> None:  # fmt: skip
    """Search within the unit cube for the front of M objectives, generation by generation.

    The first generation is a point (n,) and points of a Sobol' sequence. `outcome` says what
    candidates (P, n) come to, by all objectives, and `told` is called with how many have been
    judged. All goes into the journal; what is there already is not run again.
    """
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.config import Config
    from pymoo.core.evaluator import Evaluator
    from pymoo.core.problem import Problem
    from pymoo.core.termination import NoTermination
    from pymoo.problems.static import StaticProblem
    from scipy.stats import qmc

    Config.warnings["not_compiled"] = False  # it would be printed among what a command prints
    spread = qmc.Sobol(len(begins), rng=seed, bits=32).random_base2(population.bit_length())
    first = np.concatenate([begins[None], spread[: population - 1]])
    problem = Problem(n_var=len(begins), n_obj=objectives, n_ieq_constr=1, xl=0.0, xu=1.0)
    evolution = NSGA2(pop_size=population, sampling=first)
    evolution.setup(problem, termination=NoTermination(), seed=seed, verbose=False)
    judged = generation = 0
    while judged < evaluations:
        offspring = evolution.ask()
        if offspring is None:  # there is nothing new to try
            break
        candidates = np.clip(np.asarray(offspring.get("X"), float), 0.0, 1.0)
        known = journal.found(generation, candidates)
        if known is None:
            known = outcome(candidates)
            journal.add(candidates, known)
        figures = StaticProblem(problem, F=known.costs, G=known.beyond[:, None])
        Evaluator().eval(figures, offspring)
        evolution.tell(infills=offspring)
        judged, generation = judged + len(candidates), generation + 1
        told(judged)


def front(costs: Array, most: int) -> Array:
    """The places (k,) of the costs (N, M) that no other is better than in all.

    What differs by less than a hundredth of the front's range counts as the same (boxes of Laumanns
    and others 2002, doi:10.1162/106365602760234108), and of more than `most` those are taken that
    are spread most evenly, the ends of all objectives among them. They come in the order of the
    first objective.
    """
    from moocore import is_nondominated

    best = np.flatnonzero(is_nondominated(costs))
    low, span = costs[best].min(0), np.ptp(costs[best], axis=0)
    scaled = (costs[best] - low) / np.where(span > 0, span, 1.0)
    middling = np.argsort(scaled.sum(1), kind="stable")  # the first of a box stands for it
    best, scaled = best[middling], scaled[middling]
    apart = is_nondominated(np.floor(scaled / _SAME))
    best, scaled = best[apart], scaled[apart]
    taken = list(dict.fromkeys(np.argmin(scaled, 0).tolist()))
    away = np.linalg.norm(scaled[:, None] - scaled[None, taken], axis=-1).min(1)
    while len(taken) < min(most, len(best)):
        taken.append(int(np.argmax(away)))
        away = np.minimum(away, np.linalg.norm(scaled - scaled[taken[-1]], axis=-1))
    return best[sorted(taken, key=lambda k: tuple(scaled[k]))]
