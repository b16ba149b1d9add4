"""The dismount from the high bar, start by start."""

from __future__ import annotations

import numpy as np

from somersault.thesis.ch1._dismount_starts import CASES, RELEASE, WITH, WITHOUT, Start, dismount
from somersault.thesis.ch1._high_bar import GRAVITY, LANDING_HEIGHT, MASS, let_go, until

LATE = Start(later=0.02, faster=1.03)


def test_what_is_known_at_the_release_is_what_the_flight_does() -> None:
    seen = let_go(until(RELEASE + LATE.later, LATE.faster))
    flight = dismount(CASES[WITH], LATE).flight
    assert np.allclose(flight.angular_momentum[:, 1], seen.momentum, rtol=1e-6)
    height = np.interp(seen.time, flight.times, flight.centre_of_mass[:, 2])
    assert abs(height - LANDING_HEIGHT) < 1e-3


def test_the_push_through_the_feet_stops_fall_way_and_turn_together() -> None:
    seen = let_go(until(RELEASE))
    along, _, up = seen.release.takeoff.velocity
    falling = GRAVITY * seen.time - up
    # The impulse that stops the centre of mass, at the feet, forwards about the centre of mass.
    stopped = LANDING_HEIGHT * MASS * along - seen.ahead * MASS * falling
    assert abs(stopped + seen.momentum) < 1e-9 * abs(seen.momentum)


def test_the_feedback_lands_a_late_release_that_is_lost_by_heart() -> None:
    with_it, without = dismount(CASES[WITH], LATE), dismount(CASES[WITHOUT], LATE)
    assert with_it.stance.stood
    assert without.stance.ended == "fell"
    usual = dismount(CASES[WITH]).error
    assert abs(with_it.error - usual) < 0.03
    assert abs(without.error - usual) > 0.15


def test_both_land_the_nominal_release_alike() -> None:
    with_it, without = dismount(CASES[WITH]), dismount(CASES[WITHOUT])
    assert with_it.stance.stood
    assert without.stance.stood
    assert abs(with_it.error - without.error) < 0.01
