"""What is accepted and strange: the notes that say so, and the lines that they point at."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import somersault as so
from somersault._core.notes import note
from somersault.cli import main

SOURCE = Path(so.__file__).parent


def notes_of(call: Callable[[], Any]) -> list[warnings.WarningMessage]:
    """The notes of a call, in order."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", so.SomersaultWarning)
        call()
    return [one for one in caught if issubclass(one.category, so.SomersaultWarning)]


# ------------------------------------------------------------------------------- where they point


def test_every_warning_of_the_package_goes_through_one_place() -> None:
    for path in SOURCE.rglob("*.py"):
        if path.name != "notes.py":
            assert not re.search(r"warnings\.warn\b", path.read_text(encoding="utf-8")), path


def test_a_note_points_at_the_line_that_called_the_package(tmp_path: Path) -> None:
    """Through as many calls of ours as there are, and through a dataclass's own `__init__`."""
    arm = so.load("furrer").bodies[-1]
    spring = replace(arm, joints=(replace(arm.joints[0], stiffness=-1.0),))
    calls: list[Callable[[], Any]] = [
        lambda: so.Takeoff(tilt=33.0),
        lambda: so.fly("furrer", LOOSE, 2.0),
        lambda: so.Maneuver("furrer", LOOSE, 2.0).fly(samples=5),
        lambda: so.ensemble("furrer", so.Takeoff(spin=8.0), 8.0, steps=3),
        lambda: so.load(urdf(tmp_path, "<axs xyz='0 0 1'/>")),
        lambda: replace(so.load("furrer"), bodies=(*so.load("furrer").bodies[:-1], spring)),
    ]
    for call in calls:
        line = call.__code__.co_firstlineno
        for one in (noted := notes_of(call)):
            assert one.filename == __file__
            assert line <= one.lineno < line + 10
        assert noted


def test_a_note_of_a_program_that_is_nothing_but_the_package_points_somewhere() -> None:
    with pytest.warns(so.SomersaultWarning, match="^strange$"):
        eval(compile("note('strange')", "<nowhere>", "eval"), {"note": note})


def test_the_shell_prints_each_note_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    spec = tmp_path / "loose.toml"
    spec.write_text(
        'model = "furrer"\nduration = 2.0\n[takeoff]\nspin = 8.0\nsomersault = 360\n'
        '[joints.shoulder]\nmotion = "free"\nangle = 1.4\nrate = 9.0\n'
    )
    assert main(["fly", str(spec), "--json"]) == 0
    notes = capsys.readouterr().err.splitlines()
    assert [line.partition(" is ")[0] for line in notes[:1]] == ["note: takeoff somersault"]
    assert notes[1].startswith("note: joints went far beyond their limits: left_shoulder to ")
    assert len(notes) == 2


# ---------------------------------------------------------------------------- joints beyond limits


LOOSE = so.Takeoff(spin=8.0, joints={"shoulder": so.JointTakeoff.free(1.4, rate=9.0)})


def test_joints_that_go_far_beyond_their_limits_are_named_with_when_and_how_far() -> None:
    with pytest.warns(so.SomersaultWarning) as noted:
        flight = so.fly("furrer", LOOSE, 2.0)
    (said,) = (str(one.message) for one in noted)
    for name in ("left_shoulder", "right_shoulder"):
        low, high = flight.model.joint(name).limits or (0.0, 0.0)
        at, when = re.search(rf"{name} to (\S+) rad at (\S+) s", said).groups()  # type: ignore[union-attr]
        path = flight.joint_coordinates[:, flight.model.coordinate_slice(name).start]
        beyond = np.maximum(low - path, path - high)
        assert float(at) == pytest.approx(path[beyond.argmax()], rel=1e-3)
        assert float(when) == pytest.approx(flight.times[beyond.argmax()], rel=1e-3)
        assert f"(limits {low:g} to {high:g})" in said


def test_a_joint_that_passes_its_limit_by_a_little_is_left_alone() -> None:
    """Limits exert no force, and a sprung joint swings through them in many a flight."""
    arm = so.JointTakeoff.sprung(angle=3.2, rate=6.0, stiffness=60.0, rest=3.2)
    flight = so.fly("furrer", so.Takeoff(spin=2.0, joints={"shoulder": arm}), 0.5)
    _, high = flight.model.joint("left_shoulder").limits or (0.0, 0.0)
    assert high + 0.1 < flight.joint_coordinates[:, 0].max() < high + np.pi


