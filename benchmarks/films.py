"""A film of the gymnast, 1280 × 720, and the same scene by MuJoCo's renderer, if it works here.

Everything in one thread of one process; what counts is the processor's time. MuJoCo draws on
whatever GL there is (on machines without a GPU, Mesa's software EGL or OSMesa).
"""

from __future__ import annotations

import argparse
import os
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from machine import finish, load

os.environ.setdefault("MUJOCO_GL", "egl")

import numpy as np

import somersault as so
from somersault.view import film

SIZE, FRAMES = (1280, 720), 120


def ours(flight: so.Flight, folder: Path, **options: Any) -> Callable[[], None]:
    """A whole film: scene, frames, encoding, file."""
    speed = flight.times[-1] / (FRAMES - 1) * 30

    def run() -> None:
        film(flight, folder / "a.mp4", speed=speed, size=SIZE, **options)

    return run


def mujocos(flight: so.Flight) -> Callable[[], None] | None:
    """As many frames by `mujoco.Renderer`, not encoded; None where it does not work."""
    try:
        import mujoco

        text = so.model.mjcf(flight.model)
        head = (
            f'<visual><global offwidth="{SIZE[0]}" offheight="{SIZE[1]}"/>'
            '<quality offsamples="4"/></visual>'
        )
        floor = (
            '<worldbody><geom type="plane" size="5 5 .1" pos="0 0 -1.5"/>'
            '<light directional="true" dir="-.4 .3 -.8" pos="0 0 3"/>'
        )
        text = text.replace("<worldbody>", head + floor, 1)
        model = mujoco.MjModel.from_xml_string(text)
        data = mujoco.MjData(model)
        renderer = mujoco.Renderer(model, SIZE[1], SIZE[0])
    except Exception as error:
        print(f"MuJoCo's renderer does not work here: {' '.join(str(error).split())[:200]}")
        return None
    camera = mujoco.MjvCamera()
    camera.distance, camera.azimuth, camera.elevation = 4.0, 215.0, -12.0

    def run() -> None:
        for k in np.linspace(0, len(flight.times) - 1, FRAMES).astype(int):
            data.qpos[3:7] = flight.base_quaternion[k]
            data.qpos[7:] = flight.joint_coordinates[k]
            mujoco.mj_forward(model, data)
            renderer.update_scene(data, camera)
            renderer.render()

    return run


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--json", type=Path, help="write the numbers there too")
    chosen = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):  # one core, x264 and Mesa included
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    report: dict[str, Any] = {"load_before": load()}
    flight = so.arm_tilt().fly()
    with tempfile.TemporaryDirectory() as folder:
        contenders = {
            "film": ours(flight, Path(folder)),
            "film with charts and vectors": ours(
                flight, Path(folder), charts=True, vectors=("momentum", "spin")
            ),
            "MuJoCo's renderer, frames alone": mujocos(flight),
        }
        runs = {name: run for name, run in contenders.items() if run is not None}
        taken: dict[str, list[float]] = {name: [] for name in runs}
        for run in runs.values():
            run()
        for _ in range(chosen.rounds):
            for name, run in runs.items():
                start = time.process_time()
                run()
                taken[name].append(time.process_time() - start)
    for name, seconds in taken.items():
        rates = FRAMES / min(seconds), FRAMES / statistics.median(seconds)
        report[name] = {"frames_per_second": rates[0], "median": rates[1]}
        ratio = min(seconds) / min(taken["film"])
        print(f"{name:34} {rates[0]:7.1f} frames/s (median {rates[1]:.1f}), {ratio:.2f} × film")
    finish(report, load(), chosen.json)


if __name__ == "__main__":
    main()
