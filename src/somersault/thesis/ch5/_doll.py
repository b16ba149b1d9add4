"""The laboratory doll: its numbers (Table 5.1), its models, and what is compared of them.

Chapter 5 is about the doll with a 30 g weight on each arm; the bare doll is the other column of
Table 5.1. A third model carries that table's arm as printed, to show what the misprint changes.
SI units and radians.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from somersault import rigid
from somersault import stability as st
from somersault._core.array import Array
from somersault.model import Model, load
from somersault.thesis.ch4._furrer import ANGLE, HIGH, LOW, STIFFNESS

BARE, WEIGHTED = "doll", "doll_weighted"
STRAIGHT = 1.57  # the nominal arm angle Γ of §§5.3 and 5.5, rad
BEST = 0.82  # the K_sh that best stabilised the doll in the laboratory (§5.5)
PRINTED_I_SH = 3.021e-4  # kg m² (§5.5, where its unit is misprinted)
_COPIED = "A transcription: the model was made with this number."
PRINTED_RL3 = 0.0572  # m, Table 5.1's weighted arm; 0.0622 by the table's own masses (errata)
HEIGHT = 15 * 0.0254  # m, “fifteen inch tall” (§5.2.1)
WEIGHT, WEIGHT_AT = 0.030, 0.043  # kg on each arm, and m from the shoulder (§5.2.1)
ANGLES = np.linspace(0, 3, 151)  # of the pictures, rad
SPRINGS = np.linspace(LOW, HIGH, 601)

# Table 5.1: without a weight, with it, unit.
TABLE_5_1 = {
    "mb": (0.466, 0.466, "kg"),
    "ml": (0.0275, 0.0575, "kg"),
    "Ib1": (0.00411, 0.00411, "kg m²"),
    "Ib2": (0.00391, 0.00391, "kg m²"),
    "Ib3": (0.000354, 0.000354, "kg m²"),
    "Il1": (0.0000559, 0.0000789, "kg m²"),
    "Il2": (0.0000559, 0.0000789, "kg m²"),
    "Il3": (0.000001, 0.000001, "kg m²"),
    "rb1": (0.0, 0.0, "m"),
    "rb2": (0.0413, 0.0413, "m"),
    "rb3": (0.0664, 0.0664, "m"),
    "rl1": (0.0, 0.0, "m"),
    "rl2": (0.0, 0.0, "m"),
    "rl3": (0.0832, PRINTED_RL3, "m"),
}


def parameters(model: str | Model) -> dict[str, float]:
    """Table 5.1's parameters as a model has them, of its left arm."""
    body, arm, _ = load(model).bodies
    pin = np.array(arm.joints[0].anchor)
    values = {"mb": body.mass, "ml": arm.mass}
    values |= {f"Ib{i + 1}": body.inertia[i][i] for i in range(3)}
    values |= {f"Il{i + 1}": arm.inertia[i][i] for i in range(3)}
    values |= {f"rb{i + 1}": float(arm.position[i] + pin[i] - body.com[i]) for i in range(3)}
    values |= {f"rl{i + 1}": float(pin[i] - arm.com[i]) for i in range(3)}
    return values


@cache
def as_printed(name: str = WEIGHTED) -> Model:
    """A doll with its arms' centres of mass where Table 5.1 prints those of the weighted one."""
    model = load(name)
    body, *arms = model.bodies
    moved = [replace(arm, com=(0.0, 0.0, -PRINTED_RL3)) for arm in arms]
    return replace(model, name=f"{name} as printed", bodies=(body, *moved))


def composed_arm() -> tuple[float, float]:
    """rl3 and Il1 of the bare arm and the weight together, by the parallel axis theorem."""
    arm = parameters(BARE)
    mass = arm["ml"] + WEIGHT
    centre = (arm["ml"] * arm["rl3"] + WEIGHT * WEIGHT_AT) / mass
    apart = arm["rl3"] - WEIGHT_AT
    return centre, arm["Il1"] + arm["ml"] * WEIGHT / mass * apart**2


