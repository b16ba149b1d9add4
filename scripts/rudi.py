"""Find the rudi: a front somersault with one and a half twists (Playter 1994, section 6.3.1).

    python scripts/rudi.py          # a few minutes; writes src/somersault/thesis/rudi.json

The gymnast takes off upright and piked with arms straight out at 12.6 rad/s. A quarter of a hula
movement (the legs swing from in front to the side, then under the body) tilts him; the arms are
wrapped, he twists; the arms open and the legs make a part of the movement backwards, which takes
the tilt out again; he ends upright in layout, arms straight out. The thesis programmed its
motion by hand and does not print it. Here a few timings and amplitudes are found by differential
evolution: attitude at landing, the greatest twist rate (40.2 rad/s) and small joint torques.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from scipy.optimize import differential_evolution

import somersault as so

OUT = Path(__file__).parents[1] / "src/somersault/thesis/rudi.json"
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
NAMES = list(NUMBERS)
ARM = ("shoulder_abduction", "shoulder_rotation", "shoulder_flexion", "elbow")


def motion(x: np.ndarray) -> tuple[dict[str, tuple[np.ndarray, np.ndarray]], np.ndarray]:
    """Times (N, K) and angles (N, K) of every joint, and when all is done (N,), of numbers
    (N, 17)."""
    n = dict(zip(NAMES, x.T, strict=True))
    zero = np.zeros(len(x))
    swung = n["swing"] + n["swing_time"]
    extend = n["swing"] + n["extend"]
    straight = np.maximum(extend + n["extend_time"], swung + 0.02)
    centred = np.maximum(straight + n["centre"], swung + SWING)
    wrapped = n["wrap"] + n["wrap_time"]
    opens = wrapped + n["open"]
    left, right = opens - np.minimum(n["late"], 0), opens + np.maximum(n["late"], 0)
    back = np.maximum(opens + n["back"], np.maximum(centred, straight) + 0.01)
    out, home = back + n["back_time"], back + 2 * n["back_time"]
    done = np.maximum(np.maximum(left, right) + n["open_time"], home)

    def path(times, angles):
        return np.stack(times, 1), np.stack([a + zero for a in angles], 1)

    found = {}
    for side, sign, opening in (("left", 1, left), ("right", -1, right)):
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
                (n["wrap"], wrapped, opening, opening + n["open_time"]),
                (out_angle, WRAP[joint], WRAP[joint], out_angle),
            )
    found["torso_twist"] = path((n["swing"], swung, centred), (0, n["torso"], 0))
    return found, done


def fly(x: np.ndarray, landing: float):
    """Dataset of the flights of numbers (N, 17) that end at `landing`, s."""
    paths, done = motion(x)
    joints, vary = {}, {}
    for joint, (times, angles) in paths.items():
        joints[joint] = so.JointTakeoff(times=times[0], angles=angles[0], motion="prescribed")
        for k in range(times.shape[1]):
            for what, values in (("times", times), ("angles", angles)):
                vary[f"{what}_{joint}_{k}"] = so.Vary(
                    sets=f"joints.{joint}.{what}.{k + 1}", samples=values[:, k]
                )
    takeoff = so.Takeoff(spin=SOMERSAULT_RATE, joints=joints)
    report = so.Report(
        ("somersault", "tilt", "twist", "somersault_rate", "tilt_rate", "twist_rate"),
        extremes=("twist_rate",),
    )
    flown = so.ensemble(
        "gymnast", takeoff, landing, vary, size=len(x), report=report, accuracy=1e-5
    )
    return flown.dataset, done


def cost(x: np.ndarray, landing: float) -> np.ndarray:
    """What is wrong with each motion (N,)."""
    data, done = fly(x, landing)
    twist = np.abs(data["twist"].values)
    fastest = np.maximum(data["greatest_twist_rate"].values, -data["least_twist_rate"].values)
    n = dict(zip(NAMES, x.T, strict=True))
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


def main() -> None:
    found = {landing: search(landing, 1) for landing in LANDINGS}
    for landing, result in found.items():
        print(f"{landing:.2f} s: {result.fun:.5f}", flush=True)
    landing = min(found, key=lambda t: found[t].fun)
    paths, _ = motion(found[landing].x[None])
    record = {
        "model": "gymnast",
        "landing": landing,
        "spin": SOMERSAULT_RATE,
        "numbers": dict(zip(NAMES, found[landing].x.tolist(), strict=True)),
        "joints": {
            name: {"times": times[0].round(6).tolist(), "angles": angles[0].round(6).tolist()}
            for name, (times, angles) in paths.items()
        },
    }
    OUT.write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    main()
