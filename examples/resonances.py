"""Where the modes of a spin are in resonance, and with which springs a wobble bursts.

Run with `python examples/resonances.py [MODEL [JOINT]]`: any free model with a joint, or a mirrored
pair of them, whose angle and spring are to be varied. Writes resonances.png, a stability chart with
the resonances on it, and flies through the strongest of them with many springs. Half a minute, a
minute for a gymnast.
"""

import sys

import numpy as np

import somersault as so
from somersault.view import stability_chart

TILT, TURNS, RATE = 0.002, 400, 10.0  # rad, turns and rad/s of the flights


def main(model: str = "furrer", joint: str = "shoulder") -> None:
    """Draw the chart, and fly with springs about the 2 : 1 resonance."""
    chart = so.stability.chart(
        model,
        x=(f"pose.{joint}", np.linspace(0.6, 2.2, 401)),
        y=(f"stiffness.{joint}", np.linspace(-0.5, 1.75, 451)),
        resonances=4,
    )
    stability_chart(chart).savefig("resonances.png", dpi=160)
    for angle in (1.3, 1.7):
        across(model, joint, angle)


def across(model: str, joint: str, angle: float) -> None:
    """Print where a small wobble should burst, and where it does."""
    steady = so.spin(model, pose={joint: angle})
    springs = np.linspace(-0.5, 1.75, 4501)
    bursting = []
    for low, high in so.stability.stable_ranges(
        model, (f"stiffness.{joint}", springs[0], springs[-1]), pose={joint: angle}
    ):
        for spring in springs[(springs > low) & (springs < high)]:
            layout = steady.linear({joint: float(spring)})
            for found in layout.resonances(order=3, within=0.1):
                if found.explosive and sorted(map(abs, found.counts)) == [1, 2]:
                    burst = so.stability.burst(layout, found)
                    if burst.threshold < float(burst.amplitude(tilt=TILT)):
                        bursting.append(float(spring))
    if not bursting:
        print(f"{joint} at {angle} rad: no spring lets a tilt of {TILT} rad burst")
        return
    first, last = min(bursting), max(bursting)
    reach = max(last - first, 10 * (springs[1] - springs[0]))
    tried = np.linspace(first - reach, last + reach, 121)
    side = next(name for name in steady.outboard_inertias if name.endswith(joint))
    arms = so.JointTakeoff("sprung", angle=angle, stiffness=0.0, hold=True)
    inertia = steady.principal_inertias[steady.axis - 1]
    flown = so.ensemble(
        model,
        so.Takeoff(
            tilt=TILT, angular_momentum=(0.0, RATE * float(inertia), 0.0), joints={joint: arms}
        ),
        TURNS * 2 * np.pi / RATE,
        {
            "K": so.Vary(
                sets=f"joints.{joint}.stiffness",
                values=tried,
                scale=RATE**2 * steady.outboard_inertias[side],
            )
        },
        report=["somersaults"],
        accuracy=1e-9,
        until="quarter twist",
        steps=1_000_000,
    ).dataset
    lost = tried[so.ensembles.ended_by(flown["ended"], "event").values]
    where = f"{lost.min():.4f} to {lost.max():.4f}" if lost.size else "none"
    print(
        f"{joint} at {angle} rad, from a tilt of {TILT} rad: K = {first:.4f} to {last:.4f} should "
        f"burst; lost within {TURNS} turns: {where}"
    )


if __name__ == "__main__":
    try:
        main(*sys.argv[1:3])
    except so.SomersaultError as mistake:
        sys.exit(f"{sys.argv[0]}: {mistake}")
