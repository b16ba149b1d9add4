"""The search for the best candidate: evolution with an adapting covariance (CMA-ES)."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault.designs._journal import Journal
from somersault.designs._penalty import Penalty
from somersault.designs._trial import Outcome


def search(
    begins: Array, width: float, evaluations: int, population: int | None, seed: int,
    journal: Journal,
    outcome: Callable[[Array], Outcome], told: Callable[[int, Outcome], None],
) -> None:  # fmt: skip
    """Search within the unit cube from a point (n,), at first so wide about it, generation by
    generation.

    `outcome` says what candidates (P, n) come to, and `told` is called with how many have been
    judged and what the last came to. All goes into the journal; what is there already is not run
    again.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of its own, about plots
        import cma

        random = np.random.default_rng(seed)
        options: dict[str, Any] = {
            "bounds": [0, 1], "maxfevals": evaluations, "verbose": -9, "tolfun": 1e-9,
            "tolflatfitness": 20, "seed": np.nan, "maxstd_boundrange": np.inf,
            "randn": lambda *shape: random.standard_normal(shape),
        }  # fmt: skip
        if population is not None:
            options["popsize"] = population
        evolution = cma.CMAEvolutionStrategy(begins, width, options)
        judged, penalty = 0, Penalty()
        while not evolution.stop() and judged < evaluations:
            candidates = np.array(evolution.ask())
            candidates = np.clip(candidates, 0.0, 1.0)
            known = journal.found(judged // len(candidates), candidates)
            if known is None:
                known = outcome(candidates)
                journal.add(candidates, known)
            judged += len(candidates)
            evolution.tell(list(candidates), list(penalty.of(known)))
            told(judged, known)
