"""The modes of a spin, with names a person can read."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

import numpy as np

from somersault._core.array import Array
from somersault.model import Model, common_name, mirror_pairs
from somersault.stability._growth import (
    Energy,
    balanced,
    condition,
    conservative,
    rounding,
    slow_rates,
)
from somersault.stability._gyric import GyricSystem

_SMALL = 1e-6  # imaginary parts below it, in units of Ω, are those of real roots
_STILL = 1e-5  # of a shape: joints that move less do not move
_SIGNED = 1e-6  # of a mode's kinetic energy: what less there is of the whole has no sign
_TAKES_PART = 0.2  # of the largest share of kinetic energy


@dataclass(frozen=True, eq=False)
class Mode:
    """One way in which a spin deviates: x(t) = Re(shape · exp(root Ω t)).

    Attributes
    ----------
    name : str
        What moves, and how: "antisymmetric arm–body oscillation", "stroboscopic", ….
    root : complex
        In units of the spin rate Ω: growth rate and frequency.
    shape : numpy.ndarray, shape (coordinates,)
        Complex amplitudes of the coordinates, the largest of them 1.
    energy : int
        The sign of its energy at fixed angular momentum. A mode of negative energy (−1) grows
        when damping takes energy away. It is 0 where the sign means nothing: real roots, growing
        oscillations that no damper feeds, and the two modes that change the angular momentum.
    """

    name: str
    root: complex
    shape: Array
    energy: int


def modes(model: Model, system: GyricSystem) -> tuple[Mode, ...]:
    """One mode for each root with Im ≥ 0, slowest first; drifts of the spin angle as one.

    Subsystem by subsystem, so that rounding cannot mix what does not act on each other.
    """
    every = [mode for group in system.groups for mode in _of_part(model, system, group)]
    every.sort(key=lambda mode: (round(mode.root.imag, 9), round(mode.root.real, 9)))
    return tuple(every)


def _of_part(model: Model, system: GyricSystem, keep: list[int]) -> list[Mode]:
    part = system.part(keep)
    scaled = part.scaled()
    m, d, k, n = scaled.mass, scaled.damping, scaled.stiffness, len(keep)
    inverse = np.linalg.inv(m)
    still, unit = np.zeros((n, n)), np.eye(n)
    matrix, scale = balanced(still, unit, -inverse @ k, -inverse @ scaled.rate)
    values, vectors = np.linalg.eig(matrix)
    x, rates = vectors[:n], vectors[n:] * scale[:, None]
    unsure = np.abs(values.real) <= rounding(matrix, inverse) * condition(vectors)
    shapes = x[np.argsort(scaled.order)] / part.sizes[:, None]
    slow = slow_rates(x, rates, Energy(k, m, d)) if conservative(scaled) else np.zeros(2 * n)
    real = np.where(unsure, slow, values.real)
    of_part: list[Mode] = []
    about = part.attitude.about
    # Turning a little faster or slower is a double zero, which rounding splits into a tiny pair:
    # the two nearest zero.
    skip = set() if about is None else set(np.argsort(np.abs(values))[:2].tolist())
    if about is not None:
        of_part.append(Mode(f"{part.names[about]} drift", 0j, np.eye(n, dtype=complex)[about], 0))
    for i in range(2 * n):
        if i in skip or values[i].imag < -_SMALL * 1e-3:
            continue
        root = complex(real[i], values[i].imag)
        shape = shapes[:, i] / shapes[np.argmax(np.abs(shapes[:, i])), i]
        if _stroboscopic(part, shape, root):
            of_part.append(Mode("stroboscopic", root, shape, 0))
            continue
        name, energy = _name(model, part, shape, root), _energy(part, shape, root)
        of_part.append(Mode(name, root, shape, energy))
    whole = np.zeros(len(system.names), complex)
    return [replace(mode, shape=_embedded(mode.shape, keep, whole)) for mode in of_part]


def _embedded(shape: Array, keep: list[int], whole: Array) -> Array:
    result = whole.copy()
    result[keep] = shape
    return result


def _stroboscopic(system: GyricSystem, shape: Array, root: complex) -> bool:
    """A spin as steady as before, about an axis that points elsewhere: it changes the momentum."""
    return abs(root - 1j) < _STILL and bool(np.all(np.abs(shape[system.joints]) < _STILL))


def _energy(system: GyricSystem, shape: Array, root: complex) -> int:
    """Sign of ẋᵀMẋ + xᵀKx, averaged over an oscillation (Krein's signature)."""
    if root.imag < _SMALL:
        return 0
    kinetic = (shape.conj() @ system.mass @ shape).real * abs(root) ** 2
    whole = kinetic + (shape.conj() @ system.stiffness @ shape).real
    return 0 if abs(whole) < _SIGNED * kinetic else int(np.sign(whole))


def _name(model: Model, system: GyricSystem, shape: Array, root: complex) -> str:
    shares = np.abs(shape) * np.abs(system.mass @ shape)
    taking = [i for i in range(len(shape)) if shares[i] >= _TAKES_PART * shares.max()]
    limbs = [_limb(model, system.names[i]) for i in taking if i in system.joints]
    ways = [system.names[i] for i in taking if i not in system.joints]
    who = "–".join([*dict.fromkeys(limbs), "body"]) if limbs else "–".join(ways)
    return f"{who} {_motion(root)}"


def _motion(root: complex) -> str:
    way = int(np.sign(root.real))
    if abs(root.imag) < _SMALL:
        return {1: "divergence", -1: "convergence", 0: "drift"}[way]
    return {1: "growing oscillation", -1: "decaying oscillation", 0: "oscillation"}[way]


def _limb(model: Model, coordinate: str) -> str:
    """The body (or mirrored pair of bodies) that a joint coordinate moves, and how."""
    how, plain = "", coordinate
    paired = re.match(r"(antisymmetric|symmetric) (.*)", coordinate)
    if paired:
        how, plain = f"{paired.group(1)} ", paired.group(2)
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
