"""Matrices and holding torques of steady spins, in numbers: for one pose or for many."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance, name_list, truth
from somersault._core.numbers import floats
from somersault.dynamics import Equations
from somersault.engine import Kernel
from somersault.model import Model
from somersault.stability._matrices import spin_matrices, spin_torques
from somersault.stability._principal import cycle, principal_axes, require_inertia

_WORTH_COMPILING = 8  # samples
_ALONG = 1e-15  # of the inertia: products below it leave a body axis a principal axis


@dataclass(frozen=True)
class SteadyMatrices:
    """Spin matrices over the base's axes and the joint speeds, for one pose or many.

    `mass`, `gyric` and `stiffness` are (…, 3 + speeds, 3 + speeds); `holding` and `outboard`, the
    holding torques at Ω = 1 rad/s and the outboard inertias, (…, speeds).
    """

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


def composite_inertia(
    model: Model, q: Array, parameters: tuple[str, ...] = (), values: Array | None = None
) -> Array:
    """Inertia about the centre of mass, (…, 3, 3), in the base's axes."""
    return equations_of(model, parameters).inertia(q, values)


def steady_matrices(
    model: Model,
    q: Array,
    axis: Array,
    parameters: tuple[str, ...] = (),
    values: Array | None = None,
) -> SteadyMatrices:
    """Spin matrices at poses q (…, coordinates) about unit vectors `axis` (…, 3)."""
    values = np.zeros(0) if values is None else values
    lead = np.broadcast_shapes(q.shape[:-1], axis.shape[:-1], values.shape[:-1])
    parts = [np.broadcast_to(x, (*lead, x.shape[-1])) for x in (q, axis, values)]
    size = 3 + len(model.speeds)
    rows = _rows(model, parameters, np.concatenate(parts, -1))
    rows = rows.reshape(*lead, size, 3 * size + 2)
    return SteadyMatrices(
        rows[..., :size],
        rows[..., size : 2 * size],
        rows[..., 2 * size : 3 * size],
        rows[..., 3:, -2],
        rows[..., 3:, -1],
    )


def holding_torques(
    model: Model,
    q: Array,
    parameters: tuple[str, ...] = (),
    values: Array | None = None,
    *,
    compiled: bool,
) -> tuple[Array, Array]:
    """What holds the joints in steady spins about the principal axes nearest that of somersault.

    A planar model spins about the axis across its plane, a principal axis or not.

    Parameters
    ----------
    model : Model
        The model.
    q : numpy.ndarray, shape (N, coordinates)
        Poses.
    parameters : tuple of str
        Names of the bodies' numbers that vary, as `Equations` has them.
    values : numpy.ndarray, shape (N, parameters) or (1, parameters), optional
        Their values.
    compiled : bool
        Whether the equations are worth compiling; a few poses need no compiling.

    Returns
    -------
    inertia : numpy.ndarray, shape (N,)
        About the axis of spin, kg m².
    torques : numpy.ndarray, shape (N, speeds)
        At each joint speed, at Ω = 1 rad/s, N m (N for a slide); times Ω² at other rates.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.model import pose
    >>> from somersault.stability import holding_torques
    >>> furrer = so.load("furrer")
    >>> poses = pose(furrer, {"shoulder": [1.3]})
    >>> inertia, torques = holding_torques(furrer, poses, compiled=False)
    >>> inertia.round(2), torques.round(3)
    (array([11.06]), array([[-0.31,  0.31]]))
    """
    compiled = truth("compiled", compiled)
    instance("model", model, Model)
    parameters = name_list("parameters", parameters)
    q = np.atleast_2d(floats("q", q, len(model.coordinates)))
    whole = composite_inertia(model, q, parameters, values)
    before, k, after = cycle(model.axes[0])
    axis = np.tile(np.eye(3)[k], (len(q), 1))
    inertia = whole[:, k, k].copy()
    if model.plane is None:
        tilted = np.abs(whole[:, before, k]) + np.abs(whole[:, k, after]) > _ALONG * inertia
        if tilted.any():  # elsewhere the body's own axis is a principal axis as it is
            about = principal_axes(whole[tilted])
            inertia[tilted], axis[tilted] = about.inertias[:, k], about.axes[..., k]
        require_inertia(model, np.linalg.eigvalsh(whole[:1]))
    values = np.zeros((1, 0)) if values is None else values
    parts = [np.broadcast_to(x, (len(q), x.shape[-1])) for x in (q, axis, values)]
    joined = np.concatenate(parts, 1)
    if compiled:
        return inertia, _torque_kernel(model, parameters)(joined)
    return inertia, _evaluated(_torque_function(model, parameters), joined)


def _rows(model: Model, parameters: tuple[str, ...], x: Array) -> Array:
    """Raveled spin matrices of samples x (…, inputs): compiled where that pays."""
    flat = x.reshape(-1, x.shape[-1])
    if len(flat) > _WORTH_COMPILING:
        return _matrix_kernel(model, parameters)(x)
    return _evaluated(_matrix_function(model, parameters), flat)


def _evaluated(function: Any, rows: Array) -> Array:
    """A CasADi function at each row, as CasADi evaluates it: nothing to compile."""
    return np.stack([np.asarray(function(row)).ravel() for row in rows])


@lru_cache(maxsize=16)
def equations_of(model: Model, parameters: tuple[str, ...]) -> Equations:
    """The equations of a model, compiled once."""
    return Equations(model, parameters)


@lru_cache(maxsize=16)
def _matrix_function(model: Model, parameters: tuple[str, ...]) -> Any:
    expression = spin_matrices(equations_of(model, parameters))
    joined = ca.vertcat(*expression.arguments.values())
    return ca.Function("spin_matrices", [joined], [ca.densify(ca.vec(expression.value.T))])


@lru_cache(maxsize=16)
def _matrix_kernel(model: Model, parameters: tuple[str, ...]) -> Kernel:
    equations = equations_of(model, parameters)
    return equations.kernel(spin_matrices(equations))


@lru_cache(maxsize=16)
def _torque_function(model: Model, parameters: tuple[str, ...]) -> Any:
    expression = spin_torques(equations_of(model, parameters))
    joined = ca.vertcat(*expression.arguments.values())
    return ca.Function("spin_torques", [joined], [ca.densify(expression.value)])


@lru_cache(maxsize=16)
def _torque_kernel(model: Model, parameters: tuple[str, ...]) -> Kernel:
    equations = equations_of(model, parameters)
    return equations.kernel(spin_torques(equations))
