"""Athletes: against the table they are made of, the yeadon package, and MuJoCo."""

from __future__ import annotations

import itertools
import sys
import warnings
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from programs import program
from scipy.spatial.transform import Rotation

from somersault import stability
from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault.attitude import matrix_from_quaternion
from somersault.model import (
    Model,
    athlete,
    athlete_from_measurements,
    load,
    mirror_pairs,
    named_pose,
    pose,
)
from somersault.model.athlete._athlete import INWARD
from somersault.model.athlete._de_leva import FEMALE, MALE, TABLES

ROOT = Path(__file__).parents[1]
POSES = ("tuck", "pike", "layout", "arms_up", "T", "wrap")
THIRTEEN = {
    "torso_twist",
    *(
        f"{side}_{joint}"
        for side in ("left", "right")
        for joint in (
            "shoulder_abduction",
            "shoulder_rotation",
            "shoulder_flexion",
            "elbow",
            "hip_flexion",
            "hip_abduction",
        )
    ),
}
# Nobody's: an invented grown-up in metres, left and right not quite alike.
TORSO = {
    **{"Ls1L": 0.09, "Ls2L": 0.21, "Ls3L": 0.37, "Ls4L": 0.49, "Ls5L": 0.53},
    **{"Ls6L": 0.15, "Ls7L": 0.2, "Ls8L": 0.3},
    **{"Ls0p": 0.93, "Ls1p": 0.8, "Ls2p": 0.82, "Ls3p": 0.95},
    **{"Ls5p": 0.4, "Ls6p": 0.52, "Ls7p": 0.57},
    **{"Ls0w": 0.34, "Ls1w": 0.29, "Ls2w": 0.3, "Ls3w": 0.34, "Ls4w": 0.36, "Ls4d": 0.16},
}
ARM = {
    **{"2L": 0.27, "3L": 0.33, "4L": 0.52, "5L": 0.03, "6L": 0.09, "7L": 0.18},
    **{"0p": 0.36, "1p": 0.31, "2p": 0.26, "3p": 0.27, "4p": 0.17, "5p": 0.22, "6p": 0.2},
    **{"7p": 0.12, "4w": 0.06, "5w": 0.085, "6w": 0.08, "7w": 0.05},
}
LEG = {
    **{"1L": 0.1, "3L": 0.42, "4L": 0.56, "5L": 0.82, "6L": 0.03, "8L": 0.15, "9L": 0.21},
    **{"1p": 0.56, "2p": 0.52, "3p": 0.37, "4p": 0.36, "5p": 0.23, "6p": 0.32, "7p": 0.25},
    **{"8p": 0.23, "9p": 0.19, "8w": 0.09, "9w": 0.08, "6d": 0.12},
}
MEASURED = {
    **TORSO,
    **{f"La{level}": value for level, value in ARM.items()},
    **{f"Lb{level}": 1.02 * value for level, value in ARM.items()},
    **{f"Lj{level}": value for level, value in LEG.items()},
    **{f"Lk{level}": 0.99 * value for level, value in LEG.items()},
}


