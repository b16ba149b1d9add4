"""The bioMod reader against MuJoCo, scipy, Python's own arithmetic and biorbd where installed."""

from __future__ import annotations

import contextlib
import re
import string
import warnings
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import somersault as so
from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault.model import Model
from somersault.model.read._biomod import read_biomod

DATA = Path(__file__).parent / "data"
DIVER = (DATA / "diver.bioMod").read_text("utf-8")
Moments = tuple[float, np.ndarray, np.ndarray]  # mass, com, inertia about it
FREE = "version 4\nsegment A\ntranslations xyz\nrotations xyz\nmass 1\n{}endsegment\n"


def read(folder: Path, text: str | bytes) -> Model:
    path = folder / "model.bioMod"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_biomod(path)


def noted(folder: Path, text: str) -> tuple[Model, list[str]]:
    """The model of a text, and what was said of it."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", SomersaultWarning)
        model = read(folder, text)
    return model, [str(w.message).removeprefix("model.bioMod: ") for w in caught]


# ------------------------------------------------------- the whole file, by other calculations

# diver.bioMod again, typed by hand: parent, frame (matrix, position), moves, mass, com, inertia.
EULER = Rotation.from_euler
DIVER_SEGMENTS = {
    "Pelvis": (None, np.eye(3), (0, 0, 0), "", 12, (0, 0.01, 0.05),
               [[0.08, 0.001, 0], [0.001, 0.07, 0], [0, 0, 0.09]]),
    "Chest": ("Pelvis", EULER("x", np.pi / 6).as_matrix(), (0, 0, 0.2), "", 20, (0, 0, 0.15),
              np.diag([0.3, 0.25, 0.2])),
    "RightUpperArm": ("Chest", [[0, 0, 1], [0, -1, 0], [1, 0, 0]], (-0.2, 0, 0.3), "ZYX", 2,
                      (0, 0, -0.14), np.diag([0.015, 0.015, 0.003])),
    "RightHand": ("RightUpperArm", EULER("y", -0.4).as_matrix(), (0, 0, -0.28), "", 1.5,
                  (0.01, 0, -0.1), np.diag([0.006, 0.005, 0.002])),
    "LeftUpperArm": ("Chest", EULER("XYZ", (0, -0.17, -0.1)).as_matrix(), (0.2, 0, 0.3), "zq",
                     3.5, (0, 0, -0.2), np.diag([0.04, 0.04, 0.005])),
    "Legs": ("Pelvis", np.eye(3), (0, 0, -0.1), "XY", 28, (0, 0, -0.4), np.diag([2, 2.1, 0.3])),
}  # fmt: skip


def composite(parts: list[Moments]) -> Moments:
    """The moments of a whole from those of its parts, in common axes."""
    mass = sum(m for m, _, _ in parts)
    com = sum(m * c for m, c, _ in parts) / mass
    arms = [c - com for _, c, _ in parts]
    inertia = sum(
        i + m * (np.eye(3) * (a @ a) - np.outer(a, a))
        for (m, _, i), a in zip(parts, arms, strict=True)
    )
    return mass, com, inertia


def the_diver() -> Model:
    with pytest.warns(SomersaultWarning, match=r"there_is_no_such_file.stl \(is not there\)"):
        return read_biomod(DATA / "diver.bioMod")


def diver_by_hand(pose: dict[str, list[float]]) -> Moments:
    """The unmerged diver at a pose, in the pelvis' axes, by scipy's rotations."""
    frames, parts = {}, []
    for name, (parent, rotation, position, moves, mass, com, inertia) in DIVER_SEGMENTS.items():
        above, origin = frames.get(parent, (np.eye(3), np.zeros(3)))
        origin = origin + above @ position
        turn = above @ rotation
        if moves == "zq":
            origin = origin + turn @ (0, 0, pose[name][0])
            turn = turn @ Rotation.from_quat(pose[name][1:], scalar_first=True).as_matrix()
        elif moves:
            turn = turn @ EULER(moves, pose[name]).as_matrix()
        frames[name] = turn, origin
        parts.append((mass, origin + turn @ com, turn @ inertia @ turn.T))
    return composite(parts)


def in_mujoco(model: Model) -> mujoco.MjModel:
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    made = [spec.worldbody]
    for body in model.bodies:
        quaternion = Rotation.from_matrix(body.rotation).as_quat(scalar_first=True)
        new = made[body.parent + 1].add_body(name=body.name, pos=body.position, quat=quaternion)
        new.explicitinertial, new.mass, new.ipos = True, body.mass, body.com
        i = np.array(body.inertia)
        new.fullinertia = [i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]]
        for joint in body.joints:
            kind = getattr(mujoco.mjtJoint, f"mjJNT_{joint.kind.upper()}")
            new.add_joint(name=joint.name, type=kind, axis=joint.axis, pos=joint.anchor)
        made.append(new)
    return spec.compile()


@pytest.mark.parametrize("seed", range(5))
def test_masses_at_a_random_pose_agree_with_mujoco_and_with_hand_calculation(seed: int) -> None:
    model = the_diver()
    random = np.random.default_rng(seed)
    quaternion = random.normal(size=4)
    pose = {
        "RightUpperArm": list(random.uniform(-2, 2, 3)),
        "LeftUpperArm": [random.uniform(-0.1, 0.1), *quaternion / np.linalg.norm(quaternion)],
        "Legs": list(random.uniform(-2, 2, 2)),
    }
    mass, com, inertia = diver_by_hand(pose)

    compiled = in_mujoco(model)
    state = mujoco.MjData(compiled)
    state.qpos[:] = [*pose["RightUpperArm"], *pose["LeftUpperArm"], *pose["Legs"]]
    mujoco.mj_forward(compiled, state)
    parts = []
    for body in range(1, compiled.nbody):
        axes = state.ximat[body].reshape(3, 3)
        own = axes @ np.diag(compiled.body_inertia[body]) @ axes.T
        parts.append((compiled.body_mass[body], state.xipos[body].copy(), own))

    assert mass == pytest.approx(67)
    for ours, theirs in zip(composite(parts), (mass, com, inertia), strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9)


@pytest.mark.parametrize("file", ["diver", "two_part_root"])
def test_segments_stand_where_biorbd_puts_them(file: str, tmp_path: Path) -> None:
    biorbd = pytest.importorskip("biorbd", reason="biorbd, the reference reader, is optional")
    text = (DATA / f"{file}.bioMod").read_text("utf-8")
    path = tmp_path / "m.bioMod"
    # biorbd opens mesh files, and wants actuators on all axes or on none
    path.write_text(re.sub(r"(?ms)^ *mesh.*?$|^actuator.*?^endactuator", "", text), "utf-8")
    theirs = biorbd.Model(str(path))
    ours = the_diver() if file == "diver" else read_biomod(DATA / f"{file}.bioMod")
    names = [name.to_string() for name in theirs.nameDof()]
    segments = [theirs.segment(i).name().to_string() for i in range(theirs.nbSegment())]
    pose = np.random.default_rng(3).uniform(-1, 1, theirs.nbQ())
    balls = [name[:-1] for name in names if name.endswith("_QuatX")]
    names[len(names) - len(balls) :] = [f"{ball}W" for ball in balls]  # biorbd misnames some
    for ball in balls:
        where = [names.index(ball + part) for part in "WXYZ"]
        pose[where] /= np.linalg.norm(pose[where])
    value = dict(zip(names, pose, strict=True))

    base = theirs.globalJCS(pose, segments.index(ours.bodies[0].name)).to_array()
    compiled = in_mujoco(ours)
    state = mujoco.MjData(compiled)
    parts = {"ball": "WXYZ"}
    state.qpos[:] = [
        value[joint.name + part] for joint in ours.joints for part in parts.get(joint.kind, [""])
    ]
    mujoco.mj_forward(compiled, state)
    for number, body in enumerate(ours.bodies, start=1):
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = state.xmat[number].reshape(3, 3), state.xpos[number]
        expected = theirs.globalJCS(pose, segments.index(body.name)).to_array()
        np.testing.assert_allclose(base @ frame, expected, atol=1e-7)
    if file == "two_part_root":  # the diver's board has mass in biorbd's total, not in ours
        com = base @ np.append(state.subtree_com[0], 1)
        np.testing.assert_allclose(com[:3], theirs.CoM(pose).to_array(), atol=1e-7)


# -------------------------------------------------------------------------- what words mean


def test_joints_are_named_and_ordered_as_in_biorbd() -> None:
    model = the_diver()
    assert model.free
    assert [body.name for body in model.bodies] == [
        "Pelvis", "RightUpperArm", "LeftUpperArm", "Legs",
    ]  # fmt: skip
    assert [joint.name for joint in model.joints] == [
        "RightUpperArm_RotZ", "RightUpperArm_RotY", "RightUpperArm_RotX",
        "LeftUpperArm_TransZ", "LeftUpperArm_Quat", "Legs_RotX", "Legs_RotY",
    ]  # fmt: skip
    assert [joint.axis for joint in model.bodies[1].joints] == [(0, 0, 1), (0, 1, 0), (1, 0, 0)]
    assert model.joint("RightUpperArm_RotX").limits == pytest.approx((-np.pi / 2, np.pi / 2))
    assert model.joint("RightUpperArm_RotY").damping == 0.2
    assert model.joint("LeftUpperArm_TransZ").limits == (-0.1, 0.1)
    ball = model.joint("LeftUpperArm_Quat")
    assert (ball.kind, ball.limits) == ("ball", None)


def test_what_does_not_fly_is_named() -> None:
    assert the_diver().ignored == (
        "gravity", "2 markers", "1 IMU", "1 contact", "1 actuator",
        "segment Board, fixed to the ground",
    )  # fmt: skip


def test_ranges_and_dampings_are_translations_first(tmp_path: Path) -> None:
    part = "segment B\nparent A\nrotations z\ntranslations y\n{} mass 1\nendsegment\n"
    text = FREE.format("") + part.format("rangesQ 1 2 3 4 jointdampings 5 6 rangesqdot 0 1 0 1")
    slide, hinge = read(tmp_path, text).joints
    assert (slide.name, slide.limits, slide.damping) == ("B_TransY", (1, 2), 5)
    assert (hinge.name, hinge.limits, hinge.damping) == ("B_RotZ", (3, 4), 6)


def test_rt_turns_about_carried_axes_in_the_order_written(tmp_path: Path) -> None:
    # A quarter about z, then a quarter about the carried x: x goes to y, y to z, z to x.
    text = FREE.format("") + (
        "segment B parent A rt pi/2 pi/2 0 zxy 1 2 3 rotations x mass 1 endsegment"
    )
    body = read(tmp_path, text).bodies[1]
    np.testing.assert_allclose(body.rotation, [[0, 0, 1], [1, 0, 0], [0, 1, 0]], atol=1e-12)
    assert body.position == (1, 2, 3)


@pytest.mark.parametrize("version", [1, 2, 3, 4])
def test_rt_is_a_matrix_by_default_only_before_version_3(version: int, tmp_path: Path) -> None:
    matrix = "0 -1 0 1  1 0 0 2  0 0 1 3  0 0 0 1" if version < 3 else "0 0 pi/2 xyz 1 2 3"
    text = FREE.replace("4", str(version)).format("")
    text += f"segment B parent A rt {matrix} rotations x mass 1 endsegment"
    body = read(tmp_path, text).bodies[1]
    np.testing.assert_allclose(body.rotation, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)
    assert body.position == (1, 2, 3)


def test_a_matrix_of_few_digits_becomes_a_true_rotation(tmp_path: Path) -> None:
    text = FREE.format("") + (
        "segment B parent A rtinmatrix 1 rt 0.7071 -0.7071 0 0 0.7071 0.7071 0 0 0 0 1 0 0 0 0 1"
        " rotations x mass 1 endsegment"
    )
    model, said = noted(tmp_path, text)
    rotation = np.array(model.bodies[1].rotation)
    np.testing.assert_allclose(rotation, EULER("z", np.pi / 4).as_matrix(), atol=1e-12)
    words = "matrices of few digits, made rotations (biorbd takes them as they are)"
    assert said == [f"{words}: rt of 'B' (by 7e-06)"]


def test_a_root_in_two_segments_is_one_free_base() -> None:
    model = read_biomod(DATA / "two_part_root.bioMod")
    assert model.free
    assert [body.name for body in model.bodies] == ["PelvisRot", "Arm"]
    base = model.bodies[0]
    # The mirrored shank by hand: its com (0, 0.02, 0.17) lies at (0.1, 0.02, -0.57).
    arms = [(10, np.array([0, 0, 0.1])), (4, np.array([0.1, 0.02, -0.57]))]
    com = (10 * arms[0][1] + 4 * arms[1][1]) / 14
    assert base.mass == 14
    assert base.com == pytest.approx(com)
    gap = arms[0][1] - arms[1][1]
    inertia = np.diag([0.26, 0.36, 0.256]) + 40 / 14 * (gap @ gap * np.eye(3) - np.outer(gap, gap))
    inertia[0, 1] += 0.001
    inertia[1, 0] += 0.001
    np.testing.assert_allclose(base.inertia, inertia, atol=1e-12)


CARRIER = "rotations q inertia 1 0 0 0 1 0 0 0 1 endsegment segment B parent A translations xyz"


@pytest.mark.filterwarnings("ignore::somersault._core.errors.SomersaultWarning")
@pytest.mark.parametrize("axes", ["translations yz rotations y", "rotations q", CARRIER])
def test_another_root_stays_on_joints_to_the_ground(axes: str, tmp_path: Path) -> None:
    text = f"version 4 segment A rt 0 0 pi/2 xyz 1 0 0 {axes} mass 1 endsegment"
    model = read(tmp_path, text)
    assert not model.free  # CARRIER: its inertia must not vanish, and so it cannot be dropped
    assert model.bodies[0].joints
    assert model.bodies[0].position == (1, 0, 0)


def test_ranges_left_on_a_segment_without_axes_say_nothing(tmp_path: Path) -> None:
    text = FREE.format("") + "segment B parent A // rotations x\n rangesQ -1 1\n mass 2 endsegment"
    assert read(tmp_path, text).mass == 3


def test_dampings_of_a_free_root_are_dropped_and_said_to_be(tmp_path: Path) -> None:
    model = read(tmp_path, FREE.format("jointdampings 0 0 0 0 1 0\n"))
    assert "the dampings of the root" in model.ignored


def test_the_two_z_of_a_zyz_joint_have_two_names(tmp_path: Path) -> None:
    text = FREE.format("") + "segment B parent A rotations zyz mass 1 endsegment"
    assert [joint.name for joint in read(tmp_path, text).joints] == ["B_RotZ", "B_RotY", "B_RotZ2"]


def test_parents_may_be_called_ground_unless_a_segment_is(tmp_path: Path) -> None:
    text = FREE.replace("mass 1", "parent ground mass 1").format("")
    assert read(tmp_path, text).free
    text = text.replace("segment A", "segment ground rt 0 0 0 xyz 0 0 1 endsegment segment A")
    assert read(tmp_path, text).ignored == ("segment ground, fixed to the ground",)


numbers = st.sampled_from(["2", "0.5", ".25", "3.", "1e2", "2.5e-1", "7"])
sums = st.recursive(
    numbers,
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from(["+", "-", "*", "/"]), inner).map("".join),
        inner.map("({})".format),
        inner.map("(-{})".format),
        inner.map("2*-{}".format),
    ),
    max_leaves=8,
)


@settings(derandomize=True, max_examples=150, deadline=None)
@given(text=sums)
def test_arithmetic_is_that_of_python(text: str, tmp_path_factory: pytest.TempPathFactory) -> None:
    try:
        expected = float(eval(text))
    except ZeroDivisionError:
        return
    variables = f"version 4 variables $x {text} endvariables"
    whole = FREE.replace("version 4", variables).format(f"com {text} $x -$x\n")
    com = read(tmp_path_factory.getbasetemp(), whole).bodies[0].com
    assert com == pytest.approx((expected, expected, -expected))


def test_comments_are_those_of_c(tmp_path: Path) -> None:
    text = "/* a\n// b\n*/ version 4 // c */\n" + FREE[9:].format("/**/ com 1 /* 9 */ 2 3 // 4\n")
    assert read(tmp_path, text).bodies[0].com == (1, 2, 3)


# -------------------------------------------------- what biorbd takes, and so is taken with a note

MADE = """version 4
segment root
 parent base
