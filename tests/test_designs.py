"""Designs: optima that are known, the same starts for all, restarts, and what is refused."""

from __future__ import annotations

import json
import pickle
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

import somersault as so
from somersault import SomersaultError
from somersault.designs import Choose, Limit, Mean, Objective, Quantile, Share
from somersault.simulation import ENDED, Endings, Name, Numbers, Target, Variable

NAMES = ("x", "y", "start")


@dataclass(frozen=True)
class Bowl:
    """Error (x − 2 − start)² + 4 (y − 1)², "torque" |x|; some starts fail if asked for."""

    fails_above: float = np.inf

    name = "bowl"
    packages = ("numpy",)
    endings = Endings(("done", "failed", "no start"), ("failed", "no start"), "no start")
    together = 1_000
    times = np.empty(0)
    variables: Any = None

    def __post_init__(self) -> None:
        every = {name: Variable("1") for name in ("error", "torque", "share_of_x")}
        object.__setattr__(self, "variables", every)

    @property
    def specification(self) -> Mapping[str, Any]:
        return {"bowl": self.fails_above}

    @property
    def values(self) -> Numbers:
        return {(name,): 1.0 for name in NAMES[:2]} | {("start",): 0.0}

    def targets(self, path: str) -> tuple[Target, ...]:
        if path not in NAMES:
            raise SomersaultError(f"{path} names no number; there are {', '.join(NAMES)}")
        return (Target((path,), unit="1"),)

    def with_varied(self, names: tuple[Name, ...]) -> Bowl:
        return self

    def sound(self, values: Numbers, count: int) -> np.ndarray:
        return np.ones(count, bool)

    def run(self, values: Numbers, count: int) -> Mapping[str, np.ndarray]:
        x, y, start = (np.broadcast_to(values[name,], count) for name in NAMES)
        failed = start > self.fails_above
        error = np.where(failed, np.nan, (x - 2 - start) ** 2 + 4 * (y - 1) ** 2)
        return {
            "error": error, "torque": np.abs(x), "share_of_x": x / 4,
            ENDED: failed.astype(np.uint8),
        }  # fmt: skip


BOTH = {"x": Choose(sets="x", between=(-1.0, 5.0)), "y": Choose(sets="y", between=(0.0, 4.0))}
SCATTER = {"off": so.Vary(sets="start", normal=[0.0, 0.5])}
ERROR = Mean("error")


def found(choose: Any = BOTH, objective: Objective = ERROR, of: Any = None, **options: Any) -> Any:
    given: dict[str, Any] = {"size": 128, "seed": 3, "evaluations": 300, "held_out": 4_000}
    bowl = Bowl() if of is None else of
    return so.design(bowl, choose, SCATTER, objective, **given | options)


# ------------------------------------------------------------------------- known optima


def test_the_best_of_a_bowl_is_its_bottom() -> None:
    design = found()
    assert design.best["x"] == pytest.approx(2.0, abs=0.02)  # Sobol' starts have nearly no mean
    assert design.best["y"] == pytest.approx(1.0, abs=0.01)
    low, high = design.interval
    assert low < 0.25 < high  # the variance of the scatter
    assert design.figure == pytest.approx(0.25, abs=0.02)
    assert design.first_figure == pytest.approx(0.25 + 4.0, abs=0.05)  # from the middle: y = 2


def test_a_limit_that_binds_is_kept_to() -> None:
    design = found(limits=[Limit("torque", most=1.5)])
    assert design.best["x"] == pytest.approx(1.5, abs=1e-3)
    assert design.best["x"] <= 1.5
    assert design.figure == pytest.approx(0.25 + 0.25, abs=0.03)


def test_a_range_is_kept_to_from_below_and_above() -> None:
    """`share_of_x` is x / 4, and negative for negative x; the best of the bowl is at x = 2."""
    wide = {"x": Choose(sets="x", between=(-5.0, 5.0))}
    above = found(wide, limits=[Limit("share_of_x", least=0.75)])
    assert above.best["x"] == pytest.approx(3.0, abs=0.002)
    below = found(wide, limits=[Limit("share_of_x", least=-0.75, most=-0.25)])
    assert below.best["x"] == pytest.approx(-1.0, abs=0.002)
    kept = Limit("share_of_x", least=-2.0, most=1.0, share=0.5)
    off = kept.beyond(np.array([[-1.5, 9.0], [1.5, 9.0], [-3.0, 0.0]]), np.zeros((3, 2), bool))
    assert off.tolist() == [0.0, 0.25, 0.0]
    every = replace(kept, share=1.0)
    assert every.beyond(np.array([[-3.0, 0.0]]), np.zeros((1, 2), bool)).tolist() == [0.5]
    assert every.beyond(np.array([[np.nan, 0.0]]), np.zeros((1, 2), bool))[0] > 1


