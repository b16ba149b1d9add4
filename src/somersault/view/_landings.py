"""Many poses of one model in one picture, coloured by what became of each."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import name_list, shown, truth, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.files import write
from somersault._core.places import check_file
from somersault.view._actor import Actor
from somersault.view._canvas import blank
from somersault.view._lettering import FAINT, write_on
from somersault.view._look import look_of, several
from somersault.view._stage import Stage
from somersault.view._stills import MOST_PIXELS, MOST_POSES, png
from somersault.view.style import rgb

if TYPE_CHECKING:
    from somersault.history import History

_CELL, _WHOLE = (120, 140), (720, 720)
_COLOR = re.compile("#[0-9a-fA-F]{6}")
_HEAD = 26  # pixels of a line of the key


def landings_picture(
    poses: History,
    path: str | os.PathLike[str],
    colors: Sequence[str],
    words: Sequence[str],
    key: Sequence[tuple[str, str]],
    columns: int = 10,
    superimposed: bool = False,
    **look: Any,
) -> None:
    """Write the poses of a history in one .png file, side by side or in one place.

    Parameters
    ----------
    poses : History
        Each of its samples is a pose of its own.
    path : path-like
        A .png file, written whole or not at all.
    colors, words : sequence of str
        Of each pose its colour, "#rrggbb", and what stands below it.
    key : sequence of (str, str)
        What the colours mean, a line each; a line without a colour says something else.
    columns : int
        Poses in a row.
    superimposed : bool
        Whether all are drawn in one place. What few have in common is faint: a place that a share
        of them covers has the square root of that share as its opacity.
    **look
        size (of each, or of the whole if superimposed), camera, ground: see `Look`.

    Raises
    ------
    SomersaultError
        For options that make no sense, and for more than 240 poses.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.view import landings_picture
    >>> flight = so.fly("furrer", so.Takeoff(spin=8.6), 0.5, samples=3)
    >>> key = [("#0072B2", "one flight at three times")]
    >>> landings_picture(flight, "poses.png", ["#0072B2"] * 3, ["0", "0.25", "0.5 s"], key)
    """
    file = check_file(path, (".png",))
    (poses,) = several("poses", poses, 1, 1)
    count = len(poses.times)
    if not 0 < count <= MOST_POSES:
        raise SomersaultError(f"{count} poses are too many for a picture; give 1 to {MOST_POSES}")
    columns = min(whole_number("columns", columns, 1, MOST_POSES), count)
    superimposed = truth("superimposed", superimposed)
    colors, words = name_list("colors", colors), name_list("words", words)
    for what, row in (("colors", colors), ("words", words)):
        if len(row) != count:
            raise SomersaultError(f"there are {count} poses and {len(row)} {what}; give as many")
    lines = _rows(key)
    meaning = list(zip(*lines, strict=True)) or [(), ()]
    for color in (*colors, *filter(None, meaning[0])):
        if not _COLOR.fullmatch(color):
            raise SomersaultError(f"{shown(color)} is no colour; write it like '#0072B2'")
    chosen = look_of({"ground": False, **look}, _WHOLE if superimposed else _CELL)
    if superimposed and chosen.ground:
        raise SomersaultError("superimposed poses have no ground; leave it out")
    width, height = chosen.size
    across, rows = (1, 1) if superimposed else (columns, -(-count // columns))
    head = _HEAD * len(lines) + 12
    if width * across * (height * rows + head) > MOST_PIXELS:
        raise SomersaultError(
            f"that is a picture of {width * across} x {height * rows + head} pixels; give a "
            "smaller size or fewer poses"
        )
    frames = _frames(poses, colors, (width, height), chosen.camera, chosen.ground)
    sheet = blank(max(width * across, 420), height * rows + head)
    if superimposed:
        sheet[head:, :width] = _exposed(frames, blank(width, height))
    else:
        for k, frame in enumerate(frames):
            top, left = head + k // columns * height, k % columns * width
            cell = sheet[top : top + height, left : left + width]
            cell[:] = frame
            write_on(cell, (6, height - 18), words[k], 10, FAINT)
    for line, (color, said) in enumerate(lines):
        top = 8 + _HEAD * line
        if color:
            sheet[top + 3 : top + 15, 10:22, :3] = np.array(rgb(color)) * 255
        write_on(sheet, (30 if color else 10, top), said, 14)
    write(file, png(sheet))


def _rows(key: Any) -> list[tuple[str, str]]:
    """A key's lines; SomersaultError unless each is a colour and words."""
    try:
        rows = [(color, said) for color, said in key]
    except (TypeError, ValueError):
        rows = [(None, None)]
    if not all(isinstance(part, str) for row in rows for part in row):
        raise SomersaultError(f"key must be a list of (colour, words), and is {shown(key)}")
    return rows


def _frames(
    poses: History, colors: Sequence[str], size: tuple[int, int], camera: tuple[float, float],
    ground: bool,
) -> list[Array]:  # fmt: skip
    """A picture (height, width, 4) of each pose, all on one scale."""
    stages = {
        color: Stage([Actor(poses, poses.times, color)], [], *size, camera, ground=ground)
        for color in dict.fromkeys(colors)
    }
    return [stages[color].draw([k]).copy() for k, color in enumerate(colors)]


def _exposed(frames: Sequence[Array], back: Array) -> Array:
    """All in one place, each pixel as opaque as the square root of the share that covers it."""
    plain = back[..., :3].astype(float)
    total, covered = np.zeros_like(plain), np.zeros(plain.shape[:2])
    for frame in frames:
        there = np.any(frame[..., :3] != back[..., :3], axis=-1)
        covered += there
        total[there] += frame[there, :3]
    share = np.sqrt(covered / len(frames))[..., None]
    mean = total / np.maximum(covered, 1)[..., None]
    exposed = back.copy()
    exposed[..., :3] = plain + share * (mean - plain) + 0.5
    return exposed
