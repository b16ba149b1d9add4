"""`ensemble`: many flights of one maneuver, and what became of them."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault._core.checks import name_list, text, truth, whole_number
from somersault._core.datasets import netcdf
from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault._core.files import write as write_file
from somersault.ensembles import _run, _store
from somersault.ensembles._chunks import Chunks, chunked
from somersault.ensembles._memory import empty_dataset, run_bytes
from somersault.ensembles._plan import Plan, plan
from somersault.ensembles._vary import Vary
from somersault.flight import Flight, Maneuver, Report, Takeoff, flights
from somersault.model import Model
from somersault.simulation import ENDED, LANDING_ERROR, Simulation

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
    """Flights that differ in what was varied: `dataset` over the varied quantities.

    Made by `ensemble`, or by `Ensemble.open` from a file.
    """

    dataset: xr.Dataset

    @staticmethod
    def open(path: str | Path) -> Ensemble:
        """An ensemble that was written before, whole or in part.

        Parameters
        ----------
        path : str or Path
            A Zarr store, whose values are read when they are used, or a NetCDF file.

        Returns
        -------
        Ensemble

        Raises
        ------
        SomersaultError
            Where there is none.
        """
        file = _path("path", path)
        if not file.exists():
            raise SomersaultError(f"there is no ensemble {str(path)!r}; check the path")
        return Ensemble(_store.opened(file))

    def fraction(
        self,
        good: Any = None,
        tolerance: float | None = None,
        *,
        ended: str | None = None,
        over: str | Sequence[str] = "sample",
        confidence: float = 0.95,
    ) -> xr.Dataset:
        """The share of flights that came out right, with its confidence interval.

        One of `good`, `tolerance` and `ended` says which those are.

        Parameters
        ----------
        good : xarray.DataArray of bool, optional
            For each flight, like `found.dataset.tilt < 0.1`. One that failed was not
            good.
        tolerance : float, optional
            The flights whose landing error is at most so much, rad.
        ended : str, optional
            The flights that ended so: "duration", "event", "too many steps" …
        over : str or sequence of str
            The dimensions over which flights are counted.
        confidence : float
            That the interval holds the true share, between 0 and 1.

        Returns
        -------
        xarray.Dataset
            `fraction`, `low`, `high`, and `flights`, how many counted.

        Raises
        ------
        SomersaultError
            For what does not fit.

        Examples
        --------
        >>> import somersault as so
        >>> vary = {"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05])}
        >>> found = so.ensemble("furrer", so.Takeoff(spin=8.64), 1.0, vary, size=20)
        >>> float(found.fraction(ended="duration")["fraction"])
        1.0
        """
        from somersault.ensembles._endings import ended_by, run_already
        from somersault.ensembles._summary import fraction, share, within

        given = sum(x is not None for x in (good, tolerance, ended))
        if given != 1:
            raise SomersaultError(
                f"fraction is given {given} of good, tolerance and ended; give one of them, to say "
                "which flights came out right"
            )
        codes = self.dataset[ENDED]
        if ended is not None:
            return share(ended_by(codes, ended), run_already(codes), over, confidence)
        chosen = within(self.dataset, tolerance) if good is None else good
        return fraction(chosen, codes, over, confidence)

    def quantiles(
        self, name: str, q: Sequence[float] = (0.05, 0.5, 0.95), **options: Any
    ) -> xr.Dataset:
        """Quantiles of a reported quantity, over the flights that did not fail.

        Parameters
        ----------
        name : str
            One of the variables.
        q : sequence of float
            From 0 to 1.
        **options
            `over`, as for `ensembles.quantiles`.

        Returns
        -------
        xarray.Dataset
            As `ensembles.quantiles` gives it.

        Raises
        ------
        SomersaultError
            For what does not fit.
        """
        from somersault.ensembles._summary import quantiles

        return quantiles(self.dataset, name, q, **options)

    def sensitivity(self, name: str, **options: Any) -> xr.Dataset:
        """How much of the scatter of a reported quantity comes from each drawn one.

        Parameters
        ----------
        name : str
            One of the variables.
        **options
            `confidence` and `seed`, as for `ensembles.sensitivity`.

        Returns
        -------
        xarray.Dataset
            As `ensembles.sensitivity` gives it.

        Raises
        ------
        SomersaultError
            Where nothing is drawn, or there are too few samples.
        """
        from somersault.ensembles._sensitivity import sensitivity

        return sensitivity(self.dataset, name, **options)

    def plot(self, name: str | None = None) -> Figure:
        """A picture of a reported quantity: a map over two grids, a band over one, or a histogram.

        Parameters
        ----------
        name : str, optional
            One of the variables; by default the landing error, or the first.

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        SomersaultError
            For more than two grids, or where all flights failed.
        """
        from somersault.ensembles._plot import plot

        return plot(self.dataset, name)


def ensemble(
    model: str | Model | Maneuver | Simulation,
    takeoff: Takeoff | None = None,
    duration: float | None = None,
    vary: Mapping[str, Vary] | None = None,
    *,
    against: Flight | Mapping[str, float] | None = None,
    size: int | None = None,
    seed: int = 0,
    sequence: str = "random",
    report: Report | Sequence[str] | None = None,
    accuracy: float | None = None,
    until: str | None = None,
    steps: int | None = None,
    out: str | Path | None = None,
    chunk: int | None = None,
    threads: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: bool = False,
) -> Ensemble:
    """Many flights of one maneuver, differing in what is varied.

    The numbers are the same, bit for bit, for any chunks, threads and workers, and where the same
    call goes on with a store after it was stopped.

    Parameters
    ----------
    model : str, Model, Maneuver or Simulation
        A model, whose `takeoff` and `duration` (s; 1 by default) are given as for
        `somersault.fly`; a maneuver, which has its own; or anything else that can be run many
        times, a `somersault.simulation.Simulation`.
    takeoff : Takeoff, optional
    duration : float, optional
        s.
    vary : mapping of str to Vary
        What differs, by name. Grids span dimensions of their own; all that is drawn or listed runs
        along the dimension `sample`.
    against : Flight or mapping of str to float, optional
        The flight, or angles by name (rad), that landings are measured against: "landing_error" is
        then reported.
    size : int, optional
        How many samples are drawn.
    seed : int
        From which they are drawn.
    sequence : {"random", "sobol", "halton", "saltelli"}
        How they are drawn.
    report : Report or sequence of str, optional
        A `Report`, or the names of its quantities.
    accuracy : float, optional
        Of the attitude, rad; by default the maneuver's, or 1e-7.
    until : {"quarter twist"}, optional
        The event that ends a flight; by default the maneuver's, or none.
    steps : int, optional
        A flight that is not done after so many steps of the integration has failed; by default the
        maneuver's, or 100,000.
    out : str or Path, optional
        A path that ends in .nc gets the dataset as NetCDF in the end. Any other is a Zarr store,
        which fills chunk by chunk, and with which the same call goes on. Without it the dataset
        stays in memory.
    chunk : int, optional
        Flights in a chunk of the store.
    threads : int, optional
        On which chunks are run; one for each core by default.
    workers : int, optional
        Processes of dask.distributed that run them instead.
    scheduler : str, optional
        Address of the dask scheduler whose workers run them instead.
    progress : bool
        Whether a bar shows how far it is.

    Returns
    -------
    Ensemble

    Raises
    ------
    SomersaultError
        For what does not fit, and for a store of another specification.

    Warns
    -----
    SomersaultWarning
        Where flights failed although they could take off, with how many and why.

    Examples
    --------
    >>> import somersault as so
    >>> vary = {"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.02])}
    >>> takeoff = so.Takeoff(spin=8.64)
    >>> found = so.ensemble("furrer", takeoff, 1.0, vary, size=50, report=["twist"])
    >>> found.dataset["twist"].sizes["sample"]
    50
    """
    simulation = _simulation(
        model, report,
        {"takeoff": takeoff, "duration": duration},
        {"against": against, "accuracy": accuracy, "until": until, "steps": steps},
    )  # fmt: skip
    planned = plan(simulation, vary, size, seed, sequence)
    found = carried_out(planned, out, chunk, threads, workers, scheduler, progress)
    _warn_of_failures(planned, found)
    return found


def _simulation(
    of: Any, report: Any, takeoff: Mapping[str, Any], options: Mapping[str, Any]
) -> Simulation:
    """What is run; `takeoff` and `options` are arguments of `ensemble`, None for those left out."""
    given = {name: x for name, x in takeoff.items() if x is not None}
    chosen = {name: x for name, x in options.items() if x is not None}
    if report is not None:
        chosen["report"] = _with_error(report, "against" in chosen)
    elif "against" in chosen:
        chosen["report"] = _with_error(Report(), True)
    if isinstance(of, Maneuver):
        _refuse(given, "a maneuver has its own")
        own = {name: getattr(of, name, None) for name in ("accuracy", "until", "steps")}
        chosen = {name: x for name, x in own.items() if x is not None} | chosen
        return flights(of.model, of.takeoff, of.duration, **chosen)
    if isinstance(of, str | Model) or not isinstance(of, Simulation):
        return flights(of, **given, **chosen)
    _refuse({**given, **chosen}, "a simulation has its own")
    return of


def _with_error(report: Any, measured: bool) -> Any:
    """A report with the landing error in it where that is measured."""
    if not isinstance(report, Report):
        report = Report(name_list("report, unless it is a Report,", report))
    if not measured or LANDING_ERROR in report.quantities:
        return report
    return replace(report, quantities=(*report.quantities, LANDING_ERROR))


def _refuse(given: Mapping[str, Any], why: str) -> None:
    for name in given:
        raise SomersaultError(f"{name} is given, but {why}; leave it out")


def _warn_of_failures(planned: Plan, found: Ensemble) -> None:
    """Warn of runs that failed although they could begin."""
    from somersault.ensembles._summary import endings

    known = planned.simulation.endings
    lost = {
        word: count
        for word, count in endings(found.dataset).items()
        if word in known.failed and word != known.unsound
    }
    if lost:
        reasons = ", ".join(f"{word}: {count:,}" for word, count in lost.items())
        warnings.warn(
            f"{sum(lost.values()):,} of {planned.count:,} flights broke off ({reasons}); what they "
            "report is NaN, and counts as failed",
            SomersaultWarning,
            stacklevel=3,
        )


def carried_out(
    plan: Plan, out: str | Path | None = None, chunk: int | None = None,
    threads: int | None = None, workers: int | None = None, scheduler: str | None = None,
    progress: bool = False,
) -> Ensemble:  # fmt: skip
    """The ensemble of a plan; with a store, what is left of it is run.

    Parameters
    ----------
    plan : Plan
        Made by `ensembles.plan`.
    out, chunk, threads, workers, scheduler, progress
        As for `ensemble`.

    Returns
    -------
    Ensemble

    Raises
    ------
    SomersaultError
        For what does not fit, and for a store of another specification.
    """
    for what, value in (("chunk", chunk), ("threads", threads), ("workers", workers)):
        if value is not None:
            whole_number(what, value, 1, _MOST)
    truth("progress", progress)
    if scheduler is not None:
        text("scheduler", scheduler)
    file = None if out is None else _path("out", out)
    if workers is not None and scheduler is not None:
        raise SomersaultError("workers and scheduler are both given; give one of them")
    chunks = chunked(plan.dims, chunk or chunk_size(plan))
    if file is None or file.suffix.lower() == ".nc":
        return _in_memory(plan, chunks, file, threads, workers, scheduler, progress)
    if file.exists():
        chunks = _store.resume(file, plan)
    else:
        if scheduler is not None:  # before anything is written
            from somersault.ensembles._cluster import check_scheduler

            check_scheduler(scheduler)
        _store.create(file, plan, chunks)
        chunks = _store.resume(file, plan)  # which another program may have made meanwhile
    done = _store.finished(file, plan, chunks)
    left = [k for k in range(len(chunks)) if k not in done]
    if left:
        _store.note_processor(file)

    def put(k: int, rows: Mapping[str, Any]) -> None:
        _store.write(file, plan, chunks, k, rows)

    _run_chunks(plan, chunks, left, put, file, threads, workers, scheduler, progress)
    _store.tidy(file)
    return Ensemble(_store.opened(file))


def _path(what: str, given: str | Path) -> Path:
    if not isinstance(given, str | Path) or not str(given):
        raise SomersaultError(
            f"{what} must be the path of a Zarr store or of a .nc file, and is {given!r}"
        )
    return Path(given)


def _run_chunks(
    plan: Plan, chunks: Chunks, left: list[int], put: _run.Put, file: Path | None,
    threads: int | None, workers: int | None, scheduler: str | None, shown: bool,
) -> None:  # fmt: skip
    remaining = sum(map(chunks.size, left))
    with _run.progress_bar(plan.count, plan.count - remaining, shown) as advance:
        if left and (workers is not None or scheduler is not None):
            from somersault.ensembles._cluster import on_cluster

            on_cluster(plan, chunks, left, put, advance, file, threads, workers, scheduler)
        else:
            _run.on_threads(plan, chunks, left, put, advance, threads)


def _in_memory(
    plan: Plan, chunks: Chunks, file: Path | None, threads: int | None,
    workers: int | None, scheduler: str | None, shown: bool,
) -> Ensemble:  # fmt: skip
    if plan.count * run_bytes(plan) > _MEMORY_BYTES:
        raise SomersaultError(
            f"{plan.count:,} flights would fill the memory; give --out a Zarr store, MAP.zarr"
        )
    data, put = empty_dataset(plan, chunks)
    every = list(range(len(chunks)))
    _run_chunks(plan, chunks, every, put, None, threads, workers, scheduler, shown)
    if file is not None:
        write_file(file, netcdf(data))
    return Ensemble(data)


def chunk_size(plan: Plan) -> int:
    """Flights in a chunk: about a second of work, some megabytes."""
    fitting = max(_CHUNK_BYTES // run_bytes(plan), 64)
    return min(fitting, _CHUNK, max(_LEAST_CHUNK, -(-plan.count // _PARTS)))
