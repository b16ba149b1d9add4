"""Chapter 2 and the flights of chapter 4: what they compute is what they say."""

from __future__ import annotations

import json

import numpy as np
import pytest

import somersault as so
from somersault import rigid
from somersault import stability as st
from somersault.flight import fly
from somersault.thesis import ENTRIES, reproduce
from somersault.thesis.ch2 import _inertia_ratios as gyric
from somersault.thesis.ch2 import _momentum_sphere as spheres
from somersault.thesis.ch2 import _postures as humans
from somersault.thesis.ch4 import _arm_raised as asymmetry
from somersault.thesis.ch4 import _layout_takeoff as layout
from somersault.thesis.ch4 import _lifetimes as ridge
from somersault.thesis.ch4 import _tilt_and_twist_paths as reorientation
from somersault.view import contact_sheet

QUICK = ["fig2-1", "eq2", "fig2-2", "fig2-4", "fig2-6", "fig2-7", "fig2-8", "fig3-3", "fig4-13"]
PRINTED_WRONG = {"eq2.nu"}  # the thesis's errata: ±ν for ±jν


def test_entries_stand_in_the_order_of_the_thesis():
    chapters = [entry.chapter for entry in ENTRIES]
    assert chapters == sorted(chapters)
    ids = [entry.id for entry in ENTRIES]
    for figure in range(1, 9):
        assert f"fig2-{figure}" in ids
    for figure in [2, 3, 12, 13, 14, 15]:
        assert f"fig4-{figure}" in ids


# ------------------------------------------------------------------------------- chapter 2


def test_random_bodies_are_bodies_of_every_kind():
    bodies = gyric.random_bodies()
    assert np.all(2 * bodies.max(1) < bodies.sum(1))
    kinds, counts = np.unique(rigid.quadrant(*rigid.inertia_ratios(*bodies.T)), return_counts=True)
    assert set(kinds) >= {1, 2, 3, 4}
    assert counts.min() > 100


def test_roots_notice_a_wrong_sign(monkeypatch):
    """The claim that only equal signs are stable is made of eigenvalues, not of the signs."""
    true = rigid.gyric_matrices
    assert all(c.holds for c in gyric.fig_2_3().claims)
    monkeypatch.setattr(rigid, "gyric_matrices", lambda *i: (*true(*i)[:2], -true(*i)[2]))
    assert not any(c.holds for c in gyric.fig_2_3().claims)


@pytest.mark.parametrize("name", humans.POSTURES)
def test_path_of_postures_passes_through_the_shipped_athletes(name):
    share, path = humans._path()
    at = int(np.argmin(np.abs(share - humans.POSTURES.index(name))))
    there = rigid.inertia_ratios(*st.principal_inertias(f"human_{name}"))
    # Drawn by hand there, by joint angles here: the wrists are some centimetres elsewhere.
    np.testing.assert_allclose(path[:, at], there, atol=0.02)
    assert np.abs(np.diff(path, axis=1)).max() < 0.1  # no axis is taken for another


@pytest.mark.parametrize("model", ["human_layout", "human_pike", "human_tuck"])
def test_share_of_the_sphere_is_what_chance_finds(model):
    inertias = st.principal_inertias(model)
    c = np.random.default_rng(1).normal(size=(40_000, 3))
    c /= np.linalg.norm(c, axis=1, keepdims=True)
    above = np.sum(c * c / inertias, 1) > 1 / np.sort(inertias)[1]
    assert spheres.minor_share(inertias) == pytest.approx(above.mean(), abs=0.01)


# ----------------------------------------------------------------------------- the flights


def test_a_batch_of_lifetimes_is_flights_flown_one_by_one():
    angles, springs = np.array([0.9, 1.3]), np.array([0.0, 0.5, 1.1])
    found = ridge.lifetimes(angles, springs, 0.02, 0.01)
    for i, angle in enumerate(angles):
        for j, spring in enumerate(springs):
            start = layout.takeoff(layout.sprung(angle, spring), 0.02, 0.01, "rates")
            alone = fly("furrer", start, 9.6 * layout.TURN, until="quarter twist", samples=600)
            turns = min(alone.landing.somersault / (2 * np.pi), 8.0)
            assert found.somersaults[i, j] == pytest.approx(turns, abs=1e-5)
            assert (turns < 8) == (alone.ended == "event" and turns < 8)
            if turns < 8:
                most = np.abs(alone.dataset["twist"].values[:-1]).max()
                assert found.furthest[i, j] == pytest.approx(most, abs=0.05)


