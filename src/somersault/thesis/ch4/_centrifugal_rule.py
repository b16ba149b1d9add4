"""Figure 4-17: the rule that the spring should cancel the centrifugal term."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result
from somersault.thesis.ch4._furrer import THREE, edges
from somersault.thesis.ch4._stability_regions import FINE, draw_part

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def fig_4_17() -> Result:
    """The region of figure 4-10 and the spring that cancels the centrifugal term."""
    edge = edges(FINE)
    have = ~np.isnan(edge.lower3)
    low, high, rule = (x[have] for x in (edge.lower3, edge.upper3, edge.rule))
    inside = (low < rule) & (rule < high)
    off = (rule - (low + high) / 2) / (high - low)
    outside = FINE[have][~inside]
    middle = edges(np.array([np.pi / 2]))
    straight = float(middle.rule[0])
    runs = f"below it at Γ up to {outside[outside < 1.5].max():.2f} rad and from " + (
        f"{outside[outside > 1.5].min():.2f} rad"
    )
    bulk = (low + high) / 2
    fit = float(np.corrcoef(rule, bulk)[0, 1])
    claims = (
        statement(
            "fig4-17.rule",
            "§4.4.2, Figure 4-17",
            "the stabilising K_sh are those that cancel the centrifugal term on the arm, −k33",
            "the region seems to be defined by it",
            f"inside the stable range at {100 * inside.mean():.0f} % of the arm angles that have "
            f"one; correlation with its middle {fit:.3f}",
            inside.mean() > 0.75 and fit > 0.95,
            f"The rule lies {runs}, where the range is a blade; elsewhere inside, "
            f"{off[inside].min():+.2f} to {off[inside].max():+.2f} of the range's width from its "
            f"middle, {np.mean(off[inside]):+.2f} on average. The upper edge is exactly the rule "
            "plus k13²/(2 I_sh k11), so the rule never overshoots.",
        ),
        number(
            "fig4-17.straight",
            "§4.4.2",
            "stabilising K_sh for arms straight out, Γ = π/2, by the rule",
            1.0,
            straight,
            "1",
            0.05,
        ),
        statement(
            "fig4-17.one",
            "§4.4.2",
            "K_sh = 1.0 stabilises Γ = π/2",
            "approximately 1.0",
            f"3 d.o.f.: {middle.lower3[0]:.3f} to {middle.upper3[0]:.3f}; 5 d.o.f.: from "
            f"{middle.lower5[0]:.3f}",
            bool(middle.lower5[0] < 1.0 < middle.upper5[0]),
        ),
    )
    return Result(
        "The region of figure 4-10 with the K_sh that would exactly cancel the spring term due to "
        "centrifugal forces on the arm: the region “seems to be defined by the negative of this "
        "centrifugal force term”.",
        f"The rule is inside the stable range at {100 * inside.mean():.0f} % of the arm angles "
        "that have one, on average above its middle. The upper edge is exactly the rule plus "
        "k13²/(2 I_sh k11): what the arm's coupling to the body allows beyond it.",
        claims,
        _draw_4_17(),
    )


def _draw_4_17() -> Figure:
    from somersault.view import style as look

    picture, ax = draw_part(THREE, "The rule: cancel the centrifugal term", (1.4, 0.83, "stable"))
    edge = edges(FINE)
    ax.plot(FINE, edge.rule, color=look.VERMILION, lw=2)
    look.pointer(
        ax,
        (2.0, 0.21),
        (2.15, 1.1),
        "$K_{sh}$ = −$k_{33}$/(2 $I_{sh}$)\ncancels it",
        look.VERMILION,
    )
    ax.plot(np.pi / 2, 1.0, "o", color=look.BLACK, ms=5, zorder=6)
    look.pointer(ax, (np.pi / 2, 1.0), (1.75, 2.0), "thesis: ≈ 1.0 for\narms straight out")
    return picture
