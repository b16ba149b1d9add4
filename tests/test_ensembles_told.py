"""What is told of each flight: its course, its extremes, its landing, and that it failed."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_ensembles_agreement import ACCURACY, NEAR, SHOULDERS, SPIN, held

import somersault as so
from somersault.attitude import angle_rates
from somersault.flight import ENDINGS, JointTakeoff, Takeoff

# ------------------------------------------------------------------------- on the way


def test_histories_are_samples_of_fly_up_to_the_end() -> None:
    stops, turns = [0.6, 1.5], ("tilt", "somersault", "left_shoulder", "twist_rate")
    made = so.ensemble(
        "furrer", Takeoff(tilt=0.05, spin=SPIN, joints=held(stiffness=10.0)), 3.0,
        {"angle": so.Vary(sets="joints.shoulder.angle", values=stops)}, accuracy=ACCURACY,
        report=so.Report(history=turns, samples=31), until="quarter twist",
    ).dataset  # fmt: skip
    np.testing.assert_array_equal(made.history_time, np.linspace(0.0, 3.0, 31))
    assert int(made.ended[0]) == ENDINGS.code("event")
    for k, angle in enumerate(stops):
        takeoff = Takeoff(tilt=0.05, spin=SPIN, joints=held(angle, 10.0))
        single = so.fly(
            "furrer", takeoff, 3.0, samples=31, until="quarter twist", accuracy=ACCURACY
        ).dataset
        one = made.isel(angle=k)
        flown = one.history_time.values <= float(one.time)
        count = flown.sum()
        assert np.isnan(one.tilt_history.values[~flown]).all()
        angles = np.stack([single[n].values for n in ("somersault", "tilt", "twist")], 1)
        rates = angle_rates(angles, single.angular_velocity.values)[:, 2]
        for name, wanted in (
            ("tilt", single.tilt), ("somersault", single.somersault), ("twist_rate", rates),
            ("left_shoulder", single.joint_angle.sel(joint="left_shoulder")),
        ):  # fmt: skip
            seen = one[f"{name}_history"].values[flown]
            np.testing.assert_allclose(seen, np.asarray(wanted)[:count], **NEAR)


@pytest.mark.parametrize("accuracy", [1e-7, 1e-10])
def test_extremes_are_those_of_a_dense_history(accuracy: float) -> None:
    names = ("tilt", "twist", "left_shoulder", "left_shoulder_rate", "angular_velocity_1",
             "tilt_rate", "somersault")  # fmt: skip
    angles = [0.8, 1.4, 2.0]
    made = so.ensemble(
        "furrer", Takeoff(tilt=0.05, spin=SPIN, joints=held()), 2.0,
        {"angle": so.Vary(sets="joints.shoulder.angle", values=angles)},
        report=so.Report(extremes=names), accuracy=accuracy,
    ).dataset  # fmt: skip
    for k, angle in enumerate(angles):
        flight = so.fly(
            "furrer", Takeoff(tilt=0.05, spin=SPIN, joints=held(angle)), 2.0, samples=20_001
        ).dataset
        body = np.stack([flight[n].values for n in ("somersault", "tilt", "twist")], 1)
        omega = flight.angular_velocity.values
        dense = {
            "tilt": body[:, 1], "twist": body[:, 2], "somersault": body[:, 0],
            "left_shoulder": flight.joint_angle.sel(joint="left_shoulder").values,
            "left_shoulder_rate": flight.joint_rate.sel(joint_speed="left_shoulder").values,
            "angular_velocity_1": omega[:, 0], "tilt_rate": angle_rates(body, omega)[:, 1],
        }  # fmt: skip
        for name, path in dense.items():
            swing = np.ptp(path)
            for which, wanted in (("least", path.min()), ("greatest", path.max())):
                off = abs(float(made[f"{which}_{name}"][k]) - wanted)
                assert off < 5e-3 * swing, (name, which, angle, off / swing)


def test_extremes_of_a_prescribed_arm_are_its_knots() -> None:
    """Which lie between two pieces of the flight; a cubic of each piece would miss none."""
    joints = {
        n: JointTakeoff(
            "prescribed", times=[0.1, 0.4, 0.9], angles=[s * a for a in (1.0, 2.5, 0.2)]
        )
        for n, s in zip(SHOULDERS, (1, -1), strict=True)
    }
    made = so.ensemble(
        "furrer", Takeoff(spin=SPIN, joints=joints), 1.2,
        {"tilt": so.Vary(sets="takeoff.tilt", values=[0.0, 0.1])},
        report=so.Report(("twist",), extremes=SHOULDERS),
    ).dataset  # fmt: skip
    for which, left in (("least", 0.2), ("greatest", 2.5)):
        np.testing.assert_allclose(made[f"{which}_left_shoulder"], left, atol=5e-3 * 2.3)
    np.testing.assert_allclose(made.least_right_shoulder, -2.5, atol=5e-3 * 2.3)


def test_landing_error_by_hand() -> None:
    target = {"somersault": 12.0, "twist": 0.2, "left_shoulder": 1.0, "right_shoulder": -1.3}
    names = ("somersault", "twist", "tilt", *SHOULDERS, "landing_error", "somersaults", "twists")
    made = so.ensemble(
        "furrer", Takeoff(0.7, 0.05, -0.4, spin=SPIN, joints=held()), 1.4,
        {"angle": so.Vary(sets="joints.shoulder.angle", values=[1.0, 1.5])},
        report=names, against=target,
    ).dataset  # fmt: skip
    for k in range(2):
        one = {name: float(made[name][k]) for name in names}
        body = sum((one[n] - target[n]) ** 2 for n in ("somersault", "twist"))
        arms = [(one[n] - target[n]) ** 2 for n in SHOULDERS]
        wanted = np.sqrt((body + sum(arms) / 2) / 4)
        assert one["landing_error"] == pytest.approx(wanted, rel=1e-14)
        assert one["somersaults"] == pytest.approx((one["somersault"] - 0.7) / (2 * np.pi))
        assert one["twists"] == pytest.approx((one["twist"] + 0.4) / (2 * np.pi))


# ------------------------------------------------------------------------- that fail


def alike(some: Any, others: Any, which: np.ndarray) -> None:
    for name in others.data_vars:
        np.testing.assert_array_equal(some[name].values[which], others[name].values, err_msg=name)


def test_a_flight_without_a_takeoff_is_struck_out_and_disturbs_no_neighbour() -> None:
    takeoff = Takeoff(tilt=0.01, spin=SPIN, joints=held(damping=0.1))
    report = so.Report(("tilt", "left_shoulder"), ("tilt",), ("twist",), 5)
    angles = np.array([1.0, 9.0, 1.2, np.nextafter(3.3, 4) + 1e-6, 1.4, -0.6])
    dampers = np.array([0.1, 0.1, -0.1, 0.1, 0.2, 0.1])
    good = np.array([True, False, False, False, True, False])

    def flown(which: np.ndarray) -> Any:
        vary = {
            "a": so.Vary(sets="joints.shoulder.angle", samples=angles[which]),
            "c": so.Vary(sets="joints.shoulder.damping", samples=dampers[which]),
        }
        return so.ensemble("furrer", takeoff, 0.5, vary, report=report).dataset

    with pytest.warns(so.SomersaultWarning, match="4 of 6 flights could not begin"):
        made = flown(np.ones(6, bool))
    assert [ENDINGS.words[k] for k in made.ended.values] == [
        "duration" if g else "no takeoff" for g in good
    ]
    for name, values in made.data_vars.items():
        if values.dtype.kind == "f":
            lost = np.isnan(values.values).reshape(6, -1).all(1)
            np.testing.assert_array_equal(lost, ~good, err_msg=str(name))
    assert (made.steps.values[~good] == 0).all()
    alike(made, flown(good), good)


def test_too_many_steps_and_what_is_not_finite() -> None:
    joint = JointTakeoff("sprung", 0.3, stiffness=1.0, rest=0.2)
    takeoff = Takeoff(tilt=0.01, spin=SPIN, joints=dict.fromkeys(SHOULDERS[:1], joint))
    report = so.Report(("tilt", "left_shoulder"), ("tilt",), ("twist",), 5)

    def flown(springs: list[float]) -> Any:
        vary = {"k": so.Vary(sets="joints.left_shoulder.stiffness", samples=springs)}
        return so.ensemble("furrer", takeoff, 0.5, vary, report=report, steps=400).dataset

    with pytest.warns(so.SomersaultWarning, match=r"^2 of 5 .*\(too many steps: 2\)"):
        made = flown([20.0, 9e8, 30.0, -9e8, 10.0])
    good = np.array([True, False, True, False, True])
    assert [ENDINGS.words[k] for k in made.ended.values] == [
        "duration" if g else "too many steps" for g in good
    ]
    assert np.isnan(made.tilt.values[~good]).all()
    assert (made.steps.values[~good] == 400).all()
    alike(made, flown([20.0, 30.0, 10.0]), good)

    broken = pytest.warns(so.SomersaultWarning, match="not finite: ")
    with broken, np.errstate(over="ignore"):  # a spread of e^1000
        wide = so.ensemble(
            "furrer", takeoff, 0.5, size=12, report=report,
            vary={"k": so.Vary(sets="joints.left_shoulder.stiffness", lognormal=[1.0, 1e3])},
        ).dataset  # fmt: skip
    endless = np.isinf(wide.k.values)
    assert endless.any()
    assert (wide.ended.values[endless] == ENDINGS.code("not finite")).all()
    for name in ("tilt", "least_tilt", "twist_history", "left_shoulder"):
        assert np.isnan(wide[name].values[endless]).all()
    calm = wide.k.values < 1e-3
    np.testing.assert_array_equal(wide.ended.values[calm], 0)
    np.testing.assert_allclose(wide.tilt.values[calm], wide.tilt.values[calm][0], atol=1e-6)


def test_steps_are_those_of_the_whole_flight() -> None:
    """Not of each piece between the knots of a move."""
    joint = JointTakeoff("prescribed", times=[0.1, 0.3, 0.5, 0.7], angles=[1.0, 1.2, 1.0, 1.2])
    takeoff = Takeoff(tilt=0.1, spin=SPIN, joints={"shoulder": joint})
    free = so.ensemble("furrer", takeoff, 1.0).dataset
    needed = int(free.steps[0])
    assert needed > 20
    for most, ending in ((needed - 6, "too many steps"), (needed + 1, "duration")):
        failing = pytest.warns(so.SomersaultWarning) if most < needed else nullcontext()
        with failing:
            made = so.ensemble("furrer", takeoff, 1.0, steps=most).dataset
        assert ENDINGS.words[int(made.ended[0])] == ending, (most, needed)
        assert np.isnan(made.tilt.values[0]) == (ending != "duration")


# ------------------------------------------------------------------------- units


def test_what_varies_has_the_unit_of_the_numbers_it_moves() -> None:
    units = {
        "takeoff.tilt": "rad", "takeoff.tilt_rate": "rad/s", "takeoff.spin": "rad/s",
        "joints.shoulder.angle": "rad", "joints.left_shoulder.rate": "rad/s",
        "joints.shoulder.stiffness": "N m/rad", "joints.right_shoulder.damping": "N m s/rad",
        "joints.shoulder.pretension": "N m", "joints.shoulder.rest": "rad",
        "bodies.left_arm.mass": "kg", "bodies.left_arm.com.1": "m",
        "bodies.left_arm.position.2": "m",
    }  # fmt: skip
    free = Takeoff(spin=SPIN, joints={"shoulder": JointTakeoff("sprung", angle=1.4, rest=1.4)})
    for path, unit in units.items():
        assert attributes(free, path) == {"adds_to": [path], "units": unit}
    moves = {"shoulder": JointTakeoff("prescribed", times=(0.0, 0.1), angles=(0.0, 1.0))}
    momentum = Takeoff(angular_momentum=(50.0, 0.0, 0.0), joints=moves)
    for path, unit in (
        ("joints.shoulder.times", "s"), ("joints.shoulder.angles.2", "rad"),
        ("takeoff.angular_momentum.2", "kg m2/s"),
    ):  # fmt: skip
        assert attributes(momentum, path)["units"] == unit
    velocity = Takeoff(angular_velocity=(8.0, 0.0, 0.0), joints=moves)
    assert attributes(velocity, "takeoff.angular_velocity.1")["units"] == "rad/s"
    assert attributes(free, "takeoff.tilt", unit="degree", scale=0.0175)["units"] == "degree"
    assert "units" not in attributes(free, "takeoff.tilt", scale=2.0)
    assert "units" not in attributes(free, "takeoff.tilt", "takeoff.spin")
    assert attributes(free, "takeoff.tilt", "takeoff.twist")["units"] == "rad"


def attributes(takeoff: Takeoff, *paths: str, **more: Any) -> dict[str, Any]:
    vary = {"x": so.Vary(adds_to=list(paths), values=[0.0], **more)}
    return so.ensemble("furrer", takeoff, 0.01, vary, report=["somersault"]).dataset.x.attrs


def test_a_slide_has_units_of_its_own(tmp_path: Path) -> None:
    file = tmp_path / "slide.xml"
    through = 'contype="0" conaffinity="0"'
    file.write_text(
        "<mujoco><worldbody><body><freejoint/>"
        f'<geom {through} type="box" size=".1 .1 .3" mass="9"/>'
        '<body><joint name="rail" type="slide" axis="0 0 1" stiffness="5" damping="1"/>'
        f'<geom {through} type="sphere" size=".1" mass="1"/></body></body></worldbody></mujoco>'
    )
    takeoff = Takeoff(spin=3.0, joints={"rail": JointTakeoff("sprung")})
    for what, unit in (
        ("angle", "m"), ("rate", "m/s"), ("stiffness", "N/m"), ("damping", "N s/m"),
        ("rest", "m"), ("pretension", "N"),
    ):  # fmt: skip
        vary = {"x": so.Vary(adds_to=f"joints.rail.{what}", values=[0.0])}
        made = so.ensemble(str(file), takeoff, 0.01, vary, report=["somersault"]).dataset
        assert made.x.attrs["units"] == unit


def test_flights_that_could_not_begin_are_noted_in_words() -> None:
    """Where the third time of an arm's move is varied, it often comes before the second."""
    vary = {"t": so.Vary(adds_to="joints.left_shoulder_abduction.times.2", normal=[0.0, 1.0])}
    with pytest.warns(so.SomersaultWarning, match="could not begin") as said:
        found = so.ensemble(so.arm_tilt(), vary=vary, size=40, report=["twist"])
    lost = int(found.fraction(ended="no takeoff").fraction * 40)
    assert 0 < lost < 40
    assert [str(one.message).partition(":")[0] for one in said] == [
        f"{lost} of 40 flights could not begin (no takeoff)"
    ]
