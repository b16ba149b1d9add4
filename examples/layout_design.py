"""Which arm angle and shoulder springs keep a layout longest, how sharply, and which matters more?

Run with `python examples/layout_design.py [MODEL [JOINT [CANDIDATES]]]`: any free model with a
joint, or a mirrored pair of them, to be raised and sprung. Starts are off by a few degrees of tilt
and twist. First springs and angle are chosen by the stability of small motions alone, then by
flights until a quarter twist. Takes about a minute; stopped, it goes on where it was. Writes
layout_design.png, layout_design_map.png and the folder layout_design.
"""

import sys

import numpy as np

import somersault as so

SPIN = 8.64  # rad/s
SOMERSAULTS = 10
ANGLE, K = 1.3, 1.2  # those of the thesis: rad, and k/(Ω² I)
ANGLES, SPRINGS = (0.6, 1.9), (0.2, 3.0)
OFF = 0.06  # rad, standard deviation of tilt and twist at takeoff
TURN = 2 * np.pi / SPIN  # s


def main(model: str = "furrer", joint: str = "shoulder", candidates: str = "240") -> None:
    """Choose, say what was found, and draw it."""
    spins = so.stability.spins(model, pose={joint: ANGLE}, stiffness={joint: K})
    by_margin = so.design(
        spins,
        {
            "angle": so.Choose(sets=f"pose.{joint}", between=ANGLES, start=ANGLE, unit="rad"),
            "K": so.Choose(sets=f"stiffness.{joint}", between=SPRINGS, start=K, scale="log"),
        },
        {
            "raised": so.Vary(adds_to=f"pose.{joint}", normal=[0.0, 0.1]),
            "stiffer": so.Vary(adds_to=f"stiffness.{joint}", normal=[0.0, 0.1]),
        },
        so.designs.Mean("stability_margin", largest=True),
        evaluations=int(candidates),
    )  # fmt: skip
    print("small motions:", told(by_margin))

    arms = so.JointTakeoff.sprung(angle=ANGLE, K=K, hold=True)
    flights = so.flight.flights(
        model, so.Takeoff(spin=SPIN, joints={joint: arms}), SOMERSAULTS * TURN, report=["twist"],
        until="quarter twist", accuracy=1e-6,
    )  # fmt: skip
    choose = {
        "angle": so.Choose(sets=f"joints.{joint}.angle", between=ANGLES, start=ANGLE, unit="rad"),
        "K": so.Choose(sets=f"joints.{joint}.K", between=SPRINGS, start=K, scale="log"),
    }
    vary = {
        f"takeoff_{name}": so.Vary(adds_to=f"takeoff.{name}", normal=[0.0, OFF])
        for name in ("tilt", "twist")
    }
    life = so.designs.Mean("time", largest=True, counts_as=0.0)
    found = so.design(
        flights, choose, vary, life, seed=1, evaluations=int(candidates), population=12,
        held_out=512, out="layout_design", progress=sys.stderr.isatty(),
    )  # fmt: skip
    low, high = (end / TURN for end in found.interval)
    print("flights:", told(found))
    print(
        f"{found.figure / TURN:.1f} somersaults of {SOMERSAULTS} ({low:.1f} to {high:.1f}), "
        f"{found.first_figure / TURN:.1f} with {ANGLE} rad and K = {K}"
    )
    ranked = found.sensitivity()
    for name, share in zip(ranked["input"].values, ranked["total"].values, strict=True):
        print(f"total Sobol' index of {name} between its bounds: {share:.2f}")
    found.plot().savefig("layout_design.png", dpi=160)
    found.plot_map("angle", "K", steps=31, reach=0.5).savefig("layout_design_map.png", dpi=160)


def told(found: so.designs.Design) -> str:
    """What was chosen, in words."""
    return ", ".join(f"{name} {value:.2f}" for name, value in found.best.items())


if __name__ == "__main__":
    try:
        main(*sys.argv[1:4])
    except so.SomersaultError as mistake:
        sys.exit(f"{sys.argv[0]}: {mistake}")
    except KeyboardInterrupt:
        sys.exit("stopped; the same call goes on from here")
