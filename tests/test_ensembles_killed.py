"""Killed at any moment, an ensemble goes on and ends with the same dataset."""

from __future__ import annotations

import contextlib
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import psutil
import pytest
import xarray as xr

import somersault as so
from somersault.ensembles import carried_out, read_ensemble

SPEC = """
model = "furrer"
duration = 1.0
until = "quarter twist"
[takeoff]
tilt = 0.02
spin = 8.64
[joints.shoulder]
motion = "sprung"
angle = 1.4
stiffness = 30.0
hold = true
[vary.stiffness]
sets = "joints.shoulder.stiffness"
values = {{from = 0.0, to = 40.0, count = 4}}
[vary.leant]
adds_to = "takeoff.tilt"
normal = [0.0, 0.05]
[vary.arm]
sets = "joints.left_shoulder.pretension"
uniform = [-2.0, 2.0]
[sample]
size = {size}
seed = 7
sequence = "sobol"
[report]
quantities = ["tilt", "twist", "somersaults"]
extremes = ["tilt"]
history = ["tilt"]
samples = 3
"""
KILLS = 50
CHUNK = 8  # flights: a chunk is mostly its files, so that there are many moments to be killed at
ROOM = 1800  # samples a grid point: more than fifty runs cut short get done
MODES = (("--threads", "1"), ("--threads", "2"), ("--workers", "1"), ("--workers", "2"))


def spec(folder: Path, size: int) -> Path:
    file = folder / "spec.toml"
    file.write_text(SPEC.format(size=size))
    return file


def command(file: Path, store: Path, *more: str) -> list[str]:
    return [
        sys.executable, "-m", "somersault", "ensemble", str(file), "--out", str(store), "--json",
        "--chunk", str(CHUNK), *more,
    ]  # fmt: skip


def begun(file: Path, store: Path, *more: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        hearing(command(file, store, *more)), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True,
    )  # fmt: skip


def hearing(command: Sequence[str], how: str = "SIG_DFL") -> list[str]:
    """A command that hears interrupts, or ignores them: what a shell starts in the background
    ignores them, and so would what that starts.

    Not by a function between fork and exec, which may wait for ever for a thread of this process.
    """
    then = f"import os, signal, sys; signal.signal(signal.SIGINT, signal.{how}); "
    return [sys.executable, "-IS", "-c", then + "os.execv(sys.argv[1], sys.argv[1:])", *command]


def finished(store: Path) -> int:
    return sum(len(files) for _, _, files in os.walk(store / "ended" / "c"))


def same(store: Path, whole: xr.Dataset) -> None:
    found = so.Ensemble.open(store).dataset
    assert set(found.variables) == set(whole.variables)
    for name in whole.variables:
        assert found[name].dtype == whole[name].dtype
        np.testing.assert_array_equal(found[name].values, whole[name].values, err_msg=str(name))


def gone(processes: list[psutil.Process], patience: float = 20.0) -> None:
    """Nobody is left behind of a program that was killed."""
    _, alive = psutil.wait_procs(processes, timeout=patience)
    for process in alive:
        with contextlib.suppress(psutil.NoSuchProcess):
            process.kill()
    assert not alive


def whole_of(file: Path) -> xr.Dataset:
    return carried_out(read_ensemble(file).plan, threads=2).dataset


@pytest.mark.slow
def test_fifty_kills_at_random_moments(tmp_path: Path) -> None:
    """In threads and on workers in turn; what is finished only ever grows."""
    file, store = spec(tmp_path, ROOM), tmp_path / "map.zarr"
    moments, before, grew = random.Random(20), 0, 0
    for k in range(KILLS):
        program = begun(file, store, *MODES[k % len(MODES)])
        # A moment of the start, or of the work, however fast the machine is: never all of it.
        longest = moments.uniform(0.2, 2.2) if moments.random() < 0.4 else 30.0
        some, until = before + moments.randrange(1, 12), time.monotonic() + longest
        while finished(store) < some and time.monotonic() < until:
            time.sleep(0.01)
        time.sleep(moments.uniform(0.0, 0.1))
        assert program.poll() is None, program.communicate()
        children = psutil.Process(program.pid).children(recursive=True)
        os.kill(program.pid, signal.SIGKILL)
        program.communicate()
        gone(children)
        now = finished(store)
        assert now >= before
        grew += now > before
        before = now
    assert grew > KILLS / 3  # were killed in the middle of the work
    assert finished(store) < 4 * ROOM / CHUNK
    last = subprocess.run(command(file, store, "--threads", "2"), capture_output=True, text=True)
    assert last.returncode == 0, last.stderr
    same(store, whole_of(file))
    assert not [p for p in tmp_path.iterdir() if p not in (file, store)]


@pytest.mark.slow
def test_a_worker_that_is_killed_costs_nothing(tmp_path: Path) -> None:
    """The run goes on by itself; its chunk is flown by another."""
    file, store = spec(tmp_path, 400), tmp_path / "map.zarr"
    program = begun(file, store, "--workers", "2")
    killed = 0
    deadline = time.monotonic() + 60
    while killed < 3 and program.poll() is None and time.monotonic() < deadline:
        if finished(store) > 30 * killed + 5:
            workers = [
                p for p in psutil.Process(program.pid).children(recursive=True)
                if "spawn_main" in " ".join(p.cmdline())
            ]  # fmt: skip
            if workers:
                workers[-1].kill()
                killed += 1
        time.sleep(0.05)
    out, err = program.communicate(timeout=120)
    assert killed == 3
    assert program.returncode == 0, (out, err)
    assert err == ""
    same(store, whole_of(file))


@pytest.mark.slow
def test_stopped_by_the_keyboard(tmp_path: Path) -> None:
    file, store = spec(tmp_path, 1_600), tmp_path / "map.zarr"
    for mode in MODES[1], MODES[3]:
        program, before = begun(file, store, *mode), finished(store)
        deadline = time.monotonic() + 60
        while finished(store) < before + 10 and time.monotonic() < deadline:
            time.sleep(0.05)
        children = psutil.Process(program.pid).children(recursive=True)
        program.send_signal(signal.SIGINT)
        _, err = program.communicate(timeout=60)
        assert (program.returncode, err) == (130, "somersault: stopped\n")
        gone(children)
    last = subprocess.run(command(file, store), capture_output=True, text=True)
    assert last.returncode == 0, last.stderr
    same(store, whole_of(file))
