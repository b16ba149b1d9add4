"""The model `biped` against Table 3.1 and section 3.4, weighed by MuJoCo alone."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from test_shipped_models import SHIPPED

import somersault as so
from somersault.robot import Control, Leg, Plant, Robot
from somersault.robot._plant import Lane

SIDES = ("left", "right")


def at_length(length: float) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """The robot, upright, with both legs of a length, from hip to sole."""
    model = mujoco.MjModel.from_xml_path(str(SHIPPED / "biped.xml"))
    data = mujoco.MjData(model)
    data.qpos[2] = 0.0
    for side in SIDES:
        data.joint(f"{side}_leg").qpos = length - 0.647
    mujoco.mj_forward(model, data)
    return model, data


def inertia(length: float) -> np.ndarray:
    """Of the whole about its centre of mass, by parallel axes."""
    model, data = at_length(length)
    mass = model.body_mass
    com = mass @ data.xipos / mass.sum()
    total = np.zeros((3, 3))
    for k in range(1, model.nbody):
        axes, arm = data.ximat[k].reshape(3, 3), data.xipos[k] - com
        total += axes @ np.diag(model.body_inertia[k]) @ axes.T
        total += mass[k] * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return total


class TestTable31:
    def test_masses(self) -> None:
        model, _ = at_length(0.647)
        assert model.body_mass.sum() == pytest.approx(31.44, abs=1e-9)
        for side in SIDES:
            assert model.body(f"{side}_lower_leg").mass[0] == 0.652

    @pytest.mark.parametrize("length", [0.647, 0.862])
    def test_sole_is_so_far_below_the_hip(self, length: float) -> None:
        model, data = at_length(length)
        for side in SIDES:
            foot = model.geom(f"{side}_foot").id
            sole = data.geom_xpos[foot][2] - model.geom_size[foot][0]
            assert sole == pytest.approx(-length, abs=1e-12)
            assert data.joint(f"{side}_hip_y").xanchor[2] == 0.0

    def test_least_radius_of_the_lower_leg(self) -> None:
        _, data = at_length(0.647)
        for side in SIDES:
            assert data.body(f"{side}_lower_leg").xipos[2] == pytest.approx(-0.404, abs=1e-12)

    def test_somersault_inertia(self) -> None:
        """1.22 and 1.50 are printed; 1.02 + 2 · 0.652 r² of the same table is 1.233 and 1.520."""
        retracted, extended = inertia(0.647)[1, 1], inertia(0.862)[1, 1]
        assert retracted == pytest.approx(1.02 + 2 * 0.652 * 0.404**2, abs=2e-3)
        assert extended == pytest.approx(1.02 + 2 * 0.652 * 0.619**2, abs=2e-3)
        assert retracted == pytest.approx(1.22, abs=0.02)
        assert extended == pytest.approx(1.50, abs=0.025)
        assert retracted / extended == pytest.approx(0.81, abs=0.005)

    @pytest.mark.parametrize("length", [0.647, 0.75, 0.862])
    def test_somersault_axis_is_the_major_one(self, length: float) -> None:
        total = inertia(length)
        np.testing.assert_allclose(total - np.diag(np.diag(total)), 0, atol=1e-12)
        roll, pitch, yaw = np.diag(total)
        assert pitch > roll > yaw

    @pytest.mark.parametrize("length", [0.647, 0.862])
    def test_hips_are_at_the_centre_of_mass(self, length: float) -> None:
        model, data = at_length(length)
        com = model.body_mass @ data.xipos / model.body_mass.sum()
        np.testing.assert_allclose(com, 0, atol=5e-3)


class TestSection34:
    def test_hip_limits(self) -> None:
        model, _ = at_length(0.7)
        for side in SIDES:
            for axis, most in (("x", 20), ("y", 60), ("z", 15)):
                limits = np.degrees(model.joint(f"{side}_hip_{axis}").range)
                np.testing.assert_allclose(limits, [-most, most])

    @pytest.mark.parametrize("pulled", [-0.02, 0.02])
    def test_the_spring_pushes_and_cannot_pull(self, pulled: float) -> None:
        """A leg 2 cm too long is held by the stop alone, one too short by the spring."""
        model, data = at_length(0.75 + pulled)
        data.ctrl[:] = 0.75 - 0.647
        mujoco.mj_forward(model, data)
        for side in SIDES:
            spring = data.actuator(f"{side}_spring").force[0]
            stop = data.actuator(f"{side}_stop").force[0]
            if pulled > 0:
                assert spring == 0
                assert stop < 0
            else:
                assert spring == pytest.approx(15_000 * 0.02)
                assert stop == 0

    def test_what_may_touch_what(self) -> None:
        """Torso and lower legs touch the ground, the lower legs one another, the torso no leg."""
        model, _ = at_length(0.7)

        def touch(one: str, other: str) -> bool:
            a, b = model.geom(one), model.geom(other)
            return bool(a.contype & b.conaffinity) or bool(b.contype & a.conaffinity)

        for name in ("frame", "rail", "left_foot", "right_foot", "left_rod", "right_rod"):
            assert touch(name, "floor")
        assert touch("left_foot", "right_foot")
        assert touch("left_rod", "right_rod")
        assert not touch("frame", "left_rod")


@pytest.mark.parametrize("name", ["biped", "biped_weighted"])
def test_pictures_tell_front_from_back_and_left_from_right(name: str) -> None:
    """By colour alone: what marks the front touches nothing and has no mass."""
    model = mujoco.MjModel.from_xml_path(str(SHIPPED / f"{name}.xml"))
    for part in ("cylinder", "rod", "foot"):
        left, right = (model.geom(f"{side}_{part}") for side in SIDES)
        assert np.abs(left.rgba - right.rgba).max() > 0.2
    front, frame = model.geom("front"), model.geom("frame")
    assert np.abs(front.rgba - frame.rgba).max() > 0.4
    assert front.pos[0] + front.size[0] > frame.size[0]
    assert np.all(front.size[1:] > frame.size[1:])
    assert front.contype == front.conaffinity == 0


def test_the_package_reads_the_same_robot() -> None:
    """Composite inertia of our own equations, at both ends of the legs."""
    model = so.load("biped")
    for length in (0.647, 0.862):
        joints = np.zeros(len(model.coordinates))
        joints[[3, 7]] = length - 0.647
        np.testing.assert_allclose(so.Equations(model).inertia(joints), inertia(length), atol=1e-9)


class TestMachine:
    def test_weighs_what_the_tuck_servo_needs(self) -> None:
        machine = Robot().machine
        assert machine.mass == pytest.approx(31.44)
        assert machine.inertia == pytest.approx(1.02, abs=2e-3)
        assert machine.lower_leg == pytest.approx(2 * 0.652)
        assert machine.offset == pytest.approx(0.647 - 0.404)
        np.testing.assert_allclose(machine.resting, 0.647)
        np.testing.assert_allclose(machine.hips, [[0, 0.06, 0], [0, -0.06, 0]])

    @pytest.mark.parametrize("length", [0.647, 0.75, 0.862])
    def test_inertia_of_the_legs_is_that_of_their_swing(self, length: float) -> None:
        """Against parallel axes by hand: what of the robot swings with both legs about the hips."""
        machine = Robot().machine
        by_hand = 2 * (0.008 + 1.0 * 0.12**2 + 0.010 + 0.652 * (length - 0.243) ** 2)
        found = machine.leg_inertia + machine.lower_leg * (length - machine.offset) ** 2
        assert found == pytest.approx(by_hand, rel=1e-9)

    def test_other_proportions_are_those_of_another_file(self, tmp_path: Path) -> None:
        """Of one that has them, compiled by MuJoCo: masses of subtrees, by which the centre of mass
        is sensed, and weights in contacts among the rest."""
        text = (SHIPPED / "biped.xml").read_text(encoding="utf-8")
        for old, new in (
            ('pos="0 0.06 0"', 'pos="0 0.075 0"'), ('pos="0 -0.06 0"', 'pos="0 -0.075 0"'),
            ('pos="0 0 -0.622" size="0.025"', 'pos="0 0 -0.607" size="0.04"'),
            ('mass="1" diaginertia="0.008 0.008 0.001"',
             'mass="1.5" diaginertia="0.012 0.012 0.0015"'),
        ):  # fmt: skip
            assert old in text
            text = text.replace(old, new)
        (tmp_path / "other.xml").write_text(text, encoding="utf-8")
        other = Robot(str(tmp_path / "other.xml")).machine.mujoco
        lane = Lane(Robot())
        plant = Plant(hip_spacing=1.25, foot_radius=1.6, upper_leg_mass=1.5)
        lane.begin(np.array(list(Control(plant=plant).numbers().values())))
        names = [
            name
            for name in dir(other)
            if name.startswith(("body_", "geom_", "jnt_", "dof_", "site_", "actuator_"))
            and isinstance(getattr(other, name), np.ndarray)
            and not name.endswith("sameframe")  # how it is stored
        ]
        assert {"body_subtreemass", "dof_invweight0", "geom_rbound"} <= set(names)
        for name in names:
            np.testing.assert_allclose(
                getattr(lane.model, name), getattr(other, name), rtol=1e-9, atol=1e-12, err_msg=name
            )

    def test_greater_feet_that_touch_are_found(self) -> None:
        """Where those of the file would be clear of each other."""
        lane = Lane(Robot())
        for radius, touch in ((1.0, False), (2.5, True)):
            lane.begin(np.array(list(Control(plant=Plant(foot_radius=radius)).numbers().values())))
            data = mujoco.MjData(lane.model)
            data.qpos[2] = 2.0
            mujoco.mj_forward(lane.model, data)
            assert (data.ncon > 0) == touch


BAD = {
    "no foot": ('name="left_foot"', 'name="left_toe"', "left leg has no foot"),
    "no spring": (
        '<position name="left_spring" class="spring" joint="left_leg"/>',
        '<motor name="left_spring" joint="left_leg"/>',
        "left_spring is no spring",
    ),
    "no slide": ('name="right_leg" class="leg"', 'name="right_knee" class="leg"', "right_leg"),
    "no motor": ('<motor name="left_hip_z" joint="left_hip_z" ctrlrange="-40 40"/>', "", "motor"),
    "short slide": ('range="-0.15 0.225"', 'range="-0.15 0.1"', "reaches from"),
    "no free joint": ("<freejoint/>", "", "free joint"),
    "other axes": ('axis="1 0 0" range="-20 20"', 'axis="0 0 1" range="-20 20"', "must be along"),
    "no text": ("<mujoco", "<mujocco", "cannot be read"),
    "no push": ('kp="60000"', 'kp="-60000"', "left_stop is no stop"),
    "other leg": (
        '<position name="left_spring" class="spring" joint="left_leg"/>',
        '<position name="left_spring" class="spring" joint="right_leg"/>',
        "left_spring must act on joint left_leg",
    ),
    "spring that pulls": (' forcerange="0 20000"', "", "left_spring .* cannot pull"),
    "stop that pushes": (
        'forcerange="-20000 0"',
        'forcerange="-20000 5"',
        "left_stop .* cannot push",
    ),
    "springs unlike": (
        '<position name="right_spring" class="spring" joint="right_leg"/>',
        '<position name="right_spring" class="spring" joint="right_leg" kp="9000"/>',
        "left_spring and right_spring must be alike",
    ),
    "no floor": (
        '<geom name="floor" type="plane" size="0 0 1" contype="1" conaffinity="0" '
        'rgba="0.8 0.8 0.8 1"/>',
        "",
        "touches no floor",
    ),
    "no contact": (
        'contype="2" conaffinity="3"',
        'contype="2" conaffinity="2"',
        "touches no floor",
    ),
    "sloping floor": (
        'size="0 0 1" contype="1"',
        'size="0 0 1" euler="0 5 0" contype="1"',
        "level",
    ),
    "low floor": ('size="0 0 1" contype="1"', 'size="0 0 1" pos="0 0 -1" contype="1"', "level"),
    "gear": ('ctrlrange="-150 150"', 'ctrlrange="-150 150" gear="2"', "without gear"),
    "one way": ('ctrlrange="-150 150"', 'ctrlrange="0 150"', "as strong either way"),
    "weaker": ('ctrlrange="-150 150"', 'ctrlrange="-150 150" forcerange="-20 20"', "weaker than"),
    "two motors": (
        '<motor name="left_hip_y"',
        '<motor name="more" joint="left_hip_y" ctrlrange="-9 9"/><motor name="left_hip_y"',
        "has 2 motors",
    ),
    "weightless": ("<option ", '<option gravity="0 0 0" ', "gravity must be 0 0 -9.81"),
    "moon": ("<option ", '<option gravity="0 0 -1.62" ', "gravity must be 0 0 -9.81"),
    "step": ('timestep="0.0005"', 'timestep="0.0007"', "timestep"),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_robots_are_refused_in_a_sentence(what: str, tmp_path: Path) -> None:
    old, new, says = BAD[what]
    text = (SHIPPED / "biped.xml").read_text(encoding="utf-8")
    assert old in text
    file = tmp_path / "robot.xml"
    file.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(so.SomersaultError, match=says) as refused:
        _ = Robot(str(file)).machine
    assert "\n" not in str(refused.value)
    assert "robot.xml" in str(refused.value)


def test_files_that_are_no_mjcf(tmp_path: Path) -> None:
    for ending in (".bioMod", ".urdf", ".osim"):
        with pytest.raises(so.SomersaultError, match=rf"^who\{ending} is no robot that runs.*MJCF"):
            Robot(str(tmp_path / f"who{ending}"))


def test_legs_that_are_none() -> None:
    left, right = Leg.called("left"), Leg.called("right")
    with pytest.raises(so.SomersaultError, match="cannot both have 'left_foot'"):
        Robot("biped", left, replace(right, foot="left_foot"))
    with pytest.raises(so.SomersaultError, match="cannot both have"):
        Robot("biped", left, left)
    with pytest.raises(so.SomersaultError, match="cannot have 'left_stop' twice"):
        replace(left, spring="left_stop")
    swapped = replace(left, spring="left_stop", stop="left_spring")
    with pytest.raises(so.SomersaultError, match=r"left_stop .* cannot pull"):
        _ = Robot("biped", swapped, right).machine
    crossed = [replace(one, hip=other.hip) for one, other in ((left, right), (right, left))]
    with pytest.raises(so.SomersaultError, match="left_leg does not hang on right_hip_z"):
        _ = Robot("biped", *crossed).machine


def test_lengths_that_no_leg_has() -> None:
    with pytest.raises(so.SomersaultError, match="shortest to longest"):
        Robot(shortest=0.9, longest=0.8)
    with pytest.raises(so.SomersaultError, match="bipet"):
        _ = Robot("bipet").machine
