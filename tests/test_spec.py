"""SPEC files: what they mean, and that a mistake names its key."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import somersault as so
from somersault import SomersaultError
from somersault.cli import main

LAYOUT = Path(__file__).parents[1] / "examples" / "layout.toml"
CONTRACT = """
model = "furrer"
duration = 2.0
gravity = [0.0, 0.0, -9.81]
accuracy = 1e-9
[takeoff]
somersault = 0.0
tilt = 0.01
twist = 0.0
spin = 8.64
velocity = [0.0, 0.0, 5.0]
[joints.left_shoulder]
motion = "sprung"
angle = 1.4
rate = 0.0
stiffness = 44.0
damping = 0.0
hold = true
[joints.right_shoulder]
motion = "prescribed"
times = [0.0, 0.2, 1.0]
angles = [0.0, -1.2, -1.2]
"""


def test_the_contract_flies(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    spec = tmp_path / "spec.toml"
    spec.write_text(CONTRACT)
    out = tmp_path / "flight.nc"
    assert main(["fly", str(spec), "--out", str(out), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert set(found) == {"final", "momentum_drift", "energy_drift", "steps", "ended"}
    assert set(found["final"]) >= {
        "somersault", "tilt", "twist", "quaternion", "angular_velocity", "joints",
    }  # fmt: skip
    assert found["momentum_drift"] < 1e-10
    assert found["energy_drift"] is None  # one arm is driven
    assert found["ended"] == "duration"
    assert found["final"]["joints"]["right_shoulder"] == pytest.approx(-1.2, abs=1e-12)
    xarray = pytest.importorskip("xarray")
    with xarray.open_dataset(out, engine="h5netcdf") as data:
        assert float(data["somersault"][-1]) == found["final"]["somersault"]
        assert float(data["centre_of_mass"][-1, 2]) == pytest.approx(5 * 2 - 9.81 * 2)
        assert data["somersault"].attrs["units"] == "rad"


def test_the_example_is_eight_stable_somersaults(capsys: pytest.CaptureFixture) -> None:
    assert main(["fly", str(LAYOUT), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["final"]["somersault"] == pytest.approx(16 * np.pi, abs=0.1)
    assert abs(found["final"]["twist"]) < 0.2
    assert max(found["momentum_drift"], found["energy_drift"]) < 1e-10


def test_csv_has_a_row_a_sample(tmp_path: Path) -> None:
    flight = so.Maneuver.read(LAYOUT).fly(samples=11)
    flight.save(tmp_path / "f.csv")
    lines = (tmp_path / "f.csv").read_text().splitlines()
    assert len(lines) == 12
    assert len({line.count(",") for line in lines}) == 1
    assert lines[0].startswith("time [s],somersault [rad],tilt [rad]")
    assert float(lines[-1].split(",")[1]) == flight.landing.somersault
    with pytest.raises(so.SomersaultError, match=r"\.nc"):
        flight.save(tmp_path / "f.xls")


def test_a_model_file_is_found_beside_the_spec(tmp_path: Path) -> None:
    source = Path(so.__file__).parent / "model/shipped/book.xml"
    (tmp_path / "mine.xml").write_text(source.read_text())
    (tmp_path / "s.toml").write_text('model = "mine.xml"\n[takeoff]\nspin = 3.0\n')
    assert so.Maneuver.read(tmp_path / "s.toml").model.bodies == so.load("book").bodies


BAD = {
    "model": "duration = 1.0",
    "modell": 'modell = "furrer"',
    "duration": 'model = "furrer"\nduration = "long"',
    "duration 0": 'model = "furrer"\nduration = 0',
    "accuracy": 'model = "furrer"\naccuracy = 1.0',
    "gravity": 'model = "furrer"\ngravity = [1.0, 2.0]',
    "samples": 'model = "furrer"\nsamples = 2.5',
    "until": 'model = "furrer"\nuntil = "lunch"',
    "takeoff": 'model = "furrer"\ntakeoff = 3',
    "takeoff.spinn": 'model = "furrer"\n[takeoff]\nspinn = 3.0',
    "tilt": 'model = "furrer"\n[takeoff]\ntilt = nan',
    "spin": 'model = "furrer"\n[takeoff]\nspin = 0.0',
    "angular_velocity": 'model = "furrer"\n[takeoff]\nangular_velocity = [1.0]',
    "elbow": 'model = "furrer"\n[joints.elbow]\nmotion = "free"',
    "joints.left_shoulder.mode": 'model = "furrer"\n[joints.left_shoulder]\nmode = "free"',
    "flying": 'model = "furrer"\n[joints.left_shoulder]\nmotion = "flying"',
    "increase": 'model = "furrer"\n[joints.left_shoulder]\nmotion = "prescribed"\n'
    "times = [0.0, 0.0]\nangles = [0.0, 1.0]",
    "limits": 'model = "furrer"\n[joints.left_shoulder]\nmotion = "prescribed"\n'
    "times = [0.0, 1.0]\nangles = [0.0, 9.0]",
    "not TOML": "model = ",
}


@pytest.mark.parametrize("naming", BAD)
def test_a_mistake_names_its_key(
    naming: str, tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    spec = tmp_path / "spec.toml"
    spec.write_text(BAD[naming])
    assert main(["fly", str(spec), "--out", str(tmp_path / "out.nc")]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert naming.split()[0] in err
    assert [p.name for p in tmp_path.iterdir()] == ["spec.toml"]


@settings(max_examples=200, deadline=None, derandomize=True)
@given(
    st.dictionaries(
        st.sampled_from(["model", "duration", "takeoff", "joints", "gravity", "samples", "x"]),
        st.recursive(
            st.one_of(st.none(), st.booleans(), st.floats(), st.text(max_size=3), st.integers()),
            lambda inner: st.one_of(
                st.lists(inner, max_size=3),
                st.dictionaries(
                    st.sampled_from(["tilt", "spin", "left_shoulder", "angle", "?"]), inner
                ),
            ),
            max_leaves=5,
        ),
    )
)
def test_any_table_is_read_or_refused(given_: dict) -> None:
    try:
        so.Maneuver.parse(given_)
    except so.SomersaultError as mistake:
        assert "\n" not in str(mistake)


RECORDED = """
model = "gymnast"
duration = 0.5
[takeoff]
spin = 5.0
[motion]
file = "arms.csv"
"""


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """A folder with a recording of both elbows, as a pair, and of one hip."""
    times = np.linspace(0.0, 1.0, 101)
    rows = [f"{t},{1 + 0.2 * t},{0.1 * t}" for t in times]
    (tmp_path / "arms.csv").write_text("\n".join(["time,elbow,left_hip_flexion", *rows]))
    return tmp_path


@pytest.mark.parametrize("compliance", ["", "[compliance]\nnatural_frequency = 60\npose = 0.1\n"])
@pytest.mark.parametrize(
    ("name", "locked"),
    [
        ("right_elbow", {"right_elbow"}),
        ("elbow", {"left_elbow", "right_elbow"}),
        ("hip_flexion", {"left_hip_flexion", "right_hip_flexion"}),
    ],
)
def test_a_joint_of_the_spec_goes_before_its_recording(
    recording: Path, name: str, locked: set[str], compliance: str
) -> None:
    own = f'[joints.{name}]\nmotion = "locked"\nangle = 1.5\n'
    (recording / "spec.toml").write_text(RECORDED + compliance + own)
    landed = so.Maneuver.read(recording / "spec.toml").fly(accuracy=1e-6).landing.joints
    moved = {"left_elbow": 1.1, "right_elbow": 1.1, "left_hip_flexion": 0.05}
    for joint, angle in (moved | dict.fromkeys(locked, 1.5)).items():
        assert landed[joint] == pytest.approx(angle, abs=1e-5), joint


def test_a_named_pose_and_what_there_is_instead(recording: Path) -> None:
    text = RECORDED + "[compliance]\nnatural_frequency = 60\npose = "
    (recording / "spec.toml").write_text(text + '"wrap"\n')
    soft = so.Maneuver.read(recording / "spec.toml").takeoff.joints["left_elbow"].stiffness
    (recording / "spec.toml").write_text(text + '"wrapped"\n')
    with pytest.raises(so.SomersaultError, match=r"'following', 'layout', .*'wrap'"):
        so.Maneuver.read(recording / "spec.toml")
    (recording / "spec.toml").write_text(text + "{elbow = 2.1}\n")  # what it hinges on is outboard
    assert so.Maneuver.read(recording / "spec.toml").takeoff.joints["left_elbow"].stiffness == soft


def test_gains_by_joint_are_those_of_python(recording: Path) -> None:
    text = RECORDED + '[compliance]\npose = "wrap"\nnatural_frequency = 60\ndamping_ratio = '
    (recording / "spec.toml").write_text(text + '{"*elbow*" = 0.4, "*_*_*" = 0.7}\n')
    read = so.Maneuver.read(recording / "spec.toml").takeoff.joints
    (recording / "spec.toml").write_text(text + "0.4\n")
    alike = so.Maneuver.read(recording / "spec.toml").takeoff.joints
    assert read["left_elbow"].damping == alike["left_elbow"].damping
    ratio = read["left_hip_flexion"].damping / alike["left_hip_flexion"].damping
    assert ratio == pytest.approx(0.7 / 0.4)
    (recording / "spec.toml").write_text(text + '"soft"\n')
    with pytest.raises(so.SomersaultError, match="numbers by joint"):
        so.Maneuver.read(recording / "spec.toml")


def test_a_pair_and_its_side_are_still_one_too_many(recording: Path) -> None:
    own = '[joints.elbow]\nmotion = "locked"\n[joints.left_elbow]\nmotion = "locked"\n'
    (recording / "spec.toml").write_text(RECORDED + own)
    with pytest.raises(so.SomersaultError, match="left_elbow is given twice"):
        so.Maneuver.read(recording / "spec.toml")


def test_an_off_nominal_start_is_that_of_python(tmp_path: Path) -> None:
    """The tape is that of the takeoff, and not of the start that is off it."""
    text = """
    model = "furrer"
    [takeoff]
    spin = 8.64
    [joints.left_shoulder]
    motion = "prescribed"
    times = [0.1, 0.4]
    angles = [1.4, 0.5]
    [compliance]
    natural_frequency = 20
    pose = 0.1
    """
    (tmp_path / "nominal.toml").write_text(text)
    (tmp_path / "off.toml").write_text(text + "[off_nominal]\ntilt = 0.05\n")
    nominal, off = (
        so.Maneuver.read(tmp_path / f"{name}.toml").takeoff for name in ("nominal", "off")
    )
    assert off == so.off_nominal("furrer", nominal, tilt=0.05)
    (tmp_path / "off.toml").write_text(text + "[off_nominal]\nlean = 0.05\n")
    with pytest.raises(SomersaultError, match=r"off_nominal\.lean"):
        so.Maneuver.read(tmp_path / "off.toml")
