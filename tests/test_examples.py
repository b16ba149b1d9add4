"""The examples take a model and a joint; one that there is not gets a sentence. Those of laws
run."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import somersault as so

EXAMPLES = Path(__file__).parents[1] / "examples"


@pytest.mark.parametrize("example", sorted(EXAMPLES.glob("*.py")), ids=lambda p: p.stem)
@pytest.mark.parametrize(
    ("arguments", "said"),
    [(["nobody"], "nobody"), (["nobody.xml"], "nobody.xml"), (["furrer", "elbow"], "elbow")],
)
def test_a_mistake_is_a_sentence(
    example: Path, arguments: list[str], said: str, tmp_path: Path
) -> None:
    run = subprocess.run(
        [sys.executable, str(example), *arguments],
        capture_output=True, encoding="utf-8", cwd=tmp_path,
    )  # fmt: skip
    assert run.returncode == 1
    assert run.stderr.count("\n") == 1
    assert said in run.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_four_layouts_are_shown(tmp_path: Path) -> None:
    run = subprocess.run(
        [sys.executable, str(EXAMPLES / "active_layout.py")],
        capture_output=True, encoding="utf-8", cwd=tmp_path, check=True,
    )  # fmt: skip
    rigid, *held = (int(twist) for twist in re.findall(r"by (\d+)°", run.stdout))
    assert rigid > 170
    assert len(held) == 3
    assert max(held) < 10
    assert {file.name for file in tmp_path.iterdir()} == {"active_layout.mp4", "active_layout.html"}


@pytest.mark.slow
def test_a_gain_is_varied_and_an_ensemble_goes_on(tmp_path: Path) -> None:
    command = [
        sys.executable, "-m", "somersault", "ensemble", str(EXAMPLES / "active_scatter.toml"),
        "--out", str(tmp_path / "scatter.zarr"),
    ]  # fmt: skip
    found = []
    for _ in range(2):
        subprocess.run(command, capture_output=True, check=True)
        found.append(so.ensembles.Ensemble.open(tmp_path / "scatter.zarr"))
    first, again = (one.dataset.load() for one in found)
    assert first.identical(again)
    lasting = found[0].fraction(ended="duration")["fraction"]
    assert lasting.sel(gain=-16.0) > 0.8
    assert lasting.sel(gain=0.0) < 0.3


@pytest.mark.slow
@pytest.mark.parametrize(
    ("example", "arguments", "said"),
    [
        ("layout_design", ["furrer", "shoulder", "24"], r"small motions: angle 1\.\d+, K"),
        ("doll_design", ["doll_weighted", "shoulder", "48"], r"arms of \d+ g, K = .* somersaults"),
        ("legs_design", ["biped", "leg", "24"], r"2\.\d times less on springs"),
    ],
)
def test_designs_are_found_and_go_on(
    example: str, arguments: list[str], said: str, tmp_path: Path
) -> None:
    """What is kept of a search is not run again, and the same is said of it."""
    command = [sys.executable, str(EXAMPLES / f"{example}.py"), *arguments]
    told = [
        subprocess.run(
            command, capture_output=True, encoding="utf-8", cwd=tmp_path, check=True
        ).stdout
        for _ in range(2)
    ]
    assert re.search(said, told[0])
    assert told[0] == told[1]
    made = {file.name for file in tmp_path.iterdir()}
    assert f"{example}.png" in made
    assert all((tmp_path / name / "design.json").exists() for name in made if "." not in name)
