"""Why compliance lands better: what a small tilt or twist at takeoff does to the landing."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.flight import Takeoff, fly, off_nominal
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch6 import _rudi as rudi
from somersault.thesis.ch6._rudi_maps import best

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_POINTS = 7  # a side
_WRAPPED = 0.08  # s before and after the fastest twist in which the arms are wrapped
_FREQUENCIES = (20.0, 22.0, 24.0, 26.0, 28.0, 30.0, 33.0, 37.0, 45.0, 60.0, 100.0, 200.0)
_GROUPS = {
    "shoulders": ("shoulder_abduction", "shoulder_rotation", "shoulder_flexion"),
    "elbows": ("elbow",),
    "hips": ("hip_flexion", "hip_abduction"),
    "torso": ("torso_twist",),
}


def only(groups: tuple[str, ...], frequency: float) -> Takeoff:
    """Compliant in the joints of some groups, all others prescribed."""
    parts = tuple(part for group in groups for part in _GROUPS[group])
    soft = rudi.strategy(frequency)
    joints = {
        name: joint if name.endswith(parts) else joint.nominal()
        for name, joint in soft.joints.items()
    }
    return replace(soft, joints=joints)


@cache
def _shares() -> dict[str, tuple[float, float]]:
    """Share of small errors with one group of joints compliant alone, and with all others."""
    shares = {}
    for group in _GROUPS:
        others = tuple(name for name in _GROUPS if name != group)
        alone, without = (rudi.landings(only(g, best()), _POINTS) for g in ((group,), others))
        shares[group] = (alone.share, without.share)
    return shares


@cache
def _sensitivities() -> Array:
    """d(landing) / d(takeoff) at each frequency, (frequencies, 3, 2)."""
    return np.array([rudi.sensitivity(f) for f in _FREQUENCIES])


@cache
def _opening() -> Array:
    """From a tilt of +0.1 and −0.1 rad: turns twisted by a prescribed body, and how far the arms
    are opened by a compliant one, rad, on average while they are wrapped; (2, 2)."""
    rows = []
    middle = rudi.twist_rate()[1]
    for tilt in (rudi.SPAN, -rudi.SPAN):
        flown = [
            fly(
                rudi.MODEL,
                off_nominal(rudi.MODEL, rudi.strategy(f), tilt=tilt),
                rudi.landing_time(),
                accuracy=1e-7,
            )
            for f in (None, best())
        ]
        wrapped = np.abs(flown[1].times - middle) < _WRAPPED
        stiff, soft = (
            f.dataset["joint_angle"].sel(
                joint=[f"{s}_shoulder_abduction" for s in ("left", "right")]
            )
            for f in flown
        )
        opened = float((soft - stiff).values[wrapped].mean())
        rows.append((abs(flown[0].landing.twist) / (2 * np.pi), opened))
    return np.array(rows)


def landing_sensitivity() -> Result:
    """Sensitivities against the natural frequency, and which joints matter for them."""
    slopes, stiff = _sensitivities(), rudi.sensitivity(None)
    twist = slopes[:, 2]
    sizes = np.linalg.norm(slopes, axis=(1, 2))
    least = _FREQUENCIES[int(np.argmin(sizes))]
    crossing = [_crossing(twist[:, k]) for k in range(2)]
    shares = _shares()
    whole = rudi.error_map(best(), points=_POINTS).share
    none = rudi.error_map(None, points=_POINTS).share
    opened = _opening()
    fast = int(np.argmax(opened[:, 0]))
    missed = min(shares, key=lambda group: shares[group][1])
    claims = (
        statement(
            "why.zero", "§6.3.3", "with falling ω_n the final twist's dependence on tilt and on "
            "twist at takeoff passes through zero near the best ω_n", "(not in the thesis)",
            f"through zero at {_words(crossing[0])} (tilt) and {_words(crossing[1])} (twist); best "
            f"{best():g} rad/s",
            all(c is not None and abs(np.log(c / best())) < np.log(1.6) for c in crossing),
        ),
        statement(
            "why.arms", "§6.3.3", "the compliance that allowed the arms to open prematurely was "
            "important in off-nominal simulations", "important",
            f"with all but the shoulders compliant {100 * shares['shoulders'][1]:.0f} % land below "
            "0.1, with all "
            f"joints {100 * whole:.0f} %, with none {100 * none:.0f} %",
            missed == "shoulders" and shares["shoulders"][1] < whole / 2,
            "Holds when the shoulders are missed most and more than half is lost without them.",
        ),
        statement(
            "why.opens", "§6.3.3", "compliance lets the arms open and so increases the inertia "
            "about the twist axis, where the body twists too fast", "arms open",
            f"from ±0.1 rad of tilt, prescribed, {opened[fast, 0]:.2f} and "
            f"{opened[1 - fast, 0]:.2f} twists; compliant arms in the wrap "
            f"{np.degrees(opened[fast, 1]):+.1f}° and {np.degrees(opened[1 - fast, 1]):+.1f}° from "
            "their path",
            opened[fast, 1] > 0 > opened[1 - fast, 1],
            "Mean abduction of both shoulders within 0.08 s of the fastest twist. Holds when they "
            "open in the start that twists too much, and close in the other.",
        ),
    )  # fmt: skip
    return Result(
        "Why the compliant body lands more reliably. The thesis supposes that "
        "the arms' giving way matters.",
        "Prescribed, 0.1 rad of tilt at takeoff changes the twist at landing by "
        f"{abs(stiff[2, 0]) / 10:.1f} rad: more tilt twists faster all the way. A faster twist "
        "pulls soft arms outward, the inertia about the twist axis grows and the twist slows down, "
        "as with the balls of a governor. Arms that are too stiff do nothing; arms that are too "
        "soft overcorrect, and the effect changes sign. In between lies a natural frequency at "
        "which the "
        f"first-order effect is least, {least:g} rad/s, and the map's best is {best():g}. The "
        "motor tape does the nominal work, so that springs answer nothing but deviations. The "
        "table shows each group of joints compliant alone, and all the others without it.",
        claims,
        _draw(slopes),
        Table(
            ("joints", "compliant alone: below 0.1", "all others compliant"),
            (
                *((g, *(f"{100 * s:.0f} %" for s in pair)) for g, pair in shares.items()),
                ("all", f"{100 * whole:.0f} %", f"{100 * none:.0f} %"),
            ),
        ),
    )


def _crossing(values: Array) -> float | None:
    """The highest frequency at which values over the frequencies change sign."""
    signs = np.flatnonzero(values[:-1] * values[1:] < 0)
    if not signs.size:
        return None
    k = int(signs[-1])
    low, high = np.log(_FREQUENCIES[k]), np.log(_FREQUENCIES[k + 1])
    return float(np.exp(low + (high - low) * values[k] / (values[k] - values[k + 1])))


def _words(crossing: float | None) -> str:
    return "no ω_n" if crossing is None else f"{crossing:.0f} rad/s"


def _draw(slopes: Array) -> Figure:
    from somersault.view import style as look

    picture = look.figure(8.4, 3.9)
    grid = picture.subplots(1, 2, sharey=True)
    for ax, k, name in zip(grid, (0, 1), ("tilt", "twist"), strict=True):
        for row, (what, color) in enumerate(
            (("somersault", look.GREY), ("tilt", look.GREEN), ("twist", look.BLUE))
        ):
            ax.plot(_FREQUENCIES, slopes[:, row, k], "o-", ms=3, color=color, label=f"final {what}")
        ax.axhline(0, color=look.BLACK, lw=0.8)
        ax.axvline(best(), color=look.VERMILION, lw=1.0, ls="--")
        ax.set(xscale="log", xlabel="ω_n (rad/s)", title=f"by {name} at takeoff (rad/rad)")
        ax.set_xticks([20, 30, 45, 60, 100, 200], ["20", "30", "45", "60", "100", "200"])
        ax.minorticks_off()
        if not k:
            ax.legend(frameon=False, fontsize=8)
    return picture
