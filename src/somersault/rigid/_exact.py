"""The motion of a free rigid body, exactly, at any time (A.4)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from somersault import attitude
from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats
from somersault.rigid._euler import Kind, checked_omega, kind_of_motion
from somersault.rigid._given import checked_times, fixed, unit_quaternion
from somersault.rigid._inertia import checked_inertias
from somersault.rigid._map import tilt_and_twist
from somersault.rigid._orbit import Orbit, orbit
from somersault.rigid._precession import Precession
from somersault.rigid._quadrature import period_and_somersault

_ALONG = 1e-14  # sine of the angle to inertial axis 2 below which h counts as lying along it
_MOST_SAMPLES = 2_000_000
_PER_PERIOD = 256  # samples of a mean over a period: of a smooth one every digit
_STEP = 0.02  # rad of turning between samples where turns are counted along the path


@dataclass(frozen=True, eq=False, init=False)
class RigidMotion:
    """Torque-free motion of a rigid body, exactly (Playter 1994, appendix A.4).

    Any order of the inertias and any direction of the angular momentum; both kinds of
    motion, the separatrix, symmetric and spherical bodies and pure spins. Times may have any
    shape and sign; errors are those of rounding and grow in proportion to the angle turned.

    Parameters
    ----------
    inertias : array_like, shape (3,)
        Principal inertias I1, I2, I3 about the body's axes, kg m².
    omega0 : array_like, shape (3,)
        Angular velocity at t = 0 in body axes, rad/s.
    attitude0 : array_like, shape (4,)
        Quaternion at t = 0, body to inertial, of any length.

    Raises
    ------
    SomersaultError
        For inertias that no body has, an angular velocity that is zero or not finite, and an
        attitude that is no quaternion.

    Examples
    --------
    >>> from somersault.rigid import RigidMotion
    >>> book = RigidMotion([3.0, 2.0, 1.0], [0.01, 5.0, 0.0])
    >>> book.kind, round(book.period, 2)
    ('major', 9.77)
    """

    inertias: Array
    omega0: Array
    attitude0: Array

    def __init__(
        self,
        inertias: ArrayLike,
        omega0: ArrayLike,
        attitude0: ArrayLike = (1.0, 0.0, 0.0, 0.0),
    ) -> None:
        put = object.__setattr__  # the class is frozen
        put(self, "inertias", fixed(checked_inertias(inertias)))
        put(self, "omega0", fixed(checked_omega(omega0)))
        put(self, "attitude0", fixed(unit_quaternion(attitude0)))

    @classmethod
    def from_momentum(
        cls, inertias: ArrayLike, momentum: ArrayLike, attitude0: ArrayLike = (1.0, 0.0, 0.0, 0.0)
    ) -> RigidMotion:
        """A motion from its angular momentum in inertial axes.

        Parameters
        ----------
        inertias : array_like, shape (3,)
            Principal inertias, kg m².
        momentum : array_like, shape (3,), or float
            Angular momentum in inertial axes, kg m²/s. A number is along inertial axis 2, as A.4
            has it.
        attitude0 : array_like, shape (4,)
            Quaternion at t = 0, body to inertial.

        Returns
        -------
        RigidMotion

        Raises
        ------
        SomersaultError
            As the class does, and for a momentum that is not finite.

        Examples
        --------
        >>> from somersault.rigid import RigidMotion
        >>> RigidMotion.from_momentum([3.0, 2.0, 1.0], 4.0).omega0.tolist()
        [0.0, 2.0, 0.0]
        """
        given = floats("momentum", momentum)
        h = np.array([0.0, float(given), 0.0]) if given.ndim == 0 else given
        if h.shape != (3,) or not np.all(np.isfinite(h)):
            raise SomersaultError(
                f"The angular momentum must be one or three finite numbers in kg m²/s, "
                f"not {shown(momentum)}."
            )
        turn = attitude.matrix_from_quaternion(unit_quaternion(attitude0))
        checked = checked_inertias(inertias)
        return cls(checked, h @ turn / checked, attitude0)

    @cached_property
    def momentum(self) -> Array:
        """Angular momentum in inertial axes (3,), kg m²/s."""
        turn = attitude.matrix_from_quaternion(self.attitude0)
        return turn @ (self.inertias * self.omega0)

    @cached_property
    def energy(self) -> float:
        """Kinetic energy of rotation, J: eq. 2.16."""
        return float(0.5 * np.sum(self.inertias * self.omega0**2))

    @cached_property
    def kind(self) -> Kind:
        """Which axis the angular momentum circles in the body: see `kind_of_motion`."""
        return kind_of_motion(self.inertias, self.omega0)

    @property
    def monotonic_twist(self) -> bool:
        """Whether twist goes on and on, because the axis that h circles is axis 3."""
        path = self._orbit
        return path is not None and path.kc > 0 and path.axes[2] == 2

    @property
    def period(self) -> float:
        """Time in which ω returns, s; infinite on the separatrix and where ω is constant."""
        path = self._orbit
        return math.inf if path is None else 4 * path.quarter / path.rate

    @property
    def mean_rates(self) -> tuple[float, float]:
        """Mean somersault and twist rates about the angular momentum, rad/s: `momentum_angles`.

        For the spin about axis 3 itself, where only their sum is defined, the limit of
        ever narrower cones about it (for axis 3 not the middle one).
        """
        if self._precession is not None:
            return self._precession.mean_rates
        rate = float(np.linalg.norm(self.omega0))
        one, two, three = self.inertias
        product = (one - three) * (two - three)
        if self.omega0[0] or self.omega0[1] or product <= 0:
            return rate, 0.0
        circling = math.copysign(math.sqrt(product / (one * two)), one - three) * rate
        return rate - circling, math.copysign(circling, circling * self.omega0[2])

    @property
    def twists_per_somersault(self) -> float:
        """Rotation number: mean twist rate over mean somersault rate, about h.

        By complete elliptic integrals of the first and third kind. Zero where twist only
        oscillates; positive twist is about +3.
        """
        somersault, twist = self.mean_rates
        return twist / somersault

    @property
    def mean_tilt(self) -> float:
        """Mean tilt of the body against its angular momentum over a period, rad.

        Raises
        ------
        SomersaultError
            On the separatrix, which has no period.
        """
        if self._orbit is not None and math.isinf(self.period):
            raise SomersaultError(
                "This motion is on the separatrix and never comes back, so it has no mean tilt; "
                "ask for angles(t) instead."
            )
        period = self.period if self._orbit is not None else 0.0
        times = np.arange(_PER_PERIOD) * period / _PER_PERIOD
        return float(tilt_and_twist(self.omega(times) * self.inertias)[0].mean())

    def omega(self, t: ArrayLike) -> Array:
        """Angular velocity (Playter 1994, A.8 to A.17).

        Parameters
        ----------
        t : array_like
            Times, s.

        Returns
        -------
        numpy.ndarray, shape (..., 3)
            In body axes, rad/s.

        Examples
        --------
        >>> from somersault.rigid import RigidMotion
        >>> RigidMotion([3.0, 2.0, 1.0], [0.0, 5.0, 0.0]).omega([0.0, 1.0]).tolist()
        [[0.0, 5.0, 0.0], [0.0, 5.0, 0.0]]
        """
        times = checked_times(t)
        path = self._orbit
        if path is None:
            return np.broadcast_to(self.omega0, (*times.shape, 3)).copy()
        at = path.elliptic(times)
        return path.omega(at) * path.flips(at)

    def quaternion(self, t: ArrayLike) -> Array:
        """Attitude as unit quaternions, body to inertial.

        They are continuous in time, so their sign is that of the given attitude at t = 0 and may
        become either.

        Parameters
        ----------
        t : array_like
            Times, s.

        Returns
        -------
        numpy.ndarray, shape (..., 4)
            Scalar first.

        Examples
        --------
        >>> import numpy as np
        >>> from somersault.rigid import RigidMotion
        >>> RigidMotion([3.0, 2.0, 1.0], [0.0, 1.0, 0.0]).quaternion(np.pi).round(3).tolist()
        [0.0, 0.0, 1.0, 0.0]
        """
        times = checked_times(t)
        if self._precession is None:
            return attitude.quaternion_product(self.attitude0, self._steady_turn(times))
        begin = self._precession.quaternion(np.zeros(()))
        frame = attitude.quaternion_product(self.attitude0, attitude.quaternion_conjugate(begin))
        return attitude.quaternion_product(frame, self._precession.quaternion(times))

    def angles(self, t: ArrayLike) -> Array:
        """Somersault, tilt and twist in the given inertial axes, continuous from t = 0 on.

        With the angular momentum along inertial axis 2 (either way) they are in closed form. With
        it elsewhere they are those of `quaternion`, and whole turns are counted along the path: see
        `attitude.unwrapped_angles`, also for how tilt runs through ±π/2.

        Parameters
        ----------
        t : array_like
            Times, s.

        Returns
        -------
        numpy.ndarray, shape (..., 3)
            (Φ, Θ, Ψ), rad.

        Raises
        ------
        SomersaultError
            For times that are not finite, and those beyond which turns can no longer be counted.

        Examples
        --------
        >>> from somersault.rigid import RigidMotion
        >>> RigidMotion([3.0, 2.0, 1.0], [0.0, 5.0, 0.0]).angles(2.0).tolist()
        [10.0, 0.0, 0.0]
        """
        times = checked_times(t)
        h = self.momentum
        if math.hypot(h[0], h[2]) > _ALONG * abs(h[1]):
            return self._counted(times)
        angles = self.momentum_angles(times)
        if h[1] > 0:
            return angles
        angles = angles * [-1.0, -1.0, 1.0] + [0.0, 0.0, np.pi]
        start = self.momentum_angles(0.0)[2] + np.pi
        angles[..., 2] -= 2 * np.pi * np.round(start / (2 * np.pi))
        return angles

    def momentum_angles(self, t: ArrayLike) -> Array:
        """Somersault, tilt and twist about the angular momentum, in closed form (A.19 to A.33).

        The inertial axes are the given ones turned the shortest way that brings axis 2 onto
        the angular momentum (by a half turn about 3 if it points along −2). Θ and Ψ are
        where h stands on the momentum sphere, Φ its precession; all are continuous and at
        t = 0 in [−π, π].

        Parameters
        ----------
        t : array_like
            Times, s.

        Returns
        -------
        numpy.ndarray, shape (..., 3)
            (Φ, Θ, Ψ), rad.

        Examples
        --------
        >>> from somersault.rigid import RigidMotion
        >>> tilted = RigidMotion([2.0, 2.0, 1.0], [0.0, 1.0, -0.5])
        >>> tilted.momentum_angles(0.0).round(3).tolist()
        [0.0, 0.245, 0.0]
        """
        times = checked_times(t)
        unaligned = attitude.quaternion_conjugate(_shortest_from_2(self.momentum))
        start = attitude.quaternion_product(unaligned, self.attitude0)
        first = attitude.angles_from_quaternion(start)
        if self._precession is None:
            rate = np.linalg.norm(self.omega0)
            return first + np.stack([rate * times, 0 * times, 0 * times], -1)
        angles = self._precession.angles(times)
        begin = self._precession.angles(np.zeros(()))
        turns = np.round((begin[2] - first[2]) / (2 * np.pi))
        return angles + np.array([first[0] - begin[0], 0.0, -2 * np.pi * turns])

    def twists_per_somersault_quadrature(self) -> float:
        """`twists_per_somersault` by numerical integration of A.22, with no elliptic function.

        Returns
        -------
        float
            Zero where twist only oscillates; positive twist is about +3.

        Raises
        ------
        SomersaultError
            For a constant angular velocity and on the separatrix, which have no period.
        """
        path = self._orbit
        if path is None or path.kc == 0:
            raise SomersaultError(
                "This motion has no period to integrate over, because it is a pure spin or on "
                "the separatrix; ask for twists_per_somersault instead."
            )
        if not self.monotonic_twist:
            return 0.0
        _, somersault = period_and_somersault(self.inertias, self.omega0)
        sense = self.omega0[2] * (self.inertias[0] - self.inertias[2])
        return math.copysign(2 * math.pi / somersault, sense)

    @cached_property
    def _orbit(self) -> Orbit | None:
        return orbit(self.inertias, self.omega0)

    @cached_property
    def _precession(self) -> Precession | None:
        if self._orbit is None:
            return None
        h = float(np.linalg.norm(self.inertias * self.omega0))
        return Precession(self.inertias, h, self._orbit)

    def _steady_turn(self, times: Array) -> Array:
        rate = float(np.linalg.norm(self.omega0))
        half = 0.5 * rate * times[..., None]
        return np.concatenate([np.cos(half), np.sin(half) * (self.omega0 / rate)], -1)

    def _counted(self, times: Array) -> Array:
        """Angles at times (…), with turns counted along samples close to each other from t = 0."""
        flat = times.reshape(-1)
        fastest = float(np.linalg.norm(self.momentum) / self.inertias.min())
        if np.abs(flat).max(initial=0.0) * fastest / _STEP > _MOST_SAMPLES:
            raise SomersaultError(
                f"Turns are counted up to {_MOST_SAMPLES * _STEP / fastest:.0f} s for this body; "
                "later, use quaternion(t), or lay the momentum along inertial axis 2."
            )
        counted = np.empty((flat.size, 3))
        for side in (flat >= 0, flat < 0):
            if not side.any():
                continue
            last = flat[side][np.argmax(np.abs(flat[side]))]
            fine = np.linspace(0.0, last, 2 + int(abs(last) * fastest / _STEP))
            path = np.unique(np.concatenate([np.abs(fine), np.abs(flat[side])]))
            signed = path if last >= 0 else -path
            angles = attitude.unwrapped_angles(self.quaternion(signed))
            counted[side] = angles[np.searchsorted(path, np.abs(flat[side]))]
        return counted.reshape(*times.shape, 3)


def _shortest_from_2(direction: Array) -> Array:
    """Quaternion (4,) of the shortest turn from axis 2 to a direction (3,)."""
    x, y, z = direction / np.linalg.norm(direction)
    across = math.hypot(x, z)
    if across <= _ALONG:
        return np.array([1.0, 0.0, 0.0, 0.0] if y > 0 else [0.0, 0.0, 0.0, 1.0])
    half = 0.5 * math.atan2(across, y)
    scale = math.sin(half) / across
    return np.array([math.cos(half), z * scale, 0.0, -x * scale])
