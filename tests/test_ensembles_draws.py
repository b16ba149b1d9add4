"""What is drawn: the right distributions, each place its own draw, each quantity its own stream."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from SALib.sample import sobol as salib_sobol
from scipy import stats

import somersault as so
from somersault.ensembles._vary import SEQUENCES, draws

ANY = "takeoff.tilt"
FOUR = {name: so.Vary(sets=ANY, uniform=[0.0, 1.0]) for name in ("a", "b", "c", "d")}
DISTRIBUTIONS = {
    "uniform": ([-1.0, 3.0], stats.uniform(-1.0, 4.0)),
    "normal": ([2.0, 0.5], stats.norm(2.0, 0.5)),
    "truncated_normal": ([1.0, 2.0, 0.0, 2.5], stats.truncnorm(-0.5, 0.75, 1.0, 2.0)),
    "triangular": ([-1.0, 0.5, 2.0], stats.triang(0.5, -1.0, 3.0)),
    "lognormal": ([3.0, 0.4], stats.lognorm(0.4, scale=3.0)),
}
U = np.concatenate([[1e-9, 1e-4], np.linspace(0.01, 0.99, 99), [1 - 1e-4, 1 - 1e-9]])


@pytest.mark.parametrize("name", DISTRIBUTIONS)
def test_quantile_functions(name: str) -> None:
    numbers, wanted = DISTRIBUTIONS[name]
    vary = so.Vary(sets=ANY, **{name: numbers})
    np.testing.assert_allclose(vary.quantile(U), wanted.ppf(U), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("numbers", [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0]])
def test_a_triangle_with_its_peak_at_an_end(numbers: list[float]) -> None:
    low, peak, high = numbers
    wanted = stats.triang((peak - low) / (high - low), low, high - low)
    found = so.Vary(sets=ANY, triangular=numbers).quantile(U)
    np.testing.assert_allclose(found, wanted.ppf(U), atol=1e-12)


@pytest.mark.parametrize("name", DISTRIBUTIONS)
@pytest.mark.parametrize("sequence", ["random", "sobol", "halton"])
def test_draws_are_of_their_distribution(name: str, sequence: str) -> None:
    numbers, wanted = DISTRIBUTIONS[name]
    vary = {"first": FOUR["a"], "x": so.Vary(sets=ANY, **{name: numbers})}
    found = draws(vary, sequence, 5, np.arange(1 << 14))
    assert stats.kstest(found["x"], wanted.cdf).pvalue > 1e-4
    np.testing.assert_allclose(found["x"].mean(), wanted.mean(), atol=0.03)
    np.testing.assert_allclose(found["x"].std(), wanted.std(), atol=0.03)
    assert abs(np.corrcoef(found["x"], found["first"])[0, 1]) < 0.03


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(SEQUENCES), st.integers(0, 5000), st.integers(1, 300), st.integers(0, 2**62))
def test_a_place_has_its_own_draw(sequence: str, first: int, count: int, seed: int) -> None:
    whole = draws(FOUR, sequence, seed, np.arange(first + count))
    part = draws(FOUR, sequence, seed, np.arange(first, first + count))
    scattered = draws(FOUR, sequence, seed, np.arange(first % 7, first + count, 7))
    for name in FOUR:
        np.testing.assert_array_equal(part[name], whole[name][first:])
        np.testing.assert_array_equal(scattered[name], whole[name][first % 7 :: 7])


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_far_along_and_by_the_seed(sequence: str) -> None:
    """A chunk far along is drawn without all that come before it."""
    far = draws(FOUR, sequence, 1, np.arange(10**8, 10**8 + 5))
    assert np.all((far["a"] > 0) & (far["a"] < 1))
    other = draws(FOUR, sequence, 2, np.arange(10**8, 10**8 + 5))
    assert not np.any(far["a"] == other["a"])


def test_a_random_quantity_keeps_its_stream_as_others_come_and_go() -> None:
    places = np.arange(100)
    whole = draws(FOUR, "random", 3, places)
    for names in (["c"], ["d", "c"], ["a", "c", "new"]):
        some = {n: FOUR.get(n, FOUR["a"]) for n in names}
        np.testing.assert_array_equal(draws(some, "random", 3, places)["c"], whole["c"])
    assert not np.any(whole["a"] == whole["b"])


def test_a_sobol_sequence_fills_its_cube_evenly() -> None:
    """Every one of 64 slices of every quantity has the same number of the first 2^k points."""
    found = draws(FOUR, "sobol", 9, np.arange(1 << 10))
    for x in found.values():
        np.testing.assert_array_equal(np.histogram(x, 64, (0, 1))[0], 16)


def test_the_saltelli_design_is_the_one_that_salib_reads() -> None:
    """Groups of A, A with one coordinate of B after another, B."""
    found = np.stack(list(draws(FOUR, "saltelli", 4, np.arange(6 * 128)).values()), 1)
    groups = found.reshape(128, 6, 4)
    a, b = groups[:, 0], groups[:, -1]
    assert not np.any(a == b)
    for k in range(4):
        mixed = a.copy()
        mixed[:, k] = b[:, k]
        np.testing.assert_array_equal(groups[:, 1 + k], mixed)
    problem = {"num_vars": 4, "names": list("abcd"), "bounds": [[0.0, 1.0]] * 4}
    theirs = salib_sobol.sample(problem, 4, calc_second_order=False).reshape(4, 6, 4)
    for k in range(4):  # their order is ours
        np.testing.assert_array_equal(theirs[:, 1 + k, k], theirs[:, -1, k])
    for x in (a, b):
        for k in range(4):
            np.testing.assert_array_equal(np.histogram(x[:, k], 16, (0, 1))[0], 8)


def test_what_is_listed_is_taken_as_it_is() -> None:
    listed = so.Vary(sets=ANY, samples=[3.0, 1.0, 2.0, 1.0])
    found = draws({"x": listed, **FOUR}, "random", 0, np.array([1, 2, 3]))
    np.testing.assert_array_equal(found["x"], [1.0, 2.0, 1.0])


def test_a_draw_too_large_for_a_number_is_infinite_without_a_warning() -> None:
    vary = so.Vary(sets=ANY, lognormal=[1.0, 2000.0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert vary.quantile(np.array([0.01, 0.99])).tolist() == [0.0, np.inf]
