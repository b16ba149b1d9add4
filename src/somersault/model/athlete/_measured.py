"""An athlete from 95 measurements, weighed by the `yeadon` package."""

from __future__ import annotations

import contextlib
import io
import os
import warnings
from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import Any, Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault.model._model import Model
from somersault.model.athlete._athlete import Part, Physique, Shoulders, athlete_model, joined
from somersault.model.athlete._figure import BALL, CLOTH, SKIN, solid, stadium
from somersault.model.athlete._measurements import read_measurements
from somersault.model.shapes import Color, Mesh

Densities = Literal["Chandler", "Clauser", "Dempster"]

# yeadon's axes are 1 left, 2 back, 3 head.
_TO_THE_NECK, _TO_THE_ANKLE = 2, 2  # solids of its chest and head, and of its shank and foot
_AXES = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def athlete_from_measurements(
    source: str | os.PathLike[str] | Mapping[str, float],
    *,
    mass: float | None = None,
    densities: Densities = "Dempster",
    shoulders: Shoulders = "hinges",
    knees: bool = False,
    ankles: bool = False,
    name: str = "athlete",
) -> Model:
    """A gymnast of the shape that 95 measurements give, with thirteen joints.

    The torso twists at the level of the nipples, as in Yeadon's model (1990, J. Biomech. 23, 67).
    Left and right are averaged. What the `yeadon` package had to mend (a cross-section that no
    stadium has) is a SomersaultWarning.

    Parameters
    ----------
    source : path, or mapping of str to float
        A file as yeadon reads it, or metres by the measurements' names.
    mass : float, optional
        kg, to which all densities are scaled; by default the file's `totalmass`, else what follows
        from `densities`.
    densities : {"Dempster", "Chandler", "Clauser"}
        kg/m³ by segment.
    shoulders, knees, ankles, name
        As in `athlete`.

    Returns
    -------
    Model

    Raises
    ------
    SomersaultError
        If yeadon is not installed, for a file or measurement that cannot be used, measurements that
        enclose no body, and a mass outside 10 to 250 kg.

    Examples
    --------
    >>> import somersault as so
    >>> so.athlete_from_measurements("me.txt", mass=62.0).mass  # doctest: +SKIP
    62.0
    """
    try:
        human_type = import_module("yeadon").Human
    except ImportError:
        raise SomersaultError(
            "measurements need the yeadon package; pip install somersault[yeadon]"
        ) from None
    if not isinstance(densities, str) or densities not in ("Chandler", "Clauser", "Dempster"):
        raise SomersaultError(
            f"densities is {shown(densities)}; give 'Chandler', 'Clauser' or 'Dempster'"
        )
    metres, measured = read_measurements(source, human_type.measnames)
    human = _weighed(human_type, metres, densities)
    wanted = measured if mass is None else mass
    scale = 1.0 if wanted is None else _mass(wanted) / human.mass
    return athlete_model(name, _physique(human, scale), shoulders, knees, ankles)


def _mass(value: Any) -> float:
    if isinstance(value, (int, float, np.number)) and 10 <= value <= 250:
        return float(value)
    raise SomersaultError(f"mass is {shown(value)}; give 10 to 250 kg")


def _weighed(human_type: Any, metres: dict[str, float], densities: str) -> Any:
    """A yeadon Human of those measurements, every solid of which has a mass.

    The mass is not scaled there: yeadon would keep the scaled densities for the next human.
    """
    with warnings.catch_warnings(record=True) as mended, contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("always")
        try:
            human = human_type(dict(metres), density_set=densities)
        except Exception as error:  # whatever it meets in numbers that are no body
            reason = " ".join(str(error).split()).rstrip(".")[:200] or type(error).__name__
            raise SomersaultError(
                f"the measurements make no body: {reason}; correct them"
            ) from None
    hollow = [
        solid.label
        for segment in human.segments
        for solid in segment.solids
        if not (solid.mass > 0 and solid.height > 0)
    ]
    if hollow:
        raise SomersaultError(
            f"the measurements leave the solid {hollow[0]!r} no volume; correct the lengths there"
        )
    stadia = sum("is defined incorrectly" in " ".join(str(w.message).split()) for w in mended)
    if stadia:
        note(
            f"{stadia} cross-sections have a perimeter that is not 2 to π times their width; "
            "yeadon took circles for them"
        )
    return human


def _physique(human: Any, scale: float) -> Physique:
    """Of a human who stands as yeadon draws it: every segment's axes parallel."""

    def place(segment: Any) -> Array:
        return _AXES @ segment.pos[:, 0]

    def part(segment: Any, clothed: int) -> Part:
        com, inertia = segment.rel_center_of_mass[:, 0], segment.rel_inertia
        return Part(scale * segment.mass, com, scale * inertia, _solids(segment, clothed)).turned(
            _AXES
        )

    def piece(segment: Any, solids: slice) -> Part:
        """Some solids of a leg's segment."""
        ends = -np.cumsum([one.height for one in segment.solids])  # under its inner joint
        parts = [
            Part(
                scale * one.mass,
                one.rel_center_of_mass[:, 0] + [0.0, 0.0, end],
                scale * one.rel_inertia,
            )
            for one, end in list(zip(segment.solids, ends, strict=True))[solids]
        ]
        return joined(*parts).turned(_AXES)

    pelvis, thorax, chest = human.P, human.T, human.C
    leg, foot = (shape.placed(np.zeros(3), _AXES) for shape in _solids(human.J2, _TO_THE_ANKLE))
    return Physique(
        lower=joined(part(pelvis, 2), part(thorax, 1).moved(place(thorax))),
        upper=part(chest, _TO_THE_NECK),
        upper_arm=part(human.A1, 0),
        forearm=part(human.A2, 0),
        thigh=part(human.J1, 3),
        shank=piece(human.J2, slice(_TO_THE_ANKLE)).looking(leg),
        foot=piece(human.J2, slice(_TO_THE_ANKLE, None)).looking(foot),
        twist=float(place(chest)[2]),
        shoulder=place(human.A1) - place(chest),
        hip=place(human.J1),
        upper_arm_length=human.A1.length,
        thigh_length=human.J1.length,
        shank_length=float(sum(one.height for one in human.J2.solids[:_TO_THE_ANKLE])),
    )


def _solids(segment: Any, clothed: int) -> tuple[Mesh, ...]:
    """Through all the cross-sections of a segment, in its own axes: so many of its solids, from the
    inner joint on, in clothes, and the rest bare."""
    groups = ((segment.solids[:clothed], CLOTH), (segment.solids[clothed:], SKIN))
    return tuple(_solid(segment, solids, color) for solids, color in groups if solids)


def _solid(segment: Any, solids: Sequence[Any], color: Color) -> Mesh:
    """Through the cross-sections of some of its solids, rounded at a joint's ball."""
    rings: list[Array] = []
    radius = 0.0
    for part in sorted(solids, key=lambda part: part.pos[2, 0]):
        low = float(part.pos[2, 0] - segment.pos[2, 0])
        if not hasattr(part, "stads"):  # the top of the head
            return solid(rings, color, above=part.height)
        for level, section in zip((low, low + part.height), part.stads, strict=True):
            along = 0 if section.alignment == "ML" else 1  # yeadon's axis 1 is the left
            ring = stadium(section.radius, section.thickness, level, along)
            radius = section.radius
            if not rings or not np.allclose(ring, rings[-1]):
                rings.append(ring)
    jointed = segment.label[0] in "AJK" and solids[0] is segment.solids[0]
    return solid(rings, color, above=BALL * radius if jointed else 0.0)
