"""The centre of mass's parabola, against school formulas and flights."""

from __future__ import annotations

import numpy as np
import pytest

import somersault as so
from somersault.flight import BallisticPath


def test_thrown_straight_up_it_is_back_after_twice_v_over_g():
    path = BallisticPath((0, 0, 1.2), (0, 0, 3.0))
    assert path.time_to(1.2) == pytest.approx(2 * 3.0 / 9.81, rel=1e-14)
    assert path.apex == pytest.approx(1.2 + 9.0 / 19.62, rel=1e-14)
    assert path.time_to(path.apex) == pytest.approx(3.0 / 9.81, rel=1e-6)


def test_dropped_it_falls_as_galilei_says():
    assert BallisticPath((5, 5, 10), (0, 0, 0)).time_to(0.0) == pytest.approx(np.sqrt(20 / 9.81))


@pytest.mark.parametrize("gravity", [(0, 0, -9.81), (0, 0, -1.62), (0.5, -3.0, -8.0)])
def test_it_is_where_a_flight_has_its_centre_of_mass(gravity):
    position, velocity = np.array([0.1, -0.2, 1.0]), (1.0, 0.3, 4.0)
    path = BallisticPath(position, velocity, gravity)
    flight = so.fly("furrer", so.Takeoff(velocity=velocity, spin=5.0), 1.3, gravity=gravity)
    fallen = flight.dataset["centre_of_mass"].values
    np.testing.assert_allclose(path.at(flight.times), position + fallen, atol=1e-14)
    assert flight.ballistic_path.apex == pytest.approx(path.apex - path.height, abs=1e-14)
    time = path.time_to(0.3)
    up = -np.array(gravity) / np.linalg.norm(gravity)
    assert path.at([time])[0] @ up == pytest.approx(0.3, abs=1e-12)
    late = path.at(np.linspace(time, time + 0.5, 9)) @ up
    assert np.all(np.diff(late) < 0)  # the later of the two moments, on the way down
    assert (path.at(np.linspace(0, time, 5001)) @ up).max() == pytest.approx(path.apex, abs=1e-5)


def test_a_body_that_leaves_downwards_has_no_higher_place_to_land():
    path = BallisticPath((0, 0, 1.0), (0, 0, -2.0))
    assert path.time_to(1.0) == pytest.approx(0.0, abs=1e-15)
    with pytest.raises(so.SomersaultError, match="at most 1 m high"):
        path.time_to(1.1)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"velocity": (0, 0)}, "velocity must be 3 numbers"),
        ({"position": (0, 0, np.nan)}, "position must be finite"),
        ({"gravity": None}, "gravity must be 3 numbers"),
    ],
)
def test_what_is_no_path(given, said):
    with pytest.raises(so.SomersaultError, match=said):
        BallisticPath(**{"position": (0, 0, 1), "velocity": (0, 0, 1)} | given)


def test_without_gravity_it_goes_straight_on_and_never_down():
    path = BallisticPath((0, 0, 1), (1, 0, 2), (0, 0, 0))
    np.testing.assert_array_equal(path.at([0.0, 2.0]), [[0, 0, 1], [2, 0, 5]])
    with pytest.raises(so.SomersaultError, match="without gravity"):
        path.time_to(0.0)


def test_a_height_out_of_reach_is_refused_with_the_greatest():
    with pytest.raises(so.SomersaultError, match=r"does not come down to 3 m: .* 1\.05097 m"):
        BallisticPath((0, 0, 1), (0, 0, 1)).time_to(3.0)
