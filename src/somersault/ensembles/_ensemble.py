"""`ensemble`: many flights of one maneuver, and what became of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault._core.checks import by_name, instance, name_list, text, truth, whole_number
from somersault._core.datasets import netcdf
from somersault._core.errors import SomersaultError
from somersault._core.files import write as write_file
from somersault.ensembles import _run, _store
from somersault.ensembles._plan import MOST_FLIGHTS, MOST_SEED, Plan, check
from somersault.ensembles._report import Report
from somersault.ensembles._targets import unit
from somersault.ensembles._vary import Vary
from somersault.flight._maneuver import (
    STEPS,
    Event,
    check_limits_of_flight,
    flight_time,
)
from somersault.flight._takeoff import Takeoff, require_takeoff
from somersault.model import Model, load

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_MOST = 10**9  # chunks, threads or workers
_CHUNK = 131_072  # flights
_LEAST_CHUNK = 8_192
_PARTS = 8  # that a small ensemble is cut into
_CHUNK_BYTES = 2**26
_MEMORY_BYTES = 2**31  # that a dataset without a store may take


@dataclass(frozen=True, eq=False)
class Ensemble:
    """Flights that differ in what was varied: `dataset` over the varied quantities."""

    dataset: xr.Dataset

    @staticmethod
    def open(path: str | Path) -> Ensemble:
        """An ensemble that was written before, whole or in part: a Zarr store, whose values are
        read when used, or NetCDF."""
        file = _path("path", path)
        if not file.exists():
            raise SomersaultError(f"there is no ensemble {str(path)!r}; check the path")
        return Ensemble(_store.opened(file))

    def fraction(
        self, good: Any = None, tolerance: float | None = None, **options: Any
    ) -> xr.Dataset:
        """The share of flights that came out right, with its confidence interval: see
        `ensembles.fraction`. `good` is a true-or-false array over the flights; without it those
        whose landing_error is at most `tolerance`."""
        from somersault.ensembles._summary import fraction, within

        chosen = within(self.dataset, tolerance) if good is None else good
        return fraction(chosen, self.dataset["ended"], **options)

    def quantiles(
        self, name: str, q: Sequence[float] = (0.05, 0.5, 0.95), **options: Any
    ) -> xr.Dataset:
        """Quantiles of a reported quantity over the flights that did not fail: see
        `ensembles.quantiles`."""
        from somersault.ensembles._summary import quantiles

        return quantiles(self.dataset, name, q, **options)

    def sensitivity(self, name: str, **options: Any) -> xr.Dataset:
        """How much of the variance of a reported quantity each drawn one makes, in order: see
        `ensembles.sensitivity`."""
        from somersault.ensembles._sensitivity import sensitivity

        return sensitivity(self.dataset, name, **options)

    def plot(self, name: str | None = None) -> Figure:
        """A picture of a reported quantity: a map over two grids, a band over one, or a
        histogram."""
        from somersault.ensembles._plot import plot

        return plot(self.dataset, name)


def ensemble(
    model: str | Model,
    takeoff: Takeoff | None = None,
    duration: float = 1.0,
    vary: Mapping[str, Vary] | None = None,
    *,
    size: int | None = None,
    seed: int = 0,
    sequence: str = "random",
    report: Report | Sequence[str] = Report.quantities,
    accuracy: float = 1e-7,
    until: Event | None = None,
    steps: int = STEPS,
    out: str | Path | None = None,
    chunk: int | None = None,
    threads: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: bool = False,
) -> Ensemble:
    """Many flights of a maneuver, differing in what is varied.

    `vary` names the varied quantities (`Vary`). Grids span dimensions of their own; everything
    drawn runs along `sample`, `size` of them, from the `seed`, as a "random", "sobol", "halton"
    or "saltelli" `sequence`. `report` is a `Report`, or the names of its quantities. `accuracy` and
    `until` are those of `fly`; a flight that takes `steps` steps of the integration and is not done
    has failed, and is marked.

    Without `out` the result stays in memory. A path that ends in .nc gets it as NetCDF in the
    end; any other is a Zarr store, which fills chunk by chunk (`chunk` flights each), and which
    the same call, stopped however, goes on with. Chunks are flown on `threads` (one a core), or
    on `workers` processes of dask.distributed, or by those of the `scheduler` at an address; the
    numbers are the same, bit for bit. Raises SomersaultError for what does not fit, and for a
    store of another specification.
    """
    planned = plan(
        model, takeoff, duration, vary, size, seed, sequence, report, accuracy, until, steps
    )
    return carried_out(planned, out, chunk, threads, workers, scheduler, progress)


def plan(
    model: str | Model, takeoff: Takeoff | None, duration: float,
    vary: Mapping[str, Vary] | None, size: int | None, seed: int, sequence: str,
    report: Report | Sequence[str], accuracy: float, until: str | None, steps: int,
) -> Plan:  # fmt: skip
    """What `ensemble` would fly; SomersaultError for what does not fit."""
    duration = flight_time(duration)
    check_limits_of_flight(accuracy, until, steps)
    takeoff = Takeoff() if takeoff is None else takeoff
    require_takeoff(takeoff)
    if not isinstance(report, Report):
        report = Report(name_list("report, unless it is a Report,", report))
    varied = {n: instance(f"vary.{n}", v, Vary) for n, v in by_name("vary", vary).items()}
    seed = whole_number("sample.seed", seed, 0, MOST_SEED)
    if size is not None:
        size = whole_number("sample.size", size, 1, MOST_FLIGHTS)
    if size is None:
        listed = [len(v.samples) for v in varied.values() if v.samples is not None]
        size = listed[0] if listed else 1
    made = Plan(
        load(model), takeoff, duration, varied, report, size, seed, sequence,
        float(accuracy), until, int(steps),
    )  # fmt: skip
    check(made)
    units = {name: unit(made.model, v, made.targets[name]) for name, v in varied.items()}
    return replace(made, vary={n: replace(v, unit=units[n]) for n, v in varied.items()})


def carried_out(
    plan: Plan, out: str | Path | None = None, chunk: int | None = None,
    threads: int | None = None, workers: int | None = None, scheduler: str | None = None,
    progress: bool = False,
) -> Ensemble:  # fmt: skip
    """Fly a plan, or what is left of it."""
    for what, value in (("chunk", chunk), ("threads", threads), ("workers", workers)):
        if value is not None:
            whole_number(what, value, 1, _MOST)
    truth("progress", progress)
    if scheduler is not None:
        text("scheduler", scheduler)
    file = None if out is None else _path("out", out)
    if workers is not None and scheduler is not None:
        raise SomersaultError("workers and scheduler are both given; give one of them")
    cut = _store.layout(plan.dims, chunk or _chunk(plan))
    if file is None or file.suffix.lower() == ".nc":
        return _in_memory(plan, cut, file, threads, workers, scheduler, progress)
    if file.exists():
        cut = _store.resume(file, plan)
    else:
        if scheduler is not None:  # before anything is written
            from somersault.ensembles._cluster import check_scheduler

            check_scheduler(scheduler)
        _store.create(file, plan, cut)
        cut = _store.resume(file, plan)  # which another program may have made meanwhile
    done = _store.finished(file, plan, cut)
    left = [k for k in range(len(cut)) if k not in done]
    if left:
        _store.note_processor(file)

    def put(k: int, rows: Mapping[str, Any]) -> None:
        _store.write(file, plan, cut, k, rows)

    _fly(plan, cut, left, put, file, threads, workers, scheduler, progress)
    _store.tidy(file)
    return Ensemble(_store.opened(file))


def _path(what: str, given: str | Path) -> Path:
    if not isinstance(given, str | Path) or not str(given):
        raise SomersaultError(
            f"{what} must be the path of a Zarr store or of a .nc file, and is {given!r}"
        )
    return Path(given)


def _fly(
    plan: Plan, cut: _store.Layout, left: list[int], put: _run.Put, file: Path | None,
    threads: int | None, workers: int | None, scheduler: str | None, shown: bool,
) -> None:  # fmt: skip
    remaining = sum(map(cut.size, left))
    with _run.progress(plan.count, plan.count - remaining, shown) as told:
        if left and (workers is not None or scheduler is not None):
            from somersault.ensembles._cluster import on_cluster

            on_cluster(plan, cut, left, put, told, file, threads, workers, scheduler)
        else:
            _run.on_threads(plan, cut, left, put, told, threads)


def _in_memory(
    plan: Plan, cut: _store.Layout, file: Path | None, threads: int | None,
    workers: int | None, scheduler: str | None, shown: bool,
) -> Ensemble:  # fmt: skip
    if plan.count * _bytes_told(plan) > _MEMORY_BYTES:
        raise SomersaultError(
            f"{plan.count:,} flights would fill the memory; give --out a Zarr store, MAP.zarr"
        )
    data, put = _store.gathered(plan, cut)
    _fly(plan, cut, list(range(len(cut))), put, None, threads, workers, scheduler, shown)
    if file is not None:
        write_file(file, netcdf(data))
    return Ensemble(data)


def _bytes_told(plan: Plan) -> int:
    kept = plan.report
    samples = kept.samples if kept.history else 0
    return 8 * (4 + len(kept.quantities) + 2 * len(kept.extremes) + samples * len(kept.history))


def _chunk(plan: Plan) -> int:
    """Flights in a chunk: about a second of work, some megabytes."""
    fitting = max(_CHUNK_BYTES // _bytes_told(plan), 64)
    return min(fitting, _CHUNK, max(_LEAST_CHUNK, -(-plan.count // _PARTS)))
