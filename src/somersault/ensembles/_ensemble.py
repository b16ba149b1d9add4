"""`ensemble`: many flights of one maneuver, and what became of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault._core.checks import name_list
from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault.ensembles._carried_out import carried_out
from somersault.ensembles._plan import Plan, plan
from somersault.ensembles._result import Ensemble
from somersault.ensembles._vary import Vary
from somersault.flight import Flight, Maneuver, Report, Takeoff, flights
from somersault.model import Model
from somersault.simulation import LANDING_ERROR, Simulation

if TYPE_CHECKING:
    from distributed.security import Security


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
    security: Security | None = None,
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
        A path that ends in .nc gets the dataset as NetCDF in the end. One that ends in .zarr, or
        has no ending, is a Zarr store, which fills chunk by chunk, and with which the same call
        goes on. Without it the dataset stays in memory.
    chunk : int, optional
        Flights in a chunk of the store.
    threads : int, optional
        On which chunks are run; one for each core by default.
    workers : int, optional
        Processes of dask.distributed that run them instead.
    scheduler : str, optional
        Address of the dask scheduler whose workers run them instead: tls://… or tcp://….
    security : distributed.security.Security, optional
        The certificates for a scheduler at tls://; by default those of dask's configuration.
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
    found = carried_out(
        planned, out, chunk, threads, workers, scheduler, security, progress
    )  # fmt: skip
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
    if isinstance(of, str | Model | Maneuver) or not isinstance(of, Simulation):
        return flights(of, **given, **chosen)
    for name in (*given, *chosen):
        raise SomersaultError(f"{name} is given, but a simulation has its own; leave it out")
    return of


def _with_error(report: Any, measured: bool) -> Any:
    """A report with the landing error in it where that is measured."""
    if not isinstance(report, Report):
        report = Report(name_list("report, unless it is a Report,", report))
    if not measured or LANDING_ERROR in report.quantities:
        return report
    return replace(report, quantities=(*report.quantities, LANDING_ERROR))


def _warn_of_failures(planned: Plan, found: Ensemble) -> None:
    """Warn of runs that failed, and of those that could not even begin."""
    from somersault.ensembles._summary import endings

    known = planned.simulation.endings
    lost = {word: n for word, n in endings(found.dataset).items() if word in known.failed}
    if unsound := lost.pop(known.unsound, 0):
        note(
            f"{unsound:,} of {planned.count:,} {known.called} could not begin ({known.unsound}): "
            "what is varied gave them numbers that none of them can have, like times of a move out "
            "of order, angles or lengths beyond a joint's limits or a mass that is not positive; "
            "what they report is NaN, and counts as failed"
        )
    if lost:
        reasons = ", ".join(f"{word}: {count:,}" for word, count in lost.items())
        note(
            f"{sum(lost.values()):,} of {planned.count:,} {known.called} broke off ({reasons}); "
            "what they report is NaN, and counts as failed"
        )
