"""Read many inputs in one process and say of each, on one line of JSON, how it ended.

    python -m tests.fuzz.child READER SEED FIRST LAST

The process has bounded memory; whoever started it watches the time, and that it lives.
"""

from __future__ import annotations

import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import traceback
import warnings
from pathlib import Path
from typing import Any, TextIO

import numpy as np

import somersault as so

from .forked import programs_forked
from .inputs import Input, spoilt
from .readers import READERS, Reader, flown, one_sentence

LONGEST = 20.0  # s of work for one input
MEMORY = 2 * 2**30  # bytes beyond what the imports took
_USED = 0.04  # the share of inputs that are flown
_ASKED = 0.03  # the share of inputs that go through the command line
_UNSEEN: list[str] = []  # exceptions of finalizers, which Python prints with a traceback


def main() -> None:
    """Read the inputs of some numbers."""
    name, seed, first, last = sys.argv[1], *map(int, sys.argv[2:5])
    reader = READERS[name]
    with os.fdopen(os.dup(1), "w", encoding="utf-8") as told:  # libraries may write to 1 and 2
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        _warm_up(reader)
        sys.unraisablehook = lambda trouble: _UNSEEN.append(repr(trouble.exc_value))
        _bound_memory()
        _tell(told, number=first - 1)
        with programs_forked():
            for number in range(first, last):
                rng = np.random.default_rng([seed, number])
                signal.setitimer(signal.ITIMER_PROF, LONGEST)  # its signal ends the process
                _tell(told, number=number, **outcome(reader, spoilt(reader, seed, number), rng))


def _tell(told: TextIO, **what: Any) -> None:
    told.write(json.dumps(what) + "\n")
    told.flush()


def _warm_up(reader: Reader) -> None:
    """Import what will be needed, before memory is bounded."""
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for number, good in enumerate(reader.good()):
            place = Path(folder, str(number))
            place.mkdir()
            thing = reader.read(Input(good, next(iter(good)), ()).write(place))
            reader.check(thing)
            if reader.use is not None and number == 0:
                reader.use(thing, np.random.default_rng(0))
        flown(so.load("book"), np.random.default_rng(0))


def _bound_memory() -> None:
    taken = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    _, most = resource.getrlimit(resource.RLIMIT_AS)  # which a forked program may set anew
    resource.setrlimit(resource.RLIMIT_AS, (taken + MEMORY, most))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def outcome(reader: Reader, given: Input, rng: np.random.Generator) -> dict[str, Any]:
    """How the reading of an input ended: "read", "refused", or "failed" and why."""
    place = Path(tempfile.mkdtemp(prefix="fuzz-"))
    try:
        file = given.write(place)
        before = _listing(place)
        os.chdir(place)
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # NumPy's are noise on the user's screen
            warnings.simplefilter("ignore", so.SomersaultWarning)
            ended = _read(reader, file, rng)
        after = _listing(place)
        assert after == before, f"it left {sorted(set(after) ^ set(before))} in the folder"
        assert not _UNSEEN, f"while cleaning up: {_UNSEEN}"
        return {"ended": ended}
    except BaseException as trouble:
        where = traceback.extract_tb(trouble.__traceback__)
        places = [f"{Path(f.filename).name}:{f.lineno}" for f in where]
        why = f"{type(trouble).__name__}: {str(trouble)[:500]}"
        return {"ended": "failed", "why": why, "at": places[-4:], "done": given.done}
    finally:
        _UNSEEN.clear()
        os.chdir("/")
        shutil.rmtree(place, ignore_errors=True)


def _read(reader: Reader, file: Path, rng: np.random.Generator) -> str:
    ended = "read"
    try:
        thing = reader.read(file)
    except so.SomersaultError as mistake:
        one_sentence(mistake)
        ended = "refused"
    else:
        reader.check(thing)
        repr(thing)
        if reader.use is not None and rng.uniform() < _USED:
            reader.use(thing, rng)
    if reader.commands and rng.uniform() < _ASKED:
        _ask(reader, file, rng)
    return ended


def _ask(reader: Reader, file: Path, rng: np.random.Generator) -> None:
    """The same through the command line: exit 0, or 2 and a sentence."""
    import contextlib
    import io

    from somersault.cli import main as command_line

    words = reader.commands[int(rng.integers(len(reader.commands)))]
    out, err = io.StringIO(), io.StringIO()
    with tempfile.TemporaryDirectory() as place:
        places = {"FILE": str(file), "BESIDE": str(file.parent), "OUT": f"{place}/out"}
        for name, there in places.items():
            words = tuple(word.replace(name, there) for word in words)
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = command_line(words)
        left = sorted(os.listdir(place))
    said = err.getvalue()
    assert code in (0, 2), f"{words}: exit {code}"
    assert "Traceback" not in said, f"{words}: {said[-500:]}"
    if code == 2:
        assert said.strip(), f"{words}: exit 2 and nothing said"
        assert not left or left == ["out.zarr"], f"{words} failed and left {left}"


def _listing(place: Path) -> dict[str, int]:
    return {
        str(file.relative_to(place)): file.lstat().st_size
        for file in place.rglob("*")
        if not file.is_symlink()
    }


if __name__ == "__main__":
    main()
