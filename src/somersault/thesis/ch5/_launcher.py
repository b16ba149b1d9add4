"""The launcher of section 5.2.2: the doll swung round a bar by a torsion spring, and let go.

The thesis describes it and gives a photograph, but no dimensions. Those marked "ours" below are
assumptions that a workshop would find plausible; docs/doll.md says what depends on them. SI units
and radians; the bar is along inertial axis 2, and the angle round it is the doll's somersault Φ:
at 0 the doll hangs upright, feet down, from the rod on its head.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.dynamics import Equations
from somersault.flight import (
    GRAVITY,
    BallisticPath,
    JointTakeoff,
    Prop,
    Release,
    Swing,
    Takeoff,
    height_energy,
    released,
    swing,
)
from somersault.model import GROUND, Body, Joint, Model, Mount, load, mounted
from somersault.thesis.ch5._doll import BEST, HEIGHT, WEIGHTED, shoulder_inertia

SPIN = 16.6  # rad/s, "the average somersault rate" (§5.5)
CEILING = 4.3  # m (§5.5)
SOMERSAULTS = 3.5  # from release to landing (§5.5)
ARMS = 1.6  # rad, the nominal arm angle Γ of the experiments (§5.4)

HEAD = 0.133  # m from the body's centre of mass to the top of the head (ours: the model's drawing)
REACH = 0.22  # m from the bar to the top of the head: clamp and rod (ours)
CLAMP_MASS, CLAMP_AT = 0.35, 0.08  # kg, m from the bar (ours)
CLAMP_INERTIA = 5e-4  # kg m² about its centre of mass (ours)
BAR_HEIGHT = 2.35  # m above the floor (ours)
CATCH = 1.1  # m, the catcher's hands (ours)
RELEASE = 1.45  # rad: "approximately π/2"; a little before it the doll comes down clear of the bar
WOUND = 2 * np.pi  # rad that the doll is wound back from hanging (ours: one turn)
SPRING = 0.15  # N m/rad of the launcher's spring (ours)
ROD = 1.4e4  # N m/rad about the shoulder: a steel rod of 1/16 in, 0.1 m from it (ours)
ROD_LEVER = 0.1  # m from the shoulder to where the rod props the arm (ours)
ROD_DAMPING = 30.0  # s/rad of `Prop` (ours)
_CLAMP, _BAR = "clamp", "bar"
G = -GRAVITY[2]
_LONGEST_SWING = 5.0  # s


@dataclass(frozen=True)
class Launch:
    """One launch: the clamp's `reach` from the bar to the doll's head (m), the doll's K_sh."""

    reach: float = REACH
    stiffness: float = BEST

    @property
    def pretension(self) -> float:
        """What the left shoulder's spring gives at the nominal arm angle, N m: it balances the
        centrifugal torque of the spin about the doll's own centre of mass."""
        return _held() * SPIN**2

    @cached_property
    def doll(self) -> Model:
        """The weighted doll with this spring at its shoulders, pretensioned."""
        model = load(WEIGHTED)
        k = self.stiffness * SPIN**2 * shoulder_inertia(WEIGHTED)
        body, *arms = model.bodies
        sprung = []
        for arm in arms:
            joint = arm.joints[0]
            rest = _side(joint.name) * (ARMS + self.pretension / k)
            sprung.append(replace(arm, joints=(replace(joint, stiffness=k, rest=rest),)))
        return replace(model, bodies=(body, *sprung))

    @cached_property
    def mount(self) -> Mount:
        """The doll in the clamp, the launcher's spring tensioned so that it reaches the spin.

        The tension follows from the energy of the doll with its arms still, from hanging,
        wound back, to the release.
        """
        held = _mount(self, RELEASE).held
        begin, end = self._start(), {**self._start(), _BAR: RELEASE}
        first, last = ([at[joint.name] for joint in held.joints] for at in (begin, end))
        equations = Equations(held)
        needed = float(equations.kinetic_energy(last, [SPIN, *[0.0] * (len(last) - 1)]))
        needed += float(height_energy(equations, last) - height_energy(equations, first))
        turned = RELEASE + WOUND
        beyond = (needed / (0.5 * SPRING) - turned**2) / (2 * turned)
        return _mount(self, RELEASE + beyond)

    def _start(self) -> dict[str, float]:
        return {_BAR: -WOUND, "left_shoulder": ARMS, "right_shoulder": -ARMS}

    @cached_property
    def swing(self) -> Swing:
        """From rest until the clamp opens, the arms propped by rods."""
        held, start = self.mount.held, self._start()
        q = [start[joint.name] for joint in held.joints]
        still = np.zeros(len(q))
        # The rods already bear the arms' pretension and weight when the clamp is let go.
        loads = Equations(held).inverse_dynamics(q, still, still, GRAVITY)
        rods = {
            joint.name: Prop(start[joint.name] + load / ROD, _side(joint.name), ROD, ROD_DAMPING)
            for joint, load in zip(held.joints, loads.tolist(), strict=True)
            if joint.name != _BAR
        }
        return swing(held, start, _LONGEST_SWING, until=(_BAR, RELEASE), stops=rods)

    @cached_property
    def release(self) -> Release:
        """The doll's takeoff, and where it stands then."""
        return released(self.swing, self.mount)

    @property
    def rod_torque(self) -> Array:
        """What a rod gives about the left shoulder during the swing, (T,), N m."""
        return self.swing.stop_torques[:, 1]

    @property
    def spring_torques(self) -> tuple[float, float]:
        """What the launcher's spring gives, wound and at the release, N m."""
        given = self.swing.spring_torques[:, 0]
        return float(given[0]), float(given[-1])

    # ------------------------------------------------------------------------ the flight

    @property
    def spin(self) -> Array:
        """Angular velocity at the release, in the doll's axes, (3,), rad/s."""
        return self.swing.u[-1, 0] * np.array([0.0, 1.0, 0.0])

    @property
    def out(self) -> float:
        """From the bar to the doll's centre of mass, m."""
        return float(np.linalg.norm(self.release.centre - [0.0, 0.0, BAR_HEIGHT]))

    @cached_property
    def path(self) -> BallisticPath:
        """Where the centre of mass goes after the release."""
        return BallisticPath(self.release.centre, self.release.takeoff.velocity, GRAVITY)

    def time(self, catch: float = CATCH) -> float:
        """From release until the centre of mass comes down to a height, s."""
        return self.path.time_to(catch)

    def somersaults(self, catch: float = CATCH) -> float:
        """Of the spin at release until then: a stable doll's somersault rate stays about it."""
        return float(self.spin[1]) * self.time(catch) / (2 * np.pi)


