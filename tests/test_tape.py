"""The motor tape: what is recorded is what the nominal flight's inverse dynamics give."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_prescribed import GYMNAST, SECONDS, prescribed

import somersault as so
from somersault.flight._batch import Batch
from somersault.flight._layout import PATH
from somersault.motion import TAPE_DEGREE

WRAP = so.named_pose("gymnast", "wrap")


def taped(soft: so.Takeoff, times: np.ndarray) -> np.ndarray:
    """Torques (time, joints) of a compliant takeoff's tape."""
    batch = Batch(GYMNAST, soft, SECONDS)
    states = np.empty((1, len(times), batch.system.layout.state))  # which do not matter here
    p = batch.begun().course.parameters(times[None], states)[0]
    own = p[:, PATH * len(batch.joints) : batch.system.layout.changing]
    s = times - own[:, 0]
    rows = own[:, 1:].reshape(len(times), -1, TAPE_DEGREE + 1)
    return (rows * s[:, None, None] ** np.arange(TAPE_DEGREE + 1)).sum(-1)


@pytest.mark.parametrize("spin", [2.0, 12.6, 40.0])
def test_torques_are_those_of_the_nominal_flight(spin: float) -> None:
    """Between the points of the recording, before and behind knots, at both ends; and also where
    the body turns so fast that the pieces must be shorter."""
    nominal = replace(prescribed(), spin=spin)
    soft = so.compliant(GYMNAST, nominal, 25.0, pose=WRAP)
    times = np.unique(
        np.concatenate([np.random.default_rng(3).uniform(0, SECONDS, 300), [0.0, SECONDS]])
    )
    flight = so.fly(GYMNAST, nominal, SECONDS, samples=times, accuracy=1e-12)
    wanted = flight.joint_torques.values
    off = np.abs(taped(soft, times) - wanted).max()
    assert off < 2e-10 * np.abs(wanted).max()


def test_each_flight_of_an_ensemble_has_its_own_tape() -> None:
    """Moves whose times and angles are varied: as flown one by one, whatever the chunks."""
    soft = so.compliant(GYMNAST, prescribed(), 25.0, pose=WRAP)
    name = next(n for n, joint in soft.joints.items() if len(joint.times) > 1)
    held = soft.joints[name]
    late, more = [0.0, 0.013, -0.021], [0.0, 0.1, -0.2]
    vary = {
        "late": so.Vary(adds_to=f"joints.{name}.times.2", samples=late),
        "more": so.Vary(adds_to=f"joints.{name}.angles.2", samples=more),
    }
    told = so.Report(("somersault", "tilt", "twist", f"{name}_rate"))
    given = {"size": 3, "report": told, "accuracy": 1e-10, "progress": False}
    found = so.ensemble(GYMNAST, soft, SECONDS, vary, **given).dataset
    cut = so.ensemble(GYMNAST, soft, SECONDS, vary, **given, chunk=1).dataset
    for quantity in found:
        assert np.array_equal(found[quantity], cut[quantity]), quantity
    for k in range(3):
        times, angles = list(held.times), list(held.angles)
        times[1] += late[k]
        angles[1] += more[k]
        joints = {**soft.joints, name: replace(held, times=times, angles=angles)}
        alone = so.fly(GYMNAST, replace(soft, joints=joints), SECONDS, accuracy=1e-10)
        for quantity in ("somersault", "tilt", "twist"):
            assert float(found[quantity][k]) == pytest.approx(
                getattr(alone.landing, quantity), abs=1e-8
            )
