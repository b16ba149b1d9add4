"""Figure 4-2: the layout, rigid and passively stable."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault import rigid
from somersault import stability as st
from somersault.flight import Flight, fly
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result
from somersault.thesis._motion import Motion
from somersault.thesis.ch4._furrer import MODEL, NOMINAL
from somersault.thesis.ch4._layout_takeoff import (
    SPIN,
    TURN,
    arms,
    passive,
    sprung,
    takeoff,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STIFFNESS = 1.1  # K_sh of the passive flight; the thesis does not print its own
_STIFF = (50.0, 5.0)  # K_sh and b/(Ω I_sh) of "very stiff shoulder springs and dampers"
_WHERE = "§4.1, Figure 4-2"


@cache
def locked(tilt: float = 0.01, twist: float = 0.0) -> Flight:
    """Eight somersaults with the arms locked, from a tilt and a twist."""
    start = takeoff(arms(NOMINAL, motion="locked"), tilt, twist)
    return fly(MODEL, start, 8 * TURN, samples=4001)


@cache
def stiff() -> Flight:
    """The same with stiff, damped shoulders: the thesis's way of making the body rigid."""
    return fly(MODEL, takeoff(sprung(NOMINAL, *_STIFF)), 8 * TURN, samples=4001)


def fig_4_2() -> Result:
    """Tilt, twist and shoulders of the rigid and of the passively stable layout."""
    soft = passive(NOMINAL, STIFFNESS)
    turns = soft.landing.somersault / (2 * np.pi)
    return Result(
        "Somersaults, twist, tilt and shoulder angles of two simulations. The rigid body goes "
        "through large excursions; the passively stable one does nearly eight stable somersaults "
        "about its middle principal axis.",
        f"Furrer at Γ = {NOMINAL} rad and {SPIN} rad/s from a tilt of 0.01 rad, momentum along the "
        f"inertial 2 axis; passive with K_sh = {STIFFNESS}: {turns:.2f} somersaults in "
        f"{soft.landing.time:.2f} s. Of these numbers the thesis prints only Γ and the tilt, and "
        "these only for figure 4-15. Locked arms and arms on stiff, damped springs start alike and "
        "then part: damping takes the body over the separatrix, after which its twist only "
        "oscillates, "
        "as the thesis describes; with locked arms it goes on. Strips: rigid above, passive below, "
        "every third of a somersault.",
        (*_passive_claims(soft), *_rigid_claims(), *_stiff_claims()),
        _draw_4_2(soft),
        motion=Motion(
            {"passive": soft, "rigid: stiff and damped": stiff(), "rigid: locked": locked()}, 0.5
        ),
    )


def _passive_claims(soft: Flight) -> list[Claim]:
    held = fly(MODEL, takeoff(sprung(NOMINAL, STIFFNESS)), 8 * TURN, until="quarter twist")
    history, other = soft.dataset, stiff().dataset
    tilt, twist = (float(np.abs(history[name]).max()) for name in ("tilt", "twist"))
    far = float(np.abs(other["twist"]).max())
    swing = [float(np.abs(d["joint_angle"] - d["joint_angle"][0]).max()) for d in (history, other)]
    return [
        statement(
            "fig4-2.eight", _WHERE, "nearly eight stable somersaults of the passive body",
            "nearly eight", f"{held.landing.somersault / (2 * np.pi):.2f} in {held.times[-1]:.2f} "
            "s, without a quarter twist",
            held.ended == "duration" and held.landing.somersault > 7.9 * 2 * np.pi,
        ),
        statement(
            "fig4-2.near", _WHERE, "its tilt and twist stay near zero", "near zero",
            f"tilt within {np.degrees(tilt):.2f}°, twist within {np.degrees(twist):.1f}°; rigid "
            f"{np.degrees(float(np.abs(other['tilt']).max())):.1f}° and {np.degrees(far):.0f}°",
            twist < 0.1 * far and tilt < 0.1 * float(np.abs(other["tilt"]).max()),
        ),
        statement(
            "fig4-2.arms", _WHERE, "tuned springs allow considerable passive arm movement",
            "considerable", f"up to {np.degrees(swing[0]):.1f}° from 1.3 rad; stiff "
            f"{np.degrees(swing[1]):.1f}°", swing[0] > 3 * swing[1],
        ),
    ]  # fmt: skip