endsegment
segment T
 parent root
 translations xyz
 rotations xyz
 mass 40
 inertia 3 0 0 0 2.8 0 0 0 0.5
endsegment
"""
LOOSE = """version 4
variables
 $m 2
endvariables
segment P
 translations xyz
 rotations xyz
 mass 10
 inertia 1 0 0 0 1.2 0 0 0 0.3
endsegment
segment A
 parent P
 rotations x
 ranges -3pi 3*pi
        -10 10
 mass $m
 inertia 0.02 0 0 0 0.02 0 0 0 0.002
 com 0 0 -0.2
endsegment
"""


def test_a_root_segment_as_biobuddy_writes_it(tmp_path: Path) -> None:
    model, said = noted(tmp_path, MADE)
    assert (model.free, model.mass, said) == (True, 40.0, [])
    assert [body.name for body in model.bodies] == ["T"]
    np.testing.assert_allclose(model.bodies[0].inertia, np.diag([3, 2.8, 0.5]))
    assert [body.name for body in model.file_coordinates.root] == ["root", "T"]
    root = MADE.replace(" parent base\n", " translations xyz\n rotations xyz\n mass 1\n")
    rest = root.replace(" translations xyz\n rotations xyz\n mass 40", " rotations x\n mass 40")
    assert [body.name for body in read(tmp_path, rest).bodies] == ["root", "T"]


def test_multiples_of_pi_and_ranges_to_spare(tmp_path: Path) -> None:
    model, said = noted(tmp_path, LOOSE)
    assert (model.free, model.mass) == (True, 12.0)
    assert model.joint("A_RotX").limits == (-3.0, pytest.approx(3 * np.pi))  # as in biorbd
    pi = "numbers with pi right behind them, which biorbd drops, as we do; write 3*pi"
    assert said == [
        f"{pi}: -3pi (line 14)",
        "ranges to spare, which count for nothing: A",
    ]


SEGMENT = "version 4\nsegment A\ntranslations xyz\nrotations xyz\n{}\nmass 7\nendsegment\n"
NOTES = {
    "mass 2": "given twice in a segment, of which the last counts: mass of A (line 6)",
    "rangesQ 0 1 0 1 0 1 0 1 2 -2 0 1": "ranges the wrong way round, and so swapped: 2 -2 of A "
    "(line 5)",
    "inertia 3 9 9 1 3 9 1 0 3": "inertias that are not symmetric, of which the lower half counts, "
    "as in biorbd: A",
    "colour 1 2 3": "unknown words, skipped as biorbd skips them: colour (line 5)",
}


@pytest.mark.parametrize("text", NOTES)
def test_what_is_odd_is_read_as_biorbd_reads_it(text: str, tmp_path: Path) -> None:
    model, said = noted(tmp_path, SEGMENT.format(text))
    assert (model.mass, said) == (7.0, [NOTES[text]])
    if text.startswith("inertia"):
        assert model.bodies[0].inertia == ((3, 1, 1), (1, 3, 0), (1, 0, 3))


def test_what_acts_but_is_not_carried_is_named_once(tmp_path: Path) -> None:
    muscle = (
        "\n  muscle m musclegroup g\n fatigueParameters type Xia endfatigueparameters endmuscle\n"
    )
    text = FREE.format("marker in_A parent root endmarker\n") + (
        "segment B parent A rotations x mass 1 inertia_xxyyzz 1 1 1 endsegment\n"
        "musclegroup g OriginParent A InsertionParent B endmusclegroup\n" + muscle * 2
        + "viapoint v parent B endviapoint wrapping w parent B endwrapping\n"
        "ligament l origin A endligament\n"
        "passivetorque B type exponential dof RotX endpassivetorque\n"
        "marker out parent B markerweight 2 endmarker\n"
        "softcontact s type sphere endsoftcontact contact c endcontact\n"
        "loopconstraint predecessor A successor B"
    )  # fmt: skip
    model, said = noted(tmp_path, text)
    assert model.ignored == ("2 markers", "1 soft contact", "1 contact")
    assert said == [
        "blocks that never end, as the file ends: loopconstraint",
        "acting in the file, but left out of flights: 2 muscles, 1 ligament, 1 loop constraint, "
        "1 passive torque",
    ]


def test_passive_torques_that_are_springs_become_springs(tmp_path: Path) -> None:
    text = (
        FREE.format("") + "segment B parent A rotations xy mass 1 inertia_xxyyzz 1 1 1 endsegment\n"
    )
    torque = "passivetorque B type {} dof {} T0 {} slope {} torque {} endpassivetorque\n"
    torques = [
        ("Linear", "RotX", 2, -4, 0), ("linear", "RotX", 1, -2, 0), ("linear", "RotY", 1, 3, 0),
        ("constant", "RotY", 0, 0, 0), ("constant", "RotY", 0, 0, 5), ("linear", "RotZ", 1, -3, 0),
    ]  # fmt: skip
    model, said = noted(tmp_path, text + "".join(torque.format(*t) for t in torques))
    joint = model.joint("B_RotX")
    assert (joint.stiffness, joint.rest) == (6.0, 0.5)
    assert model.joint("B_RotY").stiffness == 0
    assert said == ["acting in the file, but left out of flights: 3 passive torques"]


def test_passive_torques_are_those_of_biorbd(tmp_path: Path) -> None:
    biorbd = pytest.importorskip("biorbd", reason="biorbd, the reference reader, is optional")
    text = FREE.format("") + (
        "segment B parent A rotations x mass 1 inertia_xxyyzz 1 1 1 endsegment\n"
        "passivetorque B type linear dof RotX T0 2 slope -4 endpassivetorque\n"
    )
    joint = read(tmp_path, text).joint("B_RotX")
    theirs = biorbd.Model(str(tmp_path / "model.bioMod"))
    for angle in (-0.7, 0.2, 1.3):
        torque = theirs.passiveJointTorque(np.array([0.0] * 6 + [angle]), np.zeros(7)).to_array()
        assert torque[6] == pytest.approx(-joint.stiffness * (angle - joint.rest))


def test_joints_that_move_no_mass_are_left_out(tmp_path: Path) -> None:
    text = FREE.format("") + "segment B parent A rotations xy endsegment"
    model, said = noted(tmp_path, text)
    assert model.joints == ()
    assert said == ["joints that move no mass, and so left out: B_RotX, B_RotY"]


def test_words_that_end_nothing_and_variables_without_their_sign(tmp_path: Path) -> None:
    text = FREE.replace("version 4", "version 4 variables b 1 $c 3 endvariables").format("")
    model, said = noted(tmp_path, text.replace("mass 1", "mass $c kg") + "endsegment 8\n")
    assert model.mass == 3
    assert said == [
        "unknown words, skipped as biorbd skips them: b (line 1), kg (line 5)",
        "words that end nothing: endsegment (line 7)",
        "numbers between blocks, skipped as biorbd skips them: 8 (line 7)",
    ]


def test_words_before_the_version_and_versions_with_a_point(tmp_path: Path) -> None:
    text = "A model of mine\n" + FREE.format("").replace("version 4", "version 4.1")
    assert read(tmp_path, text).mass == 1


# ------------------------------------------------------------------------------- mistakes

MISTAKES = {
    "": (1, "starts with the word version"),
    "version 5": (1, "none of 1, 2, 3 and 4"),
    "version 4\n\nsegmnt A": (3, "'segmnt' is not a word of the format here; did you mean segment"),
    "version 4\n/* open": (2, "never ends"),
    "version 4\nsegment": (2, "the name of the segment"),
    "version 4\nsegment A\nmass 1\nsegment B": (2, "'A' never ends; add endsegment"),
    "version 4\nsegment ROOT": (2, "cannot be named ROOT"),
    "version 4\nsegment A\nendsegment\nsegment A": (4, "two segments 'A'"),
    "version 4\nsegment A\nparent B": (3, "'B' of 'A' is not a segment above it"),
    "version 4\nsegment A\nmass nan": (3, "'nan' is not a number"),
    "version 4\nsegment A\nmass 1e999": (3, "too large"),
    "version 4\nsegment A\nmass 1/0": (3, "'1/0' is not a number"),
    "version 4\nsegment A\nmass $m": (3, "'$m' is not a variable"),
    "version 4\nsegment A\nmass -1": (3, "negative"),
    "version 4\nsegment A\ncom 1 2\nmass 3": (4, "number 3 of the 3 of the com"),
    "version 4\nsegment A\ncom 1 2 3 4": (3, "'4' is one too many"),
    "version 4\nsegment A\ntranslation xyz": (3, "did you mean translations?"),
    "version 4\nsegment A\ntranslations xx": (3, "an axis twice"),
    "version 4\nsegment A\nrotations zz": (3, "one axis twice"),
    "version 4\nsegment A\ntranslations xy rotations z\nranges 1 2\nendsegment": (
        5,
        "start of range 2 of 'A' (it has 3: 2 for translations, 1 for rotations)",
    ),
    "version 4\nsegment A\nrotations x\nranges 1 2\ntranslations x": (5, "below the ranges"),
    "version 4\nsegment A\nrotations q\njointdampings 1 1 2": (4, "quaternion differ"),
    "version 4\nsegment A\nrotations x\njointdampings -1": (4, "negative"),
    "version 4\nsegment A\nrt 0 0 0 0 0 0": (3, "write xyz"),
    "version 4\nsegment A\nrt 0 0 0 xyz 0 0 0\nrtinmatrix 1": (4, "below its rt"),
    "version 1\nsegment A\nrt 2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1": (3, "not a rotation"),
    "version 1\nsegment A\nrt 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2": (3, "0 0 0 1"),
    "version 4\nvariables\n$a 1\n$a 2": (4, "'$a' is defined twice"),
    "version 4\nvariables\n$a 1\nsegment": (2, "never end"),
    "version 4\nvariables\n$-b 1": (3, "'$-b' is not a variable's name"),
    "version 4\nvariables\n1": (3, "'1' is one too many"),
    "version 4\nmarker M\nposition 0 0 0\nsegment A": (2, "'M' never ends; add endmarker"),
    "segment A\nendsegment\nversion 4": (1, "starts with the word version"),
    "version 4\nsegment A\ninertia 1 0 0 0 1 0 0 0 1\ninertia_xxyyzz 1 1 1": (4, "xxyyzz twice"),
    "version 4\nsegment A\nrotations x\nranges 1 2\nranges 1 2": (5, "ranges twice"),
    "version 4\nsegment A\nrotations x y z": (
        3,
        "are written as one word, of which biorbd would read",
    ),
    "version 4\nsegment A\ntranslations x y": (3, "write xy"),
    "version 4\nsegment A\nmass pi3": (3, "'pi3' is not a number"),
    "version 4\nsegment A\nmass 1,5": (3, "'1,5' is not a number"),
    "version 4\nsegment A\nmuscle m\nsegment B": (3, "'m' never ends; add endmuscle"),
    "version 4\nsegment P\nendsegment\nsegment A\nmarker m\nparent P\nendmarker endsegment": (
        5,
        "the marker 'm' stands within segment 'A'",
    ),
    "version 4\nsegment A\nmarker m\nparent A\nendmarker endsegment": (
        3,
        "would take to be 'A' because of it",
    ),
}


@pytest.mark.parametrize("text", MISTAKES)
def test_a_mistake_is_named_with_its_line(text: str, tmp_path: Path) -> None:
    line, words = MISTAKES[text]
    with pytest.raises(SomersaultError, match=re.escape(words)) as caught:
        read(tmp_path, text)
    assert str(caught.value).startswith(f"model.bioMod, line {line}: ")


def test_a_segment_may_be_called_root_in_other_letters(tmp_path: Path) -> None:
    text = FREE.replace("segment A", "segment Root").format("")
    model = read(tmp_path, text + "segment B parent Root rotations x mass 1 endsegment")
    assert model.free
    assert [(body.name, body.parent) for body in model.bodies] == [("Root", -1), ("B", 0)]
    assert read(tmp_path, FREE.format("parent Root ")).free  # where no segment is, the ground


def test_a_root_that_only_turns_is_told_what_it_lacks(tmp_path: Path) -> None:
    model = read(tmp_path, FREE.replace("translations xyz\n", "").format("inertia_xxyyzz 1 1 1 "))
    for call in (
        lambda: so.load(model, axes=(1, 2, 3)),
        lambda: so.fly(model, so.Takeoff(), 1.0),
        lambda: so.spin(model),
    ):
        with pytest.raises(SomersaultError, match='base = "free"'):
            call()


def test_files_that_are_no_text(tmp_path: Path) -> None:
    with pytest.raises(SomersaultError, match="line 2: is not UTF-8"):
        read(tmp_path, b"version 4\n\xff\xfe")
    with pytest.raises(SomersaultError, match="larger than 50 MB"):
        read(tmp_path, b" " * 50_000_001)
    with pytest.raises(SomersaultError, match="cannot be read"):
        read_biomod(tmp_path / "nothing.bioMod")
    with pytest.raises(SomersaultError, match="cannot be read"):
        read_biomod(tmp_path)
    with pytest.raises(SomersaultError, match="cannot be read"):
        read_biomod(Path("a\0b"))


def test_models_that_cannot_fly(tmp_path: Path) -> None:
    with pytest.raises(SomersaultError, match="nothing can fly"):
        read(tmp_path, "version 4 segment A mass 1 endsegment")
    with pytest.raises(SomersaultError, match="'B' is a mirror image"):
        read(
            tmp_path,
            FREE.format("") + "segment B parent A rtinmatrix 1 rt 1 0 0 0 0 1 0 0 0 0 -1 0 0 0 0 1"
            " rotations x mass 1 endsegment",
        )
    for moves in ("rotations x", ""):
        with pytest.raises(SomersaultError, match="'B' names no parent, and so stands"):
            read(tmp_path, FREE.format("") + f"segment B {moves} mass 1 endsegment")
    with pytest.raises(SomersaultError, match="not part of the free body"):
        read(tmp_path, FREE.format("") + "segment B parent root rotations x mass 1 endsegment")


SCRAPS = ["1e400", "nan", "-", "(((", "$x", "/*", "//", "xyz", "q", "\0", "é", "1e15", "endsegment"]
words = st.sampled_from([*SCRAPS, *re.findall(r"\S+", DIVER)])


@settings(derandomize=True, max_examples=400, deadline=None)
@given(
    changes=st.lists(st.tuples(st.integers(0, len(DIVER)), st.integers(0, 30), words), max_size=4)
)
def test_no_damage_to_a_file_escapes_as_another_error(
    changes: list[tuple[int, int, str]], tmp_path_factory: pytest.TempPathFactory
) -> None:
    text = DIVER
    for start, length, word in changes:
        text = text[:start] + word + text[start + length :]
    with contextlib.suppress(SomersaultError):
        assert np.isfinite(noted(tmp_path_factory.getbasetemp(), text)[0].mass)


@settings(derandomize=True, max_examples=200, deadline=None)
@given(data=st.one_of(st.binary(), st.text(string.printable).map(str.encode)), header=st.booleans())
def test_no_garbage_escapes_as_another_error(
    data: bytes, header: bool, tmp_path_factory: pytest.TempPathFactory
) -> None:
    with pytest.raises(SomersaultError):
        read(tmp_path_factory.getbasetemp(), b"version 4\nsegment " * header + data)
