"""What joints do: torques, couplings, springs without dimension, and a behaviour from outside."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path as File
from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from trees import mujoco_addresses, to_mujoco

import somersault as so
from somersault import JointTakeoff, SomersaultError, Takeoff
from somersault.attitude import quaternion_conjugate, quaternion_product
from somersault.flight.behaviours import Here, Moving, quantity
from somersault.model import Follow
from somersault.motion import Path, as_moves, held, moves, straight

GYMNAST = so.load("gymnast")


def apart(one: np.ndarray, two: np.ndarray) -> float:
    """Angle between two attitudes, rad."""
    turn = quaternion_product(quaternion_conjugate(one), two)
    return 2 * float(np.linalg.norm(turn[1:]))


# --------------------------------------------------------------------------------- torque


@pytest.mark.parametrize("rest", [None, 0.3])
def test_held_torques_are_mujocos(rest: float | None) -> None:
    """Torques at 100 Hz in all joints, springs and dampers too, against Runge–Kutta steps."""
    rng, seconds, substeps = np.random.default_rng(4), 0.4, 100
    times = np.arange(0.0, seconds, 0.01)
    passive = {} if rest is None else {"stiffness": 30.0, "rest": rest, "damping": 0.4}
    drives = {j.name: rng.uniform(-8, 8, len(times)) for j in GYMNAST.joints}
    joints = {
        name: JointTakeoff.torque(times=times, torques=row, between="held", **passive)
        for name, row in drives.items()
    }
    takeoff = Takeoff(spin=5.0, tilt=0.1, joints=joints)
    flight = so.fly(GYMNAST, takeoff, seconds, samples=2, accuracy=1e-11)
    m = to_mujoco(GYMNAST, 0.01 / substeps)
    m.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
    m.opt.gravity[:] = 0
    d = mujoco.MjData(m)
    q_at, v_at = mujoco_addresses(GYMNAST, m)
    for name in drives:
        joint = m.joint(name)
        if rest is not None:
            m.jnt_stiffness[joint.id], m.dof_damping[joint.dofadr[0]] = 30.0, 0.4
            m.qpos_spring[joint.qposadr[0]] = rest
    d.qpos[3:7], d.qvel[3:6] = flight.start.quaternion, flight.start.omega
    d.qpos[q_at], d.qvel[v_at] = flight.start.q, flight.start.u
    for k in range(len(times)):
        d.qfrc_applied[v_at] = [row[k] for row in drives.values()]
        for _ in range(substeps):
            mujoco.mj_step(m, d)
    assert apart(flight.landing.quaternion, d.qpos[3:7] / np.linalg.norm(d.qpos[3:7])) < 1e-7
    angles = np.array(list(flight.landing.joints.values()))
    np.testing.assert_allclose(angles, d.qpos[q_at], atol=1e-6)
    assert np.ptp(angles) > 0.5


def test_a_constant_torque_is_a_pretension() -> None:
    flown = [
        so.fly("furrer", Takeoff(tilt=0.1, spin=3.0, joints={"left_shoulder": does}), 0.5)
        for does in (JointTakeoff.torque(torque=2.0), JointTakeoff.free(pretension=2.0))
    ]
    one, two = (flight.landing for flight in flown)
    assert apart(one.quaternion, two.quaternion) < 1e-13
    assert one.joints["left_shoulder"] == pytest.approx(two.joints["left_shoulder"], abs=1e-13)
    assert flown[0].energy_drift is None


def test_a_torque_does_the_work_that_the_energy_gains() -> None:
    times = np.linspace(0.0, 0.5, 6)
    does = JointTakeoff.torque(times=times, torques=[0, 4, -2, 5, 1, 0])
    flight = so.fly("furrer", Takeoff(spin=3.0, joints={"left_shoulder": does}), 0.5, samples=2001)
    rate = flight.dataset["joint_rate"].sel(joint_speed="left_shoulder").values
    power = np.interp(flight.times, times, does.torques) * rate
    work = np.trapezoid(power, flight.times)
    assert np.ptp(flight.kinetic_energy) == pytest.approx(abs(work), rel=0.5)
    assert flight.kinetic_energy[-1] - flight.kinetic_energy[0] == pytest.approx(work, rel=1e-5)


def test_samples_may_come_from_a_file(tmp_path: File) -> None:
    file = tmp_path / "torques.csv"
    file.write_text("time [ms],knee [N m],elbow\n0,1,5\n100,2,6\n200,4,7\n")
    does = JointTakeoff.torque(file=file, column="knee")
    assert (does.file, does.column) == (None, None)  # it holds the samples now
    assert (does.times, does.torques) == ((0.0, 0.1, 0.2), (1.0, 2.0, 4.0))
    for column, said in ((None, "names no column"), ("hip", "'hip'.*knee, elbow")):
        with pytest.raises(SomersaultError, match=said):
            JointTakeoff.torque(file=file, column=column)
    with pytest.raises(SomersaultError, match="both a file"):
        JointTakeoff.torque(file=file, column="knee", times=[0, 1], torques=[0, 1])


def test_the_mirrored_joint_gets_the_mirrored_torque() -> None:
    """A pair driven by its common name moves symmetrically."""
    does = JointTakeoff.torque(torque=3.0, times=[0.0, 0.2], torques=[0.0, -5.0])
    takeoff = Takeoff(spin=4.0, joints={"shoulder": does})
    flight = so.fly("furrer", takeoff, 0.3, accuracy=1e-12)
    left, right = flight.dataset["joint_angle"].values.T
    np.testing.assert_allclose(left, -right, rtol=0, atol=1e-9)
    assert np.ptp(left) > 0.05


def test_numbers_of_a_torque_can_be_varied() -> None:
    does = JointTakeoff.torque(torque=1.0, times=[0.0, 0.2], torques=[0.0, 4.0])
    takeoff = Takeoff(spin=4.0, joints={"left_shoulder": does})
    vary = {
        "constant": so.Vary(sets="joints.left_shoulder.torque", samples=[1.0, -2.0]),
        "late": so.Vary(adds_to="joints.left_shoulder.times.2", samples=[0.0, 0.1]),
        "more": so.Vary(adds_to="joints.left_shoulder.torques.2", samples=[0.0, 1.0]),
    }
    options = {"size": 2, "report": ["twist", "left_shoulder"], "accuracy": 1e-10}
    flown = so.ensemble("furrer", takeoff, 0.4, vary, **options).dataset
    other = replace(does, torque=-2.0, times=[0.0, 0.3], torques=[0.0, 5.0])
    for k, each in enumerate((does, other)):
        alone = so.fly("furrer", replace(takeoff, joints={"left_shoulder": each}), 0.4)
        assert float(flown["twist"][k]) == pytest.approx(alone.landing.twist, abs=1e-8)
        angle = alone.landing.joints["left_shoulder"]
        assert float(flown["left_shoulder"][k]) == pytest.approx(angle, abs=1e-8)


# --------------------------------------------------------------------------------- coupled

MOVE = {"times": [0.05, 0.3], "angles": [0.2, 1.3]}


def test_a_joint_that_follows_a_path_is_on_a_path() -> None:
    angles = [1.5 * a - 0.1 for a in MOVE["angles"]]
    led = {
        "left_elbow": JointTakeoff.prescribed(**MOVE),
        "right_elbow": JointTakeoff.coupled(leader="left_elbow", factor=1.5, offset=-0.1),
    }
    both = led | {"right_elbow": JointTakeoff.prescribed(times=MOVE["times"], angles=angles)}
    flown = [so.fly(GYMNAST, Takeoff(spin=6.0, joints=j), 0.4) for j in (led, both)]
    assert apart(*(flight.landing.quaternion for flight in flown)) < 1e-12
    assert flown[0].landing.joints["right_elbow"] == pytest.approx(1.85)
    np.testing.assert_allclose(*(flight.joint_torques.values for flight in flown), atol=1e-8)


def test_a_joint_that_follows_a_locked_one_is_locked() -> None:
    joints = {
        "left_elbow": JointTakeoff.locked(0.8),
        "right_elbow": JointTakeoff.coupled(leader="left_elbow"),
    }
    flight = so.fly(GYMNAST, Takeoff(spin=6.0, joints=joints), 0.3)
    assert set(flight.dataset["joint_angle"].sel(joint="right_elbow").values.tolist()) == {0.8}


def test_what_the_model_gears_follows_without_being_named() -> None:
    bodies = []
    for body in GYMNAST.bodies:
        joints = tuple(
            replace(j, follows=Follow("left_elbow", 0.5, 0.1)) if j.name == "right_elbow" else j
            for j in body.joints
        )
        bodies.append(replace(body, joints=joints))
    geared = replace(GYMNAST, bodies=tuple(bodies))
    takeoff = Takeoff(spin=6.0, joints={"left_elbow": JointTakeoff.prescribed(**MOVE)})
    assert so.fly(geared, takeoff, 0.4).landing.joints["right_elbow"] == pytest.approx(0.75)


def test_a_pair_is_coupled_to_the_mirror_image_of_its_leader() -> None:
    joints = {
        "elbow": JointTakeoff.coupled(leader="left_hip_flexion", factor=0.7, offset=0.2),
        "hip_flexion": JointTakeoff.prescribed(times=[0.0, 0.3], angles=[0.0, 1.0]),
    }
    end = so.fly(GYMNAST, Takeoff(spin=6.0, joints=joints), 0.4).landing.joints
    assert end["left_elbow"] == pytest.approx(0.9)
    assert end["right_elbow"] == pytest.approx(0.9)


@pytest.mark.parametrize("factor", [1.0, -0.6])
def test_gears_to_a_joint_that_moves_freely_keep_energy_and_momentum(factor: float) -> None:
    """Ideal gears do no work; the follower's own spring acts through them."""
    joints = {
        "left_elbow": JointTakeoff.sprung(0.6, 1.5, stiffness=4.0, rest=0.2),
        "right_elbow": JointTakeoff.coupled(
            leader="left_elbow", factor=factor, offset=0.8, stiffness=2.0, rest=0.5
        ),
        "left_shoulder_abduction": JointTakeoff.free(0.9),
    }
    flight = so.fly(GYMNAST, Takeoff(spin=5.0, tilt=0.1, joints=joints), 1.0, accuracy=1e-11)
    left, right = (
        flight.dataset["joint_angle"].sel(joint=name).values
        for name in ("left_elbow", "right_elbow")
    )
    np.testing.assert_allclose(right, factor * left + 0.8, atol=1e-13)
    assert np.ptp(left) > 0.3
    assert flight.energy_drift is not None
    assert flight.energy_drift < 1e-10
    assert flight.momentum_drift < 1e-12


