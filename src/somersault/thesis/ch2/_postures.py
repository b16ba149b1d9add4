"""Tuck, pike and layout: figures 2-5 and 2-6."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault import rigid
from somersault import stability as st
from somersault._core.array import Array
from somersault.dynamics import Equations
from somersault.model import Model, athlete, load, named_pose, pose
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

POSTURES = ("tuck", "pike", "layout")


def fig_2_5() -> Result:
    """The three postures."""
    rows = []
    for name in POSTURES:
        inertias = st.principal_inertias(f"human_{name}")
        k1, k3 = rigid.inertia_ratios(*inertias)
        rows.append((name, *(f"{x:.3f}" for x in inertias), f"{k1:.3f}", f"{k3:.3f}"))
    return Result(
        "A human in the tuck, pike and layout positions.",
        "The three rigid athletes that come with the package: the average man of de Leva (1996). "
        "The thesis does not print the dimensions of its athlete.",
        (),
        _draw_2_5(),
        Table(("posture", "I1 kg m²", "I2 (somersault)", "I3", "k1", "k3"), tuple(rows)),
    )


def _draw_2_5() -> Figure:
    from somersault.view import camera, draw_pose
    from somersault.view import style as look

    picture = look.figure(7.2, 3.6)
    ax = picture.add_subplot()
    for place, name in enumerate(POSTURES):
        model = load(f"human_{name}")
        x = 1.35 * place
        draw_pose(ax, model, model.home, np.eye(3), camera(62, 10), (x, 0.0))
        look.label(ax, x, -1.25, name, ha="center", fontsize=11)
    ax.set(xlim=(-0.7, 3.5), ylim=(-1.35, 1.15))
    ax.set_aspect("equal")
    ax.axis("off")
    return picture


@cache
def _spin(name: str) -> st.Spin:
    """The athlete's somersault in a posture."""
    return st.spin(_athlete(), 2, named_pose(_athlete(), name))


def fig_2_6() -> Result:
    """Their inertia ratios, and a path between them."""
    claims = []
    for name in POSTURES:
        spin = _spin(name)
        ratios = spin.inertia_ratios
        quadrant = int(rigid.quadrant(ratios["k1"], ratios["k3"]))
        stable = spin.linear(lock=["all"]).stable
        wanted, where = (False, 4) if name == "layout" else (True, 1)
        claims.append(
            statement(
                f"fig2-6.{name}",
                "§2.4, Figure 2-6",
                f"a rigid {name} somersault is {'stable' if wanted else 'unstable'}: quadrant "
                f"{where}",
                f"{'stable, upper' if wanted else 'unstable, lower'} right quadrant",
                f"{'stable' if stable else 'unstable'}, quadrant {quadrant}: k1 "
                f"{ratios['k1']:.3f}, k3 {ratios['k3']:.3f}",
                stable == wanted and quadrant == where,
                "An athlete made from de Leva (1996); the thesis's own measures are not printed.",
            )
        )
    tilted = max(
        float(np.abs(_spin(name).principal_axes[:, 1] - [0, 1, 0]).max()) for name in POSTURES
    )
    claims.append(
        statement(
            "fig2-6.axis",
            "§2.4",
            "I2 is the principal inertia along the somersault axis",
            "axis 2 is principal",
            f"in all three postures, to {tilted:.0e}",
            tilted < 1e-9,
        )
    )
    share, path = _path()
    leaves = float(share[np.argmax(path[1] < 0)])
    return Result(
        "Inertia ratios of a performer moving from tuck through pike to layout. Tuck and pike are "
        "stable as rigid bodies, layout is not.",
        "They are, for an athlete of the average man's size (1.741 m, 73 kg; de Leva 1996), knees "
        "bent in the tuck. Between the postures the joint angles are interpolated (the thesis does "
        "not print its own sequence); on that path the body crosses "
        f"from stable to unstable {100 * (leaves - 1):.0f} % of the way from pike to layout, where "
        "I2 falls below I1.",
        tuple(claims),
        _draw_2_6(path),
    )


@cache
def _athlete() -> Model:
    """The gymnast of the average man's size, with knees, whose poses the rigid postures are."""
    return athlete(1.741, 73.0, knees=True)


@cache
def _path(count: int = 60) -> tuple[Array, Array]:
    """Share 0 (tuck), 1 (pike), 2 (layout), and k1, k3 (2, …) along it."""
    share = np.linspace(0, 2, 2 * count + 1)
    postures = [named_pose(_athlete(), name) for name in POSTURES]
    angles = {
        joint: np.interp(share, [0, 1, 2], [at[joint] for at in postures]) for joint in postures[0]
    }
    ratios = []
    axes = np.eye(3)
    for whole in Equations(_athlete()).inertia(pose(_athlete(), angles)):
        values, vectors = np.linalg.eigh(whole)
        # Followed from one posture to the next: near pike the axes lean by almost 45°.
        match = np.argmax(np.abs(vectors.T @ axes), 0)
        axes = vectors[:, match]
        ratios.append(rigid.inertia_ratios(*values[match]))
    return share, np.array(ratios).T


def _draw_2_6(path: Array) -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(5.2, 5.0)
    ax = picture.add_subplot()
    charts.square(ax)
    charts.filled(ax, [0, 1], [0, 1], np.ones((2, 2)), edge=None, alpha=0.35)
    charts.filled(ax, [-1, 0], [-1, 0], np.ones((2, 2)), edge=None, alpha=0.35)
    ax.set(xlabel="$k_1$", ylabel="$k_3$")
    ax.plot(*path, color=look.VERMILION, lw=1.6)
    spots = {"tuck": (0.25, 0.2), "pike": (0.75, 0.75), "layout": (0.35, -0.75)}
    for name, place in spots.items():
        k1, k3 = rigid.inertia_ratios(*_spin(name).principal_inertias)
        ax.plot(k1, k3, "o", color=look.VERMILION, ms=7, zorder=6)
        look.pointer(ax, (float(k1), float(k3)), place, name, fontsize=11)
    look.label(ax, 0.04, 0.93, "stable", look.BLUE)
    look.label(ax, 0.04, -0.93, "unstable", look.GREY)
    look.label(ax, -0.96, -0.93, "stable", look.BLUE)
    return picture
