"""Chapter 3: what its claims would notice."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from somersault import rigid
from somersault.robot import run, tuck_servo
from somersault.thesis import reproduce
from somersault.thesis.ch3 import _airborne, _biped, _running, _somersault, _strategy
from somersault.thesis.ch3._free_flight import reflown
from somersault.thesis.ch3._runs import nominal
from somersault.thesis.ch3._scatter import HELD_OUT, held_out

QUICK = [
    "table3-1", "fig3-2", "fig3-3", "sec3-3", "table3-2", "fig3-5", "fig3-6", "fig3-7",
]  # fmt: skip
PRINTED_WRONG = {"sec3-3.derivative", "sec3-3.sign"}


@pytest.mark.slow
def test_single_somersaults_do_what_the_chapter_says(tmp_path: Path) -> None:
    claims = reproduce(QUICK, tmp_path, progress=False)
    assert len(claims) > 35
    assert {c.id for c in claims if not c.holds} == PRINTED_WRONG
    for name in ("fig3-2", "fig3-3", "fig3-5", "fig3-6", "fig3-7"):
        assert (tmp_path / "figures" / f"{name}.png").stat().st_size > 5000


@pytest.mark.slow
def test_free_flight_by_two_programs() -> None:
    """The same torques from the same state; and they are those of the flight, which both follow at
    first: stiff legs without their servos drift apart later."""
    flown = reflown()
    assert flown.times[-1] > 0.6
    angle, joint = flown.apart(flown.mujoco, flown.ours)
    assert angle < 1e-5
    assert joint < 1e-4
    soon = flown.times < 0.05
    assert np.abs(flown.run[soon, :4] - flown.ours[soon, :4]).max() < 0.01
    moved = np.ptp(flown.run, axis=0)
    assert moved[4:].max() > 0.3


def test_separatrix_angle_is_where_motions_change_kind() -> None:
    inertias = np.diag(_biped.inertia(0.862))
    edge = _biped.separatrix_angle(inertias)
    kinds = []
    for angle in (edge - 1e-3, edge + 1e-3):
        c = np.array([0.0, np.cos(angle), np.sin(angle)])
        kinds.append(rigid.RigidMotion(inertias, c / inertias).kind)
    assert kinds == ["major", "minor"]


def test_whether_it_falls_after_a_push_depends_on_the_moment(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """So that one moment would say little."""
    monkeypatch.setattr(_running, "_PUSHES", {"sideways": (200.0, -300.0)})
    fell = _running.falls.__wrapped__("sideways")
    assert fell[200.0] == 0
    assert 0 < fell[-300.0] < 12


def test_a_robot_that_does_not_flip_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    never = run("biped", 5.0, samples=1000)
    monkeypatch.setattr(_somersault, "nominal", lambda: never)
    with pytest.raises(IndexError):
        _somersault.fig_3_5()


def test_another_lift_off_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A servo that is off turns too far, and the claims about it fail."""
    from somersault.robot import Control, Flip

    held = run(
        "biped", 8.0, Control(flip=Flip(servo=0.0, held_length=0.66)), flip=3.0, samples=1000
    )
    monkeypatch.setattr(_airborne, "nominal", lambda: held)
    failing = {c.id for c in _airborne.fig_3_6().claims if not c.holds}
    assert {"fig3-6.slows", "fig3-6.meet"} <= failing


def test_a_wrong_slope_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    true = tuck_servo.mismatch_slope
    monkeypatch.setattr(tuck_servo, "mismatch_slope", lambda *a: 0.7 * true(*a))
    failing = {c.id for c in _strategy.sec_3_3().claims if not c.holds}
    assert "sec3-3.newton" in failing


def test_prediction_of_flight_time_follows_the_run() -> None:
    run_ = nominal()
    assert _somersault._parabola(run_) == pytest.approx(run_.outcome["flight_time"], abs=0.012)


@pytest.mark.slow
def test_held_out_attempts() -> None:
    """A part of those that the chapter counts; four hundred give 99.75 %."""
    data = held_out(48).dataset
    assert HELD_OUT not in (1, 2)
    assert (data["ended"].values == 0).mean() > 0.9


def test_map_with_the_weight() -> None:
    """Tilts at the separatrix against exact motions, and inertias against parallel axes."""
    from somersault.thesis.ch6 import _weighted_biped as heavy

    result = heavy.fig_6_6()
    assert all(claim.holds for claim in result.claims)
    for inertias in (np.diag(_biped.inertia(0.75)), heavy.weighted(0.75)):
        edge, kinds = heavy.twisting_tilt(inertias), []
        for angle in (edge - 1e-3, edge + 1e-3):
            c = np.array([0.0, np.cos(angle), np.sin(angle)])
            kinds.append(rigid.RigidMotion(inertias, c / inertias).kind)
        assert kinds == ["major", "minor"]
    com = 4 * 0.8 / 35.44
    by_hand = _biped.inertia(0.75)[1, 1] + 31.44 * com**2 + 4 * (0.8 - com) ** 2
    assert heavy.weighted(0.75)[1] == pytest.approx(by_hand, rel=1e-12)
