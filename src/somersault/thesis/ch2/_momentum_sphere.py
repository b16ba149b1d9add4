"""The map of rigid rotation: figures 2-7 and 2-8 (section 2.5)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault import attitude, rigid
from somersault import stability as st
from somersault._core.array import Array
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result
from somersault.thesis.ch2._inertia_ratios import random_bodies

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LAYOUT = "human_layout"
_EXAMPLE = (np.radians(3.0), 0.0)  # tilt and twist of the body in figure 2-7
AXES = ("front-to-back", "side-to-side", "head-to-toe")


def minor_share(inertias: Array) -> float:
    """Share of the sphere's area in which h circles the minor axis: 2δ/π."""
    low, middle, high = np.sort(inertias)
    delta = np.arctan2(np.sqrt(1 / low - 1 / middle), np.sqrt(1 / middle - 1 / high))
    return float(2 * delta / np.pi)


def fig_2_7() -> Result:
    """The map for the rigid athlete in layout."""
    inertias = st.principal_inertias(_LAYOUT)
    low, middle, high = rigid.energy_bounds(inertias, 1.0)
    return Result(
        "A map of rigid body rotation for a human in the layout position: the angular momentum "
        "draws curves of constant energy on a sphere that turns with the body.",
        f"The same for human_layout. Energies over h² lie between {low:.4f} and {high:.4f} "
        f"1/(kg m²), with the separatrix at {middle:.4f}; curves around the head-to-toe axis take "
        f"{100 * minor_share(inertias):.0f} % of the sphere, and those around the front-to-back "
        "axis the narrow lunes between them. The black dot is the printed example, Θ = 3°, Ψ = 0.",
        (*_bound_claims(inertias), *_kind_claims(inertias), *_curve_claims(inertias)),
        map_with_example(inertias, "human_layout held rigid"),
    )


def map_with_example(inertias: Array, title: str) -> Figure:
    from somersault.view import camera, sphere
    from somersault.view import style as look

    picture = sphere.sphere_map(inertias, sphere.energies(inertias, 6), title)
    ball, chart = picture.axes
    chart.plot(np.degrees(_EXAMPLE[1]), np.degrees(_EXAMPLE[0]), "o", color=look.BLACK, ms=5)
    spot = camera(*sphere.VIEW) @ rigid.momentum_direction(*_EXAMPLE)
    ball.plot(spot[0], spot[1], "o", color=look.BLACK, ms=5, zorder=9)
    return picture


def _bound_claims(inertias: Array) -> list[Claim]:
    chance = np.random.default_rng(27)
    bodies = random_bodies()
    c = chance.normal(size=bodies.shape)
    c /= np.linalg.norm(c, axis=1, keepdims=True)
    energy = np.sum(c * c / bodies, 1) / 2
    least, most = (1 / (2 * x) for x in (bodies.max(1), bodies.min(1)))
    within = bool(np.all((least <= energy) & (energy <= most)))
    low, middle, high = rigid.energy_bounds(inertias, 1.0)
    poles = np.sort(1 / (2 * inertias))
    curves = rigid.separatrix(inertias)
    on = float(np.abs(np.sum(curves**2 / inertias, -1) / 2 / middle - 1).max())
    return [
        statement(
            "fig2-7.bounds", "§2.5", "h²/2I_max ≤ T ≤ h²/2I_min", "bounded so",
            f"so for {len(bodies)} random bodies and attitudes, equal in pure spins",
            within and bool(np.allclose([low, middle, high], poles, rtol=1e-14)),
        ),
        statement(
            "fig2-7.separatrix", "§2.5", "the dividing curve has the energy of the spin about the "
            "middle axis, h²/2I_mid", "h²/2I_mid",
            f"two great circles through that axis; on them the energy differs by {on:.0e}",
            on < 1e-12 and bool(np.allclose(np.abs(curves[:, 0, 1]), 1)),
        ),
    ]  # fmt: skip


def _kind_claims(inertias: Array) -> list[Claim]:
    """Exact motions from random attitudes, over several periods."""
    chance = np.random.default_rng(28)
    minor = major = 0
    good_minor = good_major = True
    for c in chance.normal(size=(60, 3)) * [1, 1, 0.15]:
        motion = rigid.RigidMotion(inertias, c / inertias)
        times = np.linspace(0, 3 * motion.period, 400)
        twist = motion.momentum_angles(times)[:, 2]
        if motion.energy * inertias[1] * 2 > np.sum(c * c):
            minor += 1
            good_minor &= bool(np.all(np.diff(twist) > 0) or np.all(np.diff(twist) < 0))
        else:
            major += 1
            turned = np.sin(twist)  # between 0 and ±π: of one sign
            bounded = np.ptp(twist) < np.pi
            good_major &= bounded and bool(np.all(turned > 0) or np.all(turned < 0))
    return [
        statement(
            "fig2-7.monotonic", "§2.5", "with more energy than the separatrix's the twist is "
            "monotonic", "monotonic", f"so in all {minor} exact motions of that kind",
            good_minor and minor > 10,
        ),
        statement(
            "fig2-7.oscillatory", "§2.5", "with less, it oscillates between 0 and ±π", "between 0 "
            "and π, or 0 and −π", f"so in all {major} exact motions of that kind",
            good_major and major > 10,
        ),
        statement(
            "fig2-7.axes", "§2.5, Figure 2-7", "in layout the minor axis is head-to-toe, and the "
            "middle one, where curves converge and diverge, the somersault axis",
            "head-to-toe, side-to-side",
            f"{AXES[int(np.argmin(inertias))]}, {AXES[int(np.argsort(inertias)[1])]}",
            int(np.argmin(inertias)) == 2 and int(np.argsort(inertias)[1]) == 1,
        ),
    ]  # fmt: skip


