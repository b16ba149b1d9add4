"""How fast a robot runs: one, and many at once, against MuJoCo alone.

    python benchmarks/robots.py [--rounds 3] [--json FILE]

MuJoCo alone is `mj_step` with the controls that the run had, recorded, from a loop in Python: what
the physics costs without any controller. See README.md beside this file.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import machine
import mujoco
import numpy as np

from somersault.engine import cores, use_threads
from somersault.robot import Control, End, Flip, Run, Runs, run_of
from somersault.robot._plant import Lane

SECONDS = 8.0
MANY = 32
CONTROL = Control(flip=Flip(at=3.0), end=End(steps_after=20))


def timed(rounds: int, work: Callable[[], object]) -> float:
    """Median wall-clock time, s."""
    found = []
    for _ in range(rounds):
        begin = time.perf_counter()
        work()
        found.append(time.perf_counter() - begin)
    return statistics.median(found)


def physics(runs: Runs, ran: Run) -> None:
    """The same steps of MuJoCo's, with the controls that were recorded."""
    lane = Lane(runs.robot)
    lane.begin(np.array(list(runs.values.values())))
    for drive in ran.drive:
        lane.data.ctrl[:] = drive
        for _ in range(runs.robot.machine.steps):
            mujoco.mj_step(lane.model, lane.data)


def main() -> None:
    """Time all of it and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--json", type=Path)
    chosen = parser.parse_args()
    before = machine.load()
    runs = Runs(control=CONTROL, duration=SECONDS)
    begin = time.perf_counter()
    runs.controller.loop.compile()
    compiled = time.perf_counter() - begin
    ran = run_of(runs, samples=1000)
    simulated = float(ran.times[-1])
    alone = timed(chosen.rounds, lambda: physics(runs, ran))
    one = timed(chosen.rounds, lambda: run_of(runs, samples=200))
    rows = {"MuJoCo alone, one": simulated / alone, "one run": simulated / one}
    values = {name: np.full(MANY, x) for name, x in runs.values.items()}
    total = MANY * simulated
    for threads in sorted({1, cores()}):
        with use_threads(threads):
            seconds = timed(chosen.rounds, lambda: runs.run(values, MANY))
        rows[f"{MANY} runs, {threads} thread{'s' * (threads > 1)}"] = total / seconds
    print(f"compiled once in {compiled:.2f} s; {simulated:.0f} s of running and one somersault")
    for name, factor in rows.items():
        print(f"  {name:26s} {factor:8.1f} times real time")
    report = {"compiled": compiled, "real_time_factors": rows, "load": before}
    machine.finish(report, machine.load(), chosen.json)


if __name__ == "__main__":
    main()
