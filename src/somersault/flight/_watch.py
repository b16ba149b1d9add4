"""What is kept account of while a flight goes on: its turns, and how far it strays.

Turns are counted as `attitude.unwrapped_angles` counts them, from one step of the integration
to the next. Near the singularity (tilt ±π/2) steps are short, and on which side of it a path goes
by is read from the cubic that has the attitudes and their rates at both ends of a step. Nearer than
`SINGULAR` there is no side: a path that comes so near goes through, and one that stays there keeps
the half of the angles that has no meaning. Extremes are those of the cubic that has the
values and the rates at both ends of a step; the steps resolve the fastest motion, so they
are good to some thousandths of the swing.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np

from somersault.attitude import SINGULAR, Axes, in_sequence, side
from somersault.laws import wrapped
from somersault.model import Model

ANGLES = ("somersault", "tilt", "twist")
RATES = tuple(f"{name}_rate" for name in ANGLES)
VELOCITIES = tuple(f"angular_velocity_{k}" for k in (1, 2, 3))
_LONGEST = 1.0  # rad that a body turns in a step, and less near the singularity of the angles
NEAREST = 0.02  # cos Θ: no nearer to it are steps shorter still
_PAST = 3 * np.pi / 4  # rad: a half of the angles turns by π/2 to π in a step that passes it by

Quantities = Callable[[Any, Any, Any], dict[str, Any]]


def quantities(model: Model) -> list[str]:
    """Names of all that is known of a model's motion at a moment, but for the time."""
    rates = (f"{name}_rate" for name in model.speeds)
    return [*ANGLES, *RATES, *VELOCITIES, *model.coordinates, *rates]


def torques(model: Model) -> dict[str, str]:
    """Names of what acts at joints, and the joint speeds at which it does."""
    return {f"{name}_torque": name for name in model.speeds}


def watched(extremes: tuple[str, ...]) -> list[str]:
    """Names of the watched rows: the angles, then the least and greatest of each quantity."""
    return [*ANGLES, *(f"{which}_{name}" for name in extremes for which in ("least", "greatest"))]


def longest(quaternion: list[Any], omega: list[Any], axes: Axes) -> Any:
    """The longest step (s) from a state: to less than where somersault and twist run off."""
    upright = ca.sqrt(ca.fmax(1 - _sine_of_tilt(quaternion, axes) ** 2, 0))
    rate = ca.sqrt(sum(w * w for w in omega) + 1e-300)
    return ca.fmin(ca.fmax(upright, NEAREST), 1.0) * _LONGEST / rate


def watch(
    extremes: tuple[str, ...], quantities: Quantities, state: int, parameters: int, axes: Axes
) -> ca.Function:
    """The watched rows after a step, of the rows of `Rows.look`; angles are about `axes`."""
    y0, f0, y1, f1 = (ca.SX.sym(name, state) for name in ("y0", "f0", "y1", "f1"))
    t0, t1 = ca.SX.sym("t0"), ca.SX.sym("t1")
    p, before = ca.SX.sym("p", parameters), ca.SX.sym("w", 3 + 2 * len(extremes))
    angles = [before[k] for k in range(3)]
    ends = [[y[k] for k in range(4)] for y in (y0, y1)]
    slopes = [[(t1 - t0) * f[k] for k in range(4)] for f in (f0, f1)]
    after = _followed(angles, ends, slopes, axes)
    rows = list(after)
    if extremes:
        g0, rate0 = _with_rates(extremes, quantities, angles, y0, f0, t0, p, axes)
        g1, rate1 = _with_rates(extremes, quantities, after, y1, f1, t1, p, axes)
        for k in range(len(extremes)):
            least, greatest = _extremes(g0[k], g1[k], (t1 - t0) * rate0[k], (t1 - t0) * rate1[k])
            rows += [ca.fmin(before[3 + 2 * k], least), ca.fmax(before[4 + 2 * k], greatest)]
    look = ca.vertcat(y0, f0, y1, f1, t0, t1, p, before)
    return ca.Function("watch", [look], [ca.cse(ca.densify(ca.vertcat(*rows)))])


