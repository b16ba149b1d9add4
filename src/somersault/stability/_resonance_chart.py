"""Resonances over two quantities: modes' frequencies and energies, and sums that vanish."""

from __future__ import annotations

from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault.stability._grid import Grid, Values
from somersault.stability._growth import mode_energies, reduced
from somersault.stability._gyric import GyricSystem
from somersault.stability._reflection import odd_places
from somersault.stability._resonances import Combination, combinations


def resonance_fields(
    cases: Grid, varied: Values, dims: tuple[str, str], stable: Array, order: int
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Variables and coordinates of a chart's dataset; NaN where a spin is not stable.

    Only the resonances are kept that some of the stable spins are on.
    """
    parts = cases.parts(varied)
    names = [name for part in parts for name in part.names]
    ends = np.cumsum([len(part.names) for part in parts])
    groups = [range(end - len(p.names), end) for p, end in zip(parts, ends, strict=True)]
    odd_names = odd_places(cases.parities(varied, names), groups)
    frequencies, signs, odd, labels = [], [], [], []
    for part, group in zip(parts, groups, strict=True):
        omega, sign = (np.broadcast_to(a, (*stable.shape, a.shape[-1])) for a in _modes(part))
        for k in range(omega.shape[-1]):
            frequencies.append(np.where(stable, omega[..., k], np.nan))
            signs.append(np.where(stable, sign[..., k], 0).astype("int8"))
            odd.append(bool(odd_names[group[0]]))
            labels.append(f"{part.names[0]} {k + 1}")
    omega, sign = (np.array(a).reshape(len(labels), *stable.shape) for a in (frequencies, signs))
    found = [c for c in combinations(odd, order) if _crosses(c.detuning(omega))]
    off = np.array([c.detuning(omega) for c in found]).reshape(-1, *stable.shape)
    burst = np.array([c.explosive(sign) for c in found], bool).reshape(-1, *stable.shape)
    in_spin = {"units": "spin rate"}
    data = {
        "frequency": (("mode", *dims), omega, {**in_spin, "long_name": "frequency of a mode"}),
        "mode_energy": (("mode", *dims), sign, {"long_name": "sign of a mode's energy"}),
        "detuning": (("resonance", *dims), off, {**in_spin, "long_name": "distance from it"}),
        "explosive": (("resonance", *dims), burst, {"long_name": "all its modes can grow"}),
    }
    coords = {
        "mode": labels,
        "resonance": [_label(c, labels) for c in found],
        "order": ("resonance", [c.order for c in found], {"long_name": "order of its terms"}),
    }
    return data, coords


def _modes(part: GyricSystem) -> tuple[Array, Array]:
    """Frequencies, ascending, and signs of the energies of a part's oscillations, (…, k)."""
    scaled = part.undamped().scaled()
    whole = reduced(scaled)
    values, vectors = np.linalg.eig(whole.matrix)
    count = scaled.potential.shape[-1]
    q = vectors[..., count:, :] * whole.rate_scale[..., :, None]
    energies = mode_energies(vectors[..., :count, :], q, scaled.potential, whole.kinetic)
    half = values.shape[-1] // 2
    order = np.argsort(values.imag, -1)[..., values.shape[-1] - half :]
    omega, energy = (np.take_along_axis(a, order, -1) for a in (values.imag, energies))
    return omega, np.sign(energy)


def _crosses(off: Array) -> bool:
    """Whether a quantity (y, x) vanishes between neighbours, or at one of them."""
    with np.errstate(invalid="ignore"):
        along = [off[1:] * off[:-1] <= 0, off[:, 1:] * off[:, :-1] <= 0]
    return bool(any(a.any() for a in along) or (off == 0).any())


def _label(combination: Combination, labels: list[str]) -> str:
    """ "2 × tilt 1 = somersault 1", the side with the first mode on the left."""
    first = next(n for n in combination.counts if n)
    sides = (
        " + ".join(
            f"{abs(n)} × {name}" if abs(n) > 1 else name
            for name, n in zip(labels, combination.counts, strict=True)
            if n * first * way > 0
        )
        for way in (1, -1)
    )
    return " = ".join(sides)
