"""Compliant flights: what they must be, whoever computes them; their gains, maps and mistakes.

That the torques are the right ones is for `test_compliance_mujoco.py`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
import pytest
from test_flight_mujoco import apart
from test_prescribed import GYMNAST, MOVES, SECONDS, prescribed
from trees import InMujoco, State, random_tree, to_mujoco, unit

import somersault as so
from somersault import JointTakeoff, SomersaultError, Takeoff
from somersault.flight import ENDINGS
from somersault.flight._batch import Batch
from somersault.model import Model

NAMES = [joint.name for joint in GYMNAST.joints]
PIKED = {name: angles[0] for name, (_, angles) in MOVES.items()}
ZETA = 0.7


def fly(takeoff: Takeoff, seconds: float = SECONDS, **options: Any) -> so.Flight:
    return so.fly(GYMNAST, takeoff, seconds, **{"accuracy": 1e-11, **options})


def compliant(natural_frequency: Any = 25.0, zeta: Any = ZETA, **options: Any) -> Takeoff:
    given = {"pose": so.named_pose("gymnast", "wrap"), **options}
    return so.compliant(GYMNAST, prescribed(), natural_frequency, zeta, **given)


def leant(takeoff: Takeoff, tilt: float = -0.1, twist: float = 0.07) -> Takeoff:
    return replace(takeoff, tilt=takeoff.tilt + tilt, twist=takeoff.twist + twist)


def left_path(flight: so.Flight, other: so.Flight) -> float:
    """The most by which a joint of one flight is elsewhere than in the other."""
    return float(np.abs(flight._joints[0] - other._joints[0]).max())


@pytest.fixture(scope="module")
def nominal() -> so.Flight:
    return fly(prescribed())


# ---------------------------------------------------------------------- from the nominal start


@pytest.mark.parametrize("natural_frequency", [15.0, 60.0])
@pytest.mark.parametrize("pose", ["wrap", "following", 0.1])
def test_the_tape_alone_flies_the_nominal_flight(
    nominal: so.Flight, natural_frequency: float, pose: Any
) -> None:
    flight = fly(compliant(natural_frequency, pose=pose))
    assert left_path(flight, nominal) < 1e-9
    assert apart(flight.landing.quaternion, nominal.landing.quaternion) < 1e-9
    assert flight.momentum_drift < 1e-9
    # What the springs and dampers add is nothing: the whole torque is the tape.
    size = np.abs(nominal.joint_torques.values).max()
    np.testing.assert_allclose(
        flight.joint_torques, nominal.joint_torques, rtol=0, atol=1e-7 * size
    )


def test_without_the_tape_the_body_lags_behind_its_paths(nominal: so.Flight) -> None:
    begun = compliant(tape=False)
    assert begun.tape is None
    flight = fly(begun)
    assert left_path(flight, nominal) > 0.05
    assert apart(flight.landing.quaternion, nominal.landing.quaternion) > 0.05
    assert flight.momentum_drift < 1e-9


def test_a_stiff_body_lands_as_the_prescribed_one() -> None:
    """Off the nominal start, where the tape is wrong; the error goes as 1/ω_n²."""
    exact = fly(leant(so.with_momentum(GYMNAST, prescribed())))
    errors, strays = [], []
    for natural_frequency in (100.0, 200.0, 400.0):
        flight = fly(leant(compliant(natural_frequency)), accuracy=1e-9)
        errors.append(apart(flight.landing.quaternion, exact.landing.quaternion))
        strays.append(left_path(flight, exact))
        assert flight.momentum_drift < 1e-9
    assert errors[2] < 1e-2
    assert strays[2] < 1e-2
    for values in (errors, strays):
        assert 3.5 < values[0] / values[1] < 4.5
        assert 3.8 < values[1] / values[2] < 4.2


def test_the_momentum_stays_in_space_when_the_attitude_changes(nominal: so.Flight) -> None:
    for begun in (compliant(), so.with_momentum(GYMNAST, prescribed())):
        flight = fly(leant(begun))
        assert flight.momentum_drift < 1e-9
        h = flight.start.momentum
        np.testing.assert_allclose(h, nominal.start.momentum, rtol=1e-12, atol=1e-12)
    # ω in the takeoff's own axes would have turned it along.
    turned = fly(leant(prescribed()), samples=2).start.momentum
    assert np.abs(turned - nominal.start.momentum).max() > 0.5


@pytest.mark.parametrize("start", [{"spin": 9.0}, {"angular_velocity": (0.4, 8.0, -1.0)}])
def test_with_momentum_is_the_same_takeoff(start: dict[str, Any]) -> None:
    given = {"spin": None, **start}
    before = prescribed(**given)
    after = so.with_momentum(GYMNAST, before)
    assert after.angular_momentum is not None
    assert after.spin is None
    assert after.angular_velocity is None
    one, other = (fly(t, samples=2).landing for t in (before, after))
    assert apart(one.quaternion, other.quaternion) < 1e-10


def test_energy_is_kept_about_a_path_that_stays() -> None:
    """Without dampers, and without a tape: springs about angles that do not move."""
    held = {n: JointTakeoff("prescribed", times=[0.0], angles=[a]) for n, a in PIKED.items()}
    still = Takeoff(tilt=0.1, spin=8.0, joints=held)
    begun = so.compliant(GYMNAST, still, 25.0, 0.0, pose=0.0, tape=False)
    flight = fly(begun, 1.0)
    away = flight._joints[0] - [PIKED[n] for n in NAMES]
    stiffness = np.array([begun.joints[n].stiffness for n in NAMES])
    springs = 0.5 * (stiffness * away**2).sum(1)
    energy = flight.kinetic_energy + springs
    assert springs.max() > 1e-3 * energy[0]
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)
    assert flight.momentum_drift < 1e-9
    damped = fly(so.compliant(GYMNAST, still, 25.0, ZETA, pose=0.0, tape=False), 1.0)
    assert damped.kinetic_energy[-1] < 0.999 * flight.kinetic_energy[0]


def test_gains_by_joint_are_those_of_each_alone() -> None:
    """A joint's gains are those that it has where all have its frequency and ratio."""
    given = {"*shoulder*": 18.0, "left_elbow": 30.0, "right_elbow": 31.0, "*hip*": 22.0}
    ratios = {"*_*_*": 0.5, "*elbow": 0.9, "torso_twist": 0.6}
    soft = compliant({**given, "torso_twist": 12.0}, ratios).joints
    of = {"left_shoulder_flexion": (18.0, 0.5), "right_elbow": (31.0, 0.9)}
    for name, (frequency, ratio) in {**of, "torso_twist": (12.0, 0.6)}.items():
        alone = compliant(frequency, ratio).joints[name]
        assert soft[name] == alone
    pair = compliant({"elbow": 30.0, "*_*_*": 20.0, "torso_twist": 20.0}).joints
    assert pair["right_elbow"].stiffness == compliant(30.0).joints["right_elbow"].stiffness


