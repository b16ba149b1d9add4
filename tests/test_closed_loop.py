"""Systems in C under a compiled controller, against the same loop in Python."""

from __future__ import annotations

from concurrent.futures import CancelledError

import casadi as ca
import mujoco
import numpy as np
import pytest

from somersault.engine import LANES, ClosedLoop, Kernel, Stop, System
from somersault.robot._plant import advance

PENDULUM = """
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <body>
      <joint name="hinge" axis="0 1 0" damping="0.1"/>
      <geom type="capsule" fromto="0 0 0 0 0 -0.5" size="0.02" mass="1"/>
    </body>
  </worldbody>
  <actuator><motor joint="hinge"/></actuator>
</mujoco>
"""
STEPS = 3


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(PENDULUM)


@pytest.fixture(scope="module")
def loop() -> ClosedLoop:
    """Pushes with 2 N m towards an angle, and counts; done when it has counted to its number."""
    angle, rate, count, numbers = (ca.SX.sym("x", n) for n in (1, 1, 1, 2))
    torque = ca.if_else(angle < numbers[0], 2.0, -2.0) - 0.1 * rate
    over = count + 1 >= numbers[1]
    result = ca.densify(ca.vertcat(over, torque, count + 1))
    return ClosedLoop(ca.Function("c", [angle, rate, count, numbers], [result]), (1, 1))


class Pendulum:
    def __init__(self, model: mujoco.MjModel, start: float, goal: float, periods: float) -> None:
        self.model, self.data = model, mujoco.MjData(model)
        self.data.qpos[0] = start
        mujoco.mj_forward(model, self.data)
        self.count, self.numbers = np.zeros(1), np.array([goal, periods])

    @property
    def system(self) -> System:
        d = self.data
        return System(
            self.model._address, d._address, [d.qpos, d.qvel, self.count, self.numbers],
            [d.ctrl, self.count],
        )  # fmt: skip

    def by_hand(self, most: int) -> int:
        for period in range(most):
            torque = 2.0 if self.data.qpos[0] < self.numbers[0] else -2.0
            self.data.ctrl[0] = torque - 0.1 * self.data.qvel[0]
            self.count += 1
            if self.count[0] >= self.numbers[1]:
                return period + 1
            for _ in range(STEPS):
                mujoco.mj_step(self.model, self.data)
        return most


STARTS = [(0.1 * k, 0.3 - 0.1 * k, 40.0 + 7 * k) for k in range(LANES + 3)]


@pytest.mark.parametrize("count", [1, 3, LANES, LANES + 3])
def test_is_the_loop_in_python(model: mujoco.MjModel, loop: ClosedLoop, count: int) -> None:
    """Whatever the number of lanes, and though each is done at its own time."""
    ours = [Pendulum(model, *start) for start in STARTS[:count]]
    done, _ = loop.run(advance(), [p.system for p in ours], 70, STEPS)
    for pendulum, start, periods in zip(ours, STARTS, done, strict=False):
        other = Pendulum(model, *start)
        assert other.by_hand(70) == periods
        np.testing.assert_allclose(pendulum.data.qpos, other.data.qpos, rtol=0, atol=1e-13)
        assert pendulum.count == other.count
        assert pendulum.data.time == other.data.time


def test_a_lane_does_not_see_its_neighbours(model: mujoco.MjModel, loop: ClosedLoop) -> None:
    """Bit for bit."""
    together = [Pendulum(model, *start) for start in STARTS]
    loop.run(advance(), [p.system for p in together], 100, STEPS)
    for pendulum, start in zip(together, STARTS, strict=True):
        alone = Pendulum(model, *start)
        loop.run(advance(), [alone.system], 100, STEPS)
        assert pendulum.data.qpos[0] == alone.data.qpos[0]
        assert pendulum.data.qvel[0] == alone.data.qvel[0]


def test_records_what_is_read_and_written(model: mujoco.MjModel, loop: ClosedLoop) -> None:
    every = 4
    ours = [Pendulum(model, 0.0, 0.3, 30), Pendulum(model, 0.1, -0.3, 50)]
    done, records = loop.run(advance(), [p.system for p in ours], 45, STEPS, every)
    assert done.tolist() == [30, 45]
    for record, start in zip(records, ((0.0, 0.3, 30), (0.1, -0.3, 50)), strict=True):
        other = Pendulum(model, *start)
        for row in record:
            np.testing.assert_allclose(row[0], other.data.qpos[0], atol=1e-13)
            assert row[2] == other.count[0]
            np.testing.assert_array_equal(row[3:5], other.numbers)
            other.by_hand(every)
            assert abs(row[5]) > 1
            assert row[6] == row[2] + 1
    assert [len(r) for r in records] == [8, 12]


def test_parts_that_do_not_fit_are_refused(model: mujoco.MjModel, loop: ClosedLoop) -> None:
    good = Pendulum(model, 0.0, 0.3, 30).system
    bad = System(good.first, good.second, good.reads[:3], good.writes)
    with pytest.raises(ValueError, match="parts of"):
        loop.run(advance(), [bad], 10, STEPS)
    strided = [*good.reads[:3], np.zeros(4)[::2]]
    bad = System(good.first, good.second, strided, good.writes)
    with pytest.raises(ValueError, match="side by side"):
        loop.run(advance(), [bad], 10, STEPS)


def test_conditions_of_expressions() -> None:
    """Each of CasADi's, against CasADi, for numbers, nothing and infinity."""
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    expressions = [
        x < y, x <= y, x == y, x != y, ca.logic_and(x, y), ca.logic_or(x, y), ca.logic_not(x),
        ca.if_else(x, y, -x), ca.sign(x),
    ]  # fmt: skip
    function = ca.Function("f", [x, y], [ca.densify(ca.vertcat(*expressions))])
    values = [0.0, -0.0, 1.0, -2.5, np.inf, -np.inf]
    pairs = np.array([[a, b] for a in values for b in values])
    kernel = Kernel(function)(pairs)
    theirs = np.array([np.array(function(a, b)).ravel() for a, b in pairs])
    np.testing.assert_array_equal(kernel, theirs)


def test_gives_up_when_it_is_told_to(model: mujoco.MjModel, loop: ClosedLoop) -> None:
    stop = Stop()
    stop.set()
    pendulum = Pendulum(model, 0.0, 0.3, 1e9)
    with stop.heeded(), pytest.raises(CancelledError):
        loop.run(advance(), [pendulum.system], 10**9, STEPS)
    assert pendulum.data.time == 0
