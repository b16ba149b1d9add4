"""Tune the half twist of the 3D Biped with a weight (Playter 1994, section 6.4); needs cma.

    python scripts/biped_half_twist.py found.toml        # half an hour on two cores
    python scripts/biped_half_twist.py found.toml 20     # so many generations

It begins with `somersault/robot/half_twist.toml`, and writes what it finds as such a file. The
numbers in there were found so in stages of some ten generations, from those of a somersault on, as
the errors grew from 0.3 times those that count to 1.5 times. Each candidate makes the same attempts
as all others of its generation, with errors by `LEVEL` times as great, drawn anew for the next.
What an attempt costs is how early it falls, how far from backwards it lands, and a little of its
tilt. The attempts that the thesis's chapter counts have another seed, `_scatter.HELD_OUT`.

Numbers that lie near the separatrix do well in one generation and badly in the next: there half of
the attempts land facing forwards. Hence errors greater than those that count.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from somersault.robot import Control, End, Robot, Runs, maneuver
from somersault.thesis.ch3._scatter import scatter

SEED = 5
LEVEL = 1.3
ATTEMPTS = 10
CANDIDATES = 14
STEPS = 10
WIDTH = 0.3  # of the first generation, in the units below

# What is tuned, and by how much it is sensible to change it.
UNITS = {
    ("running", "speed_gain"): 0.015, ("running", "turning_friction"): 0.005,
    ("flip", "hurdle_speed"): 0.25, ("flip", "hurdle_pitch"): 0.08, ("flip", "foot"): 0.04,
    ("flip", "width"): 0.05, ("flip", "leg_length"): 0.03, ("flip", "torque"): 60.0,
    ("flip", "lift_off_speed"): 0.4, ("flip", "feet_back"): 0.1, ("flip", "attitude"): 0.15,
    ("flip", "window"): 0.03, ("flip", "landing_foot"): 0.04, ("flip", "landing_speed"): 0.3,
    ("flip", "landing_gain"): 0.02, ("flip", "landing_stiffness"): 150.0,
    ("flip", "landing_damping"): 40.0, ("flip", "landing_lift_off"): 0.15, ("flip", "hold"): 0.03,
    ("twist", "wind_up"): 0.1, ("twist", "lean"): 0.06, ("twist", "pitch_rate"): 0.5,
    ("twist", "yaw_rate"): 1.0, ("twist", "lift_off_speed"): 0.2, ("twist", "pace"): 0.4,
    ("twist", "pitch_damping"): 100.0, ("twist", "roll_stiffness"): 500.0,
    ("twist", "roll_damping"): 60.0, ("twist", "yaw_damping"): 30.0, ("twist", "torque"): 40.0,
    ("twist", "straddle"): 0.15, ("twist", "straddle_gain"): 0.2,
    ("twist", "sideways_gain"): 0.02, ("twist", "landing_roll_stiffness"): 300.0,
    ("twist", "landing_roll_damping"): 40.0, ("twist", "landing_yaw_damping"): 15.0,
    ("twist", "turn_rate"): 0.3,
}  # fmt: skip


def nominal() -> Runs:
    """The runs of a candidate, which begin their hurdle at once."""
    control = maneuver("half_twist")
    flip = replace(control.flip, at=0.8)
    control = replace(control, flip=flip, end=End(steps_after=STEPS))
    return Runs(Robot("biped_weighted"), control, 10.5)


def costs(runs: Runs, candidates: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Mean cost of each candidate (candidates, numbers), over attempts whose errors are normals
    (attempts, errors)."""
    shape = len(candidates), len(normals)
    given = {name: np.full(shape, value) for name, value in runs.values.items()}
    for column, name in zip(candidates.T, UNITS, strict=True):
        given[name] = np.broadcast_to(column[:, None], shape).copy()
    for vary, normal in zip(scatter(LEVEL).values(), normals.T, strict=True):
        mean, deviation = vary.normal
        (target,) = runs.targets(vary.sets or vary.adds_to)
        before = 0.0 if vary.sets else given[target.name]
        given[target.name] = np.broadcast_to(before + mean + deviation * normal, shape)
    rows = {name: values.reshape(-1) for name, values in given.items()}
    found = runs.run(rows, shape[0] * shape[1])
    off, tilt, over = (
        np.degrees(found[f"landing_{name}"]) for name in ("twist", "tilt", "somersault")
    )
    landed = np.isfinite(off)
    steps = np.minimum(found["steps_after"], STEPS) / STEPS
    cost = 2 * (1 - steps) + 0.8 * _short(off - 180, 60) + 0.2 * _short(tilt, 25)
    cost = np.where(landed, cost + 0.1 * _short(over - 360, 40), 4.0)
    return cost.reshape(shape).mean(1)


def _short(error: np.ndarray, much: float) -> np.ndarray:
    return np.minimum(1, (np.nan_to_num(error) / much) ** 2)


def toml(control: Control) -> str:
    """The tables that a maneuver's file has."""
    lines = ["# A front somersault with half a twist, for the model biped_weighted (section 6.4).",
             "# Tuned by scripts/biped_half_twist.py."]  # fmt: skip
    for (table, name), value in control.numbers().items():
        if table not in ("running", "hips", "flip", "twist") or name == "at":
            continue
        if f"[{table}]" not in lines:
            lines += ["", f"[{table}]"]
        lines.append(f"{name} = {value!r}")
    return "\n".join(lines) + "\n"


def main(path: Path, generations: int) -> None:
    """Search, and write the best so far after each generation."""
    import cma

    runs, chance = nominal(), np.random.default_rng(SEED)
    units = np.array(list(UNITS.values()))
    first = np.array([runs.values[name] for name in UNITS])
    evolution = cma.CMAEvolutionStrategy(
        np.zeros(len(units)), WIDTH, {"popsize": CANDIDATES, "seed": SEED, "verbose": -9}
    )
    for generation in range(generations):
        asked = evolution.ask()
        candidates = first + units * np.array(asked)
        normals = chance.standard_normal((ATTEMPTS, len(scatter())))
        found = costs(runs, candidates, normals)
        evolution.tell(asked, found.tolist())
        best = first + units * evolution.result.xfavorite
        tables: dict[str, dict[str, float]] = {}
        for (table, name), value in zip(UNITS, best.tolist(), strict=True):
            tables.setdefault(table, {})[name] = float(f"{value:.4g}")
        control = replace(runs.control, **{
            table: replace(getattr(runs.control, table), **numbers)
            for table, numbers in tables.items()
        })  # fmt: skip
        path.write_text(toml(control), encoding="utf-8")
        print(f"{generation}: least {found.min():.3f}, mean {found.mean():.3f}", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 40)
