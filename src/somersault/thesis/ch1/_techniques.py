"""Figure 1-1: three ways to change a flight from within."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault.flight import (
    Flight,
    Maneuver,
    Takeoff,
    arm_tilt,
    cat_turn,
    inertia_change,
    joint_work,
    principal_attitude,
    rigid_continuation,
    torque_twist,
    twist_time,
)
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result
from somersault.thesis._motion import Motion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FIGURE = "§1.1.1, Figure 1-1"
SHARP = 1e-12  # accuracy of flights, rad
_QUICK = (0.5, 0.1)  # times of the cat's turn, over the first


# ---------------------------------------------------------------------------- measurements


def work(maneuver: Maneuver, samples: int = 8001) -> tuple[float, float]:
    """Change of kinetic energy, and the work done at the joints, J."""
    flown = maneuver.fly(accuracy=SHARP, samples=samples)
    energy = flown.kinetic_energy
    return float(energy[-1] - energy[0]), float(joint_work(flown)[-1].sum())


def tilted(tilt: float, pose: str = "layout", h: float = 60.0) -> Maneuver:
    """The gymnast held in a pose, his body tilted (rad) against the momentum h (kg m²/s)."""
    leant = Takeoff(tilt=tilt, angular_momentum=(0.0, h, 0.0))
    return torque_twist(pose=pose).from_takeoff(leant)


def rotation_number(maneuver: Maneuver, begin: float = 0.0) -> tuple[float, float]:
    """Twists per somersault, and the mean twist rate in rad/s, over one twist flown from `begin`
    (s) on, when all joints rest."""
    first = maneuver.fly(accuracy=SHARP) if begin == 0 else until(maneuver, begin)
    angles = first.angles[0] if begin == 0 else first.angles[-1]
    somersault, _, twist = angles.tolist()
    sense = np.sign(first.landing.twist - first.angles[0, 2])
    start = maneuver.takeoff.twist
    end = twist_time(maneuver, abs(twist - start) / (2 * np.pi) + 1)
    landed = until(maneuver, end).landing
    return (
        float(sense * 2 * np.pi / (landed.somersault - somersault)),
        float(sense * 2 * np.pi / (end - begin)),
    )


def until(maneuver: Maneuver, time: float) -> Flight:
    """A maneuver's flight, ended at another time (s)."""
    return replace(maneuver, duration=time).fly(accuracy=SHARP)


@cache
def half_turn(cycles: int = 3) -> float:
    """How far the torso must twist (rad) for so many cycles to make half a turn."""
    from scipy.optimize import brentq

    def missing(torso: float) -> float:
        flown = cat_turn(cycles=cycles, torso=torso).fly(accuracy=1e-11, samples=2)
        return flown.landing.twist - np.pi

    return float(brentq(missing, 0.5, np.pi / 4, xtol=1e-10))


def apart(one: Flight, other: Flight) -> float:
    """The angle between the attitudes at landing, rad."""
    p, q = one.landing.quaternion, other.landing.quaternion
    return float(4 * np.arcsin(min(np.linalg.norm(p - q), np.linalg.norm(p + q)) / 2))


# ------------------------------------------------------------------------------- figure 1-1


def fig_1_1() -> Result:
    """The three techniques, each flown by the gymnast."""
    return Result(
        "Three ways to influence a ballistic maneuver from within: change the inertia about an "
        "axis, and with it the rate; turn without any momentum by a sequence of limb movements; "
        "tilt the principal axes against the momentum, which starts or removes twist.",
        "The thesis gives no numbers. Here the gymnast tucks during a somersault; turns over "
        "without momentum by twisting his torso with legs apart and arms in, and back with arms "
        "out and "
        "legs together; and leans his arms to one side in a layout somersault, which starts a "
        "twist, and back "
        "one twist later, which ends it.",
        (*_inertia_claims(), *_cat_claims(), *_tilt_claims()),
        _draw_1_1(),
        motion=Motion(
            {
                "change of inertia": inertia_change(duration=0.65).fly(),
                "no momentum": cat_turn(torso=half_turn()).fly(),
                "tilt of the principal axes": arm_tilt(duration=0.97).fly(),
            },
            speed=0.4,
        ),
    )


