"""A spin's linear system as a labelled dataset."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr

    from somersault.stability._linear import LinearSpin


def linear_dataset(system: LinearSpin) -> xr.Dataset:
    """Matrices (equation, coordinate), roots (root), modes' shapes (mode, coordinate)."""
    import xarray as xr

    square = ("equation", "coordinate")
    matrices = {
        "M": (system.M, "mass matrix"),
        "G": (system.G, "gyric matrix over the spin rate"),
        "D": (system.D, "damping matrix over the spin rate"),
        "K": (system.K, "stiffness of the spin over its rate squared"),
        "K_springs": (system.K_springs, "stiffness of the springs over the spin rate squared"),
    }
    data: dict[str, Any] = {
        name: (square, matrix, {"units": "kg m2", "long_name": long})
        for name, (matrix, long) in matrices.items()
    }
    data |= {
        "root_real": ("root", system.roots.real, {"units": "spin rate"}),
        "root_imaginary": ("root", system.roots.imag, {"units": "spin rate"}),
        "mode_real": (("mode", "coordinate"), [mode.shape.real for mode in system.modes], {}),
        "mode_imaginary": (("mode", "coordinate"), [mode.shape.imag for mode in system.modes], {}),
        "mode_energy": ("mode", [mode.energy for mode in system.modes], {}),
    }
    names = list(system.coordinates)
    return xr.Dataset(
        data,
        coords={
            "equation": names,
            "coordinate": names,
            "mode": [mode.name for mode in system.modes],
        },
        attrs={
            "model": system.spin.model.name,
            "axis": system.spin.axis,
            "stable": int(system.stable),
            "growth_per_somersault": system.growth_per_somersault,
            "energy_signature": system.energy_signature,
        },
    )
