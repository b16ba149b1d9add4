"""The rudi: its data, its error, its maps, and what its table says."""

from __future__ import annotations

import numpy as np
import pytest
from programs import program
from scipy.linalg import eig

import somersault as so
from somersault.dynamics import Equations
from somersault.model import pose as posed
from somersault.thesis.ch6 import _bounded_torques as gentle
from somersault.thesis.ch6 import _eigenfrequencies as table
from somersault.thesis.ch6 import _landing_sensitivity as why
from somersault.thesis.ch6 import _rudi as rudi
from somersault.thesis.ch6 import _rudi_flights as flights

KEPT: tuple[rudi.Kept, ...] = ("rudi", "rudi_gentle")


def _numbers(given: dict[str, float]) -> dict[str, np.ndarray]:
    return {name: np.array([value]) for name, value in given.items()}


@pytest.mark.parametrize("kept", KEPT)
def test_the_nominal_motions_are_within_limits_and_do_what_they_should(kept: rudi.Kept) -> None:
    model, end = so.load(rudi.MODEL), rudi.nominal(kept).landing
    for joint in model.joints:
        low, high = joint.limits
        angles = rudi.nominal(kept).dataset["joint_angle"].sel(joint=joint.name).values
        assert low - 1e-9 <= angles.min()
        assert angles.max() <= high + 1e-9
    assert end.somersault / (2 * np.pi) == pytest.approx(1.0, abs=0.02)
    assert abs(end.twist) / (2 * np.pi) == pytest.approx(1.5, abs=0.02)
    assert abs(end.tilt) < 0.1
    history = rudi.nominal(kept).dataset
    assert float(history["somersault"][1] / history["time"][1]) == pytest.approx(12.6, abs=0.1)


@pytest.mark.parametrize("kept", KEPT)
def test_what_is_kept_is_the_scripts_motion(kept: rudi.Kept) -> None:
    script, found = program("rudi"), rudi.data(kept)
    shortest = script.GENTLE_SWING if kept == "rudi_gentle" else script.SWING
    paths, done = script.motion(_numbers(found["numbers"]), shortest)
    assert set(paths) == set(found["joints"])
    for name, (times, angles) in paths.items():
        np.testing.assert_allclose(found["joints"][name]["times"], times[0], atol=1e-6)
        np.testing.assert_allclose(found["joints"][name]["angles"], angles[0], atol=1e-6)
    assert done[0] <= found["landing"]


def test_the_gentle_motion_keeps_its_bounds_and_a_margin_to_the_limits() -> None:
    found, flight = rudi.data("rudi_gentle"), rudi.nominal("rudi_gentle")
    assert found["bounds"] == program("rudi").BOUNDS
    peaks = gentle.peaks()
    assert all(peaks[group] <= bound for group, bound in found["bounds"].items())
    assert abs(flight.landing.tilt) < 0.05
    assert flight.landing.somersault == pytest.approx(2 * np.pi, abs=0.03)
    assert abs(flight.landing.twist) == pytest.approx(3 * np.pi, abs=0.03)
    assert rudi.twist_rate("rudi_gentle")[0] == pytest.approx(found["front"][0]["twist_rate"], 2e-3)
    for joint in so.load(rudi.MODEL).joints:
        if "elbow" in joint.name:
            continue  # straight is its limit
        angles = flight.dataset["joint_angle"].sel(joint=joint.name).values
        assert joint.limits[0] + 0.03 < angles.min()
        assert angles.max() < joint.limits[1] - 0.03


def test_the_front_is_what_its_numbers_fly() -> None:
    script, found = program("rudi"), rudi.data("rudi_gentle")
    for one in found["front"]:
        told, peaks, fastest, _ = script.strained(_numbers(one["numbers"]))
        assert fastest[0] == pytest.approx(one["twist_rate"], abs=0.01)
        assert told["tilt"][0] == pytest.approx(one["tilt"], abs=1e-3)
        assert abs(one["tilt"]) < 0.05
        assert (peaks[0] <= one["times_bounds"] * script.bounds()).all()
    assert found["front"][0]["numbers"] == found["numbers"]
    rates = [one["twist_rate"] for one in found["front"]]
    assert rates == sorted(rates)


