"""How the motor tape, and what is recorded besides, changes with the numbers of its own flight."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from somersault._core.array import Array
from somersault.engine import MOST_STEPS
from somersault.flight._along import Along
from somersault.flight._batch import Begun
from somersault.flight._directions import Directions, of_numbers, parts
from somersault.flight._tape import POINTS, RECORDED_TO, Tape, points, through
from somersault.simulation import Target


def with_recordings(
    begun: Begun, directions: Directions, paths: Sequence[str],
    meant: Sequence[tuple[Target, ...]], sizes: Array,
) -> Directions:  # fmt: skip
    """Directions along numbers, by steps of these sizes, with how what is recorded of the nominal
    flight changes: its recorded values are differentiated in its own flight, and the polynomials
    through them follow."""
    whole, first = list(directions.paths), len(directions.paths) - len(begun.batch.recorded)
    for k, (nominal, kept, played) in enumerate(begun.batch.recorded.values(), first):
        own = [tuple(t for t in targets if nominal.moved_by(t.name)) for targets in meant]
        moved = [i for i, targets in enumerate(own) if targets]
        if not moved:
            continue
        flight = replace(nominal, extremes=()).begun()
        along = Along(
            flight,
            of_numbers(flight, [paths[i] for i in moved], [own[i] for i in moved], sizes[moved]),
        )
        tape = nominal.recording(kept)
        times = points(tape.edges, nominal.duration)
        solution = along.solve(times[0], RECORDED_TO, MOST_STEPS)
        function = along.tangent.quantities(kept.called(nominal.model), event=False)
        values = along.read(
            function, solution.watched, solution.states, np.repeat(times, len(moved), 0),
            np.repeat(tape.edges[0, :-1], POINTS),
        )[..., 1:]  # fmt: skip
        edges = np.repeat(tape.edges, len(moved), 0)
        powers, _ = through(edges, values)
        knots, coefficients = (np.array(part) for part in whole[k])
        coefficients[moved] = parts(Tape(edges, powers).path(played))[1]
        whole[k] = knots, coefficients
    return replace(directions, paths=whole)
