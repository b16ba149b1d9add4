"""Table 3.1 and figure 3-3: the robot's masses and its map of rotation."""

from __future__ import annotations

from functools import cache

import numpy as np

from somersault import rigid
from somersault._core.array import Array
from somersault.dynamics import Equations
from somersault.model import load
from somersault.robot import Robot
from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch2._momentum_sphere import minor_share

_RETRACTED, _EXTENDED = 0.647, 0.862
_T31 = "§3.4, Table 3.1"


@cache
def inertia(length: float) -> Array:
    """Of the robot about its centre of mass with straight legs of a length, (3, 3), kg m²."""
    model = load("biped")
    slides = [name.endswith("_leg") for name in model.coordinates]
    found: Array = Equations(model).inertia(np.where(slides, length - _RETRACTED, 0.0))
    return found


def table_3_1() -> Result:
    """The 3D Biped's parameters."""
    model, machine = load("biped"), Robot().machine
    short, long = (float(inertia(length)[1, 1]) for length in (_RETRACTED, _EXTENDED))
    lower = next(body for body in model.bodies if body.name == "left_lower_leg")
    shortest = _RETRACTED - machine.offset
    m_l, i_o = machine.lower_leg / 2, machine.inertia
    claims = (
        number("table3-1.mass", _T31, "total mass", 31.44, model.mass, "kg", 0.005),
        number("table3-1.lower-leg", _T31, "lower leg mass", 0.652, lower.mass, "kg", 5e-4),
        number(
            "table3-1.inertia", _T31, "somersault inertia but for the lower legs' distance, I_o",
            1.02, i_o, "kg m2", 0.005, "From the mass matrix with straight legs, less 2 m_l r².",
        ),
        number(
            "table3-1.radius", _T31, "least radius of the lower leg, r_min", 0.404, shortest, "m",
            5e-4,
        ),
        number(
            "table3-1.retracted", "§3.3", "somersault inertia with legs retracted", 1.22, short,
            "kg m2", 0.015, "I_o + 2 m_l r_min² of the same table is 1.233.",
        ),
        number(
            "table3-1.extended", "§3.3", "somersault inertia with legs fully extended", 1.50, long,
            "kg m2", 0.025, "I_o + 2 m_l r² of the same table is 1.520.",
        ),
        number(
            "table3-1.ratio", "§3.3", "from retracted to extended legs the somersault rate falls "
            "to a part of its initial value", 0.81, short / long, "1", 0.005,
        ),
        number(
            "table3-1.formula", "§3.3.1", "the inertia is I_o + 2 m_l r² with legs extended",
            i_o + 2 * m_l * (_EXTENDED - machine.offset) ** 2, long, "kg m2", 1e-3,
            "What is left is how far the centre of mass moves as the legs extend.",
        ),
        statement(
            "table3-1.com", "§3.3.1", "the centre of mass moves very little as the legs extend",
            "very little", f"{1e3 * _com_shift():.1f} mm for {1e3 * (_EXTENDED - _RETRACTED):.0f} "
            "mm of leg", _com_shift() < 0.05 * (_EXTENDED - _RETRACTED),
        ),
    )  # fmt: skip
    rows = (
        ("m", "total mass", "31.44 kg", f"{model.mass:.2f}"),
        ("m_l", "lower leg mass", "0.652 kg", f"{lower.mass:.3f}"),
        ("I_o", "somersault inertia", "1.02 kg m²", f"{i_o:.3f}"),
        ("r_min", "least lower leg radius", "0.404 m", f"{shortest:.3f}"),
        ("l_min", "least leg length", "0.647 m", f"{_RETRACTED:.3f}"),
        ("l_max", "greatest leg length", "0.862 m", f"{_EXTENDED:.3f}"),
    )
    return Result(
        "Mass properties of the 3D Biped.",
        "The model `biped` that ships with the package; what the thesis does not give is named in "
        "its file.",
        claims,
        table=Table(("symbol", "description", "thesis", "ours"), rows),
    )


def _com_shift() -> float:
    """How far the centre of mass moves as the legs extend, m."""
    from somersault.model import centre_of_mass

    model = load("biped")
    slides = np.array([name.endswith("_leg") for name in model.coordinates])
    ends = [centre_of_mass(model, slides * x) for x in (0.0, _EXTENDED - _RETRACTED)]
    return float(np.linalg.norm(ends[1] - ends[0]))


def separatrix_angle(inertias: Array) -> float:
    """The least angle between the major axis and the separatrix, rad."""
    low, middle, high = np.sort(inertias)
    return float(np.arctan(np.sqrt((1 / middle - 1 / high) / (1 / low - 1 / middle))))


def fig_3_3() -> Result:
    """The map with the legs fully extended."""
    from somersault.view import sphere

    whole = inertia(_EXTENDED)
    inertias = np.diag(whole)
    share = 1 - minor_share(inertias)
    chance = np.random.default_rng(33)
    worst, stays = 0.0, True
    for turn in chance.uniform(0, 2 * np.pi, 40):
        c = np.array([0.2 * np.sin(turn), np.cos(0.2), 0.2 * np.cos(turn)])
        motion = rigid.RigidMotion(inertias, c / inertias)
        path = motion.omega(np.linspace(0, motion.period, 300)) * inertias
        away = np.arccos(np.clip(path[:, 1] / np.linalg.norm(path, axis=1), -1, 1)).max()
        worst, stays = max(worst, float(away)), stays and motion.kind == "major"
    where = "§3.2, Figure 3-3"
    edge = separatrix_angle(inertias)
    off = float(np.abs(whole - np.diag(inertias)).max())
    claims = (
        statement(
            "fig3-3.major", where, "the somersault axis is coincident with the major principal "
            "axis", "major", f"{inertias[1]:.3f} of {inertias[0]:.3f}, {inertias[1]:.3f}, "
            f"{inertias[2]:.3f} kg m², products below {max(off, 1e-12):.0e}",
            int(np.argmax(inertias)) == 1 and off < 1e-9,
            "Roll and yaw inertia are assumptions, chosen so; the pitch inertia is the thesis's.",
        ),
        statement(
            "fig3-3.minor", where, "with the legs fully extended the minor principal axis is the "
            "head-to-toe axis", "head to toe", f"I3 = {inertias[2]:.3f} kg m² is the least",
            int(np.argmin(inertias)) == 2,
        ),
        statement(
            "fig3-3.large", where, "the region of stable rotation about the somersault axis is "
            "large", "large", f"the momentum may be {np.degrees(edge):.0f}° off before it is left; "
            f"{100 * share:.0f} % of the sphere", bool(edge > np.radians(15)),
            "Held against the 15° of tilt at which balance can still be regained (§3.4).",
        ),
        statement(
            "fig3-3.stays", "§3.2", "begun with the momentum close to the major axis, it remains "
            "close to it", "remains close", f"all 40 exact motions from {np.degrees(0.2):.1f}° off "
            f"circle it, at most {np.degrees(worst):.1f}° away", stays and worst < np.radians(30),
        ),
    )  # fmt: skip
    return Result(
        "The 3D Biped's somersault axis is its major principal axis; the region of stable rotation "
        "about it is large.",
        f"The model `biped` with legs of {_EXTENDED} m. Curves around its major axis take "
        f"{100 * share:.0f} % of the sphere.",
        claims,
        sphere.sphere_map(inertias, sphere.energies(inertias, 6), "biped, legs extended"),
    )
