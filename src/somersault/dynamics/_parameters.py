"""The numbers of a model that can stay open in its equations, and how they are spelled.

They are spelled as in a SPEC file: "bodies.torso.mass", "bodies.torso.com.1",
"bodies.torso.inertia.12", "bodies.torso.position.2", "joints.knee.stiffness", "joints.knee.rest",
"joints.knee.damping".

A body whose mass is open keeps its shape, lighter or denser: its moments of inertia go along with
the mass, unless one of them is open too, in which case all are as they are given.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from somersault._core.checks import instance, text
from somersault.model import Body, Model

_OF_A_BODY = re.compile(r"bodies\..+\.(mass|com|inertia|position)(?:\.\d+)?")
_OF_JOINTS = ("stiffness", "rest", "damping")


def body_parameter(body: str, kind: str, part: str = "") -> str:
    """The name of a body's number: of `kind` mass, com, inertia or position, and its `part`."""
    return f"bodies.{body}.{kind}.{part}" if part else f"bodies.{body}.{kind}"


def joint_parameter(joint: str, kind: str) -> str:
    """The name of a joint's stiffness, rest or damping."""
    return f"joints.{joint}.{kind}"


def body_kind(name: str) -> str | None:
    """What a parameter's name says of a body.

    Parameters
    ----------
    name : str
        As in `parameter_values`.

    Returns
    -------
    str or None
        "mass", "com", "inertia" or "position"; None for a name of anything else.
    """
    match = _OF_A_BODY.fullmatch(text("name", name))
    return None if match is None else match[1]


def parameter_values(model: Model) -> dict[str, float]:
    """Every number of a model that can stay open in its equations, by its name.

    Parameters
    ----------
    model
        The model.

    Returns
    -------
    dict
        From names such as "bodies.torso.mass" to the numbers that the model has, in SI units.
    """
    instance("model", model, Model)
    values = {
        body_parameter(body.name, kind, part): value
        for body, kind, part, value in body_numbers(model)
    }
    for joint in model.joints:
        for kind in _OF_JOINTS:
            if kind != "rest" or joint.kind != "ball":
                values[joint_parameter(joint.name, kind)] = float(getattr(joint, kind))
    return values


def body_numbers(model: Model) -> Iterator[tuple[Body, str, str, float]]:
    """Body, kind, part and value of every number of a model's bodies."""
    for index, body in enumerate(model.bodies):
        if index or not model.free:  # a free base is where it is
            for k in range(3):
                yield body, "position", str(k + 1), body.position[k]
        yield body, "mass", "", body.mass
        for k in range(3):
            yield body, "com", str(k + 1), body.com[k]
        for i in range(3):
            for j in range(i, 3):
                yield body, "inertia", f"{i + 1}{j + 1}", body.inertia[i][j]
