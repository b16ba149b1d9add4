"""Steady spins: a body turning for ever about one of its principal axes, joints held."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import permutations
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import by_name
from somersault._core.errors import SomersaultError
from somersault.dynamics import Equations
from somersault.engine import Kernel
from somersault.model import Model
from somersault.model._load import load
from somersault.model._pose import pose as posed
from somersault.model._types import FREE_IT
from somersault.stability._matrices import spin_matrices, spin_torques

if TYPE_CHECKING:
    from somersault.stability._linear import LinearSpin

Axis = Literal["minor", "intermediate", "major", 1, 2, 3]
_WORTH_COMPILING = 8  # samples
_ALONG = 1e-15  # of the inertia: products below it leave a body axis a principal axis
_RANK = {"minor": 0, "intermediate": 1, "major": 2}


@dataclass(frozen=True, eq=False)
class Spin:
    """A body turning steadily about a principal axis in a fixed pose.

    Any pose is one, with constant torques at the joints; springs pretensioned to those
    torques hold it without effort (Playter 1994, section 4.2.2).
    """

    model: Model
    axis: int
    """1, 2 or 3: the body axis nearest the axis of spin."""
    pose: Array
    """Joint coordinates (coordinates,)."""
    principal_inertias: Array
    """About the principal axes nearest body axes 1, 2 and 3, (3,), kg m²."""
    principal_axes: Array
    """Their directions, as columns, in the base's axes, (3, 3)."""
    holding_torques: Mapping[str, float]
    """What holds each joint at Ω = 1 rad/s, by its speed's name, N m (N); times Ω² otherwise."""
    outboard_inertias: Mapping[str, float]
    """The I of each joint in K = k/(Ω² I), by its speed's name, kg m² (kg for a slide)."""
    mass_matrix: Array
    """M over turns about the principal axes and the joint speeds, kg m²."""
    gyric_matrix: Array
    """G over the same, at Ω = 1 rad/s."""
    stiffness_matrix: Array
    """K over the same, of the spin alone, at Ω = 1 rad/s."""

    def linear(
        self,
        stiffness: Mapping[str, float] | None = None,
        damping: Mapping[str, float] | None = None,
        lock: Iterable[str] = (),
        rate: float | None = None,
    ) -> LinearSpin:
        """The linear equations of small deviations, with joints sprung, damped or locked.

        `stiffness` and `damping` are non-dimensional, k/(Ω² I) and b/(Ω I), by joint or pair
        name, I the inertia outboard of the joint about its axis. With a `rate` Ω in rad/s the
        model's own springs and dampers act on the joints that are not named; without it they
        are left out. Joints in `lock` ("all": every one) are rigid; the others are free.
        Raises SomersaultError for unknown names and numbers that are not finite.
        """
        from somersault.stability._linear import linear

        springs, dampers = by_name("stiffness", stiffness), by_name("damping", damping)
        return linear(self, springs, dampers, lock, rate)

    @property
    def inertia_ratios(self) -> dict[str, float]:
        """k1 and k3 (section 2.3.2), I2 being the inertia about the axis of spin.

        For spins about other axes than 2 the axes are renamed in turn, so that the order
        1, 2, 3 stays right-handed.
        """
        before, about, after = self.principal_inertias[list(cycle(self.axis))]
        return {"k1": float((about - after) / before), "k3": float((about - before) / after)}


def cycle(axis: int) -> tuple[int, int, int]:
    """Indices of the axes before, of and after the spin, in right-handed order."""
    about = axis - 1
    return (about + 2) % 3, about, (about + 1) % 3


def spin(
    model: str | Model,
    axis: Axis | str | int | None = None,
    pose: Mapping[str, ArrayLike] | None = None,
) -> Spin:
    """The steady spin of a model in a pose about a principal axis.

    `axis` is "minor", "intermediate" or "major", or 1, 2, 3 for the principal axis nearest
    that body axis; by default that of somersault, the first of the model's `axes`. `pose` gives
    joint angles by name in rad (m for slides), a left–right pair's by its common name; the rest
    stand as the file draws them. Raises SomersaultError for a model without a free base, an unknown
    axis or joint, or a pose outside limits.
    """
    model = load(model)
    require_free(model)
    if pose is not None and not isinstance(pose, Mapping):
        raise SomersaultError(f"a pose gives angles by name, {{'shoulder': 1.3}}, and is {pose!r}")
    q = posed(model, pose)
    if q.ndim != 1:
        raise SomersaultError("a spin has one pose; use stability.chart for several")
    about = principal(composite_inertia(model, q))
    require_inertia(model, about.inertias)
    index = axis_index(about, or_somersault(model, axis))
    turned = evaluated(model, q, about.axes[:, index])
    _require_independent(model, turned.mass)
    return Spin(
        model,
        index + 1,
        q,
        about.inertias,
        about.axes,
        MappingProxyType(dict(zip(model.speeds, turned.holding.tolist(), strict=True))),
        MappingProxyType(dict(zip(model.speeds, turned.outboard.tolist(), strict=True))),
        *turned.in_axes(about.axes),
    )