def values(
    extremes: tuple[str, ...], quantities: Quantities, state: int, parameters: int, axes: Axes
) -> ca.Function:
    """The quantities at one moment, of (angles, state, time, parameters)."""
    s, y, t = ca.SX.sym("s", 3), ca.SX.sym("y", state), ca.SX.sym("t")
    p = ca.SX.sym("p", parameters)
    known = named(quantities, [s[k] for k in range(3)], y, t, p, axes)
    chosen = ca.vertcat(*[known[name] for name in extremes])
    return ca.Function("values", [ca.vertcat(s, y, t, p)], [ca.cse(ca.densify(chosen))])


def _sine_of_tilt(quaternion: list[Any], axes: Axes) -> Any:
    w, x, y, z = _renamed(quaternion, axes)
    return 2 * (w * x - y * z) / (w * w + x * x + y * y + z * z)


def _renamed(quaternion: list[Any], axes: Axes) -> list[Any]:
    return [quaternion[0], *in_sequence(quaternion[1:], axes)]


def _followed(
    angles: list[Any], ends: list[list[Any]], slopes: list[list[Any]], axes: Axes
) -> list[Any]:
    """Somersault, tilt and twist at the end of a step, in the representation nearest to where
    `angles`, those before it, are carried; slopes are those of the ends, times the step."""
    (start, start_down), (end, end_down) = (_spun(quaternion, axes) for quaternion in ends)
    (leaving, leaving_down), (arriving, arriving_down) = (_spun(slope, axes) for slope in slopes)
    here, plus, minus = _read(angles, end, end_down, axes)
    up = minus < plus
    short = [
        _chosen(up, down, other)
        for down, other in (
            (start_down, start), (end_down, end), (leaving_down, leaving),
            (arriving_down, arriving),
        )
    ]  # fmt: skip
    past = _PAST * _sense_past(*short)
    carried = [angles[0] + side(axes) * past, angles[1], angles[2] + (2 * up - 1) * past]
    return _closest(here, carried)


def nearest(quaternion: list[Any], angles: list[Any], axes: Axes) -> list[Any]:
    """Somersault, tilt and twist of an attitude, in the representation nearest to `angles`."""
    here, _, _ = _read(angles, *_spun(quaternion, axes), axes)
    return _closest(here, angles)


def _read(angles: list[Any], end: Any, end_down: Any, axes: Axes) -> tuple[list[Any], Any, Any]:
    """Angles of the attitude of two such vectors as `_spun` gives, and their lengths; what is free
    at tilt ±π/2 is as in `angles`."""
    half_sum, half_difference = ca.atan2(end_down[1], end_down[0]), ca.atan2(end[1], end[0])
    plus = ca.sqrt(end[0] ** 2 + end[1] ** 2)
    minus = ca.sqrt(end_down[0] ** 2 + end_down[1] ** 2)
    tilt = 2 * ca.atan2(plus - minus, plus + minus)
    # Half the sum is free at tilt π/2, half the difference at −π/2: there each stays as it was.
    sum_was, difference_was = ((side(axes) * angles[0] + k * angles[2]) / 2 for k in (1, -1))
    half_sum = _chosen(2 * minus < SINGULAR * plus, sum_was, half_sum)
    half_difference = _chosen(2 * plus < SINGULAR * minus, difference_was, half_difference)
    here = [side(axes) * (half_sum + half_difference), tilt, half_sum - half_difference]
    return here, plus, minus


def _closest(here: list[Any], carried: list[Any]) -> list[Any]:
    """Angles `here` or their other representation, with the whole turns that bring either nearest
    to what is `carried`."""
    there = [here[0] + np.pi, np.pi - here[1], here[2] + np.pi]
    by = [wrapped(a - b) for a, b in zip(here, carried, strict=True)]
    other = [wrapped(a - b) for a, b in zip(there, carried, strict=True)]
    crosses = sum(d * d for d in other) < sum(d * d for d in by)
    # Not `if_else`: it multiplies, and a number that is not finite would spread.
    return [a + one + crosses * (two - one) for a, one, two in zip(carried, by, other, strict=True)]


def _spun(quaternion: list[Any], axes: Axes) -> tuple[Any, Any]:
    """Two vectors, linear in the quaternion, that stand at the angles (Φ − Ψ)/2 and (Φ + Ψ)/2 and
    are as long as cos Θ/2 ± sin Θ/2."""
    w, x, y, z = _renamed(quaternion, axes)
    return ca.vertcat(w + x, y - z), ca.vertcat(w - x, y + z)


