"""The other side: MuJoCo and pinocchio on the same tree, checked to compute the same first."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import mujoco
import mujoco.rollout
import numpy as np

from somersault.model import Model

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from trees import InMujoco, State, random_state, to_mujoco


def state_of(model: Model) -> State:
    """One state without gravity, in the variables of the tests."""
    return random_state(model, np.random.default_rng(3), gravity=False)


def mujoco_timer(model: Model, threads: int, check: np.ndarray) -> Callable[[], float]:
    """Seconds an evaluation inside MuJoCo's threaded rollout of the Runge–Kutta integrator.

    Four evaluations a step. The tree has no geoms and nothing but its dynamics is enabled.
    `check` is our forward dynamics at `state_of(model)`.
    """
    m = to_mujoco(model)
    own = InMujoco(model, m, state_of(model))
    np.testing.assert_allclose(own.forward_dynamics, check, rtol=1e-9, atol=1e-9)
    off = mujoco.mjtDisableBit
    for bit in (off.mjDSBL_CONSTRAINT, off.mjDSBL_SENSOR, off.mjDSBL_GRAVITY):
        m.opt.disableflags |= int(bit)
    m.opt.enableflags = 0
    runs, steps = 128, 250
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    start_states = np.zeros((runs, mujoco.mj_stateSize(m, kind)))
    rng = np.random.default_rng(4)
    for row in start_states:
        d = mujoco.MjData(m)
        d.qvel[:] = 0.3 * rng.normal(size=m.nv)
        mujoco.mj_getState(m, d, row, kind)
    data = [mujoco.MjData(m) for _ in range(threads)]
    states = np.empty((runs, steps, start_states.shape[1]))
    sensors = np.empty((runs, steps, m.nsensordata))
    rollout = mujoco.rollout.Rollout(nthread=threads)

    def measure() -> float:
        start = time.perf_counter()
        rollout.rollout(m, data, start_states, nstep=steps, state=states, sensordata=sensors)
        return (time.perf_counter() - start) / (runs * steps * 4)

    measure()
    assert np.isfinite(states).all()
    return measure


def pinocchio_timers(
    model: Model, threads: int, check: np.ndarray
) -> dict[str, Callable[[], float]]:
    """Seconds an evaluation of pinocchio's `aba`: a call at a time less the cost of a call, and
    batched over threads; {} if it is not installed."""
    if find_spec("pinocchio") is None:
        return {}
    import pinocchio as pin
    from test_dynamics_pinocchio import InPinocchio

    own = InPinocchio(model, state_of(model))
    np.testing.assert_allclose(own.forward_dynamics, check, rtol=1e-9, atol=1e-9)
    m, d, q, v, tau = own.m, own.d, own.q, own.v, np.zeros(own.m.nv)
    count = 5000

    def measure() -> float:
        start = time.perf_counter()
        for _ in range(count):
            pin.aba(m, d, q, v, tau)
        whole = time.perf_counter() - start
        start = time.perf_counter()
        for _ in range(count):
            pin.isNormalized(m, q)
        return max(whole - (time.perf_counter() - start), 0.0) / count

    timers = {"pinocchio aba, one call at a time, 1 thread": measure}
    if hasattr(pin, "abaInParallel"):
        batch = 4096
        pool = pin.ModelPool(m, threads)
        many = [np.asfortranarray(np.repeat(x[:, None], batch, 1)) for x in (q, v, tau)]
        out = np.asfortranarray(np.zeros((m.nv, batch)))

        def batched() -> float:
            start = time.perf_counter()
            pin.abaInParallel(threads, pool, *many, out)
            return (time.perf_counter() - start) / batch

        batched()
        timers["pinocchio abaInParallel, all threads"] = batched
    return timers