def require_free(model: Model) -> None:
    """Refuse a model whose base cannot turn freely."""
    if not model.free:
        raise SomersaultError(f"{model.name} has a fixed base, so it cannot spin freely; {FREE_IT}")


def principal_inertias(model: str | Model, pose: Mapping[str, ArrayLike] | None = None) -> Array:
    """Principal inertias (…, 3) nearest body axes 1, 2 and 3, kg m²; poses may be arrays."""
    model = load(model)
    require_free(model)
    return principal(composite_inertia(model, posed(model, pose))).inertias


def _require_independent(model: Model, mass: Array) -> None:
    """Refuse joints that do the same, or move nothing in this pose: M would be singular."""
    size = np.sqrt(np.diag(mass))
    with np.errstate(invalid="ignore", divide="ignore"):
        scaled = mass / np.outer(size, size)
    if not np.all(np.isfinite(scaled)) or np.linalg.eigvalsh(scaled)[0] < 1e-12:
        raise SomersaultError(
            f"two joints of {model.name} do the same in this pose, or one moves nothing; remove one"
        )


def require_inertia(model: Model, inertias: Array) -> None:
    """Refuse bodies without inertia about some axis: nothing says how they would turn."""
    least, most = np.min(inertias, -1), np.max(inertias, -1)
    if not np.all(least > 1e-12 * most):
        raise SomersaultError(
            f"{model.name} has no inertia about one of its axes, so its spins are not determined; "
            "give its bodies some thickness"
        )


# ----------------------------------------------------------------- many poses and numbers


@dataclass(frozen=True)
class Principal:
    """Principal inertias (…, 3) nearest body axes 1, 2, 3, and axes as columns (…, 3, 3)."""

    inertias: Array
    axes: Array


def principal(inertia: Array) -> Principal:
    """Principal axes, each matched to the body axis it lies nearest and pointing its way.

    Where two inertias are equal their axes are not determined; a nudge picks those along the
    body's own, and is then taken out again wherever the axes are determined.
    """
    nudge = (
        np.diag([3.0, 2.0, 1.0]) * 1e-11 * np.trace(inertia, axis1=-2, axis2=-1)[..., None, None]
    )
    _, vectors = np.linalg.eigh(inertia + nudge)
    orders = np.array(list(permutations(range(3))))
    along = np.abs(vectors)  # [body axis, principal axis]
    match = np.stack([sum(along[..., k, order[k]] for k in range(3)) for order in orders], -1)
    order = orders[np.argmax(match, -1)]
    axes = np.take_along_axis(vectors, order[..., None, :], -1)
    diagonal = np.einsum("...kk->...k", axes)
    axes = axes * np.where(diagonal < 0, -1.0, 1.0)[..., None, :]
    # Three axes that each point along their body axis can still be left-handed; turn the
    # least certain one round.
    left_handed = np.linalg.det(axes) < 0
    least = np.argmin(np.abs(np.einsum("...kk->...k", axes)), -1)
    flip = np.where(left_handed[..., None] & (np.arange(3) == least[..., None]), -1.0, 1.0)
    return _sharpened(inertia, axes * flip[..., None, :])


def _sharpened(inertia: Array, axes: Array) -> Principal:
    """One step of perturbation theory: the small products of inertia that are left, gone."""
    left = np.swapaxes(axes, -1, -2) @ inertia @ axes
    moments = np.einsum("...kk->...k", left)
    gap = moments[..., None, :] - moments[..., :, None]
    apart = np.abs(gap) > 1e-8 * moments.sum(-1)[..., None, None]
    axes = axes @ (np.eye(3) + np.where(apart, left / np.where(apart, gap, 1.0), 0.0))
    axes = axes @ (1.5 * np.eye(3) - 0.5 * np.swapaxes(axes, -1, -2) @ axes)  # orthonormal again
    left = np.swapaxes(axes, -1, -2) @ inertia @ axes
    return Principal(np.einsum("...kk->...k", left), axes)


def or_somersault(model: Model, axis: Axis | str | int | None) -> Axis | str | int:
    """The axis asked for, or else the one that the model somersaults about."""
    return model.axes[0] if axis is None else axis


def axis_index(about: Principal, axis: Axis | str | int) -> int:
    """Index 0, 1, 2 of the principal axis meant."""
    if str(axis) in ("1", "2", "3"):
        return int(axis) - 1
    if str(axis) in _RANK:
        return int(np.argsort(about.inertias)[_RANK[str(axis)]])
    raise SomersaultError(
        f"{axis!r} is no axis to spin about; use minor, intermediate, major, 1, 2 or 3"
    )


