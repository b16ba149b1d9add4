"""Regions of stability over arm angle and shoulder stiffness: figures 4-9, 4-10, 4-11."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result
from somersault.thesis.ch4._furrer import (
    ANGLE,
    GROWS,
    HIGH,
    MODEL,
    STIFFNESS,
    THREE,
    TWO,
    both,
    edges,
    region,
    undivided_growth,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Edges of the 5-d.o.f. region from another implementation, in steps of 0.02 (errata).
REFERENCE = {1.2: (0.94, 1.34), 1.4: (0.82, 1.32), 1.6: (0.56, 1.12), 1.8: (0.18, 0.74)}
FINE = np.linspace(0, 3, 301)


def fig_4_9() -> Result:
    """Where the whole 5-d.o.f. system is stable."""
    five, three = both(), region(THREE).stable
    positive = five[STIFFNESS] > 1e-9
    share = float(five.sum() / three.sum())
    share_positive = float((five & positive).sum() / (three & positive).sum())
    low, high = _positive_range()
    open_, close = _closing(0.5, 0.7), _closing(2.6, 2.4)
    return Result(
        "Points in the Γ–K_sh plane that stabilise the five-d.o.f. system. They are the "
        "intersection of figures 4-10 and 4-11, and resemble 4-10: few conditions that stabilise "
        "the 3-by-3 system fail to stabilise the 5-by-5 one. Positive springs stabilise arm angles "
        "between 0.8 and 2.0 rad.",
        f"The region is a crescent from Γ = {open_:.2f} to {close:.2f} rad; springs of positive "
        f"stiffness reach from {low:.2f} to {high:.2f} rad. It thins to a blade at both ends: at "
        f"0.6 rad it is {_width(0.6):.3f} wide, at 0.7 rad {_width(0.7):.3f}. Points 0.1 "
        f"apart miss "
        f"the blade and give 0.8 to 2.0. It covers {100 * share:.0f} % of figure 4-10's area "
        f"({100 * share_positive:.0f} % of it for K_sh > 0); what is lost lies along one edge, "
        "where the symmetric arms are too soft.",
        (
            *_range_claims(low, high),
            *_share_claims(share, share_positive),
            _same_top(),
        ),
        _draw_4_9(),
    )


def _positive_range() -> tuple[float, float]:
    """Least and greatest arm angle that some positive K_sh stabilises."""
    high = _root(lambda angle: float(edges(np.array([angle])).upper5[0]), 2.0, 2.2)
    return _closing(0.5, 0.7), high


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    from scipy.optimize import brentq

    return float(brentq(function, low, high, xtol=1e-7))


def _closing(outside: float, inside: float) -> float:
    """The arm angle at which the 5-d.o.f. region begins, by halving."""
    for _ in range(24):
        middle = (outside + inside) / 2
        if np.isnan(edges(np.array([middle])).lower5[0]):
            outside = middle
        else:
            inside = middle
    return inside


def _width(angle: float) -> float:
    edge = edges(np.array([angle]))
    return float(edge.upper5[0] - edge.lower5[0])


def _range_claims(low: float, high: float) -> list[Claim]:
    where = "§4.3.3, Figure 4-9"
    ends = {}
    for step in (0.1, 0.05, 0.02):
        angles = np.arange(0, 3 + step / 2, step)
        stiffness = np.arange(step, HIGH + step / 2, step)
        rates = st.growth_rates(MODEL, {ANGLE: angles[:, None], STIFFNESS: stiffness[None, :]})
        some = angles[(rates <= GROWS).any(1)]
        ends[step] = (round(float(some.min()), 2), round(float(some.max()), 2))
    finer = ", ".join(f"{a:g} to {b:g} with {step:g}" for step, (a, b) in ends.items())
    blade = (
        f"A blade: stable K_sh are {_width(0.6):.4f} apart at 0.6 rad, {_width(0.7):.3f} at "
        f"0.7 and "
        f"{_width(0.8):.3f} at 0.8. A search on separate points misses it: {finer}."
    )
    return [
        statement(
            "fig4-9.range-grid",
            where,
            "positive springs stabilise arm angles between 0.8 and 2.0 rad (points 0.1 apart)",
            "0.8 to 2.0 rad",
            f"{ends[0.1][0]:g} to {ends[0.1][1]:g} rad",
            ends[0.1] == (0.8, 2.0),
            f"Depends on how finely one searches: {finer}. The thesis does not give its spacing.",
        ),
        number(
            "fig4-9.range-low",
            where,
            "least arm angle that a positive spring stabilises, exactly",
            0.8,
            low,
            "rad",
            0.1,
            blade,
        ),
        number(
            "fig4-9.range-high",
            where,
            "greatest arm angle that a positive spring stabilises, exactly",
            2.0,
            high,
            "rad",
            0.1,
            "There the upper edge crosses K_sh = 0.",
        ),
    ]


def _share_claims(share: float, share_positive: float) -> list[Claim]:
    wrong, count = _undivided()
    lost = 100 * (1 - share)
    edge = edges(FINE)
    trimmed = FINE[edge.lower5 > edge.lower3 + 1e-9]
    area = f"{100 * share:.1f} % of the 3-d.o.f. area ({100 * share_positive:.1f} % for K_sh > 0)"
    return [
        statement(
            "fig4-9.intersection",
            "§4.3.2",
            "the stable points of figure 4-9 are those of 4-10 and of 4-11",
            "an intersection",
            f"the undivided system's roots differ from it at {wrong} of {count} points",
            wrong == 0,
            "All ten roots of the 5-d.o.f. system as it stands, against the two charts.",
        ),
        statement(
            "fig4-9.few-fail",
            "§4.3.2",
            "few conditions that stabilise the 3-by-3 system fail to stabilise the 5-by-5 system",
            "few",
            f"{lost:.1f} % fail",
            share >= 0.75,
            "“Few” read as fewer than one in four. It is a fair summary of the shape, but nearly a "
            f"fifth of the area is lost, all of it along the lower edge between Γ = "
            f"{trimmed.min():.2f} "
            f"and {trimmed.max():.2f} rad.",
        ),
        statement(
            "fig4-9.nearly",
            "§4.2.2",
            "parameters that stabilise the whole are nearly, not exactly, those of the "
            "3-by-3 system",
            "nearly, but not exactly, identical",
            area,
            0.75 <= share < 1,
        ),
    ]


def _undivided() -> tuple[int, int]:
    """How many of a grid's points the roots of the undivided system judge differently."""
    expected = both()[::10, ::10]
    wrong = 0
    for angle in expected[ANGLE].values:
        growth = undivided_growth(round(float(angle), 9), expected[STIFFNESS].values)
        # The double zero of the somersault's drift is smeared by rounding to about 1e-7.
        stable = growth <= 3 * GROWS
        wrong += int((stable != expected.sel({ANGLE: angle}).values).sum())
    return wrong, expected.size


