"""How sharp a design is and which of its quantities matter, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from test_designs import ARMS, Bowl, found

import somersault as so
from somersault import SomersaultError
from somersault.designs import Choose, Mean, Share


def test_a_map_is_the_bowl() -> None:
    """The mean error over starts of variance v is (x − 2)² + v − 2 (x − 2) m + 4 (y − 1)²."""
    design = found(evaluations=60)
    data = design.map("x", "y", steps=5, reach=0.1)
    assert data["figure"].dims == ("y", "x")
    starts = design.dataset["off"].values
    x, y = data["x"].values, data["y"].values[:, None]
    expected = (x - 2) ** 2 - 2 * (x - 2) * starts.mean() + np.mean(starts**2) + 4 * (y - 1) ** 2
    np.testing.assert_allclose(data["figure"], expected, rtol=1e-12)
    assert x[2] == pytest.approx(design.best["x"])
    assert np.ptp(x) == pytest.approx(0.2 * 6.0)


def test_a_map_ends_at_the_bounds_and_follows_the_scale() -> None:
    choose = {
        "x": Choose(sets="x", between=(0.5, 8.0), scale="log"),
        "y": Choose(sets="y", between=(0.9, 4.0)),
    }
    data = found(choose, evaluations=60).map("y", "x", steps=4, reach=1.0)
    assert data["figure"].dims == ("x", "y")
    np.testing.assert_allclose(data["x"], np.geomspace(0.5, 8.0, 4))
    np.testing.assert_allclose(data["y"], np.linspace(0.9, 4.0, 4))


def test_sobol_indices_of_a_sum_are_the_shares_of_variance() -> None:
    """Var (x − 2)² over [−1, 5] is 7.2, Var 4 (y − 1)² over [0, 4] is 16 (12.2 − (7/3)²)."""
    ranked = found(evaluations=20).sensitivity(size=1024)
    assert list(ranked["input"].values) == ["y", "x"]
    of_x, of_y = 7.2, 16 * (12.2 - (7 / 3) ** 2)
    expected = np.array([of_y, of_x]) / (of_x + of_y)
    for which in ("first_order", "total"):
        off = np.abs(ranked[which].values - expected)
        assert (off < ranked[f"{which}_confidence"].values).all()
        np.testing.assert_allclose(ranked[which], expected, atol=0.05)


def test_near_the_best_both_matter_as_their_curvatures_say() -> None:
    """Windows of a tenth of the ranges, 6 and 4: (0.6² · 1)² against (0.4² · 4)²."""
    ranked = found(evaluations=600).sensitivity(size=1024, reach=0.1)
    expected = np.array([0.64**2, 0.36**2]) / (0.64**2 + 0.36**2)
    np.testing.assert_allclose(ranked["total"], expected, atol=0.06)


def test_the_same_ranking_again() -> None:
    design = found(evaluations=20)
    one, other = (design.sensitivity(size=64, seed=seed) for seed in (0, 0))
    assert one.identical(other)
    assert not one.equals(design.sensitivity(size=64, seed=1))


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda d: d.map("x", "x"), "against itself"),
        (lambda d: d.map("x", "z"), "z"),
        (lambda d: d.map("x", "y", steps=1), "steps"),
        (lambda d: d.map("x", "y", reach=0.0), "reach"),
        (lambda d: d.sensitivity(size=10), "size"),
        (lambda d: d.sensitivity(reach=2.0), "reach"),
    ],
)
def test_a_mistake_gets_a_sentence(call: object, said: str) -> None:
    with pytest.raises(SomersaultError, match=said):
        call(found(evaluations=10))  # type: ignore[operator]


def test_pictures_are_of_these_quantities() -> None:
    picture = found(evaluations=20).plot_map("x", "y", steps=3)
    ax = picture.axes[0]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x", "y")
    layout = so.Maneuver("furrer", so.Takeoff(spin=8.64, joints=ARMS), 0.2)
    choose = {
        "K": Choose(sets="joints.shoulder.K", between=(0.1, 2.0), scale="log"),
        "arms": Choose(sets="joints.shoulder.angle", between=(1.0, 1.4), unit="rad"),
    }
    vary = {"twisted": so.Vary(adds_to="takeoff.twist", normal=[0.0, 0.02])}
    for objective, label in (
        (Mean("twist", counts_as=3.2), "mean twist (rad)"),
        (Share("twist", most=0.1), "share with twist within 0.1"),
    ):
        design = so.design(layout, choose, vary, objective, size=4, evaluations=8, held_out=4)
        picture = design.plot_map("K", "arms", steps=3)
        assert picture.axes[1].get_ylabel() == label
        assert picture.axes[0].get_ylabel() == "arms (rad)"
        assert picture.axes[0].get_xscale() == "log"


def test_a_surface_of_failures_is_refused_as_the_design_is() -> None:
    with pytest.raises(SomersaultError, match="say what they count as"):
        found(of=Bowl(fails_above=0.5), evaluations=10).sensitivity(size=64)
