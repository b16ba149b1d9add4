"""Find the rudi: a front somersault with one and a half twists (Playter 1994, section 6.3.1).

    python scripts/rudi.py          # a few minutes; writes src/somersault/thesis/ch6/rudi.json
    python scripts/rudi.py gentle   # a quarter of an hour on two cores; rudi_gentle.json; needs cma

The gymnast takes off upright and piked with arms straight out at 12.6 rad/s. A quarter of a hula
movement (the legs swing from in front to the side, then under the body) tilts him; the arms are
wrapped, he twists; the arms open and the legs make a part of the movement backwards, which takes
the tilt out again; he ends upright in layout, arms straight out. The thesis programmed its
motion by hand and does not print it. Here a few timings and amplitudes are found by differential
evolution: attitude at landing, the greatest twist rate (40.2 rad/s) and small joint torques.

The gentle one is the fastest twist that bounded joint torques let, in up to 1.1 s, searched for by
CMA-ES: once with bounds that an athlete may have, and again with 1.5 and 2 times as much.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from pathlib import Path

import numpy as np
from scipy.optimize import differential_evolution

import somersault as so
from somersault.dynamics import Equations
from somersault.engine import use_threads
from somersault.ensembles import plan
from somersault.flight import flights

OUT = Path(__file__).parents[1] / "src/somersault/thesis/ch6/rudi.json"
GENTLE = OUT.with_name("rudi_gentle.json")
SOMERSAULT_RATE, TWIST_RATE = 12.6, 40.2  # rad/s, section 6.3.1
HALF_PI = np.pi / 2
WRAP = so.named_pose("gymnast", "wrap")
LANDINGS = (0.8, 0.85, 0.9)  # s
SHORTEST = 0.16  # s, of any move of the arms
SWING = 0.19  # s, of any move of the legs: they are heavy

# Name, lowest and highest value of each number that is searched for.
NUMBERS = {
    "pike": (1.2, 2.4),  # rad of hip flexion at takeoff
    "side": (0.1, 0.52),  # rad that the legs swing to the side
    "swing": (0.02, 0.15),  # s until the swing begins
    "swing_time": (SWING, 0.32),
    "extend": (0.0, 0.12),  # s after the swing begins until the hips extend
    "extend_time": (SWING, 0.35),
    "centre": (-0.05, 0.1),  # s after the extension until the legs are under the body
    "wrap": (0.05, 0.35),  # s until the arms come in
    "wrap_time": (SHORTEST, 0.30),
    "open": (0.05, 0.3),  # s that the arms stay in
    "open_time": (SHORTEST, 0.35),
    "late": (-0.1, 0.1),  # s by which the right arm opens later than the left
    "back": (-0.2, 0.1),  # s after the arms begin to open until the legs swing out again
    "back_side": (-0.52, 0.52),  # rad
    "back_time": (SWING, 0.3),  # s out, and again back
    "back_pike": (0.0, 0.9),
    "torso": (-0.5, 0.5),  # rad of torso twist while the legs swing
}
FIRST = 0.001  # s, before which nothing moves
ARM = ("shoulder_abduction", "shoulder_rotation", "shoulder_flexion", "elbow")


Numbers = Mapping[str, np.ndarray]
Paths = dict[str, tuple[np.ndarray, np.ndarray]]


def motion(n: Numbers, shortest: float = SWING) -> tuple[Paths, np.ndarray]:
    """Times (N, K) and angles (N, K) of every joint, and when all is done (N,), of numbers (N,).

    The legs take `shortest` at least to come back under the body.
    """
    zero = np.zeros(len(n["pike"]))
    swung = n["swing"] + n["swing_time"]
    extend = np.maximum(n["swing"] + n["extend"], FIRST)
    straight = np.maximum(extend + n["extend_time"], swung + 0.02)
    centred = np.maximum(straight + n["centre"], swung + shortest)
    early = n.get("early", zero)
    wraps = n["wrap"] + np.maximum(early, 0), n["wrap"] + np.maximum(-early, 0)
    opens = np.maximum(*wraps) + n["wrap_time"] + n["open"]
    opened = opens - np.minimum(n["late"], 0), opens + np.maximum(n["late"], 0)
    back = np.maximum(opens + n["back"], np.maximum(centred, straight) + 0.01)
    out = back + n.get("out_time", n["back_time"])
    home = out + n["back_time"]
    done = np.maximum(np.maximum(*opened) + n["open_time"], home)

    def path(times, angles):
        return np.stack(times, 1), np.stack([a + zero for a in angles], 1)

    found = {}
    for side, sign, wrap, opening in zip(("left", "right"), (1, -1), wraps, opened, strict=True):
        found[f"{side}_hip_flexion"] = path(
            (extend, straight, back, out, home), (n["pike"], 0, 0, n["back_pike"], 0)
        )
        found[f"{side}_hip_abduction"] = path(
            (n["swing"], swung, centred, back, out, home),
            (0, sign * n["side"], 0, 0, sign * n["back_side"], 0),
        )
        for joint in ARM:
            out_angle = HALF_PI if joint == "shoulder_abduction" else 0.0
            found[f"{side}_{joint}"] = path(
                (wrap, wrap + n["wrap_time"], opening, opening + n["open_time"]),
                (out_angle, WRAP[joint], WRAP[joint], out_angle),
            )
    found["torso_twist"] = path((n["swing"], swung, centred), (0, n["torso"], 0))
    return found, done


def named(x: np.ndarray, bounds: Mapping[str, tuple[float, float]]) -> Numbers:
    """Numbers (N,) by name, of rows (N, numbers)."""
    return dict(zip(bounds, x.T, strict=True))


def takeoff(paths: Paths, vary: dict[str, so.Vary]) -> so.Takeoff:
    """The takeoff of the first of many motions; how the others differ is added to `vary`."""
    joints = {}
    for joint, (times, angles) in paths.items():
        joints[joint] = so.JointTakeoff(times=times[0], angles=angles[0], motion="prescribed")
        for k in range(times.shape[1]):
            for what, values in (("times", times), ("angles", angles)):
                vary[f"{what}_{joint}_{k}"] = so.Vary(
                    sets=f"joints.{joint}.{what}.{k + 1}", samples=values[:, k]
                )
    return so.Takeoff(spin=SOMERSAULT_RATE, joints=joints)


def fly(x: np.ndarray, landing: float):
    """Dataset of the flights of numbers (N, 17) that end at `landing`, s."""
    paths, done = motion(named(x, NUMBERS))
    vary: dict[str, so.Vary] = {}
    first = takeoff(paths, vary)
    report = so.Report(
        ("somersault", "tilt", "twist", "somersault_rate", "tilt_rate", "twist_rate"),
        extremes=("twist_rate",),
    )
    flown = so.ensemble("gymnast", first, landing, vary, size=len(x), report=report, accuracy=1e-5)
    return flown.dataset, done


def cost(x: np.ndarray, landing: float) -> np.ndarray:
    """What is wrong with each motion (N,)."""
    data, done = fly(x, landing)
    twist = np.abs(data["twist"].values)
    fastest = np.maximum(data["greatest_twist_rate"].values, -data["least_twist_rate"].values)
    n = named(x, NUMBERS)
    wrong = (
        (data["somersault"].values - 2 * np.pi) ** 2
        + (twist - 3 * np.pi) ** 2
        + 4 * data["tilt"].values ** 2
        + 0.03 * ((fastest - TWIST_RATE) / 4) ** 2
        + 0.002 * (data["twist_rate"].values / 4) ** 2
        + 100 * np.maximum(done - landing, 0)
        # Torques go as accelerations, which at most are 5.8 amplitude / time².
        + 4e-5 * (n["side"] / n["swing_time"] ** 2) ** 2
        + 4e-5 * (n["back_side"] / n["back_time"] ** 2) ** 2
        + 1e-5 * (n["back_pike"] / n["back_time"] ** 2) ** 2
        + 0.02 * (n["torso"] ** 2 + n["late"] ** 2)
    )
    return np.where(np.isfinite(wrong), wrong, 1e3)


def search(landing: float, seed: int, generations: int = 350):
    """The best motion that lands then."""
    return differential_evolution(
        lambda x: cost(np.atleast_2d(x.T), landing), list(NUMBERS.values()), vectorized=True,
        updating="deferred", popsize=8, maxiter=generations, tol=1e-10, polish=False, rng=seed,
    )  # fmt: skip


# ------------------------------------------------------------------ with bounded torques

# N m at a joint, by what its name holds. Isometric maxima of a male gymnast in the RBDL library's
# torque muscles (M. Millard, 2016): hip 176 extending and 157 flexing, shoulder 44 to 128 by
# direction, elbow 70 extending and 101 flexing. Anderson, Madigan and Nussbaum (2007) have hip
# extension of young men at 0.161 ± 0.049 of weight times height, 200 ± 60 N m for this model. So
# these are a strong man's; the torso's, and the hips' to the side, are assumed.
BOUNDS = {"hip": 250.0, "shoulder": 150.0, "torso": 150.0, "elbow": 70.0}
TIMES = (1.0, 1.5, 2.0)  # the bounds
KEPT = 0.98  # of a bound: the search sees torques at samples only
SAMPLES, FINE = 81, 801  # of a flight: some peaks lie between the former
WITHIN = 0.02  # rad of somersault and twist, and of tilt, that is as good as none at landing
GENTLE_NUMBERS = NUMBERS | {
    "landing": (0.8, 1.1),
    "side": (0.05, 0.48),
    "swing": (0.005, 0.2),
    "swing_time": (0.12, 0.4),
    "extend": (-0.05, 0.25),
    "extend_time": (0.15, 0.5),
    "centre": (-0.3, 0.3),
    "wrap": (0.02, 0.5),
    "wrap_time": (0.12, 0.4),
    "early": (-0.1, 0.1),  # s by which the left arm comes in later than the right
    "open": (0.005, 0.4),
    "open_time": (0.12, 0.4),
    "back": (-0.3, 0.2),
    "back_side": (-0.48, 0.48),
    "out_time": (0.12, 0.45),
    "back_time": (0.12, 0.45),
    "back_pike": (0.0, 1.2),
    "torso": (-0.6, 0.6),
}
LOW, HIGH = np.array(list(GENTLE_NUMBERS.values())).T
GENTLE_SWING = 0.12  # s
READY = 0.01  # s before landing, when all is done
SEEDS = (4, 5)  # at the bounds themselves 1, 2 and 3 end 0.3 to 0.7 rad/s slower than 4
GENERATIONS, POPULATION = 600, 64


@cache
def equations() -> Equations:
    """Inverse dynamics and mass matrix."""
    return Equations("gymnast")


def followed(paths: Paths, times: np.ndarray) -> np.ndarray:
    """Angles, rates and accelerations (3, N, T, joints) of paths at times (N, T)."""
    found = []
    for joint in equations().model.speeds:
        knots, angles = (part[:, None] for part in paths[joint])
        span, by = np.diff(knots), np.diff(angles)
        s = np.clip((times[..., None] - knots[..., :-1]) / span, 0, 1)
        curves = (
            s**3 * (10 - 15 * s + 6 * s**2),
            30 * s**2 * (1 - s) ** 2 / span,
            60 * s * (1 - s) * (1 - 2 * s) / span**2,
        )
        path = np.array([(by * curve).sum(-1) for curve in curves])
        path[0] += angles[..., 0]
        found.append(path)
    return np.stack(found, -1)


def torques(paths: Paths, times: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """Joint torques (N, T, joints) of bodies that turn at omega (N, T, 3) on their way."""
    q, u, a = followed(paths, times)
    free = np.zeros((*omega.shape[:-1], 6))
    moving = np.concatenate([omega, free[..., :3], u], -1)
    loads = equations().inverse_dynamics(q, moving, np.concatenate([free, a], -1))
    inertia = equations().mass_matrix(q)
    # The base accelerates as it must for nothing to act on it.
    base = np.linalg.solve(inertia[..., :6, :6], -loads[..., :6, None])
    return loads[..., 6:] + (inertia[..., 6:, :6] @ base)[..., 0]


def strained(n: Numbers, samples: int = FINE):
    """What is told of the flights, peak torques (N, joints), greatest twist rates (N,) and when all
    is done (N,)."""
    paths, done = motion(n, GENTLE_SWING)
    landing = n["landing"]
    # All fly for one unit of time, their landing: rates go with it, and torques with its square.
    scaled = {joint: (times / landing[:, None], angles) for joint, (times, angles) in paths.items()}
    vary = {"spin": so.Vary(sets="takeoff.spin", samples=SOMERSAULT_RATE * landing)}
    first = takeoff(scaled, vary)
    turning = tuple(f"angular_velocity_{k}" for k in (1, 2, 3))
    report = so.Report(
        ("somersault", "tilt", "twist", "twist_rate"), extremes=("twist_rate",),
        history=turning, samples=samples,
    )  # fmt: skip
    # An ensemble's own flights, without the description that goes with its dataset: that takes
    # several times as long as some dozens of flights.
    many = flights(equations().model, first, 1.0, report=report, accuracy=1e-5, steps=3000)
    data = plan(many, vary).run(0, len(landing))
    omega = np.stack([data[f"{name}_history"] for name in turning], -1)
    times = np.broadcast_to(np.linspace(0, 1, samples), omega.shape[:-1])
    peaks = np.abs(torques(scaled, times, omega)).max(1) / landing[:, None] ** 2
    fastest = np.maximum(data["greatest_twist_rate"], -data["least_twist_rate"])
    return data, peaks, fastest / landing, done


def bounds() -> np.ndarray:
    """The bound of each joint."""
    groups = [next(g for g in BOUNDS if g in name) for name in equations().model.speeds]
    return np.array([BOUNDS[group] for group in groups])


def strain(x: np.ndarray, times: float, samples: int) -> np.ndarray:
    """How slow each motion (N, 20) twists, and how far it is from `times` the bounds, and from
    landing as it should."""
    n = named(x, GENTLE_NUMBERS)
    data, peaks, fastest, done = strained(n, samples)
    over = np.maximum(peaks / (times * KEPT * bounds()) - 1, 0)
    missed = (
        (data["somersault"] - 2 * np.pi, 30),
        (np.abs(data["twist"]) - 3 * np.pi, 30),
        (data["tilt"], 200),
    )
    wrong = (
        -fastest / 10
        + sum(by * np.maximum(np.abs(off) - WITHIN, 0) ** 2 for off, by in missed)
        + 0.001 * (data["twist_rate"] / n["landing"] / 4) ** 2
        + 20 * (over**2).sum(1) + 2 * over.sum(1)
        + 200 * np.maximum(done - n["landing"] + READY, 0)
    )  # fmt: skip
    return np.where(np.isfinite(wrong), wrong, 1e3)


def evolve(
    first: np.ndarray, width: float, times: float, generations: int, samples: int, seed: int
) -> tuple[float, np.ndarray]:
    """What is left wrong with the best motion within so many times the bounds, and its numbers;
    from numbers `first`, all as parts of their ranges."""
    import cma

    options = {
        "bounds": [0, 1], "popsize": POPULATION, "maxiter": generations, "seed": seed,
        "verbose": -9,
    }  # fmt: skip
    evolution = cma.CMAEvolutionStrategy(first, width, options)
    with use_threads(1):
        while not evolution.stop():
            asked = np.array(evolution.ask())
            wrong = strain(LOW + (HIGH - LOW) * asked, times, samples)
            evolution.tell(list(asked), list(wrong))
    print(f"{times:g} times, seed {seed}: {evolution.result.fbest:.4f}", flush=True)
    return evolution.result.fbest, LOW + (HIGH - LOW) * evolution.result.xbest


def fastest_within(task: tuple[float, int]) -> tuple[float, np.ndarray]:
    """A search from the best of some random motions."""
    times, seed = task
    first = np.random.default_rng(seed).random((2 * POPULATION, len(LOW)))
    first = first[np.argmin(strain(LOW + (HIGH - LOW) * first, times, SAMPLES))]
    return evolve(first, 0.25, times, GENERATIONS, SAMPLES, seed)


def refined(task: tuple[float, np.ndarray]) -> np.ndarray:
    """A search about a motion that sees all peaks of its torques."""
    times, x = task
    return evolve((x - LOW) / (HIGH - LOW), 0.01, times, GENERATIONS // 3, FINE, 1)[1]


def gentle() -> None:
    tasks = [(times, seed) for times in TIMES for seed in SEEDS]
    with ProcessPoolExecutor(2) as pool:
        found = dict(zip(tasks, pool.map(fastest_within, tasks), strict=True))
        best = [min((found[t, s] for s in SEEDS), key=lambda one: one[0])[1] for t in TIMES]
        best = list(pool.map(refined, zip(TIMES, best, strict=True)))
    front = []
    for times, x in zip(TIMES, best, strict=True):
        n = named(x[None], GENTLE_NUMBERS)
        data, peaks, fastest, _ = strained(n)
        joints = equations().model.speeds
        front.append({
            "times_bounds": times,
            "twist_rate": round(float(fastest[0]), 3),
            "tilt": round(float(data["tilt"][0]), 4),
            "peaks": {
                group: round(max(t for j, t in zip(joints, peaks[0], strict=True) if group in j), 1)
                for group in BOUNDS
            },
            "numbers": {name: float(value[0]) for name, value in n.items()},
        })  # fmt: skip
    numbers = front[0]["numbers"]
    paths, _ = motion({name: np.array([value]) for name, value in numbers.items()}, GENTLE_SWING)
    landing = numbers["landing"]
    write(GENTLE, landing, numbers, paths, {"bounds": BOUNDS, "front": front})


# ---------------------------------------------------------------------------- what is kept


def write(out: Path, landing: float, numbers: dict, paths: Paths, more: dict) -> None:
    """Keep the first of some motions as data."""
    record = {
        "model": "gymnast",
        "landing": landing,
        "spin": SOMERSAULT_RATE,
        "numbers": numbers,
        "joints": {
            name: {"times": times[0].round(6).tolist(), "angles": angles[0].round(6).tolist()}
            for name, (times, angles) in paths.items()
        },
    }
    out.write_text(json.dumps(record | more, indent=1) + "\n")


def main() -> None:
    found = {landing: search(landing, 1) for landing in LANDINGS}
    for landing, result in found.items():
        print(f"{landing:.2f} s: {result.fun:.5f}", flush=True)
    landing = min(found, key=lambda t: found[t].fun)
    numbers = dict(zip(NUMBERS, found[landing].x.tolist(), strict=True))
    paths, _ = motion(named(found[landing].x[None], NUMBERS))
    write(OUT, landing, numbers, paths, {})


if __name__ == "__main__":
    gentle() if sys.argv[1:] == ["gentle"] else main()
