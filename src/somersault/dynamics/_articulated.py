"""Forward dynamics by the articulated-body algorithm (Featherstone 1983), over symbols.

Each link's articulated inertia is kept in 3 × 3 blocks about its frame's origin,

    [moment]   [ I  H ] [α]   [n]
    [force ] = [ Hᵀ M ] [a] + [f],

α its angular acceleration and a the acceleration of its origin. A hinge about a coordinate
axis makes that axis's row of I and H exactly zero once it has been projected out, which is
written as zero and never computed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from somersault.dynamics._motion import Placed, Rates, joint_vector, placements, rates
from somersault.dynamics._tree import Link, Tree
from somersault.dynamics.vectors import (
    Mat,
    Scalar,
    Vec,
    add,
    cross,
    dot,
    madd,
    matmul,
    matvec,
    mul,
    scale,
    solve_symmetric,
    steiner,
    sub,
    symmetric,
    tilde,
    transpose,
    vadd,
    vsub,
)


@dataclass
class _Articulated:
    """I, H, M and the bias n, f of one link and all that it carries."""

    moment: Mat
    coupling: Mat
    mass: Mat
    n: Vec
    f: Vec


@dataclass(frozen=True)
class _Gain:
    """A joint's own acceleration: bias − rows · (α, a)."""

    bias: Vec
    alpha_rows: Mat
    a_rows: Mat


def forward_dynamics(
    tree: Tree,
    q: Sequence[Scalar],
    omega: Vec,
    speeds: Sequence[Scalar],
    torques: Sequence[Scalar],
    gravity: Vec,
    driven: Mapping[int, Scalar] | None = None,
) -> tuple[Vec, Vec, list[Scalar]]:
    """Accelerations by the articulated-body algorithm (Featherstone 1983).

    Vectors are in the base's axes; for a fixed base in the ground's.

    Parameters
    ----------
    tree : Tree
    q : sequence
        Joint coordinates.
    omega : vector
        Angular velocity of the base, rad/s; what of it would turn a base out of its plane counts
        as zero.
    speeds : sequence
        Joint speeds.
    torques : sequence
        What acts at each joint speed, N m or N.
    gravity : vector
        m/s².
    driven : mapping of int to number, optional
        Accelerations that are prescribed, by the place of the joint speed. A ball is driven in all
        three or in none.

    Returns
    -------
    alpha, a : vector
        Angular acceleration of a free base, rad/s², and acceleration of its own centre of mass,
        m/s²; zero for a fixed base, and out of its plane for a planar one.
    accelerations : list
        Of the joint speeds.
    """
    driven = driven or {}
    omega = tree.kept(omega)
    placed = placements(tree, q)
    moving = [
        _driven(link, motion, driven)
        for link, motion in zip(tree.links, rates(placed, omega, speeds), strict=True)
    ]
    bodies = [_rigid(link, motion) for link, motion in zip(tree.links, moving, strict=True)]
    gains: list[_Gain | None] = [None] * len(bodies)
    for index in range(len(bodies) - 1, -1, -1):
        link = tree.links[index]
        if link.joint is None:
            continue
        if link.speeds.start not in driven:
            gains[index] = _project(link, bodies[index], list(torques[link.speeds]))
        _carry(bodies[index], moving[index])
        if link.parent >= 0:
            _hang(bodies[link.parent], placed[index], bodies[index])
    return _accelerations(tree, placed, moving, bodies, gains, gravity, driven)


def _driven(link: Link, motion: Rates, driven: Mapping[int, Scalar]) -> Rates:
    """A prescribed joint's own acceleration is known, as those that rates make are."""
    if link.joint is None or link.speeds.start not in driven:
        return motion
    known = joint_vector(link, [driven.get(k, 0.0) for k in range(link.speeds.stop)])
    if link.joint.kind == "slide":
        return replace(motion, pull=vadd(motion.pull, known))
    return replace(motion, spin=vadd(motion.spin, known))


def _rigid(link: Link, motion: Rates) -> _Articulated:
    """A lone link: its inertia about its origin, and the bias of its own turning."""
    first = scale(link.mass, link.com)
    about_origin = madd(link.inertia, steiner(link.mass, link.com))
    return _Articulated(
        about_origin,
        tilde(first),
        [[link.mass if i == j else 0.0 for j in range(3)] for i in range(3)],
        cross(motion.omega, matvec(about_origin, motion.omega)),
        cross(motion.omega, cross(motion.omega, first)),
    )