# ------------------------------------------------------ the three numbers that are compared


def ratios(model: str | Model, angles: Array) -> tuple[Array, Array]:
    """k1 and k3 of the whole body with its arms held at angles."""
    k1, k3 = rigid.inertia_ratios(*st.principal_inertias(model, {"shoulder": angles}).T)
    return np.asarray(k1), np.asarray(k3)


@cache
def shoulder_inertia(model: str | Model) -> float:
    """I_sh: an arm about its shoulder, kg m²."""
    return float(st.spin(model, 2, {"shoulder": 0.0}).outboard_inertias["left_shoulder"])


def relative_inertia(model: str | Model, angles: Array) -> Array:
    """I_rel = 2 I_sh/I1: both arms about their shoulders over the whole body's I1.

    So Table 4.3 forms it (§4.4.2) with the arms straight out; figure 5-3 at any angle.
    """
    whole: Array = st.principal_inertias(model, {"shoulder": angles})[..., 0]
    return 2 * shoulder_inertia(model) / whole


# --------------------------------------------------------------------- stabilising springs


@cache
def region(model: str | Model) -> Array:
    """Whether the five-d.o.f. system is stable, at (SPRINGS, ANGLES)."""
    chart = st.chart(model, (ANGLE, ANGLES), (STIFFNESS, SPRINGS))
    return np.asarray(chart.stable.values)


@cache
def springs(model: str | Model, angle: float = STRAIGHT) -> tuple[tuple[float, float], ...]:
    """The ranges of K_sh within −2 to 4 that stabilise it at an arm angle."""
    return tuple(st.stable_ranges(model, (STIFFNESS, LOW, HIGH), fixed={ANGLE: angle}))


def edges(model: str | Model) -> tuple[Array, Array]:
    """Least and greatest stable K_sh at each of ANGLES, to 1e-8; NaN where there is none.

    At every angle the dolls and the human have one range or none.
    """
    every = st.stable_ranges_by_case(
        model, (STIFFNESS, LOW, HIGH), fixed={ANGLE: ANGLES}, samples=len(SPRINGS)
    )
    ends = np.array(
        [(ranges[0][0], ranges[-1][1]) if ranges else (np.nan, np.nan) for ranges in every]
    )
    return ends[:, 0], ends[:, 1]


def width(model: str | Model, angle: float = STRAIGHT) -> float:
    """How much of K_sh stabilises it at an arm angle."""
    return sum(high - low for low, high in springs(model, angle))


def with_smaller_arms(model: str, relative: float) -> Model:
    """A model whose arms are lighter, by a common factor, so that I_rel is as given at STRAIGHT.

    What the arms lose the body gains, so the whole body's mass, k1 and k3 stay: a change of
    I_rel and of nothing else that figures 5-2 and 5-3 compare.
    """
    whole = load(model)
    body, *arms = whole.bodies
    pose = {"shoulder": STRAIGHT}
    before = st.principal_inertias(whole, pose)
    share = relative / float(relative_inertia(model, np.array(STRAIGHT)))
    small = [
        replace(
            arm,
            mass=arm.mass * share,
            inertia=_rows(share * np.array(arm.inertia)),
        )
        for arm in arms
    ]
    heavy = replace(body, mass=body.mass + (1 - share) * sum(arm.mass for arm in arms))
    lacking = before - st.principal_inertias(replace(whole, bodies=(heavy, *small)), pose)
    inertia = np.array(heavy.inertia) + np.diag(lacking)
    filled = replace(heavy, inertia=_rows(inertia))
    return replace(whole, name=f"{model}, smaller arms", bodies=(filled, *small))


def _rows(matrix: Array) -> Any:
    return tuple(tuple(float(value) for value in row) for row in matrix)
