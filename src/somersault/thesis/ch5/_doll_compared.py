"""The doll beside the human: figures 5-2, 5-3 and 5-5 (sections 5.1 to 5.3)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import ANGLE, GROWS, MODEL, NOMINAL, STIFFNESS, shown
from somersault.thesis.ch5 import _doll as doll
from somersault.thesis.ch5._doll import ANGLES, BARE, BEST, STRAIGHT, WEIGHTED

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from somersault.model import Model

_NEAR = 0.1  # "nearly the same" inertia ratio: within a tenth of the diagram's axis
_LOW, _HIGH, _STEP = 0.7, 1.4, 0.1  # §5.5's stabilising K_sh at Γ = 1.57, printed in tenths
# Each model's colour (vermilion, blue, black of view/style.py) and line.
_LOOKS = {MODEL: ("#D55E00", "-"), WEIGHTED: ("#0072B2", (0, (1, 1))), BARE: ("#000000", "--")}


# ---------------------------------------------------------------------------- figure 5-2


def fig_5_2() -> Result:
    """Inertia ratios of human and dolls over curves of growth."""
    human = doll.ratios(MODEL, ANGLES)
    dolls = {name: doll.ratios(name, ANGLES) for name in (WEIGHTED, BARE)}
    off = {
        name: [float(np.abs(a - b).max()) for a, b in zip(human, found, strict=True)]
        for name, found in dolls.items()
    }
    inside = [bool(np.all((k1 > 0) & (k3 < 0))) for k1, k3 in (human, *dolls.values())]
    claims = (
        *_nearly(off, human, dolls),
        statement(
            "fig5-2.quadrant",
            "Figure 5-2",
            "doll and human lie in the quadrant of the middle axis at every arm angle",
            "the quadrant of growth curves",
            f"k1 > 0 and k3 < 0 throughout for {sum(inside)} of human, weighted and bare doll",
            all(inside),
        ),
    )
    return Result(
        "Rigid body inertia ratios of the doll (dotted) and the human (solid) for arm angles of 0 "
        "to 3 rad: the doll has nearly the same ratios as the human model.",
        f"k3 is nearly the same (within {off[WEIGHTED][1]:.3f}; of the bare doll "
        f"{off[BARE][1]:.3f}). k1 is not: the weighted doll's is lower by up to "
        f"{off[WEIGHTED][0]:.2f}, the bare one's by up to {off[BARE][0]:.2f}, and so the doll held "
        "rigid is the less unstable of the two.",
        claims,
        _draw_5_2(human, dolls),
    )


def _nearly(
    off: dict[str, list[float]],
    human: tuple[Array, Array],
    dolls: dict[str, tuple[Array, Array]],
) -> list[Claim]:
    """Four claims: k1 and k3 of either doll against the human's."""
    printed, mixed = (
        max(float(np.abs(a - b).max()) for a, b in zip(human, found, strict=True))
        for found in (doll.ratios(doll.as_printed(name), ANGLES) for name in (WEIGHTED, BARE))
    )
    small = float(doll.relative_inertia(doll.as_printed(BARE), np.array(STRAIGHT)))
    needed, fit = _heavier_body()
    rod = doll.parameters(BARE)["mb"] * doll.HEIGHT**2 / 12
    why = (
        " Table 5.1 does not allow it. The arms are a larger part of I3 than a human's, and k1 = "
        f"(I2 − I3)/I1 falls. The printed rl3 = 0.0572 m leaves the weighted doll {printed:.2f} "
        "away. Printed numbers come near only if the columns are mixed: the bare arm's 27.5 g at "
        f"0.0572 m, within {mixed:.2f}; but that arm's I_rel is {small:.3f}, the human's, and "
        f"figure 5-3 says more. Ib1 = {needed:.4f} for 0.0041 kg m², Ib2 raised with it, would "
        f"bring the bare doll within {fit:.3f}; but a uniform rod of the body's mass and 15 inches "
        f"has {rod:.4f}. So figure 5-2 was drawn from other numbers, or “nearly” is meant more "
        "widely than here."
    )
    here = int(np.argmin(np.abs(ANGLES - NOMINAL)))
    notes = {"k1": why, "k1-bare": " As for the weighted doll, fig5-2.k1."}
    claims = []
    for name, found in dolls.items():
        for i, ratio in enumerate(("k1", "k3")):
            tag = ratio if name == WEIGHTED else f"{ratio}-bare"
            claims.append(
                statement(
                    f"fig5-2.{tag}",
                    "§5.2.1, Figure 5-2",
                    f"{ratio} of the {'weighted' if name == WEIGHTED else 'bare'} doll is nearly "
                    "the human's at all arm angles",
                    f"nearly the same: within {_NEAR:g}",
                    f"within {off[name][i]:.3f}; at Γ = {ANGLES[here]:g} {found[i][here]:.3f} "
                    f"against {human[i][here]:.3f}",
                    off[name][i] <= _NEAR,
                    "“Nearly” read as a tenth of the diagram's axis." + notes.get(tag, ""),
                )
            )
    return claims


def _heavier_body() -> tuple[float, float]:
    """The Ib1 that would give the bare doll the human's ratios, and how near it comes.

    Ib2 is raised with it, which leaves k3 as it is.
    """
    more = 2.5e-3
    i1, i2, i3 = st.principal_inertias(BARE, {"shoulder": ANGLES}).T
    k1, k3 = doll.ratios(MODEL, ANGLES)
    away = [(i2 + more - i3) / (i1 + more) - k1, (i2 - i1) / i3 - k3]
    return doll.parameters(BARE)["Ib1"] + more, float(np.abs(away).max())


