"""Stability over many poses, springs and bodies at once: charts, root loci, stable ranges."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import by_name, truth, whole_number
from somersault._core.errors import SomersaultError
from somersault.model import Model, load
from somersault.model._pose import pose as posed
from somersault.model._pose import spread
from somersault.stability import _gyric
from somersault.stability._coordinates import coordinates
from somersault.stability._gyric import TOLERANCE, Attitude
from somersault.stability._linear import coupled, locked_speeds, part_of
from somersault.stability._spin import (
    Axis,
    axis_index,
    composite_inertia,
    evaluated,
    or_somersault,
    principal,
    require_free,
    require_inertia,
)

if TYPE_CHECKING:
    import xarray as xr

Values = Mapping[str, ArrayLike]
_JOINT_KINDS = ("pose", "stiffness", "damping")
_MOST_SAMPLES = 1_000_000
_BODY_KINDS = ("mass", "com", "position", "inertia")


@dataclass(frozen=True)
class _System:
    """M, C = G + D and K + K′ over named coordinates, for a broadcast grid of cases."""

    names: tuple[str, ...]
    mass: Array
    rate: Array
    stiffness: Array
    attitude: Attitude

    def parts(self, subsystem: str | None) -> list[_System]:
        """The decoupled parts, or only the one with a coordinate."""
        near = coupled(self.mass, self.rate, self.stiffness)
        groups = _gyric.blocks(_gyric.together(near, self.attitude))
        if subsystem is not None:
            if not isinstance(subsystem, str) or subsystem not in self.names:
                raise SomersaultError(
                    f"there is no coordinate {subsystem!r}; there are {', '.join(self.names)}"
                )
            place = self.names.index(subsystem)
            groups = [group for group in groups if place in group]
        return [self._part(group) for group in groups]

    def _part(self, keep: list[int]) -> _System:
        def cut(a: Array) -> Array:
            return a[..., keep, :][..., keep]

        return _System(
            tuple(self.names[i] for i in keep),
            cut(self.mass),
            cut(self.rate),
            cut(self.stiffness),
            part_of(self.attitude, keep),
        )


def _system(
    model: Model, axis: Axis | str | int, quantities: Values, lock: Iterable[str]
) -> _System:
    """The linear systems for arrays of quantities, which broadcast against each other."""
    kinds = _sorted_kinds(model, quantities)
    q = posed(model, kinds["pose"])
    names = tuple(kinds["body"])
    values = _stacked([np.asarray(v, float) for v in kinds["body"].values()])
    about = principal(composite_inertia(model, q, names, values))
    require_inertia(model, about.inertias)
    index = _one_axis(model, about, axis)
    turned = evaluated(model, q, about.axes[..., index], names, values)
    _require_definite(model, turned.mass)
    chosen = coordinates(model, index + 1, locked_speeds(model, lock))
    mass, gyric, own = (chosen.transformed(a) for a in turned.in_axes(about.axes))
    springs = _joint_terms(model, kinds["stiffness"], turned.outboard, chosen.columns)
    dampers = _joint_terms(model, kinds["damping"], turned.outboard, chosen.columns)
    return _System(chosen.names, mass, gyric + dampers, own + springs, chosen.attitude)


def _require_definite(model: Model, mass: Array) -> None:
    """Refuse bodies that no masses make: their kinetic energy could be negative."""
    try:
        np.linalg.cholesky(mass)
    except np.linalg.LinAlgError:
        raise SomersaultError(
            f"somewhere in this chart {model.name} is no body, as its mass matrix is not positive; "
            "narrow the values"
        ) from None


def _sorted_kinds(model: Model, quantities: Values) -> dict[str, dict[str, ArrayLike]]:
    kinds: dict[str, dict[str, ArrayLike]] = {k: {} for k in (*_JOINT_KINDS, "body")}
    for name, value in quantities.items():
        kind, _, rest = name.partition(".")
        if kind in _JOINT_KINDS and rest:
            kinds[kind][rest] = value
        elif kind in _BODY_KINDS and rest:
            kinds["body"][name] = value
        else:
            raise SomersaultError(
                f"{name!r} is no quantity of {model.name}; use pose.JOINT, stiffness.JOINT, "
                "damping.JOINT, mass.BODY, com.BODY.1, position.BODY.1 or inertia.BODY.11"
            )
        try:
            numbers = np.asarray(value, float)
        except (TypeError, ValueError):
            numbers = np.array(np.nan)
        if not np.all(np.isfinite(numbers)):
            raise SomersaultError(f"{name} has values that are not finite; give finite numbers")
        least = {"mass": 1e-300, "damping": 0.0}.get(kind, -np.inf)
        if np.any(numbers < least):
            raise SomersaultError(f"{name} goes down to {numbers.min():g}; it must be positive")
    return kinds


def _stacked(values: Sequence[Array]) -> Array:
    return np.stack(np.broadcast_arrays(*values), -1) if values else np.zeros(0)


def _one_axis(model: Model, about: Any, axis: Axis | str | int) -> int:
    if str(axis) in ("1", "2", "3"):
        return int(axis) - 1
    flat = about.inertias.reshape(-1, 3)
    found = {axis_index(type(about)(row, about.axes), axis) for row in flat}
    if len(found) > 1:
        raise SomersaultError(
            f"the {axis} axis of {model.name} is not the same one everywhere in this chart; give "
            "axis 1, 2 or 3"
        )
    return found.pop()


def _joint_terms(
    model: Model, values: Mapping[str, ArrayLike], outboard: Array, columns: Array
) -> Array:
    """Spring or damper matrices in the chosen coordinates, (…, n, n), from k/(Ω² I)."""
    total: Array = np.zeros((columns.shape[1], columns.shape[1]))
    for name, value in spread(model, values, mirrored=False).items():
        own = model.speed_slice(name)
        for speed in range(own.start, own.stop):
            row = columns[3 + speed]
            strength = np.asarray(value, float) * outboard[..., speed]
            total = total + strength[..., None, None] * np.outer(row, row)
    return total


def growth_rates(
    model: str | Model,
    quantities: Values,
    *,
    axis: Axis | str | int | None = None,
    lock: Iterable[str] = (),
    subsystem: str | None = None,
) -> Array:
    """Largest growth rates, in units of Ω, for arrays of quantities that broadcast.

    Quantities are named "pose.JOINT" (rad), "stiffness.JOINT" and "damping.JOINT" (k/(Ω² I)
    and b/(Ω I)), "mass.BODY", "com.BODY.1", "position.BODY.2", "inertia.BODY.11"; a
    mirrored pair's common name sets both sides. `axis` is that of `spin`. `subsystem` names a
    coordinate and keeps only the decoupled part it is in.
    """
    model = load(model)
    require_free(model)
    quantities = by_name("quantities", quantities)
    whole = _system(model, or_somersault(model, axis), quantities, lock)
    shape = np.broadcast_shapes(*(np.shape(v) for v in quantities.values()))
    rates = [
        _gyric.growth_rate(_gyric.reduced(p.mass, p.rate, p.stiffness, p.attitude))
        for p in whole.parts(subsystem)
    ]
    worst = np.array(-np.inf)
    for rate in rates:
        worst = np.maximum(worst, rate)
    return np.broadcast_to(worst, shape)


def _lowest_energy(
    model: Model,
    quantities: Values,
    axis: Axis | str | int,
    lock: Iterable[str],
    subsystem: str | None,
) -> Array:
    whole = _system(model, axis, quantities, lock)
    rigid = len(whole.names) == len(whole.attitude.places())

    def least(potential: Array) -> Array:  # of a rigid body, a maximum is as good
        low = _gyric.lowest(potential)
        return np.maximum(low, _gyric.lowest(-potential)) if rigid else low

    lows = [
        least(_gyric.amended(p.mass, p.rate, p.stiffness, p.attitude))
        for p in whole.parts(subsystem)
        if len(p.names) > (p.attitude.about is not None)
    ]
    shape = np.broadcast_shapes(*(np.shape(v) for v in quantities.values()))
    worst = np.array(np.inf)
    for low in lows:
        worst = np.minimum(worst, low)
    return np.broadcast_to(worst, shape)


def chart(
    model: str | Model,
    x: tuple[str, ArrayLike],
    y: tuple[str, ArrayLike],
    *,
    fixed: Values | None = None,
    axis: Axis | str | int | None = None,
    lock: Iterable[str] = (),
    subsystem: str | None = None,
    energy: bool = False,
) -> xr.Dataset:
    """Stability over two quantities, as an `xarray.Dataset` with dimensions (y, x).

    `x` and `y` are (name, values), names as in `growth_rates`; `fixed` holds other quantities.
    Variables: `growth_rate` (units of Ω), `stable`, and with `energy` also `definite`, where
    the energy is a minimum and dampers do no harm.
    """
    import xarray as xr

    model = load(model)
    axis = or_somersault(model, axis)
    (x_name, x_values), (y_name, y_values) = _row("x of a chart", x), _row("y of a chart", y)
    if x_values.ndim != 1 or y_values.ndim != 1 or not x_values.size or not y_values.size:
        raise SomersaultError("a chart needs one row of values for each of x and y")
    if x_name == y_name:
        raise SomersaultError(f"a chart of {x_name} against itself shows nothing; vary two things")
    truth("energy", energy)
    held = by_name("fixed", fixed)
    if {x_name, y_name} & set(held):
        raise SomersaultError(f"{x_name} or {y_name} is varied and fixed at once; do one of them")
    quantities = {**held, x_name: x_values[None, :], y_name: y_values[:, None]}
    rates = growth_rates(model, quantities, axis=axis, lock=lock, subsystem=subsystem)
    dims = (y_name, x_name)
    data: dict[str, Any] = {
        "growth_rate": (dims, rates, {"units": "spin rate", "long_name": "largest growth rate"}),
        "stable": (dims, rates <= TOLERANCE, {"long_name": "directionally stable"}),
    }
    if energy:
        low = _lowest_energy(model, quantities, axis, lock, subsystem)
        data["definite"] = (dims, low > 0, {"long_name": "energy is a minimum"})
    return xr.Dataset(
        data,
        coords={
            name: (name, values, {"units": unit(model, name)})
            for name, values in ((x_name, x_values), (y_name, y_values))
        },
        attrs={"model": model.name, "axis": str(axis), "subsystem": subsystem or "all"},
    )


def _row(what: str, given: Any) -> tuple[str, Array]:
    try:
        name, values = given
        return str(name), np.asarray(values, float)
    except (TypeError, ValueError):
        raise SomersaultError(
            f"{what} is a name and values, ('pose.shoulder', [0, 1]), not {given!r}"
        ) from None


def unit(model: Model, name: str) -> str:
    """Unit of a quantity's values."""
    kind, _, rest = name.partition(".")
    if kind == "pose":
        joint = next(
            (j for j in model.joints if j.name in spread(model, {rest: 0}, mirrored=True)), None
        )
        return "m" if joint is not None and joint.kind == "slide" else "rad"
    return {
        "stiffness": "k/(Ω² I)",
        "damping": "b/(Ω I)",
        "mass": "kg",
        "com": "m",
        "position": "m",
    }.get(kind, "kg m2")