def _inertia_claims() -> list[Claim]:
    claims = []
    for name, axis, poses, words in (
        ("somersault", 2, ("layout", "tuck"), "a somersault by tucking"),
        ("twist", 3, ("T", "layout"), "a skater's spin by lowering the arms"),
    ):
        maneuver = inertia_change(axis=axis, poses=poses)
        flown = maneuver.fly(accuracy=SHARP)
        rates = flown.angular_velocity[[0, -1], axis - 1]
        inertias = flown.system.equations.inertia(flown.dataset["joint_angle"].values[[0, -1]])
        before, after = inertias[:, axis - 1, axis - 1]
        ratio, inverse = rates[1] / rates[0], before / after
        # A skater's feet lie before the axis, so that a trace of the momentum leaves axis 3.
        within = 1e-9 if axis == 2 else 1e-4
        claims.append(statement(
            f"fig1-1.inertia-{name}", _FIGURE, f"a change of inertia changes the rate: {words}",
            "in inverse ratio", f"{rates[0]:.2f} to {rates[1]:.2f} rad/s, {ratio:.6f} times; "
            f"the inertia {1 / inverse:.6f} times, and 1 over that is {inverse:.6f}",
            bool(abs(ratio / inverse - 1) < within and ratio > 1.5),
        ))  # fmt: skip
    gained, done = work(inertia_change())
    claims.append(statement(
        "fig1-1.inertia-work", _FIGURE, "what a tuck adds to the energy is the muscles' work",
        "no momentum is added, energy is", f"{gained:.4f} J gained, {done:.4f} J from joint "
        "torques and rates", bool(abs(gained - done) < 1e-7 * abs(gained) and gained > 0),
        "The thesis does not speak of the energy; inverse dynamics of the flight.",
    ))  # fmt: skip
    return claims


def _cat_claims() -> list[Claim]:
    full = [np.degrees(cat_turn(cycles=n).fly(accuracy=SHARP).landing.twist) for n in (1, 2, 3)]
    turn = cat_turn(torso=half_turn())
    flown = turn.fly(accuracy=SHARP)
    momentum = float(np.abs(flown.angular_momentum).max())
    quicker = [apart(flown, turn.scaled(k).fly(accuracy=SHARP)) for k in _QUICK]
    landed = Takeoff(quaternion=flown.landing.quaternion.tolist(), angular_momentum=(0, 0, 0))
    back = turn.reversed().from_takeoff(landed).fly(accuracy=SHARP)
    home = 2 * float(np.linalg.norm(back.landing.quaternion[1:]))
    end = np.degrees([flown.landing.somersault, flown.landing.tilt, flown.landing.twist])
    joints = flown.dataset["joint_angle"].values
    return [
        statement(
            "fig1-1.cat-turns", _FIGURE, "a sequence of limb movements reorients a body that has "
            "no angular momentum", "reoriented", f"by {end[2]:.3f}° about its long axis (and "
            f"{np.abs(end[:2]).max():.3f}° otherwise), every joint back where it was; momentum "
            f"within {momentum:.0e} kg m²/s of zero throughout",
            bool(momentum < 1e-12 and abs(end[2]) > 90 and np.all(joints[0] == joints[-1])),
        ),
        statement(
            "fig1-1.cat-half", "§1.1.1", "a cat dropped with no momentum rights itself before it "
            "lands", "half a turn", f"the gymnast needs three cycles within his joints' limits: "
            f"{full[0]:.1f}°, {full[1]:.1f}° and {full[2]:.1f}° after one, two and three with the "
            f"torso twisted by 45°, and half a turn with {np.degrees(half_turn()):.1f}°",
            bool(full[1] < 180 <= full[2] and abs(end[2] - 180) < 1e-3),
            "A cat's spine bends and twists further.",
        ),
        statement(
            "fig1-1.cat-speed", _FIGURE, "momentum-free rotation depends on the moves and not on "
            "their speed", "the same", f"within {max(quicker):.0e} rad when done twice and ten "
            "times as fast", max(quicker) < 1e-9,
        ),
        statement(
            "fig1-1.cat-back", _FIGURE, "the moves backwards turn it back", "back",
            f"to within {home:.0e} rad", home < 1e-9,
        ),
    ]  # fmt: skip


