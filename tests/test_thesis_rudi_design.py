"""The rudi whose motion and compliance are designed together: data, example, flights."""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import somersault as so
from somersault.thesis.ch6 import _rudi as rudi
from somersault.thesis.ch7 import _rudi_momenta as momenta
from somersault.thesis.ch7 import _rudi_together as together

EXAMPLE = Path(__file__).parents[1] / "examples/rudi_design.py"
CASES: tuple[together.Case, ...] = ("fixed", "damped")


@pytest.fixture(scope="module")
def example() -> dict[str, Any]:
    return runpy.run_path(str(EXAMPLE))


def test_the_ready_rudi_with_the_gentle_ones_numbers_is_the_gentle_one() -> None:
    found = rudi.data("rudi_gentle")
    called = {"landing": "duration", "open": "stay"}
    numbers = {called.get(name, name): x for name, x in found["numbers"].items()}
    made = so.rudi(**numbers)
    assert made.duration == found["landing"]
    assert set(made.keyframes) == set(found["joints"])
    for name, path in found["joints"].items():
        kept = np.stack([path["times"], path["angles"]], 1)
        np.testing.assert_allclose(made.keyframes[name], kept, atol=1e-6)


@pytest.mark.parametrize("case", CASES)
def test_what_is_kept_is_within_what_the_example_may_choose(
    case: together.Case, example: dict[str, Any]
) -> None:
    kept = together.numbers(case)
    chosen = example["moves"]() | example["gains"](
        "frequency", example["FREQUENCIES"], example["GROUPS"]
    )
    if case == "damped":
        chosen |= example["gains"]("damping", example["RATIOS"], example["GROUPS"])
    assert list(kept) == list(chosen)
    for name, value in kept.items():
        low, high = chosen[name].between
        assert low <= value <= high
    assert example["ATHLETE"] == together.bounds()
    made = example["maneuver"](so.load(rudi.MODEL), **kept)
    assert made.takeoff == together.soft(case).takeoff


@pytest.mark.parametrize("case", CASES)
def test_the_motions_land_upright_within_an_athletes_torques(case: together.Case) -> None:
    flight = together.landing(case)
    end = flight.landing
    assert [end.somersault, end.tilt, end.twist] == pytest.approx(
        [2 * np.pi, 0, -3 * np.pi], abs=0.06
    )
    most = abs(flight.joint_torques).max("time")
    for name in most["joint_speed"].values:
        bound = next(b for g, b in together.bounds().items() if g in name)
        assert float(most.sel(joint_speed=name)) <= bound
    for joint in so.load(rudi.MODEL).joints:
        low, high = joint.limits
        angles = flight.dataset["joint_angle"].sel(joint=joint.name).values
        assert low - 1e-9 <= angles.min()
        assert angles.max() <= high + 1e-9


@pytest.mark.slow
def test_flights_of_the_design_are_those_made_by_hand() -> None:
    """Gains joint by joint from compliance that all joints share; one flight after the other."""
    gains, nominal = together.numbers("fixed"), together.nominal("fixed")
    joints = {}
    for name in rudi.joint_names():
        group = next(g for g in gains if g.startswith("frequency_") and g[10:] in name)
        alike = nominal.compliant(gains[group], 0.7, pose="wrap")
        joints[name] = alike.takeoff.joints[name]
    soft = nominal.compliant(20.0, pose="wrap").changed(samples=401)
    soft = soft.from_takeoff(soft.takeoff).changed(
        takeoff=so.flight.Takeoff(
            **{
                **{f: getattr(soft.takeoff, f) for f in ("angular_momentum", "tape")},
                "joints": joints,
            }
        )
    )
    flown = together.flown("fixed", "figure")
    side = 21
    for tilt, twist in ((0, 0), (20, 5)):
        by_hand = soft.off_nominal(tilt=-0.1 + 0.01 * tilt, twist=-0.1 + 0.01 * twist).fly()
        error = so.flight.landing_error(
            so.flight.landing_target(together.landing("fixed")),
            so.flight.landing_target(by_hand),
        )
        at = tilt * side + twist
        assert flown.errors[at] == pytest.approx(float(error), abs=1e-4)
        hips = [n for n in rudi.joint_names() if "hip" in n]
        sampled = float(abs(by_hand.joint_torques.sel(joint_speed=hips)).max()) / 250.0
        assert sampled - 1e-4 <= flown.strain["hip"][at] <= 1.05 * sampled


@pytest.mark.slow
def test_unperturbed_a_compliant_body_lands_as_prescribed_at_h_and_elsewhere_at_others() -> None:
    nominal, gains = rudi.nominal().landing, momenta.found("rudi", "fixed")
    own = {
        factor: momenta.own_landing("rudi", momenta.soft("rudi", gains, factor)).landing
        for factor in momenta.FACTORS
    }
    assert own[1.0].twist == pytest.approx(nominal.twist, abs=1e-4)
    assert own[0.9].somersault < own[1.0].somersault - 0.3
    assert own[1.1].somersault > own[1.0].somersault + 0.3
    assert momenta.judged("rudi", "fixed", 0.9).share[1] >= 95.0
