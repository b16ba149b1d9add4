"""What derivatives of a landing cost, against the flight itself, in the same run.

    python benchmarks/sensitivity.py [--rounds 9] [--json FILE]

See README.md beside this file for what each line means.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import machine
import numpy as np

import somersault as so
from somersault.engine import MOST_STEPS, use_threads
from somersault.flight._along import Along
from somersault.flight._batch import TOLERANCE_PER_ACCURACY, Begun
from somersault.flight._directions import Directions, of_numbers, of_state, sizes
from somersault.flight._recorded_along import with_recordings
from somersault.flight._sensitivity import watched_batch
from somersault.flight._targets import targets

MANY = 16  # times all directions of a flight
TOLERANCE = 1e-9 * TOLERANCE_PER_ACCURACY  # that of an attitude to 1e-9 rad


def layout() -> tuple[Begun, Directions]:
    """Along its motion at takeoff."""
    arms = {"shoulder": so.JointTakeoff.sprung(angle=1.4, K=1.2, hold=True)}
    return _from_takeoff(so.Maneuver("furrer", so.Takeoff(tilt=0.01, spin=8.64, joints=arms), 5.82))


def gymnast() -> tuple[Begun, Directions]:
    """Along its motion at takeoff: paths and motor tape stay."""
    return _from_takeoff(_compliant())


def moves_of_gymnast() -> tuple[Begun, Directions]:
    """Along numbers that move its paths, and so change its motor tape."""
    batch = watched_batch(_compliant())
    shoulders = ("left_shoulder_abduction", "right_shoulder_abduction")
    names = [f"joints.{n}.{what}.2" for n in shoulders for what in ("times", "angles")]
    meant = [targets(batch, name) for name in names]
    varied = tuple(dict.fromkeys(target.name for one in meant for target in one))
    begun = batch.differing_in(varied, ()).begun()
    by = sizes(begun.batch, meant)
    along = of_numbers(begun, names, meant, by)
    return begun, with_recordings(begun, along, names, meant, by)


def _compliant() -> so.Maneuver:
    return so.arm_tilt().compliant(30.0, pose="wrap").off_nominal(tilt=-0.05)


def _from_takeoff(maneuver: so.Maneuver) -> tuple[Begun, Directions]:
    begun = watched_batch(maneuver).begun()
    return begun, of_state(begun)


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rounds", type=int, default=9)
    options.add_argument("--json", type=Path)
    given = options.parse_args()
    report = {"load_before": machine.load()}
    use_threads(1)
    for case in (layout, gymnast, moves_of_gymnast):
        report[case.__name__] = measured(*case(), given.rounds)
        print(
            case.__name__, *(f"{k}: {v:.3g}" for k, v in report[case.__name__].items()), sep="\n  "
        )
    machine.finish(report, machine.load(), given.json)


def measured(begun: Begun, one: Directions, rounds: int) -> dict[str, float]:
    """Times of one thread, ms, the least and the median, and their ratios."""
    many = Directions(
        _often(one.rows), _often(one.still), [(_often(k), _often(c)) for k, c in one.paths]
    )
    end, tolerance = np.array([begun.batch.duration]), TOLERANCE
    rows = np.repeat(begun.rows, len(many.rows), 0)
    calls: dict[str, Callable[[], object]] = {
        "one flight": lambda: begun.course.solve(begun.rows, end, tolerance),
        "one flight along all": lambda: Along(begun, one).solve(end, tolerance, MOST_STEPS),
        "many flights": lambda: begun.course.solve(rows, end, tolerance),
        "many directions": lambda: Along(begun, many).solve(end, tolerance, MOST_STEPS),
    }
    times: dict[str, list[float]] = {name: [] for name in calls}
    for turn in range(rounds + 1):
        for name, call in calls.items():
            start = time.process_time()
            call()
            if turn:  # the first one compiles
                times[name].append(1e3 * (time.process_time() - start))
    result: dict[str, float] = {"directions": len(one.rows)}
    for name, own in times.items():
        result |= {f"{name}, least ms": min(own), f"{name}, median ms": statistics.median(own)}
    for how in ("least", "median"):
        alone = result[f"one flight along all, {how} ms"] / result[f"one flight, {how} ms"]
        result[f"a direction over a flight alone, {how}"] = alone / len(one.rows)
        together = result[f"many directions, {how} ms"] / result[f"many flights, {how} ms"]
        result[f"a direction of many over a flight of many, {how}"] = together
    return result


def _often(numbers: np.ndarray) -> np.ndarray:
    return np.tile(numbers, (MANY, *[1] * (numbers.ndim - 1)))


if __name__ == "__main__":
    main()
