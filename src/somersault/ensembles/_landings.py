"""How a maneuver lands from starts that are not its own: maps and sensitivities."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault._core.checks import instance, name_list
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.ensembles._ensemble import ensemble
from somersault.ensembles._result import Ensemble
from somersault.ensembles._vary import Vary
from somersault.flight import Flight, Maneuver

if TYPE_CHECKING:
    import xarray as xr


def landing_map(
    maneuver: Maneuver, against: Flight | None = None, *, span: float = 0.1, points: int = 21
) -> Ensemble:
    """Landing errors over a grid of tilts and twists at takeoff (Playter 1994, figure 6-2).

    Parameters
    ----------
    maneuver : Maneuver
        If its takeoff has an `angular_momentum`, the body tilts and twists against it; with a
        `spin`, each start has the momentum of its own attitude.
    against : Flight, optional
        The flight whose landing every other one should have; by default the maneuver's own.
    span : float
        Tilt and twist go from −span to span, rad.
    points : int
        Points a side; odd for one at no tilt and no twist.

    Returns
    -------
    Ensemble
        `dataset.landing_error` over `takeoff_tilt` and `takeoff_twist`, rad: e of section 6.3.2,
        e² = ¼ (ΔΦ² + ΔΘ² + ΔΨ² + the mean of the joints' Δq²); NaN where a flight failed.

    Raises
    ------
    SomersaultError
        For what is no maneuver, a span that is not positive, and whatever `ensemble` refuses.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.ensembles import landing_map
    >>> lands = landing_map(so.arm_tilt(), points=3)
    >>> float(lands.dataset.landing_error[1, 1]) < 1e-5
    True
    """
    instance("maneuver", maneuver, Maneuver)
    if number("span", span) <= 0:
        raise SomersaultError(f"span {span:g} rad is none; give a positive angle")
    grid = {"from": -span, "to": span, "count": points}
    return ensemble(
        maneuver,
        vary={
            "takeoff_tilt": Vary("takeoff.tilt", values=grid, unit="rad"),
            "takeoff_twist": Vary("takeoff.twist", values=grid, unit="rad"),
        },
        report=["landing_error"],
        against=maneuver.fly() if against is None else against,
    )


def landing_derivatives(
    maneuver: Maneuver,
    of: tuple[str, ...] = ("somersault", "tilt", "twist"),
    to: tuple[str, ...] = ("takeoff.tilt", "takeoff.twist"),
    *,
    step: float = 1e-4,
) -> xr.DataArray:
    """How a landing changes with small changes at takeoff, by differences of flights.

    `somersault.flight.sensitivity` gives the same as accurately as the flight itself.

    Parameters
    ----------
    maneuver : Maneuver
        Its `accuracy` over `step` is the error to expect.
    of : tuple of str
        What is looked at when the flight ends, as a `Report` names it.
    to : tuple of str
        What is changed at takeoff, as `Vary` names it.
    step : float
        Half the distance of the central differences, in the unit of what is changed.

    Returns
    -------
    xarray.DataArray, dims (landing, takeoff)
        ∂ of / ∂ to; NaN where a flight failed.

    Raises
    ------
    SomersaultError
        For what is no maneuver, a step that is not positive, and whatever `ensemble` refuses.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.ensembles import landing_derivatives
    >>> slopes = landing_derivatives(so.arm_tilt())
    >>> slopes.shape, slopes.dims
    ((3, 2), ('landing', 'takeoff'))
    """
    import xarray as xr

    instance("maneuver", maneuver, Maneuver)
    landing, takeoff = name_list("of", of), name_list("to", to)
    if not landing or not takeoff:
        raise SomersaultError("of and to name nothing; name what is looked at, and what is changed")
    if number("step", step) <= 0:
        raise SomersaultError(f"step {step:g} is no step; give a positive number")
    changes = np.kron(np.eye(len(takeoff)), [step, -step])
    flown = ensemble(
        maneuver,
        vary={
            f"change_{k}": Vary(adds_to=name, samples=changes[k]) for k, name in enumerate(takeoff)
        },
        report=landing,
    ).dataset
    ends = np.array([flown[name].values for name in landing])
    slopes = (ends[:, ::2] - ends[:, 1::2]) / (2 * step)
    return xr.DataArray(
        slopes,
        {"landing": list(landing), "takeoff": list(takeoff)},
        ("landing", "takeoff"),
        "derivative",
    )
