"""`fly`: one free flight, from takeoff to landing."""

from __future__ import annotations

from collections.abc import Sequence

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.flight._flight import Flight
from somersault.flight._maneuver import Event, Maneuver
from somersault.flight._takeoff import Takeoff
from somersault.model import Model, load


def fly(
    model: str | Model | Maneuver,
    takeoff: Takeoff | None = None,
    duration: float | None = None,
    *,
    gravity: Sequence[float] | None = None,
    accuracy: float | None = None,
    samples: int | Sequence[float] | Array | None = None,
    until: Event | None = None,
    steps: int | None = None,
) -> Flight:
    """The free flight of a model from a takeoff.

    Parameters
    ----------
    model : str, Model or Maneuver
        The name of a shipped model, a file, a model, or a whole maneuver, which needs no takeoff.
    takeoff : Takeoff, optional
        How it begins; by default upright and at rest.
    duration : float
        s; 1 unless it is given.
    gravity, accuracy, samples, until, steps
        As in `Maneuver`; where one is not given it is the maneuver's, or what `Maneuver` has by
        default.

    Returns
    -------
    Flight
        Where it broke off, or joints went far beyond their limits, with a SomersaultWarning that
        says so.

    Raises
    ------
    SomersaultError
        For anything that does not fit.

    Examples
    --------
    >>> import somersault as so
    >>> arms = {"shoulder": so.JointTakeoff.sprung(angle=1.4, K=1.2, hold=True)}
    >>> takeoff = so.Takeoff(tilt=0.01, spin=8.64, joints=arms)
    >>> flight = so.fly("furrer", takeoff, duration=5.8)
    >>> abs(flight.landing.twist) < 0.1
    True
    """
    given = {
        "duration": duration, "gravity": gravity, "accuracy": accuracy, "samples": samples,
        "until": until, "steps": steps,
    }  # fmt: skip
    options = {name: value for name, value in given.items() if value is not None}
    if isinstance(model, Maneuver):
        if takeoff is not None:
            raise SomersaultError("a maneuver has a takeoff of its own; leave the other out")
        return model.fly(**options)
    maneuver = Maneuver(load(model), Takeoff() if takeoff is None else takeoff)
    return maneuver.fly(**options)
