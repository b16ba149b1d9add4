"""Figure 4-3: the map of the layout held rigid."""

from __future__ import annotations

import numpy as np

from somersault import rigid
from somersault import stability as st
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result
from somersault.thesis.ch2._momentum_sphere import AXES, map_with_example
from somersault.thesis.ch4._furrer import MODEL, NOMINAL


def fig_4_3() -> Result:
    """The map again, for Furrer's layout."""
    inertias = st.principal_inertias(MODEL, {"shoulder": NOMINAL})
    circles = rigid.separatrix(inertias, 721)
    tilt, _ = rigid.tilt_and_twist(circles)
    widest = float(np.degrees(np.abs(tilt).max()))
    order = [int(k) for k in np.argsort(inertias)]
    growth = float(rigid.growth_angle(*rigid.inertia_ratios(*inertias)))
    claims = (
        statement(
            "fig4-3.middle", "§4.1, Figure 4-3", "the layout somersault is about the middle axis, "
            "upon which trajectories converge and diverge", "middle axis, unstable",
            f"axis 2 is the middle one, and the separatrix crosses on it: tenfold growth in "
            f"{growth:.2f} rad", order[1] == 1 and bool(np.isfinite(growth)),
        ),
        statement(
            "fig4-3.major", "§4.1", "the maximum principal axis is front-to-back", "front-to-back",
            AXES[order[2]], order[2] == 0,
        ),
    )  # fmt: skip
    return Result(
        "The map of figure 2-7 again: the rigid layout's instability is evident from trajectories "
        "that converge and diverge upon the somersault axis.",
        f"For Furrer with his arms at Γ = 1.3 rad. The lunes around the front-to-back axis "
        f"reach {widest:.1f}° of tilt.",
        claims,
        map_with_example(inertias, "Furrer held rigid, arms at 1.3 rad"),
    )