def test_springs_of_the_model_do_not_act_beside_compliance() -> None:
    """A tree whose joints have springs, dampers and rotors of their own, hinges and slides.

    The tape is the whole torque of the nominal motion, so they would act twice.
    """
    rng = np.random.default_rng(19)
    model = random_tree(rng, 4, True, ("hinge", "slide"))
    assert any(j.stiffness for j in model.joints)
    assert any(j.damping for j in model.joints)
    joints = {}
    for joint in model.joints:
        size = 0.2 if joint.kind == "slide" else 0.8
        times = np.cumsum(rng.uniform(0.05, 0.2, 3))
        angles = joint.reference + size * rng.normal(size=3)
        joints[joint.name] = JointTakeoff("prescribed", times=times, angles=angles)
    begun = Takeoff(quaternion=unit(rng, 4), angular_velocity=3 * unit(rng, 3), joints=joints)
    exact = so.fly(model, begun, 0.6, accuracy=1e-11)
    soft = so.compliant(model, begun, 30.0, ZETA, pose=0.1)
    flight = so.fly(model, soft, 0.6, accuracy=1e-11)
    assert np.abs(flight._joints[0] - exact._joints[0]).max() < 1e-8
    assert np.ptp(exact._joints[0], axis=0).min() > 0.02


# ------------------------------------------------------------------------------------- gains


