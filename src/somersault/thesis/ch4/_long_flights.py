"""Section 4.3.3: two flights of two thousand seconds."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault.flight import Flight, fly
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import MODEL
from somersault.thesis.ch4._layout_takeoff import SPIN, TURN, Begun, lifetime, sprung, takeoff

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_RUNS = ((1.2, 1.4), (1.0, 1.6))  # {K_sh, Γ} of the two runs of 2000 s
_SHORT = ((0.5, 1.3, 2.3), (1.8, 1.3, 2.7))  # {K_sh, Γ} and lifetimes of another implementation
_SECONDS = 2000.0


@cache
def long_run(stiffness: float, angle: float, begun: Begun) -> Flight:
    """2000 s from a tilt of 0.01, or until a quarter twist."""
    start = takeoff(sprung(angle, stiffness), begun=begun)
    return fly(MODEL, start, _SECONDS, accuracy=1e-12, samples=20_001, until="quarter twist")


def sec_4_3_3() -> Result:
    """The two runs of 2000 seconds."""
    claims, rows = [], []
    for stiffness, angle in _RUNS:
        for begun in ("rates", "momentum"):
            flown = long_run(stiffness, angle, begun)
            name = f"sec4-3-3.{stiffness:g}-{angle:g}-{begun}"
            claims += _long_claims(name, f"{{{stiffness:g}, {angle:g}}}", flown, begun)
            rows.append(_row(stiffness, angle, begun, flown))
    for stiffness, angle, lasts in _SHORT:
        exact = lifetime(angle, stiffness, "rates")
        other = lifetime(angle, stiffness, "momentum")
        claims.append(
            number(
                f"sec4-3-3.lifetime-{stiffness:g}",
                "§4.3.3, Figure 4-12",
                f"{{K_sh, Γ}} = {{{stiffness:g}, {angle:g}}} from a tilt of 0.01: turns of the "
                "nominal spin until a quarter twist",
                lasts,
                exact,
                "somersaults",
                0.05,
                "The reference is another implementation's, not the thesis's. With the momentum "
                "along the inertial 2 axis instead of only the somersault's rate at the start "
                f"{other:.2f}.",
            )
        )
    return Result(
        "Two simulations from a tilt of 0.01 rad and no twist, {K_sh, Γ} = {1.2, 1.4} and "
        "{1.0, 1.6}, were stopped after 2000 simulated seconds and over 2750 stable somersaults; "
        "the maneuver may remain stable indefinitely as long as energy is conserved.",
        f"Both last, with either reading of the start, at {SPIN} rad/s (the spin is not printed; "
        "2750 turns in 2000 s are 8.64 rad/s). The quarter twist is looked for at every step of "
        "the integration. Pictures: {1.2, 1.4} over the last two of its somersaults.",
        tuple(claims),
        _draw_4_3_3(),
        Table(
            ("K_sh", "Γ rad", "start", "somersaults", "largest tilt °", "largest twist °",
             "energy drift", "momentum drift"), tuple(rows),
        ),
    )  # fmt: skip


def _row(stiffness: float, angle: float, begun: str, flown: Flight) -> tuple[str, ...]:
    history = flown.dataset
    return (
        f"{stiffness:g}", f"{angle:g}", begun, f"{flown.landing.somersault / (2 * np.pi):.2f}",
        f"{np.degrees(float(np.abs(history['tilt']).max())):.2f}",
        f"{np.degrees(float(np.abs(history['twist']).max())):.2f}",
        f"{flown.energy_drift or 0:.0e}", f"{flown.momentum_drift:.0e}",
    )  # fmt: skip


def _long_claims(name: str, which: str, flown: Flight, begun: Begun) -> list[Claim]:
    where = "§4.3.3"
    turns = flown.landing.somersault / (2 * np.pi)
    twist = float(np.abs(flown.dataset["twist"]).max())
    said = {
        "rates": "only the somersault's rate at the start",
        "momentum": "momentum along the inertial 2 axis",
    }[begun]
    drift = flown.energy_drift
    assert drift is not None
    return [
        statement(
            f"{name}-somersaults", where, f"{which}: over 2750 stable somersaults in 2000 s",
            "over 2750", f"{turns:.2f} in {flown.times[-1]:.0f} s, twist within "
            f"{np.degrees(twist):.2f}°; {said}",
            flown.ended == "duration" and flown.times[-1] == _SECONDS and turns > 2750,
        ),
        statement(
            f"{name}-energy", where, f"{which}: energy is conserved (to 1e-10)", "conserved",
            f"relative drift {drift:.1e}", drift < 1e-10,
        ),
        statement(
            f"{name}-momentum", where, f"{which}: angular momentum is conserved (to 1e-10)",
            "conserved",
            f"relative drift {flown.momentum_drift:.1e}", flown.momentum_drift < 1e-10,
        ),
    ]  # fmt: skip


def _draw_4_3_3() -> Figure:
    from somersault.view import contact_sheet

    flown = long_run(*_RUNS[0], "momentum")
    start = takeoff(sprung(_RUNS[0][1], _RUNS[0][0]), begun="momentum")
    times = _SECONDS - 2 * TURN + np.linspace(0, 2 * TURN, 16)
    last = fly(MODEL, start, _SECONDS, accuracy=1e-12, samples=times)
    assert abs(last.landing.somersault - flown.landing.somersault) < 1e-6
    return contact_sheet(last, times, title="After 2750 somersaults: {K_sh, Γ} = {1.2, 1.4}")
