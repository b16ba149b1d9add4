"""What a user may get wrong in a model, refused in one place, whatever format it came in."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np

from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault.attitude import AXES, Axes
from somersault.model._bodies import GROUND, Body, Follow, Joint, speed_names
from somersault.model._types_given import check_types

MOST_SPEEDS = 150  # of joints: what a command derives and compiles takes up to a minute
_ALONG = 1 - 1e-12  # cosine to the normal of a plane from which on a hinge turns in the plane
_LIGHTEST, _HEAVIEST = 1e-6, 1e4  # kg: a fruit fly, and any athlete in grams
FREE_IT = 'load it with base = "free" (a key of a SPEC too), or give its file a free base'


def check(
    name: str, free: bool, bodies: tuple[Body, ...], axes: Axes, plane: int | None = None
) -> None:
    """Refuse what cannot be a body in the air, naming the body or joint and the mend.

    Parameters
    ----------
    name, free, bodies, axes, plane
        Of a `Model`.

    Raises
    ------
    SomersaultError
    """
    check_types(name, free, bodies)
    joints = [joint for body in bodies for joint in body.joints]
    moving = sum(joint.speeds for joint in joints)
    if moving > MOST_SPEEDS:
        raise SomersaultError(
            f"{name} moves in {moving} ways besides its base, and equations are written for up to "
            f"{MOST_SPEEDS}; weld the bodies whose motion does not matter"
        )
    if not bodies:
        raise SomersaultError(f"{name} has no bodies, so nothing can fly; add a body")
    if not free and axes != AXES:
        raise SomersaultError(
            f"{name} has a fixed base, so it has no somersault, tilt or twist; leave its "
            f"axes out, or {FREE_IT}"
        )
    if plane is not None:
        _check_plane(name, free, axes, plane)
    for what, names in (
        ("body", [body.name for body in bodies]),
        ("joint", [joint.name for joint in joints]),
    ):
        twice, count = next(iter(Counter(names).most_common(1)), ("", 0))
        if count > 1:
            raise SomersaultError(
                f"{name} has two {what} elements named {twice!r}; give each its own name"
            )
    speeds = speed_names(joints)
    if "" in [*(body.name for body in bodies), *speeds]:
        raise SomersaultError(f"{name} has a body or joint without a name; name it")
    if len(set(speeds)) < len(speeds):
        raise SomersaultError(
            f"{name} has a joint named like a part of a ball joint (x.1); rename it"
        )
    for index, body in enumerate(bodies):
        _check_tree(name, free, index, body)
        _check_body(name, body)
        for joint in body.joints:
            _check_joint(name, joint)
            if joint.follows is not None:
                _check_follow(name, joints, joint, joint.follows)
    _check_mass(name, math.fsum(body.mass for body in bodies))
    _check_moving_mass(name, bodies)
    _warn_of_impossible(name, bodies if plane is None else _turning_out(bodies, plane))


def _check_plane(name: str, free: bool, axes: Axes, plane: int) -> None:
    if not free:
        raise SomersaultError(
            f"{name} has a fixed base, so it moves in no plane of its own; leave its plane out"
        )
    if isinstance(plane, bool) or not isinstance(plane, int) or plane not in (1, 2, 3):
        raise SomersaultError(
            f"{name} has the plane {shown(plane)}; give the base's axis across it, 1, 2 or 3"
        )
    if axes[0] != plane:
        raise SomersaultError(
            f"{name} moves in the plane across its axis {plane}, so it somersaults about that and "
            f"not about axis {axes[0]}; give axes that begin with {plane}, or "
            'base = "free"'
        )


def _check_tree(name: str, free: bool, index: int, body: Body) -> None:
    if not GROUND <= body.parent < index:
        raise SomersaultError(
            f"{name}: body {body.name!r} must come after its parent, so the bodies form "
            "a loop or stand out of order"
        )
    if free and (body.parent == GROUND) != (index == 0):
        raise SomersaultError(
            f"{name}: body {body.name!r} is not part of the free body; a model in the "
            "air is one tree, so remove it or join it to the base"
        )
    if not body.joints and not (free and index == 0):
        raise SomersaultError(
            f"{name}: body {body.name!r} has no joint, so it cannot move against its "
            "parent; make the two one body"
        )
    if free and index == 0 and body.joints:
        raise SomersaultError(
            f"{name}: the free base {body.name!r} has joints of its own; remove them"
        )


def _check_body(name: str, body: Body) -> None:
    where = f"{name}: body {body.name!r}"
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


def _turning_out(bodies: tuple[Body, ...], plane: int) -> tuple[Body, ...]:
    """The bodies that may turn out of the plane of a base, across its axis `plane`: of the others
    only the inertia about that axis counts."""
    turns: list[np.ndarray] = []
    within: list[bool] = []
    for index, body in enumerate(bodies):
        turns.append(turns[body.parent] @ np.array(body.rotation) if index else np.eye(3))
        along = [
            abs((turns[-1] @ joint.axis)[plane - 1]) if joint.kind == "hinge" else 0.0
            for joint in body.joints
            if joint.kind != "slide"
        ]
        within.append((within[body.parent] if index else True) and all(c > _ALONG for c in along))
    return tuple(body for body, inside in zip(bodies, within, strict=True) if not inside)


def _warn_of_impossible(name: str, bodies: tuple[Body, ...]) -> None:
    """Name the bodies that no distribution of mass makes: one principal inertia larger than the
    sum of the other two, or negative, or inertia without mass.

    Such are published every day and read by every program, since the motion of the whole is
    defined as long as its mass matrix is positive; that is looked at where models are loaded.
    """
    odd = []
    for body in bodies:
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
        note(
            f"{name}: no rigid body has inertia without mass, or a principal inertia that is "
            "negative or larger than the sum of the other two, as these have: "
            f"{', '.join(odd[:8])}{more}; flown as given"
        )


def _check_joint(name: str, joint: Joint) -> None:
    where = f"{name}: joint {joint.name!r}"
    if joint.kind not in ("hinge", "slide", "ball"):
        raise SomersaultError(f"{where} is a {shown(joint.kind)}; joints are hinge, slide or ball")
    numbers = [*joint.axis, *joint.anchor, joint.reference, joint.rest]
    numbers += [joint.stiffness, joint.damping, joint.armature, *(joint.limits or ())]
    if not all(map(math.isfinite, numbers)):
        raise SomersaultError(f"{where} holds a number that is not finite; give finite numbers")
    if abs(math.hypot(*joint.axis) - 1) > 1e-6:
        raise SomersaultError(f"{where} has an axis of length {math.hypot(*joint.axis):g}; give 1")
    if joint.limits is not None and joint.limits[0] > joint.limits[1]:
        raise SomersaultError(f"{where} has limits in the wrong order; give the smaller first")
    if joint.stiffness < 0:
        note(
            f"{where} has negative stiffness ({joint.stiffness:g}), which drives it away from rest"
        )
    for what in ("damping", "armature"):
        if getattr(joint, what) < 0:
            raise SomersaultError(f"{where} has negative {what}; it must be zero or positive")


def _check_follow(name: str, joints: list[Joint], joint: Joint, follow: Follow) -> None:
    where = f"{name}: joint {joint.name!r}"
    leader = next((j for j in joints if j.name == follow.leader), None)
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


def _check_mass(name: str, mass: float) -> None:
    if mass <= 0:
        raise SomersaultError(f"{name} has no mass; give its bodies masses")
    if not _LIGHTEST <= mass <= _HEAVIEST:
        note(f"{name} has a mass of {mass:g} kg in all; masses are in kg, lengths in m")


def _check_moving_mass(name: str, bodies: tuple[Body, ...]) -> None:
    """Every joint must move something, itself or by those that follow it, or its acceleration
    has no meaning."""
    joints = [joint for body in bodies for joint in body.joints]
    leading = {joint.follows.leader for joint in joints if joint.follows is not None}
    outboard = [body.mass for body in bodies]
    for index in range(len(bodies) - 1, 0, -1):
        if bodies[index].parent != GROUND:
            outboard[bodies[index].parent] += outboard[index]
    for body, mass in zip(bodies, outboard, strict=True):
        idle = [j.name for j in body.joints if not j.armature and j.name not in leading]
        if idle and mass == 0:
            raise SomersaultError(
                f"{name}: joint {idle[-1]!r} moves no mass; give body {body.name!r} a mass "
                "or remove the joint"
            )
