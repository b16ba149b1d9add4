"""Ensembles of what is no flight: the same store, resumption, threads, workers and summaries."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from other_simulations import GRAVITY, Boxes, Pendulum
from test_ensembles_bits import same
from test_ensembles_killed import finished

import somersault as so
from somersault.flight import flights
from somersault.simulation import Simulation

# Some are given numbers with which they cannot begin.
pytestmark = pytest.mark.filterwarnings(
    "ignore:.* runs could not begin:somersault._core.errors.SomersaultWarning"
)
SWUNG = {
    "l": so.Vary(sets="pendulum.length", values=[0.5, 1.0, 2.0]),
    "pushed": so.Vary(adds_to="pendulum.angle", normal=[0.0, 0.02]),
    "oil": so.Vary(sets="pendulum.damping", uniform=[0.0, 3.0], scale=2.0, unit="1"),
}
THROWN = {
    "spin": so.Vary(sets="spin", values=[-4.0, 2.0]),
    "higher": so.Vary(adds_to="height", normal=[0.0, 0.1]),
    "rough": so.Vary(sets="friction", uniform=[-0.02, 0.6]),
}


def swung(**options: Any) -> so.Ensemble:
    return so.ensemble(Pendulum(), vary=SWUNG, size=64, seed=2, **options)


def thrown(**options: Any) -> so.Ensemble:
    return so.ensemble(Boxes(), vary=THROWN, size=30, seed=5, **options)


BOTH = pytest.mark.parametrize("run", [swung, thrown])


@pytest.fixture(scope="module")
def wholes() -> dict[Any, xr.Dataset]:
    return {run: run(threads=1, chunk=1000).dataset for run in (swung, thrown)}


def test_what_an_ensemble_needs() -> None:
    for one in (Pendulum(), Boxes(), flights("furrer")):
        assert isinstance(one, Simulation)
    assert not isinstance(so.Takeoff(), Simulation)


def test_each_run_is_the_one_that_was_asked_for(wholes: dict[Any, xr.Dataset]) -> None:
    """Against the formula of each pendulum by itself, with what is set, added and scaled."""
    data = wholes[swung]
    assert data.attrs["model"] == "pendulum"
    assert (data.l.attrs["units"], data.pushed.attrs["units"]) == ("m", "rad")
    assert data.angle.dims == ("l", "sample")
    assert data.angle_history.sizes["history_time"] == 5
    creeping = data.ended.values == 1
    assert 0 < creeping.sum() < creeping.size
    length, d = np.broadcast_arrays(data.l.values[:, None], 2 * data.oil.values)
    t, begin = 3.0, 0.1 + data.pushed.values
    for where, roots in (
        (creeping, np.sqrt(np.maximum(d**2 - GRAVITY / length, 0))),
        (~creeping, np.sqrt(np.maximum(GRAVITY / length - d**2, 0))),
    ):
        c, s = (np.cosh, np.sinh) if where is creeping else (np.cos, np.sin)
        with np.errstate(divide="ignore", invalid="ignore"):
            angle = begin * np.exp(-d * t) * (c(roots * t) + d / roots * s(roots * t))
        np.testing.assert_allclose(data.angle.values[where], angle[where], rtol=1e-9, atol=1e-12)
    np.testing.assert_array_equal(data.angle, data.angle_history.isel(history_time=-1))


def test_a_run_that_cannot_begin_is_struck_out(wholes: dict[Any, xr.Dataset]) -> None:
    data = wholes[thrown]
    lost = np.broadcast_to(data.rough.values <= 0, data.ended.shape)
    assert 0 < lost.sum() < lost.size
    np.testing.assert_array_equal(data.ended.values == 3, lost)
    np.testing.assert_array_equal(np.isnan(data.slid), lost)
    assert (data.hits.values[lost] == 0).all()
    assert (data.hits.values[~lost] > 0).any()
    assert {0, 1} <= set(data.ended.values.ravel().tolist())


@BOTH
@pytest.mark.parametrize("chunk", [1, 7, 64])
@pytest.mark.parametrize("threads", [1, 3])
def test_for_any_chunk_on_any_threads(
    run: Any, chunk: int, threads: int, wholes: dict[Any, xr.Dataset]
) -> None:
    same(run(chunk=chunk, threads=threads).dataset, wholes[run])


@BOTH
def test_a_store_goes_on_where_files_are_missing(
    run: Any, wholes: dict[Any, xr.Dataset], tmp_path: Path
) -> None:
    store = tmp_path / "s.zarr"
    same(run(out=store, chunk=9).dataset, wholes[run])
    chunks = sorted(f for f in (store / "ended" / "c").rglob("*") if f.is_file())
    damaged = [k for k in range(len(chunks)) if k % 3 < 2]
    for k, file in enumerate(chunks):
        if k % 3 == 0:
            file.unlink()
        elif k % 3 == 1:
            name = next(n for n in wholes[run].data_vars if n.endswith("_history"))
            other = store / str(name) / file.relative_to(store / "ended") / "0"
            other.write_bytes(other.read_bytes()[:-8])
    with pytest.raises(so.SomersaultError, match=f"{len(damaged)} of its {len(chunks)} chunks"):
        so.Ensemble.open(store)
    with pytest.warns(so.SomersaultWarning, match=f"{len(damaged)} chunks were damaged"):
        same(run(out=store, threads=2).dataset, wholes[run])
    same(so.Ensemble.open(store).dataset, wholes[run])


@BOTH
@pytest.mark.slow
@pytest.mark.parametrize("out", ["s.zarr", None])
def test_on_two_workers(
    run: Any, out: str | None, wholes: dict[Any, xr.Dataset], tmp_path: Path
) -> None:
    file = None if out is None else tmp_path / out
    same(run(out=file, chunk=8, workers=2).dataset, wholes[run])


PROGRAM = """
import sys
sys.path.insert(0, sys.argv[1])
from test_ensembles_simulations import many
many(out=sys.argv[2], chunk=4, threads=int(sys.argv[3]))
"""


def many(**options: Any) -> so.Ensemble:
    return so.ensemble(Boxes(2.0), vary=THROWN, size=400, seed=5, **options)


@pytest.mark.slow
def test_killed_again_and_again(tmp_path: Path) -> None:
    store, before = tmp_path / "s.zarr", 0
    for k in range(4):
        command = [sys.executable, "-c", PROGRAM, str(Path(__file__).parent), str(store)]
        program = subprocess.Popen([*command, str(k % 2 + 1)], stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 60
        while finished(store) < before + 3 + k and time.monotonic() < deadline:
            time.sleep(0.002)
        os.kill(program.pid, signal.SIGKILL)
        program.wait()
        assert finished(store) > before
        before = finished(store)
    assert before < 200
    same(many(out=store).dataset, many(threads=1).dataset)
    shutil.rmtree(store)


# ------------------------------------------------------------------------- what it adds up to


def test_summaries(wholes: dict[Any, xr.Dataset]) -> None:
    for run, data in wholes.items():
        found = so.Ensemble(data)
        words = {swung: ("swinging", "creeping"), thrown: ("at rest", "moving", "no throw")}[run]
        over = data.ended.dims
        shares = [float(found.fraction(ended=word, over=over)["fraction"]) for word in words]
        assert sum(shares) == pytest.approx(1.0)
        assert all(share > 0 for share in shares)
    spread = so.Ensemble(wholes[thrown]).quantiles("slid", over=["spin", "sample"])
    sound = wholes[thrown].slid.values[~np.isnan(wholes[thrown].slid.values)]
    assert float(spread["mean"]) == pytest.approx(sound.mean())
    assert int(spread["flights"]) == sound.size
    assert int(spread["failed"]) == np.isnan(wholes[thrown].slid.values).sum()
    ranking = so.Ensemble(wholes[swung]).sensitivity("angle")
    assert set(ranking.input.values) == {"pushed", "oil"}
    assert so.Ensemble(wholes[swung]).plot("angle").axes[0].get_xlabel() == "l (m)"
    assert so.ensembles.summary(wholes[thrown])["ended"]["no throw"] == int(
        so.ensembles.failed(wholes[thrown].ended).sum()
    )
    with pytest.raises(so.SomersaultError, match="no landing_error"):
        so.Ensemble(wholes[swung]).fraction(tolerance=0.1)


def test_runs_that_break_off_are_counted_in_a_warning() -> None:
    fast = {"speed": so.Vary(sets="speed", samples=[0.5, 1e9, 0.2])}
    with pytest.warns(so.SomersaultWarning, match=r"^1 of 3 .*\(unstable: 1\)"):
        data = so.ensemble(Boxes(), vary=fast).dataset
    np.testing.assert_array_equal(np.isnan(data.slid), [False, True, False])


# ------------------------------------------------------------------------- mistakes


def test_mistakes(tmp_path: Path) -> None:
    for said, vary, options in (
        ("vary.x: weight is no number", so.Vary(sets="weight", values=[1.0]), {}),
        ("'no pendulum'", so.Vary(sets="pendulum.length", values=[-1.0, 1.0]), {}),
        ("duration is given, but", so.Vary(sets="pendulum.length", values=[1.0]), {"duration": 1}),
        ("report is given, but", so.Vary(sets="pendulum.length", values=[1.0]), {"report": ["a"]}),
    ):
        with pytest.raises(so.SomersaultError, match=said):
            so.ensemble(Pendulum(), vary={"x": vary}, **options)
    with pytest.raises(so.SomersaultError, match="has the name of something reported"):
        so.ensemble(Pendulum(), vary={"angle": SWUNG["l"]})
    store = tmp_path / "s.zarr"
    so.ensemble(Pendulum(), vary=SWUNG, size=3, out=store)
    with pytest.raises(so.SomersaultError, match=r"pendulum\.duration differs"):
        so.ensemble(replace(Pendulum(), duration=4.0), vary=SWUNG, size=3, out=store)
    with pytest.raises(so.SomersaultError, match="another specification"):
        so.ensemble("book", so.Takeoff(spin=5.0), 0.1, out=store)
