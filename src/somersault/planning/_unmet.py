"""Why no start came to a plan, in words."""

from __future__ import annotations

import numpy as np

from somersault.planning._ipopt import Outcome
from somersault.planning._transcription import Transcription


def reason(grid: Transcription, outcome: Outcome) -> str:
    """What the best of the starts that failed could not keep to.

    Parameters
    ----------
    grid : Transcription
        The program that it was to solve.
    outcome : Outcome
        The start's.
    """
    program, x = grid.program, outcome.x
    values = program.constraints(x, program.outputs(x))
    missed = np.maximum(program.low - values, values - program.high)
    missed = np.where(np.isfinite(missed), missed, 0.0)
    worst = int(np.argmax(missed))
    rows = next(rows for rows in grid.rows if worst in rows.places)
    what = rows.what
    if rows.names:
        what = f"{what} of {rows.names[(worst - rows.places.start) % len(rows.names)]}"
    return (
        f"{_BLAMED.get(rows.what, what)} cannot be kept to; give more torque, a longer flight, "
        "wider ranges or a wider landing, or more starts"
    )


_BLAMED = {
    "attitude": "what is asked of takeoff and landing",
    "joints' paths": "where the joints are to be",
}
