"""The momentum sphere: a map of rigid body rotation (Playter 1994, section 2.5)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from somersault import rigid
from somersault._core.array import Array
from somersault.view import style as look
from somersault.view._figure import camera

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MINOR, MAJOR = look.VERMILION, look.BLUE  # curves round the minor and the major axis
VIEW = (55.0, 22.0)  # degrees: the eye, in body axes, from 1 (front) towards 2 (left) and 3 (head)
WAYS = ("1 front", "2 left", "3 head")


def energies(inertias: ArrayLike, count: int) -> Array:
    """Energies of curves on the momentum sphere, through points evenly spaced in angle between the
    middle axis and the two others.

    Parameters
    ----------
    inertias : array_like, (3,)
        Principal, kg m².
    count : int
        How many curves on each side of the separatrix, at most: a symmetric body has them on one
        side only.

    Returns
    -------
    ndarray
        J, at h = 1 kg m²/s.
    """
    i = np.sort(np.asarray(inertias, float))
    angle = (np.arange(count) + 0.5) / count * np.pi / 2
    below, above = (
        (np.cos(angle) ** 2 / i[1] + np.sin(angle) ** 2 / i[other]) / 2 for other in (2, 0)
    )
    found = np.concatenate([below[::-1], above])
    middle = 1 / (2 * i[1])
    return found[np.abs(found - middle) > 1e-9 * middle]


def twist_text(inertias: ArrayLike, kind: str) -> str:
    """What twist does in one of the two kinds of motion, "minor" or "major"."""
    i = np.asarray(inertias, float)
    circled = int(np.argmin(i) if kind == "minor" else np.argmax(i))
    return "goes on and on" if circled == 2 else "oscillates"


def sphere_map(
    inertias: ArrayLike,
    levels: Sequence[float] | Array,
    title: str = "",
    view: tuple[float, float] = VIEW,
) -> Figure:
    """The momentum sphere in 3-D and, next to it, as a picture of tilt against twist.

    Parameters
    ----------
    inertias : array_like, (3,)
        Principal, kg m².
    levels : sequence of float
        Energies at h = 1 kg m²/s, as from `energies`.
    title : str, optional
    view : (float, float)
        Azimuth and elevation of the eye, degrees.

    Returns
    -------
    matplotlib.figure.Figure
    """
    made = look.figure(9.6, 4.6)
    ball, chart = made.subplots(1, 2, width_ratios=(1, 1.35))
    globe(ball, inertias, levels, view)
    tilt_twist(chart, inertias, levels)
    if title:
        made.suptitle(look.literal(title), fontsize=10.5)
    return made


def globe(
    ax: Axes, inertias: ArrayLike, levels: Sequence[float] | Array, view: tuple[float, float] = VIEW
) -> None:
    """The sphere in 3-D, body axes fixed; what is behind it shows faintly."""
    from matplotlib.patches import Circle

    seen = camera(*view)
    ax.add_patch(Circle((0, 0), 1, fc=look.PALE, ec=look.GREY, lw=0.8, zorder=0))
    for curve, color in _curves(inertias, levels):
        _on_sphere(ax, curve, seen, color, 1.2)
    for circle in rigid.separatrix(inertias, 721):
        _on_sphere(ax, circle, seen, look.BLACK, 2.0)
    for axis, name in enumerate(WAYS):
        tip = seen @ np.eye(3)[axis]
        flat = tip[:2]
        start = flat if tip[2] > 0 else flat / max(float(np.linalg.norm(flat)), 1e-9)
        end = 1.38 * flat + 0.12 * flat / max(float(np.linalg.norm(flat)), 0.2)
        ax.annotate(
            "", end, start, arrowprops={"arrowstyle": "-|>", "color": look.GREEN, "lw": 1.6}
        )
        look.label(ax, 1.12 * float(end[0]), 1.12 * float(end[1]), name, look.GREEN, ha="center")
    ax.set(xlim=(-1.5, 1.5), ylim=(-1.45, 1.7), title="Directions of angular momentum in the body")
    ax.set_aspect("equal")
    ax.axis("off")


def _on_sphere(ax: Axes, curve: Array, seen: Array, color: str, width: float) -> None:
    flat = curve @ seen.T
    for front in (True, False):
        shown = np.where(((flat[:, 2] >= 0) == front)[:, None], flat[:, :2], np.nan)
        ax.plot(
            *shown.T,
            color=color,
            lw=width if front else 0.5,
            alpha=1 if front else 0.3,
            zorder=2 if front else 1,
        )


def tilt_twist(
    ax: Axes, inertias: ArrayLike, levels: Sequence[float] | Array, words: bool = True
) -> None:
    """The sphere unrolled: tilt (minus latitude) against twist (minus longitude), degrees."""
    for curve, color in _curves(inertias, levels):
        _unrolled(ax, curve, color, 1.2)
    for circle in rigid.separatrix(inertias, 721):
        _unrolled(ax, circle, look.BLACK, 2.0)
    ax.set(
        xlim=(-180, 180),
        ylim=(-90, 90),
        xlabel="twist Ψ = −longitude (°)",
        ylabel="tilt Θ = −latitude (°)",
    )
    ax.set_xticks(range(-180, 181, 90))
    ax.set_yticks(range(-90, 91, 45))
    if not words:
        return
    i = np.asarray(inertias, float)
    parts = [(kind, color) for kind, color in (("minor", MINOR), ("major", MAJOR))]
    order = np.sort(i)
    have = {"minor": order[0] < order[1], "major": order[1] < order[2]}
    text = [(f"round the {k} axis: twist {twist_text(i, k)}", c) for k, c in parts if have[k]]
    text.append(("separatrix", look.BLACK))
    for line, (said, color) in enumerate(text):
        ax.text(
            0,
            1.02 + 0.055 * (len(text) - 1 - line),
            said,
            color=color,
            fontsize=9,
            transform=ax.transAxes,
        )


def _unrolled(ax: Axes, curve: Array, color: str, width: float) -> None:
    tilt, twist = (np.degrees(x) for x in rigid.tilt_and_twist(curve))
    # A curve that runs off one edge comes in at the other, and jumps where it passes a pole.
    jumps = np.flatnonzero(np.abs(np.diff(twist)) > 90) + 1
    ax.plot(np.insert(twist, jumps, np.nan), np.insert(tilt, jumps, np.nan), color=color, lw=width)


def _curves(inertias: ArrayLike, levels: Sequence[float] | Array) -> list[tuple[Array, str]]:
    middle = rigid.energy_bounds(inertias, 1.0)[1]
    found = []
    for energy in levels:
        for curve in rigid.energy_curve(inertias, float(energy), 721):
            found.append((curve, MINOR if energy > middle else MAJOR))
    return found
