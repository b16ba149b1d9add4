"""Whether a model is made of what models are made of: texts, numbers and bodies, all values.

What the numbers and names may be is another question (`_refused.py`).
"""

from __future__ import annotations

from typing import Any

from somersault._core.checks import instance, shown, text, truth
from somersault._core.errors import SomersaultError
from somersault._core.numbers import as_floats
from somersault.model._bodies import Body, Follow, Joint

# Of each class the fields that hold numbers, and their shapes.
_NUMBERS: dict[type, dict[str, tuple[int, ...]]] = {
    Body: {"mass": (), "com": (3,), "inertia": (3, 3), "position": (3,), "rotation": (3, 3)},
    Joint: {
        "axis": (3,), "anchor": (3,), "reference": (), "stiffness": (), "rest": (), "damping": (),
        "armature": (),
    },
    Follow: {"factor": (), "offset": ()},
}  # fmt: skip


def check_types(name: str, free: bool, bodies: tuple[Body, ...]) -> None:
    """SomersaultError, naming the field, for what is of another kind than its field holds."""
    text("the name of a model", name)
    truth(f"{name}: free", free)
    for body in _all(f"{name}: bodies", bodies, Body):
        where = f"{name}: body {text('the name of a body', body.name)!r}"
        _check_numbers(where, body)
        if isinstance(body.parent, bool) or not isinstance(body.parent, int):
            raise SomersaultError(
                f"{where}: parent must be the place of a body, and is {shown(body.parent)}"
            )
        text(f"{where}: inertia_from", body.inertia_from)
        _all(f"{where}: shapes", body.shapes, object)
        for joint in _all(f"{where}: joints", body.joints, Joint):
            _check_joint(name, joint)


def _check_joint(name: str, joint: Joint) -> None:
    where = f"{name}: joint {text('the name of a joint', joint.name)!r}"
    text(f"{where}: kind", joint.kind)
    _check_numbers(where, joint)
    if joint.limits is not None:
        _check_shape(f"{where}: limits", joint.limits, (2,))
    if joint.follows is not None:
        instance(f"{where}: follows", joint.follows, Follow)
        text(f"{where}: leader", joint.follows.leader)
        _check_numbers(where, joint.follows)


def _check_numbers(where: str, thing: Any) -> None:
    for name, shape in _NUMBERS[type(thing)].items():
        _check_shape(f"{where}: {name}", getattr(thing, name), shape)


def _check_shape(what: str, value: Any, shape: tuple[int, ...]) -> None:
    array = as_floats(value)
    plain = isinstance(value, tuple) if shape else not isinstance(value, bool)
    if array is None or array.shape != shape or not plain:
        wanted = f"a tuple of {' x '.join(map(str, shape))} numbers" if shape else "a number"
        raise SomersaultError(f"{what} must be {wanted}, and is {shown(value)}")


def _all(what: str, values: Any, kind: type) -> tuple[Any, ...]:
    if not isinstance(values, tuple) or not all(isinstance(value, kind) for value in values):
        name = "values" if kind is object else f"somersault.{kind.__name__}"
        raise SomersaultError(f"{what} must be a tuple of {name}, and is {shown(values)}")
    return values
