"""Linear gyric systems M ẍ + (G + D) ẋ + K x = 0 in the frame of a steady spin.

Matrices may be stacks (…, n, n). `Attitude` says which coordinates are the body's own attitude: for
those the equations are the balance of angular momentum, so three linear integrals are known,
δh = M_a ẋ + P x, read off the matrices themselves. On δh = 0, the motions that keep the angular
momentum, what remains has neither the drift of the spin's own angle nor the stroboscopic mode, and
its energy tells stability that lasts from stability that damping destroys (the energy–momentum
method; Hughes 1986, ch. 4, for one rigid body).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError

_DECOUPLED = 1e-10  # of two coordinates' inertias: what acts less than that is rounding


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

    def part(self, keep: list[int]) -> Attitude:
        """The places among some of the coordinates."""
        moved = [
            keep.index(p) if p in keep else None for p in (self.before, self.about, self.after)
        ]
        return Attitude(*moved)


@dataclass(frozen=True, eq=False)
class GyricSystem:
    """M ẍ + (G + D) ẋ + K x = 0 over named coordinates, time in units of 1/Ω; one or a stack.

    `stiffness` is that of the spin and of the springs together.
    """

    names: tuple[str, ...]
    mass: Array
    gyric: Array
    damping: Array
    stiffness: Array
    attitude: Attitude

    @cached_property
    def turns(self) -> list[int]:
        """Places of the attitude's coordinates, that of the turn about the axis of spin first."""
        about = self.attitude.about
        return sorted(self.attitude.places(), key=lambda place: place != about)

    @cached_property
    def joints(self) -> list[int]:
        """Places of the joints' coordinates."""
        return [p for p in range(len(self.names)) if p not in self.turns]

    @cached_property
    def deviations(self) -> list[int]:
        """Places of all coordinates but the turn about the axis of spin, which changes nothing:
        the turns across it and the joints."""
        return [p for p in (*self.turns, *self.joints) if p != self.attitude.about]

    @property
    def rigid(self) -> bool:
        """Whether no joint moves, so that a maximum of the energy is as good as a minimum."""
        return not self.joints

    @cached_property
    def groups(self) -> list[list[int]]:
        """Places of the coordinates of each subsystem, which does not act on the others.

        The two turns across the axis of spin stay together, because they share an integral.
        """
        near = coupled(self.mass, self.gyric, self.damping, self.stiffness)
        return blocks(together(near, self.attitude))

    def part(self, keep: list[int]) -> GyricSystem:
        """The system over some of the coordinates."""

        def cut(a: Array) -> Array:
            return a[..., keep, :][..., keep]

        return GyricSystem(
            tuple(self.names[i] for i in keep),
            cut(self.mass),
            cut(self.gyric),
            cut(self.damping),
            cut(self.stiffness),
            self.attitude.part(keep),
        )

    def parts(self, subsystem: str | None = None) -> list[GyricSystem]:
        """The decoupled parts, or only the one with a coordinate of that name."""
        groups = self.groups
        if subsystem is not None:
            place = self.place(subsystem)
            groups = [group for group in groups if place in group]
        return [self.part(group) for group in groups]

    def place(self, name: str) -> int:
        """Where a coordinate stands; SomersaultError, with those there are, if there is none."""
        if not isinstance(name, str) or name not in self.names:
            raise SomersaultError(
                f"there is no coordinate {shown(name)}; there are {', '.join(self.names)}"
            )
        return self.names.index(name)

    def undamped(self) -> GyricSystem:
        """The same without its dampers."""
        return replace(self, damping=np.zeros_like(self.damping))

    @cached_property
    def sizes(self) -> Array:
        """Square root of each coordinate's own inertia, (…, n)."""
        return np.sqrt(np.einsum("...kk->...k", self.mass))

    def scaled(self) -> ScaledSystem:
        """The same with each coordinate in units of its own inertia: 1 on the diagonal of M.

        Whether a coordinate was in radians or in metres is then of no account for rounding.
        """
        turns = self.turns
        order = np.array([*turns, *self.joints])
        size = self.sizes[..., order]
        by = _outer(size, size)
        m, g, d, k = (
            a[..., order[:, None], order] / by
            for a in (self.mass, self.gyric, self.damping, self.stiffness)
        )
        inverse, held = self.integrals()
        count, first = len(turns), int(self.attitude.about is not None)
        of_turns = size[..., :count]
        inverse, held = (
            inverse * _outer(of_turns, of_turns),
            held / _outer(of_turns, size[..., first:]),
        )
        return ScaledSystem(order, count, first, m, g + d, d, k, inverse, held)

    def roots(self) -> Array:
        """All 2n roots s of det(M s² + (G + D) s + K), (…, 2n), by imaginary part and then real.

        Turning about the axis of spin changes nothing, so its column of K is zero and gives one
        root that is exactly zero; it is split off, which keeps the other zero root (a changed
        spin rate) from being smeared by a double one.
        """
        n, inner = len(self.names), self.deviations
        rate = self.gyric + self.damping
        bottom = -np.linalg.solve(self.mass, _joined(self.stiffness[..., inner], rate, -1))
        top = np.zeros((len(inner), len(inner) + n))
        for row, p in enumerate(inner):
            top[row, len(inner) + p] = 1.0
        roots = np.linalg.eigvals(_joined(top, bottom, -2)).astype(complex)
        zero = np.zeros((*roots.shape[:-1], n - len(inner)), complex)
        roots = np.concatenate([roots, zero], -1)
        order = np.lexsort((roots.real.round(9), roots.imag.round(9)))
        return np.take_along_axis(roots, order, -1)

    def integrals(self) -> tuple[Array, Array]:
        """M_aa⁻¹ and P (over all but the turn about the axis of spin) of δh = M_a ẋ + P x.

        In the turning frame the momentum balance reads ḣ + e × h = 0, so each transverse row of
        K is a row of P, and along the axis of spin the row of G is.
        """
        before, about, after = self.attitude.before, self.attitude.about, self.attitude.after
        zero = np.zeros(len(self.names))
        rows = []
        if about is not None:
            rows.append(self.gyric[..., about, :])
        if before is not None:
            rows.append(zero if after is None else -self.stiffness[..., after, :])
        if after is not None:
            rows.append(zero if before is None else self.stiffness[..., before, :])
        lead = np.broadcast_shapes(*(row.shape[:-1] for row in rows)) if rows else ()
        held = np.zeros((*lead, len(rows), len(self.deviations)))
        for index, row in enumerate(rows):
            held[..., index, :] = row[..., self.deviations]
        return np.linalg.inv(self.mass[..., self.turns, :][..., self.turns]), held

    def amended(self) -> Array:
        """Hessian over the deviations of the energy at fixed angular momentum, K + Pᵀ M_aa⁻¹ P,
        (…, n − 1, n − 1).

        The rest of that energy is positive definite in the joints' rates. Only the symmetric part
        of K counts.
        """
        x = self.deviations
        return _amended(self.stiffness[..., x, :][..., x], *self.integrals())


