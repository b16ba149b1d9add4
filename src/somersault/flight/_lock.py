"""Where joints have come into line: gimbal lock, at which no integration gets on."""

from __future__ import annotations

import numpy as np

from somersault.flight._flight import Flight

_IN_LINE = 1e-3  # of a mass matrix with a unit diagonal: hinges 0.3 rad apart have 0.05
_TAKES_PART = 0.1  # of the direction that has no inertia left


def aligned(flight: Flight) -> tuple[str, ...]:
    """Freely moving joints that turn the same bodies about one line as the flight ends; () if none.

    Then some motion of them together has no inertia, and no torque of theirs can be borne.
    """
    model = flight.system.model
    free = [
        place
        for slot in flight.system.layout.slots
        if slot.kind.in_state
        for place in range(*model.speed_slice(slot.joint.name).indices(len(model.speeds)))
    ]
    if len(free) < 2:
        return ()
    last = np.asarray(list(flight.landing.joints.values()))
    whole = flight.system.equations.mass_matrix(last)[6:, 6:]
    own = whole[np.ix_(free, free)]
    size = np.sqrt(np.diag(own))
    if not np.all(size > 0):
        return ()
    values, vectors = np.linalg.eigh(own / np.outer(size, size))
    if values[0] > _IN_LINE:
        return ()
    return tuple(
        model.speeds[place]
        for place, part in zip(free, vectors[:, 0], strict=True)
        if abs(part) > _TAKES_PART
    )
