"""From names like "joints.shoulder.stiffness" to the numbers of a takeoff that they mean."""

from __future__ import annotations

import re
from collections.abc import Iterable
from fnmatch import fnmatchcase

from somersault._core.checks import shown, text
from somersault._core.errors import SomersaultError
from somersault.dynamics import parameter_values
from somersault.flight._batch import Batch
from somersault.flight._plane import leaves_plane
from somersault.flight._replay import Replay
from somersault.flight.behaviours import Coupled, declared
from somersault.model import Model, sides
from somersault.simulation import Name, Target

_JOINT = re.compile(r"^joints\.(.+)\.([^\W\d]\w*)(?:\.(\d+))?$")
_OF_TABLE = re.compile(r"^joints\.(.+)\.([^\W\d]\w*)\.(\w+)$")
_REPLAY = re.compile(r"^replay\.(\w+)(?:\.(.+))?$")
_BODY = re.compile(r"^bodies\.(.+)\.(?:(mass)|(com|position)\.([123]))$")
_TAKEOFF = re.compile(r"^takeoff\.(\w+)(?:\.([123]))?$")
_VECTORS = ("angular_velocity", "angular_momentum")
_UNITS = {
    "somersault": "rad", "tilt": "rad", "twist": "rad", "spin": "rad/s", "tilt_rate": "rad/s",
    "twist_rate": "rad/s", "noise": "1", "angular_velocity": "rad/s", "angular_momentum": "kg m2/s",
}  # fmt: skip


def targets(batch: Batch, path: str) -> tuple[Target, ...]:
    """The numbers that a name means, of the flights of a batch.

    Raises
    ------
    SomersaultError
        For a name that is not there.
    """
    text("the name of a number", path)
    if "*" in path:
        return _of_joints_alike(batch, path)
    if match := _TAKEOFF.match(path):
        return _of_takeoff(batch, path, *match.groups())
    if match := _REPLAY.match(path):
        return _of_replay(batch, path, *match.groups())
    match = _OF_TABLE.match(path)
    if not (match and _is_joint(batch.model, match[1])):  # whose name may have dots
        match = _JOINT.match(path)
    if match:
        return _of_joint(batch, path, *match.groups())
    if match := _BODY.match(path):
        return _of_body(batch.model, *match.groups())
    raise SomersaultError(
        f"{shown(path)} names no number; names are like takeoff.tilt, joints.JOINT.stiffness, "
        "joints.JOINT.times.2, replay.gains.k, bodies.BODY.mass"
    )


def body_names(names: Iterable[Name]) -> tuple[str, ...]:
    """Those of some names that are the bodies' numbers, as `Equations` has them."""
    return tuple(str(name[0]) for name in names if str(name[0]).startswith("bodies."))


def _of_takeoff(batch: Batch, path: str, what: str, k: str | None) -> tuple[Target, ...]:
    values = batch.values
    name: Name = (what, int(k)) if k else ("takeoff", what)
    if name not in values:
        there = [_spelled(n) for n in values if n[0] in ("takeoff", *_VECTORS)]
        raise SomersaultError(f"{path} is no number of this takeoff; it has {', '.join(there)}")
    if leaves_plane(batch.model, what, int(k) if k else None):
        raise SomersaultError(
            f"{path} would turn {batch.model.name} out of the plane in which it moves; vary "
            'something else, or give the model base = "free"'
        )
    return (Target(name, unit=_UNITS[what]),)


def _of_replay(batch: Batch, path: str, what: str, key: str | None) -> tuple[Target, ...]:
    name: Name = ("replay", what) if key is None else ("replay", what, key)
    if name not in batch.values:
        there = [".".join(map(str, n)) for n in batch.values if n[0] == "replay"]
        has = f"it has {', '.join(there)}" if there else "it has no replay"
        raise SomersaultError(f"{path} is no number of this takeoff; {has}")
    return (Target(name, unit=declared(Replay)[what].unit),)


def _of_joints_alike(batch: Batch, path: str) -> tuple[Target, ...]:
    """The numbers of all joints whose names fit, where a mirrored joint has the same."""
    match = _JOINT.match(path)
    of_table = _OF_TABLE.match(path)
    if of_table and any(name[:1] == (of_table[2],) for name in batch.values):
        match = of_table
    if not match:
        raise SomersaultError(f"{path} has a * that is not in a joint's name; write it out")
    pattern, what = match[1], match[2]
    meant: list[Target] = []
    for plan in batch.joints:
        name = plan.joint.name
        there = [n for n in batch.values if n[:2] == (what, name)]
        if not fnmatchcase(name, pattern) or not there:
            continue
        if match[3] and match[3] not in [str(x) for n in there for x in n[2:]]:
            continue
        if declared(plan.does)[what].image != "same":
            raise SomersaultError(
                f"{path} is another number for a joint's mirror image; name joints or pairs instead"
            )
        meant += _of_joint(batch, path, name, what, match[3])
    if not meant:
        raise SomersaultError(f"{path} fits no joint of {batch.model.name} that has such a number")
    return tuple(meant)


def _spelled(name: Name) -> str:
    parts = name if name[0] == "takeoff" else ("takeoff", *name)
    return ".".join(str(part) for part in parts)


def _is_joint(model: Model, name: str) -> bool:
    """Whether it is the name of a joint, or the common one of a pair."""
    return name in model.speeds or next(iter(sides(model, name))) != name


def _of_joint(batch: Batch, path: str, joint: str, what: str, k: str | None) -> tuple[Target, ...]:
    both, values = sides(batch.model, joint), batch.values
    does = {plan.joint.name: plan.does for plan in batch.joints}
    meant: list[Target] = []
    for name, (factor, offset) in both.items():
        slides = batch.model.joint(name).kind == "slide"
        every: list[Name] = [n for n in values if n[:2] == (what, name)]
        wanted: list[Name] = [n for n in every if k in (None, *map(str, n[2:]))]
        if not wanted or any(n not in values for n in wanted):
            there = sorted(
                {".".join(str(x) for x in (n[0], *n[2:])) for n in values if name in n[1:2]}
            )
            raise SomersaultError(
                f"{path} is no number of this takeoff; joint {name} has {', '.join(there)}"
            )
        if len(both) > 1 and isinstance(does[name], Coupled):
            raise SomersaultError(f"{path} is of joints that follow others; name one at a time")
        known = declared(does[name])[what]
        by = 1.0 if known.image == "same" else factor
        about = offset if known.image == "angle" else 0.0
        unit = known.slide_unit if slides else known.unit
        meant += [Target(n, by, about, unit) for n in wanted]
    return tuple(meant)


def _of_body(
    model: Model, body: str, mass: str | None, what: str | None, k: str | None
) -> tuple[Target, ...]:
    names = [b.name for b in model.bodies]
    if body not in names:
        raise SomersaultError(f"there is no body {body!r}; there are {', '.join(names)}")
    if not mass:
        if f"bodies.{body}.{what}.{k}" not in parameter_values(model):
            raise SomersaultError(f"{body} is the base, which has no position to vary")
        return (Target((f"bodies.{body}.{what}.{k}",), unit="m"),)
    if model.bodies[names.index(body)].mass <= 0:
        raise SomersaultError(f"body {body} has no mass, so none can be varied")
    return (Target((f"bodies.{body}.mass",), unit="kg"),)
