"""Ready maneuvers against inertias, quadratures, exact rigid motion and SciPy.

The mean athlete is not quite alike in front and behind (his feet are before his ankles);
`flat` is, so that what symmetry promises can be asked for exactly.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from shares import every

import somersault as so
from somersault.attitude import matrix_from_quaternion, quaternion_product
from somersault.dynamics import Equations
from somersault.flight import (
    Maneuver,
    arm_tilt,
    cat_turn,
    fly,
    hula,
    inertia_change,
    rigid_continuation,
    torque_twist,
    twist_time,
)
from somersault.rigid import RigidMotion
from somersault.thesis.ch1 import _techniques as techniques
from somersault.thesis.ch6 import _torque_twist as of_torque_twist

SHARP = 1e-12


def flat():
    """The gymnast without front and back: every part on its own axis, and round about it."""
    model = so.load("gymnast")
    bodies = []
    for body in model.bodies:
        (a, _, _), (_, b, _), (_, _, c) = body.inertia
        mean = (a + b) / 2
        bodies.append(replace(
            body, com=(0.0, 0.0, body.com[2]), position=(0.0, *body.position[1:]),
            inertia=((mean, 0.0, 0.0), (0.0, mean, 0.0), (0.0, 0.0, c)),
        ))  # fmt: skip
    return replace(model, name="flat", bodies=tuple(bodies))


def inertia(maneuver, poses=(0, -1)):
    flown = maneuver.fly(accuracy=SHARP)
    q = flown.dataset["joint_angle"].values[list(poses)]
    return flown, Equations(maneuver.model).inertia(q)


# ---------------------------------------------------------------------------- inertia change


@pytest.mark.parametrize("poses", [("layout", "tuck"), ("tuck", "layout"), ("T", "pike")])
def test_somersault_rate_goes_as_one_over_the_inertia(poses):
    flown, whole = inertia(inertia_change(poses=poses))
    omega = flown.angular_velocity[[0, -1]]
    assert omega[1, 1] / omega[0, 1] == pytest.approx(whole[0, 1, 1] / whole[1, 1, 1], rel=1e-10)
    assert np.abs(omega[:, [0, 2]]).max() < 1e-10
    assert flown.momentum_drift < 1e-12


def test_twist_rate_goes_as_one_over_the_inertia():
    made = inertia_change(flat(), axis=3, poses=("T", "layout"))
    flown, whole = inertia(made)
    omega = flown.angular_velocity[[0, -1], 2]
    assert omega[1] / omega[0] == pytest.approx(whole[0, 2, 2] / whole[1, 2, 2], rel=1e-10)
    assert omega[1] > 2 * omega[0]


def test_no_moment_from_outside_is_needed():
    assert np.abs(hula().fly(accuracy=SHARP).external_moment).max() < 1e-9


# ---------------------------------------------------------------------------------- cat turn


def test_cat_turns_without_momentum_and_with_all_joints_back():
    flown = cat_turn().fly(accuracy=SHARP)
    assert np.abs(flown.angular_momentum).max() < 1e-12
    joints = flown.dataset["joint_angle"].values
    assert np.array_equal(joints[0], joints[-1])
    assert flown.landing.twist > np.pi
    assert abs(flown.landing.tilt) + abs(flown.landing.somersault) < 1e-3


def limb(model, angle, *names):
    """Inertia about the long axis of a straight limb held out to the side by an angle."""
    parts = [next(body for body in model.bodies if body.name == name) for name in names]
    side, total, joint = abs(parts[0].position[1]), 0.0, 0.0
    for place, part in enumerate(parts):
        joint -= part.position[2] if place else 0.0
        across, _, own = np.diag(part.inertia)
        away = side + (joint - part.com[2]) * np.sin(angle)
        total += own * np.cos(angle) ** 2 + across * np.sin(angle) ** 2 + part.mass * away**2
    return total


def test_cat_turn_is_that_of_two_bodies_on_one_axis():
    """Without front and back nothing but the long axis is left, and all is in closed form."""
    model = flat()

    def lower(abduction):
        return model.bodies[0].inertia[2][2] + 2 * limb(model, abduction, "left_leg")

    def upper(abduction):
        arm = limb(model, abduction, "left_upper_arm", "left_forearm")
        return model.bodies[1].inertia[2][2] + 2 * arm

    apart = upper(0.12) / (upper(0.12) + lower(np.pi / 4))
    out = upper(np.pi / 2) / (upper(np.pi / 2) + lower(0.0))
    # Legs apart the torso twists by π/4 twice, arms out by −π/2; the hips turn the other way.
    turned = np.pi / 2 * (out - apart)
    landing = cat_turn(model, cycles=1).fly(accuracy=SHARP).landing
    assert landing.twist == pytest.approx(turned, abs=1e-9)
    assert abs(landing.tilt) + abs(landing.somersault) < 1e-10


@pytest.mark.parametrize("legs", every([{"hip_abduction": 0.7}, {"hip_flexion": 1.5}], 2))
def test_cat_turn_against_scipy(legs):
    """Attitude from ω = −A⁻¹ B q̇, integrated by SciPy, piked and tumbling a little too."""
    made = cat_turn(cycles=1, legs=legs)
    equations = Equations(made.model)
    names = made.motion.joints
    places = [made.model.coordinates.index(name) for name in names]

    def change(time, quaternion):
        angles, rates, _ = made.motion.values([time])
        q, v = np.zeros(13), np.zeros(19)
        q[places], v[6 + np.array(places)] = angles[0], rates[0]
        omega = -np.linalg.solve(equations.inertia(q), equations.momentum(q, v)[:3])
        return 0.5 * quaternion_product(quaternion, np.append(0.0, omega))

    state = np.array([1.0, 0, 0, 0])
    for k in range(7):
        ends = (0.15 * k, 0.15 * (k + 1))
        state = solve_ivp(change, ends, state, "DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
    found = made.fly(accuracy=SHARP).landing.quaternion
    assert matrix_from_quaternion(found) == pytest.approx(matrix_from_quaternion(state), abs=1e-8)


@pytest.mark.parametrize("legs", [None, {"hip_flexion": 1.5}])
@pytest.mark.parametrize("factor", [2.0, 0.5, 0.1])
def test_cat_turn_does_not_depend_on_speed(legs, factor):
    made = cat_turn(cycles=1, legs=legs)
    other = made.scaled(factor).fly(accuracy=SHARP)
    assert techniques.apart(made.fly(accuracy=SHARP), other) < 1e-9


def test_cat_turn_backwards_turns_back():
    made = cat_turn(legs={"hip_flexion": 1.5})
    end = made.fly(accuracy=SHARP).landing.quaternion
    start = so.Takeoff(quaternion=end.tolist(), angular_momentum=(0, 0, 0))
    back = made.reversed().from_takeoff(start).fly(accuracy=SHARP).landing.quaternion
    assert abs(back[0]) == pytest.approx(1, abs=1e-12)
    assert np.abs(back[1:]).max() < 1e-9


def test_cat_turns_the_other_way():
    left, right = (cat_turn(cycles=1, torso=x).fly(accuracy=SHARP).landing for x in (0.6, -0.6))
    assert left.twist == pytest.approx(-right.twist, abs=1e-10)


# ------------------------------------------------------------------------- tilt, rotation number


@pytest.mark.parametrize("pose", ["layout", "T", "wrap"])
@pytest.mark.parametrize("tilt", [0.02, -0.1, 0.5])
def test_rotation_number_of_a_tilted_athlete(pose, tilt):
    made = techniques.tilted(tilt, pose)
    exact = rigid_continuation(made.fly(accuracy=SHARP, samples=[0.0]))
    number, rate = techniques.rotation_number(made)
    assert number == pytest.approx(exact.twists_per_somersault_quadrature(), rel=1e-8)
    assert number == pytest.approx(exact.twists_per_somersault, rel=1e-8)
    assert rate == pytest.approx(exact.mean_rates[1], rel=1e-8)


def test_between_the_moves_it_is_a_rigid_body():
    on = arm_tilt(twists=None, duration=0.3)
    exact = rigid_continuation(on.fly(accuracy=SHARP))
    number, rate = techniques.rotation_number(on, 0.3)
    assert number == pytest.approx(exact.twists_per_somersault, rel=1e-8)
    assert rate == pytest.approx(exact.mean_rates[1], rel=1e-8)


@pytest.mark.parametrize("twists", [1, 2])
def test_two_moves_undo_each_other_without_front_and_back(twists):
    made = arm_tilt(flat(), twists=twists)
    flown = replace(made, duration=made.motion.end).fly(accuracy=SHARP)
    assert flown.landing.twist == pytest.approx(2 * np.pi * twists, abs=1e-8)
    assert abs(flown.landing.tilt) < 1e-8
    assert np.abs(flown.dataset["tilt"]).max() > 0.1


def test_what_is_left_oscillates_in_a_pike():
    made = arm_tilt()
    end = made.motion.end
    moves = dict(made.keyframes)
    for joint in ("left_hip_flexion", "right_hip_flexion"):
        moves[joint] = [(end, 0.0), (end + 0.25, 1.8)]
    piked = so.Maneuver.moves(made.model, moves, made.takeoff, end + 10)
    flown = piked.fly(accuracy=1e-10)
    over = flown.times > end
    assert np.ptp(flown.dataset["somersault"].values[over]) > 10 * 2 * np.pi
    assert np.abs(flown.dataset["twist"].values[over] - 2 * np.pi).max() < 0.05
    assert np.abs(flown.dataset["tilt"].values[over]).max() < 0.05


def test_twist_time_is_when():
    made = torque_twist()
    time = twist_time(made, 0.75)
    landed = replace(made, duration=time).fly(accuracy=SHARP).landing
    assert landed.twist == pytest.approx(1.5 * np.pi, abs=1e-9)


# ------------------------------------------------------------------------------ torque twist, hula


def test_torque_twist_turns_as_asked_and_does_not_stop():
    flown = torque_twist(spin=6.0, twist_rate=-4.0).fly(accuracy=SHARP)
    assert flown.angular_velocity[0] == pytest.approx([0, 6, -4], abs=1e-3)
    h = flown.angular_momentum
    assert np.abs(h[:, [0, 2]]).max() < 1e-10 * h[0, 1]
    assert np.all(np.diff(flown.dataset["twist"]) < 0)


def test_only_a_tilt_ends_a_torque_twist():
    made, moment, lean = of_torque_twist.stopped_torque_twist()
    flown = replace(made, duration=3.5).fly(accuracy=SHARP)
    over = flown.times > moment + 0.2
    assert np.ptp(flown.dataset["twist"].values[over]) < 0.01
    assert 0.3 < lean < 1.5


def test_hula_mirrors():
    left, right = (hula(side=x).fly(accuracy=SHARP).landing for x in (0.4, -0.4))
    assert [left.somersault, left.tilt, left.twist] == pytest.approx(
        [right.somersault, -right.tilt, -right.twist], abs=1e-8
    )
    assert abs(left.twist) > 3


def test_hula_without_a_side_does_not_twist():
    landing = hula(side=0.0).fly(accuracy=SHARP).landing
    assert abs(landing.twist) + abs(landing.tilt) < 1e-9


def test_a_rudi_turns_once_and_twists_one_and_a_half_times_within_an_athletes_torques():
    flown = so.rudi().fly(samples=801)
    end = flown.landing
    assert [end.somersault, end.tilt, end.twist] == pytest.approx(
        [2 * np.pi, 0, -3 * np.pi], abs=0.03
    )
    out = so.named_pose("gymnast", "T")
    assert end.joints == pytest.approx({n: out[n.split("_", 1)[1]] if n != "torso_twist" else 0.0
                                        for n in end.joints}, abs=1e-9)  # fmt: skip
    most = abs(flown.joint_torques).max("time")
    bounds = {"hip": 250.0, "shoulder": 150.0, "torso": 150.0, "elbow": 70.0}
    for name in most["joint_speed"].values:
        assert most.sel(joint_speed=name) <= bounds[next(g for g in bounds if g in name)]


def test_the_moves_of_a_rudi_are_when_its_numbers_say():
    made = so.rudi(
        pike=2.2, swing=0.02, swing_time=0.2, extend=0.01, extend_time=0.3, stay=0.1, early=-0.03
    )
    legs, left, right = (
        made.keyframes[n] for n in ("left_hip_flexion", "left_elbow", "right_elbow")
    )
    assert np.array(legs[:2]) == pytest.approx(np.array([(0.03, 2.2), (0.33, 0.0)]))
    assert right[0][0] - left[0][0] == pytest.approx(0.03)
    assert left[2][0] - right[1][0] == pytest.approx(0.1)
    apart = made.keyframes["left_hip_abduction"], made.keyframes["right_hip_abduction"]
    assert [a for _, a in apart[0]] == [-a for _, a in apart[1]]


def test_a_rudi_mirrors():
    names = ("side", "torso", "early", "late", "back_side")
    numbers = {"side": 0.23, "torso": -0.5, "early": -0.02, "late": 0.09, "back_side": -0.4}
    right, left = (
        so.rudi(**{n: sign * numbers[n] for n in names}).fly(accuracy=SHARP).landing
        for sign in (1, -1)
    )
    assert [left.somersault, left.tilt, left.twist] == pytest.approx(
        [right.somersault, -right.tilt, -right.twist], abs=1e-7
    )


def test_mean_tilt_of_a_nearly_symmetric_body_is_its_tilt():
    c = np.array([0.0, np.cos(0.2), -np.sin(0.2)])
    motion = RigidMotion([10, 10 - 1e-6, 1], 50 * c / [10, 10, 1])
    assert motion.mean_tilt == pytest.approx(0.2, abs=1e-5)


# ------------------------------------------------------------------------------------- mistakes


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: inertia_change(axis=1), "2 for a somersault"),
        (lambda: inertia_change(poses=("layout", "swan")), "no pose is called"),
        (lambda: inertia_change(move=0.0), "positive"),
        (lambda: cat_turn(cycles=0), "whole number"),
        (lambda: cat_turn(torso=1.5).takeoff, "limits"),
        (lambda: cat_turn(legs={"tail": 1.0}), "tail"),
        (lambda: arm_tilt(twists=1.5), "whole number"),
        (lambda: arm_tilt(raised=np.pi / 2, lowered=np.pi / 2), "does not twist"),
        (lambda: hula(hold=-0.1), "hold"),
        (lambda: hula(side=0.7).takeoff, "limits"),
        (lambda: hula("furrer"), "takes no named pose"),
        (lambda: hula(so.athlete(1.7, 65, shoulders="ball")), "hinges"),
        (lambda: so.rudi(stay=0.0), "stay 0 s .* positive"),
        (lambda: so.rudi("furrer"), "takes no named pose"),
        (lambda: so.rudi(side=0.7), "limits"),
        (lambda: cat_turn().scaled(-1), "factor"),
    ],
)
def test_mistakes_get_a_sentence(make, words):
    with pytest.raises(so.SomersaultError, match=words) as told:
        make()
    assert "\n" not in str(told.value)


def test_a_maneuver_is_a_takeoff_and_a_duration():
    made = hula()
    assert isinstance(made, Maneuver)
    flown = fly("gymnast", made.takeoff, made.duration)
    assert flown.landing.twist == made.fly().landing.twist


def test_other_athletes_fly_them():
    for model in (so.athlete(1.55, 48, sex="female"), so.athlete(1.8, 75, knees=True)):
        assert abs(arm_tilt(model).fly().landing.twist - 2 * np.pi) < 0.3
        assert abs(hula(model).fly().landing.twist) > 3
        assert cat_turn(model).fly().landing.twist > 2.5
