"""Trade-offs: fronts that are known, restarts, SPECs, and what is refused."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_designs import ARMS, BOTH, SCATTER, TWISTED, Bowl

import somersault as so
from somersault import SomersaultError
from somersault.designs import Choose, Limit, Mean, Quantile, Share, trade_off
from somersault.designs._front import front, search_front
from somersault.designs._journal import Journal
from somersault.designs._trial import Outcome

pytest.importorskip("pymoo")
AIMS = (Mean("error"), Mean("torque"))


def found(objectives: Any = AIMS, choose: Any = BOTH, of: Any = None, **options: Any) -> Any:
    given: dict[str, Any] = {"size": 64, "seed": 3, "evaluations": 600, "held_out": 2_000}
    return trade_off(of or Bowl(), choose, SCATTER, objectives, **given | options)


def test_the_front_of_a_bowl_is_the_line_to_no_torque() -> None:
    """Error (x − 2)² + 4 (y − 1)² + 1/4 against |x|: y is 1 all along, and x goes from 0 to 1.8, as
    a hundredth of the errors' range is not told apart."""
    data = found().dataset
    x, y = data["chosen"].values.T
    np.testing.assert_allclose(y, 1.0, atol=0.15)
    assert x.min() == pytest.approx(0.0, abs=0.05)
    assert 1.75 < x.max() < 2.05
    error, torque = data["figure"].values.T
    np.testing.assert_allclose(torque, x, atol=1e-12)
    np.testing.assert_allclose(error, (x - 2) ** 2 + 4 * (y - 1) ** 2 + 0.25, atol=0.01)
    assert (np.diff(error) > 0).all()
    assert np.abs(np.diff(torque)).max() < 0.4  # no gaps
    assert (data["low"] <= data["figure"]).all()
    assert (data["figure"] <= data["high"]).all()
    assert list(data["units"].values) == ["1", "1"]


def test_a_limit_ends_the_front() -> None:
    data = found(limits=[Limit("torque", most=1.0)]).dataset
    torque = data["figure"].values[:, 1]
    assert torque.max() <= 1.0
    assert torque.max() > 0.95


def test_what_is_chosen_may_be_an_objective() -> None:
    named = {"far": BOTH["x"], "y": BOTH["y"]}
    one = found([Mean("error"), Mean("far")], named).dataset
    other = found([Mean("error"), Mean("torque")], named).dataset
    assert list(one["objective"].values) == ["mean error", "far"]
    np.testing.assert_allclose(one["figure"], other["figure"], rtol=1e-12)
    np.testing.assert_allclose(one["low"][:, 1], one["high"][:, 1], rtol=1e-9)


def test_shares_and_quantiles_and_three_objectives() -> None:
    aims = [Share("error", most=0.25), Quantile("error", q=0.9), Mean("torque")]
    data = found(aims).dataset
    assert data.sizes["objective"] == 3
    share, worst, torque = data["figure"].values.T
    assert share.max() > 0.6
    assert worst.min() < 1.1
    assert torque.min() < 0.1


def test_the_same_call_finds_the_same_and_goes_on_where_it_stopped(tmp_path: Path) -> None:
    whole = found(out=tmp_path / "whole", evaluations=150)
    again = found(evaluations=150)
    assert whole.table.tobytes() == again.table.tobytes()
    assert whole.dataset.identical(again.dataset)
    kept = json.loads((tmp_path / "whole" / "design.json").read_text())
    kept["generations"] = kept["generations"][:3]
    (tmp_path / "part").mkdir()
    (tmp_path / "part" / "design.json").write_text(json.dumps(kept))
    assert found(out=tmp_path / "part", evaluations=150).dataset.identical(whole.dataset)
    files = [(tmp_path / name / "design.json").read_bytes() for name in ("whole", "part")]
    assert files[0] == files[1]
    with pytest.raises(SomersaultError, match="holds another design"):
        found((*AIMS, Mean("share_of_x")), out=tmp_path / "part", evaluations=150)


