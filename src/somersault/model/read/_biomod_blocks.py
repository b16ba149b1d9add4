"""Blocks of a `.bioMod` file that are no segments: markers, contacts, muscles, passive torques …"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

from somersault.model.read._biomod_words import Words, shown


@dataclass(frozen=True, slots=True)
class Kind:
    """What to call such blocks where they are counted (nothing for parts of others), whether they
    act on the body, and the words that end one."""

    name: str
    acts: bool
    ends: tuple[str, ...]
    torque: bool = False


_FRAMES = ("endimu", "endmimu", "endcustomrt")
BLOCKS = {
    "marker": Kind("marker", False, ("endmarker",)),
    "imu": Kind("IMU", False, _FRAMES),
    "mimu": Kind("IMU", False, _FRAMES),
    "customrt": Kind("custom frame", False, _FRAMES),
    "contact": Kind("contact", False, ("endcontact",)),
    "softcontact": Kind("soft contact", False, ("endsoftcontact",)),
    "actuator": Kind("actuator", False, ("endactuator",)),
    "scalingsegment": Kind("scaling rule", False, ("endscalingsegment",)),
    "musclegroup": Kind("", True, ("endmusclegroup",)),
    "muscle": Kind("muscle", True, ("endmuscle",)),
    "viapoint": Kind("", True, ("endviapoint",)),
    "wrapping": Kind("", True, ("endwrapping",)),
    "ligament": Kind("ligament", True, ("endligament",)),
    "loopconstraint": Kind("loop constraint", True, ("endloopconstraint",)),
    "passivetorque": Kind("passive torque", True, ("endpassivetorque",), torque=True),
}
ENDS = {end for kind in BLOCKS.values() for end in kind.ends}
_NAMELESS = {"loopconstraint"}


@dataclass(slots=True)
class Block:
    """A block's words: the first of all is its name."""

    key: str
    name: str
    line: int
    words: list[str] = field(default_factory=list)

    @classmethod
    def read(cls, words: Words, key: str, others: Collection[str]) -> Block:
        """Pass over a block, but not over the rest of the file: `others` end other things."""
        kind, line = BLOCKS[key], words.line
        block = cls(key, "" if key in _NAMELESS else words.word(f"the name of the {key}"), line)
        while (word := words.next()) is not None:
            lower = word.lower()
            if lower in kind.ends:
                return block
            if lower in others or (words.starts_line and lower == "segment"):
                name = f" {shown(block.name)}" if block.name else ""
                raise words.error(f"the {key}{name} never ends; add {kind.ends[0]}", line)
            block.words.append(word)
        words.strange.add("blocks that never end, as the file ends", f"{key} {block.name}".strip())
        return block

    def text(self, key: str) -> str:
        """The word after a key, or nothing."""
        for word, following in zip(self.words, self.words[1:], strict=False):
            if word.lower() == key:
                return following
        return ""


@dataclass(frozen=True, slots=True)
class PassiveTorque:
    """A torque `constant` + `slope` · q on the joint of a segment's degree of freedom, N m and
    N m/rad; neither is known of one that is no line."""

    joint: str
    constant: float | None
    slope: float | None

    @classmethod
    def of(cls, words: Words, block: Block) -> PassiveTorque:
        """The torque in a block; SomersaultError for numbers that are none."""

        def number(*keys: str) -> float:
            found = next((text for key in keys if (text := block.text(key))), "0")
            return words.value(found, f"the {keys[0]} of the passive torque of {shown(block.name)}")

        joint = f"{block.name}_{block.text('dof')}"
        kind = block.text("type").lower()
        if kind == "constant":
            return cls(joint, number("torque"), 0.0)
        if kind == "linear":
            return cls(joint, number("t0"), number("slope", "pente"))
        return cls(joint, None, None)
