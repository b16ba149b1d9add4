"""Chapter 4, the layout somersault that springs at the shoulders make stable."""

from functools import partial

from somersault.thesis._entries import Chapter, Entry

_entry = partial(Entry.of, __name__)

CHAPTER = Chapter(
    "ch4",
    "Passively Stable Layout Somersaults",
    (
        _entry(
            "fig4-2",
            "Figure 4-2: the layout, rigid and passively stable",
            "_rigid_and_passive.fig_4_2",
        ),
        _entry("fig4-3", "Figure 4-3: the map of the rigid layout", "_layout_sphere.fig_4_3"),
        _entry("table4-1", "Table 4.1: Carl Furrer's inertia data", "_rigid_layout.table_4_1"),
        _entry(
            "eq4-1",
            "Equations 4.1–4.9: small deviations from a somersault",
            "_linear_equations.small_deviations",
        ),
        _entry(
            "appA-3", "Appendix A.3: elements of the linear model", "_linear_equations.appendix_a_3"
        ),
        _entry("fig4-5", "Figure 4-5: the rigid body's inertia ratios", "_rigid_layout.fig_4_5"),
        _entry("fig4-6", "Figure 4-6: root locus, undamped", "_root_loci.fig_4_6"),
        _entry("fig4-7", "Figure 4-7: root locus, damped shoulders", "_damping.fig_4_7"),
        _entry(
            "energy",
            "Why damping destroys it: the energy's signature",
            "_damping.energy_signature",
            beyond=True,
        ),
        _entry("fig4-8", "Figure 4-8: root loci for eight arm angles", "_root_loci.fig_4_8"),
        _entry(
            "fig4-9",
            "Figure 4-9: stability of the five-d.o.f. system",
            "_stability_regions.fig_4_9",
        ),
        _entry(
            "fig4-10", "Figure 4-10: tilt, twist and asymmetric arms", "_stability_regions.fig_4_10"
        ),
        _entry(
            "fig4-11", "Figure 4-11: somersault and symmetric arms", "_stability_regions.fig_4_11"
        ),
        _entry(
            "sec4-3",
            "Section 4.3: stabilising springs at a dozen arm angles",
            "_stiffness_ranges.sec_4_3",
        ),
        _entry("fig4-12", "Figure 4-12: somersaults until a quarter twist", "_lifetimes.fig_4_12"),
        _entry("sec4-3-3", "Section 4.3.3: two thousand seconds", "_long_flights.sec_4_3_3"),
        _entry(
            "sec4-3-lives",
            "Ten thousand somersaults, near the edge and within",
            "_long_lives.long_lives",
            beyond=True,
        ),
        _entry(
            "fig4-12-notches",
            "Figure 4-12's notches: resonances",
            "_notches.notches",
            beyond=True,
        ),
        _entry(
            "fig4-13", "Figure 4-13: turning the principal axes with an arm", "_arm_raised.fig_4_13"
        ),
        _entry(
            "fig4-14",
            "Figure 4-14: rigid trajectories near the middle axis",
            "_tilt_and_twist_paths.fig_4_14",
        ),
        _entry(
            "fig4-15",
            "Figure 4-15: the passively stable trajectory",
            "_tilt_and_twist_paths.fig_4_15",
        ),
        _entry("fig4-16", "Figure 4-16: the simplest model", "_one_arm_model.fig_4_16"),
        _entry("table4-2", "Table 4.2 and equation 4.11: its elements", "_one_arm_model.table_4_2"),
        _entry(
            "table4-3", "Table 4.3: Furrer's non-dimensional parameters", "_one_arm_model.table_4_3"
        ),
        _entry("fig4-17", "Figure 4-17: the centrifugal rule", "_centrifugal_rule.fig_4_17"),
        _entry("fig4-18", "Figure 4-18: nine stiffnesses", "_one_arm_regions.fig_4_18"),
        _entry("fig4-19", "Figure 4-19: nine sizes of arm", "_one_arm_regions.fig_4_19"),
        _entry(
            "fig4-20",
            "Figure 4-20: the simplest model with arms at an angle",
            "_one_arm_angle.fig_4_20",
        ),
    ),
)
