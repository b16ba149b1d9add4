"""Chapter 1, the introduction: three techniques in the air."""

from functools import partial

from somersault.thesis._entries import Chapter, Entry

_entry = partial(Entry.of, __name__)

CHAPTER = Chapter(
    "ch1",
    "Introduction",
    (_entry("fig1-1", "Figure 1-1: three techniques in the air", "_techniques.fig_1_1"),),
)
