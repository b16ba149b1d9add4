"""Many flights of one model at once, for how they end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from somersault._errors import SomersaultError
from somersault.attitude import angles_from_quaternion
from somersault.dynamics._integrator import STATUS
from somersault.flight._fly import TOLERANCE_PER_ACCURACY, Event
from somersault.flight._numbers import number
from somersault.flight._start import start
from somersault.flight._system import kinds, system
from somersault.flight._takeoff import Takeoff, plans
from somersault.model import Model, load

if TYPE_CHECKING:
    import xarray as xr


def landings(
    model: str | Model,
    takeoffs: Sequence[Takeoff],
    duration: float,
    *,
    accuracy: float = 1e-9,
    until: Event | None = None,
) -> xr.Dataset:
    """How each of many flights ends, as an `xarray.Dataset` over `flight`.

    All are flown together, compiled, eight to a vector and on all cores; they must do the same
    with their joints (sprung, locked, prescribed with as many moves …), with any numbers.
    Variables: `time` (s), `quaternion`, `somersault`, `tilt` and `twist` (rad, somersault and
    twist within one turn), `angular_velocity` (body axes), `joint_angle`, `steps`, and `ended`:
    "duration", "event", "too many steps" or "not finite", flight by flight.
    """
    import xarray as xr

    model = load(model)
    if not len(takeoffs):
        raise SomersaultError("landings need at least one takeoff")
    setups = [plans(model, takeoff.joints) for takeoff in takeoffs]
    if any(kinds(setup) != kinds(setups[0]) for setup in setups):
        raise SomersaultError(
            "these takeoffs do different things with their joints; fly each sort by itself"
        )
    if number("duration", duration) <= 0:
        raise SomersaultError(f"duration {duration:g} s is no flight; give a positive number")
    chosen = system(model, kinds(setups[0]), until)
    begun = [start(chosen, t, s) for t, s in zip(takeoffs, setups, strict=True)]
    parameters = np.stack([chosen.parameter_vector(b.plans) for b in begun])
    first = np.stack([chosen.start(b.quaternion, b.omega, b.q, b.u) for b in begun])
    found = chosen.integrator.solve(
        first, parameters, np.array([float(duration)]), accuracy * TOLERANCE_PER_ACCURACY
    )
    q, _ = chosen.joint_states(found.final, found.end, parameters)
    quaternion = found.final[:, :4] / np.linalg.norm(found.final[:, :4], axis=1, keepdims=True)
    with np.errstate(invalid="ignore"):
        angles = angles_from_quaternion(quaternion)
    return xr.Dataset(
        {
            "time": ("flight", found.end, {"units": "s"}),
            "somersault": ("flight", angles[:, 0], {"units": "rad"}),
            "tilt": ("flight", angles[:, 1], {"units": "rad"}),
            "twist": ("flight", angles[:, 2], {"units": "rad"}),
            "quaternion": (("flight", "component"), quaternion, {"units": "1"}),
            "angular_velocity": (
                ("flight", "body_axis"), found.final[:, 4:7], {"units": "rad/s"},
            ),
            "joint_angle": (("flight", "joint"), q, {"units": "rad or m"}),
            "steps": ("flight", found.steps, {}),
            "ended": ("flight", [STATUS[float(code)] for code in found.status], {}),
        },
        coords={
            "component": list("wxyz"),
            "body_axis": [1, 2, 3],
            "joint": list(model.coordinates),
        },
        attrs={"model": model.name},
    )  # fmt: skip
