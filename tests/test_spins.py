"""Spins as a simulation: margins, their ensembles, and designs by them, against the chart."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

import somersault as so
from somersault import SomersaultError
from somersault.designs import Choose, Mean, Share
from somersault.model import as_matrix

ARMS = 1.3
LAYOUT = so.stability.spins("furrer", pose={"shoulder": ARMS}, stiffness={"shoulder": 1.1})


def test_each_margin_is_that_of_its_own_spin() -> None:
    vary = {
        "arms": so.Vary(sets="pose.shoulder", values=[0.6, 1.3]),
        "K": so.Vary(sets="stiffness.shoulder", values=[0.2, 1.2]),
        "b": so.Vary(sets="damping.left_shoulder", values=[0.0, 0.1]),
        "mass": so.Vary(adds_to="bodies.left_arm.mass", values=[-0.4, 0.0]),
    }
    data = so.ensemble(LAYOUT, vary=vary).dataset["stability_margin"]
    furrer = so.load("furrer")
    for place in np.ndindex(data.shape):
        at = data[place]
        by = float(at.mass)
        bodies = [_heavier(b, by) if b.name == "left_arm" else b for b in furrer.bodies]
        arms, springs = float(at.arms), float(at.K)
        pose = {"left_shoulder": arms, "right_shoulder": -arms}  # bodies so unlike are no pair
        spin = so.spin(so.Model("other", True, tuple(bodies)), pose=pose)
        both = {"left_shoulder": springs, "right_shoulder": springs}
        linear = spin.linear(both, {"left_shoulder": float(at.b)})
        assert float(at) == pytest.approx(-linear.growth_rate, abs=1e-9)


def _heavier(body: so.Body, by: float) -> so.Body:
    inertia = (1 + by / body.mass) * np.array(body.inertia)
    return replace(body, mass=body.mass + by, inertia=as_matrix(inertia))


def test_springs_are_chosen_from_the_middle_of_the_chart() -> None:
    """Springs off by a normal scatter: most are stable about the middle of the stable range, and
    how many is what the normal distribution says."""
    ((low, high),) = so.stability.stable_ranges(
        "furrer", ("stiffness.shoulder", -2, 4), pose={"shoulder": ARMS}
    )
    choose = {"K": Choose(sets="stiffness.shoulder", between=(0.5, 2.0))}
    off = {"softer": so.Vary(adds_to="stiffness.shoulder", normal=[0.0, 0.2])}
    stable = Share("stability_margin", least=0.0)
    found = so.design(LAYOUT, choose, off, stable, size=1024, held_out=20_000, evaluations=60)
    assert found.best["K"] == pytest.approx((low + high) / 2, abs=0.03)
    half = (high - low) / 2 / 0.2
    expected = stats.norm.cdf(half) - stats.norm.cdf(-half)
    assert found.interval[0] - 0.003 < expected < found.interval[1] + 0.003


def test_the_margin_alone_chooses_the_layout_of_the_thesis() -> None:
    """1.3 rad and K = 1.2 (Playter 1994, figure 4-12), where arms and springs are a little off."""
    choose = {
        "K": Choose(sets="stiffness.shoulder", between=(0.3, 2.5)),
        "arms": Choose(sets="pose.shoulder", between=(0.3, 1.9)),
    }
    off = {
        "softer": so.Vary(adds_to="stiffness.shoulder", normal=[0.0, 0.1]),
        "raised": so.Vary(adds_to="pose.shoulder", normal=[0.0, 0.1]),
    }
    margin = Mean("stability_margin", largest=True)
    found = so.design(LAYOUT, choose, off, margin, size=128, held_out=512, evaluations=150)
    assert found.best["arms"] == pytest.approx(1.3, abs=0.06)
    assert found.best["K"] == pytest.approx(1.15, abs=0.1)
    assert found.figure > -0.01 > found.first_figure


def test_what_is_no_spin_is_counted() -> None:
    vary = {
        "b": so.Vary(sets="damping.shoulder", samples=[-0.1, 0.1, 0.1, -0.1]),
        "mass": so.Vary(sets="bodies.left_arm.mass", samples=[4.0, -1.0, 4.0, -1.0]),
    }
    with pytest.warns(so.SomersaultWarning, match="3 of 4 spins could not begin"):
        data = so.ensemble(LAYOUT, vary=vary).dataset
    assert np.isnan(data["stability_margin"].values).sum() == 3


def test_a_star_stands_for_springs_alike_and_a_pair_for_mirror_images() -> None:
    every = {target.name for target in LAYOUT.targets("stiffness.*shoulder")}
    assert every == {("stiffness", "left_shoulder"), ("stiffness", "right_shoulder")}
    assert [target.factor for target in LAYOUT.targets("pose.shoulder")] == [1.0, -1.0]
    assert [target.unit for target in LAYOUT.targets("bodies.body.mass")] == ["kg"]


@pytest.mark.parametrize("path", ["pose.knee", "pose.*", "stiffness", "takeoff.tilt", "mass", "*"])
def test_a_name_that_is_none_is_refused_with_those_there_are(path: str) -> None:
    with pytest.raises(SomersaultError, match=r"no number of these spins; .*pose\.left_shoulder"):
        LAYOUT.targets(path)


def test_a_spin_that_is_none_is_refused() -> None:
    with pytest.raises(SomersaultError, match="knee"):
        so.stability.spins("furrer", pose={"knee": 0.1})
    with pytest.raises(SomersaultError, match="damping"):
        so.stability.spins("furrer", damping={"shoulder": -0.1})


SPEC = {
    "model": "furrer",
    "spin": {"pose": {"shoulder": 1.3}, "stiffness": {"shoulder": 1.1}},
    "vary": {"softer": {"adds_to": "stiffness.shoulder", "normal": [0.0, 0.2]}},
    "sample": {"size": 20, "sequence": "sobol"},
}


def test_a_spec_of_spins_is_the_same() -> None:
    planned = so.ensembles.parse_ensemble(SPEC, Path()).plan
    margins = so.ensembles.carried_out(planned).dataset["stability_margin"]
    off = {"softer": so.Vary(adds_to="stiffness.shoulder", normal=[0.0, 0.2])}
    other = so.ensemble(LAYOUT, vary=off, size=20, sequence="sobol").dataset["stability_margin"]
    assert margins.values.tobytes() == other.values.tobytes()
    design = SPEC | {
        "choose": {"K": {"sets": "stiffness.shoulder", "between": [0.5, 2.0]}},
        "objective": {"kind": "mean", "quantity": "stability_margin", "largest": True},
        "search": {"evaluations": 40, "held_out": 40},
    }
    found = so.designs.parse_design(design, Path()).run()
    assert found.best["K"] == pytest.approx(1.1, abs=0.15)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"takeoff": {"spin": 1.0}}, "takeoff is no key of an ensemble of spins"),
        ({"spin": {"poses": {}}}, "spin.poses is no key"),
        ({"spin": {"pose": {"knee": 1.0}}}, "knee"),
        ({"spin": {"axis": "4"}}, "4"),
        ({"model": "nobody"}, "nobody"),
        ({"spin": 3}, "spin must be"),
    ],
)
def test_a_spec_of_spins_that_is_none_is_refused(change: dict[str, Any], said: str) -> None:
    with pytest.raises(SomersaultError, match=said):
        so.ensembles.parse_ensemble(SPEC | change, Path())