def test_gears_that_symmetry_makes_anyway_change_nothing() -> None:
    """A symmetric body in a symmetric spin: with the right arm geared to the left or not."""
    spring = {"stiffness": 20.0, "rest": 0.3}
    both = {"shoulder": JointTakeoff.sprung(0.9, 0.5, **spring)}
    geared = {
        "left_shoulder": JointTakeoff.sprung(0.9, 0.5, **spring),
        "right_shoulder": JointTakeoff.coupled(
            leader="left_shoulder", factor=-1.0, stiffness=20.0, rest=-0.3
        ),
    }
    flown = [
        so.fly("furrer", Takeoff(spin=5.0, joints=j), 0.5, accuracy=1e-12) for j in (both, geared)
    ]
    assert apart(*(flight.landing.quaternion for flight in flown)) < 1e-9
    angles = [flight.landing.joints["left_shoulder"] for flight in flown]
    assert angles[0] == pytest.approx(angles[1], abs=1e-9)


@pytest.mark.parametrize(
    ("joints", "said"),
    [
        ({"left_elbow": JointTakeoff.coupled(leader="knee")}, "left_elbow.*knee.*no joint"),
        (
            {
                "left_elbow": JointTakeoff.coupled(leader="right_elbow"),
                "right_elbow": JointTakeoff.coupled(leader="left_elbow"),
            },
            "left_elbow.*right_elbow.*leads them all",
        ),
        ({"left_elbow": JointTakeoff.coupled()}, "left_elbow.*name its leader"),
        (
            {"left_elbow": JointTakeoff.coupled(leader="left_elbow")},
            "left_elbow cannot follow itself",
        ),
    ],
)
def test_what_cannot_be_coupled(joints: dict, said: str) -> None:
    with pytest.raises(SomersaultError, match=said):
        so.fly(GYMNAST, Takeoff(spin=6.0, joints=joints), 0.1)


