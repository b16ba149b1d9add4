"""An interrupt at any moment ends any command, and nothing is left behind."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import psutil
import pytest
from test_ensembles_killed import SPEC, hearing, same, spec, whole_of

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")

PATIENCE = 60.0  # s, on a machine that has much else to do
LONG = """
model = "furrer"
duration = {duration}
steps = 1000000000
[takeoff]
tilt = 0.02
spin = 8.64
[joints.shoulder]
motion = "sprung"
angle = 0.3
rest = 0.2
stiffness = 1e7
"""
ASKED = """
model = "furrer"
[plan]
torque = 60.0
nodes = 40
starts = 8
[plan.joints]
shoulder = [0.2, 2.8]
"""
CHOSEN = """
[choose.spin]
sets = "takeoff.spin"
between = [8.0, 9.0]
[objective]
kind = "mean"
quantity = "time"
largest = true
counts_as = 0.0
[search]
evaluations = 400
held_out = 64
"""
# What is flown and drawn, by name, without outputs; {} is a folder with the files of `files`.
COMMANDS: dict[str, list[str]] = {
    "fly": ["fly", "{}/long.toml"],
    "film": ["fly", "{}/short.toml", "--video", "{}/out/film.gif"],
    "page": ["fly", "{}/short.toml", "--page", "{}/out/page.html", "--out", "{}/out/short.nc"],
    "memory": ["ensemble", "{}/many.toml"],
    "netcdf": ["ensemble", "{}/many.toml", "--out", "{}/out/many.nc"],
    "threads": ["ensemble", "{}/some.toml", "--out", "{}/out/map.zarr", "--chunk", "8"],
    "workers": ["ensemble", "{}/some.toml", "--out", "{}/out/map.zarr", "--chunk", "8",
                "--workers", "2"],
    "reproduce": ["reproduce", "ch3", "ch4", "--out", "{}/out/report"],
    "stability": ["stability", "gymnast"],
    "plan": ["plan", "{}/asked.toml", "--out", "{}/out/plan.toml", "--processes", "2"],
    "design": ["design", "{}/chosen.toml", "--out", "{}/out/design"],
    "map": ["map", "human_layout", "--out", "{}/out/map.png"],
}  # fmt: skip


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Where the files of `COMMANDS` are, and what they write and throw away goes."""
    for name in ("out", "temporary"):
        (tmp_path / name).mkdir()
    (tmp_path / "long.toml").write_text(LONG.format(duration=3e3))
    (tmp_path / "short.toml").write_text(LONG.format(duration=10.0))
    (tmp_path / "many.toml").write_text(SPEC.format(size=100_000))
    (tmp_path / "some.toml").write_text(SPEC.format(size=100))
    (tmp_path / "asked.toml").write_text(ASKED)
    (tmp_path / "chosen.toml").write_text(SPEC.format(size=64) + CHOSEN)
    return tmp_path


def begun(arguments: Sequence[str], folder: Path, how: str = "SIG_DFL") -> subprocess.Popen[str]:
    """A command in a process group of its own, as a shell begins it."""
    return subprocess.Popen(
        hearing([sys.executable, "-m", "somersault", *(w.format(folder) for w in arguments)], how),
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", process_group=0,
        env={**os.environ, "TMPDIR": str(folder / "temporary")},
    )  # fmt: skip


def heeds(program: subprocess.Popen[str]) -> bool:
    """Whether it is its own program already, and not yet Python that starts."""
    return _has(program, "SigCgt", signal.SIGTERM)


def _has(program: subprocess.Popen[str], mask: str, number: int) -> bool:
    """Whether a signal is in one of the masks that the system shows of a program."""
    try:
        status = Path(f"/proc/{program.pid}/status").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return False
    found = [line for line in status.splitlines() if line.startswith(mask)]
    return bool(found) and bool(int(found[0].split()[1], 16) & 1 << number - 1)


