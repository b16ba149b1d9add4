"""A last step of least squares from the best candidate, where errors are of landings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.designs._given import Given
from somersault.designs._mean import Mean
from somersault.designs._study import Study
from somersault.flight import Flights
from somersault.simulation import ENDED, LANDING_ERROR

_STEP = 1e-4  # of the ranges, of differences
_INSIDE = 1e-3  # of the ranges, how far from the bounds it begins
_MOST = 8  # steps, after which the rudi's fourteen numbers hardly changed


class LeastSquares:
    """The errors of all angles of all landings, whose squares are to be small.

    SomersaultError where a design's objective is something else.
    """

    def __init__(self, study: Study) -> None:
        trial = study.trial
        source, aim = trial.source, trial.objective
        cases = [case for case in source.cases if isinstance(case, Flights)]
        if (
            not (isinstance(aim, Mean) and aim.quantity == LANDING_ERROR and not aim.largest)
            or not isinstance(source, Given)
            or len(cases) < len(source.cases)
        ):
            raise SomersaultError(
                "only the mean landing_error of flights that are given, and not made by a "
                "function, can be polished; leave polishing out"
            )
        apart = [case.apart() for case in cases]
        names = list(apart[0][1])
        parts = np.array([[one[name] for name in names] for _, one in apart])  # case, angle, 2
        self._angles, self._weights = parts[..., 0], parts[0, :, 1]
        self._lost = (np.pi if aim.counts_as is None else aim.counts_as) / np.sqrt(len(names))
        self._names, self._where = names, study.where
        self._trial = replace(
            trial, source=replace(source, cases=tuple(one for one, _ in apart)),
            objectives=tuple(Mean(name) for name in names), limits=(),
        )  # fmt: skip

    def errors(self, parts: Array) -> Array:
        """Of candidates (P, chosen), (P, runs · angles)."""
        rows = self._trial.run(self._trial.table(parts), **self._where)
        landed = np.stack([rows[name] for name in self._names], -1)
        target = np.repeat(self._angles, landed.shape[1] // len(self._angles), 0)
        off = self._weights * (landed - target)
        lost = self._trial.failed(rows[ENDED])[..., None] | ~np.isfinite(off)
        return np.where(lost, self._lost, off).reshape(len(parts), -1)

    def slopes(self, at: Array) -> Array:
        """Their derivatives (runs · angles, chosen), from differences that are run at once."""
        by = np.where(at + _STEP <= 1.0, _STEP, -_STEP)
        every = self.errors(np.concatenate([at[None], at + np.diag(by)]))
        return ((every[1:] - every[0]) / by[:, None]).T

    def steps_from(self, parts: Array) -> Array:
        """The candidates (k, chosen) to which least squares come from one (chosen,): Gauss and
        Newton's steps in a trust region within the bounds (SciPy's `least_squares`)."""
        from scipy.optimize import least_squares

        steps: list[Array] = []

        def errors(at: Array) -> Array:
            steps.append(np.clip(at, 0.0, 1.0))
            return self.errors(steps[-1][None])[0]

        begin = np.clip(parts, _INSIDE, 1.0 - _INSIDE)
        least_squares(errors, begin, self.slopes, bounds=(0.0, 1.0), max_nfev=_MOST)
        return np.array(steps)