def test_the_worst_start_is_the_one_that_the_objective_likes_least() -> None:
    """The error is (x − 2 − start)², and `share_of_x` x / 4 of x with the scatter."""
    scatter = {"off": so.Vary(adds_to="x", normal=[0.0, 0.5])}
    for objective, of in (
        (Share("share_of_x", least=0.5), np.argmin), (Share("share_of_x", most=2.0), np.argmax),
        (Share("share_of_x", least=-9.0, most=1.0), np.argmax),
        (Mean("share_of_x", largest=True), np.argmin), (Mean("share_of_x"), np.argmax),
    ):  # fmt: skip
        choose = {"x": Choose(sets="x", between=(4.0, 5.0))}
        design = so.design(Bowl(), choose, scatter, objective, size=16, evaluations=10, held_out=64)
        off = design.dataset["off"].values
        assert design.worst_start == {"off": off[of(off)]}


def test_a_share_is_largest_where_the_distribution_says() -> None:
    """Good are starts within 0.5 of x − 2, so the best is the middle, and the share that of a
    normal distribution."""
    design = found(
        {"x": BOTH["x"]}, Share("error", most=0.25), size=1_024, held_out=20_000, evaluations=200
    )
    expected = stats.norm.cdf(1) - stats.norm.cdf(-1)
    assert design.best["x"] == pytest.approx(2.0, abs=0.1)
    low, high = design.interval
    assert low - 0.01 < expected < high + 0.01


def test_a_quantile_and_a_lifetime() -> None:
    worst = found({"x": BOTH["x"]}, Quantile("error", q=0.9), size=1_024, held_out=20_000)
    assert worst.figure == pytest.approx((0.5 * stats.norm.ppf(0.95)) ** 2, rel=0.05)
    longest = found({"x": BOTH["x"]}, Mean("share_of_x", largest=True))
    assert longest.best["x"] == pytest.approx(5.0, abs=1e-2)


def test_one_quantity_may_multiply_many_numbers_with_its_powers() -> None:
    twice = {"both": Choose(multiplies={"x": 1, "y": 2}, between=(0.25, 4.0), scale="log")}
    design = found(twice)
    numbers = design.numbers
    assert numbers["x",] == pytest.approx(design.best["both"])
    assert numbers["y",] == pytest.approx(design.best["both"] ** 2)
    grid = np.linspace(0.25, 4.0, 20_001)
    best = grid[np.argmin((grid - 2) ** 2 + 4 * (grid**2 - 1) ** 2)]
    assert design.best["both"] == pytest.approx(best, abs=0.02)


def test_how_sharp_the_optimum_is() -> None:
    around = found(evaluations=600).around(steps=21, reach=0.1)
    for name, curvature in (("x", 1.0), ("y", 4.0)):
        row = around.sel(quantity=name)
        fit = np.polyfit(row["value"], row["figure"], 2)
        assert fit[0] == pytest.approx(curvature, rel=1e-6)


def test_starts_are_scattered_about_what_is_chosen() -> None:
    """A number may be chosen and scattered: the scatter is added."""
    scatter = {"off": so.Vary(adds_to="x", normal=[0.0, 0.5])}
    design = so.design(
        Bowl(), {"x": BOTH["x"]}, scatter, ERROR, size=256, evaluations=200, held_out=4_000
    )
    assert design.best["x"] == pytest.approx(2.0, abs=0.02)
    assert design.figure == pytest.approx(0.25, abs=0.02)


def test_the_first_candidates_are_as_wide_as_is_said() -> None:
    one = found(evaluations=200, population=200, width=0.01).generations[0][0]
    assert np.std(one, 0) == pytest.approx([0.01, 0.01], rel=0.2)


# --------------------------------------------------------------- the same starts, and restarts


