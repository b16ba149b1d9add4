"""Kinds of robots that people write, at random, against pinocchio."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from robots import ARM, HUB, joint, link, read, robot
from trees import assert_close

import somersault as so
from somersault.model import Follow, Model
from somersault.model._mass import mass_matrix


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


SIX = [(f"{kind}_{axis}", kind, axis) for kind in ("prismatic", "continuous")
       for axis in ("1 0 0", "0 1 0", "0 0 1")]  # fmt: skip


@settings(derandomize=True, max_examples=20, deadline=None)
@given(st.permutations(SIX), st.sampled_from(["world", "map"]))
def test_six_virtual_joints_are_a_free_base(order: list[tuple[str, str, str]], root: str) -> None:
    links = [root, "v1", "v2", "v3", "v4", "v5", "hub"]
    parts = [link(name) for name in links[:-1]]
    for k, (name, kind, axis) in enumerate(order):
        limit = '<limit lower="-9" upper="9" effort="1" velocity="1"/>'
        parts.append(joint(name, links[k], links[k + 1], axis, kind, more=limit))
    arm = (ARM, joint("hinge", "hub", "arm", at="0 0.1 0"))
    model = read(robot(*parts, HUB, *arm))
    assert model.free
    assert model == read(robot(HUB, *arm))


def in_pinocchio(text: str, model: Model, q: np.ndarray) -> np.ndarray:
    """The mass matrix that pinocchio makes of a file, in our order of speeds."""
    pin = pytest.importorskip("pinocchio")
    theirs = pin.buildModelFromXML(text, *([pin.JointModelFreeFlyer()] if model.free else []))
    at = pin.neutral(theirs)
    order = [3, 4, 5, 0, 1, 2] if model.free else []
    for own, value in zip(model.joints, q, strict=True):
        there = theirs.joints[theirs.getJointId(own.name)]
        at[there.idx_q : there.idx_q + there.nq] = (np.cos(value), np.sin(value))
        order.append(there.idx_v)
    upper = np.triu(pin.crba(theirs, theirs.createData(), at))
    return (upper + np.triu(upper, 1).T)[np.ix_(order, order)]


def assert_like_pinocchio(text: str, model: Model) -> None:
    random = np.random.default_rng(1)
    equations = so.Equations(model).expression("mass_matrix").function()
    for _ in range(3):
        q = random.uniform(-3, 3, len(model.home))
        theirs = in_pinocchio(text, model, q)
        assert_close(equations(q, []), theirs, 1e-9)
        assert_close(mass_matrix(model, q), theirs, 1e-9)


sizes = st.floats(0.01, 10)
places = st.tuples(*[st.floats(-1, 1)] * 3).map(lambda v: " ".join(map(str, v)))


@settings(derandomize=True, max_examples=30, deadline=None)
@given(st.lists(st.tuples(sizes, sizes, sizes, places, places), min_size=2, max_size=4))
def test_plates_anywhere(plates: list[tuple[float, float, float, str, str]]) -> None:
    """Flat in any direction: one moment is the sum of the others, up to rounding."""
    parts = []
    for k, (mass, one, other, com, turn) in enumerate(plates):
        inertia = np.roll([one, other, one + other], k)
        parts.append(link(f"l{k}", mass, tuple(inertia), com=com, rpy=turn))
        if k:
            parts.append(joint(f"j{k}", f"l{k - 1}", f"l{k}", "0.6 0 0.8", at=com, rpy=turn))
    text = robot(*parts)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model = read(text)
    assert_like_pinocchio(text, model)


@settings(derandomize=True, max_examples=30, deadline=None)
@given(st.lists(st.tuples(sizes, sizes, st.booleans()), min_size=1, max_size=4))
def test_rods_and_points_on_hinges(rods: list[tuple[float, float, bool]]) -> None:
    parts = [HUB]
    for k, (mass, size, point) in enumerate(rods):
        inertia = (0, 0, 0) if point else (mass * size**2 / 12, 0, mass * size**2 / 12)
        parts.append(link(f"l{k}", mass, inertia, com=f"0 {size / 2} 0"))
        parent = f"l{k - 1}" if k else "hub"
        parts.append(joint(f"j{k}", parent, f"l{k}", "1 0 0", at="0.1 0.3 0"))
    text = robot(*parts)
    assert_like_pinocchio(text, read(text))


@settings(derandomize=True, max_examples=30, deadline=None)
@given(st.permutations(["1 0 0", "0 1 0", "0 0 1"]), places, st.integers(2, 3))
def test_massless_links_between_hinges(axes: list[str], turn: str, count: int) -> None:
    parts = [HUB, ARM]
    names = ["hub", *(f"cross{k}" for k in range(count - 1)), "arm"]
    parts += [link(name) for name in names[1:-1]]
    for k in range(count):
        at = "0 0 0.1" if k == 0 else "0 0 0"
        rpy = turn if k == 0 else "0 0 0"
        parts.append(joint(f"j{k}", names[k], names[k + 1], axes[k], at=at, rpy=rpy))
    text = robot(*parts)
    assert_like_pinocchio(text, read(text))


@settings(derandomize=True, max_examples=30, deadline=None)
@given(
    st.lists(
        st.tuples(st.integers(0, 3), st.floats(-3, 3), st.floats(-1, 1)), min_size=2, max_size=5
    )
)
def test_mimics_of_mimics(chain: list[tuple[int, float, float]]) -> None:
    """Each follows one before it; all of them follow the first, as a walk back says."""
    parts = [HUB]
    leaders: list[int] = []
    for k, (back, factor, offset) in enumerate(chain):
        leaders.append(max(k - 1 - back, 0))
        more = (
            f'<mimic joint="j{leaders[k]}" multiplier="{factor}" offset="{offset}"/>' if k else ""
        )
        parts += [link(f"l{k}", 1, (1, 1, 1)), joint(f"j{k}", "hub", f"l{k}", more=more)]
    model = read(robot(*parts))
    values = [0.7]
    for (_, factor, offset), leader in zip(chain[1:], leaders[1:], strict=True):
        values.append(factor * values[leader] + offset)
    assert model.joints[0].follows is None
    for each, value in zip(model.joints[1:], values[1:], strict=True):
        assert isinstance(each.follows, Follow)
        assert each.follows.leader == "j0"
        assert each.follows.factor * 0.7 + each.follows.offset == pytest.approx(value, abs=1e-9)
