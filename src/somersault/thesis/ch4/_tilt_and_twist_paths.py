"""Figures 4-14 and 4-15: rigid and passively stable trajectories (section 4.4.1)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault import rigid
from somersault import stability as st
from somersault._core.array import Array
from somersault.flight import Flight, principal_attitude
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result
from somersault.thesis.ch4._furrer import MODEL, NOMINAL
from somersault.thesis.ch4._layout_takeoff import SPIN, passive
from somersault.thesis.ch4._rigid_and_passive import STIFFNESS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DOT = 0.01  # s between the dots of figure 4-14


def _rigid_paths(starts: tuple[tuple[float, float], ...], seconds: float) -> list[Array]:
    """Tilt and twist (2, time) of rigid motions from tilts and twists (°), every 0.01 s."""
    inertias = st.principal_inertias(MODEL, {"shoulder": NOMINAL})
    times = np.arange(0, seconds, _DOT)
    paths = []
    for tilt, twist in starts:
        c = rigid.momentum_direction(*np.radians([tilt, twist]))
        motion = rigid.RigidMotion(inertias, SPIN * inertias[1] * c / inertias)
        paths.append(np.array(rigid.tilt_and_twist(motion.omega(times) * inertias)))
    return paths


_NEAR = (
    *((sign * tilt, 0.0) for tilt in (0.6, 1.2, 1.8, 2.4) for sign in (1, -1)),
    *((0.0, sign * twist) for twist in (3.0, 6.0, 9.0) for sign in (1, -1)),
)


def _near_the_origin(ax: Axes, dots: bool = True) -> None:
    from somersault.view import style as look

    for tilt, twist in _both_ways(_NEAR):
        line = ax.plot(twist, tilt, color=look.GREY, lw=0.6, zorder=1)[0]
        line.set_clip_on(True)
        if dots:
            ax.plot(twist, tilt, ".", color=look.BLUE, ms=2.5, zorder=2)
        inside = np.flatnonzero((np.abs(twist) < 11) & (np.abs(tilt) < 2.8))
        for k in inside[len(inside) // 4 :: max(len(inside) // 2, 4)]:
            if k + 1 < len(twist) and k > 0:
                ax.annotate(
                    "", (twist[k + 1], tilt[k + 1]), (twist[k], tilt[k]), zorder=3,
                    arrowprops={
                        "arrowstyle": "-|>", "color": look.BLACK, "lw": 0.6, "mutation_scale": 9,
                    },
                )  # fmt: skip
    ax.plot(0, 0, "+", color=look.BLACK, ms=10)
    ax.set(xlim=(-12, 12), ylim=(-3, 3), xlabel="twist Ψ (°)", ylabel="tilt Θ (°)")


def _both_ways(starts: tuple[tuple[float, float], ...]) -> list[Array]:
    """Paths through the starts, backwards in time and forwards, in degrees, in order of time."""
    inertias = st.principal_inertias(MODEL, {"shoulder": NOMINAL})
    times = np.arange(-40, 41) * _DOT
    paths = []
    for tilt, twist in starts:
        c = rigid.momentum_direction(*np.radians([tilt, twist]))
        motion = rigid.RigidMotion(inertias, SPIN * inertias[1] * c / inertias)
        paths.append(np.degrees(rigid.tilt_and_twist(motion.omega(times) * inertias)))
    return paths


def fig_4_14() -> Result:
    """Rigid trajectories near the middle axis."""
    tilts = np.linspace(0.2, 2.8, 14)
    first = _rigid_paths(tuple((float(t), 0.0) for t in tilts), 0.015)
    speed = np.array([abs(path[1, 1] - path[1, 0]) / _DOT for path in first])
    later = _rigid_paths(((0.5, 0.0), (-0.5, 0.0)), 0.35)
    sides = [path[1, -1] for path in later]
    circle = rigid.separatrix(st.principal_inertias(MODEL, {"shoulder": NOMINAL}), 721)
    tilt, twist = (np.degrees(x[:, 8]) for x in rigid.tilt_and_twist(circle))
    where = "§4.4.1, Figure 4-14"
    claims = (
        statement(
            "fig4-14.rate", where, "dot spacing shows that twist rate increases with tilt "
            "magnitude", "increases", f"at no twist from {np.degrees(speed[0]):.1f} to "
            f"{np.degrees(speed[-1]):.0f} °/s for tilts of {tilts[0]:.1f} to {tilts[-1]:.1f}°",
            bool(np.all(np.diff(speed) > 0)),
        ),
        statement(
            "fig4-14.sides", where, "the body departs from the origin in a direction that depends "
            "on which side of the equilibrium it is", "depends on the side",
            f"tilt ±0.5° leads to twist {np.degrees(sides[0]):+.1f}° and "
            f"{np.degrees(sides[1]):+.1f}° in 0.34 s", bool(sides[0] < 0 < sides[1]),
        ),
        statement(
            "fig4-14.saddle", where, "trajectories converge on the origin and diverge from it",
            "unstable", f"the separatrix crosses there: lines of tilt/twist = "
            f"{tilt[0] / twist[0]:+.3f} and {tilt[1] / twist[1]:+.3f}",
            bool(tilt[0] / twist[0] * tilt[1] / twist[1] < 0),
        ),
    )  # fmt: skip
    return Result(
        "Tilt against twist for several rigid motions of the layout near its middle axis, arms at "
        "1.3 rad: dots 0.01 s apart, arrows with time.",
        f"Exact motions at {SPIN} rad/s. Twist is to the right and tilt up: then the twist is "
        "negative in the upper half, as the text says.",
        claims,
        _draw_4_14(),
    )


def _draw_4_14() -> Figure:
    from somersault.view import style as look

    picture = look.figure(7.2, 5.0)
    ax = picture.add_subplot()
    _near_the_origin(ax)
    circles = rigid.separatrix(st.principal_inertias(MODEL, {"shoulder": NOMINAL}), 1441)
    for circle in circles:
        tilt, twist = (np.degrees(x) for x in rigid.tilt_and_twist(circle))
        near = np.abs(twist) < 13
        ax.plot(np.where(near, twist, np.nan), tilt, color=look.BLACK, lw=1.8, zorder=1)
    look.label(ax, 7.2, 1.15, "separatrix")
    return picture


def circling(tilt: Array, twist: Array) -> tuple[float, float]:
    """Turns about the origin, counter-clockwise with twist to the right and tilt up, and the
    share of the steps that go that way."""
    angle = np.unwrap(np.arctan2(tilt, twist))
    return float((angle[-1] - angle[0]) / (2 * np.pi)), float(np.mean(np.diff(angle) > 0))


def fig_4_15() -> Result:
    """The passively stable trajectory."""
    flown = passive(NOMINAL, STIFFNESS)
    history = flown.dataset
    tilt, twist = history["tilt"].values, history["twist"].values
    principal = principal_attitude(flown)
    return Result(
        "A passively stable simulation from a tilt of 0.01 rad over the rigid trajectories: it "
        "circles the origin counter-clockwise, twisting with the flow and tilting upstream. The "
        "arms move asymmetrically (left up, right down) in answer to a negative twist rate, which "
        "reduces the tilt of the principal axes.",
        f"Γ = {NOMINAL} rad, K_sh = {STIFFNESS} (not printed), {SPIN} rad/s, momentum along the "
        "inertial 2 axis. It is the principal axes that circle, all the time and in the direction "
        "that the thesis says; the body's own tilt and twist also carry the quick rocking of the "
        "arms, and whether they circle depends on the spring.",
        tuple(_claims_4_15(flown, tilt, twist, principal)),
        _draw_4_15(tilt, twist, principal),
    )


def _claims_4_15(
    flown: Flight, tilt: Array, twist: Array, principal: tuple[Array, Array]
) -> list[Claim]:
    where = "§4.4.1, Figure 4-15"
    turns, share = circling(*principal)
    of_body = circling(tilt, twist)
    others = []
    for stiffness in (0.95, 1.2, 1.3):
        other = passive(NOMINAL, stiffness)
        axes = circling(*principal_attitude(other))
        body = circling(other.dataset["tilt"].values, other.dataset["twist"].values)
        others.append((stiffness, axes, body[0]))
    joints = flown.dataset["joint_angle"]
    left = joints.sel(joint="left_shoulder").values - NOMINAL
    right = -joints.sel(joint="right_shoulder").values - NOMINAL  # up is positive
    rate = np.gradient(twist, flown.times)
    begin = flown.times < 0.05
    falling = np.gradient(principal[0], flown.times)[begin]
    locked = _rigid_paths(((np.degrees(0.01), 0.0),), 0.06)[0][0]
    lean = (left - right) / 2
    first = slice(1, int(np.argmax(rate > 0)))  # until the first negative twist is over
    push = np.gradient(np.gradient(lean, flown.times), flown.times)
    answer = float(np.corrcoef(push, rate)[0, 1])
    mean = float(lean[rate < 0].mean())
    listed = ", ".join(f"{t[0]:.1f} at K_sh = {k:g}" for k, t, _ in others)
    return [
        statement(
            "fig4-15.circles", where, "the passively stable trajectory circles the origin "
            "counter-clockwise (its principal axes' tilt and twist)", "counter-clockwise",
            f"{turns:.1f} times in eight somersaults, {100 * share:.0f} % of the time that way",
            turns > 1 and share > 0.95, f"So with other springs: {listed}.",
        ),
        statement(
            "fig4-15.body", where, "the passively stable trajectory circles the origin "
            "counter-clockwise (the body's own tilt and twist)", "counter-clockwise",
            f"{of_body[0]:+.1f} times, {100 * of_body[1]:.0f} % of the time that way",
            of_body[0] > 1 and of_body[1] > 0.6,
            "The body's own tilt rocks with the arms; turns with other springs: "
            + ", ".join(f"{b:+.1f} at K_sh = {k:g}" for k, _, b in others)
            + ". The thesis does not print its spring, nor which axes it plots.",
        ),
        statement(
            "fig4-15.start", where, "from positive tilt, no twist and symmetric arms the body "
            "begins to twist in the negative direction", "negative",
            f"{np.degrees(rate[begin].min()):.1f} °/s within 0.05 s",
            bool(np.all(rate[begin][1:] < 0)),
        ),
        statement(
            "fig4-15.upstream", where, "from there the tilt of the principal axes decreases "
            "despite the rigid body's tendency to increase it", "decreases",
            f"falls by {np.degrees(principal[0][0] - principal[0][begin][-1]):.4f}° in 0.05 s; "
            f"rigid it rises by {np.degrees(locked[-1] - locked[0]):.4f}°",
            bool(np.all(falling[1:] < 0) and locked[-1] > locked[0]),
        ),
        statement(
            "fig4-15.arms", where, "from there the arms move asymmetrically in response to the "
            "negative twist rate: left arm up, right arm down", "left up, right down",
            f"left {np.degrees(left[first.stop - 1]):+.1f}°, right "
            f"{np.degrees(right[first.stop - 1]):+.1f}° when the twist first turns back, at "
            f"{flown.times[first.stop]:.2f} s",
            bool(np.all(left[first] > 0) and np.all(right[first] < 0)),
        ),
        statement(
            "fig4-15.gyroscopic", where, "the gyroscopic effect tends to move the arms in the "
            "direction that reduces the tilt of the principal axes as long as the body twists",
            "against the twist rate", f"the arms' asymmetric acceleration and the twist rate "
            f"correlate by {answer:+.3f} over eight somersaults", answer < -0.9,
            "It is the push that answers the twist rate. The arms' position, being an "
            "oscillation's, follows half a period later: while the twist rate is negative the left "
            f"arm is on average {np.degrees(mean):+.1f}° from 1.3 rad.",
        ),
    ]  # fmt: skip


def _draw_4_15(tilt: Array, twist: Array, principal: tuple[Array, Array]) -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.4, 4.4)
    grid = picture.subplots(1, 2, sharex=True, sharey=True)
    for ax, (up, right), name in zip(
        grid, (principal, (tilt, twist)), ("principal axes", "body"), strict=True
    ):
        _near_the_origin(ax, dots=False)
        ax.plot(np.degrees(right), np.degrees(up), color=look.VERMILION, lw=1.0, zorder=5)
        ax.plot(np.degrees(right[0]), np.degrees(up[0]), "o", color=look.BLACK, ms=5, zorder=6)
        k = int(np.argmax(np.degrees(np.abs(right)) > 1.0))
        ax.annotate(
            "", np.degrees([right[k + 12], up[k + 12]]), np.degrees([right[k], up[k]]), zorder=7,
            arrowprops={
                "arrowstyle": "-|>", "color": look.VERMILION, "lw": 1.6, "mutation_scale": 16,
            },
        )  # fmt: skip
        ax.set(xlim=(-7, 7), ylim=(-1.5, 1.5), title=f"tilt and twist of the {name}")
    return picture