@dataclass(frozen=True, eq=False)
class ScaledSystem:
    """M, C = G + D, D and K of a system, and M_aa⁻¹ and P of its integrals δh = M_a ẋ + P x, with
    coordinates in units of their own inertia.

    They are taken in another `order` (n,): the turns first, `turns` of them, then the joints.
    `first` is 1 where the turn about the axis of spin is the first of them, else 0: the deviations
    begin there.
    """

    order: Array
    turns: int
    first: int
    mass: Array
    rate: Array
    damping: Array
    stiffness: Array
    inverse: Array
    held: Array

    @cached_property
    def potential(self) -> Array:
        """The amended potential, as `GyricSystem.amended`."""
        x = self.first
        return _amended(self.stiffness[..., x:, x:], self.inverse, self.held)


def _amended(stiffness: Array, inverse: Array, held: Array) -> Array:
    matrix = stiffness + np.swapaxes(held, -1, -2) @ inverse @ held
    return (matrix + np.swapaxes(matrix, -1, -2)) / 2


def _outer(a: Array, b: Array) -> Array:
    return a[..., :, None] * b[..., None, :]


def _joined(a: Array, b: Array, axis: int) -> Array:
    """Two stacks of matrices side by side (axis −1) or one above the other (−2)."""
    lead = np.broadcast_shapes(a.shape[:-2], b.shape[:-2])
    parts = [np.broadcast_to(x, (*lead, *x.shape[-2:])) for x in (a, b)]
    return np.concatenate(parts, axis)


def coupled(mass: Array, *others: Array) -> Array:
    """Which coordinates act on each other, rounding aside, in any of a stack of systems."""
    size = np.sqrt(_largest(np.einsum("...kk->...k", mass), 1))
    worst = sum(_largest(a, 2) for a in (mass, *others))
    return worst > _DECOUPLED * size[:, None] * size[None, :]


def _largest(stack: Array, keep: int) -> Array:
    return np.abs(stack).max(axis=tuple(range(stack.ndim - keep)))


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
