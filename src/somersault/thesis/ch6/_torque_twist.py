"""Section 6.2: what tilts a twisting somersault, and what ends its twist."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.flight import (
    Flight,
    Maneuver,
    arm_tilt,
    inertia_change,
    principal_attitude,
    rigid_continuation,
    torque_twist,
    twist_time,
)
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table
from somersault.thesis._motion import Motion
from somersault.thesis.ch1._techniques import SHARP, rotation_number, tilted, until

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SIX_2 = "§6.2"
_TILTS = (0.1, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0)  # degrees


@cache
def stopped_torque_twist() -> tuple[Maneuver, float, float]:
    """A torque twist with arms out, ended by leaning the arms: (maneuver, time, amplitude).

    Solved for the moment (s) and the amplitude (rad: the left arm goes up by it, the right one
    down) after which the momentum lies along a principal axis.
    """
    from scipy.optimize import fsolve

    still = torque_twist(pose="T", duration=2.2)

    def leaning(x: Array) -> Maneuver:
        moves = dict(still.keyframes)
        for side, sign in (("left", 1), ("right", -1)):
            angle = np.pi / 2 + sign * float(x[1])
            ends = (float(x[0]), float(x[0]) + 0.2)
            moves[f"{side}_shoulder_abduction"] = [(ends[0], np.pi / 2), (ends[1], angle)]
        return Maneuver.moves(still.model, moves, still.takeoff, still.duration)

    def wrong(x: Array) -> Array:
        maneuver = leaning(x)
        tilt, twist = principal_attitude(until(maneuver, float(x[0]) + 0.2))
        return np.array([np.sin(twist[-1]), tilt[-1]])

    # Half a twist after takeoff the left arm has to go up; see the claims of figure 1-1.
    solution = fsolve(wrong, [twist_time(still, 0.5) - 0.1, 0.6], xtol=1e-12)
    return leaning(solution), float(solution[0]), float(solution[1])


@cache
def rotation_numbers() -> tuple[tuple[float, float, float, float], ...]:
    """Tilt (°), and twists per somersault: flown, by elliptic integrals, by quadrature."""
    rows = []
    for degrees in _TILTS:
        maneuver = tilted(float(np.radians(degrees)))
        exact = rigid_continuation(maneuver.fly(accuracy=SHARP, samples=[0.0]))
        rows.append((
            degrees, rotation_number(maneuver)[0], exact.twists_per_somersault,
            exact.twists_per_somersault_quadrature(),
        ))  # fmt: skip
    return tuple(rows)


def _twist_rate(flight: Flight) -> Array:
    """Least and greatest rate at which the principal axes twist, over the flight, rad/s."""
    rate = np.gradient(np.unwrap(principal_attitude(flight)[1]), flight.times)
    return np.array([rate.min(), rate.max()])


def _with_arms(pose: str) -> Maneuver:
    """The torque twist with both arms alike going from the T to a pose, from 0.3 s on."""
    still = torque_twist(pose="T", duration=2.2)
    to = inertia_change(poses=("T", pose), begin=0.3, duration=2.2)
    return Maneuver.moves(still.model, to.keyframes, still.takeoff, still.duration)


def sec_6_2() -> Result:
    """Torque twist and torque-free twist."""
    still = torque_twist(pose="T", duration=2.2).fly(accuracy=SHARP)
    rows = {pose: _twist_rate(_with_arms(pose).fly()) for pose in ("layout", "arms_up", "wrap")}
    slowest = min(float(r[0]) for r in rows.values())
    stopped, moment, lean = stopped_torque_twist()
    ended = stopped.fly(accuracy=SHARP)
    after = np.degrees(np.ptp(np.unwrap(principal_attitude(ended)[1])[ended.times >= moment + 0.2]))
    free = principal_attitude(arm_tilt().fly())[0]
    tilts = np.degrees([principal_attitude(still)[0][0], free[np.argmax(np.abs(free))]])
    numbers = np.array(rotation_numbers())
    wrong = np.abs(numbers[:, 1:3] / numbers[:, 3:] - 1).max()
    listed = ", ".join(f"{pose} {r[0]:.1f} to {r[1]:.1f}" for pose, r in rows.items())
    claims = (
        statement(
            "sec6-2.torque", _SIX_2, "in the torque twist somersault and twist come from the "
            "ground, and twist goes on to the landing", "from takeoff on",
            f"{still.landing.twist / (2 * np.pi):.2f} twists in "
            f"{still.landing.somersault / (2 * np.pi):.2f} somersaults, never slower than "
            f"{_twist_rate(still)[0]:.2f} rad/s", bool(_twist_rate(still)[0] > 0),
        ),
        statement(
            "sec6-2.symmetric", _SIX_2, "without a tilt the twist cannot be ended: moves of both "
            "arms alike only change its rate", "not ended", f"rates of twist in rad/s while the "
            f"arms go from T to {listed}", slowest > 0,
            "The thesis says that either twist is one of tilt; this is what follows for landing.",
        ),
        statement(
            "sec6-2.ended", _SIX_2, "arms leant at the right moment end a torque twist too",
            "the tilt removed", f"one up and one down by {np.degrees(lean):.1f}° from "
            f"{moment:.3f} s on: then it twists by {after:.2f}° in all until "
            f"{stopped.duration:g} s", bool(after < 5),
        ),
        statement(
            "sec6-2.tilt", _SIX_2, "the net effect of either technique is to tilt the principal "
            "axes", "tilted", f"by {tilts[0]:.2f}° at takeoff of the torque twist, by up to "
            f"{tilts[1]:.2f}° in the torque-free one, which takes off with {free[0]:.0e}",
            bool(np.all(np.abs(tilts) > 2) and abs(free[0]) < 1e-9),
        ),
        statement(
            "sec6-2.small", _SIX_2, "even a small tilt of a layout results in twisting", "twists",
            f"{numbers[0, 1]:+.3f} a somersault with a tilt of {numbers[0, 0]:g}°",
            bool(abs(numbers[0, 1]) > 0.05),
        ),
        statement(
            "sec6-2.rate", _SIX_2, "the greater the tilt, the greater the twist rate", "greater",
            f"from {abs(numbers[0, 1]):.3f} to {abs(numbers[-1, 1]):.3f} twists a somersault for "
            f"tilts of {_TILTS[0]:g} to {_TILTS[-1]:g}°",
            bool(np.all(np.diff(np.abs(numbers[:, 1])) > 0)),
        ),
        statement(
            "sec6-2.exact", "§6.2, Figure 2-7", "it is the map of rotation that gives the rate",
            "the map", f"flown, by elliptic integrals and by quadrature twists a somersault agree "
            f"to {wrong:.0e}", bool(wrong < 1e-8),
        ),
    )  # fmt: skip
    table = Table(
        ("tilt", "flown", "elliptic integrals", "quadrature"),
        tuple((f"{r[0]:g}°", *(f"{x:.10f}" for x in r[1:])) for r in rotation_numbers()),
    )
    return Result(
        "A torque twist comes from the ground, a torque-free one from moves of the limbs; both "
        "tilt the principal axes against the momentum, and the more tilt, the more twist.",
        "Both techniques flown by the gymnast. The table gives twists per somersault of the "
        "gymnast held in layout.",
        claims,
        _draw_6_2(),
        table,
        Motion(
            {
                "torque twist": torque_twist(pose="T", duration=1.6).fly(),
                "its tilt taken out": until(stopped, 1.6),
                "torque-free": arm_tilt(duration=1.6).fly(),
            },
            0.5,
        ),
    )


def _draw_6_2() -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.2, 3.8)
    left, right = picture.subplots(1, 2)
    torque = torque_twist(pose="T", duration=2.2).fly()
    ended = stopped_torque_twist()[0].fly()
    free = arm_tilt(duration=1.6).fly()
    for flight, color, words, place, spot in (
        (torque, look.BLUE, "torque twist", (1.2, 1.62), (1.25, -7.3)),
        (ended, look.GREEN, "its tilt taken out", (1.1, 0.4), (1.25, -0.7)),
        (free, look.VERMILION, "torque-free,\nstarted and ended", (0.0, 1.2), (0.82, -3.6)),
    ):
        tilt, twist = principal_attitude(flight)
        left.plot(flight.times, np.unwrap(twist) / (2 * np.pi), color=color)
        right.plot(flight.times, np.degrees(tilt), color=color)
        look.label(left, *place, words, color)
        look.label(right, *spot, words, color)
    left.set(xlabel="time (s)", ylabel="twists of the principal axes")
    right.set(xlabel="time (s)", ylabel="tilt of the principal axes (°)")
    return picture
