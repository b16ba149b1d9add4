"""What a joint does from takeoff on: the base of all behaviours.

A behaviour is one class in one file. Its fields are its numbers, each declared once
(`_declared`), and its methods say where the joint begins, what its equations are in symbols, and
which arrays go into them. Nothing else in the package knows which behaviours there are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import truth
from somersault._core.errors import SomersaultError
from somersault.flight._values import Name, Values
from somersault.flight.behaviours import _declared
from somersault.model import LIMIT_SLACK, Joint, Model
from somersault.motion import Path

Self = TypeVar("Self", bound="JointTakeoff")
Angle = float | Sequence[float] | None
"""Of a joint: a number, or three for a ball."""


class _Registry(type):
    """Makes `JointTakeoff("sprung", …)` and `JointTakeoff.sprung(…)` out of the class that is
    called so, and turns a key that the class does not have into one sentence."""

    classes: ClassVar[dict[str | None, type[JointTakeoff]]] = {}

    def __call__(cls, *given: Any, **named: Any) -> Any:
        if cls._root():
            motion, *rest = given or (named.pop("motion", None),)
            return _class(motion)(*rest, **named)
        named = cls.keys_of(named)
        if len(given) > len(cls._keys()):
            raise SomersaultError(f"a joint that is {cls._called()} takes {_listed(cls._keys())}")
        return super().__call__(*given, **named)

    def __getattr__(cls, name: str) -> Any:
        if cls._root() and name in _Registry.classes:
            return _Registry.classes[name]
        known = "" if name.startswith("_") else f"; behaviours are {_listed(_names())}"
        raise AttributeError(f"{cls.__name__} has no {name!r}{known}")

    def kind_of(cls, motion: str | None) -> type[JointTakeoff]:
        """The behaviour of a name; SomersaultError if there is none."""
        return _class(motion)

    def keys_of(cls, given: Mapping[str, Any]) -> dict[str, Any]:
        """Those of some numbers by name that this behaviour has.

        What it does not have may be nothing (0, false, none), and is left out; SomersaultError
        for anything else.
        """
        for key in given:
            if key not in cls._keys() and not (key in _every_key() and _nothing(given[key])):
                raise SomersaultError(_refusal(cls, key))
        return {key: value for key, value in given.items() if key in cls._keys()}

    def _root(cls) -> bool:
        return cls.__mro__[1] is object  # `JointTakeoff` itself

    def _keys(cls) -> list[str]:
        every = getattr(cls, "__dataclass_fields__", {})
        return [name for name in every if name not in JointTakeoff.__annotations__]

    def _called(cls) -> str:
        return cls.motion or "as modelled"


@dataclass(frozen=True)
class Here:
    """A joint in symbols, as its behaviour sees it.

    `q` and `u` are its coordinates and speeds, `numbers` its parameters by name, `paths` the
    value, rate and acceleration of each of its paths now. `outboard` gives, for each of its speeds,
    the inertia about its axis of all that is outboard, in the pose in which the paths have the
    body. `tape` is the motor tape's torque. `leader` is the joint that it follows.
    """

    joint: Joint
    q: list[Any]
    u: list[Any]
    time: Any
    numbers: Mapping[str, Any]
    paths: tuple[tuple[Any, Any, Any], ...]
    outboard: Callable[[], list[Any]]
    tape: Any = 0.0
    leader: Known | None = None

    def at(self, known: Known) -> Here:
        """The same where a joint that is no part of the state is."""
        return replace(self, q=known.q, u=known.u)

    def following(self, leader: Known | None) -> Here:
        """The same with the joint that it follows."""
        return replace(self, leader=leader)


@dataclass(frozen=True)
class Known:
    """Coordinates, speeds and accelerations of a joint; no accelerations where it moves freely."""

    q: list[Any]
    u: list[Any]
    a: list[Any]


@dataclass(frozen=True)
class JointTakeoff(metaclass=_Registry):
    """One joint at takeoff and after.

    `JointTakeoff.NAME(…)`, or `JointTakeoff("NAME", …)`, is a joint that does so:

    ========== ==========================================================================
    locked     holds its angle
    free       swings, with its damper
    sprung     has a spring and a damper, and may be pretensioned to balance the spin
    prescribed moves along a path, whatever it takes
    compliant  has a spring and a damper about a path, and the torque of a motor tape
    torque     is driven by a torque against time, with or without a spring and a damper
    coupled    follows another joint, as gears make it
    ========== ==========================================================================

    Without a name a joint does what the model says: it follows where it is geared to another,
    is sprung where it has stiffness or is given some, and is locked otherwise. Angles are in rad (m
    for slides), torques in N m (N). A ball's angle is a rotation vector and its rate an angular
    velocity, both along its body's axes. A joint that moves freely goes through its limits unless
    it has a `stop_stiffness` there.

    Raises
    ------
    SomersaultError
        For a behaviour that is none, and for a number that would do nothing.

    Examples
    --------
    >>> import somersault as so
    >>> arm = so.JointTakeoff.sprung(angle=1.4, K=1.2, hold=True)
    >>> so.JointTakeoff("prescribed", times=[0.1, 0.3], angles=[0.0, 1.2]).motion
    'prescribed'
    """

    motion: ClassVar[str | None] = None
    """Its name, in a SPEC and in `JointTakeoff.NAME`."""
    in_state: ClassVar[bool] = False
    """Whether the joint moves freely, so that its coordinates are part of the state."""
    path_count: ClassVar[int] = 0
    """How many paths its equations have."""

    if TYPE_CHECKING:  # the registry takes a behaviour's name first

        def __init__(self, *given: Any, **named: Any) -> None: ...

    def __init_subclass__(cls, motion: str | None = None, **more: Any) -> None:
        super().__init_subclass__(**more)
        if motion is not None:
            cls.motion = motion
            _Registry.classes[motion] = cls

    def standard(self) -> dict[str, Any]:
        """Its fields by name, and what each is where nothing is given."""
        return {f.name: f.default for f in fields(self)}

    def is_named(self) -> bool:
        """Whether it has a name of its own, and is not what the model says."""
        return self.motion in _names()

    # -------------------------------------------------------------- from what was asked for

    def settled(self, joint: Joint) -> JointTakeoff:
        """The same with all that the model leaves open filled in, its numbers floats or tuples.

        Raises SomersaultError for what does not fit the joint.
        """
        return self._checked(joint)

    def _checked(self: Self, joint: Joint) -> Self:
        """Numbers as floats, rows as tuples; SomersaultError for what is neither."""
        where = f"joint {joint.name}"
        changes: dict[str, Any] = {}
        for name, what in _declared.declared(self).items():
            value = _declared.checked(where, joint, name, what, getattr(self, name))
            changes[name] = value
            if what.least is not None and isinstance(value, float) and value < what.least:
                raise SomersaultError(
                    f"{where} has the negative {name} {value:g}; give none, or a positive one"
                )
        for one in fields(self):
            if one.type in ("bool", bool):
                changes[one.name] = truth(f"{where}: {one.name}", getattr(self, one.name))
        return replace(self, **changes)

    def mirrored(self: Self, model: Model, name: str, factor: float, offset: float) -> Self:
        """What the mirrored joint does: angles are offset + factor times this one's.

        `name` is the joint that this one is for, as a message has it.
        """
        joint = model.joint(name)
        changes: dict[str, Any] = {}
        for key, what in _declared.declared(self).items():
            value = _declared.checked(f"joint {name}", joint, key, what, getattr(self, key))
            if value is None or what.image == "same":
                continue
            by, about = factor, offset if what.image == "angle" else 0.0
            row = isinstance(value, tuple)
            changes[key] = [about + by * x for x in value] if row else about + by * value
        for one in fields(self):
            path = getattr(self, one.name)
            if isinstance(path, Path):
                changes[one.name] = self._image(one.name, path, factor, offset)
        return replace(self, **changes)

    def _image(self, name: str, path: Path, factor: float, offset: float) -> Path:
        """A path's mirror image: that of an angle, unless the class says otherwise."""
        return path.image(factor, offset)

    def scaled_in_time(self: Self, factor: float) -> Self:
        """The same in `factor` times its time."""
        changes: dict[str, Any] = {}
        for one in fields(self):
            value = getattr(self, one.name)
            if isinstance(value, Path):
                changes[one.name] = value.scaled(factor)
            elif one.name == "times":
                changes[one.name] = tuple(factor * np.asarray(value, float))
        return replace(self, **changes)

    def reversed_in_time(self: Self, end: float) -> Self:
        """The same backwards: at t what it was at `end` - t, s."""
        changes: dict[str, Any] = {}
        rows = [name for name, what in _declared.declared(self).items() if what.row]
        for one in fields(self):
            value = getattr(self, one.name)
            if isinstance(value, Path):
                changes[one.name] = value.reversed(end)
            elif one.name in rows:
                row = np.asarray(value, float)[::-1]
                changes[one.name] = tuple(end - row if one.name == "times" else row)
        return replace(self, **changes)

    # --------------------------------------------------------------- what decides equations

    def kind(self: Self) -> Self:
        """The same without its numbers: joints of one kind share their equations."""
        kept = {f.name: getattr(self, f.name) for f in fields(self) if f.metadata.get("structure")}
        return type(self)(**kept)

    def parameters(self, joint: Joint) -> tuple[str, ...]:
        """Names of its lasting parameters."""
        return ()

    def place(self, here: Here) -> Known:
        """Where it is, of a joint that is no part of the state."""
        raise NotImplementedError

    def loads(self, here: Here) -> list[Any]:
        """What acts at each of its speeds, N m, of a joint that is part of the state."""
        raise NotImplementedError

    def wanted(self, here: Here) -> list[Any]:
        """Coordinates in the pose in which the paths have the body."""
        return here.q

    # -------------------------------------------------------------------------- its numbers

    def numbers(self, joint: Joint) -> dict[Name, float | Array]:
        """The numbers that may differ between flights, by name."""
        result: dict[Name, float | Array] = {}
        for name in _declared.declared(self):
            result |= _declared.spread(joint.name, name, getattr(self, name))
        return result

    def begin(self, joint: Joint, values: Values, count: int) -> tuple[Array, Array]:
        """Coordinates (count, c) and speeds (count, s) at takeoff."""
        raise NotImplementedError

    def lasting(self, joint: Joint, values: Values, q: Array) -> Array:
        """Parameters that stay as they are, (count, parameters); q (count, c) as at takeoff."""
        names: list[Name] = [(name, joint.name) for name in self.parameters(joint)]
        return _declared.side_by_side(values, names, len(q))

    def paths(self, joint: Joint, values: Values, count: int) -> tuple[Path, ...]:
        """Its paths, for each flight or one for all where they are alike."""
        return ()

    def sound(self, joint: Joint, values: Values, count: int) -> Array:
        """Whether each flight's numbers could be asked for, (count,)."""
        good = np.ones(count, bool)
        known = _declared.declared(self)
        for key in self.numbers(joint):
            what, value = known[str(key[0])], np.asarray(values[key])
            if what.limited and joint.kind != "ball":
                good &= _within(joint, value)
            if what.least is not None:
                good &= value >= what.least
        return good

    # ---------------------------------------------------------------------- what it amounts to

    def nominal(self) -> JointTakeoff:
        """What it does in the flight whose torques a motor tape records."""
        return self

    @property
    def conservative(self) -> bool:
        """Whether it keeps the energy of the flight."""
        return True

    def energy(self, joint: Joint, q: Array) -> Array | float:
        """What it holds at coordinates q (…, c), J."""
        return 0.0


