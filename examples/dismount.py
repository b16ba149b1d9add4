"""A giant swing, a double tucked somersault, and a landing on the feet.

Run with `python examples/dismount.py [STATURE [MASS]]`, in m and kg. The tuck is as deep as the
time in the air asks for; nothing is corrected in flight. Writes dismount.mp4, if there is an
encoder, else dismount.gif.
"""

import importlib.util
import sys

import numpy as np
from scipy.optimize import brentq

import somersault as so

FALLS = (0.0, 0.0, -9.81)
TUCKED = {"shoulder_flexion": 0.62, "hip_flexion": 2.4, "knee": 2.4, "ankle": 0.6}
OPEN = {"shoulder_flexion": 1.4, "hip_flexion": 1.1, "knee": 0.55, "ankle": 1.66}
SMOOTH = "clip({0}, 0, 1)**2 * (3 - 2*clip({0}, 0, 1))"
CLOSED = SMOOTH.format("(land - time)/0.5")
BEGUN = SMOOTH.format("(time - 0.1)/0.35")
LAW = f"start + {BEGUN} * (opened - start + share*(tucked - opened) * {CLOSED})"
TURNED = -4 * np.pi + 0.68  # somersault angle to land at, rad: two turns, the trunk leant forwards


def number(what: str, text: str) -> float:
    """A number that was given as a text."""
    try:
        return float(text)
    except ValueError:
        raise so.SomersaultError(f"the {what} must be a number, and is {text!r}") from None


def main(stature: str = "1.67", mass: str = "64") -> None:
    """Swing, fly, land; print how it ended, and write the film."""
    kg = number("mass", mass)
    model = so.sagittal(so.athlete(number("stature", stature), kg, knees=True, ankles=True))
    none = (0.0, 0.0, 0.0)
    bar = so.Body(
        "bar", -1, 0.0, none, (none, none, none), position=(0.0, 0.0, 2.8),
        joints=(so.Joint("bar", "hinge", (0.0, 1.0, 0.0)),),
    )  # fmt: skip
    mount = so.mounted(model, bar, (0.0, 0.0, 0.61), body="upper_arm")
    held = so.JointTakeoff.locked
    kick = so.JointTakeoff.prescribed(times=[0.2, 0.9, 1.1, 1.32], angles=[0.1, -0.4, -0.4, 0.4])
    joints = {
        "shoulder_flexion": held(angle=np.pi - 0.05), "hip_flexion": kick,
        "knee": held(angle=0.0), "ankle": held(angle=0.0),
    }  # fmt: skip
    giant = so.swing(mount.held, {"bar": -0.15}, 1.39, rates={"bar": -0.3}, joints=joints)

    release = so.released(giant, mount)
    up, height = release.takeoff.velocity[2], release.centre[2]
    land = (up + np.sqrt(up**2 + 2 * 9.81 * (height - 0.9))) / 9.81
    begun = {name: plan.angle for name, plan in release.takeoff.joints.items()}

    def flown(share: float) -> so.Flight:
        moves = {
            name: so.JointTakeoff.angle_law(
                law=LAW, every=0.02, most_rate=20.0, most_acceleration=600.0,
                gains={
                    "start": begun[name], "opened": opened, "tucked": TUCKED[name],
                    "share": share, "land": land,
                },
            )
            for name, opened in OPEN.items()
        }  # fmt: skip
        takeoff = so.released(giant, mount, moves).takeoff
        return so.fly(model, takeoff, land + 0.2, gravity=FALLS)

    def missing(share: float) -> float:
        flight = flown(share)
        return float(np.interp(land, flight.times, flight.angles[:, 0])) - TURNED

    loose, tight = 0.4, 1.05
    if missing(loose) * missing(tight) > 0:
        raise so.SomersaultError(f"{stature} m, {mass} kg: no tuck turns twice in {land:.2f} s")
    share = brentq(missing, loose, tight)
    flight = flown(share)
    landing = so.ground.land(flight)
    print(f"{land:.2f} s in the air, {share:.2f} of the tuck: {landing.ended}")

    whole = so.history.joined(
        [so.flight.ridden(giant, mount), flight, landing],
        clocks=[0.0, release.time, release.time],
    )
    ending = "mp4" if importlib.util.find_spec("av") else "gif"
    so.view.film(whole, f"dismount.{ending}", speed=0.5, camera=(80.0, 4.0))


if __name__ == "__main__":
    try:
        main(*sys.argv[1:3])
    except so.SomersaultError as mistake:
        sys.exit(f"{sys.argv[0]}: {mistake}")
