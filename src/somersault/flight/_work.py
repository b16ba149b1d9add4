"""Power and work of what acts at the joints: muscles, springs, dampers, motors."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault._core.checks import instance
from somersault.flight._flight import Flight

if TYPE_CHECKING:
    import xarray as xr


def joint_power(flight: Flight) -> xr.DataArray:
    """Power of each joint along a flight: its torque times its rate.

    Parameters
    ----------
    flight : Flight

    Returns
    -------
    xarray.DataArray, dims (time, joint_speed)
        W. Positive where the joint drives the motion, negative where it brakes it.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.flight import joint_power
    >>> flight = so.inertia_change().fly()  # a tuck: the muscles pull the legs in
    >>> bool(joint_power(flight).sum("joint_speed").max() > 0)
    True
    """
    instance("flight", flight, Flight)
    power = flight.joint_torques * flight.dataset["joint_rate"].values
    return power.rename("joint_power").assign_attrs(units="W")


def joint_work(flight: Flight) -> xr.DataArray:
    """Work that each joint has done since the first sample of a flight.

    The integral of `joint_power` by Simpson's rule over the samples, so its accuracy is theirs: it
    goes with the third power or better of their spacing where torques are smooth. In a free flight
    the work of all joints together is the gain of kinetic energy.

    Parameters
    ----------
    flight : Flight
        With two samples at least.

    Returns
    -------
    xarray.DataArray, dims (time, joint_speed)
        J, zero at the first sample.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.flight import joint_work
    >>> flight = so.inertia_change().fly(samples=2001)
    >>> work = joint_work(flight).sum("joint_speed")[-1]
    >>> gain = flight.kinetic_energy[-1] - flight.kinetic_energy[0]
    >>> bool(abs(work - gain) < 1e-5 * gain)
    True
    """
    from scipy.integrate import cumulative_simpson

    power = joint_power(flight)
    work = cumulative_simpson(power.values, x=flight.times, axis=0, initial=0.0)
    return power.copy(data=np.asarray(work)).rename("joint_work").assign_attrs(units="J")
