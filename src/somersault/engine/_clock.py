"""A clock that goes faster and slower than time, with a constant acceleration between ticks.

It stands in four numbers (`CLOCK`) that are carried from tick to tick: since when, and what it
showed then, at which rate and with which acceleration. Its rate is above 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

CLOCK = 4


def clock_at(clock: Sequence[Any], time: Any) -> tuple[Any, Any, Any]:
    """What a clock shows at a time, and its rate and acceleration.

    Parameters
    ----------
    clock : sequence, (4,)
        Numbers, arrays or symbols.
    time : number, array or symbol
        s, before the next tick.

    Returns
    -------
    shown, rate, acceleration
        Of the kind that the clock and the time are.
    """
    since, shown, rate, acceleration = clock
    by = time - since
    return shown + (rate + acceleration * by / 2) * by, rate + acceleration * by, acceleration


def time_of(flow: Any, root: Any, clock: Sequence[Any], shows: Any) -> Any:
    """When a clock shows something, in compiled code; no number where it never does as it goes now.

    `flow` writes the code, and `root` is the square root. The form of the solution is the one
    without a difference of like numbers.
    """
    since, shown, rate, acceleration = clock
    left = flow.fsub(shows, shown)
    twice = flow.fadd(left, left)
    squared = flow.fadd(flow.fmul(rate, rate), flow.fmul(acceleration, twice))
    return flow.fadd(since, flow.fdiv(twice, flow.fadd(rate, flow.call(root, [squared]))))
