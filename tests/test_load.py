"""Reading MJCF and URDF: what a file says is what MuJoCo makes of it, and mistakes are told."""

from __future__ import annotations

import os
import random
import re
import warnings
from importlib.resources import files
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from trees import assert_close, mujoco_addresses, to_mujoco

from somersault import SomersaultError, SomersaultWarning
from somersault.model import Joint, Model, load, shipped

MASS = '<inertial pos="0 0 0.1" mass="2" diaginertia="1 1.1 1.2"/>'


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def written(text: str | bytes, name: str = "thing.xml") -> Path:
    path = Path(name)
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def mjcf(inside: str = "", before: str = "", after: str = "", joint: str = "") -> Path:
    """A free base with an arm on a hinge, and whatever else."""
    arm = f'<body name="arm"><joint name="hinge" axis="0 1 0" {joint}/>{MASS}</body>'
    base = f'<body name="base"><freejoint name="root"/>{MASS}{inside}{arm}</body>'
    return written(f"<mujoco>{before}<worldbody>{base}</worldbody>{after}</mujoco>")


def quietly(path: Path) -> Model:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SomersaultWarning)
        return load(path)


def assert_same_machine(path: Path, model: Model) -> None:
    """MuJoCo's own model of the file and of ours: mass matrix and spring torques at some pose."""
    theirs, ours = mujoco.MjModel.from_xml_path(str(path)), to_mujoco(model)
    assert (theirs.nv, theirs.nq) == (ours.nv, ours.nq)
    rng = np.random.default_rng(3)
    motion = rng.normal(size=ours.nv) * 0.5
    found = []
    for m in (theirs, ours):
        d = mujoco.MjData(m)
        _, v_at = mujoco_addresses(model, m)
        own = np.zeros(m.nv)
        own[v_at] = motion[-len(v_at) :]
        d.qpos[:] = m.qpos0
        if model.free:
            d.qpos[:7] = 0, 0, 0, 1, 0, 0, 0
        mujoco.mj_integratePos(m, d.qpos, own, 1.0)
        mujoco.mj_forward(m, d)
        full = np.zeros((m.nv, m.nv))
        for row, speed in zip(full, np.eye(m.nv), strict=True):
            mujoco.mj_mulM(m, d, row, speed)
        order = [*range(6 * model.free), *v_at]
        found.append((full[np.ix_(order, order)], d.qfrc_spring[order]))
    for one, other in zip(*found, strict=True):
        assert_close(other, one, 1e-10)


# ------------------------------------------------------------------------------------ MJCF

WELDED = f"""<mujoco><worldbody><body name="base"><freejoint/>{MASS}
  <body name="pole" pos="0.1 0.2 0.3" euler="20 30 40">
    <inertial pos="0 0.1 0" mass="3" diaginertia="1 2 2.5"/>
    <body name="box" pos="1 0 0" euler="0 50 10"><geom type="box" size="0.1 0.2 0.3" mass="1.5"/>
      <body name="arm" pos="0 1 0" euler="5 0 60"><joint name="hinge" axis="1 2 3"/>{MASS}
        <body name="hand" pos="0 0 1" euler="1 2 3"><geom size="0.1" mass="0.5"/></body></body>
    </body></body></body></worldbody></mujoco>"""


def test_welded_bodies_become_one() -> None:
    path = written(WELDED)
    model = quietly(path)
    assert [body.name for body in model.bodies] == ["base", "arm"]
    assert [body.mass for body in model.bodies] == pytest.approx([2 + 3 + 1.5, 2 + 0.5])
    assert_same_machine(path, model)


def test_defaults_and_includes_mean_what_they_mean_in_mujoco() -> None:
    written(
        f'<mujocoinclude><body name="arm" childclass="stiff"><joint name="hinge"/>{MASS}</body>'
        "</mujocoinclude>",
        "part.xml",
    )
    path = written(
        '<mujoco><compiler angle="degree"/><default><joint damping="0.5" axis="0 1 0"/>'
        '<default class="stiff"><joint stiffness="7" springref="30" armature="0.1"/></default>'
        f'</default><worldbody><body name="base"><freejoint/>{MASS}<include file="part.xml"/>'
        "</body></worldbody></mujoco>"
    )
    model = load(path)
    rest = pytest.approx(np.pi / 6)
    axis = (0.0, 1.0, 0.0)
    want = Joint("hinge", "hinge", axis, stiffness=7, rest=rest, damping=0.5, armature=0.1)
    assert model.joints == (want,)
    assert_same_machine(path, model)


