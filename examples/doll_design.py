"""How stiff should a doll's shoulders be, and what does a longer life cost in weight of its arms?

Run with `python examples/doll_design.py [MODEL [JOINT [CANDIDATES]]]`: any free model with a pair
of sprung joints, each of which carries a body. Starts are off by a few degrees of tilt and twist.
First the spring is chosen alone, then the life is traded off against the mass of the arms, which
needs pymoo. Takes about a minute; stopped, it goes on where it was. Writes doll_design.png,
doll_trade_off.png and the folders doll_design and doll_trade_off.
"""

import sys

import numpy as np

import somersault as so

SPIN = 20.0  # rad/s
SOMERSAULTS = 10
ANGLE, K = 1.57, 0.82  # of the thesis's doll: rad, and k/(Ω² I)
OFF = 0.06  # rad, standard deviation of tilt and twist at takeoff
STARTS = 256  # of each candidate
LIGHTEST, HEAVIEST = 0.5, 2.0  # arms, in masses of the model's own
TURN = 2 * np.pi / SPIN  # s


def main(model: str = "doll_weighted", joint: str = "shoulder", candidates: str = "600") -> None:
    """Choose, say what was found, and draw it."""
    body = so.load(model)
    arms = so.JointTakeoff.sprung(angle=ANGLE, K=K, hold=True)
    thrown = so.flight.flights(
        body, so.Takeoff(spin=SPIN, joints={joint: arms}), SOMERSAULTS * TURN, report=["twist"],
        until="quarter twist", accuracy=1e-6,
    )  # fmt: skip
    sprung = [target.name[1] for target in thrown.targets(f"joints.{joint}.K")]
    moved = [b for b in body.bodies if any(one.name in sprung for one in b.joints)]
    masses = [f"bodies.{one.name}.mass" for one in moved]
    own = moved[0].mass
    spring = so.Choose(sets=f"joints.{joint}.K", between=(0.2, 3.0), start=K, scale="log")
    weight = so.Choose(sets=masses, between=(LIGHTEST * own, HEAVIEST * own), start=own, unit="kg")
    vary = {
        f"takeoff_{name}": so.Vary(adds_to=f"takeoff.{name}", normal=[0.0, OFF])
        for name in ("tilt", "twist")
    }
    life = so.designs.Mean("time", largest=True, counts_as=0.0)
    shown = sys.stderr.isatty()
    found = so.design(
        thrown, {"K": spring}, vary, life, size=STARTS, seed=1,
        evaluations=max(int(candidates) // 5, 2), held_out=512, out="doll_design", progress=shown,
    )  # fmt: skip
    print(
        f"K = {found.best['K']:.2f}: {found.figure / TURN:.1f} somersaults of {SOMERSAULTS}, "
        f"{found.first_figure / TURN:.1f} with {K}"
    )
    found.plot(steps=41, reach=0.4).savefig("doll_design.png", dpi=160)

    traded = so.designs.trade_off(
        thrown, {"K": spring, "arm": weight}, vary, [life, so.designs.Mean("arm")],
        size=STARTS, seed=1, evaluations=int(candidates), held_out=512, out="doll_trade_off",
        progress=shown,
    )  # fmt: skip
    for point in range(traded.dataset.sizes["point"]):
        one = traded.dataset.isel(point=point)
        lasts, mass = one["figure"].values
        print(
            f"arms of {1000 * mass:.0f} g, K = {float(one['chosen'][0]):.2f}: {lasts / TURN:.1f} "
            "somersaults"
        )
    traded.plot().savefig("doll_trade_off.png", dpi=160)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:4])
    except so.SomersaultError as mistake:
        sys.exit(f"{sys.argv[0]}: {mistake}")
    except KeyboardInterrupt:
        sys.exit("stopped; the same call goes on from here")
