"""Recordings as they come: angles that start again at −180°, jumps, flights' tables, the base."""

from __future__ import annotations

import os
import warnings
from math import degrees, pi, sin
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from osims import Bone, Hinge, element, line, version_4
from scipy.spatial.transform import Rotation

import somersault as so
from somersault._core.errors import SomersaultWarning
from somersault.motion import RecordedBase, read_motion, sampled_motion
from somersault.motion._jumps import without_turns

ACROBAT = so.load(Path(__file__).parents[1] / "examples" / "acrobat.bioMod", axes=(1, 2, 3))
ARM = "LeftArm_RotY"
X, Y, Z = np.eye(3)


def noted(call):  # type: ignore[no-untyped-def]
    """What a call gives, and what it warns of."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", SomersaultWarning)
        result = call()
    return result, [str(w.message) for w in caught if w.category is SomersaultWarning]


def table(path: Path, columns: dict[str, np.ndarray]) -> Path:
    """A .csv, .mot or .sto with these columns; OpenSim's say that angles are degrees."""
    mark = "," if path.suffix == ".csv" else "\t"
    rows = list(zip(*(np.asarray(c).tolist() for c in columns.values()), strict=True))
    header = ""
    if mark == "\t":
        header = (
            f"r\nversion=1\nnRows={len(rows)}\nnColumns={len(columns)}\ninDegrees=yes\nendheader\n"
        )
    lines = [mark.join(columns), *(mark.join(map(repr, row)) for row in rows)]
    path.write_text(header + "\n".join(lines) + "\n")
    return path


# ------------------------------------------------------------------------------ whole turns


@pytest.mark.parametrize("ending", [".mot", ".sto", ".csv"])
def test_an_angle_that_starts_again_goes_on(ending: str, tmp_path: Path) -> None:
    times = [k / 100 for k in range(120)]
    true = np.array([2.6 + 2.2 * sin(2.2 * t) for t in times])
    turn = 360.0 if ending != ".csv" else 2 * pi
    wrapped = [((degrees(a) if turn == 360 else a) + turn / 2) % turn - turn / 2 for a in true]
    path = table(tmp_path / f"jump{ending}", {"time": times, ARM: wrapped})
    motion, said = noted(lambda: read_motion(path, ACROBAT, cutoff=None))
    np.testing.assert_allclose(motion.values(times)[0][:, 0], true, rtol=0, atol=1e-9)
    passed = [k for k in range(119) if (true[k] > pi) != (true[k + 1] > pi)]
    between = ", ".join(f"{times[k]:g} and {times[k + 1]:g}" for k in passed)
    words = f"jump{ending}: joint {ARM} jumps by a whole turn between {between} s"
    assert said == [f"{words}, and is taken to go on"]


@given(
    size=st.floats(0.5, 6.0), rate=st.floats(0.5, 12.0), start=st.floats(-3.0, 3.0),
    spin=st.floats(-8.0, 8.0), hertz=st.sampled_from([50, 100, 240]),
)  # fmt: skip
@settings(max_examples=60, deadline=None)
def test_smooth_angles_come_back_from_their_remainders(
    size: float, rate: float, start: float, spin: float, hertz: int
) -> None:
    times = np.arange(int(1.2 * hertz)) / hertz
    true = start + size * np.sin(rate * times) + spin * times
    wrapped = (true + pi) % (2 * pi) - pi
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SomersaultWarning)
        found = without_turns("j", "s", times, wrapped)
    np.testing.assert_allclose(found - found[0], true - true[0], rtol=0, atol=1e-9)


def test_a_wheel_that_turns_by_much_at_every_sample_is_left_alone() -> None:
    times = np.arange(30) / 10
    for step in (4.0, 6.5, -7.0):
        angles = step * np.arange(30.0)
        assert without_turns("j", "s", times, angles) is angles


def test_many_turns_are_named_by_the_first(tmp_path: Path) -> None:
    times = np.arange(300) / 100
    values = {ARM: (3.9 * times + pi) % (2 * pi) - pi + np.where(times > 2, 2 * pi, 0)}
    values[ARM] = (12.0 * np.sin(4 * times) + pi) % (2 * pi) - pi
    _, said = noted(lambda: sampled_motion(ACROBAT, times, values, cutoff=None))
    assert len(said) == 1
    assert " times more, and is taken to go on" in said[0]


