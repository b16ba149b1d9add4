"""The models that ship, read by MuJoCo alone and weighed by hand.

Nothing here imports somersault: these are the numbers everything else stands on.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np
import pytest
from programs import program

ROOT = Path(__file__).parents[1]
SHIPPED = ROOT / "src" / "somersault" / "model" / "shipped"
JOINTS = {
    "furrer": ("left_shoulder", "right_shoulder"),
    "doll": ("left_shoulder", "right_shoulder"),
    "doll_weighted": ("left_shoulder", "right_shoulder"),
    "simplest": ("arm",),
    "human_layout": (),
    "human_pike": (),
    "human_tuck": (),
    "book": (),
    **dict.fromkeys(
        ("biped", "biped_weighted"),
        tuple(
            f"{side}_{joint}"
            for side in ("left", "right")
            for joint in ("hip_y", "hip_x", "hip_z", "leg")
        ),
    ),
    "gymnast": (
        "torso_twist",
        *(
            f"{side}_{joint}"
            for side in ("left", "right")
            for joint in ("shoulder_abduction", "shoulder_rotation", "shoulder_flexion", "elbow")
        ),
        *(f"{side}_hip_{way}" for side in ("left", "right") for way in ("flexion", "abduction")),
    ),
}
MASSES = {
    "furrer": 58.3 + 2 * 3.743,
    "doll": 0.466 + 2 * 0.0275,
    "doll_weighted": 0.466 + 2 * 0.0575,
    "simplest": 58.3 + 2 * 3.743,
    "human_layout": 73.0,
    "human_pike": 73.0,
    "human_tuck": 73.0,
    "book": 1.0,
    "biped": 31.44,
    "biped_weighted": 31.44 + 4.0,
    "gymnast": 64.0,
}
ROBOTS = ("biped", "biped_weighted")  # which run on the ground; `test_robot_model.py` is about them


class Posed(NamedTuple):
    """A model at a pose: where each body's centre of mass stands, and which way it is turned."""

    model: mujoco.MjModel
    data: mujoco.MjData

    @property
    def mass(self) -> float:
        return float(self.model.body_mass.sum())

    @property
    def com(self) -> np.ndarray:
        return self.model.body_mass @ self.data.xipos / self.mass

    @property
    def inertia(self) -> np.ndarray:
        """Of the whole, locked, about the common centre of mass, in the root body's axes."""
        total = np.zeros((3, 3))
        for body in range(1, self.model.nbody):
            axes = self.data.ximat[body].reshape(3, 3)
            arm = self.data.xipos[body] - self.com
            total += axes @ np.diag(self.model.body_inertia[body]) @ axes.T
            total += self.model.body_mass[body] * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        return total

    @property
    def principal(self) -> np.ndarray:
        """Principal inertias nearest body axes 1, 2, 3, for a body that is left-right symmetric."""
        values, axes = np.linalg.eigh(self.inertia)
        second = int(np.argmax(np.abs(axes[1])))
        others = [i for i in range(3) if i != second]
        third = max(others, key=lambda i: abs(axes[2, i]))
        first = others[0] if third == others[1] else others[1]
        return values[[first, second, third]]

    @property
    def ratios(self) -> tuple[float, float]:
        """k1 and k3 of the thesis, eq. 2.10."""
        i1, i2, i3 = self.principal
        return (i2 - i3) / i1, (i2 - i1) / i3


def pose(name: str, **angles: float) -> Posed:
    """A shipped model with its root frame at the origin, parallel to the world."""
    model = mujoco.MjModel.from_xml_path(str(SHIPPED / f"{name}.xml"))
    data = mujoco.MjData(model)
    for joint, angle in angles.items():
        data.joint(joint).qpos = angle
    mujoco.mj_forward(model, data)
    return Posed(model, data)


def arms(name: str, angle: float) -> Posed:
    """The symmetric pose of eqs. 4.7 and 4.8."""
    return pose(name, left_shoulder=angle, right_shoulder=-angle)


def outboard(posed: Posed, side: str) -> float:
    """I_sh: inertia of one arm about its shoulder's axis."""
    body = posed.model.body(f"{side}_arm")
    return float(body.inertia[0] + body.mass[0] * (body.ipos @ body.ipos))


