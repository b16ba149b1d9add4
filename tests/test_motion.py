"""Motions: what is read is what was written, what was done to it is known, and what does not
fit is refused in one sentence."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import somersault as so
from somersault.motion import _tables
from somersault.motion._files import read_motion
from somersault.motion._motion import Motion
from somersault.motion._path import Path as Quintics
from somersault.motion._path import value
from somersault.motion._samples import low_pass, sampled_motion

ELBOW, TWIST = "left_elbow", "torso_twist"
TIMES = np.arange(301) / 250
ANGLES = {ELBOW: 1 + 0.9 * np.sin(6 * TIMES), TWIST: 0.5 * np.cos(5 * TIMES)}
SIGNALS = np.stack(list(ANGLES.values()), 1)


def written(
    path: Path,
    columns: dict[str, np.ndarray],
    mark: str = ",",
    header: str = "",
) -> Path:
    """A table of numbers, each such that it is read back bit for bit."""
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    lines = [mark.join(columns), *(mark.join(map(repr, row)) for row in rows)]
    path.write_text(header + "\n".join(lines) + "\n")
    return path


def opensim(columns: dict[str, np.ndarray], degrees: str | None = "inDegrees=yes") -> str:
    rows = len(next(iter(columns.values())))
    said = "" if degrees is None else f"{degrees}\n"
    return f"Coordinates\nversion=1\nnRows={rows}\nnColumns={len(columns)}\n{said}\nendheader\n"


def refused(call: Callable[[], object]) -> str:
    """The one sentence with which a call is refused."""
    with pytest.raises(so.SomersaultError) as caught:
        call()
    said = str(caught.value)
    assert 0 < len(said) < 400
    assert "\n" not in said
    assert not said.endswith(".")
    return said


# ------------------------------------------------------------------------------- keyframes


def test_keyframes_are_reached_at_rest_and_held() -> None:
    motion = Motion.moves(
        "gymnast", {"elbow": [(0.1, 1.5), (0.3, 0.1), (0.5, 2.0)], TWIST: [(0.0, 0), (1.0, 0.5)]}
    )
    assert motion.joints == ("left_elbow", "right_elbow", TWIST)
    assert (motion.begin, motion.end, motion.duration, motion.held) == (0.0, 1.0, 1.0, True)
    angle, rate, acceleration = motion.values([-1.0, 0.1, 0.3, 0.5, 9.0])
    assert angle[:, 0] == pytest.approx([1.5, 1.5, 0.1, 2.0, 2.0])
    assert np.array_equal(angle[:, 0], angle[:, 1])
    assert np.abs(rate[:, 0]).max() < 1e-12
    assert np.abs(acceleration[:, 0]).max() < 1e-9
    between = motion.values(np.linspace(0.1, 0.3, 101))[0][:, 0]
    assert np.all(np.diff(between) < 0)  # no overshoot


def test_a_motion_is_what_a_prescribed_joint_flies() -> None:
    motion = Motion.moves("gymnast", {TWIST: [(0.1, 0.0), (0.4, 0.5)]})
    path = motion.joint_paths("gymnast", 2.0)[TWIST]
    for time in (0.0, 0.2, 0.37, 1.0):
        angle, rate = value(path, time)
        found = motion.values([time])
        assert (angle, rate) == pytest.approx((found[0][0, 0], found[1][0, 0]), abs=1e-14)


def test_a_flight_follows_a_motion_and_its_recording_alike() -> None:
    frames = {"left_shoulder_abduction": [(0.2, 1.57), (0.45, 0.2)], TWIST: [(0.1, 0), (0.4, 0.5)]}
    moved = Motion.moves("gymnast", frames)
    times = np.arange(-75, 326) / 250  # a recording of it, before takeoff and after landing too
    samples = dict(zip(moved.joints, moved.values(times)[0].T, strict=True))
    recorded = sampled_motion("gymnast", times, samples, cutoff=None).delayed(-0.3)
    by_hand = {
        name: so.JointTakeoff(
            motion="prescribed", times=[t for t, _ in row], angles=[a for _, a in row]
        )
        for name, row in frames.items()
    }
    twists = [
        so.fly("gymnast", so.Takeoff(angular_momentum=(0, 60, 0), joints=joints), 1.0).landing.twist
        for joints in (
            by_hand,
            so.prescribed("gymnast", moved, 1.0),
            so.prescribed("gymnast", recorded, 1.0),
        )
    ]
    assert twists[1] == twists[0]
    assert twists[2] == pytest.approx(twists[0], abs=1e-6)
    assert abs(twists[0]) > 1


def test_the_right_side_of_a_pair_is_mirrored() -> None:
    motion = Motion.moves("furrer", {"shoulder": [(0, 1.4), (1, 0.2)]})  # its axes are parallel
    assert np.allclose(motion.values([0, 0.4, 1])[0] @ [1, 1], 0, atol=1e-15)


def test_a_motion_cannot_be_changed() -> None:
    knots, coefficients = np.zeros(1), np.zeros((2, 6))
    motion = Motion({ELBOW: Quintics(knots, coefficients)}, 0.0, 1.0, True)
    knots[0] = coefficients[0, 0] = 7.0  # the caller's own arrays
    assert motion.paths[ELBOW].knots[0] == 0
    with pytest.raises(ValueError, match="read-only"):
        motion.paths[ELBOW].coefficients[0, 0] = 1.0
    with pytest.raises(AttributeError):
        motion.end = 2.0  # type: ignore[misc]


# ----------------------------------------------------------------------- spline and filter


def test_the_spline_has_the_derivatives_of_what_was_sampled() -> None:
    motion = sampled_motion("gymnast", TIMES, ANGLES, cutoff=None)
    at = np.linspace(0, 1.2, 777)
    angle, rate, acceleration = motion.values(at)
    exact = np.stack([1 + 0.9 * np.sin(6 * at), 0.5 * np.cos(5 * at)], 1)
    assert np.abs(angle - exact).max() < 1e-10
    exact = np.stack([5.4 * np.cos(6 * at), -2.5 * np.sin(5 * at)], 1)
    assert np.abs(rate - exact).max() < 1e-7
    exact = np.stack([-32.4 * np.sin(6 * at), -12.5 * np.cos(5 * at)], 1)
    assert np.abs(acceleration - exact).max() < 1e-4
    assert motion.filtered == {ELBOW: 0.0, TWIST: 0.0}
    assert "not filtered" in motion.source


def test_four_derivatives_are_continuous() -> None:
    path = sampled_motion("gymnast", TIMES, ANGLES).paths[ELBOW]
    steps = np.diff(path.knots)
    for order in range(5):
        row = np.polynomial.polynomial.polyder(path.coefficients.T, order)
        ends = np.array(
            [np.polynomial.polynomial.polyval(s, c) for s, c in zip(steps, row.T[1:], strict=False)]
        )
        assert np.abs(ends - row[0, 2:]).max() < 1e-12 * 3000**order


@pytest.mark.parametrize("cutoff", [2.0, 6.0, 10.0, 40.0])
def test_the_filter_has_root_half_the_amplitude_at_its_cutoff_and_no_lag(cutoff: float) -> None:
    rate = 250.0
    times = np.arange(5001) / rate
    middle = slice(2000, 3001)
    for ratio in (0.25, 1.0, 2.0):
        frequency = ratio * cutoff
        wave = np.stack(
            [np.sin(2 * np.pi * frequency * times), np.cos(2 * np.pi * frequency * times)]
        )
        sine, cosine = low_pass(wave.T, rate, cutoff)[middle].T
        warped = np.tan(np.pi * frequency / rate) / np.tan(np.pi * cutoff / rate)
        gain = 1 / (1 + (np.sqrt(2) - 1) * warped**4)
        assert np.abs(sine - gain * wave[0, middle]).max() < 1e-9
        assert np.abs(cosine - gain * wave[1, middle]).max() < 1e-9
        if ratio == 1:
            assert gain == pytest.approx(np.sqrt(0.5))


def test_the_filter_passes_what_is_still_or_steady() -> None:
    steady = np.stack([np.full(200, 1.3), 0.4 + 0.01 * np.arange(200)], 1)
    assert np.abs(low_pass(steady, 250.0, 6.0) - steady).max() < 1e-6


def test_what_the_filter_did_is_told() -> None:
    noise = 0.01 * np.random.default_rng(1).standard_normal(TIMES.size)
    motion = sampled_motion("gymnast", TIMES, {ELBOW: ANGLES[ELBOW] + noise})
    moved = motion.filtered[ELBOW]
    assert np.abs(noise).max() * 0.5 < moved < np.abs(noise).max() * 1.5
    assert "250 Hz" in motion.source
    assert "-3 dB at 10 Hz" in motion.source
    inside = slice(25, -25)
    found = motion.values(TIMES)[0][inside, 0]
    assert np.std(found - ANGLES[ELBOW][inside]) < 0.4 * 0.01


def test_uneven_times_are_made_even() -> None:
    uneven = TIMES + 1e-3 * np.sin(np.arange(301.0)) * (TIMES > 0) * (TIMES < 1.2)
    motion = sampled_motion("gymnast", uneven, {ELBOW: 1 + 0.9 * np.sin(6 * uneven)}, cutoff=None)
    assert "uneven" in motion.source
    assert np.abs(motion.values(TIMES)[0][:, 0] - ANGLES[ELBOW]).max() < 1e-6
    assert "uneven" not in sampled_motion("gymnast", TIMES, ANGLES).source


def test_a_part_begins_at_time_zero_and_knots_may_be_fewer() -> None:
    motion = sampled_motion("gymnast", TIMES, ANGLES, start=0.3, stop=0.9, rate=50.0, cutoff=None)
    assert (motion.begin, motion.end) == (0.0, pytest.approx(0.6))
    assert len(motion.paths[ELBOW].knots) == 31 - 5
    at = np.linspace(0, 0.6, 61)
    assert np.abs(motion.values(at)[0][:, 0] - 1 - 0.9 * np.sin(6 * (at + 0.3))).max() < 1e-6
    assert motion.values([0.6])[1][0, 0] == pytest.approx(5.4 * np.cos(5.4), abs=1e-3)  # no stop
    assert "0 to 0.6 s" in refused(lambda: motion.values([0.7]))
    assert "delayed()" in refused(lambda: motion.joint_paths("gymnast", 0.7))
    motion.joint_paths("gymnast", 0.6)


# ------------------------------------------------------------------------- transformations


@pytest.mark.parametrize("model", ["gymnast", "furrer", "doll"])
@given(angles=st.lists(st.floats(0, 0.7), min_size=2, max_size=4), stretch=st.floats(0.1, 10))
@settings(max_examples=20, deadline=None)
def test_transformations_undo_each_other(model: str, angles: list[float], stretch: float) -> None:
    first = so.load(model).joints[0].name
    motion = Motion.moves(model, {first: list(enumerate(angles))})
    times = np.linspace(-1, 5, 25)
    before = motion.values(times)
    for same in (
        motion.mirrored(model).mirrored(model),
        motion.scaled(stretch).scaled(1 / stretch),
        motion.delayed(stretch).delayed(-stretch),
    ):
        assert same.joints == motion.joints
        for one, other in zip(same.values(times), before, strict=True):
            assert np.abs(one - other).max() < 1e-9
    stretched = motion.scaled(stretch)
    assert stretched.end == pytest.approx(stretch * motion.end)
    for power, (one, other) in enumerate(
        zip(stretched.values(stretch * times), before, strict=True)
    ):
        assert np.allclose(one, other / stretch**power, atol=1e-9 / min(1, stretch**power))
    for one, other in zip(motion.delayed(0.3).values(times + 0.3), before, strict=True):
        assert np.abs(one - other).max() < 1e-9


def test_a_mirror_swaps_the_sides() -> None:
    motion = sampled_motion("gymnast", TIMES, ANGLES).mirrored("gymnast")
    assert motion.joints == ("right_elbow", TWIST)
    assert set(motion.filtered) == {"right_elbow", TWIST}
    assert np.abs(motion.values(TIMES)[0] - SIGNALS * [1, -1]).max() < 2e-3
    assert motion.source.endswith("; mirrored")


def test_joint_names_as_the_mirror_knows_them() -> None:
    motion = Motion.moves("simplest", {"arm": [(0, 0), (1, 1)]})
    assert "mirror image" in refused(lambda: motion.mirrored("simplest"))
    assert "no joint" in refused(lambda: motion.check("gymnast"))


# ----------------------------------------------------------------------------------- files


def test_csv_is_read_as_written(tmp_path: Path) -> None:
    path = written(tmp_path / "m.csv", {"time [s]": TIMES, **ANGLES})
    motion = read_motion(path, "gymnast", cutoff=None)
    assert motion.joints == (ELBOW, TWIST)
    assert not motion.held
    assert motion.source.startswith("m.csv: 301 samples at 250 Hz")
    assert np.abs(motion.values(TIMES)[0] - SIGNALS).max() < 1e-14


@pytest.mark.parametrize(
    ("mark", "ending"), [(",", "csv"), ("\t", "tsv"), (" ", "txt"), (";", "csv")]
)
def test_units_and_marks(tmp_path: Path, mark: str, ending: str) -> None:
    columns = {
        "Time[ms]": 1e3 * TIMES,
        f"{ELBOW}[deg]": np.degrees(ANGLES[ELBOW]),
        f"{TWIST}(rad)": ANGLES[TWIST],
    }
    path = written(tmp_path / f"m.{ending}", columns, mark)
    if mark == ";":  # as spreadsheets write it where commas are decimal
        path.write_bytes(
            b"\xef\xbb\xbf" + path.read_bytes().replace(b".", b",").replace(b"\n", b"\r\n")
        )
    motion = read_motion(path, "gymnast", cutoff=None)
    assert np.abs(motion.values(TIMES)[0] - SIGNALS).max() < 1e-13


def test_a_pair_and_degrees_in_csv(tmp_path: Path) -> None:
    path = written(tmp_path / "m.csv", {"time": TIMES, "elbow": np.degrees(ANGLES[ELBOW])})
    motion = read_motion(path, "gymnast", degrees=True, cutoff=None)
    assert motion.joints == ("left_elbow", "right_elbow")
    assert np.abs(motion.values(TIMES)[0] - SIGNALS[:, :1]).max() < 1e-13


@pytest.mark.parametrize("said", ["inDegrees=yes", "inDegrees=no", "Angles are in degrees.", None])
def test_opensim_files(tmp_path: Path, said: str | None) -> None:
    turned = said != "inDegrees=no"
    unit = np.degrees(1.0) if turned else 1.0
    columns = {
        "time": TIMES + 0.75,
        "pelvis_tx": 0 * TIMES,
        "elbow_flex_l": unit * ANGLES[ELBOW],
        "/jointset/back/torso_twist/value": unit * ANGLES[TWIST],
        "/jointset/back/torso_twist/speed": 0 * TIMES,
    }
    path = written(tmp_path / "m.mot", columns, "\t", opensim(columns, said))
    names = {"elbow_flex_l": ELBOW}
    if said is None:
        assert "with degrees, true or false" in refused(
            lambda: read_motion(path, "gymnast", names=names)
        )
    other = refused(lambda: read_motion(path, "gymnast", names=names, degrees=turned))
    assert "of gymnast: pelvis_tx;" in other  # speeds follow from the values
    motion = read_motion(
        path,
        "gymnast",
        names=names,
        ignore_others=True,
        degrees=None if said else True,
        cutoff=None,
    )
    assert motion.joints == (ELBOW, TWIST)
    assert np.abs(motion.values(TIMES)[0] - SIGNALS).max() < 1e-12
    if said is not None:
        again = refused(lambda: read_motion(path, "gymnast", degrees=not turned))
        assert "contradicts" in again


def test_simm_headers_and_slides(tmp_path: Path) -> None:
    source = so.load("simplest")
    slide = so.Joint("rod", "slide", (0.0, 0.0, 1.0))
    arm = source.bodies[-1]
    body = so.Body(arm.name, arm.parent, arm.mass, arm.com, arm.inertia, joints=(slide,))
    model = so.Model("sliding", True, (source.bodies[0], body))
    header = "name m.mot\ndatacolumns 2\ndatarows 301\nrange 0.0 1.2\ninDegrees=yes\nendheader\n"
    path = written(tmp_path / "m.mot", {"time": TIMES, "rod": 0.1 * TIMES}, " ", header)
    motion = read_motion(path, model, cutoff=None)  # lengths are metres whatever angles are
    assert motion.values([1.0])[0][0, 0] == pytest.approx(0.1)


# --------------------------------------------------------------------------- what is refused

ROWS = ["time,left_elbow", *(f"{t},{a}" for t, a in zip(TIMES, ANGLES[ELBOW], strict=True))]


def changed(line: int, text: str | None) -> str:
    """The table with one line (counted from 1) replaced, or left out."""
    rows = ROWS[: line - 1] + ([] if text is None else [text]) + ROWS[line:]
    return "\n".join(rows)


BAD_FILES = {
    "empty": ("", "empty"),
    "blank": ("\n \n,,\n", "empty"),
    "names alone": (ROWS[0], "no rows"),
    "no time": ("\n".join(ROWS).replace("time", "tyme"), "no column named time"),
    "blank cell": (changed(9, "0.028,"), "line 9, column 'left_elbow' is blank"),
    "NaN": (changed(9, "0.028,NaN"), "line 9, column 'left_elbow' is 'NaN'"),
    "infinite": (changed(9, "0.028,inf"), "line 9"),
    "words": (changed(9, "0.028,straight"), "'straight', which is no number"),
    "short row": (changed(9, "0.028"), "line 9 has 1 cells and the row of names 2"),
    "long row": (changed(9, "0.028,1,1"), "line 9 has 3 cells"),
    "unsorted": (changed(9, "0.5,1.1"), "time 0.5 s comes before 0.032 s"),
    "duplicate": (changed(9, "0.024,1.1"), "time 0.024 s occurs twice"),
    "gap": ("\n".join(ROWS[:50] + ROWS[60:]), "missing between 0.192 and 0.236 s"),
    "few": ("\n".join(ROWS[:6]), "5 samples are too few"),
    "out of limits": (changed(9, "0.028,2.9"), "2.9 rad (166.2°) at 0.028 s is outside"),
    "degrees": ("\n".join(f"{r}e2" for r in ROWS).replace("elbowe2", "elbow"), "like degrees"),
    "enormous": (changed(9, "0.028,1e300"), "number 8 is 1e+300"),
    "unknown joint": ("\n".join(ROWS).replace("elbow", "antenna"), "no joints of gymnast: left_a"),
    "unknown unit": ("\n".join(ROWS).replace("elbow", "elbow [grad]"), "unit 'grad'; give rad"),
    "unit of time": ("\n".join(ROWS).replace("time", "time [deg]"), "unit 'deg'; give s or ms"),
    "a joint twice": (ROWS[0] + ",left_elbow\n" + "\n".join(r + ",1" for r in ROWS[1:]), "two col"),
    "a pair twice": (ROWS[0] + ",elbow\n" + "\n".join(r + ",1" for r in ROWS[1:]), "given twice"),
    "milliseconds": (
        "\n".join([ROWS[0], *(f"{1000 * k / 250},1.0" for k in range(301))]),
        "if the times are milliseconds",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", BAD_FILES)
def test_a_bad_file_is_refused_in_one_sentence(tmp_path: Path, what: str) -> None:
    text, expected = BAD_FILES[what]
    path = tmp_path / "m.csv"
    path.write_text(text)
    said = refused(lambda: read_motion(path, "gymnast"))
    assert said.startswith("m.csv: ")
    assert expected in said


def test_degrees_are_told_from_radians_without_limits_too(tmp_path: Path) -> None:
    source = so.load("simplest")
    arm = source.bodies[-1]
    body = so.Body(
        arm.name, arm.parent, arm.mass, arm.com, arm.inertia, joints=(so.Joint("arm", "hinge"),)
    )
    model = so.Model("unlimited", True, (source.bodies[0], body))
    path = written(tmp_path / "m.csv", {"time": TIMES, "arm [rad]": 80 * np.sin(TIMES)})
    assert "looks like degrees" in refused(lambda: read_motion(path, model))


def test_files_that_are_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    good = written(tmp_path / "good.csv", {"time": TIMES, **ANGLES})
    assert "cannot be read" in refused(lambda: read_motion(tmp_path / "none.csv", "gymnast"))
    folder = tmp_path / "folder.csv"
    folder.mkdir()
    assert "cannot be read" in refused(lambda: read_motion(folder, "gymnast"))
    assert "path of a file" in refused(lambda: read_motion("a\0.csv", "gymnast"))
    assert "read from .csv" in refused(lambda: read_motion(tmp_path / "m.c3d", "gymnast"))
    assert "path of a file" in refused(lambda: read_motion(3, "gymnast"))  # type: ignore[arg-type]
    (tmp_path / "b.csv").write_bytes(b"\x89PNG\r\n\x1a\n\0\0")
    assert "not text" in refused(lambda: read_motion(tmp_path / "b.csv", "gymnast"))
    unknown = {"wrist": ELBOW}
    assert "'wrist'" in refused(lambda: read_motion(good, "gymnast", names=unknown))
    elsewhere = {ELBOW: "wrist"}
    assert "no joint 'wrist'" in refused(lambda: read_motion(good, "gymnast", names=elsewhere))
    none = written(tmp_path / "o.csv", {"time": TIMES, "x": TIMES})
    assert "none of" in refused(lambda: read_motion(none, "gymnast", ignore_others=True))
    monkeypatch.setattr(_tables, "MOST_BYTES", 1000)
    assert "larger" in refused(lambda: read_motion(good, "gymnast"))
    monkeypatch.undo()
    monkeypatch.setattr(_tables, "MOST_SAMPLES", 100)
    assert "over 100 rows" in refused(lambda: read_motion(good, "gymnast"))


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        ("", "endheader"),
        (
            "name\nnRows=400\ninDegrees=no\nendheader\n",
            "says 400 rows and there are 301; it was cut off",
        ),
        (
            "name\nnRows=9\ninDegrees=no\nendheader\n",
            "9 rows and there are 301; correct its header",
        ),
        ("name\nnColumns=9\ninDegrees=no\nendheader\n", "says 9 columns and there are 2"),
        ("DataType=Vec3\nversion=3\nendheader\n", "holds vec3"),
    ],
)
def test_bad_opensim_headers(tmp_path: Path, header: str, expected: str) -> None:
    path = written(tmp_path / "m.sto", {"time": TIMES, ELBOW: ANGLES[ELBOW]}, "\t", header)
    assert expected in refused(lambda: read_motion(path, "gymnast"))


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({"cutoff": 125.0}, "cannot be filtered at 125 Hz"),
        ({"cutoff": 0.0}, "cannot be filtered"),
        ({"cutoff": np.nan}, "cutoff"),
        ({"cutoff": "6"}, "cutoff"),
        ({"start": -1.0}, "no part"),
        ({"start": 0.9, "stop": 0.3}, "no part"),
        ({"start": 0.3, "stop": 0.301}, "too short"),
        ({"rate": 1e9}, "too long"),
        ({"rate": -50.0}, "too short"),
        ({"gap": 0.001}, "missing"),
    ],
)
def test_bad_options(options: dict, expected: str) -> None:
    assert expected in refused(lambda: sampled_motion("gymnast", TIMES, ANGLES, **options))


@pytest.mark.parametrize(
    ("keyframes", "expected"),
    [
        ({}, "without joints"),
        (3, "dict"),
        ({"wrist": [(0, 0)]}, "no joint 'wrist'"),
        ({ELBOW: []}, "pairs"),
        ({ELBOW: [0, 1]}, "pairs"),
        ({ELBOW: [(0, "bent")]}, "pairs"),
        ({ELBOW: [(0, 0), (0, 1)]}, "do not increase"),
        ({ELBOW: [(1, 0), (0, 1)]}, "do not increase"),
        ({ELBOW: [(0, np.nan)]}, "number 1 is nan"),
        ({ELBOW: [(0, 0), (np.inf, 1)]}, "number 2 is inf"),
        ({ELBOW: [(0, 0), (1, 2.7)]}, "outside its limits"),
        ({ELBOW: [(0, 0), (1, 90)]}, "looks like degrees"),
        ({ELBOW: [(0, 0)], "elbow": [(0, 0)]}, "given twice"),
    ],
)
def test_bad_keyframes(keyframes: dict, expected: str) -> None:
    assert expected in refused(lambda: Motion.moves("gymnast", keyframes))


@pytest.mark.parametrize("cutoff", [None, 6.0])
def test_times_in_milliseconds_are_suspected(cutoff: float | None) -> None:
    said = refused(lambda: sampled_motion("gymnast", 1000 * TIMES, ANGLES, cutoff=cutoff))
    assert "milliseconds" in said


def test_limits_hold_between_knots_too() -> None:
    spread_out = np.array([0.0, 0, 0, 0, 2.6, 2.6, 2.6, 2.6, 2.6])  # within, and no path is
    said = refused(
        lambda: sampled_motion("gymnast", np.arange(9) / 10, {ELBOW: spread_out}, cutoff=None)
    )
    assert "outside its limits 0 to 2.61799" in said
    assert "by more than the slack of 0.02; if that is noise give it more slack" in said


def test_bad_samples_and_transformations() -> None:
    short = {ELBOW: ANGLES[ELBOW][:-1]}
    assert "300 values at 301 times" in refused(lambda: sampled_motion("gymnast", TIMES, short))
    assert "no joint" in refused(lambda: sampled_motion("gymnast", TIMES, {}))
    assert "row of numbers" in refused(lambda: sampled_motion("gymnast", [[0.0]], ANGLES))
    motion = Motion.moves("gymnast", {ELBOW: [(0, 0), (1, 1)]})
    for factor in (0.0, -1.0, np.nan, "2"):
        assert "factor" in refused(lambda factor=factor: motion.scaled(factor))
    assert "microsecond" in refused(lambda: motion.scaled(1e-7))
    assert "not finite" in refused(lambda: motion.scaled(1e-70))
    assert "delay" in refused(lambda: motion.delayed(np.inf))
    ball = so.athlete(1.7, 65, shoulders="ball")
    name = next(joint.name for joint in ball.joints if joint.kind == "ball")
    assert "ball" in refused(lambda: Motion.moves(ball, {name: [(0, 0)]}))


@given(
    data=st.one_of(
        st.binary(max_size=300),
        st.text(alphabet='time,left_elbow;\t\n "0123456789.eE+-naif[]=/', max_size=300).map(
            str.encode
        ),
        st.binary(max_size=40).map(lambda b: b"name\nendheader\ntime\tleft_elbow\n" + b),
        st.lists(st.sampled_from(ROWS), max_size=9).map("\n".join).map(str.encode),
    ),
    ending=st.sampled_from([".csv", ".mot", ".txt"]),
)
@example(b'time,"left_elbow\n' + b"1,2\n" * 9, ".csv")
@example(b"time\n" + b"1_0\n" * 9, ".csv")
@settings(max_examples=300, deadline=None)
def test_garbage_is_refused_in_one_sentence(
    tmp_path_factory: pytest.TempPathFactory, data: bytes, ending: str
) -> None:
    path = tmp_path_factory.getbasetemp() / f"garbage{ending}"
    path.write_bytes(data)
    try:
        read_motion(path, "gymnast", degrees=False, ignore_others=True)
    except so.SomersaultError as mistake:
        assert "\n" not in str(mistake)


def test_a_recording_ends() -> None:
    """Beyond its end a spline knows nothing; before its beginning neither."""
    times = np.arange(0, 1.2, 0.01)
    motion = so.sampled_motion("gymnast", times, {"elbow": 1 + 0.9 * np.sin(6 * times)})
    joints = so.prescribed("gymnast", motion)
    begun = so.Takeoff(angular_momentum=(0, 60, 0), joints=joints)
    assert so.fly("gymnast", begun, 1.19).ended == "duration"
    with pytest.raises(so.SomersaultError, match="recorded") as caught:
        so.fly("gymnast", begun, 1.3)
    assert "\n" not in str(caught.value)
    later = so.Takeoff(
        angular_momentum=(0, 60, 0), joints=so.prescribed("gymnast", motion.delayed(0.5))
    )
    for attempt in (
        lambda: so.fly("gymnast", later, 1.0),
        lambda: so.ensemble("gymnast", begun, 2.5),
        lambda: so.fly("gymnast", so.compliant("gymnast", begun, 30.0, pose=0.0), 2.5),
    ):
        with pytest.raises(so.SomersaultError, match="recorded"):
            attempt()