# ------------------------------------------------------------------------ without dimension


def test_springs_without_dimension_are_those_of_the_theory() -> None:
    spin, angle, K, B = 8.64, 1.4, 1.2, 0.05
    inertia = so.spin("furrer", pose={"shoulder": angle}).outboard_inertias["left_shoulder"]
    given = {"stiffness": K * spin**2 * inertia, "damping": B * spin * inertia}
    by_rate = Takeoff(tilt=0.01, spin=spin)
    by_momentum = so.with_momentum("furrer", replace(by_rate, tilt=0.0))
    for takeoff in (by_rate, by_momentum):
        ends = []
        for numbers in ({"K": K, "B": B}, given):
            arms = {"shoulder": JointTakeoff.sprung(angle, hold=True, **numbers)}
            if takeoff is by_momentum:
                nominal = so.with_momentum("furrer", replace(by_rate, tilt=0.0, joints=arms))
                arms_takeoff = replace(nominal, tilt=0.01)
            else:
                arms_takeoff = replace(takeoff, joints=arms)
            ends.append(so.fly("furrer", arms_takeoff, 2.0).landing)
        assert ends[0].twist == pytest.approx(ends[1].twist, abs=1e-9)


def test_without_dimension_needs_a_spin_and_no_dimension() -> None:
    arms = {"shoulder": JointTakeoff.sprung(1.4, K=1.0)}
    with pytest.raises(SomersaultError, match="K and B are of a nominal spin"):
        so.fly("furrer", Takeoff(joints=arms))
    with pytest.raises(SomersaultError, match="both K and a stiffness"):
        so.fly(
            "furrer",
            Takeoff(spin=3.0, joints={"shoulder": replace(arms["shoulder"], stiffness=1.0)}),
        )


