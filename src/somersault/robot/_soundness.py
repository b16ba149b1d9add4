"""Model files that are no robot, each refused in a sentence."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from somersault._core.errors import SomersaultError
from somersault.robot._leg import Leg
from somersault.robot.tuck_servo import GRAVITY


def base_of(file: str, m: Any) -> str:
    """The name of the body with the free joint."""
    import mujoco

    free = [k for k in range(m.njnt) if m.jnt_type[k] == mujoco.mjtJoint.mjJNT_FREE]
    if free != [0]:
        raise SomersaultError(
            f"{file} is no robot that runs: it needs one body with a free joint, first of all; "
            "write <freejoint/> in its torso, and see the model biped"
        )
    return str(m.body(int(m.jnt_bodyid[0])).name)


def motor_of(m: Any, joint: str) -> int:
    """The actuator on a joint; −1 if there is none."""
    acting = _acting_on(m, joint)
    return acting[0] if acting else -1


def check_leg(file: str, m: Any, side: str, leg: Leg) -> None:
    """SomersaultError for a leg without its parts, or with such as the controller cannot use."""
    import mujoco

    kinds = {
        "joint": (mujoco.mjtObj.mjOBJ_JOINT, "joint"),
        "geom": (mujoco.mjtObj.mjOBJ_GEOM, "foot, a geom"),
        "actuator": (mujoco.mjtObj.mjOBJ_ACTUATOR, "spring or stop, an actuator"),
    }
    for kind, name in leg.parts:
        if not _is_there(m, kinds[kind][0], name):
            raise SomersaultError(
                f"{file}: its {side} leg has no {kinds[kind][1]} called {name!r}; add it to the "
                "file, or say what it is called there"
            )
    if m.geom_type[m.geom(leg.foot).id] != mujoco.mjtGeom.mjGEOM_SPHERE:
        raise SomersaultError(f"{file}: the foot {leg.foot} must be a sphere")
    _check_joints(file, m, leg)
    for name in leg.hip:
        _check_motor(file, m, name)
    _check_piston(file, m, leg)


def check_alike(file: str, m: Any, left: Leg, right: Leg) -> None:
    """SomersaultError unless both legs have the same spring and stop, as the controller has it."""
    for one, other in ((left.spring, right.spring), (left.stop, right.stop)):
        a, b = m.actuator(one), m.actuator(other)
        same = np.allclose(a.gainprm, b.gainprm) and np.allclose(a.biasprm, b.biasprm)
        if not same:
            raise SomersaultError(
                f"{file}: {one} and {other} must be alike; give them the same kp and kv"
            )


def check_world(file: str, m: Any, feet: Sequence[str]) -> None:
    """SomersaultError for a world in which the controller's numbers are wrong."""
    import mujoco

    flags = mujoco.mjtDisableBit
    weightless = m.opt.disableflags & flags.mjDSBL_GRAVITY
    if weightless or not np.allclose(m.opt.gravity, (0, 0, -GRAVITY), atol=1e-6):
        raise SomersaultError(
            f"{file}: gravity must be 0 0 {-GRAVITY:g}, for which the controller is made; leave it "
            "out of <option>"
        )
    floors = [
        k for k in range(m.ngeom)
        if m.geom_bodyid[k] == 0 and m.geom_type[k] == mujoco.mjtGeom.mjGEOM_PLANE
    ]  # fmt: skip
    for foot in feet:
        own = m.geom(foot).id
        under = [k for k in floors if _touch(m, own, k)]
        if not under or m.opt.disableflags & flags.mjDSBL_CONTACT:
            raise SomersaultError(
                f"{file}: the foot {foot} touches no floor; add a plane to the world whose contype "
                "and conaffinity go with the foot's"
            )
        for k in under:
            level = np.allclose(m.geom_quat[k][1:3], 0, atol=1e-9)
            if not (level and abs(m.geom_pos[k][2]) < 1e-9):
                raise SomersaultError(
                    f"{file}: its floor must be level and at a height of 0; correct pos and "
                    "orientation of the plane"
                )


def _is_there(m: Any, kind: Any, name: str) -> bool:
    """Whether a model has something of a kind called so."""
    import mujoco

    try:
        return bool(mujoco.mj_name2id(m, kind, name) >= 0)
    except TypeError:  # a name that is no text in UTF-8
        return False


def _acting_on(m: Any, joint: str) -> list[int]:
    import mujoco

    which, kind = m.joint(joint).id, mujoco.mjtTrn.mjTRN_JOINT
    return [
        k for k in range(m.nu)
        if m.actuator_trntype[k] == kind and m.actuator_trnid[k][0] == which
    ]  # fmt: skip