def test_the_scripts_torques_are_those_of_the_flight() -> None:
    script, found = program("rudi"), rudi.data("rudi_gentle")
    _, peaks, _, _ = script.strained(_numbers(found["numbers"]))
    flight = so.fly(
        rudi.MODEL, rudi.nominal_takeoff("rudi_gentle"), found["landing"], samples=script.FINE
    )
    np.testing.assert_allclose(
        peaks[0], np.abs(flight.joint_torques.values).max(0), rtol=1e-3, atol=0.05
    )


def test_the_error_by_hand() -> None:
    flight, wanted = flights.from_the_corner(None), rudi.nominal().landing
    end = flight.landing
    body = [end.somersault - wanted.somersault, end.tilt - wanted.tilt, end.twist - wanted.twist]
    joints = [end.joints[n] - wanted.joints[n] for n in wanted.joints]
    by_hand = np.sqrt((np.sum(np.square(body)) + np.sum(np.square(joints)) / 13) / 4)
    assert flights.error(flight) == pytest.approx(by_hand, rel=1e-12)
    found = rudi.error_map(None, points=3)
    assert found.error[0, 0] == pytest.approx(by_hand, rel=1e-4)
    assert found.error[1, 1] < 1e-5


def test_perturbed_starts_keep_the_momentum_in_space() -> None:
    corner, nominal = flights.from_the_corner(rudi.THEIRS), rudi.nominal()
    np.testing.assert_allclose(
        corner.angular_momentum[0], nominal.angular_momentum[0], rtol=0, atol=1e-9
    )
    assert corner.momentum_drift < 1e-9


def test_sensitivity_is_that_of_larger_steps() -> None:
    found = rudi.sensitivity(None)
    step = 2e-3
    ends = []
    for tilt in (step, -step):
        takeoff = so.Takeoff(
            tilt=tilt, angular_momentum=rudi.nominal_takeoff().angular_momentum,
            joints=rudi.nominal_takeoff().joints,
        )  # fmt: skip
        end = so.fly(rudi.MODEL, takeoff, rudi.landing_time()).landing
        ends.append([end.somersault, end.tilt, end.twist])
    by = (np.array(ends[0]) - np.array(ends[1])) / (2 * step)
    np.testing.assert_allclose(found[:, 0], by, rtol=2e-3, atol=2e-3)


@pytest.mark.parametrize("pose", ["pike", "wrap"])
def test_roots_by_the_companion_matrix(pose: str) -> None:
    """Of M ẍ + C ẋ + K x = 0 over all nineteen speeds, the free base's six included."""
    model = so.load(rudi.MODEL)
    equations = Equations(model)
    inertia = equations.outboard_inertia(posed(model, table._angles("wrap")))
    mass = equations.mass_matrix(posed(model, table._angles(pose)))
    stiffness, damping = (np.zeros((19, 19)) for _ in range(2))
    stiffness[6:, 6:] = np.diag(900.0 * inertia)
    damping[6:, 6:] = np.diag(2 * 0.7 * 30.0 * inertia)
    zero, one = np.zeros((19, 19)), np.eye(19)
    a = np.block([[zero, one], [-stiffness, -damping]])
    b = np.block([[one, zero], [zero, mass]])
    roots = eig(a, b, right=False)
    ours = table.roots(pose)
    for root in ours:
        assert np.abs(roots - root).min() < 1e-6 * abs(root)
    assert len(ours) == 26


def test_one_group_alone_leaves_the_others_prescribed() -> None:
    takeoff = why.only(("elbows",), 30.0)
    kinds = {name: joint.motion for name, joint in takeoff.joints.items()}
    assert {n for n, kind in kinds.items() if kind == "compliant"} == {"left_elbow", "right_elbow"}
    assert set(kinds.values()) == {"compliant", "prescribed"}


@pytest.mark.slow
def test_compliance_has_a_best_frequency_inside() -> None:
    shares = {f: rudi.error_map(f, points=11).share for f in (20.0, 28.0, 60.0)}
    stiff = rudi.error_map(None, points=11).share
    assert shares[28.0] > 4 * stiff
    assert shares[28.0] > 2 * max(shares[20.0], shares[60.0])


@pytest.mark.slow
def test_the_gentle_motion_is_served_by_compliance_too() -> None:
    claims = {claim.id: claim.holds for claim in gentle.bounded_torques().claims}
    assert claims["gentle.improved"]
    assert claims["gentle.interior"]
