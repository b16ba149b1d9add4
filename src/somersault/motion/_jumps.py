"""Angles that jump between two samples: by whole turns, which are no motion, or by anything else.

Cameras and inverse kinematics give angles between −180° and 180°, so that one that goes on beyond
starts again at the other end. What is a jump is told from the steps around it: an angle that turns
by much from every sample to the next does not jump.
"""

from __future__ import annotations

from math import degrees, pi

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.notes import note

_TURN = 2 * pi
_AROUND = 3  # steps before, and after, among which a step is an ordinary one
_OUT = 4.0  # times the median of these: as far from it is out of order
_LARGE = 2.8  # rad: no limb moves so far out of order between two samples
_SMALL = 0.5  # rad: what limbs may do, unless at more than
_FASTEST = 50.0  # rad/s
_SHOWN = 3  # times in a sentence


def without_turns(name: str, source: str, times: Array, angles: Array) -> Array:
    """A joint's angles (T,) with whole turns between two samples taken out, which warns of them."""
    steps = np.diff(angles)
    turns = np.round(steps / _TURN)
    places = np.flatnonzero(turns)
    if not places.size:
        return angles
    ordinary = _ordinary(steps - _TURN * turns)[0]
    whole = _ordinary(steps)[0]
    # Where all steps are large, a wheel's say, they are steps and not turns.
    false = np.abs(steps - whole) <= np.abs(steps - _TURN * turns - ordinary)
    turns[false] = 0.0
    places = np.flatnonzero(turns)
    if not places.size:
        return angles
    more = len(places) - _SHOWN
    shown = ", ".join(f"{times[k]:.6g} and {times[k + 1]:.6g}" for k in places[:_SHOWN])
    note(
        f"{source}: joint {name} jumps by a whole turn between {shown} s"
        + (f" and {more} times more" if more > 0 else "")
        + ", and is taken to go on"
    )
    return angles - _TURN * np.concatenate([[0.0], np.cumsum(turns)])


def refuse_jumps(name: str, times: Array, angles: Array, first: float, last: float) -> None:
    """SomersaultError where a joint's angle (T,) jumps between `first` and `last`, with the time.

    A step is a jump if it is far out of the order of those around it, and by more than any limb
    moves between two samples.
    """
    steps = np.diff(angles)
    ordinary, size = _ordinary(steps)
    out = np.abs(steps - ordinary)
    too_far = (out > _LARGE) | ((out > _SMALL) & (out > _FASTEST * np.diff(times)))
    inside = (times[1:] > first) & (times[:-1] < last)
    jumps = np.flatnonzero(too_far & (out > _OUT * size) & inside)
    if jumps.size:
        k = int(jumps[np.argmax(out[jumps])])
        raise SomersaultError(
            f"joint {name} jumps by {steps[k]:.3g} rad ({degrees(steps[k]):.4g}°) between "
            f"{times[k]:.6g} and {times[k + 1]:.6g} s, which is neither a whole turn nor a motion; "
            "correct the recording, or take a part of it with start and stop"
        )


def _ordinary(steps: Array) -> tuple[Array, Array]:
    """The medians of the steps around each step (T - 1,), and of their sizes."""
    padded = np.pad(steps, _AROUND, constant_values=np.nan)
    around = np.lib.stride_tricks.sliding_window_view(padded, 2 * _AROUND + 1)
    around = np.delete(around, _AROUND, axis=1)
    return np.nanmedian(around, axis=1), np.nanmedian(np.abs(around), axis=1)