# ------------------------------------------------------------------------------------ jumps


def still(jump: float, count: int = 1, hertz: float = 100) -> tuple[np.ndarray, np.ndarray]:
    """A gentle motion with `count` samples off by a jump, from 0.5 s on."""
    times = np.arange(120) / hertz
    angles = 0.4 * np.sin(3 * times)
    at = int(0.5 * hertz)
    angles[at : at + count] += jump
    return times, angles


@pytest.mark.parametrize("jump", [pi, -pi, 2.0, -1.0, pi / 2, 3 * pi])
@pytest.mark.parametrize("count", [1, 2, 999])
def test_a_jump_that_is_no_turn_is_refused_with_joint_and_time(jump: float, count: int) -> None:
    times, angles = still(jump, count)
    with pytest.raises(so.SomersaultError, match=f"joint {ARM} jumps by .* between 0") as caught:
        noted(lambda: sampled_motion(ACROBAT, times, {ARM: angles}))
    begin, end = (0.49, 0.5) if count > 2 or "0.49 and 0.5 s" in str(caught.value) else (
        times[50 + count - 1], times[50 + count])  # fmt: skip
    assert f"between {begin:g} and {end:g} s" in str(caught.value)


def test_a_part_without_the_jump_is_taken() -> None:
    times, angles = still(2.0, 3)
    motion = sampled_motion(ACROBAT, times, {ARM: angles}, start=0.6, stop=1.1, cutoff=None)
    assert motion.end == pytest.approx(0.5)


@pytest.mark.parametrize("hertz", [5, 30, 100, 1000])
def test_quick_moves_are_no_jumps(hertz: int) -> None:
    """An arm that drops by 1.5 rad in 0.2 s, and one thrown at 40 rad/s."""
    times = np.arange(int(1.6 * hertz) + 8) / hertz
    for size, seconds in ((1.5, 0.2), (2.8, 0.14)):
        s = np.clip((times - 0.4) / seconds, 0, 1)
        angles = size * (10 * s**3 - 15 * s**4 + 6 * s**5)
        motion = sampled_motion(ACROBAT, times, {ARM: angles}, cutoff=None)
        assert motion.joints == (ARM,)


# ----------------------------------------------------------------------- a flight's own table


def test_a_flight_is_read_back_as_a_motion(tmp_path: Path) -> None:
    keys = {
        "left_shoulder_abduction": [(0.0, 1.5), (0.5, 0.2)],
        "hip_flexion": [(0.1, 0), (0.6, 1)],
    }
    motion = so.Motion.moves("gymnast", keys)
    takeoff = so.Takeoff(
        somersault=0.3, tilt=0.05, angular_momentum=(0, 60, 0), velocity=(0.3, 0.1, 4),
        joints=so.prescribed("gymnast", motion, duration=0.7),
    )  # fmt: skip
    flight = so.fly("gymnast", takeoff, 0.7, samples=np.linspace(0, 0.7, 141))
    flight.save(tmp_path / "flight.csv")
    again = read_motion(tmp_path / "flight.csv", "gymnast")
    assert set(again.joints) == {joint.name for joint in so.load("gymnast").joints}
    at = np.linspace(0, 0.7, 57)
    for name in motion.joints:
        ours = again.values(at)[0][:, again.joints.index(name)]
        theirs = motion.values(at)[0][:, motion.joints.index(name)]
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=2e-6)
    assert "not filtered" in again.source
    assert again.base is not None
    np.testing.assert_array_equal(again.base.times, flight.times)
    np.testing.assert_allclose(again.base.positions, flight.base_position, atol=1e-12)
    turned = np.abs(np.sum(again.base.quaternions * flight.base_quaternion, 1))
    np.testing.assert_allclose(turned, 1, atol=1e-12)
    np.testing.assert_allclose(again.base.angles, flight.angles, atol=1e-9)
    part = read_motion(tmp_path / "flight.csv", "gymnast", start=0.2, stop=0.5)
    assert part.base is not None
    assert part.base.times[0] == pytest.approx(0, abs=1e-12)
    assert part.base.times[-1] == pytest.approx(0.3)
    np.testing.assert_array_equal(part.base.positions, again.base.positions[40:101])


