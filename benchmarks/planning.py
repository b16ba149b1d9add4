"""A plan's solve with our derivatives and with CasADi's own, in the same run.

    python benchmarks/planning.py [--starts 3] [--json FILE]

See README.md beside this file for what each line means.
"""

from __future__ import annotations

import argparse
import runpy
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import casadi as ca
import machine
import numpy as np

import somersault as so
from somersault.engine import use_threads
from somersault.planning._guess import refined
from somersault.planning._ipopt import SETTINGS, Solver
from somersault.planning._program import Program
from somersault.planning._request import requested
from somersault.planning._search import MOST_ITERATIONS, Draw, Search

COARSE, FINE = 40, 100  # nodes
EXAMPLE = Path(__file__).parents[1] / "examples" / "plan_twist.py"
AIM = 5.0  # s, for a solve of 100 nodes
Solve = Callable[[np.ndarray], tuple[np.ndarray, float, int]]


def search() -> Search:
    """The published acrobat's, as the example asks it."""
    example: dict[str, Any] = runpy.run_path(str(EXAMPLE))
    body = so.load(example["ACROBAT"], axes=(1, 2, 3))
    task = requested(
        body, somersaults=1, twists="most", torque=100.0, duration=(0.5, 1.5), joints=None,
        end=None, rest_at_end=False, fastest=None, effort=0.01, **example["ASKED"],
    )  # fmt: skip
    return Search(task)


def ours(program: Program) -> Solve:
    """IPOPT with compiled derivatives of a point, put together by a sparse product."""
    solver = Solver(program, MOST_ITERATIONS)

    def solve(start: np.ndarray) -> tuple[np.ndarray, float, int]:
        outcome = solver(start)
        return outcome.x, outcome.objective, outcome.iterations

    return solve


def mapped(program: Program) -> Solve:
    """The same program and settings, written in CasADi, which differentiates all of it: the
    point's function is mapped over the points."""
    return _casadi(program, expand=False)


def expanded(program: Program) -> Solve:
    """The same, and all of it is expanded into scalars first."""
    return _casadi(program, expand=True)


def _casadi(program: Program, expand: bool) -> Solve:
    point = program.point
    x = ca.MX.sym("x", program.unknowns)
    function = ca.Function("point", [point._x], [point._value])
    arguments = ca.reshape(ca.DM(program.arguments.tocsc()) @ x, point.arguments, program.points)
    y = ca.vec(function.map(program.points)(arguments))
    problem = {
        "x": x,
        "f": ca.dot(program.cost, x) + ca.dot(program.cost_of_outputs, y),
        "g": ca.DM(program.linear.tocsc()) @ x + ca.DM(program.nonlinear.tocsc()) @ y,
    }
    settings = {**SETTINGS, "ipopt.max_iter": MOST_ITERATIONS, "expand": expand}
    solver = ca.nlpsol("plain", "ipopt", problem, settings)

    def solve(start: np.ndarray) -> tuple[np.ndarray, float, int]:
        answer = solver(
            x0=start, lbx=program.least, ubx=program.most, lbg=program.low, ubg=program.high
        )
        said = solver.stats()
        return np.array(answer["x"]).ravel(), float(answer["f"]), said["iter_count"]

    return solve


MAKERS: dict[str, Callable[[Program], Solve]] = {
    "ours": ours,
    "CasADi, mapped": mapped,
    "CasADi, expanded": expanded,
}


def _ratios(rows: dict[str, list[dict[str, float]]], name: str) -> dict[str, float]:
    """Medians, in processor time, and how many times ours they are."""
    each = {k: [row["s"] / row["iterations"] for row in own] for k, own in rows.items()}
    pairs = list(zip(rows[name], rows["ours"], strict=True))
    return {
        "ms an iteration": 1e3 * statistics.median(each[name]),
        "times ours, an iteration": statistics.median(
            a / b for a, b in zip(each[name], each["ours"], strict=True)
        ),
        "times ours, a solve": statistics.median(a["s"] / b["s"] for a, b in pairs),
    }


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--starts", type=int, default=3)
    options.add_argument("--json", type=Path)
    given = options.parse_args()
    report: dict[str, Any] = {"load_before": machine.load()}
    use_threads(1)
    with_all = search()
    coarse, fine = with_all.grid(COARSE), with_all.grid(FINE)
    first = [with_all.solve(Draw(COARSE, (0, k), wild=False)) for k in range(given.starts)]
    starts = [refined(coarse, outcome.x, fine) for outcome in first if outcome.solved]
    solvers, made = {}, {}
    for name, make in MAKERS.items():
        begun = time.process_time()
        solvers[name] = make(fine.program)
        made[name] = time.process_time() - begun
    rows: dict[str, list[dict[str, float]]] = {name: [] for name in MAKERS}
    for start in starts:
        for name, solve in solvers.items():
            begun = time.process_time()
            _, objective, iterations = solve(start)
            seconds = time.process_time() - begun
            row = {"s": seconds, "iterations": iterations, "twists": -objective / (2 * np.pi)}
            rows[name].append(row)
            print(name, *(f"{what} {x:.4g}" for what, x in row.items()), sep="  ", flush=True)
    for name in MAKERS:
        report[name] = {"made in, s": made[name], "solves": rows[name], **_ratios(rows, name)}
        print(name, *(f"{k}: {v:.3g}" for k, v in _ratios(rows, name).items()), sep="\n  ")
    report["longest of ours, s"] = max(row["s"] for row in rows["ours"])
    print(f"the longest of ours: {report['longest of ours, s']:.2f} s (aim: below {AIM:g})")
    machine.finish(report, machine.load(), given.json)


if __name__ == "__main__":
    main()
