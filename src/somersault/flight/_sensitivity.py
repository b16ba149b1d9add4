"""How a landing depends on the start, to first order: exactly, along the flight."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance, name_list
from somersault._core.errors import SomersaultError
from somersault.flight._along import Along, landed
from somersault.flight._batch import Batch
from somersault.flight._directions import of_numbers, of_state, sizes
from somersault.flight._jumps import refuse_jumps
from somersault.flight._maneuver import Maneuver
from somersault.flight._recorded_along import with_recordings
from somersault.flight._report import units
from somersault.flight._tangent import moving_names
from somersault.flight._targets import body_names, targets
from somersault.flight._watch import ANGLES, VELOCITIES, quantities, torques

if TYPE_CHECKING:
    import xarray as xr

_NOISE = ("takeoff", "noise")


def sensitivity(
    maneuver: Maneuver, with_respect_to: Sequence[str], of: Sequence[str] | None = None
) -> xr.DataArray:
    """How a landing changes with numbers of its maneuver, to first order.

    The derivatives are integrated beside the flight (ṡ = f_y s + f_p p'), so they are as
    accurate as the flight is. Where an event ends it, its time changes too.

    Parameters
    ----------
    maneuver : Maneuver
    with_respect_to : sequence of str
        Numbers of the takeoff, of joints and bodies, by the names that `Vary` has: "takeoff.tilt",
        "joints.shoulder.stiffness", "joints.left_shoulder.angles.2", "bodies.body.mass". A pair
        changes as mirror images; a row without a place changes as a whole.
    of : sequence of str, optional
        What is looked at when the flight ends, as a `Report` names it, or "time". Unless it is
        given: the time where an event ends the flight, somersault, tilt and twist, the angular
        velocity, joint coordinates and their rates.

    Returns
    -------
    xarray.DataArray, dims (landing, takeoff)
        ∂ of / ∂ with_respect_to. Units stand beside both, `landing_unit` and `takeoff_unit`.

    Raises
    ------
    SomersaultError
        For names that are none, a flight that breaks off, and where there is no derivative: with
        respect to the noise, to the time of a jump of what acts, to a knot at takeoff.

    Examples
    --------
    >>> import somersault as so
    >>> arms = {"shoulder": so.JointTakeoff.sprung(angle=1.4, K=1.2, hold=True)}
    >>> layout = so.Maneuver("furrer", so.Takeoff(tilt=0.01, spin=8.64, joints=arms), 2.0)
    >>> slopes = so.flight.sensitivity(layout, ["takeoff.tilt", "joints.shoulder.K"])
    >>> round(float(slopes.sel(landing="twist", takeoff="takeoff.tilt")), 4)
    -0.7721
    """
    batch = watched_batch(maneuver)
    names = name_list("with_respect_to", with_respect_to)
    looked_at = _looked_at(maneuver, of)
    if not names or not looked_at:
        raise SomersaultError(
            "with_respect_to and of name nothing; name what changes, and what is looked at"
        )
    for what, row in (("with_respect_to", names), ("of", looked_at)):
        for name in row:
            if row.count(name) > 1:
                raise SomersaultError(f"{what} names {name} twice; leave one out")
    meant = [targets(batch, name) for name in names]
    varied = tuple(dict.fromkeys(target.name for one in meant for target in one))
    if _NOISE in varied:
        raise SomersaultError(
            "takeoff.noise says which noise is sensed, so a landing has no derivative with "
            "respect to it; leave it out"
        )
    begun = batch.differing_in(varied, body_names(varied)).begun()
    _ = begun.start  # refuses what cannot be held
    by = sizes(begun.batch, meant)
    directions = of_numbers(begun, names, meant, by)
    refuse_jumps(begun, directions, names)
    directions = with_recordings(begun, directions, names, meant, by)
    end = landed(Along(begun, directions), maneuver.accuracy, maneuver.steps)
    known = tuple(name for name in looked_at if name != "time")
    time, *others = end.quantities(known).T / by
    rows = {"time": time, **dict(zip(known, others, strict=True))}
    unit = {"time": "s", **units(maneuver.model)}
    return _labelled(
        np.array([rows[name] for name in looked_at]), {name: unit[name] for name in looked_at},
        {name: one[0].unit for name, one in zip(names, meant, strict=True)},
    )  # fmt: skip


def transition(maneuver: Maneuver) -> xr.DataArray:
    """The state-transition matrix of a flight: how its motion at the end changes with that at
    takeoff, to first order.

    Parameters
    ----------
    maneuver : Maneuver
        All its numbers stay as they are; a spring that is held keeps its pretension.

    Returns
    -------
    xarray.DataArray, dims (landing, takeoff)
        Of the same on both sides: small turns about the body's axes ("turn_1" …, rad), the angular
        velocity, and the coordinates and rates of joints that move freely, of a ball small turns.
        Where an event ends the flight, its time changes too.

    Raises
    ------
    SomersaultError
        For what is no maneuver, and a flight that breaks off.

    Examples
    --------
    The eigenvalues of a steady spin over one somersault are exp(2π λ), λ its roots.

    >>> import numpy as np
    >>> import somersault as so
    >>> turn = so.Maneuver("book", so.Takeoff(spin=6.0), 2 * np.pi / 6.0)
    >>> roots = so.spin("book").linear().roots
    >>> greatest = np.abs(np.linalg.eigvals(so.flight.transition(turn))).max()
    >>> bool(np.isclose(greatest, np.exp(2 * np.pi * np.real(roots).max()), rtol=1e-6))
    True
    """
    begun = watched_batch(maneuver).begun()
    _ = begun.start
    directions, names = of_state(begun), moving_names(begun.batch.system)
    refuse_jumps(begun, directions, names)
    end = landed(Along(begun, directions), maneuver.accuracy, maneuver.steps)
    unit = {f"turn_{k}": "rad" for k in (1, 2, 3)} | units(maneuver.model)
    labels = {name: unit.get(name, "rad") for name in names}  # of a ball: a turn
    return _labelled(end.motion().T[1:], labels, labels)


def watched_batch(maneuver: Maneuver) -> Batch:
    """The flights of a maneuver, whose turns are watched."""
    return replace(instance("maneuver", maneuver, Maneuver).batch, extremes=(), differing=None)


def _looked_at(maneuver: Maneuver, of: Sequence[str] | None) -> tuple[str, ...]:
    model = maneuver.model
    if of is None:
        rates = [f"{name}_rate" for name in model.speeds]
        first = [] if maneuver.until is None else ["time"]
        return (*first, *ANGLES, *VELOCITIES, *model.coordinates, *rates)
    there = ["time", *quantities(model), *torques(model)]
    names = name_list("of", of)
    for name in names:
        if name not in there:
            raise SomersaultError(
                f"of: {name!r} is nothing that is known of {model.name}; there are "
                f"{', '.join(there)}"
            )
    return names


def _labelled(
    values: Array, landing: Mapping[str, str], takeoff: Mapping[str, str | None]
) -> xr.DataArray:
    import xarray as xr

    coordinates: dict[str, Any] = {"landing": list(landing), "takeoff": list(takeoff)}
    coordinates["landing_unit"] = ("landing", list(landing.values()))
    coordinates["takeoff_unit"] = ("takeoff", [unit or "1" for unit in takeoff.values()])
    return xr.DataArray(values, coordinates, ("landing", "takeoff"), "derivative")
