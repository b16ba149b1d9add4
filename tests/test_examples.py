"""The examples take a model and a joint; one that there is not gets a sentence."""

import subprocess
import sys
from pathlib import Path

import pytest

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
