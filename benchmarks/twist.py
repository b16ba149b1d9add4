"""The maps of the twisting gymnast, here and in MuJoCo, in one run, at the same accuracy.

    python benchmarks/twist.py [--rounds 5] [--accuracies 1e-4 1e-6 1e-8] [--json FILE]

441 flights that differ in tilt and twist at takeoff: once compliant about a motion with its motor
tape, once with all thirteen joints prescribed. See README.md beside this file.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import machine
import mujoco
import mujoco.rollout
import numpy as np
from flights import measured

import somersault as so
from somersault.attitude import (
    quaternion_conjugate,
    quaternion_from_angles,
    quaternion_product,
)
from somersault.engine import threads as threads_here
from somersault.flight import Batch
from somersault.flight._start import Start

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from trees import mujoco_addresses

SOURCE = Path(__file__).parents[1] / "src/somersault"
NATURAL_FREQUENCY, ZETA = 25.0, 0.7
GRID = np.linspace(-0.1, 0.1, 21)  # rad, of tilt and of twist
TIMED = 16  # flights that MuJoCo is timed over; its time a flight depends on nothing else
MATCHED = 10  # every so many-th flight is one that accuracies are compared on
CHUNK = 500  # steps that its rollout keeps at a time
HEAVY = 1e12  # kg m² of a rotor that no gymnast moves
STABLE = 1e-3  # s; about the longest step at which Runge-Kutta holds the stiffest root
SHORTEST = 2e-5  # s, of MuJoCo's steps that are tried
AIMS = {"compliant": 1.0, "prescribed": 0.2}  # s of a map
RATIO = 100.0  # of a compliant one


@dataclass(frozen=True)
class Case:
    """A map: flights of one takeoff, leant and turned, their momentum staying where it is."""

    name: str
    takeoff: so.Takeoff
    nominal: so.Takeoff
    duration: float

    def angles(self, accuracy: float) -> np.ndarray:
        """Somersault, tilt and twist at landing, (flights, 3)."""
        vary = {
            "leant": so.Vary(adds_to="takeoff.tilt", values=GRID),
            "turned": so.Vary(adds_to="takeoff.twist", values=GRID),
        }
        data = so.ensemble(
            "gymnast", self.takeoff, self.duration, vary, report=ANGLES, accuracy=accuracy
        ).dataset
        return np.stack([data[name].values.ravel() for name in ANGLES], 1)

    def attitudes(self, accuracy: float) -> np.ndarray:
        """Quaternions at landing, (flights, 4)."""
        return quaternion_from_angles(*self.angles(accuracy).T)

    @cached_property
    def reference(self) -> np.ndarray:
        """Attitudes as tightly as they can be had."""
        return self.attitudes(1e-12)

    @cached_property
    def matched(self) -> np.ndarray:
        """Flights spread over the map whose attitudes two tight solutions agree on."""
        apart = turns(self.reference, self.attitudes(1e-11))
        return np.flatnonzero(apart < 1e-9)[::MATCHED]

    @cached_property
    def starts(self) -> list[Start]:
        """Of all flights, in the order of the map."""
        model, found = so.load("gymnast"), []
        for leant in GRID:
            for turned in GRID:
                tilt, twist = self.takeoff.tilt + leant, self.takeoff.twist + turned
                leaning = replace(self.takeoff, tilt=tilt, twist=twist)
                found.append(Batch(model, leaning, self.duration).begun().start)
        return found

    def error(self, which: np.ndarray, quaternions: np.ndarray) -> float:
        """Largest error of attitude at landing among some flights, rad."""
        return float(turns(self.reference[which], quaternions).max())


ANGLES = ("somersault", "tilt", "twist")


def turns(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Angles between attitudes, rad."""
    turn = quaternion_product(quaternion_conjugate(first), second)
    return 2 * np.linalg.norm(turn[:, 1:], axis=1)


