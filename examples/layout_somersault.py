"""Which springs stabilise a layout somersault: a chart, a verdict and the reason.

Run with `python examples/layout_somersault.py [MODEL [JOINT]]`: any free model with a joint, or a
mirrored pair of them, whose angle and spring are to be varied. Writes stability.png and
roots.png.
"""

import sys

import numpy as np

import somersault as so
from somersault.view import root_loci, stability_chart


def main(model: str = "furrer", joint: str = "shoulder") -> None:
    """Draw the chart and the root locus, and print verdicts."""
    chart = so.stability.chart(
        model,
        x=(f"pose.{joint}", np.linspace(0.0, 3.0, 601)),
        y=(f"stiffness.{joint}", np.linspace(-1.5, 2.0, 2801)),
    )
    stability_chart(chart).savefig("stability.png", dpi=160)

    locus = so.stability.root_locus(
        model,
        (f"stiffness.{joint}", np.linspace(-2.0, 4.0, 241)),
        pose={joint: 1.3},
        subsystem="tilt",
    )
    root_loci(locus).savefig("roots.png", dpi=160)

    for angle in (0.4, 1.4, 2.6):
        ranges = so.stability.stable_ranges(
            model, (f"stiffness.{joint}", -2.0, 4.0), pose={joint: angle}
        )
        shown = ", ".join(f"{low:.3f} to {high:.3f}" for low, high in ranges) or "none"
        print(f"{joint} at {angle} rad: stable for K = {shown}")

    layout = so.spin(model, pose={joint: 1.4}).linear(stiffness={joint: 1.2})
    print(layout)
    for mode in layout.modes:
        print(f"  {mode.name}: {mode.root:.4f}")


if __name__ == "__main__":
    try:
        main(*sys.argv[1:3])
    except so.SomersaultError as mistake:
        sys.exit(f"{sys.argv[0]}: {mistake}")
