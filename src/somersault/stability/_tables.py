"""A spin's linear system as a labelled dataset."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from somersault._core.array import Array
from somersault.stability._modes import Mode

if TYPE_CHECKING:
    import xarray as xr

_LONG_NAMES = {
    "M": "mass matrix",
    "G": "gyric matrix over the spin rate",
    "D": "damping matrix over the spin rate",
    "K": "stiffness of the spin over its rate squared",
    "K_springs": "stiffness of the springs over the spin rate squared",
}


def linear_dataset(
    names: Sequence[str],
    matrices: Mapping[str, Array],
    roots: Array,
    modes: Sequence[Mode],
    attributes: Mapping[str, Any],
) -> xr.Dataset:
    """Matrices (equation, coordinate), roots (root), modes' shapes (mode, coordinate)."""
    import xarray as xr

    square = ("equation", "coordinate")
    data: dict[str, Any] = {
        name: (square, matrix, {"units": "kg m2", "long_name": _LONG_NAMES[name]})
        for name, matrix in matrices.items()
    }
    data |= {
        "root_real": ("root", roots.real, {"units": "spin rate"}),
        "root_imaginary": ("root", roots.imag, {"units": "spin rate"}),
        "mode_real": (("mode", "coordinate"), [mode.shape.real for mode in modes], {}),
        "mode_imaginary": (("mode", "coordinate"), [mode.shape.imag for mode in modes], {}),
        "mode_energy": ("mode", [mode.energy for mode in modes], {}),
    }
    return xr.Dataset(
        data,
        coords={
            "equation": list(names),
            "coordinate": list(names),
            "mode": [mode.name for mode in modes],
        },
        attrs=dict(attributes),
    )