def _touch(m: Any, one: int, other: int) -> bool:
    types, ways = m.geom_contype, m.geom_conaffinity
    return bool(types[one] & ways[other]) or bool(types[other] & ways[one])


def _check_joints(file: str, m: Any, leg: Leg) -> None:
    """Hips from the torso outwards, then the slide, then the foot, each in its direction."""
    chain = [*leg.hip, leg.slide]
    for name, axis in zip(chain, ([0, 1, 0], [1, 0, 0], [0, 0, 1], [0, 0, -1]), strict=True):
        if not np.allclose(m.joint(name).axis, axis, atol=1e-9):
            raise SomersaultError(
                f"{file}: joint {name} must be along {axis}; a leg's hinges turn about axes 2, 1 "
                "and 3, and its slide points down"
            )
    bodies = [int(m.joint(name).bodyid[0]) for name in chain]
    links = [*zip(chain, bodies, strict=True), (leg.foot, int(m.geom(leg.foot).bodyid[0]))]
    for (inner, inside), (outer, outside) in pairwise(links):
        if inside not in _inwards(m, outside):
            raise SomersaultError(
                f"{file}: {outer} does not hang on {inner}; name the parts of one leg, from the "
                "torso outwards"
            )


def _inwards(m: Any, body: int) -> list[int]:
    """A body and those that it hangs on."""
    found = [body]
    while body:
        body = int(m.body_parentid[body])
        found.append(body)
    return found


def _check_motor(file: str, m: Any, joint: str) -> None:
    import mujoco

    acting = _acting_on(m, joint)
    if not acting or not m.actuator_ctrllimited[acting[0]]:
        raise SomersaultError(
            f"{file}: joint {joint} needs a motor with a ctrlrange, which says how strong it is"
        )
    if len(acting) > 1:
        raise SomersaultError(f"{file}: joint {joint} has {len(acting)} motors; leave it one")
    k, which = acting[0], m.joint(joint).id
    plain = (
        m.actuator_gear[k][0] == 1
        and m.actuator_gaintype[k] == mujoco.mjtGain.mjGAIN_FIXED
        and m.actuator_gainprm[k][0] == 1
        and m.actuator_biastype[k] == mujoco.mjtBias.mjBIAS_NONE
        and m.actuator_dyntype[k] == mujoco.mjtDyn.mjDYN_NONE
    )
    low, high = m.actuator_ctrlrange[k]
    if not plain:
        raise SomersaultError(
            f"{file}: the motor of {joint} must be a plain <motor> without gear; say in its "
            "ctrlrange how strong it is, in N m"
        )
    if not (high > 0 and np.isclose(low, -high)):
        raise SomersaultError(
            f"{file}: the motor of {joint} must be as strong either way, and has a ctrlrange of "
            f"{low:g} to {high:g}; give {-abs(high):g} to {abs(high):g}, say"
        )
    if (m.actuator_forcelimited[k] and _narrower(m.actuator_forcerange[k], high)) or (
        m.jnt_actfrclimited[which] and _narrower(m.jnt_actfrcrange[which], high)
    ):
        raise SomersaultError(
            f"{file}: a force range makes the motor of {joint} weaker than its ctrlrange says; "
            "leave it out, and say in ctrlrange how strong it is"
        )


def _narrower(limits: Any, strength: float) -> bool:
    return bool(limits[0] > -strength or limits[1] < strength)


def _check_piston(file: str, m: Any, leg: Leg) -> None:
    """Spring and stop act on the leg's slide; one only pushes, and the other only pulls."""
    slide = _acting_on(m, leg.slide)
    for name, what in ((leg.spring, "spring"), (leg.stop, "stop")):
        k = m.actuator(name).id
        gain, (_, position, rate) = m.actuator_gainprm[k][0], m.actuator_biasprm[k][:3]
        if not (gain > 0 and np.isclose(position, -gain) and rate <= 0):
            raise SomersaultError(
                f"{file}: {name} is no {what}; make it a position actuator with kp above zero"
            )
        if k not in slide or m.actuator_gear[k][0] != 1:
            raise SomersaultError(
                f"{file}: {name} must act on joint {leg.slide}, without gear; correct its joint, "
                "or say which actuator the leg has"
            )
        low, high = m.actuator_forcerange[k]
        if not m.actuator_forcelimited[k] or (low, high)[what == "stop"] != 0 or low == high:
            does, limits = {
                "spring": ("pushes and cannot pull", "0 20000"),
                "stop": ("pulls and cannot push", "-20000 0"),
            }[what]
            raise SomersaultError(
                f"{file}: {name} is to be a leg's {what}, which {does}; give it a forcerange like "
                f"{limits}"
            )
    if len(slide) > 2:
        raise SomersaultError(
            f"{file}: joint {leg.slide} has {len(slide)} actuators; leave it its spring and stop"
        )
