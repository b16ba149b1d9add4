"""Every figure, table and section that `reproduce` knows, in the thesis's order."""

from __future__ import annotations

from somersault.thesis._entries import Entry
from somersault.thesis.ch1._techniques import fig_1_1
from somersault.thesis.ch2._equations_2 import equations_2
from somersault.thesis.ch2._gyric import fig_2_1, fig_2_2, fig_2_3, fig_2_4
from somersault.thesis.ch2._humans import fig_2_5, fig_2_6
from somersault.thesis.ch2._spheres import fig_2_7, fig_2_8, fig_3_3, fig_4_3
from somersault.thesis.ch4._arm_shape import fig_4_20
from somersault.thesis.ch4._asymmetry import fig_4_13
from somersault.thesis.ch4._damping import energy, fig_4_7
from somersault.thesis.ch4._edges import sec_4_3
from somersault.thesis.ch4._layout_flights import fig_4_2, sec_4_3_3
from somersault.thesis.ch4._locus import fig_4_6, fig_4_8
from somersault.thesis.ch4._matrices import appendix_a_3, equations
from somersault.thesis.ch4._regions import fig_4_9, fig_4_10, fig_4_11
from somersault.thesis.ch4._reorientation import fig_4_14, fig_4_15
from somersault.thesis.ch4._ridge import fig_4_12
from somersault.thesis.ch4._rigid import fig_4_5, table_4_1
from somersault.thesis.ch4._rule import fig_4_17
from somersault.thesis.ch4._simplest import fig_4_16, table_4_2, table_4_3
from somersault.thesis.ch4._squares import fig_4_18, fig_4_19
from somersault.thesis.ch5._doll import table_5_1
from somersault.thesis.ch5._doll_compared import fig_5_2, fig_5_3, fig_5_5
from somersault.thesis.ch5._friction import friction
from somersault.thesis.ch5._launch import sec_5_4
from somersault.thesis.ch5._launches import fig_5_7, fig_5_8
from somersault.thesis.ch5._no_ceiling import ceiling
from somersault.thesis.ch5._scatter import estimate
from somersault.thesis.ch5._springs_tried import springs_tried
from somersault.thesis.ch6._eigenfrequencies import table_6_1
from somersault.thesis.ch6._hula import sec_6_2, sec_6_3_hula
from somersault.thesis.ch6._rudi_flights import fig_6_1, fig_6_4, fig_6_5
from somersault.thesis.ch6._rudi_gentle import gentle
from somersault.thesis.ch6._rudi_maps import fig_6_2, fig_6_3, momentum, poses
from somersault.thesis.ch6._why_compliance import why

