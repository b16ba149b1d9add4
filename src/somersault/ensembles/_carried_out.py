"""The ensemble of a plan: its chunks run, on threads or a cluster, into memory or a store."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault._core.checks import instance, text, truth, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault._core.stages import stage
from somersault.ensembles import _run, _store
from somersault.ensembles._begin import create
from somersault.ensembles._chunks import Chunks, chunked
from somersault.ensembles._memory import empty_dataset, run_bytes
from somersault.ensembles._plan import Plan
from somersault.ensembles._result import Ensemble, check_out
from somersault.ensembles._scheduler import check_scheduler, check_security

if TYPE_CHECKING:
    from distributed.security import Security

_MOST_CHUNK = 10**9  # flights
_MOST_THREADS = 1024
_MOST_WORKERS = 256  # processes, of some hundred megabytes each
_CHUNK = 131_072  # flights
_LEAST_CHUNK = 8_192
_PARTS = 8  # that a small ensemble is cut into
_CHUNK_BYTES = 2**26
_MEMORY_BYTES = 2**31  # that a dataset without a store may take


def carried_out(
    plan: Plan, out: str | Path | None = None, chunk: int | None = None,
    threads: int | None = None, workers: int | None = None, scheduler: str | None = None,
    security: Security | None = None, progress: bool = False,
) -> Ensemble:  # fmt: skip
    """The ensemble of a plan; with a store, what is left of it is run.

    Parameters
    ----------
    plan : Plan
        Made by `ensembles.plan`.
    out, chunk, threads, workers, scheduler, security, progress
        As for `ensemble`.

    Returns
    -------
    Ensemble

    Raises
    ------
    SomersaultError
        For what does not fit, and for a store of another specification.
    """
    instance("plan", plan, Plan)
    for what, value, most in (
        ("chunk", chunk, _MOST_CHUNK), ("threads", threads, _MOST_THREADS),
        ("workers", workers, _MOST_WORKERS),
    ):  # fmt: skip
        if value is not None:
            whole_number(what, value, 1, most)
    truth("progress", progress)
    if scheduler is not None:
        text("scheduler", scheduler)
    if security is not None:
        if scheduler is None:
            raise SomersaultError("certificates are for a scheduler; give its address, tls://…")
        check_security(security)
    whole = out is not None and check_out(out)
    if workers is not None and scheduler is not None:
        raise SomersaultError("workers and scheduler are both given; give one of them")
    chunks = chunked(plan.dims, chunk or chunk_size(plan))
    if out is None or whole:
        found = _in_memory(plan, chunks, threads, workers, scheduler, security, progress)
        if out is not None:
            _save(found, out)
        return found
    file = Path(out)
    if file.exists():
        chunks = _store.resume(file, plan)
    else:
        if scheduler is not None:  # before anything is written
            check_scheduler(scheduler, security)
        create(file, plan, chunks)
        chunks = _store.resume(file, plan)  # which another program may have made meanwhile
    with stage(f"looking at {len(chunks):,} chunks of the store"):
        done = _store.finished(file, plan, chunks)
    left = [k for k in range(len(chunks)) if k not in done]
    if left:
        _store.note_processor(file)

    def put(k: int, rows: Mapping[str, Any]) -> None:
        _store.write(file, plan, chunks, k, rows)

    _run_chunks(plan, chunks, left, put, file, threads, workers, scheduler, security, progress)
    _store.tidy(file)
    return Ensemble(_store.opened(file), plan)


def _run_chunks(
    plan: Plan, chunks: Chunks, left: list[int], put: _run.Put, file: Path | None,
    threads: int | None, workers: int | None, scheduler: str | None, security: Security | None,
    shown: bool,
) -> None:  # fmt: skip
    remaining = sum(map(chunks.size, left))
    called = plan.simulation.endings.called
    with _run.progress(plan.count, plan.count - remaining, shown, called) as advance:
        if left and (workers is not None or scheduler is not None):
            from somersault.ensembles._cluster import on_cluster

            on_cluster(
                plan, chunks, left, put, advance, file, threads, workers, scheduler, security
            )
        else:
            _run.on_threads(plan, chunks, left, put, advance, threads)


def _save(found: Ensemble, out: str | Path) -> None:
    """Write it as NetCDF; what was run is not thrown away for want of room on a disk."""
    try:
        found.save(out)
    except OSError as trouble:
        note(
            f"{out} could not be written ({trouble.strerror}): the ensemble is in memory alone; "
            "`save` it to another place"
        )


def _in_memory(
    plan: Plan, chunks: Chunks, threads: int | None, workers: int | None,
    scheduler: str | None, security: Security | None, shown: bool,
) -> Ensemble:  # fmt: skip
    if plan.count * run_bytes(plan) > _MEMORY_BYTES:
        raise SomersaultError(
            f"{plan.count:,} {plan.simulation.endings.called} would fill the memory; write them to "
            "a Zarr store, MAP.zarr"
        )
    data, put = empty_dataset(plan, chunks)
    every = list(range(len(chunks)))
    _run_chunks(plan, chunks, every, put, None, threads, workers, scheduler, security, shown)
    return Ensemble(data, plan)


def chunk_size(plan: Plan) -> int:
    """Flights in a chunk: about a second of work, some megabytes."""
    fitting = max(_CHUNK_BYTES // run_bytes(plan), 64)
    least = min(_LEAST_CHUNK, plan.simulation.together)  # a robot's run is long
    return min(fitting, _CHUNK, max(least, -(-plan.count // _PARTS)))
