"""One body written in two frames, axes renamed to match: it flies to the same angles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import permutations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from trees import random_tree, unit

import somersault as so
from somersault.attitude import Axes, matrix_from_quaternion
from somersault.model import as_matrix, as_vector, mirror_pairs, model_shapes
from somersault.view import camera, contact_sheet

ORDERS = [axes for axes in permutations((1, 2, 3)) if axes != (2, 1, 3)]
SAME = 1e-10
every_order = pytest.mark.parametrize("axes", ORDERS)
either_hand = pytest.mark.parametrize("axes", [(1, 2, 3), (1, 3, 2)])


def frame(axes: Axes) -> np.ndarray:
    """Columns: front, left and head (our axes 1, 2, 3) in the axes of a body drawn otherwise.

    Its axis of tilt points to the front and that of twist to the head; the third is where a
    right-handed frame has its left.
    """
    front, head = np.eye(3)[axes[1] - 1], np.eye(3)[axes[2] - 1]
    return np.column_stack([front, np.cross(head, front), head])


def sign(axes: Axes) -> float:
    """Of a somersault about their axis, which may point to the right."""
    return float(frame(axes)[axes[0] - 1, 1])


def redrawn(model: so.Model, axes: Axes) -> so.Model:
    """The same body with another frame fixed to its base, and `axes` to match."""
    turn = frame(axes)
    base, *others = model.bodies
    drawn = replace(
        base,
        com=as_vector(turn @ base.com),
        inertia=as_matrix(turn @ np.array(base.inertia) @ turn.T),
        shapes=tuple(shape.placed(np.zeros(3), turn) for shape in base.shapes),
    )
    moved = [
        replace(
            body,
            position=as_vector(turn @ body.position),
            rotation=as_matrix(turn @ np.array(body.rotation)),
        )
        if body.parent == 0
        else body
        for body in others
    ]
    return replace(model, bodies=(drawn, *moved), axes=axes)


def retold(takeoff: so.Takeoff, axes: Axes) -> so.Takeoff:
    """The same takeoff in words of the other frame, inertial axes renamed alike."""
    turn, changes = frame(axes), {}
    for name in ("angular_velocity", "angular_momentum", "position", "velocity", "tape"):
        vector = getattr(takeoff, name)
        if vector is not None:
            changes[name] = (turn @ vector).tolist()
    if takeoff.quaternion is not None:
        w, *vector = takeoff.quaternion
        changes["quaternion"] = [w, *(turn @ vector).tolist()]
    if takeoff.spin is not None:
        changes["spin"] = sign(axes) * takeoff.spin
    return replace(takeoff, somersault=sign(axes) * takeoff.somersault, **changes)


def assert_same(ours: so.Flight, other: so.Flight, axes: Axes) -> None:
    """The same flight, its angles and its vectors told in other words."""
    turn, signs = frame(axes), np.array([sign(axes), 1, 1])
    assert (other.ended, other.landing.time) == (ours.ended, pytest.approx(ours.landing.time))
    np.testing.assert_allclose(other._angles[-1], signs * ours._angles[-1], rtol=0, atol=SAME)
    if len(ours.times) == len(other.times):  # but for how often turns are counted
        for name, by in zip(("somersault", "tilt", "twist"), signs, strict=True):
            told = [flight.dataset[name].values for flight in (ours, other)]
            np.testing.assert_allclose(told[1], by * told[0], rtol=0, atol=SAME)
    end, their_end = ours.landing, other.landing
    np.testing.assert_allclose(
        matrix_from_quaternion(their_end.quaternion),
        turn @ matrix_from_quaternion(end.quaternion) @ turn.T, rtol=0, atol=SAME,
    )  # fmt: skip
    np.testing.assert_allclose(
        their_end.angular_velocity, turn @ end.angular_velocity, rtol=0, atol=100 * SAME
    )
    for name, angle in end.joints.items():
        assert their_end.joints[name] == pytest.approx(angle, abs=10 * SAME)


def both(
    model: so.Model, takeoff: so.Takeoff, duration: float, axes: Axes, **options: Any
) -> tuple[so.Flight, so.Flight]:
    return (
        so.fly(model, takeoff, duration, accuracy=1e-11, **options),
        so.fly(redrawn(model, axes), retold(takeoff, axes), duration, accuracy=1e-11, **options),
    )


# ------------------------------------------------------------------------------- flights

SPRUNG = {"shoulder": so.JointTakeoff("sprung", angle=1.3, stiffness=30.0, hold=True)}
TAKEOFFS: Mapping[str, so.Takeoff] = {
    "spin": so.Takeoff(
        somersault=0.4, tilt=0.05, twist=-0.3, spin=8.0, tilt_rate=0.4, twist_rate=1.0,
        joints=SPRUNG,
    ),
    "momentum": so.Takeoff(
        somersault=7.0, tilt=0.2, twist=-9.0, angular_momentum=(3.0, 60.0, -8.0), joints=SPRUNG
    ),
    "quaternion": so.Takeoff(
        quaternion=(0.9, 0.1, -0.4, 0.3), angular_velocity=(0.4, 7.0, 2.0), joints=SPRUNG
    ),
}  # fmt: skip


@every_order
@pytest.mark.parametrize("given", TAKEOFFS)
def test_sprung_arms(axes: Axes, given: str) -> None:
    assert_same(*both(so.load("furrer"), TAKEOFFS[given], 1.5, axes), axes)


@either_hand
def test_arms_that_start_a_twist(axes: Axes) -> None:
    """The gymnast's asymmetric arms, and the quarter twist that they come to."""
    model = so.load("gymnast")
    start = so.arm_tilt(model, twists=None).takeoff
    ours, other = both(model, start, 2.0, axes)
    assert abs(ours.landing.twist) > 2 * np.pi
    assert_same(ours, other, axes)
    ours, other = both(model, start, 2.0, axes, until="quarter twist")
    assert ours.ended == "event"
    assert abs(ours.landing.twist) == pytest.approx(np.pi / 2, abs=1e-9)
    assert other.landing.time == pytest.approx(ours.landing.time, abs=1e-11)
    assert_same(ours, other, axes)


