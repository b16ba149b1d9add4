"""As many twists as can be in one somersault, found by optimal control, and shown.

Run with `python examples/plan_twist.py [MODEL [JOINT]]`: without arguments the acrobat of
twister.xml, as in the examples of bioptim's paper: both arms move about one axis each, with
torques within ±100 N m, from 2.8 rad, in a somersault of 0.5 to 1.5 s. With another model its
joints move within their limits, or the one that is named does. Prints what came of every start, and
writes plan_twist.png, plan_twist.html and plan_twist.toml, which `somersault fly` takes.
"""

import sys
from pathlib import Path

import numpy as np

import somersault as so

PI = np.pi
ACROBAT = Path(__file__).parent / "twister.xml"
RATE = 2 * PI / 1.5  # rad/s at takeoff, of somersault and of twist
ASKED = {  # of the acrobat
    "start": {"right_shoulder": -2.8, "left_shoulder": 2.8},
    "takeoff": {"spin": RATE, "twist_rate": RATE},
    "landing": {
        "somersault": (2 * PI - 0.1, 2 * PI + 0.1),
        "tilt": (-PI / 12, PI / 12),
        "twist": (2 * PI, 20 * PI),
    },
    "aloft": {
        "somersault": (-0.001, 2 * PI + 0.1),
        "tilt": (-PI / 4, PI / 4),
        "twist": (-PI, 20 * PI),
    },
}
STARTS = 24
NODES = 100


def main(model: str = "", joint: str = "") -> None:
    """Plan, say what was found, and show it."""
    body = so.load(model) if model else so.load(ACROBAT, axes=(1, 2, 3))
    joints = [joint] if joint else None
    best = so.plan(
        body, somersaults=1, twists="most", torque=100.0, duration=(0.5, 1.5), joints=joints,
        nodes=NODES, starts=STARTS, **({} if model else ASKED),
    )  # fmt: skip
    for k, attempt in enumerate(best.attempts):
        turns = f"{-attempt.objective / (2 * PI):.2f}" if attempt.solved else "no"
        print(f"start {k}: {turns} twists, {attempt.iterations} iterations")
    print(f"{best.rotations['twist']:.2f} twists in {best.duration:.2f} s")
    print(f"found in {best.seconds:.0f} s; its flight departs from it by {best.departure:.1g} rad")
    flight = best.fly()
    flight.picture("plan_twist.png", np.linspace(0.0, best.duration, 12), columns=6)
    flight.page("plan_twist.html", title="As many twists as can be")
    best.maneuver.save("plan_twist.toml")


if __name__ == "__main__":
    try:
        main(*sys.argv[1:3])
    except so.SomersaultError as mistake:
        sys.exit(f"{sys.argv[0]}: {mistake}")
