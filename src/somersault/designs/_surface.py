"""An objective's figure over what is chosen, as a simulation: ensembles draw it, and rank it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.canonical import canonical
from somersault._core.errors import SomersaultError
from somersault.designs._choose import FIGURE
from somersault.designs._trial import Trial
from somersault.ensembles import Vary, carried_out, plan
from somersault.simulation import ENDED, Endings, Name, Numbers, Target, Variable

_ENDINGS = Endings(
    ("judged", "no candidate"), ("no candidate",), "no candidate", called="candidates"
)
_CHUNKS = 64  # so that a bar moves, and every core has some


@dataclass(frozen=True, eq=False)
class Surface:
    """The figure that candidates come to on the starts of a trial.

    A run is a candidate; its numbers are where it is between its bounds, 0 to 1, by the names of
    what is chosen.
    """

    trial: Trial
    name = "candidates"
    endings = _ENDINGS
    times = np.empty(0)

    @property
    def packages(self) -> tuple[str, ...]:
        """The packages whose versions decide the last digits."""
        return self.trial.simulation.packages

    @property
    def specification(self) -> Mapping[str, Any]:
        """All that decides the numbers, as plain data."""
        trial = self.trial
        return {
            **trial.simulation.specification,
            "chosen": canonical(dict(trial.chosen)),
            "objective": {"kind": trial.objective.kind, **canonical(trial.objective)},
            "starts": [trial.size, trial.seed, trial.sequence, canonical(dict(trial.vary))],
        }

    @property
    def values(self) -> Numbers:
        """Where the search begins."""
        return {(name,): one.begins for name, one in self.trial.chosen.items()}

    @property
    def variables(self) -> Mapping[str, Variable]:
        """The figure."""
        return {
            FIGURE: Variable(
                self.trial.unit(self.trial.objective), words=self.trial.objective.words
            )
        }

    @property
    def together(self) -> int:
        """How many candidates are run at once."""
        return max(self.trial.simulation.together // self.trial.size, 1)

    def targets(self, path: str) -> tuple[Target, ...]:
        """The number of something that is chosen."""
        if path not in self.trial.chosen:
            raise SomersaultError(
                f"{path} is not chosen; there are {', '.join(map(str, self.trial.chosen))}"
            )
        return (Target((path,), unit="1"),)

    def with_varied(self, names: tuple[Name, ...]) -> Surface:
        """The same."""
        return self

    def sound(self, values: Numbers, count: int) -> Array:
        """All candidates are; what cannot begin with their numbers fails."""
        return np.ones(count, bool)

    def run(self, values: Numbers, count: int) -> dict[str, Array]:
        """The figures of some candidates."""
        parts = np.stack([np.broadcast_to(values[name,], count) for name in self.trial.chosen], -1)
        figures = self.trial.figures(self.trial.run(self.trial.table(parts)))
        return {FIGURE: figures, ENDED: np.zeros(count, np.uint8)}

    def over(
        self, vary: Mapping[str, Vary], size: int | None, sequence: str, seed: int, progress: bool
    ) -> Any:
        """The figures where some quantities vary, an `xarray.Dataset` of an ensemble."""
        planned = plan(self, vary, size, seed, sequence)
        chunk = -(-planned.count // _CHUNKS)
        return carried_out(planned, chunk=chunk, progress=progress).dataset
