"""Throw a doll many times: which shoulder springs keep its layout somersault, and how surely?

Run with `python examples/doll_experiment.py [MODEL [JOINT]]`: any free model with a joint, or a
mirrored pair of them, whose spring is to be chosen. Change the numbers below for another launcher.
Prints a table and writes doll_experiment.png.
"""

import sys

import numpy as np
from matplotlib.figure import Figure

import somersault as so

MODEL = sys.argv[1] if len(sys.argv) > 1 else "doll_weighted"
JOINT = sys.argv[2] if len(sys.argv) > 2 else "shoulder"
ANGLE = 1.6  # rad, the nominal arm angle
SPIN = 16.6  # rad/s
SOMERSAULTS = 3.5  # until it is caught
SPRINGS = [0.23, 0.34, 0.6, 0.82, 1.18, 2.1]  # K = k/(Ω² I)
LAUNCHES = 1000  # a spring
SCATTER = {  # standard deviations from launch to launch
    "takeoff.tilt": 0.03,  # rad
    "takeoff.twist": 0.03,
    "takeoff.tilt_rate": 0.4,  # rad/s
    "takeoff.twist_rate": 0.4,
    f"joints.{JOINT}.angle": 0.1,  # rad
}
PRETENSION = 0.04  # of the torque that balances the spin


def thrown(arm, vary):
    """Launches of an arm that is sprung or locked, until a quarter twist or the catch."""
    return so.ensemble(
        MODEL, so.Takeoff(spin=SPIN, joints={JOINT: arm}), SOMERSAULTS * 2 * np.pi / SPIN, vary,
        size=LAUNCHES, seed=1, report=["somersaults"], until="quarter twist",
    )  # fmt: skip


def stable(launches):
    """The share of launches that did not end with a quarter twist, with its interval."""
    return launches.fraction(ended="duration")


def main():
    """Throw, print the table and draw it."""
    spin = so.spin(MODEL, pose={JOINT: ANGLE})
    joint = JOINT if JOINT in spin.outboard_inertias else f"left_{JOINT}"
    unit = SPIN**2 * spin.outboard_inertias[joint]  # N m/rad of K = 1
    held = abs(spin.holding_torques[joint]) * SPIN**2  # N m
    scatter = {
        what.split(".", 1)[1].replace(".", "_") + "_error": so.Vary(adds_to=what, normal=(0.0, sd))
        for what, sd in SCATTER.items()
    }
    sprung = so.JointTakeoff("sprung", angle=ANGLE, stiffness=unit, hold=True)
    springs = thrown(
        sprung,
        {
            "K": so.Vary(sets=f"joints.{JOINT}.stiffness", values=SPRINGS, scale=unit),
            "pretension_error": so.Vary(
                adds_to=f"joints.{JOINT}.pretension", normal=(0.0, PRETENSION * held), unit="N m"
            ),
            **scatter,
        },
    )
    clamped = thrown(so.JointTakeoff("locked", angle=ANGLE), scatter)

    rows = [(f"K = {K:g}", springs.dataset.sel(K=K), stable(springs).sel(K=K)) for K in SPRINGS]
    rows.append(("clamped", clamped.dataset, stable(clamped)))
    print(f"{MODEL}: somersaults until a quarter twist, and launches that stayed stable")
    for name, data, share in rows:
        count = data["somersaults"]
        low, middle, high = (100 * float(share[x]) for x in ("low", "fraction", "high"))
        print(
            f"{name:>9}  {float(count.mean()):.2f} ± {float(count.std()):.2f}   "
            f"{middle:5.1f} %  ({low:.1f} to {high:.1f})"
        )

    picture = Figure(figsize=(6.4, 4.0), layout="constrained")
    axes = picture.add_subplot(
        xlabel="shoulder stiffness K", ylabel="launches that stayed stable (%)"
    )
    share = 100 * stable(springs)
    reach = [share["fraction"] - share["low"], share["high"] - share["fraction"]]
    axes.errorbar(SPRINGS, share["fraction"], reach, fmt="o-", color="#0072B2", capsize=3)
    axes.axhline(100 * float(stable(clamped)["fraction"]), color="#D55E00", linestyle="--")
    axes.text(SPRINGS[0], 1, "arms clamped", color="#D55E00", va="bottom")
    axes.set_ylim(-2, 104)
    picture.savefig("doll_experiment.png", dpi=160)


if __name__ == "__main__":
    try:
        main()
    except so.SomersaultError as mistake:
        sys.exit(f"{sys.argv[0]}: {mistake}")
