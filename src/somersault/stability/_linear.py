"""Small deviations from a steady spin: their equations, roots, modes and energy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.model import Model
from somersault.model._pose import spread
from somersault.stability import _gyric
from somersault.stability._coordinates import coordinates
from somersault.stability._gyric import TOLERANCE, Attitude
from somersault.stability._modes import Mode, modes
from somersault.stability._spin import Spin

_MOST = 1e9  # non-dimensional stiffness or damping beyond which roots are rounding


@dataclass(frozen=True, eq=False)
class LinearSpin:
    """M ẍ + (G + D) ẋ + (K + K′) x = 0, time in units of 1/Ω (Playter 1994, eq. 4.9).

    Matrices (n, n) in kg m², over `coordinates`: tilt, twist and somersault are small turns
    about the principal axes nearest body axes 1, 3 and 2; mirrored joints move as a pair,
    symmetrically or antisymmetrically, when both are free to.
    """

    spin: Spin
    coordinates: tuple[str, ...]
    M: Array
    G: Array
    D: Array
    K: Array
    """Stiffness of the spin alone."""
    K_springs: Array
    """K′, stiffness of the springs, over Ω²."""
    attitude: Attitude

    @cached_property
    def roots(self) -> Array:
        """The 2n roots, in units of Ω."""
        return _gyric.roots(self.M, self.G + self.D, self.K + self.K_springs, self.attitude)

    @cached_property
    def growth_rate(self) -> float:
        """Largest growth rate in units of Ω, of motions that keep the angular momentum.

        The drift of the somersault angle and the stroboscopic mode are left out, as in all
        directional stability (section 2.3).
        """
        system = _gyric.reduced(self.M, self.G + self.D, self.K + self.K_springs, self.attitude)
        return float(_gyric.growth_rate(system))

    @property
    def stable(self) -> bool:
        """Directionally stable: nothing grows faster than 1e-6 Ω."""
        return self.growth_rate <= TOLERANCE

    @property
    def growth_per_somersault(self) -> float:
        """Factor by which the fastest mode grows in one turn (1 where nothing grows)."""
        rate = self.growth_rate
        return 1.0 if abs(rate) <= TOLERANCE else float(np.exp(min(2 * np.pi * rate, 700.0)))

    @cached_property
    def potential(self) -> Array:
        """Eigenvalues, ascending, of the energy's second variation by position.

        At fixed angular momentum (the amended potential), over all but the somersault angle;
        the kinetic part is positive in the joints' rates. In kg m² (times Ω²).
        """
        matrix = _gyric.amended(self.M, self.G, self.K + self.K_springs, self.attitude)
        return np.linalg.eigvalsh((matrix + matrix.T) / 2)

    @property
    def energy_signature(self) -> str:
        """Why the spin is stable, or is not, dampers aside.

        "definite": its energy is a strict minimum (or, with no joint free to move, maximum)
        among motions of the same angular momentum, so it stays stable, with dampers too.
        "gyroscopic": the energy is a saddle, and only gyroscopic coupling holds it; damping
        destroys it. "neutral": nothing grows, but some deviation leaves the energy as it is, so
        nothing restores it either. "unstable": it grows.

        A ball joint's holding torque is constant in its body's axes and so has no energy; K is
        then not symmetric, and the signature is that of its symmetric part.
        """
        if not self.potential.size:  # nothing but the drift of the spin's own angle
            return "definite"
        low, high = self.potential[0], self.potential[-1]
        small = 1e-9 * max(abs(low), abs(high))
        rigid = len(self.coordinates) == len(self.attitude.places())
        if low > small or (rigid and high < -small):
            return "definite"
        if not replace(self, D=np.zeros_like(self.D)).stable:
            return "unstable"
        one_sided = low >= -small or (rigid and high <= small)
        return "neutral" if one_sided else "gyroscopic"

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """The modes, one for each root with Im ≥ 0, named so that a person can read them."""
        return modes(self)

    @cached_property
    def subsystems(self) -> tuple[tuple[str, ...], ...]:
        """Coordinates in groups that do not act on each other."""
        return tuple(tuple(self.coordinates[i] for i in group) for group in self.groups)

    @cached_property
    def groups(self) -> list[list[int]]:
        """Places of the coordinates of each subsystem."""
        near = coupled(self.M, self.G, self.K, self.K_springs, self.D)
        return _gyric.blocks(_gyric.together(near, self.attitude))

    def subsystem(self, coordinate: str) -> LinearSpin:
        """The decoupled part that holds a coordinate, as a system of its own."""
        group = next((g for g in self.subsystems if coordinate in g), None)
        if group is None:
            raise SomersaultError(
                f"there is no coordinate {coordinate!r}; there are {', '.join(self.coordinates)}"
            )
        return self.part([self.coordinates.index(name) for name in group])

    def part(self, keep: list[int]) -> LinearSpin:
        at = np.ix_(keep, keep)
        return LinearSpin(
            self.spin,
            tuple(self.coordinates[i] for i in keep),
            self.M[at],
            self.G[at],
            self.D[at],
            self.K[at],
            self.K_springs[at],
            part_of(self.attitude, keep),
        )

    def dataset(self) -> Any:
        """Everything above as a labelled `xarray.Dataset`."""
        from somersault.stability._tables import linear_dataset

        return linear_dataset(self)

    def __repr__(self) -> str:
        verdict = "stable" if self.stable else "unstable"
        return (
            f"<LinearSpin of {self.spin.model.name} about axis {self.spin.axis}: {verdict}, "
            f"{self.energy_signature}, ×{self.growth_per_somersault:.3g} a turn, over "
            f"{', '.join(self.coordinates)}>"
        )


def part_of(attitude: Attitude, keep: list[int]) -> Attitude:
    """The attitude's places among some of the coordinates."""
    moved = [
        keep.index(p) if p in keep else None
        for p in (attitude.before, attitude.about, attitude.after)
    ]
    return Attitude(*moved)