ENTRIES = (
    Entry("fig1-1", "Figure 1-1: three techniques in the air", "ch1", fig_1_1),
    Entry("fig2-1", "Figure 2-1: somersault, tilt and twist", "ch2", fig_2_1),
    Entry("eq2", "Equations 2.1–2.14: the rigid body", "ch2", equations_2),
    Entry("fig2-2", "Figure 2-2: the inertia ratio diagram", "ch2", fig_2_2),
    Entry("fig2-3", "Figure 2-3: stability of the simple spins", "ch2", fig_2_3),
    Entry("fig2-4", "Figure 2-4: curves of equal growth", "ch2", fig_2_4),
    Entry("fig2-5", "Figure 2-5: tuck, pike and layout", "ch2", fig_2_5),
    Entry("fig2-6", "Figure 2-6: inertia ratios of the three postures", "ch2", fig_2_6),
    Entry("fig2-7", "Figure 2-7: a map of rigid body rotation", "ch2", fig_2_7),
    Entry("fig2-8", "Figure 2-8: tilt and twist on the map", "ch2", fig_2_8),
    Entry("fig3-3", "Figure 3-3: the map of a spin about the major axis", "ch3", fig_3_3),
    Entry("fig4-2", "Figure 4-2: the layout, rigid and passively stable", "ch4", fig_4_2),
    Entry("fig4-3", "Figure 4-3: the map of the rigid layout", "ch4", fig_4_3),
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
    Entry("fig4-12", "Figure 4-12: somersaults until a quarter twist", "ch4", fig_4_12),
    Entry("sec4-3-3", "Section 4.3.3: two thousand seconds", "ch4", sec_4_3_3),
    Entry("fig4-13", "Figure 4-13: turning the principal axes with an arm", "ch4", fig_4_13),
    Entry("fig4-14", "Figure 4-14: rigid trajectories near the middle axis", "ch4", fig_4_14),
    Entry("fig4-15", "Figure 4-15: the passively stable trajectory", "ch4", fig_4_15),
    Entry("fig4-16", "Figure 4-16: the simplest model", "ch4", fig_4_16),
    Entry("table4-2", "Table 4.2 and equation 4.11: its elements", "ch4", table_4_2),
    Entry("table4-3", "Table 4.3: Furrer's non-dimensional parameters", "ch4", table_4_3),
    Entry("fig4-17", "Figure 4-17: the centrifugal rule", "ch4", fig_4_17),
    Entry("fig4-18", "Figure 4-18: nine stiffnesses", "ch4", fig_4_18),
    Entry("fig4-19", "Figure 4-19: nine sizes of arm", "ch4", fig_4_19),
    Entry("fig4-20", "Figure 4-20: the simplest model with arms at an angle", "ch4", fig_4_20),
    Entry("table5-1", "Table 5.1: the doll's body parameters", "ch5", table_5_1),
    Entry("fig5-2", "Figure 5-2: inertia ratios of doll and human", "ch5", fig_5_2),
    Entry("fig5-3", "Figure 5-3: how large the doll's arms are", "ch5", fig_5_3),
    Entry("fig5-5", "Figure 5-5: springs that stabilise the doll", "ch5", fig_5_5),
    Entry("sec5-4", "Sections 5.2.2 and 5.4: the launcher and the flight", "ch5", sec_5_4),
    Entry("fig5-7", "Figure 5-7: somersaults of twenty launches a spring", "ch5", fig_5_7),
    Entry("fig5-8", "Figure 5-8: completely stable launches", "ch5", fig_5_8),
    Entry("ch5-scatter", "How the launches scattered", "ch5", estimate, beyond=True),
    Entry("ch5-springs", "Which five springs there were", "ch5", springs_tried, beyond=True),
    Entry("ch5-ceiling", "The doll with no ceiling", "ch5", ceiling, beyond=True),
    Entry("ch5-friction", "Friction in the doll's shoulders", "ch5", friction, beyond=True),
    Entry("sec6-2", "Section 6.2: what tilts a twisting somersault", "ch6", sec_6_2),
    Entry("sec6-3-hula", "Section 6.3: the hula movement", "ch6", sec_6_3_hula),
    Entry("fig6-1", "Figure 6-1: the rudi", "ch6", fig_6_1),
    Entry("fig6-2", "Figure 6-2: landings with prescribed joints", "ch6", fig_6_2),
    Entry("fig6-3", "Figure 6-3: landings with compliant joints", "ch6", fig_6_3),
    Entry("ch6-poses", "Which pose the gains are of", "ch6", poses, beyond=True),
    Entry("sec6-3-h", "Section 6.3.3: other angular momenta", "ch6", momentum),
    Entry("fig6-4", "Figure 6-4: an off-nominal start, prescribed", "ch6", fig_6_4),
    Entry("fig6-5", "Figure 6-5: the same start, compliant", "ch6", fig_6_5),
    Entry("table6-1", "Table 6.1: the rudi's eigenfrequencies", "ch6", table_6_1),
    Entry("ch6-why", "Why compliance lands better", "ch6", why, beyond=True),
    Entry("ch6-gentle", "A rudi with an athlete's torques", "ch6", gentle, beyond=True),
)
