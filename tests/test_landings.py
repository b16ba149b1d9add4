"""Maps and derivatives of landings, against flights flown one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import somersault as so
from somersault.ensembles import landing_derivatives, landing_map
from somersault.flight import landing_target

TWIST = so.arm_tilt(duration=0.8)


@pytest.fixture(scope="module")
def nominal() -> so.Flight:
    return TWIST.fly(accuracy=1e-10)


def flown(tilt: float, twist: float) -> so.Landing:
    takeoff = replace(TWIST.takeoff, tilt=tilt, twist=twist)
    return so.fly(TWIST.model, takeoff, TWIST.duration, accuracy=1e-10).landing


def test_the_map_is_of_flights_flown_one_by_one(nominal):
    found = landing_map(TWIST, nominal, span=0.2, points=3)
    error = found.dataset["landing_error"]
    assert error.dims == ("takeoff_tilt", "takeoff_twist")
    wanted = nominal.landing
    for tilt, twist in ((-0.2, 0.0), (0.2, -0.2)):
        end = flown(tilt, twist)
        body = [getattr(end, n) - getattr(wanted, n) for n in ("somersault", "tilt", "twist")]
        here = float(error.sel(takeoff_tilt=tilt, takeoff_twist=twist))
        # All joints are prescribed, so that they end where they should.
        assert here == pytest.approx(np.linalg.norm(body) / 2, abs=1e-4)
    assert float(error[1, 1]) < 1e-5


def test_a_landing_hits_its_own_target(nominal):
    target = landing_target(nominal)
    assert set(target) == {"somersault", "tilt", "twist", *nominal.system.model.coordinates}
    assert target["twist"] == nominal.landing.twist


def test_derivatives_are_those_of_larger_steps_flown_one_by_one():
    found = landing_derivatives(TWIST)
    step = 1e-3
    for name, ends in {
        "takeoff.tilt": (flown(step, 0), flown(-step, 0)),
        "takeoff.twist": (flown(0, step), flown(0, -step)),
    }.items():
        for what in ("somersault", "tilt", "twist"):
            slope = (getattr(ends[0], what) - getattr(ends[1], what)) / (2 * step)
            here = float(found.sel(landing=what, takeoff=name))
            assert here == pytest.approx(slope, rel=1e-3, abs=1e-3)


def test_derivatives_of_a_steady_spin_are_known():
    """A rigid spin about a principal axis turns by ω t, whatever its somersault at takeoff."""
    spin = so.Maneuver(so.load("book"), so.Takeoff(somersault=0.4, spin=6.0), 0.5)
    found = landing_derivatives(spin, ("somersault",), ("takeoff.somersault", "takeoff.spin"))
    np.testing.assert_allclose(found.values, [[1.0, 0.5]], atol=1e-6)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda spin: landing_map(spin, span=0.0), "span 0 rad"),
        (lambda spin: landing_map(spin, points=0), "count"),
        (lambda spin: landing_derivatives(spin, step=-1.0), "step -1"),
        (lambda spin: landing_derivatives(spin, of=("tlt",)), "tlt"),
        (lambda spin: landing_derivatives(spin, to="takeoff.tilt"), "list of names"),
    ],
)
def test_what_is_refused(call, said):
    with pytest.raises(so.SomersaultError, match=said):
        call(so.Maneuver(so.load("book"), so.Takeoff(spin=6.0), 0.1))


@pytest.mark.parametrize("call", [landing_map, landing_derivatives])
@pytest.mark.parametrize("wrong", ["furrer", None, 3])
def test_what_is_no_maneuver_is_refused(call, wrong):
    with pytest.raises(so.SomersaultError, match=r"maneuver must be a somersault\.Maneuver"):
        call(wrong)
