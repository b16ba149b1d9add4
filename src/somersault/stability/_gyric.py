"""Linear gyric systems M ẍ + (G + D) ẋ + K x = 0 in the frame of a steady spin.

Everything takes stacks of matrices (…, n, n). `Attitude` says which coordinates are the body's
own attitude: for those the equations are the balance of angular momentum, so three linear
integrals are known, δh = M_a ẋ + P x, read off the matrices themselves. On δh = 0, the motions
that keep the angular momentum, what remains has neither the drift of the spin's own angle nor
the stroboscopic mode, and its energy tells stability that lasts from stability that damping
destroys (the energy–momentum method; Hughes 1986, ch. 4, for one rigid body).
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array

TOLERANCE = 1e-6  # growth rates below this, in units of Ω, count as none


@dataclass(frozen=True)
class Attitude:
    """Places of the attitude deviations among the coordinates; None where one is absent.

    `about` turns about the axis of spin itself; `before` and `after` are the two across it,
    such that before → about → after is a right-handed order (1, 2, 3 for a somersault).
    """

    before: int | None
    about: int | None
    after: int | None

    def places(self) -> list[int]:
        """Those that are present."""
        return [p for p in (self.before, self.about, self.after) if p is not None]


def roots(m: Array, c: Array, k: Array, attitude: Attitude) -> Array:
    """All 2n roots s of det(M s² + C s + K), (…, 2n), by imaginary part and then real.

    Turning about the axis of spin changes nothing, so its column of K is zero and gives one
    root that is exactly zero; it is split off, which keeps the other zero root (a changed
    spin rate) from being smeared by a double one.
    """
    n = m.shape[-1]
    inner = [p for p in range(n) if p != attitude.about]
    bottom = -np.linalg.solve(m, _joined(k[..., inner], c, -1))
    top = np.zeros((len(inner), len(inner) + n))
    for row, p in enumerate(inner):
        top[row, len(inner) + p] = 1.0
    found = np.linalg.eigvals(_joined(top, bottom, -2)).astype(complex)
    zero = np.zeros((*found.shape[:-1], n - len(inner)), complex)
    found = np.concatenate([found, zero], -1)
    order = np.lexsort((found.real.round(9), found.imag.round(9)))
    return np.take_along_axis(found, order, -1)


def reduced(m: Array, c: Array, k: Array, attitude: Attitude) -> Array:
    """A in ẏ = A y, y = (x, q̇): the motions that keep the angular momentum.

    x are all coordinates but the turn about the axis of spin, q̇ the joints' rates; the
    attitude rates follow from δh = 0. C holds G + D, and K the springs: the integrals use the
    attitude's rows only, in which the joints' springs and dampers do not appear.
    """
    n = m.shape[-1]
    turns = attitude.places()
    joints = [p for p in range(n) if p not in turns]
    x = [p for p in range(n) if p != attitude.about]
    across, inverse, held = _integrals(m, c, k, attitude)
    from_rates = -inverse @ across[..., joints]  # attitude rates = from_rates q̇ + from_x x
    from_x = -inverse @ held
    velocity_x = np.zeros((*from_x.shape[:-2], len(x), len(x)))  # ẋ = velocity_x x + velocity_q q̇
    velocity_q = np.zeros((*from_rates.shape[:-2], len(x), len(joints)))
    for row, p in enumerate(x):
        if p in turns:
            velocity_x[..., row, :] = from_x[..., turns.index(p), :]
            velocity_q[..., row, :] = from_rates[..., turns.index(p), :]
        else:
            velocity_q[..., row, joints.index(p)] = 1.0
    upper = _joined(velocity_x, velocity_q, -1)
    if not joints:
        return upper
    own = m[..., joints, :]
    mass = own[..., joints] + own[..., turns] @ from_rates
    carried = own[..., turns] @ from_x  # M_ja v̇_a with v̇_a = from_rates q̈ + from_x ẋ
    rate = c[..., joints, :]
    by_x = carried @ velocity_x + rate[..., turns] @ from_x + k[..., joints, :][..., x]
    by_q = carried @ velocity_q + rate[..., turns] @ from_rates + rate[..., joints]
    lower = -np.linalg.inv(mass) @ _joined(by_x, by_q, -1)
    return _joined(upper, lower, -2)


def amended(m: Array, c: Array, k: Array, attitude: Attitude) -> Array:
    """Hessian over x of the energy at fixed angular momentum, K + Pᵀ M_aa⁻¹ P (…, n − 1, n − 1).

    The rest of that energy is positive definite in the joints' rates.
    """
    x = [p for p in range(m.shape[-1]) if p != attitude.about]
    _, inverse, held = _integrals(m, c, k, attitude)
    return k[..., x, :][..., x] + np.swapaxes(held, -1, -2) @ inverse @ held


def _integrals(m: Array, c: Array, k: Array, attitude: Attitude) -> tuple[Array, Array, Array]:
    """M_a, M_aa⁻¹ and P (over x) of δh = M_a ẋ + P x.

    In the turning frame the momentum balance reads ḣ + e × h = 0, so each transverse row of
    K is a row of P, and along the axis of spin the row of G is.
    """
    turns = attitude.places()
    x = [p for p in range(m.shape[-1]) if p != attitude.about]
    across = m[..., turns, :]
    rows = []
    if attitude.before is not None:
        rows.append(_row(k, attitude.after, -1.0))
    if attitude.about is not None:
        rows.append(c[..., attitude.about, :])
    if attitude.after is not None:
        rows.append(_row(k, attitude.before, 1.0))
    lead = np.broadcast_shapes(*(row.shape[:-1] for row in rows)) if rows else ()
    held = np.zeros((*lead, len(rows), len(x)))
    for index, row in enumerate(rows):
        held[..., index, :] = row[..., x]
    return across, np.linalg.inv(across[..., turns]), held


def _row(k: Array, place: int | None, sign: float) -> Array:
    return np.zeros(k.shape[-1]) if place is None else sign * k[..., place, :]


def _joined(a: Array, b: Array, axis: int) -> Array:
    """Two stacks of matrices side by side (axis −1) or one above the other (−2)."""
    lead = np.broadcast_shapes(a.shape[:-2], b.shape[:-2])
    parts = [np.broadcast_to(x, (*lead, *x.shape[-2:])) for x in (a, b)]
    return np.concatenate(parts, axis)


def growth_rate(system: Array) -> Array:
    """Largest real part of the eigenvalues of each matrix, (…); 0 for an empty one."""
    if system.shape[-1] == 0:
        return np.zeros(system.shape[:-2])
    return _threaded(lambda part: np.linalg.eigvals(part).real.max(-1), system)


def lowest(symmetric: Array) -> Array:
    """Lowest eigenvalue of each symmetric matrix, (…)."""
    return _threaded(lambda part: np.linalg.eigvalsh(part)[:, 0], symmetric)


def _threaded(function: Callable[[Array], Array], matrices: Array) -> Array:
    """A reduction of each matrix to a number; LAPACK frees Python's lock, so threads help."""
    flat = matrices.reshape(-1, *matrices.shape[-2:])
    if len(flat) < 4096:
        return function(flat).reshape(matrices.shape[:-2])
    workers = os.cpu_count() or 1
    with ThreadPoolExecutor(workers) as pool:
        parts = list(pool.map(function, np.array_split(flat, 4 * workers)))
    return np.concatenate(parts).reshape(matrices.shape[:-2])


def together(coupled: Array, attitude: Attitude) -> Array:
    """The couplings, with the two turns across the spin in one group: they share an integral."""
    if attitude.before is None or attitude.after is None:
        return coupled
    near = coupled.copy()
    near[attitude.before, attitude.after] = True
    return near


def blocks(coupled: Array) -> list[list[int]]:
    """Groups of coordinates that do not act on each other: connected components, in order."""
    n = len(coupled)
    near = coupled | coupled.T
    left, groups = set(range(n)), []
    while left:
        group = {min(left)}
        edge = set(group)
        while edge:
            edge = {j for i in edge for j in range(n) if near[i, j]} - group
            group |= edge
        groups.append(sorted(group))
        left -= group
    return groups
