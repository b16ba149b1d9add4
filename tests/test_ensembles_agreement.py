"""Each flight of an ensemble is the flight that `fly` makes of the same takeoff by itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

import somersault as so
from somersault.attitude import angle_rates
from somersault.flight import ENDINGS, JointTakeoff, Takeoff
from somersault.model import Model

SPIN = 8.64
SHOULDERS = ("left_shoulder", "right_shoulder")
JOINTS = (*SHOULDERS, "left_shoulder_rate", "right_shoulder_rate")
BODY = ("somersault", "tilt", "twist", "somersault_rate", "tilt_rate", "twist_rate")
OMEGA = tuple(f"angular_velocity_{k}" for k in (1, 2, 3))
ACCURACY = 1e-11
NEAR = {"rtol": 0.0, "atol": 3e-8}

Flown = Callable[[Mapping[str, float]], tuple[str | Model, Takeoff]]


def told(flight: so.Flight) -> dict[str, float]:
    """What `fly` says of the end of a flight, under an ensemble's names."""
    landing, data = flight.landing, flight.dataset
    angles = (landing.somersault, landing.tilt, landing.twist)
    rates = angle_rates(angles, landing.angular_velocity)
    found = dict(zip(BODY, (*angles, *rates.tolist()), strict=True))
    found |= dict(zip(OMEGA, landing.angular_velocity.tolist(), strict=True))
    found |= landing.joints | {"time": landing.time}
    last = data.isel(time=-1)
    found |= {
        f"{n}_rate": float(x) for n, x in zip(data.joint_speed.values, last.joint_rate, strict=True)
    }
    return found


def agree(
    model: str | Model, takeoff: Takeoff, vary: dict[str, so.Vary], flown: Flown,
    names: tuple[str, ...] = (*BODY, *OMEGA), duration: float = 1.0, until: Any = None,
    **options: Any,
) -> Any:  # fmt: skip
    """Compare every flight of an ensemble with its own `fly`; the dataset."""
    made = so.ensemble(
        model, takeoff, duration, vary, report=names, accuracy=ACCURACY, until=until, chunk=5,
        **options,
    ).dataset  # fmt: skip
    for place in product(*(range(n) for n in made.sizes.values())):
        at = dict(zip(made.sizes, place, strict=True))
        one = made.isel(at)
        single_model, single = flown({name: float(one[name]) for name in vary})
        wanted = so.fly(single_model, single, duration, accuracy=ACCURACY, until=until)
        assert ENDINGS.words[int(one.ended)] == wanted.ended
        expected = told(wanted)
        for name in ("time", *names):
            np.testing.assert_allclose(float(one[name]), expected[name], **NEAR, err_msg=name)
    return made


def held(angle: float = 1.4, stiffness: float = 30.0, **other: Any) -> dict[str, JointTakeoff]:
    return {"shoulder": JointTakeoff("sprung", angle, stiffness=stiffness, hold=True, **other)}


def test_a_pair_by_its_common_name_with_hold() -> None:
    made = agree(
        "furrer", Takeoff(tilt=0.02, spin=SPIN, joints=held()),
        {
            "angle": so.Vary(sets="joints.shoulder.angle", values=[0.6, 1.0, 1.7]),
            "K": so.Vary(sets="joints.shoulder.stiffness", values=[0.5, 1.2], scale=28.7),
        },
        lambda v: ("furrer", Takeoff(tilt=0.02, spin=SPIN, joints=held(v["angle"], 28.7 * v["K"]))),
        (*BODY, *OMEGA, *JOINTS), 1.4,
    )  # fmt: skip
    assert made.tilt.dims == ("angle", "K")
    assert np.ptp(made.tilt.values) > 1e-3  # what is varied matters


