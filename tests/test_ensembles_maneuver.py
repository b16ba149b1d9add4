"""Ensembles of a maneuver, against a landing, and of what behaviours declare."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from test_ensembles_bits import same

import somersault as so
from somersault.flight import landing_target

TWIST = so.Maneuver.moves(
    "furrer",
    {"left_shoulder": [(0.1, 1.2), (0.4, 0.3)], "right_shoulder": [(0.1, -1.2)]},
    so.Takeoff(spin=7.0),
    0.6,
)
VARY = {"leant": so.Vary(sets="takeoff.tilt", values=[-0.1, 0.0, 0.1])}


def test_a_maneuver_is_its_model_takeoff_and_duration() -> None:
    """With its accuracy, event and steps, unless the call has others."""
    made = TWIST.changed(accuracy=1e-6, until="quarter twist", steps=999)
    given = (made.model, made.takeoff, made.duration, VARY)
    whole = so.ensemble(made, vary=VARY, seed=1).dataset
    options: dict[str, Any] = {"accuracy": 1e-6, "until": "quarter twist", "steps": 999}
    same(whole, so.ensemble(*given, seed=1, **options).dataset)
    finer = so.ensemble(made, vary=VARY, seed=1, accuracy=1e-9, steps=5000).dataset
    same(finer, so.ensemble(*given, seed=1, **options | {"accuracy": 1e-9, "steps": 5000}).dataset)
    assert (finer.steps > whole.steps).all()


def test_landings_against_a_flight() -> None:
    nominal = TWIST.fly(samples=2)
    found = so.ensemble(TWIST, vary=VARY, against=nominal)
    error = found.dataset["landing_error"]
    assert error.attrs["units"] == "rad"
    assert float(error[1]) < 1e-8
    assert (error.values[[0, 2]] > 0.01).all()
    for k, tilt in enumerate(VARY["leant"].values):
        leaning = TWIST.from_takeoff(so.Takeoff(tilt=tilt, spin=7.0)).fly(samples=2)
        wanted = so.flight.landing_error(landing_target(nominal), landing_target(leaning))
        assert float(error[k]) == pytest.approx(float(wanted), abs=1e-8)
    by_name = so.ensemble(TWIST, vary=VARY, against=landing_target(nominal))
    same(by_name.dataset, found.dataset)
    share = found.fraction(tolerance=float(error[0]) * 1.01, over="leant")
    assert float(share["fraction"]) in (2 / 3, 1.0)


@pytest.mark.parametrize(
    ("report", "names"),
    [
        (None, ("somersault", "tilt", "twist", "landing_error")),
        (["twist"], ("twist", "landing_error")),
        (so.Report(("landing_error", "tilt")), ("landing_error", "tilt")),
        (so.Report((), extremes=("tilt",)), ("landing_error", "least_tilt", "greatest_tilt")),
    ],
)
def test_what_is_measured_is_reported(report: Any, names: tuple[str, ...]) -> None:
    data = so.ensemble("furrer", so.Takeoff(spin=7.0), 0.1, report=report, against={"tilt": 0.1})
    assert tuple(data.dataset.data_vars) == ("time", *names, "steps", "ended")
    assert float(data.dataset.landing_error[0]) == pytest.approx(0.05)


def test_the_share_that_ended_so() -> None:
    shoulder = so.JointTakeoff("sprung", 1.4, stiffness=34.0, hold=True)
    takeoff = so.Takeoff(tilt=0.01, spin=8.64, joints={"shoulder": shoulder})
    vary = {"arm": so.Vary(sets="joints.shoulder.angle", values=[0.5, 1.4, 2.0])}
    vary["leant"] = so.Vary(adds_to="joints.shoulder.angle", samples=[0.0, 0.01, 9.0])
    with pytest.warns(so.SomersaultWarning, match="3 of 9 flights could not begin"):
        found = so.ensemble("furrer", takeoff, 3.0, vary, until="quarter twist")
    ended = found.dataset["ended"].values
    for word in ("duration", "event", "no takeoff"):
        code = so.flight.ENDINGS.code(word)
        share = found.fraction(ended=word)
        np.testing.assert_allclose(share["fraction"], (ended == code).mean(1))
        np.testing.assert_array_equal(share["flights"], 3)
        np.testing.assert_array_equal(
            so.ensembles.ended_by(found.dataset["ended"], word).values, ended == code
        )
    assert float(found.fraction(ended="no takeoff", over=["arm", "sample"]).fraction) == 1 / 3


TORQUE = {
    "left_shoulder": so.JointTakeoff(
        "torque", 1.2, torque=2.0, times=[0.1, 0.3], torques=[0.0, 5.0]
    ),
    "right_shoulder": so.JointTakeoff("coupled", leader="left_shoulder", factor=-1.0),
}


@pytest.mark.parametrize(
    ("path", "field", "unit"),
    [
        ("joints.left_shoulder.torque", "torque", "N m"),
        ("joints.left_shoulder.torques.2", "torques", "N m"),
        ("joints.left_shoulder.times.2", "times", "s"),
        ("joints.right_shoulder.factor", "factor", "1"),
        ("joints.right_shoulder.offset", "offset", "rad"),
    ],
)
def test_whatever_a_behaviour_declares_can_be_varied(path: str, field: str, unit: str) -> None:
    takeoff = so.Takeoff(tilt=0.05, spin=7.0, joints=TORQUE)
    values = [0.25, 0.4] if field == "times" else [-0.9, -1.1]
    report, accuracy = ["tilt", "twist", "left_shoulder", "right_shoulder"], 1e-11
    vary = {"x": so.Vary(sets=path, values=values)}
    data = so.ensemble("furrer", takeoff, 0.5, vary, report=report, accuracy=accuracy).dataset
    assert data.x.attrs["units"] == unit
    name = path.split(".")[1]
    for k, x in enumerate(values):
        row = tuple(getattr(TORQUE[name], field)) if field in ("times", "torques") else None
        does = replace(TORQUE[name], **{field: x if row is None else (row[0], x)})
        joints = {**TORQUE, name: does}
        own = so.Takeoff(tilt=0.05, spin=7.0, joints=joints)
        end = landing_target(so.fly("furrer", own, 0.5, accuracy=accuracy, samples=2))
        for what in report:
            assert float(data[what][k]) == pytest.approx(end[what], abs=3e-9), what
    assert np.ptp(data.twist.values) > 1e-6


def test_what_is_planned_in_a_line() -> None:
    many = so.flight.flights(TWIST.model, TWIST.takeoff, 0.6)
    assert repr(many) == "Flights(furrer, 0.6 s)"
    vary = {**VARY, "late": so.Vary(adds_to="joints.left_shoulder.times", uniform=[0.0, 0.1])}
    assert repr(so.ensembles.plan(many, vary, 2000)) == "Plan(furrer, leant 3, sample 2,000)"


# ------------------------------------------------------------------------- mistakes


@cache
def mistakes() -> dict[str, Any]:
    flown = so.fly("book", so.Takeoff(spin=7.0), 0.1)
    found = so.ensemble(TWIST, vary=VARY)
    gearing = so.Takeoff(spin=7.0, joints={"shoulder": so.JointTakeoff("sprung", 1.0)})
    return {
        "takeoff is given, but a maneuver": lambda: so.ensemble(TWIST, so.Takeoff()),
        "duration is given, but a maneuver": lambda: so.ensemble(TWIST, duration=1.0),
        "against, unless it is a Flight": lambda: so.ensemble(TWIST, against=3),
        "target: 'lean' is nothing": lambda: so.ensemble(TWIST, against={"lean": 0.0}),
        "target.tilt must be a number": lambda: so.ensemble(TWIST, against={"tilt": "no"}),
        "needs a target": lambda: so.ensemble(TWIST, report=["landing_error"]),
        "'left_shoulder' is nothing that is known of book": lambda: so.ensemble(
            "book", against=TWIST.fly()
        ),
        "steps must be a whole number": lambda: so.ensemble(TWIST, steps=0),
        "is given 0 of good, tolerance": lambda: found.fraction(),
        "is given 2 of good, tolerance": lambda: found.fraction(tolerance=1.0, ended="event"),
        "ended is 'landed'; give 'duration' or 'event'": lambda: found.fraction(ended="landed"),
        "lost its attribute": lambda: so.ensembles.failed(found.dataset["ended"].drop_attrs()),
        "shoulder.hardness is no number": lambda: so.ensemble(
            "furrer", gearing, 0.1, {"x": so.Vary(sets="joints.shoulder.hardness", values=[1.0])}
        ),
        "no model": lambda: so.ensemble(flown),
    }


@pytest.mark.parametrize("said", list(mistakes()))
def test_mistakes(said: str) -> None:
    with pytest.raises(so.SomersaultError) as mistake:
        mistakes()[said]()
    assert said in str(mistake.value)
    assert "\n" not in str(mistake.value)
