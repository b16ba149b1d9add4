"""Two things that are no flights, which an ensemble can run all the same.

A pendulum in closed form, and boxes that are thrown on the ground in MuJoCo, several threads at a
time.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from typing import Any, ClassVar

import mujoco
import numpy as np

import somersault as so
from somersault.engine import threads
from somersault.simulation import ENDED, Endings, Name, Numbers, Target, Variable

GRAVITY = 9.81  # m/s2


@dataclass(frozen=True)
class Pendulum:
    """A damped pendulum of small swings, let go at rest: θ̈ + 2 d θ̇ + (g / l) θ = 0."""

    duration: float = 3.0
    samples: int = 5
    name = "pendulum"
    packages = ("numpy",)
    endings = Endings(("swinging", "creeping", "no pendulum"), ("no pendulum",), "no pendulum")
    together = 7
    units: ClassVar[dict[str, str]] = {"angle": "rad", "length": "m", "damping": "1/s"}

    @property
    def specification(self) -> dict[str, Any]:
        return {"pendulum": {"duration": self.duration, "samples": self.samples}}

    @property
    def values(self) -> dict[Name, float]:
        return {("angle",): 0.1, ("length",): 1.0, ("damping",): 0.2}

    @property
    def variables(self) -> dict[str, Variable]:
        return {
            "swings": Variable("1", "i4", words="whole swings"),
            "angle": Variable("rad"),
            "angle_history": Variable("rad", over_time=True),
        }

    @property
    def times(self) -> np.ndarray:
        return np.linspace(0.0, self.duration, self.samples)

    def targets(self, path: str) -> tuple[Target, ...]:
        what = path.removeprefix("pendulum.")
        if what not in self.units or what == path:
            raise so.SomersaultError(f"{path} is no number of a pendulum")
        return (Target((what,), unit=self.units[what]),)

    def with_varied(self, names: tuple[Name, ...]) -> Pendulum:
        return self

    def sound(self, values: Numbers, count: int) -> np.ndarray:
        return np.broadcast_to(np.asarray(values["length",]) > 0, count)

    def run(self, values: Numbers, count: int) -> Mapping[str, np.ndarray]:
        angle, length, damping = (
            np.broadcast_to(values[name,], count)[:, None] for name in self.units
        )
        w = np.sqrt(GRAVITY / length + 0j - damping**2)  # imaginary where it creeps
        t = self.times
        swing = np.cos(w * t) + damping / w * np.sin(w * t)
        history = np.real(angle * np.exp(-damping * t) * swing)
        return {
            "swings": np.floor(np.real(w[:, 0]) * self.duration / (2 * np.pi)).astype("i4"),
            "angle": history[:, -1],
            "angle_history": history,
            ENDED: (np.real(w[:, 0]) == 0).astype("u1"),
        }


BOX = """
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <geom name="ground" type="plane" size="5 5 1"/>
    <body><freejoint/><geom name="box" type="box" size=".1 .15 .2" density="500"/></body>
  </worldbody>
</mujoco>
"""


@cache
def box() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(BOX)


@dataclass(frozen=True)
class Boxes:
    """Boxes thrown on the ground, until they are at rest or `duration` is over."""

    duration: float = 1.0
    samples: int = 4
    name = "box"
    packages = ("numpy", "mujoco")
    endings = Endings(
        ("at rest", "moving", "unstable", "no throw"), ("unstable", "no throw"), "no throw"
    )
    together = 16
    units: ClassVar[dict[str, str]] = {
        "height": "m", "speed": "m/s", "spin": "rad/s", "friction": "1",
    }  # fmt: skip

    @property
    def specification(self) -> dict[str, Any]:
        return {"box": BOX, "duration": self.duration, "samples": self.samples}

    @property
    def values(self) -> dict[Name, float]:
        return {("height",): 0.6, ("speed",): 0.5, ("spin",): 3.0, ("friction",): 0.8}

    @property
    def variables(self) -> dict[str, Variable]:
        return {
            "time": Variable("s"),
            "slid": Variable("m", words="how far it came"),
            "hits": Variable("1", "i4", words="steps with contact"),
            "height_history": Variable("m", over_time=True),
        }

    @property
    def times(self) -> np.ndarray:
        return np.linspace(0.0, self.duration, self.samples)

    def targets(self, path: str) -> tuple[Target, ...]:
        if path not in self.units:
            raise so.SomersaultError(f"{path} is no number of a throw")
        return (Target((path,), unit=self.units[path]),)

    def with_varied(self, names: tuple[Name, ...]) -> Boxes:
        return self

    def sound(self, values: Numbers, count: int) -> np.ndarray:
        above, rough = np.asarray(values["height",]) > 0.3, np.asarray(values["friction",]) > 0
        return np.broadcast_to(above & rough, count)

    def run(self, values: Numbers, count: int) -> Mapping[str, np.ndarray]:
        rows = np.stack([np.broadcast_to(values[name,], count) for name in self.units], 1)
        with ThreadPoolExecutor(threads()) as pool:
            thrown = list(pool.map(self._throw, rows))
        return {
            "time": np.array([t for t, *_ in thrown]),
            "slid": np.array([x for _, x, *_ in thrown]),
            "hits": np.array([hits for _, _, hits, *_ in thrown], "i4"),
            "height_history": np.stack([heights for *_, heights, _ in thrown]),
            ENDED: np.array([self.endings.code(word) for *_, word in thrown], "u1"),
        }

    def _throw(self, row: np.ndarray) -> tuple[float, float, int, np.ndarray, str]:
        height, speed, spin, friction = row
        model = copy.copy(box())
        model.geom_friction[:, 0] = friction
        data = mujoco.MjData(model)
        data.qpos[2], data.qvel[0], data.qvel[4] = height, speed, spin
        heights, hits = np.full(self.samples, np.nan), 0
        while data.time < self.duration:
            k = np.searchsorted(self.times, data.time, side="right") - 1
            if np.isnan(heights[k]):
                heights[k] = data.qpos[2]
            mujoco.mj_step(model, data)
            hits += bool(data.ncon)
            if data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number or abs(data.qpos[2]) > 50:
                return np.nan, np.nan, hits, np.full(self.samples, np.nan), "unstable"
            if hits and np.abs(data.qvel).max() < 0.02:
                return data.time, data.qpos[0], hits, heights, "at rest"
        heights[-1] = data.qpos[2]
        return data.time, data.qpos[0], hits, heights, "moving"
