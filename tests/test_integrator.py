"""DOP853 in compiled form: its table, its order, its accuracy, and how its lanes end."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields
from functools import cache
from itertools import combinations_with_replacement

import casadi as ca
import mpmath
import numpy as np
import pytest

from somersault.engine import STATUS, Integrator, Solution, use_threads
from somersault.engine import _dop853 as table

ENDED = {name: code for code, name in STATUS.items()}


def integrator(state: int, parameters: int, slope, gauge=None) -> Integrator:
    """The integrator of slope(y, t, p), each a list of symbols."""
    x = ca.SX.sym("x", state + 1 + parameters)
    own = ca.vertsplit(x)
    given = own[:state], own[state], own[state + 1 :]
    rate = ca.Function("slope", [x], [ca.densify(ca.vertcat(*slope(*given)))])
    if gauge is None:
        return Integrator(rate)
    return Integrator(rate, ca.Function("gauge", [x], [ca.densify(ca.SX(gauge(*given)))]))


@cache
def oscillator() -> Integrator:
    """y'' = -w² y, of frequency w = p[0]; with the gauge y - p[1]."""
    return integrator(
        2, 2, lambda y, t, p: [y[1], -(p[0] ** 2) * y[0]], lambda y, t, p: y[0] - p[1]
    )


@cache
def plain_oscillator() -> Integrator:
    return integrator(2, 1, lambda y, t, p: [y[1], -(p[0] ** 2) * y[0]])


@cache
def growth() -> Integrator:
    """y' = p y², which is without bound at t = 1/p from y = 1."""
    return integrator(1, 1, lambda y, t, p: [p[0] * y[0] ** 2])


@cache
def euler() -> Integrator:
    """Problem B5 of DETEST: a rigid body without torques."""
    return integrator(3, 0, lambda y, t, p: [y[1] * y[2], -y[0] * y[2], -0.51 * y[0] * y[1]])


def solved(own: Integrator, start, parameters, samples, tolerance=1e-12, end=None) -> Solution:
    start, parameters = np.atleast_2d(np.asarray(start, float)), np.asarray(parameters, float)
    return own.solve(start, parameters.reshape(len(start), -1), samples, tolerance, end)


# ------------------------------------------------------------------------------- the table


def trees(order: int) -> Iterator[tuple]:
    """All rooted trees of so many nodes, each the tuple of its branches."""
    yield from _trees(order)


@cache
def _trees(order: int) -> tuple[tuple, ...]:
    return tuple(_forests(order - 1, order - 1))


