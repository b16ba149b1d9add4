"""Stores that lost files, or were begun by two programs at once."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import somersault as so
from somersault.ensembles import _store, plan
from somersault.ensembles._chunks import chunked
from somersault.flight import flights

VARY = {
    "start": so.Vary(adds_to="takeoff.tilt", normal=(0, 0.1)),
    "rate": so.Vary(sets="takeoff.spin", values=[4.0, 6.0]),
}


def flown(out: Path | None, **options: Any) -> so.Ensemble:
    return so.ensemble(
        "book", so.Takeoff(spin=5.0), 0.3, VARY, size=50, chunk=7, out=out,
        report=so.Report(("tilt",), history=("twist",), samples=3), **options,
    )  # fmt: skip


@pytest.mark.parametrize("name", ["tilt", "twist_history", "steps", "ended", "start"])
@pytest.mark.parametrize("damage", ["gone", "empty", "short"])
def test_what_is_lost_is_flown_again(tmp_path: Path, name: str, damage: str) -> None:
    whole = flown(None).dataset
    store = tmp_path / "s.zarr"
    flown(store)
    file = max(f for f in (store / name / "c").rglob("*") if f.is_file())
    if damage == "gone":
        file.unlink()
    elif damage == "empty" or name in ("steps", "ended"):  # compressed: any length may be right
        file.write_bytes(b"")
    else:
        file.write_bytes(file.read_bytes()[:-8])
    again = flown(store).dataset
    for variable in whole.variables:
        np.testing.assert_array_equal(again[variable].values, whole[variable].values)


def test_a_whole_variable_may_be_lost(tmp_path: Path) -> None:
    store = tmp_path / "s.zarr"
    flown(store)
    shutil.rmtree(store / "tilt" / "c")
    assert not np.isnan(flown(store).dataset["tilt"].values).any()


def test_flights_that_all_failed_are_not_flown_for_ever(tmp_path: Path) -> None:
    store = tmp_path / "s.zarr"
    with pytest.warns(so.SomersaultWarning, match=r"100 of 100 .*too many steps: 100"):
        flown(store, steps=1)
    report = so.Report(("tilt",), history=("twist",), samples=3)
    made = plan(flights("book", so.Takeoff(spin=5.0), 0.3, report=report, steps=1), VARY, 50)
    cut = _store.resume(store, made)
    assert _store.finished(store, made, cut) == set(range(len(cut)))


def test_two_programs_may_begin_one_store(tmp_path: Path) -> None:
    made = plan(flights("book", so.Takeoff(spin=5.0), 0.3, report=["tilt"]), VARY, 50)
    store, chunks = tmp_path / "s.zarr", chunked(made.dims, 7)
    _store.create(store, made, chunks)
    _store.create(store, made, chunks)
    assert [p.name for p in tmp_path.iterdir()] == ["s.zarr"]
