"""Contact sheets: a flight as a row of pictures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.attitude import matrix_from_quaternion
from somersault.model import body_frames, centre_of_mass
from somersault.view import _figure as parts
from somersault.view import style as look

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from somersault.flight import Flight
    from somersault.model import Model

_VIEW = (35.0, 12.0)  # degrees: from the front, a little to the left and above


def contact_sheet(
    flight: Flight,
    times: Sequence[float] | Array,
    columns: int = 8,
    view: tuple[float, float] = _VIEW,
    title: str = "",
) -> Figure:
    """Pictures of a flight at some times (s), in rows, each with its time and its angles.

    Each is the flight's sample nearest to the time asked for. The centre of mass stands
    still; `view` is the camera's azimuth and elevation in degrees, from the front towards the left
    and up, as the model's `axes` have them at takeoff.
    """
    rows = -(-len(times) // columns)
    made = look.figure(1.15 * columns, 1.75 * rows + 0.3)
    grid = made.subplots(rows, 1, squeeze=False)[:, 0]
    size = _size(flight, times)
    for row, ax in enumerate(grid):
        shown = times[row * columns : (row + 1) * columns]
        strip(ax, flight, shown, columns, view, size=size)
    if title:
        made.suptitle(title, fontsize=10)
    return made


def strip(
    ax: Axes,
    flight: Flight,
    times: Sequence[float] | Array,
    columns: int | None = None,
    view: tuple[float, float] = _VIEW,
    words: bool = True,
    size: float | None = None,
) -> None:
    """One row of pictures of a flight on axes of their own.

    `size` (m) is the room for each, from its centre of mass: as far as any of them reaches, if it
    is not given.
    """
    model = flight.system.model
    history = flight.dataset
    size = _size(flight, times) if size is None else size
    seen = parts.camera(*view, model.axes)
    for place, moment in enumerate(times):
        here = history.isel(time=_nearest(flight, moment))
        turn = matrix_from_quaternion(here["quaternion"].values)
        x = 1.7 * size * place
        parts.draw(ax, model, here["joint_angle"].values, turn, seen, (x, 0.0))
        if words:
            turns = float(here["somersault"]) / (2 * np.pi)
            text = (
                f"{float(here['time']):.2f} s\n{turns:.2f} turns\n"
                f"twist {np.degrees(float(here['twist'])):.0f}°"
            )
            look.label(ax, x, -1.12 * size, text, look.GREY, ha="center", va="top", fontsize=7.5)
    count = columns or len(times)
    ax.set(xlim=(-0.95 * size, (1.7 * count - 0.75) * size))
    ax.set_ylim(-(1.9 if words else 1.1) * size, 1.1 * size)
    ax.set_aspect("equal")
    ax.axis("off")


def _nearest(flight: Flight, moment: float) -> int:
    """The sample nearest to a time."""
    return int(np.argmin(np.abs(flight.times - moment)))


def _size(flight: Flight, times: Sequence[float] | Array) -> float:
    """How far the model reaches from its centre of mass at most in its poses at some times, m."""
    angles = flight.dataset["joint_angle"].values
    return max(_reach(flight.system.model, angles[_nearest(flight, t)]) for t in times)


def _reach(model: Model, q: Array) -> float:
    rotations, origins = body_frames(model, q)
    centre = centre_of_mass(model, q)
    return max(
        float(
            np.linalg.norm(origins[s.body] + s.points @ rotations[s.body].T - centre, axis=1).max()
        )
        + s.radius
        for s in parts.solids(model)
    )
