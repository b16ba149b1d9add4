"""The chapters that `reproduce` knows, in the thesis's order; each lists its own entries."""

from __future__ import annotations

from somersault.thesis import ch1, ch2, ch3, ch4, ch5, ch6, ch7

CHAPTERS = tuple(chapter.CHAPTER for chapter in (ch1, ch2, ch3, ch4, ch5, ch6, ch7))
ENTRIES = tuple(entry for chapter in CHAPTERS for entry in chapter.entries)
