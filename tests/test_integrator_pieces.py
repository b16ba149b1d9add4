"""Parameters that change on the way, samples of a flight's own, and the queue of flights."""

from __future__ import annotations

from functools import cache

import casadi as ca
import numpy as np
import pytest

from somersault.engine import STATUS, Integrator, Pieces, use_threads

rng = np.random.default_rng(11)


@cache
def ramp(event: bool = False) -> Integrator:
    """y' = a + b t + c of (a, b), which change, and c, which stays; with the gauge y − 1."""
    x = ca.SX.sym("x", 5)  # y, t, a, b, c
    slope = ca.Function("slope", [x], [x[2] + x[3] * x[1] + x[4]])
    gauge = ca.Function("gauge", [x], [x[0] - 1]) if event else None
    return Integrator(slope, gauge, changing=2)


def integral(ends: np.ndarray, numbers: np.ndarray, c: float, y: float, t: float) -> float:
    """y at a time, in closed form."""
    begin = 0.0
    for end, (a, b) in zip(ends, numbers, strict=True):
        upto = min(max(end, begin), t)
        y += (a + c) * (upto - begin) + b * (upto**2 - begin**2) / 2
        begin = upto
    return y


def some(count: int, pieces: int) -> tuple[np.ndarray, ...]:
    start, still = rng.normal(size=(count, 1)), rng.normal(size=(count, 1))
    ends = np.sort(rng.uniform(0, 2, (count, pieces)), 1)
    ends[1::3, 2] = ends[1::3, 1]  # a piece without length
    return start, still, ends, rng.normal(size=(count, pieces, 2))


@pytest.mark.parametrize("count", [1, 5, 83])
def test_each_flight_has_pieces_of_its_own(count: int) -> None:
    start, still, ends, numbers = some(count, 5)
    found = ramp().solve(start, still, np.array([2.0]), 1e-12, pieces=Pieces(ends, numbers))
    assert np.array_equal(found.end, ends[:, -1])
    wanted = [integral(ends[k], numbers[k], still[k, 0], start[k, 0], 2.0) for k in range(count)]
    np.testing.assert_allclose(found.final[:, 0], wanted, rtol=0, atol=1e-13)


def test_pieces_and_parameters_in_common() -> None:
    _, _, ends, numbers = some(1, 5)
    start = rng.normal(size=(30, 1))
    found = ramp().solve(
        start, np.array([[0.5]]), np.array([2.0]), 1e-12, pieces=Pieces(ends, numbers)
    )
    wanted = [integral(ends[0], numbers[0], 0.5, y, 2.0) for y in start[:, 0]]
    np.testing.assert_allclose(found.final[:, 0], wanted, rtol=0, atol=1e-13)


def test_samples_of_each_flights_own_may_be_alike_and_lie_at_knots() -> None:
    start, still, ends, numbers = some(20, 5)
    ends[:, -1] = 2.0
    times = np.sort(np.concatenate([ends, rng.uniform(0, 2, (20, 6)), ends[:, 2:3]], 1), 1)
    found = ramp().solve(start, still, times, 1e-12, pieces=Pieces(ends, numbers))
    wanted = [
        [integral(ends[k], numbers[k], still[k, 0], start[k, 0], t) for t in times[k]]
        for k in range(20)
    ]
    np.testing.assert_allclose(found.states[..., 0], wanted, rtol=0, atol=1e-13)


def test_a_sample_after_the_end_shows_the_last_state() -> None:
    start, still, ends, numbers = some(20, 5)
    found = ramp().solve(start, still, np.linspace(0, 2, 7), 1e-12, pieces=Pieces(ends, numbers))
    assert np.array_equal(found.states[:, -1], found.final)
    first = found.states[:, 0]
    assert np.array_equal(first, start)


def test_an_event_in_a_later_piece() -> None:
    """y = 0 until 1 s, then t − 1: it is 1 at 2 s, whatever the steps."""
    ends = np.array([[1.0, 3.0]])
    numbers = np.array([[[0.0, 0.0], [1.0, 0.0]]])
    found = ramp(event=True).solve(
        np.zeros((9, 1)), np.array([[0.0]]), np.array([3.0]), 1e-9, pieces=Pieces(ends, numbers)
    )
    assert {STATUS[s] for s in found.status} == {"event"}
    np.testing.assert_allclose(found.end, 2.0, rtol=0, atol=1e-15)


def test_an_event_at_the_very_end_of_a_step() -> None:
    """The step lands on a sample where the gauge is exactly zero, and not on either side."""
    found = ramp(event=True).solve(
        np.zeros((1, 1)), np.array([[1.0]]), np.array([1.0, 2.0]), 1e-9,
        pieces=Pieces(np.array([[2.0]]), np.zeros((1, 1, 2))),
    )  # fmt: skip
    assert STATUS[found.status[0]] == "event"
    assert found.end[0] == pytest.approx(1.0, abs=1e-15)


def test_a_start_on_the_gauge_is_no_event() -> None:
    found = ramp(event=True).solve(
        np.ones((1, 1)), np.array([[1.0]]), np.array([2.0]), 1e-9,
        pieces=Pieces(np.array([[2.0]]), np.zeros((1, 1, 2))),
    )  # fmt: skip
    assert STATUS[found.status[0]] == "duration"


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_the_queue_gives_every_flight_once(threads: int) -> None:
    """Flights of very different length, on more threads than there are lanes to fill."""
    start, still, ends, numbers = some(301, 5)
    ends *= np.exp(rng.normal(size=(301, 1)))
    pieces = Pieces(ends, numbers)
    with use_threads(threads):
        found = ramp().solve(start, still, np.array([100.0]), 1e-12, pieces=pieces)
    assert np.array_equal(found.end, ends[:, -1])
    alone = [
        ramp().solve(
            start[k : k + 1], still[k : k + 1], np.array([100.0]), 1e-12,
            pieces=Pieces(ends[k : k + 1], numbers[k : k + 1]),
        ).final[0, 0]
        for k in range(0, 301, 25)
    ]  # fmt: skip
    assert np.array_equal(found.final[::25, 0], alone)


def test_parameters_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ValueError, match="not the parameters"):
        ramp().solve(np.zeros((1, 1)), np.zeros((1, 1)), np.array([1.0]), 1e-9)
