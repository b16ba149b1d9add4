"""Table 5.1: the dolls' body parameters, and how they follow from each other."""

from __future__ import annotations

import numpy as np

from somersault import stability as st
from somersault.model import load
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import MODEL, NOMINAL
from somersault.thesis.ch5._doll import (
    BARE,
    PRINTED_I_SH,
    TABLE_5_1,
    WEIGHT,
    WEIGHTED,
    as_printed,
    composed_arm,
    parameters,
    shoulder_inertia,
)

_COPIED = "A transcription: the model was made with this number."


def table_5_1() -> Result:
    """The dolls' numbers as the shipped models have them, and as they follow from each other."""
    bare, loaded = parameters(BARE), parameters(WEIGHTED)
    centre, inertia = composed_arm()
    where = "Table 5.1"
    misprint = (
        f"A misprint (errata): the bare arm and 30 g at 0.043 m balance at {centre:.4f} m, and "
        "only then is I_sh the 3.021e-4 kg m² of §5.5; with 0.0572 m it would be "
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
        "table, so each parameter's claim only says that it was copied without a slip. What could "
        "fail are the checks at the end, of these numbers against each other and against numbers "
        "printed elsewhere. The models carry all of the table's numbers but one: rl3 = 0.0572 m of "
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
