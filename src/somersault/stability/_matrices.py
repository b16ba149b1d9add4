"""The linear equations of small deviations from a steady spin, derived from the model.

M ẍ + Ω (G + D) ẋ + Ω² (K + K′) x = 0 (Playter 1994, eq. 4.1), here with Ω = 1. The deviations
are small turns about the base's axes, seen from a frame that turns steadily with the spin,
and the joints' own; translation is gone, because the centre of mass stays where it is. A base in a
plane does not move across it; of its turns, rows and columns of the one about the normal alone
mean anything.
"""

from __future__ import annotations

from typing import Any

import casadi as ca

from somersault.dynamics import (
    Equations,
    Expression,
    inverse_dynamics,
    outboard_inertia,
    placements,
)
from somersault.dynamics.vectors import Vec, cross, scale, vadd, vsub
from somersault.model import Model


def spin_matrices(equations: Equations) -> Expression:
    """(M, G, K | τ) of a spin at pose `q` about the unit vector `axis`, one matrix of rows.

    Columns: M, G, K (each 3 + joint speeds wide), then the holding torques and the outboard
    inertias. Rows: the base's three axes, then the joint speeds.
    """
    model = equations.model
    count = len(model.speeds)
    q = ca.SX.sym("q", len(model.coordinates))
    axis = ca.SX.sym("axis", 3)
    x, dx, ddx = (ca.SX.sym(name, 3 + count) for name in ("x", "dx", "ddx"))
    loads = ca.vertcat(*_loads(equations, q, axis, x, dx, ddx))
    matrices = [ca.jacobian(loads, symbol) for symbol in (ddx, dx, x)]
    still = ca.vertcat(x, dx, ddx)
    at_rest = ca.substitute([*matrices, loads], [still], [ca.SX.zeros(still.numel())])
    placed = placements(equations.tree, [q[k] for k in range(q.numel())])
    outboard = outboard_inertia(equations.tree, placed)
    value = ca.horzcat(*at_rest, ca.vertcat(0.0, 0.0, 0.0, *outboard))
    arguments = {"q": q, "axis": axis, "parameters": equations.open_parameters}
    return Expression("spin_matrices", arguments, value)


def spin_torques(equations: Equations) -> Expression:
    """What holds each joint speed in the same spins: a column of `spin_matrices` alone."""
    model = equations.model
    q = ca.SX.sym("q", len(model.coordinates))
    axis = ca.SX.sym("axis", 3)
    still = ca.SX.zeros(3 + len(model.speeds))
    loads = ca.vertcat(*_loads(equations, q, axis, still, still, still)[3:])
    arguments = {"q": q, "axis": axis, "parameters": equations.open_parameters}
    return Expression("spin_torques", arguments, loads)


def _loads(equations: Equations, q: Any, axis: Any, x: Any, dx: Any, ddx: Any) -> list[Any]:
    """Moment about the base and joint torques that the deviated motion would need.

    To first order a body turned by δ in the steady frame sees the spin as e − δ × e, and a
    uniform acceleration keeps the centre of mass where it is.
    """
    e: Vec = [axis[k] for k in range(3)]
    turn, turn_rate, turn_acceleration = ([v[k] for k in range(3)] for v in (x, dx, ddx))
    omega = vadd(e, turn_rate, scale(-1.0, cross(turn, e)))
    alpha = vsub(turn_acceleration, cross(turn_rate, e))
    deviation, speeds, accelerations = (
        [v[3 + k] for k in range(v.numel() - 3)] for v in (x, dx, ddx)
    )
    pose = deviated(equations.model, [q[k] for k in range(q.numel())], deviation)
    tree = equations.tree

    def needed(a: Vec) -> tuple[Vec, Vec, list[Any]]:
        return inverse_dynamics(tree, pose, omega, speeds, alpha, a, accelerations)

    _, force, _ = needed([0.0, 0.0, 0.0])
    falling = scale(-1.0 / tree.mass, force)
    moment, _, torques = needed([a if 3 + k in tree.ways else 0.0 for k, a in enumerate(falling)])
    return [*moment, *torques]


def deviated(model: Model, q: Vec, deviation: Vec) -> Vec:
    """The pose q with each joint moved by a small `deviation` along its speeds."""
    pose: Vec = []
    for joint in model.joints:
        at = q[model.coordinate_slice(joint.name)]
        small = deviation[model.speed_slice(joint.name)]
        if joint.kind == "ball":
            w, v = at[0], at[1:]
            half = scale(0.5, small)
            pose += [w - sum(a * b for a, b in zip(v, half, strict=True))]
            pose += vadd(v, scale(w, half), cross(v, half))
        else:
            pose += [at[0] + small[0]]
    return pose