def coupled(mass: Array, *others: Array) -> Array:
    """Which coordinates act on each other, rounding aside, in any of a stack of systems."""
    size = np.sqrt(_largest(np.einsum("...kk->...k", mass), 1))
    worst = sum(_largest(a, 2) for a in (mass, *others))
    return worst > 1e-10 * size[:, None] * size[None, :]


def _largest(stack: Array, keep: int) -> Array:
    return np.abs(stack).max(axis=tuple(range(stack.ndim - keep)))


def linear(
    spin: Spin,
    stiffness: Mapping[str, float],
    damping: Mapping[str, float],
    lock: Iterable[str],
    rate: float | None,
) -> LinearSpin:
    """What `Spin.linear` gives; its documentation says what the arguments mean."""
    for what, given in (("stiffness", stiffness), ("damping", damping)):
        if not isinstance(given, Mapping):
            raise SomersaultError(f"{what} gives numbers by joint, and is {given!r}")
    chosen = coordinates(spin.model, spin.axis, locked_speeds(spin.model, lock))
    own_k, own_d = (np.array(x) for x in _own(spin, rate))
    k = diagonal(spin, stiffness, "stiffness", own_k)
    d = diagonal(spin, damping, "damping", own_d)
    m, g, k_spin = (
        chosen.transformed(a) for a in (spin.mass_matrix, spin.gyric_matrix, spin.stiffness_matrix)
    )
    springs, dampers = (chosen.transformed(np.diag([0, 0, 0, *x])) for x in (k, d))
    order = chosen.ordered(coupled(m, g, k_spin, springs, dampers))
    at = np.ix_(order, order)
    names = tuple(chosen.names[i] for i in order)
    size = np.sqrt(np.diag(m))
    m, g, k_spin, springs, dampers = (
        np.where(np.abs(a) > 1e-14 * np.outer(size, size), a, 0.0)  # what rounding left
        for a in (m, g, k_spin, springs, dampers)
    )
    return LinearSpin(
        spin,
        names,
        m[at],
        g[at],
        dampers[at],
        k_spin[at],
        springs[at],
        part_of(chosen.attitude, order),
    )


def _own(spin: Spin, rate: float | None) -> tuple[list[float], list[float]]:
    """The model's own springs and dampers at a spin rate, over Ω² and over Ω, kg m²."""
    joints = [joint for joint in spin.model.joints for _ in range(joint.speeds)]
    if rate is None:
        return [0.0] * len(joints), [0.0] * len(joints)
    if not 1e-6 <= abs(one_number("the spin rate", rate)) <= 1e6:
        raise SomersaultError(f"a spin rate of {rate} rad/s is no spin; give 1e-6 to 1e6")
    return [j.stiffness / rate**2 for j in joints], [j.damping / abs(rate) for j in joints]


def diagonal(spin: Spin, given: Mapping[str, float], what: str, default: Array) -> Array:
    """Spring (damper) numbers at each joint speed in kg m², from non-dimensional ones."""
    result = default.copy()
    for name, value in spread(spin.model, given, mirrored=False).items():
        number = one_number(f"{what} of {name}", value)
        if abs(number) > _MOST:
            raise SomersaultError(f"{what} of {name} is {number:g}; lock a joint that stiff")
        if number < 0 and what == "damping":
            raise SomersaultError(f"damping of {name} is {number:g}; dampers are not negative")
        own = spin.model.speed_slice(name)
        result[own] = [number * spin.outboard_inertias[s] for s in spin.model.speeds[own]]
    return result


def one_number(what: str, value: Any) -> float:
    """A finite number, or SomersaultError naming what should have been one."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = float("nan")
    if not np.isfinite(number):
        raise SomersaultError(f"{what} is {value!r}; give a finite number")
    return number


def locked_speeds(model: Model, lock: Iterable[str]) -> set[int]:
    """Places of the locked joints' speeds; "all" locks every joint."""
    if isinstance(lock, str):
        lock = [lock]
    try:
        names = [str(name) for name in lock]
    except TypeError:
        raise SomersaultError(f"lock takes joint names, and is {lock!r}") from None
    if "all" in names:
        names = [joint.name for joint in model.joints]
    places: set[int] = set()
    for name in spread(model, dict.fromkeys(names, 0.0), mirrored=False):
        own = model.speed_slice(name)
        places |= set(range(own.start, own.stop))
    return places