@pytest.mark.parametrize(("unit", "size"), [("degree", 180 / np.pi), ("radian", 1.0)])
def test_angles(unit: str, size: float) -> None:
    """Range, ref and springref of a hinge are angles; a slide's are lengths."""
    numbers = f'range="{-0.5 * size} {size}" ref="{0.3 * size}" springref="{0.2 * size}"'
    slide = '<joint name="slide" type="slide" range="-0.5 1" ref="0.3" springref="0.2"/>'
    path = mjcf(f"<body>{slide}{MASS}</body>", f'<compiler angle="{unit}"/>', joint=numbers)
    for joint in load(path).joints:
        assert joint.limits == pytest.approx((-0.5, 1.0))
        assert joint.reference == pytest.approx(0.3)
        assert joint.rest == pytest.approx(0.2)
        assert joint.home == pytest.approx((0.3,))


def test_several_joints_of_a_body_stay_in_order() -> None:
    joints = (
        '<joint name="out" type="slide" axis="3 0 4" pos="0.1 0 0"/>'
        '<joint name="swing" axis="0 0 2" pos="0 0.2 0" ref="20" stiffness="3" springref="50"/>'
        '<joint type="hinge" axis="1 1 0"/>'
    )
    ball = f'<body name="ball_body"><joint type="ball" stiffness="2"/>{MASS}</body>'
    path = mjcf(f'<body name="leg" euler="10 20 30">{joints}{MASS}{ball}</body>')
    model = load(path)
    found = [(joint.name, joint.kind) for joint in model.joints]
    assert found[:3] == [("out", "slide"), ("swing", "hinge"), ("leg_3", "hinge")]
    assert ("ball_body", "ball") in found
    assert model.joint("out").axis == pytest.approx((0.6, 0.0, 0.8))
    assert model.joint("swing").anchor == pytest.approx((0.0, 0.2, 0.0))
    # Names that the file does not give are ours, so MuJoCo's model is asked by place.
    path.write_text(path.read_text().replace('<joint type="hinge"', '<joint name="leg_3"'))
    path.write_text(path.read_text().replace('type="ball"', 'name="ball_body" type="ball"'))
    assert_same_machine(path, load(path))


