"""Tune the somersault of the 3D Biped (Playter 1994, chapter 3), with all of its strategy or less.

    python scripts/biped.py            # the whole strategy: half an hour on two cores
    python scripts/biped.py ablations  # without tuck servo, landing window, or either

Attempts are scored on seeds 1 and 2, with errors half as great again as those that count; what
comes off most often goes into `somersault.robot.Flip` and `somersault.thesis.ch3._attempts`. The
attempts that the thesis's chapter counts have another seed, `_scatter.HELD_OUT`.

Gains of running were taken from Raibert's rule that a foot half a stance in front neither speeds up
nor slows down, and softened until a somersault that lands 40 degrees off still runs on: pitch of
250 N m/rad and 25 N m s/rad overshoots in the following flights and falls ten steps later.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from itertools import product

import somersault as so
from somersault.robot import End
from somersault.thesis.ch3._scatter import attempts, scatter

SEEDS = (1, 2)
LEVEL = 1.5
SIZE = 48
STEPS = 10

WHOLE = {"lift_off_speed": (3.5, 4.0, 4.3), "torque": (95.0, 105.0, 115.0)}
ABLATIONS = {
    "no tuck servo": (
        {"servo": 0.0}, {"held_length": (0.70, 0.75, 0.80), "torque": (95.0, 105.0)},
    ),
    "no landing window": (
        {"window": -1.0}, {"feet_back": (0.0, 0.2, 0.436), "torque": (95.0, 105.0)},
    ),
    "neither": (
        {"servo": 0.0, "window": -1.0},
        {"held_length": (0.75, 0.80), "feet_back": (0.0, 0.2), "torque": (95.0, 105.0)},
    ),
}  # fmt: skip


def score(numbers: dict[str, float]) -> int:
    """How many attempts come off, of SIZE for each seed."""
    runs = attempts(at=0.8, **numbers)
    runs = replace(runs, control=replace(runs.control, end=End(steps_after=STEPS)), duration=14.0)
    found = 0
    for seed in SEEDS:
        data = so.ensemble(runs, vary=scatter(LEVEL), size=SIZE, seed=seed).dataset
        found += int(so.ensembles.ended_by(data["ended"], "ran on").sum())
    return found


def search(title: str, fixed: dict[str, float], grid: dict[str, tuple[float, ...]]) -> None:
    """Every combination, and how often it comes off."""
    print(f"{title}, of {SIZE * len(SEEDS)}:")
    for values in product(*grid.values()):
        tried = dict(zip(grid, values, strict=True))
        words = ", ".join(f"{name} {value:g}" for name, value in tried.items())
        print(f"  {words}: {score(fixed | tried)}", flush=True)


if __name__ == "__main__":
    if "ablations" in sys.argv[1:]:
        for name, (fixed, grid) in ABLATIONS.items():
            search(name, fixed, grid)
    else:
        search("the whole strategy", {}, WHOLE)