def outboard(model: Model, angles: dict[str, float]) -> dict[str, float]:
    """Inertia outboard of each joint, by MuJoCo: the diagonal of its mass matrix."""
    q = np.array([angles.get(j.name, j.reference) for j in model.joints])
    still = np.zeros(6 + len(q))
    state = State(np.eye(4)[0], q, still, still[6:], np.zeros(3))
    mass = InMujoco(model, to_mujoco(model), state).mass_matrix
    return dict(zip([j.name for j in model.joints], np.diag(mass)[6:].tolist(), strict=True))


@pytest.mark.parametrize("name", ["wrap", "pike"])
def test_a_named_pose_is_that_of_athletes(name: str) -> None:
    by_angles = compliant(pose=so.named_pose(GYMNAST, name))
    assert compliant(pose=name).joints == by_angles.joints


def assert_gains(begun: Takeoff, inertias: dict[str, float], omega_n: float, zeta: float) -> None:
    for name, inertia in inertias.items():
        joint = begun.joints[name]
        assert joint.motion == "compliant"
        np.testing.assert_allclose(joint.stiffness, omega_n**2 * inertia, rtol=1e-12)
        np.testing.assert_allclose(joint.damping, 2 * zeta * omega_n * inertia, rtol=1e-12)


def test_gains_of_a_pose_by_name() -> None:
    pose = so.named_pose("gymnast", "wrap")
    angles = {n: pose.get(n.split("_", 1)[1], 0.0) for n in NAMES}
    assert_gains(compliant(30.0, 0.4), outboard(GYMNAST, angles), 30.0, 0.4)
    one = {"left_elbow": 1.0}  # the others as the file draws them
    assert_gains(compliant(30.0, pose=one), outboard(GYMNAST, one), 30.0, ZETA)


def test_gains_of_the_motion_at_a_time(nominal: so.Flight) -> None:
    for k in (0, 17, len(nominal.times) - 1):
        angles = dict(zip(NAMES, nominal._joints[0][k].tolist(), strict=True))
        begun = compliant(30.0, pose=float(nominal.times[k]))
        assert_gains(begun, outboard(GYMNAST, angles), 30.0, ZETA)
    # After the last knot the path is held, and so is the pose.
    last = {name: angles[-1] for name, (_, angles) in MOVES.items()}
    assert_gains(compliant(30.0, pose=5.0), outboard(GYMNAST, last), 30.0, ZETA)
    assert_gains(compliant(30.0, pose=-1.0), outboard(GYMNAST, PIKED), 30.0, ZETA)


def test_a_pair_by_its_common_name() -> None:
    joints = {"elbow": JointTakeoff("prescribed", times=[0.1, 0.3], angles=[0.2, 1.5])}
    begun = so.compliant(GYMNAST, Takeoff(spin=9.0, joints=joints), 20.0, pose=0.3)
    wanted = outboard(GYMNAST, {"left_elbow": 1.5, "right_elbow": 1.5})
    names = ("left_elbow", "right_elbow")
    assert_gains(begun, {n: wanted[n] for n in names}, 20.0, ZETA)
    assert begun.joints["right_hip_flexion"].motion == "locked"


def test_gains_that_follow_a_pose_that_stays_are_those_of_the_pose() -> None:
    held = {n: JointTakeoff("prescribed", times=[0.0], angles=[a]) for n, a in PIKED.items()}
    still = Takeoff(tilt=0.1, spin=8.0, joints=held)
    ends = [
        fly(leant(so.compliant(GYMNAST, still, 25.0, ZETA, pose=pose)), accuracy=1e-12)
        for pose in ("following", PIKED, 0.2)
    ]
    for end in ends[1:]:
        assert apart(ends[0].landing.quaternion, end.landing.quaternion) < 1e-10
        assert left_path(ends[0], end) < 1e-10
    assert left_path(ends[0], fly(still)) > 1e-3


