"""What a search has found so far, kept in a file with which the same search goes on."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import file_path
from somersault._core.errors import SomersaultError
from somersault._core.files import write
from somersault._core.places import check_folder
from somersault.designs._trial import Outcome

NAME = "design.json"
_MOST_BYTES = 2**28


class Journal:
    """The generations of a search, in a folder or in memory.

    A generation is its candidates and what they came to. `specification` is all that decides them:
    a folder with another one is refused.
    """

    def __init__(self, folder: Path | None, specification: Mapping[str, Any]) -> None:
        text = json.dumps(specification, sort_keys=True)
        self._digest = hashlib.sha256(text.encode()).hexdigest()
        self._specification = specification
        self._file = None if folder is None else check_folder(folder) / NAME
        self._rows: list[dict[str, Any]] = []
        if self._file is not None and self._file.exists():
            self._rows = self._read(self._file)

    def _read(self, file: Path) -> list[dict[str, Any]]:
        file_path("a design's journal", file)
        try:
            if file.stat().st_size > _MOST_BYTES:
                raise ValueError
            kept = json.loads(file.read_text(encoding="utf-8"))
            digest, rows = kept["digest"], kept["generations"]
            for row in rows:
                for what in ("candidates", "figures", "costs", "beyond"):
                    np.asarray(row[what], float)
        except (OSError, ValueError, KeyError, TypeError, RecursionError):
            raise SomersaultError(
                f"{file} is no journal of a design, or is damaged; remove it, or give another "
                "folder"
            ) from None
        if digest != self._digest:
            raise SomersaultError(
                f"{file.parent} holds another design; give another folder, or ask for the same"
            )
        return list(rows)

    def found(self, generation: int, candidates: Array) -> Outcome | None:
        """What the candidates of a generation came to, if that is known."""
        if generation >= len(self._rows):
            return None
        row = self._rows[generation]
        if not np.array_equal(np.asarray(row["candidates"], float), candidates):
            del self._rows[generation:]  # of another version of the optimiser
            return None
        return _outcome(row)

    def add(self, candidates: Array, outcome: Outcome) -> None:
        """Keep a generation."""
        self._rows.append({
            "candidates": candidates.tolist(), "figures": outcome.figures.tolist(),
            "costs": outcome.costs.tolist(), "beyond": outcome.beyond.tolist(),
        })  # fmt: skip
        if self._file is not None:
            kept = {
                "digest": self._digest, "specification": self._specification,
                "generations": self._rows,
            }  # fmt: skip
            write(self._file, json.dumps(kept, indent=1) + "\n")

    @property
    def generations(self) -> list[tuple[Array, Outcome]]:
        """Candidates and outcomes, in order."""
        return [(np.asarray(row["candidates"], float), _outcome(row)) for row in self._rows]


def _outcome(row: Mapping[str, Any]) -> Outcome:
    return Outcome(*(np.asarray(row[what], float) for what in ("figures", "costs", "beyond")))