def mass_matrix(posed: Posed) -> np.ndarray:
    """M of the thesis's five coordinates, the centre of mass being free to move.

    Rows: tilt, twist, asymmetric arms, somersault, symmetric arms.
    """
    size = posed.model.nv
    columns = []
    for unit in np.eye(size):
        column = np.zeros(size)
        mujoco.mj_mulM(posed.model, posed.data, column, unit)
        columns.append(column)
    full = np.column_stack(columns)
    moved = full[3:, :3]
    reduced = full[3:, 3:] - moved @ np.linalg.solve(full[:3, :3], moved.T)
    change = np.zeros((5, 5))
    change[0, 0] = change[2, 1] = change[1, 3] = 1.0
    change[3:, 2] = 1.0, 1.0
    change[3:, 4] = 1.0, -1.0
    return change.T @ reduced @ change


def test_every_shipped_file_is_checked_here() -> None:
    assert {path.stem for path in SHIPPED.glob("*.xml")} == set(JOINTS) == set(MASSES)


@pytest.mark.parametrize("name", JOINTS)
class TestEvery:
    def test_names_its_sources_first(self, name: str) -> None:
        text = (SHIPPED / f"{name}.xml").read_text(encoding="utf-8")
        assert text.startswith("<!--\n")
        comment = text[: text.index("-->")]
        assert "Playter (1994)" in comment
        assert "SI units" in comment
        assert max(map(len, comment.splitlines())) <= 100

    def test_mass(self, name: str) -> None:
        assert pose(name).mass == pytest.approx(MASSES[name], rel=1e-6)

    def test_flies_free_of_gravity_and_contact(self, name: str) -> None:
        model = pose(name).model
        assert model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE
        if name in ROBOTS:
            return
        assert model.opt.gravity.tolist() == [0.0, 0.0, 0.0]
        assert not model.geom_contype.any()
        assert not model.geom_conaffinity.any()

    def test_joints_turn_about_their_axes_and_are_limited(self, name: str) -> None:
        model = pose(name).model
        assert tuple(model.joint(i).name for i in range(1, model.njnt)) == JOINTS[name]
        for joint in JOINTS[name]:
            if name not in ("gymnast", *ROBOTS):  # whose joints are tested elsewhere
                assert model.joint(joint).axis.tolist() == [1.0, 0.0, 0.0]
            assert model.joint(joint).limited[0]
            low, high = model.joint(joint).range
            assert low <= 0 < high


class TestFurrer:
    def test_shoulder_inertia(self) -> None:
        for side in ("left", "right"):
            assert outboard(pose("furrer"), side) == pytest.approx(0.384934, abs=5e-7)

    def test_whole_body_at_1_3_by_parallel_axes(self) -> None:
        """m11, m44 and m22, from Table 4.1 without MuJoCo."""
        mb, ml, y, z, r, angle = 58.3, 3.743, 0.18, 0.479, 0.262, 1.3
        y_arm, z_arm = y + r * np.sin(angle), z - r * np.cos(angle)
        lift = 2 * ml * z_arm / (mb + 2 * ml)
        up = mb * lift**2 + 2 * ml * (z_arm - lift) ** 2
        out = 2 * ml * y_arm**2
        turned = np.array([np.cos(angle) ** 2, np.sin(angle) ** 2])
        expected = [
            10.19 + 2 * 0.128 + up + out,
            9.93 + 2 * turned @ [0.128, 0.0037] + up,
            0.52 + 2 * turned @ [0.0037, 0.128] + out,
        ]
        np.testing.assert_allclose(expected, [12.9553, 11.0645, 2.1582], atol=5e-5)
        np.testing.assert_allclose(arms("furrer", 1.3).inertia, np.diag(expected), atol=1e-9)

    def test_whole_mass_matrix_at_1_3(self) -> None:
        expected = np.diag([12.9553, 2.1582, 0.7657, 11.0645, 0.7156])
        expected[0, 2] = expected[2, 0] = 0.8831
        np.testing.assert_allclose(mass_matrix(arms("furrer", 1.3)), expected, atol=5e-5)

    def test_inertia_ratios_at_1_3(self) -> None:
        assert arms("furrer", 1.3).ratios == pytest.approx((0.687, -0.876), abs=1e-3)

    def test_raises_its_arms_sideways(self) -> None:
        data = arms("furrer", np.pi / 2).data
        np.testing.assert_allclose(data.body("left_arm").xipos, [0, 0.18 + 0.262, 0.479])
        np.testing.assert_allclose(data.body("right_arm").xipos, [0, -0.18 - 0.262, 0.479])


