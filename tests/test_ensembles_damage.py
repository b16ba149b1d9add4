"""Stores that lost files, or were begun by two programs at once."""

from __future__ import annotations

import os
import shutil
import warnings
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import somersault as so
from somersault.ensembles import Plan, _store, carried_out, plan
from somersault.ensembles._begin import create
from somersault.ensembles._chunks import chunked
from somersault.flight import flights

VARY = {
    "start": so.Vary(adds_to="takeoff.tilt", normal=(0, 0.1)),
    "rate": so.Vary(sets="takeoff.spin", values=[4.0, 6.0]),
}


VAST = 2**40  # bytes, which no memory holds; of zeros, which take no room on a disk

REPORT = so.Report(("tilt",), history=("twist",), samples=3)


@cache
def planned(seed: int = 0, **options: Any) -> Plan:
    """A hundred flights, compiled once."""
    many = flights("book", so.Takeoff(spin=5.0), 0.3, report=REPORT, **options)
    return plan(many, VARY, 50, seed)


def flown(out: Path | None, **options: Any) -> so.Ensemble:
    return carried_out(planned(**options), out, chunk=7, threads=1)


def same(found: so.Ensemble, whole: so.Ensemble) -> None:
    assert set(found.dataset.variables) == set(whole.dataset.variables)
    for name, variable in whole.dataset.variables.items():
        np.testing.assert_array_equal(found.dataset[name].values, variable.values, err_msg=name)


@pytest.fixture(scope="module")
def whole() -> so.Ensemble:
    return flown(None)


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> Path:
    store = tmp_path_factory.mktemp("stored") / "s.zarr"
    flown(store)
    return store


