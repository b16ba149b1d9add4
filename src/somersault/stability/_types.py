"""A steady spin, and the linear equations of small deviations from it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.model import Model
from somersault.stability._coordinates import coordinates, locked_speeds
from somersault.stability._growth import extremes, growth_rate
from somersault.stability._gyric import Attitude, GyricSystem, coupled
from somersault.stability._modes import Mode, modes
from somersault.stability._principal import cycle
from somersault.stability._reflection import odd_places, parities
from somersault.stability._resonances import MOST_ORDER, Resonance, near
from somersault.stability._springs import own_strengths, strengths

if TYPE_CHECKING:
    import xarray as xr

_DUST = 1e-14  # of the coordinates' inertias: what rounding leaves where there is nothing
_SIGNATURES = ("definite", "neutral", "gyroscopic", "unstable")  # from best to worst
_READABLE = 1.05  # factor in a turn from which on it is easier to read than turns for an e-fold
_GREATEST = 700.0  # exponent beyond which a factor is no number of the machine


@dataclass(frozen=True, eq=False)
class Spin:
    """A body turning steadily about a principal axis in a fixed pose; `spin` makes one.

    Any pose is one, with constant torques at the joints; springs pretensioned to those
    torques hold it without effort (Playter 1994, section 4.2.2).

    Attributes
    ----------
    model : Model
        The body.
    axis : int
        1, 2 or 3: the body axis nearest the axis of spin.
    pose : numpy.ndarray, shape (coordinates,)
        Joint coordinates, rad (m for slides).
    principal_inertias : numpy.ndarray, shape (3,)
        About the principal axes nearest body axes 1, 2 and 3, kg m².
    principal_axes : numpy.ndarray, shape (3, 3)
        Their directions, as columns, in the base's axes. Of a planar model these are the base's own
        axes, principal or not, as it turns about the one across its plane alone.
    holding_torques : mapping of str to float
        What holds each joint at Ω = 1 rad/s, by its speed's name, N m (N); times Ω² otherwise.
    outboard_inertias : mapping of str to float
        The I of each joint in K = k/(Ω² I), by its speed's name, kg m² (kg for a slide).
    mass_matrix, gyric_matrix, stiffness_matrix : numpy.ndarray, shape (3 + speeds, 3 + speeds)
        M, G and K of the spin alone at Ω = 1 rad/s, over turns about the principal axes and the
        joint speeds, kg m².
    """

    model: Model
    axis: int
    pose: Array
    principal_inertias: Array
    principal_axes: Array
    holding_torques: Mapping[str, float]
    outboard_inertias: Mapping[str, float]
    mass_matrix: Array
    gyric_matrix: Array
    stiffness_matrix: Array

    @property
    def inertia_ratios(self) -> dict[str, float]:
        """k1 and k3 (Playter 1994, section 2.3.2), I2 being the inertia about the axis of spin.

        For spins about other axes than 2 the axes are renamed in turn, so that the order
        1, 2, 3 stays right-handed. A planar model, which neither tilts nor twists, has none: nan.
        """
        if self.model.plane is not None:
            return {"k1": np.nan, "k3": np.nan}
        before, about, after = self.principal_inertias[list(cycle(self.axis))]
        return {"k1": float((about - after) / before), "k3": float((about - before) / after)}

    def linear(
        self,
        stiffness: Mapping[str, float] | None = None,
        damping: Mapping[str, float] | None = None,
        lock: str | Iterable[str] = (),
        rate: float | None = None,
    ) -> LinearSpin:
        """The linear equations of small deviations, with joints sprung, damped or locked.

        Joints are named by their own name or, both sides of a left–right pair at once, by the
        name that they share.

        Parameters
        ----------
        stiffness : mapping of str to float, optional
            K = k/(Ω² I) by joint or pair, without dimension; I is the inertia of everything
            outboard of the joint about its axis.
        damping : mapping of str to float, optional
            B = b/(Ω I) by joint or pair, without dimension.
        lock : str or iterable of str
            Joints or pairs that are rigid; "all" locks every joint. The others are free.
        rate : float, optional
            Ω in rad/s. With it the model's own springs and dampers act on the joints that are not
            named; without it they are left out.

        Returns
        -------
        LinearSpin
            M ẍ + (G + D) ẋ + (K + K′) x = 0 (Playter 1994, eq. 4.9).

        Raises
        ------
        SomersaultError
            For an unknown name, a number that is not finite, or a negative damping.

        Examples
        --------
        >>> import somersault as so
        >>> layout = so.spin("furrer", pose={"shoulder": 1.3}).linear({"shoulder": 1.2})
        >>> layout.stable, layout.energy_signature
        (True, 'gyroscopic')
        >>> layout.coordinates[:3]
        ('tilt', 'twist', 'antisymmetric shoulder')
        """
        model = self.model
        chosen = coordinates(model, self.axis, locked_speeds(model, lock))
        outboard = np.array([self.outboard_inertias[name] for name in model.speeds])
        own_springs, own_dampers = own_strengths(model, rate)
        springs = by_name("stiffness", stiffness)
        dampers = by_name("damping", damping)
        k = strengths(model, "stiffness", springs, outboard, own_springs)
        d = strengths(model, "damping", dampers, outboard, own_dampers)
        of_spin = (self.mass_matrix, self.gyric_matrix, self.stiffness_matrix)
        whole = [*map(chosen.transformed, of_spin), *map(chosen.of_joints, (k, d))]
        order = chosen.ordered(coupled(*whole))
        m, g, of_spin_alone, of_springs, damped = _without_dust(np.stack(whole))[
            :, np.array(order)[:, None], order
        ]
        names = tuple(chosen.names[i] for i in order)
        attitude = chosen.attitude.part(order)
        return LinearSpin(self, names, m, g, damped, of_spin_alone, of_springs, attitude)


@dataclass(frozen=True, eq=False)
class LinearSpin:
    """M ẍ + (G + D) ẋ + (K + K′) x = 0, time in units of 1/Ω (Playter 1994, eq. 4.9).

    `Spin.linear` makes one.

    Attributes
    ----------
    spin : Spin
        The steady spin that is deviated from.
    coordinates : tuple of str
        Tilt, twist and somersault are small turns about the principal axes nearest body axes 1, 3
        and 2; mirrored joints move as a pair, symmetrically or antisymmetrically, when both are
        free to.
    M, G, D, K, K_springs : numpy.ndarray, shape (n, n)
        Mass, gyric and damping matrix, stiffness of the spin alone and of the springs, kg m².
    attitude : Attitude
        Which of the coordinates are the body's own attitude.
    """

    spin: Spin
    coordinates: tuple[str, ...]
    M: Array
    G: Array
    D: Array
    K: Array
    K_springs: Array
    attitude: Attitude

    @cached_property
    def system(self) -> GyricSystem:
        """The matrices as one value, with the linear algebra of such systems."""
        stiffness = self.K + self.K_springs
        return GyricSystem(self.coordinates, self.M, self.G, self.D, stiffness, self.attitude)

    @cached_property
    def roots(self) -> Array:
        """The 2n roots, (2n,) complex, in units of Ω."""
        return self.system.roots()

    @cached_property
    def growth_rate(self) -> float:
        """Largest growth rate in units of Ω, of motions that keep the angular momentum.

        Its sign can be relied on: where rounding hides it, the energy decides. It is 0 where
        nothing grows or decays as far as can be known. The drift of the somersault angle and the
        stroboscopic mode are left out, as in all directional stability (Playter 1994, section 2.3).
        """
        if not self.D.any():
            return float(growth_rate(self.system))
        # With dampers energies count: rounding must not mix modes that do not act on each other.
        return max(float(growth_rate(part)) for part in self.system.parts())

    @property
    def stable(self) -> bool:
        """Directionally stable: nothing that keeps the angular momentum grows, however slowly."""
        return self.growth_rate <= 0

    @property
    def growth_per_somersault(self) -> float:
        """Factor by which the fastest mode grows in one turn (1 where nothing grows or decays)."""
        return float(np.exp(min(2 * np.pi * self.growth_rate, _GREATEST)))

    @property
    def growth_in_words(self) -> str:
        """How fast the fastest mode grows: "grows × 11.3 in a turn", "grows one e-fold in 44,600
        turns"."""
        if self.growth_rate == 0:
            return "nothing grows"
        return f"{'grows' if self.growth_rate > 0 else 'decays'} {_in_turns(self.growth_rate)}"

    @cached_property
    def potential(self) -> Array:
        """Eigenvalues, ascending, of the energy's second variation by position, (n − 1,).

        At fixed angular momentum (the amended potential), over all but the somersault angle;
        the kinetic part is positive in the joints' rates. In kg m² (times Ω²).
        """
        return np.linalg.eigvalsh(self.system.amended())

    @cached_property
    def energy_signature(self) -> str:
        """Why the spin is stable, or is not, leaving its dampers aside.

        - "definite": its energy is a strict minimum (or, where no joint moves, maximum) among
          motions of the same angular momentum, so it stays stable, with dampers too;
        - "gyroscopic": the energy is a saddle, and only gyroscopic coupling holds the spin;
          damping destroys it;
        - "neutral": nothing grows, but some deviation leaves the energy as it is, so nothing
          restores it either;
        - "unstable": it grows.

        Of subsystems that do not act on each other, the worst counts. A ball joint's holding torque
        is constant in its body's axes and so has no energy; K is then not symmetric, and the
        signature is that of its symmetric part.
        """
        by_part = [_signature(part) for part in self.system.undamped().parts()]
        return max(by_part, key=_SIGNATURES.index)

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """The modes, one for each root with Im ≥ 0, named so that a person can read them."""
        return modes(self.spin.model, self.system)

    def resonances(self, order: int = 4, within: float = 0.05) -> tuple[Resonance, ...]:
        """Frequencies of the modes that are nearly in a ratio of whole numbers, dampers aside.

        The spin's own rate is no partner: nothing in flight depends on which way a body points.
        Of a body that is its own mirror image across the axis of spin, those are left out that the
        mirror forbids.

        Parameters
        ----------
        order : int
            Up to which order, 3 to 8: 3 are those of cubic terms in the energy, 2 : 1 and
            ω₁ + ω₂ = ω₃.
        within : float
            How far off the sum may be, in units of Ω.

        Returns
        -------
        tuple of Resonance
            Those of least order first, the nearest of them first. An explosive one of order three
            is unstable at any size, although nothing grows in the linear equations.

        Raises
        ------
        SomersaultError
            For another order, or a detuning that is negative.

        Examples
        --------
        >>> import somersault as so
        >>> layout = so.spin("furrer", pose={"shoulder": 1.3}).linear({"shoulder": 1.16})
        >>> for found in layout.resonances(order=3, within=0.01):
        ...     print(found.words, found.explosive)
        2 × 0.2683 ≈ 0.5371 Ω True
        """
        order, within = whole_number("order", order, 3, MOST_ORDER), number("within", within)
        if not within >= 0:
            raise SomersaultError(f"within is {within:g}; a detuning is not negative")
        model, system = self.spin.model, self.system.undamped()
        swinging = [m for m in modes(model, system) if m.energy and m.root.real == 0]
        parity = parities(model, self.spin.axis, self.coordinates, self.spin.pose)
        reversed_ = odd_places(parity, system.groups)
        odd = [bool(np.any(reversed_ & (mode.shape != 0))) for mode in swinging]
        return near(swinging, odd, order, within)

    @cached_property
    def subsystems(self) -> tuple[tuple[str, ...], ...]:
        """Coordinates in groups that do not act on each other."""
        return tuple(tuple(self.coordinates[i] for i in group) for group in self.system.groups)

    def subsystem(self, coordinate: str) -> LinearSpin:
        """The decoupled part that holds a coordinate, as a system of its own.

        Parameters
        ----------
        coordinate : str
            One of `coordinates`.

        Returns
        -------
        LinearSpin
            Over the coordinates that act on that one.

        Raises
        ------
        SomersaultError
            For a name that is no coordinate.

        Examples
        --------
        >>> import somersault as so
        >>> so.spin("furrer", pose={"shoulder": 1.3}).linear().subsystem("somersault").coordinates
        ('somersault', 'symmetric shoulder')
        """
        place = self.system.place(coordinate)
        keep = next(group for group in self.system.groups if place in group)
        m, g, d, k, springs = (
            a[np.ix_(keep, keep)] for a in (self.M, self.G, self.D, self.K, self.K_springs)
        )
        names = tuple(self.coordinates[i] for i in keep)
        return LinearSpin(self.spin, names, m, g, d, k, springs, self.attitude.part(keep))

    def dataset(self) -> xr.Dataset:
        """All of it as a labelled dataset.

        Returns
        -------
        xarray.Dataset
            Matrices over (equation, coordinate), roots over (root), modes' shapes over
            (mode, coordinate), the verdict in the attributes.
        """
        from somersault.stability._tables import linear_dataset

        matrices = {n: getattr(self, n) for n in ("M", "G", "D", "K", "K_springs")}
        verdict = {
            "model": self.spin.model.name,
            "axis": self.spin.axis,
            "stable": int(self.stable),
            "growth_per_somersault": self.growth_per_somersault,
            "energy_signature": self.energy_signature,
        }
        return linear_dataset(self.coordinates, matrices, self.roots, self.modes, verdict)

    def __repr__(self) -> str:
        verdict = "stable" if self.stable else "unstable"
        return (
            f"<LinearSpin of {self.spin.model.name} about axis {self.spin.axis}: {verdict}, "
            f"{self.energy_signature}, {self.growth_in_words}, over "
            f"{', '.join(self.coordinates)}>"
        )


