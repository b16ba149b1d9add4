"""The segments in the text of a `.bioMod` file.

What each word means follows biorbd's own reader (pyomeca/biorbd, src/ModelReader.cpp). It skips
what it does not know in silence; so do we, with a note, but refuse what looks like a known word
misspelt. Words are known in small and capital letters alike, names only as they are written.
"""

from __future__ import annotations

import difflib
from collections import Counter

import numpy as np

from somersault.model._strange import Strange
from somersault.model.read._biomod_blocks import BLOCKS, ENDS, Block, PassiveTorque
from somersault.model.read._biomod_segment import (
    DUST,
    GROUND_PARENT,
    NOTHING,
    Properties,
    Segment,
    speeds,
)
from somersault.model.read._biomod_words import Words, shown

_HEADER = {
    "root_actuated",
    "external_forces",
    "mesh_folder_prefix",
}  # one word each, no matter here
_TOP = ["segment", "variables", "gravity", *BLOCKS, *_HEADER]
_ENDS = {"endsegment", "endvariables", *ENDS}

_RANGES = {"ranges", "rangesq", "rangesqdot", "rangesqddot", "jointdampings"}
_INERTIAS = {"inertia", "inertiamatrix", "inertia_xxyyzz"}
_SEVERAL = {"mesh", "patch", "meshrt", "meshscale"}
_DIGITS = "+-.0123456789"
_ALIKE = 0.8  # of a word's letters: as near to a known word as this it is misspelt
_MOST_SEGMENTS = 1000  # the largest athletes have some 150


