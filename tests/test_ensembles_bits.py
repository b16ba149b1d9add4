"""The same dataset, bit for bit, however an ensemble is cut, flown, stopped and kept."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import somersault as so
from somersault.ensembles import Plan, _store, carried_out, plan
from somersault.flight import JointTakeoff, Takeoff, flights


def layout(
    size: int = 130, sequence: str = "random", grid: int = 3, seed: int = 3, tilt: float = 0.02,
    **other: Any,
) -> Plan:  # fmt: skip
    """Every kind of number at once: grids, draws, a list, moves, masses, events, histories."""
    joints = {
        "left_shoulder": JointTakeoff("sprung", 1.2, stiffness=30.0, hold=True, damping=0.1),
        "right_shoulder": JointTakeoff("prescribed", times=[0.1, 0.5], angles=[-1.2, -0.6]),
    }
    vary = {
        "K": so.Vary(sets="joints.left_shoulder.stiffness", values=np.linspace(10.0, 40.0, grid)),
        "leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05]),
        "late": so.Vary(adds_to="joints.right_shoulder.times", uniform=[-0.3, 0.3]),
        "damper": so.Vary(adds_to="joints.left_shoulder.damping", normal=[0.0, 0.1]),
        "arm": so.Vary(adds_to="bodies.left_arm.mass", triangular=[-0.5, 0.0, 1.0]),
        "listed": so.Vary(adds_to="takeoff.twist", samples=np.linspace(-0.3, 0.3, size)),
    }
    if sequence == "saltelli":
        del vary["listed"]
    report = so.Report(
        ("tilt", "twist", "somersaults", "left_shoulder", "landing_error"), ("tilt",), ("twist",),
        4,
    )  # fmt: skip
    given = {
        "model": "furrer", "takeoff": Takeoff(tilt=tilt, spin=8.64, joints=joints),
        "report": report, "against": {"tilt": 0.0, "left_shoulder": 1.2}, "until": "quarter twist",
    }  # fmt: skip
    return plan(flights(**{**given, **other}), vary, size, seed, sequence)


def heavier(model: so.Model) -> so.Model:
    base, *others = model.bodies
    return replace(model, bodies=(replace(base, mass=1.001 * base.mass), *others))


def same(some: xr.Dataset, other: xr.Dataset) -> None:
    assert set(some.variables) == set(other.variables)
    assert dict(some.sizes) == dict(other.sizes)
    for name in other.variables:
        a, b = some[name], other[name]
        assert a.dims == b.dims
        assert a.dtype == b.dtype, name
        np.testing.assert_array_equal(a.values, b.values, err_msg=str(name))
        for key, value in b.attrs.items():
            np.testing.assert_array_equal(a.attrs[key], value)
    for key, value in other.attrs.items():
        assert some.attrs[key] == value


@pytest.fixture(scope="module")
def whole() -> xr.Dataset:
    made = carried_out(layout(), threads=1, chunk=65_536).dataset
    assert len(np.unique(made.ended.values)) == 3  # the end, a quarter twist, no takeoff
    return made


@pytest.mark.parametrize("chunk", [7, 64, 129, 131, 1000])
@pytest.mark.parametrize("threads", [1, 2, 3])
def test_for_any_chunk_on_any_threads(whole: xr.Dataset, chunk: int, threads: int) -> None:
    same(carried_out(layout(), chunk=chunk, threads=threads).dataset, whole)


def test_one_by_one() -> None:
    small = layout(9)
    same(carried_out(small, chunk=1, threads=2).dataset, carried_out(small).dataset)


def test_any_flight_by_itself(whole: xr.Dataset) -> None:
    """Its numbers are of its place, not of where its chunk begins."""
    made = layout()
    for first, last in ((0, 1), (129, 131), (388, 390), (5, 300)):
        rows = made.run(first, last)
        for name, values in rows.items():
            flat = whole[name].values.reshape(390, *values.shape[1:])
            np.testing.assert_array_equal(values, flat[first:last], err_msg=name)


@pytest.mark.parametrize("together", [3, 8, 100])
def test_however_many_are_packed_together(
    whole: xr.Dataset, together: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("somersault.flight._many._TOGETHER", together)
    same(carried_out(layout(), chunk=200, threads=1).dataset, whole)


def test_on_zarr_netcdf_and_in_memory(whole: xr.Dataset, tmp_path: Path) -> None:
    zarr = carried_out(layout(), tmp_path / "a.zarr", chunk=50).dataset
    same(zarr, whole)
    same(so.Ensemble.open(tmp_path / "a.zarr").dataset, whole)
    same(carried_out(layout(), tmp_path / "a.nc", chunk=50).dataset, whole)
    with xr.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as kept:
        same(kept.load(), whole)


def test_a_netcdf_file_is_opened_as_a_store_is(whole: xr.Dataset, tmp_path: Path) -> None:
    carried_out(layout(), tmp_path / "a.nc")
    same(so.Ensemble.open(tmp_path / "a.nc").dataset, whole)


@pytest.mark.parametrize("left", [0, 1, 5])
def test_goes_on_from_what_is_there(whole: xr.Dataset, tmp_path: Path, left: int) -> None:
    """Also where a chunk had some of its variables, or all, but not yet its seal."""
    file = tmp_path / "a.zarr"
    carried_out(layout(), file, chunk=40)
    cut = _store.resume(file, layout())
    assert len(cut) == 12
    ended = sorted((file / "ended" / "c").rglob("*"))
    chunks = [f for f in ended if f.is_file()]
    assert len(chunks) == len(cut)
    for k, path in enumerate(chunks):
        if k % 6 != left:
            continue
        place = path.relative_to(file / "ended")
        (file / "seal" / place / "0").unlink()
        if k % 3:
            path.unlink()
        if k % 2:  # killed earlier: nothing of it was there, or other numbers half written
            (file / "tilt" / place).unlink()
            (file / "twist" / place).write_bytes(bytes((file / "twist" / place).stat().st_size))
            if place.parts[1] == "0":  # of the first K: its chunks bring what is drawn
                (file / "leant" / place.parts[0] / place.name).unlink()
    part = so.Ensemble.open(file).dataset
    assert left % 3 == 0 or (part.ended.values == 255).sum() > 0
    sealed = [f for k, f in enumerate(chunks) if k % 6 != left]
    kept = {f: f.stat().st_mtime_ns for f in sealed}
    same(carried_out(layout(), file, chunk=999, threads=2).dataset, whole)
    assert all(f.stat().st_mtime_ns == when for f, when in kept.items())


def test_what_is_finished_is_not_flown_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a.zarr"
    carried_out(layout(20), file, chunk=10)
    monkeypatch.setattr(Plan, "run", lambda *_: pytest.fail("it was all there"))
    assert int((carried_out(layout(20), file).dataset.ended == 255).sum()) == 0


@pytest.mark.parametrize("sequence", ["sobol", "halton", "saltelli"])
def test_sequences_do_not_depend_on_the_chunk(sequence: str) -> None:
    made = layout(6 * 9, sequence, grid=2)
    wanted = carried_out(made, threads=1).dataset
    for chunk in (7, 20, 54, 70):
        same(carried_out(made, chunk=chunk).dataset, wanted)


def test_a_store_of_another_specification_is_left_as_it_is(tmp_path: Path) -> None:
    file = tmp_path / "a.zarr"
    carried_out(layout(20), file, chunk=10)
    before = {f: (f.stat().st_mtime_ns, f.read_bytes()) for f in file.rglob("*") if f.is_file()}
    others = {
        "sample.seed": layout(20, seed=4), "accuracy": layout(20, accuracy=1e-8),
        "steps": layout(20, steps=99),
        "vary.K.values": layout(20, grid=4), "until": layout(20, until=None),
        "sample.sequence": layout(20, sequence="sobol"), "duration": layout(20, duration=1.5),
        "takeoff.tilt": layout(20, tilt=0.021),
        "model_sha256": layout(20, model=heavier(so.load("furrer"))),
    }  # fmt: skip
    for key, other in others.items():
        with pytest.raises(so.SomersaultError, match=f"\\({key} differs\\)"):
            carried_out(other, file)
    after = {f: (f.stat().st_mtime_ns, f.read_bytes()) for f in file.rglob("*") if f.is_file()}
    assert after == before


def test_a_store_of_other_versions_is_not_gone_on_with(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a.zarr"
    carried_out(layout(20), file)
    other = layout(20).versions | {"numpy": "0.0.1"}
    monkeypatch.setattr(Plan, "versions", property(lambda self: other))
    with pytest.raises(so.SomersaultError, match="begun with numpy"):
        carried_out(layout(20), file)


def test_a_store_of_another_processor_is_gone_on_with_and_told_of(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a.zarr"
    with monkeypatch.context() as elsewhere:
        for where in ("_labels", "_store"):
            elsewhere.setattr(f"somersault.ensembles.{where}.processor", lambda: "z80")
        carried_out(layout(20), file)
    carried_out(layout(20), file)  # nothing is left to fly, and so nothing to tell
    shutil.rmtree(file / "seal" / "c")
    with pytest.warns(so.SomersaultWarning, match="z80"):
        carried_out(layout(20), file)


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize("out", ["a.zarr", "a.nc", None])
def test_on_workers(whole: xr.Dataset, tmp_path: Path, workers: int, out: str | None) -> None:
    file = None if out is None else tmp_path / out
    same(carried_out(layout(), file, chunk=30, workers=workers).dataset, whole)
    shutil.rmtree(tmp_path)