@either_hand
def test_compliant_arms(axes: Axes) -> None:
    model = so.load("gymnast")
    start = replace(so.arm_tilt(model, twists=None).takeoff, tilt=0.02)
    soft = {"natural_frequency": 25.0, "pose": "following"}
    starts = (
        so.compliant(model, start, **soft),
        so.compliant(redrawn(model, axes), retold(start, axes), **soft),
    )
    told = retold(starts[0], axes)
    for name in ("angular_momentum", "tape"):
        np.testing.assert_allclose(getattr(starts[1], name), getattr(told, name), atol=1e-11)
    ours, other = (
        so.fly(body, begun, 1.0, accuracy=1e-11)
        for body, begun in zip((model, redrawn(model, axes)), starts, strict=True)
    )
    assert abs(ours.landing.twist) > 1
    assert_same(ours, other, axes)


@pytest.mark.parametrize("number", range(6))
def test_random_trees(number: int) -> None:
    """Without springs, which may be stiff; with slides and balls."""
    rng = np.random.default_rng([31, number])
    axes = ORDERS[number % len(ORDERS)]
    model = random_tree(rng, int(rng.integers(2, 5)), True, armature=False)
    joints = {
        j.name: so.JointTakeoff("free", damping=0.1, rate=0.0 if j.kind == "ball" else 0.2)
        for j in model.joints
    }
    start = so.Takeoff(
        quaternion=unit(rng, 4).tolist(), angular_velocity=(3 * unit(rng, 3)).tolist(),
        joints=joints,
    )  # fmt: skip
    ours, other = both(model, start, 1.0, axes)
    assert ours.ended == "duration"
    assert_same(ours, other, axes)


@either_hand
def test_maneuvers(axes: Axes) -> None:
    model = so.load("gymnast")
    drawn, by = redrawn(model, axes), sign(axes)
    for make, spin in ((so.torque_twist, 7.0), (so.torque_twist, -7.0), (so.inertia_change, 6.0)):
        ours, other = make(model, spin=spin), make(drawn, spin=by * spin)
        start = retold(ours.takeoff, axes)
        assert other.takeoff.tilt == pytest.approx(start.tilt, abs=1e-13)
        np.testing.assert_allclose(
            other.takeoff.angular_momentum, start.angular_momentum, atol=1e-12
        )
        flights = [maneuver.fly(accuracy=1e-11) for maneuver in (ours, other)]
        assert_same(*flights, axes)
    with pytest.raises(so.SomersaultError, match=f"{axes[0]} for a somersault or {axes[2]} for"):
        so.inertia_change(drawn, axis=axes[1])


def test_a_torque_twist_turns_as_it_was_given() -> None:
    for spin in (7.0, -7.0):
        omega = so.torque_twist(spin=spin, twist_rate=5.0).fly(samples=2).angular_velocity[0]
        np.testing.assert_allclose(omega, [0, spin, 5.0], atol=1e-3)


# --------------------------------------------------------------------------------- spins


@every_order
def test_deviations_and_spins(axes: Axes) -> None:
    model = so.load("furrer")
    drawn = redrawn(model, axes)
    springs, deviation = {"shoulder": 1.2}, {"tilt": 0.02, "somersault": 0.1, "twist": 0.01}
    ours, other = (so.spin(body, pose={"shoulder": 1.4}) for body in (model, drawn))
    assert other.axis == axes[0]
    assert other.linear(springs).coordinates == ours.linear(springs).coordinates
    np.testing.assert_allclose(other.linear(springs).roots, ours.linear(springs).roots, atol=1e-9)
    by = sign(axes)
    flown = [
        so.deviated_flight(
            spin, s * 8.64, 2.0, tilt=deviation["tilt"], twist=deviation["twist"],
            somersault=s * deviation["somersault"], stiffness=springs, accuracy=1e-11,
        )
        for spin, s in ((ours, 1), (other, by))
    ]  # fmt: skip
    assert flown[0].landing.somersault == pytest.approx(8.64 * 2, abs=0.5)
    assert_same(*flown, axes)
    rates = [
        so.stability.growth_rates(body, {"pose.shoulder": np.array([0.5, 1.4])}, lock=["all"])
        for body in (model, drawn)
    ]
    np.testing.assert_allclose(rates[1], rates[0], atol=1e-9)


