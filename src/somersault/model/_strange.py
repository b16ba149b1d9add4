"""What is strange in a file, gathered while it is read and said in a few sentences."""

from __future__ import annotations

from dataclasses import dataclass, field

from somersault._core.notes import listed


@dataclass(slots=True)
class Strange:
    """What a file says that is read otherwise, or not at all: names, by what there is to say."""

    said: dict[str, dict[str, None]] = field(default_factory=dict)  # each name once, in order

    def add(self, what: str, name: str) -> None:
        """Note one name; `what` is the sentence that a list of names completes."""
        self.said.setdefault(what, {})[name] = None

    def sentences(self) -> list[str]:
        """One sentence for each kind, with the first few names."""
        return [f"{what}: {listed(list(names))}" for what, names in self.said.items()]