# --------------------------------------------------------------------------------------- degrees


def hinge(tmp_path: Path, more: str = 'axis="0 1 0"') -> so.Model:
    """A body with one joint, which has no range."""
    file = tmp_path / "hinge.xml"
    file.write_text(
        '<mujoco><compiler angle="radian"/><default><geom contype="0" conaffinity="0"/></default>'
        '<worldbody><body name="a"><freejoint/><geom size=".2" mass="2"/>'
        f'<body name="b" pos="0 0 .3"><joint name="j" {more}/><geom size=".1" pos="0 0 .2" mass="1"'
        "/></body></body></worldbody></mujoco>"
    )
    return so.load(file)


def test_angles_that_look_like_degrees_are_noted(tmp_path: Path) -> None:
    model, still = hinge(tmp_path), so.Takeoff(spin=3.0)
    doing = so.JointTakeoff

    def flown(joint: so.JointTakeoff) -> Callable[[], Any]:
        return lambda: so.fly(model, so.Takeoff(spin=3.0, joints={"j": joint}), 0.01)

    cases: list[tuple[Callable[[], Any], str]] = [
        (lambda: so.Takeoff(spin=500), r"takeoff spin is 500 rad/s.*500°/s are 8.727 rad/s"),
        (lambda: so.Takeoff(angular_velocity=[0, -720, 10]), "takeoff angular_velocity is -720"),
        (lambda: so.Takeoff(tilt=33), r"takeoff tilt is 33 rad.*33° are 0.576 rad"),
        (lambda: so.Takeoff(somersault=-90.0), "takeoff somersault is -90 rad"),
        (flown(doing.locked(80.0)), "joint j: angle is 80 rad"),
        (flown(doing.sprung(0.0, stiffness=1.0, rest=45)), "joint j: rest is 45 rad"),
        (flown(doing.prescribed(times=[0.0, 0.5], angles=[0, 120])), "joint j: angles is 120 rad"),
        (lambda: so.spin(model, pose={"j": 80}), "pose j is 80 rad"),
        (
            lambda: so.ensemble(model, still, 0.01, against={"somersault": 360.0}),
            "target.somersault is 360 rad",
        ),
        (
            lambda: so.ensemble(
                model, still, 0.01, {"leant": so.Vary(sets="takeoff.tilt", values=[0, 10, 20])}
            ),
            "vary.leant is 20 rad",
        ),
        (
            lambda: so.ensemble(
                model, still, 0.01, {"leant": so.Vary(adds_to="takeoff.tilt", uniform=[-10, 10])},
                size=2,
            ),
            "vary.leant is -10 rad",
        ),
    ]  # fmt: skip
    for call, words in cases:
        said = {str(one.message) for one in notes_of(call)}
        assert len(said) == 1, said
        assert re.match(words, said.pop())


def test_angles_that_are_radians_are_not(tmp_path: Path) -> None:
    """Turns that were counted, a quarter, a step of a grid that is scaled from degrees."""
    model = hinge(tmp_path)
    for angle in (0.5, 6.0, 2 * np.pi * 3, 18.85, -31.42):
        so.Takeoff(somersault=angle)
        so.Takeoff(spin=angle)
        so.spin(model, pose={"j": angle})
    scaled = so.Vary(sets="takeoff.tilt", values=[10.0, 20.0], scale=np.pi / 180)
    so.ensemble("furrer", so.Takeoff(spin=8.0), 0.01, {"leant": scaled})


LIMITED = """<robot name="r"><link name="a"><inertial><mass value="2"/><inertia ixx="1" iyy="1"
izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><link name="b"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j"
type="{}"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/><limit lower="{}" upper="{}"
effort="1" velocity="1"/></joint></robot>"""


@pytest.mark.parametrize(
    ("kind", "limits", "said"),
    [
        ("revolute", (-90, 90), ["j (-90 to 90)"]),
        ("revolute", (0, 135), ["j (0 to 135)"]),
        ("revolute", (-1.5, 2), []),
        ("revolute", (-31.4159, 31.4159), []),
        ("revolute", (-10000, 10000), []),  # which says that there are none
        ("prismatic", (-90, 90), []),
    ],
)
def test_limits_that_look_like_degrees_are_noted(
    kind: str, limits: tuple[float, float], said: list[str], tmp_path: Path
) -> None:
    file = tmp_path / "r.urdf"
    file.write_text(LIMITED.format(kind, *limits))
    start = "r.urdf: limits of joints are in rad, and these look like degrees: "
    assert [str(one.message) for one in notes_of(lambda: so.load(file))] == [
        start + words for words in said
    ]


