"""How films and pictures look: what their options are, and that they make sense."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from somersault._core.checks import instance, name_list, shown, truth, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats, numbers
from somersault.history import History
from somersault.model import Model
from somersault.view._stage import VECTORS

SMALLEST, LARGEST = 64, 4096  # pixels
CHARTS_FROM = 640  # pixels across, in which histories can be read
_MOST_BESIDE, _MOST_GHOSTS = 6, 120
_PARTS = ("model", "times", "base_position", "base_quaternion", "joint_coordinates", "angles")


@dataclass(frozen=True, kw_only=True)
class Look:
    """What is seen of histories, and how.

    Parameters
    ----------
    size : (int, int)
        Width and height in pixels, even numbers.
    camera : (float, float)
        Azimuth and elevation of the eye in degrees: from the front towards the body's left, and up,
        as the model's `axes` have them with no turn of the base.
    follow : bool
        Whether the eye goes with the centre of mass, or stands where it sees the whole way. One
        whose base is fixed is seen from one place anyway.
    vectors : sequence of {"momentum", "spin"}
        Arrows of the angular momentum and of the angular velocity of the base.
    charts : bool
        Whether its angles and joints against time stand at the right.
    ghosts : History or sequence of them
        Others, seen through, where they are at the same time.
    labels : sequence of str, optional
        A line for each of the histories that stand side by side; their models' names, if it is not
        given and there are several.
    ground : bool
        Whether there is a ground, below the lowest point that is ever reached, for shadows.

    Raises
    ------
    SomersaultError
        For what is none of these, with what to give.
    """

    size: tuple[int, int] = (1280, 720)
    camera: tuple[float, float] = (35.0, 12.0)
    follow: bool = True
    vectors: Sequence[str] = ()
    charts: bool = False
    ghosts: History | Sequence[History] = ()
    labels: Sequence[str] | None = None
    ground: bool = True

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "size", _size(self.size))
        azimuth, elevation = numbers("camera", self.camera, 2).tolist()
        if abs(elevation) > 89:
            raise SomersaultError(
                f"the elevation of the camera is {elevation:g}°; give -89 to 89 degrees"
            )
        put(self, "camera", (azimuth, elevation))
        for name in ("follow", "charts", "ground"):
            put(self, name, truth(name, getattr(self, name)))
        names = name_list("vectors", _row(self.vectors))
        if unknown := [name for name in names if name not in VECTORS]:
            raise SomersaultError(
                f"there is no vector {shown(unknown[0])}; give {' or '.join(map(repr, VECTORS))}"
            )
        put(self, "vectors", names)
        put(self, "ghosts", self.others)
        if self.labels is not None:
            put(self, "labels", name_list("labels", _row(self.labels)))
        if self.charts and self.size[0] < CHARTS_FROM:
            raise SomersaultError(
                f"a picture {self.size[0]} pixels wide has no room for charts; give size at least "
                f"{CHARTS_FROM} in width or leave them out"
            )

    @property
    def others(self) -> tuple[History, ...]:
        """The ghosts, as a tuple."""
        return several("ghosts", self.ghosts, 0, _MOST_GHOSTS)


def look_of(options: dict[str, Any], size: tuple[int, int] = (1280, 720)) -> Look:
    """A look by its options; SomersaultError for one that there is not."""
    names = Look.__dataclass_fields__
    if unknown := [name for name in options if name not in names]:
        raise SomersaultError(
            f"there is no option {shown(unknown[0])} of films; give {', '.join(names)}"
        )
    return Look(**{"size": size, **options})


def several(what: str, given: object, least: int, most: int = _MOST_BESIDE) -> tuple[History, ...]:
    """One history or a row of them as a tuple; SomersaultError for what is none."""
    row = (given,) if hasattr(given, "base_quaternion") else _row(given)
    for item in row:
        if missing := [name for name in _PARTS if not hasattr(item, name)]:
            raise SomersaultError(
                f"{what} must be flights, swings or recordings, and {shown(item)} has no "
                f"{missing[0]}"
            )
    if not least <= len(row) <= most:
        raise SomersaultError(f"{what}: give {least} to {most} of them, not {len(row)}")
    for item in row:
        instance(f"the model of {what}", item.model, Model)
        parts = [floats(f"{name} of {what}", getattr(item, name)) for name in _PARTS[1:]]
        if not all(np.all(np.isfinite(part)) for part in parts[:-1]):
            raise SomersaultError(
                f"a history of {item.model.name} holds numbers that are not finite and cannot be "
                "drawn; leave out what comes after the flight broke off"
            )
    return row


def _row(given: Any) -> tuple[Any, ...]:
    if isinstance(given, str):
        return (given,)
    try:
        return tuple(given)
    except TypeError:  # one thing, or an array of no dimension
        return (given,)


def _size(given: Any) -> tuple[int, int]:
    row = _row(given)
    if len(row) != 2:
        raise SomersaultError(
            f"size is {shown(given)}; give width and height in pixels, like (1280, 720)"
        )
    width, height = (
        whole_number(f"the {name} of size", value, SMALLEST, LARGEST)
        for name, value in zip(("width", "height"), row, strict=True)
    )
    if width % 2 or height % 2:
        raise SomersaultError(f"size is {width} x {height}; films need even numbers of pixels")
    return width, height
