"""The linear systems of many spins at once: arrays of poses, springs, dampers and bodies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import by_name, shown, text
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats, require_together
from somersault.dynamics import body_kind
from somersault.model import Model, load, spread
from somersault.model import pose as posed
from somersault.stability._coordinates import coordinates, locked_speeds
from somersault.stability._gyric import GyricSystem
from somersault.stability._principal import (
    Axis,
    PrincipalAxes,
    axes_of_spin,
    axis_index,
    body_axis,
    or_somersault,
    require_free,
    require_inertia,
)
from somersault.stability._reflection import parities
from somersault.stability._springs import finite, strengths
from somersault.stability._steady import composite_inertia, steady_matrices

Values = Mapping[str, ArrayLike]
_SEEN = 9  # cases of a grid that are looked at for their symmetry
_JOINT_KINDS = ("pose", "stiffness", "damping")
_UNITS = {
    "stiffness": "k/(Ω² I)", "damping": "b/(Ω I)", "mass": "kg", "com": "m", "position": "m",
    "inertia": "kg m2",
}  # fmt: skip


@dataclass(frozen=True)
class Grid:
    """Which spins of which model: everything but the quantities that are varied.

    `fixed` has quantities by their full names ("pose.shoulder", "bodies.body.mass"), the model's
    default axis of somersault stands for none, and `subsystem` keeps the part that a coordinate is
    in.
    """

    model: Model
    fixed: dict[str, Any]
    axis: Axis | str | int
    lock: str | Iterable[str]
    subsystem: str | None

    def parts(self, varied: Values) -> list[GyricSystem]:
        """The decoupled parts of the systems for arrays of quantities, which broadcast."""
        system = _system(self.model, self.axis, {**self.fixed, **varied}, self.lock)
        return system.parts(self.subsystem)

    def shape(self, varied: Values) -> tuple[int, ...]:
        """The shape that all quantities together have."""
        return _shape({**self.fixed, **varied})

    def parities(self, varied: Values, names: Sequence[str]) -> Array:
        """1 for coordinates that a mirror across the axis of spin leaves, −1 for those that it
        reverses; 0 for all if it makes another body of one of some cases, taken evenly."""
        quantities = {**self.fixed, **varied}
        shape = _shape(quantities)
        seen = np.linspace(0, np.prod(shape, dtype=int) - 1, _SEEN).astype(int)
        some = {
            name: np.broadcast_to(floats(name, v), shape).ravel()[seen]
            for name, v in quantities.items()
        }
        posed_ = _posed(self.model, self.axis, some)
        q = np.atleast_2d(posed_.q)
        return parities(self.model, posed_.axis, names, q, posed_.names, posed_.values)

    @property
    def attributes(self) -> dict[str, str]:
        """What a dataset says of the spins it is of."""
        return {
            "model": self.model.name,
            "axis": str(self.axis),
            "subsystem": self.subsystem or "all",
        }


def grid(
    model: str | Model,
    fixed: Values | None,
    pose: Values | None,
    stiffness: Values | None,
    damping: Values | None,
    axis: Axis | str | int | None,
    lock: str | Iterable[str],
    subsystem: str | None,
) -> Grid:
    """From the arguments that all public calls of this room share."""
    model = load(model)
    require_free(model)
    quantities = by_name("fixed", fixed)
    for kind, values in zip(_JOINT_KINDS, (pose, stiffness, damping), strict=True):
        for joint, value in by_name(kind, values).items():
            if f"{kind}.{joint}" in quantities:
                raise SomersaultError(f"{kind} of {joint} is given twice; give it once")
            quantities[f"{kind}.{joint}"] = value
    if not isinstance(lock, str):
        lock = tuple(lock) if isinstance(lock, Iterable) else lock
    return Grid(model, quantities, or_somersault(model, axis), lock, subsystem)


def row(what: str, given: Any) -> tuple[str, Array]:
    """The name and the values of a quantity that is varied along a row."""
    try:
        name, values = given
        return text("its name", name), floats("its values", values)
    except (TypeError, ValueError):
        raise SomersaultError(
            f"{what} is a name and values, ('pose.shoulder', [0, 1]), not {shown(given)}"
        ) from None


def unit(model: Model, name: str) -> str:
    """Unit of a quantity's values."""
    kind, _, rest = name.partition(".")
    if kind != "pose":
        return _UNITS[body_kind(name) or kind]
    speeds = spread(model, {rest: 0}, mirrored=True)
    slides = [joint.name for joint in model.joints if joint.kind == "slide"]
    return "m" if any(name in slides for name in speeds) else "rad"


