"""Single pictures of histories, drawn as films are."""

from __future__ import annotations

import io
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import whole_number
from somersault._core.errors import SomersaultError
from somersault._core.files import write
from somersault._core.numbers import number, numbers
from somersault._core.places import check_file
from somersault.view._actor import Actor
from somersault.view._canvas import blank
from somersault.view._lettering import write_on
from somersault.view._look import Look, look_of, several
from somersault.view._scene import Scene
from somersault.view._stage import Stage

if TYPE_CHECKING:
    from somersault.history import History

_CELL = (240, 320)
MOST_POSES = 240
MOST_PIXELS = 60_000_000
_SLACK = 1e-9  # of the whole time: what is reckoned up of steps ends there
_STILL = 0.25  # of its size: a centre of mass that travels less stays in place


def frame(histories: History | Sequence[History], time: float, **look: Any) -> Array:
    """One frame of a film.

    Parameters
    ----------
    histories : History or sequence of History
        One, or several side by side.
    time : float
        s, from the first sample to the last; of several, those that have ended stay as they are.
    **look
        size, camera, follow, vectors, charts, ghosts, labels, ground: see `Look`.

    Returns
    -------
    ndarray, (height, width, 3)
        Red, green and blue, bytes.

    Raises
    ------
    SomersaultError
        For a time before the beginning or after the end, and options that make no sense.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.view import frame
    >>> flight = so.fly("furrer", so.Takeoff(spin=8.6, tilt=0.05), 0.5)
    >>> frame(flight, 0.2, size=(320, 180)).shape
    (180, 320, 3)
    """
    shown = several("histories", histories, 1)
    scene, (place,) = _of_the_film(shown, _within(shown, [number("time", time)]), look_of(look))
    return scene.frame(place)[..., :3].copy()


