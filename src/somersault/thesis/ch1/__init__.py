"""Chapter 1, the introduction: three techniques in the air, a compliant twisting somersault, an
active layout, and a dismount."""

from functools import partial

from somersault.thesis._entries import Chapter, Entry

_entry = partial(Entry.of, __name__)

CHAPTER = Chapter(
    "ch1",
    "Introduction",
    (
        _entry("fig1-1", "Figure 1-1: three techniques in the air", "_techniques.fig_1_1"),
        _entry(
            "fig1-4", "Figure 1-4: a twisting somersault by torques alone", "_open_loop.fig_1_4"
        ),
        _entry("sec1-1", "§1.1.1: a layout that the arms hold", "_stabiliser.stabiliser"),
        _entry("sec1-1-dismount", "§1.1.1: a dismount from the high bar", "_dismount.dismounts"),
    ),
)
