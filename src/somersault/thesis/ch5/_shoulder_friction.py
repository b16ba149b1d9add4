"""What friction in the doll's shoulders does, given that damping destabilises."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import ANGLE, DAMPING, STIFFNESS
from somersault.thesis.ch5 import _simulated_launches as experiment
from somersault.thesis.ch5._doll import BEST, WEIGHTED, shoulder_inertia
from somersault.thesis.ch5._launcher import ARMS, SOMERSAULTS, SPIN
from somersault.thesis.ch5._no_ceiling import MOST, scaled
from somersault.thesis.ch5._pulleys import OMITTED
from somersault.thesis.ch5._simulated_launches import SCATTER, Outcome

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DAMPINGS = (0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)  # b/(Ω I_sh)
SPRINGS = (BEST, OMITTED)
# A small ball bearing's friction, taken as viscous: 1e-4 N m at an arm's 1 rad/s (ours).
BEARING = 1e-4
_SCATTER = 0.25  # of the laboratory's, to see friction rather than scatter
_DRAWN = 256


def bearing() -> float:
    """A good ball bearing's b/(Ω I_sh)."""
    return BEARING / (SPIN * shoulder_inertia(WEIGHTED))


@cache
def growth() -> Array:
    """Growth rates in units of Ω, (springs, dampings)."""
    return st.growth_rates(
        WEIGHTED,
        {ANGLE: ARMS, STIFFNESS: np.array(SPRINGS)[:, None], DAMPING: np.array(DAMPINGS)},
    )


@cache
def lasting(damping: float) -> Outcome:
    """Launches with little scatter, for thirty somersaults' time."""
    return experiment.sprung(
        SPRINGS, scaled(_SCATTER), _DRAWN, duration=MOST * 2 * np.pi / SPIN, damping=damping,
        sequence="sobol",
    )  # fmt: skip


@cache
def caught(damping: float) -> Array:
    """Share of stable launches in the laboratory, by spring."""
    return experiment.sprung(SPRINGS, SCATTER, 2 * _DRAWN, damping=damping, sequence="sobol").share


_SAID = "a quarter of the scatter, thirty turns' time"


def shoulder_friction() -> Result:
    """Growth rates, lifetimes, and what the laboratory would have seen."""
    rates = growth()
    rows = [
        (
            f"{b:g}", *(f"{2 * np.pi * rate:.3f}" for rate in rates[:, k]),
            *(f"{x:.1f}" for x in np.median(lasting(b).somersaults, 1)),
            *(f"{100 * x:.0f} %" for x in caught(b)),
        )
        for k, b in enumerate(DAMPINGS)
    ]  # fmt: skip
    return Result(
        "The doll's arms turn on ball bearings that allow free shoulder rotation (§5.2.1); damping "
        "tends to destabilise gyrically stabilised systems (§4.3.1).",
        f"Any damper makes the spin unstable, slowly: with a good bearing's friction "
        f"(b/(Ω I_sh) ≈ {bearing():.2f}, ours) the wobble grows by "
        f"{100 * np.expm1(2 * np.pi * _rate(0, bearing())):.0f} % in a somersault. Under the "
        "laboratory's ceiling this cannot be seen; with no ceiling the doll would end its layout "
        "after "
        "some tens of somersaults, or a hundred from a quarter of the scatter.",
        tuple(_claims()),
        _draw(),
        Table(
            ("b/(Ω I_sh)", *(f"growth rate a somersault, K_sh = {k:.2f}" for k in SPRINGS),
             *(f"median somersaults, {k:.2f}; {_SAID}" for k in SPRINGS),
             *(f"stable to the catch, {k:.2f}" for k in SPRINGS)),
            tuple(rows),
        ),
    )  # fmt: skip


def _rate(spring: int, damping: float) -> float:
    return float(np.interp(damping, DAMPINGS, growth()[spring]))


def _claims() -> list[Claim]:
    rates = growth()
    seen = [caught(b)[0] for b in DAMPINGS]
    near = int(np.searchsorted(DAMPINGS, bearing()))
    medians = np.array([np.median(lasting(b).somersaults, 1) for b in DAMPINGS])
    # e-foldings that a wobble has in the somersaults it lasted, where it did not last them all.
    gone = medians < 0.97 * MOST
    folds = (2 * np.pi * rates.T * medians)[gone]
    strong = caught(DAMPINGS[-1])
    return [
        statement(
            "ch5-friction.destabilises", "§4.3.1", "damping destabilises the doll's gyrically "
            "stabilised layout, however little", "destabilises",
            f"growth rates of {rates[:, 1].min():.4f} Ω or more with b/(Ω I_sh) = "
            f"{DAMPINGS[1]:g}, {rates[:, 0].max():.0e} Ω without",
            bool(rates[:, 1:].min() > 1e-4 and rates[:, 0].max() < 1e-6),
        ),
        statement(
            "ch5-friction.bearings", "§5.2.1", "ball bearings allow free enough rotation: their "
            "friction is not seen in the laboratory", "free",
            f"{100 * seen[near]:.0f} % stable with b/(Ω I_sh) = {DAMPINGS[near]:g}, "
            f"{100 * seen[0]:.0f} % without", abs(seen[near] - seen[0]) < 0.05,
            f"A bearing has about {bearing():.3f}. Holds within 5 %.",
        ),
        statement(
            "ch5-friction.slow", "§4.3.1", "lifetimes follow the growth rates", "growth",
            f"flights last for {folds.min():.1f} to {folds.max():.1f} growth times of their "
            "wobble, at dampings whose growth rates differ "
            f"{(rates.T[gone].max() / rates.T[gone].min()):.0f} times",
            folds.max() / folds.min() < 0.5 * rates.T[gone].max() / rates.T[gone].min(),
            "Holds when the growth times differ by less than half as much as the rates.",
        ),
        statement(
            "ch5-friction.strong", "§4.3.1", "strong friction would spoil the layout under the "
            "ceiling too", "spoils",
            f"b/(Ω I_sh) = {DAMPINGS[-1]:g}: {100 * strong[0]:.0f} % stable to the catch, "
            f"{100 * seen[0]:.0f} % without", strong[0] < 0.8 * seen[0],
        ),
    ]  # fmt: skip


def _draw() -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.2, 4.0)
    left, right = picture.subplots(1, 2)
    at = np.arange(len(DAMPINGS))
    rates = 2 * np.pi * growth()
    styles = ((look.VERMILION, "o-"), (look.BLUE, "s-"))
    for k, (spring, (color, line)) in enumerate(zip(SPRINGS, styles, strict=True)):
        left.plot(at, rates[k], line, color=color, ms=5)
        middle = [float(np.median(lasting(b).somersaults[k])) for b in DAMPINGS]
        right.plot(at, middle, line, color=color, ms=5, label=f"$K_{{sh}}$ = {spring:.2f}")
    for ax in (left, right):
        ax.set_xticks(at, [f"{b:g}" for b in DAMPINGS])
        ax.set_xlabel("damper at each shoulder, b/(Ω $I_{sh}$)")
    left.set(ylabel="growth rate of the wobble, per somersault", title="By the linear theory")
    left.set_ylim(bottom=0)
    right.set(ylim=(0, 33), ylabel="median somersaults until a quarter twist")
    right.set_title("In flight, a quarter of the scatter")
    right.axhline(SOMERSAULTS, color=look.GREY, lw=0.8, ls="--")
    look.label(right, 0.0, SOMERSAULTS + 1.2, "the laboratory's catch", look.GREY)
    right.legend(loc="upper right", frameon=False)
    return picture
