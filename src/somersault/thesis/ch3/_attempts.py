"""Table 3.3: attempts on starts that the controller was not tuned on, and without parts of it."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault.ensembles import ended_by, ensemble, fraction
from somersault.robot import Control, Plant
from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch3._scatter import HELD_OUT, RUN_ON, attempts, held_out, scatter

if TYPE_CHECKING:
    import xarray as xr

_T33 = "§3.4, Table 3.3"
_TEN = 10
_TILT = 15.0  # degrees at landing with which balance can be regained

# Rows of Table 3.3: somersault rate (deg/s), lift-off speed estimated and measured, and speed
# forwards at lift-off (m/s).
PRINTED = np.array([
    [547, 3.08, 3.04, 1.04], [529, 3.48, 3.33, 0.77], [524, 3.41, 3.32, 0.89],
    [549, 3.53, 3.48, 1.10], [553, 3.69, 3.70, 1.02], [551, 3.45, 3.47, 1.04],
    [545, 3.54, 3.48, 0.96], [541, 3.15, 3.13, 0.90], [529, 3.28, 3.04, 0.89],
    [503, 3.33, 3.20, 0.88],
])  # fmt: skip


def table_3_3() -> Result:
    """Ten of the attempts, and what all of them come to."""
    data = held_out().dataset
    share = _share(data)
    good = _good(data)
    rates = np.degrees(data["servo_rate"].values[good])
    speeds, tilts = data["lift_off_speed"].values[good], _degrees(data, "landing_tilt")
    landed = np.isfinite(tilts)
    errors = _degrees(data, "landing_inclination") - _degrees(data, "landing_wanted")
    attitudes = _degrees(data, "landing_somersault")
    printed = PRINTED.mean(0)
    estimate = 100 * (PRINTED[:, 1] / PRINTED[:, 2] - 1)
    claims = (
        statement(
            "table3-3.success", _T33, "the robot regained balanced running on seven of ten",
            "7 of 10", f"{_words(share)} of {len(good)} attempts, by {RUN_ON} steps more",
            float(share["low"]) > 0.7,
            "Starts and errors were never used for tuning. Only the error of the estimated "
            "lift-off speed is the thesis's; the others are assumed.",
        ),
        number(
            "table3-3.rate", _T33, "mean somersault rate of the attempts", float(printed[0]),
            float(rates.mean()), "deg/s", 40.0, "As the tuck servo begins; deviation "
            f"{rates.std(ddof=1):.0f}, printed {PRINTED[:, 0].std(ddof=1):.0f} deg/s.",
        ),
        number(
            "table3-3.lift-off", _T33, "mean lift-off speed", float(printed[2]),
            float(speeds.mean()), "m/s", 0.2, f"Deviation {speeds.std(ddof=1):.2f}, printed "
            f"{PRINTED[:, 2].std(ddof=1):.2f} m/s.",
        ),
        number(
            "table3-3.forward", _T33, "mean speed forwards at lift-off", float(printed[3]),
            float(data["lift_off_forward"].values[good].mean()), "m/s", 0.2,
        ),
        statement(
            "table3-3.estimate", _T33, "lift-off speeds are estimated within a few per cent",
            f"{estimate.mean():+.1f} ± {estimate.std(ddof=1):.1f} %", _estimates(data),
            bool(abs(_estimate_errors(data).mean() - estimate.mean()) < 1),
            "It is what was put in. The printed column of errors has the opposite sign.",
        ),
        statement(
            "table3-3.tilt", "§3.4", "the tilt angle on landing must be kept moderately small, "
            f"and is: |Θ| < {_TILT:.0f}°", f"< {_TILT:.0f}°",
            f"in {100 * np.mean(np.abs(tilts[landed]) < _TILT):.1f} % of {landed.sum()} landings, "
            f"at most {np.abs(tilts[good]).max():.1f}° where it ran on",
            bool(np.mean(np.abs(tilts[landed]) < _TILT) > 0.95),
            "Nothing controls tilt in flight.",
        ),
        statement(
            "table3-3.inclination", "§3.3.2", "the legs' inclination is much closer to what is "
            "wanted than the body's attitude", "much closer",
            f"deviations {np.nanstd(errors):.1f}° of the legs, {np.nanstd(attitudes):.1f}° of the "
            "body", bool(np.nanstd(errors) < np.nanstd(attitudes) / 3),
        ),
    )  # fmt: skip
    return Result(
        "Ten attempts of the 3D Biped; seven were successful.",
        f"{_words(share)} of {len(good)} attempts with errors in start, thrust, torque, foot and "
        f"estimate ran on for {RUN_ON} steps. The first ten:",
        claims,
        table=_table(data),
    )


def _table(data: xr.Dataset) -> Table:
    words = data["ended"].attrs["flag_meanings"].split()
    rows = []
    for k in range(_TEN):
        one = data.isel(sample=k)
        estimate, speed = (float(one[f"lift_off_{x}"]) for x in ("estimate", "speed"))
        steps = int(one["steps_after"])
        outcome = {"ran_on": "success", "some_steps": f"{steps} steps"}
        rows.append((
            str(k + 1), outcome.get(words[int(one["ended"])], "fall"),
            f"{np.degrees(float(one['landing_inclination'])):.1f}",
            f"{np.degrees(float(one['landing_somersault'])):.0f}",
            f"{np.degrees(float(one['servo_rate'])):.0f}", f"{estimate:.2f}", f"{speed:.2f}",
            f"{100 * (estimate / speed - 1):.1f}", f"{float(one['lift_off_forward']):.2f}",
        ))  # fmt: skip
    header = (
        "attempt", "outcome", "β_td (°)", "Φ_td (°)", "rate (°/s)", "ż_0 estimated (m/s)",
        "ż_0 (m/s)", "error (%)", "speed (m/s)",
    )  # fmt: skip
    return Table(header, tuple(rows))


def _estimate_errors(data: xr.Dataset) -> Array:
    found: Array = 100 * (data["lift_off_estimate"] / data["lift_off_speed"] - 1).values
    return found[np.isfinite(found)]


def _estimates(data: xr.Dataset) -> str:
    errors = _estimate_errors(data)
    return f"{errors.mean():+.1f} ± {errors.std(ddof=1):.1f} %"


def _degrees(data: xr.Dataset, name: str) -> Array:
    found: Array = np.degrees(data[name].values)
    return found


def _good(data: xr.Dataset) -> Array:
    found: Array = ended_by(data["ended"], "ran on").values
    return found


def _share(data: xr.Dataset) -> xr.Dataset:
    return fraction(ended_by(data["ended"], "ran on"), data["ended"])


def _words(share: xr.Dataset) -> str:
    part, low, high = (100 * float(share[name]) for name in ("fraction", "low", "high"))
    return f"{part:.1f} % ({low:.1f} to {high:.1f})"


# --------------------------------------------------------------------------------- ablations

COUNT = 80
"""Attempts with each part left out."""

PLANAR = Plant(roll_inertia=1e3, yaw_inertia=1e3)
"""A torso that neither rolls nor turns aside: the robot held to its plane."""

# As scripts/biped.py finds them best on the seeds for tuning.
ABLATIONS: dict[str, dict[str, float]] = {
    "all of it": {},
    "no tuck servo": {"servo": 0.0, "held_length": 0.70, "torque": 95.0},
    "no landing window": {"window": -1.0, "feet_back": 0.2, "torque": 95.0},
    "neither": {"servo": 0.0, "held_length": 0.80, "window": -1.0, "feet_back": 0.2},
    "narrow stance": {"width": 0.12},
}


@cache
def ablated(name: str, planar: bool = False) -> xr.Dataset:
    """Attempts without a part of the controller, the same errors for all of them."""
    if name == "all of it" and not planar:
        return held_out().dataset.isel(sample=slice(COUNT))
    control = Control(plant=PLANAR) if planar else Control()
    runs = attempts(None, control, **ABLATIONS[name])
    vary = scatter(planar=planar)
    return ensemble(runs, vary=vary, size=COUNT, seed=HELD_OUT).dataset


def ablations() -> Result:
    """What each part contributes."""
    shares: dict[str, Any] = {name: _share(ablated(name)) for name in ABLATIONS}
    planar = _share(ablated("no tuck servo", planar=True))
    part = {name: float(share["fraction"]) for name, share in shares.items()}
    wide, narrow = (
        float(np.nanstd(_degrees(ablated(name), "landing_tilt")))
        for name in ("all of it", "narrow stance")
    )
    claims = (
        statement(
            "ch3-parts.servo", "§7.1", "whether active control of rotation rate is necessary is "
            "not known", "open", f"without it {_words(shares['no tuck servo'])}, with it "
            f"{_words(shares['all of it'])}", part["no tuck servo"] < part["all of it"],
            "The legs are held at the length that did best on the seeds for tuning.",
        ),
        statement(
            "ch3-parts.window", "§3.3.2", "foot placement prior to landing was necessary to "
            "compensate for errors in landing time", "necessary",
            f"without it {_words(shares['no landing window'])}",
            part["no landing window"] < part["all of it"] - 0.1,
            "Not here: a servo that goes by momentum and knows of the sweep lands so near to 350° "
            "that either of the two is nearly enough. Neither is not.",
        ),
        statement(
            "ch3-parts.neither", "§3.3", "an open loop pattern depends on how precisely the state "
            "can be reproduced", "depends", f"with neither {_words(shares['neither'])}",
            part["neither"] < min(part["no tuck servo"], part["all of it"]),
        ),
        statement(
            "ch3-parts.planar", "§1.1.1", "a planar biped with open loop initiation and foot "
            "placement somersaulted on 90 % of the trials", "90 %",
            f"held to its plane, without tuck servo {_words(planar)}",
            float(planar["low"]) <= 0.9 <= float(planar["high"]) or float(planar["low"]) > 0.9,
            "Our robot with our errors, not theirs.",
        ),
        statement(
            "ch3-parts.stance", "§3.3.3", "a wide stance helps to keep tilt small", "helps",
            f"deviation of tilt at landing {wide:.1f}° with the feet 0.24 m apart, {narrow:.1f}° "
            "with 0.12 m", wide < narrow,
        ),
    )  # fmt: skip
    rows = (
        *((name, _words(share)) for name, share in shares.items()),
        ("no tuck servo, held to its plane", _words(planar)),
    )
    return Result(
        "The strategy combines feed-forward and feedback control with passive stability; whether "
        "all of it is necessary is left open.",
        f"{COUNT} attempts each, with the same errors. Tuned on other seeds.",
        claims,
        table=Table(("without", "came off (%)"), rows),
    )