@cache
def _forests(nodes: int, largest: int) -> tuple[tuple, ...]:
    """Collections of trees with so many nodes in all, none with more than `largest`."""
    if nodes == 0:
        return ((),)
    if largest == 0:
        return ()
    found = list(_forests(nodes, largest - 1))
    for count in range(1, nodes // largest + 1):
        for some in combinations_with_replacement(_trees(largest), count):
            found += [some + rest for rest in _forests(nodes - count * largest, largest - 1)]
    return tuple(found)


def size(tree: tuple) -> int:
    return 1 + sum(size(branch) for branch in tree)


def density(tree: tuple) -> int:
    return size(tree) * math.prod(density(branch) for branch in tree)


def stages(tree: tuple) -> np.ndarray:
    """Butcher's elementary weights of the stages: Π over branches of A Φ(branch)."""
    a = np.zeros((12, 12))
    for stage, weights in enumerate(table.STAGES, 1):
        a[stage, : len(weights)] = weights
    return math.prod((a @ stages(branch) for branch in tree), start=np.ones(12))


def worst(order: int, weights: tuple[float, ...], wanted: bool) -> float:
    """Largest defect of the order conditions of that order; `wanted` 0 for error weights."""
    return max(abs(np.dot(weights, stages(tree)) - wanted / density(tree)) for tree in trees(order))


def test_trees_are_all_there() -> None:
    assert [len(_trees(order)) for order in range(1, 10)] == [1, 1, 2, 4, 9, 20, 48, 115, 286]


def test_nodes_are_the_sums_of_their_rows() -> None:
    sums = [math.fsum(weights) for weights in table.STAGES]
    np.testing.assert_allclose(table.NODES, [0.0, *sums], rtol=0, atol=3e-15)


def test_order_of_the_solution() -> None:
    """All two hundred conditions for order 8, and not those for order 9."""
    for order in range(1, 9):
        assert worst(order, table.WEIGHTS, True) < 1e-14
    assert worst(9, table.WEIGHTS, True) > 1e-8


@pytest.mark.parametrize(("weights", "order"), [(table.ERROR_5, 5), (table.ERROR_3, 3)])
def test_order_of_the_error_estimates(weights: tuple[float, ...], order: int) -> None:
    for lower in range(1, order + 1):
        assert worst(lower, weights, False) < 1e-14
    assert worst(order + 1, weights, False) > 1e-5


def test_quadrature() -> None:
    """Σ b cᵏ = 1/(k + 1): the weights alone, which a wrong row could not mend."""
    for power in range(8):
        assert np.dot(table.WEIGHTS, np.array(table.NODES) ** power) == pytest.approx(
            1 / (power + 1), abs=1e-15
        )


def test_table_of_scipy() -> None:
    theirs = pytest.importorskip("scipy.integrate._ivp.dop853_coefficients")
    for stage, weights in enumerate(table.STAGES, 1):
        assert np.array_equal(weights, theirs.A[stage, :stage])
    assert np.array_equal(table.WEIGHTS, theirs.B)
    np.testing.assert_allclose(table.ERROR_3, theirs.E3[:12], rtol=1e-14, atol=0)
    np.testing.assert_allclose(table.ERROR_5, theirs.E5[:12], rtol=1e-14, atol=0)


# --------------------------------------------------------------------- order and accuracy


def test_one_step_is_of_order_nine() -> None:
    """A step's own error falls as h⁹: the compiled stages, not only their table."""
    lengths = 0.3 * 2.0 ** -np.arange(0, 1.5, 0.25)
    start = np.tile([0.0, 1.0, 1.0], (len(lengths), 1))
    found = euler().solve(start, np.empty((1, 0)), np.array([0.3]), 1e9, lengths, first_step=1.0)
    assert set(found.steps) == {1}
    errors = np.abs(found.final - jacobi(lengths)).max(1)
    order = np.polyfit(np.log(lengths), np.log(errors), 1)[0]
    assert order == pytest.approx(9.0, abs=0.2)


def jacobi(times: np.ndarray) -> np.ndarray:
    """sn, cn, dn of modulus k² = 0.51, which solve B5, (time, 3), to 30 digits."""
    with mpmath.workdps(30):
        rows = [[mpmath.ellipfun(f, float(t), m="0.51") for f in ("sn", "cn", "dn")] for t in times]
        return np.array(rows, float)


def test_detest_b5() -> None:
    times = np.linspace(0.0, 20.0, 9)
    found = solved(euler(), [0.0, 1.0, 1.0], [[]], times, 1e-14)
    np.testing.assert_allclose(found.states[0], jacobi(times), rtol=0, atol=1e-12)


def test_error_follows_the_tolerance() -> None:
    """Over eight decades, and no decade's work is wasted."""
    exact = jacobi(np.array([20.0]))[0]
    tolerances = 10.0 ** -np.arange(4.0, 13.0)
    found = [solved(euler(), [0.0, 1.0, 1.0], [[]], [20.0], tol) for tol in tolerances]
    errors = np.array([np.abs(one.final[0] - exact).max() for one in found])
    assert np.all(errors < 20 * tolerances)
    assert np.all(np.diff(np.log10(errors)) < 0)
    steps = np.array([one.steps[0] for one in found])
    assert steps[-1] < 16 * steps[0]  # 10^(8/8) at order 8, with some to spare


@pytest.mark.parametrize("rate", [0.01, 1.0, 50.0, 3000.0])
def test_oscillator(rate: float) -> None:
    """Ten periods, however long they are beside the first step."""
    end = 10 * 2 * np.pi / rate
    found = solved(plain_oscillator(), [1.0, 0.5 * rate], [rate], [end], 1e-13)
    wanted = [np.cos(rate * end) + 0.5 * np.sin(rate * end), 0.5 * rate]
    np.testing.assert_allclose(found.final[0] / [1, rate], wanted / np.array([1, rate]), atol=2e-11)


def test_time_and_parameters_reach_the_slope() -> None:
    """y' = a cos(b t): stages at the wrong times would still be consistent for y' = f(y)."""
    own = integrator(1, 2, lambda y, t, p: [p[0] * ca.cos(p[1] * t)])
    a, b = np.array([1.0, -2.0, 0.3]), np.array([1.0, 3.0, 11.0])
    times = np.array([0.3, 1.0, 4.0])
    found = solved(own, np.zeros((3, 1)), np.column_stack([a, b]), times, 1e-13)
    wanted = (a / b)[:, None] * np.sin(np.outer(b, times))
    np.testing.assert_allclose(found.states[..., 0], wanted, rtol=0, atol=1e-11)


def test_fast_decay() -> None:
    """y' = -1000 (y - cos t) holds the steps to 1/1000 s, and the result to the tolerance."""
    own = integrator(1, 0, lambda y, t, p: [-1000 * (y[0] - ca.cos(t))])
    found = solved(own, [0.0], [[]], [2.0], 1e-10)
    wanted = 1000 * (1000 * np.cos(2.0) + np.sin(2.0)) / (1000**2 + 1)
    assert found.final[0, 0] == pytest.approx(wanted, abs=1e-9)
    assert 200 < found.steps[0] < 2000


# -------------------------------------------------------------------------- how lanes end


def test_solution_that_runs_away_is_told_and_alone() -> None:
    rates = np.array([0.1, 1.0, 0.5])
    found = solved(growth(), np.ones((3, 1)), rates, [0.5, 1.5], 1e-11)
    assert [STATUS[s] for s in found.status] == ["duration", "not finite", "duration"]
    assert found.end[1] == pytest.approx(1.0, abs=1e-6)
    keep = [0, 2]
    np.testing.assert_allclose(found.final[keep, 0], 1 / (1 - rates[keep] * 1.5), rtol=1e-9, atol=0)
    assert found.states[1, 0, 0] == pytest.approx(2.0, rel=1e-9)
    assert found.states[1, 1, 0] == found.final[1, 0]


def test_rate_that_is_no_number_is_told_at_once() -> None:
    """√(p - t) has no value after p: shorter steps, then the end, not a million tries."""
    own = integrator(1, 1, lambda y, t, p: [ca.sqrt(p[0] - t)])
    found = solved(own, np.ones((3, 1)), [10.0, 1.0, -1.0], [0.5, 1.5], 1e-9)
    assert [STATUS[s] for s in found.status] == ["duration", "not finite", "not finite"]
    assert found.end[1] == pytest.approx(1.0, abs=1e-6)
    assert found.end[2] == 0.0
    assert found.steps.max() < 1000
    assert found.final[0, 0] == pytest.approx(1 + (10**1.5 - 8.5**1.5) / 1.5, rel=1e-9)


def test_start_that_is_no_number() -> None:
    start = np.array([[1.0], [np.nan], [np.inf], [1.0]])
    found = solved(growth(), start, np.full(4, 0.1), [1.0])
    assert [STATUS[s] for s in found.status] == [
        "duration", "not finite", "not finite", "duration",
    ]  # fmt: skip
    assert found.steps.max() < 1000
    assert found.final[0, 0] == found.final[3, 0] == pytest.approx(1 / 0.9, rel=1e-11)


def test_step_limit() -> None:
    free = solved(plain_oscillator(), np.ones((2, 2)), [1.0, 100.0], [3.0])
    assert free.steps[0] < 40 < free.steps[1]
    found = plain_oscillator().solve(
        np.ones((2, 2)), np.array([[1.0], [100.0]]), np.array([3.0]), 1e-12, most_steps=40
    )
    assert [STATUS[s] for s in found.status] == ["duration", "too many steps"]
    assert found.steps.tolist() == [free.steps[0], 40]
    assert np.array_equal(found.final[0], free.final[0])
    assert 0 < found.end[1] < 3.0


def test_each_lane_has_its_own_end() -> None:
    ends = np.array([0.0, 0.7, 1.3, 2.0, 9.0])
    found = solved(plain_oscillator(), [[1.0, 0.0]] * 5, [2.0] * 5, [1.0, 2.0], 1e-13, ends)
    reached = np.minimum(ends, 2.0)
    assert np.array_equal(found.end, reached)
    np.testing.assert_allclose(found.final[:, 0], np.cos(2 * reached), rtol=0, atol=1e-11)
    held = np.minimum(ends[:, None], [1.0, 2.0])
    np.testing.assert_allclose(found.states[..., 0], np.cos(2 * held), rtol=0, atol=1e-11)
    assert {STATUS[s] for s in found.status} == {"duration"}
    assert found.steps[0] == 0


# ------------------------------------------------------------------------ samples in time


def test_samples_are_met_exactly() -> None:
    """With y' = 1 the state is the time; a clock that only adds its steps would drift."""
    own = integrator(2, 0, lambda y, t, p: [ca.SX(1.0), 2 * t])
    times = np.sort(np.random.default_rng(5).uniform(0, 30, 200))
    found = solved(own, [0.0, 0.0], [[]], times)
    np.testing.assert_allclose(found.states[0, :, 0], times, rtol=4e-15, atol=0)
    np.testing.assert_allclose(found.states[0, :, 1], times**2, rtol=1e-14, atol=0)
    assert found.end[0] == times[-1]


def test_first_sample_may_be_the_start() -> None:
    found = solved(euler(), [0.1, 0.9, 0.4], [[]], [0.0, 1.0])
    assert found.states[0, 0].tolist() == [0.1, 0.9, 0.4]


@pytest.mark.parametrize("count", [2, 50, 5000])
def test_samples_do_not_matter_to_the_result(count: int) -> None:
    start, alone = [0.0, 1.0, 1.0], solved(euler(), [0.0, 1.0, 1.0], [[]], [20.0], 1e-11)
    often = solved(euler(), start, [[]], np.linspace(0, 20.0, count), 1e-11)
    np.testing.assert_allclose(often.final, alone.final, rtol=0, atol=1e-10)
    assert often.steps[0] <= alone.steps[0] + count


# ------------------------------------------------------------------------------- events


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-12])
def test_events_do_not_depend_on_the_tolerance(tolerance: float) -> None:
    """y = t⁵ is exact in steps of any size, so all that is seen is the search."""
    own = integrator(1, 1, lambda y, t, p: [5 * t**4], lambda y, t, p: y[0] - p[0])
    levels = np.array([1e-3, 0.5, 1.0, 7.0, 100.0, 242.9])
    found = solved(own, np.zeros((6, 1)), levels, [3.0], tolerance)
    assert {STATUS[s] for s in found.status} == {"event"}
    np.testing.assert_allclose(found.end, levels**0.2, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found.final[:, 0], levels, rtol=1e-13, atol=0)


