"""From the names of numbers to the numbers of a takeoff that they mean."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.dynamics._tree import parameter_names
from somersault.ensembles._vary import Vary
from somersault.flight._values import Name
from somersault.flight._values import Values as Numbers
from somersault.model import Model
from somersault.model._mirror import sides

_JOINT = re.compile(
    r"^joints\.(.+)\.(angle|rate|stiffness|damping|rest|pretension|times|angles)(?:\.(\d+))?$"
)
_BODY = re.compile(r"^bodies\.(.+)\.(?:(mass)|(com|position)\.([123]))$")
_TAKEOFF = re.compile(r"^takeoff\.(\w+)(?:\.([123]))?$")
_SIGNED = ("angle", "rate", "rest", "pretension", "angles")
_ABOUT = ("angle", "rest", "angles")  # mirrored about the pose in which the file draws the joint


@dataclass(frozen=True)
class Target:
    """A number of the takeoff that becomes factor · value + offset, or to which that is added."""

    name: Name
    factor: float
    offset: float


def targets(model: Model, values: Numbers, where: str, vary: Vary) -> tuple[Target, ...]:
    """All the numbers that a varied quantity moves; SomersaultError for one that is not there."""
    found = [t for path in vary.targets for t in _targets(model, values, where, path)]
    return tuple(
        Target(t.name, t.factor * vary.scale, 0.0 if vary.adds_to else t.offset) for t in found
    )


def _targets(model: Model, values: Numbers, where: str, path: str) -> list[Target]:
    if match := _TAKEOFF.match(path):
        what, k = match.groups()
        name: Name = (what, int(k)) if k else ("takeoff", what)
        if name not in values:
            there = [_spelled(n) for n in values if n[0] in ("takeoff", *_VECTORS)]
            raise SomersaultError(
                f"{where}: {path} is no number of this takeoff; it has {', '.join(there)}"
            )
        return [Target(name, 1.0, 0.0)]
    if match := _JOINT.match(path):
        return _of_joint(model, values, where, path, *match.groups())
    if match := _BODY.match(path):
        return _of_body(model, where, *match.groups())
    raise SomersaultError(
        f"{where}: {path!r} names no number; names are like takeoff.tilt, joints.JOINT.stiffness, "
        "joints.JOINT.times.2, bodies.BODY.mass"
    )


_VECTORS = ("angular_velocity", "angular_momentum")


def _spelled(name: Name) -> str:
    parts = name if name[0] == "takeoff" else ("takeoff", *name)
    return ".".join(str(part) for part in parts)


def _of_joint(
    model: Model, values: Numbers, where: str, path: str, joint: str, what: str, k: str | None
) -> list[Target]:
    found = []
    for name, (factor, offset) in sides(model, joint).items():
        try:
            model.joint(name)
        except SomersaultError as mistake:
            raise SomersaultError(f"{where}: {mistake}") from None
        known: list[Name] = [(what, name, int(k))] if k else _every(values, what, name)
        if not known or any(n not in values for n in known):
            there = sorted(
                {".".join(str(x) for x in (n[0], *n[2:])) for n in values if name in n[1:2]}
            )
            raise SomersaultError(
                f"{where}: {path} is no number of this takeoff; joint {name} has {', '.join(there)}"
            )
        by, about = factor if what in _SIGNED else 1.0, offset if what in _ABOUT else 0.0
        found += [Target(n, by, about) for n in known]
    return found


def _every(values: Numbers, what: str, joint: str) -> list[Name]:
    return [n for n in values if n[:2] == (what, joint)]


def _of_body(
    model: Model, where: str, body: str, mass: str | None, what: str | None, k: str | None
) -> list[Target]:
    names = [b.name for b in model.bodies]
    if body not in names:
        raise SomersaultError(f"{where}: there is no body {body!r}; there are {', '.join(names)}")
    if not mass:
        if f"{what}.{body}.{k}" not in parameter_names(model):
            raise SomersaultError(f"{where}: {body} is the base, which has no position to vary")
        return [Target((f"{what}.{body}.{k}",), 1.0, 0.0)]
    own = model.bodies[names.index(body)]
    if own.mass <= 0:
        raise SomersaultError(f"{where}: body {body} has no mass, so none can be varied")
    inertia = np.asarray(own.inertia)
    # The same shape, denser: moments of inertia go with the mass.
    return [Target((f"mass.{body}",), 1.0, 0.0)] + [
        Target((f"inertia.{body}.{i + 1}{j + 1}",), float(inertia[i, j]) / own.mass, 0.0)
        for i in range(3)
        for j in range(i, 3)
        if inertia[i, j] != 0
    ]


_UNITS = {  # of what is no joint's
    "somersault": "rad", "tilt": "rad", "twist": "rad", "spin": "rad/s", "tilt_rate": "rad/s",
    "twist_rate": "rad/s", "angular_velocity": "rad/s", "angular_momentum": "kg m2/s",
    "mass": "kg", "com": "m", "position": "m",
}  # fmt: skip
_JOINT_UNITS = {  # of a hinge or a ball, and of a slide
    "angle": ("rad", "m"), "angles": ("rad", "m"), "rest": ("rad", "m"), "times": ("s", "s"),
    "rate": ("rad/s", "m/s"), "stiffness": ("N m/rad", "N/m"),
    "damping": ("N m s/rad", "N s/m"), "pretension": ("N m", "N"),
}  # fmt: skip


def unit(model: Model, vary: Vary, moved: tuple[Target, ...]) -> str:
    """The unit of a varied quantity: as given, else that of all the numbers that it moves, where
    they have the same and no scale comes between; else ""."""
    if vary.unit or vary.scale != 1:
        return vary.unit
    units = {_unit(model, t.name) for t in moved if not str(t.name[0]).startswith("inertia.")}
    return units.pop() if len(units) == 1 else ""


def _unit(model: Model, name: Name) -> str:
    what = str(name[1] if name[0] == "takeoff" else name[0]).split(".")[0]
    if what in _JOINT_UNITS:
        return _JOINT_UNITS[what][model.joint(str(name[1])).kind == "slide"]
    return _UNITS[what]


def check_apart(vary: Mapping[str, Vary], where: Mapping[str, tuple[Target, ...]]) -> None:
    """SomersaultError where two varied quantities set the same number."""
    owner: dict[Name, str] = {}
    for name, group in where.items():
        for target in group if vary[name].sets else ():
            if target.name in owner:
                raise SomersaultError(
                    f"vary.{owner[target.name]} and vary.{name} set the same number; "
                    "let one of them be added to it"
                )
            owner[target.name] = name


def body_names(moved: Mapping[str, tuple[Target, ...]]) -> tuple[str, ...]:
    """Names of the bodies' numbers among targets, as `Equations` has them."""
    starts = ("mass.", "inertia.", "com.", "position.")
    names = [str(t.name[0]) for group in moved.values() for t in group]
    return tuple(dict.fromkeys(n for n in names if n.startswith(starts)))


def moved(
    values: Numbers, vary: Mapping[str, Vary], where: Mapping[str, tuple[Target, ...]],
    given: Mapping[str, Array],
) -> dict[Name, float | Array]:  # fmt: skip
    """The numbers, with those that are varied as arrays over the flights."""
    result = dict(values)
    for name in sorted(where, key=lambda name: bool(vary[name].adds_to)):  # what is set, first
        for target in where[name]:
            value = target.factor * given[name] + target.offset
            before = result[target.name] if vary[name].adds_to else 0.0
            result[target.name] = before + value
    return result
