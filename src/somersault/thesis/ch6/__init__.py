"""Chapter 6, the twisting somersault of a compliant body."""

from functools import partial

from somersault.thesis._entries import Chapter, Entry

_entry = partial(Entry.of, __name__)

CHAPTER = Chapter(
    "ch6",
    "Twisting Somersaults",
    (
        _entry("sec6-2", "Section 6.2: what tilts a twisting somersault", "_torque_twist.sec_6_2"),
        _entry("sec6-3-hula", "Section 6.3: the hula movement", "_hula.sec_6_3_hula"),
        _entry("fig6-1", "Figure 6-1: the rudi", "_rudi_flights.fig_6_1"),
        _entry("fig6-2", "Figure 6-2: landings with prescribed joints", "_rudi_maps.fig_6_2"),
        _entry("fig6-3", "Figure 6-3: landings with compliant joints", "_rudi_maps.fig_6_3"),
        _entry(
            "ch6-poses", "In which pose the gains are taken", "_rudi_maps.gain_poses", beyond=True
        ),
        _entry("sec6-3-h", "Section 6.3.3: other angular momenta", "_rudi_maps.other_momenta"),
        _entry("fig6-4", "Figure 6-4: an off-nominal start, prescribed", "_rudi_flights.fig_6_4"),
        _entry("fig6-5", "Figure 6-5: the same start, compliant", "_rudi_flights.fig_6_5"),
        _entry("table6-1", "Table 6.1: the rudi's eigenfrequencies", "_eigenfrequencies.table_6_1"),
        _entry("fig6-6", "Figure 6-6: the 3D Biped's map with a weight", "_weighted_biped.fig_6_6"),
        _entry("fig6-7", "Figure 6-7: a half twist in pictures", "_half_twist.fig_6_7"),
        _entry("fig6-8", "Figure 6-8: a half twist over time", "_half_twist.fig_6_8"),
        _entry(
            "ch6-attempts",
            "Attempts of a half twist",
            "_half_twist_attempts.attempts_of_half_twist",
            beyond=True,
        ),
        _entry(
            "ch6-why",
            "Why compliance lands better",
            "_landing_sensitivity.landing_sensitivity",
            beyond=True,
        ),
        _entry(
            "ch6-gentle",
            "A rudi with an athlete's torques",
            "_bounded_torques.bounded_torques",
            beyond=True,
        ),
    ),
)