def test_gains_that_follow_are_of_the_nominal_pose_at_each_moment(nominal: so.Flight) -> None:
    """The torque beside the tape is ω_n² I(t) (path − angle) + 2 ζ ω_n I(t) (rates)."""
    flight = fly(leant(compliant(30.0, pose="following")))
    q, u = flight._joints
    for k in (0, 11, 21, 33):
        wanted, rates = nominal._joints[0][k], nominal._joints[1][k]
        inertias = outboard(GYMNAST, dict(zip(NAMES, wanted.tolist(), strict=True)))
        i = np.array([inertias[n] for n in NAMES])
        pull = i * (900.0 * (wanted - q[k]) + 2 * ZETA * 30.0 * (rates - u[k]))
        beside = flight.joint_torques.values[k] - nominal.joint_torques.values[k]
        np.testing.assert_allclose(beside, pull, rtol=0, atol=1e-6)


# --------------------------------------------------------------------------------- ensembles

GRID = {
    "leant": so.Vary(adds_to="takeoff.tilt", values=[-0.1, 0.0, 0.05]),
    "turned": so.Vary(adds_to="takeoff.twist", values=[-0.1, 0.02, 0.1]),
}
TOLD = ("somersault", "tilt", "twist", "left_elbow", "right_hip_flexion", "angular_velocity_3")


@pytest.mark.parametrize("pose", [pytest.param("following", marks=pytest.mark.slow), 0.25, None])
def test_a_map_is_its_single_flights(pose: Any) -> None:
    """Of compliant and (None) of prescribed flights, the momentum staying where it is."""
    begun = so.with_momentum(GYMNAST, prescribed()) if pose is None else compliant(pose=pose)
    made = so.ensemble(GYMNAST, begun, SECONDS, GRID, report=TOLD, accuracy=1e-11).dataset
    for i, tilt in enumerate(GRID["leant"].values):
        for j, twist in enumerate(GRID["turned"].values):
            if (i + j) % 2:
                continue
            one = fly(leant(begun, tilt, twist), samples=2).landing
            own = made.isel(leant=i, turned=j)
            assert ENDINGS.words[int(own.ended)] == one.ended == "duration"
            wanted = {"somersault": one.somersault, "tilt": one.tilt, "twist": one.twist}
            wanted |= one.joints | {"angular_velocity_3": one.angular_velocity[2]}
            for name in TOLD:
                np.testing.assert_allclose(float(own[name]), wanted[name], rtol=0, atol=3e-8)
    assert np.ptp(made["angular_velocity_3"].values) > 1e-2


def test_a_compliant_flight_of_too_many_steps_is_told_and_not_averaged() -> None:
    with pytest.warns(so.SomersaultWarning, match="too many steps: 9"):
        few = so.ensemble(GYMNAST, compliant(), SECONDS, GRID, report=TOLD, steps=50)
    data = few.dataset
    assert {ENDINGS.words[int(k)] for k in data.ended.values.ravel()} == {"too many steps"}
    assert int(data.steps.max()) <= 50
    assert (data.time.values < SECONDS).all()
    share = few.fraction(good=data.tilt == data.tilt, over=("leant", "turned"))
    assert float(share.fraction) == 0.0
    assert int(share.flights) == 9


# ---------------------------------------------------------------------------------- mistakes

PATH: dict[str, Any] = {"times": [0.1, 0.2], "angles": [0.1, 0.5]}
ELBOW = Takeoff(spin=9.0, joints={"left_elbow": JointTakeoff("prescribed", **PATH)})


def _elbow(**given: Any) -> Takeoff:
    joint = JointTakeoff("compliant", **{**PATH, "stiffness": 1.0, "damping": 0.1, **given})
    return so.with_momentum(GYMNAST, Takeoff(spin=9.0, joints={"left_elbow": joint}))