def test_the_end_at_a_quarter_twist() -> None:
    made = agree(
        "furrer", Takeoff(tilt=0.01, spin=SPIN, joints=held(stiffness=34.0)),
        {"angle": so.Vary(sets="joints.shoulder.angle", values=[0.5, 0.9, 1.2, 1.4, 2.0])},
        lambda v: ("furrer", Takeoff(tilt=0.01, spin=SPIN, joints=held(v["angle"], 34.0))),
        duration=3.0, until="quarter twist",
    )  # fmt: skip
    assert {ENDINGS.words[int(k)] for k in made.ended.values} == {"event", "duration"}
    twisted = np.abs(made.twist.values[made.ended.values == ENDINGS.code("event")])
    np.testing.assert_allclose(twisted, np.pi / 2, atol=1e-9)


def test_a_book_that_tumbles_through_the_singularity() -> None:
    """Tilt runs on through ±π/2, with the turns of somersault and twist that `fly` counts.

    None of these goes by the singularity closer than 0.04 rad without going through.
    """
    made = agree(
        "book", Takeoff(angular_velocity=(6.0, 0.01, 0.02)),
        {
            "w2": so.Vary(adds_to="takeoff.angular_velocity.2", samples=[-0.01, 0.3, 0.3, 2, 2]),
            "w3": so.Vary(sets="takeoff.angular_velocity.3", samples=[0, 0.05, 1, 0.05, 1]),
        },
        lambda v: ("book", Takeoff(angular_velocity=(6.0, 0.01 + v["w2"], v["w3"]))),
        duration=4.0,
    )  # fmt: skip
    assert np.abs(made.tilt).max() > np.pi


def test_attitude_and_the_rates_of_a_spin_and_several_targets() -> None:
    agree(
        "furrer", Takeoff(spin=6.0, tilt_rate=0.1, twist_rate=0.2, joints=held(1.2)),
        {
            "leant": so.Vary(sets="takeoff.tilt", samples=[0.1, -0.3, 2.0]),
            "both": so.Vary(
                adds_to=["takeoff.somersault", "takeoff.twist"], samples=[0.4, -0.2, 3.0]
            ),
            "spin": so.Vary(sets="takeoff.spin", values=[-5.0, 7.0]),
            "rates": so.Vary(
                adds_to=["takeoff.tilt_rate", "takeoff.twist_rate"], scale=-0.5,
                samples=[0.0, 1.0, 0.3],
            ),
        },
        lambda v: ("furrer", Takeoff(
            v["both"], v["leant"], v["both"], spin=v["spin"], tilt_rate=0.1 - 0.5 * v["rates"],
            twist_rate=0.2 - 0.5 * v["rates"], joints=held(1.2),
        )),
        duration=0.8,
    )  # fmt: skip


def test_components_of_angular_momentum_with_joints_that_turn() -> None:
    def joints(rate: float) -> dict[str, JointTakeoff]:
        return {
            "left_shoulder": JointTakeoff("sprung", 0.8, rate, stiffness=25.0, rest=0.5),
            "right_shoulder": JointTakeoff("free", -1.1),
        }

    agree(
        "furrer", Takeoff(0.1, 0.2, 0.3, angular_momentum=(1.0, 90.0, 3.0), joints=joints(0.4)),
        {
            "h1": so.Vary(sets="takeoff.angular_momentum.1", values=[-4.0, 6.0]),
            "h3": so.Vary(adds_to="takeoff.angular_momentum.3", values=[0.0, 5.0]),
            "rate": so.Vary(sets="joints.left_shoulder.rate", values=[-2.0, 0.7]),
        },
        lambda v: ("furrer", Takeoff(
            0.1, 0.2, 0.3, angular_momentum=(v["h1"], 90.0, 3.0 + v["h3"]),
            joints=joints(v["rate"]),
        )),
        (*BODY, *OMEGA, *JOINTS),
    )  # fmt: skip


