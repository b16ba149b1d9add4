"""Whether the values of a joint's path stay within its limits."""

from __future__ import annotations

from math import degrees, pi

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.model import LIMIT_SLACK, Joint
from somersault.motion._path import Path

_TURNS = 4 * pi  # rad: no joint winds up so far; degrees read as radians soon do
_BETWEEN = 4  # points within each piece at which limits are checked beside its extremes


def check_slack(slack: float) -> float:
    """How far beyond its limits a joint may be; SomersaultError for what is negative."""
    if number("slack", slack) < 0:
        raise SomersaultError(f"slack must not be negative, and is {slack:g}")
    return float(slack)


def check_within(joint: Joint, values: Array, times: Array, slack: float) -> None:
    """SomersaultError where a joint's values (K,) at times (K,) go beyond its limits by `slack`.

    Says so where they look like degrees.
    """
    largest = float(np.abs(values).max(initial=0.0))
    unit = "m" if joint.kind == "slide" else "rad"
    if joint.limits is None:
        if joint.kind == "hinge" and largest > _TURNS:
            raise SomersaultError(
                f"joint {joint.name} reaches {largest:g} rad, which looks like degrees; say that "
                "they are degrees, convert them, or give the joint limits in the model"
            )
        return
    least, most = joint.limits
    beyond = np.maximum(least - values, values - most)
    worst = int(np.argmax(beyond))
    if beyond[worst] <= max(slack, LIMIT_SLACK):
        return
    angle = float(values[worst])
    if joint.kind == "hinge" and largest > 2 * pi:
        mend = "which looks like degrees; say that they are degrees, or convert them"
    elif slack:  # of a recording, whose noise may take it beyond
        mend = (
            f"by more than the slack of {slack:g}; if that is noise give it more slack, or else "
            "change the motion, or the limits in the model"
        )
    else:
        mend = "so change the motion, or the limits in the model"
    shown = f"{angle:.6g} {unit}" + (f" ({degrees(angle):.4g}°)" if unit == "rad" else "")
    raise SomersaultError(
        f"joint {joint.name}: {shown} at {times[worst]:.6g} s is outside its limits {least:g} to "
        f"{most:g}, {mend}"
    )


def extremes(path: Path, end: float) -> tuple[Array, Array]:
    """Values and times among which are a path's least and greatest until `end`."""
    from scipy.interpolate import PPoly

    breaks = np.append(path.knots, end) if end > path.knots[-1] else path.knots
    if len(breaks) == 1:
        return path.coefficients[-1:, 0], breaks
    pieces = PPoly(path.coefficients[1 : len(breaks)].T[::-1], breaks)
    turning = pieces.derivative().roots(extrapolate=False)
    inside = breaks[:-1, None] + np.diff(breaks)[:, None] * np.linspace(0, 1, _BETWEEN + 2)[1:-1]
    times = np.concatenate([breaks, inside.ravel(), turning[np.isfinite(turning)]])
    return pieces(times), times