def _same_top() -> Claim:
    """Whether the stiffest stable spring is the same in both charts."""
    tops = []
    for stable in (both().values, region(THREE).stable.values):
        tops.append(stable.shape[0] - 1 - np.argmax(stable[::-1], axis=0))
    have = both().values.any(0)
    same = tops[0][have] == tops[1][have]
    return statement(
        "fig4-9.top",
        "§4.3.2",
        "figure 4-9 is figure 4-10 with the soft side trimmed: its upper edge is the same",
        "well represented by the simpler 3-by-3 system",
        f"same upper edge at {int(same.sum())} of {int(have.sum())} arm angles",
        bool(same.all()),
    )


def _draw_4_9() -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(7.4, 5.4)
    ax = picture.add_subplot()
    charts.chart_axes(ax, "Stable somersaults, five degrees of freedom")
    edge = edges(FINE)
    charts.band(ax, FINE, edge.lower3, edge.upper3, look.PALE, None, alpha=1)
    charts.band(ax, FINE, edge.lower5, edge.upper5)
    ax.plot(FINE, edge.lower2, color=look.VERMILION, lw=1.2, ls="--")
    for angle, (low, high) in REFERENCE.items():
        ax.plot([angle, angle], [low, high], "o", color=look.BLACK, ms=4, zorder=6)
    look.label(ax, 1.4, 1.03, "stable", look.BLUE, ha="center", fontsize=10)
    look.pointer(ax, (1.2, 0.8), (0.35, -0.6), "3 d.o.f. alone\nwould be stable", look.GREY)
    look.label(
        ax, 1.92, -0.05, "symmetric arms\nstable above", look.VERMILION, va="top", ha="right"
    )
    look.pointer(ax, (1.6, 1.12), (1.9, 1.6), "edges found independently (errata)")
    look.pointer(ax, (0.6, 0.64), (0.12, 1.5), "a blade 0.01 wide\nat 0.6 rad", look.BLUE)
    ax.annotate("", (2.0, 2.4), (0.8, 2.4), arrowprops={"arrowstyle": "<->", "lw": 1})
    look.label(ax, 1.4, 2.65, "thesis: 0.8 to 2.0 rad with positive springs", ha="center")
    return picture


