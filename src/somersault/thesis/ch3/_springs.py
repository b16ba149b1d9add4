"""Section 7.1: legs on soft springs in the place of the tuck servo."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.ensembles import ended_by, ensemble, fraction
from somersault.robot import Control, Errors, Flip, Robot, leg_spring, run
from somersault.robot.tuck_servo import Tuck
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch3._scatter import HELD_OUT, attempts, scatter

if TYPE_CHECKING:
    import xarray as xr

_STIFFNESSES = (60.0, 100.0, 200.0)  # N/m
_RATE, _LENGTH = 8.3, 0.80  # rad/s of the nominal somersault, and the length it lands with, m
_OFF = (-0.06, -0.03, 0.0, 0.03, 0.06)  # parts by which the flip's torque is wrong
_HELD = 0.75  # m, the best length at which legs are held
_COUNT = 80


def _tuck() -> Tuck:
    robot = Robot()
    m = robot.machine
    return Tuck(m.inertia, m.leg_inertia, m.lower_leg, m.offset, robot.shortest, robot.longest)


def spring(stiffness: float) -> dict[str, float]:
    """Numbers of [flip] for legs on springs that hang at the nominal length at the nominal rate."""
    tuck = _tuck()
    drawn = tuck.lower_leg / 2 * (_LENGTH - tuck.offset) * _RATE**2 / stiffness
    return {"leg_spring": stiffness, "leg_rest": _LENGTH - drawn}


@cache
def landings(name: str) -> Array:
    """Angles at landing for flips with too little and too much torque, degrees."""
    numbers = _ways()[name]
    found = []
    for off in _OFF:
        ran = run("biped", 5.0, Control(flip=Flip(**numbers), errors=Errors(torque=off)), flip=1.0)
        found.append(np.degrees(ran.outcome["landing_somersault"]))
    return np.array(found)


def _ways() -> dict[str, dict[str, float]]:
    ways: dict[str, dict[str, float]] = {"held": {"servo": 0.0, "held_length": _HELD}}
    ways |= {f"spring, {k:g} N/m": spring(k) for k in _STIFFNESSES}
    return ways | {"tuck servo": {}}


@cache
def _attempts(stiffness: float) -> xr.Dataset:
    runs = attempts(None, None, **spring(stiffness))
    return ensemble(runs, vary=scatter(), size=_COUNT, seed=HELD_OUT).dataset


def sec_7_1() -> Result:
    """Whether springs correct the somersault rate, and by how much against the servo."""
    tuck = _tuck()
    spreads = {name: float(np.ptp(landings(name))) for name in _ways()}
    parts = {k: float(leg_spring.corrected(tuck, k, _RATE, _LENGTH)) for k in _STIFFNESSES}
    left = {k: spreads[f"spring, {k:g} N/m"] / spreads["held"] for k in _STIFFNESSES}
    soft = _STIFFNESSES[0]
    data = _attempts(soft)
    share = fraction(ended_by(data["ended"], "ran on"), data["ended"])
    words = "{:.0f} % ({:.0f} to {:.0f})".format(
        *(100 * float(share[name]) for name in ("fraction", "low", "high"))
    )
    where = "§7.1"
    claims = (
        statement(
            "ch3-springs.corrects", where, "tuned leg springs could correct errors of the rotation "
            "rate, as legs extend at higher rates", "could", f"torque wrong by ±6 % spreads "
            f"landings over {spreads['held']:.0f}° with legs held, "
            f"{spreads[f'spring, {soft:g} N/m']:.0f}° with springs of {soft:g} N/m",
            left[soft] < 0.7,
        ),
        statement(
            "ch3-springs.softer", where, "the softer the spring, the more it corrects", "by tuning",
            ", ".join(f"{k:g} N/m: {100 * (1 - x):.0f} %" for k, x in left.items()),
            bool(np.all(np.diff(list(left.values())) > 0)),
            "In equilibrium " + ", ".join(f"{100 * p:.0f} %" for p in parts.values())
            + "; a flight is too short for the legs to get there.",
        ),
        statement(
            "ch3-springs.servo", where, "a middle ground between open loop and active control",
            "between", f"landings spread over {spreads['held']:.0f}, "
            f"{spreads[f'spring, {soft:g} N/m']:.0f} and {spreads['tuck servo']:.1f}° with legs "
            "held, on springs and with the servo",
            spreads["tuck servo"] < spreads[f"spring, {soft:g} N/m"] < spreads["held"],
        ),
        statement(
            "ch3-springs.reliable", where, "with active foot placement it may provide reliable "
            "somersaults", "may", f"{words} of {_COUNT} attempts", float(share["fraction"]) > 0.8,
        ),
    )  # fmt: skip
    rows = tuple(
        (name, *(f"{x:.0f}" for x in landings(name)), f"{spreads[name]:.1f}") for name in _ways()
    )
    return Result(
        "Tuned leg springs might influence the somersault rate passively, as legs extend at higher "
        "rates.",
        "They do: a governor that is isochronous for springs just stiffer than m_l Ω² = "
        f"{tuck.lower_leg / 2 * _RATE**2:.0f} N/m. Landing angles (°) with the flip's torque "
        "wrong:",
        claims,
        table=Table(("legs", *(f"{100 * off:+.0f} %" for off in _OFF), "spread (°)"), rows),
    )