def cases() -> tuple[Case, Case]:
    """The shipped motion of one and a half twists, compliant and prescribed."""
    motion = json.loads((SOURCE / "thesis/ch6/rudi.json").read_text())
    joints = {
        name: so.JointTakeoff("prescribed", times=path["times"], angles=path["angles"])
        for name, path in motion["joints"].items()
    }
    nominal = so.Takeoff(spin=motion["spin"], joints=joints)
    soft = so.compliant(
        "gymnast", nominal, NATURAL_FREQUENCY, ZETA, pose=so.named_pose("gymnast", "wrap")
    )
    exact = so.with_momentum("gymnast", nominal)
    return (
        Case("compliant", soft, nominal, motion["landing"]),
        Case("prescribed", exact, nominal, motion["landing"]),
    )


# -------------------------------------------------------------------------------- MuJoCo


class InMujoco:
    """The same flights in MuJoCo's threaded rollout of its Runge–Kutta integrator.

    Springs and dampers are MuJoCo's own, about zero; what the path and the tape add to them is a
    torque that depends on time alone and comes through the rollout's controls. These are held over
    a step. With `ramps` a motor whose activation is the integral of its control adds a slope
    within the step: a straight line with the mean and the first moment of the torque, with which
    Runge–Kutta keeps its fourth order. Without, the mean is held, of the second order.
    Prescribed joints have no equal in MuJoCo: theirs get a rotor that nothing else moves, and the
    torque that accelerates it along the path.
    """

    def __init__(self, case: Case, which: np.ndarray, step: float, ramps: bool) -> None:
        self.steps = max(1, round(case.duration / step))
        self.step = case.duration / self.steps
        model = so.load("gymnast")
        m = self._model(case, model)
        q_at, v_at = mujoco_addresses(model, m)
        self.kind, rows = mujoco.mjtState.mjSTATE_FULLPHYSICS, []
        for begun in (case.starts[k] for k in which):
            d = mujoco.MjData(m)
            d.qpos[3:7], d.qvel[3:6] = begun.quaternion, begun.omega
            d.qpos[q_at], d.qvel[v_at] = begun.q, begun.u
            row = np.zeros(mujoco.mj_stateSize(m, self.kind))
            mujoco.mj_getState(m, d, row, self.kind)
            rows.append(row)
        self.first = np.array(rows)
        self.control = self._control(case, m, np.array(v_at), ramps)
        self.model = m
        self.data = [mujoco.MjData(m) for _ in range(threads_here())]
        self.states = np.empty((len(rows), min(CHUNK, self.steps), self.first.shape[1]))
        self.rollout = mujoco.rollout.Rollout(nthread=threads_here())

    def _model(self, case: Case, model: so.Model) -> mujoco.MjModel:
        spec = mujoco.MjSpec.from_file(str(SOURCE / "model/shipped/gymnast.xml"))
        for geom in list(spec.geoms):
            spec.delete(geom)
        for joint in model.joints:
            motor = spec.add_actuator(name=joint.name, target=joint.name)
            motor.trntype = mujoco.mjtTrn.mjTRN_JOINT
            motor.dyntype = mujoco.mjtDyn.mjDYN_INTEGRATOR
            motor.gear = [_gear(case), 0, 0, 0, 0, 0]
        m = spec.compile()
        off = mujoco.mjtDisableBit
        for bit in (off.mjDSBL_CONSTRAINT, off.mjDSBL_CONTACT, off.mjDSBL_SENSOR):
            m.opt.disableflags |= int(bit)
        m.opt.disableflags |= int(off.mjDSBL_GRAVITY) | int(off.mjDSBL_LIMIT)
        m.opt.integrator, m.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, self.step
        for joint in model.joints:
            plan, own = case.takeoff.joints[joint.name], m.joint(joint.name)
            if plan.motion == "prescribed":
                m.dof_armature[own.dofadr[0]] = HEAVY
                continue
            m.jnt_stiffness[own.id] = plan.stiffness
            m.dof_damping[own.dofadr[0]] = plan.damping
        m.qpos_spring[:] = 0.0
        mujoco.mj_setConst(m, mujoco.MjData(m))
        return m

    def _control(self, case: Case, m: mujoco.MjModel, v_at: np.ndarray, ramps: bool) -> np.ndarray:
        """Slopes of the motors and torques beside them, (1, steps, controls)."""
        mean, slope = self._lines(case)
        if not ramps:
            slope[:] = 0.0
        done = np.cumsum(slope, 0) * self.step - slope * self.step  # activation at a step's begin
        held = np.zeros((self.steps, m.nv))
        held[:, v_at] = mean - slope * self.step / 2 - done
        motors = slope / _gear(case)  # in the order of the joints; MuJoCo refuses more than 1e10
        return np.concatenate([motors, held], 1)[None]

    def quaternions(self) -> np.ndarray:
        """Attitudes at the end, (flights, 4)."""
        spec = int(mujoco.mjtState.mjSTATE_CTRL) | int(mujoco.mjtState.mjSTATE_QFRC_APPLIED)
        now, done = self.first, 0
        while done < self.steps:
            count = min(self.steps - done, CHUNK)
            kept = np.ascontiguousarray(self.states[:, :count])
            self.rollout.rollout(
                self.model, self.data, now, self.control[:, done : done + count],
                control_spec=spec, state=kept, nstep=count,
            )  # fmt: skip
            now, done = kept[:, -1].copy(), done + count
        return now[:, 4:8]  # after the time and the position

    def _lines(self, case: Case) -> tuple[np.ndarray, np.ndarray]:
        """Mean and slope of the straight lines that have the torques' first two moments in every
        step, (steps, joints); no quadrature goes across a knot, where torques have a kink."""
        edges = np.arange(self.steps + 1) * self.step
        knots = [t for joint in case.takeoff.joints.values() for t in joint.times]
        edges = np.unique(np.concatenate([edges, [t for t in knots if 0 < t < edges[-1]]]))
        edges = edges[np.append(True, np.diff(edges) > 1e-12)]
        places, weights = np.polynomial.legendre.leggauss(4)
        half = np.diff(edges) / 2
        times = (edges[:-1] + half)[:, None] + half[:, None] * places
        step = np.minimum(((edges[:-1] + half) / self.step).astype(int), self.steps - 1)
        parts = half[:, None] * weights / self.step
        away = times - ((step + 0.5) * self.step)[:, None]
        wanted = forcing(case, times.ravel()).reshape(*times.shape, -1)
        mean, slope = np.zeros((2, self.steps, wanted.shape[2]))
        np.add.at(mean, step, np.einsum("pi,pij->pj", parts, wanted))
        np.add.at(slope, step, np.einsum("pi,pij->pj", parts * away, wanted))
        return mean, slope * 12 / self.step**2


