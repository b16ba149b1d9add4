"""Whole flights, here and elsewhere, in the same run, at the same accuracy of attitude.

    python benchmarks/flights.py [--rounds 5] [--json FILE]

MuJoCo's step is found first, by halving against a tight reference; then all contenders take
turns. See README.md beside this file for what each line means.
"""

from __future__ import annotations

import argparse
import copy
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import machine
import mujoco
import mujoco.rollout
import numpy as np
from gymnast import gymnast
from others import pinocchio_timers, state_of
from scipy.integrate import solve_ivp

from somersault.attitude import quaternion_conjugate, quaternion_product
from somersault.engine import Kernel, Solution
from somersault.engine import threads as threads_here
from somersault.flight import Batch, Begun, Flight, JointTakeoff, Takeoff, fly
from somersault.flight._system import System
from somersault.model import Model, load
from somersault.stability import spin as steady_spin

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from trees import mujoco_addresses, to_mujoco

SPIN, TURNS = 8.64, 8  # rad/s; somersaults of a layout flight
DURATION = TURNS * 2 * np.pi / SPIN
TIMED = 16  # flights that MuJoCo is timed over; its time a flight depends on nothing else
CHUNK = 500  # steps that its rollout keeps at a time
ACCURACIES = {"layout": (1e-7, 1e-9), "gymnast": (1e-6, 1e-9)}
AIMS = {"layout": 300.0, "gymnast": 100.0, "one flight": 10.0}


# ----------------------------------------------------------------------------- the flights


