"""Chapter 5, experiments with a somersaulting doll."""

from functools import partial

from somersault.thesis._entries import Chapter, Entry

_entry = partial(Entry.of, __name__)

CHAPTER = Chapter(
    "ch5",
    "Layout Somersault Experiments",
    (
        _entry("table5-1", "Table 5.1: the doll's body parameters", "_doll_parameters.table_5_1"),
        _entry("fig5-2", "Figure 5-2: inertia ratios of doll and human", "_doll_and_human.fig_5_2"),
        _entry("fig5-3", "Figure 5-3: how large the doll's arms are", "_doll_and_human.fig_5_3"),
        _entry("fig5-5", "Figure 5-5: springs that stabilise the doll", "_doll_springs.fig_5_5"),
        _entry(
            "sec5-4",
            "Sections 5.2.2 and 5.4: the launcher and the flight",
            "_release_and_flight.sec_5_4",
        ),
        _entry(
            "fig5-6", "Figure 5-6: the doll, rigid and with springs", "_rigid_and_sprung.fig_5_6"
        ),
        _entry(
            "fig5-7",
            "Figure 5-7: somersaults of twenty launches with each spring",
            "_launch_results.fig_5_7",
        ),
        _entry("fig5-8", "Figure 5-8: completely stable launches", "_launch_results.fig_5_8"),
        _entry(
            "ch5-scatter",
            "How the launches scattered",
            "_launch_scatter.launch_scatter",
            beyond=True,
        ),
        _entry(
            "ch5-springs",
            "Which five springs the doll had",
            "_five_springs.five_springs",
            beyond=True,
        ),
        _entry("ch5-ceiling", "The doll with no ceiling", "_no_ceiling.no_ceiling", beyond=True),
        _entry("ch5-resonance", "The doll's 2 : 1", "_doll_burst.doll_burst", beyond=True),
        _entry(
            "ch5-friction",
            "Friction in the doll's shoulders",
            "_shoulder_friction.shoulder_friction",
            beyond=True,
        ),
    ),
)
