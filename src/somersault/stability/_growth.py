"""How fast a gyric system grows, and whether it grows at all, as far as either can be known.

An eigenvalue s of the reduced system is known to within noise × condition number, where the noise
is what rounding can have changed in the matrix. Where its real part is smaller than that, the
energy decides. A mode's energy E at fixed angular momentum falls only by what its dampers take,
2 Re(s) E = −2 ẋᴴ D ẋ (E without its ½), so a mode of negative energy that moves a damper grows and
one of positive energy decays, however slowly (Kelvin, Tait, Chetaev). A mode that moves no damper
is left, and its growth counts as 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import TypeVar

import numpy as np

from somersault._core.array import Array
from somersault.engine import pool, threads
from somersault.stability._gyric import GyricSystem, ScaledSystem

_EPS = float(np.finfo(float).eps)
_ROUNDINGS = 64.0  # errors of rounding allowed for in each entry: ten times those seen
_CLEAR = 1e-2  # real parts beyond it, in units of Ω, need no error bound
_DAMPED = 1e-24  # of a mode's square: what less of it moves dampers is rounding
_SIGNED = 1e-8  # of the terms of a mode's energy: what less is left of them has no sign
_SYMMETRIC = 1e-9  # of the stiffness: what less of it is not symmetric is rounding
_WORTH_THREADS = 4096  # matrices
_Stack = TypeVar("_Stack", "Reduced", "Energy")


@dataclass(frozen=True)
class Reduced:
    """The motions that keep the angular momentum: ẏ = A y, y = (x, q̇ / scale).

    x are all coordinates but the turn about the axis of spin, q̇ the joints' rates, each in units
    of its own inertia. Stacks (…) as those of the system.
    """

    matrix: Array
    """A, (…, m, m)."""
    noise: Array
    """The size of what rounding can have changed in A, (…)."""
    rate_scale: Array
    """(…, joints)"""
    kinetic: Array
    """The kinetic energy's second variation by q̇, (…, joints, joints)."""


@dataclass(frozen=True)
class Energy:
    """Second variations, (…, k, k), of the energy that such motions lose to dampers alone."""

    potential: Array
    """By x."""
    kinetic: Array
    """By q̇."""
    damping: Array
    """D over the joints."""


def reduced(system: ScaledSystem) -> Reduced:
    """The motions of a system that keep the angular momentum.

    The attitude rates follow from δh = 0. The integrals use the attitude's rows only, in which
    the joints' springs and dampers do not appear.
    """
    t, x, m = system.turns, system.first, system.mass
    coupling, unit = m[..., t:, :t], np.eye(m.shape[-1] - t)
    # attitude rates = from_rates q̇ + from_x x
    from_rates = -system.inverse @ m[..., :t, t:]
    from_x = -system.inverse @ system.held
    velocity_x = _above(from_x[..., x:, :], np.zeros((len(unit), from_x.shape[-1])))
    velocity_q = _above(from_rates[..., x:, :], unit)  # ẋ = velocity_x x + velocity_q q̇
    kinetic = m[..., t:, t:] + coupling @ from_rates
    lighter = np.linalg.inv(kinetic)
    carried = coupling @ from_x  # M_ja v̇_a with v̇_a = from_rates q̈ + from_x ẋ
    dragged, dragging = system.rate[..., t:, :t], system.rate[..., t:, t:]
    by_x = carried @ velocity_x + dragged @ from_x + system.stiffness[..., t:, x:]
    by_q = carried @ velocity_q + dragged @ from_rates + dragging
    matrix, scale = balanced(velocity_x, velocity_q, -lighter @ by_x, -lighter @ by_q)
    return Reduced(matrix, rounding(matrix, system.inverse, lighter), scale, kinetic)


def energy(system: ScaledSystem, whole: Reduced) -> Energy | None:
    """What dampers take from; None without dampers, and where the energy is not kept without them.

    It is not with a ball joint's holding torque, which turns with the body, so that K is not
    symmetric.
    """
    if not system.damping.any() or not conservative(system):
        return None
    t = system.turns
    return Energy(system.potential, whole.kinetic, system.damping[..., t:, t:])