@dataclass(frozen=True)
class JointPlan:
    """A joint and what it does, everything filled in."""

    joint: Joint
    does: JointTakeoff


def kinds(plans: tuple[JointPlan, ...]) -> tuple[JointTakeoff, ...]:
    """What each joint does, without numbers: flights that do the same share their equations."""
    return tuple(plan.does.kind() for plan in plans)


def check_limits(joint: Joint, angles: tuple[float, ...]) -> None:
    """SomersaultError where angles are outside a joint's limits."""
    if joint.limits is None or not angles:
        return
    least, most = joint.limits
    low, high = min(angles), max(angles)
    if low < least - LIMIT_SLACK or high > most + LIMIT_SLACK:
        worst = low if low < least - LIMIT_SLACK else high
        raise SomersaultError(
            f"joint {joint.name}: angle {worst:g} is outside its limits {least:g} to {most:g}"
        )


def _within(joint: Joint, angle: Array) -> Array:
    if joint.limits is None:
        return np.isfinite(angle)
    least, most = joint.limits
    return (angle >= least - LIMIT_SLACK) & (angle <= most + LIMIT_SLACK)


def _class(motion: Any) -> type[JointTakeoff]:
    if motion is None:
        return _Registry.classes["as modelled"]
    if not isinstance(motion, str) or motion not in _names():
        raise SomersaultError(f"{motion!r} is no motion of a joint; use {_listed(_names())}")
    return _Registry.classes[motion]


def _names() -> list[str]:
    return [name for name in _Registry.classes if name is not None and name != "as modelled"]


def _every_key() -> set[str]:
    return {key for cls in _Registry.classes.values() for key in cls._keys()}


def _nothing(value: Any) -> bool:
    """Whether a value is as good as none."""
    try:
        return value is None or value is False or bool(np.all(np.asarray(value) == 0))
    except (TypeError, ValueError):
        return False


def _refusal(cls: Any, key: str) -> str:
    takes = f"it takes {_listed(cls._keys())}" if cls._keys() else "it takes nothing"
    if key in _every_key():
        return f"{key} would do nothing for a joint that is {cls._called()}; leave it out ({takes})"
    return f"{key} is nothing that a joint has; one that is {cls._called()} takes {takes[9:]}"


def _listed(names: list[str]) -> str:
    return ", ".join(names)
