"""Attempts of a half twist with the errors of chapter 3's somersaults."""

from __future__ import annotations

import numpy as np
import xarray as xr

from somersault._core.array import Array
from somersault.ensembles import ended_by, fraction
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch3._scatter import RUN_ON
from somersault.thesis.ch6._half_twist_runs import BACKWARDS, held_out

COUNT = 64
_ENOUGH = 0.75


def backwards(data: xr.Dataset) -> xr.DataArray:
    """Whether each attempt landed facing backwards and ran on."""
    off = np.abs(np.degrees(data["landing_twist"]) - 180) < BACKWARDS
    return ended_by(data["ended"], "ran on") & off


def attempts_of_half_twist() -> Result:
    """How many come off."""
    data = held_out(COUNT)
    good = backwards(data)
    share = fraction(good, data["ended"])
    part, low, high = (100 * float(share[name]) for name in ("fraction", "low", "high"))
    words = f"{part:.0f} % ({low:.0f} to {high:.0f}) of {COUNT}"
    twists = np.degrees(data["landing_twist"].values)
    claims = (
        statement(
            "ch6-attempts.share", "§6.4", "a simulated robot landed the half twist and went on "
            "running; of many with errors at least three quarters do", "one", words,
            bool(low > 100 * _ENOUGH),
            "Errors as in Table 3.3's attempts. Starts and errors were never used for tuning. An "
            f"attempt has come off that lands within {BACKWARDS:.0f}° of facing backwards and runs "
            f"on for {RUN_ON} steps.",
        ),
    )  # fmt: skip
    rows = (
        ("landed facing backwards and ran on", words),
        ("twist at landing where it did (°)", _spread(twists[good.values])),
        ("twist at landing where it did not (°)", _spread(twists[~good.values])),
        ("tilt at landing where it did (°)", _spread(_of(data, "landing_tilt")[good.values])),
        ("somersault at landing (°)", _spread(_of(data, "landing_somersault")[good.values])),
        ("lift-off speed (m/s)", _spread(data["lift_off_speed"].values, 2)),
    )  # fmt: skip
    return Result(
        "A simulated robot landed the half twist and went on running. How often it would, the "
        "thesis does not say.",
        f"{words} attempts with errors in start, thrust, torque, foot, a push in the hurdle, and "
        "the estimate of lift-off speed.",
        claims,
        table=Table(("", f"of {COUNT} attempts"), rows),
    )


def _of(data: xr.Dataset, name: str) -> Array:
    found: Array = np.degrees(data[name].values)
    return found


def _spread(values: Array, digits: int = 0) -> str:
    known = values[np.isfinite(values)]
    if not len(known):
        return "none"
    return f"{known.mean():.{digits}f} ± {known.std():.{digits}f}"
