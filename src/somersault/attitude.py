"""Somersault, tilt and twist; quaternions; direction cosines.

Attitude is the 2-1-3 sequence of Playter (1994), eq. 2.2: somersault Φ about the inertial 2
axis, then tilt Θ about the carried 1 axis, then twist Ψ about the body's 3 axis. `C_bi`
takes inertial components to body components. Quaternions are scalar first and turn body
components into inertial ones, so `matrix_from_quaternion(q)` is `C_bi` transposed.

A body drawn otherwise somersaults, tilts and twists about other axes (a, b, c) of its own: its
attitude is R_a(Φ) R_b(Θ) R_c(Ψ). Renaming axes is all that this takes (`in_sequence`): whoever
tilts about his front and twists about his head has a at his left or, with the sense of Φ turned
round, at his right.

Angles are in radians, in the order (Φ, Θ, Ψ). Everything works on stacks: the last axis (the
last two of matrices) holds the components, those before it are carried along.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError

Axes = tuple[int, int, int]

AXES: Axes = (2, 1, 3)
SINGULAR = 1e-15  # cos Θ below which somersault and twist are told apart by convention
_RIGHT_HANDED = ((2, 1, 3), (1, 3, 2), (3, 2, 1))  # as tilt, somersault, twist: 1, 2, 3 in turn


def as_axes(axes: Any) -> Axes:
    """Axes of somersault, tilt and twist; SomersaultError unless they are 1, 2, 3 in some order."""
    given = tuple(axes) if isinstance(axes, Sequence | np.ndarray) else ()
    if not all(isinstance(k, int | np.integer) and not isinstance(k, bool) for k in given) or (
        given not in permutations((1, 2, 3))
    ):
        raise SomersaultError(
            f"axes {shown(axes)} are not those of somersault, tilt and twist; give 1, 2 and 3 in "
            "some order, like (2, 1, 3)"
        )
    a, b, c = (int(k) for k in given)
    return a, b, c


def side(axes: Axes) -> int:
    """1 where the axis of somersault is at the left of the axes of tilt (front) and twist (head),
    −1 where it is at the right."""
    return 1 if tuple(axes) in _RIGHT_HANDED else -1


def in_sequence(vector: Sequence[Any], axes: Axes) -> list[Any]:
    """A vector's three components along front, left and head, where 2-1-3 has its axes 1, 2, 3.

    Numbers, arrays or symbols. Attitudes renamed so (the vector part of a quaternion) have Θ and
    Ψ of the sequence about `axes`, and `side` times its Φ.
    """
    a, b, c = axes
    return [vector[b - 1], side(axes) * vector[a - 1], vector[c - 1]]


def from_sequence(vector: Sequence[Any], axes: Axes) -> list[Any]:
    """The inverse of `in_sequence`: a vector's three components in the body's own axes."""
    a, b, c = axes
    found: list[Any] = [None] * 3
    found[b - 1], found[a - 1], found[c - 1] = vector[0], side(axes) * vector[1], vector[2]
    return found


def direction_cosines(somersault: ArrayLike, tilt: ArrayLike, twist: ArrayLike) -> Array:
    """C_bi (…, 3, 3) of eq. 2.2, from angles (…) in rad that broadcast together."""
    s, t, w = np.broadcast_arrays(*(np.asarray(x, float) for x in (somersault, tilt, twist)))
    (sf, cf), (st, ct), (sp, cp) = ((np.sin(x), np.cos(x)) for x in (s, t, w))
    return _matrix(
        [
            [cp * cf + sp * st * sf, sp * ct, -cp * sf + sp * st * cf],
            [-sp * cf + cp * st * sf, cp * ct, sp * sf + cp * st * cf],
            [ct * sf, -st, ct * cf],
        ]
    )


def matrix_from_quaternion(quaternion: ArrayLike) -> Array:
    """Rotation matrix (…, 3, 3) of unit quaternions (…, 4)."""
    w, x, y, z = np.moveaxis(np.asarray(quaternion, float), -1, 0)
    return _matrix(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def quaternion_from_matrix(matrix: ArrayLike) -> Array:
    """Unit quaternions (…, 4) of rotation matrices (…, 3, 3), with w ≥ 0.

    Each is read from the largest of w², x², y², z² (Shepperd), so half turns are as exact
    as small ones.
    """
    r = np.asarray(matrix, float)
    xx, yy, zz = r[..., 0, 0], r[..., 1, 1], r[..., 2, 2]
    wx, wy, wz = (r[..., j, i] - r[..., i, j] for i, j in ((1, 2), (2, 0), (0, 1)))
    yz, zx, xy = (r[..., j, i] + r[..., i, j] for i, j in ((1, 2), (2, 0), (0, 1)))
    products = _matrix(  # 4 q qᵀ
        [
            [1 + xx + yy + zz, wx, wy, wz],
            [wx, 1 + xx - yy - zz, xy, zx],
            [wy, xy, 1 - xx + yy - zz, yz],
            [wz, zx, yz, 1 - xx - yy + zz],
        ]
    )
    largest = np.argmax(np.diagonal(products, axis1=-2, axis2=-1), -1)
    row = np.take_along_axis(products, largest[..., None, None], -2)[..., 0, :]
    row = row / np.linalg.norm(row, axis=-1, keepdims=True)
    return np.where(row[..., :1] < 0, -row, row)


def quaternion_product(first: ArrayLike, second: ArrayLike) -> Array:
    """p q (…, 4) of quaternions (…, 4): the turn q, then the turn p."""
    p, q = np.asarray(first, float), np.asarray(second, float)
    real = p[..., 0] * q[..., 0] - np.sum(p[..., 1:] * q[..., 1:], -1)
    parts = p[..., :1] * q[..., 1:] + q[..., :1] * p[..., 1:] + np.cross(p[..., 1:], q[..., 1:])
    return np.concatenate([real[..., None], parts], -1)


def quaternion_conjugate(quaternion: ArrayLike) -> Array:
    """The inverse turn (…, 4) of unit quaternions (…, 4)."""
    return np.asarray(quaternion, float) * [1.0, -1.0, -1.0, -1.0]


def quaternion_from_angles(
    somersault: ArrayLike, tilt: ArrayLike, twist: ArrayLike, axes: Axes = AXES
) -> Array:
    """Unit quaternions (…, 4) from angles (…) in rad about `axes`; continuous in the angles."""
    halves = (0.5 * np.asarray(x, float) for x in (somersault, tilt, twist))
    (sf, cf), (st, ct), (sp, cp) = ((np.sin(x), np.cos(x)) for x in halves)
    sf = side(axes) * sf
    vector = [
        cf * st * cp + sf * ct * sp,
        sf * ct * cp - cf * st * sp,
        cf * ct * sp - sf * st * cp,
    ]
    return np.stack([cf * ct * cp + sf * st * sp, *from_sequence(vector, axes)], -1)


def angles_from_quaternion(quaternion: ArrayLike, axes: Axes = AXES) -> Array:
    """(Φ, Θ, Ψ) (…, 3) of quaternions (…, 4): Θ in [−π/2, π/2], Φ and Ψ in [−π, π].

    The angles always give the attitude back to rounding. At Θ = ±π/2 only the sum or the
    difference of Φ and Ψ is an attitude: there the twist is 0 and the somersault has it all.
    """
    half_sum, half_difference, tilt, _ = _halves(np.asarray(quaternion, float), axes)
    return _signed(_from_halves(half_sum, half_difference, tilt), axes)


def angles_from_matrix(cosines: ArrayLike) -> Array:
    """(Φ, Θ, Ψ) (…, 3) of direction cosines C_bi (…, 3, 3), as `angles_from_quaternion`."""
    c = np.asarray(cosines, float)
    return angles_from_quaternion(quaternion_from_matrix(np.swapaxes(c, -1, -2)))


def body_rates(angles: ArrayLike, rates: ArrayLike, axes: Axes = AXES) -> Array:
    """ω (…, 3), rad/s in body axes, from (Φ, Θ, Ψ) and their rates (…, 3): eq. 2.4."""
    _, tilt, twist = np.ascontiguousarray(np.moveaxis(np.asarray(angles, float), -1, 0))
    somersaulting, tilting, twisting = np.moveaxis(np.asarray(rates, float), -1, 0)
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
    """(Φ̇, Θ̇, Ψ̇) (…, 3), rad/s, from (Φ, Θ, Ψ) and ω (…, 3) in body axes: eq. 2.3.

    As the inverse of eq. 2.4, Φ̇ and Ψ̇ hold 1/cos Θ and tan Θ (where 2.3 reads as products
    with cos Θ, fraction bars are lost). They grow without bound towards Θ = ±π/2.
    """
    _, tilt, twist = np.moveaxis(np.asarray(angles, float), -1, 0)
    w1, w2, w3 = in_sequence(list(np.moveaxis(np.asarray(omega, float), -1, 0)), axes)
    somersaulting = (np.sin(twist) * w1 + np.cos(twist) * w2) / np.cos(tilt)
    tilting = np.cos(twist) * w1 - np.sin(twist) * w2
    rates = np.stack([somersaulting, tilting, w3 + np.sin(tilt) * somersaulting], -1)
    return _signed(rates, axes)


def unwrapped_angles(quaternions: ArrayLike, axes: Axes = AXES) -> Array:
    """(Φ, Θ, Ψ) (…, time, 3) along paths of attitudes (…, time, 4), through any number of turns.

    Every attitude is (Φ, Θ, Ψ) and also (Φ + π, π − Θ, Ψ + π), each plus whole turns. The
    first sample has Θ in [−π/2, π/2]; each further one is the representation nearest the
    sample before it. So tilt runs on through ±π/2, and a body that tilts head over heels has
    Φ and Ψ at rest. A sample at Θ = ±π/2 itself keeps the sum or difference of Φ and Ψ that
    is free there from its neighbour.

    Samples must be less than a quarter turn apart and, where a path goes by the singularity,
    closer than it: one that goes by between two samples is taken to go through, which is the
    same attitude but may count a turn of somersault and of twist differently.

    Raises `SomersaultError` where an attitude is not finite.
    """
    q = np.asarray(quaternions, float)
    if not np.all(np.isfinite(q)):
        raise SomersaultError("Attitudes along a path must be finite; remove the others first.")
    half_sum, half_difference, tilt, free = _halves(q, axes)
    half_sum = _kept(half_sum, free & (tilt > 0))
    half_difference = _kept(half_difference, free & (tilt < 0))
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


def _matrix(rows: list[list[Array]]) -> Array:
    return np.stack([np.stack(row, -1) for row in rows], -2)


def _wrapped(angle: Array) -> Array:
    """The same angles in [−π, π]."""
    return angle - 2 * np.pi * np.round(angle / (2 * np.pi))


def _signed(angles: Array, axes: Axes) -> Array:
    """(Φ, Θ, Ψ) (…, 3), or rates, about `axes`, of those of attitudes `in_sequence`."""
    return angles * [side(axes), 1, 1]


def _halves(q: Array, axes: Axes) -> tuple[Array, Array, Array, Array]:
    """(Φ + Ψ)/2, (Φ − Ψ)/2, Θ of attitudes `in_sequence`, and whether a half is free (Θ = ±π/2).

    From w ± x and y ∓ z, which are the cosine and sine of (Φ ∓ Ψ)/2 times cos Θ/2 ± sin Θ/2:
    no digits are lost near the singularity. A free half is that of no twist.
    """
    w, *vector = np.moveaxis(q, -1, 0)
    x, y, z = in_sequence(vector, axes)
    plus, minus = np.hypot(w + x, y - z), np.hypot(w - x, y + z)
    tilt = 2 * np.arctan2(plus - minus, plus + minus)
    free = np.minimum(plus, minus) <= SINGULAR * np.maximum(plus, minus)
    half_sum, half_difference = np.arctan2(y + z, w - x), np.arctan2(y - z, w + x)
    return (
        np.where(free & (tilt > 0), half_difference, half_sum),
        np.where(free & (tilt < 0), half_sum, half_difference),
        tilt,
        free,
    )


def _from_halves(half_sum: Array, half_difference: Array, tilt: Array) -> Array:
    turns = _wrapped(np.stack([half_sum + half_difference, half_sum - half_difference], -1))
    return np.stack([turns[..., 0], tilt, turns[..., 1]], -1)


def _kept(values: Array, missing: Array) -> Array:
    """Values (…, time) with missing ones copied from before them, or at the start from after."""
    if not missing.any():
        return values
    steps = np.arange(values.shape[-1])
    before = np.maximum.accumulate(np.where(missing, -1, steps), -1)
    after = np.minimum.accumulate(np.where(missing, len(steps), steps)[..., ::-1], -1)[..., ::-1]
    source = np.where(before < 0, np.where(after < len(steps), after, steps), before)
    return np.take_along_axis(values, source, -1)