def test_events_against_a_closed_form() -> None:
    """cos w t falls through its level; where it never gets there, or only later, no event."""
    w = np.array([1.0, 3.0, 20.0, 2.0, 0.1, 1.0])
    levels = np.array([0.3, -0.9, 0.0, 1.7, 0.2, -0.999])
    found = solved(
        oscillator(), [[1.0, 0.0]] * 6, np.column_stack([w, levels]), [1.0, 2.5, 4.0], 1e-13
    )
    event = np.array([True, True, True, False, False, True])
    assert np.array_equal(found.status == ENDED["event"], event)
    wanted = np.where(event, np.arccos(np.clip(levels, -1, 1)) / w, 4.0)
    # The slope at the level magnifies what error the state has.
    slope = np.sqrt(1 - np.clip(levels, -1, 0.99) ** 2)
    assert np.all(np.abs(found.end - wanted) < 1e-12 / slope)
    np.testing.assert_allclose(found.final[event, 0], levels[event], rtol=0, atol=1e-13)
    # A sample after the event has the state at the event... or before, never beyond.
    assert np.all(found.states[event, -1, 0] >= levels[event] - 1e-13)


def test_end_before_the_event() -> None:
    end = np.array([1.0, 2.0])
    found = solved(oscillator(), [[1.0, 0.0]] * 2, [[1.0, 0.0]] * 2, [3.0], 1e-12, end)
    assert [STATUS[s] for s in found.status] == ["duration", "event"]
    np.testing.assert_allclose(found.end, [1.0, np.pi / 2], rtol=0, atol=1e-11)


