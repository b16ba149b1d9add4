"""The commands as contracts: what they print, how they fail, how they leave files."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import somersault as so
from somersault.cli import main

KEYS = [
    "model", "axis", "pose", "principal_inertias", "inertia_ratios", "coordinates",
    "M", "G", "D", "K", "holding_torques", "roots", "stable", "growth_per_somersault",
    "energy_signature",
]  # fmt: skip


def record(capsys: pytest.CaptureFixture, *arguments: str) -> dict:
    assert main([*arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def exit_code(words: list[str]) -> int | str | None:
    try:
        return main(words)
    except SystemExit as stop:  # argparse
        return stop.code


def test_stability_prints_the_contract(capsys: pytest.CaptureFixture) -> None:
    found = record(
        capsys, "stability", "furrer", "--axis", "intermediate",
        "--pose", "left_shoulder=1.3", "right_shoulder=-1.3",
        "--stiffness", "left_shoulder=1.1", "--stiffness", "right_shoulder=1.1",
    )  # fmt: skip
    assert list(found)[: len(KEYS)] == KEYS
    at = found["coordinates"].index
    tilt, twist = at("tilt"), at("twist")
    assert found["M"][tilt][tilt] == pytest.approx(12.9553, abs=5e-5)
    assert found["G"][tilt][twist] == pytest.approx(4.0490, abs=5e-5)
    arms = at("antisymmetric shoulder")
    assert found["K"][arms][arms] == pytest.approx(-0.8802 + 2 * 1.1 * 0.384934, abs=1e-4)
    assert found["stable"] is True
    assert found["energy_signature"] == "gyroscopic"
    assert len(found["roots"]) == 10


def test_pair_names_and_repeated_options_mean_the_same(capsys: pytest.CaptureFixture) -> None:
    both = record(capsys, "stability", "furrer", "--pose", "shoulder=1.3", "--lock", "all")
    one = record(
        capsys, "stability", "furrer", "--pose", "left_shoulder=1.3",
        "--pose", "right_shoulder=-1.3", "--lock", "left_shoulder", "right_shoulder",
    )  # fmt: skip
    assert both == one
    assert both["coordinates"] == ["tilt", "twist", "somersault"]


def test_own_springs_count_only_at_a_rate(capsys: pytest.CaptureFixture, tmp_path: Path) -> None:
    text = (Path(so.__file__).parent / "model/shipped/furrer.xml").read_text()
    sprung = tmp_path / "sprung.xml"
    sprung.write_text(text.replace('axis="1 0 0"', 'axis="1 0 0" stiffness="30" damping="0.5"'))
    pose = ["--pose", "shoulder=1.3"]
    without = record(capsys, "stability", str(sprung), *pose)
    assert "--rate" in (main(["stability", str(sprung), *pose]), capsys.readouterr().err)[1]
    at_rate = record(capsys, "stability", str(sprung), *pose, "--rate", "8")
    named = record(
        capsys, "stability", "furrer", *pose,
        "--stiffness", f"shoulder={30 / 64 / 0.384934492}",
        "--damping", f"shoulder={0.5 / 8 / 0.384934492}",
    )  # fmt: skip
    np.testing.assert_allclose(at_rate["K"], named["K"], atol=1e-12)
    np.testing.assert_allclose(at_rate["D"], named["D"], atol=1e-12)
    assert np.abs(np.array(without["K"]) - at_rate["K"]).max() > 0.1
    assert not np.any(without["D"])


def test_models_lists_what_ships(capsys: pytest.CaptureFixture) -> None:
    found = {m["name"]: m for m in record(capsys, "models")}
    assert set(found) == set(so.shipped())
    assert found["book"]["principal_inertias"] == pytest.approx(
        [(0.17**2 + 0.24**2) / 12, (0.03**2 + 0.24**2) / 12, (0.03**2 + 0.17**2) / 12]
    )
    assert main(["models"]) == 0
    assert "65.79" in capsys.readouterr().out


ROBOT = """<robot name="robot"><link name="hub"><inertial><mass value="5"/>
<inertia ixx="0.05" iyy="0.09" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial><collision/></link>
<link name="shank"><inertial><mass value="0.2"/>
<inertia ixx="0.001" iyy="0.001" izz="0.0001" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="knee" type="revolute"><parent link="hub"/><child link="shank"/><axis xyz="0 1 0"/>
<limit lower="-2.7" upper="-0.9"/><dynamics friction="1" damping="0.1"/></joint></robot>"""


def test_models_says_what_was_understood_of_a_file(
    capsys: pytest.CaptureFixture, tmp_path: Path
) -> None:
    path = tmp_path / "robot.urdf"
    path.write_text(ROBOT)
    (found,) = record(capsys, "models", str(path))
    hub, shank = found["bodies"]
    assert (hub["mass"], hub["inertia_from"], shank["parent"]) == (5.0, "file", "hub")
    (knee,) = found["joint_details"]
    assert (knee["range"], knee["home"], knee["damping"]) == ([-2.7, -0.9], [-0.9], 0.1)
    assert found["left_out"] == ["1 collision shape"]
    assert len(found["notes"]) == 3
    assert main(["models", str(path)]) == 0
    page = capsys.readouterr().out
    for words in ("5.2 kg, free in the air", "-2.7 to -0.9", "stands at -0.9", "dry friction",
                  "1 collision shape"):  # fmt: skip
        assert words in page


def test_models_says_which_masses_come_from_shapes(
    capsys: pytest.CaptureFixture, tmp_path: Path
) -> None:
    path = tmp_path / "ball.xml"
    path.write_text(
        '<mujoco><worldbody><body name="ball"><freejoint/><geom size="0.1" contype="0" '
        'conaffinity="0"/></body></worldbody></mujoco>'
    )
    assert main(["models", str(path)]) == 0
    assert "shapes" in capsys.readouterr().out


def test_equations_are_written_whole_or_not_at_all(
    capsys: pytest.CaptureFixture, tmp_path: Path
) -> None:
    target = tmp_path / "book.tex"
    assert main(["equations", "book", "--out", str(target)]) == 0
    capsys.readouterr()
    assert main(["equations", "book"]) == 0
    assert target.read_text() == capsys.readouterr().out
    assert main(["equations", "nothing", "--out", str(tmp_path / "no.tex")]) == 2
    assert main(["equations", "book", "--out", str(tmp_path)]) == 2
    assert [p.name for p in tmp_path.iterdir()] == ["book.tex"]


BAD = [
    "stability nobody",
    "stability missing.xml",
    "stability notes.txt",
    "stability furrer --axis 4",
    "stability furrer --axis biggest",
    "stability furrer --pose shoulder",
    "stability furrer --pose shoulder=nan",
    "stability furrer --pose =1",
    "stability furrer --pose shoulder=1 shoulder=2",
    "stability furrer --pose elbow=1",
    "stability furrer --pose shoulder=4",
    "stability furrer --stiffness elbow=1",
    "stability furrer --damping shoulder=inf",
    "stability furrer --lock elbow",
    "stability furrer --rate 0",
    "stability furrer --rate fast",
    "stability furrer --rate nan",
    "stability",
    "stability furrer doll",
    "stability furrer --frobnicate",
    "equations human_tuck --c --latex",
    "reproduce fig9-9",
    "models nobody",
    "fly",
    "",
]


@pytest.mark.parametrize("line", BAD)
def test_a_mistake_gets_one_sentence(
    line: str, capsys: pytest.CaptureFixture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code = exit_code(line.split())
    out, err = capsys.readouterr()
    assert code == 2
    assert out == ""
    assert err.count("\n") == 1
    assert err.startswith("somersault")
    assert not list(tmp_path.iterdir())


@settings(max_examples=150, deadline=None, derandomize=True)
@given(
    st.lists(
        st.sampled_from(
            ["stability", "models", "furrer", "book", "--axis", "minor", "2", "--pose", "--lock",
             "shoulder=1", "left_shoulder=0.2", "all", "--json", "--rate", "3", "--damping",
             "=", "shoulder=1e999", "💥", "-", "--", "--pose=", "left_shoulder"]
        ),
        max_size=7,
    )
)  # fmt: skip
def test_any_words_end_in_a_code(words: list[str]) -> None:
    assert exit_code(words) in (0, 2)


def run(*arguments: str, **more) -> subprocess.CompletedProcess:
    return subprocess.run(
        [sys.executable, "-m", "somersault", *arguments],
        capture_output=True,
        encoding="utf-8",
        **more,
    )


def test_help_has_examples() -> None:
    for command in ("stability", "models", "equations", "reproduce"):
        shown = run(command, "--help")
        assert shown.returncode == 0
        assert f"somersault {command}" in shown.stdout.partition("examples:")[2]
    assert run("--version").stdout.strip() == f"somersault {so.__version__}"


@pytest.mark.skipif(os.name != "posix", reason="needs a shell pipe")
def test_a_closed_pipe_is_no_error() -> None:
    line = f"{sys.executable} -m somersault models | head -c 1"
    done = subprocess.run(["bash", "-c", line], capture_output=True, encoding="utf-8")
    assert done.stderr == ""
