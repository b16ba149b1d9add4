"""How the numbers of a joint's behaviour are declared: once each, as fields of its class.

From the declaration follow the keys of a SPEC, what a mirrored joint gets, which numbers an
ensemble may vary and their units.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name
from somersault._core.degrees import note_degrees
from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault._core.numbers import number, numbers
from somersault.flight.behaviours._limits import within
from somersault.model import Joint
from somersault.simulation import Name, Numbers

_KEY = "quantity"
Image = Literal["same", "turned", "angle"]


class Table(dict[str, float]):
    """Numbers by name, which do not change."""

    def __hash__(self) -> int:  # type: ignore[override]
        return hash(tuple(self.items()))


@dataclass(frozen=True)
class Quantity:
    """What is known of a number, or of a row of them.

    `unit` of a hinge, `slide_unit` of a slide. `image` says what the mirrored joint gets: the
    "same" number, one "turned" over with the joint's rate, or an "angle" about the pose in which
    the file draws the joint. A `row` has several, a `table` several by name. `least` is the
    smallest that makes sense, and what is below `usual` is noted. A `limited` one must be within
    the joint's limits at takeoff.
    """

    unit: str
    slide_unit: str
    image: Image = "same"
    row: bool = False
    least: float | None = None
    limited: bool = False
    usual: float | None = None
    table: bool = False


def quantity(
    unit: str,
    slide_unit: str | None = None,
    *,
    default: Any = None,
    image: Image = "same",
    row: bool = False,
    least: float | None = None,
    limited: bool = False,
    usual: float | None = None,
    table: bool = False,
    kw_only: bool = True,
) -> Any:
    """Declare a field that is a number, or a row of numbers.

    Parameters
    ----------
    unit, slide_unit : str
        Of a hinge, and of a slide where that is another.
    default
        What the field has where nothing is given.
    image : {"same", "turned", "angle"}
    row : bool
    least : float, optional
    limited : bool
    usual : float, optional
    table : bool
        As in `Quantity`.
    kw_only : bool
        Whether it is given by name only.

    Returns
    -------
    dataclasses.Field
    """
    declared = Quantity(unit, slide_unit or unit, image, row, least, limited, usual, table)
    return field(default=default, kw_only=kw_only, metadata={_KEY: declared})


def angle(**options: Any) -> Any:
    """A joint's coordinate at takeoff: rad, m; a rotation vector for a ball."""
    return quantity("rad", "m", image="angle", limited=True, kw_only=False, **options)


def rate(**options: Any) -> Any:
    """A joint's speed at takeoff."""
    return quantity("rad/s", "m/s", default=0.0, image="turned", kw_only=False, **options)


def stiffness(**options: Any) -> Any:
    """A spring's stiffness."""
    return quantity("N m/rad", "N/m", usual=0.0, **options)


def damping(**options: Any) -> Any:
    """A damper's constant."""
    return quantity("N m s/rad", "N s/m", least=0.0, **options)


def rest(**options: Any) -> Any:
    """The coordinate at which a spring is slack."""
    return quantity("rad", "m", image="angle", **options)


def torque(**options: Any) -> Any:
    """A torque, or a slide's force."""
    return quantity("N m", "N", default=options.pop("default", 0.0), image="turned", **options)


def declared(kind: Any) -> dict[str, Quantity]:
    """The quantities that a behaviour declares.

    Parameters
    ----------
    kind : JointTakeoff, or its class

    Returns
    -------
    dict of str to Quantity
    """
    return {f.name: f.metadata[_KEY] for f in fields(kind) if _KEY in f.metadata}


# ------------------------------------------------------------------ numbers, checked and by name


def checked_all(where: str, does: Any, joint: Joint | None = None) -> dict[str, Any]:
    """The declared fields of something as floats.

    Parameters
    ----------
    where : str
        What a message says has them.
    does : JointTakeoff or Law
    joint : Joint, optional
        Whose they are.

    Returns
    -------
    dict of str to float, tuple or Table

    Raises
    ------
    SomersaultError
        Naming the first that is none, or is less than it can be.
    """
    changes: dict[str, Any] = {}
    defaults = {one.name: one.default for one in fields(does)}
    for name, what in declared(does).items():
        given = getattr(does, name)
        value = checked(where, joint, name, what, defaults[name] if given is None else given)
        if what.least is not None and isinstance(value, float) and value < what.least:
            raise SomersaultError(
                f"{where} has the negative {name} {value:g}; give none, or a positive one"
            )
        changes[name] = value
    return changes


def checked(where: str, joint: Joint | None, name: str, what: Quantity, value: Any) -> Any:
    """A value as floats; SomersaultError, naming it, for what is no number of this kind.

    A ball takes three numbers where a hinge takes one.
    """
    label = f"{where}: {name}"
    if value is None:
        return None
    if what.table:
        given = by_name(label, value)
        return Table((key, number(f"{label}.{key}", x)) for key, x in given.items())
    if what.row:
        return tuple(numbers(label, value).tolist())
    if joint is not None and joint.kind == "ball" and name in ("angle", "rate"):
        still = isinstance(value, float | int) and value == 0
        return tuple(numbers(label, (0, 0, 0) if still else value, 3).tolist())
    return number(label, value)


def note_strange(where: str, joint: Joint, name: str, what: Quantity, value: Any) -> None:
    """Note a checked value that looks like degrees, or drives a joint away where others hold it."""
    if value is None:
        return
    bounded = what.limited and joint.limits is not None  # by which it is judged elsewhere
    if what.image == "angle" and joint.kind != "slide" and not bounded:
        note_degrees(f"{where}: {name}", value)
    if what.usual is not None and value < what.usual:
        note(f"{where} has negative {name} ({value:g}), which drives it away from rest")


def sound(
    joint: Joint, known: Mapping[str, Quantity], names: Iterable[Name], values: Numbers, count: int
) -> Array:
    """Whether the numbers of such names are within what is declared of them, (count,)."""
    good = np.ones(count, bool)
    for key in names:
        what, value = known[str(key[0])], np.asarray(values[key])
        if what.limited and joint.kind != "ball":
            good &= within(joint, value)
        if what.least is not None:
            good &= value >= what.least
    return good


def spread(joint: str, name: str, value: Any) -> dict[Name, float]:
    """A quantity's numbers by name: (quantity, joint), or with a place from 1 for one of a row."""
    if value is None:
        return {}
    if isinstance(value, Mapping):
        return {(name, joint, key): x for key, x in value.items()}
    if isinstance(value, tuple):
        return {(name, joint, k + 1): x for k, x in enumerate(value)}
    return {(name, joint): value}


def named(joint: str, parameter: str) -> Name:
    """The name of the number that a parameter of a joint's equations is: "gains.k" is one of a
    table."""
    what, _, key = parameter.partition(".")
    return (what, joint, key) if key else (what, joint)


def side_by_side(values: Numbers, names: list[Name], count: int) -> Array:
    """Some of the numbers of many flights as the columns of an array.

    Parameters
    ----------
    values : mapping of tuple to float or ndarray, (count,)
        The numbers of the flights.
    names : list of tuple
        Those that are wanted.
    count : int
        How many flights.

    Returns
    -------
    ndarray, (count, names)
    """
    result = np.empty((count, len(names)))
    for k, name in enumerate(names):
        result[:, k] = values[name]
    return result