def _draw_5_2(human: tuple[Array, Array], dolls: dict[str, tuple[Array, Array]]) -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    made = look.figure(9.0, 4.4)
    square, along = made.subplots(1, 2, width_ratios=(1.15, 1))
    charts.growth_curves(square, (2.6, 3.0, 3.5, 4.0, 4.5), (0.93, 0.86, 0.52, 0.385, 0.385))
    square.set(xlim=(0.36, 0.96), ylim=(-0.95, -0.6), title="Tenfold growth in Φ rad (grey curves)")
    square.set(xlabel="$k_1$", ylabel="$k_3$")
    along.set(xlim=(0, 3), ylim=(-1, 1), xlabel="arm angle Γ (rad)", title="The same against Γ")
    along.axhline(0, color=look.GREY, lw=0.6)
    for name, (k1, k3) in {MODEL: human, **dolls}.items():
        color, line = _LOOKS[name]
        square.plot(k1, k3, color=color, ls=line)
        for angle in (0.0, 1.0, 2.0, 3.0):
            i = int(np.argmin(np.abs(ANGLES - angle)))
            square.plot(k1[i], k3[i], "o", color=color, ms=4)
        along.plot(ANGLES, k1, color=color, ls=line)
        along.plot(ANGLES, k3, color=color, ls=line)
    names = {"Γ = 0": (0.89, -0.645), "1": (0.697, -0.85), "2": (0.735, -0.876), "3": (0.903, -0.7)}
    for text, place in names.items():
        look.label(square, *place, text, _LOOKS[MODEL][0], fontsize=8)
    look.pointer(square, (0.689, -0.873), (0.68, -0.93), "human", _LOOKS[MODEL][0])
    look.pointer(square, (0.58, -0.86), (0.46, -0.8), "bare doll", _LOOKS[BARE][0])
    look.pointer(square, (0.48, -0.894), (0.4, -0.86), "weighted doll", _LOOKS[WEIGHTED][0])
    look.label(along, 0.1, 0.97, "$k_1$", fontsize=11)
    look.label(along, 0.1, -0.55, "$k_3$", fontsize=11)
    look.label(along, 1.5, 0.76, "human", _LOOKS[MODEL][0], ha="center")
    look.label(along, 1.5, 0.595, "bare doll", _LOOKS[BARE][0], ha="center")
    look.label(along, 1.5, 0.36, "weighted doll", _LOOKS[WEIGHTED][0], ha="center")
    return made


# ---------------------------------------------------------------------------- figure 5-3


def fig_5_3() -> Result:
    """How large the arms are beside the body."""
    relative = {name: doll.relative_inertia(name, ANGLES) for name in _LOOKS}
    human, ours = relative[MODEL], relative[WEIGHTED]
    ratio, bare = ours / human, relative[BARE] / human
    masses = {}
    for name in _LOOKS:
        found = doll.parameters(name)
        masses[name] = 2 * found["ml"] / (found["mb"] + 2 * found["ml"])
    straight = float(doll.relative_inertia(MODEL, np.array(np.pi / 2)))
    where = "§5.2.1, Figure 5-3"
    claims = (
        number(
            "fig5-3.human",
            "Table 4.3, Figure 5-3",
            "the human's I_rel with the arms straight out",
            0.06,
            straight,
            "1",
            0.005,
            "I_rel = 2 I_sh/I1, the reading of figure 5-3 at any angle.",
        ),
        statement(
            "fig5-3.larger",
            where,
            "the doll's I_rel is larger than the human's, at every arm angle",
            "larger",
            f"{ratio.min():.2f} to {ratio.max():.2f} times as large; the bare doll's "
            f"{bare.min():.2f} to {bare.max():.2f}",
            bool(np.all(ratio > 1)),
        ),
        statement(
            "fig5-3.massive",
            where,
            "the doll has relatively more massive arms than the human",
            "more massive",
            f"{100 * masses[WEIGHTED]:.1f} % of its mass against {100 * masses[MODEL]:.1f} %",
            masses[WEIGHTED] > masses[MODEL],
            f"Without the weights it is {100 * masses[BARE]:.1f} %: the bare doll's arms are no "
            "heavier than a human's, only longer, and its I_rel is larger none the less.",
        ),
    )
    return Result(
        "I_rel against the arm angle: the doll has relatively more massive arms than the human, "
        "which makes stabilisation slightly easier.",
        f"The weighted doll's I_rel is {ratio.min():.1f} to {ratio.max():.1f} times the human's.",
        claims,
        _draw_5_3(relative),
    )


def _draw_5_3(relative: dict[str, Array]) -> Figure:
    from somersault.view import style as look

    made = look.figure(6.2, 3.9)
    ax = made.add_subplot()
    for name, values in relative.items():
        color, line = _LOOKS[name]
        ax.plot(ANGLES, values, color=color, ls=line)
    ax.plot(np.pi / 2, 0.06, "x", color=look.BLACK, ms=7, mew=1.5)
    ax.set(xlim=(0, 3), ylim=(0, 0.15), xlabel="arm angle Γ (rad)")
    ax.set_ylabel("$I_{rel}$ = 2 $I_{sh}$/$I_1$")
    look.label(ax, 2.0, 0.105, "weighted doll", _LOOKS[WEIGHTED][0])
    look.label(ax, 2.0, 0.085, "bare doll", _LOOKS[BARE][0])
    look.label(ax, 2.0, 0.049, "human", _LOOKS[MODEL][0])
    look.pointer(ax, (np.pi / 2, 0.06), (1.1, 0.03), "× Table 4.3: 0.06")
    return made


# ---------------------------------------------------------------------------- figure 5-5


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

    made = look.figure(9.4, 4.8)
    whole, near = made.subplots(1, 2, width_ratios=(1.2, 1))
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
    return made
