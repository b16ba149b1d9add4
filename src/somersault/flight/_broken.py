"""Why a flight broke off."""

from __future__ import annotations

import numpy as np

from somersault._core.checks import instance
from somersault._core.notes import listed
from somersault.flight._flight import Flight
from somersault.flight._lock import aligned
from somersault.flight.behaviours import Sprung

BROKEN = ("too many steps", "not finite")
_AROUND = 2 * np.pi  # rad or m from rest: a joint that a negative spring has driven away
_AWAY = 1e3  # rad or m: a joint that anything has


def why_broken(flight: Flight) -> str:
    """Why a flight broke off, and what to do about it.

    Parameters
    ----------
    flight : Flight
        That ended with one of `BROKEN`.

    Returns
    -------
    str
        In a sentence.
    """
    if away := _ran_away(instance("flight", flight, Flight)):
        return away
    if flight.ended == "not finite":
        return f"its motion is no longer finite; {_not_finite(flight)}"
    given_up = f"it had taken {flight.steps} steps of the integration"
    if joints := aligned(flight):
        return (
            f"{given_up}, and {' and '.join(joints)} have come into line there (gimbal lock), "
            "which no step gets past; make them stiffer, or take the gains in another pose"
        )
    return (
        f"{given_up}; a spring or damper is too stiff, or the accuracy too fine: make them "
        "softer or coarser, or give more steps"
    )


def _not_finite(flight: Flight) -> str:
    """What may have made it so."""
    led = [plan.joint.name for plan in flight.start.plans if plan.does.sensing]
    if flight.system.layout.replay:
        led.append("the replay")
    often = "a spring, damper or move is too stiff or fast"
    if not led:
        return often
    return f"{often}, or a law ({listed(led)}) has given no number, as the root of one below 0 is"


def _ran_away(flight: Flight) -> str:
    """Which joints have gone far beyond what any does, and what drove them; nothing if none has.

    A stiff spring is fast too, but keeps its joint near.
    """
    end = flight.landing.joints
    driven, gone = [], []
    for plan in flight.start.plans:
        if plan.joint.kind == "ball":
            continue
        name, does = plan.joint.name, plan.does
        if isinstance(does, Sprung) and (does.stiffness or 0.0) < 0:
            if abs(end[name] - (does.rest or 0.0)) > _AROUND:
                driven.append(f"{name} ({does.stiffness:.4g})")
        elif abs(end[name]) > _AWAY:
            gone.append(name)
    if driven:
        return (
            "springs with negative stiffness have driven joints away, ever faster: "
            f"{listed(driven)}; give them a positive stiffness, or fly for less time"
        )
    if gone:
        return (
            f"joints have run away, beyond {_AWAY:g} rad or m: {listed(gone)}; drive them with "
            "less torque, or give them dampers"
        )
    return ""