@dataclass(frozen=True)
class Evaluated:
    """Spin matrices over the base's axes and the joint speeds, for one pose or many."""

    mass: Array
    gyric: Array
    stiffness: Array
    holding: Array
    outboard: Array

    def in_axes(self, axes: Array) -> tuple[Array, Array, Array]:
        """M, G, K with turns about the principal axes instead of the base's."""
        size = self.mass.shape[-1]
        to_base = np.broadcast_to(np.eye(size), (*axes.shape[:-2], size, size)).copy()
        to_base[..., :3, :3] = axes
        back = np.swapaxes(to_base, -1, -2)
        return tuple(back @ a @ to_base for a in (self.mass, self.gyric, self.stiffness))  # type: ignore[return-value]


@lru_cache(maxsize=16)
def _equations(model: Model, parameters: tuple[str, ...]) -> Equations:
    return Equations(model, parameters)


@lru_cache(maxsize=16)
def _function(model: Model, parameters: tuple[str, ...]) -> Any:
    """Spin matrices for one sample as CasADi evaluates them: nothing to compile."""
    expression = spin_matrices(_equations(model, parameters))
    joined = ca.vertcat(*expression.arguments.values())
    return ca.Function("spin_matrices", [joined], [ca.densify(ca.vec(expression.value.T))])


def _rows(model: Model, parameters: tuple[str, ...], x: Array) -> Array:
    """Raveled spin matrices of samples x (…, inputs): compiled where that pays."""
    flat = x.reshape(-1, x.shape[-1])
    if len(flat) > _WORTH_COMPILING:
        return _kernel(model, parameters)(x)
    function = _function(model, parameters)
    return np.stack([np.asarray(function(row)).ravel() for row in flat])


@lru_cache(maxsize=16)
def _kernel(model: Model, parameters: tuple[str, ...]) -> Kernel:
    equations = _equations(model, parameters)
    return equations.kernel(spin_matrices(equations))


def composite_inertia(
    model: Model, q: Array, parameters: tuple[str, ...] = (), values: Array | None = None
) -> Array:
    """Inertia about the centre of mass, (…, 3, 3), in the base's axes."""
    return _equations(model, parameters).inertia(q, values)


def evaluated(
    model: Model,
    q: Array,
    axis: Array,
    parameters: tuple[str, ...] = (),
    values: Array | None = None,
) -> Evaluated:
    """Spin matrices at poses q (…, coordinates) about unit vectors `axis` (…, 3)."""
    values = np.zeros(0) if values is None else values
    lead = np.broadcast_shapes(q.shape[:-1], axis.shape[:-1], values.shape[:-1])
    parts = [np.broadcast_to(x, (*lead, x.shape[-1])) for x in (q, axis, values)]
    size = 3 + len(model.speeds)
    rows = _rows(model, parameters, np.concatenate(parts, -1))
    rows = rows.reshape(*lead, size, 3 * size + 2)
    return Evaluated(
        rows[..., :size],
        rows[..., size : 2 * size],
        rows[..., 2 * size : 3 * size],
        rows[..., 3:, -2],
        rows[..., 3:, -1],
    )


def holding(
    model: Model,
    q: Array,
    parameters: tuple[str, ...] = (),
    values: Array | None = None,
    *,
    compiled: bool,
) -> tuple[Array, Array]:
    """Of the steady spins about the principal axes nearest that of somersault, at poses q (N, …):
    inertia (N,), kg m², and what holds each joint speed at Ω = 1 rad/s, (N, speeds)."""
    whole = composite_inertia(model, q, parameters, values)
    before, k, after = cycle(model.axes[0])
    axis = np.tile(np.eye(3)[k], (len(q), 1))
    inertia = whole[:, k, k].copy()
    tilted = np.abs(whole[:, before, k]) + np.abs(whole[:, k, after]) > _ALONG * inertia
    if tilted.any():  # elsewhere the body's own axis is a principal axis as it is
        about = principal(whole[tilted])
        inertia[tilted], axis[tilted] = about.inertias[:, k], about.axes[..., k]
    require_inertia(model, np.linalg.eigvalsh(whole[:1]))
    values = np.zeros((1, 0)) if values is None else values
    parts = [np.broadcast_to(x, (len(q), x.shape[-1])) for x in (q, axis, values)]
    joined = np.concatenate(parts, 1)
    if compiled:
        return inertia, _torque_kernel(model, parameters)(joined)
    function = _torque_function(model, parameters)
    return inertia, np.stack([np.asarray(function(row)).ravel() for row in joined])


@lru_cache(maxsize=16)
def _torque_function(model: Model, parameters: tuple[str, ...]) -> Any:
    expression = spin_torques(_equations(model, parameters))
    joined = ca.vertcat(*expression.arguments.values())
    return ca.Function("spin_torques", [joined], [ca.densify(expression.value)])


@lru_cache(maxsize=16)
def _torque_kernel(model: Model, parameters: tuple[str, ...]) -> Kernel:
    equations = _equations(model, parameters)
    return equations.kernel(spin_torques(equations))
