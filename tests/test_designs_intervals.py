"""Confidence intervals of designs: starts are what is independent, and not runs."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats
from test_designs import BOTH, SCATTER, Bowl, found
from test_designs_made import Moved

import somersault as so
from somersault.designs import Mean, Objective, Quantile, Share

OBJECTIVES: list[Objective] = [
    Mean("error"), Share("error", most=0.25), Share("error", least=0.1), Quantile("error", q=0.8),
]  # fmt: skip


@pytest.mark.parametrize("objective", OBJECTIVES, ids=lambda one: one.words)
def test_a_simulation_given_four_times_says_no_more_than_once(objective: Objective) -> None:
    once = found(objective=objective, evaluations=30, held_out=200)
    assert once.on(simulation=[Bowl()] * 4).interval == pytest.approx(once.interval, rel=1e-9)


@pytest.mark.parametrize("objective", OBJECTIVES, ids=lambda one: one.words)
def test_points_of_a_grid_share_their_starts(objective: Objective) -> None:
    once = found(objective=objective, evaluations=30, held_out=200)
    grid = {**SCATTER, "y_off": so.Vary(adds_to="y", values=[0.0, 1e-12, 2e-12])}
    assert once.on(vary=grid).interval == pytest.approx(once.interval, rel=1e-6)


@pytest.mark.parametrize("objective", OBJECTIVES, ids=lambda one: one.words)
def test_one_case_has_the_interval_of_independent_runs(objective: Objective) -> None:
    """By SciPy's own."""
    values = np.abs(np.random.default_rng(5).normal(size=300))
    low, high = objective.interval(values, np.zeros(300, bool))
    if isinstance(objective, Share):
        good = int(objective.good(values, np.zeros(300, bool)).sum())
        expected = stats.binomtest(good, 300).proportion_ci(method="exact")
    elif isinstance(objective, Quantile):
        expected = stats.quantile_test(values, p=0.8).confidence_interval(0.95)
    else:
        expected = stats.norm.interval(0.95, values.mean(), stats.sem(values))
    assert (low, high) == pytest.approx((expected[0], expected[1]), rel=1e-6)


@pytest.mark.parametrize("objective", OBJECTIVES, ids=lambda one: one.words)
@pytest.mark.parametrize("alike", [0.0, 0.7, 0.95])
def test_intervals_of_cases_hold_the_figure_as_often_as_they_say(
    objective: Objective, alike: float
) -> None:
    """Of |z| of normal z in three cases that are correlated so much."""
    random = np.random.default_rng(7)
    together, alone = random.normal(size=(600, 1, 150)), random.normal(size=(600, 3, 150))
    values = np.abs(np.sqrt(alike) * together + np.sqrt(1 - alike) * alone)
    if isinstance(objective, Share):
        true = stats.halfnorm.cdf(0.25) if objective.most else stats.halfnorm.sf(0.1)
    else:
        true = stats.halfnorm.ppf(0.8) if isinstance(objective, Quantile) else stats.halfnorm.mean()
    held = [low <= true <= high for low, high in
            (objective.interval(one, np.zeros(one.shape, bool)) for one in values)]  # fmt: skip
    assert 0.925 < np.mean(held) < 0.99


def test_the_mean_of_sizes_is_not_below_none() -> None:
    rare = np.zeros(50)
    rare[0] = 1.0
    assert Mean("error").interval(rare, np.zeros(50, bool))[0] == 0.0
    assert Mean("error", largest=True).interval(rare, np.zeros(50, bool))[0] < 0.0


def test_cases_that_differ_widen_nothing_by_themselves() -> None:
    """The mean over two cases, one 0 and the other 2 for all starts, is known exactly."""
    both = np.stack([np.zeros(40), np.full(40, 2.0)])
    assert Mean("error").interval(both, np.zeros(both.shape, bool)) == (1.0, 1.0)
    cases = found({"x": BOTH["x"]}, of=[Moved(by=-1.0), Moved(by=2.0)], held_out=200)
    assert cases.interval[0] < cases.figure < cases.interval[1]
