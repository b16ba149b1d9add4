"""Figure 5-5: which springs stabilise the doll (sections 5.3 and 5.5)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault import stability as st
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import ANGLE, GROWS, MODEL, NOMINAL, STIFFNESS, shown
from somersault.thesis.ch5 import _doll as doll
from somersault.thesis.ch5._doll import ANGLES, BARE, BEST, STRAIGHT, WEIGHTED

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from somersault.model import Model

_LOW, _HIGH, _STEP = 0.7, 1.4, 0.1  # §5.5's stabilising K_sh at Γ = 1.57, printed in tenths


def fig_5_5() -> Result:
    """Stabilising springs of the weighted doll."""
    (low, high), *_ = doll.springs(WEIGHTED)
    human = doll.springs(MODEL)
    return Result(
        "Values of K_sh that theoretically stabilise the doll, and the measured best, 0.82 at "
        "Γ ≈ 1.57. The plot is very similar to figure 4-9; the range is larger, due to the larger "
        "I_rel. At 1.57 it is 0.7 ≤ K_sh ≤ 1.4.",
        f"At Γ = 1.57 the doll is stable for {low:.3f} ≤ K_sh ≤ {high:.3f}, the human for "
        f"{shown(list(human))}; 0.82 lies in both. With the misprinted rl3 the doll's range is "
        f"{shown(list(doll.springs(doll.as_printed())))}, on points 0.1 apart 0.7 to 1.4: the "
        "thesis's figure seems to have been computed with the misprint.",
        (*_range_claims(low, high, human), *_beside_the_human()),
        _draw_5_5(),
        _compared(),
    )


def _tenths(model: str | Model, angle: float = STRAIGHT) -> tuple[float, float]:
    """Least and greatest stable K_sh of points 0.1 apart."""
    at = np.round(np.arange(_STEP, 2.05, _STEP), 9)
    stable = at[st.growth_rates(model, {ANGLE: angle, STIFFNESS: at}) <= GROWS]
    return float(stable.min()), float(stable.max())


def _range_claims(low: float, high: float, human: tuple[tuple[float, float], ...]) -> list[Claim]:
    where = "§5.5, Figure 5-5"
    printed = doll.as_printed()
    (least, most), *_ = doll.springs(printed)
    grid, fit = _tenths(printed), _tenths(WEIGHTED)
    here, there = (_tenths(model, 1.6) for model in (printed, WEIGHTED))
    reading = "An edge between two points 0.1 apart, as the thesis prints its range."
    misprint = (
        f" With the printed rl3 = 0.0572 m the range is {least:.3f} to {most:.3f}, on points 0.1 "
        f"apart {grid[0]:g} to {grid[1]:g}; with the corrected 0.0622 m {fit[0]:g} to {fit[1]:g}."
    )
    theirs = f"{_LOW:g} to {_HIGH:g}"
    return [
        number("fig5-5.low", where, "least stable K_sh, Γ = 1.57", _LOW, low, "1", _STEP, reading),
        number(
            "fig5-5.high",
            where,
            "greatest stable K_sh, Γ = 1.57",
            _HIGH,
            high,
            "1",
            _STEP,
            reading + misprint,
        ),
        statement(
            "fig5-5.all",
            where,
            "every spring of 0.7 ≤ K_sh ≤ 1.4 stabilises the doll at Γ = 1.57",
            theirs,
            f"stable from {low:.3f} to {high:.3f}",
            low <= _LOW and high >= _HIGH,
        ),
        statement(
            "fig5-5.as-printed",
            where,
            "the stabilising range at Γ = 1.57, with Table 5.1's rl3 as printed",
            theirs,
            f"{grid[0]:g} to {grid[1]:g} on points 0.1 apart; edges {least:.3f} and {most:.3f}",
            bool(np.allclose(grid, (_LOW, _HIGH))),
            f"With the corrected rl3 {fit[0]:g} to {fit[1]:g}. At Γ = 1.6 the same: "
            f"{here[0]:g} to {here[1]:g} with the printed, {there[0]:g} to {there[1]:g} with the "
            "corrected. So the misprint seems to have been in the computation as well.",
        ),
        statement(
            "fig5-5.best",
            "Figures 5-5, 5-7, 5-8; §5.5",
            "the spring that did best, K_sh = 0.82, lies in the doll's range at Γ = 1.57",
            "within",
            f"the range is {low:.3f} to {high:.3f}",
            low < BEST < high,
            f"It lies low in it: {(BEST - low) / (high - low):.2f} of the way up.",
        ),
        statement(
            "fig5-5.best-human",
            "§5.5, Figure 4-9",
            "0.82 lies in the human's range too",
            "within",
            f"the human's range at Γ = 1.57 is {shown(list(human))}",
            any(a < BEST < b for a, b in human),
        ),
    ]


def _beside_the_human() -> list[Claim]:
    ours, theirs = doll.edges(WEIGHTED), doll.edges(MODEL)
    have = [~np.isnan(low) for low, _ in (ours, theirs)]
    ends = [(float(ANGLES[x][0]), float(ANGLES[x][-1])) for x in have]
    both, either = have[0] & have[1], have[0] | have[1]
    middles = np.array([(low + high)[both] / 2 for low, high in (ours, theirs)])
    like = float(np.corrcoef(middles)[0, 1])
    wide, human = (np.nan_to_num(high - low) for low, high in (ours, theirs))
    common = np.minimum(ours[1], theirs[1]) - np.maximum(ours[0], theirs[0])
    covered = float(np.maximum(np.nan_to_num(common), 0).sum() / human.sum())
    area = float(wide.sum() / human.sum())
    wider = float((wide > human)[either].mean())
    here, there, bare = (doll.width(name) for name in (WEIGHTED, MODEL, BARE))
    size = float(doll.relative_inertia(MODEL, np.array(STRAIGHT)))
    thin = doll.width(doll.with_smaller_arms(WEIGHTED, size))
    return [
        statement(
            "fig5-5.similar",
            "§5.1, §5.3",
            "the plot is very similar to figure 4-9, as the doll is dynamically similar",
            "very similar",
            f"arm angles {ends[0][0]:.2f} to {ends[0][1]:.2f} rad, the human's {ends[1][0]:.2f} to "
            f"{ends[1][1]:.2f}; middles of the ranges correlate {like:.2f}; {100 * covered:.0f} % "
            "of the human's region is in the doll's",
            bool(np.allclose(ends[0], ends[1], rtol=0, atol=0.1)) and like > 0.9 and covered > 0.5,
            "Read as: the same arm angles within 0.1 rad, ranges that rise and fall together "
            "(correlation above 0.9), more than half of figure 4-9 stable for the doll too. Not so "
            "in the strict sense: k1 and I_rel differ (fig5-2.k1, fig5-3.larger).",
        ),
        statement(
            "fig5-5.wider",
            "§5.3",
            "the range of stabilising K_sh is larger for the doll",
            "larger",
            f"{here:.2f} against {there:.2f} wide at Γ = 1.57; wider at {100 * wider:.0f} % of the "
            f"arm angles; {area:.2f} times the area",
            here > there and wider > 0.9 and area > 1,
        ),
        statement(
            "fig5-5.slightly",
            "§5.2.1, §5.6",
            "relatively more massive arms make the doll slightly easier to stabilise",
            "slightly easier",
            f"{here / there:.2f} times the human's range of K_sh at Γ = 1.57",
            1 < here / there < 2,
            "“Slightly” read as less than twice. It takes the weights: the bare doll's range is "
            f"{bare:.2f} wide, the human's {there:.2f}.",
        ),
        statement(
            "fig5-5.due",
            "§5.3",
            "the larger range is due to the larger I_rel",
            "due to I_rel",
            f"with arms as small as the human's (I_rel {size:.3f}) and the whole body's inertias "
            f"kept, the doll's range at Γ = 1.57 is {thin:.2f} wide, not {here:.2f}; the human's "
            f"is {there:.2f}",
            thin <= there < here,
            "The doll's lower k1 by itself would make the range narrower than the human's.",
        ),
    ]


def _compared() -> Table:
    """The numbers of all four models, the misprint's doll among them."""
    rows = []
    for name, model in (
        ("human (furrer)", MODEL),
        ("bare doll", BARE),
        ("weighted doll", WEIGHTED),
        ("weighted, rl3 as printed", doll.as_printed()),
    ):
        k1, k3 = doll.ratios(model, np.array(NOMINAL))
        relative = float(doll.relative_inertia(model, np.array(STRAIGHT)))
        values = (f"{k1:.3f}", f"{k3:.3f}", f"{relative:.3f}", shown(list(doll.springs(model))))
        rows.append((name, f"{doll.shoulder_inertia(model):.4g}", *values))
    header = ("model", "I_sh kg m²", "k1 at 1.3", "k3 at 1.3", "I_rel at 1.57", "K_sh at 1.57")
    return Table(header, tuple(rows))