# ------------------------------------------------------------------- lanes and threads


def many(count: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(8)
    start, parameters = rng.normal(size=(400, 2)), np.exp(rng.normal(size=(400, 2)))
    start[17] = np.nan  # one that breaks must not show in the others
    parameters[30, 0] = 300.0  # nor one that takes far more steps
    return start[:count], parameters[:count]


def flown(count: int) -> Solution:
    return oscillator().solve(*many(count), np.array([0.4, 1.0, 2.0]), 1e-10)


def same(one: Solution, other: Solution, count: int) -> None:
    for name in ("states", "end", "final", "status", "steps"):
        a, b = getattr(one, name)[:count], getattr(other, name)[:count]
        assert np.array_equal(a, b, equal_nan=name in ("states", "final")), name


@pytest.fixture(scope="module")
def whole() -> Solution:
    return flown(361)


@pytest.mark.parametrize("count", [1, 7, 8, 9, 361])
@pytest.mark.parametrize("threads", [1, 2])
def test_batches_and_threads_do_not_matter(count: int, threads: int, whole: Solution) -> None:
    """Bit for bit; with events, whose search goes on until the last lane has found its own."""
    with use_threads(threads):
        same(flown(count), whole, count)


def test_neighbours_do_not_matter(whole: Solution) -> None:
    """Lanes in another order, in other blocks, beside other lanes."""
    start, parameters = many(361)
    order = np.random.default_rng(9).permutation(361)
    mixed = oscillator().solve(start[order], parameters[order], np.array([0.4, 1.0, 2.0]), 1e-10)
    back = np.argsort(order)
    again = Solution(*(getattr(mixed, field.name)[back] for field in fields(Solution)))
    same(again, whole, 361)


def test_the_last_step_that_is_allowed_may_be_the_one_that_arrives() -> None:
    start, rate = np.ones((1, 2)), np.array([[10.0]])
    needed = int(plain_oscillator().solve(start, rate, np.array([3.0]), 1e-12).steps[0])
    for limit, ended in ((needed, "duration"), (needed - 1, "too many steps")):
        found = plain_oscillator().solve(start, rate, np.array([3.0]), 1e-12, most_steps=limit)
        assert STATUS[found.status[0]] == ended