class TestDolls:
    @pytest.mark.parametrize(("name", "inertia"), [("doll", 2.463e-4), ("doll_weighted", 3.02e-4)])
    def test_shoulder_inertia(self, name: str, inertia: float) -> None:
        for side in ("left", "right"):
            assert outboard(pose(name), side) == pytest.approx(inertia, rel=3e-3)

    def test_the_weight_accounts_for_the_difference(self) -> None:
        """Bare arm and 30 g at 0.043 m make the weighted arm, within the table's rounding."""
        bare, weighted = (pose(name).model.body("left_arm") for name in ("doll", "doll_weighted"))
        m, r, weight, at = bare.mass[0], -bare.ipos[2], 0.03, 0.043
        centre = (m * r + weight * at) / (m + weight)
        assert weighted.mass[0] == pytest.approx(m + weight)
        assert -weighted.ipos[2] == pytest.approx(centre, abs=5e-5)
        spread = bare.inertia[0] + m * (r - centre) ** 2 + weight * (at - centre) ** 2
        assert weighted.inertia[0] == pytest.approx(spread, rel=5e-3)

    @pytest.mark.parametrize("name", ["doll", "doll_weighted"])
    def test_is_unstable_about_the_somersault_axis_like_furrer(self, name: str) -> None:
        for angle in (0.3, 1.3, 2.3):
            k1, k3 = arms(name, angle).ratios
            assert k1 > 0 > k3


class TestSimplest:
    def test_is_furrer_with_arms_out(self) -> None:
        whole = arms("furrer", np.pi / 2)
        np.testing.assert_allclose(pose("simplest").inertia, whole.inertia, atol=1e-6)

    def test_centres_of_mass_coincide(self) -> None:
        np.testing.assert_allclose(pose("simplest", arm=0.7).data.xipos[1:], 0, atol=1e-15)

    def test_ratios_beside_table_4_3(self) -> None:
        """I_rel and kl1 are the table's 0.06 and -0.99; its k1 and k3 are not Furrer's."""
        posed = pose("simplest")
        il1, il2, il3 = np.diag(_body_inertia(posed, "arm"))
        assert il1 == il3
        assert (il2 - il3) / il1 == pytest.approx(-0.99, abs=5e-3)
        assert il1 / posed.principal[0] == pytest.approx(0.06, abs=5e-3)
        assert posed.ratios == pytest.approx((0.6866, -0.8805), abs=1e-4)

    def test_no_arm_angle_of_furrer_gives_the_k1_of_table_4_3(self) -> None:
        least = min(arms("furrer", angle).ratios[0] for angle in np.linspace(0, np.pi, 181))
        assert least == pytest.approx(0.684, abs=5e-4)