SLIDES = "".join(f'<joint type="slide" axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))
HINGES = "".join(f'<joint axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))
PLAIN = '<inertial pos="0 0 0" mass="5" diaginertia="0.05 0.09 0.1"/>'


@pytest.mark.parametrize(
    "root", [SLIDES + HINGES, HINGES + SLIDES, SLIDES + '<joint type="ball"/>']
)
def test_six_virtual_joints_are_a_free_base(root: str) -> None:
    path = written(f"<mujoco><worldbody><body>{root}{PLAIN}</body></worldbody></mujoco>")
    model = load(path)
    assert (model.free, model.mass, model.coordinates) == (True, 5.0, ())
    np.testing.assert_allclose(np.diag(model.bodies[0].inertia), (0.05, 0.09, 0.1))


@pytest.mark.parametrize(
    "root",
    [
        SLIDES,
        SLIDES + HINGES.replace("1 0 0", "0 1 0"),
        SLIDES.replace("1 0 0", "0 1 0") + HINGES,
        SLIDES + HINGES.replace("<joint", '<joint stiffness="1"'),
    ],
)
def test_other_roots_stay_on_joints_to_the_ground(root: str) -> None:
    path = written(f"<mujoco><worldbody><body>{root}{PLAIN}</body></worldbody></mujoco>")
    if "stiffness" in root or root == SLIDES:
        assert not load(path).free
    else:
        assert "moves no mass" in told(path)  # two joints do the same


def test_the_base_can_be_held_and_let_go() -> None:
    held = load(mjcf(), base="fixed")
    assert [(body.name, body.parent) for body in held.bodies] == [("arm", -1)]
    stand = (
        f'<body name="stand" pos="0 0 1">{MASS}<body name="arm"><joint name="hinge"/>{MASS}</body>'
    )
    path = written(f"<mujoco><worldbody>{stand}</body></worldbody></mujoco>")
    assert quietly(path).mass == 2
    free = load(path, base="free")
    assert (free.free, free.mass, [body.name for body in free.bodies]) == (
        True,
        4,
        ["stand", "arm"],
    )
    pendulum = written(
        f"<mujoco><worldbody><body name='b'><joint/>{MASS}</body></worldbody></mujoco>"
    )
    assert not load(pendulum).free
    assert load(pendulum, base="free").joints == ()


FINGERS = (
    f'<body><joint name="left" ref="10"/>{MASS}</body><body><joint name="right"/>{MASS}</body>'
)


def test_a_linear_coupling_of_two_joints_is_followed() -> None:
    couple = '<joint joint1="right" joint2="left" polycoef="0.1 -2 0 0 0"/>'
    model = load(mjcf(FINGERS, after=f"<equality>{couple}</equality>"))
    zero = np.pi / 18  # where left is drawn
    follow = model.joint("right").follows
    assert follow is not None
    assert (follow.leader, follow.factor) == ("left", -2.0)
    assert follow.offset == pytest.approx(0.1 + 2 * zero)
    assert model.home[model.coordinate_slice("right")] == pytest.approx(0.1)


@pytest.mark.parametrize(
    "couple",
    [
        '<joint name="odd" joint1="right" joint2="left" polycoef="0 1 0.1 0 0"/>',
        '<joint name="odd" joint1="right"/>',
        '<connect name="odd" body1="base" body2="arm" anchor="0 0 0"/>',
        '<joint joint1="right" joint2="left"/><joint name="odd" joint1="right" joint2="hinge"/>',
    ],
)
def test_other_couplings_are_refused_by_name(couple: str) -> None:
    assert "'odd'" in told(mjcf(FINGERS, after=f"<equality>{couple}</equality>"))


def test_where_inertias_come_from() -> None:
    model = quietly(written(WELDED))
    assert [body.inertia_from for body in model.bodies] == ["file, shapes", "file, shapes"]
    assert [body.inertia_from for body in load(mjcf()).bodies] == ["file", "file"]
    always = mjcf('<geom size="0.1"/>', before='<compiler inertiafromgeom="true"/>')
    written(always.read_text().replace(f"{MASS}</body></body>", '<geom size="1"/></body></body>'))
    assert [body.inertia_from for body in quietly(always).bodies] == ["shapes", "shapes"]


# ------------------------------------------------------------------------------------ URDF

LINK = (
    '<link name="{}"><inertial><origin xyz="0 0 0.1" rpy="0.1 0.2 0.3"/><mass value="2"/>'
    '<inertia ixx="1" iyy="1.1" izz="1.2" ixy="0.1" ixz="0" iyz="0"/></inertial></link>'
)
HINGE = (
    '<joint name="{}" type="{}"><origin xyz="0 0 1" rpy="0.1 0.2 0.3"/><parent link="{}"/>'
    '<child link="{}"/><axis xyz="0 0.6 0.8"/><limit lower="-1" upper="2" effort="1" '
    'velocity="1"/><dynamics damping="0.7"/></joint>'
)


def urdf(root: str = LINK.format("trunk"), parent: str = "trunk") -> Path:
    parts = [LINK.format(name) for name in ("arm", "hand", "rail")] + [
        HINGE.format("shoulder", "revolute", parent, "arm"),
        HINGE.format("wrist", "fixed", "arm", "hand"),
        HINGE.format("glide", "prismatic", "arm", "rail"),
    ]
    return written(f'<robot name="robot">{root}{"".join(parts)}</robot>', "robot.urdf")


def test_urdf_root_link_is_in_the_air() -> None:
    model = load(urdf())
    assert model.free
    assert [(b.name, b.mass) for b in model.bodies] == [("trunk", 2), ("arm", 4), ("rail", 2)]
    shoulder, glide = model.joints
    assert (shoulder.kind, glide.kind) == ("hinge", "slide")
    assert shoulder.limits == (-1.0, 2.0)
    assert shoulder.damping == pytest.approx(0.7)
    assert shoulder.axis == pytest.approx((0.0, 0.6, 0.8))


def test_urdf_root_link_called_world_is_the_ground() -> None:
    path = urdf('<link name="world"/>', "world")
    model = load(path)
    assert not model.free
    assert [(b.name, b.parent) for b in model.bodies] == [("arm", -1), ("rail", 0)]
    assert_same_machine(path, model)


@pytest.mark.parametrize("attribute", ["", ' xmlns="http://ros.org/wiki/urdf"'])
def test_urdf_is_read_with_a_namespace_too(attribute: str) -> None:
    path = urdf()
    path.write_text(path.read_text().replace("<robot", f"<robot{attribute}"))
    assert load(path).free


# ----------------------------------------------------------------------- what is refused

SITES = '<site name="s"/><body><site name="t"/></body>'
ROPE = '<site site="s"/><site site="t"/></spatial></tendon>'
PAIR = f'<body name="other"><freejoint/>{MASS}</body>'
REFUSED = {
    "joint 'hinge' has a polynomial": {"joint": 'stiffness="1 2"'},
    "joint 'hinge' has a polynomial spring or damper": {"joint": 'damping="1 2"'},
    "'weld'": {"after": '<equality><joint name="weld" joint1="hinge"/></equality>'},
    "'rope'": {"inside": SITES, "after": f'<tendon><spatial name="rope" stiffness="3">{ROPE}'},
    "density": {"before": '<option density="1.2"/>'},
    "viscosity": {"before": '<option viscosity="0.1"/>'},
    "plugin": {"before": '<extension><plugin plugin="no.such.plugin"/></extension>'},
    "'cloth'": {
        "after": '<worldbody><flexcomp name="cloth" type="grid" count="3 3 1" dim="2" mass="1" '
        'spacing=".1 .1 .1" radius=".01"/></worldbody>'
    },
    "gravcomp": {"inside": f'<body name="balloon" gravcomp="1"><joint/>{MASS}</body>'},
    "nope.xml": {"before": '<include file="nope.xml"/>'},
    "nope.stl": {"before": '<asset><mesh name="mesh" file="nope.stl"/></asset>'},
    "'base'": {"inside": "<joint/>"},
}


def told(path: Path | str) -> str:
    """The one sentence in which a file is refused; nothing is left lying about."""
    before = set(os.listdir())
    with pytest.raises(SomersaultError) as caught:
        quietly(Path(path))
    assert set(os.listdir()) == before
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_carried_is_named(what: str) -> None:
    message = told(mjcf(**REFUSED[what]))
    assert what in message
    assert message.startswith("thing.xml")


@pytest.mark.parametrize("post", ["{}", '<body name="post">{}</body>'])
def test_one_body_in_the_air_and_nothing_beside_it(post: str) -> None:
    door = post.format(f'<body name="door"><joint/>{MASS}</body>')
    text = mjcf().read_text()
    assert "'door'" in told(written(text.replace("</worldbody>", f"{door}</worldbody>")))
    message = told(written(text.replace("</worldbody>", f"{PAIR}</worldbody>")))
    assert "'base'" in message
    assert "'other'" in message
    held = text.replace("<freejoint", '<joint type="free" damping="1"')
    assert "'root'" in told(written(held))


def test_a_urdf_with_two_roots_is_refused() -> None:
    assert "'spare'" in told(urdf(LINK.format("trunk") + LINK.format("spare")))


IGNORED = {
    "1 camera": {"inside": '<camera name="eye"/>'},
    "1 sensor": {"after": '<sensor><jointpos joint="hinge"/></sensor>'},
    "1 actuator": {"after": '<actuator><motor joint="hinge"/></actuator>'},
    "1 geom that could touch": {"inside": '<geom size="0.1"/>'},
    "2 sites": {"inside": '<site name="s"/><site name="t"/>'},
    "1 keyframe": {"after": '<keyframe><key name="start"/></keyframe>'},
    "1 actuator (muscle)": {
        "after": '<actuator><muscle name="biceps" joint="hinge" lengthrange="0 1"/></actuator>'
    },
    "1 tendon": {
        "after": '<tendon><fixed name="t" limited="true" range="-1 1">'
        '<joint joint="hinge" coef="1"/>'
        "</fixed></tendon>"
    },
    "1 inactive equality constraint": {
        "after": '<equality><joint joint1="hinge" active="false"/></equality>'
    },
}


@pytest.mark.parametrize("what", IGNORED)
def test_what_has_no_part_in_flight_is_left_out_with_a_warning(what: str) -> None:
    path, what = mjcf(**IGNORED[what]), what.removesuffix(" (muscle)")
    with pytest.warns(SomersaultWarning, match=f"thing.xml.*{what}"):
        model = load(path)
    assert model.ignored == (what,)
    assert model.bodies == load(mjcf()).bodies


def test_dry_friction_is_left_out_with_a_warning() -> None:
    with pytest.warns(SomersaultWarning, match=r"dry friction.*hinge"):
        model = load(mjcf(joint='frictionloss="1"'))
    assert model.bodies == load(mjcf()).bodies


def test_shipped_models_warn_of_nothing() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        robots = {"biped", "biped_weighted"}  # whose motors and feet have no part in flight
        for name in {*shipped()} - robots:
            load(Path(str(files("somersault.model") / "shipped" / f"{name}.xml")))


# -------------------------------------------------------------------------- hopeless files

BAD_BYTES = {
    "empty": b"",
    "malformed": b"<mujoco><worldbody>",
    "no model": b"<mujoco/>",
    "html": b"<html><body>404</body></html>",
    "noise": bytes(range(256)) * 8,
    "nothing but zeros": bytes(500),
    "utf-16": "<mujoco/>".encode("utf-16"),
}


@pytest.mark.parametrize("ending", ["xml", "mjcf", "urdf"])
@pytest.mark.parametrize("what", BAD_BYTES)
def test_bytes_that_are_no_model(what: str, ending: str) -> None:
    assert "thing" in told(written(BAD_BYTES[what], f"thing.{ending}"))


def test_names_that_are_not_utf_8() -> None:
    for path in (mjcf(), urdf()):
        assert path.name in told(
            written(path.read_bytes().replace(b'"arm"', b'"br\xe1s"'), path.name)
        )


def test_files_that_are_none() -> None:
    Path("folder.xml").mkdir()
    for name in ("folder.xml", "missing.xml", "missing.urdf", "n" * 300 + ".xml", "no\0.xml"):
        assert "no model file" in told(name)
    assert "furrer" in told("somebody")
    assert "'.txt'" in told(written("", "thing.txt"))
    for ending in ("xml", "urdf"):
        with open(f"huge.{ending}", "wb") as file:
            file.truncate(51 * 2**20)
        assert "50 MB" in told(f"huge.{ending}")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read all")
def test_files_that_may_not_be_read() -> None:
    path = mjcf()
    path.chmod(0)
    assert "thing.xml" in told(path)
    folder = Path("locked")
    folder.mkdir(mode=0)
    assert "thing.xml" in told(folder / "thing.xml")
    folder.chmod(0o700)


# ------------------------------------------------------------------- mutations of good files

NUMBER = re.compile(r"-?\d+\.?\d*")
TAG = re.compile(r"<[^<>]*>")
VALUE = re.compile(r'"[^"]*"')
NONSENSE = ("nan", "inf", "-inf", "-1", "0", "1e300", "-1e300", "1e-300", "text", "", "1 2 3")


def mutated(text: str, seed: int) -> str:
    """One to three pieces dropped, doubled, or put in another's place."""
    dice = random.Random(seed)
    for _ in range(dice.choice((1, 1, 1, 2, 3))):
        start = dice.randrange(len(text))
        end = start + dice.choice((1, 5, 30, 200))
        places = [m.span() for m in dice.choice((NUMBER, TAG, VALUE)).finditer(text)]
        one, other = dice.choice(places or [(0, 0)]), dice.choice(places or [(0, 0)])
        number = dice.choice([m.span() for m in NUMBER.finditer(text)] or [(0, 0)])
        text = (
            dice.choice(
                (
                    text[:start] + text[end:],
                    text[:end] + text[start:],
                    text[: one[0]] + text[other[0] : other[1]] + text[one[1] :],
                    text[: one[0]] + text[one[1] :],
                    text[: number[0]] + dice.choice(NONSENSE) + text[number[1] :],
                    text[: number[0]] + dice.choice(NONSENSE) + text[number[1] :],
                )
            )
            or " "
        )
    return text


def survives(text: str, name: str) -> None:
    """Read or refused in one line, and nothing but the file itself in the folder."""
    message = ""
    try:
        quietly(written(text, name))
    except SomersaultError as error:
        message = str(error)
    assert "\n" not in message
    left = {"MUJOCO_LOG.TXT"} & set(os.listdir())
    for log in left:
        Path(log).unlink()
    assert not left


@settings(derandomize=True, max_examples=40, deadline=None)  # tests/fuzz has many more
@given(st.integers(0, 2**32))
def test_mutated_mjcf_is_read_or_refused_but_nothing_else(seed: int) -> None:
    survives(mutated(WELDED if seed % 2 else mjcf(SITES).read_text(), seed), "thing.xml")


@settings(derandomize=True, max_examples=150, deadline=None)
@given(st.integers(0, 2**32))
def test_mutated_urdf_is_read_or_refused_but_nothing_else(seed: int) -> None:
    survives(mutated(urdf().read_text(), seed), "robot.urdf")