def _gear(case: Case) -> float:
    return HEAVY if case.name == "prescribed" else 1.0


def forcing(case: Case, times: np.ndarray) -> np.ndarray:
    """Torques on MuJoCo's joints that depend on time alone, (times, joints), for nothing."""
    flown = so.fly("gymnast", case.nominal, case.duration, samples=times, accuracy=1e-10)
    q, u = flown._joints
    given = [case.takeoff.joints[joint.name] for joint in so.load("gymnast").joints]
    if case.name == "prescribed":
        return HEAVY * accelerations(given, times)
    k, c = (np.array([getattr(g, n) for g in given]) for n in ("stiffness", "damping"))
    return k * q + c * u + flown.joint_torques.values


def accelerations(given: list[so.JointTakeoff], times: np.ndarray) -> np.ndarray:
    """Of the paths, (times, joints)."""
    found = np.zeros((len(times), len(given)))
    for column, joint in enumerate(given):
        knots, angles = np.array(joint.times), np.array(joint.angles)
        for begin, span, by in zip(knots, np.diff(knots), np.diff(angles), strict=False):
            s = (times - begin) / span
            moving = (s > 0) & (s < 1)
            found[moving, column] = (by / span**2 * (60 * s - 180 * s**2 + 120 * s**3))[moving]
    return found


# -------------------------------------------------------------------------------- measuring


def matching_accuracy(case: Case, accuracy: float) -> tuple[float, float]:
    """The loosest `accuracy` of ours, by factors of 10^¼, that gives it, and its error."""
    which, asked = case.matched, 1e-2  # the springs' fast roots may make it far more accurate
    while (found := case.error(which, case.attitudes(asked)[which])) > accuracy:
        asked /= 10**0.25
    return asked, found


