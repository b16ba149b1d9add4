"""The generator of noise, against its published arithmetic in whole numbers, and its normals."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from scipy import stats

from somersault.engine import Kernel
from somersault.laws import Noise, seeds

M1, M2 = 4294967087, 4294944443


def published(state: list[int], count: int) -> list[float]:
    """MRG32k3a in Python's integers (L'Ecuyer 1999, figure I)."""
    state, result = list(state), []
    for _ in range(count):
        first = (1403580 * state[1] - 810728 * state[0]) % M1
        second = (527612 * state[5] - 1370589 * state[3]) % M2
        state = [state[1], state[2], first, state[4], state[5], second]
        apart = first - second
        result.append((apart + M1 if apart <= 0 else apart) / (M1 + 1))
    return result


def test_published_numbers() -> None:
    """The first ones from the seed 12345, as the generator's users know them."""
    assert published([12345] * 6, 3) == pytest.approx([0.127011, 0.318528, 0.309186], abs=1e-6)


def drawn(states: np.ndarray, count: int) -> np.ndarray:
    symbols = [ca.SX.sym(f"s{k}") for k in range(6)]
    noise = Noise(symbols)
    normals = [noise.normal() for _ in range(count)]
    function = ca.Function("f", [ca.vertcat(*symbols)], [ca.vertcat(*normals, *noise.state)])
    return np.asarray(Kernel(function)(states))


def test_normals_are_those_of_the_published_numbers() -> None:
    states = seeds(np.linspace(0.0, 1.0, 1000))
    found = drawn(states, 4)
    for row, state in zip(found, states, strict=True):
        u = published([int(x) for x in state], 4)
        for k in range(2):
            radius, angle = np.sqrt(-2 * np.log(u[2 * k])), 2 * np.pi * u[2 * k + 1]
            expected = radius * np.array([np.cos(angle), np.sin(angle)])
            np.testing.assert_allclose(row[2 * k : 2 * k + 2], expected, rtol=1e-13, atol=1e-13)


def test_normals_are_normal_and_independent() -> None:
    found = drawn(seeds(np.arange(20_000.0)), 4)[:, :4]
    assert stats.kstest(found.ravel(), "norm").pvalue > 0.01
    apart = np.corrcoef(found.T) - np.eye(4)
    assert np.abs(apart).max() < 4 / np.sqrt(20_000)


def test_the_logarithm() -> None:
    x = ca.SX.sym("x")
    numbers = np.concatenate([np.geomspace(1e-300, 1e300, 4001), 1 + np.linspace(-1e-3, 1e-3, 101)])
    found = Kernel(ca.Function("f", [x], [ca.log(x)]))(numbers[:, None])[:, 0]
    np.testing.assert_allclose(found, np.log(numbers), rtol=4e-16, atol=1e-17)
    assert np.all(np.isnan(Kernel(ca.Function("f", [x], [ca.log(x)]))(np.array([[-1.0], [0.0]]))))
