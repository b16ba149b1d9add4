"""A layout somersault whose arms are still, on springs, moved by a law, or both, from one start.

Run with `python examples/active_layout.py [MODEL [JOINT]]`: any free model with a mirrored pair of
joints. Change the numbers below for another person. Prints what becomes of each and writes
active_layout.mp4, in which they turn side by side, and active_layout.html, a page to look at them.
"""

import sys

import numpy as np

import somersault as so
from somersault.view import film, page

SPIN = 8.64  # rad/s
ANGLE = 1.3  # rad, the arms' own
OFF = {"tilt": 0.03, "twist": 0.03}  # rad at takeoff
SOMERSAULTS = 4
TURN = 2 * np.pi / SPIN  # s
EVERY = TURN / 36  # s between two looks
LATE = {"active": 2 * EVERY, "both": 8 * EVERY}  # s until it is acted on: 40 and 162 ms


def arms(inertia: float) -> dict[str, so.JointTakeoff]:
    """What the joints do in each case; `inertia` is of all that is outboard of one of them."""
    return {
        "rigid": so.JointTakeoff.locked(angle=ANGLE),
        "passive": so.JointTakeoff.sprung(angle=ANGLE, K=1.2, hold=True),
        "active": so.JointTakeoff.rate_law(
            angle=ANGLE, law="k * twist + c * twist_rate", gains={"k": -1.5 * SPIN, "c": -1.5},
            every=EVERY, delay=LATE["active"], most_rate=10.0,
        ),
        "both": so.JointTakeoff.torque_law(
            angle=ANGLE, K=1.2, B=0.13, hold=True, law="k * twist",
            gains={"k": -0.5 * inertia * SPIN**2}, every=EVERY, delay=LATE["both"],
        ),
    }  # fmt: skip


def main(model: str = "furrer", joint: str = "shoulder") -> None:
    """Fly the four, say how far each has twisted, and show them."""
    inertias = so.spin(model, pose={joint: ANGLE}).outboard_inertias
    cases = arms(inertias[joint if joint in inertias else f"left_{joint}"])
    flights = {}
    for name, does in cases.items():
        takeoff = so.Takeoff(spin=SPIN, joints={joint: does}, **OFF)
        flights[name] = so.fly(model, takeoff, SOMERSAULTS * TURN, samples=289)
        twist = np.degrees(np.abs(flights[name].angles[:, 2]).max())
        late = f", {1000 * LATE[name]:.0f} ms late" if name in LATE else ""
        print(f"{name}{late}: twists by {twist:.0f}° at most in {SOMERSAULTS} somersaults")
    shown, labels = list(flights.values()), list(flights)
    film(
        shown, "active_layout.mp4", speed=0.4, size=(1280, 460), labels=labels,
        vectors=["momentum"],
    )  # fmt: skip
    page(shown, "active_layout.html", labels=labels, title="One layout, held in four ways")


if __name__ == "__main__":
    try:
        main(*sys.argv[1:3])
    except so.SomersaultError as mistake:
        sys.exit(f"{sys.argv[0]}: {mistake}")