class File:
    """One pass over the words of a file."""

    def __init__(self, words: Words) -> None:
        self.words = words
        self.version = 0
        self.segments: dict[str, Segment] = {}
        self.torques: list[PassiveTorque] = []
        self.ignored: Counter[str] = Counter()
        self.acting: Counter[str] = Counter()
        self._skipping = False  # the numbers after a word that nobody knows
        self._properties = Properties(words, self.segments, self.ignored)

    @property
    def strange(self) -> Strange:
        """What the file says that is read otherwise, or not at all."""
        return self.words.strange

    # --------------------------------------------------------------------- the whole file

    def read(self) -> None:
        """Read everything; afterwards `segments`, `torques`, `ignored` and `acting` hold it."""
        words = self.words
        while (word := words.next()) is not None and word.lower() != "version":
            if word.lower() in _TOP:
                word = None
                break
        if word is None:
            raise words.error("a bioMod file starts with the word version; is this one?", 1)
        self.version = int(words.number("the version"))
        if self.version not in (1, 2, 3, 4):
            raise words.error("its version is none of 1, 2, 3 and 4; save it as version 4")
        while (word := words.next()) is not None:
            self._element(word)

    def _element(self, word: str) -> None:
        words, key = self.words, word.lower()
        if key == "segment":
            self._segment()
        elif key == "variables":
            self._variables()
        elif key == "gravity":
            words.numbers(3, "gravity")
            self.ignored["gravity"] = 0
        elif key in _HEADER:
            words.word(f"the value of {key}")
        elif key in BLOCKS:
            self._block(key)
        elif key in _ENDS:
            self.strange.add("words that end nothing", self.words.at(word))
        else:
            self._pass_over(word, _TOP)
            return
        self._skipping = False

    def _variables(self) -> None:
        line = self.words.line
        while (word := self.words.word("endvariables")).lower() != "endvariables":
            if word.lower() in _TOP:
                raise self.words.error("the variables never end; add endvariables", line)
            if word.startswith("$"):
                self._skipping = False
                self.words.variable(word)
            else:
                self._pass_over(word, ["endvariables"])

    def _block(self, key: str) -> Block:
        """A block that is no segment: what has no part in flight, or acts but is left out."""
        block = Block.read(self.words, key, _ENDS)
        kind = BLOCKS[key]
        if kind.torque:
            self.torques.append(PassiveTorque.of(self.words, block))
        elif kind.name:
            (self.acting if kind.acts else self.ignored)[kind.name] += 1
        return block

    def _pass_over(self, word: str, known: list[str]) -> None:
        """Skip a word that nobody knows, and numbers after it, as biorbd does."""
        if word[0] in _DIGITS:
            if self._skipping:
                return
            if known is _TOP:
                self.strange.add(
                    "numbers between blocks, skipped as biorbd skips them", self.words.at(word[:40])
                )
                return
            raise self.words.error(
                f"the number {shown(word)} is one too many; remove it or add the word it belongs to"
            )
        near = difflib.get_close_matches(word[:40].lower(), known, 1, _ALIKE)
        if near:
            raise self.words.error(
                f"{shown(word)} is not a word of the format here; did you mean {near[0]}?"
            )
        self._skipping = True
        self.strange.add("unknown words, skipped as biorbd skips them", self.words.at(word[:40]))

    # -------------------------------------------------------------------------- a segment

    def _segment(self) -> None:
        words = self.words
        line = words.line
        name = words.word("the name of the segment")
        if name == "ROOT":
            raise words.error("a segment cannot be named ROOT, the ground's name; rename it")
        if name in self.segments:
            raise words.error(f"there are two segments {shown(name)}; rename one of them")
        if len(self.segments) == _MOST_SEGMENTS:
            raise words.error(
                f"there are more than {_MOST_SEGMENTS} segments; is this one athlete?"
            )
        parent = "root" if "root" in self.segments else GROUND_PARENT
        segment = Segment(name, self.version < 3, parent)  # version 3 turned the default round
        self._skipping = False
        seen: set[str] = set()
        last, within = "", None
        while (word := words.next()) is not None:
            key = word.lower()
            if key == "endsegment":
                if segment.mass == 0 and np.abs(segment.inertia).max() <= DUST:
                    segment.inertia = NOTHING
                self._check_parent(segment, within)
                self.segments[name] = segment
                return
            if words.starts_line and key in BLOCKS:
                within = self._block(key)
                continue
            if key in _ENDS or (words.starts_line and key in _TOP):
                break
            if last in _RANGES and word[0] in _DIGITS:
                if speeds(segment):  # else its axes were commented out, and their ranges left
                    self.strange.add("ranges to spare, which count for nothing", name)
                continue
            if last in ("translations", "rotations") and set(key) <= set("xyz"):
                raise words.error(
                    f"the axes of {last} are written as one word, of which biorbd would read "
                    f"only the first part; write {getattr(segment, last)}{key}"
                )
            if key not in self._properties.readers:
                self._pass_over(word, [*self._properties.readers, "endsegment"])
                continue
            self._check_order(segment, key, seen)
            self._skipping = False
            within = None if key == "parent" else within
            seen.add(last := key)
            self._properties.readers[key](segment, key)
        raise words.error(f"segment {shown(name)} never ends; add endsegment", line)

    def _check_order(self, segment: Segment, key: str, seen: set[str]) -> None:
        """Refuse a word that biorbd refuses here; note one that stands twice."""
        if key in ("translations", "rotations") and not seen.isdisjoint(_RANGES):
            raise self.words.error(f"{key} stand below the ranges of their axes; put them above")
        once = _INERTIAS if key in _INERTIAS else {key}
        if (key in _INERTIAS or key in _RANGES) and not seen.isdisjoint(once):
            raise self.words.error(
                f"segment {shown(segment.name)} has {key} twice; remove one of them"
            )
        if key in seen and key not in _SEVERAL:
            self.strange.add(
                "given twice in a segment, of which the last counts",
                self.words.at(f"{key} of {segment.name}"),
            )

    def _check_parent(self, segment: Segment, within: Block | None) -> None:
        """Refuse a block inside a segment, below its parent, whose parent biorbd would take for
        the segment's."""
        parent = "" if within is None else within.text("parent")
        if within is not None and parent and self._properties.known(parent) != segment.parent:
            raise self.words.error(
                f"the {within.key} {shown(within.name)} stands within segment "
                f"{shown(segment.name)}, whose parent biorbd would take to be {shown(parent)} "
                "because of it; put it below the segment",
                within.line,
            )
