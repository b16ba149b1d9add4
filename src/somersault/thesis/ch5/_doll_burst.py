"""The doll's resonance near K_sh = 0.98, from its linear modes, and how soon it ends a flight."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._columns import Column, column, edges
from somersault.thesis.ch4._two_to_one import TwoToOne, two_to_one
from somersault.thesis.ch5._doll import WEIGHTED
from somersault.thesis.ch5._launcher import ARMS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TILTS = (0.001, 0.002, 0.005)  # rad
LEANT = (0.0003, 0.001, 0.003, 0.01, 0.03)  # rad, at exact resonance
_REACH, _STEP = 0.03, 0.0005  # of K_sh about the resonance
_MOST = 1500  # turns
_FOUND = 0.98  # where flights of launches with scatter had the gap
_WHERE = "§5.5, beyond"


def _exact() -> TwoToOne:
    return two_to_one(WEIGHTED, ARMS)


@cache
def near() -> Column:
    """Flights with springs about the resonance."""
    at = _exact().stiffness
    return column(WEIGHTED, ARMS, TILTS, _STEP, _MOST, (at - _REACH, at + _REACH))


@cache
def bursts() -> tuple[Array, Array]:
    """Turns until a quarter twist at exact resonance: flown from each tilt, and predicted."""
    exact = _exact()
    here = (exact.stiffness - _STEP / 2, exact.stiffness + _STEP / 2)
    flown = column(WEIGHTED, ARMS, LEANT, _STEP, _MOST, here).turns[0]
    sizes = exact.burst.amplitude(tilt=LEANT)
    return flown, np.array([exact.burst.turns(float(size)) for size in sizes])


def doll_burst() -> Result:
    """Where, how wide, and how soon."""
    exact, (flown, predicted) = _exact(), bursts()
    slow, fast = sorted(m.root.imag for m in exact.spin.resonances(order=3)[0].modes)
    low, high = edges(WEIGHTED, ARMS)
    return Result(
        "Nothing: the flights of the doll with no ceiling showed a gap near K_sh = 0.98.",
        f"The doll's linear modes alone have the symmetric arms ({fast:.4f} Ω, positive energy) "
        f"exactly twice as fast as the slow wobble ({slow:.4f} Ω, negative energy) at K_sh = "
        f"{exact.stiffness:.4f}, far from the edges of its region ({low:.2f} to {high:.2f}). Modes "
        "of opposite energy grow together: any wobble, however small, ends in a twist. The "
        "quadratic terms of the equations say when: a wobble of a rad within "
        f"1/(4 · {exact.burst.strength:.3f} a) turns. Nothing was fitted.",
        tuple(_claims()),
        _draw(),
        Table(
            ("tilt (rad)", "wobble (rad)", "turns, predicted", "turns, flown"),
            tuple(
                (f"{tilt:g}", f"{size:.4f}", f"{p:.1f}", f"{f:.1f}")
                for tilt, size, p, f in zip(
                    LEANT, exact.burst.amplitude(tilt=LEANT), predicted, flown, strict=True
                )
            ),
        ),
    )


def _claims() -> list[Claim]:
    exact, (flown, predicted) = _exact(), bursts()
    gaps = [near().notches(k) for k in range(len(TILTS))]
    (first,) = gaps[0] or [(np.nan, np.nan)]
    bands = [exact.band(float(exact.burst.amplitude(tilt=tilt))) for tilt in TILTS]
    small = np.array(LEANT) < 0.02
    off = abs(flown / predicted - 1)
    return [
        number(
            "ch5-resonance.place", _WHERE, "K_sh of the gap that flights show, from the ratio of "
            "the linear modes alone", _FOUND, exact.stiffness, "1", 0.005,
            "Ours on both sides: first flown, then predicted.",
        ),
        number(
            "ch5-resonance.middle", _WHERE, f"middle of the gap from a tilt of {TILTS[0]:g} rad",
            exact.stiffness, sum(first) / 2, "1", 0.001,
            "The first number is the linear modes', the second that of flights.",
        ),
        statement(
            "ch5-resonance.width", _WHERE, "how wide the gap is, from the quadratic terms",
            "; ".join(f"{a:.4f} to {b:.4f}" for a, b in bands),
            "; ".join(", ".join(f"{a:.4f} to {b:.4f}" for a, b in g) for g in gaps),
            abs(first[0] - bands[0][0]) < 0.001 and abs(first[1] - bands[0][1]) < 0.001,
            f"From tilts of {', '.join(f'{t:g}' for t in TILTS)} rad. Holds if both ends are "
            f"within 0.001 at {TILTS[0]:g} rad; frequencies change with size, which shifts larger "
            "ones.",
        ),
        statement(
            "ch5-resonance.when", _WHERE, "how many turns the doll does at exact resonance, from "
            "the quadratic terms", ", ".join(f"{p:.1f}" for p in predicted),
            ", ".join(f"{f:.1f}" for f in flown), bool(off[small].max() < 0.1),
            f"From tilts of {', '.join(f'{t:g}' for t in LEANT)} rad. Holds if all but the largest "
            f"are within 10 %; they are within {100 * off[small].max():.0f} %.",
        ),
    ]  # fmt: skip


def _draw() -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.2, 4.0)
    left, right = picture.subplots(1, 2)
    exact = _exact()
    colors = (look.BLUE, look.GREEN, look.VERMILION)
    for k, (tilt, color) in enumerate(zip(TILTS, colors, strict=True)):
        left.plot(near().stiffness, near().turns[:, k], color=color, label=f"{tilt:g} rad")
        band = exact.band(float(exact.burst.amplitude(tilt=tilt)))
        left.plot(band, [_MOST * 1.4 * 1.35**k] * 2, color=color, lw=4, solid_capstyle="butt")
    left.axvline(exact.stiffness, color=look.GREY, lw=0.8, ls=":")
    left.set(yscale="log", ylim=(10, 6 * _MOST), xlabel="shoulder stiffness $K_{sh}$")
    left.set_ylabel(f"turns until a quarter twist (at most {_MOST})")
    left.set_title("Bars: where a wobble should burst")
    left.legend(title="tilt", loc="lower left", fontsize=8)
    flown, _ = bursts()
    sizes = np.geomspace(2e-4, 0.2, 50)
    right.plot(sizes, [exact.burst.turns(float(a)) for a in sizes], color=look.GREY)
    right.plot(exact.burst.amplitude(tilt=LEANT), flown, "o", color=look.BLUE)
    right.set(
        xscale="log", yscale="log", xlabel="wobble (rad)", ylabel="turns until a quarter twist"
    )
    right.set_title("At exact resonance")
    look.label(right, 0.004, 400, "from the quadratic terms", look.GREY)
    look.label(right, 0.004, 40, "flown", look.BLUE)
    return picture
