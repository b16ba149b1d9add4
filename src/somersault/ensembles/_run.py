"""The chunks of an ensemble on this machine, in threads."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from contextlib import contextmanager
from itertools import islice

from somersault._core.array import Array
from somersault._core.notes import note
from somersault._core.stages import stage
from somersault.engine import Stop, cores, use_threads
from somersault.ensembles._chunks import Chunks
from somersault.ensembles._plan import Plan

Put = Callable[[int, Mapping[str, Array]], None]
Advance = Callable[[int], None]  # so many more flights are done

_SETTLED = 3.0  # s, before an estimate is worth telling
_LONG = 3600.0  # s
_OFTEN = 0.1  # s: not every system ends a wait for an interrupt


def on_threads(
    plan: Plan, chunks: Chunks, left: list[int], put: Put, advance: Advance, threads: int | None
) -> None:
    """Run the chunks that are `left`, each in one thread, and hand their rows to `put` in this one.

    Fewer chunks than threads are each shared out among several.
    """
    if not left:
        return
    most = threads or cores()
    side_by_side = min(most, len(left))
    if side_by_side > 1:  # what is compiled, before several threads would
        first = chunks.runs(left[0])[0]
        plan.run(first, first + 1)

    stop = Stop()

    def run(k: int) -> tuple[int, Mapping[str, Array]]:
        with stop.heeded():
            return k, rows_of(plan, chunks, k, most // side_by_side)

    with ThreadPoolExecutor(side_by_side) as pool:
        try:
            for k, rows in _as_done(pool, left, 2 * side_by_side, run):
                put(k, rows)
                advance(chunks.size(k))
        except BaseException:
            stop.set()
            raise


def rows_of(plan: Plan, chunks: Chunks, k: int, threads: int) -> Mapping[str, Array]:
    """The rows of chunk k, on so many threads."""
    with use_threads(threads):
        return plan.run(*chunks.runs(k))


def _as_done(
    pool: ThreadPoolExecutor, left: Iterable[int], most: int,
    run: Callable[[int], tuple[int, Mapping[str, Array]]],
) -> Iterator[tuple[int, Mapping[str, Array]]]:  # fmt: skip
    """Chunks and rows as they finish, never more than `most` begun and not handed on."""
    ahead = iter(left)
    running = {pool.submit(run, k) for k in islice(ahead, most)}
    try:
        while running:
            done, running = wait(running, _OFTEN, FIRST_COMPLETED)
            running |= {pool.submit(run, k) for k in islice(ahead, len(done))}
            while done:
                yield done.pop().result()
    finally:
        for future in running:
            future.cancel()


@contextmanager
def progress(total: int, done: int, shown: bool, called: str = "flights") -> Iterator[Advance]:
    """How far `total` flights are, `done` before: shown as a bar with share, rate and time left on
    standard error, or noted once if they will take very long."""
    if total == done:
        yield lambda more: None
    elif shown:
        with _bar(total, done, called) as advance:
            yield advance
    else:
        yield _Estimate(total - done, called).advance


class _Estimate:
    """Notes once, when some of so many flights are done, that the rest will take very long."""

    def __init__(self, left: int, called: str) -> None:
        self.left, self.done, self.noted, self.called = left, 0, False, called
        self.begun: float | None = None  # when the first were done: before, much is made ready

    def advance(self, more: int) -> None:
        self.left -= more
        if self.begun is None:
            self.begun = time.monotonic()
            return
        self.done += more
        elapsed = time.monotonic() - self.begun
        remaining = elapsed / self.done * self.left
        if not self.noted and elapsed > _SETTLED and remaining > _LONG:
            self.noted = True
            note(
                f"{self.left:,} {self.called} are left, which at {self.done / elapsed:,.0f} a "
                f"second will take about {in_words(remaining)}; fewer of them, or more machines, "
                "take less"
            )


def in_words(seconds: float) -> str:
    """A long time, about."""
    for unit, size in (("years", 31_557_600), ("days", 86_400), ("hours", 3_600)):
        if seconds >= 2 * size:
            return f"{seconds / size:,.0f} {unit}"
    return f"{seconds / 60:,.0f} minutes" if seconds >= 120 else f"{seconds:,.0f} s"


@contextmanager
def _bar(total: int, done: int, called: str) -> Iterator[Advance]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, ProgressColumn, Task, TextColumn
    from rich.text import Text

    class Left(ProgressColumn):
        """From the first chunk on, where rich waits for a second one."""

        def render(self, task: Task) -> Text:
            flown, elapsed = task.completed - done, task.elapsed
            if not flown or not elapsed:
                return Text("in the first chunk")
            left = (total - task.completed) * elapsed / flown
            return Text(f"{flown / elapsed:,.0f}/s, {in_words(left)} left")

    with stage(""), Progress(
        TextColumn(f"{{task.completed:,.0f}} of {{task.total:,.0f}} {called}, "
                   "{task.percentage:.3g} %"),
        BarColumn(bar_width=10), Left(), console=Console(stderr=True), transient=True,
    ) as bar:  # fmt: skip
        task = bar.add_task("", total=total, completed=done)
        yield lambda more: bar.update(task, advance=more)