def test_damping_rest_rate_and_pretension_of_a_pair() -> None:
    """Mirrored: angle, rate, rest and pretension change sign with the side, damping does not."""

    def takeoff(v: Mapping[str, float]) -> Takeoff:
        joint = JointTakeoff(
            "sprung", 1.0, v["rate"], stiffness=22.0, damping=v["damping"], rest=v["rest"],
            pretension=v["pretension"],
        )  # fmt: skip
        return Takeoff(0.0, 0.05, 0.02, spin=7.0, joints={"shoulder": joint})

    nominal = {"rate": 0.1, "damping": 0.2, "rest": 0.9, "pretension": 1.0}
    lists = {
        "rate": [0.5, -0.3, 0.0], "damping": [0.0, 0.6, 1.5], "rest": [0.4, 1.2, 1.0],
        "pretension": [-3.0, 0.0, 6.0],
    }  # fmt: skip
    made = agree(
        "furrer", takeoff(nominal),
        {n: so.Vary(sets=f"joints.shoulder.{n}", samples=x) for n, x in lists.items()},
        lambda v: ("furrer", takeoff(v)), (*BODY, *OMEGA, *JOINTS),
    )  # fmt: skip
    assert made.sizes == {"sample": 3}


def test_pretension_beside_what_holds() -> None:
    agree(
        "furrer", Takeoff(tilt=0.02, spin=SPIN, joints=held(1.3)),
        {"more": so.Vary(sets="joints.left_shoulder.pretension", values=[-2.0, 0.0, 4.0])},
        lambda v: ("furrer", Takeoff(tilt=0.02, spin=SPIN, joints={
            "left_shoulder": JointTakeoff(
                "sprung", 1.3, stiffness=30.0, hold=True, pretension=v["more"]
            ),
            "right_shoulder": JointTakeoff("sprung", -1.3, stiffness=30.0, hold=True),
        })),
        (*BODY, *JOINTS),
    )  # fmt: skip


def test_prescribed_moves_at_varied_times_through_varied_angles() -> None:
    """Knots before takeoff, within the flight and after its end; one arm later than the other."""

    def takeoff(v: Mapping[str, float]) -> Takeoff:
        late = v["late"]
        return Takeoff(tilt=0.05, spin=9.0, joints={
            "left_shoulder": JointTakeoff(
                "prescribed", times=[-0.9, -0.5, 0.5 + late, 2.0], angles=[2.8, 1.8, v["up"], 0.5]
            ),
            "right_shoulder": JointTakeoff(
                "prescribed", times=[0.2 + late, 0.6 + late, 0.8 + late], angles=[-2.0, -0.2, -1.0]
            ),
        })  # fmt: skip

    moved = ["joints.left_shoulder.times.3", "joints.right_shoulder.times"]
    made = agree(
        "furrer", takeoff({"late": 0.0, "up": 1.0}),
        {
            "late": so.Vary(adds_to=moved, values=[-0.7, -0.3, 0.0, 0.25, 0.35]),
            "up": so.Vary(sets="joints.left_shoulder.angles.3", values=[0.0, 2.0]),
        },
        lambda v: ("furrer", takeoff(v)), (*BODY, *JOINTS),
    )  # fmt: skip
    assert np.ptp(made.twist.values) > 1e-2


def test_moves_that_begin_after_the_end() -> None:
    """The last piece of every flight is then empty."""

    def takeoff(late: float) -> Takeoff:
        joint = JointTakeoff("prescribed", times=[0.2 + late, 0.6 + late], angles=[2.0, 0.2])
        return Takeoff(tilt=0.05, spin=9.0, joints={"shoulder": joint})

    agree(
        "furrer", takeoff(0.0),
        {"late": so.Vary(adds_to="joints.shoulder.times", values=[0.9, 1.4])},
        lambda v: ("furrer", takeoff(v["late"])), (*BODY, *JOINTS),
    )  # fmt: skip


