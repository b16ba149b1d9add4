"""Somersault, tilt and twist about any three axes, against SciPy's Euler angles."""

from __future__ import annotations

from itertools import permutations
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import somersault as so
from somersault import attitude
from somersault.attitude import Axes

many = settings(derandomize=True, max_examples=60, deadline=None)
orders = st.sampled_from(list(permutations((1, 2, 3))))
turns = st.floats(-7.0, 7.0)
tilts = st.floats(-1.2, 1.2)
numbers = st.floats(-3.0, 3.0)


def scipys(axes: Axes) -> str:
    """The intrinsic sequence of these axes in SciPy's letters."""
    return "".join("XYZ"[axis - 1] for axis in axes)


def wrapped(angle: Any) -> Any:
    return np.angle(np.exp(1j * np.asarray(angle)))


@many
@given(orders, turns, tilts, turns)
def test_attitudes_are_scipys(axes: Axes, somersault: float, tilt: float, twist: float) -> None:
    angles = [somersault, tilt, twist]
    ours = attitude.quaternion_from_angles(*angles, axes)
    theirs = Rotation.from_euler(scipys(axes), angles)
    matrix = attitude.matrix_from_quaternion(ours)
    np.testing.assert_allclose(matrix, theirs.as_matrix(), rtol=0, atol=1e-14)
    back = attitude.angles_from_quaternion(ours, axes)
    wanted = theirs.as_euler(scipys(axes))
    np.testing.assert_allclose(wrapped(back - wanted), 0, atol=1e-14)
    np.testing.assert_allclose(wrapped(back - angles), 0, atol=1e-14)


@many
@given(orders, st.sampled_from([1, -1]), turns, turns)
def test_the_singularity_keeps_the_attitude(
    axes: Axes, up: int, somersault: float, twist: float
) -> None:
    given_ = attitude.quaternion_from_angles(somersault, up * np.pi / 2, twist, axes)
    angles = attitude.angles_from_quaternion(given_, axes)
    assert angles[2] == 0
    same = np.abs(attitude.quaternion_from_angles(*angles, axes) @ given_)
    assert same == pytest.approx(1, abs=1e-15)


@many
@given(orders, st.tuples(turns, tilts, turns), st.tuples(numbers, numbers, numbers))
def test_rates_are_those_of_the_attitude(
    axes: Axes, angles: tuple[float, ...], rates: tuple[float, ...]
) -> None:
    """ω from finite differences of SciPy's rotations, and back."""
    step = 1e-5
    before, after = (
        Rotation.from_euler(scipys(axes), np.array(angles) + way * step * np.array(rates))
        for way in (-1, 1)
    )
    omega = attitude.body_rates(angles, rates, axes)
    middle = Rotation.from_euler(scipys(axes), angles)
    differences = (middle.inv() * (after * before.inv()) * middle).as_rotvec() / (2 * step)
    np.testing.assert_allclose(omega, differences, rtol=0, atol=1e-7)
    np.testing.assert_allclose(attitude.angle_rates(angles, omega, axes), rates, atol=1e-13)


@many
@given(orders, st.tuples(turns, tilts, turns), st.tuples(turns, tilts, turns))
def test_turns_are_counted_along_a_path(
    axes: Axes, start: tuple[float, ...], end: tuple[float, ...]
) -> None:
    whole = np.array([4 * np.pi, 0, -6 * np.pi])
    path = np.linspace(start, np.array(end) + whole, 400)
    quaternions = Rotation.from_euler(scipys(axes), path).as_quat(scalar_first=True)
    found = attitude.unwrapped_angles(quaternions, axes)
    np.testing.assert_allclose(found - found[0], path - path[0], rtol=0, atol=1e-12)
    np.testing.assert_allclose(wrapped(found[0] - path[0]), 0, atol=1e-12)


@many
@given(orders, st.tuples(numbers, numbers, numbers))
def test_renaming_axes_turns_a_vector(axes: Axes, vector: tuple[float, ...]) -> None:
    renaming = np.array(attitude.in_sequence(list(np.eye(3)), axes))
    assert np.linalg.det(renaming) == 1  # a rotation, whatever the order of the axes
    renamed = attitude.in_sequence(vector, axes)
    np.testing.assert_array_equal(renamed, renaming @ vector)
    np.testing.assert_array_equal(attitude.from_sequence(renamed, axes), vector)


WRONG: list[Any] = [
    (1, 2), (1, 2, 2), (0, 1, 2), (1, 2, 3, 1), (1.0, 2.0, 3.0), "213", "xyz", 213, None,
    (True, 2, 3), [[1, 2, 3]], np.eye(3), ("1", "2", "3"),
]  # fmt: skip


@pytest.mark.parametrize("axes", WRONG)
def test_what_are_no_axes(axes: Any) -> None:
    with pytest.raises(so.SomersaultError, match=r"^axes .*give 1, 2 and 3 in some order"):
        attitude.as_axes(axes)
    if axes is not None:
        with pytest.raises(so.SomersaultError, match="axes "):
            so.load("furrer", axes)


def test_a_model_keeps_its_axes() -> None:
    furrer = so.load("furrer")
    assert furrer.axes == (2, 1, 3)
    other = so.load("furrer", axes=np.array([1, 2, 3]))
    assert other.axes == (1, 2, 3)
    assert all(type(axis) is int for axis in other.axes)
    assert so.load(other) is other  # a model is given back as it is
    assert so.load(other, axes=[2, 1, 3]) == furrer
    assert len({other, furrer, so.load("furrer", axes=(1, 2, 3))}) == 2
    assert other.renamed("mine").axes == (1, 2, 3)


def test_a_fixed_base_has_no_somersault() -> None:
    post = so.Body("post", -1, 1.0, (0, 0, 0), ((1, 0, 0), (0, 1, 0), (0, 0, 1)), joints=(
        so.Joint("hinge", "hinge"),
    ))  # fmt: skip
    fixed = so.Model("fixed", False, (post,))
    assert so.load(fixed, axes=(2, 1, 3)) == fixed
    with pytest.raises(so.SomersaultError, match="fixed base"):
        so.load(fixed, axes=(1, 2, 3))
