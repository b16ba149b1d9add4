"""What is given in Python and is no such thing: one sentence, from whichever function."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import somersault as so
from somersault.stability import chart, growth_rates, root_locus, stable_ranges

T = np.linspace(0.0, 1.0, 60)
ELBOW = {"elbow": 1 + 0.1 * T}
PATHS = so.Motion.moves("gymnast", {"elbow": [(0.0, 1.0), (1.0, 1.2)]}).paths
PRESCRIBED = so.Takeoff(
    spin=8.0, joints={"shoulder": so.JointTakeoff("prescribed", times=[0.0], angles=[1.0])}
)
CLAMP = so.Body(
    "clamp", -1, 0.3, com=(0, 0, 0), inertia=np.diag([1e-3] * 3).tolist(),
    joints=(so.Joint("bar", "hinge", (0, 1, 0)),),
)  # fmt: skip
MOUNT = so.mounted(so.load("doll"), CLAMP)
GIVEN = np.array([np.nan, 1.0])


def fly(**given: Any) -> so.Flight:
    return so.fly("furrer", so.Takeoff(**given), 0.1)


def ensemble(**given: Any) -> so.Ensemble:
    vary = {"t": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.1])}
    return so.ensemble("furrer", duration=0.1, **{"vary": vary, "size": 64, **given})


def sampled(**given: Any) -> so.Motion:
    return so.sampled_motion("gymnast", T, **{"values": ELBOW, **given})


def swing(**given: Any) -> so.Swing:
    return so.swing(MOUNT.held, **{"angles": {"bar": 1.0}, "duration": 0.1, **given})


MISTAKES: dict[str, Callable[[], Any]] = {
    "knees must be true or false": lambda: so.athlete(1.7, 65, knees="yes"),
    "height is True": lambda: so.athlete(True, 65),
    "name must be a text": lambda: so.athlete(1.7, 65, name=3),
    "no pose is called": lambda: so.named_pose("gymnast", GIVEN),
    "model must be a somersault.Model": lambda: so.mounted("doll", CLAMP),
    "carrier must be a somersault.Body": lambda: so.mounted(so.load("doll"), "clamp"),
    "position must be 3 finite": lambda: so.mounted(so.load("doll"), CLAMP, (0, np.nan, 0)),
    "rotation must be 3 x 3 finite": lambda: so.mounted(so.load("doll"), CLAMP, rotation=1),
    "model must be a somersault.Model, ": lambda: so.swing("doll", {}, 1.0),
    "angles must be given by name": lambda: swing(angles=[1.0]),
    "rates must be given by name": lambda: swing(rates=[1.0]),
    "until must be a joint and its angle": lambda: swing(until="bar"),
    "stops must be given by name": lambda: swing(stops=[so.Prop(0.0)]),
    "stop bar must be a somersault.Prop": lambda: swing(stops={"bar": 1.0}),
    "samples must be a whole number from 2": lambda: swing(samples="many"),
    "accuracy -1 is out of reach": lambda: swing(accuracy=-1.0),
    "a prop's angle": lambda: so.Prop(np.nan),
    "a prop's side": lambda: so.Prop(1.0, 0),
    "a prop's stiffness must be positive": lambda: so.Prop(1.0, stiffness=-1.0),
    "a prop's damping": lambda: so.Prop(1.0, damping=-1.0),
    "what is released must be a somersault.Swing": lambda: so.released(None, MOUNT),
    "takeoff of joint left_shoulder must be": lambda: so.released(
        swing(), MOUNT, {"left_shoulder": 1.0}
    ),
    "until": lambda: so.fly("furrer", until=GIVEN),
    "stop_stiffness must not be negative": lambda: so.compliant(
        "furrer", PRESCRIBED, 20.0, pose={}, stop_stiffness=-1.0
    ),
    "stop_damping must be a number": lambda: so.compliant(
        "furrer", PRESCRIBED, 20.0, pose={}, stop_damping="soft"
    ),
    "stiffness must be given by name": lambda: so.spin("furrer").linear([1.0]),
    "damping must be given by name": lambda: so.spin("furrer").linear(damping=1.0),
    "spin must be a somersault.Spin": lambda: so.deviated_flight("furrer", 8.0, 1.0),
    "joints must be given by name": lambda: so.deviated_flight(
        so.spin("furrer"), 8.0, 1.0, joints=[0.1]
    ),
    "samples must be given by name": lambda: sampled(values=[1.0, 2.0]),
    "slack must not be negative": lambda: sampled(slack=-1.0),
    "slack must be a finite number": lambda: so.Motion(PATHS, 0.0, 1.0, True, slack=np.nan),
    "source must be a text": lambda: sampled(source=3),
    "begin must be a number": lambda: so.Motion(PATHS, "early", 1.0, True),
    "ends too soon": lambda: so.Motion(PATHS, 2.0, 1.0, True),
    "held must be true or false": lambda: so.Motion(PATHS, 0.0, 1.0, "yes"),
    "elbow: path must be a somersault.motion.Path": lambda: so.Motion({"elbow": 1}, 0, 1, True),
    "duration -1 s is none": lambda: so.prescribed("gymnast", so.Motion(PATHS, 0.0, 1.0, True), -1),
    "ignore_others must be true or false": lambda: so.read_motion(
        "dive.csv", "gymnast", ignore_others="yes"
    ),
    "degrees must be true or false": lambda: so.read_motion("dive.csv", "gymnast", degrees=1),
    "poses must be a list of names": lambda: so.inertia_change(poses=3),
    "poses are two": lambda: so.inertia_change(poses=("tuck",)),
    "legs must be given by name": lambda: so.cat_turn(legs=[1.0]),
    "cycles must be a whole number from 1 to 1000": lambda: so.cat_turn(cycles=10**9),
    "duration 0 s is no duration": lambda: so.arm_tilt(twists=None, duration=0.0),
    "takeoff joints must be given by name": lambda: so.Takeoff(joints=[1]),
    "is no motion": lambda: fly(joints={"left_shoulder": so.JointTakeoff(GIVEN)}),
    "path is int": lambda: fly(joints={"shoulder": so.JointTakeoff("prescribed", path=3)}),
    "left_shoulder: angles": lambda: fly(
        joints={"shoulder": so.JointTakeoff("prescribed", times=[0.0], angles=1.0)}
    ),
    "sample.seed must be a whole": lambda: ensemble(seed=None),
    "sample.sequence": lambda: ensemble(sequence=GIVEN),
    "report, unless it is a Report": lambda: ensemble(report=3),
    "progress must be true or false": lambda: ensemble(progress="yes"),
    "out must be the path": lambda: ensemble(out=3),
    "scheduler must be a text": lambda: ensemble(scheduler=3),
    "path must be the path": lambda: so.Ensemble.open(3),
    "report.quantities must be a list": lambda: so.Report("tilt"),
    "report.samples must be a whole": lambda: so.Report(samples="many"),
    "against, unless it is a Flight, must be given by name": lambda: ensemble(against=[1.0]),
    "vary.t.unit must be a text": lambda: ensemble(
        vary={"t": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.1], unit=3)}
    ),
    "x of a chart is a name": lambda: chart("furrer", x=3, y=("stiffness.shoulder", [0, 1])),
    "energy must be true or false": lambda: chart(
        "furrer", ("pose.shoulder", [0, 1]), ("stiffness.shoulder", [0, 1]), energy="yes"
    ),
    "what a root locus is along": lambda: root_locus("furrer", "stiffness.shoulder"),
    "what stable ranges are along": lambda: stable_ranges("furrer", "stiffness.shoulder"),
    "fixed must be given by name": lambda: stable_ranges(
        "furrer", ("stiffness.shoulder", -2, 4), fixed=[1.0]
    ),
    "quantities must be given by name": lambda: growth_rates("furrer", [1.0]),
    "parameters must be a list of names": lambda: so.Equations("furrer", 3),
}


@pytest.mark.parametrize("said", MISTAKES)
def test_one_sentence(said: str) -> None:
    with pytest.raises(so.SomersaultError) as told:
        MISTAKES[said]()
    assert said in str(told.value)
    assert "\n" not in str(told.value)
    assert len(str(told.value)) < 400


@pytest.fixture(scope="module")
def landings() -> so.Ensemble:
    return ensemble(report=["tilt"], against={"tilt": 0.0})


@pytest.mark.parametrize(
    ("said", "ask"),
    [
        ("tolerance must be a number", lambda e: e.fraction(tolerance="good")),
        ("tolerance must be a positive", lambda e: e.fraction(tolerance=-1.0)),
        ("confidence must be a number", lambda e: e.fraction(tolerance=1.0, confidence="sure")),
        ("over must be a list of names", lambda e: e.fraction(tolerance=1.0, over=3)),
        ("over names no dimension", lambda e: e.quantiles("tilt", over=[])),
        ("quantiles must be a row of numbers", lambda e: e.quantiles("tilt", 0.5)),
        ("quantiles are numbers from 0 to 1", lambda e: e.quantiles("tilt", [2.0])),
        ("reports no", lambda e: e.quantiles(GIVEN)),
        ("confidence must be between 0 and 1", lambda e: e.sensitivity("tilt", confidence=2.0)),
        ("seed must be a whole number", lambda e: e.sensitivity("tilt", seed="lucky")),
        ("reports no", lambda e: e.plot(GIVEN)),
        ("no landing_error", lambda e: so.ensembles.within(e.dataset[["tilt"]], 0.1)),
        ("an xarray.Dataset", lambda e: so.ensembles.within(SimpleNamespace(), 0.1)),
    ],
)
def test_one_sentence_of_an_ensemble(
    landings: so.Ensemble, said: str, ask: Callable[[so.Ensemble], Any]
) -> None:
    with pytest.raises(so.SomersaultError, match=said):
        ask(landings)
