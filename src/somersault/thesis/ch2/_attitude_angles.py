"""Figure 2-1: somersault, tilt and twist, one after the other."""

from __future__ import annotations

import numpy as np

from somersault import attitude
from somersault._core.array import Array
from somersault.model import load
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result


def fig_2_1() -> Result:
    """Somersault, tilt and twist, one after the other."""
    from somersault.view import camera, draw_pose
    from somersault.view import style as look

    steps = ((0, 0, 0), (50, 0, 0), (50, 25, 0), (50, 25, 70))
    names = (
        "parallel to the\ninertial axes",
        "somersault Φ = 50°\nabout the fixed 2 axis",
        "then tilt Θ = 25°\nabout the body's 1 axis",
        "then twist Ψ = 70°\nabout the body's 3 axis",
    )
    picture = look.figure(8.4, 3.2)
    ax = picture.add_subplot()
    model = load("human_layout")
    seen = camera(38, 14)
    colors = (look.VERMILION, look.GREEN, look.BLUE)
    errors = []
    for place, (degrees, name) in enumerate(zip(steps, names, strict=True)):
        turns = np.radians(degrees)
        turn = attitude.direction_cosines(*turns).T
        errors.append(np.abs(turn - _turn(2, turns[0]) @ _turn(1, turns[1]) @ _turn(3, turns[2])))
        x = 2.6 * place
        draw_pose(ax, model, model.home, turn, seen, (x, 0.0))
        for axis, color in enumerate(colors):
            tip = seen[:2] @ turn[:, axis] * 1.25
            ax.annotate(
                "",
                (x + tip[0], tip[1]),
                (x, 0),
                zorder=8,
                arrowprops={"arrowstyle": "-|>", "color": color, "lw": 1.3},
            )
            look.label(ax, x + 1.12 * tip[0], 1.12 * tip[1], str(axis + 1), color, ha="center")
        look.label(ax, x, -1.75, name, ha="center")
    ax.set(xlim=(-1.5, 9.3), ylim=(-2.1, 1.6))
    ax.set_aspect("equal")
    ax.axis("off")
    claim = statement(
        "fig2-1.sequence",
        "§2.2, Figure 2-1",
        "the attitude is a turn about the inertial 2 axis, then about the carried 1 axis, then "
        "about the body's 3 axis",
        "2-1-3",
        f"the product of the three turns is eq. 2.2 to {np.max(errors):.0e}",
        np.max(errors) < 1e-14,
    )
    return Result(
        "The somersault, tilt and twist sequence that describes the body's attitude.",
        "The same on the rigid athlete human_layout, with body axes 1 (front), 2 (left), 3 (head).",
        (claim,),
        picture,
    )


def _turn(axis: int, angle: float) -> Array:
    """The turn by an angle about axis 1, 2 or 3 (3, 3)."""
    i, j = (axis % 3, (axis + 1) % 3)
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = np.cos(angle)
    matrix[j, i], matrix[i, j] = np.sin(angle), -np.sin(angle)
    return matrix
