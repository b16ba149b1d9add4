"""Chapter 5's doll beside the human, against hand formulas from Tables 4.1 and 5.1."""

from __future__ import annotations

import numpy as np
import pytest
from reference_a3 import DOLL, DOLL_WEIGHTED, FURRER, Athlete, matrices, springs

from somersault.thesis import Result
from somersault.thesis.ch5 import _doll as doll
from somersault.thesis.ch5 import _doll_and_human as compared
from somersault.thesis.ch5 import _doll_parameters as table
from somersault.thesis.ch5 import _doll_springs as springs_of_doll

FAIL = {
    "table5-1.rl3-weighted",
    "table5-1.scaled",
    "fig5-2.k1",
    "fig5-2.k1-bare",
    "fig5-5.high",
}


@pytest.fixture(scope="module")
def results() -> dict[str, Result]:
    made = (table.table_5_1, compared.fig_5_2, compared.fig_5_3, springs_of_doll.fig_5_5)
    return {make.__name__: make() for make in made}


def inertias(a: Athlete, angle: float) -> np.ndarray:
    """I1, I2, I3 of the whole body by the parallel axis theorem, term by term."""
    c, s = np.cos(angle), np.sin(angle)
    y, z = a.rb2 + a.rl3 * s, a.rb3 - a.rl3 * c  # an arm's centre from the body's
    total = a.mb + 2 * a.ml
    up = 2 * a.ml * z / total  # the whole's centre above the body's
    arms = np.array([y**2 + (z - up) ** 2, (z - up) ** 2, y**2]) * 2 * a.ml
    turned = 2 * np.array(
        [a.Il[0], a.Il[1] * c**2 + a.Il[2] * s**2, a.Il[1] * s**2 + a.Il[2] * c**2]
    )
    return np.array(a.Ib) + np.array([1, 1, 0]) * a.mb * up**2 + arms + turned


@pytest.mark.parametrize("angle", [0.0, 0.7, 1.3, 1.57, 3.0])
@pytest.mark.parametrize(
    ("name", "athlete"), [("furrer", FURRER), ("doll", DOLL), ("doll_weighted", DOLL_WEIGHTED)]
)
def test_compared_numbers_follow_from_the_tables(name: str, athlete: Athlete, angle: float) -> None:
    i1, i2, i3 = inertias(athlete, angle)
    k1, k3 = doll.ratios(name, np.array(angle))
    assert (k1, k3) == pytest.approx(((i2 - i3) / i1, (i2 - i1) / i3), rel=1e-9)
    relative = float(doll.relative_inertia(name, np.array(angle)))
    assert relative == pytest.approx(2 * athlete.shoulder_inertia / i1, rel=1e-9)


def test_shoulder_inertias_by_hand() -> None:
    assert doll.shoulder_inertia("doll") == pytest.approx(5.59e-5 + 0.0275 * 0.0832**2)
    assert doll.shoulder_inertia("doll_weighted") == pytest.approx(3.0136e-4, abs=5e-9)
    assert doll.shoulder_inertia(doll.as_printed()) == pytest.approx(2.67e-4, abs=5e-7)


def test_weighted_arm_is_the_bare_arm_and_the_weight() -> None:
    """About the shoulder a point mass adds m r², whatever the arm's centre of mass."""
    centre, inertia = doll.composed_arm()
    assert centre == pytest.approx(0.0622, abs=5e-5)
    about = inertia + 0.0575 * centre**2
    assert about == pytest.approx(5.59e-5 + 0.0275 * 0.0832**2 + 0.03 * 0.043**2, rel=1e-12)


def test_printed_doll_differs_in_nothing_but_rl3() -> None:
    ours, printed = doll.parameters("doll_weighted"), doll.parameters(doll.as_printed())
    assert {name for name in ours if ours[name] != printed[name]} == {"rl3"}
    assert printed["rl3"] == 0.0572


