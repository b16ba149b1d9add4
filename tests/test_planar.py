"""Models that move in a plane: what they are, and which files describe one."""

from __future__ import annotations

import json
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from osims import Bone, Hinge, version_3, version_4
from planes import AXES, random_chain, turn
from robots import ARM, HUB, joint, link, robot

import somersault as so
from somersault import cli
from somersault.model import Body, Joint, Model, as_matrix, model_digest, plain_form

NONE = (0.0, 0.0, 0.0)


def read(path: Path, text: str, **how: Any) -> Model:
    path.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", so.SomersaultWarning)
        return so.load(path, **how)


def mjcf(joints: str, more: str = "", body: str = "") -> str:
    arm = (
        '<body name="arm" pos="0 0 -0.4"><joint name="elbow" axis="0 1 0"/>'
        '<geom size="0.1" pos="0 0 -0.2"/></body>'
    )
    return (
        f'<mujoco><worldbody><body name="hub" {body}>{joints}<geom size="0.2"/>{arm}</body>{more}'
        "</worldbody></mujoco>"
    )


def slide(axis: str, more: str = "") -> str:
    return f'<joint type="slide" axis="{axis}" {more}/>'


def hinge(axis: str, more: str = "") -> str:
    return f'<joint type="hinge" axis="{axis}" {more}/>'


WALKER = slide("1 0 0") + slide("0 0 1") + hinge("0 1 0")


# ------------------------------------------------------------------------------------- values


def test_a_planar_model_is_free_and_somersaults_about_the_normal() -> None:
    model = so.load("gymnast", base="planar")
    assert (model.free, model.plane, model.axes) == (True, 2, (2, 1, 3))
    assert model.base_ways == (1, 3, 5)
    assert "free in the plane across axis 2" in repr(model)
    space = so.load("gymnast")
    assert (space.plane, space.base_ways) == (None, (0, 1, 2, 3, 4, 5))
    assert so.load("gymnast", base="fixed").base_ways == ()


