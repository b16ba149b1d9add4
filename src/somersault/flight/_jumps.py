"""Jumps of what acts, whose times no derivative may depend on."""

from __future__ import annotations

from collections.abc import Sequence

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.engine import CLOCK
from somersault.flight._batch import Begun
from somersault.flight._directions import Directions

_SMALL = 1e-6  # of the greatest acceleration: what a motor tape leaves out is less
_SAME = 1e-12  # s


def refuse_jumps(begun: Begun, directions: Directions, names: Sequence[str]) -> None:
    """SomersaultError where accelerations jump at a time that changes along a direction.

    At a knot at which they do not, a derivative goes on as it is, wherever the knot goes.
    """
    course, layout = begun.course, begun.batch.system.layout
    phases = course.knots[0, 1:-1]
    if not phases.size:
        return
    moved = _moved(begun, directions, phases)
    if not moved.any():
        return
    y = np.repeat(begun.rows[:, : layout.state], len(phases), 0)
    if layout.replay:
        clock = np.stack([phases, phases, np.ones_like(phases), np.zeros_like(phases)], 1)
        y[:, layout.replay.start : layout.replay.start + CLOCK] = clock
    symbols = begun.batch.system.symbols
    slope = ca.Function("slope", [symbols.x], [symbols.slope]).map(len(phases))
    still = np.repeat(course.still, len(phases), 0)
    before, after = (
        np.array(slope(np.concatenate([y, phases[:, None], course.now(at[None])[0], still], 1).T))
        for at in (course.knots[0, :-2], phases)
    )
    jumps = np.abs(after - before).max(0) > _SMALL * (1 + np.abs(before).max())
    for name, own in zip(names, moved, strict=True):
        if np.any(own & jumps):
            time = phases[np.argmax(own & jumps)]
            raise SomersaultError(
                f"what acts at the joints jumps at {time:.4g} s, which moves with {name}, so the "
                "landing has no derivative that is known here; make it smooth, or keep its time"
            )


def _moved(begun: Begun, directions: Directions, phases: Array) -> Array:
    """Which knots come at other times along which directions, (N, K)."""
    moved = np.full((len(directions.rows), len(phases)), bool(begun.batch.system.layout.replay))
    for path, (knots, _) in zip(begun.course.changing, directions.paths, strict=True):
        same = np.abs(np.ravel(path.knots)[:, None] - phases) < _SAME
        moved |= (knots != 0) @ same
    return moved
