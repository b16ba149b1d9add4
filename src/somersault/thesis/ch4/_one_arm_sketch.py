"""Figure 4-16: a sketch of the simplest model."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault.view.style import BLACK, BLUE, ORANGE, PALE, VERMILION, figure, label, pointer

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def one_arm_sketch() -> Figure:
    """A body and one arm that pivots about the centre of mass of both (figure 4-16)."""
    from matplotlib.patches import Ellipse, FancyArrowPatch, FancyBboxPatch

    drawing = figure(6.4, 4.4)
    ax = drawing.add_subplot()
    ax.set_aspect("equal")
    ax.set(xlim=(-2.3, 2.7), ylim=(-1.75, 1.75))
    ax.axis("off")
    box = FancyBboxPatch(
        (-0.3, -1.3), 0.6, 2.6, boxstyle="round,pad=0,rounding_size=0.12", fc=PALE, ec=BLACK, lw=1.4
    )
    ax.add_patch(box)
    ax.plot([-1.75, 2.25], [0, 0], ls=":", color=BLACK, lw=0.9, zorder=1)
    tilt = 14.0
    arm = Ellipse((0, 0), 3.2, 0.2, angle=tilt, fc=ORANGE, ec=BLACK, lw=1.2, alpha=0.9, zorder=3)
    ax.add_patch(arm)
    turns = np.linspace(0.5, 5.5 * np.pi, 300)
    radius = 0.1 + 0.018 * turns
    ax.plot(radius * np.cos(turns), radius * np.sin(turns), color=VERMILION, lw=1.4, zorder=4)
    ax.plot(0, 0, "o", color=BLACK, ms=7, zorder=5)
    for tip, name in (((2.35, 0), "2: somersault axis"), ((0, 1.62), "3: twist axis")):
        head = FancyArrowPatch((0, 0), tip, arrowstyle="-|>", mutation_scale=12, color=BLUE, lw=1)
        head.set_zorder(2)
        ax.add_patch(head)
        side = (tip[0] - 0.35, -0.14) if tip[0] else (0.08, 1.6)
        label(ax, *side, name, BLUE, ha="center" if tip[0] else "left")
    sweep = np.radians(np.linspace(0, tilt, 30))
    ax.plot(1.75 * np.cos(sweep), 1.75 * np.sin(sweep), color=BLACK, lw=1.1)
    label(ax, 1.82, 0.22, "arm angle")
    pointer(ax, (0, 0), (0.6, -0.75), "pivot: both centres of mass,\naxis 1 towards you")
    pointer(ax, (-0.28, -0.2), (-2.25, -0.75), "spring $K_{sh}$ between\narm and body", VERMILION)
    label(ax, 0, -1.12, "body", BLACK, ha="center")
    label(ax, -1.75, 0.1, "one arm, held only\nby the spring", BLACK, va="bottom")
    return drawing