def root_locus(
    model: str | Model,
    along: tuple[str, ArrayLike],
    *,
    fixed: Values | None = None,
    axis: Axis | str | int | None = None,
    lock: Iterable[str] = (),
    subsystem: str | None = None,
) -> xr.Dataset:
    """Roots while one quantity is varied: `growth` and `frequency`, their real and
    imaginary parts (value, root), in units of Ω.


    From the whole second-order system, nothing eliminated: the stroboscopic roots and the
    zeros of the drift are among them.
    """
    import xarray as xr

    model = load(model)
    require_free(model)
    axis = or_somersault(model, axis)
    name, values = _row("what a root locus is along", along)
    if values.ndim != 1 or not values.size:
        raise SomersaultError("a root locus needs one row of values")
    whole = _system(model, axis, {**by_name("fixed", fixed), name: values}, lock)
    found = [
        np.broadcast_to(r, (len(values), r.shape[-1]))
        for r in (
            _gyric.roots(p.mass, p.rate, p.stiffness, p.attitude) for p in whole.parts(subsystem)
        )
    ]
    roots = np.concatenate(found, -1)
    dims = (name, "root")
    attrs = {"units": "spin rate"}
    return xr.Dataset(
        {"growth": (dims, roots.real, attrs), "frequency": (dims, roots.imag, attrs)},
        coords={name: (name, values, {"units": unit(model, name)})},
        attrs={"model": model.name, "axis": str(axis), "subsystem": subsystem or "all"},
    )