def draw_part(subsystem: str, title: str, words: tuple[float, float, str]) -> tuple[Figure, Axes]:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(7.0, 5.0)
    ax = picture.add_subplot()
    charts.chart_axes(ax, title)
    edge = edges(FINE)  # the same as the search finds, as claims of 4-10 and 4-11 check
    if subsystem == THREE:
        charts.band(ax, FINE, edge.lower3, edge.upper3)
    else:
        charts.band(ax, FINE, edge.lower2, np.full_like(FINE, HIGH))
    look.label(ax, *words, look.BLUE, ha="center", fontsize=10)
    return picture, ax


def fig_4_10() -> Result:
    """Where tilt, twist and asymmetric arms are stable."""
    edge, stable = edges(FINE), region(THREE).stable.values
    k = region(THREE)[STIFFNESS].values
    away = np.min(np.abs(k[:, None] - np.stack([edge.lower3, edge.upper3])[:, None, :]), 0)
    inside = (k[:, None] > edge.lower3) & (k[:, None] < edge.upper3)
    wrong = int(((inside != stable) & ~(away < 1e-6)).sum())
    widths = edge.upper3 - edge.lower3
    widest = float(FINE[np.nanargmax(widths)])
    return Result(
        "Points that stabilise the three-d.o.f. system of tilt, twist and asymmetric arms.",
        f"A crescent, widest at Γ = {widest:.2f} rad ({np.nanmax(widths):.2f} in K_sh). Its edges "
        "follow from the characteristic polynomial (s² + 1)(a s⁴ + b s² + c): below, two "
        "oscillations meet (b² = 4 a c); above, a root reaches zero (c = 0).",
        (
            statement(
                "fig4-10.edges",
                "Figure 4-10",
                "the stable region of the 3-d.o.f. system",
                "a region, found by searching",
                f"{wrong} of {stable.size} searched points differ from the closed form",
                wrong == 0,
            ),
            statement(
                "fig4-10.widest",
                "§4.4.2",
                "the arm's power to stabilise falls as the arms leave Γ = π/2",
                "decreases away from π/2",
                f"widest at {widest:.2f} rad; narrows on both sides"
                if _one_peak(widths)
                else f"widest at {widest:.2f} rad, not falling steadily on both sides",
                _one_peak(widths) and abs(widest - np.pi / 2) < 0.2,
                "Measured by the width of the range of K_sh.",
            ),
        ),
        _draw_4_10(),
    )


def _one_peak(widths: Array) -> bool:
    known = widths[~np.isnan(widths)]
    top = int(np.argmax(known))
    return bool(np.all(np.diff(known[: top + 1]) > 0) and np.all(np.diff(known[top:]) < 0))


def _draw_4_10() -> Figure:
    from somersault.view import style as look

    picture, ax = draw_part(THREE, "Tilt, twist and asymmetric arms", (1.42, 0.95, "stable"))
    look.pointer(ax, (1.55, 1.18), (1.9, 1.9), "above: a root leaves zero,\ntilt and twist diverge")
    look.pointer(ax, (1.1, 0.78), (0.3, -0.8), "below: two oscillations\nmeet and one grows")
    return picture


def fig_4_11() -> Result:
    """Where somersault and symmetric arms are stable."""
    edge, data = edges(FINE), region(TWO)
    k = data[STIFFNESS].values[:, None]
    wrong = int((((k > edge.lower2) != data.stable.values) & (abs(k - edge.lower2) > 1e-6)).sum())
    stiff = np.array([5.0, 10, 100, 1e3, 1e4])
    far = st.growth_rates(MODEL, {ANGLE: FINE[:, None], STIFFNESS: stiff[None, :]}, subsystem=TWO)
    upward = np.all(np.diff(data.stable.values.astype(int), axis=0) >= 0)
    return Result(
        "Points that stabilise the two-d.o.f. system of somersault and symmetric arms. Higher K_sh "
        "than shown are suspected to stabilise it too.",
        "Stable above a single edge, K_sh = −(k55 + g45²/m44)/(2 I_sh), without an upper limit.",
        (
            statement(
                "fig4-11.edge",
                "Figure 4-11",
                "the stable region of the 2-d.o.f. system lies above one edge",
                "a region, found by searching",
                f"{wrong} of {data.stable.size} searched points differ from the closed form",
                wrong == 0 and bool(upward),
            ),
            statement(
                "fig4-11.higher",
                "Figure 4-11",
                "higher K_sh than shown also stabilise the system",
                "suspected",
                f"stable at {int((far <= GROWS).sum())} of {far.size} cases with K_sh of 5 to "
                f"10 000",
                bool(np.all(far <= GROWS)),
                "In closed form too: stiffness only adds to k55.",
            ),
        ),
        draw_part(TWO, "Somersault and symmetric arms", (1.5, 2.4, "stable, and so on upwards"))[0],
    )
