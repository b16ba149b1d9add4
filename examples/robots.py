"""Running and somersaulting with other robots than the 3D Biped.

    python examples/robots.py [MODEL [SECONDS]]

The first is the 3D Biped changed: slippery ground, softer springs, weaker hips. The second is
another robot, `runner.xml`, with other masses, proportions and names: it is described by saying
which of its joints are legs, and takes the 3D Biped's numbers, grown to its size.
"""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from pathlib import Path

import somersault as so
from somersault.robot import Control, Leg, Plant, Robot, Run, run, similar, usual

MODEL = Path(__file__).with_name("runner.xml")
AT = 4.0  # s, when the somersaults are to begin


def runner() -> Robot:
    """The other robot."""
    legs = [
        Leg(
            hip=(f"pitch_{side}", f"roll_{side}", f"yaw_{side}"), slide=f"shank_{side}",
            foot=f"ball_{side}", spring=f"air_{side}", stop=f"seat_{side}",
        )
        for side in ("l", "r")
    ]  # fmt: skip
    return Robot(str(MODEL), legs[0], legs[1], shortest=0.75, longest=1.05)


def runner_control() -> Control:
    """The 3D Biped's numbers for a robot of the other's mass and length."""
    robot, biped = runner(), Robot()
    mass = robot.machine.mass / biped.machine.mass
    length = (robot.shortest + robot.longest) / (biped.shortest + biped.longest)
    return similar(Control(), mass, length)


def told(title: str, ran: Run) -> None:
    """One line on a run."""
    if math.isnan(ran.outcome["landing_somersault"]):
        print(f"{title}: {ran.ended} after {ran.outcome['time']:.1f} s, without a landing")
        return
    turned = math.degrees(ran.outcome["landing_somersault"])
    steps = ran.outcome["steps_after"]
    print(f"{title}: {ran.ended}; landed at {turned:.0f}°, {steps:.0f} steps after")


def main(model: str = "biped", at: str = str(AT)) -> None:
    """Run a robot as it is and changed, and the other one; all flip at a time."""
    try:
        when = float(at)
    except ValueError:
        raise so.SomersaultError(f"{at!r} is no time in seconds; give 4, say") from None
    changed = Plant(friction=0.7, stiffness=0.9, torque=0.9)
    told(model, run(model, when + 8, flip=when))
    numbers = replace(usual(model), plant=changed)
    told(f"{model}, changed", run(model, when + 8, numbers, flip=when))
    told("runner", run(runner(), when + 8, runner_control(), flip=when))


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except so.SomersaultError as mistake:
        raise SystemExit(f"robots.py: {mistake}") from None
