"""Stability over many poses, springs and bodies at once: charts and root loci."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import by_name, truth, whole_number
from somersault._core.errors import SomersaultError
from somersault.model import Model
from somersault.stability._grid import Grid, Values, grid, row, unit
from somersault.stability._growth import definite, growth_rate
from somersault.stability._principal import Axis
from somersault.stability._resonance_chart import resonance_fields
from somersault.stability._resonances import MOST_ORDER

if TYPE_CHECKING:
    import xarray as xr


def growth_rates(
    model: str | Model,
    quantities: Values | None = None,
    *,
    pose: Values | None = None,
    stiffness: Values | None = None,
    damping: Values | None = None,
    axis: Axis | str | int | None = None,
    lock: str | Iterable[str] = (),
    subsystem: str | None = None,
) -> Array:
    """Largest growth rates for arrays of poses, springs, dampers and numbers of the bodies.

    Parameters
    ----------
    model : str or Model
        A shipped model's name, a model file, or a model.
    quantities : mapping of str to array_like, optional
        Arrays that broadcast against each other, by "pose.JOINT" (rad), "stiffness.JOINT" and
        "damping.JOINT" (k/(Ω² I) and b/(Ω I)), "bodies.BODY.mass" (kg), "bodies.BODY.com.1" and
        "bodies.BODY.position.2" (m), "bodies.BODY.inertia.11" (kg m²). JOINT may be a left–right
        pair.
    pose, stiffness, damping : mapping of str to array_like, optional
        The same of joints by their name alone, as for `spin` and `Spin.linear`.
    axis : {"minor", "intermediate", "major", 1, 2, 3}, optional
        As for `spin`.
    lock : str or iterable of str
        As for `Spin.linear`.
    subsystem : str, optional
        Only the decoupled part that this coordinate ("tilt", …) is in.

    Returns
    -------
    numpy.ndarray
        Of the shape to which the arrays broadcast, in units of Ω. The signs can be relied on, and
        0 stands where nothing grows or decays as far as can be known: see `LinearSpin.growth_rate`.

    Raises
    ------
    SomersaultError
        For unknown names, numbers that are not finite, arrays whose shapes do not go together, and
        whatever `spin` refuses.

    Examples
    --------
    >>> from somersault.stability import growth_rates
    >>> growth_rates("furrer", pose={"shoulder": 1.3}, stiffness={"shoulder": [0.5, 1.2]}).round(3)
    array([0.649, 0.   ])
    """
    by_name("quantities", quantities)
    cases = grid(model, quantities, pose, stiffness, damping, axis, lock, subsystem)
    return largest_growth(cases, {})


def chart(
    model: str | Model,
    x: tuple[str, ArrayLike],
    y: tuple[str, ArrayLike],
    *,
    pose: Values | None = None,
    stiffness: Values | None = None,
    damping: Values | None = None,
    fixed: Values | None = None,
    axis: Axis | str | int | None = None,
    lock: str | Iterable[str] = (),
    subsystem: str | None = None,
    energy: bool = False,
    resonances: int = 0,
) -> xr.Dataset:
    """Stability over two quantities.

    Parameters
    ----------
    model : str or Model
        A shipped model's name, a model file, or a model.
    x, y : tuple of str and array_like
        The name of a quantity, as in `growth_rates`, and its values.
    pose, stiffness, damping : mapping of str to float, optional
        What stays fixed, by joint, as for `spin` and `Spin.linear`.
    fixed : mapping of str to float, optional
        Any other quantities that stay fixed, by name as in `growth_rates`.
    axis, lock, subsystem
        As for `growth_rates`.
    energy : bool
        Whether to say, too, where the energy is definite.
    resonances : int
        Up to which order, 3 to 8, to look for frequencies of modes in ratios of whole numbers, as
        `LinearSpin.resonances` does; none for 0.

    Returns
    -------
    xarray.Dataset
        With dimensions (y, x): `growth_rate` (units of Ω), `stable`, and with `energy` also
        `definite`, where the energy is an extremum and dampers do no harm. With `resonances` also
        `frequency` and `mode_energy` of each mode, which are called by the first coordinate of the
        subsystem that they are in and numbered as they get faster, and for each resonance, with its
        `order`, the `detuning`, which is zero on it, and where it is `explosive`.

    Raises
    ------
    SomersaultError
        As for `growth_rates`.

    Examples
    --------
    >>> from somersault.stability import chart
    >>> island = chart("furrer", ("pose.shoulder", [1.3]), ("stiffness.shoulder", [0.5, 1.2]))
    >>> island.stable.values
    array([[False],
           [ True]])
    """
    import xarray as xr

    cases = grid(model, fixed, pose, stiffness, damping, axis, lock, subsystem)
    (x_name, x_values), (y_name, y_values) = row("x of a chart", x), row("y of a chart", y)
    if x_values.ndim != 1 or y_values.ndim != 1 or not x_values.size or not y_values.size:
        raise SomersaultError("a chart needs one row of values for each of x and y")
    if x_name == y_name:
        raise SomersaultError(f"a chart of {x_name} against itself shows nothing; vary two things")
    truth("energy", energy)
    if whole_number("resonances", resonances, 0, MOST_ORDER):
        whole_number("resonances", resonances, 3, MOST_ORDER)
    require_open(cases, x_name, y_name)
    varied = {x_name: x_values[None, :], y_name: y_values[:, None]}
    rates = largest_growth(cases, varied)
    dims = (y_name, x_name)
    data: dict[str, Any] = {
        "growth_rate": (dims, rates, {"units": "spin rate", "long_name": "largest growth rate"}),
        "stable": (dims, rates <= 0, {"long_name": "directionally stable"}),
    }
    if energy:
        extremum = _everywhere(cases, varied)
        data["definite"] = (dims, extremum, {"long_name": "energy is an extremum"})
    coords: dict[str, Any] = {
        name: (name, values, {"units": unit(cases.model, name)})
        for name, values in ((x_name, x_values), (y_name, y_values))
    }
    if resonances:
        more, names = resonance_fields(cases, varied, dims, rates <= 0, resonances)
        data, coords = {**data, **more}, {**coords, **names}
    return xr.Dataset(
        data,
        coords=coords,
        attrs=cases.attributes,
    )


def root_locus(
    model: str | Model,
    along: tuple[str, ArrayLike],
    *,
    pose: Values | None = None,
    stiffness: Values | None = None,
    damping: Values | None = None,
    fixed: Values | None = None,
    axis: Axis | str | int | None = None,
    lock: str | Iterable[str] = (),
    subsystem: str | None = None,
) -> xr.Dataset:
    """All roots while one quantity is varied.

    They are those of the whole second-order system, nothing eliminated: the stroboscopic roots and
    the zeros of the drift are among them.

    Parameters
    ----------
    model : str or Model
        A shipped model's name, a model file, or a model.
    along : tuple of str and array_like
        The name of a quantity, as in `growth_rates`, and its values (N,).
    pose, stiffness, damping, fixed
        What stays fixed, as for `chart`.
    axis, lock, subsystem
        As for `growth_rates`.

    Returns
    -------
    xarray.Dataset
        `growth` and `frequency`, real and imaginary part of each root, with dimensions
        (quantity, root), in units of Ω.

    Raises
    ------
    SomersaultError
        As for `growth_rates`.

    Examples
    --------
    >>> from somersault.stability import root_locus
    >>> root_locus("furrer", ("stiffness.shoulder", [0.5, 1.2]), pose={"shoulder": 1.3}).sizes
    Frozen({'stiffness.shoulder': 2, 'root': 10})
    """
    import xarray as xr

    cases = grid(model, fixed, pose, stiffness, damping, axis, lock, subsystem)
    name, values = row("what a root locus is along", along)
    if values.ndim != 1 or not values.size:
        raise SomersaultError("a root locus needs one row of values")
    require_open(cases, name)
    by_part = [
        np.broadcast_to(r, (len(values), r.shape[-1]))
        for r in (part.roots() for part in cases.parts({name: values}))
    ]
    roots = np.concatenate(by_part, -1)
    dims = (name, "root")
    attrs = {"units": "spin rate"}
    return xr.Dataset(
        {"growth": (dims, roots.real, attrs), "frequency": (dims, roots.imag, attrs)},
        coords={name: (name, values, {"units": unit(cases.model, name)})},
        attrs=cases.attributes,
    )


def largest_growth(cases: Grid, varied: Values) -> Array:
    """Largest growth rate of each case, over its parts."""
    shape = cases.shape(varied)
    if 0 in shape:
        return np.zeros(shape)
    worst = np.array(-np.inf)
    for part in cases.parts(varied):
        worst = np.maximum(worst, growth_rate(part))
    return np.broadcast_to(worst, shape)


def _everywhere(cases: Grid, varied: Values) -> Array:
    """Where the energy of each part is definite."""
    good = np.array(True)
    for part in cases.parts(varied):
        good = good & definite(part)
    return np.broadcast_to(good, cases.shape(varied))


def require_open(cases: Grid, *names: str) -> None:
    """Refuse a quantity that is varied and fixed at once."""
    for name in names:
        if name in cases.fixed:
            raise SomersaultError(f"{name} is varied and fixed at once; do one of the two")