def printed_growth(a: Athlete, angle: float, stiffness: float) -> float:
    """Largest growth rate of the printed five-d.o.f. equations, nothing removed."""
    m, g, k = matrices(a, angle)
    n = len(m)
    sprung = k + springs(a, stiffness)
    inverse = np.linalg.inv(m)
    first = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ sprung, -inverse @ g]])
    return float(np.linalg.eigvals(first).real.max())


@pytest.mark.parametrize(
    ("model", "rl3", "low", "high"),
    [("doll_weighted", 0.0622, 0.6285, 1.5151), ("as printed", 0.0572, 0.6449, 1.4467)],
)
def test_stable_springs_are_those_of_the_printed_equations(
    model: str, rl3: float, low: float, high: float
) -> None:
    athlete = Athlete(
        DOLL_WEIGHTED.mb, DOLL_WEIGHTED.ml, DOLL_WEIGHTED.Ib, DOLL_WEIGHTED.Il, 0.0413, 0.0664, rl3
    )
    ((ours_low, ours_high),) = doll.springs(doll.as_printed() if rl3 == 0.0572 else model)
    assert (ours_low, ours_high) == pytest.approx((low, high), abs=1e-4)
    for inside in (ours_low + 2e-3, 0.82, ours_high - 2e-3):
        assert printed_growth(athlete, 1.57, inside) < 1e-5
    for outside in (ours_low - 2e-3, ours_high + 2e-3):
        assert printed_growth(athlete, 1.57, outside) > 1e-3


def test_one_range_of_springs_an_angle() -> None:
    """What `edges` takes for granted, and its edges are those of a search at one angle."""
    for model in ("doll_weighted", doll.as_printed(), "furrer"):
        changes = np.abs(np.diff(doll.region(model).astype(int), axis=0)).sum(0)
        assert set(changes) <= {0, 2}
    low, high = doll.edges("doll_weighted")
    place = int(np.argmin(np.abs(doll.ANGLES - 1.2)))
    ((least, most),) = doll.springs("doll_weighted", float(doll.ANGLES[place]))
    assert (low[place], high[place]) == pytest.approx((least, most), abs=1e-7)


def test_smaller_arms_change_i_rel_alone() -> None:
    small = doll.with_smaller_arms("doll_weighted", 0.0573)
    at = np.array(doll.STRAIGHT)
    assert doll.relative_inertia(small, at) == pytest.approx(0.0573)
    for ours, theirs in zip(doll.ratios(small, at), doll.ratios("doll_weighted", at), strict=True):
        assert ours == pytest.approx(theirs)
    assert sum(b.mass for b in small.bodies) == pytest.approx(0.581)
    same = doll.with_smaller_arms(
        "doll_weighted", float(doll.relative_inertia("doll_weighted", at))
    )
    assert doll.springs(same)[0] == pytest.approx(doll.springs("doll_weighted")[0], abs=1e-6)


def test_claims_have_ids_of_their_own_and_say_why_they_fail(results: dict[str, Result]) -> None:
    claims = [claim for result in results.values() for claim in result.claims]
    assert len({claim.id for claim in claims}) == len(claims) > 45
    assert {claim.id for claim in claims if not claim.holds} == FAIL
    assert all(claim.note for claim in claims if not claim.holds)


def test_pictures_and_tables_are_there(results: dict[str, Result]) -> None:
    assert all(results[name].figure is not None for name in ("fig_5_2", "fig_5_3", "fig_5_5"))
    table = results["fig_5_5"].table
    assert table is not None
    assert [row[1] for row in table.rows][2:] == ["0.0003014", "0.000267"]


def test_a_moved_measurement_flips_its_claims(monkeypatch: pytest.MonkeyPatch) -> None:
    (low, high), *_ = doll.springs("doll_weighted")
    human = doll.springs("furrer")
    monkeypatch.setattr(springs_of_doll, "BEST", 1.3)  # in the doll's range, not in the human's
    holds = {claim.id: claim.holds for claim in springs_of_doll._range_claims(low, high, human)}
    assert holds["fig5-5.best"]
    assert not holds["fig5-5.best-human"]
