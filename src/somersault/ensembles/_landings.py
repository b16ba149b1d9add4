"""How a maneuver lands from starts that are not its own: maps and sensitivities."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault._core.checks import name_list
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.ensembles._ensemble import Ensemble, ensemble
from somersault.ensembles._vary import Vary
from somersault.flight import Flight, Takeoff
from somersault.model import Model

if TYPE_CHECKING:
    import xarray as xr

_STEPS = 100_000  # of a flight's integration


def landing_map(
    model: str | Model,
    takeoff: Takeoff,
    duration: float,
    against: Flight,
    *,
    span: float = 0.1,
    points: int = 21,
    accuracy: float = 1e-6,
    steps: int = _STEPS,
) -> Ensemble:
    """Landing errors over a grid of tilts and twists at takeoff (Playter 1994, figure 6-2).

    Parameters
    ----------
    model : str or Model
    takeoff : Takeoff
        With an `angular_momentum`, the body tilts and twists against it; with a `spin`, the
        momentum is the body's own at every start.
    duration : float
        s.
    against : Flight
        The flight whose landing every other one should have.
    span : float
        Tilt and twist go from −span to span, rad.
    points : int
        Points a side; odd for one at no tilt and no twist.
    accuracy : float
        Attitude, rad.
    steps : int
        A flight that is not done after so many steps of the integration has failed.

    Returns
    -------
    Ensemble
        `dataset.landing_error` over `takeoff_tilt` and `takeoff_twist`, rad: e of section 6.3.2,
        e² = ¼ (ΔΦ² + ΔΘ² + ΔΨ² + the mean of the joints' Δq²); NaN where a flight failed.

    Raises
    ------
    SomersaultError
        For a span that is not positive, and whatever `ensemble` refuses.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.ensembles import landing_map
    >>> twist = so.arm_tilt()
    >>> lands = landing_map(twist.model, twist.takeoff, twist.duration, twist.fly(), points=3)
    >>> float(lands.dataset.landing_error[1, 1]) < 1e-5
    True
    """
    if number("span", span) <= 0:
        raise SomersaultError(f"span {span:g} rad is none; give a positive angle")
    grid = {"from": -span, "to": span, "count": points}
    return ensemble(
        model,
        takeoff,
        duration,
        {
            "takeoff_tilt": Vary("takeoff.tilt", values=grid, unit="rad"),
            "takeoff_twist": Vary("takeoff.twist", values=grid, unit="rad"),
        },
        report=["landing_error"],
        against=against,
        accuracy=accuracy,
        steps=steps,
    )


def landing_derivatives(
    model: str | Model,
    takeoff: Takeoff,
    duration: float,
    *,
    of: tuple[str, ...] = ("somersault", "tilt", "twist"),
    to: tuple[str, ...] = ("takeoff.tilt", "takeoff.twist"),
    step: float = 1e-4,
    accuracy: float = 1e-10,
    steps: int = _STEPS,
) -> xr.DataArray:
    """How a landing changes with small changes at takeoff, to first order.

    Parameters
    ----------
    model : str or Model
    takeoff : Takeoff
    duration : float
        s.
    of : tuple of str
        What is looked at when the flight ends, as a `Report` names it.
    to : tuple of str
        What is changed at takeoff, as `Vary` names it.
    step : float
        Half the distance of the central differences, in the unit of what is changed.
    accuracy : float
        Of the flights, rad; its quotient with `step` is the error.
    steps : int
        Of a flight's integration, at most.

    Returns
    -------
    xarray.DataArray, dims (landing, takeoff)
        ∂ of / ∂ to; NaN where a flight failed.

    Raises
    ------
    SomersaultError
        For a step that is not positive, and whatever `ensemble` refuses.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.ensembles import landing_derivatives
    >>> found = landing_derivatives("furrer", so.Takeoff(spin=6.0), 0.1)
    >>> found.shape, found.dims
    ((3, 2), ('landing', 'takeoff'))
    """
    import xarray as xr

    wanted, changed = name_list("of", of), name_list("to", to)
    if number("step", step) <= 0:
        raise SomersaultError(f"step {step:g} is no step; give a positive number")
    steps_of = np.kron(np.eye(len(changed)), [step, -step])
    flown = ensemble(
        model,
        takeoff,
        duration,
        {f"change_{k}": Vary(adds_to=name, samples=steps_of[k]) for k, name in enumerate(changed)},
        report=wanted,
        accuracy=accuracy,
        steps=steps,
    ).dataset
    ends = np.array([flown[name].values for name in wanted])
    slopes = (ends[:, ::2] - ends[:, 1::2]) / (2 * step)
    return xr.DataArray(
        slopes, {"landing": list(wanted), "takeoff": list(changed)}, ("landing", "takeoff"),
        "derivative",
    )  # fmt: skip
