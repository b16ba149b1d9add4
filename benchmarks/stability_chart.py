"""A stability chart of the layout model, 601 × 301 springs and arm angles.

Against what one would otherwise do for each point: linearise MuJoCo's dynamics by finite
differences (mjd_transitionFD) and take the eigenvalues; and our own `linear`, one by one.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np

import somersault as so

STIFFNESS, ANGLES = np.linspace(-2, 4, 601), np.linspace(0, 3, 301)


def chart() -> None:
    """All 180,901 points at once."""
    so.stability.chart("furrer", ("stiffness.shoulder", STIFFNESS), ("pose.shoulder", ANGLES))


def one_by_one(count: int) -> Callable[[], None]:
    """`count` points, each a spin and its linear system of its own."""

    def run() -> None:
        for angle in ANGLES[:count]:
            _ = so.spin("furrer", pose={"shoulder": angle}).linear({"shoulder": 1.0}).stable

    return run


def by_mujoco(count: int) -> Callable[[], None]:
    """`count` points: springs set, dynamics linearised by differences, eigenvalues taken."""
    file = Path(so.__file__).parent / "model/shipped/furrer.xml"
    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    a = np.zeros((2 * model.nv, 2 * model.nv))

    def run() -> None:
        for angle in ANGLES[:count]:
            model.jnt_stiffness[1:] = 0.385
            data.qpos[7:] = angle, -angle
            data.qvel[4] = 1.0
            mujoco.mjd_transitionFD(model, data, 1e-6, True, a, None, None, None)
            np.linalg.eigvals(a)

    return run


def seconds(run: Callable[[], None], rounds: int) -> tuple[float, float]:
    """Least and median time of some rounds, after one that does not count."""
    run()
    taken = []
    for _ in range(rounds):
        start = time.perf_counter()
        run()
        taken.append(time.perf_counter() - start)
    return min(taken), statistics.median(taken)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, help="write the numbers there too")
    chosen = parser.parse_args()
    points = len(STIFFNESS) * len(ANGLES)
    found = {"load": os.getloadavg()[0]}
    for name, run, each, rounds in (
        ("chart", chart, points, 7),
        ("one by one", one_by_one(301), 301, 5),
        ("mujoco differences", by_mujoco(301), 301, 5),
    ):
        least, median = seconds(run, rounds)
        found[name] = {"seconds": least, "median": median, "us_a_point": least / each * 1e6}
        print(f"{name:20} {least:8.3f} s (median {median:.3f})  {least / each * 1e6:9.2f} µs/point")
    ratio = found["mujoco differences"]["us_a_point"] / found["chart"]["us_a_point"]
    print(f"a point by MuJoCo's differences costs {ratio:.0f} times a point of the chart")
    if chosen.json:
        chosen.json.write_text(json.dumps(found, indent=2))


if __name__ == "__main__":
    main()
