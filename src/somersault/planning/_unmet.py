"""Why no start came to a plan, in words."""

from __future__ import annotations

import numpy as np

from somersault.planning._ipopt import Outcome
from somersault.planning._transcription import Transcription

_WORDS = {
    "joint": "where joints are to be",
    "attitude": "the {} from takeoff to landing",
    "torque": "the bounds of torque of {}",
    "range": "the range of {}",
    "fastest": "the greatest rate of {}",
    "takeoff": "the {} at takeoff",
    "momentum": "the angular momentum along axis {}",
}


def reason(grid: Transcription, outcome: Outcome) -> str:
    """What the nearest of the starts that failed could not keep to.

    Parameters
    ----------
    grid : Transcription
        The program that it was to solve.
    outcome : Outcome
        The start's.
    """
    worst = int(np.argmax(grid.program.missed(outcome.x)))
    rows = next(rows for rows in grid.rows if worst in rows.places)
    name = rows.names[(worst - rows.places.start) % len(rows.names)] if rows.names else ""
    return (
        f"the nearest misses {_WORDS[rows.what].format(name)}; give more torque, more time, wider "
        "ranges, a wider landing, or more starts"
    )
