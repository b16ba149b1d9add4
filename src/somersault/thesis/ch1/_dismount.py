"""Takashima's dismount (section 1.1.1): a double tucked somersault from the bar, and a stand."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault.flight import ridden
from somersault.ground import LandingLaw
from somersault.history import Recording, joined
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table
from somersault.thesis._motion import Motion
from somersault.thesis.ch1._dismount_starts import (
    CASES,
    MISJUDGED,
    NOISE,
    RELEASE,
    ROUGH,
    SCATTER,
    STARTS,
    WITH,
    WITHOUT,
    Dismount,
    Outcomes,
    Start,
    dismount,
    outcomes,
    starts,
)
from somersault.thesis.ch1._high_bar import GRAVITY, MASS, let_go, on_the_bar, until
from somersault.thesis.ch1._tuck_law import REACTION

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_WHERE = "§1.1.1"
_FEW = 30  # starts for the landing without feedback
# A landing by heart: the centre of mass is braked and raised, and nothing else is looked at.
_FEED_FORWARD = LandingLaw(
    place_stiffness=0.0, place_damping=0.0, attitude_stiffness=0.0, momentum_damping=0.0
)
_SHOWN = Start(0.02, 1.03)  # the release of the film: later and faster by a standard deviation


@cache
def _nominal() -> Dismount:
    return dismount(CASES[WITH])


def _share(found: Outcomes) -> xr.Dataset:
    import xarray as xr

    from somersault.ensembles import fraction

    return fraction(xr.DataArray(found.stood, dims="sample"))


def dismounts() -> Result:
    """The dismount with and without the posture feedback, from the same releases."""
    one, seen = _nominal(), let_go(until(RELEASE))
    found = {name: outcomes(name) for name in CASES}
    share = {name: _share(each) for name, each in found.items()}
    blind = outcomes(WITH, _FEED_FORWARD, _FEW)
    sighted = found[WITH].stood[:_FEW]
    strength, asked = _strength(one)
    turned = (one.stance.angles[0, 0] - one.flight.angles[0, 0]) / (2 * np.pi)
    best = float(np.abs(found[WITH].error).max())
    claims = (
        statement(
            "sec1-1-dismount.lands", _WHERE, "the control of rotation rate about the somersault "
            "axis produces a balanced landing of a dismount from the horizontal bar",
            "a balanced landing",
            f"{-turned:.2f} somersaults from the release to the floor, in "
            f"{one.stance.times[0]:.2f} s; then it {one.stance.ended}",
            one.stance.stood and turned < -1.5,
            f"Holds if it stands still for two seconds. Let go with {-seen.momentum:.0f} kg m²/s, "
            f"{seen.release.takeoff.velocity[2]:.1f} m/s upwards.",
        ),
        statement(
            "sec1-1-dismount.accurate", _WHERE, "his algorithm could produce accurate tucked, "
            "multiple-somersault dismounts", "accurate",
            f"{_interval(share[WITH])} stand, without the feedback {_interval(share[WITHOUT])}",
            float(share[WITH]["low"]) > max(0.8, float(share[WITHOUT]["high"])),
            f"{STARTS} releases, {1000 * SCATTER[0]:.0f} ms and {100 * SCATTER[1]:.0f} % of the "
            "rate (standard deviations), the same for both. Holds if more than four fifths stand "
            "with feedback, and more than without, by 95 % confidence.",
        ),
        statement(
            "sec1-1-dismount.posture", _WHERE, "he used the feedback control of posture to control "
            "rotation rate", "controls",
            f"the somersault angle at touchdown scatters by {found[WITH].spread:.3f} rad, without "
            f"by {found[WITHOUT].spread:.2f} rad",
            found[WITH].spread < 0.2 * found[WITHOUT].spread,
            f"Acts {REACTION:g} s late. Holds if the scatter is less than a fifth. The greatest "
            f"error with feedback is {best:.2f} rad, most of it the same for all.",
        ),
        statement(
            "sec1-1-dismount.landing", _WHERE, "he used a combination of feed forward and feed "
            "back control to execute the landing", "a combination",
            f"the path of the centre of mass alone: {blind.stood.sum()} of {_FEW} stand; with "
            f"feedback {sighted.sum()} of them", bool(blind.stood.sum() < 0.5 * sighted.sum()),
            "The same flights. Holds if the feed-forward alone lands less than half as often.",
        ),
        statement(
            "sec1-1-dismount.strength", _WHERE, "joint torques that a gymnast has", "not said",
            f"in flight {_torques(asked)}, of {_torques(strength)}; in the landing the torques end "
            f"there, for {100 * _cut(one):.0f} % of the time until it rises",
            bool(np.all(asked < strength)),
            "Ours. Both sides together; holds if the flight needs no more. What the greatest are "
            f"is assumed. The floor pushes with up to {_weights(one):.0f} body weights.",
        ),
        statement(
            "sec1-1-dismount.noise", _WHERE, "with noisy senses and a misjudged release",
            "not said", f"{_interval(share[ROUGH])} stand, the angle at touchdown scatters by "
            f"{found[ROUGH].spread:.2f} rad",
            float(share[ROUGH]["fraction"]) > 0.8 * float(share[WITH]["fraction"]),
            f"Ours. Deviations of {NOISE['somersault']:g} rad and {NOISE['somersault_rate']:g} "
            f"rad/s at each tick, of {100 * MISJUDGED[0]:.0f} % of the momentum and "
            f"{1000 * MISJUDGED[1]:.0f} ms of the time to land. Holds if at most a fifth of the "
            "dismounts is lost by them. An error of the time is one of the angle: nothing in the "
            "law sees the floor come.",
        ),
    )  # fmt: skip
    return Result(
        "Takashima's gymnast dismounts from the high bar by a double tucked somersault: posture "
        "feedback in flight, feed-forward and feedback in the landing.",
        "A giant swing, a release, two somersaults, and a landing on the contact of MuJoCo. The "
        "law reckons from somersault, rate and hip angle how far to tuck, until the floor. What is "
        "known at the release: the angular momentum, the time in the air, and where the feet must "
        "come down. The landing law knows everything at once, no reaction time is in it.",
        claims,
        _draw(found, share),
        table=_table(found, share),
        motion=Motion({"posture feedback": _film(WITH), "by heart": _film(WITHOUT)}, 0.5,
                      {"camera": (80.0, 4.0), "vectors": ()}),
    )  # fmt: skip


def _film(name: str) -> Recording:
    """Swing, flight and landing, of a release later and faster than the nominal."""
    swung = until(RELEASE + _SHOWN.later, _SHOWN.faster)
    one = dismount(CASES[name], _SHOWN)
    go = float(swung.times[-1])
    return joined([ridden(swung, on_the_bar()), one.flight, one.stance], [0.0, go, go])


def _strength(one: Dismount) -> tuple[np.ndarray, np.ndarray]:
    """The greatest torques that there are, and that the flight until touchdown needs, N m."""
    flown = one.flight.times < one.stance.times[0]
    asked = np.abs(one.flight.joint_torques.values[flown]).max(0)
    s = one.stance.gymnast.strength
    return np.array([s.shoulder, s.hip, s.knee, s.ankle]), asked


def _cut(one: Dismount) -> float:
    """For which share of the fall of the centre of mass some torque ended at the strength."""
    down = slice(0, int(np.argmin(one.stance.centre_of_mass[:, 2])))
    strength, _ = _strength(one)
    full = np.abs(one.stance.joint_torques[down]) >= strength
    return float(full.any(1).mean())


def _weights(one: Dismount) -> float:
    return float(one.stance.ground_force[:, 1].max() / (MASS * GRAVITY))


def _torques(values: np.ndarray) -> str:
    names = ("shoulder", "hip", "knee", "ankle")
    return ", ".join(f"{name} {x:.0f}" for name, x in zip(names, values, strict=True)) + " N m"


def _interval(share: xr.Dataset) -> str:
    low, middle, high = (100 * float(share[name]) for name in ("low", "fraction", "high"))
    return f"{middle:.0f} % ({low:.0f} to {high:.0f} %)"


def _table(found: dict[str, Outcomes], share: dict[str, xr.Dataset]) -> Table:
    header = (
        "in flight", "stood (%)", "95 % confidence", "angle at touchdown: mean error (rad)",
        "standard deviation (rad)",
    )  # fmt: skip
    rows = tuple(
        (
            name, f"{100 * float(share[name]['fraction']):.0f}",
            f"{100 * float(share[name]['low']):.0f} to {100 * float(share[name]['high']):.0f}",
            f"{each.error.mean():.3f}", f"{each.spread:.3f}",
        )
        for name, each in found.items()
    )  # fmt: skip
    return Table(header, rows)


def _draw(found: dict[str, Outcomes], share: dict[str, xr.Dataset]) -> Figure:
    from somersault.view import strip
    from somersault.view import style as look

    picture = look.figure(10.0, 5.6)
    parts: Any = picture.subfigures(2, 1, height_ratios=(1, 1.7))
    top, bottom = parts
    row, film, go = top.subplots(), _film(WITH), RELEASE + _SHOWN.later
    touch = float(go + dismount(CASES[WITH], _SHOWN).stance.times[0])
    moments = [0.7, go, 1.6, 1.8, 2.0, 2.2, 2.4, touch, touch + 0.2, touch + 2.0]
    strip(row, film, moments, view=(90.0, 3.0), words=False)
    row.set_title("Swing, release, double tucked somersault, touchdown, stand (posture feedback)")
    size = row.get_ylim()[1] / 1.1
    for place, time in enumerate(moments):
        look.label(row, 1.7 * size * place, -1.15 * size, f"{time:.2f} s", look.GREY,
                   ha="center", fontsize=8)  # fmt: skip
    left, middle, right = bottom.subplots(1, 3)
    late = np.array([1000 * start.later for start in starts()])
    colors = {WITHOUT: look.VERMILION, WITH: look.BLUE, ROUGH: look.ORANGE}
    for name in (WITHOUT, WITH):
        one = found[name]
        for stood, marker in ((True, "o"), (False, "x")):
            chosen = one.stood == stood
            left.plot(late[chosen], one.error[chosen], marker, color=colors[name], ms=4)
        look.label(left, 0.03, 0.09 if name == WITHOUT else 0.17, name, colors[name],
                   transform=left.transAxes)  # fmt: skip
    left.set(xlabel="release, ms later than nominal", ylabel="error of the angle at touchdown, rad")
    left.set_title("● stood  × fell")
    for place, (name, each) in enumerate(share.items()):
        low, rate, high = (100 * float(each[key]) for key in ("low", "fraction", "high"))
        middle.bar(place, rate, 0.6, color=colors[name])
        middle.plot([place, place], [low, high], color=look.BLACK, lw=1.2)
    middle.set_xticks(range(len(share)), [name.replace(" ", "\n") for name in share])
    middle.set(ylabel="stood, %", ylim=(0, 102))
    middle.set_title(f"{STARTS} releases, 95 % confidence")
    stance = _nominal().stance
    force = stance.ground_force[:, 1] / (MASS * GRAVITY)
    time = stance.times - stance.times[0]
    right.plot(time, force, color=look.BLUE)
    look.label(right, 0.05, 13, "floor's push, body weights", look.BLUE, fontsize=8)
    strength, _ = _strength(_nominal())
    knee = np.abs(stance.joint_torques[:, 2]) / strength[2]
    right.plot(time, 10 * knee, color=look.GREEN)
    look.label(right, 0.16, 7.5, "knee torque, tenths of its most", look.GREEN, fontsize=8)
    right.set(xlabel="time after touchdown, s", xlim=(0, 0.8), ylim=(0, None))
    right.set_title("The nominal landing")
    return picture
