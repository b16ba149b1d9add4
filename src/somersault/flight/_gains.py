"""A number of each joint: one for all of them, or by joint."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase

from somersault._core.checks import by_name
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.model import Model, named_pairs, sides


def each(
    what: str, given: float | Mapping[str, float], model: Model, joints: Sequence[str]
) -> dict[str, float]:
    """The number of each of some joints, by name.

    A mapping has it by joint, by the name that a pair shares, or by one with a * for joints alike.
    SomersaultError for a name that fits none of them, and for a joint with none or two.
    """
    if not isinstance(given, Mapping):
        return dict.fromkeys(joints, number(what, given))
    values: dict[str, float] = {}
    pairs = named_pairs(model)
    for name, value in by_name(what, given).items():
        pair = sides(model, name) if name in pairs else ()
        meant = [joint for joint in joints if joint in pair or fnmatchcase(joint, name)]
        if not meant:
            raise SomersaultError(
                f"{what}: {name} is none of the joints on paths; there are {', '.join(joints)}"
            )
        for joint in meant:
            if joint in values:
                raise SomersaultError(f"{what}: joint {joint} is given twice, by {name} too")
            values[joint] = number(f"{what} {name}", value)
    left = [joint for joint in joints if joint not in values]
    if left:
        raise SomersaultError(f"{what} is given by joint, but not of {', '.join(left)}")
    return values