def _without_dust(matrices: Array) -> Array:
    """M and other matrices (…, n, n) without what rounding left where there is nothing, against
    their coordinates' sizes; springs and dampers may be small."""
    size = np.sqrt(np.diag(matrices[0]))
    scaled = np.abs(matrices) / np.outer(size, size)
    largest = scaled.max((-2, -1), keepdims=True)
    return np.where(scaled > _DUST * np.minimum(largest, 1.0), matrices, 0.0)


def _in_turns(rate: float) -> str:
    """A rate (units of Ω) as a factor in a turn where that can be read, else as turns for e."""
    factor = np.exp(min(2 * np.pi * abs(rate), _GREATEST))
    if factor >= _READABLE:
        return f"× {factor if rate > 0 else 1 / factor:.4g} in a turn"
    turns = float(f"{1 / (2 * np.pi * abs(rate)):.3g}")
    return f"one e-fold in {turns:,.0f} turns" if turns < 1e9 else f"one e-fold in {turns:g} turns"


def _signature(part: GyricSystem) -> str:
    low, high = extremes(part)
    if low > 0 or (part.rigid and high < 0):
        return "definite"
    if growth_rate(part) > 0:
        return "unstable"
    return "neutral" if low == 0 or (part.rigid and high == 0) else "gyroscopic"
