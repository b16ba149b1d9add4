"""A compliant flight whose paths and motor tape are replayed at a varying rate, against MuJoCo's
Runge–Kutta steps, which are given the springs, dampers and tape at the phase of every stage.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import mujoco
import numpy as np
from scipy.optimize import brentq
from test_compliance_mujoco import STEP, WITHIN, ZETA, Compliant, Nominal, gave_way, off_nominal
from test_prescribed import (
    GYMNAST,
    SECONDS,
    Torques,
    assert_arrives,
    halved,
    moments,
    paths,
    prescribed,
)

import somersault as so

EVERY, RATE, FREQUENCY = 0.02, 0.9, 30.0


def law(phase: float) -> float:
    return 0.85 + 0.3 * np.sin(9 * phase)


def phases(times: np.ndarray, waits: int) -> tuple[np.ndarray, np.ndarray]:
    """The phase and its rate at times, by sums from tick to tick."""
    shown, rate, waiting = 0.0, RATE, [RATE] * waits
    found = np.empty((2, len(times)))
    for k in range(round(SECONDS / EVERY) + 1):
        waiting.append(law(shown))
        bend = (np.clip(waiting.pop(0), 0.5, 2.0) - rate) / EVERY
        since = times - k * EVERY
        own = since >= -1e-12
        found[0, own] = (shown + rate * since + bend * since**2 / 2)[own]
        found[1, own] = (rate + bend * since)[own]
        shown, rate = shown + rate * EVERY + bend * EVERY**2 / 2, rate + bend * EVERY
    return found[0], found[1]


class Replayed(Compliant):
    """What springs, dampers and tape do where the nominal motion is at other phases."""

    def __init__(self, quaternion: np.ndarray, h: np.ndarray, waits: int) -> None:
        self.nominal = Nominal(GYMNAST, paths())

        def left(time: float, knot: float) -> float:
            return float(phases(np.array([time]), waits)[0][0]) - knot

        last = left(SECONDS, 0.0)
        assert last < SECONDS
        reached = [brentq(left, 0, SECONDS, (k,), 1e-15) for k in self.nominal.knots if k < last]
        self.knots = [*reached, *(EVERY * np.arange(1, round(SECONDS / EVERY)))]
        self.times = halved(halved(moments(STEP, self.knots)))  # of the stages of halved steps
        at, rates = phases(self.times, waits)
        nominal = np.array([self.nominal.wanted(t) for t in at])
        omegas = self.nominal.flown(quaternion, h, at)
        torques = [self.nominal.torques(w, *x) for w, x in zip(omegas, nominal, strict=True)]
        self.tape, self.wanted = np.array(torques), nominal.copy()
        self.wanted[:, 1] *= rates[:, None]

    def torques(self, gains: Callable[[int], tuple[np.ndarray, np.ndarray]]) -> Torques:
        q_at, v_at = self.nominal.q_at, self.nominal.v_at

        def acting(d: mujoco.MjData) -> np.ndarray:
            k = int(np.searchsorted(self.times, d.time - 1e-9))
            assert abs(self.times[k] - d.time) < 1e-9
            (q, u, _), (stiff, damp) = self.wanted[k], gains(k)
            return stiff * (q - d.qpos[q_at]) + damp * (u - d.qvel[v_at]) + self.tape[k]

        return acting


def test_a_compliant_flight_at_a_varying_rate() -> None:
    start = so.fly(GYMNAST, prescribed(), SECONDS, samples=2, accuracy=1e-11).start
    pose = so.named_pose("gymnast", "wrap")
    soft = so.compliant(GYMNAST, prescribed(), FREQUENCY, ZETA, pose=pose)
    replay = so.Replay(law="0.85 + 0.3 * sin(9 * phase)", every=EVERY, delay=2 * EVERY, rate=RATE)
    begun = off_nominal(replace(soft, replay=replay))
    flight = so.fly(GYMNAST, begun, SECONDS, accuracy=1e-11)
    assert np.ptp(flight.phase_rate) > 0.3
    assert gave_way(flight) > 0.01
    assert flight.momentum_drift < 1e-12
    own = Replayed(start.quaternion, start.momentum, waits=2)
    np.testing.assert_allclose(flight.phase[-1], phases(np.array([SECONDS]), 2)[0], atol=1e-12)
    wrapped = [pose[j.name.removeprefix("left_").removeprefix("right_")] for j in GYMNAST.joints]
    inertia = own.inertias(np.array(wrapped))
    gains = FREQUENCY**2 * inertia, 2 * ZETA * FREQUENCY * inertia
    assert_arrives(flight, own.torques(lambda _: gains), WITHIN, STEP, own.knots)
