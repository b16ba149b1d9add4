"""Designs whose candidates a function makes, and designs over several cases."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import pytest
from test_designs import BOTH, TWISTED, Bowl, found

import somersault as so
from somersault import SomersaultError
from somersault.designs import Choose, Limit, Mean
from somersault.simulation import ENDED, Numbers, Variable


@dataclass(frozen=True)
class Moved(Bowl):
    """The bowl with its bottom `by` further to the right."""

    by: float = 0.0

    @property
    def specification(self) -> Mapping[str, Any]:
        return {**super().specification, "by": self.by}

    def run(self, values: Numbers, count: int) -> Mapping[str, np.ndarray]:
        return super().run({**values, ("start",): values["start",] + self.by}, count)


def test_a_function_makes_what_is_run_of_what_is_chosen() -> None:
    """The bottom is where x − 2 − by vanishes, with by given to the function and x set."""
    choose = {"x": BOTH["x"], "by": Choose(between=(-0.5, 0.75))}
    design = found(choose, of=lambda by: Moved(by=by), evaluations=400)
    assert design.best["x"] == pytest.approx(2.0 + design.best["by"], abs=0.02)
    assert design.simulation.simulation == Moved(by=design.best["by"])
    assert design.on(simulation=lambda by: Moved(by=by + 1.0)).figure == pytest.approx(
        0.25 + 1.0, abs=0.05
    )


def test_several_cases_are_judged_as_one() -> None:
    """Bottoms at 1 and 4: the mean square is least in their middle."""
    cases = [Moved(by=-1.0), Moved(by=2.0)]
    design = found({"x": BOTH["x"]}, of=cases)
    assert design.best["x"] == pytest.approx(2.5, abs=0.02)
    assert design.figure == pytest.approx(0.25 + 1.5**2, abs=0.1)
    assert len(design.cases) == 2
    data = design.dataset
    assert data.sizes["start"] == 2 * 4_000
    best = data.sel(candidate="best")
    there = (best["error"] - (design.best["x"] - 2 - best["off"] - [-1, 2][0]) ** 2)[:4_000]
    assert np.abs(there).max() < 1e-12
    made = found({"by": Choose(between=(-3.0, 3.0))}, of=lambda by: [Moved(by=by), Moved(by=-2)])
    assert made.best["by"] == pytest.approx(-1.0, abs=0.02)  # x stays 1


def test_a_candidate_that_cannot_be_made_is_worse_than_any_other() -> None:
    def small(by: float) -> Bowl:
        if by > 0.5:
            raise SomersaultError("too far")
        return Moved(by=by)

    choose = {"by": Choose(between=(-1.0, 3.0), start=0.0)}
    objective = Mean("error", counts_as=100.0)
    with_x = {"x": BOTH["x"], **choose}
    design = found(with_x, objective, of=small, limits=[Limit("torque", most=2.25)])
    assert design.best["by"] <= 0.5
    assert design.best["x"] == pytest.approx(2.0 + design.best["by"], abs=0.02)
    with pytest.raises(SomersaultError, match="too far"):
        found({"by": Choose(between=(1.0, 3.0))}, objective, of=small)


def test_a_limit_of_the_unperturbed_run() -> None:
    """Its error is (x − 2)², which none of the scattered ones has for a mean."""
    choose = {"x": Choose(sets="x", between=(-1.0, 1.9))}
    free = found(choose, Mean("torque"), evaluations=100)
    assert free.best["x"] == pytest.approx(0.0, abs=0.05)
    near = [Limit("error", most=0.25, unperturbed=True)]
    kept = found(choose, Mean("torque"), limits=near)
    assert kept.best["x"] == pytest.approx(1.5, abs=1e-3)
    broken = [Limit("error", most=0.25, unperturbed=True)]
    with pytest.raises(SomersaultError, match="keeps to the limits"):
        found(choose, Mean("torque", counts_as=9.0), of=Bowl(fails_above=-5.0), limits=broken)


def raised(lift: float, time: float) -> so.Maneuver:
    """One arm up and the other down, by so much and in so long."""
    arms = {
        "left_shoulder": [(0.05, 1.4), (0.05 + time, 1.4 + lift)],
        "right_shoulder": [(0.05, -1.4), (0.05 + time, -1.4 + lift)],
    }
    return so.Maneuver.moves("furrer", arms, so.Takeoff(spin=8.64), 0.6)


def test_a_motion_is_chosen_with_the_compliance_about_it() -> None:
    """The tape and the gains are those of each candidate's own motion: unperturbed it flies as
    joints that follow exactly do, and off nominal as the same maneuver made by hand."""

    def made(lift: float, time: float) -> Any:
        soft = raised(lift, time).compliant(20.0, pose={"shoulder": 1.4})
        return so.flight.flights(
            soft.model, soft.takeoff, soft.duration, report=["twist", "left_shoulder"],
            accuracy=1e-10,
        )  # fmt: skip

    choose = {
        "lift": Choose(between=(0.2, 0.8)),
        "time": Choose(between=(0.1, 0.3)),
        "stiffer": Choose(multiplies="joints.shoulder.stiffness", between=(0.5, 2.0), scale="log"),
    }
    design = so.design(
        made, choose, TWISTED, Mean("twist", largest=True, counts_as=0.0), size=4, evaluations=12,
        held_out=4,
    )  # fmt: skip
    lift, time, stiffer = design.best.values()
    nominal = raised(lift, time)
    alone = so.ensemble(design.simulation).dataset.isel(sample=0)
    landing = nominal.fly(accuracy=1e-10).landing
    assert float(alone["twist"]) == pytest.approx(landing.twist, abs=1e-8)
    assert float(alone["left_shoulder"]) == pytest.approx(1.4 + lift, abs=1e-8)
    soft = nominal.compliant(20.0, pose={"shoulder": 1.4})
    joints = {
        name: replace(does, stiffness=stiffer * does.stiffness)
        for name, does in soft.takeoff.joints.items()
    }
    soft = soft.changed(takeoff=replace(soft.takeoff, joints=joints), accuracy=1e-10)
    for k, off in enumerate(design.dataset["twisted"].values):
        flown = soft.off_nominal(twist=float(off)).fly().landing
        assert design.rows["twist"][1, k] == pytest.approx(flown.twist, abs=1e-7)
        assert abs(flown.joints["left_shoulder"] - 1.4 - lift) > 1e-6  # it does give way


def test_a_search_of_made_candidates_goes_on_where_it_stopped(tmp_path: Any) -> None:
    def made(by: float) -> Bowl:
        return Moved(by=by)

    choose = {"x": BOTH["x"], "by": Choose(between=(-0.5, 0.75))}
    limits = [Limit("torque", most=1.2)]  # its weight is what it was at the stop
    whole = found(choose, of=made, limits=limits, out=tmp_path, evaluations=60)
    kept = json.loads((tmp_path / "design.json").read_text())
    for row in kept["generations"]:
        assert len(row["costs"]) == len(row["candidates"])
    kept["generations"] = kept["generations"][:4]
    (tmp_path / "design.json").write_text(json.dumps(kept))
    again = found(choose, of=made, limits=limits, out=tmp_path, evaluations=60)
    assert again.table.tobytes() == whole.table.tobytes()


def test_functions_are_told_apart_by_what_they_make(tmp_path: Any) -> None:
    """All of them make the same where the search begins, and have one name."""

    def functions() -> Any:
        def made(by: float, sign: float = 1.0) -> Bowl:
            return Moved(by=by if by > 0 else sign * by)

        return made

    given: dict[str, Any] = {
        "choose": {"x": BOTH["x"], "by": Choose(between=(-0.5, 0.75))}, "out": tmp_path,
        "evaluations": 12,
    }  # fmt: skip
    first = found(of=functions(), **given)
    for same in (functions(), lambda by: Moved(by=by), partial(functions(), sign=1.0)):
        assert found(of=same, **given).table.tobytes() == first.table.tobytes()

    def edited(by: float) -> Bowl:
        return Moved(by=abs(by))

    def lost(by: float) -> Bowl:
        if by <= 0:
            raise SomersaultError("too little")
        return Moved(by=by)

    for other in (partial(functions(), sign=-1.0), edited, lost):
        other.__qualname__ = functions().__qualname__
        with pytest.raises(SomersaultError, match="holds another design"):
            found(of=other, **given)


def test_a_motion_with_another_tape_is_another_design(tmp_path: Any) -> None:
    """Two motions that begin and end alike, by another way."""

    def made(time: float, late: float = 0.0) -> Any:
        soft = raised(0.5, time + late * (time - 0.2)).compliant(20.0, pose={"shoulder": 1.4})
        return so.flight.flights(soft.model, soft.takeoff, soft.duration, report=["twist"])

    def searched(of: Any) -> Any:
        return so.design(
            of, {"time": Choose(between=(0.1, 0.3))}, TWISTED, Mean("twist", counts_as=3.0),
            size=4, evaluations=4, held_out=4, out=tmp_path,
        )  # fmt: skip

    assert searched(made).table.tobytes() == searched(partial(made)).table.tobytes()
    with pytest.raises(SomersaultError, match="holds another design"):
        searched(partial(made, late=0.1))


@dataclass(frozen=True)
class Torque(Bowl):
    """A bowl that reports its torque alone."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "variables", {"torque": Variable("1")})

    def run(self, values: Numbers, count: int) -> Mapping[str, np.ndarray]:
        rows = super().run(values, count)
        return {name: rows[name] for name in ("torque", ENDED)}


@pytest.mark.parametrize(
    ("other", "said"),
    [
        (Torque(), "error is not reported of a candidate"),
        ([Bowl(), Bowl()], "run as 2 cases, and the first as 1"),
        (None, "None is nothing that can be run"),
    ],
)
def test_a_function_whose_candidates_differ_in_kind_is_refused(other: Any, said: str) -> None:
    with pytest.raises(SomersaultError, match=said):
        found(
            {"by": Choose(between=(-1.0, 1.0))}, of=lambda by: Moved(by=by) if by <= 0 else other,
            evaluations=20,
        )  # fmt: skip


def test_a_function_of_other_cases_judges_the_same_design() -> None:
    made = found({"by": Choose(between=(-1.0, 1.0))}, of=lambda by: Moved(by=by), evaluations=20)
    twice = made.on(simulation=lambda by: [Moved(by=by), Moved(by=by + 1.0)])
    assert twice.dataset.sizes["start"] == 2 * 4_000
    with pytest.raises(SomersaultError, match="error is not reported of these runs"):
        made.on(simulation=lambda by: Torque())
