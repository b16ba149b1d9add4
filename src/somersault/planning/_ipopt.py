"""IPOPT, by CasADi, on a program that computes its derivatives itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault.planning._entries import Assembly
from somersault.planning._program import Program

_KEPT = 1e-6  # by which a constraint may be missed
SETTINGS = {
    "print_time": False,
    "show_eval_warnings": False,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.tol": 1e-6,
    "ipopt.mu_strategy": "adaptive",
}
Fill = Callable[[Sequence[Array], Sequence[Array | None]], None]
_NO_MORE = {"no_nlp_grad": True, "calc_lam_p": False, "calc_multipliers": False}


@dataclass(frozen=True, eq=False)
class Outcome:
    """How the solver ended.

    Parameters
    ----------
    x : array
        The unknowns.
    objective : float
    status : str
        IPOPT's own word for it.
    iterations : int
    missed : float
        By how much the constraint is missed that is missed most.
    """

    x: Array
    objective: float
    status: str
    iterations: int
    missed: float

    @property
    def solved(self) -> bool:
        """Whether it keeps to all constraints: where iterations ran out it may still not be the
        best near its start."""
        return self.missed < _KEPT


class Solver:
    """IPOPT on one program, for any start."""

    def __init__(self, program: Program, most_iterations: int) -> None:
        self._program = program
        self._last: Array | None = None
        self._known: dict[str, Array] = {}
        self._raised: list[BaseException] = []
        unknowns, rows = program.unknowns, len(program.low)
        dense = ca.Sparsity.dense
        x, none, one, g = dense(unknowns), dense(0), dense(1), dense(rows)
        jacobian, hessian = (_sparsity(a) for a in (program.jacobian, program.hessian))
        point = {"x": x, "p": none}
        fill = self._heedful
        self._parts = {
            "nlp": _Called("nlp", point, {"f": one, "g": g}, fill(self._nlp)),
            "grad_f": _Called("grad_f", point, {"f": one, "grad_f_x": x}, fill(self._gradient)),
            "jac_g": _Called("jac_g", point, {"g": g, "jac_g_x": jacobian}, fill(self._jacobian)),
            "hess_lag": _Called(
                "hess_lag", {**point, "lam_f": one, "lam_g": g},
                {"triu_hess_gamma_x_x": hessian}, fill(self._hessian),
            ),
        }  # fmt: skip
        own = {name: part for name, part in self._parts.items() if name != "nlp"}
        settings: dict[str, Any] = {
            **SETTINGS, **_NO_MORE, **own, "ipopt.max_iter": most_iterations
        }  # fmt: skip
        self._solver = ca.nlpsol("plan", "ipopt", self._parts["nlp"], settings)

    def __call__(self, start: Array) -> Outcome:
        """What comes of a start. This thread waits: an interrupt within IPOPT would be lost."""
        self._raised.clear()
        with ThreadPoolExecutor(1) as thread:
            running = thread.submit(copy_context().run, self._solved, start)
            try:
                return running.result()
            except BaseException as raised:
                self._raised.append(raised)  # which ends what runs
                raise

    def _solved(self, start: Array) -> Outcome:
        program = self._program
        try:
            answer = self._solver(
                x0=start, lbx=program.least, ubx=program.most, lbg=program.low, ubg=program.high
            )
        finally:
            if self._raised:  # which IPOPT takes for a point that cannot be had
                raise self._raised[0]
        said = self._solver.stats()
        x = np.array(answer["x"]).ravel()
        return Outcome(
            x, float(answer["f"]), said["return_status"], max(int(said["iter_count"]), 0),
            float(program.missed(x).max()),
        )  # fmt: skip

    # ----------------------------------------------------------------- what IPOPT asks for

    def _of(self, x: Array, what: str, compute: Callable[[Array], Array]) -> Array:
        """What was computed for these unknowns, once."""
        if self._last is None or not np.array_equal(x, self._last):
            self._last, self._known = x.copy(), {}
        if what not in self._known:
            self._known[what] = compute(x)
        return self._known[what]

    def _heedful(self, fill: Fill) -> Callable[[Sequence[Array], Sequence[Array | None]], bool]:
        """The same, which says whether it is done, and keeps what is raised meanwhile."""

        def done(arguments: Sequence[Array], results: Sequence[Array | None]) -> bool:
            if not self._raised:
                try:
                    fill(arguments, results)
                except BaseException as raised:
                    self._raised.append(raised)
            return not self._raised

        return done

    def _nlp(self, arguments: Sequence[Array], results: Sequence[Array | None]) -> None:
        x = arguments[0]
        y = self._of(x, "y", self._program.outputs)
        _put(results[0], lambda: np.array(self._program.objective(x, y)))
        _put(results[1], lambda: self._program.constraints(x, y))

    def _gradient(self, arguments: Sequence[Array], results: Sequence[Array | None]) -> None:
        x, program = arguments[0], self._program
        _put(results[0], lambda: np.array(program.objective(x, self._of(x, "y", program.outputs))))
        slopes = self._of(x, "slopes", program.slopes)
        if results[1] is not None:
            results[1][:] = 0.0
            results[1][program.gradient.columns] = program.gradient.values(slopes)

    def _jacobian(self, arguments: Sequence[Array], results: Sequence[Array | None]) -> None:
        x, program = arguments[0], self._program
        _put(results[0], lambda: program.constraints(x, self._of(x, "y", program.outputs)))
        slopes = self._of(x, "slopes", program.slopes)
        _put(results[1], lambda: program.jacobian.values(slopes))

    def _hessian(self, arguments: Sequence[Array], results: Sequence[Array | None]) -> None:
        x, _, (objective,), multipliers = arguments
        program = self._program
        curvatures = program.curvatures(x, float(objective), multipliers)
        _put(results[0], lambda: program.hessian.values(curvatures))


def _put(place: Array | None, compute: Callable[[], Array]) -> None:
    if place is not None and place.size:
        place[:] = compute()


def _sparsity(assembly: Assembly) -> ca.Sparsity:
    rows, columns = assembly.shape
    return ca.Sparsity.triplet(rows, columns, assembly.rows.tolist(), assembly.columns.tolist())


class _Called(ca.Callback):
    """A function of CasADi's that fills arrays of CasADi's in place."""

    def __init__(
        self,
        name: str,
        inputs: dict[str, ca.Sparsity],
        outputs: dict[str, ca.Sparsity],
        fill: Callable[[Sequence[Array], Sequence[Array | None]], bool],
    ) -> None:
        ca.Callback.__init__(self)
        self._inputs, self._outputs, self._fill = inputs, outputs, fill
        self.construct(name, {})

    @cached_property
    def _names(self) -> tuple[list[str], list[str]]:
        return list(self._inputs), list(self._outputs)

    def get_n_in(self) -> int:
        return len(self._inputs)

    def get_n_out(self) -> int:
        return len(self._outputs)

    def get_name_in(self, k: int) -> str:
        return self._names[0][k]

    def get_name_out(self, k: int) -> str:
        return self._names[1][k]

    def get_sparsity_in(self, k: int) -> ca.Sparsity:
        return self._inputs[self._names[0][k]]

    def get_sparsity_out(self, k: int) -> ca.Sparsity:
        return self._outputs[self._names[1][k]]

    def has_eval_buffer(self) -> bool:
        return True

    def eval_buffer(self, given: Sequence[Any], wanted: Sequence[Any]) -> int:
        arguments = [np.frombuffer(a) if a is not None else np.zeros(0) for a in given]
        results = [np.frombuffer(r) if r is not None else None for r in wanted]
        return 0 if self._fill(arguments, results) else 1
