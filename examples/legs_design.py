"""Which leg springs let a robot land upright although it took off turning too fast or too slowly?

Run with `python examples/legs_design.py [MODEL [JOINT [CANDIDATES]]]`: any free model with a slide,
or a mirrored pair of them, along which its legs lengthen. The angular momentum is off by 5 %. Legs
of one length are compared with legs on springs and dampers; the springs' numbers are chosen so that
the somersault lands nearest to where it should. The landing error is half of what the somersault
is off by. Takes about a minute; stopped, it goes on where it was. Writes legs_design.png and the
folders legs_rigid and legs_sprung.
"""

import sys

import numpy as np

import somersault as so

SPIN, TIME = 6.5, 0.75  # rad/s at lift-off and s in the air
TARGET = 4.6  # rad of somersault at landing
SPREAD = 0.05  # of the angular momentum, standard deviation
DRAWN_IN = -0.1  # m of the legs at lift-off


def main(model: str = "biped", joint: str = "leg", candidates: str = "240") -> None:
    """Choose, say what was found, and draw it."""
    leg = f"joints.{joint}"
    rigid = so.JointTakeoff.locked(angle=DRAWN_IN)
    sprung = so.JointTakeoff.sprung(angle=DRAWN_IN, stiffness=200.0, rest=DRAWN_IN, damping=5.0)
    length = so.Choose(sets=f"{leg}.angle", between=(-0.15, 0.2), start=DRAWN_IN, unit="m")
    springs = {
        "stiffness": so.Choose(
            sets=f"{leg}.stiffness", between=(20.0, 2000.0), start=200.0, scale="log", unit="N/m"
        ),
        "rest": so.Choose(sets=f"{leg}.rest", between=(-0.3, 0.2), start=DRAWN_IN, unit="m"),
        "damping": so.Choose(
            sets=f"{leg}.damping", between=(0.3, 60.0), start=5.0, scale="log", unit="N s/m"
        ),
    }
    found = {}
    for name, does, choose in (("rigid", rigid, {"length": length}), ("sprung", sprung, springs)):
        takeoff = so.flight.with_momentum(model, so.Takeoff(spin=SPIN, joints={joint: does}))
        turning = np.linalg.norm(takeoff.angular_momentum)
        off = so.Vary(adds_to="takeoff.angular_momentum.2", normal=[0.0, SPREAD * turning])
        runs = so.flight.flights(
            model, takeoff, TIME, report=["landing_error"], against={"somersault": TARGET}
        )
        found[name] = so.design(
            runs, choose, {"momentum": off}, so.designs.Mean("landing_error", counts_as=np.pi),
            seed=1, evaluations=int(candidates), population=12, polish=True, held_out=512,
            out=f"legs_{name}", progress=sys.stderr.isatty(),
        )  # fmt: skip
        best = ", ".join(f"{key} {x:.3g} {choose[key].unit}" for key, x in found[name].best.items())
        low, high = found[name].interval
        print(
            f"{name} legs ({best}): mean landing error {found[name].figure:.3f} rad "
            f"({low:.3f} to {high:.3f})"
        )
    print(f"{found['rigid'].figure / found['sprung'].figure:.1f} times less on springs")
    found["sprung"].plot().savefig("legs_design.png", dpi=160)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:4])
    except so.SomersaultError as mistake:
        sys.exit(f"{sys.argv[0]}: {mistake}")
    except KeyboardInterrupt:
        sys.exit("stopped; the same call goes on from here")
