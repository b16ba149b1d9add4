"""Figure 1-4: the rudi of a compliant body, driven by torques that nobody corrects."""

from __future__ import annotations

import numpy as np

from somersault.flight import fly, landing_error, landing_target
from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result
from somersault.thesis._motion import Motion
from somersault.thesis.ch6 import _rudi as rudi

_WHERE = "ch. 1, Figure 1-4"


def fig_1_4() -> Result:
    """The motor tape of the rudi, played into joints that give way."""
    from somersault.view import contact_sheet

    takeoff = rudi.strategy(rudi.THEIRS)
    flight = fly(rudi.MODEL, takeoff, rudi.landing_time(), samples=801, accuracy=1e-8)
    end = flight.landing
    error = float(landing_error(landing_target(rudi.nominal()), landing_target(flight)))
    turns, twists = end.somersault / (2 * np.pi), abs(end.twist) / (2 * np.pi)
    soft, stiff = rudi.error_map(rudi.THEIRS), rudi.error_map(None)
    claims = (
        number(
            "fig1-4.somersault", _WHERE, "a front somersault", 1.0, turns, "turns", 0.02,
            "The motion is ours; see figure 6-1.",
        ),
        number("fig1-4.twists", _WHERE, "with one and a half twists", 1.5, twists, "turns", 0.02),
        statement(
            "fig1-4.open-loop", _WHERE, "torques recorded from the motion drive the compliant body "
            "through it", "open loop torque control",
            f"lands within e = {error:.0e} of the prescribed motion", error < 1e-3,
            "Inverse dynamics of the prescribed motion gives the torques; nothing is corrected.",
        ),
        statement(
            "fig1-4.reliable", _WHERE, "open loop torques and a compliant model led to relatively "
            "reliable performances", "relatively reliable",
            f"{100 * soft.share:.0f} % of starts within 0.1 rad of tilt and twist land with a "
            f"small error, of prescribed joints {100 * stiff.share:.0f} %",
            soft.share > 2 * stiff.share,
            "Holds when at least twice as many do; figures 6-2 and 6-3 show them.",
        ),
    )  # fmt: skip
    return Result(
        "Images of a front somersault with one and a half twists of a compliant model under open "
        "loop torque control.",
        f"Figure 6-1's motion by its torques alone, joints compliant with ω_n = {rudi.THEIRS:g} "
        "rad/s about it. From the nominal start nothing pulls the joints off their paths, so that "
        "it is the same somersault; figures 6-4 and 6-5 show what the compliance is for.",
        claims,
        contact_sheet(flight, np.linspace(0, rudi.landing_time(), 12), columns=6),
        motion=Motion({"compliant, by its motor tape": flight}, 0.3, {"charts": True}),
    )
