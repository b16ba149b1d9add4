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
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import ANGLE, GROWS, HIGH, LOW, MODEL, NOMINAL, STIFFNESS

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
    found = {"mb": body.mass, "ml": arm.mass}
    found |= {f"Ib{i + 1}": body.inertia[i][i] for i in range(3)}
    found |= {f"Il{i + 1}": arm.inertia[i][i] for i in range(3)}
    found |= {f"rb{i + 1}": float(arm.position[i] + pin[i] - body.com[i]) for i in range(3)}
    found |= {f"rl{i + 1}": float(pin[i] - arm.com[i]) for i in range(3)}
    return found


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
    found = st.chart(model, (ANGLE, ANGLES), (STIFFNESS, SPRINGS))
    return np.asarray(found.stable.values)


@cache
def springs(model: str | Model, angle: float = STRAIGHT) -> tuple[tuple[float, float], ...]:
    """The ranges of K_sh within −2 to 4 that stabilise it at an arm angle."""
    return tuple(st.stable_ranges(model, (STIFFNESS, LOW, HIGH), fixed={ANGLE: angle}))


def edges(model: str | Model) -> tuple[Array, Array]:
    """Least and greatest stable K_sh at each of ANGLES, to 1e-8; NaN where there is none.

    At every angle the dolls and the human have one range or none.
    """
    inside = region(model)
    some = np.flatnonzero(inside.any(0))
    found = np.full((2, len(ANGLES)), np.nan)
    last = len(SPRINGS) - 1
    first_in = inside[:, some].argmax(0)
    last_in = last - inside[::-1, some].argmax(0)
    for row, (within, beyond) in enumerate(((first_in, first_in - 1), (last_in, last_in + 1))):
        stable, unstable = SPRINGS[within], SPRINGS[np.clip(beyond, 0, last)]
        for _ in range(20):
            middle = (stable + unstable) / 2
            rates = st.growth_rates(model, {ANGLE: ANGLES[some], STIFFNESS: middle})
            stable = np.where(rates <= GROWS, middle, stable)
            unstable = np.where(rates <= GROWS, unstable, middle)
        found[row, some] = stable
    return found[0], found[1]


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


# ----------------------------------------------------------------------------- Table 5.1


def table_5_1() -> Result:
    """The dolls' numbers as the shipped models have them, and as they follow from each other."""
    bare, loaded = parameters(BARE), parameters(WEIGHTED)
    centre, inertia = composed_arm()
    where = "Table 5.1"
    misprint = (
        f"A misprint (errata): the bare arm and 30 g at 0.043 m balance at {centre:.4f} m, and "
        "only so is I_sh the 3.021e-4 kg m² of §5.5; with 0.0572 m it would be "
        f"{1e4 * shoulder_inertia(as_printed()):.3f}e-4. Figure 5-5 shows what else it changes."
    )
    claims, rows = [], []
    for name, (first, second, unit) in TABLE_5_1.items():
        note = misprint if name == "rl3" else _COPIED
        say = f"{name} of the shipped model"
        claims += [
            number(f"table5-1.{name}", where, f"{say} doll", first, bare[name], unit, 0, _COPIED),
            number(
                f"table5-1.{name}-weighted",
                where,
                f"{say} doll_weighted",
                second,
                loaded[name],
                unit,
                0,
                note,
            ),
        ]
        ours, theirs = (f"{table[name]:g}" for table in (bare, loaded))
        rows.append((name, f"{first:g}", ours, f"{second:g}", theirs, unit))
    claims += [
        number(
            "table5-1.weight",
            "§5.2.1",
            "what the threaded weight adds to an arm",
            WEIGHT,
            loaded["ml"] - bare["ml"],
            "kg",
            1e-9,
        ),
        number(
            "table5-1.Il1-composed",
            where,
            "Il1 of the weighted arm, from the bare arm and a 30 g point at 0.043 m",
            TABLE_5_1["Il1"][1],
            inertia,
            "kg m²",
            6e-7,
            "The tolerance is what half a millimetre of the weight's place makes.",
        ),
        number(
            "table5-1.I_sh",
            "§5.5, Table 5.1",
            "inertia of a weighted arm about its shoulder, I_sh",
            PRINTED_I_SH,
            shoulder_inertia(WEIGHTED),
            "kg m²",
            1.5e-6,
            "With rl3 = 0.0622 m; the tolerance is what the rounding of 30 g and 0.043 m makes.",
        ),
        *_same_kind(),
        _scaled(),
    ]
    header = ("parameter", "bare: thesis", "model", "weighted: thesis", "model", "unit")
    return Result(
        "Body parameters of the doll without arm weights and with 30 g on each arm, 0.043 m from "
        "the shoulder. All data of chapter 5 are for the second.",
        "Mostly a transcription: the shipped models doll and doll_weighted were made from this "
        "table, so that each parameter's claim only says that it was copied without a slip. What "
        "could fail are the sums at the end, of numbers printed elsewhere or of each other. The "
        "models carry the table's numbers but one: rl3 = 0.0572 m of "
        f"the weighted arm contradicts the table's own masses, which give {centre:.4f} m.",
        tuple(claims),
        table=Table(header, tuple(rows)),
    )


def _same_kind() -> list[Claim]:
    systems = [st.spin(name, 2, {"shoulder": NOMINAL}).linear() for name in (MODEL, WEIGHTED)]
    human, ours = ([set(group) for group in system.subsystems] for system in systems)
    axes = [joint.axis for joint in load(WEIGHTED).joints if joint.kind == "hinge"]
    frontal = bool(axes) and all(abs(axis[0]) == 1 for axis in axes)
    return [
        statement(
            "table5-1.five",
            "§5.2.1",
            "the doll is a mechanical version of the five-d.o.f. human model",
            "the same five degrees of freedom",
            f"{len(systems[1].coordinates)} coordinates, in the same decoupled parts"
            if ours == human
            else " | ".join(" + ".join(group) for group in systems[1].subsystems),
            ours == human and len(systems[1].coordinates) == 5,
        ),
        statement(
            "table5-1.frontal",
            "§5.1",
            "the springy shoulders allow arm movement in the frontal plane",
            "frontal plane",
            f"{len(axes)} hinges about {'the front axis' if frontal else axes}",
            frontal and len(axes) == 2,
        ),
    ]


def _scaled() -> Claim:
    """The scale of every dimension: masses go as its cube, inertias as its fifth power."""
    human, ours = parameters(MODEL), parameters(BARE)
    power = {"m": 1 / 3, "I": 1 / 5, "r": 1.0}
    scales = {
        name: (ours[name] / human[name]) ** power[name[0]] for name in human if human[name] > 0
    }
    middle = float(np.median(list(scales.values())))
    off = {name: scale for name, scale in scales.items() if abs(scale / middle - 1) > 0.2}
    return statement(
        "table5-1.scaled",
        "§5.2.1",
        "the doll is a scaled version of the human performer",
        "a fifteen inch tall, scaled version",
        f"scales {min(scales.values()):.3f} to {max(scales.values()):.3f}, middle {middle:.3f}; "
        f"further than a fifth from it: "
        + (", ".join(f"{name} {scale:.3f}" for name, scale in off.items()) or "none"),
        not off,
        "Masses, inertias and the shoulders' breadth are scaled, but the arms, plain steel rods, "
        "have their centres of mass further out, and the shoulders sit lower. This is why the arms "
        "weigh more in the inertias than a human's do (figures 5-2 and 5-3).",
    )
