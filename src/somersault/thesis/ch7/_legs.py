"""Leg springs that correct the rotation rate of the 3D Biped's somersault (section 7.1)."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault.designs import Choose, Design, Mean, design
from somersault.ensembles import Vary
from somersault.flight import Flights, JointTakeoff, Takeoff, flights, fly, with_momentum
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WHERE = "§7.1"
_MODEL = "biped"
_RATE, _TIME = 6.5, 0.75  # rad/s at lift-off and s in the air, about those of chapter 3's robot
_TARGET = 4.6  # rad of somersault when it lands
_SPREAD = 0.05  # of the angular momentum, standard deviation
_DRAWN_IN = -0.1  # m of the legs at lift-off
_STARTS, _HELD_OUT = 64, 512


def _takeoff(legs: JointTakeoff) -> Takeoff:
    return with_momentum(_MODEL, Takeoff(spin=_RATE, joints={"leg": legs}))


def _runs(legs: JointTakeoff) -> Flights:
    return flights(
        _MODEL, _takeoff(legs), _TIME, report=["landing_error", "somersault"],
        against={"somersault": _TARGET},
    )  # fmt: skip


@cache
def chosen(springs: bool) -> Design:
    """Legs of one length, or on springs and dampers, that land nearest."""
    locked = JointTakeoff.locked(angle=_DRAWN_IN)
    momentum = fly(_MODEL, _takeoff(locked), 0.01, samples=2).angular_momentum[0, 1]
    vary = {
        "momentum": Vary(
            adds_to="takeoff.angular_momentum.2", normal=[0.0, _SPREAD * float(momentum)]
        )
    }
    goal = Mean("landing_error", counts_as=np.pi)
    if not springs:
        choose = {
            "length": Choose((-0.15, 0.2), sets="joints.leg.angle", start=_DRAWN_IN, unit="m")
        }
        return design(
            _runs(locked), choose, vary, goal, size=_STARTS, seed=1, evaluations=60,
            held_out=_HELD_OUT,
        )  # fmt: skip
    legs = JointTakeoff.sprung(angle=_DRAWN_IN, stiffness=200.0, rest=_DRAWN_IN, damping=5.0)
    choose = {
        "stiffness": Choose(
            (20.0, 2000.0), sets="joints.leg.stiffness", start=200.0, scale="log", unit="N/m"
        ),
        "rest": Choose((-0.3, 0.2), sets="joints.leg.rest", start=_DRAWN_IN, unit="m"),
        "damping": Choose(
            (0.3, 60.0), sets="joints.leg.damping", start=5.0, scale="log", unit="N s/m"
        ),
    }
    return design(
        _runs(legs), choose, vary, goal, size=_STARTS, seed=1, evaluations=240, population=12,
        polish=True, held_out=_HELD_OUT,
    )  # fmt: skip


def leg_springs() -> Result:
    """What tuned springs do that legs of one length do not."""
    rigid, sprung = chosen(False), chosen(True)
    less = rigid.figure / sprung.figure
    claims = (
        statement(
            "sec7-1.springs", _WHERE, "tuned leg springs correct errors of the rotation rate in "
            "the air", "not tried", f"mean landing error e {sprung.figure:.3f} rad "
            f"({sprung.interval[0]:.3f} to {sprung.interval[1]:.3f}) on springs, "
            f"{rigid.figure:.3f} ({rigid.interval[0]:.3f} to {rigid.interval[1]:.3f}) with legs of "
            "one length", sprung.interval[1] < rigid.interval[0],
            f"{less:.1f} times less. Here e is half of what the somersault is off by (section "
            "6.3.2). Holds if the intervals are apart.",
        ),
    )  # fmt: skip
    best = ", ".join(
        f"{name} {value:.3g} {sprung.trial.chosen[name].unit}"
        for name, value in sprung.best.items()
    )
    return Result(
        "Leg springs could let the legs extend at higher than normal rates, and so correct errors "
        "of the rate passively. The thesis did not try it.",
        f"The 3D Biped in the air for {_TIME} s with the angular momentum of {_RATE} rad/s, "
        f"{100 * _SPREAD:.0f} % off (standard deviation), hips held, to land at {_TARGET} rad. On "
        f"springs: {best}. Soft springs with their rest drawn in far let the legs out by the spin "
        "itself: faster bodies have longer legs. The time in the air is the same in all, and no "
        "joint limits stop the legs.",
        claims,
        _draw(rigid, sprung),
        Table(
            ("legs", "mean e (rad)", "95 % confidence", "somersault off by, mean (rad)"),
            tuple(
                (
                    name,
                    f"{found.figure:.3f}",
                    f"{found.interval[0]:.3f} to {found.interval[1]:.3f}",
                    f"{2 * found.figure:.3f}",
                )
                for name, found in (("of one length", rigid), ("on springs", sprung))
            ),
        ),
    )


def _draw(rigid: Design, sprung: Design) -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.2, 3.6)
    left, right = picture.subplots(1, 2)
    for found, color, words in (
        (rigid, look.VERMILION, "legs of one length"), (sprung, look.BLUE, "on springs"),
    ):  # fmt: skip
        data = found.dataset.sel(candidate="best")
        order = np.argsort(data["momentum"].values)
        off = data["momentum"].values[order]
        error = data["landing_error"].values[order]
        left.plot(off, error, ".", ms=3, color=color, label=words)
    left.set(xlabel="angular momentum off by (kg m²/s)", ylabel="landing error e (rad)")
    left.legend(fontsize=8, frameon=False)
    around = sprung.around(steps=9, reach=0.25)
    for name, color in zip(sprung.best, (look.BLUE, look.ORANGE, look.GREEN), strict=True):
        row = around.sel(quantity=name)
        right.plot(100 * row["step"], row["figure"], "o-", ms=3, color=color, label=name)
    right.set(xlabel="off the best, % of the range", ylabel="mean e (rad)")
    right.legend(fontsize=8, frameon=False)
    return picture