@pytest.fixture(scope="module")
def other(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of another specification, with files of the same names and sizes."""
    store = tmp_path_factory.mktemp("other") / "s.zarr"
    flown(store, seed=1)
    return store


@pytest.mark.parametrize("name", ["tilt", "twist_history", "steps", "ended", "start", "seal"])
@pytest.mark.parametrize(
    "damage", ["gone", "empty", "short", "zeros", "one bit", "folder", "pipe", "vast"]
)
def test_what_is_damaged_is_flown_again_and_said(
    stored: Path, whole: so.Ensemble, tmp_path: Path, name: str, damage: str
) -> None:
    store = tmp_path / "s.zarr"
    shutil.copytree(stored, store)
    file = max(f for f in (store / name / "c").rglob("*") if f.is_file())
    content = file.read_bytes()
    if damage == "gone":
        file.unlink()
    elif damage in ("folder", "pipe"):
        file.unlink()
        (file.mkdir if damage == "folder" else lambda: os.mkfifo(file))()
    elif damage == "vast":
        os.truncate(file, VAST)
    elif damage == "one bit":
        file.write_bytes(bytes([content[0] ^ 16]) + content[1:])
    else:
        file.write_bytes(
            {"empty": b"", "short": content[:-8], "zeros": bytes(len(content))}[damage]
        )
    if (name, damage) == ("seal", "gone"):
        same(flown(store), whole)  # one that was not finished
    else:
        with pytest.raises(so.SomersaultError, match="1 of its 16 chunks"):
            so.Ensemble.open(store)
        with pytest.warns(so.SomersaultWarning, match="1 chunk was damaged in .* is run again"):
            same(flown(store), whole)
    same(so.Ensemble.open(store), whole)


@pytest.mark.parametrize(
    "folder",
    ["tilt", "tilt/c", "tilt/c/0", "twist_history/c/0/1", "start/c", "rate", "rate/c",
     "seal", "seal/c", "seal/c/0", "seal/c/0/1"],
)  # fmt: skip
def test_a_file_where_a_folder_was(
    stored: Path, whole: so.Ensemble, tmp_path: Path, folder: str
) -> None:
    store = tmp_path / "s.zarr"
    shutil.copytree(stored, store)
    shutil.rmtree(store / folder)
    (store / folder).write_text("hi")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", so.SomersaultWarning)
        same(flown(store), whole)
    same(so.Ensemble.open(store), whole)


@pytest.mark.parametrize("swapped", ["two chunks", "two variables", "another store"])
def test_a_chunk_that_is_whole_but_not_in_its_place(
    stored: Path, other: Path, whole: so.Ensemble, tmp_path: Path, swapped: str
) -> None:
    store = tmp_path / "s.zarr"
    shutil.copytree(stored, store)
    first, second = store / "tilt/c/0/1", store / "tilt/c/1/2"
    if swapped == "two variables":
        first, second = store / "tilt/c/0/1", store / "tilt_copy"
        second.write_bytes((store / "steps/c/0/1").read_bytes())
    elif swapped == "another store":
        second = tmp_path / "theirs"
        second.write_bytes((other / "tilt/c/0/1").read_bytes())
    kept = first.read_bytes()
    assert kept != second.read_bytes()
    first.write_bytes(second.read_bytes())
    second.write_bytes(kept)
    with pytest.raises(so.SomersaultError, match="chunks are damaged"):
        so.Ensemble.open(store)
    with pytest.warns(so.SomersaultWarning, match="damaged"):
        same(flown(store), whole)


def test_a_whole_variable_may_be_lost(stored: Path, whole: so.Ensemble, tmp_path: Path) -> None:
    store = tmp_path / "s.zarr"
    shutil.copytree(stored, store)
    shutil.rmtree(store / "tilt")
    with pytest.warns(so.SomersaultWarning) as said:
        same(flown(store), whole)
    assert [str(w.message).partition(" ")[0] for w in said] == [str(store), "16"]


@pytest.mark.parametrize("file", ["tilt", "ended", "start", "rate", "history_time", "seal", "."])
def test_metadata_are_mended(stored: Path, whole: so.Ensemble, tmp_path: Path, file: str) -> None:
    store = tmp_path / "s.zarr"
    shutil.copytree(stored, store)
    said = store / file / "zarr.json"
    content = said.read_text()
    said.write_text(content.replace("f", "g", 1))
    if file == ".":
        with pytest.raises(so.SomersaultError, match=r"zarr.json is damaged; run the same"):
            so.Ensemble.open(store)
    with pytest.warns(so.SomersaultWarning, match="was damaged .*, and has been mended"):
        same(flown(store), whole)
    assert said.read_text() == content


@pytest.mark.parametrize("damage", ["another's", "vast"])
def test_coordinates_are_mended(
    stored: Path, whole: so.Ensemble, tmp_path: Path, damage: str
) -> None:
    store = tmp_path / "s.zarr"
    shutil.copytree(stored, store)
    if damage == "vast":
        os.truncate(store / "rate/c/0", VAST)
    else:
        (store / "rate/c/0").write_bytes((store / "start/c/0").read_bytes()[: 2 * 8 + 4])
    with pytest.raises(so.SomersaultError, match="its coordinates are damaged"):
        so.Ensemble.open(store)
    with pytest.warns(so.SomersaultWarning, match=r"damaged \(what it says of .*rate"):
        same(flown(store), whole)
    same(so.Ensemble.open(store), whole)


def test_a_store_of_which_nothing_shows_what_it_was(stored: Path, tmp_path: Path) -> None:
    store = tmp_path / "s.zarr"
    shutil.copytree(stored, store)
    (store / "zarr.json").write_text("{}")
    shutil.rmtree(store / "seal" / "c")
    with pytest.raises(so.SomersaultError, match=r"nothing else shows that .*s\.zarr is of this"):
        flown(store)


def test_a_store_from_before_seals_is_told_so(stored: Path, tmp_path: Path) -> None:
    store = tmp_path / "s.zarr"
    shutil.copytree(stored, store)
    shutil.rmtree(store / "seal")
    said = store / "zarr.json"
    said.write_text(said.read_text().replace("somersault ensemble 2", "somersault ensemble 1"))
    with pytest.raises(so.SomersaultError, match="did not seal its stores"):
        flown(store)


def damaged(store: Path, other: Path, rng: np.random.Generator) -> str:
    """One random damage to a store; what it was, in words."""
    files = sorted(f for f in store.rglob("*") if f.is_file())
    file = files[rng.integers(len(files))]
    content, of = bytearray(file.read_bytes()), str(file.relative_to(store))
    kind = rng.choice(["flip", "cut", "lengthen", "zeros", "gone", "swap", "theirs", "folder"])
    if kind == "flip":
        for _ in range(rng.integers(1, 4)):
            content[rng.integers(len(content))] ^= 1 << rng.integers(8)
    elif kind == "cut":
        del content[rng.integers(len(content)) :]
    elif kind == "lengthen":
        content += bytes(rng.integers(1, 40))
    elif kind == "zeros":
        content[:] = bytes(len(content))
    elif kind == "swap":
        like = [f for f in files if f.stat().st_size == len(content)]
        with_file = like[rng.integers(len(like))]
        content[:], theirs = with_file.read_bytes(), bytes(content)
        with_file.write_bytes(theirs)
        of += f" with {with_file.relative_to(store)}"
    elif kind == "theirs":
        content[:] = (other / of).read_bytes()
    if kind == "gone":
        file.unlink()
    elif kind == "folder":
        shutil.rmtree(file.parent)
        of = str(file.parent.relative_to(store))
        store.mkdir(exist_ok=True)
    else:
        file.write_bytes(content)
    return f"{kind} {of}"


def bear(count: int, seed: int, stored: Path, other: Path, whole: so.Ensemble, at: Path) -> None:
    """Damage a store so many times: each time it is healed to the same bits, or refused by name."""
    rng, store = np.random.default_rng(seed), at / "s.zarr"
    refused = 0
    for _ in range(count):
        shutil.rmtree(store, ignore_errors=True)
        shutil.copytree(stored, store)
        what = [damaged(store, other, rng) for _ in range(rng.integers(1, 3))]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", so.SomersaultWarning)
            try:
                same(so.Ensemble.open(store), whole)
            except so.SomersaultError as told:
                assert str(store) in str(told), what
            try:
                same(flown(store), whole)
            except so.SomersaultError as told:
                assert str(store) in str(told), what
                refused += 1
                continue
            same(so.Ensemble.open(store), whole)
    assert refused < count / 4  # those in the group's own metadata, of which little else is left


def test_random_damages(stored: Path, other: Path, whole: so.Ensemble, tmp_path: Path) -> None:
    bear(20, 1, stored, other, whole, tmp_path)


@pytest.mark.slow
def test_many_random_damages(stored: Path, other: Path, whole: so.Ensemble, tmp_path: Path) -> None:
    bear(200, 2, stored, other, whole, tmp_path)


@pytest.mark.parametrize("at", [0.1, 0.5, 0.9])
def test_a_damaged_netcdf_file_is_refused(tmp_path: Path, whole: so.Ensemble, at: float) -> None:
    file = tmp_path / "s.nc"
    flown(file)
    same(so.Ensemble.open(file), whole)
    content = bytearray(file.read_bytes())
    values = whole.dataset["tilt"].values.tobytes()
    content[content.index(values) + int(at * len(values))] ^= 1
    file.write_bytes(content)
    with pytest.raises(so.SomersaultError, match="is not what was written"):
        so.Ensemble.open(file)


def test_flights_that_all_failed_are_not_flown_for_ever(tmp_path: Path) -> None:
    store = tmp_path / "s.zarr"
    made = planned(steps=1)
    assert set(flown(store, steps=1).dataset["ended"].values.flat) == {
        made.simulation.endings.code("too many steps")
    }
    cut = _store.resume(store, made)
    assert _store.finished(store, made, cut) == set(range(len(cut)))


def test_two_programs_may_begin_one_store(tmp_path: Path) -> None:
    made = planned()
    store, chunks = tmp_path / "s.zarr", chunked(made.dims, 7)
    create(store, made, chunks)
    create(store, made, chunks)
    assert [p.name for p in tmp_path.iterdir()] == ["s.zarr"]
