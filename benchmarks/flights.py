"""Whole flights, here and elsewhere, in the same run, at the same accuracy of attitude.

    python benchmarks/flights.py [--rounds 5] [--json FILE]

MuJoCo's step is found first, by halving against a tight reference; then all contenders take
turns. See README.md beside this file for what each line means.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import flight_cases as cases
import numpy as np
from flight_others import matching_step, mujoco_timer, pinocchio_timer, scipy_timer

from somersault.dynamics._kernel import threads as threads_here

LAYOUT_ACCURACIES, GYMNAST_ACCURACIES = (1e-7, 1e-9), (1e-6, 1e-9)
AIMS = {"layout": 300.0, "gymnast": 100.0, "one flight": 10.0}


def matching_tolerance(case: cases.Case, accuracy: float) -> float:
    """The loosest tolerance, by factors of √10, at which our attitudes are as accurate."""
    tolerance = accuracy * 10
    while cases.error(case, case.solve(tolerance).final) > accuracy:
        tolerance /= 10**0.5
    return tolerance


def measured(timers: dict[str, Callable[[], float]], rounds: int) -> dict[str, dict[str, float]]:
    """Least and median seconds of each timer, the timers taking turns."""
    values: dict[str, list[float]] = {name: [] for name in timers}
    for timer in timers.values():
        timer()
    for _ in range(rounds):
        for name, timer in timers.items():
            values[name].append(timer())
    return {n: {"min": min(v), "median": statistics.median(v)} for n, v in values.items()}


def ours_timer(case: cases.Case, tolerance: float) -> Callable[[], float]:
    """Seconds of all flights in one batch, on all threads, over a share of a second."""
    begun = time.perf_counter()
    case.solve(tolerance)
    repeats = max(1, int(0.1 / (time.perf_counter() - begun)))

    def measure() -> float:
        start = time.perf_counter()
        for _ in range(repeats):
            case.solve(tolerance)
        return (time.perf_counter() - start) / repeats

    return measure


def benchmark(case: cases.Case, accuracies: tuple[float, ...], rounds: int) -> dict:
    """One case at each accuracy; times are of all its flights."""
    result: dict = {"flights": case.flights, "calm": int(case.calm.sum()), "accuracies": {}}
    for accuracy in accuracies:
        tolerance = matching_tolerance(case, accuracy)
        step, step_error = matching_step(case, accuracy)
        found = case.solve(tolerance)
        timers = {
            "ours": ours_timer(case, tolerance),
            "MuJoCo rollout RK4": mujoco_timer(case, step),
            "SciPy DOP853, our right-hand side": scipy_timer(case, tolerance),
        }
        extra = pinocchio_timer(case, step)
        if extra is not None:
            timers["pinocchio aba, RK4"] = extra
        times = measured(timers, rounds)
        result["accuracies"][f"{accuracy:g}"] = {
            "tolerance": tolerance,
            "error": cases.error(case, found.final),
            "steps": float(found.steps.mean()),
            "mujoco_step": step,
            "mujoco_error": step_error,
            "seconds": times,
            "ratio": {
                which: times["MuJoCo rollout RK4"][which] / times["ours"][which]
                for which in ("min", "median")
            },
        }
    return result


def one_flight(repeats: int = 50) -> dict[str, float]:
    """Seconds of `fly` and its dataset in a warm process."""
    values = []
    for _ in range(repeats + 3):
        start = time.perf_counter()
        cases.one_flight().dataset  # noqa: B018 (computes)
        values.append(time.perf_counter() - start)
    return {"min": min(values[3:]), "median": statistics.median(values[3:])}


def table(name: str, result: dict) -> str:
    """One case's numbers as plain text."""
    lines = [f"{name}: {result['flights']} flights, {result['calm']} of them not tumbling"]
    for accuracy, own in result["accuracies"].items():
        lines += [
            f"  attitude to {accuracy} rad: ours tolerance {own['tolerance']:.1e}, error "
            f"{own['error']:.1e}, {own['steps']:.0f} steps a flight; MuJoCo step "
            f"{own['mujoco_step'] * 1e3:.4g} ms, error {own['mujoco_error']:.1e}",
            f"    {'µs a flight':<40}{'least':>12}{'median':>12}{'× ours':>9}",
        ]
        base = own["seconds"]["ours"]["min"]
        for what, value in own["seconds"].items():
            per = {k: v / result["flights"] * 1e6 for k, v in value.items()}
            lines.append(
                f"    {what:<40}{per['min']:>12.1f}{per['median']:>12.1f}{value['min'] / base:>9.0f}"
            )
        lines.append(
            f"    MuJoCo / ours: {own['ratio']['min']:.0f} by the least times, "
            f"{own['ratio']['median']:.0f} by the medians (aim: at least {AIMS[name]:.0f})"
        )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5, help="measurements of each contender")
    parser.add_argument("--json", type=Path, help="write the numbers here as well")
    options = parser.parse_args()
    before = os.getloadavg() if hasattr(os, "getloadavg") else None
    print(f"{threads_here()} threads; load of the machine before: {before}", flush=True)
    report: dict = {"threads": threads_here(), "load_before": before}
    for case, accuracies in (
        (cases.layout(), LAYOUT_ACCURACIES),
        (cases.gymnast_flights(), GYMNAST_ACCURACIES),
    ):
        report[case.name] = benchmark(case, accuracies, options.rounds)
        print("\n" + table(case.name, report[case.name]), flush=True)
    single = one_flight()
    report["one flight"] = single
    print(
        f"\none flight of eight somersaults with its dataset: median {single['median'] * 1e3:.1f} "
        f"ms, least {single['min'] * 1e3:.1f} ms (aim: less than {AIMS['one flight']:.0f})"
    )
    report["load_after"] = os.getloadavg() if hasattr(os, "getloadavg") else None
    print(f"load of the machine after: {report['load_after']}")
    if options.json is not None:
        options.json.write_text(json.dumps(report, indent=2) + "\n")


if __name__ == "__main__":
    main()
