"""Films of histories."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import whole_number
from somersault._core.errors import SomersaultError
from somersault._core.files import write
from somersault._core.numbers import number
from somersault._core.places import check_file
from somersault._core.stages import stage
from somersault.view._encoders import ENCODERS
from somersault.view._look import look_of, several
from somersault.view._scene import Scene

if TYPE_CHECKING:
    from somersault.history import History

_MOST_FRAMES = 30_000
_MOST_FPS = 240


def film(
    histories: History | Sequence[History],
    path: str | os.PathLike[str],
    fps: int = 30,
    speed: float = 1.0,
    **look: Any,
) -> None:
    """Write a film of one history, or of several side by side.

    Parameters
    ----------
    histories : History or sequence of History
        Flights, swings, recordings.
    path : path-like
        A .mp4, .webm or .gif file, written whole or not at all.
    fps : int
        Frames per second.
    speed : float
        Seconds of the motion in a second of the film; less than 1 is slow motion.
    **look
        size, camera, follow, vectors, charts, ghosts, labels, ground: see `Look`.

    Raises
    ------
    SomersaultError
        For options that make no sense, a file of another kind or a place where it cannot be
        written, and .mp4 or .webm without PyAV.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.view import film
    >>> flight = so.fly("furrer", so.Takeoff(spin=8.6, tilt=0.05), 0.1)
    >>> film(flight, "layout.gif", fps=20, size=(160, 90))
    """
    file = check_film(path)
    shown_ = several("histories", histories, 1)
    chosen = look_of(look)
    fps = whole_number("fps", fps, 1, _MOST_FPS)
    speed = number("speed", speed)
    if speed <= 0:
        raise SomersaultError(f"speed is {speed:g}; give more than 0, like 0.25 for slow motion")
    moments = _moments(shown_, fps, speed)
    kind = ENCODERS[file.suffix.lower()]
    if len(moments) * chosen.size[0] * chosen.size[1] > kind.most_pixels:
        raise SomersaultError(
            f"{len(moments)} frames of {chosen.size[0]} x {chosen.size[1]} are too many for a "
            f"{kind.ending}; give a smaller size or fewer fps, or write an .mp4"
        )
    note = "" if speed == 1 else f"   (speed × {speed:.3g})"
    scene = Scene(shown_, moments, chosen, note)
    encoder = kind(chosen.size, fps)
    with stage("drawing the film, frame", len(moments)) as drawing:
        for _ in _ahead(scene.frame, len(moments), encoder.add):
            drawing.advance()
    write(file, encoder.finished())


def _ahead(
    drawn: Callable[[int], Array], count: int, encode: Callable[[Array], None]
) -> Iterator[None]:
    """Frames one after the other: the next one is drawn while the last is encoded."""
    with ThreadPoolExecutor(1) as encoding:
        last: Future[None] | None = None
        for k in range(count):
            frame = drawn(k).copy()  # a canvas draws the next one over it
            if last is not None:
                last.result()
            last = encoding.submit(encode, frame)
            yield
        if last is not None:
            last.result()


def check_film(path: str | os.PathLike[str]) -> Path:
    """The place of a film, if one can be written there.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    pathlib.Path

    Raises
    ------
    SomersaultError
        For another ending than .mp4, .webm and .gif, without the encoder of that kind, and for a
        place where no such file can be written.

    Examples
    --------
    >>> from somersault.view import check_film
    >>> check_film("layout.gif").name
    'layout.gif'
    """
    file = check_file(path, tuple(ENCODERS))
    ENCODERS[file.suffix.lower()].check()
    return file


def _moments(histories: Sequence[History], fps: int, speed: float) -> Array:
    """Of the frames: from the first sample of any to the last of any."""
    first = min(float(history.times[0]) for history in histories)
    last = max(float(history.times[-1]) for history in histories)
    count = (last - first) * fps / speed + 1 + 1e-9
    if count > _MOST_FRAMES:
        raise SomersaultError(
            f"that is a film of {count:.3g} frames; give a greater speed or fewer fps, for at most "
            f"{_MOST_FRAMES}"
        )
    return first + np.arange(int(count)) * speed / fps
