"""Many inputs, in processes that are watched: none may take long, die, or fail."""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

from .child import LONGEST
from .inputs import spoilt
from .readers import READERS

_LONGEST = 120.0  # s by the clock for one input, or to begin: one that sleeps; `child` bounds work
_BATCH = 400  # inputs to a process


@dataclass(frozen=True)
class Failure:
    """An input that ended as none may."""

    reader: str
    seed: int
    number: int
    why: str
    size: int

    def write(self, folder: Path, rank: int) -> None:
        """Write the input and what is wrong with it to a folder of its own."""
        place = folder / f"{rank:03d}-{self.reader}-{self.seed}-{self.number}"
        place.mkdir(parents=True)
        spoilt(READERS[self.reader], self.seed, self.number).write(place)
        (place / "WHY").write_text(self.why + "\n", encoding="utf-8")


@dataclass
class Report:
    """How the inputs of each reader ended."""

    counts: dict[str, Counter[str]] = field(default_factory=dict)
    failures: list[Failure] = field(default_factory=list)

    def add(self, reader: str, counts: Counter[str], failures: list[Failure]) -> None:
        """Add a batch."""
        self.counts.setdefault(reader, Counter()).update(counts)
        self.failures += failures

    def write(self, folder: Path) -> None:
        """Write the inputs that failed, the smallest first."""
        for rank, failure in enumerate(sorted(self.failures, key=lambda f: f.size)):
            failure.write(folder, rank)

    def __str__(self) -> str:
        rows = [f"{'reader':<14}{'inputs':>8}{'read':>8}{'refused':>9}{'failed':>8}"]
        total: Counter[str] = Counter()
        for name, counts in [*self.counts.items(), ("all", total)]:
            rows.append(
                f"{name:<14}{counts.total():>8}{counts['read']:>8}{counts['refused']:>9}"
                f"{counts['failed']:>8}"
            )
            total.update(counts)
        return "\n".join(rows)


def run(
    count: int,
    seed: int,
    readers: tuple[str, ...] = tuple(READERS),
    jobs: int = 2,
    said: Callable[[str], None] = lambda _: None,
) -> Report:
    """Read `count` inputs altogether, shared among the readers."""
    shares = {name: READERS[name].share for name in readers}
    whole = sum(shares.values())
    batches = [
        (name, first, min(first + _BATCH, of_reader))
        for name, share in shares.items()
        for of_reader in [max(1, round(count * share / whole))]
        for first in range(0, of_reader, _BATCH)
    ]
    report = Report()
    with ThreadPoolExecutor(jobs) as pool:
        done = pool.map(lambda batch: _batch(*batch, seed, said), batches)
        for (name, _, _), (counts, failures) in zip(batches, done, strict=True):
            report.add(name, counts, failures)
    return report


def _batch(
    reader: str, first: int, last: int, seed: int, said: Callable[[str], None]
) -> tuple[Counter[str], list[Failure]]:
    """Read some inputs, in a new process after each that hangs or dies."""
    counts: Counter[str] = Counter()
    failures = []
    while first < last:
        for number, ended, why in _child(reader, first, last, seed):
            counts[ended] += 1
            if ended == "failed":
                size = spoilt(READERS[reader], seed, number).size
                failures.append(Failure(reader, seed, number, why, size))
                said(f"{reader} {number}: {why}")
            first = number + 1
    return counts, failures


def _child(reader: str, first: int, last: int, seed: int) -> Iterator[tuple[int, str, str]]:
    """Number, end and reason of each input, up to one at which the process hangs or dies."""
    package = __package__ or "fuzz"
    root = Path(__file__).parents[len(package.split("."))]
    sources = [str(root), os.environ.get("PYTHONPATH", "")]
    process = subprocess.Popen(
        [sys.executable, "-m", f"{package}.child", reader, str(seed), str(first), str(last)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        stdin=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sources)),
             "OPENBLAS_NUM_THREADS": "1", "SOMERSAULT_THREADS": "1"},
    )  # fmt: skip
    number, ended = None, "the process ended"
    try:
        for line in _lines(process):
            if line is None:
                ended = f"it waited for {_LONGEST:g} s"
                break
            answer = json.loads(line)
            number = answer["number"]
            if number >= first:
                yield number, answer["ended"], _why(answer)
    finally:
        process.kill()
        _, errors = process.communicate()
    if number is None:
        raise RuntimeError(f"the process that reads did not begin: {errors.decode()[-2000:]}")
    if number + 1 < last:
        code = process.returncode
        if code == -signal.SIGPROF:
            ended = f"it worked for {LONGEST:g} s"
        yield number + 1, "failed", f"{ended} ({code}) {errors.decode(errors='replace')[-300:]}"


def _why(answer: dict[str, object]) -> str:
    return (
        "" if "why" not in answer else f"{answer['why']} at {answer['at']} after {answer['done']}"
    )


def _lines(process: subprocess.Popen[bytes]) -> Iterator[bytes | None]:
    """Lines as they come; None when one has not come in time."""
    assert process.stdout is not None
    handle = process.stdout.fileno()
    waiting = b""
    until = time.monotonic() + _LONGEST
    while True:
        ready, _, _ = select.select([handle], [], [], max(0.0, until - time.monotonic()))
        if not ready:
            yield None
            return
        data = os.read(handle, 65536)
        if not data:
            return
        *lines, waiting = (waiting + data).split(b"\n")
        if lines:
            until = time.monotonic() + _LONGEST
        yield from lines
