"""Every figure, table and section that `reproduce` knows, in the thesis's order."""

from __future__ import annotations

from somersault.thesis._arm_shape import fig_4_20
from somersault.thesis._damping import energy, fig_4_7
from somersault.thesis._edges import sec_4_3
from somersault.thesis._entries import Entry
from somersault.thesis._locus import fig_4_6, fig_4_8
from somersault.thesis._matrices import appendix_a_3, equations
from somersault.thesis._regions import fig_4_9, fig_4_10, fig_4_11
from somersault.thesis._rigid import fig_4_5, table_4_1
from somersault.thesis._rule import fig_4_17
from somersault.thesis._simplest import fig_4_16, table_4_2, table_4_3
from somersault.thesis._squares import fig_4_18, fig_4_19

ENTRIES = (
    Entry("table4-1", "Table 4.1: Carl Furrer's inertia data", "ch4", table_4_1),
    Entry("eq4-1", "Equations 4.1–4.9: small deviations from a somersault", "ch4", equations),
    Entry("appA-3", "Appendix A.3: elements of the linear model", "ch4", appendix_a_3),
    Entry("fig4-5", "Figure 4-5: the rigid body's inertia ratios", "ch4", fig_4_5),
    Entry("fig4-6", "Figure 4-6: root locus, undamped", "ch4", fig_4_6),
    Entry("fig4-7", "Figure 4-7: root locus, damped shoulders", "ch4", fig_4_7),
    Entry("energy", "Why damping destroys it: the energy's signature", "ch4", energy, beyond=True),
    Entry("fig4-8", "Figure 4-8: root loci for eight arm angles", "ch4", fig_4_8),
    Entry("fig4-9", "Figure 4-9: stability of the five-d.o.f. system", "ch4", fig_4_9),
    Entry("fig4-10", "Figure 4-10: tilt, twist and asymmetric arms", "ch4", fig_4_10),
    Entry("fig4-11", "Figure 4-11: somersault and symmetric arms", "ch4", fig_4_11),
    Entry("sec4-3", "Section 4.3: edges at a dozen arm angles", "ch4", sec_4_3),
    Entry("fig4-16", "Figure 4-16: the simplest model", "ch4", fig_4_16),
    Entry("table4-2", "Table 4.2 and equation 4.11: its elements", "ch4", table_4_2),
    Entry("table4-3", "Table 4.3: Furrer's non-dimensional parameters", "ch4", table_4_3),
    Entry("fig4-17", "Figure 4-17: the centrifugal rule", "ch4", fig_4_17),
    Entry("fig4-18", "Figure 4-18: nine stiffnesses", "ch4", fig_4_18),
    Entry("fig4-19", "Figure 4-19: nine sizes of arm", "ch4", fig_4_19),
    Entry("fig4-20", "Figure 4-20: the simplest model with arms at an angle", "ch4", fig_4_20),
)
