"""How attempts of the 3D Biped differ: Table 3.3 and assumptions."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from somersault.ensembles import Ensemble, Vary, ensemble
from somersault.robot import Control, End, Robot, Runs

RUN_ON = 20
"""Steps after a somersault with which an attempt has come off."""

HELD_OUT = 2026
"""The seed of attempts that nothing was ever tuned on; `scripts/biped.py` tunes on 1 and 2."""

LIFT_OFF_ERROR = (0.021, 0.026)
"""Mean and deviation of the estimate of the speed at lift-off, in parts of it, by Table 3.3."""

_START = {
    "forward": 0.1, "sideways": 0.1, "roll": 0.03, "pitch": 0.03, "roll_rate": 0.2,
    "pitch_rate": 0.2, "yaw_rate": 0.2,
}  # fmt: skip
_ERRORS = {
    "torque": 0.05, "thrust": 0.05, "foot": 0.015, "forward": 0.07, "sideways": 0.07,
    "upward": 0.07, "roll": 0.15, "pitch": 0.15, "yaw": 0.15,
}  # fmt: skip


def scatter(level: float = 1.0, planar: bool = False) -> dict[str, Vary]:
    """What varies from one attempt to the next, by so many times its deviation; in a plane nothing
    that would leave it.

    The start (m/s, rad, rad/s), the estimate of the lift-off speed, what the flip step does (parts,
    m), and a push in the hurdle (m/s, rad/s). Only the estimate's numbers are in the thesis.
    """
    mean, deviation = LIFT_OFF_ERROR
    vary = {
        f"start_{name}": Vary(adds_to=f"start.{name}", normal=[0.0, level * deviation])
        for name, deviation in _START.items()
    }
    vary["estimate"] = Vary(sets="errors.lift_off_speed", normal=[mean, level * deviation])
    vary |= {
        f"error_{name}": Vary(sets=f"errors.{name}", normal=[0.0, level * deviation])
        for name, deviation in _ERRORS.items()
    }
    out_of_plane = ("roll", "yaw", "sideways")
    return {
        name: x
        for name, x in vary.items()
        if not planar or not any(w in name for w in out_of_plane)
    }


def attempts(robot: Robot | None = None, control: Control | None = None, **flip: float) -> Runs:
    """Attempts of a somersault at the first step after 3 s, with other numbers of [flip]."""
    numbers = Control() if control is None else control
    numbers = replace(
        numbers, flip=replace(numbers.flip, **{"at": 3.0, **flip}), end=End(steps_after=RUN_ON)
    )
    return Runs(robot or Robot(), numbers, duration=24.0)


@cache
def held_out(size: int = 400) -> Ensemble:
    """Attempts with the tuned controller on starts that it was not tuned on."""
    return ensemble(attempts(), vary=scatter(), size=size, seed=HELD_OUT)
