"""Somersault, tilt and twist: of attitudes, along paths, and their rates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats, require_together, together
from somersault.attitude._axes import AXES, Axes, from_sequence, in_sequence, side
from somersault.attitude._quaternions import quaternion_from_matrix, stacked

SINGULAR = 1e-8  # cos Θ below which turns are not followed along a path
_ROUNDING = 1e-15  # cos Θ below which an attitude's somersault and twist cannot be told apart


def direction_cosines(somersault: ArrayLike, tilt: ArrayLike, twist: ArrayLike) -> Array:
    """C_bi, which takes inertial components to body components (Playter 1994, eq. 2.2).

    Parameters
    ----------
    somersault, tilt, twist : array_like
        rad, which broadcast.

    Returns
    -------
    numpy.ndarray, shape (..., 3, 3)

    Examples
    --------
    >>> import numpy as np
    >>> from somersault.attitude import direction_cosines
    >>> direction_cosines(0.0, 0.0, np.pi / 2).round(3).tolist()
    [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -0.0, 1.0]]
    """
    s, t, w = together(somersault=somersault, tilt=tilt, twist=twist)
    (sf, cf), (st, ct), (sp, cp) = ((np.sin(x), np.cos(x)) for x in (s, t, w))
    return stacked(
        [
            [cp * cf + sp * st * sf, sp * ct, -cp * sf + sp * st * cf],
            [-sp * cf + cp * st * sf, cp * ct, sp * sf + cp * st * cf],
            [ct * sf, -st, ct * cf],
        ]
    )


def quaternion_from_angles(
    somersault: ArrayLike, tilt: ArrayLike, twist: ArrayLike, axes: Axes = AXES
) -> Array:
    """Unit quaternions from somersault, tilt and twist; continuous in the angles.

    Parameters
    ----------
    somersault, tilt, twist : array_like
        rad, which broadcast.
    axes : tuple of int
        The body axes that they are about.

    Returns
    -------
    numpy.ndarray, shape (..., 4)
        Scalar first, body to inertial.

    Examples
    --------
    >>> import numpy as np
    >>> from somersault.attitude import quaternion_from_angles
    >>> quaternion_from_angles(np.pi, 0.0, 0.0).round(3).tolist()
    [0.0, 0.0, 1.0, 0.0]
    """
    halves = (0.5 * x for x in together(somersault=somersault, tilt=tilt, twist=twist))
    (sf, cf), (st, ct), (sp, cp) = ((np.sin(x), np.cos(x)) for x in halves)
    sf = side(axes) * sf
    vector = [
        cf * st * cp + sf * ct * sp,
        sf * ct * cp - cf * st * sp,
        cf * ct * sp - sf * st * cp,
    ]
    return np.stack([cf * ct * cp + sf * st * sp, *from_sequence(vector, axes)], -1)


def angles_from_quaternion(quaternion: ArrayLike, axes: Axes = AXES) -> Array:
    """Somersault, tilt and twist of quaternions.

    The angles always give the attitude back to rounding. At Θ = ±π/2 only the sum or the
    difference of Φ and Ψ is an attitude: there the twist is 0 and the somersault has it all.

    Parameters
    ----------
    quaternion : array_like, shape (..., 4)
        Scalar first, body to inertial, of any length.
    axes : tuple of int
        The body axes that the angles are about.

    Returns
    -------
    numpy.ndarray, shape (..., 3)
        (Φ, Θ, Ψ), rad: Θ in [−π/2, π/2], Φ and Ψ in [−π, π].

    Examples
    --------
    >>> from somersault.attitude import angles_from_quaternion
    >>> angles_from_quaternion([1.0, 0.0, 1.0, 0.0]).round(4).tolist()
    [1.5708, 0.0, 0.0]
    """
    half_sum, half_difference, tilt, _ = _halves(floats("quaternion", quaternion, 4), axes)
    return _signed(_from_halves(half_sum, half_difference, tilt), axes)


def angles_from_matrix(cosines: ArrayLike) -> Array:
    """Somersault, tilt and twist of direction cosines, as `angles_from_quaternion` has them.

    Parameters
    ----------
    cosines : array_like, shape (..., 3, 3)
        C_bi.

    Returns
    -------
    numpy.ndarray, shape (..., 3)
        (Φ, Θ, Ψ), rad.

    Examples
    --------
    >>> from somersault.attitude import angles_from_matrix, direction_cosines
    >>> angles_from_matrix(direction_cosines(0.3, 0.2, 0.1)).round(4).tolist()
    [0.3, 0.2, 0.1]
    """
    c = floats("cosines", cosines, 3, 3)
    return angles_from_quaternion(quaternion_from_matrix(np.swapaxes(c, -1, -2)))


def body_rates(angles: ArrayLike, rates: ArrayLike, axes: Axes = AXES) -> Array:
    """Angular velocity from somersault, tilt and twist and their rates (Playter 1994, eq. 2.4).

    Parameters
    ----------
    angles : array_like, shape (..., 3)
        (Φ, Θ, Ψ), rad.
    rates : array_like, shape (..., 3)
        (Φ̇, Θ̇, Ψ̇), rad/s.
    axes : tuple of int
        The body axes that they are about.

    Returns
    -------
    numpy.ndarray, shape (..., 3)
        ω in body axes, rad/s.

    Examples
    --------
    >>> from somersault.attitude import body_rates
    >>> body_rates([0.0, 0.0, 0.0], [5.0, 0.1, 0.2]).tolist()
    [0.1, 5.0, 0.2]
    """
    angles, rates = _vectors(angles=angles, rates=rates)
    _, tilt, twist = np.ascontiguousarray(np.moveaxis(angles, -1, 0))
    somersaulting, tilting, twisting = np.moveaxis(rates, -1, 0)
    somersaulting = side(axes) * somersaulting
    s, c = np.sin(twist), np.cos(twist)
    across = np.cos(tilt) * somersaulting
    omega = [
        c * tilting + s * across,
        -s * tilting + c * across,
        twisting - np.sin(tilt) * somersaulting,
    ]
    return np.stack(from_sequence(omega, axes), -1)


def angle_rates(angles: ArrayLike, omega: ArrayLike, axes: Axes = AXES) -> Array:
    """Rates of somersault, tilt and twist from the angular velocity (Playter 1994, eq. 2.3).

    As the inverse of eq. 2.4, Φ̇ and Ψ̇ hold 1/cos Θ and tan Θ (where 2.3 reads as products
    with cos Θ, fraction bars are lost). They grow without bound towards Θ = ±π/2.

    Parameters
    ----------
    angles : array_like, shape (..., 3)
        (Φ, Θ, Ψ), rad.
    omega : array_like, shape (..., 3)
        Angular velocity in body axes, rad/s.
    axes : tuple of int
        The body axes that the angles are about.

    Returns
    -------
    numpy.ndarray, shape (..., 3)
        (Φ̇, Θ̇, Ψ̇), rad/s.

    Examples
    --------
    >>> from somersault.attitude import angle_rates
    >>> angle_rates([0.0, 0.0, 0.0], [0.1, 5.0, 0.2]).tolist()
    [5.0, 0.1, 0.2]
    """
    angles, omega = _vectors(angles=angles, omega=omega)
    _, tilt, twist = np.moveaxis(angles, -1, 0)
    sines = (np.sin(tilt), np.cos(tilt)), (np.sin(twist), np.cos(twist))
    return np.stack(sequence_rates(*sines, list(np.moveaxis(omega, -1, 0)), axes), -1)


def sequence_rates(
    tilt: Sequence[Any], twist: Sequence[Any], omega: Sequence[Any], axes: Axes = AXES
) -> list[Any]:
    """`angle_rates` of numbers, arrays or symbols.

    Parameters
    ----------
    tilt, twist : sequence of two
        Sine and cosine of either angle.
    omega : sequence of three
        Angular velocity in body axes, rad/s.
    axes : tuple of int
        The body axes that the angles are about.

    Returns
    -------
    list of three
        (Φ̇, Θ̇, Ψ̇), rad/s.

    Examples
    --------
    >>> from somersault.attitude import sequence_rates
    >>> sequence_rates((0.0, 1.0), (0.0, 1.0), [0.1, 5.0, 0.2])
    [5.0, 0.1, 0.2]
    """
    (sine, cosine), (s, c) = tilt, twist
    w1, w2, w3 = in_sequence(omega, axes)
    somersaulting = (s * w1 + c * w2) / cosine
    return [side(axes) * somersaulting, c * w1 - s * w2, w3 + sine * somersaulting]


def cayley_klein(quaternion: ArrayLike, axes: Axes = AXES) -> tuple[Array, Array]:
    """The Cayley–Klein parameters of attitudes about their axis of tilt.

    Parameters
    ----------
    quaternion : array_like, shape (..., 4)
        Scalar first, body to inertial.
    axes : tuple of int
        The body axes that the angles are about.

    Returns
    -------
    numpy.ndarray, shape (...), complex
        At the angle (Φ − Ψ)/2, and as long as cos Θ/2 + sin Θ/2.
    numpy.ndarray, shape (...), complex
        At the angle (Φ + Ψ)/2, and as long as cos Θ/2 − sin Θ/2; where Φ is about an axis at the
        right, −Φ is meant.

    Examples
    --------
    >>> import numpy as np
    >>> from somersault.attitude import cayley_klein, quaternion_from_angles
    >>> up, down = cayley_klein(quaternion_from_angles(0.3, 1.0, 0.1))
    >>> np.angle([up, down]).round(6).tolist()
    [0.1, 0.2]
    """
    w, *vector = np.moveaxis(floats("quaternion", quaternion, 4), -1, 0)
    x, y, z = in_sequence(vector, axes)
    return (w + x) + 1j * (y - z), (w - x) + 1j * (y + z)


def unwrapped_angles(
    quaternions: ArrayLike, axes: Axes = AXES, start: ArrayLike | None = None
) -> Array:
    """Somersault, tilt and twist along paths of attitudes, through any number of turns.

    Every attitude is (Φ, Θ, Ψ) and also (Φ + π, π − Θ, Ψ + π), each plus whole turns. The
    first sample has Θ in [−π/2, π/2]; each further one is the representation nearest the
    sample before it. So tilt runs on through ±π/2, and a body that tilts head over heels has
    Φ and Ψ at rest. At Θ = ±π/2, and within 1e-8 rad of it, a sample keeps the sum or difference
    of Φ and Ψ that is free there from its neighbour: a body that stays there turns by the other.

    Samples must be less than a quarter turn apart and, where a path goes by the singularity,
    closer than it: one that goes by between two samples is taken to go through, which is the
    same attitude but may count a turn of somersault and of twist differently.

    Parameters
    ----------
    quaternions : array_like, shape (..., time, 4)
        Scalar first, body to inertial.
    axes : tuple of int
        The body axes that the angles are about.
    start : array_like, shape (..., 3), optional
        The angles of the first sample, to have what is free there if it is at Θ = ±π/2.

    Returns
    -------
    numpy.ndarray, shape (..., time, 3)
        (Φ, Θ, Ψ), rad.

    Raises
    ------
    SomersaultError
        Where an attitude is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from somersault.attitude import quaternion_from_angles, unwrapped_angles
    >>> path = quaternion_from_angles(np.linspace(0, 20, 50), 0.1, 0.0)
    >>> unwrapped_angles(path)[-1].round(6).tolist()
    [20.0, 0.1, 0.0]
    """
    q = floats("quaternions", quaternions, 4)
    if q.ndim < 2:
        raise SomersaultError("A path is a row of attitudes, (time, 4), and this is one alone.")
    if not np.all(np.isfinite(q)):
        raise SomersaultError("Attitudes along a path must be finite; remove the others first.")
    half_sum, half_difference, tilt, free = _halves(q, axes, SINGULAR)
    of_sum, of_difference = None, None
    if start is not None:
        somersault, _, twist = np.moveaxis(_signed(floats("start", start, 3), axes), -1, 0)
        of_sum, of_difference = (somersault + twist) / 2, (somersault - twist) / 2
    half_sum = _kept(half_sum, free & (tilt > 0), of_sum)
    half_difference = _kept(half_difference, free & (tilt < 0), of_difference)
    angles = _from_halves(half_sum, half_difference, tilt)
    step = np.diff(angles, axis=-2)
    other = step + np.pi
    other[..., 1] = np.pi - angles[..., 1:, 1] - angles[..., :-1, 1]
    # Changing both samples to their second representation keeps their distance, so whether
    # a step crosses over does not depend on the representation it starts from.
    crosses = np.sum(_wrapped(other) ** 2, -1) < np.sum(_wrapped(step) ** 2, -1)
    first = np.zeros((*crosses.shape[:-1], 1), int)
    second = np.concatenate([first, np.cumsum(crosses, -1)], -1) % 2 == 1
    turned = angles + np.pi
    turned[..., 1] = np.pi - angles[..., 1]
    return _signed(np.unwrap(np.where(second[..., None], turned, angles), axis=-2), axes)


def _vectors(**values: ArrayLike) -> list[Array]:
    """Vectors (…, 3) that broadcast against each other."""
    arrays = {name: floats(name, value, 3) for name, value in values.items()}
    require_together({name: array.shape for name, array in arrays.items()})
    return [*arrays.values()]


def _wrapped(angle: Array) -> Array:
    """The same angles in [−π, π]."""
    return angle - 2 * np.pi * np.round(angle / (2 * np.pi))


def _signed(angles: Array, axes: Axes) -> Array:
    """(Φ, Θ, Ψ) (…, 3), or rates, about `axes`, of those of attitudes `in_sequence`."""
    return angles * [side(axes), 1, 1]


def _halves(q: Array, axes: Axes, singular: float = _ROUNDING) -> tuple[Array, Array, Array, Array]:
    """(Φ + Ψ)/2, (Φ − Ψ)/2, Θ of attitudes `in_sequence`, and whether a half is free (Θ = ±π/2).

    From w ± x and y ∓ z, which are the cosine and sine of (Φ ∓ Ψ)/2 times cos Θ/2 ± sin Θ/2:
    no digits are lost near the singularity. A free half is that of no twist.
    """
    up, down = cayley_klein(q, axes)
    plus, minus = np.hypot(up.real, up.imag), np.hypot(down.real, down.imag)
    tilt = 2 * np.arctan2(plus - minus, plus + minus)
    free = np.minimum(plus, minus) <= singular / 2 * np.maximum(plus, minus)
    half_sum, half_difference = np.arctan2(down.imag, down.real), np.arctan2(up.imag, up.real)
    return (
        np.where(free & (tilt > 0), half_difference, half_sum),
        np.where(free & (tilt < 0), half_sum, half_difference),
        tilt,
        free,
    )


def _from_halves(half_sum: Array, half_difference: Array, tilt: Array) -> Array:
    turns = _wrapped(np.stack([half_sum + half_difference, half_sum - half_difference], -1))
    return np.stack([turns[..., 0], tilt, turns[..., 1]], -1)


def _kept(values: Array, missing: Array, start: Array | None) -> Array:
    """Values (…, time) with missing ones copied from before them; at the start they are those
    given, or copied from after, or all the first one."""
    if not missing.any():
        return values
    if start is not None:
        first = np.where(missing[..., 0], start, values[..., 0])
        values = np.concatenate([first[..., None], values[..., 1:]], -1)
        missing = np.concatenate([np.zeros_like(missing[..., :1]), missing[..., 1:]], -1)
    steps = np.arange(values.shape[-1])
    before = np.maximum.accumulate(np.where(missing, -1, steps), -1)
    after = np.minimum.accumulate(np.where(missing, len(steps), steps)[..., ::-1], -1)[..., ::-1]
    source = np.where(before < 0, np.where(after < len(steps), after, 0), before)
    return np.take_along_axis(values, source, -1)
