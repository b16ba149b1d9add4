"""What would take hours or all memory is refused before it begins, with the size and the limit."""

from __future__ import annotations

import os
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

import somersault as so
from somersault.dynamics import latex
from somersault.model import Body, Joint, Model
from somersault.model.athlete import athlete_from_measurements

SPIN = so.Takeoff(spin=8.0)
FREE = so.Takeoff(spin=8.0, joints={"left_shoulder": so.JointTakeoff.free(rate=1e7)})


def chain(joints: int) -> Model:
    """Bodies alike, each on a hinge across the one before."""
    alike = {"mass": 1.0, "inertia": tuple(map(tuple, np.diag([0.01, 0.02, 0.03])))}
    bodies = [Body("base", -1, com=(0.0, 0.0, 0.0), **alike)]
    for k in range(joints):
        hinge = Joint(f"hinge {k}", "hinge", axis=tuple(np.eye(3)[k % 3]))
        bodies.append(
            Body(
                f"link {k}",
                k,
                com=(0.1, 0.2, 0.3),
                position=(0.2, 0.0, 0.1),
                joints=(hinge,),
                **alike,
            )
        )
    return Model("chain", True, tuple(bodies))


@pytest.mark.parametrize(
    ("model", "takeoff", "options"),
    [
        ("book", SPIN, {"duration": 9e8}),
        ("furrer", FREE, {"duration": 1.0}),
        ("gymnast", SPIN, {"duration": 1.0, "samples": 5_000_000}),
    ],
)
def test_a_flight_beyond_memory_is_refused_before_any_is_taken(
    model: str, takeoff: so.Takeoff, options: dict
) -> None:
    so.fly(model, SPIN, 0.1)  # what is compiled
    samples = options.get("samples", 101)
    tracemalloc.start()
    try:
        with pytest.raises(so.SomersaultError, match=r"may turn .* moments fit into the 1 GB"):
            so.fly(model, takeoff, **{"samples": 101, **options})
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert most < 2**26 + 5 * 8 * samples


def test_a_long_flight_within_the_limit_is_flown() -> None:
    flight = so.fly("book", so.Takeoff(spin=8.0), 1_000.0, samples=2)
    assert flight.landing.somersault == pytest.approx(8_000.0, abs=1e-5)


def test_a_chain_of_a_thousand_is_refused_with_its_size_and_the_limit() -> None:
    for joints in (151, 1_000):
        with pytest.raises(so.SomersaultError, match=rf"chain moves in {joints} ways .* up to 150"):
            chain(joints)
    assert len(chain(150).joints) == 150


def test_latex_that_nobody_would_read_is_refused() -> None:
    with pytest.raises(so.SomersaultError, match="the LaTeX of chain would fill pages"):
        latex(chain(3))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes")
def test_nobody_waits_for_a_pipe(tmp_path: Path) -> None:
    for ending in (".xml", ".urdf", ".bioMod", ".osim", ".toml", ".csv", ".txt"):
        os.mkfifo(tmp_path / f"pipe{ending}")
    for ending in (".xml", ".urdf", ".bioMod", ".osim"):
        with pytest.raises(so.SomersaultError):
            so.load(tmp_path / f"pipe{ending}")
    with pytest.raises(so.SomersaultError):
        so.Maneuver.read(tmp_path / "pipe.toml")
    with pytest.raises(so.SomersaultError):
        so.read_recording(tmp_path / "pipe.csv", "furrer")
    with pytest.raises(so.SomersaultError, match="pipe"):
        athlete_from_measurements(tmp_path / "pipe.txt")
