"""Draw docs/laws.png: the same start of a layout with arms that are still, on springs, moved by a
law, and both.

Run with `python scripts/active_layouts.py`.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import somersault as so
from somersault.view import strip, style

OUT = Path(__file__).parents[1] / "docs" / "laws.png"
ARMS, SPIN, TURN = 1.3, 8.64, 2 * np.pi / 8.64
EVERY = TURN / 36
SOMERSAULTS, PICTURES = 3, 13
SPRUNG = {"angle": ARMS, "K": 1.2, "hold": True}
JOINT = so.JointTakeoff
CASES = {
    "rigid": JOINT.locked(angle=ARMS),
    "passive:\nsprings": JOINT.sprung(**SPRUNG),
    "active:\na law,\n40 ms late": JOINT.rate_law(
        angle=ARMS, law="k * twist + c * twist_rate", gains={"k": -1.5 * SPIN, "c": -1.5},
        every=EVERY, delay=2 * EVERY, most_rate=10.0,
    ),
    "both,\n162 ms late": JOINT.torque_law(
        **SPRUNG, B=0.13, law="k * twist", gains={"k": -0.2 * SPIN**2}, every=EVERY,
        delay=8 * EVERY,
    ),
}  # fmt: skip


def main() -> None:
    times = np.linspace(0.0, SOMERSAULTS * TURN, PICTURES)
    picture = style.figure(10.0, 6.6)
    for ax, (name, arms) in zip(picture.subplots(len(CASES), 1), CASES.items(), strict=True):
        takeoff = so.Takeoff(spin=SPIN, tilt=0.03, twist=0.03, joints={"shoulder": arms})
        flight = so.fly("furrer", takeoff, times[-1], samples=times)
        strip(ax, flight, times, size=1.15)
        ax.text(-0.005, 0.5, name, transform=ax.transAxes, ha="right", va="center", fontsize=10)
    picture.savefig(OUT, dpi=110)


if __name__ == "__main__":
    main()
