"""What a joint does from takeoff on: the base of all behaviours.

A behaviour is one class in one file. Its fields are its numbers, each declared once
(`_declared`), and its methods say where the joint begins, what its equations are in symbols, and
which arrays go into them. Nothing else in the package knows which behaviours there are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from somersault._core.array import Array
from somersault._core.checks import truth
from somersault.flight.behaviours import _changed, _declared
from somersault.flight.behaviours._here import Here, Known
from somersault.flight.behaviours._registry import Registry, behaviour_names
from somersault.flight.behaviours._sensing import Sensing
from somersault.model import Joint, Model
from somersault.motion import Path
from somersault.simulation import Name, Numbers

Self = TypeVar("Self", bound="JointTakeoff")
Angle = float | Sequence[float] | None
"""Of a joint: a number, or three for a ball."""


@dataclass(frozen=True)
class JointTakeoff(metaclass=Registry):
    """One joint at takeoff and after.

    `JointTakeoff.NAME(…)`, or `JointTakeoff("NAME", …)`, is a joint that does so:

    | name       | what the joint does                                              |
    |------------|------------------------------------------------------------------|
    | locked     | holds its angle                                                  |
    | free       | swings, with its damper                                          |
    | sprung     | has a spring and a damper; may be pretensioned against the spin  |
    | prescribed | moves along a path, whatever it takes                            |
    | compliant  | has a spring and a damper about a path, and a motor tape         |
    | torque     | is driven by a torque against time; may have spring and damper   |
    | coupled    | follows another joint, as gears make it                          |
    | torque_law | has a torque by a law of what is sensed; rate_law, angle_law too |

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
            Registry.classes[motion] = cls

    def is_named(self) -> bool:
        """Whether it has a name, and is not what the model says.

        Returns
        -------
        bool
        """
        return self.motion in behaviour_names()

    def settled(self, joint: Joint) -> JointTakeoff:
        """The same with all that it leaves open filled in from the model.

        Parameters
        ----------
        joint : Joint

        Returns
        -------
        JointTakeoff
            Its numbers are floats or tuples of floats.

        Raises
        ------
        SomersaultError
            For what does not fit the joint.
        """
        return self._checked(joint)

    def _checked(self: Self, joint: Joint) -> Self:
        """Numbers as floats, rows as tuples; SomersaultError for what is neither."""
        where = f"joint {joint.name}"
        changes = _declared.checked_all(where, self, joint)
        for name, what in _declared.declared(self).items():
            _declared.note_strange(where, joint, name, what, changes[name])
        for one in fields(self):
            if one.type in ("bool", bool):
                changes[one.name] = truth(f"{where}: {one.name}", getattr(self, one.name))
        return replace(self, **changes)

    def mirrored(self: Self, model: Model, name: str, factor: float, offset: float) -> Self:
        """What the joint on the other side does, seen in a mirror.

        Parameters
        ----------
        model : Model
        name : str
            The joint that this one is for.
        factor, offset : float
            An angle's image is offset + factor · angle.

        Returns
        -------
        JointTakeoff

        Raises
        ------
        SomersaultError
            For what has no mirror image.
        """
        changes = _changed.mirrored(self, model.joint(name), factor, offset)
        for one in fields(self):
            path = getattr(self, one.name)
            if isinstance(path, Path):
                changes[one.name] = self._image(one.name, path, factor, offset)
        return replace(self, **changes)

    def _image(self, name: str, path: Path, factor: float, offset: float) -> Path:
        """A path's mirror image: that of an angle, unless the class says otherwise."""
        return path.image(factor, offset)

    def scaled_in_time(self: Self, factor: float) -> Self:
        """The same in another time.

        Parameters
        ----------
        factor : float
            Its times are multiplied by it.

        Returns
        -------
        JointTakeoff

        Examples
        --------
        >>> import somersault as so
        >>> raised = so.JointTakeoff.prescribed(times=[0.0, 0.2], angles=[0.0, 1.2])
        >>> [float(time) for time in raised.scaled_in_time(2.0).times]
        [0.0, 0.4]
        """
        return replace(self, **_changed.scaled(self, factor))

    def reversed_in_time(self: Self, end: float) -> Self:
        """The same backwards: at t what it was at `end` − t.

        Parameters
        ----------
        end : float
            s.

        Returns
        -------
        JointTakeoff

        Examples
        --------
        >>> import somersault as so
        >>> raised = so.JointTakeoff.prescribed(times=[0.0, 0.2], angles=[0.0, 1.2])
        >>> [float(angle) for angle in raised.reversed_in_time(1.0).angles]
        [1.2, 0.0]
        """
        return replace(self, **_changed.reversed_(self, end))

    def kind(self: Self) -> Self:
        """The same without its numbers: joints of one kind share their equations.

        Returns
        -------
        JointTakeoff
        """
        kept = {f.name: getattr(self, f.name) for f in fields(self) if f.metadata.get("structure")}
        return type(self)(**kept)

    def parameters(self, joint: Joint) -> tuple[str, ...]:
        """Names of the parameters of its equations that stay as they are in a flight.

        Parameters
        ----------
        joint : Joint

        Returns
        -------
        tuple of str
        """
        return ()

    def place(self, here: Here) -> Known:
        """Where it is; of a joint that is no part of the state.

        Parameters
        ----------
        here : Here

        Returns
        -------
        Known
        """
        raise NotImplementedError

    def loads(self, here: Here) -> list[Any]:
        """What acts at each of its speeds; of a joint that is part of the state.

        Parameters
        ----------
        here : Here

        Returns
        -------
        list
            N m (N for a slide), symbols.
        """
        raise NotImplementedError

    def wanted(self, here: Here) -> list[Any]:
        """Its coordinates in the pose in which the paths have the body.

        Parameters
        ----------
        here : Here

        Returns
        -------
        list
        """
        return here.q

    def accelerations(self, here: Here) -> list[Any]:
        """Its accelerations, of a joint that is part of the state and yet does not move freely.

        Parameters
        ----------
        here : Here

        Returns
        -------
        list
            One for each of its speeds, or none where they follow from what acts.
        """
        return []

    @property
    def sensing(self) -> Sensing | None:
        """What it does at ticks; None for a joint that does not sense."""
        return None

    def numbers(self, joint: Joint) -> dict[Name, float | Array]:
        """The numbers that may differ between flights.

        Parameters
        ----------
        joint : Joint

        Returns
        -------
        dict of tuple to float
            By names such as ("angle", joint).
        """
        result: dict[Name, float | Array] = {}
        for name in _declared.declared(self):
            result |= _declared.spread(joint.name, name, getattr(self, name))
        return result

    def begin(self, joint: Joint, values: Numbers, count: int) -> tuple[Array, Array]:
        """Coordinates and speeds at takeoff.

        Parameters
        ----------
        joint : Joint
        values : mapping of tuple to float or ndarray, (count,)
            The numbers of the flights.
        count : int
            How many flights.

        Returns
        -------
        q : ndarray, (count, coordinates)
        u : ndarray, (count, speeds)
        """
        raise NotImplementedError

    def lasting(self, joint: Joint, values: Numbers, q: Array) -> Array:
        """Numbers of `parameters`.

        Parameters
        ----------
        joint, values
            As for `begin`.
        q : ndarray, (count, coordinates)
            Its coordinates at takeoff.

        Returns
        -------
        ndarray, (count, parameters)
        """
        names = [_declared.named(joint.name, name) for name in self.parameters(joint)]
        return _declared.side_by_side(values, names, len(q))

    def paths(self, joint: Joint, values: Numbers, count: int) -> tuple[Path, ...]:
        """Its paths.

        Parameters
        ----------
        joint, values, count
            As for `begin`.

        Returns
        -------
        tuple of Path
            Each for all flights where they are alike, otherwise with one row for each.
        """
        return ()

    def sound(self, joint: Joint, values: Numbers, count: int) -> Array:
        """Whether the numbers of each flight are such as could be asked for by themselves.

        Parameters
        ----------
        joint, values, count
            As for `begin`.

        Returns
        -------
        ndarray of bool, (count,)
        """
        return _declared.sound(joint, _declared.declared(self), self.numbers(joint), values, count)

    def nominal(self) -> JointTakeoff:
        """What it does in the flight whose torques a motor tape records.

        Returns
        -------
        JointTakeoff
        """
        return self

    @property
    def conservative(self) -> bool:
        """Whether it keeps the energy of the flight."""
        return True

    def energy(self, joint: Joint, q: Array) -> Array | float:
        """The energy that it holds.

        Parameters
        ----------
        joint : Joint
        q : ndarray, (…, coordinates)
            Its coordinates.

        Returns
        -------
        ndarray, (…), or float
            J.
        """
        return 0.0