def test_a_flight_read_back_flies_the_same_when_its_joints_are_prescribed(tmp_path: Path) -> None:
    """To 3e-7 rad from a hundred samples a second, and 16 times closer from twice as many: the
    spline through them is of the fourth order."""
    moves = {
        "left_shoulder_abduction": [(0.1, 0.1), (0.4, 2.0)],
        "hip_flexion": [(0.2, 0.0), (0.6, 1.0)],
    }
    flown = so.Maneuver.moves("gymnast", moves, so.Takeoff(spin=6.0, tilt=0.03), 1.0)
    off = []
    for samples in (101, 201):
        flight = flown.fly(samples=samples)
        flight.save(tmp_path / "flight.csv")
        joints = so.prescribed("gymnast", read_motion(tmp_path / "flight.csv", "gymnast"), 1.0)
        momentum = flight.start.momentum.tolist()
        takeoff = so.Takeoff(tilt=0.03, angular_momentum=momentum, joints=joints)
        again = so.fly("gymnast", takeoff, 1.0, samples=samples)
        np.testing.assert_allclose(
            again.joint_coordinates, flight.joint_coordinates, rtol=0, atol=1e-14
        )
        off.append(np.abs(again.angles - flight.angles).max())
    assert off[0] < 3e-7
    assert 10 < off[0] / off[1] < 25


def test_a_base_that_is_no_attitude_is_refused(tmp_path: Path) -> None:
    flight = so.fly("furrer", so.Takeoff(spin=8.0), 0.2)
    flight.save(tmp_path / "flight.csv")
    text = (tmp_path / "flight.csv").read_text().splitlines()
    place = text[0].split(",").index("quaternion w [1]")
    row = text[4].split(",")
    row[place] = "3.0"
    text[4] = ",".join(row)
    (tmp_path / "flight.csv").write_text("\n".join(text))
    with pytest.raises(so.SomersaultError, match=r"the base's quaternion at .* has the length"):
        read_motion(tmp_path / "flight.csv", "furrer")


# ------------------------------------------------------------------------ the base, measured

ROOT = ("pelvis_tilt", "pelvis_list", "pelvis_rotation", "pelvis_tx", "pelvis_ty", "pelvis_tz")


