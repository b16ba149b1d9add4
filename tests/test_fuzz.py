"""Every reader against spoilt files: each is read and sound, or refused in a sentence."""

from __future__ import annotations

from pathlib import Path

import pytest
from fuzz.inputs import spoilt
from fuzz.readers import READERS
from fuzz.run import Report, run

QUICK, MANY = 100, 2_000


def _none_failed(report: Report, folder: Path) -> None:
    if report.failures:
        report.write(folder)
        worst = "\n".join(f"{f.reader} {f.number}: {f.why}" for f in report.failures[:10])
        pytest.fail(
            f"{len(report.failures)} inputs failed; they are in {folder}\n{worst}\n{report}"
        )


def test_an_input_is_the_same_again() -> None:
    for reader in READERS.values():
        first, again = (spoilt(reader, 7, 11) for _ in range(2))
        assert first == again
        assert first != spoilt(reader, 8, 11)


def test_a_few_spoilt_files(tmp_path: Path) -> None:
    report = run(QUICK, seed=1, jobs=2)
    _none_failed(report, tmp_path / "failed")
    ends = sum(report.counts.values(), start=type(report.counts["mjcf"])())
    assert ends["read"] > QUICK / 10  # what is spoilt a little is read
    assert ends["refused"] > QUICK / 10


@pytest.mark.slow
def test_many_spoilt_files(tmp_path: Path) -> None:
    _none_failed(run(MANY, seed=2, jobs=2), tmp_path / "failed")
