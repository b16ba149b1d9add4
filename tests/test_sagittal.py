"""Bodies seen from the side, and bodies held by another one than their base."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import somersault as so
from somersault import SomersaultError
from somersault.model import GROUND, Body, Joint, Mount, body_frames, centre_of_mass

POSE = {"shoulder_flexion": 2.4, "hip_flexion": 1.1, "knee": 0.7}
NONE = (0.0, 0.0, 0.0)
BAR = Body(
    "clamp", GROUND, 0.0, NONE, (NONE, NONE, NONE), joints=(Joint("bar", "hinge", (0.0, 1.0, 0.0)),)
)


@pytest.fixture(scope="module")
def athlete() -> so.Model:
    return so.athlete(1.67, 64, knees=True, ankles=True)


@pytest.fixture(scope="module")
def flat(athlete: so.Model) -> so.Model:
    return so.sagittal(athlete, POSE)


def test_what_turns_in_the_plane_is_kept(flat: so.Model) -> None:
    assert [joint.name for joint in flat.joints] == [
        "shoulder_flexion", "hip_flexion", "knee", "ankle",
    ]  # fmt: skip
    assert [body.name for body in flat.bodies] == ["pelvis", "upper_arm", "thigh", "shank", "foot"]
    assert flat.plane == 2
    assert flat.home == pytest.approx([2.4, 1.1, 0.7, 0.0])


def test_it_moves_as_the_whole_body_moving_alike_on_both_sides(
    athlete: so.Model, flat: so.Model
) -> None:
    """Energy, momentum and centre of mass of random motions in the plane."""
    rng = np.random.default_rng(3)
    whole, seen = so.Equations(athlete), so.Equations(flat)
    for _ in range(5):
        angles = {joint.name: rng.uniform(*joint.limits) for joint in flat.joints if joint.limits}
        rates = {name: rng.normal() for name in angles}
        base = np.array([0.0, rng.normal(), 0.0, rng.normal(), 0.0, rng.normal()])
        states = []
        for model in (athlete, flat):
            q = so.model.pose(model, POSE | angles if model is athlete else angles)
            u = np.zeros(len(model.speeds))
            for name, rate in so.model.spread(model, rates, mirrored=True).items():
                u[model.speed_slice(name)] = rate
            states.append((q, np.concatenate([base, u])))
        (q, u), (q_seen, u_seen) = states
        assert seen.kinetic_energy(q_seen, u_seen) == pytest.approx(
            whole.kinetic_energy(q, u), rel=1e-12
        )
        assert seen.momentum(q_seen, u_seen) == pytest.approx(whole.momentum(q, u), abs=1e-11)
        assert centre_of_mass(flat, q_seen) == pytest.approx(centre_of_mass(athlete, q), abs=1e-14)


def test_springs_and_dampers_of_both_sides_add_up() -> None:
    flat = so.sagittal(so.load(_two_legs(stiffness="3", damping="0.5")))
    joint = flat.joint("hip")
    assert (joint.stiffness, joint.damping) == (6.0, 1.0)
    assert so.Equations(flat).spring_energy([0.2]) == pytest.approx(2 * 0.5 * 3 * 0.2**2)


def test_sides_that_do_not_turn_about_one_line_are_refused(athlete: so.Model) -> None:
    with pytest.raises(SomersaultError, match="left_knee and right_knee"):
        so.sagittal(athlete, {"left_hip_flexion": 0.5})


def test_unlike_sides_are_refused() -> None:
    with pytest.raises(SomersaultError, match="not alike on both sides"):
        so.sagittal(so.athlete(1.67, 64), {"left_hip_flexion": 0.5})
    legs = so.load(_two_legs())
    trunk, left, right = legs.bodies
    heavier = replace(legs, bodies=(trunk, left, replace(right, mass=2 * right.mass)))
    with pytest.raises(SomersaultError, match="not alike on both sides"):
        so.sagittal(heavier)


def test_what_turns_about_no_axis_across_the_plane_is_held(athlete: so.Model) -> None:
    flat = so.sagittal(athlete, {"shoulder_abduction": 0.4})
    assert [joint.name for joint in flat.joints] == ["hip_flexion", "knee", "ankle"]
    assert flat.mass == pytest.approx(athlete.mass)


def test_a_fixed_base_and_many_poses_are_refused() -> None:
    with pytest.raises(SomersaultError, match="fixed base"):
        so.sagittal(so.load("gymnast", base="fixed"))
    with pytest.raises(SomersaultError, match="one number each"):
        so.sagittal(so.load("gymnast"), {"hip_flexion": [0.1, 0.2]})


def _two_legs(**given: str) -> object:
    import tempfile
    from pathlib import Path

    more = " ".join(f'{name}="{value}"' for name, value in given.items())
    legs = "".join(
        f'<body name="{side}_leg" pos="0 {y} -0.1"><joint name="{side}_hip" axis="0 1 0" {more}/>'
        '<geom type="capsule" size="0.05" fromto="0 0 0 0 0 -0.4"/></body>'
        for side, y in (("left", 0.1), ("right", -0.1))
    )
    path = Path(tempfile.mkdtemp()) / "legs.xml"
    path.write_text(
        '<mujoco><compiler angle="radian"/>'
        '<default><geom contype="0" conaffinity="0"/></default>'
        '<worldbody><body name="trunk"><freejoint/>'
        f'<geom type="box" size="0.1 0.2 0.3"/>{legs}</body></worldbody></mujoco>'
    )
    return path


# ------------------------------------------------------------ held by another body than the base


@pytest.fixture(scope="module")
def mount(flat: so.Model) -> Mount:
    return so.mounted(flat, BAR, (0.0, 0.0, 0.7), body="upper_arm")


def test_what_is_held_is_the_same_body(flat: so.Model, mount: Mount) -> None:
    """Same joints and angles: seen from the base all bodies are where they were."""
    rng = np.random.default_rng(5)
    names = [joint.name for joint in flat.joints]
    angles = {name: rng.uniform(*flat.joint(name).limits) for name in names}  # type: ignore[misc]
    q = so.model.pose(flat, angles)
    held = so.model.pose(mount.held, angles | {"bar": 0.4})
    turns, places = body_frames(mount.held, held)
    base_turn, base = turns[mount.place], places[mount.place]
    index = {body.name: number for number, body in enumerate(mount.held.bodies)}
    for number, body in enumerate(flat.bodies):
        if body.name == "upper_arm":
            continue
        turn, place = (x[number] for x in body_frames(flat, q))
        there = index[body.name]
        assert base_turn @ turn == pytest.approx(turns[there], abs=1e-14)
        assert base + base_turn @ place == pytest.approx(places[there], abs=1e-14)
    assert mount.held.mass == pytest.approx(flat.mass)


def test_letting_go_keeps_energy_and_momentum(flat: so.Model, mount: Mount) -> None:
    swung = so.swing(
        mount.held, {"bar": 2.5, "hip_flexion": 0.5}, 0.4, rates={"bar": -1.0, "knee": 1.0},
        samples=41, accuracy=1e-12,
    )  # fmt: skip
    assert np.ptp(swung.dataset["energy"].values) < 1e-8
    let_go = so.released(swung, mount)
    first = so.fly(flat, let_go.takeoff, 0.01, samples=2).dataset.isel(time=0)
    held, free = so.Equations(mount.held), so.Equations(flat)
    velocity = np.array(let_go.takeoff.velocity)
    q = first["joint_angle"].values
    u = np.concatenate([first["angular_velocity"].values, NONE, first["joint_rate"].values])
    u[3:6] = -free.momentum(q, u)[3:] / flat.mass  # the centre of mass at rest
    energy = free.kinetic_energy(q, u)
    whole = held.kinetic_energy(swung.q[-1], swung.u[-1])
    assert energy + 0.5 * flat.mass * velocity @ velocity == pytest.approx(whole, rel=1e-12)
    height = -centre_of_mass(mount.held, swung.q[-1])
    assert -let_go.centre == pytest.approx(height, abs=1e-12)


def test_a_ball_between_the_two_is_refused() -> None:
    with pytest.raises(SomersaultError, match="is a ball"):
        so.mounted(so.athlete(1.67, 64, shoulders="ball"), BAR, body="left_upper_arm")


def test_a_body_that_is_not_there_is_refused(flat: so.Model) -> None:
    with pytest.raises(SomersaultError, match="has no body 'hand'"):
        so.mounted(flat, BAR, body="hand")


# --------------------------------------------------------------------------------- ankles


def test_a_foot_on_a_hinge_changes_no_mass() -> None:
    plain, jointed = (so.athlete(1.67, 64, knees=True, ankles=x) for x in (False, True))
    assert jointed.mass == pytest.approx(plain.mass)
    whole, parts = (so.Equations(m).mass_matrix(m.home)[:6, :6] for m in (plain, jointed))
    assert parts == pytest.approx(whole, abs=1e-12)
    straight = so.athlete(1.67, 64, ankles=True)
    assert [body.name for body in straight.bodies][-2:] == ["right_leg", "right_foot"]


def test_toes_go_up() -> None:
    model = so.athlete(1.67, 64, knees=True, ankles=True)
    foot = [body.name for body in model.bodies].index("left_foot")
    turns, _ = body_frames(model, so.model.pose(model, {"ankle": np.pi / 2}))
    ahead = turns[foot] @ np.array(model.bodies[foot].com)
    assert ahead[0] > 0.04
    assert abs(ahead[2]) < 0.01
