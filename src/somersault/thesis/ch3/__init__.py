"""Chapter 3, the tucked somersault of a running robot."""

from functools import partial

from somersault.thesis._entries import Chapter, Entry

_entry = partial(Entry.of, __name__)

CHAPTER = Chapter(
    "ch3",
    "Robot Tucked Somersaults",
    (
        _entry(
            "fig3-3", "Figure 3-3: the map of a spin about the major axis", "_major_axis.fig_3_3"
        ),
    ),
)
