"""What of the robot is assumed, and how much depends on it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from somersault.ensembles import ended_by, ensemble
from somersault.robot import Control, End, Plant
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch3._scatter import HELD_OUT, attempts, scatter

_CHANGES: dict[str, tuple[float, ...]] = {
    "friction": (0.7, 1.3), "turning_friction": (0.5, 2.0), "stiffness": (0.8, 1.25),
    "damping": (0.5, 2.0), "roll_inertia": (0.8, 1.25), "yaw_inertia": (0.8, 1.25),
    "torque": (0.8, 1.25), "hip_spacing": (0.75, 1.5), "foot_radius": (0.6, 1.6),
    "upper_leg_mass": (0.5, 1.5),
}  # fmt: skip
_COUNT = 16


@cache
def came_off(name: str, factor: float) -> int:
    """How many of some attempts come off with a part of the robot changed; the controller does not
    know."""
    control = Control(plant=replace(Plant(), **{name: factor}))
    runs = attempts(None, control, at=0.8)
    runs = replace(runs, control=replace(runs.control, end=End(steps_after=10)), duration=14.0)
    data = ensemble(runs, vary=scatter(), size=_COUNT, seed=HELD_OUT).dataset
    return int(ended_by(data["ended"], "ran on").sum())


def assumptions() -> Result:
    """Attempts with what the thesis does not give changed, one at a time."""
    found = {
        (name, factor): came_off(name, factor)
        for name, factors in _CHANGES.items()
        for factor in factors
    }
    worst = min(found, key=found.__getitem__)
    claims = (
        statement(
            "ch3-assumed.all", "§3.4", "what is assumed of the robot does not decide whether it "
            "somersaults", "not given", f"least with {worst[0].replace('_', ' ')} × {worst[1]:g}: "
            f"{found[worst]} of {_COUNT} attempts", found[worst] >= 0.75 * _COUNT,
        ),
    )  # fmt: skip
    rows = tuple(
        (name.replace("_", " "), f"× {factor:g}", f"{count} of {_COUNT}")
        for (name, factor), count in found.items()
    )
    return Result(
        "The thesis gives masses, lengths and the somersault inertia.",
        "Each of the others less and greater than assumed, with the controller as it is; ten steps "
        "after the somersault count.",
        claims,
        table=Table(("what", "changed", "came off"), rows),
    )
