"""Stability of the simplest model over the square of inertia ratios: figures 4-18 and 4-19."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._one_arm_model import bodies, stable

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STIFFNESSES = (0.0, 0.5, 0.8, 0.9, 1.0, 1.1, 1.2, 1.5, 2.0)
_RELATIVE = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
_SIDE = 100
# Cell centres: the square's edges, k = ±1, are bodies without thickness.
_RATIOS = (np.arange(_SIDE) + 0.5) / _SIDE * 2 - 1
_K1, _K3 = _RATIOS[None, :], _RATIOS[:, None]


def _possible(relative: float) -> Array:
    """Bodies whose part outside the arm has positive inertias."""
    inertias = bodies(_K1, _K3, relative, -1.0)
    return (inertias["bodies.body.inertia.33"] > 0) & (inertias["bodies.body.inertia.22"] > 0)


def fig_4_18() -> Result:
    """Nine stiffnesses at I_rel = 0.1."""
    inertias = bodies(_K1, _K3, 0.1, -1.0)
    panels = [stable(inertias, k) for k in _STIFFNESSES]
    fourth = (_K1 > 0) & (_K3 < 0)
    shares = [float(panel[fourth].mean()) for panel in panels]
    best = _STIFFNESSES[int(np.argmax(shares))]
    half = _RATIOS[_RATIOS > 0][::2]
    sweep = np.round(np.arange(0.5, 1.501, 0.02), 2)
    fine = stable(bodies(half[:, None, None], -half[None, :, None], 0.1, -1.0), sweep).mean((0, 1))
    finest = float(sweep[int(np.argmax(fine))])
    real = _possible(0.1) & fourth
    best_real = _STIFFNESSES[int(np.argmax([panel[real].mean() for panel in panels]))]
    order = sorted(zip(shares, _STIFFNESSES, strict=True), reverse=True)
    claims = (
        statement(
            "fig4-18.best",
            "§4.4.2, Figure 4-18",
            "K_sh ≈ 1.1 stabilises the largest part of the unstable fourth quadrant",
            "≈ 1.1",
            f"{best:g} of the nine ({100 * max(shares):.0f} %); {finest:.2f} in a fine sweep",
            abs(best - 1.1) < 0.01 and abs(finest - 1.1) <= 0.05,
            "The best is 1 + I_rel: up to there the upper edge K_sh < −kl1 + kl1² I_rel/k1 "
            "excludes "
            "no body (k1 ≤ 1), and beyond it slender bodies are lost.",
        ),
        statement(
            "fig4-18.between",
            "Figure 4-18",
            "1.0 ≤ K_sh ≤ 1.1 produces the largest region of stable configurations",
            "1.0 to 1.1",
            f"the two largest of the nine: {order[0][1]:g} and {order[1][1]:g}",
            {order[0][1], order[1][1]} == {1.0, 1.1},
        ),
        statement(
            "fig4-18.most",
            "§4.4.2",
            "K_sh ≈ 1.1 stabilises most of quadrant 4",
            "most",
            f"{100 * shares[_STIFFNESSES.index(1.1)]:.0f} %",
            shares[_STIFFNESSES.index(1.1)] > 0.5,
            f"Counting only bodies that can carry such an arm the best of the nine is "
            f"{best_real:g}.",
        ),
    )
    rows = tuple(
        (f"{k:g}", f"{100 * share:.1f} %") for k, share in zip(_STIFFNESSES, shares, strict=True)
    )
    return Result(
        "Stable bodies in the k1–k3 square for nine K_sh, kl1 = −1, I_rel = 0.1: the value that "
        "stabilises the largest part of the unstable fourth quadrant is K_sh ≈ 1.1.",
        f"K_sh = {best:g} is the best of the nine with {100 * max(shares):.0f} % of quadrant "
        f"4 (the "
        f"best of all is 1 + I_rel). Above it the share falls steeply: {100 * shares[6]:.0f} % at "
        "1.2.",
        claims,
        _draw(panels, [f"$K_{{sh}}$ = {k:g}" for k in _STIFFNESSES], shares, 0.1),
        Table(("K_sh", "quadrant 4 stable"), rows),
    )


def fig_4_19() -> Result:
    """Nine sizes of arm at K_sh = 1."""
    panels = [stable(bodies(_K1, _K3, r, -1.0), 1.0) for r in _RELATIVE]
    bottom = np.broadcast_to(_K3 < 0, panels[0].shape)
    shares = [float(panel[bottom].mean()) for panel in panels]
    right, left = (
        [float(panel[bottom & side].mean()) for panel in panels] for side in (_K1 > 0, _K1 < 0)
    )
    real = [
        float(panel[bottom & _possible(r)].mean())
        for panel, r in zip(panels, _RELATIVE, strict=True)
    ]
    grows = bool(np.all(np.diff(shares) >= 0))
    claims = (
        statement(
            "fig4-19.grows",
            "§4.4.2, Figure 4-19",
            "the larger I_rel, the easier it is to stabilise the bottom two quadrants",
            "stabilisation gets easier with larger arms",
            ", ".join(f"{100 * s:.0f}" for s in shares)
            + " % for I_rel = "
            + ", ".join(f"{r:g}" for r in _RELATIVE),
            grows and shares[-1] > shares[0],
            "Never falls from one I_rel to the next. Counting only bodies that can carry such an "
            f"arm: {'the same' if np.all(np.diff(real) >= 0) else 'not so'}.",
        ),
        statement(
            "fig4-19.fourth",
            "Figure 4-19",
            "so it is in the fourth quadrant (k1 > 0, k3 < 0), that of the layout somersault",
            "easier with larger arms",
            ", ".join(f"{100 * s:.0f}" for s in right) + " %",
            bool(np.all(np.diff(right) >= 0)),
        ),
    )
    rows = tuple(
        (f"{r:g}", f"{100 * s:.1f} %", f"{100 * a:.1f} %", f"{100 * b:.1f} %")
        for r, s, a, b in zip(_RELATIVE, shares, right, left, strict=True)
    )
    return Result(
        "Stable bodies in the k1–k3 square for nine sizes of arm, kl1 = −1, K_sh = 1.0: the larger "
        "I_rel, the easier it is to stabilise the bottom two quadrants.",
        f"The stable share of the bottom two quadrants grows from {100 * shares[0]:.0f} to "
        f"{100 * shares[-1]:.0f} %, never falling. On its own, the third quadrant (k1, k3 < 0), "
        f"where a "
        f"rigid body needs no arm to be stable, first loses ground, from {100 * left[0]:.0f} to "
        f"{100 * min(left):.0f} %: at K_sh = −kl1 nothing but the body's turning holds a "
        f"small arm. "
        "Hatching marks bodies that could not carry so large an arm.",
        claims,
        _draw(panels, [f"$I_{{rel}}$ = {r:g}" for r in _RELATIVE], shares, None),
        Table(("I_rel", "both bottom quadrants", "fourth", "third"), rows),
    )


def _draw(
    panels: Sequence[Array], names: Sequence[str], shares: Sequence[float], relative: float | None
) -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(8.2, 8.8)
    grid = picture.subplots(3, 3, sharex=True, sharey=True)
    for i, (ax, panel, name, share) in enumerate(
        zip(grid.flat, panels, names, shares, strict=True)
    ):
        charts.square(ax, name)
        charts.filled(ax, _RATIOS, _RATIOS, panel, alpha=0.7)
        ax.contourf(
            _RATIOS,
            _RATIOS,
            (~_possible(relative if relative is not None else _RELATIVE[i])).astype(float),
            levels=[0.5, 1.5],
            colors="none",
            hatches=["////"],
            zorder=2,
        )
        where = (0.5, -0.5) if relative is not None else (0.0, -0.5)
        words = f"{100 * share:.0f} %"
        look.label(ax, *where, words, fontsize=12, ha="center")
        if i >= 6:
            ax.set_xlabel("$k_1$")
        if i % 3 == 0:
            ax.set_ylabel("$k_3$")
    which = "quadrant 4 (lower right)" if relative is not None else "the lower half"
    picture.suptitle(
        f"Blue: stable. Number: share of {which}. Hatched: no such body could carry the arm.",
        fontsize=10,
    )
    return picture
