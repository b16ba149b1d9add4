"""Stability over many poses, springs and bodies at once: charts, root loci, stable ranges."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import by_name, shown, truth, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats
from somersault.model import Model
from somersault.stability._grid import Grid, Values, grid, row, unit
from somersault.stability._growth import definite, growth_rate
from somersault.stability._principal import Axis

if TYPE_CHECKING:
    import xarray as xr

_MOST_SAMPLES = 1_000_000
_HALVINGS = 32  # of an edge's bracket


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
    return _rates(cases, {})


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

    Returns
    -------
    xarray.Dataset
        With dimensions (y, x): `growth_rate` (units of Ω), `stable`, and with `energy` also
        `definite`, where the energy is an extremum and dampers do no harm.

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
    _require_open(cases, x_name, y_name)
    varied = {x_name: x_values[None, :], y_name: y_values[:, None]}
    rates = _rates(cases, varied)
    dims = (y_name, x_name)
    data: dict[str, Any] = {
        "growth_rate": (dims, rates, {"units": "spin rate", "long_name": "largest growth rate"}),
        "stable": (dims, rates <= 0, {"long_name": "directionally stable"}),
    }
    if energy:
        extremum = _everywhere(cases, varied)
        data["definite"] = (dims, extremum, {"long_name": "energy is an extremum"})
    return xr.Dataset(
        data,
        coords={
            name: (name, values, {"units": unit(cases.model, name)})
            for name, values in ((x_name, x_values), (y_name, y_values))
        },
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
    _require_open(cases, name)
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


def stable_ranges(
    model: str | Model,
    along: tuple[str, float, float],
    *,
    pose: Values | None = None,
    stiffness: Values | None = None,
    damping: Values | None = None,
    fixed: Values | None = None,
    axis: Axis | str | int | None = None,
    lock: str | Iterable[str] = (),
    subsystem: str | None = None,
    samples: int = 1201,
) -> list[tuple[float, float]]:
    """Where between two values of a quantity the spin is stable, each edge to about 1e-9.

    Looks at evenly spaced values, so an island narrower than their spacing can be missed, then
    halves each edge's bracket.

    Parameters
    ----------
    model : str or Model
        A shipped model's name, a model file, or a model.
    along : tuple of str, float and float
        The name of a quantity, as in `growth_rates`, its least and its greatest value.
    pose, stiffness, damping, fixed
        What stays fixed, one number each, as for `chart`.
    axis, lock, subsystem
        As for `growth_rates`.
    samples : int
        How many values to look at.

    Returns
    -------
    list of tuple of float
        The ends of each stable range.

    Raises
    ------
    SomersaultError
        As for `growth_rates`.

    Examples
    --------
    >>> from somersault.stability import stable_ranges
    >>> for low, high in stable_ranges("furrer", ("stiffness.shoulder", -2, 4),
    ...                                pose={"shoulder": 1.3}):
    ...     print(f"{low:.4f} to {high:.4f}")
    0.8919 to 1.3606
    """
    cases = grid(model, fixed, pose, stiffness, damping, axis, lock, subsystem)
    name, low, high = _ends(along)
    _require_open(cases, name)
    if cases.shape({}):
        raise SomersaultError(
            "stable ranges are those of one case, and these are arrays; use stable_ranges_by_case"
        )
    return _ranges(cases, name, low, high, samples)[0]


def stable_ranges_by_case(
    model: str | Model,
    along: tuple[str, float, float],
    *,
    pose: Values | None = None,
    stiffness: Values | None = None,
    damping: Values | None = None,
    fixed: Values | None = None,
    axis: Axis | str | int | None = None,
    lock: str | Iterable[str] = (),
    subsystem: str | None = None,
    samples: int = 1201,
) -> list[list[tuple[float, float]]]:
    """`stable_ranges` of many cases at once: of many poses, say.

    Parameters
    ----------
    model, along, axis, lock, subsystem, samples
        As for `stable_ranges`.
    pose, stiffness, damping, fixed
        The cases: arrays (N,), or numbers where all cases have the same.

    Returns
    -------
    list of list of tuple of float
        The ends of the stable ranges of each case.

    Raises
    ------
    SomersaultError
        As for `growth_rates`.

    Examples
    --------
    >>> from somersault.stability import stable_ranges_by_case
    >>> by_pose = stable_ranges_by_case("furrer", ("stiffness.shoulder", -2, 4),
    ...                                 pose={"shoulder": [0.1, 1.3]})
    >>> [len(ranges) for ranges in by_pose]
    [0, 1]
    """
    cases = grid(model, fixed, pose, stiffness, damping, axis, lock, subsystem)
    name, low, high = _ends(along)
    _require_open(cases, name)
    if len(cases.shape({})) != 1:
        raise SomersaultError("cases are rows of numbers, (N,); use stable_ranges for one case")
    return _ranges(cases, name, low, high, samples)


def _rates(cases: Grid, varied: Values) -> Array:
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


def _require_open(cases: Grid, *names: str) -> None:
    """Refuse a quantity that is varied and fixed at once."""
    for name in names:
        if name in cases.fixed:
            raise SomersaultError(f"{name} is varied and fixed at once; do one of the two")


def _ends(along: Any) -> tuple[str, float, float]:
    if not isinstance(along, tuple | list) or len(along) != 3:
        raise SomersaultError(
            "what stable ranges are along is a name, a lower and a higher value, "
            f"('stiffness.shoulder', -2, 4), not {shown(along)}"
        )
    name, (low, high) = row("what stable ranges are along", (along[0], along[1:]))
    if not low < high:
        raise SomersaultError(f"stable ranges of {name} need a lower and a higher value")
    return name, float(low), float(high)


def _ranges(
    cases: Grid, name: str, low: float, high: float, samples: int
) -> list[list[tuple[float, float]]]:
    """Ranges of one quantity in which each case is stable: by looking, and then by halving."""
    whole_number("samples", samples, 2, _MOST_SAMPLES)
    held = {key: floats(key, value) for key, value in cases.fixed.items()}
    values = np.linspace(low, high, samples)

    def stable(at: Array, case: Array | None) -> Array:
        of_case = {key: v if v.ndim == 0 else v[case] for key, v in held.items()}
        return _rates(cases, {**of_case, name: at}) <= 0

    (count,) = cases.shape({}) or (1,)
    inside = np.broadcast_to(stable(values, np.arange(count)[:, None]), (count, samples))
    case, column = np.nonzero(inside[:, 1:] != inside[:, :-1])
    left, right = values[column], values[column + 1]
    starts_inside = inside[case, column]
    for _ in range(_HALVINGS if len(case) else 0):
        middle = (left + right) / 2
        same = stable(middle, case) == starts_inside
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    edges = (left + right) / 2
    by_case = []
    for k in range(count):
        first, last = ([low] if inside[k, 0] else []), ([high] if inside[k, -1] else [])
        ends = [*first, *edges[case == k].tolist(), *last]
        by_case.append(list(zip(ends[::2], ends[1::2], strict=True)))
    return by_case
