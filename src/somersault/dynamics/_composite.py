"""Composite inertia and the mass matrix: a body with what hangs from it held still."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from somersault.dynamics._motion import Placed, placements
from somersault.dynamics._tree import Link, Tree
from somersault.dynamics.vectors import (
    Mat,
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
)

_UNITS: Mat = [[float(i == j) for j in range(3)] for i in range(3)]


@dataclass(frozen=True)
class Composite:
    """A link and all that hangs from it as one rigid body: inertia about its frame's origin."""

    mass: Scalar
    first_moment: Vec
    inertia: Mat

    @property
    def centre(self) -> Vec:
        """Centre of mass, from the frame's origin."""
        return scale(1.0 / self.mass, self.first_moment)

    @property
    def about_centre(self) -> Mat:
        """Inertia about the centre of mass."""
        return madd(self.inertia, [scale(-1.0, row) for row in steiner(self.mass, self.centre)])

    def load(self, alpha: Vec, a: Vec) -> tuple[Vec, Vec]:
        """What accelerates the body from rest.

        Parameters
        ----------
        alpha : vector
            Its angular acceleration, in the link's axes.
        a : vector
            The acceleration of its frame's origin.

        Returns
        -------
        moment, force : vector
            The moment is about the origin.
        """
        moment = vadd(matvec(self.inertia, alpha), cross(self.first_moment, a))
        return moment, vadd(scale(self.mass, a), cross(alpha, self.first_moment))


def composite_bodies(tree: Tree, placed: Sequence[Placed]) -> list[Composite]:
    """Each link and all that is outboard of it as one rigid body.

    Parameters
    ----------
    tree : Tree
    placed : sequence of Placed
        Its links in a pose, as `placements` returns them.

    Returns
    -------
    list of Composite
        One for each link, in its axes.
    """
    result = [
        Composite(
            link.mass,
            scale(link.mass, link.com),
            madd(link.inertia, steiner(link.mass, link.com)),
        )
        for link in tree.links
    ]
    for index in range(len(result) - 1, -1, -1):
        at, outer = placed[index], result[index]
        if at.link.joint is None or at.link.parent < 0:
            continue
        first = at.turn.out(outer.first_moment)
        inertia = at.turn.out_symmetric(outer.inertia)
        inner = result[at.link.parent]
        result[at.link.parent] = Composite(
            add(inner.mass, outer.mass),
            vadd(inner.first_moment, first, scale(outer.mass, at.position)),
            madd(madd(inner.inertia, inertia), _moved(outer.mass, first, at.position)),
        )
    return result


def _moved(mass: Scalar, first: Vec, p: Vec) -> Mat:
    """What moving a body by p adds to its inertia about the old origin."""
    twice = mul(2.0, dot(first, p))
    shift = steiner(mass, p)
    return [
        [
            add(
                add(shift[i][j], twice if i == j else 0.0),
                mul(-1.0, add(mul(first[i], p[j]), mul(p[i], first[j]))),
            )
            for j in range(3)
        ]
        for i in range(3)
    ]


def outboard_inertia(tree: Tree, placed: Sequence[Placed]) -> list[Scalar]:
    """The inertia that each joint speed alone would move, the I of K = k/(Ω² I).

    Parameters
    ----------
    tree : Tree
    placed : sequence of Placed
        Its links in a pose, as `placements` returns them.

    Returns
    -------
    list
        About the joint's axis, with the outboard joints locked, kg m²; for a slide the mass, kg;
        for a ball the moments about its body's axes.
    """
    result: list[Scalar] = []
    for link, whole in zip(tree.links, composite_bodies(tree, placed), strict=True):
        if link.joint is None:
            continue
        if link.joint.kind == "slide":
            result.append(whole.mass)
        elif link.joint.kind == "hinge":
            result.append(whole.inertia[link.axis][link.axis])
        else:
            result += [whole.inertia[k][k] for k in range(3)]
    return result


def mass_matrix(tree: Tree, q: Sequence[Scalar]) -> Mat:
    """The mass matrix, by composite bodies (Walker and Orin 1982).

    Parameters
    ----------
    tree : Tree
    q : sequence
        Joint coordinates.

    Returns
    -------
    list of list
        M in T = ½ vᵀ M v, with v = (ω, velocity of a free base's own centre of mass, joint speeds);
        without a free base the joint speeds alone.
    """
    placed = placements(tree, q)
    wholes = composite_bodies(tree, placed)
    count = sum(link.joint.speeds for link in tree.links if link.joint is not None)
    ahead = 6 if tree.free else 0
    matrix: Mat = [[0.0] * (ahead + count) for _ in range(ahead + count)]
    if tree.free:
        for k, unit in enumerate(_UNITS):
            for column, motion in ((k, (unit, [0.0] * 3)), (3 + k, ([0.0] * 3, unit))):
                moment, force = wholes[0].load(*motion)
                for row, value in enumerate([*moment, *force]):
                    matrix[row][column] = value
    for index, link in enumerate(tree.links):
        for column, (moment, force) in _unit_loads(link, wholes[index]):
            rotor = link.joint.armature if link.joint is not None else 0.0
            _pass_to_base(tree, placed, index, moment, force, matrix, column, ahead)
            matrix[ahead + column][ahead + column] = add(
                matrix[ahead + column][ahead + column], rotor
            )
    return matrix


def _unit_loads(link: Link, whole: Composite) -> list[tuple[int, tuple[Vec, Vec]]]:
    """The load that one unit of each of the joint's own accelerations takes."""
    if link.joint is None:
        return []
    still: Vec = [0.0] * 3
    if link.joint.kind == "ball":
        return [(link.speeds.start + k, whole.load(_UNITS[k], still)) for k in range(3)]
    unit = scale(link.sign, _UNITS[link.axis])
    motion = (still, unit) if link.joint.kind == "slide" else (unit, still)
    return [(link.speeds.start, whole.load(*motion))]


def _pass_to_base(
    tree: Tree,
    placed: Sequence[Placed],
    index: int,
    moment: Vec,
    force: Vec,
    matrix: Mat,
    column: int,
    ahead: int,
) -> None:
    """Enter a load's components along every joint from `index` inward."""
    while True:
        link = tree.links[index]
        if link.joint is None:
            for row, value in enumerate([*moment, *force]):
                matrix[row][ahead + column] = matrix[ahead + column][row] = value
            return
        load = force if link.joint.kind == "slide" else moment
        along = load if link.joint.kind == "ball" else [mul(link.sign, load[link.axis])]
        for row, value in enumerate(along, link.speeds.start):
            matrix[ahead + row][ahead + column] = matrix[ahead + column][ahead + row] = value
        if link.parent < 0:
            return
        at = placed[index]
        force = at.turn.out(force)
        moment = vadd(at.turn.out(moment), cross(at.position, force))
        index = link.parent