def stable_ranges(
    model: str | Model,
    along: tuple[str, float, float],
    *,
    fixed: Values | None = None,
    axis: Axis | str | int | None = None,
    lock: Iterable[str] = (),
    subsystem: str | None = None,
    samples: int = 1201,
) -> list[tuple[float, float]]:
    """Where between two values of a quantity the spin is stable, each edge to about 1e-9.

    Looks at `samples` evenly spaced values, so an island narrower than their spacing can be
    missed, then halves each edge's bracket.
    """
    if not isinstance(along, tuple | list) or len(along) != 3:
        raise SomersaultError(
            "what stable ranges are along is a name, a lower and a higher value, "
            f"('stiffness.shoulder', -2, 4), not {along!r}"
        )
    name, (low, high) = _row("what stable ranges are along", (along[0], along[1:]))
    if not low < high:
        raise SomersaultError(f"stable ranges of {name} need a lower and a higher value")
    whole_number("samples", samples, 2, _MOST_SAMPLES)
    held = by_name("fixed", fixed)
    values = np.linspace(low, high, samples)

    def stable(at: Array) -> Array:
        rates = growth_rates(model, {**held, name: at}, axis=axis, lock=lock, subsystem=subsystem)
        return rates <= TOLERANCE

    inside = stable(values)
    change = np.flatnonzero(inside[1:] != inside[:-1])
    left, right = values[change], values[change + 1]
    starts_inside = inside[change]
    for _ in range(32 if len(change) else 0):
        middle = (left + right) / 2
        same = stable(middle) == starts_inside
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    edges = [*([low] if inside[0] else []), *((left + right) / 2), *([high] if inside[-1] else [])]
    return [(float(a), float(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
