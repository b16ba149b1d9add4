"""The numbers of the controller for each maneuver that ships."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from pathlib import Path

from somersault._core.checks import shown, text
from somersault._core.errors import SomersaultError
from somersault.robot._control import Control
from somersault.spec import read_toml, structured

MANEUVERS = ("somersault", "half_twist")
"""What ships: the somersault of chapter 3, and that with half a twist of §6.4."""


def maneuver(name: str) -> Control:
    """The numbers of a maneuver.

    Parameters
    ----------
    name : str
        "somersault", for the model `biped`, or "half_twist", for the model `biped_weighted`.

    Returns
    -------
    Control

    Raises
    ------
    SomersaultError
        For another name.

    Examples
    --------
    >>> from somersault.robot import maneuver
    >>> round(maneuver("half_twist").twist.angle, 4)
    3.1416
    """
    if text("maneuver", name) not in MANEUVERS:
        raise SomersaultError(f"maneuver is {' or '.join(MANEUVERS)}, and here {shown(name)}")
    return Control() if name == "somersault" else _read(name)


def usual(model: str) -> Control:
    """The numbers with which a robot runs, where it is given none.

    Parameters
    ----------
    model : str
        Its model. "biped_weighted" runs with [running] and [hips] of the maneuver "half_twist", as
        it falls with those of the lighter "biped". Every other robot has `Control()`.

    Returns
    -------
    Control

    Examples
    --------
    >>> from somersault.robot import usual
    >>> usual("biped_weighted").running.pitch_stiffness
    450.0
    """
    if text("model", model) != "biped_weighted":
        return Control()
    heavy = maneuver("half_twist")
    return Control(running=heavy.running, hips=heavy.hips)


@cache
def _read(name: str) -> Control:
    path = Path(str(files("somersault.robot") / f"{name}.toml"))
    return structured(read_toml(path), Control)
