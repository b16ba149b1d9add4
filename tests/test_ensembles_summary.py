"""Shares, quantiles, rankings and pictures of ensembles, against others' numbers."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.stats import binomtest

import somersault as so
from somersault.cli import main
from somersault.ensembles import (
    _selection,
    _sensitivity,
    _summary,
    failed,
    fraction,
    quantiles,
    sensitivity,
    summary,
    within,
)
from somersault.ensembles._vary import draws
from somersault.flight import ENDINGS

LOST, NOT_YET = ENDINGS.code("not finite"), 255
MEANT = {
    "flag_meanings": "duration event too_many_steps not_finite no_takeoff",
    "failures": "too_many_steps not_finite no_takeoff",
}


def dataset(values: np.ndarray, ended: np.ndarray, dims: tuple[str, ...]) -> xr.Dataset:
    return xr.Dataset(
        {
            "tilt": (dims, values, {"units": "rad"}),
            "landing_error": (dims, np.abs(values), {"units": "rad"}),
            "ended": (dims, ended.astype("u1"), MEANT),
        }
    )


@pytest.mark.parametrize(("hits", "count"), [(0, 12), (12, 12), (5, 12), (1, 1), (0, 1), (99, 999)])
@pytest.mark.parametrize("confidence", [0.95, 0.5])
def test_shares_have_the_exact_binomial_interval(hits: int, count: int, confidence: float) -> None:
    good = xr.DataArray(np.arange(count) < hits, dims="sample")
    found = fraction(good, confidence=confidence)
    wanted = binomtest(hits, count).proportion_ci(confidence, "exact")
    assert float(found.fraction) == pytest.approx(hits / count)
    assert float(found.low) == pytest.approx(wanted.low, abs=1e-12)
    assert float(found.high) == pytest.approx(wanted.high, abs=1e-12)
    assert int(found.flights) == count


def test_shares_count_what_failed_and_leave_out_what_is_not_flown() -> None:
    good = xr.DataArray([[True] * 6, [True] * 6], dims=("K", "sample"))
    ended = xr.DataArray(
        np.array([[0, 1, LOST, 4, 2, NOT_YET], [NOT_YET] * 6], "u1"), dims=("K", "sample"),
        attrs=MEANT,
    )  # fmt: skip
    np.testing.assert_array_equal(failed(ended)[0], [False, False, True, True, True, False])
    found = fraction(good, ended)
    np.testing.assert_array_equal(found.flights, [5, 0])
    assert float(found.fraction[0]) == pytest.approx(2 / 5)
    assert np.isnan(found.to_array()[:3, 1]).all()
    whole = fraction(good, ended, over=["K", "sample"])
    assert float(whole.fraction) == pytest.approx(2 / 5)
    with pytest.raises(so.SomersaultError, match="confidence"):
        fraction(good, ended, confidence=1.0)
    with pytest.raises(so.SomersaultError, match="K, sample"):
        fraction(good, ended, over="twist")


def test_landings_within_a_tolerance() -> None:
    data = dataset(np.array([0.1, -0.2, 0.3, np.nan]), np.array([0, 0, 0, LOST]), ("sample",))
    np.testing.assert_array_equal(within(data, 0.2), [True, True, False, False])
    assert float(so.Ensemble(data).fraction(tolerance=0.2).fraction) == 0.5
    for bad in (None, 0.0, -1.0, np.nan):
        with pytest.raises(so.SomersaultError, match="tolerance"):
            within(data, bad)


def test_quantiles_of_what_did_not_fail() -> None:
    rng = np.random.default_rng(1)
    values, ended = rng.normal(size=(3, 101)), np.zeros((3, 101))
    ended[1, :7], ended[2, :] = LOST, LOST
    values[ended == LOST] = np.nan
    data = dataset(values, ended, ("K", "sample"))
    with warnings.catch_warnings():  # numpy's, of a slice without numbers
        warnings.simplefilter("ignore")
        found = quantiles(data, "tilt", [0.0, 0.1, 0.5, 1.0])
    for k in range(2):
        flown = values[k][~np.isnan(values[k])]
        np.testing.assert_allclose(found.tilt[:, k], np.quantile(flown, [0, 0.1, 0.5, 1]))
        assert float(found["mean"][k]) == pytest.approx(flown.mean())
        assert float(found.deviation[k]) == pytest.approx(flown.std(ddof=1))
    assert np.isnan(found.tilt[:, 2]).all()
    np.testing.assert_array_equal(found.flights, [101, 94, 0])
    np.testing.assert_array_equal(found.failed, [0, 7, 101])
    with pytest.raises(so.SomersaultError, match="twist"):
        quantiles(data, "twist")
    with pytest.raises(so.SomersaultError, match="0 to 1"):
        quantiles(data, "tilt", [1.2])


def test_the_whole_in_a_few_numbers() -> None:
    values = np.concatenate([np.linspace(0, 1, 101), [np.nan] * 4])
    data = dataset(values, np.array([0] * 100 + [1] + [LOST] * 4), ("sample",))
    found = summary(data, 0.25)
    assert found["flights"] == 105
    assert found["ended"] == {"duration": 100, "event": 1, "not finite": 4}
    assert found["reported"]["tilt"] == {
        "5%": pytest.approx(0.05), "median": 0.5, "95%": pytest.approx(0.95), "unit": "rad",
    }  # fmt: skip
    assert found["within_tolerance"]["fraction"] == pytest.approx(26 / 105)


# ------------------------------------------------------------------------- rankings

NAMES = ("x1", "x2", "x3")
A, B = 7.0, 0.1
VARIANCE = A**2 / 8 + B * np.pi**4 / 5 + B**2 * np.pi**8 / 18 + 0.5
FIRST = {"x1": 0.5 * (1 + B * np.pi**4 / 5) ** 2 / VARIANCE, "x2": A**2 / 8 / VARIANCE, "x3": 0.0}
TOTAL = {"x2": FIRST["x2"], "x3": 8 * B**2 * np.pi**8 / 225 / VARIANCE}
TOTAL["x1"] = FIRST["x1"] + TOTAL["x3"]


def ishigami(sequence: str, size: int) -> xr.Dataset:
    """A function whose indices are known (Ishigami and Homma 1990), over one grid of two."""
    vary = {n: so.Vary(sets="takeoff.tilt", uniform=[-np.pi, np.pi]) for n in NAMES}
    x = draws(vary, sequence, 3, np.arange(size))
    y = np.sin(x["x1"]) + A * np.sin(x["x2"]) ** 2 + B * x["x3"] ** 4 * np.sin(x["x1"])
    drawn = {n: {"uniform": [-np.pi, np.pi]} for n in NAMES}
    specification = {
        "vary": {"K": {"values": [1.0, 2.0]}, **drawn}, "sample": {"sequence": sequence},
    }  # fmt: skip
    return xr.Dataset(
        {"y": (("K", "sample"), np.stack([y, 10 - 3 * y])), "n": ("K", np.zeros(2))},
        {"K": [1.0, 2.0], **{n: ("sample", v) for n, v in x.items()}},
        {"specification": json.dumps(specification)},
    )


def test_sobol_indices_of_a_known_function() -> None:
    found = sensitivity(ishigami("saltelli", 5 * 4096), "y")
    assert found.input.values.tolist() == ["x1", "x2", "x3"]
    for k in range(2):
        for name in NAMES:
            one = found.sel(input=name).isel(K=k)
            assert float(one.first_order) == pytest.approx(FIRST[name], abs=0.03)
            assert float(one.total) == pytest.approx(TOTAL[name], abs=0.03)
            assert abs(float(one.first_order) - FIRST[name]) < 2 * float(one.first_order_confidence)


@pytest.mark.parametrize("sequence", ["random", "sobol", "halton"])
def test_first_order_indices_from_any_draws(sequence: str) -> None:
    found = sensitivity(ishigami(sequence, 4096), "y")
    assert found.input.values.tolist() == ["x2", "x1", "x3"]
    assert "total" not in found
    assert found.first_order.attrs == {"units": "1", "long_name": "first-order Sobol' index"}
    for name in NAMES:
        np.testing.assert_allclose(found.first_order.sel(input=name), FIRST[name], atol=0.06)


def test_a_failed_flight_goes_with_its_group() -> None:
    data = ishigami("saltelli", 5 * 1024)
    lost = data.y.values.copy()
    lost[0, [3, 77, 4000]] = np.nan
    groups = np.ones(1024, bool)
    groups[[0, 15, 800]] = False
    kept = data.isel(sample=np.repeat(groups, 5))
    found = sensitivity(data.assign(y=(data.y.dims, lost)), "y")
    wanted = sensitivity(kept, "y")
    for name in ("first_order", "total"):
        np.testing.assert_array_equal(
            found[name].isel(K=0).sortby("input"), wanted[name].isel(K=0).sortby("input")
        )


def test_what_cannot_be_ranked() -> None:
    data = ishigami("random", 63)
    with pytest.raises(so.SomersaultError, match=r"sample\.size"):
        sensitivity(data, "y")
    with pytest.raises(so.SomersaultError, match="no 'z'"):
        sensitivity(data, "z")
    with pytest.raises(so.SomersaultError, match="no single value"):
        sensitivity(data, "n")
    flat = ishigami("random", 100)
    flat["y"] = flat.y * 0
    assert np.isnan(sensitivity(flat, "y").first_order).all()


# ------------------------------------------------------------------------- pictures


def test_pictures_over_two_grids_one_and_none() -> None:
    rng = np.random.default_rng(2)
    made = {}
    for dims in (("K", "arm", "sample"), ("K", "sample"), ("K", "arm"), ("K",), ("sample",)):
        shape = tuple({"K": 5, "arm": 4, "sample": 30}[d] for d in dims)
        data = dataset(rng.normal(size=shape), np.zeros(shape), dims)
        data = data.assign_coords(K=np.linspace(0, 1, 5), arm=np.linspace(1, 2, 4))
        made[dims] = so.Ensemble(data).plot("tilt")
    for dims in made:
        ax = made[dims].axes[0]
        labels = (ax.get_xlabel(), ax.get_ylabel())
        if dims[:2] == ("K", "arm"):
            assert labels == ("K", "arm")
            assert made[dims].axes[1].get_ylabel().startswith("tilt (rad)")
            image = ax.collections[0].get_array()
            assert image.shape == (4, 5)
        elif dims[0] == "K":
            assert labels == ("K", "tilt (rad)")
            assert len(ax.lines[0].get_xdata()) == 5
        else:
            assert labels == ("tilt (rad)", "flights")
            assert sum(p.get_height() for p in ax.patches) == 30
    wide = dataset(np.zeros((2, 2, 2)), np.zeros((2, 2, 2)), ("a", "b", "c"))
    with pytest.raises(so.SomersaultError, match="draw a part"):
        so.Ensemble(wide).plot("tilt")
    lost = dataset(np.full(3, np.nan), np.full(3, LOST), ("sample",))
    with pytest.raises(so.SomersaultError, match="all failed"):
        so.Ensemble(lost).plot()


def rough(rng: np.random.Generator, size: int) -> dict[str, np.ndarray]:
    """Numbers that are hard to tell apart, or far apart, or all alike."""
    wide = rng.normal(size=size) * 10.0 ** rng.integers(-300, 300, size)
    near = 1.0 + rng.integers(0, 5, size) * np.spacing(1.0)
    holes = np.where(rng.random(size) < 0.3, np.nan, rng.normal(size=size))
    return {
        "normal": rng.normal(size=size), "wide": wide, "near": near, "holes": holes,
        "zeros": np.where(rng.random(size) < 0.5, 0.0, -0.0), "one": np.full(size, -3.5),
    }  # fmt: skip


@pytest.mark.parametrize("few", [2, 100, 2**20])  # numbers that are sorted at once
@pytest.mark.parametrize("size", [1, 2, 7, 5000])
def test_quantiles_read_in_blocks_are_those_of_the_whole(
    few: int, size: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_selection, "_FEW", few)
    levels = [0.0, 0.05, 0.5, 0.77, 0.95, 1.0]
    for name, values in rough(np.random.default_rng(size), size).items():
        kept = values[~np.isnan(values)]
        if not kept.size:
            continue
        found = _selection.quantiles(lambda: np.array_split(values, 3), levels)  # noqa: B023
        np.testing.assert_array_equal(found, np.quantile(kept, levels), err_msg=name)
    assert np.isnan(_selection.quantiles(lambda: [np.full(3, np.nan)], levels)).all()


def test_a_summary_holds_no_variable_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(2)
    ended = rng.choice([0, 1, LOST, NOT_YET], (30, 40))
    values = np.where(ended < 2, rng.normal(size=(30, 40)), np.nan)
    data = dataset(values, ended, ("K", "sample"))
    whole = summary(data, 0.5)
    monkeypatch.setattr(_summary, "_BLOCK", 100)
    longest = max(block.size for block in _summary._blocks(data["tilt"]))
    assert longest <= 100
    assert summary(data, 0.5) == whole
    low, middle, high = np.nanquantile(values, [0.05, 0.5, 0.95])
    assert list(whole["reported"]["tilt"].values()) == [low, middle, high, "rad"]
    share = fraction(within(data, 0.5), data["ended"], ["K", "sample"])
    for key in ("fraction", "low", "high"):
        assert whole["within_tolerance"][key] == float(share[key])


@pytest.mark.parametrize(("sequence", "which"), [("saltelli", "total"), ("sobol", "first-order")])
def test_the_command_says_which_indices_it_prints(
    sequence: str, which: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "spec.toml").write_text(
        'model = "furrer"\nduration = 0.2\n[takeoff]\nspin = 8.64\n'
        '[vary.leant]\nadds_to = "takeoff.tilt"\nnormal = [0.0, 0.1]\n'
        '[vary.turned]\nadds_to = "takeoff.twist"\nnormal = [0.0, 0.01]\n'
        f'[sample]\nsize = 256\nsequence = "{sequence}"\n[report]\nquantities = ["tilt"]\n'
    )
    assert main(["ensemble", str(tmp_path / "spec.toml")]) == 0
    assert f"  {which} Sobol' indices of tilt: leant 0." in capsys.readouterr().out
    assert main(["ensemble", str(tmp_path / "spec.toml"), "--json"]) == 0
    assert list(json.loads(capsys.readouterr().out)["sensitivity"]) == [f"tilt ({which})"]


def test_a_quick_ranking_takes_some_of_the_samples(monkeypatch: pytest.MonkeyPatch) -> None:
    data = ishigami("sobol", 16384)
    monkeypatch.setattr(_sensitivity, "_QUICK", 6 * 8192)  # 2 rankings of 3 quantities
    found, used = _sensitivity.quick_sensitivity(data, ["y"])
    assert used == 8192
    assert list(found["y"]) == ["first_order"]
    for name in NAMES:
        np.testing.assert_allclose(found["y"].first_order.sel(input=name), FIRST[name], atol=0.04)
    whole = sensitivity(data, "y")
    assert not np.array_equal(found["y"].first_order, whole.first_order)
    monkeypatch.undo()
    found, used = _sensitivity.quick_sensitivity(data, ["y"])
    assert used == 16384
    np.testing.assert_array_equal(found["y"].first_order, whole.first_order)
    data = ishigami("saltelli", 5 * 1024)
    found, used = _sensitivity.quick_sensitivity(data, ["y"])
    assert used == 5 * 1024
    np.testing.assert_array_equal(found["y"].total, sensitivity(data, "y").total)


def test_of_many_samples_some_are_ranked() -> None:
    data = ishigami("random", 100_000).isel(K=[0])
    data = data.assign({f"y{k}": data.y for k in range(24)})
    _, used = _sensitivity.quick_sensitivity(data, [f"y{k}" for k in range(24)])
    assert used == 2**20 // 72


def test_the_command_says_how_many_samples_it_ranked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "spec.toml").write_text(
        'model = "furrer"\nduration = 0.2\n[takeoff]\nspin = 8.64\n'
        '[vary.leant]\nadds_to = "takeoff.tilt"\nnormal = [0.0, 0.1]\n'
        '[vary.turned]\nadds_to = "takeoff.twist"\nnormal = [0.0, 0.01]\n'
        '[sample]\nsize = 256\n[report]\nquantities = ["tilt"]\n'
    )
    monkeypatch.setattr(_sensitivity, "_QUICK", 400)
    assert main(["ensemble", str(tmp_path / "spec.toml")]) == 0
    assert "indices of tilt (from 200 of 256 samples): leant 0." in capsys.readouterr().out
    assert main(["ensemble", str(tmp_path / "spec.toml"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["ranked_samples"] == 200
