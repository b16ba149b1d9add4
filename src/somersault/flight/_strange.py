"""What is strange in a flight that has been flown, said in notes."""

from __future__ import annotations

from math import pi

import numpy as np

from somersault._core.notes import listed, note
from somersault.flight._broken import BROKEN, why_broken
from somersault.flight._flight import Flight
from somersault.flight._layout import Slot

BROKE_OFF = "the flight broke off"
_FAR = pi  # rad beyond a limit: what no limb does


def note_strange(flight: Flight) -> None:
    """Note why a flight broke off, or joints that went far beyond their limits.

    Limits exert no force, and passive joints pass them in many flights. Far is half a turn; of a
    slide, as far beyond the limit as the limits are apart.

    Parameters
    ----------
    flight : Flight
    """
    if flight.ended in BROKEN:
        note(f"{BROKE_OFF} at {flight.landing.time:g} s: {why_broken(flight)}")
        return
    beyond = [said for slot in flight.system.layout.slots if (said := _beyond(flight, slot))]
    if beyond:
        note(
            f"joints went far beyond their limits: {listed(beyond)}; limits exert no force unless "
            "the joint is given a stop_stiffness"
        )


def _beyond(flight: Flight, slot: Slot) -> str:
    """Where a joint was farthest beyond its limits, in words; nothing if that was not far."""
    joint = slot.joint
    if joint.limits is None or not slot.q:
        return ""
    low, high = joint.limits
    angles = flight.states[:, slot.q.start]
    beyond = np.maximum(low - angles, angles - high)
    worst = int(np.argmax(beyond))
    slide = joint.kind == "slide"
    if beyond[worst] <= (high - low if slide else _FAR):
        return ""
    return (
        f"{joint.name} to {angles[worst]:.4g} {'m' if slide else 'rad'} at "
        f"{flight.times[worst]:.4g} s (limits {low:g} to {high:g})"
    )
