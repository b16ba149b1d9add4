"""The compiled kernel against CasADi's own evaluation of the same function."""

from __future__ import annotations

import ctypes
import gc

import casadi as ca
import numpy as np
import pytest

from somersault.dynamics import Equations
from somersault.engine import LANES, Kernel, _kernel, compiled, compiled_function, use_threads
from somersault.engine._derivative import derivative
from somersault.engine._expression import expression
from somersault.engine._shared import Shared
from somersault.engine._vectors import module
from somersault.model import load

rng = np.random.default_rng(7)


def both(expression, *symbols, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compiled and interpreted values, one row for each row of `at`."""
    function = ca.Function("f", [ca.vertcat(*symbols)], [ca.densify(expression)])
    interpreted = np.array(function.map(len(at))(at.T)).T
    return Kernel(function)(at), interpreted


def column(values) -> np.ndarray:
    return np.asarray(values, float).reshape(-1, 1)


def near_quarter_turns() -> np.ndarray:
    """The doubles about multiples of π/2 up to 1e5, where the reduction cancels most."""
    k = np.concatenate([np.arange(-300, 301), np.linspace(-63000, 63000, 4001).round()])
    nearest = k * (np.pi / 2)
    above, below = np.nextafter(nearest, np.inf), np.nextafter(nearest, -np.inf)
    return np.concatenate([nearest, above, below, nearest + 1e-9, nearest - 1e-6])


ANGLES = {
    "everyday": np.linspace(-20.0, 20.0, 20001),
    "many turns": np.random.default_rng(0).uniform(-1e5, 1e5, 50000),
    "near quarter turns": near_quarter_turns(),
    "tiny": np.concatenate([[0.0], np.geomspace(1e-300, 1e-3, 500), -np.geomspace(1e-300, 1, 500)]),
}


@pytest.mark.parametrize("where", ANGLES)
def test_sine_and_cosine(where: str) -> None:
    x = ca.SX.sym("x")
    ours, theirs = both(ca.vertcat(ca.sin(x), ca.cos(x)), x, at=column(ANGLES[where]))
    np.testing.assert_allclose(ours, theirs, rtol=1e-13, atol=0)


def test_sine_alone_and_cosine_alone() -> None:
    """Each shares its reduction with the other, and must not need it."""
    x = ca.SX.sym("x")
    at = column(np.linspace(-10, 10, 1001))
    for function in (ca.sin, ca.cos):
        ours, theirs = both(function(x), x, at=at)
        np.testing.assert_allclose(ours, theirs, rtol=1e-13)


def test_square_root() -> None:
    x = ca.SX.sym("x")
    at = column(np.concatenate([[0.0, 1e-300, 1e300], np.random.default_rng(1).uniform(0, 9, 999)]))
    ours, theirs = both(ca.sqrt(x), x, at=at)
    np.testing.assert_array_equal(ours, theirs)


def test_arc_tangent_of_a_length() -> None:
    """y ≥ 0 and x of either sign, steep and flat, on the axes and at the joints of the pieces."""
    y, x = ca.SX.sym("y"), ca.SX.sym("x")
    rng = np.random.default_rng(2)
    angle = np.concatenate([np.linspace(0, np.pi, 4001), np.pi * np.arange(9) / 8])
    size = 10.0 ** rng.uniform(-8, 8, len(angle))
    round_ = np.column_stack([np.abs(size * np.sin(angle)), size * np.cos(angle)])
    special = np.array(
        [[0, 1], [0, -1], [1, 0], [1, 1], [1, -1], [1e-150, 1], [1e-150, -1], [1, 1e-300]]
    )
    ours, theirs = both(ca.atan2(y, x), y, x, at=np.concatenate([round_, special]))
    np.testing.assert_allclose(ours, theirs, rtol=1e-13)


def test_arithmetic() -> None:
    """Every operation of the instruction list, some with a common denominator."""
    x = ca.SX.sym("x", 3)
    a, b, c = ca.vertsplit(x)
    value = ca.vertcat(
        a + b, a - b, a * b, a / c, b / c, 1 / c, -a, a * a, 2 * a, ca.fabs(b), ca.sign(b), 7.5, a
    )
    at = np.random.default_rng(3).normal(size=(500, 3))
    at[0] = 0.0, 0.0, 1.0
    ours, theirs = both(value, x, at=at)
    np.testing.assert_allclose(ours, theirs, rtol=1e-15)


def test_division_by_zero_is_not_a_number_and_no_crash() -> None:
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    at = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 0.0], [1.0, -0.0]])
    with np.errstate(all="raise"):
        ours, _ = both(x / y, x, y, at=at)
    np.testing.assert_array_equal(ours[:, 0], [np.inf, -np.inf, np.nan, -np.inf])


def test_what_is_not_finite_stays_in_its_own_sample() -> None:
    x = ca.SX.sym("x")
    value = ca.vertcat(ca.sin(x), ca.sqrt(x), 1 / x)
    at = column([0.5, np.nan, 2.0, np.inf, 3.0, -1.0, 4.0, 0.0])
    ours, theirs = both(value, x, at=at)
    finite = np.isfinite(at[:, 0]) & (at[:, 0] > 0)
    np.testing.assert_allclose(ours[finite], theirs[finite], rtol=1e-15)
    assert np.isnan(ours[[1, 3], 0]).all()
    assert np.isnan(ours[[1, 5], 1]).all()


@pytest.mark.parametrize("operation", [ca.tan, ca.exp, ca.asin, ca.sinh])
def test_unknown_operations_are_refused(operation) -> None:
    x = ca.SX.sym("x")
    kernel = Kernel(ca.Function("f", [x], [operation(x)]))
    with pytest.raises(NotImplementedError, match="has no vector form"):
        kernel(np.ones((1, 1)))


# ------------------------------------------------------- the same whoever asks, and how many


@pytest.fixture(scope="module")
def furrer() -> Kernel:
    equations = Equations(load("furrer"))
    return equations.kernel(equations.expression("forward_dynamics"))


@pytest.fixture(scope="module")
def samples(furrer: Kernel) -> np.ndarray:
    return np.random.default_rng(4).normal(size=(5000, furrer.inputs)) * 3


@pytest.mark.parametrize("count", [1, 7, 8, 9, 2047, 5000])
def test_bits_do_not_depend_on_the_number_of_samples(
    furrer: Kernel, samples: np.ndarray, count: int
) -> None:
    whole = furrer(samples)
    np.testing.assert_array_equal(furrer(samples[:count]), whole[:count])
    np.testing.assert_array_equal(furrer(samples[-count:]), whole[-count:])


def test_bits_do_not_depend_on_company(furrer: Kernel, samples: np.ndarray) -> None:
    whole = furrer(samples)
    for number in (0, 1, 6, 7, 8, 4999):
        np.testing.assert_array_equal(furrer(samples[number]), whole[number])


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_bits_do_not_depend_on_threads(furrer: Kernel, samples: np.ndarray, threads: int) -> None:
    assert len(samples) / 8 > _kernel._WORTH_A_THREAD
    whole = furrer(samples)
    with use_threads(threads):
        np.testing.assert_array_equal(furrer(samples), whole)


def test_leading_dimensions_are_kept(furrer: Kernel, samples: np.ndarray) -> None:
    shaped = samples[:24].reshape(2, 3, 4, furrer.inputs)
    assert furrer(shaped).shape == (2, 3, 4, furrer.outputs)
    np.testing.assert_array_equal(furrer(shaped).reshape(24, -1), furrer(samples[:24]))
    assert furrer(samples[:0]).shape == (0, furrer.outputs)


@pytest.mark.parametrize("width", range(10))
@pytest.mark.parametrize("count", [1, 7, 8, 9, 17])
def test_rows_of_any_width_come_back(width: int, count: int) -> None:
    """x and y as they are, whose rows are turned into lanes and back in groups of four."""
    x, y = ca.SX.sym("x", width), ca.SX.sym("y", 2)
    kernel = Kernel(ca.Function("f", [x, y], [ca.vertcat(x, y, y[0] * x)]))
    a, b = rng.normal(size=(count, width)), rng.normal(size=(count, 2))
    np.testing.assert_array_equal(kernel(a, b), np.concatenate([a, b, b[:, :1] * a], 1))
    np.testing.assert_array_equal(kernel(a, b[0])[:, width], np.full(count, b[0, 0]))
    np.testing.assert_array_equal(kernel(a[:1], b)[:, :width], np.tile(a[0], (count, 1)))


def difference() -> Kernel:
    x, y = ca.SX.sym("x", 5), ca.SX.sym("y", 5)
    return Kernel(ca.Function("f", [x, y], [x - y]))


def test_leading_dimensions_broadcast() -> None:
    a, b = rng.normal(size=(3, 1, 40, 5)), rng.normal(size=(7, 1, 5))
    np.testing.assert_array_equal(difference()(a, b), a - b)
    np.testing.assert_array_equal(difference()(a[0, 0, 0], b[0, 0]), a[0, 0, 0] - b[0, 0])
    assert difference()(a[:, :, :0], b).shape == (3, 7, 0, 5)
    with pytest.raises(ValueError, match="broadcast"):
        difference()(a[0, 0], b[:, 0])


def test_arguments_may_lie_in_memory_in_any_way() -> None:
    a, b = rng.normal(size=(300, 12)), rng.normal(size=(300, 5))
    packed = np.zeros(300, [("first", "i1"), ("x", "f8", 5)])
    packed["x"] = b
    for x in (a[:, :5], a[:, ::-1][:, :5], a[::-1, 3:8], a[:, ::2][:, :5], np.asfortranarray(b)):
        np.testing.assert_array_equal(difference()(x, b), x - b)
    for y in (packed["x"], b.astype(">f8"), b.astype("f4"), np.rint(b).astype(int), b.tolist()):
        np.testing.assert_array_equal(difference()(a[:, :5], y), a[:, :5] - np.asarray(y, float))


def test_code_lives_as_long_as_its_function() -> None:
    x = ca.SX.sym("x", 2)
    block = Kernel(ca.Function("f", [x], [x[0] - x[1]])).block  # of a kernel that is gone
    gc.collect()
    raw = np.arange(5 * 8.0)
    first = -raw.ctypes.data % 64 // 8
    rows = raw[first : first + 24].reshape(3, 8)
    block(rows[0].ctypes.data, rows[2].ctypes.data)
    np.testing.assert_array_equal(rows[2], rows[0] - rows[1])


def test_all_arguments_side_by_side() -> None:
    a = rng.normal(size=(20, 10))
    np.testing.assert_array_equal(difference()(a), a[:, :5] - a[:, 5:])


@pytest.mark.parametrize("shapes", [[(5,), (4,)], [(9,)], [(5,)], [(5,), (5,), (5,)], [(5,), ()]])
def test_arguments_of_other_widths_are_refused(shapes: list[tuple[int, ...]]) -> None:
    with pytest.raises(ValueError, match=r"arguments of widths \(5, 5\)"):
        difference()(*(np.zeros(shape) for shape in shapes))


def test_arguments_are_left_as_they_were(furrer: Kernel, samples: np.ndarray) -> None:
    before = samples.copy()
    furrer(samples)
    np.testing.assert_array_equal(samples, before)
    turned = np.asfortranarray(samples)
    np.testing.assert_array_equal(furrer(turned), furrer(samples))


def test_forward_dynamics_are_casadis(furrer: Kernel, samples: np.ndarray) -> None:
    separate = np.split(samples[:200], np.cumsum(furrer.widths)[:-1], axis=1)
    theirs = np.array(furrer._function.map(200)(*(part.T for part in separate))).T
    np.testing.assert_allclose(furrer(samples[:200]), theirs, rtol=1e-11, atol=1e-11)


OPERATIONS = {
    "sums and products": lambda a, b, c: (a + b) * c - a * a + (a - b) / c - 1.0 / b + 2.0 * a,
    "roots and sizes": lambda a, b, c: ca.sqrt(a * a + 1.0) + ca.fabs(b - c) + ca.fabs(c),
    "angles": lambda a, b, c: ca.sin(a * b) * ca.cos(c) + ca.atan2(a, b) + ca.log(c * c + 0.1),
    "the lesser, the greater": lambda a, b, c: ca.fmin(a * b, c) - ca.fmax(a, b * c),
    "one or the other": lambda a, b, c: ca.if_else(a * b < c, a * c, ca.sin(b)) + ca.sign(a) * b,
    "jumps": lambda a, b, c: ca.floor(3 * a) * b + ca.if_else(ca.logic_or(a > b, b > c), a, c),
    "what does not change": lambda a, b, c: ca.DM(3.0) + ca.floor(c),
}


@pytest.mark.parametrize("what", OPERATIONS)
def test_derivatives_along_a_direction(what: str) -> None:
    """As CasADi differentiates; rows may stand anywhere, and the middle number has no derivative.

    The second result is a number that went in, and the third is one that does not change.
    """
    x, along = ca.SX.sym("x", 3), ca.SX.sym("d", 2)
    value = ca.vertcat(OPERATIONS[what](x[0], x[1], x[2]), x[2], x[1])
    slope = ca.jtimes(value, x, ca.vertcat(along[0], 0.0, along[1]))
    wanted = ca.Function("wanted", [x, along], [ca.densify(ca.vertcat(value, slope))])
    given = ca.Function("f", [x], [ca.densify(value)])
    at = rng.normal(size=(LANES, 5))
    rows = np.zeros((6, LANES))  # of c, c', nothing, a', a, b
    rows[[4, 5, 0, 3, 1]] = at.T
    text = expression(given, "along", [4, 5, 0], [3, None, 1])
    engine = compiled(module([text]))
    function = compiled_function(engine, "along", ctypes.c_void_p, ctypes.c_void_p)
    aligned, result = (_aligned(6) for _ in range(2))
    aligned[:] = rows
    function(aligned.ctypes.data, result.ctypes.data)
    interpreted = [np.array(wanted(row[:3], row[3:])).ravel() for row in at]
    np.testing.assert_allclose(result, np.array(interpreted).T, rtol=1e-12, atol=1e-12)


def test_an_operation_without_a_derivative_is_refused() -> None:
    with pytest.raises(NotImplementedError, match="derivative"):
        derivative(Shared(), ca.OP_TAN, "%r", ["%a"], ["%b"])
    assert derivative(Shared(), ca.OP_FLOOR, "%r", ["%a"], ["%b"]) is None
    assert derivative(Shared(), ca.OP_MUL, "%r", ["%a", "%b"], [None, None]) is None


def _aligned(rows: int) -> np.ndarray:
    """Rows of lanes whose memory begins where vectors may."""
    memory = np.zeros(rows * LANES + LANES)
    first = -memory.ctypes.data % 64 // 8
    return memory[first : first + rows * LANES].reshape(rows, LANES)
