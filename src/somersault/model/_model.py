"""A body in the air: rigid bodies in a tree, joined by hinges, slides and balls.

A `Model` is a value: it is read once, never changed, and knows nothing of motion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from somersault._core.checks import shown, text
from somersault._core.errors import SomersaultError
from somersault._core.notes import listed, note
from somersault.attitude import AXES, Axes, as_axes
from somersault.model._bodies import Body, Follow, Joint, coordinate_names, speed_names
from somersault.model._refused import check
from somersault.model.shapes import Mesh, Shape

_MOST_TRIANGLES = 4_000_000  # of one model, beyond which no file is read


@dataclass(frozen=True, slots=True)
class FileCoordinates:
    """What recordings in the coordinates of a model's file say of the model.

    Parameters
    ----------
    root : tuple of Body
        The base as the file has it, on joints to the ground: bodies from the ground outward, each
        the parent of the next, the base last; none where the file has a free joint or nothing.
    gears : tuple of (str, Follow)
        For coordinates that are no joint of the model the joint whose value they decide: the joint
        named `leader` stands at `factor` times the coordinate plus `offset`.
    """

    root: tuple[Body, ...] = ()
    gears: tuple[tuple[str, Follow], ...] = ()


@dataclass(frozen=True)
class Model:
    """Bodies in order, parents first. With a `free` base, body 0 is the base, in the air.

    Parameters
    ----------
    name : str
    free : bool
        Whether it flies; else what has no parent stands on the ground.
    bodies : tuple of Body
    ignored : tuple of str
        What the file held that has no part in flight.
    axes : tuple of int
        The base's axes about which it somersaults, tilts and twists: they decide what those angles
        mean, and nothing else.
    plane : int, optional
        The base's axis across the plane in which a free base moves, which is then the axis of
        somersault. By default the base moves in space.
    file_coordinates : FileCoordinates
        For reading recordings alone.

    Raises
    ------
    SomersaultError
        For anything that cannot be a body in the air (`_refused.check`).

    Examples
    --------
    >>> import somersault as so
    >>> so.load("furrer")
    <Model 'furrer': 3 bodies, 2 joints, 65.786 kg, free>
    """

    name: str
    free: bool
    bodies: tuple[Body, ...]
    ignored: tuple[str, ...] = ()
    axes: Axes = AXES
    plane: int | None = None
    file_coordinates: FileCoordinates = field(default=FileCoordinates(), compare=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "axes", as_axes(self.axes))
        check(self.name, self.free, self.bodies, self.axes, self.plane)

    def __repr__(self) -> str:
        base = "free" if self.free else "on a fixed base"
        if self.plane is not None:
            base = f"free in the plane across axis {self.plane}"
        counts = [(len(self.bodies), "body", "bodies"), (len(self.joints), "joint", "joints")]
        parts = [f"{n} {one if n == 1 else many}" for n, one, many in counts]
        return f"<Model {self.name!r}: {', '.join(parts)}, {self.mass:g} kg, {base}>"

    def __getstate__(self) -> dict[str, Any]:
        """Without what follows from it: models are sent to other processes."""
        return {own.name: getattr(self, own.name) for own in fields(self)}

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """Every joint, in the order of the bodies: the order of all coordinate vectors."""
        return tuple(joint for body in self.bodies for joint in body.joints)

    @cached_property
    def solids(self) -> tuple[tuple[Shape, ...], ...]:
        """What there is to see of each body: its shapes, and what is in the files that some of
        them stand for, which are read here. What cannot be read is left out with a
        SomersaultWarning that names it."""
        rows, left_out, count = [], list[str](), 0
        for body in self.bodies:
            row: list[Shape] = []
            for shape in body.shapes:
                try:
                    if count > _MOST_TRIANGLES:
                        raise SomersaultError(f"all beyond {_MOST_TRIANGLES} triangles")
                    solids = shape.solids()
                except SomersaultError as error:
                    left_out.append(str(error))
                    continue
                count += sum(len(solid.faces) for solid in solids if isinstance(solid, Mesh))
                row += solids
            rows.append(tuple(row))
        if left_out:
            what = listed(list(dict.fromkeys(left_out)))
            note(f"{self.name}: shapes left out: {what}")
        return tuple(rows)

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the joint coordinates; a ball has four (w, x, y, z)."""
        return coordinate_names(self.joints)

    @cached_property
    def speeds(self) -> tuple[str, ...]:
        """Names of the joint speeds; a ball has three, along its body's axes."""
        return speed_names(self.joints)

    @cached_property
    def base_ways(self) -> tuple[int, ...]:
        """Which of six ways its base moves in: turns about its axes 1, 2, 3 (0 to 2), and shifts
        along them (3 to 5)."""
        if not self.free:
            return ()
        if self.plane is None:
            return (0, 1, 2, 3, 4, 5)
        across = self.plane - 1
        return (across, *(3 + k for k in range(3) if k != across))

    @cached_property
    def mass(self) -> float:
        """Total mass in kg."""
        return math.fsum(body.mass for body in self.bodies)

    @cached_property
    def home(self) -> np.ndarray:
        """Joint coordinates where nothing else is said, (coordinates,): each joint's `home`, and
        those that follow another where that one's has them."""
        leaders = {joint.name: joint.home[0] for joint in self.joints}
        values: list[float] = []
        for joint in self.joints:
            follow = joint.follows
            own = (
                joint.home
                if follow is None
                else (follow.offset + follow.factor * leaders[follow.leader],)
            )
            values += own
        return np.array(values)

    def joint(self, name: str) -> Joint:
        """The joint of a name.

        Parameters
        ----------
        name : str

        Returns
        -------
        Joint

        Raises
        ------
        SomersaultError
            For a name that no joint has.

        Examples
        --------
        >>> import somersault as so
        >>> so.load("furrer").joint("left_shoulder").kind
        'hinge'
        """
        text("the name of a joint", name)
        for joint in self.joints:
            if joint.name == name:
                return joint
        raise SomersaultError(
            f"{self.name} has no joint {shown(name)}; {_there_are([j.name for j in self.joints])}"
        )

    def coordinate_slice(self, name: str) -> slice:
        """Where a joint's coordinates stand in a coordinate vector.

        Parameters
        ----------
        name : str
            Of the joint.

        Returns
        -------
        slice

        Raises
        ------
        SomersaultError
            For a name that no joint has.

        Examples
        --------
        >>> import somersault as so
        >>> so.load("furrer").coordinate_slice("right_shoulder")
        slice(1, 2, None)
        """
        return _slice(self.joints, self.joint(name), "coordinates")

    def speed_slice(self, name: str) -> slice:
        """Where a joint's speeds stand in a vector of joint speeds.

        Parameters
        ----------
        name : str
            Of the joint.

        Returns
        -------
        slice

        Raises
        ------
        SomersaultError
            For a name that no joint has.

        Examples
        --------
        >>> import somersault as so
        >>> so.load("furrer").speed_slice("right_shoulder")
        slice(1, 2, None)
        """
        return _slice(self.joints, self.joint(name), "speeds")

    def renamed(self, name: str) -> Model:
        """The same model under another name.

        Parameters
        ----------
        name : str

        Returns
        -------
        Model

        Examples
        --------
        >>> import somersault as so
        >>> so.load("furrer").renamed("Furrer, Zürich").name
        'Furrer, Zürich'
        """
        return replace(self, name=name)


def _slice(joints: tuple[Joint, ...], wanted: Joint, count: str) -> slice:
    start = 0
    for joint in joints:
        if joint is wanted:
            break
        start += getattr(joint, count)
    return slice(start, start + getattr(wanted, count))


def _there_are(names: list[str]) -> str:
    if not names:
        return "it has none"
    shown = ", ".join(names[:12]) + (", …" if len(names) > 12 else "")
    return f"its joints are {shown}"
