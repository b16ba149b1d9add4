"""Pieces that end by a clock whose rate is set at ticks, against closed forms and by hand."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from somersault.engine import CLOCK, Integrator, Pieces, clock_at

EVERY = 0.1


def clocked() -> Integrator:
    """ẋ = s, a number that changes; the clock's rate goes to 1 + g x by the next tick."""
    x = ca.SX.sym("x", 1 + CLOCK + 3)  # x, the clock; the time; s; g
    clock, time, slope, gain = [x[k] for k in range(1, 5)], x[5], x[6], x[7]
    shown, rate, _ = clock_at(clock, time)
    wanted = ca.fmin(ca.fmax(1 + gain * x[0], 0.5), 2.0)
    tick = ca.vertcat(time, shown, rate, (wanted - rate) / EVERY)
    return Integrator(
        ca.Function("slope", [x], [slope]), changing=1, tick=ca.Function("tick", [x], [tick]),
        clock=1,
    )  # fmt: skip


def by_hand(gain: float, knots: np.ndarray, slopes: np.ndarray, end: float) -> float:
    """x at the end, from tick to tick and knot to knot."""
    x, shown, rate, piece = 0.0, 0.0, 1.0, 0
    for _ in range(round(end / EVERY)):
        bend = (np.clip(1 + gain * x, 0.5, 2.0) - rate) / EVERY
        begun, left = 0.0, EVERY
        while piece < len(knots):
            roots = np.roots([bend / 2, rate, shown - knots[piece]])
            ahead = [t.real for t in roots if abs(t.imag) < 1e-12 and begun <= t.real < EVERY]
            if not ahead:
                break
            x += slopes[piece] * (min(ahead) - begun)
            begun, piece = min(ahead), piece + 1
            left = EVERY - begun
        x += slopes[piece] * left
        shown, rate = shown + rate * EVERY + bend * EVERY**2 / 2, rate + bend * EVERY
    return x


def test_knots_are_reached_when_the_clock_shows_them() -> None:
    rng = np.random.default_rng(5)
    count, gains = 21, np.linspace(-3.0, 3.0, 21)
    knots = np.sort(rng.uniform(0, 2.5, (count, 6)), 1)
    slopes = rng.normal(size=(count, 7))
    ends = np.concatenate([knots, np.full((count, 1), 1.6)], 1)
    start = np.tile([0.0, 0.0, 0.0, 1.0, 0.0], (count, 1))
    done = clocked().solve(
        start, gains[:, None], np.array([0.83, 1.6]), 1e-12,
        pieces=Pieces(ends, slopes[..., None]), every=EVERY,
    )  # fmt: skip
    expected = [by_hand(gains[k], knots[k], slopes[k], 1.6) for k in range(count)]
    np.testing.assert_allclose(done.final[:, 0], expected, rtol=0, atol=1e-12)
    assert np.all(done.end == 1.6)
    assert np.ptp(done.final[:, 2]) > 0.3  # the clocks went differently


def test_without_a_gain_the_clock_shows_the_time() -> None:
    """A slow clock does not see the last pieces, and a flight ends in time."""
    pieces = Pieces(np.array([[0.25, 0.5, 0.75, 0.9, 1.0]]), np.arange(1.0, 6.0)[None, :, None])
    start = np.array([[0.0, 0.0, 0.0, 1.0, 0.0]])
    done = clocked().solve(
        start, np.zeros((1, 1)), np.array([0.6]), 1e-12, pieces=pieces, every=EVERY
    )
    assert done.final[0, 0] == pytest.approx(0.25 + 0.5 + 0.3, abs=1e-14)
    assert done.end[0] == 0.6


def test_a_knot_at_a_tick_is_met_once() -> None:
    knots = EVERY * np.arange(1, 10)
    pieces = Pieces(np.append(knots, 1.0)[None], np.arange(10.0)[None, :, None])
    start = np.array([[0.0, 0.0, 0.0, 1.0, 0.0]])
    done = clocked().solve(
        start, np.zeros((1, 1)), np.array([1.0]), 1e-12, pieces=pieces, every=EVERY
    )
    assert done.final[0, 0] == pytest.approx(4.5, abs=1e-12)