def _draw_5_5() -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(9.4, 4.8)
    whole, near = picture.subplots(1, 2, width_ratios=(1.2, 1))
    charts.chart_axes(whole, "The weighted doll, five degrees of freedom")
    near.set(xlim=(1.3, 1.8), ylim=(0, 2), xlabel="arm angle Γ (rad)", title="The same, nearer")
    for ax in (whole, near):
        charts.band(ax, ANGLES, *doll.edges(WEIGHTED))
        for edge in doll.edges(MODEL):
            ax.plot(ANGLES, edge, color=look.VERMILION, lw=1.3)
        ax.plot(STRAIGHT, BEST, "+", color=look.BLACK, ms=13, mew=2, zorder=8)
    for edge in doll.edges(doll.as_printed()):
        near.plot(ANGLES, edge, color=look.BLACK, lw=1.2, ls="--")
    near.plot([STRAIGHT, STRAIGHT], [_LOW, _HIGH], color=look.BLACK, lw=1, marker="_", zorder=7)
    look.pointer(whole, (STRAIGHT, BEST), (0.25, -0.7), "best in the laboratory:\n0.82 at Γ ≈ 1.57")
    look.pointer(whole, (1.55, 1.5), (1.8, 2.6), "weighted doll", look.BLUE)
    look.pointer(whole, (0.95, 1.13), (0.25, 2.1), "human,\nfigure 4-9", look.VERMILION)
    look.pointer(near, (STRAIGHT, 1.35), (1.64, 1.8), "thesis: 0.7 to 1.4")
    look.pointer(near, (1.36, 1.55), (1.33, 1.85), "dashed: rl3 as printed")
    look.label(near, 1.38, 1.2, "human", look.VERMILION)
    look.label(near, 1.55, 0.88, "0.82", ha="right")
    return picture
