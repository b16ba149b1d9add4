"""The square of inertia ratios, and which spins in it are stable: figures 2-2 to 2-4."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault import rigid
from somersault._core.array import Array
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STABLE = 1e-6  # growth rates up to this, in units of Φ̇, count as none


def random_bodies(count: int = 2000) -> Array:
    """Principal inertias (count, 3) of clouds of point masses, of any proportions."""
    chance = np.random.default_rng(2)
    spread = 10 ** chance.uniform(-1.3, 0, (count, 3))
    second = spread * chance.uniform(0.2, 1, (count, 3))
    return second.sum(1, keepdims=True) - second


def roots(inertias: Array, damping: float = 0.0) -> Array:
    """The four roots s/Φ̇ (…, 4) of eq. 2.11, by eigenvalues of its first-order form."""
    m, g, k = rigid.gyric_matrices(*np.moveaxis(inertias, -1, 0))
    drag = damping * np.eye(2) * inertias[..., :1, None]
    inverse = np.linalg.inv(m)
    first = np.zeros((*inertias.shape[:-1], 4, 4))
    first[..., :2, 2:] = np.eye(2)
    first[..., 2:, :2] = -inverse @ k
    first[..., 2:, 2:] = -inverse @ (g + drag)
    return np.linalg.eigvals(first).astype(complex)


def fig_2_2() -> Result:
    """Which quadrant means what, with prisms."""
    bodies = random_bodies()
    one, two, three = bodies.T
    quadrants = rigid.quadrant(*rigid.inertia_ratios(one, two, three))
    wanted = {
        1: (two > one) & (two > three),
        2: (three > two) & (two > one),
        3: (two < one) & (two < three),
        4: (one > two) & (two > three),
    }
    words = {1: "I2 largest", 2: "I1 < I2 < I3", 3: "I2 smallest", 4: "I3 < I2 < I1"}
    claims = tuple(
        statement(
            f"fig2-2.quadrant-{number}",
            "Figure 2-2",
            f"quadrant {number} of the diagram is that of bodies with {words[number]}",
            words[number],
            f"so for {int((quadrants == number).sum())} random bodies in it, and no others",
            bool(
                np.array_equal(quadrants == number, wanted[number]) and (quadrants == number).any()
            ),
        )
        for number in (1, 2, 3, 4)
    )
    return Result(
        "The inertia ratio diagram: how k1 and k3 depend on which of the principal inertias is "
        "larger, with rectangular prisms of about those ratios.",
        "Each prism is the box of uniform density that has exactly the ratios of the dot beside "
        "it; the somersault axis 2 runs from side to side.",
        claims,
        _draw_2_2(),
    )


def _draw_2_2() -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(6.4, 6.2)
    ax = picture.add_subplot()
    charts.square(ax)
    ax.set(xlabel="$k_1 = (I_2 - I_3)/I_1$", ylabel="$k_3 = (I_2 - I_1)/I_3$")
    spots = [(a, b) for a in (-0.86, -0.43, 0.43, 0.86) for b in (-0.8, 0.8)]
    spots += [(a, b) for a in (-0.72, 0.72) for b in (-0.28, 0.28)] + [(0.0, 0.0)]
    for k1, k3 in spots:
        ax.plot(k1, k3, ".", color=look.VERMILION, ms=5, zorder=7)
        _prism(ax, k1, k3)
    for x, y, text in (
        (0.5, 0.5, "1: $I_2$ largest"),
        (-0.5, 0.5, "2: $I_1 < I_2 < I_3$"),
        (-0.5, -0.5, "3: $I_2$ smallest"),
        (0.5, -0.5, "4: $I_3 < I_2 < I_1$"),
    ):
        look.label(ax, x, y, text, look.BLUE, ha="center", fontsize=11)
    return picture


def _prism(ax: Axes, k1: float, k3: float) -> None:
    """The uniform box with these ratios, next to its point."""
    from matplotlib.patches import Polygon

    from somersault.view import camera
    from somersault.view import style as look

    i = rigid.inertias_from_ratios(k1, k3)
    sides = np.sqrt(np.maximum(i.sum() / 2 - i, 0.0))
    sides = 0.2 * sides / np.linalg.norm(sides)
    seen = camera(35, 22)
    for axis in np.argsort(seen[2]):
        others = [k for k in range(3) if k != axis]
        corners = np.zeros((4, 3))
        corners[:, axis] = sides[axis] / 2
        corners[:, others] = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]]) * sides[others] / 2
        flat = corners @ seen[:2].T + [k1, k3 + (0.13 if k3 < 0 else -0.13)]
        shade = ("#8fb8de", "#bcd6ec", "#e6eff8")[axis]
        ax.add_patch(Polygon(flat, fc=shade, ec=look.BLACK, lw=0.6, zorder=6))


def fig_2_3() -> Result:
    """Where the simple spin is stable."""
    ratios = np.round(np.linspace(-0.99, 0.99, 100), 12)
    k1, k3 = np.meshgrid(ratios, ratios)
    grows = roots(rigid.inertias_from_ratios(k1, k3)).real.max(-1)
    stable = grows <= STABLE
    same = k1 * k3 > 0
    wrong = int((stable != same).sum())
    claims = (
        statement(
            "fig2-3.quadrants",
            "§2.3.2, Figure 2-3",
            "the spin is stable in the first and third quadrants and nowhere else",
            "k1 and k3 of the same sign",
            f"by the eigenvalues of eq. 2.11 at {stable.size} points, {wrong} of them otherwise",
            wrong == 0,
        ),
    )
    return Result(
        "The spin about axis 2 is stable where k1 and k3 have the same sign.",
        f"It is, at all {stable.size} points of a grid, by the roots of equation 2.11.",
        claims,
        _draw_2_3(ratios, stable),
    )


def _draw_2_3(ratios: Array, stable: Array) -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(4.8, 4.7)
    ax = picture.add_subplot()
    charts.square(ax)
    charts.filled(ax, ratios, ratios, stable)
    ax.set(xlabel="$k_1$", ylabel="$k_3$")
    for x, y, text in (
        (0.5, 0.5, "stable:\nmajor axis,\nstatically"),
        (-0.5, -0.5, "stable:\nminor axis,\ngyrically"),
        (-0.5, 0.5, "unstable:\nmiddle axis"),
        (0.5, -0.5, "unstable:\nmiddle axis"),
    ):
        look.label(ax, x, y, text, ha="center", fontsize=11)
    return picture


def fig_2_4() -> Result:
    """Curves of equal growth."""
    ratios = np.linspace(0.02, 0.98, 49)
    k1, k3 = np.meshgrid(ratios, -ratios)
    rate = roots(rigid.inertias_from_ratios(k1, k3)).real.max(-1)
    angle = np.log(10) / rate
    closed = rigid.growth_angle(k1, k3)
    off = float(np.abs(angle / closed - 1).max())
    other = roots(rigid.inertias_from_ratios(-k1, -k3)).real.max(-1)
    uneven = float(np.abs(other / rate - 1).max())
    corner = np.unravel_index(np.argmin(angle), angle.shape)
    at = (float(k1[corner]), float(k3[corner]))
    where = "Figure 2-4"
    claims = (
        statement(
            "fig2-4.curves",
            "eq. 2.14, Figure 2-4",
            "bodies with the same k1 k3 have an unstable mode of the same growth: tenfold in "
            "Φ = ln 10/√(−k1 k3)",
            "eq. 2.14",
            f"the eigenvalues of eq. 2.11 at {angle.size} points agree to {off:.0e}",
            off < 1e-9,
        ),
        statement(
            "fig2-4.corners",
            where,
            "the most unstable systems are in the corners {1, −1} and {−1, 1}",
            "{1, −1} and {−1, 1}",
            f"least Φ of the grid, {angle.min():.3f} rad, at {{{at[0]:.2f}, {at[1]:.2f}}}; "
            f"{rigid.growth_angle(1.0, -1.0):.4f} rad in the corner",
            at == (float(ratios[-1]), float(-ratios[-1])),
        ),
        statement(
            "fig2-4.symmetric",
            where,
            "the plot is symmetric about the origin",
            "symmetric",
            f"growth at (k1, k3) and (−k1, −k3) differs by {uneven:.0e}",
            uneven < 1e-9,
        ),
    )
    return Result(
        "Curves of constant Φ, the somersault angle in which the unstable mode grows tenfold. The "
        "most unstable systems are those in the corners {1, −1} and {−1, 1}.",
        "The numbers that the thesis writes on its curves are not in its text; the curves here are "
        f"of round angles. The least there can be is ln 10 = {np.log(10):.3f} rad, 0.37 of a "
        "somersault, in the corner.",
        claims,
        _draw_2_4(),
    )


def _draw_2_4() -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(5.4, 5.2)
    ax = picture.add_subplot()
    charts.square(ax)
    ax.set(xlabel="$k_1$", ylabel="$k_3$")
    angles = (2.5, 3.0, 3.5, 4.0, 5.0, 7.0, 10.0, 20.0)
    x = np.linspace(1e-3, 1, 800)
    for angle in angles:
        product = (np.log(10) / angle) ** 2
        for sign in (1, -1):
            ax.plot(
                sign * x[x > product], -sign * product / x[x > product], color=look.BLUE, lw=1.2
            )
            middle = np.sqrt(product)
            look.label(
                ax, sign * middle, -sign * middle, f"{angle:g}", look.BLUE, ha="center",
                bbox={"fc": "white", "ec": "none", "pad": 0.8},
            )  # fmt: skip
    for x0, y0 in ((0.5, 0.5), (-0.5, -0.5)):
        look.label(ax, x0, y0, "stable:\nnothing grows", look.GREY, ha="center")
    ax.set_title("Somersault angle (rad) of a tenfold growth")
    return picture