def _tilt_claims() -> list[Claim]:
    on = arm_tilt(twists=None, duration=0.3)
    flown = on.fly(accuracy=SHARP)
    body = rigid_continuation(flown)
    number, rate = rotation_number(on, 0.3)
    exact, exact_rate = body.twists_per_somersault, body.mean_rates[1]
    tilt = np.degrees(principal_attitude(flown)[0])
    claims = [
        statement(
            "fig1-1.tilt-start", _FIGURE, "arms leant in a layout somersault tilt the principal "
            "axes against the momentum, and twist begins", "introduces twist",
            f"tilted from {tilt[0]:.2f}° to {tilt[-1]:.2f}° while the left arm rises and the right "
            f"one falls by about 90°; then {rate / (2 * np.pi):.2f} twists a second",
            bool(abs(tilt[0]) < 1e-6 and abs(tilt[-1]) > 2 and body.monotonic_twist),
        ),
        statement(
            "fig1-1.tilt-rate", _FIGURE, "between the moves it twists like the rigid body that it "
            "is", "twists a somersault of the map of rotation", f"{number:.9f} flown, "
            f"{exact:.9f} by elliptic integrals; {rate:.7f} and {exact_rate:.7f} rad/s",
            abs(number / exact - 1) < 1e-6 and abs(rate / exact_rate - 1) < 1e-6,
        ),
    ]  # fmt: skip
    stop = arm_tilt()
    after = stop.fly(accuracy=SHARP)
    last = stop.motion.end
    over = after.times >= last
    twist = np.degrees(after.dataset["twist"].values[over])
    leant = np.degrees(after.dataset["tilt"].values[over])
    turns = np.ptp(after.dataset["somersault"].values[over]) / (2 * np.pi)
    early = np.degrees(_badly_timed().landing.twist)
    claims.append(
        statement(
            "fig1-1.tilt-stop",
            _FIGURE,
            "the move backwards at the right moment removes the twist",
            "removed",
            f"in the {turns:.2f} somersaults after it twist stays between "
            f"{twist.min():.1f} and {twist.max():.1f}°, tilt within {np.abs(leant).max():.2f}°; a "
            f"quarter twist earlier it does not, and lands at {early:.0f}°",
            bool(abs(twist - 360).max() < 5 and np.abs(leant).max() < 1 and abs(early - 360) > 45),
            "A layout is unstable, so that what little is left grows. It is the gymnast's feet "
            "that leave it: without front and back the two moves undo each other exactly.",
        )
    )
    return claims


def _badly_timed() -> Flight:
    """The arms leant back a quarter of a twist too early."""
    good, on = arm_tilt(), arm_tilt(twists=None)
    again = good.motion.end - 0.2
    shift = again - twist_time(on, _twists_at(good, again) - 0.25)
    moves = {
        name: [(t - shift if t >= again - 1e-9 else t, angle) for t, angle in row]
        for name, row in good.keyframes.items()
    }
    return Maneuver.moves(good.model, moves, good.takeoff, good.duration).fly(accuracy=SHARP)


def _twists_at(maneuver: Maneuver, time: float) -> float:
    return abs(until(maneuver, time).landing.twist) / (2 * np.pi)


def _draw_1_1() -> Figure:
    from somersault.view import strip
    from somersault.view import style as look

    picture = look.figure(10.0, 6.2)
    grid = picture.subplots(3, 2, width_ratios=(2.7, 1))
    tuck = inertia_change(duration=0.65).fly()
    cat = cat_turn(torso=half_turn()).fly()
    arms = arm_tilt(duration=0.97).fly()
    shown = (
        (tuck, "1  change of inertia: a tuck", (78.0, 8.0), np.linspace(0, 0.6, 7)),
        (cat, "2  no momentum: torso twisted with legs apart, and back with arms out (three times)",
         (35.0, 20.0), np.append(np.arange(6) * 0.15, cat.times[-1])),
        (arms, "3  tilt of the principal axes: arms leant, and one twist later leant back",
         (20.0, 10.0), np.linspace(0, 0.9, 7)),
    )  # fmt: skip
    for (ax, _), (flight, title, view, times) in zip(grid, shown, strict=True):
        strip(ax, flight, times, view=view, words=False)
        ax.set_title(title)
        size = ax.get_ylim()[1] / 1.1
        for place, time in enumerate(times):
            look.label(ax, 1.7 * size * place, -1.15 * size, f"{time:.2f} s", look.GREY,
                       ha="center", fontsize=8)  # fmt: skip
    first, second, third = grid[:, 1]
    first.plot(tuck.times, tuck.angular_velocity[:, 1], color=look.BLUE)
    first.set(ylabel="somersault rate (rad/s)", ylim=(0, None))
    second.plot(cat.times, np.degrees(cat.dataset["twist"]), color=look.BLUE)
    second.set(ylabel="twist of the hips (°)", yticks=(0, 60, 120, 180))
    third.plot(arms.times, np.degrees(arms.dataset["twist"]), color=look.BLUE)
    third.set(ylabel="twist (°)", yticks=(0, 120, 240, 360), ylim=(-15, 400))
    third.yaxis.label.set_color(look.BLUE)
    for ax in (first, second, third):
        ax.set_xlabel("time (s)")
    other = third.twinx()
    other.plot(arms.times, np.degrees(arms.dataset["tilt"]), color=look.VERMILION)
    other.set(ylabel="tilt (°)", ylim=(-12, 0.45), yticks=(-10, -5, 0))
    other.yaxis.label.set_color(look.VERMILION)
    return picture
