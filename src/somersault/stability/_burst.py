"""How strong a 2 : 1 resonance is: which size of a wobble it lets burst, and how soon.

At ω_s ≈ 2 ω_u the amplitudes of the two modes, x = Re Σ a · shape · exp(i ω t), obey

    ȧ_u = B a_s ā_u,    ȧ_s = i δ a_s + A a_u²,    δ = ω_s − 2 ω_u,

to second order: the quadratic terms of the equations of motion, projected on the modes. A B is
real. If it is negative |a_u|² and |a_s|² are exchanged; if it is positive both grow. With c =
√|A B|, from a_s = 0 and |a_u| = a they burst if |δ| < 4 c a, and at δ = 0 within π / (2 c a): |a_u|
is then a / cos(c a t).
(The three-wave equations; explosive ones: Coppi, Rosenbluth and Sudan, Ann. Phys. 55, 1969.)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.stability._reduced_motion import ReducedMotion, reduced_motion
from somersault.stability._resonances import Resonance
from somersault.stability._springs import finite
from somersault.stability._types import LinearSpin

_SAME = 1e-9  # between roots, in units of Ω
_STEP = 2e-3  # of differences, rad or so; their error goes with its fourth power


@dataclass(frozen=True, eq=False)
class Burst:
    """What an explosive 2 : 1 resonance does to a wobble; `burst` makes one.

    Amplitudes are those of the tilt, the twist or the joint that moves most (rad, m).

    Attributes
    ----------
    strength : float
        √|A B|, in units of the spin rate Ω for an amplitude of 1: how fast the slow mode and the
        fast one make each other grow.
    detuning : float
        How far the frequencies are from 2 : 1, in units of Ω.
    """

    strength: float
    detuning: float
    _slow: Array

    @property
    def threshold(self) -> float:
        """The least amplitude of the slow mode that bursts: |δ| / (4 √|A B|)."""
        return abs(self.detuning) / (4 * self.strength)

    def width(self, amplitude: float) -> float:
        """How far off the resonance a slow mode of that amplitude bursts, in units of Ω.

        Parameters
        ----------
        amplitude : float
            rad (m for a slide).

        Returns
        -------
        float

        Raises
        ------
        SomersaultError
            For a negative amplitude.

        Examples
        --------
        >>> import somersault as so
        >>> doll = so.spin("doll_weighted", pose={"shoulder": 1.6}).linear({"shoulder": 0.98})
        >>> two_to_one, *_ = doll.resonances(order=3)
        >>> round(so.stability.burst(doll, two_to_one).width(0.01), 4)
        0.0122
        """
        size = number("amplitude", amplitude)
        if not size >= 0:
            raise SomersaultError(f"an amplitude is not negative, and this is {size:g}")
        return 4 * self.strength * size

    def turns(self, amplitude: float) -> float:
        """Within how many turns it bursts at exact resonance, the fast mode at rest at first.

        Parameters
        ----------
        amplitude : float
            Of the slow mode at first, rad (m for a slide).

        Returns
        -------
        float

        Raises
        ------
        SomersaultError
            For an amplitude that is not positive.

        Examples
        --------
        >>> import somersault as so
        >>> doll = so.spin("doll_weighted", pose={"shoulder": 1.6}).linear({"shoulder": 0.98})
        >>> two_to_one, *_ = doll.resonances(order=3)
        >>> round(so.stability.burst(doll, two_to_one).turns(0.01), 1)
        81.7
        """
        size = number("amplitude", amplitude)
        if not size > 0:
            raise SomersaultError(f"an amplitude of {size:g} never bursts; give a positive one")
        return 1 / (4 * self.strength * size)

    def amplitude(self, tilt: ArrayLike = 0.0, twist: ArrayLike = 0.0) -> Array:
        """The slow mode's amplitude after a takeoff with some tilt and twist.

        Joints are at rest, and the angular momentum is along the axis that the body should spin
        about. In a body that is not its own mirror image the same start sets the fast mode going
        too, of which threshold, width and turns know nothing: it bursts sooner or later than they
        say.

        Parameters
        ----------
        tilt, twist : array_like
            rad, small.

        Returns
        -------
        numpy.ndarray

        Examples
        --------
        >>> import somersault as so
        >>> doll = so.spin("doll_weighted", pose={"shoulder": 1.6}).linear({"shoulder": 0.98})
        >>> two_to_one, *_ = doll.resonances(order=3)
        >>> so.stability.burst(doll, two_to_one).amplitude(tilt=[0.01, 0.02]).round(4)
        array([0.0324, 0.0647])
        """
        tilt, twist = finite("tilt", tilt), finite("twist", twist)
        return np.asarray(np.abs(self._slow[0] * tilt + self._slow[1] * twist))


def burst(spin: LinearSpin, resonance: Resonance) -> Burst:
    """How small a wobble an explosive 2 : 1 resonance lets burst, and how soon.

    From the quadratic terms of the equations of motion, dampers aside.

    Parameters
    ----------
    spin : LinearSpin
    resonance : Resonance
        One of its `resonances`.

    Returns
    -------
    Burst
        What the quadratic terms say of the fast mode at rest. How a burst ends is up to higher
        terms: a flight may be lost, or come back.

    Raises
    ------
    SomersaultError
        For one that is not an explosive 2 : 1 or of another spin, and for a body with a ball joint.

    Examples
    --------
    >>> import somersault as so
    >>> layout = so.spin("furrer", pose={"shoulder": 1.3}).linear({"shoulder": 1.16})
    >>> two_to_one, *_ = layout.resonances(order=3)
    >>> found = so.stability.burst(layout, two_to_one)
    >>> round(found.threshold, 4)  # rad: smaller wobbles do not grow
    0.0008
    """
    instance("a spin", spin, LinearSpin)
    instance("a resonance", resonance, Resonance)
    if not resonance.explosive or sorted(map(abs, resonance.counts)) != [1, 2]:
        raise SomersaultError(f"{resonance.words} is no explosive 2 : 1 resonance; take one")
    own = np.array([mode.root for mode in spin.modes])
    if any(np.abs(own - mode.root).min() > _SAME for mode in resonance.modes):
        raise SomersaultError(
            f"{resonance.words} is a resonance of another spin; take one of this spin's resonances"
        )
    return two_to_one(reduced_motion(spin), resonance)[0]


def two_to_one(motion: ReducedMotion, resonance: Resonance) -> tuple[Burst, float]:
    """Any 2 : 1 resonance, and A B, which is positive where it is explosive."""
    frequencies = [mode.root.imag for mode in resonance.modes]
    slow, fast = sorted(frequencies)
    steady = motion.steady
    size = len(steady)

    def along(directions: Array) -> tuple[Array, Array]:
        """First and second derivatives along real directions (N, size)."""
        steps = _STEP * np.array([-2, -1, 0, 1, 2])
        points = steady + steps[:, None, None] * directions
        f = motion.rates(points.reshape(-1, size)).reshape(5, -1, size)
        first = (f[0] - 8 * f[1] + 8 * f[3] - f[4]) / (12 * _STEP)
        second = (-f[0] + 16 * f[1] - 30 * f[2] + 16 * f[3] - f[4]) / (12 * _STEP**2)
        return first, second

    values, vectors = np.linalg.eig(along(np.eye(size))[0].T)
    duals = np.linalg.inv(vectors)
    shapes, projections = [], []
    for frequency in (slow, fast):
        at = int(np.argmin(np.abs(values - 1j * frequency)))
        scale = motion.amplitude(vectors[:, at])
        shapes.append(vectors[:, at] / scale)
        projections.append(duals[at] * scale)
    twice = _bilinear(lambda x: along(x)[1])
    driving = projections[1] @ twice(shapes[0], shapes[0]) / 4
    driven = projections[0] @ twice(shapes[1], shapes[0].conj()) / 2
    # x = Re(a shape), so a start has twice its projection.
    by_angle = np.array([2 * projections[0] @ motion.turned(k) for k in (0, 1)])
    found = Burst(float(np.sqrt(abs(driving * driven))), fast - 2 * slow, by_angle)
    return found, float((driving * driven).real)


def _bilinear(square: Callable[[Array], Array]) -> Callable[[Array, Array], Array]:
    """The symmetric form of complex vectors whose squares of real ones are given."""

    def form(a: Array, b: Array) -> Array:
        parts = [(x, y) for x in (a.real, a.imag) for y in (b.real, b.imag)]
        sums, differences = (square(np.array([x + sign * y for x, y in parts])) for sign in (1, -1))
        rr, ri, ir, ii = (sums - differences) / 4
        return np.asarray(rr - ii + 1j * (ri + ir))

    return form