def balanced(xx: Array, xq: Array, qx: Array, qq: Array) -> tuple[Array, Array]:
    """A = [[xx, xq], [qx, qq]] over (x, q̇ / scale), and the scale, (…, rates), that keeps stiff
    springs from swelling what rounding does to slow motions."""
    scale = np.sqrt(np.maximum(1.0, np.abs(qx).max(-1, initial=0.0)))
    across, down = scale[..., None, :], scale[..., :, None]
    lead = np.broadcast_shapes(*(block.shape[:-2] for block in (xx, xq, qx, qq)))
    count, size = xx.shape[-1], xx.shape[-1] + qq.shape[-1]
    whole = np.empty((*lead, size, size))
    whole[..., :count, :count] = xx
    np.multiply(xq, across, out=whole[..., :count, count:])
    np.divide(qx, down, out=whole[..., count:, :count])
    np.multiply(qq, across / down, out=whole[..., count:, count:])
    return whole, scale


def rounding(matrix: Array, *inverses: Array) -> Array:
    """The size of what rounding can have changed in a matrix (…, m, m) that was found by solving
    with these inverses, which carry errors along."""
    amplified = sum((_norm(inverse) for inverse in inverses), start=np.ones(()))
    return _ROUNDINGS * _EPS * amplified * (1 + _norm(matrix))


def conservative(system: ScaledSystem) -> bool:
    """Whether K is symmetric, so that nothing but dampers takes or gives energy."""
    k = system.stiffness
    skew = np.abs(k - np.swapaxes(k, -1, -2)).max(initial=0.0)
    return bool(skew <= _SYMMETRIC * np.abs(k).max(initial=0.0))


def growth_rate(system: GyricSystem) -> Array:
    """Largest growth rate of a system's motions that keep the angular momentum, (…), in units of Ω.

    Its sign can be relied on. It is 0 where nothing grows or decays as far as can be known.
    """
    scaled = system.scaled()
    whole = reduced(scaled)
    lead, size = whole.matrix.shape[:-2], whole.matrix.shape[-1]
    if size == 0:
        return np.zeros(lead)
    lost = energy(scaled, whole)
    if not lead:
        return _resolved(whole, lost)
    top = _each(lambda a: np.linalg.eigvals(a).real.max(-1), whole.matrix)
    seen = np.abs(top) > whole.noise
    rates = np.where(seen, top, 0.0)
    unclear = np.nonzero((np.abs(top) < _CLEAR) & (seen | (lost is not None)))
    if unclear[0].size:
        rates[unclear] = _shared(
            lambda *at: _resolved(_at(whole, lead, at), lost and _at(lost, lead, at)), *unclear
        )
    return rates


def definite(system: GyricSystem) -> Array:
    """Where the energy at fixed angular momentum is a strict extremum, (…): a minimum or, for a
    rigid body, a maximum too. Dampers then do no harm."""
    low, high = extremes(system)
    return (low > 0) | (system.rigid & (high < 0))


def extremes(system: GyricSystem) -> tuple[Array, Array]:
    """Lowest and highest eigenvalue of the amended potential, (…), over coordinates in units of
    their own inertia; 0 where they cannot be told from it. With nothing to deviate: ∞ and −∞."""
    scaled = system.scaled()
    potential, inverse = scaled.potential, scaled.inverse
    if not potential.shape[-1]:
        return np.full(potential.shape[:-2], np.inf), np.full(potential.shape[:-2], -np.inf)
    terms = _norm(scaled.stiffness) + _norm(inverse) * (1 + _norm(scaled.held) ** 2)
    noise = _ROUNDINGS * _EPS * terms
    values = _each(np.linalg.eigvalsh, potential)
    low, high = (np.where(np.abs(v) <= noise, 0.0, v) for v in (values[..., 0], values[..., -1]))
    return low, high


