"""The momentum sphere: its picture's curves, and `somersault map` as a contract."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from somersault import rigid
from somersault import stability as st
from somersault.cli import main
from somersault.view import sphere
from somersault.view import style as look

LAYOUT = st.principal_inertias("human_layout")


def record(capsys: pytest.CaptureFixture, *arguments: str) -> dict:
    assert main(["map", *arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def exit_code(words: list[str]) -> int | str | None:
    try:
        return main(words)
    except SystemExit as stop:  # argparse
        return stop.code


def test_energies_lie_between_their_bounds_on_both_sides() -> None:
    low, middle, high = rigid.energy_bounds(LAYOUT, 1.0)
    found = sphere.energies(LAYOUT, 5)
    assert len(found) == 10
    assert np.all(np.diff(found) > 0)
    assert np.sum(found > middle) == 5
    assert low < found[0] < found[-1] < high


@pytest.mark.parametrize(("inertias", "count"), [((3.0, 3.0, 1.0), 4), ((1.0, 3.0, 3.0), 4)])
def test_a_symmetric_body_has_one_kind_of_curves(inertias: tuple, count: int) -> None:
    assert len(sphere.energies(inertias, count)) == count
    with look.style():
        sphere.sphere_map(inertias, sphere.energies(inertias, count)).draw_without_rendering()


def test_unrolled_curves_are_points_of_their_energy() -> None:
    """Every point drawn in the chart, read as tilt and twist, has one of the energies asked for."""
    levels = sphere.energies(LAYOUT, 3)
    with look.style():
        chart = sphere.sphere_map(LAYOUT, levels).axes[1]
    allowed = np.append(levels, rigid.energy_bounds(LAYOUT, 1.0)[1])
    seen = set()
    for line in chart.lines:
        twist, tilt = np.radians(np.asarray(line.get_data(), float))
        twist, tilt = twist[~np.isnan(twist)], tilt[~np.isnan(tilt)]
        assert np.abs(np.diff(twist)[np.abs(np.diff(tilt)) > 1e-12]).size  # it is a curve
        c = rigid.momentum_direction(tilt, twist)
        energy = np.sum(c * c / LAYOUT, 1) / 2
        nearest = int(np.argmin(np.abs(allowed - energy[0])))
        np.testing.assert_allclose(energy, allowed[nearest], rtol=1e-9)
        seen.add(nearest)
    assert len(seen) == len(allowed)


def test_map_prints_its_record(capsys: pytest.CaptureFixture) -> None:
    found = record(capsys, "furrer", "--pose", "shoulder=1.3")
    inertias = np.array(found["principal_inertias"])
    least, separatrix, greatest = sorted(1 / (2 * inertias))
    assert found["energy_over_h2"] == pytest.approx(
        {"least": least, "separatrix": separatrix, "greatest": greatest}
    )
    assert found["pose"] == {"left_shoulder": 1.3, "right_shoulder": -1.3}
    assert found["separatrix_axis"] == 2
    minor, major = found["motions"]
    assert (minor["circles"], minor["axis"], minor["twist"]) == ("minor", 3, "monotonic")
    assert (major["circles"], major["axis"], major["twist"]) == ("major", 1, "oscillates")


def test_map_speaks_to_people(capsys: pytest.CaptureFixture) -> None:
    assert main(["map", "human_tuck"]) == 0
    said = capsys.readouterr().out
    assert "separatrix, through axis 1 (front)" in said
    assert "below it h circles the major axis, 2 (left): twist oscillates" in said


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_map_writes_a_whole_picture(capsys, tmp_path: Path, ending: str) -> None:
    path = tmp_path / "new" / f"layout.{ending}"
    found = record(capsys, "human_layout", "--out", str(path), "--energies", "3")
    assert found["picture"] == str(path)
    data = path.read_bytes()
    assert data.startswith(b"\x89PNG") or data.lstrip().startswith(b"<?xml")
    assert [p.name for p in path.parent.iterdir()] == [path.name]
    again = path.with_name(f"again.{ending}")
    record(capsys, "human_layout", "--out", str(again), "--energies", "3")
    assert again.read_bytes() == data


@pytest.mark.parametrize(
    "words",
    [
        ["map", "nobody"],
        ["map", "furrer", "--pose", "elbow=1"],
        ["map", "furrer", "--pose", "shoulder"],
        ["map", "furrer", "--energies", "0"],
        ["map", "furrer", "--energies", "many"],
        ["map", "furrer", "--out", "map.pdf"],
        ["map"],
    ],
)
def test_mistakes_get_one_sentence(capsys: pytest.CaptureFixture, words: list[str]) -> None:
    assert exit_code(words) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1


def test_a_place_that_cannot_be_written_is_said(capsys, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    assert exit_code(["map", "human_pike", "--out", str(tmp_path / "file" / "a.png")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