def _rigid_claims() -> list[Claim]:
    """Locked arms, against the exact motion and the curve of its energy."""
    inertias = st.principal_inertias(MODEL, {"shoulder": NOMINAL})
    claims = []
    for name, tilt, twist in (("tilt", 0.01, 0.0), ("twist", 0.0, 0.01)):
        flown = locked(tilt, twist)
        angles = np.stack([flown.dataset[x].values for x in ("somersault", "tilt", "twist")], -1)
        h = float(np.linalg.norm(flown.start.momentum))
        motion = rigid.RigidMotion.from_momentum(inertias, h, flown.start.quaternion)
        off = float(np.abs(angles - motion.angles(flown.times)).max())
        curve = rigid.energy_curve(inertias, motion.energy, 721, h)
        most = float(np.abs(rigid.tilt_and_twist(curve)[0]).max())
        edge = float(np.abs(rigid.tilt_and_twist(rigid.separatrix(inertias, 721))[0]).max())
        claims += [
            statement(
                f"fig4-2.exact-{name}",
                "§2.5, Appendix A.4",
                f"rigid layout from a {name} of "
                "0.01 rad: the integrated flight is the closed-form motion",
                "A.8 to A.33",
                f"all three angles to {off:.0e} rad over eight somersaults",
                off < 1e-7,
            ),
            statement(
                f"fig4-2.excursion-{name}",
                "§4.1, Figures 4-2, 4-3",
                "largest tilt of the rigid "
                f"layout from a {name} of 0.01 rad is that of its curve on the map",
                "the flight follows its curve of constant energy",
                f"{np.abs(angles[:, 1]).max():.5f} rad flown, {most:.5f} rad on the curve",
                abs(most - float(np.abs(angles[:, 1]).max())) < 1e-4,
                f"The bound of the energy's curve against the flight; that of the separatrix is "
                f"{edge:.5f} rad.",
            ),
        ]
    return claims


def _stiff_claims() -> list[Claim]:
    inertias = st.principal_inertias(MODEL, {"shoulder": NOMINAL})
    flown = stiff()
    omega = flown.dataset["angular_velocity"].values
    kinds = [rigid.kind_of_motion(inertias, w) for w in (omega[0], omega[-1])]
    lost = float(1 - flown.kinetic_energy[-1] / flown.kinetic_energy[0])
    twist = flown.dataset["twist"].values
    turns = int(np.sum(np.diff(np.sign(np.diff(twist))) != 0))
    plain = locked().dataset["twist"].values
    return [
        statement(
            "fig4-2.oscillates", "§4.1", "the rigid body's twist oscillates, on a trajectory about "
            "the maximum principal axis (front-to-back)", "oscillates about the maximum axis",
            f"stiff, damped shoulders (K_sh = {_STIFF[0]:g}, b = {_STIFF[1]:g} Ω I_sh): round the "
            f"{kinds[1]} axis, twist turns back {turns} times within "
            f"{np.degrees(np.abs(twist).max()):.0f}°",
            kinds[1] == "major" and turns >= 3 and bool(np.abs(twist).max() < np.pi),
            f"It starts round the {kinds[0]} axis; its dampers take {100 * lost:.2f} % of the "
            "energy, and the separatrix is close. With locked arms, which lose nothing, the same "
            f"start twists on, {np.abs(plain[-1]) / (2 * np.pi):.1f} turns in eight somersaults. "
            "A start with more twist than tilt oscillates with locked arms too.",
        ),
        statement(
            "fig4-2.large", "§4.1", "rigid tilt and twist periodically move through large "
            "excursions", "large", f"tilt to {np.degrees(np.abs(flown.dataset['tilt']).max()):.1f}°"
            f", twist to {np.degrees(np.abs(twist).max()):.0f}°",
            bool(np.abs(twist).max() > np.pi / 2),
        ),
    ]  # fmt: skip


def _draw_4_2(soft: Flight) -> Figure:
    from somersault.view import strip
    from somersault.view import style as look

    picture = look.figure(8.2, 9.2)
    grid = picture.subplots(5, 1, height_ratios=(1, 1, 1, 0.75, 0.75))
    shown = (
        (soft, look.BLUE, "-", "passive"),
        (stiff(), look.VERMILION, "--", "rigid: stiff and damped"),
        (locked(), look.GREY, ":", "rigid: locked"),
    )
    for flown, color, dash, name in shown:
        data = flown.dataset
        turns = data["somersault"] / (2 * np.pi)
        grid[0].plot(turns, np.degrees(data["tilt"]), color=color, ls=dash, lw=1.3, label=name)
        grid[1].plot(turns, np.degrees(data["twist"]), color=color, ls=dash, lw=1.3)
    for flown, color, dash, _ in shown[:2]:
        data = flown.dataset
        turns = data["somersault"] / (2 * np.pi)
        for joint, sign in (("left_shoulder", 1), ("right_shoulder", -1)):
            angle = sign * np.degrees(data["joint_angle"].sel(joint=joint))
            grid[2].plot(turns, angle, color=color, ls=dash, lw=1.3 if sign > 0 else 0.8)
    grid[0].set_ylabel("tilt (°)")
    grid[0].legend(loc="upper right", ncols=3, frameon=False, bbox_to_anchor=(1, 1.3))
    grid[1].set(ylabel="twist (°)", ylim=(-400, 200))
    look.label(grid[1], 2.75, -330, "locked: twists on", look.GREY)
    grid[2].set(ylabel="arms up (°)", xlabel="somersaults")
    grid[2].set_ylim(62, 92)
    look.label(grid[2], 0.05, 89, "thick: left arm, thin: right arm", look.GREY)
    for ax in grid[:3]:
        ax.set_xlim(0, 8)
    for ax in grid[:2]:
        ax.axhline(0, color=look.GREY, lw=0.5, zorder=0)
    times = np.arange(0, 13) * TURN / 3
    for ax, flown in zip(grid[3:], (stiff(), soft), strict=True):
        strip(ax, flown, times, words=False)
    return picture
