"""How far an ensemble is, and that it will take long."""

from __future__ import annotations

import re
import warnings
from types import SimpleNamespace

import pytest

from somersault.ensembles import _run


@pytest.mark.parametrize(("left", "noted"), [(10**10, ["about 463 days"]), (10**4, [])])
def test_a_run_that_will_take_very_long_is_noted_once(
    left: int, noted: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    now = iter([0.0, 1.0, 4.0, 8.0])  # the first chunk is done, and the others
    monkeypatch.setattr(_run, "time", SimpleNamespace(monotonic=lambda: next(now)))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        with _run.progress(left, 0, shown=False) as advance:
            for _ in range(4):
                advance(500)
    assert len(said) == len(noted)
    assert all(words in str(one.message) for words, one in zip(noted, said, strict=True))


def test_the_bar_has_a_share_and_an_estimate_from_the_first_chunk_on(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "120")
    with _run.progress(2 * 10**12, 0, shown=True) as advance:
        advance(10**10)
    said = capsys.readouterr().err
    assert "0.5 %" in said
    assert re.search(r"[\d,]+/s, [\d,]+ \w+ left", said)
