"""Why a flight broke off."""

from __future__ import annotations

from somersault._core.checks import instance
from somersault.flight._flight import Flight
from somersault.flight._lock import aligned

BROKEN = ("too many steps", "not finite")


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
    if instance("flight", flight, Flight).ended == "not finite":
        return "its motion is no longer finite; a spring, damper or move is too stiff or fast"
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