def _project(link: Link, body: _Articulated, torques: list[Scalar]) -> _Gain:
    """Take the joint's own freedom out of `body`; what is left is what its parent feels."""
    joint = link.joint
    assert joint is not None
    if joint.kind == "ball":
        return _project_ball(joint.armature, body, torques)
    return _project_axis(link, body, torques[0])


def _carry(body: _Articulated, motion: Rates) -> None:
    """Add the load of the accelerations that are known to the bias."""
    body.n = vadd(body.n, matvec(body.moment, motion.spin), matvec(body.coupling, motion.pull))
    body.f = vadd(
        body.f, matvec(transpose(body.coupling), motion.spin), matvec(body.mass, motion.pull)
    )


def _project_axis(link: Link, body: _Articulated, torque: Scalar) -> _Gain:
    joint, k = link.joint, link.axis
    assert joint is not None
    hinge = joint.kind == "hinge"
    if hinge:  # the columns that the joint's acceleration multiplies
        to_moment, to_force = list(body.moment[k]), list(body.coupling[k])
        bias, inertia = body.n[k], body.moment[k][k]
    else:
        to_moment, to_force = [row[k] for row in body.coupling], list(body.mass[k])
        bias, inertia = body.f[k], body.mass[k][k]
    inverse = 1.0 / add(inertia, joint.armature)
    effort = mul(inverse, sub(mul(link.sign, torque), bias))
    moment_gain, force_gain = scale(inverse, to_moment), scale(inverse, to_force)
    exact = k if joint.armature == 0.0 else None  # rows that vanish identically
    body.moment = _reduced(body.moment, to_moment, moment_gain, exact if hinge else None)
    body.mass = _reduced(body.mass, to_force, force_gain, None if hinge else exact)
    body.coupling = [
        [
            0.0
            if exact is not None and (i if hinge else j) == exact
            else sub(body.coupling[i][j], mul(moment_gain[i], to_force[j]))
            for j in range(3)
        ]
        for i in range(3)
    ]
    body.n = vadd(body.n, scale(effort, to_moment))
    body.f = vadd(body.f, scale(effort, to_force))
    if exact is not None:  # what passes the joint's own axis is the applied torque (force)
        passed = body.n if hinge else body.f
        passed[k] = mul(link.sign, torque)
    return _Gain(
        [mul(link.sign, effort)],
        [scale(link.sign, moment_gain)],
        [scale(link.sign, force_gain)],
    )


def _reduced(a: Mat, column: Vec, gain: Vec, exact: int | None) -> Mat:
    """A − column gainᵀ, with the row and column `exact` known to vanish."""
    return symmetric(
        [
            [
                0.0 if exact in (i, j) or j < i else sub(a[i][j], mul(column[i], gain[j]))
                for j in range(3)
            ]
            for i in range(3)
        ]
    )


def _project_ball(armature: float, body: _Articulated, torques: list[Scalar]) -> _Gain:
    inertia = [[add(body.moment[i][j], armature * (i == j)) for j in range(3)] for i in range(3)]
    across = transpose(body.coupling)  # rows of Hᵀ are columns of H
    effort, *turned = solve_symmetric(inertia, [vsub(torques, body.n), *transpose(body.coupling)])
    a_rows = transpose(turned)  # D⁻¹ H
    if armature == 0.0:
        alpha_rows: Mat = [[float(i == j) for j in range(3)] for i in range(3)]
    else:
        alpha_rows = transpose(solve_symmetric(inertia, body.moment))
    left = matmul(body.moment, a_rows)
    body.n = vadd(body.n, matvec(body.moment, effort))
    body.f = vadd(body.f, matvec(across, effort))
    body.mass = symmetric(
        [vsub(x, y) for x, y in zip(body.mass, matmul(across, a_rows), strict=True)]
    )
    if armature == 0.0:
        body.n = list(torques)
        body.coupling = [[0.0] * 3 for _ in range(3)]
        body.moment = [[0.0] * 3 for _ in range(3)]
    else:
        body.coupling = [vsub(x, y) for x, y in zip(body.coupling, left, strict=True)]
        reduced = matmul(body.moment, alpha_rows)
        body.moment = symmetric([vsub(x, y) for x, y in zip(body.moment, reduced, strict=True)])
    return _Gain(effort, alpha_rows, a_rows)