def test_the_plane_is_part_of_what_decides_results() -> None:
    space, planar = so.load("gymnast"), so.load("gymnast", base="planar")
    assert space != planar
    assert hash(space) != hash(planar)
    assert model_digest(space) != model_digest(planar)
    assert "plane" not in plain_form(space)  # so that digests stay what they were
    assert plain_form(planar)["plane"] == 2


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"plane": 1}, "somersaults about that and not about axis 2; give axes that begin with 1"),
        ({"plane": 4}, "give the base's axis across it, 1, 2 or 3"),
        ({"plane": True}, "give the base's axis across it, 1, 2 or 3"),
        ({"plane": (0.0, 1.0, 0.0)}, "give the base's axis across it, 1, 2 or 3"),
    ],
)
def test_planes_that_are_none_are_refused(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(so.SomersaultError, match=words):
        replace(so.load("gymnast"), **changes)


def test_a_fixed_base_has_no_plane() -> None:
    fixed = so.load("gymnast", base="fixed")
    with pytest.raises(so.SomersaultError, match="fixed base, so it moves in no plane"):
        replace(fixed, plane=2)


def test_axes_must_begin_with_the_normal() -> None:
    planar = so.load("gymnast", base="planar")
    assert so.load(planar, axes=(2, 3, 1)).axes == (2, 3, 1)
    with pytest.raises(so.SomersaultError, match="about that and not about axis 1"):
        so.load(planar, axes=(1, 2, 3))
    assert so.load("gymnast", axes=(1, 2, 3), base="planar").plane == 1
    assert so.load(so.load("gymnast", axes=(3, 1, 2)), base="planar").plane == 3


def test_any_base_is_made_of_a_planar_model() -> None:
    planar = so.load("gymnast", base="planar")
    assert so.load(planar, base="planar") is planar
    assert so.load(planar, base="free") == so.load("gymnast")
    assert so.load(planar, base="fixed") == so.load("gymnast", base="fixed")


# ------------------------------------------------------------------------------------ formats


@pytest.mark.parametrize("plane", [1, 2, 3])
@pytest.mark.parametrize("order", ["translations first", "backwards"])
def test_biomod_roots_in_any_plane(plane: int, order: str, tmp_path: Path) -> None:
    across = "xyz"[plane - 1]
    along = "xyz".replace(across, "")[:: 1 if order == "translations first" else -1]
    text = (
        f"version 4\nsegment Pelvis\ntranslations {along}\nrotations {across}\nmass 10\n"
        "inertia 0.1 0 0 0 0.1 0 0 0 0.1\ncom 0 0 0.1\nendsegment\n"
        f"segment Leg\nparent Pelvis\nrotations {across}\nmass 5\ncom 0.1 0 0\n"
        "inertia 0.05 0 0 0 0.05 0 0 0 0.05\nendsegment\n"
    )
    model = read(tmp_path / "biped.bioMod", text)
    assert (model.free, model.plane, model.axes) == (True, plane, AXES[plane])
    assert [body.name for body in model.bodies] == ["Pelvis", "Leg"]
    assert model.coordinates == (f"Leg_Rot{across.upper()}",)
    assert len(model.file_coordinates.root) == 1
    space = read(tmp_path / "biped.bioMod", text, base="free")
    assert (space.free, space.plane, space.axes) == (True, None, AXES[plane])
    assert space.bodies == model.bodies
    fixed = read(tmp_path / "biped.bioMod", text, base="fixed")
    assert (fixed.free, len(fixed.joints)) == (False, 4)


def test_mjcf_walkers_and_carriers(tmp_path: Path) -> None:
    file = tmp_path / "walker.xml"
    walker = read(file, mjcf(WALKER))
    assert (walker.plane, walker.coordinates, walker.bodies[0].name) == (2, ("elbow",), "hub")
    damped = read(file, mjcf(WALKER.replace('axis="0 1 0"', 'axis="0 1 0" damping="0.1"')))
    assert damped.bodies == walker.bodies
    assert "the dampings of the root" in damped.ignored
    first = read(file, mjcf(hinge("0 -1 0") + slide("0 0 1") + slide("1 0 1")))
    assert first.bodies == walker.bodies
    fixed = read(file, mjcf(WALKER), base="fixed")
    assert len(fixed.joints) == 4
    assert so.load(fixed, base="planar") == walker.renamed("walker")


@pytest.mark.parametrize(
    ("joints", "why"),
    [
        (slide("1 0 0") + slide("0 1 0") + hinge("0 1 0"), "the hinge lies in the plane"),
        (slide("1 0 0") + slide("1 0 0.0001") + hinge("0 1 0"), "the slides are one"),
        (slide("1 0 0") + slide("0 0.01 1") + hinge("0 1 0"), "a slide leaves the plane"),
        (slide("1 0 0") + slide("0 0 1"), "it cannot turn"),
        (WALKER + hinge("1 0 0"), "it turns out of the plane"),
        (slide("1 0 0", 'stiffness="3"') + slide("0 0 1") + hinge("0 1 0"), "a spring holds it"),
        (slide("1 0 0") + slide("0 0 1") + hinge("0 1 0", 'armature="1"'), "a rotor holds it"),
        (slide("1 0 1") + slide("-1 1 1") + hinge("-1 -2 1"), "the plane is oblique to the base"),
    ],
)
def test_other_joints_to_the_ground_stay(joints: str, why: str, tmp_path: Path) -> None:
    model = read(tmp_path / "walker.xml", mjcf(joints))
    assert not model.free, why


def test_another_body_on_the_ground_leaves_the_first_on_its_joints(tmp_path: Path) -> None:
    ball = '<body name="ball"><joint name="rolls" type="slide"/><geom size="0.1"/></body>'
    model = read(tmp_path / "two.xml", mjcf(WALKER, ball))
    assert (model.free, len(model.joints)) == (False, 5)


def test_urdf_planar_joints_and_virtual_ones(tmp_path: Path) -> None:
    arm = joint("elbow", "hub", "arm", "0 1 0")
    file = tmp_path / "robot.urdf"
    planar = read(
        file, robot(link("world"), HUB, ARM, arm, joint("base", "world", "hub", "0 1 0", "planar"))
    )
    assert (planar.plane, planar.coordinates) == (2, ("elbow",))
    virtual = robot(
        link("world"), link("one"), link("two"), HUB, ARM, arm,
        joint("x", "world", "one", "1 0 0", "prismatic"),
        joint("z", "one", "two", "0 0 1", "prismatic"),
        joint("turn", "two", "hub", "0 1 0"),
    )  # fmt: skip
    chain = read(file, virtual)
    assert (chain.plane, chain.bodies) == (2, planar.bodies)
    held = read(file, virtual, base="fixed")
    assert held.coordinates == ("x", "z", "turn", "elbow")


def test_two_slides_and_a_hinge_that_go_on_to_six_are_free_in_space(tmp_path: Path) -> None:
    text = robot(
        link("world"), *(link(f"l{k}") for k in range(5)), HUB,
        joint("x", "world", "l0", "1 0 0", "prismatic"),
        joint("y", "l0", "l1", "0 1 0", "prismatic"), joint("c", "l1", "l2", "0 0 1"),
        joint("z", "l2", "l3", "0 0 1", "prismatic"), joint("b", "l3", "l4", "0 1 0"),
        joint("a", "l4", "hub", "1 0 0"),
    )  # fmt: skip
    model = read(tmp_path / "robot.urdf", text)
    assert (model.free, model.plane, len(model.bodies), model.joints) == (True, None, 1, ())


@pytest.mark.parametrize("version", [version_3, version_4])
def test_osim_planar_joint_to_the_ground(version: Any, tmp_path: Path) -> None:
    bones = [Bone("pelvis", 10.0), Bone("thigh", 5.0, (0, -0.2, 0))]
    hinges = [
        Hinge(
            "PlanarJoint", "ground_pelvis", "ground", "pelvis",
            {"pelvis_tilt": "", "pelvis_tx": "", "pelvis_ty": ""},
        ),
        Hinge("PinJoint", "hip", "pelvis", "thigh", {"hip_flexion": ""}),
    ]  # fmt: skip
    model = read(tmp_path / "gait.osim", version(bones, hinges))
    assert (model.plane, model.axes, model.coordinates) == (3, (3, 1, 2), ("hip_flexion",))
    names = [joint.name for body in model.file_coordinates.root for joint in body.joints]
    assert sorted(names) == ["pelvis_tilt", "pelvis_tx", "pelvis_ty"]


@pytest.mark.parametrize("plane", [1, 2, 3])
def test_mjcf_written_is_the_same_planar_model(plane: int, tmp_path: Path) -> None:
    model = random_chain(np.random.default_rng(plane), plane)
    so.write_mjcf(model, tmp_path / "chain.xml")
    again = so.load(tmp_path / "chain.xml")
    assert (again.plane, again.axes) == (plane, AXES[plane])
    assert [body.name for body in again.bodies] == [body.name for body in model.bodies]
    for one, other in zip(model.bodies, again.bodies, strict=True):
        np.testing.assert_allclose(one.inertia, other.inertia, rtol=0, atol=1e-12)


def test_a_recording_of_a_planar_root_says_where_the_base_was(tmp_path: Path) -> None:
    text = (
        "version 4\nsegment P\nrt 0 0 0 xyz 0 0 1\ntranslations yz\nrotations x\nmass 10\n"
        "com 0 0 0\ninertia 1 0 0 0 0 0 0 0 0\nendsegment\nsegment L\nparent P\nrotations x\n"
        "mass 5\ncom 0 0 -0.3\ninertia 1 0 0 0 0 0 0 0 0\nendsegment\n"
    )
    model = read(tmp_path / "biped.bioMod", text)
    times = np.linspace(0, 1, 11)
    columns = {"P_TransY": 0.5 * times, "P_TransZ": times**2, "P_RotX": 2 * times, "L_RotX": times}
    rows = np.column_stack([times, *columns.values()])
    header = ",".join(["time", *columns])
    np.savetxt(tmp_path / "a.csv", rows, delimiter=",", header=header, comments="")
    motion = so.read_motion(tmp_path / "a.csv", model, cutoff=None)
    assert motion.base is not None
    np.testing.assert_allclose(motion.base.angles, np.outer(2 * times, [1, 0, 0]), atol=1e-12)
    wanted = np.column_stack([0 * times, 0.5 * times, 1 + times**2])
    np.testing.assert_allclose(motion.base.positions, wanted, atol=1e-12)


# ----------------------------------------------------------------------------------- inertias


def flat(plane: int = 1, **ball: Any) -> Model:
    """Two bodies whose inertias are known about the normal alone; the second turned in its
    drawing, and perhaps on a ball."""
    normal = np.eye(3)[plane - 1]
    inertia = as_matrix(0.1 * np.outer(normal, normal))
    kind = {"kind": "hinge", "axis": tuple(normal.tolist()), **ball}
    upper = Body("upper", -1, 2.0, NONE, inertia)
    lower = Body(
        "lower", 0, 1.0, (0.1, 0.1, 0.1), inertia, rotation=as_matrix(turn(plane, 0.7)),
        joints=(Joint("hip", **kind),),
    )  # fmt: skip
    return Model("flat", True, (upper, lower), axes=AXES[plane], plane=plane)


@pytest.mark.parametrize("plane", [1, 2, 3])
def test_inertias_known_about_the_normal_alone_are_enough_in_a_plane(plane: int) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model = so.load(flat(plane))
    assert so.fly(model, so.Takeoff(spin=3.0), 0.5).momentum_drift < 1e-12


def test_what_can_turn_out_of_the_plane_needs_an_inertia_of_its_own() -> None:
    with pytest.warns(so.SomersaultWarning, match=r"as these have: lower \("):
        flat(kind="ball")
    with pytest.warns(so.SomersaultWarning, match=r"as these have: lower \("):
        flat(axis=(0.0, 1.0, 0.0))


def test_in_space_they_are_not_enough() -> None:
    with pytest.warns(so.SomersaultWarning, match="as these have: upper .*, lower"):
        so.load(flat(), base="free")
    one = replace(flat(), bodies=flat().bodies[:1])
    with (
        pytest.warns(so.SomersaultWarning),
        pytest.raises(so.SomersaultError, match="turning its base moves no mass"),
    ):
        so.load(one, base="free")


def test_without_inertia_about_the_normal_nothing_turns() -> None:
    inertia = ((0.0, 0.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 0.1))
    rod = Model("rod", True, (Body("rod", -1, 1.0, NONE, inertia),), axes=(1, 2, 3), plane=1)
    with pytest.raises(so.SomersaultError, match="turning its base moves no mass"):
        so.load(rod)


# ---------------------------------------------------------------------------------- the shell


def test_models_says_in_which_plane(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "walker.xml").write_text(mjcf(WALKER))
    cli.main(["models", str(tmp_path / "walker.xml")])
    assert "free in the plane across its axis 2" in capsys.readouterr().out
    cli.main(["models", str(tmp_path / "walker.xml"), "--json"])
    (record,) = json.loads(capsys.readouterr().out)
    assert (record["free"], record["plane"]) == (True, 2)
