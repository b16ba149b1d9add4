"""Section 4.3: the edges of the 5-, 3- and 2-d.o.f. regions at a dozen arm angles."""

from __future__ import annotations

import numpy as np

from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import (
    GROWS,
    HIGH,
    LOW,
    THREE,
    TWO,
    Edges,
    edges,
    searched,
    shown,
    undivided_growth,
)
from somersault.thesis.ch4._stability_regions import REFERENCE

ANGLES = np.round(np.arange(0.4, 2.61, 0.2), 1)
Ranges = list[list[tuple[float, float]]]


def sec_4_3() -> Result:
    """Edges found by searching, in closed form, and from the undivided system."""
    edge = edges(ANGLES)
    three, two = searched(THREE, ANGLES), searched(TWO, ANGLES)
    five = [_overlap(a, b) for a, b in zip(three, two, strict=True)]
    claims = [
        *_reference(five),
        *(_five(angle, ranges) for angle, ranges in zip(ANGLES, five, strict=True)),
        *(_positive(angle, ranges) for angle, ranges in zip(ANGLES, five, strict=True)),
        *_three(three, edge),
        *_two(two, edge),
    ]
    rows = tuple(
        (f"{angle:.1f}", shown(a), shown(b), shown(c))
        for angle, a, b, c in zip(ANGLES, five, three, two, strict=True)
    )
    return Result(
        "Which shoulder springs make the layout somersault stable at each arm angle (figures 4-9, "
        "4-10 and 4-11 hold these numbers as pictures).",
        "Each edge is located by bisection, and again without a search: for the 3-d.o.f. system "
        "from its characteristic polynomial, for the 2-d.o.f. system in closed form, and for the "
        "5-d.o.f. system from all ten roots of the undivided equations.",
        tuple(claims),
        table=Table(("Γ (rad)", "5 d.o.f.", "3 d.o.f.", "2 d.o.f. (up to 4)"), rows),
    )


def _overlap(
    one: list[tuple[float, float]], other: list[tuple[float, float]]
) -> list[tuple[float, float]]:
    """Where two sets of ranges overlap."""
    both = [(max(a, c), min(b, d)) for a, b in one for c, d in other]
    return [(low, high) for low, high in both if low < high]


def _reference(five: Ranges) -> list[Claim]:
    claims = []
    note = "Not printed in the thesis: an independent search in steps of 0.02 (errata)."
    for angle, ends in REFERENCE.items():
        ranges = five[int(np.argmin(np.abs(ANGLES - angle)))]
        for name, expected, i in (("least", ends[0], 0), ("greatest", ends[1], 1)):
            ours = ranges[0][i] if len(ranges) == 1 else float("nan")
            claims.append(
                number(
                    f"sec4-3.reference-{angle:.1f}-{name}",
                    "Figure 4-9",
                    f"{name} K_sh that stabilises the 5-d.o.f. system at Γ = {angle:.1f} rad",
                    expected,
                    ours,
                    "1",
                    0.02,
                    note,
                )
            )
    for angle in (0.4, 2.6):
        ranges = five[int(np.argmin(np.abs(ANGLES - angle)))]
        claims.append(
            statement(
                f"sec4-3.reference-{angle:.1f}",
                "Figure 4-9",
                f"no K_sh from −2 to 4 stabilises the 5-d.o.f. system at Γ = {angle:.1f} rad",
                "none",
                shown(ranges),
                not ranges,
                note,
            )
        )
    return claims


def _five(angle: float, ranges: list[tuple[float, float]]) -> Claim:
    """The intersection against the roots of the undivided, unreduced system on a fine grid."""
    values = np.linspace(LOW, HIGH, 1201)
    # Add each edge, a hair inside and a hair outside.
    ends = np.array([e for r in ranges for e in r if LOW < e < HIGH])
    values = np.concatenate([values, ends - 1e-5, ends + 1e-5])
    inside = np.zeros(len(values), bool)
    for low, high in ranges:
        inside |= (low < values) & (values < high)
    # The double zero of the somersault's drift is smeared by rounding to about 1e-7.
    stable = undivided_growth(float(angle), values) <= 3 * GROWS
    wrong = int((stable != inside).sum())
    return statement(
        f"sec4-3.five-{angle:.1f}",
        "§4.3.2, Figure 4-9",
        f"at Γ = {angle:.1f} rad the 5-d.o.f. system is stable where both its parts are",
        "the intersection of figures 4-10 and 4-11",
        f"{shown(ranges)}; the undivided system differs at {wrong} of {len(values)} K_sh",
        wrong == 0,
    )


def _positive(angle: float, ranges: list[tuple[float, float]]) -> Claim:
    expected = 0.8 - 1e-9 <= angle <= 2.0 + 1e-9
    stable = any(high > 0 for _, high in ranges)
    note = ""
    if stable and not expected:
        note = (
            f"The range is {ranges[0][1] - ranges[0][0]:.4f} wide, the thin end of the region: a "
            "search on separate points misses it (see figure 4-9)."
        )
    return statement(
        f"sec4-3.positive-{angle:.1f}",
        "§4.3.3",
        f"a positive K_sh stabilises Γ = {angle:.1f} rad"
        if expected
        else f"no positive K_sh stabilises Γ = {angle:.1f} rad",
        "stable between 0.8 and 2.0 rad" if expected else "outside 0.8 to 2.0 rad",
        shown(ranges),
        stable == expected,
        note,
    )


def _three(searched: Ranges, edge: Edges) -> list[Claim]:
    claims = []
    for i, angle in enumerate(ANGLES):
        exists = not np.isnan(edge.lower3[i])
        exact = [(float(edge.lower3[i]), float(edge.upper3[i]))] if exists else []
        claims.append(
            statement(
                f"sec4-3.three-{angle:.1f}",
                "Figure 4-10",
                f"edges of the 3-d.o.f. region at Γ = {angle:.1f} rad",
                "in figure 4-10, without numbers",
                shown(searched[i]),
                _equal(searched[i], exact),
                f"Holds if the search agrees to 1e-6 with the characteristic polynomial: "
                f"{shown(exact)}.",
            )
        )
    return claims


def _two(searched: Ranges, edge: Edges) -> list[Claim]:
    return [
        statement(
            f"sec4-3.two-{angle:.1f}",
            "Figure 4-11",
            f"the 2-d.o.f. system at Γ = {angle:.1f} rad is stable above one edge",
            "in figure 4-11, without numbers",
            f"K_sh > {edge.lower2[i]:.3f}",
            _equal(searched[i], [(float(edge.lower2[i]), HIGH)]),
            "Holds if the search agrees to 1e-6 with −(k55 + g45²/m44)/(2 I_sh).",
        )
        for i, angle in enumerate(ANGLES)
    ]


def _equal(one: list[tuple[float, float]], other: list[tuple[float, float]]) -> bool:
    return len(one) == len(other) and bool(
        np.allclose(np.ravel(one), np.ravel(other), rtol=0, atol=1e-6)
    )