def test_where_there_is_nothing_new_to_try_the_search_ends() -> None:
    judged: list[int] = []

    def outcome(parts: np.ndarray) -> Outcome:
        return Outcome(np.zeros((len(parts), 2)), np.zeros((len(parts), 2)), np.zeros(len(parts)))

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("pymoo.core.mating.Mating.do", lambda *given, **options: [])
        search_front(np.zeros(2), 2, 100, 8, 0, Journal(None, {}), outcome, judged.append)
    assert judged == [8]


def test_numpys_own_random_numbers_are_left_alone() -> None:
    np.random.seed(5)
    first = np.random.rand()
    np.random.seed(5)
    found(evaluations=60)
    assert np.random.rand() == first


def test_a_point_is_a_design() -> None:
    traded = found(evaluations=200)
    for point, objective in ((0, 0), (len(traded.parts) - 1, 1)):
        design = traded.design(point, objective)
        row = traded.dataset.isel(point=point)
        assert list(design.best.values()) == row["chosen"].values.tolist()
        assert design.figure == row["figure"].values[objective]
        assert design.interval == (row["low"].values[objective], row["high"].values[objective])
        assert design.first_figure == traded.first["figure"].values[objective]
        assert design.on(size=10).figure > 0
        assert np.isfinite(design.history["best"][-1])
    for point, objective in ((len(traded.parts), 0), (0, 2), (-1, 0)):
        with pytest.raises(SomersaultError):
            traded.design(point, objective)


def test_a_front_has_its_ends_and_no_two_points_alike() -> None:
    angle = np.linspace(0, np.pi / 2, 2_001)
    circle = 1 - np.stack([np.sin(angle), 5 * np.cos(angle)], 1)
    inside = circle + 0.1
    every = np.concatenate([inside, circle, circle + 1e-9])
    places = front(every, 9)
    taken = every[places]
    assert len(places) == 9
    assert (np.diff(taken[:, 0]) > 0).all()
    much = np.sqrt(1 - 0.99**2)  # that one objective gains for a hundredth of the other
    np.testing.assert_allclose(taken[0] / [1, 5], [0.01, 0.2 - much], atol=0.005)
    np.testing.assert_allclose(taken[-1] / [1, 5], [1 - much, 0.2 - 0.99], atol=0.005)
    gaps = np.linalg.norm(np.diff(taken / [1, 5], axis=0), axis=1)
    assert gaps.max() < 2.5 * gaps.min()
    assert not np.isin(places, np.arange(len(circle))).any()  # those inside are dominated


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"objectives": [Mean("error")]}, "two objectives at least"),
        ({"objectives": Mean("error")}, "objectives"),
        ({"objectives": [Mean("error"), "torque"]}, "objectives"),
        ({"objectives": [Mean("error"), Mean("error")]}, "mean error is traded off against itself"),
        ({"objectives": [Mean("x"), Mean("y")]}, "nothing has to be run"),
        ({"objectives": [Mean("error"), Mean("z")]}, "z is not reported"),
        ({"choose": {"torque": BOTH["x"]}}, "both chosen and reported"),
        ({"points": 1}, "points"),
        ({"population": 1}, "population"),
        ({"limits": [Limit("torque", most=1e-9)]}, "keeps to the limits"),
        ({"of": Bowl(fails_above=0.5)}, "say what they count as"),
    ],
)
def test_a_mistake_gets_a_sentence(change: dict[str, Any], said: str) -> None:
    with pytest.raises(SomersaultError, match=said):
        found(**{"evaluations": 48, **change})


def test_a_scatter_of_nothing_is_refused() -> None:
    with pytest.raises(SomersaultError, match="nothing is scattered"):
        trade_off(Bowl(), BOTH, {}, AIMS)


def test_without_pymoo_one_is_told_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(SomersaultError, match=r"pip install somersault\[tradeoffs\]"):
        found()


def test_a_maneuver_reports_the_extremes_that_are_asked_for() -> None:
    layout = so.Maneuver("furrer", so.Takeoff(spin=8.64, joints=ARMS), 0.3)
    choose = {"K": Choose(sets="joints.shoulder.K", between=(0.1, 2.0))}
    aims = [Mean("twist", counts_as=3.2), Quantile("greatest_left_shoulder_torque", q=0.95)]
    traded = trade_off(layout, choose, TWISTED, aims, size=4, evaluations=24, held_out=8)
    assert list(traded.dataset["units"].values) == ["rad", "N m"]
    picture = traded.plot()
    assert picture.axes[0].get_ylabel() == "mean twist (rad)"
    assert "shoulder_torque (N m)" in picture.axes[0].get_xlabel()


