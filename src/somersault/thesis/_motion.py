"""What moves in a figure: its film, its page, and its numbers."""

from __future__ import annotations

import importlib.util
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault._core.files import write

if TYPE_CHECKING:
    from somersault.history import History

_FPS = 25
_ALONE, _TOGETHER, _ROW = (960, 540), (1120, 540), (1280, 460)  # pixels: one, two, more


@dataclass(frozen=True, eq=False)
class Motion:
    """Histories that a figure shows, side by side in its film and to choose from on its page.

    Attributes
    ----------
    histories : mapping of str to History
        By what they are called.
    speed : float
        Seconds of the motion in a second of the film.
    look : mapping
        Options of a film, as in `view.Look`.
    """

    histories: Mapping[str, History]
    speed: float = 1.0
    look: Mapping[str, Any] | None = None


@dataclass(frozen=True)
class Written:
    """Where a motion's files are, from the report's folder.

    The film is None where there is no encoder; `still` is a frame of it.
    """

    film: str | None
    still: str
    page: str
    data: str
    names: tuple[str, ...]
    speed: float


def write_motion(motion: Motion, id: str, title: str, folder: Path) -> Written:
    """Write a motion's film, a still, its page and its numbers; say where they are."""
    from somersault.view import film, page, picture

    names, row = tuple(motion.histories), list(motion.histories.values())
    look: dict[str, Any] = {
        "size": (_ALONE, _TOGETHER)[len(row) - 1] if len(row) < 3 else _ROW,
        "labels": names,
        "vectors": ("momentum",),
        **(motion.look or {}),
    }
    encoder = importlib.util.find_spec("av") is not None
    made = Written(
        f"films/{id}.mp4" if encoder else None, f"films/{id}.png", f"pages/{id}.html",
        f"data/{id}-motion.csv", names, motion.speed,
    )  # fmt: skip
    for part in ("films", "pages"):
        (folder / part).mkdir(exist_ok=True)
    if made.film is not None:
        film(row, folder / made.film, _FPS, motion.speed, **look)
    first, last = (pick(float(h.times[end]) for h in row) for pick, end in ((min, 0), (max, -1)))
    picture(row, folder / made.still, first + 0.4 * (last - first), **look)
    page(row, folder / made.page, labels=names, title=title)
    write(folder / made.data, _csv(motion.histories))
    return made


def _csv(histories: Mapping[str, History]) -> str:
    """One row a sample, of one history after the other; the header names units."""
    import numpy as np

    joints = list(dict.fromkeys(n for h in histories.values() for n in h.model.coordinates))
    header = [
        "motion", "time [s]", "somersault [rad]", "tilt [rad]", "twist [rad]",
        *(f"base position {axis} [m]" for axis in (1, 2, 3)),
        *(f"base quaternion {part} [1]" for part in "wxyz"),
        *(f"{name} [rad or m]" for name in joints),
    ]  # fmt: skip
    lines = [",".join(header)]
    for name, history in histories.items():
        own = history.model.coordinates
        columns = [
            history.joint_coordinates[:, own.index(joint)]
            if joint in own
            else np.full(len(history.times), np.nan)
            for joint in joints
        ]
        known = (history.times, history.angles, history.base_position, history.base_quaternion)
        table = np.column_stack([*known, *columns])
        quoted = f'"{name}"' if "," in name else name
        lines += [f"{quoted}," + ",".join(map(_number, row)) for row in table.tolist()]
    return "\n".join(lines) + "\n"


def _number(value: float) -> str:
    """Seven digits; nothing for a joint that a model does not have."""
    return "" if value != value else f"{value + 0.0:.7g}"