def test_masses_carry_their_moments_of_inertia_along() -> None:
    def heavier(v: Mapping[str, float]) -> tuple[Model, Takeoff]:
        model = so.load("furrer")
        bodies = []
        for body in model.bodies:
            changed = body
            if body.name == arm:
                inertia = np.asarray(body.inertia) * v["mass"] / body.mass
                com = (*body.com[:2], v["com"])
                place = (v["place"], *body.position[1:])
                changed = replace(
                    body, mass=v["mass"], inertia=tuple(map(tuple, inertia.tolist())),
                    com=com, position=place,
                )  # fmt: skip
            bodies.append(changed)
        return replace(model, bodies=tuple(bodies)), takeoff

    arm = so.load("furrer").bodies[1].name
    own = so.load("furrer").bodies[1]
    springs = {
        n: JointTakeoff("sprung", s * 1.2, stiffness=30.0, hold=True)
        for n, s in zip(SHOULDERS, (1, -1), strict=True)
    }
    takeoff = Takeoff(tilt=0.03, spin=SPIN, joints=springs)
    made = agree(
        "furrer", takeoff,
        {
            "mass": so.Vary(sets=f"bodies.{arm}.mass", values=[0.7 * own.mass, 1.4 * own.mass]),
            "com": so.Vary(sets=f"bodies.{arm}.com.3", samples=[-0.2, -0.3]),
            "place": so.Vary(sets=f"bodies.{arm}.position.1", samples=[0.01, -0.02]),
        },
        heavier, (*BODY, *JOINTS),
    )  # fmt: skip
    assert np.ptp(made.twist.values) > 1e-2


def test_a_mass_that_is_added_to() -> None:
    arm = so.load("furrer").bodies[1]
    takeoff = Takeoff(tilt=0.03, spin=SPIN, joints=held(1.2))
    by = {"report": BODY, "accuracy": ACCURACY}
    added = so.ensemble(
        "furrer", takeoff, 1.0, {"m": so.Vary(adds_to=f"bodies.{arm.name}.mass", values=[0.5])},
        **by,
    )  # fmt: skip
    whole = so.ensemble(
        "furrer", takeoff, 1.0,
        {"m": so.Vary(sets=f"bodies.{arm.name}.mass", values=[arm.mass + 0.5])}, **by,
    )  # fmt: skip
    for name in BODY:
        np.testing.assert_allclose(added.dataset[name].values, whole.dataset[name].values, **NEAR)


def test_torques_are_those_of_a_flight_sprung_compliant_and_prescribed() -> None:
    moves = {"left_shoulder": [(0.1, 1.3), (0.5, 0.4)]}
    on_path = so.Maneuver.moves("furrer", moves, so.Takeoff(spin=SPIN, tilt=0.05), duration=0.6)
    sprung = JointTakeoff.sprung(angle=-1.2, K=1.2, B=0.1, hold=True)
    both = replace(on_path.takeoff, joints={**on_path.takeoff.joints, "right_shoulder": sprung})
    soft = so.compliant("furrer", on_path.takeoff, 30.0, pose=0.0)
    soft = so.off_nominal("furrer", soft, tilt=0.05)
    for takeoff in (both, soft):
        names = [f"{name}_torque" for name in SHOULDERS]
        report = so.Report(names, extremes=names, history=names, samples=61)
        many = so.flight.flights("furrer", takeoff, 0.6, report=report, accuracy=1e-10)
        data = so.ensemble(many).dataset.isel(sample=0)
        alone = so.fly("furrer", takeoff, 0.6, samples=61, accuracy=1e-10).joint_torques
        fine = so.fly("furrer", takeoff, 0.6, samples=4001, accuracy=1e-10).joint_torques
        for name, speed in zip(names, SHOULDERS, strict=True):
            own = alone.sel(joint_speed=speed).values
            np.testing.assert_allclose(data[f"{name}_history"], own, atol=1e-6)
            np.testing.assert_allclose(data[name], own[-1], atol=1e-6)
            size = float(np.abs(own).max())
            whole = fine.sel(joint_speed=speed)
            for which, pick in (("least", whole.min()), ("greatest", whole.max())):
                np.testing.assert_allclose(data[f"{which}_{name}"], float(pick), atol=5e-3 * size)
            assert data[name].attrs["units"] == "N m"