def frames(model: Model, q: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Rotation and origin of each body in the base's axes, by scipy's rotations."""
    found: list[tuple[np.ndarray, np.ndarray]] = []
    for body in model.bodies:
        turn, origin = np.array(body.rotation), np.array(body.position)
        if found:
            base, at = found[body.parent]
            turn, origin = base @ turn, at + base @ origin
        for joint in body.joints:
            value = q[model.coordinate_slice(joint.name)]
            if joint.kind == "ball":
                turn = turn @ matrix_from_quaternion(value)
            else:
                turn = turn @ Rotation.from_rotvec(value[0] * np.array(joint.axis)).as_matrix()
        found.append((turn, origin))
    return found


def whole(model: Model, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centre of mass and inertia about it of all bodies held still, in the base's axes."""
    found = frames(model, q)
    masses = np.array([body.mass for body in model.bodies])
    coms = np.array(
        [at + turn @ body.com for body, (turn, at) in zip(model.bodies, found, strict=True)]
    )
    com = masses @ coms / masses.sum()
    total = np.zeros((3, 3))
    for body, (turn, _), at in zip(model.bodies, found, coms, strict=True):
        arm = at - com
        total += turn @ np.array(body.inertia) @ turn.T
        total += body.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return com, total


def at(model: Model, name: str) -> np.ndarray:
    return pose(model, named_pose(model, name))


@pytest.fixture(params=["male", "female"])
def sex(request: pytest.FixtureRequest) -> str:
    return str(request.param)


class TestTree:
    def test_thirteen_joints(self) -> None:
        model = athlete(1.7, 65)
        assert {joint.name for joint in model.joints} == THIRTEEN
        assert all(joint.kind == "hinge" for joint in model.joints)
        assert len(model.joints) == 13

    def test_every_joint_has_its_mirror_image(self) -> None:
        for options in ({}, {"knees": True}, {"shoulders": "ball"}):
            model = athlete(1.7, 65, **options)
            pairs = mirror_pairs(model)
            assert sorted(i for p in pairs for i in {p.left, p.right}) == list(
                range(len(model.speeds))
            )
            assert [p.name for p in pairs if p.left == p.right] == ["torso_twist"]
            hinges = [p for p in pairs if p.left != p.right and "." not in p.name]
            assert all(p.sign == 1 for p in hinges), "alike on both sides"
            assert all(model.speeds[p.left].startswith("left_") for p in hinges)

    def test_signs_are_anatomical(self) -> None:
        """Where the hand, knee or ankle goes when one joint moves by a little."""
        model = athlete(1.7, 65, knees=True)
        names = [body.name for body in model.bodies]
        front, left, _ = np.eye(3)
        expected = {
            "left_shoulder_abduction": ("left_forearm", left),
            "right_shoulder_abduction": ("right_forearm", -left),
            "left_shoulder_flexion": ("left_forearm", front),
            "right_shoulder_flexion": ("right_forearm", front),
            "left_hip_flexion": ("left_shank", front),
            "right_hip_flexion": ("right_shank", front),
            "left_hip_abduction": ("left_shank", left),
            "right_hip_abduction": ("right_shank", -left),
        }
        for joint, (body, way) in expected.items():
            turn, origin = frames(model, pose(model, {joint: 0.3}))[names.index(body)]
            _, before = frames(model, model.home)[names.index(body)]
            assert (origin - before) @ way > 0.05, joint
        for side, medial in (("left", -left), ("right", left)):
            forearm = names.index(f"{side}_forearm")
            bent = {f"{side}_elbow": 1.5}
            turn, _ = frames(model, pose(model, bent))[forearm]
            assert -turn[:, 2] @ front > 0.7, "the elbow bends forward"
            turned, _ = frames(model, pose(model, bent | {f"{side}_shoulder_rotation": 0.5}))[
                forearm
            ]
            assert -turned[:, 2] @ medial > -turn[:, 2] @ medial + 0.2, "rotation is inward"
            turn, _ = frames(model, pose(model, {f"{side}_knee": 1.0}))[
                names.index(f"{side}_shank")
            ]
            assert -turn[:, 2] @ front < -0.7, "the knee bends backward"
        turn, _ = frames(model, pose(model, {"torso_twist": 0.5}))[names.index("torso")]
        assert (turn @ front) @ left > 0.4, "the torso turns to the left"

    def test_a_ball_shoulder_makes_the_same_poses(self) -> None:
        hinges, ball = athlete(1.7, 65), athlete(1.7, 65, shoulders="ball")
        for name in POSES:
            for one, other in zip(
                whole(hinges, at(hinges, name)), whole(ball, at(ball, name)), strict=True
            ):
                np.testing.assert_allclose(one, other, atol=1e-12)

    def test_bodies_are_possible_and_centred(self, sex: str) -> None:
        model = athlete(1.7, 65, sex)
        com, inertia = whole(model, model.home)
        np.testing.assert_allclose(com[:2], 0, atol=1e-12)
        np.testing.assert_allclose(inertia, np.diag(np.diag(inertia)), atol=1e-9)


class TestStature:
    def test_total_mass_is_exact(self, sex: str) -> None:
        for mass in (10.0, 61.9, 250.0):
            assert athlete(1.7, mass, sex).mass == pytest.approx(mass, rel=1e-14)

    def test_bodies_have_their_rows_shares(self, sex: str) -> None:
        row = TABLES[sex].segments
        model = athlete(1.7, 100, sex, knees=True)
        masses = {body.name: body.mass for body in model.bodies}
        bodies = {
            "pelvis": ("lower_trunk", "middle_trunk"),
            "torso": ("upper_trunk", "head"),
            "left_upper_arm": ("upper_arm",),
            "right_forearm": ("forearm", "hand"),
            "left_thigh": ("thigh",),
            "right_shank": ("shank", "foot"),
        }
        for body, rows in bodies.items():
            assert masses[body] == pytest.approx(sum(row[r].mass for r in rows), rel=2e-4)

    @pytest.mark.parametrize("table", [MALE, FEMALE])
    def test_the_trunk_in_parts_is_the_whole_trunk(self, table: Any) -> None:
        """Lengths, masses, centre of mass (3 mm for the men), and inertia across."""
        row = table.segments
        parts = [row[f"{k}_trunk"] for k in ("upper", "middle", "lower")]
        trunk = row["trunk"]
        assert sum(p.length for p in parts) == pytest.approx(trunk.length, abs=1e-9)
        assert sum(p.mass for p in parts) == pytest.approx(trunk.mass, abs=1e-9)
        tops = np.cumsum([0, *(p.length for p in parts[:2])])
        masses = np.array([p.mass for p in parts])
        at = tops + [p.com / 100 * p.length for p in parts]
        com = masses @ at / trunk.mass
        assert com == pytest.approx(trunk.com / 100 * trunk.length, abs=3.1e-3)
        across = sum(p.inertia(p.mass, p.length)[0] for p in parts) + masses @ (at - com) ** 2
        assert across == pytest.approx(trunk.inertia(trunk.mass, trunk.length)[0], rel=0.06)

    def test_lengths_from_head_to_toe(self) -> None:
        """Elbow, wrist side of the forearm and knee stand where the table's lengths put them."""
        model = athlete(MALE.height, MALE.mass, knees=True)
        names = [body.name for body in model.bodies]
        places = [origin for _, origin in frames(model, model.home)]
        row = MALE.segments
        shoulder = places[names.index("left_upper_arm")]
        np.testing.assert_allclose(shoulder, [0, 0.18, MALE.shoulder_height], atol=1e-12)
        elbow = places[names.index("left_forearm")]
        np.testing.assert_allclose(shoulder - elbow, [0, 0, row["upper_arm"].length], atol=1e-12)
        knee = places[names.index("left_shank")]
        np.testing.assert_allclose(knee, [0, 0.085, -row["thigh"].length], atol=1e-12)

    @pytest.mark.parametrize("name", POSES)
    def test_inertia_goes_as_mass_and_height_squared(self, sex: str, name: str) -> None:
        one, two = athlete(1.6, 50, sex), athlete(2.0, 75, sex)
        ratio = 75 / 50 * (2.0 / 1.6) ** 2
        expected = whole(one, at(one, name))[1] * ratio
        np.testing.assert_allclose(whole(two, at(two, name))[1], expected, atol=1e-12)

    def test_stands_like_the_rigid_man_with_a_whole_trunk(self) -> None:
        """`human_layout`, posed by its own script from the whole trunk's row."""
        model = athlete(MALE.height, MALE.mass)
        rigid = load("human_layout")
        _, expected = whole(rigid, rigid.home)
        _, inertia = whole(model, at(model, "layout"))
        np.testing.assert_allclose(np.diag(inertia), np.diag(expected), rtol=6e-3)

    def test_against_measured_men(self) -> None:
        """Santschi, DuBois and Omoto (1963) AMRL-TDR-63-36: means of 66 men, standing, kg m²."""
        model = athlete(1.763, 75.5)  # their mean height and mass
        inertia = np.diag(whole(model, at(model, "layout"))[1])
        np.testing.assert_allclose(inertia, [13.0, 11.6, 1.28], rtol=0.25)

    @pytest.mark.parametrize(
        ("given", "message"),
        [
            ((170, 65), r"height is 170; it looks like centimetres; give 0.5 to 2.5 m"),
            ((0.1, 65), r"height is 0.1; give 0.5 to 2.5 m"),
            ((float("nan"), 65), r"height is nan; give"),
            (("tall", 65), r"height is 'tall'; give"),
            ((None, 65), r"height is None; give"),
            ((1.7, 0), r"mass is 0; give 10 to 250 kg"),
            ((1.7, float("inf")), r"mass is inf; give 10 to 250 kg"),
            ((1.7, 65, "other"), r"sex is 'other'; give 'male' or 'female'"),
            ((1.7, 65, ["male"]), r"sex is \['male'\]; give 'male'"),
        ],
    )
    def test_refuses(self, given: tuple[Any, ...], message: str) -> None:
        with pytest.raises(SomersaultError, match=message):
            athlete(*given)

    def test_refuses_other_shoulders(self) -> None:
        with pytest.raises(SomersaultError, match="shoulders is 'socket'; give 'hinges' or 'ball'"):
            athlete(1.7, 65, shoulders="socket")  # type: ignore[arg-type]


class TestPoses:
    @pytest.mark.parametrize("name", POSES)
    @pytest.mark.parametrize("knees", [False, True])
    def test_is_whole_and_within_the_ranges(self, name: str, knees: bool) -> None:
        model = athlete(1.7, 65, knees=knees)
        angles = named_pose(model, name)
        assert set(angles) == {pair.name for pair in mirror_pairs(model)}
        q = pose(model, angles)  # refuses what is outside
        for value, joint in zip(q, model.joints, strict=True):
            assert joint.limits is not None
            assert joint.limits[0] <= value <= joint.limits[1]

    def test_stays_off_gimbal_lock_on_every_straight_move(self) -> None:
        """The first and last shoulder hinge never come within 0.85 rad of one line."""
        model = athlete(1.7, 65)
        names = [body.name for body in model.bodies]
        for one, other in itertools.combinations_with_replacement(POSES, 2):
            for share in np.linspace(0, 1, 11):
                q = (1 - share) * at(model, one) + share * at(model, other)
                assert _between_hinges(model, names, q) > 0.85

    def test_no_pose_within_the_ranges_is_at_gimbal_lock(self) -> None:
        model = athlete(1.7, 65)
        names = [body.name for body in model.bodies]
        low, high = np.array([joint.limits for joint in model.joints]).T
        rng = np.random.default_rng(6)
        corners = [low, high, *rng.uniform(low, high, (200, len(low)))]
        assert min(_between_hinges(model, names, q) for q in corners) > 0.3

    @pytest.mark.parametrize("sex", ["male", "female"])
    @pytest.mark.parametrize("knees", [False, True])
    def test_somersault_axis_is_major_in_pike_and_tuck_only(self, sex: str, knees: bool) -> None:
        model = athlete(1.7, 65, sex, knees=knees)
        for name in POSES:
            inertia = whole(model, at(model, name))[1]
            np.testing.assert_allclose(inertia[1, [0, 2]], 0, atol=1e-12)
            across = inertia[np.ix_([0, 2], [0, 2])]
            major = inertia[1, 1] > np.linalg.eigvalsh(across)[1]
            assert major == (name in ("pike", "tuck")), name

    def test_hands_are_where_the_pose_says(self) -> None:
        model = athlete(MALE.height, MALE.mass, knees=True)
        names = [body.name for body in model.bodies]

        def end(name: str, body: str, row: str) -> np.ndarray:
            turn, origin = frames(model, at(model, name))[names.index(body)]
            return origin - turn[:, 2] * MALE.segments[row].length

        def wrist(name: str) -> np.ndarray:
            return end(name, "left_forearm", "forearm")

        shoulder = np.array([0, 0.18, MALE.shoulder_height])
        arm = MALE.segments["upper_arm"].length + MALE.segments["forearm"].length
        np.testing.assert_allclose(wrist("T") - shoulder, [0, arm, 0], atol=1e-12)
        np.testing.assert_allclose(wrist("arms_up") - shoulder, [0, 0, arm], atol=1e-12)
        x, y, z = wrist("wrap")
        assert 0.08 < x < 0.25
        assert -0.1 < y < 0.05, "across the chest"
        assert 0.3 < z < 0.55
        for name in ("pike", "tuck"):
            _, knee = frames(model, at(model, name))[names.index("left_shank")]
            middle = (knee + end(name, "left_shank", "shank")) / 2
            assert np.linalg.norm(wrist(name) - middle) < 0.09

    def test_takes_any_model_with_the_joints(self) -> None:
        assert named_pose("gymnast", "wrap") == named_pose(athlete(1.6, 50, "female"), "wrap")

    def test_can_be_changed_by_a_joints_name(self) -> None:
        model = athlete(1.7, 65)
        q = pose(model, named_pose(model, "pike") | {"hip_flexion": 1.5})
        assert q[model.coordinate_slice("left_hip_flexion")] == 1.5

    def test_refuses_an_unknown_pose(self) -> None:
        with pytest.raises(SomersaultError, match=r"no pose is called 'straddle'; the poses are"):
            named_pose("gymnast", "straddle")

    def test_refuses_a_model_without_the_joints(self) -> None:
        with pytest.raises(SomersaultError, match=r"furrer has no 'torso_twist'.*use 'gymnast'"):
            named_pose("furrer", "pike")


def _between_hinges(model: Model, names: list[str], q: np.ndarray) -> float:
    """The smaller angle between a left shoulder's first and last axes, rad."""
    body = model.bodies[names.index("left_upper_arm")]
    first, middle, last = body.joints
    angle = q[model.coordinate_slice(middle.name)][0]
    turned = Rotation.from_rotvec(angle * np.array(middle.axis)).apply(last.axis)
    return float(np.arccos(min(1.0, abs(turned @ np.array(first.axis)))))


@pytest.fixture(scope="module")
def human() -> Any:
    return pytest.importorskip("yeadon").Human


class TestMeasured:
    # yeadon's axes are 1 left, 2 back, 3 head: its vectors, as rows, in ours.
    AXES = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])

    def configuration(self, model: Model, names: tuple[str, ...], angles: dict[str, float]) -> Any:
        """The same pose in yeadon's angles: turns about its axes 1, 2, 3 in that order."""
        q = pose(model, angles)
        bodies = [body.name for body in model.bodies]
        found = frames(model, q)
        base = found[bodies.index("torso")][0]
        cfg = dict.fromkeys(names, 0.0)

        def value(joint: str) -> float:
            return float(q[model.coordinate_slice(joint)][0])

        cfg["TCspinalTorsion"] = value("torso_twist")
        for side, arm, leg, lateral in (
            ("left", "A", "J", "adduction"),
            ("right", "B", "K", "abduction"),
        ):
            out = 1 if side == "left" else -1
            # The forearm without the elbow has the turn of yeadon's upper arm.
            elbow = value(f"{side}_elbow")
            fore = found[bodies.index(f"{side}_forearm")][0]
            upper = base.T @ fore @ Rotation.from_rotvec([0, elbow, 0]).as_matrix()
            theirs = self.AXES.T @ upper @ self.AXES
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # yeadon's own angles lock in the T
                turns = Rotation.from_matrix(theirs).as_euler("XYZ")
            first = "adduction" if side == "left" else "abduction"
            for kind, turn in zip(("extension", first, "rotation"), turns, strict=True):
                cfg[f"C{arm}1{kind}"] = float(turn)
            cfg[f"{arm}1{arm}2extension"] = -elbow
            cfg[f"P{leg}1extension"] = -value(f"{side}_hip_flexion")
            cfg[f"P{leg}1{lateral}"] = -out * value(f"{side}_hip_abduction")
            cfg[f"{leg}1{leg}2flexion"] = value(f"{side}_knee")
        return cfg

    def poses(self, model: Model) -> list[dict[str, float]]:
        rng = np.random.default_rng(3)
        drawn = [
            {joint.name: float(rng.uniform(*joint.limits)) for joint in model.joints}
            for _ in range(5)
        ]
        return [named_pose(model, name) for name in POSES] + drawn

    @pytest.mark.parametrize("densities", ["Dempster", "Clauser"])
    def test_standing_body_is_yeadons(self, human: Any, densities: str) -> None:
        model = athlete_from_measurements(MEASURED, densities=densities)
        theirs = human(dict(MEASURED), density_set=densities)
        com, inertia = whole(model, pose(model, {"shoulder_rotation": -INWARD}))
        assert model.mass == pytest.approx(theirs.mass, rel=1e-14)
        np.testing.assert_allclose(com, self.AXES @ theirs.center_of_mass[:, 0], atol=1e-14)
        np.testing.assert_allclose(inertia, self.AXES @ theirs.inertia @ self.AXES.T, atol=1e-13)

    @pytest.mark.parametrize("densities", ["Dempster", "Clauser"])
    def test_posed_body_is_made_of_yeadons_segments(self, human: Any, densities: str) -> None:
        """Masses, places and turns are yeadon's, and so are the inertias about its own axes.

        The sum is not its `inertia`: yeadon 2.0.1 turns each segment's inertia backward (RᵀIR),
        which shows as principal inertias that change when the whole body is somersaulted.
        """
        model = athlete_from_measurements(MEASURED, knees=True, densities=densities)
        theirs = human(dict(MEASURED), density_set=densities)
        for angles in self.poses(model):
            theirs.set_CFG_dict(self.configuration(model, human.CFGnames, angles))
            com, inertia = whole(model, pose(model, angles))
            centre = theirs.center_of_mass[:, 0]
            np.testing.assert_allclose(com, self.AXES @ centre, atol=1e-13)
            total = np.zeros((3, 3))
            for segment in theirs.segments:
                arm = segment.center_of_mass[:, 0] - centre
                total += segment.rot_mat @ segment.rel_inertia @ segment.rot_mat.T
                total += segment.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
            np.testing.assert_allclose(inertia, self.AXES @ total @ self.AXES.T, atol=1e-12)

    def test_straight_legs_are_the_same_body(self, human: Any) -> None:
        bent, straight = (athlete_from_measurements(MEASURED, knees=k) for k in (True, False))
        assert {joint.name for joint in straight.joints} == THIRTEEN
        for name in ("layout", "pike", "wrap"):
            for one, other in zip(
                whole(bent, at(bent, name)), whole(straight, at(straight, name)), strict=True
            ):
                np.testing.assert_allclose(one, other, atol=1e-12)

    def test_measured_mass_scales_the_densities(self, human: Any, tmp_path: Path) -> None:
        plain = athlete_from_measurements(MEASURED)
        file = tmp_path / "man.txt"
        lines = [f"{name}: {100 * value}  # cm" for name, value in MEASURED.items()]
        file.write_text("\n".join(["measurementconversionfactor = .01", "totalmass: 70", *lines]))
        for model, mass in (
            (athlete_from_measurements(file), 70.0),
            (athlete_from_measurements(file, mass=60), 60.0),
            (athlete_from_measurements(MEASURED, mass=80), 80.0),
        ):
            assert model.mass == pytest.approx(mass, rel=1e-14)
            np.testing.assert_allclose(
                whole(model, at(model, "pike"))[1],
                whole(plain, at(plain, "pike"))[1] * mass / plain.mass,
                rtol=1e-10,
                atol=1e-12,
            )
        again = athlete_from_measurements(MEASURED)
        assert again == plain, "one athlete's mass is not the next one's"

    def test_every_joint_has_its_mirror_image(self, human: Any) -> None:
        pairs = mirror_pairs(athlete_from_measurements(MEASURED, knees=True))
        assert [p.name for p in pairs if p.left == p.right] == ["torso_twist"]
        assert len(pairs) == 8

    def test_pike_and_tuck_are_stable_and_layout_is_not(self, human: Any) -> None:
        model = athlete_from_measurements(MEASURED, knees=True)
        stable = [
            stability.spin(model, 2, pose=named_pose(model, n)).linear(lock="all").stable
            for n in ("tuck", "pike", "layout")
        ]
        assert stable == [True, True, False]

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            ({"La2L": None}, r"the measurements: La2L is None; give a positive number"),
            ({"La2L": -0.2}, r"La2L is -0.2; give a positive number"),
            ({"La2L": float("nan")}, r"La2L is nan; give a positive number"),
            ({"La2L": 27.0}, r"La2L is 27 m; give 0.001 to 3 m, or the unit as measurementconv"),
            ({"La9L": 0.2}, r"'La9L' is no measurement; remove it"),
            ({"totalmass": 700.0}, r"mass is 700.0; give 10 to 250 kg"),
            ({"La3L": 0.1, "Lb3L": 0.1}, r"leave the solid 'a2.*' no volume; correct the lengths"),
        ],
    )
    def test_refuses_a_number(self, human: Any, change: dict[str, Any], message: str) -> None:
        with pytest.raises(SomersaultError, match=message):
            athlete_from_measurements(MEASURED | change)

    def test_refuses_what_is_missing(self, human: Any) -> None:
        part = {name: value for name, value in MEASURED.items() if name != "Ls4d"}
        with pytest.raises(SomersaultError, match=r"1 of the 95 measurements are missing \(Ls4d\)"):
            athlete_from_measurements(part)

    def test_refuses_other_densities(self, human: Any) -> None:
        with pytest.raises(SomersaultError, match="densities is 'lead'; give 'Chandler'"):
            athlete_from_measurements(MEASURED, densities="lead")  # type: ignore[arg-type]

    def test_warns_of_a_cross_section_that_is_none(self, human: Any) -> None:
        with pytest.warns(SomersaultWarning, match="yeadon took circles for them"):
            athlete_from_measurements(MEASURED | {"Ls3w": 0.28})

    @pytest.mark.parametrize(
        ("content", "message"),
        [
            (b"La2L 0.27", r"man.txt, line 1: 'La2L 0.27' is not 'name: number'"),
            (b"La2L: 0.27\nLa2L: 0.28", r"man.txt, line 2: La2L is given twice; keep one"),
            (b"\xff\xfe\x00", r"man.txt' cannot be read \(it is no text file\)"),
            (b"#" * 200_000, r"man.txt is larger than 100 kB"),
            (b"", r"95 of the 95 measurements are missing"),
        ],
    )
    def test_refuses_a_file(self, human: Any, tmp_path: Path, content: bytes, message: str) -> None:
        file = tmp_path / "man.txt"
        file.write_bytes(content)
        with pytest.raises(SomersaultError, match=message):
            athlete_from_measurements(file)

    def test_refuses_a_file_that_is_not_there(self, human: Any, tmp_path: Path) -> None:
        for source in (tmp_path / "nobody.txt", tmp_path):
            with pytest.raises(SomersaultError, match=r"cannot be read \(.*; give a text file"):
                athlete_from_measurements(source)
        with pytest.raises(SomersaultError, match="must be the path of a file, and is 7"):
            athlete_from_measurements(7)  # type: ignore[arg-type]

    def test_says_how_to_install_yeadon(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setitem(sys.modules, "yeadon", None)
        with pytest.raises(SomersaultError, match=r"pip install somersault\[yeadon\]"):
            athlete_from_measurements(MEASURED)


def test_trunk_and_legs_are_clothed_and_the_rest_is_bare():
    """Of either sex, however heavy the legs are."""
    for model in (athlete(1.75, 70.0), athlete(1.62, 55.0, "female", knees=True)):
        blue = {
            (body.name.removeprefix("left_"), k)
            for body in model.bodies
            for k, shape in enumerate(body.shapes)
            if shape.color[2] > shape.color[0]
            if not body.name.startswith("right_")
        }
        legs = {("leg", 0), ("leg", 1)} if len(model.bodies) == 8 else {("thigh", 0), ("shank", 0)}
        assert blue == {("pelvis", 0), ("torso", 0), *legs}


class TestShipped:
    PATH = ROOT / "src" / "somersault" / "model" / "shipped" / "gymnast.xml"

    def test_the_script_writes_the_very_file_that_ships(self) -> None:
        assert program("gymnast").mjcf().encode() == self.PATH.read_bytes()

    def test_is_the_athlete_of_that_size(self) -> None:
        script = program("gymnast")
        made, read = athlete(script.HEIGHT, script.MASS), load("gymnast")
        for one, other in zip(made.bodies, read.bodies, strict=True):
            assert one.name == other.name
            assert one.parent == other.parent
            for what in ("mass", "com", "inertia", "position", "rotation"):
                np.testing.assert_allclose(getattr(one, what), getattr(other, what), atol=1e-8)
        for one, other in zip(made.joints, read.joints, strict=True):
            assert (one.name, one.axis) == (other.name, other.axis)
            np.testing.assert_allclose(one.limits, other.limits, atol=1e-8)

    def test_whole_body_is_mujocos_in_any_pose(self) -> None:
        """Of the unrounded athlete against the file, as MuJoCo weighs it."""
        script = program("gymnast")
        model = athlete(script.HEIGHT, script.MASS)
        theirs = mujoco.MjModel.from_xml_path(str(self.PATH))
        data = mujoco.MjData(theirs)
        low, high = np.array([joint.limits for joint in model.joints]).T
        rng = np.random.default_rng(7)
        for q in rng.uniform(low, high, (20, len(low))):
            data.qpos[7:] = q
            mujoco.mj_forward(theirs, data)
            columns = []
            for unit in np.eye(theirs.nv)[3:6]:
                column = np.zeros(theirs.nv)
                mujoco.mj_mulM(theirs, data, column, unit)
                columns.append(column[3:6])
            com, inertia = whole(model, q)
            np.testing.assert_allclose(data.subtree_com[1], com, atol=1e-7)
            # The base's block is about its origin; the centre of mass is `com` from there.
            about = inertia + model.mass * (com @ com * np.eye(3) - np.outer(com, com))
            np.testing.assert_allclose(columns, about, atol=1e-6)
