"""What flights carry from tick to tick, against the closed form of sampled control."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from somersault.engine import Integrator

K, EVERY = 3.0, 0.125


def sampled(gain_by_flight: bool = True) -> Integrator:
    """ẋ = c, where c = −g x at each tick and a count goes up by one."""
    x = ca.SX.sym("x", 5)  # x, then carried: c and the count; the time; the gain
    slope = ca.Function("slope", [x], [x[1]])
    tick = ca.Function("tick", [x], [ca.vertcat(-x[4] * x[0], x[2] + 1)])
    return Integrator(slope, tick=tick)


def test_a_sampled_integrator_is_a_power() -> None:
    """x(t_k) = (1 − g T)^k, and between ticks it is straight."""
    gains = np.linspace(0.5, 12.0, 21)
    start = np.tile([1.0, 0.0, 0.0], (len(gains), 1))
    times = np.array([0.0, 0.3, 1.0, 1.0 + EVERY / 2])
    done = sampled().solve(start, gains[:, None], times, 1e-12, every=EVERY)
    factor = 1 - gains * EVERY
    expected = np.stack(
        [
            np.ones_like(gains),
            factor**2 * (1 - gains * (0.3 - 2 * EVERY)),
            factor**8,
            factor**8 * (1 - gains * EVERY / 2),
        ],
        1,
    )
    np.testing.assert_allclose(done.states[..., 0], expected, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(done.states[:, 2, 1], -gains * factor**7, rtol=1e-12, atol=1e-12)
    np.testing.assert_array_equal(done.states[:, :, 2], np.tile([0, 3, 8, 9], (len(gains), 1)))
    assert np.all(done.status == 0)


def test_a_flight_does_not_depend_on_its_neighbours() -> None:
    gains = np.linspace(0.5, 12.0, 21)
    start = np.tile([1.0, 0.0, 0.0], (len(gains), 1))
    times = np.array([0.7])
    every = sampled().solve(start, gains[:, None], times, 1e-12, every=EVERY)
    alone = [
        sampled().solve(start[:1], np.array([[g]]), times, 1e-12, every=EVERY).final[0]
        for g in gains
    ]
    np.testing.assert_array_equal(every.final, alone)


def test_ticks_go_on_past_pieces_and_events() -> None:
    """A gauge is looked for between ticks, and pieces end between them."""
    x = ca.SX.sym("x", 4)  # x, then carried c; the time; what changes
    slope = ca.Function("slope", [x], [x[1] + x[3]])
    tick = ca.Function("tick", [x], [ca.vertcat(x[0] + 1.0)])
    gauge = ca.Function("gauge", [x], [x[0] - 2.0])
    from somersault.engine import Pieces

    pieces = Pieces(np.array([[0.4, 3.0]]), np.array([[[0.0], [1.0]]]))
    one = Integrator(slope, gauge, changing=1, tick=tick)
    done = one.solve(
        np.array([[0.0, 0.0]]), np.empty((1, 0)), np.array([3.0]), 1e-13, pieces=pieces, every=0.25
    )
    position, time = 0.0, 0.0  # by hand, from corner to corner
    for k in range(100):
        carried = position + 1.0
        for end in sorted({0.25 * (k + 1), *([0.4] if 0.25 * k < 0.4 < 0.25 * (k + 1) else [])}):
            rate = carried + (1.0 if time >= 0.4 else 0.0)
            if position + rate * (end - time) >= 2.0:
                assert done.end[0] == pytest.approx(time + (2.0 - position) / rate, abs=1e-12)
                return
            position, time = position + rate * (end - time), end
    raise AssertionError("no event")


def test_ticks_need_a_time() -> None:
    with pytest.raises(ValueError, match="ticks"):
        sampled().solve(np.zeros((1, 3)), np.ones((1, 1)), np.array([1.0]), 1e-9)
