"""Sections 5.2.2, 5.4 and 5.5: what the launcher does with the doll, and how far it flies."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.dynamics import Equations
from somersault.flight import GRAVITY, BallisticPath, fly
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis._motion import Motion
from somersault.thesis.ch5 import _launcher as launcher
from somersault.thesis.ch5._filmed_launch import doll_along
from somersault.thesis.ch5._launcher import (
    BAR_HEIGHT,
    CEILING,
    RELEASE,
    SOMERSAULTS,
    SPIN,
    Launch,
    launch,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_REACHES = (0.16, 0.19, 0.22, 0.25, 0.28)  # m from the bar to the doll's head
_CATCHES = (1.5, 0.9)  # m, a catcher's hands
_MARGIN = 0.1  # m that is kept below the ceiling
_BARS = (1.4, 2.8)  # m, heights at which one can load a launcher, on a step perhaps
_STRONG = 5.0  # N m that a hand winds up at the doll's distance, about 15 N
_STEEL = 2.0e11  # Pa
_ROD = 0.0254 / 16  # m, diameter of a thin rod (ours)
_ROD_LENGTH = 0.28  # m, from the arm to the feet (ours)
_WRONG = 0.2  # of the pretension: an error that one makes by hand


def sec_5_4() -> Result:
    """The swing, the rods, the release and the flight."""
    throw = launch()
    wound, left = throw.spring_torques
    return Result(
        "The doll, held in a clamp by the rod on its head, is wound round a horizontal bar "
        "against a torsion spring and let go. At about Φ = π/2 the clamp opens. The rate of "
        "16.6 rad/s and the ceiling of 4.3 m limit the flight to about three and a half "
        "somersaults. The arms are propped by thin rods, which fall clear once the doll turns "
        "about its own centre of mass.",
        f"The launcher's dimensions are ours (docs/doll.md). Its spring, tensioned for {SPIN} "
        f"rad/s, gives {wound:.1f} N m wound one turn back and {left:.1f} N m at the release, "
        f"{throw.swing.times[-1]:.2f} s later. The doll leaves upwards at {throw.path.climb:.2f} "
        f"m/s and at {-throw.release.takeoff.velocity[0]:.2f} m/s away from the bar: at Φ = π/2 "
        f"exactly it would come down onto the clamp, so Φ = {RELEASE} rad is taken. A rod bears up "
        f"to {throw.rod_torque.max():.2f} N m about the shoulder before the release, and after it "
        "only what the pretension is wrong by.",
        (*_flight_claims(throw), *_rod_claims(throw), _carried(throw)),
        _draw(throw),
        Table(
            ("bar to head", "leaves at", "highest bar", f"somersaults, caught at {_CATCHES[0]} m",
             f"at {_CATCHES[1]} m"),
            tuple(
                (f"{fit.reach:.2f} m", f"{fit.climb:.2f} m/s", f"{fit.bar:.2f} m",
                 *(f"{turns:.2f}" for turns in fit.somersaults))
                for fit in map(_fit, _REACHES)
            ),
        ),
        Motion(
            {"swung round the bar, let go at 0 s": doll_along(throw)}, 0.5,
            {"follow": False, "size": (640, 880), "camera": (90.0, 6.0)},
        ),
    )  # fmt: skip


@dataclass(frozen=True)
class _Fit:
    """A clamp of some `reach` under this ceiling, with its bar as high as it may be (m, m/s)."""

    reach: float
    climb: float
    bar: float
    somersaults: tuple[float, ...]


@cache
def _fit(reach: float) -> _Fit:
    """In closed form: everything here follows from the distance to the doll's centre of mass."""
    out = launch().out + reach - launcher.REACH
    climb = SPIN * out * np.sin(RELEASE)
    apex = CEILING - _MARGIN - launcher.radius()
    height = apex - climb**2 / (2 * launcher.G)
    bar = height + out * np.cos(RELEASE)
    path = BallisticPath((0.0, 0.0, height), (0.0, 0.0, climb), GRAVITY)
    times = [path.time_to(catch) for catch in _CATCHES]
    return _Fit(reach, climb, bar, tuple(SPIN * time / (2 * np.pi) for time in times))


def _turns(throw: Launch) -> float:
    """Somersaults to the catch of the doll itself, whose rate is not quite steady, in flight."""
    flight = fly(throw.doll, throw.release.takeoff, throw.time(), samples=2)
    return (flight.landing.somersault - RELEASE) / (2 * np.pi)