def _taped(joint: JointTakeoff) -> so.Flight:
    return so.fly(GYMNAST, replace(ELBOW, tape=(0, 9, 0), joints={"left_elbow": joint}), 0.2)


def _soft(natural_frequency: Any = 20.0, zeta: Any = ZETA, pose: Any = 0.0, **more: Any) -> Any:
    return so.compliant(GYMNAST, replace(ELBOW, **more), natural_frequency, zeta, pose=pose)


SPRUNG = JointTakeoff("sprung", stiffness=2.0)
ARM = Takeoff(spin=8.0, joints={"shoulder": JointTakeoff("prescribed", times=[0.0], angles=[1.0])})
MISTAKES = [
    (lambda: _elbow(stiffness=None), "stiffness and damping"),
    (lambda: _elbow(damping=None), "stiffness and damping"),
    (lambda: _elbow(damping=-1.0), "negative damping"),
    (lambda: _elbow(stiffness=np.nan), "stiffness"),
    (lambda: _elbow(stiffness="soft"), "stiffness"),
    (lambda: _elbow(rest=0.1), "rest would do nothing"),
    (lambda: _elbow(pretension=1.0), "pretension"),
    (lambda: _elbow(angle=0.1), "angle would do nothing"),
    (lambda: _elbow(rate=0.1), "rate would do nothing"),
    (lambda: _elbow(times=[0.1]), "as many times as angles"),
    (lambda: _elbow(angles=[0.1, np.nan]), "left_elbow"),
    (lambda: _elbow(times=[], angles=[]), "as many times as angles"),
    (lambda: _taped(JointTakeoff("free")), "on no path"),
    (lambda: _taped(SPRUNG), "on no path"),
    (lambda: _taped(JointTakeoff("locked", following=True)), "locked"),
    (lambda: Takeoff(tape=(0, 1)), "tape must be 3 numbers"),
    (lambda: Takeoff(tape=True), "tape must be 3 numbers"),
    (lambda: Takeoff(tape="abc"), "tape must be 3 numbers"),
    (lambda: Takeoff(tape=(0, np.nan, 1)), "tape must be finite"),
    (lambda: _soft(-20.0), "natural_frequency"),
    (lambda: _soft(0.0), "natural_frequency"),
    (lambda: _soft(np.nan), "natural_frequency"),
    (lambda: _soft("fast"), "natural_frequency"),
    (lambda: _soft(None), "natural_frequency"),
    (lambda: _soft({"elbow": -1.0}), "natural_frequency"),
    (lambda: _soft({"elbow": "fast"}), "natural_frequency elbow"),
    (lambda: _soft({"*shoulder*": 20.0}), "none of the joints on paths; there are left_elbow"),
    (lambda: _soft({"elbow": 20.0, "left_elbow": 20.0}), "given twice"),
    (lambda: _soft({}), "but not of left_elbow"),
    (lambda: _soft(zeta={"elbow": -0.1}), "damping_ratio"),
    (lambda: _soft(zeta=-0.1), "damping_ratio"),
    (lambda: _soft(zeta=np.inf), "damping_ratio"),
    (lambda: _soft(pose={"knee": 0.1}), "knee"),
    (lambda: _soft(pose={"elbow": 9.0}), "limits"),
    (lambda: _soft(pose={"elbow": np.nan}), "elbow"),
    (lambda: _soft(pose="wrapped"), "'following', 'layout', 'T'"),
    (lambda: so.compliant("furrer", ARM, 20.0, pose="wrap"), "a word of 'following'"),
    (lambda: _soft(pose=None), "pose"),
    (lambda: _soft(pose=np.inf), "pose"),
    (lambda: _soft(pose=1e12), "pose"),
    (lambda: _soft(joints={}), "nothing is prescribed"),
    (lambda: _soft(joints=compliant().joints), "nothing is prescribed"),
    (lambda: _soft(joints={**ELBOW.joints, "right_elbow": SPRUNG}), "right_elbow is sprung"),
    (lambda: _soft(joints={**ELBOW.joints, "right_elbow": JointTakeoff("free")}), "is free"),
    (lambda: so.compliant("book", Takeoff(spin=9.0), 20.0, pose={}), "nothing is prescribed"),
    (lambda: so.compliant("gymnasium", ELBOW, 20.0, pose={}), "gymnasium"),
    (lambda: so.compliant(GYMNAST, "rudi", 20.0, pose={}), "takeoff"),
    (lambda: so.with_momentum(GYMNAST, None), "takeoff"),
    (lambda: _soft(pose=np.array([0.1, 0.2])), "pose"),
    (lambda: _soft(pose={"elbow": [0.1, 0.2]}), "elbow"),
    (lambda: _elbow(times=(), angles=(), path="hula"), "path"),
    (lambda: _elbow(hold=True), "hold"),
    (lambda: _elbow(following="no"), "following"),
]