class TestHumans:
    def test_layout_is_intermediate_about_the_somersault_axis(self) -> None:
        i1, i2, i3 = pose("human_layout").principal
        assert i3 < i2 < i1
        k1, k3 = pose("human_layout").ratios
        assert k1 > 0 > k3

    @pytest.mark.parametrize("name", ["human_pike", "human_tuck"])
    def test_pike_and_tuck_are_major_about_it(self, name: str) -> None:
        i1, i2, i3 = pose(name).principal
        assert i2 > max(i1, i3)
        k1, k3 = pose(name).ratios
        assert min(k1, k3) > 0

    @pytest.mark.parametrize("name", ["human_layout", "human_pike", "human_tuck"])
    def test_is_the_same_on_both_sides(self, name: str) -> None:
        posed = pose(name)
        assert posed.com[1] == pytest.approx(0, abs=1e-12)
        np.testing.assert_allclose(posed.inertia[1, [0, 2]], 0, atol=1e-9)

    def test_somersault_inertia_falls_from_layout_to_pike_to_tuck(self) -> None:
        layout, pike, tuck = (pose(f"human_{name}").principal[1] for name in _POSES)
        assert tuck < pike < layout

    def test_against_measured_men(self) -> None:
        """Santschi, DuBois and Omoto (1963) AMRL-TDR-63-36: means of 66 men, kg m².

        Standing, within 25 % on each axis. The nearest to a tuck is sitting with the thighs
        elevated, 3.8 about axis 2; only that axis is comparable.
        """
        standing = [13.0, 11.6, 1.28]
        np.testing.assert_allclose(pose("human_layout").principal, standing, rtol=0.25)
        assert pose("human_tuck").principal[1] == pytest.approx(3.8, rel=0.25)

    def test_against_three_men_scaled_to_size(self) -> None:
        """Tözeren (2000) Human Body Dynamics, table A.2.1, position 1, per mass and height²."""
        inch, pound, unit = 0.0254, 0.45359237, 0.11298  # unit: lb in s² in kg m²
        men = (
            (72.2, 173.5, (132, 119, 13.1)),
            (67.4, 147.3, (95.6, 81.9, 10.3)),
            (73.3, 203.0, (144, 129, 14.2)),
        )
        scaled = [
            np.array(inertia) * unit / (weight * pound * (height * inch) ** 2)
            for height, weight, inertia in men
        ]
        expected = 73.0 * 1.741**2 * np.mean(scaled, axis=0)
        np.testing.assert_allclose(pose("human_layout").principal, expected, rtol=0.25)

    def test_reach_the_shanks(self) -> None:
        for name in ("human_pike", "human_tuck"):
            data = pose(name).data
            knee, ankle = data.body("left_shank").xpos, data.body("left_foot").xpos
            middle = (knee + ankle) / 2
            assert np.linalg.norm(data.body("left_hand").xpos - middle) < 0.07


class TestRigidHumansScript:
    @pytest.mark.parametrize("name", ["layout", "pike", "tuck"])
    def test_writes_the_very_files_that_ship(self, name: str) -> None:
        script = program("rigid_humans")
        written = next(script.mjcf(each) for each in script.POSES if each.name == name)
        assert written.encode() == (SHIPPED / f"human_{name}.xml").read_bytes()

    def test_the_table_adds_up(self) -> None:
        table = program("rigid_humans").TABLE
        paired = sum(row.mass for name, row in table.items() if name not in ("head", "trunk"))
        total = table["head"].mass + table["trunk"].mass + 2 * paired
        assert total == pytest.approx(100, abs=1e-9)

    def test_the_trunk_is_the_same_between_other_end_points(self) -> None:
        """De Leva gives it from cervicale and from mid-shoulder to mid-hip; they must agree."""
        script = program("rigid_humans")
        trunk = script.TABLE["trunk"]
        above_hips = trunk.length * (1 - trunk.com / 100)
        from_shoulders = script.SHOULDER_HEIGHT * (1 - 0.431)
        assert above_hips == pytest.approx(from_shoulders, abs=1e-4)
        radii = script.SHOULDER_HEIGHT * np.array([0.384, 0.358, 0.197])
        np.testing.assert_allclose(trunk.length * np.array(trunk.gyration) / 100, radii, rtol=5e-3)

    def test_refuses_a_wrist_out_of_reach(self) -> None:
        script = program("rigid_humans")
        straight = script.Pose("sit", "", hip=1.0, wrist=(1.0, 0.0, 0.0))
        with pytest.raises(ValueError, match=r"sit: the wrist is .* from the shoulder"):
            script.mjcf(straight)


def test_book_is_a_uniform_box() -> None:
    thick, wide, high = 0.03, 0.17, 0.24
    expected = np.array([wide**2 + high**2, thick**2 + high**2, thick**2 + wide**2]) / 12
    inertia = pose("book").inertia
    np.testing.assert_allclose(inertia, np.diag(expected), rtol=1e-12, atol=1e-18)
    i1, i2, i3 = np.diag(inertia)
    assert i3 < i2 < i1


_POSES = ("layout", "pike", "tuck")


def _body_inertia(posed: Posed, name: str) -> np.ndarray:
    """One body's inertia about its own centre of mass, in its own axes."""
    body = posed.model.body(name)
    flat = np.empty(9)
    mujoco.mju_quat2Mat(flat, body.iquat)
    axes = flat.reshape(3, 3)
    return axes @ np.diag(body.inertia) @ axes.T