def _resolved(whole: Reduced, lost: Energy | None) -> Array:
    """The largest growth rate of each system, root by root, with the sign that can be known."""
    values, vectors = np.linalg.eig(whole.matrix)
    rates = values.real
    unsure = np.abs(rates) <= whole.noise[..., None] * condition(vectors)
    if lost is None:
        return np.where(unsure, 0.0, rates).max(-1)
    count = lost.potential.shape[-1]
    x, q = vectors[..., :count, :], vectors[..., count:, :] * whole.rate_scale[..., :, None]
    return np.where(unsure, slow_rates(x, q, lost), rates).max(-1)


def condition(vectors: Array) -> Array:
    """Condition number 1 / |yᴴ x| of each eigenvalue, (…, m), from all unit eigenvectors x as
    columns (…, m, m)."""
    try:
        with np.errstate(over="ignore"):
            return np.linalg.norm(np.linalg.inv(vectors), axis=-1)
    except np.linalg.LinAlgError:  # two of one system are the same: nothing is known of its roots
        if vectors.ndim == 2:
            return np.full(vectors.shape[-1:], np.inf)
        return np.stack([condition(alone) for alone in vectors])


def slow_rates(x: Array, q: Array, lost: Energy) -> Array:
    """Re(s) = −q̇ᴴ D q̇ / (xᴴ V x + q̇ᴴ M q̇) of modes (…, m) whose deviations x and joint rates q̇
    are the columns; 0 for those that move no damper, or whose energy has no sign."""
    taken = _form(q, lost.damping)
    energies = mode_energies(x, q, lost.potential, lost.kinetic)
    signed = (taken > _DAMPED * _norm(lost.damping)[..., None]) & (energies != 0)
    return np.where(signed, -taken / np.where(signed, energies, 1.0), 0.0)


def mode_energies(x: Array, q: Array, potential: Array, kinetic: Array) -> Array:
    """xᴴ V x + q̇ᴴ M q̇ of modes (…, m) whose deviations x and joint rates q̇ are the columns; 0
    where it has no sign."""
    energies = _form(x, potential) + _form(q, kinetic)
    terms = _form(np.abs(x), np.abs(potential)) + _form(np.abs(q), np.abs(kinetic))
    return np.where(np.abs(energies) > _SIGNED * terms, energies, 0.0)


def _form(vectors: Array, matrix: Array) -> Array:
    """vᴴ A v of each column, (…, m), for symmetric A."""
    return np.einsum("...im,...ij,...jm->...m", vectors.conj(), matrix, vectors).real


def _norm(matrices: Array) -> Array:
    return np.sqrt(np.sum(matrices**2, (-2, -1)))


def _above(upper: Array, lower: Array) -> Array:
    """A stack of matrices (…, m, n), each above the same one (k, n)."""
    whole = np.empty((*upper.shape[:-2], upper.shape[-2] + len(lower), upper.shape[-1]))
    whole[..., : upper.shape[-2], :], whole[..., upper.shape[-2] :, :] = upper, lower
    return whole


# ------------------------------------------------------------------------------------- threads


def _at(stack: _Stack, lead: tuple[int, ...], index: tuple[Array, ...]) -> _Stack:
    """Some systems of a stack."""

    def some(values: Array, core: int) -> Array:
        return np.broadcast_to(values, (*lead, *values.shape[values.ndim - core :]))[index]

    cores = {"noise": 0, "rate_scale": 1}
    kept = {f.name: some(getattr(stack, f.name), cores.get(f.name, 2)) for f in fields(stack)}
    return replace(stack, **kept)


def _each(function: Callable[[Array], Array], matrices: Array) -> Array:
    """Numbers of each matrix of a stack."""
    rows = _shared(function, matrices.reshape(-1, *matrices.shape[-2:]))
    return rows.reshape((*matrices.shape[:-2], *rows.shape[1:]))


def _shared(function: Callable[..., Array], *rows: Array) -> Array:
    """A function of rows of arrays, in as many threads as were asked for: LAPACK releases the
    interpreter."""
    workers = threads()
    if workers == 1 or len(rows[0]) < _WORTH_THREADS:
        return function(*rows)
    parts = [np.array_split(array, 4 * workers) for array in rows]
    return np.concatenate(list(pool().map(function, *parts)))