@dataclass(frozen=True)
class Case:
    """Many flights of one model, that differ in their numbers alone."""

    name: str
    model: Model
    starts: list[Begun]
    duration: float

    @property
    def system(self) -> System:
        return self.starts[0].batch.system

    @cached_property
    def states(self) -> np.ndarray:
        return np.concatenate([begun.rows for begun in self.starts])

    @cached_property
    def parameters(self) -> np.ndarray:
        begin = np.zeros((1, 1))
        return np.concatenate([b.course.parameters(begin)[:, 0] for b in self.starts])

    @cached_property
    def reference(self) -> np.ndarray:
        """Attitudes at the end, as tightly as they can be had."""
        return self.solve(1e-14).final[:, :4]

    def matched(self, accuracy: float) -> np.ndarray:
        """Up to 48 flights, spread over all, that accuracies are compared on.

        All but those that multiply errors so much that two tight solutions differ by more than
        a twentieth of the accuracy: nobody knows those well enough to compare.
        """
        other = self.solve(4e-14).final[:, :4]
        known = np.flatnonzero(_turns(self.reference, other) < accuracy / 20)
        return known[:: max(1, len(known) // 48)]

    def solve(self, tolerance: float) -> Solution:
        end = np.array([self.duration])
        return self.system.integrator.solve(self.states, self.parameters, end, tolerance)

    def error(self, which: np.ndarray, quaternions: np.ndarray) -> float:
        """Largest error of attitude at the end among some flights, rad."""
        return float(_turns(self.reference[which], quaternions).max())


def _turns(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Angles between attitudes, rad."""
    turn = quaternion_product(quaternion_conjugate(first), second)
    return 2 * np.linalg.norm(turn[:, 1:], axis=1)


def layout() -> Case:
    """The grid of figure 4-12: eight somersaults of furrer for 361 arm angles and springs."""
    model, starts = load("furrer"), []
    for angle in np.linspace(0.4, 2.2, 19):
        nominal = steady_spin(model, 2, {"shoulder": angle})
        inertia = nominal.outboard_inertias["left_shoulder"]
        for stiffness in np.linspace(0.0, 1.8, 19):
            k = stiffness * SPIN**2 * inertia
            joints = {
                f"{name}_shoulder": JointTakeoff(
                    "sprung", side * angle, stiffness=k, hold=k > 0, damping=0.0
                )
                for name, side in (("left", 1), ("right", -1))
            }
            takeoff = Takeoff(tilt=0.01, spin=SPIN, joints=joints)
            starts.append(Batch(model, takeoff, DURATION).begun())
    return Case("layout", model, starts, DURATION)


def gymnast_flights(count: int = 256) -> Case:
    """A compliant gymnast: springs of 8 rad/s and light dampers in all thirteen hinges."""
    model, starts, rng = gymnast(), [], np.random.default_rng(6)
    nominal = steady_spin(model)
    for _ in range(count):
        joints = {}
        for joint in model.joints:
            k = 8.0**2 * nominal.outboard_inertias[joint.name]
            angle, rest = 0.12 * rng.normal(size=2)  # none comes near a gimbal lock
            joints[joint.name] = JointTakeoff(
                "sprung", angle, stiffness=k, damping=k / 8.0 * 0.4, rest=rest
            )
        omega = np.array([0.0, 6.0, 0.0]) + 0.3 * rng.normal(size=3)
        takeoff = Takeoff(tilt=0.1, angular_velocity=omega, joints=joints)
        starts.append(Batch(model, takeoff, 1.5).begun())
    return Case("gymnast", model, starts, 1.5)


def stable_layout() -> Flight:
    """Eight somersaults of a stable layout, as a user asks for them."""
    joints = {
        f"{name}_shoulder": JointTakeoff("sprung", side * 1.4, stiffness=34.5, hold=True)
        for name, side in (("left", 1), ("right", -1))
    }
    begun = Takeoff(tilt=0.01, spin=SPIN, joints=joints)
    return fly("furrer", begun, TURNS * 2 * np.pi / SPIN)


# -------------------------------------------------------------------------------- the others


class InMujoco:
    """The same flights in MuJoCo's threaded rollout of its Runge–Kutta integrator."""

    def __init__(self, case: Case, which: np.ndarray, step: float) -> None:
        self.steps = max(1, round(case.duration / step))
        m = to_mujoco(case.model, case.duration / self.steps)
        off = mujoco.mjtDisableBit
        for bit in (off.mjDSBL_CONSTRAINT, off.mjDSBL_SENSOR, off.mjDSBL_GRAVITY):
            m.opt.disableflags |= int(bit)
        m.opt.enableflags = 0
        q_at, v_at = mujoco_addresses(case.model, m)
        self.kind, self.models, rows = mujoco.mjtState.mjSTATE_FULLPHYSICS, [], []
        for start_ in (case.starts[k].start for k in which):
            own, d = copy.copy(m), mujoco.MjData(m)
            own.qpos_spring[q_at] = [
                does.rest + (does.pretension / does.stiffness if does.stiffness else 0.0)
                for does in (plan.does for plan in start_.plans)
            ]
            for plan in start_.plans:
                joint = own.joint(plan.joint.name)
                own.jnt_stiffness[joint.id] = plan.does.stiffness
                own.dof_damping[joint.dofadr[0]] = plan.does.damping
            d.qpos[3:7], d.qvel[3:6] = start_.quaternion, start_.omega
            d.qpos[q_at], d.qvel[v_at] = start_.q, start_.u
            row = np.zeros(mujoco.mj_stateSize(m, self.kind))
            mujoco.mj_getState(m, d, row, self.kind)
            self.models.append(own)
            rows.append(row)
        self.first = np.array(rows)
        self.data = [mujoco.MjData(m) for _ in range(threads_here())]
        self.states = np.empty((len(rows), min(CHUNK, self.steps), self.first.shape[1]))
        self.rollout = mujoco.rollout.Rollout(nthread=threads_here())

    def quaternions(self) -> np.ndarray:
        """Attitudes at the end, (flights, 4)."""
        now, left = self.first, self.steps
        while left:
            count = min(left, CHUNK)
            kept = np.ascontiguousarray(self.states[:, :count])
            self.rollout.rollout(self.models, self.data, now, nstep=count, state=kept)
            now, left = kept[:, -1].copy(), left - count
        return now[:, 4:8]  # after the time and the position


def matching_step(case: Case, accuracy: float) -> tuple[float, float]:
    """The longest of MuJoCo's steps at which its attitudes are as accurate, and its error.

    By halving, then longer again by what its fourth order promises.
    """
    which = case.matched(accuracy)

    def error(step: float) -> float:
        return case.error(which, InMujoco(case, which, step).quaternions())

    step = 0.016
    while (found := error(step)) > accuracy:
        step /= 2
        if step < 2e-5:
            raise RuntimeError(f"MuJoCo stays {found:.1e} rad from the reference")
    longer = step * min(1.9, 0.97 * (accuracy / found) ** 0.25)
    if longer > step and (better := error(longer)) <= accuracy:
        return longer, better
    return step, found


def mujoco_timer(case: Case, step: float) -> Callable[[], float]:
    """Seconds of all flights, from those of the first few."""
    which = np.arange(min(TIMED, len(case.starts)))
    own = InMujoco(case, which, step)

    def measure() -> float:
        begun = time.perf_counter()
        own.quaternions()
        return (time.perf_counter() - begun) / len(which) * len(case.starts)

    return measure


def scipy_timer(case: Case, tolerance: float) -> Callable[[], float]:
    """Seconds of all flights by SciPy's DOP853, from those of one, on one thread."""
    kernel, k = Kernel(case.system.integrator._slope), int(case.matched(1e-7)[0])
    x = np.concatenate([case.states[k], [0.0], case.parameters[k]])
    size = case.states.shape[1]

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        x[:size], x[size] = y, t
        return kernel(x)

    def measure() -> float:
        begun = time.perf_counter()
        solve_ivp(
            rate, (0, case.duration), case.states[k], "DOP853", rtol=tolerance, atol=tolerance
        )
        return (time.perf_counter() - begun) * len(case.starts)

    return measure


def pinocchio_timer(case: Case, step: float) -> Callable[[], float] | None:
    """Seconds of all flights by as many batched evaluations as MuJoCo's steps take."""
    state = state_of(case.model)
    check = case.system.equations.forward_dynamics(state.q, state.v, state.torques)
    timers = pinocchio_timers(case.model, threads_here(), check)
    timer = timers.get("pinocchio abaInParallel, all threads")
    if timer is None:
        return None
    return lambda: timer() * 4 * round(case.duration / step) * len(case.starts)


# -------------------------------------------------------------------------------- measuring


def matching_tolerance(case: Case, accuracy: float) -> float:
    """The loosest tolerance, by factors of 10^⅛, at which our attitudes are as accurate."""
    tolerance, which = accuracy * 10, case.matched(accuracy)
    while case.error(which, case.solve(tolerance).final[which, :4]) > accuracy:
        tolerance /= 10**0.125
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


def ours_timer(case: Case, tolerance: float) -> Callable[[], float]:
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


def benchmark(case: Case, accuracies: tuple[float, ...], rounds: int) -> dict:
    """One case at each accuracy; times are of all its flights."""
    result: dict = {"flights": len(case.starts), "accuracies": {}}
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
            timers["pinocchio aba, four a step"] = extra
        times = measured(timers, rounds)
        result["accuracies"][f"{accuracy:g}"] = {
            "tolerance": tolerance,
            "matched": len(case.matched(accuracy)),
            "error": case.error(case.matched(accuracy), found.final[case.matched(accuracy), :4]),
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
        stable_layout().dataset  # noqa: B018 (computes)
        values.append(time.perf_counter() - start)
    return {"min": min(values[3:]), "median": statistics.median(values[3:])}


def table(name: str, result: dict) -> str:
    """One case's numbers as plain text."""
    lines = [f"{name}: {result['flights']} flights"]
    for accuracy, own in result["accuracies"].items():
        lines += [
            f"  attitude to {accuracy} rad on {own['matched']} flights: ours tolerance "
            f"{own['tolerance']:.1e}, error "
            f"{own['error']:.1e}, {own['steps']:.0f} steps a flight; MuJoCo step "
            f"{own['mujoco_step'] * 1e3:.4g} ms, error {own['mujoco_error']:.1e}",
            f"    {'µs a flight':<40}{'least':>12}{'median':>12}{'× ours':>9}",
        ]
        base = own["seconds"]["ours"]["min"]
        for what, value in own["seconds"].items():
            least, middle = (value[k] / result["flights"] * 1e6 for k in ("min", "median"))
            lines.append(f"    {what:<40}{least:>12.1f}{middle:>12.1f}{value['min'] / base:>9.0f}")
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
    before = machine.load()
    print(f"{threads_here()} threads; load of the machine before: {before}", flush=True)
    report: dict = {"threads": threads_here(), "load_before": before}
    for case in (layout(), gymnast_flights()):
        report[case.name] = benchmark(case, ACCURACIES[case.name], options.rounds)
        print("\n" + table(case.name, report[case.name]), flush=True)
    single = one_flight()
    report["one flight"] = single
    print(
        f"\none flight of eight somersaults with its dataset: median {single['median'] * 1e3:.1f} "
        f"ms, least {single['min'] * 1e3:.1f} ms (aim: less than {AIMS['one flight']:.0f})"
    )
    machine.finish(report, machine.load(), options.json)


if __name__ == "__main__":
    main()
