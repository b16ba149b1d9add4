"""The dynamics against pinocchio's: the articulated-body and composite algorithms, by others.

pinocchio works in body axes with spatial vectors, which MuJoCo does not: it fails for other
mistakes. It knows neither springs nor dampers, so theirs are added to the torques by hand.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from trees import TREES, Case, State, assert_close, case, shipped_case

from somersault.model import GROUND, Joint, Model, shipped

pin = pytest.importorskip("pinocchio")

BATCH = 10


def to_pinocchio(model: Model) -> Any:
    """The same tree as a `pinocchio.Model`, without springs and dampers.

    Each joint is one of theirs, its frame parallel to its body's with the origin at its
    anchor; all of a body's mass is on its last joint. Bodies are added branch by branch, the
    order that its composite-body algorithm takes for granted.
    """
    made = pin.Model()
    ends = {GROUND: (0, np.zeros(3))}  # of each body: last joint, where that joint is
    for index in _branch_by_branch(model):
        body = model.bodies[index]
        parent, at = ends[body.parent]
        place = pin.SE3(np.array(body.rotation), np.array(body.position) - at)
        anchor = np.zeros(3)
        if model.free and body.parent == GROUND:
            parent = made.addJoint(parent, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "free")
        for joint in body.joints:
            place = place * pin.SE3(np.eye(3), np.array(joint.anchor) - anchor)
            parent = made.addJoint(parent, _pinocchio_joint(joint), place, joint.name)
            place, anchor = pin.SE3.Identity(), np.array(joint.anchor)
        inertia = pin.Inertia(body.mass, np.array(body.com), np.array(body.inertia))
        made.appendBodyToJoint(parent, inertia, pin.SE3(np.eye(3), -anchor))
        ends[index] = (parent, anchor)
    rotors = np.zeros(made.nv)
    for joint in model.joints:
        theirs = made.joints[made.getJointId(joint.name)]
        rotors[theirs.idx_v : theirs.idx_v + joint.speeds] = joint.armature
    made.armature = rotors
    assert made.nv == 6 * model.free + len(model.speeds)
    return made


def _branch_by_branch(model: Model, parent: int = GROUND) -> list[int]:
    order = []
    for index, body in enumerate(model.bodies):
        if body.parent == parent:
            order += [index, *_branch_by_branch(model, index)]
    return order


def _pinocchio_joint(joint: Joint) -> Any:
    if joint.kind == "ball":
        return pin.JointModelSpherical()
    kind = {"hinge": pin.JointModelRevoluteUnaligned, "slide": pin.JointModelPrismaticUnaligned}
    return kind[joint.kind](np.array(joint.axis))


class InPinocchio:
    """A pinocchio model's quantities at a state of ours, in our variables.

    Its free joint's velocity is (linear, angular) in body axes, ours (angular, linear). Its
    accelerations are spatial: that of the origin is smaller than the classical by ω × v.
    """

    def __init__(self, model: Model, state: State) -> None:
        self.model, self.state, self.m = model, state, to_pinocchio(model)
        self.d = self.m.createData()
        self.q = pin.neutral(self.m)
        order = np.zeros(len(state.v), int)  # of their speeds, in ours
        if model.free:
            self.q[:3] = 0.3, -0.2, 0.1
            self.q[3:7] = np.roll(state.attitude, -1)
            order[:6] = [3, 4, 5, 0, 1, 2]
        for joint in model.joints:
            theirs = self.m.joints[self.m.getJointId(joint.name)]
            own = state.q[model.coordinate_slice(joint.name)]
            value = np.roll(own, -1) if joint.kind == "ball" else own - joint.reference
            self.q[theirs.idx_q : theirs.idx_q + theirs.nq] = value
            speeds = model.speed_slice(joint.name)
            ahead = 6 * model.free
            order[ahead + speeds.start : ahead + speeds.stop] = theirs.idx_v + np.arange(theirs.nv)
        self.order = order
        self.v = np.zeros(len(order))
        self.v[order] = state.v
        self.m.gravity.linear = state.turn @ state.gravity

    @property
    def _convective(self) -> np.ndarray:
        """Classical less spatial acceleration, in our order."""
        extra = np.zeros(len(self.order))
        if self.model.free:
            extra[3:6] = np.cross(self.state.v[:3], self.state.v[3:6])
        return extra

    @property
    def _passive(self) -> np.ndarray:
        """Springs and dampers, in our order, from their definition."""
        loads = np.zeros(len(self.order))
        for joint in self.model.joints:
            speeds = self.model.speed_slice(joint.name)
            at = slice(speeds.start + 6 * self.model.free, speeds.stop + 6 * self.model.free)
            own = self.state.q[self.model.coordinate_slice(joint.name)]
            if joint.kind == "ball":
                stretch = pin.log3(pin.Quaternion(np.roll(own, -1)).toRotationMatrix())
            else:
                stretch = own - joint.rest
            loads[at] = -joint.stiffness * stretch - joint.damping * self.state.v[at]
        return loads

    @property
    def forward_dynamics(self) -> np.ndarray:
        loads = self._passive
        loads[len(loads) - len(self.state.torques) :] += self.state.torques
        theirs = np.zeros(len(loads))
        theirs[self.order] = loads
        return pin.aba(self.m, self.d, self.q, self.v, theirs)[self.order] + self._convective

    def inverse_dynamics(self, a: np.ndarray) -> np.ndarray:
        theirs = np.zeros(len(a))
        theirs[self.order] = a - self._convective
        return pin.rnea(self.m, self.d, self.q, self.v, theirs)[self.order] - self._passive

    @property
    def mass_matrix(self) -> np.ndarray:
        upper = np.triu(pin.crba(self.m, self.d, self.q))
        full = upper + np.triu(upper, 1).T
        return full[np.ix_(self.order, self.order)]

    @property
    def momentum(self) -> np.ndarray:
        h = pin.computeCentroidalMomentum(self.m, self.d, self.q, self.v)
        angular = h.angular.copy()
        if not self.model.free:
            angular += np.cross(pin.centerOfMass(self.m, self.d, self.q), h.linear)
        back = self.state.turn.T
        return np.concatenate([back @ angular, back @ h.linear])

    @property
    def kinetic_energy(self) -> float:
        """With the rotors' share, which pinocchio counts for some joints only."""
        rotors = 0.5 * np.sum(self.m.armature * self.v**2)
        bare = self.m.copy()
        bare.armature = np.zeros(bare.nv)
        return float(pin.computeKineticEnergy(bare, bare.createData(), self.q, self.v) + rotors)


def compare(own: Case) -> None:
    theirs = InPinocchio(own.model, own.state)
    assert_close(own.ours["forward_dynamics"], theirs.forward_dynamics, 1e-10)
    assert_close(own.ours["mass_matrix"], theirs.mass_matrix, 1e-12)
    assert_close(own.ours["momentum"], theirs.momentum, 1e-12)
    assert_close(own.ours["kinetic_energy"], [theirs.kinetic_energy], 1e-12)
    inverse = theirs.inverse_dynamics(own.accelerations)
    assert_close(own.ours["inverse_dynamics"], inverse, 1e-12)


@pytest.mark.parametrize("first", range(0, TREES, BATCH))
def test_random_trees(first: int) -> None:
    for number in range(first, first + BATCH):
        compare(case(number))


@pytest.mark.parametrize("gravity", [False, True], ids=["free", "falling"])
@pytest.mark.parametrize("name", shipped())
def test_shipped_models(name: str, gravity: bool) -> None:
    compare(shipped_case(name, gravity))
