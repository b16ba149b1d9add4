"""What is reported of each of many flights."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, instance, name_list, whole_number
from somersault._core.degrees import MOST_TURNS, note_degrees
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats, number
from somersault.engine import STATUS
from somersault.flight._flight import Flight
from somersault.flight._watch import ANGLES, RATES, VELOCITIES, quantities, torques
from somersault.model import Model
from somersault.simulation import LANDING_ERROR, Endings, Variable

TURNS = {"somersaults": "somersault", "twists": "twist"}
ENDINGS = Endings(
    (*STATUS.values(), "no takeoff"), ("too many steps", "not finite", "no takeoff"), "no takeoff",
    called="flights",
)  # fmt: skip
_MOST_SAMPLES = 100_000


@dataclass(frozen=True)
class Report:
    """What is reported of each flight, besides when and how it ended and after how many steps.

    Parameters
    ----------
    quantities : tuple of str
        At the end: "somersault", "tilt", "twist" (rad, unwrapped) and their rates ("tilt_rate" …),
        "angular_velocity_1" (2, 3; body axes), joint coordinates by name and their rates
        ("NAME_rate"), what acts at joints, as `Flight.joint_torques` has it ("NAME_torque");
        "somersaults" and "twists", turns since takeoff; and "landing_error", the error against the
        landing that is aimed at.
    extremes : tuple of str
        Of which of them (turns and landing error excepted) the least and the greatest on the way
        are reported.
    history : tuple of str
        Which of them are reported at `samples` evenly spaced times.
    samples : int
        How many times a history has, 2 at least.

    Examples
    --------
    >>> import somersault as so
    >>> so.Report(("tilt", "twists"), extremes=("tilt",)).quantities
    ('tilt', 'twists')
    """

    quantities: tuple[str, ...] = ANGLES
    extremes: tuple[str, ...] = ()
    history: tuple[str, ...] = ()
    samples: int = 0

    def __post_init__(self) -> None:
        for what in ("quantities", "extremes", "history"):
            object.__setattr__(self, what, name_list(f"report.{what}", getattr(self, what)))
        whole_number("report.samples", self.samples, 0, _MOST_SAMPLES)

    def times(self, duration: float) -> Array:
        """The times of a reported history.

        Parameters
        ----------
        duration : float
            Of the flights, s.

        Returns
        -------
        ndarray, (samples,)
            s; empty if no history is reported.

        Examples
        --------
        >>> import somersault as so
        >>> so.Report(history=["tilt"], samples=3).times(1.0).tolist()
        [0.0, 0.5, 1.0]
        """
        duration = number("duration", duration)
        return np.linspace(0.0, duration, self.samples) if self.history else np.empty(0)


def landing_target(flight: Flight) -> dict[str, float]:
    """The attitude and the joint coordinates that a flight lands with.

    Parameters
    ----------
    flight : Flight

    Returns
    -------
    dict
        "somersault", "tilt" and "twist" (rad, unwrapped) and every joint coordinate by name.

    Examples
    --------
    >>> import somersault as so
    >>> target = so.flight.landing_target(so.arm_tilt().fly())
    >>> round(target["left_elbow"], 6), len(target)
    (0.0, 16)
    """
    end = instance("flight", flight, Flight).landing
    return {"somersault": end.somersault, "tilt": end.tilt, "twist": end.twist, **end.joints}


def target_of(against: Flight | Mapping[str, float] | None) -> dict[str, float]:
    """Angles to land at, by name; SomersaultError for anything but a flight, angles or None."""
    if isinstance(against, Flight):
        return landing_target(against)
    target = by_name("against, unless it is a Flight,", against)
    return {name: number(f"target.{name}", angle) for name, angle in target.items()}


def landing_error(target: Mapping[str, float], landed: Mapping[str, Array | float]) -> Array:
    """How far a landing is from its target, in rad: e of Playter (1994), section 6.3.2.

    e² = ¼ (ΔΦ² + ΔΘ² + ΔΨ² + the mean of the joints' Δq²), over what the target names.

    Parameters
    ----------
    target : mapping of str to float
        Somersault, tilt, twist and joint coordinates by name, as `landing_target` gives them.
    landed : mapping of str to float or array, (N,)
        The same of one landing, or of N.

    Returns
    -------
    array, () or (N,)

    Raises
    ------
    SomersaultError
        Where the landing says nothing of what the target names.

    Examples
    --------
    >>> from somersault.flight import landing_error
    >>> float(landing_error({"tilt": 0.0, "twist": 3.0}, {"tilt": 0.0, "twist": 3.5}))
    0.25
    """
    target, landed = by_name("target", target), by_name("landed", landed)
    for name in target:
        if name not in landed:
            raise SomersaultError(f"the landing says nothing of {name}, which the target names")

    def part(name: str, weight: float) -> Array:
        off = floats(f"landed {name}", landed[name]) - floats(f"target {name}", target[name])
        return (weight * off) ** 2

    squares = [part(name, weight) for name, weight in error_weights(target).items()]
    return np.sqrt(sum(squares, np.zeros(())))


def error_weights(target: Mapping[str, float]) -> dict[str, float]:
    """The weight of each angle in a landing error, whose square is that of the weighted ones."""
    joints = len([name for name in target if name not in ANGLES])
    return {name: 0.5 if name in ANGLES else 0.5 / np.sqrt(joints) for name in target}


def check(report: Report, target: Mapping[str, float], model: Model) -> None:
    """SomersaultError for anything that cannot be reported of this model."""
    angles = [*ANGLES, *model.coordinates]
    known = [*quantities(model), *torques(model)]
    for where, names, there in (
        ("report.quantities", report.quantities, [*known, *TURNS, LANDING_ERROR]),
        ("report.extremes", report.extremes, known),
        ("report.history", report.history, known),
        ("target", target, angles),
    ):
        for name in names:
            if name not in there:
                raise SomersaultError(
                    f"{where}: {name!r} is nothing that is known of {model.name}; "
                    f"there are {', '.join(there)}"
                )
        if len(set(names)) < len(tuple(names)):
            raise SomersaultError(f"{where} names the same thing twice; leave one out")
    slides = {joint.name for joint in model.joints if joint.kind == "slide"}
    for name, angle in target.items():
        if name not in slides:
            note_degrees(f"target.{name}", angle, MOST_TURNS)
    if LANDING_ERROR in report.quantities and not target:
        raise SomersaultError(
            "report.quantities has landing_error, which needs a target; give angles to land "
            "at, or a flight to measure against"
        )
    if report.history and report.samples < 2:
        raise SomersaultError(
            f"report.samples must be a whole number from 2 to {_MOST_SAMPLES} for a history, "
            f"and is {report.samples}"
        )


def variables(report: Report, model: Model) -> dict[str, Variable]:
    """All that is reported, in order."""
    unit = units(model)
    listed = {"time": Variable("s", words="when the flight ended")}
    for name in report.quantities:
        listed[name] = Variable(unit[name])
    for name in report.extremes:
        for which in ("least", "greatest"):
            listed[f"{which}_{name}"] = Variable(unit[name])
    for name in report.history:
        listed[f"{name}_history"] = Variable(unit[name], over_time=True)
    listed["steps"] = Variable("1", "i4", words="steps of the integration")
    return listed


def units(model: Model) -> dict[str, str]:
    """The unit of all that is known of a flight, by name."""
    units = dict.fromkeys(TURNS, "1") | dict.fromkeys((*ANGLES, LANDING_ERROR), "rad")
    units |= dict.fromkeys((*RATES, *VELOCITIES), "rad/s")
    for joint in model.joints:
        unit = {"hinge": "rad", "slide": "m", "ball": "1"}[joint.kind]
        rate = "m/s" if joint.kind == "slide" else "rad/s"
        coordinates = model.coordinates[model.coordinate_slice(joint.name)]
        speeds = model.speeds[model.speed_slice(joint.name)]
        units |= dict.fromkeys(coordinates, unit)
        units |= dict.fromkeys([f"{name}_rate" for name in speeds], rate)
        torque = "N" if joint.kind == "slide" else "N m"
        units |= dict.fromkeys([f"{name}_torque" for name in speeds], torque)
    return units
