"""What is strange in a file, gathered while it is read and said in a few sentences."""

from __future__ import annotations

from dataclasses import dataclass, field


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


def listed(names: list[str], most: int = 8) -> str:
    """The first few names, and how many more there are."""
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")
