"""Inverse dynamics, momentum and energy, over symbols.

The recursive Newton–Euler form: outward for accelerations, inward for forces. Everything is
in the axes of the base (of the ground, for a fixed base).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from somersault.dynamics._composite import composite_bodies
from somersault.dynamics._motion import Placed, joint_vector, placements, rates
from somersault.dynamics._tree import Link, Tree
from somersault.dynamics.vectors import (
    Scalar,
    Vec,
    add,
    cross,
    dot,
    madd,
    matvec,
    mul,
    scale,
    steiner,
    vadd,
    vsub,
)

_NOTHING: Vec = [0.0, 0.0, 0.0]


def inverse_dynamics(
    tree: Tree,
    q: Sequence[Scalar],
    omega: Vec,
    speeds: Sequence[Scalar],
    alpha: Vec,
    acceleration: Vec,
    joint_accelerations: Sequence[Scalar],
) -> tuple[Vec, Vec, list[Scalar]]:
    """What must act for given accelerations, by the recursive Newton–Euler algorithm.

    Vectors are in the base's axes; for a fixed base in the ground's. In a uniform gravity g,
    `acceleration` is the base's own less g.

    Parameters
    ----------
    tree : Tree
    q : sequence
        Joint coordinates.
    omega : vector
        Angular velocity of the base, rad/s.
    speeds : sequence
        Joint speeds.
    alpha : vector
        Angular acceleration of the base, rad/s².
    acceleration : vector
        Acceleration of its own centre of mass, m/s².
    joint_accelerations : sequence
        Of the joint speeds.

    Returns
    -------
    moment, force : vector
        On a free base; the moment is about its own centre of mass, N m. Zero for a fixed base.
    torques : list
        At the joint speeds, N m or N.
    """
    placed = placements(tree, q)
    moving = rates(placed, omega, speeds)
    alphas: list[Vec] = []
    origins: list[Vec] = []
    loads: list[tuple[Vec, Vec]] = []
    for link, at, motion in zip(tree.links, placed, moving, strict=True):
        if link.joint is None:
            alphas.append(list(alpha))
            origins.append(list(acceleration))
        else:
            outer = alphas[link.parent] if link.parent >= 0 else list(alpha)
            carried = origins[link.parent] if link.parent >= 0 else list(acceleration)
            relative = joint_vector(link, joint_accelerations)
            turned = vadd(at.turn.into(outer), motion.spin)
            moved = vadd(at.turn.into(vadd(carried, cross(outer, at.position))), motion.pull)
            slides = link.joint.kind == "slide"
            alphas.append(turned if slides else vadd(turned, relative))
            origins.append(vadd(moved, relative) if slides else moved)
        loads.append(_inertial_load(link, motion.omega, alphas[-1], origins[-1]))
    torques: list[Scalar] = [0.0] * len(joint_accelerations)
    for index in range(len(loads) - 1, -1, -1):
        link, at = tree.links[index], placed[index]
        if link.joint is None:
            continue
        torques[link.speeds] = _along(link, *loads[index], joint_accelerations)
        if link.parent >= 0:
            _pass_inward(loads, link.parent, at, *loads[index])
    moment, force = loads[0] if tree.free else (_NOTHING, _NOTHING)
    return moment, force, torques


def _inertial_load(link: Link, omega: Vec, alpha: Vec, a: Vec) -> tuple[Vec, Vec]:
    """Moment about the link's origin and force that its own motion needs."""
    first = scale(link.mass, link.com)
    inertia = madd(link.inertia, steiner(link.mass, link.com))
    moment = vadd(matvec(inertia, alpha), cross(omega, matvec(inertia, omega)), cross(first, a))
    force = vadd(scale(link.mass, a), cross(alpha, first), cross(omega, cross(omega, first)))
    return moment, force


def _along(link: Link, moment: Vec, force: Vec, accelerations: Sequence[Scalar]) -> list[Scalar]:
    """The part of a load that the joint's actuator, and its rotor, must give."""
    joint = link.joint
    assert joint is not None
    rotor = [mul(joint.armature, x) for x in accelerations[link.speeds]]
    if joint.kind == "ball":
        return vadd(moment, rotor)
    load = force if joint.kind == "slide" else moment
    return [add(mul(link.sign, load[link.axis]), rotor[0])]


def _pass_inward(
    loads: list[tuple[Vec, Vec]], parent: int, at: Placed, moment: Vec, force: Vec
) -> None:
    n, f = at.turn.out(moment), at.turn.out(force)
    held = loads[parent]
    loads[parent] = (vadd(held[0], n, cross(at.position, f)), vadd(held[1], f))


@dataclass(frozen=True)
class Momentum:
    """Angular momentum about the whole body's centre of mass, linear momentum, kinetic energy."""

    angular: Vec
    linear: Vec
    energy: Scalar


def momentum(
    tree: Tree, q: Sequence[Scalar], omega: Vec, velocity: Vec, speeds: Sequence[Scalar]
) -> Momentum:
    """Momentum and kinetic energy.

    Parameters
    ----------
    tree : Tree
    q : sequence
        Joint coordinates.
    omega : vector
        Angular velocity of the base, rad/s.
    velocity : vector
        Of a free base's own centre of mass, m/s.
    speeds : sequence
        Joint speeds.

    Returns
    -------
    Momentum
        In the base's axes. For a fixed base the angular momentum is about the ground's origin.
    """
    placed = placements(tree, q)
    moving = rates(placed, omega, speeds)
    velocities: list[Vec] = []
    carried: list[tuple[Vec, Vec]] = []  # angular about the link's origin, linear
    twice: list[Scalar] = []
    for link, at, motion in zip(tree.links, placed, moving, strict=True):
        if link.joint is None:
            v = list(velocity)
        else:
            outer = moving[link.parent].omega if link.parent >= 0 else list(_NOTHING)
            base = velocities[link.parent] if link.parent >= 0 else list(velocity)
            v = at.turn.into(vadd(base, cross(outer, at.position)))
            if link.joint.kind == "slide":
                v = vadd(v, joint_vector(link, speeds))
            rotor = link.joint.armature
            twice += [mul(rotor, mul(x, x)) for x in speeds[link.speeds]]
        velocities.append(v)
        of_com = vadd(v, cross(motion.omega, link.com))
        linear = scale(link.mass, of_com)
        spin = matvec(link.inertia, motion.omega)
        carried.append((vadd(spin, cross(link.com, linear)), linear))
        twice += [dot(motion.omega, spin), dot(of_com, linear)]
    for index in range(len(carried) - 1, -1, -1):
        link = tree.links[index]
        if link.joint is not None and link.parent >= 0:
            _pass_inward(carried, link.parent, placed[index], *carried[index])
    energy: Scalar = 0.0
    for term in twice:
        energy = add(energy, mul(0.5, term))
    if not tree.free:
        angular, linear = list(_NOTHING), list(_NOTHING)
        for index, link in enumerate(tree.links):
            if link.parent < 0:
                turn, position = placed[index].turn, placed[index].position
                f = turn.out(carried[index][1])
                angular = vadd(angular, turn.out(carried[index][0]), cross(position, f))
                linear = vadd(linear, f)
        return Momentum(angular, linear, energy)
    angular, linear = carried[0]
    centre = composite_bodies(tree, placed)[0].centre
    return Momentum(vsub(angular, cross(centre, linear)), linear, energy)