def _flight_claims(throw: Launch) -> list[Claim]:
    fit = [f for f in map(_fit, _REACHES) if _BARS[0] <= f.bar <= _BARS[1]]
    few, many = (pick(t for f in fit for t in f.somersaults) for pick in (min, max))
    times = np.linspace(0, throw.time(), 400)
    top = float(throw.path.at(times)[:, 2].max()) + launcher.radius()
    angles = np.linspace(RELEASE - 0.6, RELEASE + 0.6, 121)
    climbs = throw.path.climb / np.sin(RELEASE) * np.sin(angles)
    best = float(angles[np.argmax(climbs)])
    wound = throw.spring_torques[0]
    beside = -float(throw.path.at(times[-1:])[0, 0])
    where = "§5.2.2, §5.5"
    return [
        number(
            "sec5-4.rate", "§5.5", "the doll's somersault rate as it is let go", SPIN,
            float(throw.swing.u[-1, 0]), "rad/s", 0.05,
            "The spring is tensioned for it by the energy of a doll with still arms; the swing is "
            "integrated with arms that move against rods, and could end elsewhere.",
        ),
        statement(
            "sec5-4.spring", "§5.2.2", "doll and clamp can be wound round the bar by hand",
            "wound", f"{wound:.2f} N m for one turn back, "
            f"{wound / throw.out:.0f} N at the doll", wound < _STRONG,
            f"Holds below {_STRONG:g} N m. More turns would need less.",
        ),
        number(
            "sec5-4.somersaults", where, "somersaults from release to the catch", SOMERSAULTS,
            _turns(throw), "1", 0.25,
            f"With the bar at {BAR_HEIGHT} m and hands at {launcher.CATCH} m, both ours.",
        ),
        statement(
            "sec5-4.limited", where, "rate and ceiling limit the doll to about three and a half "
            "somersaults, whatever the launcher's size", "about three and a half",
            f"{few:.2f} to {many:.2f} for clamps of {fit[0].reach:g} to {fit[-1].reach:g} m and "
            f"hands at {_CATCHES[0]:g} to {_CATCHES[1]:g} m, the bar as high as the ceiling allows",
            few > 3.0 and many < 4.0 and few < SOMERSAULTS < many,
            f"Bars at {_BARS[0]:g} to {_BARS[1]:g} m. Holds within half a somersault.",
        ),
        statement(
            "sec5-4.ceiling", "§5.5", "the doll flies under the ceiling", f"below {CEILING:g} m",
            f"feet or arms reach {top:.2f} m", top < CEILING,
        ),
        statement(
            "sec5-4.half-pi", "§5.4", "released at about π/2 round the bar", "approximately π/2",
            f"the flight is longest for {best:.2f} rad; at {RELEASE} the doll comes down "
            f"{beside:.2f} m beside the bar, at π/2 {throw.out:.2f} m",
            abs(best - np.pi / 2) < 0.1 and beside > throw.out + launcher.radius(),
            "Between these two angles the doll leaves almost straight up.",
        ),
    ]  # fmt: skip


# ---------------------------------------------------------------------------------- rods


def _free_load(throw: Launch, share: float) -> float:
    """What a rod has to give just after the release, N m, with a share of the pretension."""
    return _steady_load(throw) + (1 - share) * throw.pretension


@cache
def _steady_load(throw: Launch) -> float:
    """What keeps the left arm of the free doll on its rod, with the springs as they are, N m."""
    free = Equations(throw.doll)
    arms = np.array([launcher.ARMS, -launcher.ARMS])
    speeds = np.concatenate([throw.spin, np.zeros(5)])
    # Of torques of the left arm and, mirrored, of the right: none, and one newton metre.
    none, one = free.forward_dynamics(arms, speeds, [[0.0, 0.0], [1.0, -1.0]])[:, 6]
    return float(-none / (one - none))


