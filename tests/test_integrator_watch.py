"""What the compiled integration watches: turns, against counting them on dense samples."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import somersault as so
from somersault.attitude import Axes, quaternion_from_angles, unwrapped_angles
from somersault.flight import Takeoff

ANGLES = ("somersault", "tilt", "twist")
BY = 0.04  # in cos Θ: steps of the watch tell through and by the singularity apart down to here

numbers = st.floats(-1.0, 1.0).map(lambda x: round(x, 6))
random_spins = given(
    st.tuples(numbers, numbers, numbers),
    st.tuples(*[numbers] * 3),
    st.floats(0.5, 12.0),
    st.sampled_from(sorted(permutations((1, 2, 3)), key=lambda axes: axes != (2, 1, 3))),
)


def tumble(axis: tuple, angles: tuple, speed: float) -> Takeoff:
    """A book at angles within a turn, turning about an axis of its own."""
    direction = np.array(axis)
    assume(np.linalg.norm(direction) > 0.1)
    omega = speed * direction / np.linalg.norm(direction)
    return Takeoff(*(3 * np.array(angles)).tolist(), angular_velocity=tuple(omega.tolist()))


def watched(takeoff: Takeoff, duration: float, count: int, axes: Axes = (2, 1, 3)) -> np.ndarray:
    """Angles (count, 3) as they are counted from step to step, on the integrator's own steps."""
    report = so.Report(ANGLES, history=ANGLES, samples=count)
    book = so.load("book", axes=axes)
    made = so.ensemble(book, takeoff, duration, report=report, accuracy=1e-10).dataset
    seen = np.stack([made[f"{name}_history"].values[0] for name in ANGLES], 1)
    np.testing.assert_array_equal(seen[-1], [made[name].values[0] for name in ANGLES])
    return seen


def attitudes(takeoff: Takeoff, duration: float, count: int, axes: Axes) -> np.ndarray:
    book = so.load("book", axes=axes)
    flight = so.fly(book, takeoff, duration, samples=count, accuracy=1e-11)
    return flight.dataset["quaternion"].values


@settings(max_examples=80, deadline=None)
@random_spins
def test_turns_are_those_of_dense_samples(
    axis: tuple, angles: tuple, speed: float, axes: Axes
) -> None:
    """Of a book that tumbles about any axis, with steps as long as the integrator likes.

    Dense samples are 0.004 rad apart, so that they count rightly what goes by the singularity
    in a hundredth; a step of the watch may be ten times as far.
    """
    takeoff = tumble(axis, angles, speed)
    dense = unwrapped_angles(attitudes(takeoff, 3.0, 10_001, axes), axes)
    assume(np.abs(np.cos(dense[:, 1])).min() > BY)
    seen = watched(takeoff, 3.0, 3, axes)
    np.testing.assert_allclose(seen[0], 3 * np.array(angles), atol=1e-15)
    # From the same start, in the one or the other representation of it.
    second = dense + np.pi
    second[:, 1] = np.pi - dense[:, 1]
    turned = [seen - path[::5_000] for path in (dense, second)]
    wanted = min(turned, key=lambda off: np.abs(np.sin(off[0] / 2)).max())
    assert np.abs(np.sin(wanted[0] / 2)).max() < 1e-12
    np.testing.assert_allclose(wanted - wanted[0], 0.0, atol=1e-6)


@settings(max_examples=60, deadline=None)
@random_spins
def test_watched_angles_are_the_attitude(
    axis: tuple, angles: tuple, speed: float, axes: Axes
) -> None:
    """However near the singularity."""
    takeoff = tumble(axis, angles, speed)
    turned = quaternion_from_angles(*watched(takeoff, 3.0, 4, axes).T, axes)
    same = np.abs(np.sum(turned * attitudes(takeoff, 3.0, 4, axes), 1))
    np.testing.assert_allclose(same, 1.0, atol=1e-12)


@pytest.mark.parametrize("by", [0.0, 1e-9, -1e-9, 1e-12])
@pytest.mark.parametrize("speed", [2.0, 9.0])
def test_a_pure_tilt_runs_on_through_the_singularity(by: float, speed: float) -> None:
    """Somersault and twist are at rest while tilt goes head over heels."""
    angles = watched(Takeoff(angular_velocity=(speed, by, 0.0)), 3.0, 7)
    np.testing.assert_allclose(angles[:, 1], speed * np.linspace(0.0, 3.0, 7), atol=1e-6)
    np.testing.assert_allclose(angles[:, [0, 2]], 0.0, atol=1e-5)


def test_takeoff_at_the_singularity_itself() -> None:
    """The angles asked for are kept, and what follows is counted as `fly` counts it."""
    takeoff = Takeoff(0.3, np.pi / 2, 0.2, angular_velocity=(1.0, 0.0, 2.0))
    angles = watched(takeoff, 0.5, 2)
    np.testing.assert_array_equal(angles[0], [0.3, np.pi / 2, 0.2])
    landing = so.fly("book", takeoff, 0.5).landing
    wanted = (landing.somersault, landing.tilt, landing.twist)
    np.testing.assert_allclose(angles[-1], wanted, atol=1e-6)


@pytest.mark.parametrize("turns", [1, -7, 40])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_many_turns_about_each_axis(axis: int, turns: int) -> None:
    """A steady spin about a principal axis: no turn is missed and none counted twice."""
    omega = np.zeros(3)
    omega[axis] = 2 * np.pi * turns
    angles = watched(Takeoff(angular_velocity=tuple(omega)), 1.0, 2)
    wanted = np.zeros(3)
    wanted[(1, 0, 2)[axis]] = 2 * np.pi * turns  # tilt is about axis 1, somersault about 2
    np.testing.assert_allclose(angles[-1], wanted, atol=1e-6)
