"""Angles within the limits of a joint."""

from __future__ import annotations

import numpy as np

from somersault._core.array import Array
from somersault._core.degrees import degrees_hint
from somersault._core.errors import SomersaultError
from somersault.model import LIMIT_SLACK, Joint


def check_limits(joint: Joint, angles: tuple[float, ...]) -> None:
    """SomersaultError where angles are outside a joint's limits."""
    if joint.limits is None or not angles:
        return
    least, most = joint.limits
    low, high = min(angles), max(angles)
    if low < least - LIMIT_SLACK or high > most + LIMIT_SLACK:
        worst = low if low < least - LIMIT_SLACK else high
        hint = degrees_hint(worst) if joint.kind == "hinge" else ""
        raise SomersaultError(
            f"joint {joint.name}: angle {worst:g} is outside its limits {least:g} to {most:g}{hint}"
        )


def within(joint: Joint, angle: Array) -> Array:
    """Whether angles are within a joint's limits.

    Parameters
    ----------
    joint : Joint
    angle : ndarray, (n,)
        rad, or m.

    Returns
    -------
    ndarray of bool, (n,)
    """
    if joint.limits is None:
        return np.isfinite(angle)
    least, most = joint.limits
    return (angle >= least - LIMIT_SLACK) & (angle <= most + LIMIT_SLACK)