def _rod_claims(throw: Launch) -> list[Claim]:
    load, pretension = throw.rod_torque, -throw.pretension
    weight = _weight_of_arm(throw)
    after = [_free_load(throw, share) for share in (1 - _WRONG, 1.0, 1 + _WRONG)]
    force = float(load.max()) / launcher.ROD_LEVER
    buckles = np.pi**3 * _STEEL * _ROD**4 / 64 / _ROD_LENGTH**2
    return [
        statement(
            "sec5-4.pretension", "§5.4", "the rods are held in place by the pretension of the "
            "shoulders' springs", "held",
            f"the spring presses an arm down with {1e3 * pretension:.0f} mN m, more than the "
            f"{1e3 * weight:.0f} mN m by which its weight lifts it with the doll wound upside down",
            pretension > weight,
        ),
        statement(
            "sec5-4.pushed", "§5.4", "as the doll turns about the bar centrifugal forces push the "
            "arms towards the feet, which helps to hold the rods", "help",
            f"the load rises from {load[0]:.2f} to {load[-1]:.2f} N m, "
            f"{(load[-1] - pretension) / pretension:.1f} times the pretension beside it, and is "
            f"never below {load.min():.2f} N m",
            load.min() > 0 and load[-1] - pretension > pretension,
        ),
        statement(
            "sec5-4.thin", "§5.4", "thin steel rods bear it", "thin",
            f"{force:.1f} N on a rod 0.1 m from the shoulder; one of 1/16 inch and "
            f"{_ROD_LENGTH:g} m buckles at {buckles:.1f} N", force < buckles,
        ),
        statement(
            "sec5-4.lifted", "§5.4", "about its own centre of mass the spin lifts the arms, and "
            "the rods fall clear", "lifted off",
            f"without springs the arms would be lifted with {1e3 * pretension:.0f} mN m; with the "
            f"pretension that balances this a rod bears {1e3 * abs(after[1]):.1f} mN m, with "
            f"{100 * _WRONG:.0f} % less {1e3 * after[0]:.1f}, with as much more "
            f"{1e3 * after[2]:.1f}",
            pretension > 0 and after[0] < 0 and max(map(abs, after)) < 0.05 * load[-1],
            "Negative: the arm is off the rod. It holds when nothing is left beyond a twentieth "
            "of the load before.",
        ),
    ]  # fmt: skip


def _weight_of_arm(throw: Launch) -> float:
    """What the weight of an arm straight out gives about its shoulder, N m."""
    arm = throw.doll.bodies[1]
    return float(arm.mass * -GRAVITY[2] * -arm.com[2] * np.sin(launcher.ARMS))


# ------------------------------------------------------------------------------- release


def _carried(throw: Launch) -> Claim:
    """Momentum and energy just before, of the held doll less its clamp, and just after."""
    off = carried(throw)
    return statement(
        "sec5-4.carried", "§5.2.2", "opening the clamp changes nothing in the doll's motion",
        "released", f"momentum, angular momentum and energy differ by at most {off:.0e} of "
        "themselves", off < 1e-10,
    )  # fmt: skip


def carried(throw: Launch) -> float:
    """Largest relative difference of momentum, angular momentum and energy across the release.

    Before it they are those of the held model, from which the clamp's known part is taken.
    """
    held, moving = throw.mount.held, throw.swing.u[-1, 0]
    equations, q, u = Equations(held), throw.swing.q[-1], throw.swing.u[-1]
    bar = np.array([0.0, 0.0, BAR_HEIGHT])
    along = np.array([-np.sin(q[0]), 0.0, -np.cos(q[0])])
    across = np.array([-np.cos(q[0]), 0.0, np.sin(q[0])])
    clamp = launcher.CLAMP_MASS * launcher.CLAMP_AT * moving * across
    clamp_spin = np.array([0.0, launcher.CLAMP_INERTIA * moving, 0.0])
    spin = clamp_spin + np.cross(bar + launcher.CLAMP_AT * along, clamp)
    whole = equations.momentum(q, u)
    p, mass = whole[3:] - clamp, throw.doll.mass
    h = whole[:3] - spin - np.cross(throw.release.centre, p)
    energy = float(equations.kinetic_energy(q, u)) - 0.5 * float(
        clamp @ clamp / launcher.CLAMP_MASS + clamp_spin @ clamp_spin / launcher.CLAMP_INERTIA
    )
    flight = fly(throw.doll, throw.release.takeoff, 1e-3, samples=2)
    v = np.array(throw.release.takeoff.velocity)
    after = float(flight.kinetic_energy[0] + 0.5 * mass * v @ v)
    first = flight.angular_momentum[0]
    return max(
        float(np.linalg.norm(p - mass * v) / np.linalg.norm(p)),
        float(np.linalg.norm(h - first) / np.linalg.norm(h)),
        abs(energy - after) / energy,
    )


# ------------------------------------------------------------------------------- picture