def test_a_refused_angle_that_looks_like_degrees_says_so() -> None:
    arms = {"shoulder": so.JointTakeoff.free(80.0)}
    for call in (
        lambda: so.spin("furrer", pose={"shoulder": 80}),
        lambda: so.fly("furrer", so.Takeoff(spin=3.0, joints=arms)),
    ):
        with pytest.raises(so.SomersaultError, match=r"80° are 1\.396 rad"):
            call()
    with pytest.raises(so.SomersaultError, match=r"give -0\.5 to 3\.3$"):
        so.spin("furrer", pose={"shoulder": 3.7})


# ---------------------------------------------------------------------- springs, masses, and files


def test_springs_that_drive_a_joint_away_are_noted_and_flown(tmp_path: Path) -> None:
    doing = so.JointTakeoff
    for joint, words in (
        (doing.sprung(1.4, stiffness=-5.0), r"negative stiffness \(-5\)"),
        (doing.sprung(1.4, K=-0.1), r"negative K \(-0\.1\)"),
    ):
        takeoff = so.Takeoff(spin=8.0, joints={"left_shoulder": joint})
        vary = {"lean": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.1])}
        for call in (
            lambda: so.fly("furrer", takeoff, 0.05),  # noqa: B023
            lambda: so.ensemble("furrer", takeoff, 0.05, vary, size=2),  # noqa: B023
        ):
            (said,) = notes_of(call)  # once
            assert re.search(words, str(said.message))
    with pytest.warns(so.SomersaultWarning, match=r"joint 'j' has negative stiffness \(-3\)"):
        hinge(tmp_path, 'axis="0 1 0" stiffness="-3"')


@pytest.mark.parametrize(("factor", "mass"), [(1e-9, "6.5786e-08"), (1e3, "65786")])
def test_a_mass_that_no_body_has(factor: float, mass: str) -> None:
    furrer = so.load("furrer")
    bodies = tuple(
        replace(
            body, mass=factor * body.mass,
            inertia=tuple(tuple(factor * x for x in row) for row in body.inertia),
        )
        for body in furrer.bodies
    )  # fmt: skip
    with pytest.warns(so.SomersaultWarning, match=f"furrer has a mass of {mass} kg in all"):
        replace(furrer, bodies=bodies)


def urdf(tmp_path: Path, inside: str, name: str = "two.urdf") -> Path:
    """Two links and a hinge between them, with something more in it."""
    inertial = (
        '<inertial><mass value="{}"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    file = tmp_path / name
    file.write_text(
        f'<robot name="two"><link name="a">{inertial.format(2)}</link>'
        f'<link name="b">{inertial.format(1)}</link><joint name="j" type="continuous">'
        f'<parent link="a"/><child link="b"/>{inside}</joint></robot>'
    )
    return file


def test_an_unknown_word_is_named_with_the_one_that_it_looks_like(tmp_path: Path) -> None:
    with pytest.warns(so.SomersaultWarning, match=r"<axs> in joint 'j' \(did you mean axis\?\)"):
        so.load(urdf(tmp_path, "<axs xyz='0 0 1'/>"))
    with pytest.warns(so.SomersaultWarning, match=r"lowr of <limit> .*\(did you mean lower\?\)"):
        so.load(urdf(tmp_path, "<limit lowr='-1' upper='1'/>"))


def test_a_robot_is_known_by_its_content_whatever_its_file_is_called(tmp_path: Path) -> None:
    for name in ("two.urdf", "two.xml", "two.mjcf"):
        model = so.load(urdf(tmp_path, "<axis xyz='0 0 1'/>", name))
        assert model.mass == 3.0
        assert model.joint("j").axis == (0.0, 0.0, 1.0)


def test_a_range_the_wrong_way_round_counts_for_nothing_as_in_mujoco(tmp_path: Path) -> None:
    with pytest.warns(so.SomersaultWarning, match="ranges the wrong way round.*: j$"):
        model = hinge(tmp_path, 'axis="0 1 0" range="1 -1"')
    assert model.joint("j").limits is None