@pytest.mark.parametrize(("mistake", "word"), MISTAKES)
def test_one_sentence_for_a_mistake(mistake: Callable[[], Any], word: str) -> None:
    with pytest.raises(SomersaultError) as told:
        mistake()
    assert word in str(told.value)
    assert "\n" not in str(told.value)


def test_the_tape_is_the_nominal_bodys() -> None:
    """Varied masses meet the torques of the body as it is: a tape knows nothing of them."""
    model = so.load(GYMNAST)
    soft = so.compliant(GYMNAST, ELBOW, 20.0, pose=0.0)
    batch = Batch(model, soft, 0.2, bodies=("bodies.torso.mass",))
    symbols = batch.system.symbols
    acting = ca.Function("acting", [symbols.x], [ca.vertcat(*symbols.torques)])
    at, torques = np.array([[0.05]]), []
    for mass in (model.bodies[1].mass, 20.0):
        begun = batch.begun({**batch.values, ("bodies.torso.mass",): mass})
        p = begun.course.parameters(at, begun.rows[:, None])[:, 0]
        assert p[0, symbols.layout.changing] == mass
        torques.append(np.array(acting(np.concatenate([begun.rows, at, p], 1)[0])).ravel())
    light, heavy = torques
    np.testing.assert_array_equal(light, heavy)
    assert np.abs(light).max() > 0.01


# ---------------------------------------------------------------------------- off-nominal starts


def test_an_off_nominal_start_keeps_momentum_and_tape() -> None:
    soft = compliant()
    off = so.off_nominal(GYMNAST, soft, tilt=-0.1, twist=0.07)
    assert off == leant(soft)
    assert off.tape == soft.tape
    assert off.angular_momentum == soft.angular_momentum
    exact = so.off_nominal(GYMNAST, prescribed(), somersault=0.2)
    nominal = so.with_momentum(GYMNAST, prescribed())
    assert exact == replace(nominal, somersault=nominal.somersault + 0.2)


def test_a_first_angle_that_is_varied_has_the_tape_of_the_varied_motion() -> None:
    """On its tape alone a compliant flight is the prescribed one, with the momentum it has."""
    name = next(iter(compliant().joints))
    vary = {"bent": so.Vary(adds_to=f"joints.{name}.angles.1", samples=[0.0, 0.05, 0.2])}
    options = {"size": 3, "report": ["somersault", "tilt", "twist"], "accuracy": 1e-10}
    exact, soft = (
        so.ensemble(GYMNAST, begun, SECONDS, vary, **options).dataset
        for begun in (so.with_momentum(GYMNAST, prescribed()), compliant())
    )
    assert np.ptp(exact["twist"].values) > 1e-3
    for quantity in ("somersault", "tilt", "twist"):
        np.testing.assert_allclose(soft[quantity], exact[quantity], rtol=0, atol=1e-8)


def test_off_nominal_starts_need_angles() -> None:
    turned = Takeoff(quaternion=(1, 0, 0, 0), angular_momentum=(0, 1, 0))
    with pytest.raises(SomersaultError, match="needs angles"):
        so.off_nominal("book", turned, tilt=0.1)
