"""An athlete from height and mass alone, with the proportions of de Leva's table."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import one_of, shown
from somersault._core.errors import SomersaultError
from somersault.model._model import Model
from somersault.model.athlete._athlete import HEAD, Part, Physique, Shoulders, athlete_model, joined
from somersault.model.athlete._de_leva import (
    HEEL_BEHIND_ANKLE,
    HIP_HALF_WIDTH,
    MALE,
    SHOULDER_HALF_WIDTH,
    TABLES,
    Table,
)
from somersault.model.athlete._figure import (
    CLOTH,
    SKIN,
    ellipse,
    far_end,
    foot,
    head,
    solid,
    tapered,
    trunk_half_axes,
)


def athlete(
    height: float,
    mass: float,
    sex: Literal["male", "female"] = "male",
    *,
    shoulders: Shoulders = "hinges",
    knees: bool = False,
    ankles: bool = False,
    name: str = "athlete",
) -> Model:
    """A gymnast of a height and mass, with thirteen joints.

    Masses, centres of mass, radii of gyration and lengths are those of the table of de Leva (1996),
    every length in proportion to the height and every mass to the mass. Joint names, signs and what
    is assumed: docs/athletes.md.

    Parameters
    ----------
    height : float
        0.5 to 2.5 m.
    mass : float
        10 to 250 kg.
    sex : {"male", "female"}
    shoulders : {"hinges", "ball"}
        Three hinges each, or a ball.
    knees : bool
        Whether each leg has a hinge there; else it is straight.
    ankles : bool
        Whether each foot has a hinge; else it is pointed. At 0 it is in line with the shank.
    name : str
        The model's.

    Returns
    -------
    Model

    Raises
    ------
    SomersaultError
        For a height or mass outside those ranges, or another sex or kind of shoulder.

    Examples
    --------
    >>> import somersault as so
    >>> so.athlete(1.62, 55.0, "female", knees=True, name="Ana")
    <Model 'Ana': 10 bodies, 15 joints, 55 kg, free>
    """
    one_of("sex", sex, TABLES)
    tall = _within("height", height, "m", 0.5, 2.5)
    heavy = _within("mass", mass, "kg", 10.0, 250.0)
    return athlete_model(name, _physique(TABLES[sex], tall, heavy), shoulders, knees, ankles)


def _within(what: str, value: float, unit: str, least: float, most: float) -> float:
    try:
        number = math.nan if isinstance(value, bool | np.bool_) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if least <= number <= most:
        return number
    hint = "; it looks like centimetres" if what == "height" and 50 <= number <= 250 else ""
    raise SomersaultError(f"{what} is {shown(value)}{hint}; give {least:g} to {most:g} {unit}")


def _physique(table: Table, height: float, mass: float) -> Physique:
    size = height / table.height
    breadth = height / MALE.height  # of the few lengths that are not in the table
    row = table.segments
    single = ("head", "upper_trunk", "middle_trunk", "lower_trunk")
    share = sum((1 if kind in single else 2) * s.mass for kind, s in row.items() if kind != "trunk")

    def length(kind: str) -> float:
        return size * row[kind].length

    def hung(kind: str, top: float = 0.0) -> Part:
        """A segment that runs down from a height over the point it is seen from."""
        heavy = mass * row[kind].mass / share  # the women's rows add up to 99.99 %
        com = (top - row[kind].com / 100 * length(kind)) * HEAD
        inertia = np.diag(row[kind].inertia(heavy, length(kind)))
        limb = kind not in single
        color = CLOTH if kind in ("thigh", "shank") else SKIN
        shapes = (tapered(row[kind], heavy, length(kind), top, color),) if limb else ()
        return Part(heavy, com, inertia, shapes)

    def half_axes(kind: str) -> Array:
        return trunk_half_axes(row[kind], mass * row[kind].mass / share, length(kind))

    lower, middle, upper = (length(f"{k}_trunk") for k in ("lower", "middle", "upper"))
    hips, waist, chest = (half_axes(f"{k}_trunk") for k in ("lower", "middle", "upper"))
    ribs = (waist + chest) / 2
    skull = head(row["head"], length("head"), upper + length("head"))
    throat = np.full(2, 0.6 * skull.semi_axes[1])
    pelvis = [
        ellipse(0.75 * hips, 0.0),
        ellipse(hips, 0.5 * lower),
        ellipse(waist, lower + 0.5 * middle),
        ellipse(ribs, lower + middle),
    ]
    collar = 0.5 * throat + 0.5 * 0.9 * chest
    torso = [
        ellipse(ribs, 0.0),
        ellipse(chest, 0.45 * upper),
        ellipse(0.9 * chest, 0.8 * upper),
        ellipse(collar, 0.9 * upper),
    ]
    neck = [
        ellipse(collar, 0.9 * upper),
        ellipse(throat, upper),
        ellipse(throat, upper + 0.5 * skull.semi_axes[2]),
    ]
    ankle = HEEL_BEHIND_ANKLE * breadth
    bare = foot(
        row["foot"],
        mass * row["foot"].mass / share,
        length("foot"),
        far_end(row["shank"], mass * row["shank"].mass / share, length("shank")),
        ankle - length("foot"),
    ).placed(-length("shank") * HEAD, np.eye(3))
    return Physique(
        lower=joined(hung("lower_trunk", lower), hung("middle_trunk", lower + middle)).looking(
            solid(pelvis, CLOTH, below=0.06 * size)
        ),
        upper=joined(hung("upper_trunk", upper), hung("head", upper + length("head"))).looking(
            solid(torso, CLOTH), solid(neck, SKIN), skull
        ),
        upper_arm=hung("upper_arm"),
        forearm=joined(hung("forearm"), hung("hand", -length("forearm"))),
        thigh=hung("thigh"),
        shank=hung("shank"),
        foot=hung("foot", ankle - length("shank")).looking(bare),
        twist=lower + middle,
        shoulder=np.array(
            [
                0.0,
                breadth * SHOULDER_HALF_WIDTH,
                size * table.shoulder_height - lower - middle,
            ]
        ),
        hip=np.array([0.0, breadth * HIP_HALF_WIDTH, 0.0]),
        upper_arm_length=length("upper_arm"),
        thigh_length=length("thigh"),
        shank_length=length("shank"),
    )