def wait_until(true: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not true() and time.monotonic() < deadline:
        time.sleep(0.002)
    assert true()


def nothing_is_left(program: subprocess.Popen[str], folder: Path) -> None:
    wait_until(lambda: not [p for p in psutil.process_iter() if _is_of(p, program.pid)])
    assert not list((folder / "temporary").iterdir())
    left = [*folder.rglob(".somersault-*"), *folder.rglob("*.partial")]
    assert not left


def _is_of(process: psutil.Process, group: int) -> bool:
    try:
        return os.getpgid(process.pid) == group and process.status() != psutil.STATUS_ZOMBIE
    except (ProcessLookupError, psutil.NoSuchProcess):
        return False


def interrupted(name: str, moment: float, folder: Path) -> float:
    """Seconds that a command took to end when the keyboard interrupted it."""
    program = begun(COMMANDS[name], folder)
    wait_until(lambda: heeds(program) or program.poll() is not None)
    time.sleep(moment)
    over = program.poll() is not None
    if not over:
        os.killpg(program.pid, signal.SIGINT)
    since = time.monotonic()
    out, err = program.communicate(timeout=PATIENCE)
    took = time.monotonic() - since
    if program.returncode == 130:
        assert err == "somersault: stopped\n", (name, moment)
    else:
        assert program.returncode == 0, (name, moment, err)
        assert out
    nothing_is_left(program, folder)
    return took


@pytest.mark.parametrize(
    ("name", "moment"),
    [("fly", 4.0), ("memory", 0.3), ("threads", 0.0), ("workers", 3.0), ("plan", 4.0)],
)
def test_a_command_is_interrupted(name: str, moment: float, folder: Path) -> None:
    interrupted(name, moment, folder)


def test_workers_leave_nothing_where_temporary_files_go(folder: Path) -> None:
    """Not even the folder that dask's scheduler wants for itself."""
    words = ["ensemble", "{}/few.toml", "--workers", "1", "--json"]
    (folder / "few.toml").write_text(SPEC.format(size=4))
    program = begun(words, folder)
    _, err = program.communicate(timeout=PATIENCE)
    assert program.returncode == 0, err
    nothing_is_left(program, folder)


@pytest.mark.slow
@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_is_interrupted_at_any_moment(
    name: str, folder: Path, record_property: Callable[[str, object], None]
) -> None:
    """A store goes on afterwards to the same bits."""
    moments = random.Random(name)
    took = sorted(interrupted(name, moments.uniform(0.0, 4.0), folder) for _ in range(10))
    record_property("seconds", [round(t, 3) for t in took])
    if "zarr" in " ".join(COMMANDS[name]):
        program = begun(COMMANDS["threads"], folder)
        _, err = program.communicate(timeout=10 * PATIENCE)
        assert (program.returncode, err) == (0, "")
        same(folder / "out" / "map.zarr", whole_of(spec(folder, 100)))


def test_a_signal_to_terminate_does_the_same(folder: Path) -> None:
    program = begun(COMMANDS["fly"], folder)
    wait_until(lambda: heeds(program))
    program.terminate()
    _, err = program.communicate(timeout=PATIENCE)
    assert (program.returncode, err) == (143, "somersault: stopped\n")
    nothing_is_left(program, folder)


def test_a_command_in_the_background_goes_on(folder: Path) -> None:
    """A shell has it ignore interrupts, which are for what is in front."""
    program = begun(["map", "human_layout"], folder, "SIG_IGN")
    wait_until(lambda: _has(program, "SigIgn", signal.SIGINT))
    deadline = time.monotonic() + PATIENCE
    while program.poll() is None and time.monotonic() < deadline:
        program.send_signal(signal.SIGINT)
        time.sleep(0.02)
    out, err = program.communicate(timeout=PATIENCE)
    assert (program.returncode, err) == (0, "")
    assert out


PYTHON = """
import _thread, signal, threading
import somersault as so

signal.signal(signal.SIGINT, signal.default_int_handler)  # what starts in the background ignores it

takeoff = so.Takeoff(spin=8.64, tilt=0.01)
shaking = so.JointTakeoff.sprung(0.3, rest=0.2, stiffness=1e7)
stiff = so.Takeoff(spin=8.64, tilt=0.01, joints={{"shoulder": shaking}})
before = so.fly("furrer", takeoff, 1.0).landing.twist
leant = {{"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.02])}}
options = {{"steps": 10**9, "size": 40}}
so.fly("furrer", stiff, 0.01)
so.ensemble("furrer", takeoff, 1.0, leant, **options)  # all is imported and compiled
threading.Timer(0.5, _thread.interrupt_main).start()
try:
    {call}
except KeyboardInterrupt:
    assert so.fly("furrer", takeoff, 1.0).landing.twist == before
    print("interrupted")
"""


@pytest.mark.parametrize(
    "call",
    [
        'so.fly("furrer", stiff, 3e3, steps=10**9)',
        'so.ensemble("furrer", takeoff, 1e6, leant, **options)',
        'so.ensemble("furrer", takeoff, 1e6, leant, **options, threads=1)',
        'so.ensemble("furrer", takeoff, 1e6, leant, **options, chunk=3)',
    ],
)
def test_in_python_compiled_flights_are_given_up(call: str) -> None:
    """Each would take many seconds, or hours."""
    run = subprocess.run(
        [sys.executable, "-c", PYTHON.format(call=call)],
        capture_output=True, text=True, timeout=4 * PATIENCE,
    )  # fmt: skip
    assert (run.stdout, run.stderr) == ("interrupted\n", "")
