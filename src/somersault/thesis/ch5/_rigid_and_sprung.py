"""Figure 5-6: the doll with its arms clamped, and with springs."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault.flight import Flight, JointTakeoff, fly
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result
from somersault.thesis._motion import Motion
from somersault.thesis.ch5._doll import BEST, WEIGHTED, shoulder_inertia
from somersault.thesis.ch5._launcher import ARMS, SPIN, launch, takeoff
from somersault.thesis.ch5._simulated_launches import SCATTER

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WHERE = "§5.4, Figure 5-6"
_QUARTER = np.pi / 2
_POSES = 11  # that are drawn of each


@cache
def flown(clamped: bool) -> Flight:
    """From the release to the catch, tilted by as much as launches scatter."""
    if clamped:
        arms = JointTakeoff("locked", angle=ARMS)
    else:
        k = BEST * SPIN**2 * shoulder_inertia(WEIGHTED)
        arms = JointTakeoff("sprung", angle=ARMS, stiffness=k, hold=True)
    start = replace(takeoff({"shoulder": arms}), tilt=SCATTER.attitude)
    return fly(WEIGHTED, start, launch().time(), samples=801)


def fig_5_6() -> Result:
    """One launch of each."""
    rigid, soft = flown(True), flown(False)
    turns = (soft.landing.somersault - soft.angles[0, 0]) / (2 * np.pi)
    twisted, most = _until_quarter(rigid), float(np.abs(soft.angles[:, 2]).max())
    swing = np.ptp(soft.joint_coordinates[:, 0])
    claims = (
        statement(
            "fig5-6.rigid", _WHERE, "the rigid doll with arms clamped exhibits the twist "
            "instability", "twists", "a quarter twist "
            + ("never" if twisted is None else f"after {twisted:.2f} somersaults"),
            twisted is not None and twisted < turns,
        ),
        statement(
            "fig5-6.passive", _WHERE, "the doll with flexible arms performs a stable layout "
            "somersault", "stable", f"twist within {np.degrees(most):.0f}° in {turns:.2f} "
            f"somersaults, its arms move by {np.degrees(swing):.0f}°", most < _QUARTER,
        ),
    )  # fmt: skip
    return Result(
        "Two photographs: the doll with its arms clamped, which exhibits the twist instability, "
        "and with flexible arms, which performs a stable layout somersault.",
        f"One launch of each, tilted by {SCATTER.attitude:g} rad at the release, as much as "
        "launches scatter (see ch5-scatter); the springs are the experiment's best, K_sh = "
        f"{BEST}.",
        claims,
        _draw(rigid, soft),
        motion=Motion({"arms clamped": rigid, "arms on springs": soft}, 0.3),
    )  # fmt: skip


def _until_quarter(flight: Flight) -> float | None:
    """Somersaults from the release to a quarter twist; None where there is none."""
    twist = np.abs(flight.angles[:, 2])
    if twist.max() < _QUARTER:
        return None
    first = int(np.argmax(twist >= _QUARTER))
    return float((flight.angles[first, 0] - flight.angles[0, 0]) / (2 * np.pi))


def _draw(rigid: Flight, soft: Flight) -> Figure:
    from somersault.view import strip
    from somersault.view import style as look

    picture = look.figure(8.2, 5.4)
    above, below, chart = picture.subplots(3, 1, height_ratios=(1, 1, 1.7))
    times = np.linspace(0, rigid.times[-1], _POSES)
    for ax, flight, name in ((above, rigid, "arms clamped"), (below, soft, "arms on springs")):
        strip(ax, flight, times, words=False)
        ax.set_title(f"{name}, every {times[1]:.2f} s")
    for flight, color, name in (
        (rigid, look.VERMILION, "arms clamped"), (soft, look.BLUE, "arms on springs")
    ):  # fmt: skip
        turns = (flight.angles[:, 0] - flight.angles[0, 0]) / (2 * np.pi)
        twist = np.degrees(flight.angles[:, 2])
        chart.plot(turns, twist, color=color, label=name)
    for side in (-90, 90):
        chart.axhline(side, color=look.GREY, lw=0.6, ls=":")
    chart.set(xlabel="somersaults from the release", ylabel="twist (°)")
    chart.legend(frameon=False)
    return picture