def pelvis_and_leg(folder: Path) -> so.Model:
    axes = zip([f"{kind}{k}" for kind in ("rotation", "translation") for k in (1, 2, 3)],
               [(n, a, line(1.0)) for n, a in zip(ROOT, (Z, X, Y, X, Y, Z), strict=True)],
               strict=True)  # fmt: skip
    root = Hinge("CustomJoint", "root", "ground", "pelvis", dict.fromkeys(ROOT, ""), dict(axes),
                 at=((0.1, 0.2, 0.3), (0, 0, 0)))  # fmt: skip
    hip = Hinge("PinJoint", "hip", "pelvis", "leg", {"hip_flexion": ""})
    knee = Hinge(
        "CustomJoint", "knee", "leg", "shank", {"knee_angle": ""},
        {"rotation1": ("knee_angle", Z, line(0.25)), "translation1": ("knee_angle", X, line(0.1))},
    )  # fmt: skip
    bones = [Bone("pelvis", 12), Bone("leg", 8), Bone("shank", 4)]
    path = folder / "gait.osim"
    path.write_text(version_4(bones, [root, hip, knee]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SomersaultWarning)
        return so.load(path, axes=(3, 1, 2))


def walk() -> dict[str, np.ndarray]:
    times = np.arange(90) / 100
    columns = {"time": times + 2.0, "hip_flexion": 40 * np.sin(4 * times)}
    columns |= {name: 20 * np.sin((k + 2) * times + k) for k, name in enumerate(ROOT[:3])}
    columns |= {name: (k + 1) * times for k, name in enumerate(ROOT[3:])}
    return columns


def test_a_mot_in_the_models_coordinates_flies_and_has_the_base(tmp_path: Path) -> None:
    model, columns = pelvis_and_leg(tmp_path), walk()
    motion = read_motion(table(tmp_path / "walk.mot", columns), model, cutoff=None)
    assert motion.joints == ("hip_flexion",)
    values = motion.values(columns["time"] - 2.0)[0][:, 0]
    np.testing.assert_allclose(values, np.radians(columns["hip_flexion"]), atol=1e-12)
    assert isinstance(motion.base, RecordedBase)
    np.testing.assert_allclose(motion.base.times, columns["time"] - 2.0, atol=1e-12)
    turns = Rotation.from_euler("ZXY", np.stack([columns[n] for n in ROOT[:3]], 1), degrees=True)
    mine = Rotation.from_quat(motion.base.quaternions, scalar_first=True)
    assert (mine * turns.inv()).magnitude().max() < 1e-9
    places = np.stack([columns[n] for n in ROOT[3:]], 1) + np.array([0.1, 0.2, 0.3])
    np.testing.assert_allclose(motion.base.positions, places, atol=1e-12)
    # Tilt, list and rotation are about z, x and y in this order: those of axes (3, 1, 2).
    np.testing.assert_allclose(
        motion.base.angles, np.radians(np.stack([columns[n] for n in ROOT[:3]], 1)), atol=1e-9
    )
    joints = so.prescribed(model, motion, duration=0.8)
    assert so.fly(model, so.Takeoff(spin=3.0, joints=joints), 0.8).momentum_drift < 1e-9


def test_a_base_moves_with_its_motion(tmp_path: Path) -> None:
    model, columns = pelvis_and_leg(tmp_path), walk()
    motion = read_motion(table(tmp_path / "walk.mot", columns), model, cutoff=None)
    assert motion.base is not None
    later = motion.scaled(2.0).delayed(0.5).base
    assert later is not None
    np.testing.assert_allclose(later.times, 2 * motion.base.times + 0.5)
    # In a mirror across z: list and rotation turn round, and so does the way along z.
    for name in ("pelvis_list", "pelvis_rotation", "pelvis_tz"):
        columns[name] = -columns[name]
    other = read_motion(table(tmp_path / "other.mot", columns), model, cutoff=None).base
    assert other is not None
    mirrored = motion.base.mirrored()
    apart = Rotation.from_quat(mirrored.quaternions, scalar_first=True) * (
        Rotation.from_quat(other.quaternions, scalar_first=True).inv()
    )
    assert apart.magnitude().max() < 1e-9
    offset = (0, 0, 0.6)  # the root's own place, which the mirror takes along
    np.testing.assert_allclose(mirrored.positions + offset, other.positions, atol=1e-12)


def test_what_is_not_recorded_of_the_base_is_said(tmp_path: Path) -> None:
    model, columns = pelvis_and_leg(tmp_path), walk()
    for name in ROOT[1:3]:
        del columns[name]
    motion, said = noted(lambda: read_motion(table(tmp_path / "w.mot", columns), model))
    assert motion.base is not None
    assert said == [
        "w.mot: the base's pelvis_list, pelvis_rotation are not recorded, and taken to stay where "
        "the model has them"
    ]
    bare = {name: columns[name] for name in ("time", "hip_flexion")}
    assert read_motion(table(tmp_path / "b.mot", bare), model).base is None


def test_the_base_of_a_biomod_is_where_biorbd_has_it(tmp_path: Path) -> None:
    biorbd = pytest.importorskip("biorbd", reason="biorbd, the reference reader, is optional")
    path = tmp_path / "turned.bioMod"
    path.write_text(
        "version 4\nsegment P\nrt 0.3 -0.2 0.5 zyx 1 2 3\ntranslations zxy\nrotations yxz\nmass 9\n"
        "inertia_xxyyzz 1 1 1\nendsegment\nsegment A\nparent P\nrotations x\nmass 1\n"
        "inertia_xxyyzz 0.1 0.1 0.1\nendsegment\n"
    )
    model, theirs = so.load(path), biorbd.Model(str(path))
    names = [name.to_string() for name in theirs.nameDof()]
    rng, times = np.random.default_rng(3), np.arange(40) / 100
    values = np.cumsum(rng.normal(size=(40, 7)) * 0.05, axis=0)
    columns = {"time": times} | dict(zip(names, values.T, strict=True))
    base = read_motion(table(tmp_path / "q.csv", columns), model, cutoff=None).base
    assert base is not None
    for k in range(0, 40, 13):
        frame = theirs.globalJCS(values[k], 0).to_array()
        turn = Rotation.from_quat(base.quaternions[k], scalar_first=True).as_matrix()
        np.testing.assert_allclose(turn, frame[:3, :3], atol=1e-9)
        np.testing.assert_allclose(base.positions[k], frame[:3, 3], atol=1e-9)


# ------------------------------------------------------------- coordinates that are no joints


def test_a_coordinate_in_proportion_moves_its_joint(tmp_path: Path) -> None:
    """OpenSim keeps such coordinates in radians in a file of degrees."""
    model, times = pelvis_and_leg(tmp_path), np.arange(50) / 100
    columns = {"time": times, "hip_flexion": 10 * times, "knee_angle": np.sin(times)}
    motion = read_motion(table(tmp_path / "k.mot", columns), model, cutoff=None)
    assert set(motion.joints) == {"hip_flexion", "knee_angle_rotation1"}
    place = motion.joints.index("knee_angle_rotation1")
    np.testing.assert_allclose(motion.values(times)[0][:, place], 0.25 * np.sin(times), atol=1e-12)
    columns["knee_angle_rotation1"] = columns["knee_angle"]
    with pytest.raises(so.SomersaultError, match="two columns are joint knee_angle_rotation1"):
        read_motion(table(tmp_path / "k.mot", columns), model)


def coupled(folder: Path) -> so.Model:
    hips = Hinge("FreeJoint", "root", "ground", "hips", {f"x{k}": "" for k in range(6)})
    knee, cap = (
        Hinge("PinJoint", f"{n}_joint", "hips", n, {f"{n}_angle": ""}) for n in ("shank", "cap")
    )
    rule = element(
        "CoordinateCouplerConstraint",
        element("coupled_coordinates_function", line(0.5, 0.1))
        + element("independent_coordinate_names", "shank_angle")
        + element("dependent_coordinate_name", "cap_angle"),
        "rule",
    )  # fmt: skip
    bones = [Bone("hips", 12), Bone("shank", 4), Bone("cap", 1)]
    path = folder / "coupled.osim"
    path.write_text(
        version_4(bones, [hips, knee, cap], element("ConstraintSet", element("objects", rule)))
    )
    return so.load(path)


def test_a_follower_that_is_recorded_follows_all_the_same(tmp_path: Path) -> None:
    model, times = coupled(tmp_path), np.arange(50) / 100
    leader = np.sin(3 * times)
    columns = {"time": times, "shank_angle": leader, "cap_angle": 0.5 * leader + 0.1}
    motion = read_motion(table(tmp_path / "a.csv", columns), model, cutoff=None)
    assert motion.joints == ("shank_angle",)
    columns["cap_angle"] = columns["cap_angle"] + np.where(times == 0.3, 0.2, 0.0)
    _, said = noted(lambda: read_motion(table(tmp_path / "a.csv", columns), model, cutoff=None))
    assert said == [
        "a.csv: joint cap_angle follows shank_angle in the model, and is recorded 0.2 from there "
        "at 0.3 s; it is taken to follow"
    ]
    del columns["shank_angle"]
    columns["cap_angle"] = 0.5 * leader + 0.1
    motion = read_motion(table(tmp_path / "a.csv", columns), model, cutoff=None)
    assert motion.joints == ("shank_angle",)
    np.testing.assert_allclose(motion.values(times)[0][:, 0], leader, atol=1e-9)


# ------------------------------------------------------------------------------------ pipes


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes here")
def test_nobody_waits_for_a_pipe(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.csv")
    with pytest.raises(so.SomersaultError, match="cannot be read"):
        read_motion(tmp_path / "pipe.csv", "furrer")
    if os.path.exists("/dev/zero"):
        os.symlink("/dev/zero", tmp_path / "zero.mot")
        with pytest.raises(so.SomersaultError, match="cannot be read"):
            read_motion(tmp_path / "zero.mot", "furrer")
