"""The modes of a spin, with names a person can read."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.model._mirror import common_name

if TYPE_CHECKING:
    from somersault.stability._linear import LinearSpin

_SMALL = 1e-6
_TAKES_PART = 0.2  # of the largest share of kinetic energy


@dataclass(frozen=True, eq=False)
class Mode:
    """x(t) = Re(shape · exp(root Ω t)).

    `energy` is the sign of its energy at fixed angular momentum: a mode of negative energy
    (−1) grows when damping takes energy away. It is 0 where the sign means nothing: real
    roots, growing oscillations, and the two modes that change the angular momentum.
    """

    name: str
    root: complex
    shape: Array
    energy: int


def modes(system: LinearSpin) -> tuple[Mode, ...]:
    """One mode for each root with Im ≥ 0, slowest first; drifts of the spin angle as one.

    Subsystem by subsystem, so that rounding cannot mix what does not act on each other.
    """
    found = [mode for group in system.groups for mode in _of_part(system, group)]
    found.sort(key=lambda mode: (round(mode.root.imag, 9), round(mode.root.real, 9)))
    return tuple(found)


def _of_part(system: LinearSpin, keep: list[int]) -> list[Mode]:
    part = system.part(keep)
    m, c, k = part.M, part.G + part.D, part.K + part.K_springs
    n = len(m)
    inverse = np.linalg.inv(m)
    first_order = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ k, -inverse @ c]])
    values, vectors = np.linalg.eig(first_order)
    found: list[Mode] = []
    drift = _drift(part)
    if drift is not None:
        found.append(drift)
    # The drift is a double zero, which rounding splits into a tiny pair: the two nearest zero.
    skip = set(np.argsort(np.abs(values))[: 2 if drift is not None else 0].tolist())
    for i, root in enumerate(values):
        if i in skip or root.imag < -_SMALL * 1e-3:
            continue
        shape = vectors[:n, i]
        shape = shape / shape[np.argmax(np.abs(shape))]
        energy = _energy(m, k, shape, root)
        found.append(Mode(_name(part, shape, root), complex(root), shape, energy))
    whole = np.zeros(len(system.M), complex)
    return [replace(mode, shape=_embedded(mode.shape, keep, whole)) for mode in found]


def _embedded(shape: Array, keep: list[int], whole: Array) -> Array:
    result = whole.copy()
    result[keep] = shape
    return result


def _drift(system: LinearSpin) -> Mode | None:
    """Turning a little faster or slower: the somersault angle runs away at a steady rate."""
    if system.attitude.about is None:
        return None
    shape = np.zeros(len(system.M), complex)
    shape[system.attitude.about] = 1.0
    return Mode(f"{system.coordinates[system.attitude.about]} drift", 0j, shape, 0)


def _energy(m: Array, k: Array, shape: Array, root: complex) -> int:
    """Sign of ẋᵀMẋ + xᵀKx averaged over an undamped oscillation (Krein's signature)."""
    if abs(root.real) > _SMALL or root.imag < _SMALL or abs(root.imag - 1) < _SMALL:
        return 0
    value = (shape.conj() @ (abs(root) ** 2 * m + k) @ shape).real
    size = (shape.conj() @ m @ shape).real * abs(root) ** 2
    return 0 if abs(value) < _SMALL * size else int(np.sign(value))


def _name(system: LinearSpin, shape: Array, root: complex) -> str:
    shares = np.abs(shape) * np.abs(system.M @ shape)
    turns = system.attitude.places()
    joints = [i for i in range(len(shape)) if i not in turns]
    still = all(np.abs(shape[i]) < 1e-5 for i in joints)
    if still and abs(root - 1j) < 1e-5:
        return "stroboscopic"
    taking = [i for i in range(len(shape)) if shares[i] >= _TAKES_PART * shares.max()]
    limbs = list(dict.fromkeys(_limb(system, system.coordinates[i]) for i in taking if i in joints))
    ways = [system.coordinates[i] for i in taking if i in turns]
    who = "–".join([*limbs, "body"]) if limbs else "–".join(ways)
    return f"{who} {_motion(root)}"


def _motion(root: complex) -> str:
    if abs(root.imag) < _SMALL:
        return (
            "divergence"
            if root.real > _SMALL
            else "convergence"
            if root.real < -_SMALL
            else "drift"
        )
    if root.real > _SMALL:
        return "growing oscillation"
    return "decaying oscillation" if root.real < -_SMALL else "oscillation"


def _limb(system: LinearSpin, coordinate: str) -> str:
    """The body (or mirrored pair of bodies) that a joint coordinate moves, and how."""
    model = system.spin.model
    how, plain = "", coordinate
    found = re.match(r"(antisymmetric|symmetric) (.*)", coordinate)
    if found:
        how, plain = f"{found.group(1)} ", found.group(2)
    from somersault.model._mirror import mirror_pairs

    speeds = [i for p in mirror_pairs(model) if p.name == plain for i in (p.left, p.right)]
    speeds = speeds or [model.speeds.index(plain)]
    owners = []
    for speed in speeds:
        start = 0
        for body in model.bodies:
            start += sum(joint.speeds for joint in body.joints)
            if speed < start:
                owners.append(body.name)
                break
    return how + common_name(owners[0], owners[-1])
