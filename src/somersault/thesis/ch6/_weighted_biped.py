"""Figure 6-6: the 3D Biped's map of rotation with a weight above its hips."""

from __future__ import annotations

import numpy as np

from somersault._core.array import Array
from somersault.model import load
from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result
from somersault.thesis.ch2._momentum_sphere import minor_share
from somersault.thesis.ch3._biped import inertia

_WEIGHT, _ABOVE = 4.0, 0.8  # kg, m above the hips
_LENGTH = 0.75  # m of the legs


def weighted(length: float) -> Array:
    """Principal inertias of the robot with the weight about axes 1, 2 and 3, kg m²."""
    mass = load("biped").mass
    lever = mass * _WEIGHT / (mass + _WEIGHT) * _ABOVE**2  # the hips are at the centre of mass
    found: Array = np.diag(inertia(length)) + np.array([lever, lever, 0.0])
    return found


def twisting_tilt(inertias: Array) -> float:
    """The tilt of the somersault axis against the momentum beyond which the body twists on and on,
    rad: where the separatrix crosses the plane of tilt, axes 2 and 3."""
    one, two, three = inertias
    # On the separatrix h²·(c2²/I2 + c3²/I3) is h² over the middle inertia, which is I1's.
    share = (1 / one - 1 / two) / (1 / three - 1 / two)
    return float(np.arcsin(np.sqrt(share)))


def fig_6_6() -> Result:
    """The map with 4 kg, 0.8 m above the hips."""
    from somersault.stability import principal_inertias
    from somersault.view import sphere

    bare, heavy = np.diag(inertia(_LENGTH)), weighted(_LENGTH)
    human = principal_inertias("human_layout")
    angles = [np.degrees(twisting_tilt(i)) for i in (bare, heavy)]
    shares = [minor_share(i) for i in (bare, heavy, np.asarray(human))]
    where = "§6.4, Figure 6-6"
    claims = (
        statement(
            "fig6-6.harder", where, "without the weight significantly more tilt is required for a "
            "twisting somersault than with it", "more tilt", f"{angles[0]:.1f}° without, "
            f"{angles[1]:.1f}° with the weight, legs of {_LENGTH} m", angles[0] > 2 * angles[1],
            "The angle between momentum and somersault axis at the separatrix, in the plane of "
            "tilt. Roll and yaw inertia are assumed.",
        ),
        statement(
            "fig6-6.major", where, "the weight increases the major and intermediate inertias but "
            "not the minor one", "not the minor", f"from {_listed(bare)} to {_listed(heavy)} kg m²",
            bool(np.all(heavy[:2] > 2 * bare[:2]) and heavy[2] == bare[2]),
        ),
        statement(
            "fig6-6.human", where, "with the weight the map looks much more like that of a human",
            "more like", f"curves around the head-to-toe axis take {100 * shares[1]:.0f} % of the "
            f"sphere, without it {100 * shares[0]:.0f} %, of human_layout {100 * shares[2]:.0f} %",
            abs(shares[1] - shares[2]) < abs(shares[0] - shares[2]) / 2,
        ),
        number(
            "fig6-6.axis", where, "the somersault axis is still the major one, by a little", 1.0,
            float(heavy[0] / heavy[1]), "1", 0.15,
        ),
    )  # fmt: skip
    return Result(
        "The map of the 3D Biped with 4.0 kg 0.8 m above the hips looks much more like a human's.",
        f"Of the model `biped`, legs of {_LENGTH} m: a tilt of {angles[1]:.1f}° begins a twisting "
        f"somersault, without the weight one of {angles[0]:.1f}°.",
        claims,
        sphere.sphere_map(
            heavy, sphere.energies(heavy, 6), "biped with 4 kg, 0.8 m above its hips"
        ),
    )


def _listed(inertias: Array) -> str:
    return ", ".join(f"{x:.2f}" for x in inertias)
