"""What the joints must do so that the feet push the floor as wanted."""

from __future__ import annotations

import numpy as np

from somersault._core.array import Array
from somersault.ground._balance import Push, within
from somersault.ground._law import LandingLaw
from somersault.ground._machine import Machine, Moment

# Weights of what is asked of the accelerations, in m/s² or rad/s²: that the body moves and turns as
# the force has it, that the feet stay (the turn of a foot counts as of a lever of 0.15 m), that
# joints stop before the ends of their ranges, that the arms go where they should, that nothing more
# happens than must.
_BODY, _FEET, _ENDS, _ARMS, _LEAST = 3.0, 3.0, 3.0, 0.3, 0.003
_LEVER = 0.15
# Within `_NEAR` rad of an end, where a joint will be after `_SOON` s, it is stopped `_SHORT` of it.
_SHORT, _NEAR, _SOON, _STIFFNESS, _DAMPING = 0.05, 0.05, 0.08, 100.0, 20.0


def torques(law: LandingLaw, machine: Machine, moment: Moment, push: Push) -> Array:
    """Torques of the joints, in the model's order, N m, (4,).

    The accelerations are the least squares of what is asked of them; the torques follow from the
    equations of motion.
    """
    size = len(moment.u)
    base = slice(0, size - len(machine.strength))
    pushed = moment.pushed(push.place, push.along, push.up)
    share = _BODY / np.array([machine.mass, machine.mass, moment.inertia])
    ways, speed, drift = moment.foot_motion()
    astray = np.array([0.0, max(moment.sole[2], 0.0), moment.pitch])
    planted = -law.foot_stiffness * astray - law.foot_damping * speed - drift
    feet = _FEET * np.array([1.0, 1.0, _LEVER])
    arms = law.arm_stiffness * (law.arms - moment.q[machine.shoulder])
    arms -= law.arm_damping * moment.u[machine.shoulder]
    ends = _ends(machine, moment)
    rows = np.zeros((7 + len(ends) + size, size))
    wanted = np.zeros(len(rows))
    rows[:3] = moment.mass_matrix[base] * share[:, None]
    wanted[:3] = (pushed - moment.bias)[base] * share
    rows[3:6], wanted[3:6] = ways * feet[:, None], planted * feet
    rows[6, machine.shoulder], wanted[6] = _ARMS, _ARMS * arms
    for row, (joint, weight, acceleration) in enumerate(ends, 7):
        rows[row, joint], wanted[row] = weight, weight * acceleration
    rows[7 + len(ends) :] = _LEAST * np.eye(size)
    accelerations = np.linalg.solve(rows.T @ rows, rows.T @ wanted)
    acting = moment.mass_matrix @ accelerations + moment.bias - pushed
    return np.clip(acting[base.stop :], -machine.strength, machine.strength)


def _ends(machine: Machine, moment: Moment) -> list[tuple[int, float, float]]:
    """Joints near the ends of their ranges: which, with what weight, and their acceleration."""
    found: list[tuple[int, float, float]] = []
    for joint, (low, high) in machine.limited:
        q, u = float(moment.q[joint]), float(moment.u[joint])
        for end, side in ((low, -1.0), (high, 1.0)):
            left = side * (end - q) - _SHORT
            soon = left - _SOON * side * u
            if soon < _NEAR:
                weight = _ENDS * within((_NEAR - soon) / (2 * _NEAR), 0.0, 1.0)
                found.append((joint, weight, side * _STIFFNESS * left - _DAMPING * u))
    return found