def _hang(parent: _Articulated, at: Placed, body: _Articulated) -> None:
    """Add a projected link to its parent: turned into the parent's axes, moved to its origin."""
    moment = at.turn.out_symmetric(body.moment)
    coupling = at.turn.out_matrix(body.coupling)
    mass = at.turn.out_symmetric(body.mass)
    n, f = at.turn.out(body.n), at.turn.out(body.f)
    p = tilde(at.position)
    shifted = matmul(p, mass)  # p̃ M
    moved = madd(coupling, shifted)  # H + p̃ M
    # I − H p̃ + p̃ Hᵀ − p̃ M p̃ = I + p̃ Hᵀ − (H + p̃ M) p̃, symmetric as a whole
    left, right = matmul(p, transpose(coupling)), matmul(moved, p)
    parent.moment = symmetric(
        [
            [
                add(parent.moment[i][j], add(moment[i][j], sub(left[i][j], right[i][j])))
                if j >= i
                else 0.0
                for j in range(3)
            ]
            for i in range(3)
        ]
    )
    parent.coupling = madd(parent.coupling, moved)
    parent.mass = symmetric(madd(parent.mass, mass))
    parent.n = vadd(parent.n, n, cross(at.position, f))
    parent.f = vadd(parent.f, f)


def _accelerations(
    tree: Tree,
    placed: list[Placed],
    moving: list[Rates],
    bodies: list[_Articulated],
    gains: list[_Gain | None],
    gravity: Vec,
    driven: Mapping[int, Scalar],
) -> tuple[Vec, Vec, list[Scalar]]:
    """Outward again: the base's acceleration, then each joint's in turn.

    Falling in gravity is the same as accelerating upward without it, so −gravity is given to
    the ground (and to a free base's own acceleration in the end).
    """
    against = scale(-1.0, gravity)
    alphas: list[Vec] = []
    accelerations: list[Vec] = []
    count = sum(link.joint.speeds for link in tree.links if link.joint is not None)
    joints: list[Scalar] = [0.0] * count
    base_alpha: Vec = [0.0] * 3
    base_a: Vec = against
    for index, (link, at, motion) in enumerate(zip(tree.links, placed, moving, strict=True)):
        if link.joint is None:
            base_alpha, base_a = _freed(bodies[index], tree.ways, against)
            alphas.append(base_alpha)
            accelerations.append(base_a)
            continue
        alpha_p = alphas[link.parent] if link.parent >= 0 else [0.0] * 3
        a_p = accelerations[link.parent] if link.parent >= 0 else against
        alpha = vadd(at.turn.into(alpha_p), motion.spin)
        a = vadd(at.turn.into(vadd(a_p, cross(alpha_p, at.position))), motion.pull)
        gain = gains[index]
        if gain is None:  # prescribed: its own acceleration is in spin and pull already
            joints[link.speeds] = [driven[k] for k in range(link.speeds.start, link.speeds.stop)]
            alphas.append(alpha)
            accelerations.append(a)
            continue
        joints[link.speeds] = [
            sub(b, add(dot(x, alpha), dot(y, a)))
            for b, x, y in zip(gain.bias, gain.alpha_rows, gain.a_rows, strict=True)
        ]
        vector = joint_vector(link, joints)
        alphas.append(alpha if link.joint.kind == "slide" else vadd(alpha, vector))
        accelerations.append(vadd(a, vector) if link.joint.kind == "slide" else a)
    return base_alpha, vsub(base_a, against) if tree.free else [0.0] * 3, joints


def _freed(base: _Articulated, ways: Sequence[int], held: Vec) -> tuple[Vec, Vec]:
    """α and a of a base that nothing holds in its ways: [I H; Hᵀ M] (α, a) = −(n, f).

    Where it has no way α is zero and a that of `held`.
    """
    whole = [
        *([*base.mass[i], *[base.coupling[j][i] for j in range(3)]] for i in range(3)),
        *([*base.coupling[i], *base.moment[i]] for i in range(3)),
    ]
    moving = [k for k in range(6) if (k + 3) % 6 in ways]  # here a stands before α
    result = [0.0 if k in moving else x for k, x in enumerate([*held, 0.0, 0.0, 0.0])]
    load = vadd([*base.f, *base.n], matvec(whole, result))
    (solution,) = solve_symmetric(
        [[whole[i][j] for j in moving] for i in moving], [[mul(-1.0, load[k]) for k in moving]]
    )
    for k, value in zip(moving, solution, strict=True):
        result[k] = value
    return result[3:], result[:3]