@dataclass(frozen=True, eq=False)
class _Posed:
    """Poses q (…, coordinates) of bodies with some numbers of theirs open, by `names`, at `values`
    (…, names), their principal axes, and which of them they spin about."""

    kinds: dict[str, dict[str, ArrayLike]]
    q: Array
    names: tuple[str, ...]
    values: Array
    about: PrincipalAxes
    axis: int


def _posed(model: Model, axis: Axis | str | int, quantities: Values) -> _Posed:
    kinds = _sorted_kinds(model, quantities)
    _shape(quantities)
    q = posed(model, kinds["pose"])
    names = tuple(kinds["body"])
    values = _stacked([np.asarray(v, float) for v in kinds["body"].values()])
    about = axes_of_spin(model, composite_inertia(model, q, names, values))
    require_inertia(model, about.inertias)
    return _Posed(kinds, q, names, values, about, _one_axis(model, about.inertias, axis) + 1)


def _system(
    model: Model, axis: Axis | str | int, quantities: Values, lock: str | Iterable[str]
) -> GyricSystem:
    here = _posed(model, axis, quantities)
    about, kinds = here.about, here.kinds
    steady = steady_matrices(model, here.q, about.axes[..., here.axis - 1], here.names, here.values)
    chosen = coordinates(model, here.axis, locked_speeds(model, lock))
    mass, gyric, of_spin = (chosen.transformed(a) for a in steady.in_axes(about.axes))
    _require_definite(model, mass)
    none = np.zeros(len(model.speeds))
    springs, dampers = (
        chosen.of_joints(strengths(model, kind, kinds[kind], steady.outboard, none, many=True))
        for kind in ("stiffness", "damping")
    )
    return GyricSystem(chosen.names, mass, gyric, dampers, of_spin + springs, chosen.attitude)


def _shape(quantities: Values) -> tuple[int, ...]:
    """The shape to which all quantities broadcast."""
    return require_together({name: floats(name, v).shape for name, v in quantities.items()})


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
        elif kind == "bodies":
            kinds["body"][name] = value
        else:
            raise SomersaultError(
                f"{shown(name)} is no quantity of {model.name}; use pose.JOINT, stiffness.JOINT, "
                "damping.JOINT, bodies.BODY.mass, bodies.BODY.com.1, bodies.BODY.position.1 or "
                "bodies.BODY.inertia.11"
            )
        numbers = finite(name, value)
        least = {"mass": 1e-300, "damping": 0.0}.get(body_kind(name) or kind, -np.inf)
        if np.any(numbers < least):
            raise SomersaultError(f"{name} goes down to {numbers.min():g}; it must be positive")
    return kinds


def _stacked(values: Sequence[Array]) -> Array:
    return np.stack(np.broadcast_arrays(*values), -1) if values else np.zeros(0)


def _one_axis(model: Model, inertias: Array, axis: Axis | str | int) -> int:
    if (own := body_axis(axis)) is not None:
        return own
    indices = {axis_index(one, axis) for one in inertias.reshape(-1, 3)}
    if len(indices) > 1:
        raise SomersaultError(
            f"the {axis} axis of {model.name} is not the same one everywhere in this chart; give "
            "axis 1, 2 or 3"
        )
    return indices.pop()