def _sense_past(start: Any, end: Any, leaving: Any, arriving: Any) -> Any:
    """The sense, ±1, in which a vector turns on its way past zero: 0 if it turns by less than π/2
    or goes through."""
    across = end - start
    length = ca.dot(across, across) + 1e-300
    s = -ca.dot(across, start) / length
    # The cubic where the chord is nearest to zero, which is within the step if it passes zero.
    bend = s * (1 - s) * ((1 - s) * (leaving - across) - s * (arriving - across))
    nearest = start + bend
    beside = nearest[0] * across[1] - nearest[1] * across[0]
    passes = (ca.dot(start, end) < 0) * (SINGULAR**2 * length < 2 * beside * beside)
    return passes * (1 - 2 * (beside < 0))


def _chosen(condition: Any, one: Any, other: Any) -> Any:
    """One or another, both of them finite."""
    return other + condition * (one - other)


def named(
    quantities: Quantities, angles: list[Any], y: Any, t: Any, p: Any, axes: Axes
) -> dict[str, Any]:
    """All quantities by name, with the angles and their rates, at a state where the angles are
    these."""
    _, tilt, twist = angles
    known = quantities(y, t, p)
    w1, w2, w3 = in_sequence([known[name] for name in VELOCITIES], axes)
    singular = ca.fabs(ca.cos(tilt)) < SINGULAR
    somersaulting = (ca.sin(twist) * w1 + ca.cos(twist) * w2) / (ca.cos(tilt) + singular)  # eq. 2.3
    # At the singularity the half of the angles that is free there is kept (`_followed`).
    somersaulting = _chosen(singular, -ca.sin(tilt) * w3 / 2, somersaulting)
    tilting = ca.cos(twist) * w1 - ca.sin(twist) * w2
    rates = [side(axes) * somersaulting, tilting, w3 + ca.sin(tilt) * somersaulting]
    return {
        **dict(zip(ANGLES, angles, strict=True)),
        **dict(zip(RATES, rates, strict=True)),
        **known,
    }


def _with_rates(
    names: tuple[str, ...],
    quantities: Quantities,
    angles: list[Any],
    y: Any,
    f: Any,
    t: Any,
    p: Any,
    axes: Axes,
) -> tuple[list[Any], list[Any]]:
    """Quantities and their time derivatives, at a state whose slope is f."""
    s, yy, tt = ca.SX.sym("s", 3), ca.SX.sym("yy", y.numel()), ca.SX.sym("tt")
    known = named(quantities, [s[k] for k in range(3)], yy, tt, p, axes)
    chosen = ca.vertcat(*[known[name] for name in names])
    direction = ca.vertcat(*[known[name] for name in RATES], f, 1.0)
    point = ca.vertcat(s, yy, tt)
    rate = ca.jtimes(chosen, point, direction)
    at = ca.vertcat(*angles, y, t)
    chosen, rate = ca.substitute([chosen, rate], [point], [at])
    return [chosen[k] for k in range(len(names))], [rate[k] for k in range(len(names))]


def _extremes(g0: Any, g1: Any, a0: Any, a1: Any) -> tuple[Any, Any]:
    """Least and greatest of the cubic with values g and slopes a at both ends of (0, 1)."""
    c, b = a0 + a1 - 2 * (g1 - g0), 3 * (g1 - g0) - 2 * a0 - a1
    root = ca.sqrt(ca.fmax(b * b - 3 * c * a0, 0))
    q = -(b + (1 - 2 * (b < 0)) * root)
    candidates = [g0, g1]
    for s in (q / (3 * c), a0 / q):
        # Not a number, where there is no such turning point, is an end of the step.
        inside = ca.fmin(ca.fmax(s, 0.0), 1.0)
        candidates.append(g0 + inside * (a0 + inside * (b + inside * c)))
    least = ca.fmin(ca.fmin(candidates[0], candidates[1]), ca.fmin(candidates[2], candidates[3]))
    greatest = ca.fmax(ca.fmax(candidates[0], candidates[1]), ca.fmax(candidates[2], candidates[3]))
    return least, greatest
