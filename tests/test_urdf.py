"""Small URDF files, each of one kind that people write, and the right values beside them.

Right values are pinocchio's, or by closed form, or by construction, as noted.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from robots import ARM, BOX, HUB, LIMIT, MESH, Numbers, joint, link, read, robot

import somersault as so
from somersault import SomersaultError, SomersaultWarning
from somersault.model import Follow, Model, load, pose
from somersault.model._mass import mass_matrix


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def refused(text: str | bytes, name: str = "robot.urdf", **how: Any) -> str:
    with pytest.raises(SomersaultError) as caught:
        read(text, name, **how)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def said(text: str, name: str = "robot.urdf") -> str:
    """All that is said of a file that is read."""
    Path(name).write_text(text)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        load(name)
    assert all(issubclass(w.category, SomersaultWarning) for w in caught)
    return "\n".join(str(w.message) for w in caught)


def principal(model: Model) -> np.ndarray:
    """Diagonal of the composite inertia in the pose it is drawn in."""
    return np.diag(so.Equations(model).inertia(model.home))


# ------------------------------------------------------------------------------ right values

RIGHT: dict[str, tuple[tuple[str, ...], float, Numbers]] = {
    "a mesh that is nowhere": (
        (link("hub", 5, (0.05, 0.09, 0.1), more=MESH.format("collision") + MESH.format("visual")),),
        5.0, (0.05, 0.09, 0.1),
    ),
    # pinocchio: a link without <inertial> has no mass, whatever it looks like
    "a camera without inertial": (
        (
            HUB,
            link("arm", 1, (0.01, 0.01, 0.001), com="0 0 0.2"),
            link("cam", more=BOX),
            joint("pan", "hub", "arm", at="0.3 0 0.1"),
            joint("mount", "arm", "cam", at="0 0 0.4", kind="fixed"),
        ),
        6.0, (0.135, 0.25, 0.176),
    ),
    # a flat plate: Ixx = Iyy + Izz up to rounding
    "a plate": ((link("hub", 0.3, (0.0025, 0.00225, 0.00025)),), 0.3, (0.0025, 0.00225, 0.00025)),
    "a rod on a hinge": (
        (HUB, link("tip", 0.1, (0.0003, 0, 0.0003), com="0 0.3 0"), joint("boom", "hub", "tip")),
        5.1, (0.059124, 0.09, 0.109124),
    ),
    # by the parallel axes: 5 · 0.1 / 5.1 · 0.3² about x and z
    "a point on a hinge": (
        (HUB, link("tip", 0.1, com="0 0.3 0"), joint("boom", "hub", "tip")),
        5.1, (0.058824, 0.09, 0.108824),
    ),
    "a cardan joint": (
        (
            HUB,
            link("cross"),
            ARM,
            joint("roll", "hub", "cross"),
            joint("pitch", "cross", "arm", "0 1 0"),
        ),
        6.0, (0.103333, 0.153333, 0.14),
    ),
    "a floating joint under a frame": (
        (link("map"), HUB, joint("base", "map", "hub", kind="floating")), 5.0, (0.05, 0.09, 0.1),
    ),
    "a floating joint under the world": (
        (
            link("world"),
            link("map", 3),
            HUB,
            joint("here", "world", "map", kind="fixed"),
            joint("base", "map", "hub", kind="floating"),
        ),
        5.0, (0.05, 0.09, 0.1),
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", RIGHT)
def test_right_values(what: str) -> None:
    parts, mass, inertia = RIGHT[what]
    model = read(robot(*parts))
    assert model.free
    assert model.mass == pytest.approx(mass)
    np.testing.assert_allclose(principal(model), inertia, atol=1e-6)


def test_a_robot_called_xml_is_a_robot_all_the_same() -> None:
    text = robot(HUB, ARM, joint("hinge", "hub", "arm"))
    assert read("\n <?xml version='1.0'?><!-- <mujoco> -->" + text, "robot.xml").mass == 6
    mjcf = '<mujoco><worldbody><body><freejoint/><geom size="1"/></body></worldbody></mujoco>'
    assert read(mjcf, "thing.urdf").bodies[0].inertia_from == "shapes"


def test_frames_limits_damping_and_names() -> None:
    model = read(
        robot(
            HUB,
            link("arm", 1, (0.02, 0.03, 0.04), com="0 0 -0.2", rpy=f"0 0 {np.pi / 2}"),
            joint(
                "hinge", "hub", "arm", "0 0 2", "revolute", at="1 2 3", rpy=f"0 {np.pi / 2} 0",
                more=LIMIT.format(-1, 2) + '<dynamics damping="0.7"/>',
            ),
        )
    )  # fmt: skip
    hub, arm = model.bodies
    assert (hub.name, arm.name, arm.position) == ("hub", "arm", (1, 2, 3))
    np.testing.assert_allclose(arm.rotation, [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], atol=1e-15)
    np.testing.assert_allclose(arm.inertia, np.diag([0.03, 0.02, 0.04]), atol=1e-15)
    assert arm.com == (0, 0, -0.2)
    (hinge,) = model.joints
    assert hinge == so.Joint("hinge", "hinge", (0, 0, 1), limits=(-1, 2), damping=0.7)


def test_a_planar_joint_moves_across_its_axis_and_about_it() -> None:
    text = robot(link("world"), HUB, joint("base", "world", "hub", "0 0 1", "planar"))
    model = read(text, base="fixed")
    assert [(j.name, j.kind, j.axis) for j in model.joints] == [
        ("base_1", "slide", (1, 0, 0)),
        ("base_2", "slide", (0, 1, 0)),
        ("base_turn", "hinge", (0, 0, 1)),
    ]
    np.testing.assert_allclose(mass_matrix(model, model.home), np.diag([5, 5, 0.1]), atol=1e-12)


def test_a_floating_joint_further_out_is_three_slides_and_a_ball() -> None:
    text = robot(HUB, link("case", 2, (1, 1, 1)), ARM, joint("lid", "hub", "case"),
                 joint("loose", "case", "arm", kind="floating"))  # fmt: skip
    model = read(text)
    kinds = [joint.kind for joint in model.joints]
    assert kinds == ["hinge", "slide", "slide", "slide", "ball"]


def test_a_knee_drawn_outside_its_range_stands_alike_in_flight_and_spin() -> None:
    knee = joint("knee", "hub", "shank", "0 1 0", "revolute", more=LIMIT.format(-2.7, -0.9))
    model = read(robot(HUB, link("shank", 0.2, (1e-3, 1e-3, 1e-4), com="0 0 -0.1"), knee))
    assert so.spin(model).pose.tolist() == [-0.9]
    assert so.fly(model, so.Takeoff(spin=5.0), 0.1).joint_coordinates[-1, 0] == pytest.approx(-0.9)


# ------------------------------------------------------------------------------------ mimic

FINGERS = (HUB, link("f1", 0.1, (1, 1, 1)), link("f2", 0.1, (1, 1, 1)), link("f3", 0.1, (1, 1, 1)))


def mimic(leader: str, more: str = "") -> str:
    return f'<mimic joint="{leader}" {more}/>'


def test_mimic_follows_its_leader_through_others() -> None:
    model = read(
        robot(
            *FINGERS,
            joint("j1", "hub", "f1"),
            joint("j2", "hub", "f2", more=mimic("j1", 'multiplier="-1" offset="0.5"')),
            joint("j3", "f2", "f3", more=mimic("j2", 'multiplier="2" offset="0.1"')),
        )
    )
    assert [joint.follows for joint in model.joints] == [
        None,
        Follow("j1", -1.0, 0.5),
        Follow("j1", -2.0, 1.1),
    ]
    assert model.home.tolist() == pytest.approx([0.0, 0.5, 1.1])


def test_a_pose_has_followers_where_their_leader_has_them() -> None:
    model = read(
        robot(
            *FINGERS[:3],
            joint("j1", "hub", "f1"),
            joint("j2", "hub", "f2", more=mimic("j1", 'multiplier="-1" offset="0.5"')),
        )
    )
    np.testing.assert_allclose(pose(model, {"j1": [0.2, 0.3]}), [[0.2, 0.3], [0.3, 0.2]])
    np.testing.assert_allclose(pose(model, {"j1": 0.2, "j2": 0.3}), [0.2, 0.3])
    with pytest.raises(SomersaultError, match=r"j2=0\.1, but in robot it follows j1.* 0\.3"):
        pose(model, {"j1": 0.2, "j2": 0.1})


def test_mimic_of_a_fixed_joint_stands_at_its_offset() -> None:
    model = read(
        robot(
            *FINGERS[:3],
            joint("j1", "hub", "f1", kind="fixed"),
            joint("j2", "hub", "f2", at="0 1 0", more=mimic("j1", 'offset="0.5"')),
        )
    )
    assert model.joints == ()
    assert model.mass == pytest.approx(5.2)


@pytest.mark.parametrize(
    ("leader", "words"),
    [("nobody", ("'j2'", "'nobody'", "no joint")), ("j2", ("'j2'", "itself"))],
)
def test_mimic_of_nobody_is_refused_by_name(leader: str, words: tuple[str, ...]) -> None:
    message = refused(robot(*FINGERS[:2], joint("j2", "hub", "f1", more=mimic(leader))))
    assert all(word in message for word in words)


def test_a_leader_that_moves_nothing_itself_stays() -> None:
    model = read(
        robot(
            HUB, link("knob"), link("f2", 0.1, (1, 1, 1)), joint("j1", "hub", "knob"),
            joint("j2", "hub", "f2", more=mimic("j1")),
        )
    )  # fmt: skip
    assert [joint.name for joint in model.joints] == ["j1", "j2"]


# -------------------------------------------------------------------------- free or on the ground


def test_the_root_is_free_unless_it_is_the_world_or_a_mere_frame() -> None:
    arm = (ARM, joint("hinge", "{}", "arm"))
    for name, root, free in [
        ("hub", HUB, True), ("world", link("world"), False), ("map", link("map"), False),
        ("world", link("world", 5, (1, 1, 1)), False),
    ]:  # fmt: skip
        model = read(robot(root, arm[0], arm[1].format(name)))
        assert model.free == free, name
        assert [joint.name for joint in model.joints] == ["hinge"]


def test_base_decides_otherwise() -> None:
    free = robot(HUB, ARM, joint("hinge", "hub", "arm"))
    held = read(free, base="fixed")
    assert (held.free, held.mass, [b.name for b in held.bodies]) == (False, 1, ["arm"])
    assert read(free, base="free") == read(free)
    fixed = robot(link("world"), HUB, ARM, joint("stand", "world", "hub", kind="fixed", at="0 0 1"),
                  joint("hinge", "hub", "arm"))  # fmt: skip
    model = read(fixed, base="free")
    assert (model.free, model.mass) == (True, 6)
    assert not read(fixed).free
    np.testing.assert_allclose(principal(model), principal(read(free)), atol=1e-12)
    arm = robot(link("world"), ARM, joint("hinge", "world", "arm"))
    let_go = read(arm, base="free")
    assert (let_go.free, let_go.mass, let_go.joints) == (True, 1, ())
    assert '"free"' in refused(robot(link("world"), HUB, joint("j", "world", "hub", kind="fixed")))
    assert "base" in refused(free, base="loose")


# ------------------------------------------------------------------- what is read with a warning

STRANGE = {
    "not understood.*<axs> in joint 'hinge'.*did you mean axis": LIMIT.format(-1, 1)
    + "<axs xyz='0 0 1'/>",
    "not understood.*lowr of <limit> in joint 'hinge'.*did you mean lower": (
        '<limit lowr="-1" upper="1"/>'
    ),
    "wrong way round.*joint 'hinge'": LIMIT.format(1, -1),
    "say no limits have none.*joint 'hinge'": '<limit effort="1" velocity="1"/>',
    "dry friction is left out: hinge": LIMIT.format(-1, 1) + '<dynamics friction="0.1"/>',
    "the first counts: joint 'hinge'": LIMIT.format(-1, 1) + LIMIT.format(-2, 2),
    r"nearer end.*hinge \(-0.9\)": LIMIT.format(-2.7, -0.9),
}


@pytest.mark.parametrize("what", STRANGE)
def test_what_is_strange_is_said(what: str) -> None:
    text = robot(HUB, ARM, joint("hinge", "hub", "arm", kind="revolute", more=STRANGE[what]))
    Path("robot.urdf").write_text(text)
    with pytest.warns(SomersaultWarning, match=what):
        model = load("robot.urdf")
    (hinge,) = model.joints
    assert hinge.axis == (1, 0, 0)
    if "wrong way" in what:
        assert hinge.limits == (-1, 1)
    if "lowr" in what:
        assert hinge.limits == (0, 1)  # as urdfdom has it


def test_what_has_no_part_in_flight_is_counted_and_nothing_else_is_said() -> None:
    more = MESH.format("collision") + BOX + BOX.replace("collision", "visual")
    rest = "<gazebo/><transmission name='t'/><material name='m'/>" + joint(
        "hinge", "hub", "arm", more="<safety_controller k_velocity='1'/><calibration rising='0'/>"
    )
    text = robot(link("hub", 5, (0.05, 0.09, 0.1), more=more), ARM, rest)
    assert said(text) == (
        "robot.urdf: left out, as they have no part in flight: 1 gazebo element, 1 transmission, "
        "2 collision shapes"
    )
    assert said(robot(HUB, ARM, joint("hinge", "hub", "arm"))) == ""


def test_a_joint_that_moves_nothing_is_left_out_by_name() -> None:
    text = robot(HUB, link("flag"), link("tip"), joint("wave", "hub", "flag"),
                 joint("stay", "flag", "tip", kind="fixed"))  # fmt: skip
    assert "move no mass are left out: wave" in said(text)
    assert read(text).joints == ()


def test_what_no_rigid_body_has_is_flown_with_a_warning() -> None:
    text = robot(HUB, link("shank", 1, (0.1, 0.1, 0.25)), joint("knee", "hub", "shank"))
    assert "shank (1.25 times)" in said(text)
    assert "'knee'" in refused(
        robot(HUB, link("shank", 1, (-0.1, 0.1, 0.1)), joint("knee", "hub", "shank"))
    )


# ---------------------------------------------------------------------------------- refusals

REFUSED = {
    "two links named 'hub'": robot(HUB, HUB),
    "two joints named 'hinge'": robot(
        HUB, ARM, link("leg", 1), joint("hinge", "hub", "arm"), joint("hinge", "hub", "leg")
    ),
    "child of two joints, 'a' and 'b'": robot(
        HUB, ARM, joint("a", "hub", "arm"), joint("b", "hub", "arm")
    ),
    "'hub' and 'arm'": robot(HUB, ARM),
    "loop": robot(HUB, ARM, joint("a", "hub", "arm"), joint("b", "arm", "hub")),
    "'leg' and those it hangs from form a loop": robot(
        HUB, link("leg", 1), link("foot", 1), joint("a", "leg", "foot"), joint("b", "foot", "leg")
    ),
    "'nobody', which is no link": robot(HUB, joint("a", "hub", "nobody")),
    "'ball'": robot(HUB, ARM, joint("a", "hub", "arm", kind="ball")),
    "two floating joints": robot(
        link("map"), HUB, ARM, joint("a", "map", "hub", kind="floating"),
        joint("b", "map", "arm", kind="floating"),
    ),
    "axis of no length": robot(HUB, ARM, joint("a", "hub", "arm", "0 0 0")),
    "xyz of the <axis> of joint 'a' must be 3": robot(HUB, ARM, joint("a", "hub", "arm", "0 1")),
    "'0, 0, 1'": robot(HUB, ARM, joint("a", "hub", "arm", "0, 0, 1")),
    "value of the <mass> of link 'hub'": robot(link("hub", float("nan"))),
    "'1_0'": robot(HUB).replace('value="5"', 'value="1_0"'),
    "has no <mass>": robot(HUB).replace('<mass value="5"/>', ""),
    "has no ixx": robot(HUB).replace("ixx", "xx"),
    "has no name": robot(HUB).replace('link name="hub"', "link"),
    "has no links": '<robot name="robot"/>',
    "xacro": "<robot xmlns:xacro='x'><xacro:include filename='a'/></robot>",
    "has no mass: no link": robot(link("hub"), link("arm"), joint("a", "hub", "arm")),
    "negative damping": robot(
        HUB, ARM, joint("a", "hub", "arm", more='<dynamics damping="-1"/>')
    ),
    "negative mass": robot(link("hub", -1), ARM, joint("a", "hub", "arm")),
    "line 3": "<robot>\n\n<link name='a'></robot>",
    "entity 'a'": '<!DOCTYPE r [<!ENTITY a "b">]>' + robot(HUB),
    "more than 100 levels": robot(HUB, "<a>" * 200 + "</a>" * 200),
    "links, more than": robot(*(link(f"l{n}") for n in range(2500))),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_refused_by_name(what: str) -> None:
    message = refused(REFUSED[what])
    assert what in message
    assert message.startswith("robot")


def test_an_entity_bomb_is_refused_at_once() -> None:
    lines = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10}">' for n in range(1, 12))
    bomb = f'<!DOCTYPE r [<!ENTITY e0 "ha">{lines}]><robot name="&e11;"/>'
    assert "entity 'e0'" in refused(bomb)
    outside = '<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot name="&x;"/>'
    assert "entity 'x'" in refused(outside)
    assert read('<!DOCTYPE robot SYSTEM "http://example.com/r.dtd">' + robot(HUB)).mass == 5


def test_what_tinyxml_forgives_is_forgiven() -> None:
    """pinocchio reads all of these."""
    text = robot("<!-- a -- b -->", HUB, '<material name="a&b"/>')
    foreign = robot(HUB.replace("hub", "h\xfcb"))
    for written in (
        text,
        "\n\n<?xml version='1.0'?>" + text,
        "\ufeff" + text,
        robot(HUB, "<xacro:undeclared/>"),
        robot(HUB).replace("0 0 0", "  0   0 0 "),
        robot("<!-- Ren\xe9 -->", HUB).encode("latin-1"),
        ('<?xml version="1.0" encoding="ISO-8859-1"?>' + foreign).encode("latin-1"),
        robot(HUB).encode("utf-16"),
    ):  # fmt: skip
        assert read(written).mass == 5
    assert "UTF-8" in refused(foreign.encode("latin-1"))