# ----------------------------------------------------------------------------- ensembles

REPORT = so.Report(
    ("somersaults", "twists", "tilt", "somersault_rate", "tilt_rate", "twist_rate", "twist"),
    extremes=("somersault_rate", "tilt", "twist", "twist_rate"),
    history=("somersault", "tilt", "twist"), samples=5,
)  # fmt: skip


def flown(model: so.Model, takeoff: so.Takeoff, by: float, until: Any) -> Any:
    vary = {
        "turned": so.Vary(adds_to="takeoff.somersault", uniform=[-1.0, 1.0], scale=by),
        "leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05]),
        "twisted": so.Vary(adds_to="takeoff.twist", normal=[0.0, 0.05]),
    }
    return so.ensemble(
        model, takeoff, 1.5, vary, size=24, seed=3, report=REPORT, accuracy=1e-11, until=until,
        against={"somersault": by * 12.0, "twist": 0.5},
    ).dataset  # fmt: skip


@every_order
@pytest.mark.parametrize("until", [None, "quarter twist"])
def test_ensembles(axes: Axes, until: Any) -> None:
    model, takeoff, by = so.load("furrer"), TAKEOFFS["spin"], sign(axes)
    ours = flown(model, takeoff, 1.0, until)
    other = flown(redrawn(model, axes), retold(takeoff, axes), by, until)
    assert (ours["ended"] == other["ended"]).all()
    if until:
        assert (ours["ended"] == so.flight.ENDINGS.code("event")).any()
    for name in ours.data_vars:
        if name in ("steps", "ended"):
            continue
        wanted, rates = ours[name].values, 100 if "rate" in str(name) else 1
        if "somersault" in str(name) and by < 0:
            swapped = {"least": "greatest", "greatest": "least"}
            which, _, rest = str(name).partition("_")
            wanted = -ours[f"{swapped[which]}_{rest}" if which in swapped else name].values
        extremes = 1e4 if "least" in str(name) or "greatest" in str(name) else 1
        tolerance = SAME * max(rates, extremes)
        np.testing.assert_allclose(other[name].values, wanted, rtol=0, atol=tolerance)


def test_an_ensemble_of_other_axes_is_another(tmp_path: Path) -> None:
    store = tmp_path / "map.zarr"
    given: dict[str, Any] = {
        "takeoff": so.Takeoff(spin=8.0), "duration": 0.2, "out": store,
        "vary": {"tilted": so.Vary(sets="takeoff.tilt", values=[0.0, 0.1])},
    }  # fmt: skip
    so.ensemble("furrer", **given)
    so.ensemble(so.load("furrer", axes=(2, 1, 3)), **given)  # goes on with it
    with pytest.raises(so.SomersaultError, match="axes differs"):
        so.ensemble(so.load("furrer", axes=(3, 1, 2)), **given)


# ------------------------------------------------------------------------------- pictures


@every_order
def test_a_contact_sheet_is_the_same_picture(axes: Axes) -> None:
    seen = camera(35.0, 12.0, axes)
    np.testing.assert_allclose(seen @ seen.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(seen) == pytest.approx(1)
    model = so.load("furrer")
    flights = both(model, TAKEOFFS["spin"], 1.0, axes)
    made = [contact_sheet(flight, [0.0, 0.3, 0.9]) for flight in flights]
    boxes = [
        sorted([*p.get_xy().min(0), *p.get_xy().max(0)] for p in sheet.axes[0].patches)
        for sheet in made
    ]
    np.testing.assert_allclose(boxes[1], boxes[0], rtol=0, atol=1e-8)


@every_order
def test_a_shipped_model_of_other_axes_looks_the_same(axes: Axes) -> None:
    drawn, other = (model_shapes(so.load("furrer", axes=order)) for order in ((2, 1, 3), axes))
    assert drawn == other
    assert [len(shapes) for shapes in drawn] == [5, 1, 1]  # the trunk with head, neck and legs


@every_order
def test_left_and_right_are_along_the_axis_of_somersault(axes: Axes) -> None:
    """Of four arms crosswise, which are mirror images of each other across two planes."""
    box = as_matrix(np.diag([3.0, 2.0, 1.0]))
    trunk = so.Body("trunk", -1, 10.0, (0.0, 0.0, 0.0), box)
    arms = tuple(
        so.Body(
            f"arm{x}{y}", 0, 1.0, (0.2 * x, 0.3 * y, 0.0), as_matrix(np.eye(3)),
            joints=(so.Joint(f"arm{x}{y}", "hinge", (0.0, 0.0, 1.0)),),
        )
        for x in (1, -1) for y in (1, -1)
    )  # fmt: skip
    model = so.Model("cross", True, (trunk, *arms))
    pairs = mirror_pairs(redrawn(model, axes))
    assert [(pair.left, pair.right) for pair in pairs] == [(0, 1), (2, 3)]  # 1 is at our axis 2
    assert pairs == mirror_pairs(model)