def picture(
    histories: History | Sequence[History],
    path: str | os.PathLike[str],
    times: float | Sequence[float] | Array | None = None,
    columns: int = 6,
    **look: Any,
) -> None:
    """Write a frame, or a contact sheet of several, as a .png file.

    Parameters
    ----------
    histories : History or sequence of History
        One, or several side by side.
    path : path-like
        A .png file, written whole or not at all.
    times : float or sequence of float, optional
        s; one time is one frame. Twelve from beginning to end, if they are not given.
    columns : int
        Frames in a row.
    **look
        As of a film; `size` is that of each frame.

    Raises
    ------
    SomersaultError
        For a time before the beginning or after the end, options that make no sense, and a file of
        another kind.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.view import picture
    >>> flight = so.fly("furrer", so.Takeoff(spin=8.6, tilt=0.05), 1.0)
    >>> picture(flight, "layout.png", [0.0, 0.2, 0.4], size=(120, 160))
    """
    file = check_file(path, (".png",))
    shown = several("histories", histories, 1)
    one = times is not None and _is_one(times)
    moments = (
        _spread(shown, 12)
        if times is None
        else _within(shown, numbers("times", [times] if one else times))
    )
    columns = min(whole_number("columns", columns, 1, MOST_POSES), max(1, len(moments)))
    if not 0 < len(moments) <= MOST_POSES:
        raise SomersaultError(f"give 1 to {MOST_POSES} times, not {len(moments)}")
    chosen = look_of(look) if one else look_of(look, _CELL)
    width, height = chosen.size
    rows = -(-len(moments) // columns)
    if width * columns * height * rows > MOST_PIXELS:
        raise SomersaultError(
            f"that is a picture of {width * columns} x {height * rows} pixels; give a smaller "
            "size or fewer times"
        )
    scene, places = _of_the_film(shown, moments, chosen)
    sheet = blank(width * columns, height * rows)
    for k, place in enumerate(places):
        top, left = k // columns * height, k % columns * width
        sheet[top : top + height, left : left + width] = scene.frame(place)
    write(file, png(sheet))


def _of_the_film(shown: Sequence[History], moments: Array, look: Look) -> tuple[Scene, list[int]]:
    """A scene in which the eye takes in what it does in the whole film, and where some moments
    stand in it."""
    whole = np.unique(np.concatenate([moments, _spread(shown, 60)]))
    return Scene(shown, whole, look), np.searchsorted(whole, moments).tolist()


def stroboscopic_picture(
    histories: History | Sequence[History],
    path: str | os.PathLike[str],
    times: int | Sequence[float] | Array = 9,
    **look: Any,
) -> None:
    """Write one picture of a motion that goes somewhere, at several times, as a .png file.

    Parameters
    ----------
    histories : History or sequence of History
        A flight in gravity or with a velocity; several are drawn in the same place.
    path : path-like
        A .png file, written whole or not at all.
    times : int or sequence of float
        s, or how many from beginning to end.
    **look
        size, camera, vectors, ground: see `Look`. From the side (azimuth 90) one sees a
        somersault best, which is what it is if `camera` is not given.

    Raises
    ------
    SomersaultError
        For what stays in place, a time before the beginning or after the end, options that make no
        sense, and a file of another kind.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.view import stroboscopic_picture
    >>> takeoff = so.Takeoff(spin=6.0, velocity=[2.0, 0.0, 4.0])
    >>> flight = so.fly("furrer", takeoff, 0.8, gravity=[0.0, 0.0, -9.81])
    >>> stroboscopic_picture(flight, "parabola.png", size=(320, 180))
    """
    file = check_file(path, (".png",))
    shown = several("histories", histories, 1, MOST_POSES)
    chosen = look_of({"camera": (90.0, 8.0), **look})
    if _is_one(times):
        moments = _spread(shown, whole_number("times", times, 1, MOST_POSES))
    else:
        moments = _within(shown, numbers("times", times))
    if not 0 < len(moments) * len(shown) <= MOST_POSES:
        raise SomersaultError(f"give 1 to {MOST_POSES} poses, not {len(moments) * len(shown)}")
    actors = [Actor(history, moments) for history in shown]
    if len(moments) > 1 and not any(map(_travels, actors)):
        raise SomersaultError(
            f"{shown[0].model.name} stays in place, where its poses would cover one another; give "
            "it gravity or a velocity, or make a contact sheet (picture)"
        )
    stage = Stage(
        actors, [], *chosen.size, chosen.camera, False, chosen.vectors, chosen.ground
    )  # fmt: skip
    image = stage.draw(range(len(moments))).copy()
    size = max(9.0, 0.028 * chosen.size[1])
    write_on(image, (0.8 * size, 0.8 * size), _spacing(moments), size)
    write(file, png(image))


def _spacing(moments: Array) -> str:
    """When poses of a stroboscope are."""
    words = f"{moments[0]:.2f} to {moments[-1]:.2f} s"
    steps = np.diff(moments)
    if len(steps) and np.ptp(steps) < 1e-6 * abs(steps[0]):
        return f"{words}, every {steps[0]:.3g} s"
    return f"{words}, {len(moments)} poses"


def png(image: Array) -> bytes:
    """A picture (height, width, 3 or 4) as the bytes of a file."""
    from PIL import Image

    held = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(image[..., :3])).save(held, "PNG")
    return held.getvalue()


def _ends(histories: Sequence[History]) -> tuple[float, float]:
    """The first time of any, and the last."""
    first = min(float(history.times[0]) for history in histories)
    return first, max(float(history.times[-1]) for history in histories)


def _is_one(times: Any) -> bool:
    """Whether it is one number, whatever else it may be."""
    return getattr(times, "ndim", isinstance(times, Sequence)) == 0 or isinstance(
        times, int | float
    )


def _within(histories: Sequence[History], moments: Array | Sequence[float]) -> Array:
    """The moments; SomersaultError for one at which there is nothing to be seen."""
    first, last = _ends(histories)
    slack = _SLACK * (last - first)
    for moment in moments:
        if not first - slack <= moment <= last + slack:
            raise SomersaultError(
                f"{moment:.9g} s is outside the motion; give a time from {first:g} to {last:g} s"
            )
    return np.clip(moments, first, last)


def _spread(histories: Sequence[History], count: int) -> Array:
    """Moments from the first sample to the last."""
    first, last = _ends(histories)
    return np.linspace(first, last, count if last > first else 1)


def _travels(actor: Actor) -> bool:
    corners, _ = actor.outline
    size = float(np.ptp(corners[0], axis=0).max())
    return float(np.ptp(actor.centres, axis=0).max()) > _STILL * size