@cache
def launch() -> Launch:
    """The nominal launcher."""
    return Launch()


def takeoff(joints: Mapping[str, JointTakeoff]) -> Takeoff:
    """How the nominal launcher lets go, as angles and rates to which scatter can be added.

    The swing is in one plane, so tilt, twist and their rates are zero.
    """
    return Takeoff(somersault=RELEASE, spin=float(launch().spin[1]), joints=joints)


def radius() -> float:
    """From the doll's centre of mass to its feet, its farthest point, m."""
    return HEIGHT - HEAD + _centre()


@cache
def _centre() -> float:
    """Height of the doll's centre of mass over its body's, arms at the nominal angle, m."""
    body, arm, _ = load(WEIGHTED).bodies
    pin = arm.joints[0].anchor
    up = arm.position[2] + pin[2] + (arm.com[2] - pin[2]) * np.cos(ARMS)
    return float(2 * arm.mass * up / (body.mass + 2 * arm.mass))


@cache
def _held() -> float:
    return st.spin(WEIGHTED, 2, {"shoulder": ARMS}).holding_torques["left_shoulder"]


def _side(joint: str) -> int:
    return 1 if joint.startswith("left") else -1


def _mount(throw: Launch, rest: float) -> Mount:
    i = CLAMP_INERTIA
    clamp = Body(
        _CLAMP, GROUND, CLAMP_MASS, (0.0, 0.0, -CLAMP_AT),
        ((i, 0.0, 0.0), (0.0, i, 0.0), (0.0, 0.0, i)), position=(0.0, 0.0, BAR_HEIGHT),
        joints=(Joint(_BAR, "hinge", (0.0, 1.0, 0.0), stiffness=SPRING, rest=rest),),
    )  # fmt: skip
    return mounted(throw.doll, clamp, (0.0, 0.0, -throw.reach - HEAD))
