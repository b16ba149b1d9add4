"""What a planar model may be asked for: its flight begins and stays in its plane."""

from __future__ import annotations

from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault.flight._takeoff import Takeoff
from somersault.model import Model

_ALONG = ("velocity", "gravity")  # vectors in the plane; of turning, along the axis across it
_TURNING = ("angular_velocity", "angular_momentum", "tape")
_ANGLES = ("tilt", "twist", "tilt_rate", "twist_rate")
_ROUNDING = 1e-12  # of a vector: what less of it is out of the plane is dropped


def turning(model: Model) -> list[int]:
    """Places of the axes about which a base can turn."""
    return [way for way in model.base_ways if way < 3]


def kept(model: Model, vectors: Array) -> Array:
    """What a base in a plane has of angular velocities or momenta (…, 3); in space all of it."""
    return np.where(np.isin(np.arange(3), turning(model)), vectors, 0.0)


def leaves_plane(model: Model, what: str, part: int | None = None) -> bool:
    """Whether a number of a takeoff, or that part (1, 2, 3) of a vector, turns or moves a model out
    of its plane."""
    if model.plane is None:
        return False
    if what in _ANGLES:
        return True
    return (what in _ALONG and part == model.plane) or (
        what in (*_TURNING, "quaternion") and part not in (0, model.plane)
    )


def refuse_out_of_plane(model: Model, where: str, what: str, value: Any) -> None:
    """SomersaultError for a number, or a vector, that turns or moves a model out of its plane."""
    if value is None or model.plane is None:
        return
    numbers = np.atleast_1d(np.asarray(value, float))
    parts: list[int | None] = [None] if numbers.size == 1 else list(range(4 - numbers.size, 4))
    rounding = _ROUNDING * np.linalg.norm(numbers)
    for part, number in zip(parts, numbers.tolist(), strict=True):
        if leaves_plane(model, what, part) and (part is None or abs(number) > rounding) and number:
            raise SomersaultError(
                f"{where} is {number:g}{_along(what, part)}, but {model.name} moves only in the "
                f"plane across its axis {model.plane}; leave that out, or give the model "
                'base = "free"'
            )


def _along(what: str, part: int | None) -> str:
    if part is None:
        return ""
    return f" in its {'xyz'[part - 1]}" if what == "quaternion" else f" along axis {part}"


def check_in_plane(model: Model, takeoff: Takeoff, until: str | None) -> None:
    """SomersaultError for a takeoff, or an end, that a planar model cannot have."""
    for what in (*_ANGLES, *_TURNING, "quaternion", "velocity"):
        refuse_out_of_plane(model, f"takeoff {what}", what, getattr(takeoff, what))
    if until is not None and model.plane is not None:
        raise SomersaultError(
            f"until {shown(until)} never comes: {model.name} moves in a plane and does not twist; "
            'leave it out, or give the model base = "free"'
        )
