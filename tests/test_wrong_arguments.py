"""Each argument of each public call, given a dozen wrong things: one sentence, or an answer.

A room joins with a right call of each of its functions.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import somersault as so
from somersault import attitude, rigid
from somersault import stability as st

WRONG = [
    None, True, "text", b"bytes", object(), 1j, float("nan"), float("inf"), -1.0, 10**400, [], {},
    [1.0, "two"], [[1.0], [2.0, 3.0]], np.zeros((2, 5)), np.arange(7.0), {"shoulder": "straight"},
    {"shoulder": [0.1, 0.2, 0.3]}, {3: 1.0}, ["elbow"], ("pose.shoulder", []), "stiffness.knee",
    ("stiffness.knee", [0.0, 1.0]), ("pose.shoulder", 1.0, "high"),
]  # fmt: skip
CHART = {
    "model": "furrer", "x": ("pose.shoulder", [0.5, 1.0]), "y": ("stiffness.shoulder", [0.0, 1.0]),
    "damping": {"shoulder": 0.1}, "fixed": {"bodies.body.mass": 60.0}, "axis": 2, "lock": (),
    "subsystem": "tilt", "energy": True,
}  # fmt: skip
RANGES = {
    "model": "furrer", "along": ("stiffness.shoulder", -2, 4), "pose": {"shoulder": 1.3},
    "axis": 2, "lock": (), "subsystem": "tilt", "samples": 5,
}  # fmt: skip
THREE, FOUR = [1.0, 2.0, 2.5], [1.0, 0.0, 0.0, 0.0]
SPIN = so.spin("furrer", pose={"shoulder": 1.3})
TUMBLE = rigid.RigidMotion(THREE, [0.1, 1.0, 0.2])
RIGHT: dict[Callable[..., Any], dict[str, Any]] = {
    so.spin: {"model": "furrer", "axis": 2, "pose": {"shoulder": 1.3}},
    SPIN.linear: {
        "stiffness": {"shoulder": 1.0}, "damping": {"shoulder": 0.1}, "lock": (), "rate": 1.0,
    },
    SPIN.linear().subsystem: {"coordinate": "tilt"},
    st.chart: CHART,
    st.growth_rates: {
        "model": "furrer", "quantities": {"pose.shoulder": [1.0, 1.2]}, "stiffness": {},
        "damping": {"shoulder": 0.1}, "axis": 2, "lock": (), "subsystem": None,
    },
    st.root_locus: {k: v for k, v in RANGES.items() if k != "samples"}
    | {"along": ("stiffness.shoulder", [0.0, 1.0]), "fixed": {}},
    st.stable_ranges: RANGES,
    st.stable_ranges_by_case: RANGES | {"pose": {"shoulder": [1.0, 1.3]}},
    st.joint_roots: {
        "model": "furrer", "pose": {}, "stiffness": {"shoulder": 1.0}, "damping": {}, "lock": (),
    },
    st.principal_inertias: {"model": "furrer", "pose": {}},
    st.principal_axes: {"inertia": np.diag(THREE)},
    st.locked_speeds: {"model": so.load("furrer"), "lock": "shoulder"},
    rigid.RigidMotion: {"inertias": THREE, "omega0": [0.1, 1.0, 0.2], "attitude0": FOUR},
    rigid.RigidMotion.from_momentum: {"inertias": THREE, "momentum": 1.0, "attitude0": FOUR},
    TUMBLE.omega: {"t": 1.0},
    TUMBLE.quaternion: {"t": 1.0},
    TUMBLE.angles: {"t": 1.0},
    TUMBLE.momentum_angles: {"t": 1.0},
    rigid.energy_bounds: {"inertias": THREE, "momentum": 1.0},
    rigid.energy_curve: {"inertias": THREE, "energy": 0.3, "points": 5, "momentum": 1.0},
    rigid.euler_rates: {"inertias": THREE, "omega": THREE},
    rigid.growth_angle: {"k1": 0.5, "k3": -0.5, "N": 10.0},
    rigid.gyric_matrices: {"I1": 1.0, "I2": 2.0, "I3": 2.5},
    rigid.gyric_roots: {"k1": 0.5, "k3": -0.5},
    rigid.inertia_ratios: {"I1": 1.0, "I2": 2.0, "I3": 2.5},
    rigid.inertias_from_ratios: {"k1": 0.5, "k3": -0.5},
    rigid.kind_of_motion: {"inertias": THREE, "omega": THREE, "tolerance": 0.0},
    rigid.momentum_direction: {"tilt": 0.1, "twist": 0.2},
    rigid.quadrant: {"k1": 0.5, "k3": -0.5},
    rigid.separatrix: {"inertias": THREE, "points": 5},
    rigid.tilt_and_twist: {"cosines": THREE},
    attitude.as_axes: {"axes": (2, 1, 3)},
    attitude.angle_rates: {"axes": (2, 1, 3), "angles": [0.1, 0.2, 0.3], "omega": THREE},
    attitude.body_rates: {"axes": (2, 1, 3), "angles": [0.1, 0.2, 0.3], "rates": THREE},
    attitude.angles_from_matrix: {"cosines": np.eye(3)},
    attitude.angles_from_quaternion: {"quaternion": FOUR, "axes": (2, 1, 3)},
    attitude.direction_cosines: {"somersault": 0.1, "tilt": 0.2, "twist": 0.3},
    attitude.matrix_from_quaternion: {"quaternion": FOUR},
    attitude.quaternion_conjugate: {"quaternion": FOUR},
    attitude.quaternion_from_angles: {
        "somersault": 0.1, "tilt": 0.2, "twist": 0.3, "axes": (2, 1, 3)
    },
    attitude.quaternion_from_matrix: {"matrix": np.eye(3)},
    attitude.quaternion_product: {"first": FOUR, "second": FOUR},
    attitude.unwrapped_angles: {"quaternions": [FOUR, FOUR], "axes": (2, 1, 3)},
    attitude.side: {"axes": (2, 1, 3)},
}  # fmt: skip
ARGUMENTS = [
    pytest.param(call, name, id=f"{call.__qualname__}-{name}")
    for call, right in RIGHT.items()
    for name in right
]


@pytest.mark.parametrize(("call", "name"), ARGUMENTS)
def test_one_sentence_or_an_answer(call: Callable[..., Any], name: str) -> None:
    right = RIGHT[call]
    call(**right)
    for wrong in WRONG:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("error", RuntimeWarning)
            try:
                call(**{**right, name: wrong})
            except so.SomersaultError as mistake:
                assert "\n" not in str(mistake)
                assert len(str(mistake)) < 400