def _curve_claims(inertias: Array) -> list[Claim]:
    c = rigid.momentum_direction(*_EXAMPLE)
    motion = rigid.RigidMotion(inertias, c / inertias)
    times = np.linspace(0, motion.period, 500)
    path = motion.omega(times) * inertias
    off = float(np.abs(np.sum(path**2, 1) - 1).max())
    ellipsoid = float(np.abs(np.sum(path**2 / inertias, 1) / (2 * motion.energy) - 1).max())
    low, _, high = rigid.energy_bounds(inertias, 1.0)
    return [
        statement(
            "fig2-7.intersection", "§2.5", "the body follows the intersection of the momentum "
            "sphere and the energy ellipsoid", "follows it",
            f"the exact motion from the printed attitude, on both to {max(off, ellipsoid):.0e}",
            max(off, ellipsoid) < 1e-12,
        ),
        statement(
            "fig2-7.example", "Figure 2-7", "the attitude shown, Θ = 3°, Ψ = 0, lies on a curve "
            "of the map", "one energy",
            f"T/h² = {motion.energy:.5f}: round the {motion.kind} axis, twist "
            f"{'monotonic' if motion.monotonic_twist else 'oscillating'}",
            low < motion.energy < high,
        ),
    ]  # fmt: skip


def fig_2_8() -> Result:
    """Tilt and twist as latitude and longitude."""
    chance = np.random.default_rng(29)
    tilt, twist = chance.uniform(-1.5, 1.5, 500), chance.uniform(-np.pi, np.pi, 500)
    cosines = attitude.direction_cosines(0.7, tilt, twist)[:, :, 1]
    printed = np.stack(
        [np.sin(twist) * np.cos(tilt), np.cos(twist) * np.cos(tilt), -np.sin(tilt)], -1
    )
    off = float(np.abs(cosines - printed).max())
    latitude = np.arcsin(cosines[:, 2])
    # Longitude from axis 2, positive about axis 3: towards −1.
    longitude = np.arctan2(-cosines[:, 0], cosines[:, 1])
    read = max(float(np.abs(latitude + tilt).max()), float(np.abs(longitude + twist).max()))
    where = "§2.5, Figure 2-8"
    claims = (
        statement(
            "fig2-8.cosines", where, "c1, c2, c3 = SΨ CΘ, CΨ CΘ, −SΘ", "as printed",
            f"the second column of C_bi to {off:.0e}", off < 1e-14,
        ),
        statement(
            "fig2-8.angles", where, "tilt is minus the latitude of the angular momentum in the "
            "body, twist minus its longitude", "Θ = −latitude, Ψ = −longitude",
            f"so to {read:.0e} for 500 random attitudes", read < 1e-12,
        ),
    )  # fmt: skip
    return Result(
        "The spherical coordinates of the angular momentum in the body are the negatives of tilt "
        "and twist.",
        "Longitude is counted from axis 2, positive about axis 3. So A.20 must read "
        "Θ = −sin⁻¹(I3 ω3/h) (errata).",
        claims,
        _draw_2_8(),
    )


def _draw_2_8() -> Figure:
    from matplotlib.patches import Circle

    from somersault.view import camera
    from somersault.view import style as look

    picture = look.figure(5.0, 4.8)
    ax = picture.add_subplot()
    seen = camera(25, 24)
    ax.add_patch(Circle((0, 0), 1, fc=look.PALE, ec=look.GREY, lw=0.8))
    turn = np.linspace(0, 2 * np.pi, 200)
    equator = np.stack([np.sin(turn), np.cos(turn), 0 * turn], -1) @ seen.T
    for front in (True, False):
        shown = np.where(((equator[:, 2] > 0) == front)[:, None], equator[:, :2], np.nan)
        ax.plot(*shown.T, color=look.GREY, lw=1.0 if front else 0.5, ls="-" if front else ":")
    for axis, name in enumerate(("1", "2", "3")):
        x, y = (float(c) for c in 1.35 * seen[:2, axis])
        ax.annotate("", (x, y), (0, 0), arrowprops={"arrowstyle": "-|>", "color": look.GREEN})
        look.label(ax, 1.08 * x, 1.08 * y, name, look.GREEN, ha="center")
    tilt, twist = np.radians([-40.0, 50.0])
    spot = seen @ rigid.momentum_direction(tilt, twist)
    foot = seen @ rigid.momentum_direction(0.0, twist)
    share = np.linspace(0, 1, 50)
    for arc, color in (
        (rigid.momentum_direction(0.0, share * twist), look.VERMILION),
        (rigid.momentum_direction(share * tilt, twist), look.BLUE),
    ):
        ax.plot(*(arc @ seen[:2].T).T, color=color, lw=2.4)
    ax.plot([0, foot[0]], [0, foot[1]], color=look.GREY, lw=0.8, ls="--")
    arrow = {"arrowstyle": "-|>", "lw": 2, "color": look.BLACK}
    ax.annotate("", (float(spot[0]), float(spot[1])), (0, 0), arrowprops=arrow)
    look.label(ax, spot[0] - 0.05, spot[1] + 0.12, "h", fontsize=12, ha="right")
    half = seen @ rigid.momentum_direction(0.0, 0.5 * twist)
    look.label(
        ax, half[0], half[1] - 0.14, "longitude −Ψ (here twist Ψ > 0)", look.VERMILION, ha="center"
    )
    up = seen @ rigid.momentum_direction(0.5 * tilt, twist)
    look.label(ax, up[0] + 0.08, up[1], "latitude −Θ\n(here tilt Θ < 0)", look.BLUE)
    ax.set(xlim=(-1.5, 1.6), ylim=(-1.3, 1.5))
    ax.set_aspect("equal")
    ax.axis("off")
    return picture