def test_lifetimes_do_not_depend_on_the_accuracy():
    """Where they last; a flight that wanders along the edge for long multiplies any error."""
    few = np.array([0.6, 1.2, 1.8]), np.array([0.3, 1.5])
    rough, fine = (ridge.lifetimes(*few, 0.01, 0.0, accuracy=a) for a in (1e-8, 1e-11))
    np.testing.assert_allclose(rough.somersaults, fine.somersaults, atol=1e-4)


@pytest.mark.parametrize(("spring", "lasts"), [(0.5, 2.3), (1.8, 2.7)])
def test_lifetimes_of_another_implementation(spring, lasts):
    assert layout.lifetime(1.3, spring, "rates") == pytest.approx(lasts, abs=0.05)


def test_the_two_starts_differ_as_they_say():
    joints = layout.sprung(1.3, 1.1)
    for begun in ("momentum", "rates"):
        flown = fly("furrer", layout.takeoff(joints, 0.01, 0.02, begun), 0.01, samples=[0.0])
        h = flown.start.momentum
        if begun == "momentum":
            np.testing.assert_allclose(h[[0, 2]], 0, atol=1e-12 * h[1])
        else:
            turn = so.flight._flight.matrix_from_quaternion(flown.start.quaternion)
            np.testing.assert_allclose(turn @ flown.start.omega, [0, layout.SPIN, 0], atol=1e-12)


def test_widening_takes_in_the_points_around():
    region = np.zeros((5, 6), bool)
    region[2, 3] = True
    wide = ridge.widened(region)
    assert wide.sum() == 9
    assert wide[1:4, 2:5].all()


def test_body_tilt_from_an_arm_is_that_of_the_planar_problem():
    flown = asymmetry.raised()
    assert flown.landing.tilt == pytest.approx(asymmetry.planar_tilt(), abs=1e-8)
    assert abs(flown.landing.tilt) > 0.05
    assert np.abs(flown.angular_momentum).max() < 1e-10


def test_circling_counts_turns_and_their_sense():
    angle = np.linspace(0, 4 * np.pi, 400)
    turns, share = reorientation.circling(tilt=np.sin(angle), twist=np.cos(angle))
    assert turns == pytest.approx(2)
    assert share == 1
    assert reorientation.circling(np.sin(-angle), np.cos(angle))[0] == pytest.approx(-2)


def test_principal_axes_circle_and_the_arms_answer():
    claims = {c.id: c.holds for c in reorientation.fig_4_15().claims}
    assert claims["fig4-15.circles"]
    assert claims["fig4-15.upstream"]
    assert claims["fig4-15.arms"]
    assert claims["fig4-15.gyroscopic"]


# -------------------------------------------------------------------------- posed pictures


def test_contact_sheet_has_a_picture_for_each_time():
    start = layout.takeoff(layout.sprung(1.3, 1.1))
    flown = fly("furrer", start, 0.5)
    made = contact_sheet(flown, np.linspace(0, 0.5, 7), columns=4)
    assert len(made.axes) == 2
    assert (
        sum(len(ax.patches) for ax in made.axes) == 7 * 7
    )  # times, and shapes of Furrer with a neck
    words = [text.get_text() for ax in made.axes for text in ax.texts]
    assert len(words) == 7
    assert words[-1].startswith("0.50 s")


# ------------------------------------------------------------------------------ the report


def test_quick_entries_hold(tmp_path):
    claims = reproduce(QUICK, tmp_path, progress=False)
    assert {c.id for c in claims if not c.holds} == PRINTED_WRONG
    assert len(json.loads((tmp_path / "claims.json").read_text(encoding="utf-8"))) == len(claims)
    for name in set(QUICK) - {"eq2"}:
        assert (tmp_path / "figures" / f"{name}.png").stat().st_size > 5000


@pytest.mark.slow
def test_layout_entries_hold_but_for_what_is_known(tmp_path):
    ids = ["ch2", "fig4-2", "fig4-3", "fig4-12", "sec4-3-3", "fig4-13", "fig4-14", "fig4-15"]
    claims = reproduce(ids, tmp_path, progress=False)
    assert {c.id for c in claims if not c.holds} == PRINTED_WRONG | {"fig4-15.body"}
    assert all(c.note for c in claims if not c.holds)


@pytest.mark.slow
def test_long_runs_keep_energy_and_momentum():
    for spring, angle in ((1.2, 1.4), (1.0, 1.6)):
        start = layout.takeoff(layout.sprung(angle, spring), begun="rates")
        flown = fly("furrer", start, 2000.0, accuracy=1e-12, samples=20_001, until="quarter twist")
        assert flown.ended == "duration"
        assert flown.landing.somersault > 2750 * 2 * np.pi
        assert flown.energy_drift < 1e-10
        assert flown.momentum_drift < 1e-10
