"""Chapter 2, the rigid body: its equations, its stability, the map of its rotation."""

from functools import partial

from somersault.thesis._entries import Chapter, Entry

_entry = partial(Entry.of, __name__)

CHAPTER = Chapter(
    "ch2",
    "Rigid Body Rotation",
    (
        _entry("fig2-1", "Figure 2-1: somersault, tilt and twist", "_attitude_angles.fig_2_1"),
        _entry(
            "eq2",
            "Equations 2.1–2.14: the rigid body",
            "_rigid_body_equations.rigid_body_equations",
        ),
        _entry("fig2-2", "Figure 2-2: the inertia ratio diagram", "_inertia_ratios.fig_2_2"),
        _entry("fig2-3", "Figure 2-3: stability of the simple spins", "_inertia_ratios.fig_2_3"),
        _entry("fig2-4", "Figure 2-4: curves of equal growth", "_inertia_ratios.fig_2_4"),
        _entry("fig2-5", "Figure 2-5: tuck, pike and layout", "_postures.fig_2_5"),
        _entry("fig2-6", "Figure 2-6: inertia ratios of the three postures", "_postures.fig_2_6"),
        _entry("fig2-7", "Figure 2-7: a map of rigid body rotation", "_momentum_sphere.fig_2_7"),
        _entry("fig2-8", "Figure 2-8: tilt and twist on the map", "_momentum_sphere.fig_2_8"),
    ),
)
