"""A body in the air: rigid bodies in a tree, joined by hinges, slides and balls.

A `Model` is a value: it is read once, never changed, and knows nothing of motion. What a
user may get wrong in a model file is refused here, in one place, whatever format it came in.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np

from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault.attitude import AXES, Axes, as_axes
from somersault.model._vectors import IDENTITY, ZERO, Matrix, Vector
from somersault.model.shapes import Shape

FREE_IT = (
    "give its base a free joint (in a .bioMod: its root segment translations xyz beside "
    "rotations xyz)"
)
GROUND = -1
LIMIT_SLACK = 1e-9  # rad or m beyond a joint's limits that count as within


@dataclass(frozen=True, slots=True)
class Follow:
    """What a joint follows: its coordinate is `factor` times that of the joint `leader`, plus
    `offset` (rad, m). URDF calls it mimic."""

    leader: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Joint:
    """One joint between a body and its parent; a body may have several, applied in order.

    `axis` and `anchor` are in the axes of the body it moves. A hinge turns about `axis`
    through `anchor` by angle − `reference`; a slide moves along `axis`; a ball turns freely
    about `anchor` and its coordinate is a unit quaternion (scalar first, child to parent).
    SI units and radians: `stiffness` N m/rad (N/m for a slide), `rest` the coordinate at
    which the spring is slack, `damping` N m s/rad, `armature` kg m² (the inertia of a geared
    rotor, as in MJCF). `limits` are the ends of the coordinate's range, or None. `follows`
    names the joint that it is geared to.
    """

    name: str
    kind: Literal["hinge", "slide", "ball"]
    axis: Vector = (1.0, 0.0, 0.0)
    anchor: Vector = ZERO
    reference: float = 0.0
    limits: tuple[float, float] | None = None
    stiffness: float = 0.0
    rest: float = 0.0
    damping: float = 0.0
    armature: float = 0.0
    follows: Follow | None = None

    @property
    def speeds(self) -> int:
        """Degrees of freedom: 3 for a ball, else 1."""
        return 3 if self.kind == "ball" else 1

    @property
    def coordinates(self) -> int:
        """Numbers that give its position: 4 (a quaternion) for a ball, else 1."""
        return 4 if self.kind == "ball" else 1

    @property
    def home(self) -> tuple[float, ...]:
        """Its coordinates where nothing else is said of it: as the file draws the model, or at the
        nearer end of its range where it is drawn outside."""
        if self.kind == "ball":
            return (1.0, 0.0, 0.0, 0.0)
        low, high = self.limits or (-math.inf, math.inf)
        return (min(max(self.reference, low), high),)

    @property
    def drawn_outside(self) -> bool:
        """Whether the file draws it outside its range."""
        return self.kind != "ball" and abs(self.home[0] - self.reference) > LIMIT_SLACK


@dataclass(frozen=True, slots=True)
class Body:
    """One rigid body. `parent` is the index of its parent, or `GROUND`.

    `position` and `rotation` (columns: this body's axes) place its frame in its parent's
    when every joint of it stands at its reference. `com` and `inertia` (about `com`) are in
    the body's own axes; kg, m, kg m². `shapes` are what there is to see of it, in its own axes:
    they decide nothing, so bodies that differ in them alone are equal. `inertia_from` says what
    its mass and inertia were read from: "file", "shapes" (at a density), both, as
    "file, shapes", or "nothing".
    """

    name: str
    parent: int
    mass: float
    com: Vector
    inertia: Matrix
    position: Vector = ZERO
    rotation: Matrix = IDENTITY
    joints: tuple[Joint, ...] = ()
    shapes: tuple[Shape, ...] = field(default=(), compare=False, repr=False)
    inertia_from: str = field(default="file", compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class FileCoordinates:
    """What recordings in the coordinates of a model's file say of the model.

    `root` is the base as the file has it, on joints to the ground: bodies from the ground
    outward, each the parent of the next, the base last; none where the file has a free joint or
    nothing. `gears` has for coordinates that are no joint of the model the joint whose value they
    decide: the joint named `leader` stands at `factor` times the coordinate plus `offset`.
    """

    root: tuple[Body, ...] = ()
    gears: tuple[tuple[str, Follow], ...] = ()


@dataclass(frozen=True)
class Model:
    """Bodies in order, parents first. With a `free` base, body 0 is the base, in the air.

    `ignored` says what the file held that has no part in flight. `axes` are the base's axes
    about which it somersaults, tilts and twists: they decide what those angles mean, and nothing
    else. `file_coordinates` is for reading recordings alone. Raises SomersaultError for anything
    that cannot be a body in the air (see `_check`).
    """

    name: str
    free: bool
    bodies: tuple[Body, ...]
    ignored: tuple[str, ...] = ()
    axes: Axes = AXES
    file_coordinates: FileCoordinates = field(default=FileCoordinates(), compare=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "axes", as_axes(self.axes))
        _check(self)

    def __repr__(self) -> str:
        base = "free" if self.free else "on a fixed base"
        counts = [(len(self.bodies), "body", "bodies"), (len(self.joints), "joint", "joints")]
        parts = [f"{n} {one if n == 1 else many}" for n, one, many in counts]
        return f"<Model {self.name!r}: {', '.join(parts)}, {self.mass:g} kg, {base}>"

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """Every joint, in the order of the bodies: the order of all coordinate vectors."""
        return tuple(joint for body in self.bodies for joint in body.joints)

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the joint coordinates; a ball has four (w, x, y, z)."""
        return tuple(_names(self.joints, ("w", "x", "y", "z")))

    @cached_property
    def speeds(self) -> tuple[str, ...]:
        """Names of the joint speeds; a ball has three, along its body's axes."""
        return tuple(_names(self.joints, ("1", "2", "3")))

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
        """The joint of that name; SomersaultError, with the names there are, if none is."""
        for joint in self.joints:
            if joint.name == name:
                return joint
        raise SomersaultError(
            f"{self.name} has no joint {name!r}; {_there_are([j.name for j in self.joints])}"
        )

    def coordinate_slice(self, name: str) -> slice:
        """Where that joint's coordinates stand in a coordinate vector."""
        return _slice(self.joints, self.joint(name), "coordinates")

    def speed_slice(self, name: str) -> slice:
        """Where that joint's speeds stand in a vector of joint speeds."""
        return _slice(self.joints, self.joint(name), "speeds")

    def renamed(self, name: str) -> Model:
        """The same model under another name."""
        return replace(self, name=name)


def _names(joints: tuple[Joint, ...], parts: tuple[str, ...]) -> Iterator[str]:
    for joint in joints:
        if joint.kind == "ball":
            yield from (f"{joint.name}.{part}" for part in parts)
        else:
            yield joint.name


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


# ------------------------------------------------------------------------- what is refused


def _check(model: Model) -> None:
    """Refuse what cannot be a body in the air, naming the body or joint and the mend."""
    if not model.bodies:
        raise SomersaultError(f"{model.name} has no bodies, so nothing can fly; add a body")
    if not model.free and model.axes != AXES:
        raise SomersaultError(
            f"{model.name} has a fixed base, so it has no somersault, tilt or twist; leave its "
            f"axes out, or {FREE_IT}"
        )
    for what, names in (
        ("body", [body.name for body in model.bodies]),
        ("joint", [joint.name for joint in model.joints]),
    ):
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise SomersaultError(
                f"{model.name} has two {what} elements named {twice!r}; give each its own name"
            )
    if "" in [*(body.name for body in model.bodies), *model.speeds]:
        raise SomersaultError(f"{model.name} has a body or joint without a name; name it")
    if len(set(model.speeds)) < len(model.speeds):
        raise SomersaultError(
            f"{model.name} has a joint named like a part of a ball joint (x.1); rename it"
        )
    for index, body in enumerate(model.bodies):
        _check_tree(model, index, body)
        _check_body(model, body)
        for joint in body.joints:
            _check_joint(model, joint)
            if joint.follows is not None:
                _check_follow(model, joint, joint.follows)
    if model.mass <= 0:
        raise SomersaultError(f"{model.name} has no mass; give its bodies masses")
    _check_moving_mass(model)
    _warn_of_impossible(model)


def _check_tree(model: Model, index: int, body: Body) -> None:
    if not GROUND <= body.parent < index:
        raise SomersaultError(
            f"{model.name}: body {body.name!r} must come after its parent, so the bodies form "
            "a loop or stand out of order"
        )
    if model.free and (body.parent == GROUND) != (index == 0):
        raise SomersaultError(
            f"{model.name}: body {body.name!r} is not part of the free body; a model in the "
            "air is one tree, so remove it or join it to the base"
        )
    if not body.joints and not (model.free and index == 0):
        raise SomersaultError(
            f"{model.name}: body {body.name!r} has no joint, so it cannot move against its "
            "parent; make the two one body"
        )
    if model.free and index == 0 and body.joints:
        raise SomersaultError(
            f"{model.name}: the free base {body.name!r} has joints of its own; remove them"
        )


def _check_body(model: Model, body: Body) -> None:
    where = f"{model.name}: body {body.name!r}"
    numbers = np.concatenate(
        [np.ravel(x) for x in (body.mass, body.com, body.inertia, body.position, body.rotation)]
    )
    if not np.all(np.isfinite(numbers)):
        raise SomersaultError(f"{where} holds a number that is not finite; give finite numbers")
    if body.mass < 0:
        raise SomersaultError(f"{where} has the negative mass {body.mass:g}; masses are positive")
    rotation = np.array(body.rotation)
    if np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-6 or np.linalg.det(rotation) < 0:
        raise SomersaultError(f"{where} has a rotation that is not one; give orthonormal axes")
    inertia = np.array(body.inertia)
    size = np.abs(inertia).max()
    if np.abs(inertia - inertia.T).max() > 1e-6 * size:
        raise SomersaultError(f"{where} has an inertia that is not symmetric; make it symmetric")


def _warn_of_impossible(model: Model) -> None:
    """Name the bodies that no distribution of mass makes: one principal inertia larger than the
    sum of the other two, or negative, or inertia without mass.

    Such are published every day and read by every program, since the motion of the whole is
    defined as long as its mass matrix is positive; that is looked at where models are loaded.
    """
    odd = []
    for body in model.bodies:
        small, middle, large = np.linalg.eigvalsh(body.inertia)
        rounding = 1e-9 * (large + body.mass * np.dot(body.com, body.com))
        if body.mass == 0 and large > 0:
            odd.append(f"{body.name} (without mass)")
        elif small < -rounding:
            odd.append(f"{body.name} ({small:.3g} kg m²)")
        elif large > (small + middle) * (1 + 1e-6) + rounding:
            odd.append(f"{body.name} ({large / max(small + middle, 1e-300):.4g} times)")
    if odd:
        more = f" and {len(odd) - 8} more" if len(odd) > 8 else ""
        warnings.warn(
            f"{model.name}: no rigid body has inertia without mass, or a principal inertia that is "
            "negative or larger than the sum of the other two, as these have: "
            f"{', '.join(odd[:8])}{more}; flown as given",
            SomersaultWarning,
            stacklevel=4,
        )


def _check_joint(model: Model, joint: Joint) -> None:
    where = f"{model.name}: joint {joint.name!r}"
    if joint.kind not in ("hinge", "slide", "ball"):
        raise SomersaultError(f"{where} is a {joint.kind!r}; joints are hinge, slide or ball")
    numbers = [*joint.axis, *joint.anchor, joint.reference, joint.rest]
    numbers += [joint.stiffness, joint.damping, joint.armature, *(joint.limits or ())]
    if not all(map(math.isfinite, numbers)):
        raise SomersaultError(f"{where} holds a number that is not finite; give finite numbers")
    if abs(math.hypot(*joint.axis) - 1) > 1e-6:
        raise SomersaultError(f"{where} has an axis of length {math.hypot(*joint.axis):g}; give 1")
    if joint.limits is not None and joint.limits[0] > joint.limits[1]:
        raise SomersaultError(f"{where} has limits in the wrong order; give the smaller first")
    for what in ("damping", "armature"):
        if getattr(joint, what) < 0:
            raise SomersaultError(f"{where} has negative {what}; it must be zero or positive")


def _check_follow(model: Model, joint: Joint, follow: Follow) -> None:
    where = f"{model.name}: joint {joint.name!r}"
    leader = next((j for j in model.joints if j.name == follow.leader), None)
    if leader is None:
        raise SomersaultError(f"{where} follows {follow.leader!r}, which is no joint; name one")
    if "ball" in (joint.kind, leader.kind):
        raise SomersaultError(
            f"{where} follows {leader.name!r}, and one of them is a ball; only hinges and slides "
            "follow each other"
        )
    if leader is joint or leader.follows is not None:
        raise SomersaultError(
            f"{where} follows {leader.name!r}, which follows a joint itself; name the joint that "
            "leads them all"
        )
    if not (math.isfinite(follow.factor) and math.isfinite(follow.offset)):
        raise SomersaultError(f"{where} follows by numbers that are not finite; give finite ones")


def _check_moving_mass(model: Model) -> None:
    """Every joint must move something, itself or by those that follow it, or its acceleration
    has no meaning."""
    leading = {joint.follows.leader for joint in model.joints if joint.follows is not None}
    outboard = [body.mass for body in model.bodies]
    for index in range(len(model.bodies) - 1, 0, -1):
        if model.bodies[index].parent != GROUND:
            outboard[model.bodies[index].parent] += outboard[index]
    for body, mass in zip(model.bodies, outboard, strict=True):
        idle = [j.name for j in body.joints if not j.armature and j.name not in leading]
        if idle and mass == 0:
            raise SomersaultError(
                f"{model.name}: joint {idle[-1]!r} moves no mass; give body {body.name!r} a mass "
                "or remove the joint"
            )
