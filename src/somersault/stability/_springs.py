"""Numbers of springs and dampers at a model's joint speeds, from non-dimensional ones by name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats
from somersault.model import Model, spread

_MOST = 1e9  # non-dimensional stiffness or damping beyond which roots are rounding


def strengths(
    model: Model,
    what: str,
    by_joint: Mapping[str, ArrayLike],
    outboard: Array,
    default: Array,
    *,
    many: bool = False,
) -> Array:
    """Springs' k/Ω² or dampers' b/Ω at each joint speed, (…, speeds), kg m² (kg for a slide).

    `by_joint` has k/(Ω² I) or b/(Ω I) by a joint's or a pair's name: numbers, or arrays if there
    are to be `many`. Joints that are not named have the `default` (speeds,). `outboard`
    (…, speeds) is I.
    """
    result = default
    for name, value in spread(model, by_joint, mirrored=False).items():
        at = model.speed_slice(name)
        numbers = _checked(f"{what} of {name}", what, value, many)
        here = numbers[..., None] * outboard[..., at]
        if result.ndim > 1 or here.ndim > 1:
            lead = np.broadcast_shapes(result.shape[:-1], here.shape[:-1])
            result = np.broadcast_to(result, (*lead, len(model.speeds)))
        result = result.copy()
        result[..., at] = here
    return result


def own_strengths(model: Model, rate: float | None) -> tuple[Array, Array]:
    """The model's own springs and dampers at a spin rate, over Ω² and over Ω, kg m²; none without
    a rate."""
    joints = [joint for joint in model.joints for _ in range(joint.speeds)]
    if rate is None:
        return np.zeros(len(joints)), np.zeros(len(joints))
    rate = one_number("the spin rate", rate)
    if not 1e-6 <= abs(rate) <= 1e6:
        raise SomersaultError(f"a spin rate of {rate} rad/s is no spin; give 1e-6 to 1e6")
    springs = np.array([joint.stiffness / rate**2 for joint in joints])
    return springs, np.array([joint.damping / abs(rate) for joint in joints])


def finite(what: str, value: Any) -> Array:
    """Finite numbers, or SomersaultError naming what should have been some."""
    numbers = floats(what, value)
    if not np.all(np.isfinite(numbers)):
        raise SomersaultError(f"{what} is {shown(value)}; give finite numbers")
    return numbers


def one_number(what: str, value: Any) -> float:
    """One finite number, or SomersaultError naming what should have been one."""
    numbers = finite(what, value)
    if numbers.ndim:
        raise SomersaultError(f"{what} is {shown(value)}; give one number")
    return float(numbers)


def _checked(where: str, what: str, value: Any, many: bool) -> Array:
    numbers = finite(where, value) if many else np.asarray(one_number(where, value))
    least, most = numbers.min(initial=0.0), numbers.max(initial=0.0)
    if max(-least, most) > _MOST:
        number = most if most > -least else least
        raise SomersaultError(f"{where} is {number:g}; lock a joint that stiff")
    if what == "damping" and least < 0:
        raise SomersaultError(f"{where} is {least:g}; dampers are not negative")
    return numbers
