"""Errors of the thesis's text, each shown by an independent calculation."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Erratum:
    """One place: what is printed there, what it should say, and how that is known."""

    where: str
    printed: str
    correct: str
    why: str


ERRATA = (
    Erratum(
        "eq. 2.3",
        "SΨ SΘ CΘ, CΨ SΘ CΘ, SΨ CΘ, CΨ CΘ in the first and third rows (as scanned)",
        "SΨ SΘ/CΘ, CΨ SΘ/CΘ, SΨ/CΘ, CΨ/CΘ",
        "The fraction bars are lost; only with them does it invert eq. 2.4.",
    ),
    Erratum(
        "§2.3.2",
        "the remaining two roots are s = ±ν",
        "s = ±jν, with ν = √(k1 k3) Φ̇",
        "Only imaginary roots make quadrants 1 and 3 oscillate, as the same paragraph says.",
    ),
    Erratum(
        "eqs. 3.10, 3.11",
        "derivative −2 m_l r h/(I_o + m_l r²)²",
        "dΦ̇/dl = −4 m_l r Φ̇/(I_o + 2 m_l r²)",
        "The derivative of h/(I_o + 2 m_l r²). Newton's method converges with the printed form "
        "too, only more slowly.",
    ),
    Erratum("ch. 3, text", "Fig. 4, Fig. 5", "figures 3-6 and 3-7", "The figures that are meant."),
    Erratum(
        "§4.3.1, Table 4.3",
        "k1 = 0.65, k3 = −0.87, tenfold growth in 3.1 rad at Γ = 1.3 rad",
        "k1 = 0.687, k3 = −0.876, 2.97 rad",
        "What Table 4.1's data give. Still less than half a somersault. No arm angle of that model "
        "has k1 = 0.65.",
    ),
    Erratum(
        "A.3",
        "2 I l_l, 2 r l_l, 2 l_l; I_2; Π_3, Π_2 (as scanned)",
        "2 Il1; Il2; Il3, Il2",
        "Read this way, all fourteen printed elements agree with an independent linearisation to "
        "1e-9 at "
        "Γ = 0.3, 1.3 and 2.1 rad. k33 and k55 have no rb2 term; k13 = k31 has one.",
    ),
    Erratum(
        "Table 5.1",
        "rl3 = 0.0572 m with the 30 g weight",
        "0.0622 m",
        "The table's own masses give 0.0622 m and I_sh = 3.02e-4 kg m², which §5.5 uses; 0.0572 m "
        "would make it 2.67e-4.",
    ),
    Erratum(
        "§5.2.1",
        "Table 5.2.1, Figure 5.2.1, Φ_s0 = 0.0",
        "Table 5.1, Figure 5-2, Γ_s0 = 0.0",
        "The table, the picture and the angle that are meant.",
    ),
    Erratum(
        "§5.5, Figure 5-5",
        "0.7 ≤ K_sh ≤ 1.4 stabilises the doll at Γ = 1.57 rad",
        "0.63 ≤ K_sh ≤ 1.51",
        "With rl3 = 0.0622 m. The misprinted 0.0572 m gives 0.645 to 1.447, which on points 0.1 "
        "apart is 0.7 to 1.4.",
    ),
    Erratum("§5.5", "I_sh in N m²", "kg m²", "The unit of an inertia."),
    Erratum("A.4", "n = L1/L3", "n = L4/L3", "Equation A.25 divided through by L1 and L3."),
    Erratum(
        "A.20", "Θ = sin⁻¹(I3 ω3/h)", "Θ = −sin⁻¹(I3 ω3/h)", "The sign that follows from A.19."
    ),
)
