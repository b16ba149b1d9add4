"""How long one evaluation of forward dynamics takes, here and elsewhere, in the same run.

    python benchmarks/forward_dynamics.py [--rounds 15] [--json FILE]

Contenders take turns, round after round, so that whatever else the machine does meets them
alike. The table gives the least and the median over the rounds; see README.md beside this
file for what each line means.
"""

from __future__ import annotations

import argparse
import statistics
import warnings
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import limits
import machine
import numpy as np
import ours
from gymnast import gymnast
from others import mujoco_timer, pinocchio_timers, state_of

from somersault.dynamics import Equations
from somersault.engine import threads as threads_here
from somersault.model import Model, load

TARGETS = {"layout": 60.0, "gymnast": 30.0}
OURS, MUJOCO = "kernel, all threads", "MuJoCo rollout RK4, all threads"


def models() -> dict[str, Model]:
    """The thesis's layout model, the gymnast, and humanoids of packages that are installed."""
    every = {"layout": load("furrer"), "gymnast": gymnast()}
    for name, package, path in (
        ("humanoid", "gymnasium", "envs/mujoco/assets/humanoid.xml"),
        ("dm_control", "dm_control", "suite/humanoid.xml"),
    ):
        found = find_spec(package)
        if found is not None and found.origin is not None:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                every[name] = load(Path(found.origin).parent / path)
    return every


def measured(timers: dict[str, Callable[[], float]], rounds: int) -> dict[str, dict[str, float]]:
    """Least and median of each timer in nanoseconds, the timers taking turns."""
    values: dict[str, list[float]] = {name: [] for name in timers}
    for _ in range(rounds):
        for name, timer in timers.items():
            values[name].append(timer() * 1e9)
    return {n: {"min": min(v), "median": statistics.median(v)} for n, v in values.items()}


def benchmark(model: Model, rounds: int) -> dict:
    """Everything about one model."""
    equations, threads = Equations(model), threads_here()
    state = state_of(model)
    q, v = state.q, state.v
    whole = ours.forward_dynamics(equations)
    sample = np.concatenate([q, v, np.zeros(whole.kernel.inputs - len(q) - len(v))])
    check = equations.forward_dynamics(q, v, state.torques)
    timers = {
        "kernel, 1 thread": ours.kernel_timer(whole.kernel, 1, sample),
        OURS: ours.kernel_timer(whole.kernel, threads, sample),
        "Equations.forward_dynamics, 65,536 samples": ours.public_timer(equations, q, v),
    }
    lean = ours.forward_dynamics(equations, attitude_only=True) if model.free else None
    if lean is not None:
        shorter = sample[: lean.kernel.inputs]
        timers["kernel, attitude and joints only, 1 thread"] = ours.kernel_timer(
            lean.kernel, 1, shorter
        )
        timers["kernel, attitude and joints only, all threads"] = ours.kernel_timer(
            lean.kernel, threads, shorter
        )
    timers[MUJOCO] = mujoco_timer(model, threads, check)
    timers |= pinocchio_timers(model, threads, check)
    timers["plain NumPy, batches of 4096"] = ours.numpy_timer(whole.function, sample)
    peak = {"peak, 1 thread": limits.peak_timer(1), "peak, all threads": limits.peak_timer(threads)}
    times = measured(timers | peak, rounds)
    peaks = {name: times.pop(name) for name in peak}
    result = {
        "speeds": equations.speeds,
        "instructions": whole.instructions,
        "operations": whole.operations,
        "derive_s": whole.derive,
        "compile_s": whole.compile,
        "ns": times,
        "peak_gflops": {name: 1 / value["min"] for name, value in peaks.items()},
        "share_of_peak": {
            of: whole.operations * peaks[f"peak, {of}"]["min"] / times[f"kernel, {of}"]["min"]
            for of in ("1 thread", "all threads")
        },
        "public": ours.public_cost(equations, whole.kernel, sample, q, v),
        "ratio": {which: times[MUJOCO][which] / times[OURS][which] for which in ("min", "median")},
    }
    if lean is not None:
        result["attitude_only"] = {"operations": lean.operations, "compile_s": lean.compile}
    return result


def table(name: str, result: dict) -> str:
    """One model's numbers as plain text."""
    lines = [
        f"{name}: {result['speeds']} degrees of freedom, {result['instructions']} instructions, "
        f"{result['operations']} floating-point operations",
        f"  derived in {result['derive_s']:.3f} s, compiled in {result['compile_s']:.3f} s",
        f"  {'ns an evaluation':<48}{'least':>10}{'median':>10}{'× ours':>9}",
    ]
    base = result["ns"][OURS]["min"]
    for what, value in result["ns"].items():
        lines.append(
            f"  {what:<48}{value['min']:>10.1f}{value['median']:>10.1f}{value['min'] / base:>9.1f}"
        )
    share, peak = result["share_of_peak"], result["peak_gflops"]
    lines.append(
        f"  of the peak of {peak['peak, 1 thread']:.1f} Gflop/s: {share['1 thread']:.0%} on one "
        f"thread; of {peak['peak, all threads']:.1f}: {share['all threads']:.0%} on all"
    )
    public = result["public"]
    lines.append(
        f"  public call, processor time of one thread: {public['ns']:.1f} ns, "
        f"{public['over_kernel']:.2f} times the {public['kernel']:.1f} ns of its kernel; copying "
        f"its {public['bytes']} bytes takes {public['copying']:.1f} ns"
    )
    ratio, target = result["ratio"], TARGETS.get(name)
    aim = "" if target is None else f" (aim: at least {target:.0f})"
    lines.append(
        f"  MuJoCo / ours, all threads: {ratio['min']:.0f} by the least times, "
        f"{ratio['median']:.0f} by the medians{aim}"
    )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=15, help="measurements of each contender")
    parser.add_argument("--json", type=Path, help="write the numbers here as well")
    parser.add_argument("--only", help="layout, gymnast, humanoid or dm_control")
    options = parser.parse_args()
    before = machine.load()
    report: dict = {"threads": threads_here(), "load_before": before, "models": {}}
    print(f"{threads_here()} threads; load of the machine before: {before}", flush=True)
    for name, model in models().items():
        if options.only in (None, name):
            report["models"][name] = benchmark(model, options.rounds)
            print("\n" + table(name, report["models"][name]), flush=True)
    machine.finish(report, machine.load(), options.json)


if __name__ == "__main__":
    main()