# --------------------------------------------------------------- a behaviour from elsewhere


@dataclass(frozen=True)
class Cubic(Moving, motion="cubic"):
    """A joint with a spring whose torque is −k q³."""

    cubic: float = quantity("N m/rad³", default=0.0)

    def springs(self, joint: so.Joint) -> tuple[str, ...]:
        return ("cubic",)

    def acting(self, here: Here) -> list[Any]:
        (passive,) = super().acting(here)
        return [passive - here.numbers["cubic"] * here.q[0] ** 3]

    def energy(self, joint: so.Joint, q: np.ndarray) -> np.ndarray:
        return self.cubic * q[..., 0] ** 4 / 4 - self.pretension * q[..., 0]


def test_one_class_is_a_behaviour() -> None:
    takeoff = Takeoff(spin=4.0, joints={"shoulder": JointTakeoff.cubic(0.9, cubic=25.0)})
    flight = so.fly("furrer", takeoff, 2.0, accuracy=1e-11)
    assert flight.energy_drift is not None
    assert flight.energy_drift < 1e-9
    assert flight.momentum_drift < 1e-12
    assert np.ptp(flight.spring_energy) > 1.0
    vary = {"k": so.Vary(sets="joints.shoulder.cubic", values=[10.0, 25.0])}
    many = so.ensemble("furrer", takeoff, 2.0, vary, report=["left_shoulder"], accuracy=1e-9)
    last = float(many.dataset["left_shoulder"].sel(k=25.0).squeeze())
    assert last == pytest.approx(flight.landing.joints["left_shoulder"], abs=1e-6)


@dataclass(frozen=True)
class Forgetful(Moving, motion="forgetful"):
    """A behaviour that does not name the number that it uses."""

    c: float = quantity("N m", default=1.0)

    def acting(self, here: Here) -> list[Any]:
        return [here.numbers["c"]]


def test_a_number_that_is_not_named_is_said() -> None:
    joints = {"left_shoulder": JointTakeoff.forgetful()}
    with pytest.raises(SomersaultError, match=r"left_shoulder has no number 'c'.*springs\(\)"):
        so.fly("furrer", Takeoff(spin=4.0, joints=joints), 0.1)


def test_what_a_behaviour_does_not_take_is_said() -> None:
    with pytest.raises(SomersaultError, match=r"prescribed takes .*times.*by name"):
        JointTakeoff.prescribed([0.1, 0.4], [0.0, 0.5])
    with pytest.raises(SomersaultError, match="cubic would do nothing for a joint that is free"):
        JointTakeoff.free(cubic=2.0)
    with pytest.raises(SomersaultError, match="springiness is nothing that a joint has"):
        JointTakeoff.sprung(springiness=2.0)
    assert JointTakeoff.locked(rate=0.0, damping=0.0, hold=False) == JointTakeoff.locked()


# ------------------------------------------------------------------------------------ paths

ROWS = st.lists(st.floats(-3, 3), min_size=2, max_size=5)


@given(ROWS, st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_paths_backwards_and_straight(values: list[float], seed: int) -> None:
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(0.05, 0.4, len(values)))
    row, end = np.array(values), float(times[-1]) + 0.2
    ramp, level = straight(times, row), held(times, row)
    for t in rng.uniform(-0.1, end, 20):
        assert at(ramp, t) == pytest.approx(np.interp(t, times, row), abs=1e-9)
        k = max(int(np.searchsorted(times, t, side="right")) - 1, 0)
        assert at(level, t) == row[k]
    for path in (moves(times, row), ramp):
        back = path.reversed(end)
        for t in rng.uniform(0.0, end, 20):
            assert at(back, t) == pytest.approx(at(path, end - t), abs=1e-8)
    again = as_moves(moves(times, row).image(-1.0, 0.4))
    assert again is not None
    np.testing.assert_allclose(again[1], 0.4 - row, atol=1e-12)
    if np.ptp(row) > 1e-3:
        assert as_moves(ramp) is None


def at(path: Path, time: float) -> float:
    origin, coefficients = path.at(np.array([[time]]))
    s = time - float(origin[0, 0])
    return math.fsum(c * s**k for k, c in enumerate(coefficients[0, 0].tolist()))