def test_all_candidates_have_the_same_starts_and_the_held_out_ones_others() -> None:
    design = found(evaluations=30)
    (planned,) = design.trial.planned(np.array([[1.0, 1.0], [2.0, 1.0], [3.0, 1.0]]))
    starts = planned.varied(0, planned.count)["off"].reshape(3, -1)
    assert np.array_equal(starts[0], starts[1])
    assert np.array_equal(starts[0], starts[2])
    held = design.dataset["off"].values
    assert not np.isin(starts[0], held).any()


def test_the_same_call_finds_the_same_and_goes_on_where_it_stopped(tmp_path: Path) -> None:
    whole = found(out=tmp_path / "whole", evaluations=60)
    again = found(evaluations=60)
    assert whole.table.tobytes() == again.table.tobytes()
    assert whole.rows["error"].tobytes() == again.rows["error"].tobytes()
    kept = json.loads((tmp_path / "whole" / "design.json").read_text())
    kept["generations"] = kept["generations"][:3]
    (tmp_path / "part").mkdir()
    (tmp_path / "part" / "design.json").write_text(json.dumps(kept))
    on = found(out=tmp_path / "part", evaluations=60)
    assert on.table.tobytes() == whole.table.tobytes()
    files = [(tmp_path / name / "design.json").read_bytes() for name in ("whole", "part")]
    assert files[0] == files[1]


def test_a_folder_with_another_design_is_refused(tmp_path: Path) -> None:
    found(out=tmp_path, evaluations=20)
    with pytest.raises(SomersaultError, match="holds another design"):
        found(out=tmp_path, evaluations=20, seed=4)
    (tmp_path / "design.json").write_text('{"digest": 3')
    with pytest.raises(SomersaultError, match="damaged"):
        found(out=tmp_path, evaluations=20)


def test_numpys_own_random_numbers_are_left_alone() -> None:
    np.random.seed(5)
    first = np.random.rand()
    np.random.seed(5)
    found(evaluations=20)
    assert np.random.rand() == first


# --------------------------------------------------------------------------------- bodies

ARMS = {"shoulder": so.JointTakeoff.sprung(angle=1.3, K=0.2, hold=True)}
STIFFNESS = {"stiffness": Choose(sets="joints.shoulder.K", between=(0.1, 2.0))}
TWISTED = {"twisted": so.Vary(adds_to="takeoff.twist", normal=[0.0, 0.02])}
TWIST = Mean("twist", counts_as=3.2)


def test_springs_are_chosen_from_where_the_layout_is_stable() -> None:
    layout = so.Maneuver("furrer", so.Takeoff(spin=8.64, joints=ARMS), 2.5)
    design = so.design(layout, STIFFNESS, TWISTED, TWIST, size=16, evaluations=30, held_out=64)
    spin = so.spin("furrer", pose={"shoulder": 1.3})
    assert spin.linear({"shoulder": design.best["stiffness"]}).stable
    assert design.figure < design.first_figure / 2
    flown = so.ensemble(design.simulation, vary=TWISTED, size=64, seed=1, sequence="sobol")
    assert flown.dataset["twist"].values.tobytes() == design.rows["twist"][1].tobytes()


def test_a_star_stands_for_joints_alike() -> None:
    runs = so.flight.flights(
        "gymnast",
        so.compliant("gymnast", so.arm_tilt().takeoff, 30.0, pose="wrap"),
        0.5,
        report=["twist"],
    )
    shoulders = runs.targets("joints.*shoulder*.stiffness")
    assert [t.name[1] for t in shoulders] == [
        name for name in so.load("gymnast").speeds if "shoulder" in name
    ]
    with pytest.raises(SomersaultError, match="fits no joint"):
        runs.targets("joints.*knee*.stiffness")
    with pytest.raises(SomersaultError, match="mirror image"):
        so.flight.flights("furrer", so.Takeoff(spin=1.0, joints=ARMS)).targets("joints.*.angle")
    with pytest.raises(SomersaultError, match="not in a joint's name"):
        runs.targets("takeoff.*")


def test_a_design_can_be_sent_to_another_process() -> None:
    design = found(evaluations=20)
    assert pickle.loads(pickle.dumps(design)).best == design.best
    assert "x " in repr(design)