def matching_step(case: Case, accuracy: float, ramps: bool) -> tuple[float, float]:
    """The longest of MuJoCo's steps at which its attitudes are as accurate, and its error.

    By halving, then longer again by what its order promises.
    """
    which, order = case.matched, 4 if ramps else 2

    def error(step: float) -> float:
        found = case.error(which, InMujoco(case, which, step, ramps).quaternions())
        return found if np.isfinite(found) else np.inf

    step = STABLE if case.name == "compliant" else 0.01
    while (found := error(step)) > accuracy:
        if found < 1e-3 and step * (accuracy / found) ** (1 / order) < SHORTEST:
            raise RuntimeError(f"{found:.1e} rad at {step * 1e3:.2g} ms; it would take too long")
        step /= 2
        if step < SHORTEST:
            raise RuntimeError(f"it stays {found:.1e} rad from the reference")
    for longer in (1.9, 1.6, 1.3, 1.15):
        tried = step * min(longer, 0.97 * (accuracy / found) ** (1 / order))
        if tried > step and (better := error(tried)) <= accuracy:
            return tried, better
    return step, found


def mujoco_timer(case: Case, step: float, ramps: bool) -> Callable[[], float]:
    """Seconds of the map, from those of the first few flights."""
    own = InMujoco(case, np.arange(TIMED), step, ramps)

    def measure() -> float:
        begun = time.perf_counter()
        own.quaternions()
        return (time.perf_counter() - begun) / TIMED * len(GRID) ** 2

    return measure


def ours_timer(case: Case, accuracy: float) -> Callable[[], float]:
    """Seconds of the map as a user asks for it, in a warm process."""

    def measure() -> float:
        begun = time.perf_counter()
        case.angles(accuracy)
        return time.perf_counter() - begun

    return measure


def benchmark(case: Case, accuracy: float, rounds: int) -> dict:
    """One map at one accuracy; times are of all its flights."""
    asked, error = matching_accuracy(case, accuracy)
    timers, steps = {"ours": ours_timer(case, asked)}, {}
    for name, ramps in (("MuJoCo, held", False), ("MuJoCo, ramps", True)):
        try:
            steps[name] = matching_step(case, accuracy, ramps)
        except RuntimeError as reason:
            print(f"  {name}: {reason}", flush=True)
            continue
        timers[name] = mujoco_timer(case, steps[name][0], ramps)
    times = measured(timers, rounds)
    return {
        "accuracy": accuracy, "asked": asked, "error": error, "flights": len(case.matched),
        "mujoco": {n: {"step": s, "error": e} for n, (s, e) in steps.items()}, "seconds": times,
        "ratio": {
            n: {which: times[n][which] / times["ours"][which] for which in ("min", "median")}
            for n in steps
        },
    }  # fmt: skip


def table(case: Case, own: dict) -> str:
    """One map's numbers as plain text."""
    lines = [
        f"{case.name}, attitude to {own['accuracy']:g} rad on {own['flights']} flights: ours "
        f"asked for {own['asked']:.1e}, error {own['error']:.1e}"
    ]
    for name, value in own["seconds"].items():
        more = own["mujoco"].get(name)
        said = (
            "" if more is None else f"  step {more['step'] * 1e3:.4g} ms, error {more['error']:.1e}"
        )
        lines.append(
            f"    {name:<16}{value['min']:>10.3f} s least{value['median']:>10.3f} s median{said}"
        )
    for name, ratio in own["ratio"].items():
        least, middle = ratio["min"], ratio["median"]
        lines.append(
            f"    {name} / ours: {least:.0f} by the least times, {middle:.0f} by the medians"
        )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5, help="measurements of each contender")
    parser.add_argument("--accuracies", type=float, nargs="+", default=[1e-4, 1e-6, 1e-8])
    parser.add_argument("--json", type=Path, help="write the numbers here as well")
    options = parser.parse_args()
    report: dict = {"threads": threads_here(), "load_before": machine.load()}
    print(f"{threads_here()} threads; load of the machine before: {machine.load()}", flush=True)
    for case in cases():
        report[case.name] = []
        for accuracy in options.accuracies:
            report[case.name].append(benchmark(case, accuracy, options.rounds))
            print("\n" + table(case, report[case.name][-1]), flush=True)
        aim = f"(aims: a map in less than {AIMS[case.name]:g} s"
        print(aim + (f", a ratio of {RATIO:g})" if case.name == "compliant" else ")"), flush=True)
    machine.finish(report, machine.load(), options.json)


if __name__ == "__main__":
    main()
