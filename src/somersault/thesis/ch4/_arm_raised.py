"""Figure 4-13: an arm raised in the air turns the body's principal axes (section 4.4.1)."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault.attitude import matrix_from_quaternion
from somersault.flight import Flight, JointTakeoff, Takeoff, fly, principal_axes_along
from somersault.model import load
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result
from somersault.thesis._motion import Motion
from somersault.thesis.ch4._furrer import MODEL

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_RAISED = 2.6  # rad: the left arm of the figure on the right
_SECONDS = 0.5  # in which it is raised; only the angles matter


@cache
def raised() -> Flight:
    """One arm raised in the air, without angular momentum."""
    joints = {
        "left_shoulder": JointTakeoff.prescribed(times=(0.0, _SECONDS), angles=(0.0, _RAISED)),
        "right_shoulder": JointTakeoff.locked(0.0),
    }
    start = Takeoff(angular_momentum=(0.0, 0.0, 0.0), joints=joints)
    return fly(MODEL, start, _SECONDS, accuracy=1e-11)


def planar_tilt() -> float:
    """Body tilt by the same motion as a planar two-body problem, I θ̇ + B γ̇ = 0, by quadrature."""
    from scipy.integrate import quad

    body, left, right = load(MODEL).bodies
    pin = np.array(left.position)[1:]
    hang = np.array(left.com)[1:]
    others = [(b.mass, np.array(b.position)[1:] + np.array(b.com)[1:]) for b in (body, right)]
    mass = sum(m for m, _ in others)
    centre = sum((m * c for m, c in others), np.zeros(2)) / mass
    inertia = sum(b.inertia[0][0] for b in (body, right))
    inertia += sum(m * float((c - centre) @ (c - centre)) for m, c in others)
    reduced = mass * left.mass / (mass + left.mass)

    def rate(angle: float) -> float:
        c, s = np.cos(angle), np.sin(angle)
        swung = np.array([c * hang[0] - s * hang[1], s * hang[0] + c * hang[1]])
        away = pin + swung - centre
        about_its_centre = left.inertia[0][0]
        return -(about_its_centre + reduced * float(away @ swung)) / (
            inertia + about_its_centre + reduced * float(away @ away)
        )

    return float(quad(rate, 0.0, _RAISED, epsabs=1e-13)[0])


def fig_4_13() -> Result:
    """An asymmetric arm turns the body, and the principal axes in the body."""
    flown = raised()
    body = float(flown.landing.tilt)
    axes = principal_axes_along(flown).axes
    incline = float(np.arctan2(axes[-1, 2, 1], axes[-1, 1, 1]))
    whole = float(body + incline)
    where = "§4.4.1, Figure 4-13"
    turned = float(np.abs([flown.landing.somersault, flown.landing.twist]).max())
    claims = (
        statement(
            "fig4-13.control", where, "arm rotation in the air controls the orientation of the "
            "principal axes", "controlled", f"raising one arm by {_RAISED} rad without angular "
            f"momentum tilts them by {np.degrees(whole):.2f}°", abs(whole) > 0.01,
        ),
        statement(
            "fig4-13.sum", where, "the tilt of the principal axes is that of the body, by airborne "
            "reorientation, plus that in the body, by its asymmetry", "body tilt plus inclination",
            f"{np.degrees(body):.2f}° + {np.degrees(incline):.2f}° = {np.degrees(whole):.2f}°",
            abs(body) > 1e-3 and abs(incline) > 1e-3 and body * incline > 0,
            "Both have the same sign: the asymmetry raises the “gain”.",
        ),
        statement(
            "fig4-13.tilt", "§4.4.1", "body tilt from raising one arm, by conservation of angular "
            "momentum", "the body tilts against the arm",
            f"{body:.6f} rad flown, {planar_tilt():.6f} rad by quadrature",
            abs(planar_tilt() - body) < 1e-8,
            "A planar two-body quadrature, written separately, against the flight.",
        ),
        statement(
            "fig4-13.plane", where, "at the start the principal axes are the inertial ones",
            "aligned", f"to {np.abs(axes[0] - np.eye(3)).max():.0e}; somersault and twist stay "
            f"within {turned:.0e} rad", bool(np.abs(axes[0] - np.eye(3)).max() < 1e-9)
            and turned < 1e-9,
        ),
    )  # fmt: skip
    return Result(
        "The orientation of the principal axes can be controlled with arm rotation: on the right "
        "they are tilted by airborne reorientation of the body, and inclined in the body by its "
        "asymmetry.",
        f"Furrer raises his left arm from the thigh to {_RAISED} rad (the thesis prints no angle), "
        f"without angular momentum: the body tilts by {np.degrees(body):.2f}° and the principal "
        f"axes lean by another {np.degrees(incline):.2f}° in it. The lines beside the picture show "
        "these tilts three times as large.",
        claims,
        _draw_4_13(flown, body, incline),
        motion=Motion({"left arm raised": flown}, 0.2, {"charts": True, "camera": (0.0, 6.0)}),
    )


def _draw_4_13(flown: Flight, body: float, incline: float) -> Figure:
    from somersault.view import camera, draw_pose
    from somersault.view import style as look

    picture = look.figure(7.4, 4.2)
    ax = picture.add_subplot()
    seen = camera(0, 0)
    model = flown.system.model
    joints = flown.dataset["joint_angle"].values
    turns = matrix_from_quaternion(flown.dataset["quaternion"].values)
    for place, step in ((0.0, 0), (1.9, -1)):
        draw_pose(ax, model, joints[step], turns[step], seen, (place, 0.0))
        angle = 0.0 if step == 0 else body + incline
        for line, color, ls in ((0.0, look.GREY, ":"), (angle, look.VERMILION, "-")):
            for turn in (line, line + np.pi / 2):
                end = 1.15 * np.array([np.cos(turn), np.sin(turn)])
                ax.plot(
                    [place - end[0], place + end[0]],
                    [-end[1], end[1]],
                    color=color,
                    ls=ls,
                    lw=1.2,
                    zorder=8,
                )
    for row, (name, angle, color) in enumerate(
        (
            ("inertial axes", 0.0, look.GREY),
            ("body", body, look.BLUE),
            ("principal axes", body + incline, look.VERMILION),
        )
    ):
        way = np.array([-np.sin(3 * angle), np.cos(3 * angle)])
        base = np.array([3.5, -0.7])
        tip = base + (1.5 - 0.2 * row) * way
        ax.plot(*np.stack([base, tip]).T, color=color, lw=1.6)
        words = f"{name} {np.degrees(angle):.1f}°"
        look.label(ax, tip[0] + 0.06, tip[1], words, color)
    look.label(ax, 3.1, -0.9, "tilts, drawn three times as large", look.GREY)
    look.label(ax, 0, -1.3, "symmetric", ha="center")
    look.label(ax, 1.9, -1.3, "left arm raised in the air", ha="center")
    ax.set(xlim=(-1.2, 5.2), ylim=(-1.4, 1.3))
    ax.set_aspect("equal")
    ax.axis("off")
    return picture