def _draw(throw: Launch) -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.4, 5.0)
    grid = picture.add_gridspec(2, 2, width_ratios=(1.05, 1.25))
    lab = picture.add_subplot(grid[:, 0])
    _draw_laboratory(lab, throw)
    rate, load = (picture.add_subplot(grid[k, 1]) for k in (0, 1))
    t = throw.swing.times - throw.swing.times[-1]
    rate.plot(t, throw.swing.u[:, 0], color=look.BLUE)
    rate.plot([0, 0.3], [throw.swing.u[-1, 0]] * 2, color=look.BLUE)
    rate.set(xlim=(t[0], 0.3), ylim=(0, 19), ylabel="somersault rate (rad/s)")
    rate.set_title("Round the bar, then free")
    spring = throw.swing.spring_torques[:, 0]
    look.label(
        rate,
        t[0] + 0.05,
        15.5,
        f"launcher's spring: {spring[0]:.1f} N m wound,\n{spring[-1]:.1f} N m at release",
        look.GREY,
    )
    load.plot(t, throw.rod_torque, color=look.VERMILION)
    after = [max(_free_load(throw, share), 0.0) for share in (1.0, 1 + _WRONG)]
    load.plot([0, 0, 0.3], [throw.rod_torque[-1], after[0], after[0]], color=look.VERMILION)
    load.fill_between([0, 0.3], after[0], after[1], color=look.VERMILION, alpha=0.35, lw=0)
    pretension = -throw.pretension
    load.plot(t, np.full_like(t, pretension), color=look.BLACK, ls="--", lw=1.2)
    load.set(xlim=(t[0], 0.3), ylim=(-0.02, 0.42), xlabel="time from the release (s)")
    load.set_ylabel("a rod's load (N m)")
    look.label(load, -0.42, 0.25, "rod", look.VERMILION)
    look.label(load, t[0] + 0.05, 0.025, "pretension of the arm's spring alone")
    look.label(load, 0.02, 0.075, "off the rod, or\nnearly so", look.VERMILION)
    for ax in (rate, load):
        ax.axvline(0, color=look.GREY, lw=0.8)
    look.label(rate, 0.01, 2.0, "let go", look.GREY)
    return picture


def _draw_laboratory(ax: object, throw: Launch) -> None:
    from matplotlib.axes import Axes

    from somersault.view import style as look

    assert isinstance(ax, Axes)
    times = np.linspace(0, throw.time(), 200)
    path = throw.path.at(times)
    ax.plot(path[:, 0], path[:, 2], color=look.BLUE, lw=1.2, ls=":")
    for k, time in enumerate(np.arange(0, throw.time(), 2 * np.pi / SPIN / 4)):
        angle = RELEASE + SPIN * time
        centre = throw.path.at([time])[0]
        _stick(ax, centre, angle, look.BLUE if k else look.VERMILION)
    for angle in np.arange(-2.4, RELEASE - 0.2, 0.6):
        centre = _on_bar(throw, angle)
        _stick(ax, centre, angle, look.GREY, alpha=0.45)
    clamp = _on_bar(throw, RELEASE, throw.reach)
    ax.plot([0, clamp[0]], [BAR_HEIGHT, clamp[2]], color=look.VERMILION, lw=1.2)
    ax.plot(0, BAR_HEIGHT, "o", color=look.BLACK, ms=6, zorder=6)
    ax.axhline(CEILING, color=look.BLACK, lw=2)
    ax.axhline(0, color=look.BLACK, lw=2)
    ax.set(xlim=(-1.75, 0.75), ylim=(-0.05, 4.6), xlabel="m", ylabel="height (m)")
    ax.set_aspect("equal")
    look.label(ax, -1.7, 4.45, "ceiling 4.3 m")
    look.label(ax, 0.12, BAR_HEIGHT + 0.05, "bar")
    look.label(ax, -1.7, 0.85, f"caught, {_turns(throw):.1f}\nsomersaults", look.BLUE)
    look.label(ax, 0.02, 3.0, "doll in\nthe clamp", look.GREY)


def _on_bar(throw: Launch, angle: float, reach: float | None = None) -> Array:
    """A point at a reach from the bar; by default the doll's centre of mass."""
    out = -(throw.out if reach is None else reach)
    return np.array([0, 0, BAR_HEIGHT]) + out * np.array([np.sin(angle), 0, np.cos(angle)])


def _stick(ax: object, centre: Array, angle: float, color: str, alpha: float = 1.0) -> None:
    """The doll from the side: a line with a dot for its head."""
    up = np.array([np.sin(angle), 0.0, np.cos(angle)])
    foot, head = (
        centre - launcher.radius() * up,
        centre + (launcher.HEIGHT - launcher.radius()) * up,
    )
    ax.plot([foot[0], head[0]], [foot[2], head[2]], color=color, alpha=alpha, lw=1.6)  # type: ignore[attr-defined]
    ax.plot(head[0], head[2], "o", color=color, alpha=alpha, ms=4)  # type: ignore[attr-defined]
