"""Figure 4-20: the simplest model with an arm shaped like two arms at an angle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.model import load
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result
from somersault.thesis.ch4._furrer import ANGLE, STIFFNESS, THREE, region, shoulder_inertia
from somersault.thesis.ch4._one_arm_model import SIMPLEST, stable

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _turned(angles: Array, total: bool) -> dict[str, Array]:
    """The simplest model with its arm shaped like two arms at ±Γ.

    Either the whole body's inertias stay as they are at Γ = π/2 (so k1, k3 and I_rel do), or
    those of the body without the arm.
    """
    slender, long = 0.0037, shoulder_inertia()
    sin2, cos2 = np.sin(angles) ** 2, np.cos(angles) ** 2
    arm = (
        2 * long + 0 * sin2,
        2 * (long * cos2 + slender * sin2),
        2 * (long * sin2 + slender * cos2),
    )
    body, arm_before = load(SIMPLEST).bodies
    inertias: dict[str, Array] = {}
    for i, value in enumerate(arm):
        rest = body.inertia[i][i] + (arm_before.inertia[i][i] - value if total else 0 * value)
        part = f"inertia.{i + 1}{i + 1}"
        inertias |= {f"bodies.arm.{part}": value, f"bodies.body.{part}": rest}
    return inertias


def fig_4_20() -> Result:
    """Arm angle and stiffness for the simplest model whose arm takes the shape of two arms."""
    human = region(THREE)
    angles, stiffness = human[ANGLE].values, human[STIFFNESS].values
    ours, other = (stable(_turned(angles[None, :], w), stiffness[:, None]) for w in (True, False))
    theirs = human.stable.values
    inside = float((ours & theirs).sum() / ours.sum())
    extra = int((ours & ~theirs).sum())
    have: Array = np.asarray(ours.any(0))
    middle = _middles(ours, stiffness)
    here, there = (_middles(x, stiffness) for x in (ours, theirs))
    common = ~np.isnan(here) & ~np.isnan(there)
    like = float(np.corrcoef(here[common], there[common])[0, 1])
    arches = _arch(ours, angles, stiffness) and _arch(theirs, angles, stiffness)
    widths = ours.sum(0)
    peak = float(angles[int(np.argmax(widths))])
    size = float(ours.sum() / theirs.sum())
    claims = (
        statement(
            "fig4-20.shape",
            "§4.4.2, Figure 4-20",
            "the shape of the region is suggestive of that of the human model",
            "suggestive of the shape",
            ("both are arches, widest near π/2" if arches else "not both are arches")
            + f"; {100 * inside:.0f} % of it lies within figure 4-10",
            arches and inside > 0.5,
            "An arch: one range of angles, widest within 0.2 rad of π/2, K_sh rising and then "
            f"falling along it. The likeness goes no further: it has {100 * size:.0f} % of "
            f"the area "
            "of figure 4-10, is symmetric about π/2 where that leans to small angles and falls "
            f"lower at large ones, and the middles of the ranges correlate only {like:.2f}. "
            "Whole-body inertias kept at their values for Γ = π/2; with those of the body "
            "alone kept instead "
            f"{100 * (other & theirs).sum() / other.sum():.0f} % lies within figure 4-10.",
        ),
        statement(
            "fig4-20.kl1",
            "§4.4.2",
            "the arms' power to stabilise falls away from Γ = π/2 because kl1 changes",
            "decreases away from π/2",
            f"widest at {peak:.2f} rad, none below {angles[have].min():.2f} or above "
            f"{angles[have].max():.2f} rad",
            abs(peak - np.pi / 2) < 0.15 and not have[0] and not have[-1],
            "Only the arm's Il2 and Il3 change with Γ here.",
        ),
        statement(
            "fig4-20.extra",
            "§4.4.2",
            "there are stable conditions that the human model does not have",
            "extra stable conditions",
            f"{extra} of {int(ours.sum())} points ({100 * (1 - inside):.0f} %)",
            extra > 0,
            "Near the ends, where figure 4-10's range lies lower. The thesis's assumptions "
            "for this "
            "plot are not printed; with ours the region as a whole is smaller, not larger.",
        ),
    )
    return Result(
        "The simplest model with its arm shaped to resemble the symmetric arm angle and fixed body "
        "parameters: the shape is suggestive of figures 4-9 to 4-11, with extra stable conditions.",
        f"With Il1 = 2 I_sh, Il2 = 2 (I_sh cos² Γ + Il3 sin² Γ), Il3 = 2 (I_sh sin² Γ + Il3 "
        f"cos² Γ) "
        "and the whole body's inertias fixed, the region follows the middle of figure 4-10 "
        f"from {middle[have][0]:.2f} at Γ = {angles[have].min():.2f} up to "
        f"{np.nanmax(middle):.2f} and down "
        f"again; it holds {100 * size:.0f} % of its area. The human's arms turn about shoulders "
        "away from the centre of mass, which this model leaves out.",
        claims,
        _draw_4_20(ours),
    )


def _middles(points: Array, stiffness: Array) -> Array:
    """Middle of the stable K_sh at each angle, NaN where there is none."""
    return np.array([stiffness[c].mean() if c.any() else np.nan for c in points.T])


def _arch(points: Array, angles: Array, stiffness: Array) -> bool:
    """Whether a region is an arch over π/2: whole, widest there, rising and then falling."""
    have = np.flatnonzero(points.any(0))
    middle = _middles(points, stiffness)[have]
    widest = angles[int(np.argmax(points.sum(0)))]
    top = int(np.argmax(middle))
    whole = bool(np.mean(np.diff(have) == 1) > 0.9)  # its ends may be thinner than the grid
    return whole and abs(widest - np.pi / 2) < 0.2 and middle[0] < middle[top] > middle[-1]


def _draw_4_20(ours: Array) -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(7.0, 5.0)
    ax = picture.add_subplot()
    human = region(THREE)
    charts.chart_axes(ax, "The simplest model with arms at Γ")
    charts.filled(ax, human[ANGLE], human[STIFFNESS], human.stable, look.PALE, look.GREY, alpha=1)
    charts.filled(ax, human[ANGLE], human[STIFFNESS], ours, look.ORANGE, look.VERMILION, alpha=0.8)
    look.pointer(ax, (1.57, 1.0), (1.9, 1.9), "simplest model", look.VERMILION)
    look.pointer(ax, (1.1, 0.8), (0.3, -0.6), "human model,\nfigure 4-10", look.GREY)
    return picture
