"""The chunks of an ensemble on this machine, in threads."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from contextlib import contextmanager
from itertools import islice

from somersault._core.array import Array
from somersault._core.stages import stage
from somersault.engine import Stop, cores, use_threads
from somersault.ensembles._chunks import Chunks
from somersault.ensembles._plan import Plan

Put = Callable[[int, Mapping[str, Array]], None]
Advance = Callable[[int], None]  # so many more flights are done

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
def progress_bar(total: int, done: int, shown: bool) -> Iterator[Advance]:
    """A bar with rate and time left on standard error, for `total` flights, `done` before."""
    if not shown or total == done:
        yield lambda more: None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        ProgressColumn,
        Task,
        TextColumn,
        TimeRemainingColumn,
    )
    from rich.text import Text

    class Rate(ProgressColumn):
        def render(self, task: Task) -> Text:
            return Text(f"{task.speed:,.0f} flights/s" if task.speed else "")

    with stage(""), Progress(
        TextColumn("{task.completed:,.0f} of {task.total:,.0f} flights"), BarColumn(), Rate(),
        TimeRemainingColumn(), console=Console(stderr=True), transient=True,
    ) as bar:  # fmt: skip
        task = bar.add_task("", total=total, completed=done)
        yield lambda more: bar.update(task, advance=more)
