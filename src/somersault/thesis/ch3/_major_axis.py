"""Figure 3-3: the map of a spin about the major axis, tuck."""

from __future__ import annotations

import numpy as np

from somersault import rigid
from somersault import stability as st
from somersault._core.array import Array
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result
from somersault.thesis.ch2._momentum_sphere import minor_share


def fig_3_3() -> Result:
    """A spin about the major axis: tuck."""
    from somersault.view import sphere

    inertias = st.principal_inertias("human_tuck")
    pike = 1 - minor_share(st.principal_inertias("human_pike"))
    share = 1 - minor_share(inertias)
    chance = np.random.default_rng(33)
    worst, stays = 0.0, True
    reach = []
    for angle in (0.01, 0.02, 0.05):
        for turn in chance.uniform(0, 2 * np.pi, 20):
            c = np.array([angle * np.sin(turn), np.cos(angle), angle * np.cos(turn)])
            motion = rigid.RigidMotion(inertias, c / inertias)
            path = motion.omega(np.linspace(0, motion.period, 300)) * inertias
            away = np.arccos(np.clip(path[:, 1] / np.linalg.norm(path, axis=1), -1, 1)).max()
            reach.append(away / np.arccos(c[1] / np.linalg.norm(c)))
            worst, stays = max(worst, float(away)), stays and motion.kind == "major"
    claims = (
        statement(
            "fig3-3.major", "§3.1, §3.2", "in most humans the tuck somersault is about the major "
            "principal axis", "major", f"I2 = {inertias[1]:.3f} of {inertias[0]:.3f}, "
            f"{inertias[1]:.3f}, {inertias[2]:.3f} kg m²", int(np.argmax(inertias)) == 1,
            "The tucked athlete stands in for the 3D Biped, whose I1 and I3 are not printed.",
        ),
        statement(
            "fig3-3.stays", "§3.2", "begun with the momentum close to the major axis, it remains "
            "close to it", "remains close", f"all {len(reach)} exact motions of human_tuck from "
            f"0.01 to 0.05 rad off stay in its lune, and go at most {max(reach):.1f} times as far",
            stays and worst < np.pi / 4,
            f"Furthest {worst:.2f} rad. On a small ellipse of energy the ratio is "
            f"√(I1 (I2 − I3)/(I3 (I2 − I1))) = {_ellipse(inertias):.1f}: I1 is nearly I2.",
        ),
    )  # fmt: skip
    return Result(
        "The 3D Biped's somersault axis is its major principal axis; the region of stable rotation "
        "about it is large.",
        f"Drawn for the tucked athlete, human_tuck: the robot's I1 and I3 are not in the thesis. "
        f"Curves around its major axis take {100 * share:.0f} % of the sphere (human_pike: "
        f"{100 * pike:.0f} %), a narrow lune because I1 is nearly I2.",
        claims,
        sphere.sphere_map(inertias, sphere.energies(inertias, 6), "human_tuck held rigid"),
    )


def _ellipse(inertias: Array) -> float:
    """Greatest over least deviation on small curves around the major axis 2."""
    one, two, three = inertias
    ratio = np.sqrt((1 / three - 1 / two) / (1 / one - 1 / two))
    return float(max(ratio, 1 / ratio))
