"""What each joint of a model does in a flight, everything filled in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.dynamics import body_kind
from somersault.flight._takeoff import Takeoff
from somersault.flight._watch import quantities
from somersault.flight.behaviours import (
    AngleLaw,
    ByLaw,
    JointPlan,
    JointTakeoff,
    RateLaw,
    Sprung,
    TorqueLaw,
    check_coupled,
)
from somersault.model import Joint, Model, sides
from somersault.simulation import Name

# Of classes derived from these a command of nothing may still do something.
_COMMANDED = (AngleLaw, RateLaw, TorqueLaw)


def plans(model: Model, takeoff: Takeoff) -> tuple[JointPlan, ...]:
    """One plan for each joint, in the model's order; SomersaultError for what does not fit.

    A left–right pair may be named once, by its common name; the right side is mirrored.
    """
    given = by_joint(model, takeoff.joints)
    settled = tuple(_settled(joint, given.get(joint.name)) for joint in model.joints)
    check_coupled(model, settled)
    if any(isinstance(p.does, Sprung) and (p.does.K, p.does.B) != (None, None) for p in settled):
        _check_spin(takeoff)
    return settled


def without_idle_laws(
    model: Model, settled: tuple[JointPlan, ...], varied: tuple[Name, ...]
) -> tuple[JointPlan, ...]:
    """The same without laws that command nothing, of flights that differ in some numbers.

    A law's ticks end steps of the integration: without them a flight is that of the joint without
    the law, bit for bit.
    """
    there, differing = frozenset([*quantities(model), "time"]), frozenset(varied)
    return tuple(
        replace(plan, does=plan.does.plainest(plan.joint, there, differing))
        if isinstance(plan.does, ByLaw) and type(plan.does) in _COMMANDED
        else plan
        for plan in settled
    )


def by_joint(model: Model, joints: Mapping[str, JointTakeoff]) -> dict[str, JointTakeoff]:
    """Takeoffs by the joints' own names, pairs spelled out; SomersaultError as of `plans`."""
    given: dict[str, JointTakeoff] = {}
    for name, takeoff in joints.items():
        both = sides(model, name)
        first = next(iter(both))
        for joint, (factor, offset) in both.items():
            model.joint(joint)
            if joint in given:
                raise SomersaultError(f"joint {joint} is given twice, alone and with its pair")
            image = joint != first
            given[joint] = takeoff.mirrored(model, first, factor, offset) if image else takeoff
    return given


def numbers(takeoff: Takeoff, settled: tuple[JointPlan, ...]) -> dict[Name, float | Array]:
    """All the numbers of one takeoff, by name."""
    result: dict[Name, float | Array] = {}
    if takeoff.quaternion is None:
        result |= {("takeoff", n): getattr(takeoff, n) for n in ("somersault", "tilt", "twist")}
    for what in ("angular_velocity", "angular_momentum"):
        row = getattr(takeoff, what)
        if row is not None:
            result |= {(what, k + 1): x for k, x in enumerate(row)}
    if takeoff.angular_velocity is None and takeoff.angular_momentum is None:
        result["takeoff", "spin"] = 0.0 if takeoff.spin is None else takeoff.spin
        result |= {("takeoff", n): getattr(takeoff, n) for n in ("tilt_rate", "twist_rate")}
    laws = [takeoff.replay, *(plan.does.sensing for plan in settled)]
    if any(law is not None and law.noisy for law in laws):
        result["takeoff", "noise"] = takeoff.noise
    for plan in settled:
        result |= plan.does.numbers(plan.joint)
    return result


def sound(
    settled: tuple[JointPlan, ...], values: Mapping[Name, float | Array], count: int
) -> Array:
    """Whether each of the flights is one that could be asked for by itself, (count,)."""
    good = np.ones(count, bool)
    for plan in settled:
        good &= plan.does.sound(plan.joint, values, count)
    if isinstance(values.get(("takeoff", "spin")), np.ndarray):
        good &= np.asarray(values["takeoff", "spin"]) != 0
    for key, x in values.items():
        if body_kind(str(key[0])) == "mass":
            good &= np.asarray(x) > 0
    return good


def _settled(joint: Joint, given: JointTakeoff | None) -> JointPlan:
    try:
        return JointPlan(joint, (given or JointTakeoff()).settled(joint))
    except SomersaultError as mistake:
        named = joint.name in str(mistake)
        raise mistake if named else SomersaultError(f"joint {joint.name}: {mistake}") from None


def _check_spin(takeoff: Takeoff) -> None:
    """SomersaultError for a takeoff without a spin of which K and B could be."""
    given = (takeoff.spin, takeoff.angular_velocity, takeoff.angular_momentum)
    if not any(np.any(spun) for spun in given if spun is not None):
        raise SomersaultError(
            "K and B are of a nominal spin, and this takeoff has none; give stiffness and damping"
        )
