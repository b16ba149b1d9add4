"""The last step of least squares: the errors are those of the landings, and it gets lower."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from test_designs import BOTH, SCATTER, Bowl

import somersault as so
from somersault import SomersaultError
from somersault.designs import Choose, Mean

ERROR = Mean("landing_error", counts_as=1.0)
TWIST = so.arm_tilt()
CHOOSE = {
    "ω": Choose(between=(0.5, 2.0), multiplies={"joints.*shoulder*.stiffness": 2}, scale="log"),
    "ζ": Choose(between=(0.3, 3.0), multiplies={"joints.*shoulder*.damping": 1}, scale="log"),
}
OFF = {"off": so.Vary(adds_to="takeoff.tilt", uniform=[-0.05, 0.05])}


def runs(**options: Any) -> Any:
    soft = TWIST.compliant(20.0, pose="wrap")
    return so.flight.flights(soft, report=["landing_error"], against=TWIST.fly(), **options)


def found(of: Any = None, **options: Any) -> Any:
    given = {"size": 8, "seed": 1, "evaluations": 12, "population": 6, "held_out": 64, **options}
    return so.design(runs() if of is None else of, CHOOSE, OFF, ERROR, **given)


def test_the_parts_of_a_landing_error_make_the_error() -> None:
    flights, parts = runs().apart()
    vary = {"off": so.Vary(adds_to="takeoff.tilt", values=[-0.05, 0.02])}
    apart = so.ensemble(flights, vary=vary).dataset
    whole = so.ensemble(runs(), vary=vary).dataset["landing_error"]
    squares = sum((w * (apart[name] - a)) ** 2 for name, (a, w) in parts.items())
    np.testing.assert_allclose(np.sqrt(squares), whole, rtol=1e-12)
    with pytest.raises(SomersaultError, match="no angles to land at"):
        so.flight.flights(TWIST).apart()


@pytest.mark.slow
def test_it_comes_to_where_the_mean_square_is_least() -> None:
    rough, fine = found(), found(polish=True)
    assert [parts.tobytes() for parts, _ in rough.generations] == [
        parts.tobytes() for parts, _ in fine.generations
    ]

    def cost(design: Any) -> float:
        return float(design.trial.outcome(design.table[1:]).costs[0])

    assert cost(fine) < cost(rough)
    assert fine.figure < rough.figure
    assert fine.table.tobytes() == found(polish=True).table.tobytes()

    def mean_square(parts: np.ndarray) -> np.ndarray:
        rows = fine.trial.run(fine.trial.table(parts))
        return (rows["landing_error"] ** 2).mean(1)

    assert rough.polished is None
    assert fine.polished == pytest.approx(cost(fine))
    drawn = [text.get_text() for text in fine.plot(steps=2).axes[0].texts]
    assert drawn == ["polished"]
    assert not rough.plot(steps=2).axes[0].texts
    near = np.clip(fine.parts + 0.02 * np.random.default_rng(0).normal(size=(24, 2)), 0, 1)
    assert mean_square(fine.parts[None])[0] < mean_square(near).min() * 1.01


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"objective": so.designs.Quantile("landing_error", counts_as=1.0)}, "only the mean"),
        ({"objective": Mean("time", counts_as=1.0)}, "only the mean"),
        ({"what": lambda: runs()}, "made by a function"),
        ({"what": Bowl(), "choose": BOTH, "vary": SCATTER, "objective": Mean("error")}, "only the"),
        ({"polish": 2}, "polish"),
    ],
)
def test_what_cannot_be_polished_is_refused(change: dict[str, Any], said: str) -> None:
    given = {"what": runs(), "choose": CHOOSE, "vary": OFF, "objective": ERROR, "polish": True}
    with pytest.raises(SomersaultError, match=said):
        so.design(**{**given, **change})
