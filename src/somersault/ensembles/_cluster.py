"""The chunks of an ensemble on the workers of dask.distributed.

A task is a plan and the number of a chunk. A worker that sees the store writes the chunk itself;
one that does not sends its rows to the program, which writes them. Chunks of a worker that dies are
given to others; what the program had finished stays finished if it, or the scheduler, dies.
"""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from collections.abc import Iterator, Mapping
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager, suppress
from functools import lru_cache, partial
from itertools import islice
from multiprocessing import current_process
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.files import temporary_folder
from somersault._core.interrupts import children_unaware
from somersault._core.notes import note
from somersault.engine import cores, processor
from somersault.ensembles import _run, _store
from somersault.ensembles._chunks import Chunks
from somersault.ensembles._kept import workers_kept
from somersault.ensembles._plan import Plan
from somersault.ensembles._scheduler import connected, note_open_door, unlogged
from somersault.ensembles._versions import versions

if TYPE_CHECKING:
    from distributed import Client, LocalCluster
    from distributed.security import Security

_WAIT_FOR_WORKERS = 60.0
_AHEAD = 2  # tasks a worker has before it
_TRIM_BYTES = 2**27
_DEATHS = 20  # of workers in one chunk, after which it is the chunk's fault


def on_cluster(
    plan: Plan, chunks: Chunks, left: list[int], put: _run.Put, advance: _run.Advance,
    file: Path | None, threads: int | None, workers: int | None, scheduler: str | None,
    security: Security | None,
) -> None:  # fmt: skip
    """Run the chunks that are `left` on processes of this machine, or on those of a scheduler."""
    with workers_kept() as kept:
        if scheduler is not None:
            found = kept.client((scheduler, id(security)), partial(_found, scheduler, security))
            _carry(found, plan, chunks, left, put, advance, file, threads, scheduler)
            return
        assert workers is not None
        each = threads or max(1, cores() // workers)
        begun = kept.client(workers, partial(_begun, workers))
        _carry(begun, plan, chunks, left, put, advance, file, each, "this machine")


def _found(scheduler: str, security: Security | None, open_now: ExitStack) -> Client:
    """A connection to a scheduler."""
    _quiet(open_now)
    client = open_now.enter_context(connected(scheduler, security))
    note_open_door(scheduler)
    return client


def _begun(workers: int, open_now: ExitStack) -> Client:
    """A connection to so many processes of this machine, which end with it."""
    import dask
    from distributed import Client, LocalCluster

    if getattr(current_process(), "_inheriting", False):
        sys.exit()  # a process that reads the script it is begun by: the one that began it says why
    _quiet(open_now)
    folder = open_now.enter_context(temporary_folder())
    # The scheduler's own files too, for which `LocalCluster` takes no folder.
    open_now.enter_context(dask.config.set({"temporary-directory": str(folder)}))
    with children_unaware():  # of interrupts: the program ends them
        try:
            cluster = LocalCluster(
                n_workers=workers, threads_per_worker=1, processes=True, host="127.0.0.1",
                dashboard_address=None, silence_logs="CRITICAL", local_directory=str(folder),
                preload="somersault.ensembles._worker",
            )  # fmt: skip
        except RuntimeError:
            raise SomersaultError(
                "the processes of the workers ended as soon as they had begun: each reads the "
                "script first, which must begin workers only where it is run itself, below "
                "if __name__ == '__main__':"
            ) from None
        open_now.enter_context(cluster)
        open_now.enter_context(_ended_at_once(cluster))
    return open_now.enter_context(Client(cluster))


def _quiet(open_now: ExitStack) -> None:
    """dask's settings while a connection is open."""
    import dask
    import distributed  # noqa: F401  # puts its own there first; else they would go with these

    settings = {
        "distributed.scheduler.allowed-failures": _DEATHS,
        "distributed.comm.retry.count": 0,
        # dask would have workers give memory back after every array, and ask for it again.
        "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": _TRIM_BYTES,
    }
    open_now.enter_context(dask.config.set(settings))
    open_now.enter_context(unlogged())


@contextmanager
def _ended_at_once(cluster: LocalCluster) -> Iterator[None]:
    """Where the program goes on after an interrupt, its workers do not finish their chunks."""
    try:
        yield
    except KeyboardInterrupt:
        for nanny in cluster.workers.values():
            nanny.auto_restart = False
            with suppress(ProcessLookupError):
                os.kill(nanny.pid, signal.SIGTERM)
        raise


def _carry(
    client: Client, plan: Plan, chunks: Chunks, left: list[int], put: _run.Put,
    advance: _run.Advance, file: Path | None, threads: int | None, where: str,
) -> None:  # fmt: skip
    from distributed.scheduler import KilledWorker

    try:
        client.wait_for_workers(1, timeout=_WAIT_FOR_WORKERS)
        _check_versions(client, plan.versions)
        _note_processors(client)
        shared = client.scatter(plan, broadcast=False, hash=False)
        path = None if file is None else str(file.resolve())
        for k in _as_done(client, shared, chunks, left, put, path, threads, plan.versions):
            advance(chunks.size(k))
        if file is not None:  # a worker may have written into a copy of the store at its path
            done = _store.finished(file, plan, chunks)
            lost = [k for k in left if k not in done]
            for _ in _as_done(client, shared, chunks, lost, put, None, threads, plan.versions):
                pass
    except KilledWorker:
        raise SomersaultError(
            f"a chunk has killed {_DEATHS} workers at {where}, perhaps for want of memory; give a "
            "smaller chunk; what is finished is kept"
        ) from None
    except SomersaultError:
        raise
    except (OSError, TimeoutError, asyncio.CancelledError, CancelledError) as trouble:
        late = isinstance(trouble, TimeoutError)  # whose arguments only look like those of a file
        if isinstance(trouble, OSError) and not late and trouble.errno and trouble.filename:
            raise  # a full disk, say
        raise SomersaultError(
            f"the scheduler at {where} has gone, or has no workers; what is finished is kept: run "
            "the same command again to go on"
        ) from None


def _as_done(
    client: Client, shared: Any, chunks: Chunks, left: list[int], put: _run.Put,
    path: str | None, threads: int | None, wanted: dict[str, str],
) -> Iterator[int]:  # fmt: skip
    """Chunks as they are finished on the workers, no more of them ahead than keeps them busy."""
    from distributed import as_completed

    ahead = iter(left)

    def begin(busy: int) -> list[Any]:
        """As many more as there are workers now: some may have joined, or gone."""
        most = _AHEAD * len(client.scheduler_info(n_workers=-1)["workers"])
        return [
            client.submit(_chunk, shared, chunks, k, path, threads, wanted, pure=False)
            for k in islice(ahead, max(most - busy, 0 if busy else 1))
        ]

    running = as_completed(begin(0))
    for future in running:
        k, rows = future.result()
        if rows is not None:
            put(k, rows)
        future.release()
        for more in begin(running.count()):
            running.add(more)
        yield k


def _check_versions(client: Client, ours: dict[str, str]) -> None:
    """Refuse workers that would compute other last digits."""
    for address, theirs in client.run(versions, tuple(ours)).items():
        _compare(f"the worker {address}", theirs, ours)


def _note_processors(client: Client) -> None:
    """Warn of workers whose code may round otherwise than this program's."""
    others = sorted(set(client.run(processor).values()) - {processor()})
    if others:
        note(
            f"there are workers on {', '.join(others)}, and this program is on {processor()}: the "
            "last digits depend on who computes them; take workers of one kind if they "
            "matter"
        )


def _compare(who: str, theirs: dict[str, str], ours: dict[str, str]) -> None:
    for name, version in ours.items():
        if theirs[name] != version:
            raise SomersaultError(
                f"{who} has {name} {theirs[name]}, and this program {version}; install the same "
                "on both"
            )


def _chunk(
    plan: Plan, chunks: Chunks, k: int, path: str | None, threads: int | None,
    wanted: dict[str, str],
) -> tuple[int, Mapping[str, Array] | None]:  # fmt: skip
    """Run chunk k on a worker; its rows, unless it could write them itself."""
    _compare("a worker that joined later", versions(tuple(wanted)), wanted)
    rows = _run.rows_of(plan, chunks, k, threads or cores())
    if path is None or not _is_here(path, plan):
        return k, rows
    _store.write(Path(path), plan, chunks, k, rows)
    return k, None


def _is_here(path: str, plan: Plan) -> bool:
    """Whether this worker sees the store."""
    try:
        return _is_stored(path, (Path(path) / "zarr.json").stat().st_mtime_ns, plan)
    except OSError:
        return False


@lru_cache(maxsize=4)
def _is_stored(path: str, created: int, plan: Plan) -> bool:
    """Whether the store `created` (ns) at a path is a plan's: read once for all chunks."""
    return _store.is_of(Path(path), plan)