# -------------------------------------------------------------------------------- mistakes


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"choose": {}}, "nothing is chosen"),
        ({"choose": {"x": Choose(sets="x", between=(2.0, 2.0))}}, "low below high"),
        ({"choose": {"x": Choose(sets="x", between=(-1.0, 2.0), scale="log")}}, "log scale"),
        ({"choose": {"x": Choose(between=(0.0, 1.0))}}, "moves no number"),
        ({"choose": {"x": Choose(sets="z", between=(0.0, 1.0))}}, "choose.x: z names no number"),
        ({"choose": {"x": Choose(sets="x", between=(0.0, 1.0), start=3.0)}}, "starts at 3"),
        ({"choose": {"a": BOTH["x"], "b": BOTH["x"]}}, "set the same number"),
        ({"choose": {"x": Choose(sets="start", between=(0.0, 1.0))}}, "vary.off sets a number"),
        ({"objective": Mean("landing")}, "landing is not reported"),
        ({"objective": "error"}, "give designs.Share"),
        ({"objective": Quantile("error", q=1.5)}, "between 0 and 1"),
        ({"objective": Mean("error", counts_as=-1.0)}, "counts_as is -1, and sizes"),
        ({"objective": Share("error")}, "objective has no bounds"),
        ({"objective": Share("error", most=-0.1)}, "objective.most must be positive"),
        ({"objective": Share("error", most=0.1, least=0.5)}, "least is 0.5, and must be below"),
        ({"objective": Share("error", most=1.0), "of": Bowl(fails_above=-9.0)}, "all 4,000 held"),
        (
            {"limits": Limit("torque", most=1.0)},
            "a list of somersault.designs.Limit",
        ),
        ({"limits": [Limit("torque")]}, "limit has no bounds"),
        ({"limits": [Limit("torque", most=1.0, least=2.0)]}, "least is 2, and must be below"),
        ({"limits": [Limit("torque", most=0.0)]}, "must be positive"),
        ({"limits": [Limit("torque", most=1e-9)]}, "keeps to the limits"),
        ({"of": Bowl(fails_above=0.5)}, "say what they count as"),
        ({"of": 3}, "nothing that can be run"),
        ({"of": []}, "nothing is run"),
        ({"of": lambda y: Bowl(), "choose": {"x": Choose(between=(0.0, 1.0))}}, "missing"),
        ({"of": lambda: Bowl(), "choose": {"x": Choose(between=(0.0, 1.0))}}, "called with .*x"),
        ({"evaluations": 1}, "evaluations"),
        ({"width": 0.0}, "width"),
        ({"seed": -1}, "seed"),
    ],
)
def test_a_mistake_gets_a_sentence(change: dict[str, Any], said: str) -> None:
    with pytest.raises(SomersaultError, match=said):
        found(**{"evaluations": 30, **change})


def test_a_scatter_of_nothing_is_refused() -> None:
    with pytest.raises(SomersaultError, match="nothing is scattered"):
        so.design(Bowl(), BOTH, {}, ERROR)
    with pytest.raises(SomersaultError, match="rename it"):
        so.design(Bowl(), BOTH, {"candidate": SCATTER["off"]}, ERROR)
    grid = {"off": so.Vary(sets="start", values=[-1.0, 0.0, 1.0])}
    with pytest.raises(SomersaultError, match="a grid of values has no other starts"):
        so.design(Bowl(), BOTH, grid, ERROR)


@pytest.mark.parametrize("name", ["ended", "figure", "sample", "", "x y"])
def test_a_name_that_maps_and_rankings_could_not_use_is_refused_at_once(name: str) -> None:
    with pytest.raises(SomersaultError, match=f"choose.{name!r} is no name|choose.{name}: that"):
        found({name: BOTH["x"]}, evaluations=20)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"size": 1}, "size must be a whole number from 2"),
        ({"vary": {}}, "nothing is scattered"),
        ({"vary": {"q": so.Vary(adds_to="x", values=[0.0, 1.0])}}, "a grid of values"),
        ({"vary": {"q": so.Vary(sets="x", normal=[0.0, 1.0])}}, "a number that the design chooses"),
        ({"vary": {"q": 3}}, "vary.q must be"),
        ({"seed": -1}, "seed"),
        ({"sequence": "odd"}, "sequence"),
        ({"simulation": 3}, "nothing that can be run"),
        ({"simulation": []}, "nothing is run"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_other_starts_that_are_none_are_refused(change: dict[str, Any], said: str) -> None:
    design = found(evaluations=12, held_out=8)
    with pytest.raises(SomersaultError, match=said):
        design.on(**change)