SPEC = """
model = "furrer"
duration = 0.2
[takeoff]
spin = 8.64
[joints.shoulder]
motion = "sprung"
angle = 1.3
K = 0.3
hold = true
[vary.twisted]
adds_to = "takeoff.twist"
normal = [0.0, 0.02]
[sample]
size = 4
sequence = "sobol"
[choose.K]
sets = "joints.shoulder.K"
between = [0.1, 2.0]
[objectives.twist]
kind = "mean"
quantity = "twist"
counts_as = 3.2
[objectives.soft]
kind = "mean"
quantity = "K"
[search]
evaluations = 48
points = 4
held_out = 8
"""


@pytest.mark.slow
def test_the_shell_trades_off(tmp_path: Path) -> None:
    spec, picture = tmp_path / "front.toml", tmp_path / "front.png"
    spec.write_text(SPEC)
    command = [sys.executable, "-m", "somersault", "design", str(spec)]
    out = [*command, "--out", str(tmp_path / "kept"), "--plot", str(picture), "--json"]
    told = subprocess.run(out, capture_output=True, check=True, encoding="utf-8")
    record = json.loads(told.stdout)
    assert record["objectives"] == ["mean twist", "K"]
    data = so.designs.read_design(spec).run().dataset
    assert [p["figure"] for p in record["points"]] == data["figure"].values.tolist()
    assert len(record["points"]) <= 4
    assert picture.stat().st_size > 10_000
    page = subprocess.run(command, capture_output=True, check=True, encoding="utf-8").stdout
    assert "points of the front of 48 candidates" in page
    assert "mean twist (rad)" in page
    assert record["objective_units"] == ["rad", ""]
    one = SPEC.replace("[objectives.twist]", "[objective]").replace("points = 4", "")
    spec.write_text(one.replace('[objectives.soft]\nkind = "mean"\nquantity = "K"\n', ""))
    page = subprocess.run(command, capture_output=True, check=True, encoding="utf-8").stdout
    assert re.search(r"mean twist, 8 other starts: [\d.]+ rad \(", page)


def test_a_spec_has_ranges(tmp_path: Path) -> None:
    spec = tmp_path / "front.toml"
    limit = '[limits.turned]\nquantity = "twist"\nleast = -0.5\nmost = 2\nshare = 0.9\n'
    spec.write_text(SPEC + limit)
    (read,) = so.designs.read_design(spec).limits
    assert read == Limit("twist", most=2.0, least=-0.5, share=0.9)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("[objectives.soft]", "[objective]"), "has both"),
        (('[objectives.soft]\nkind = "mean"\nquantity = "K"\n', ""), "two tables"),
        (("evaluations = 48", "width = 0.2"), "search.width is for objectives, one alone"),
        (("[objectives.twist]", "[objectives]\nodd = 3\n[objectives.twist]"), "objectives.odd"),
        (('quantity = "K"', ""), "objectives.soft.quantity is missing"),
        (
            ('quantity = "K"', 'quantity = "K"\nq = 1'),
            "objectives.soft.q is no key of a SPEC",
        ),
        (
            ("[search]", "[serch]"),
            "serch is no key of a design's SPEC.*, limits, search",
        ),
        (
            ("between =", 'scale = "lg"\nbetween ='),
            "K.scale must be 'linear' or 'log', and",
        ),
        (("[search]", "[limits.low]\nmost = 1\n[search]"), "limits.low.quantity is missing"),
    ],
)
def test_a_spec_that_is_none_is_refused(change: tuple[str, str], said: str, tmp_path: Path) -> None:
    spec = tmp_path / "front.toml"
    spec.write_text(SPEC.replace(*change))
    with pytest.raises(SomersaultError, match=said):
        so.designs.read_design(spec)
