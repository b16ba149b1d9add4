"""Turns at the singularity of somersault and twist (tilt ±π/2), and next to it.

A body of three unlike inertias that turns steadily about its head-to-foot axis has closed forms:
that axis stands still, so somersault and tilt do, and the twist goes with the rate. On its way by
the singularity the angles are integrated as angles (eq. 2.3), backwards and forwards from the
nearest point, so that the reference is never near it in a single long step.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from test_axes_flight import redrawn, retold, sign

import somersault as so
from somersault.attitude import Axes, angle_rates, direction_cosines

ANGLES = ("somersault", "tilt", "twist")
RATE = 8.0  # rad/s
INERTIAS = np.diag(np.array(so.load("book").bodies[0].inertia))


def landed(
    takeoff: so.Takeoff, duration: float, axes: Axes = (2, 1, 3)
) -> tuple[list[np.ndarray], list[int]]:
    """Angles (3,) at the end, of one flight and of an ensemble's, and the steps of each."""
    book = redrawn(so.load("book"), axes)
    told = retold(takeoff, axes)
    end = so.fly(book, told, duration)
    many = so.ensemble(book, told, duration, report=ANGLES).dataset
    turned = np.array([sign(axes), 1.0, 1.0])
    angles = [
        turned * [end.landing.somersault, end.landing.tilt, end.landing.twist],
        turned * [float(many[name].values.item()) for name in ANGLES],
    ]
    return angles, [end.steps, int(many["steps"].values.item())]


@pytest.mark.parametrize("off", [1e-3, 1e-5, 1e-7])
@pytest.mark.parametrize("side", [1, -1])
def test_next_to_the_singularity_a_steady_twist_is_a_twist(off: float, side: int) -> None:
    tilt = side * (np.pi / 2 - off)
    takeoff = so.Takeoff(0.2, tilt, 0.3, angular_velocity=(0.0, 0.0, RATE))
    for angles in landed(takeoff, 3.0)[0]:
        np.testing.assert_allclose(angles, [0.2, tilt, 0.3 + 3 * RATE], rtol=0, atol=1e-6)


@pytest.mark.parametrize("off", [0.0, 1e-12, 1e-10, -1e-10])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("axes", [(2, 1, 3), (3, 2, 1)])
def test_at_the_singularity_the_sum_or_difference_that_is_free_stays(
    off: float, side: int, axes: Axes
) -> None:
    """The other one turns with the body, as its closed form says, in work that is bounded."""
    tilt = side * (np.pi / 2 - off)
    takeoff = so.Takeoff(0.2, tilt, 0.3, angular_velocity=(0.0, 0.0, RATE))
    for duration in (1.0, 10.0):
        every, steps = landed(takeoff, duration, axes)
        for angles in every:
            free, turning = angles[0] + side * angles[2], angles[0] - side * angles[2]
            assert free == pytest.approx(0.2 + side * 0.3, abs=1e-7)
            assert turning == pytest.approx(0.2 - side * (0.3 + RATE * duration), abs=1e-6)
            wanted = direction_cosines(0.2, tilt, 0.3 + RATE * duration)
            np.testing.assert_allclose(direction_cosines(*angles), wanted, rtol=0, atol=1e-6)
        assert max(steps) < 200 * RATE * duration


@pytest.mark.parametrize("nearest", [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7])
@pytest.mark.parametrize("seed", range(3))
def test_turns_are_those_of_the_side_that_a_path_goes_by(nearest: float, seed: int) -> None:
    random = np.random.default_rng(seed)
    tilt, twist = (np.pi / 2 - nearest) * random.choice([-1, 1]), random.uniform(-3, 3)
    across = random.uniform(3, 6) * random.choice([-1, 1])
    omega = [across * np.sin(twist), across * np.cos(twist), random.uniform(-3, 3)]
    at = [0.1, tilt, twist, *omega]  # tilt is at its turning point here

    def slope(_: float, y: np.ndarray) -> np.ndarray:
        turning = np.cross(INERTIAS * y[3:], y[3:]) / INERTIAS
        return np.concatenate([angle_rates(y[:3], y[3:]), turning])

    before, after = (
        solve_ivp(slope, (0, end), at, "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
        for end in (-0.35, 0.5)
    )
    takeoff = so.Takeoff(*before[:3].tolist(), angular_velocity=before[3:].tolist())
    every, steps = landed(takeoff, 0.85)
    for angles in every:
        np.testing.assert_allclose(angles, after[:3], rtol=0, atol=1e-4)
    assert max(steps) < 500


def test_a_path_through_the_singularity_tilts_on() -> None:
    takeoff = so.Takeoff(0.0, 0.3, 0.0, angular_velocity=(RATE, 0.0, 0.0))
    for angles in landed(takeoff, 2.0)[0]:
        np.testing.assert_allclose(angles, [0.0, 0.3 + 2 * RATE, 0.0], rtol=0, atol=1e-6)


@pytest.mark.parametrize("side", [1, -1])
def test_rates_at_the_singularity_are_those_of_what_turns(side: int) -> None:
    takeoff = so.Takeoff(0.2, side * np.pi / 2, 0.3, angular_velocity=(0.0, 0.0, RATE))
    names = ("somersault_rate", "twist_rate")
    many = so.ensemble("book", takeoff, 1.0, report=so.Report(names, extremes=names)).dataset
    for name, rate in zip(names, (-side * RATE / 2, RATE / 2), strict=True):
        for which in (name, f"least_{name}", f"greatest_{name}"):
            assert float(many[which].values.item()) == pytest.approx(rate, rel=1e-6)
