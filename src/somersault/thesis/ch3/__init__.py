"""Chapter 3, the tucked somersault of a running robot."""

from functools import partial

from somersault.thesis._entries import Chapter, Entry

_entry = partial(Entry.of, __name__)

CHAPTER = Chapter(
    "ch3",
    "Robot Tucked Somersaults",
    (
        _entry("table3-1", "Table 3.1: the 3D Biped's parameters", "_biped.table_3_1"),
        _entry("fig3-2", "Figure 3-2: a somersault in pictures", "_somersault.fig_3_2"),
        _entry("fig3-3", "Figure 3-3: the map of a spin about the major axis", "_biped.fig_3_3"),
        _entry("sec3-3", "Section 3.3: tuck servo and landing window", "_strategy.sec_3_3"),
        _entry("sec3-4", "Section 3.4: running", "_running.sec_3_4"),
        _entry("table3-2", "Table 3.2: the steps of a somersault", "_somersault.table_3_2"),
        _entry("fig3-5", "Figure 3-5: approach, somersault and running on", "_somersault.fig_3_5"),
        _entry("fig3-6", "Figure 3-6: the tuck servo at work", "_airborne.fig_3_6"),
        _entry("fig3-7", "Figure 3-7: a somersault that over-rotates", "_airborne.fig_3_7"),
        _entry("table3-3", "Table 3.3: attempts", "_attempts.table_3_3"),
        _entry(
            "ch3-parts", "What each part of the strategy contributes", "_attempts.ablations",
            beyond=True,
        ),
        _entry(
            "ch3-assumed", "What is assumed of the robot", "_assumed.assumptions", beyond=True
        ),
        _entry(
            "ch3-springs", "Section 7.1: leg springs for a tuck servo", "_springs.sec_7_1",
            beyond=True,
        ),
    ),
)  # fmt: skip
