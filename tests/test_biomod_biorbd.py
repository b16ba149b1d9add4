"""Random `.bioMod` files have the mass matrix that biorbd gives them."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from trees import State, evaluated, random_inertia, random_rotation

import somersault as so
from somersault._core.errors import SomersaultWarning
from somersault.dynamics import Equations
from somersault.model import Joint, Model, body_frames, body_velocities, centre_of_mass
from somersault.model._weld import merge_welded

biorbd = pytest.importorskip("biorbd", reason="biorbd, the reference reader, is optional")

TREES = 60
ROOTS = ("translations xyz\nrotations xyz", "translations xyz\nrotations zxy",
         "translations yz\nrotations x")  # fmt: skip
MOVES = ("rotations x", "rotations xyz", "rotations zyz", "translations zx", "rotations q",
         "translations y\nrotations zx", "")  # fmt: skip


def read(path: Path, text: str) -> Model:
    path.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SomersaultWarning)
        return so.load(path)


def row(values: np.ndarray) -> str:
    return " ".join(repr(float(x)) for x in np.ravel(values))


def random_text(rng: np.random.Generator) -> str:
    """A root and one to six segments; some welded, some without mass, some not quite symmetric."""
    version = int(rng.integers(2, 5))
    text = f"version {version}\n"
    if rng.integers(4) == 0:
        text += "segment root\nparent base\nmass 0\nendsegment\n"
    count = int(rng.integers(2, 8))
    massless = [False] * count
    for number in range(1, count - 1):
        massless[number] = not massless[number - 1] and rng.integers(4) == 0
    for number in range(count):
        parent = "root" if number == 0 else f"S{rng.integers(number)}"
        if number and massless[number - 1]:
            parent = f"S{number - 1}"  # something heavy hangs on it
        moves = str(rng.choice(ROOTS if number == 0 else MOVES))
        if massless[number]:
            moves = "rotations x"
        elif number and massless[number - 1]:
            moves = "rotations y"
        text += f"segment S{number}\nparent {parent}\n{_place(rng, version)}{moves}\n"
        if massless[number]:
            text += "mass 0\n"
        else:
            mass = float(rng.uniform(0.5, 5))
            inertia = np.array(random_inertia(rng, mass))
            if rng.integers(3) == 0:
                inertia += np.triu(rng.normal(size=(3, 3)) * 1e-3, 1)
            text += f"mass {mass!r}\ncom {row(rng.normal(size=3) * 0.2)}\ninertia {row(inertia)}\n"
        text += "endsegment\n"
    return text


def _place(rng: np.random.Generator, version: int) -> str:
    kind = int(rng.integers(3))
    position = rng.normal(size=3) * 0.3
    if kind == 0:
        return ""
    if kind == 1:
        axes = "".join(rng.permutation(list("xyz")))
        start = "rtinmatrix 0\n" if version < 3 else ""
        return f"{start}rt {row(rng.normal(size=3))} {axes} {row(position)}\n"
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = random_rotation(rng), position
    start = "" if version < 3 else "RTinMatrix 1\n"
    return f"{start}RT {row(matrix)}\n"


def held(model: Model) -> Model:
    """The same model with its base on the file's joints to the ground."""
    root = model.file_coordinates.root
    if not root:
        return model
    base = model.bodies[0]
    last = replace(root[-1], mass=base.mass, com=base.com, inertia=base.inertia)
    others = (replace(body, parent=body.parent + len(root) - 1) for body in model.bodies[1:])
    joined = [*root[:-1], last, *others]
    return Model("held", False, merge_welded(joined, free=False))


def mass_matrix(model: Model, q: np.ndarray) -> np.ndarray:
    still = np.zeros(6 * model.free + len(model.speeds))
    state = State(np.array([1.0, 0, 0, 0]), q, still, np.zeros(len(model.speeds)), np.zeros(3))
    return evaluated(Equations(model), state, still, False, ("mass_matrix",))["mass_matrix"]


def assert_same(path: Path, model: Model, seed: int, count: int = 2, tol: float = 1e-9) -> None:
    """Mass, centre of mass and mass matrix as biorbd has them, in random poses."""
    theirs, rng, whole = biorbd.Model(str(path)), np.random.default_rng(seed), held(model)
    assert model.mass == pytest.approx(theirs.mass(), rel=tol)
    for _ in range(count):
        q = np.concatenate([_value(joint, rng) for joint in whole.joints])
        pose = in_biorbd(whole, q)
        expected = theirs.massMatrix(pose).to_array()[: len(whole.speeds), : len(whole.speeds)]
        atol = tol * np.abs(expected).max()
        np.testing.assert_allclose(mass_matrix(whole, q), expected, rtol=0, atol=atol)
        com = theirs.CoM(pose).to_array()
        np.testing.assert_allclose(centre_of_mass(whole, q), com, rtol=0, atol=tol)
        if model.free:
            found = through_the_base(model, whole, q)
            np.testing.assert_allclose(found, expected, rtol=0, atol=atol)


def _value(joint: Joint, rng: np.random.Generator) -> np.ndarray:
    value = rng.normal(size=joint.coordinates)
    return value / np.linalg.norm(value) if joint.kind == "ball" else value


def in_biorbd(model: Model, q: np.ndarray) -> np.ndarray:
    """Joint coordinates as biorbd has them: the w of all quaternions last."""
    pose, last = [], []
    for joint in model.joints:
        value = q[model.coordinate_slice(joint.name)]
        if joint.kind == "ball":
            last.append(value[0])
            value = value[1:]
        pose += value.tolist()
    return np.array(pose + last)


def through_the_base(model: Model, whole: Model, q: np.ndarray) -> np.ndarray:
    """The free model's mass matrix, over the speeds of the joints that held its base."""
    count = sum(joint.speeds for body in model.file_coordinates.root for joint in body.joints)
    base = next(n for n, body in enumerate(whole.bodies) if body.name == model.bodies[0].name)
    each = np.broadcast_to(q, (count, len(q)))
    angular, linear = body_velocities(whole, each, np.eye(count, len(whole.speeds)))
    turn = body_frames(whole, q)[0][base]
    speeds = np.zeros((6 + len(model.speeds), len(whole.speeds)))
    speeds[:3, :count] = turn.T @ angular[:, base].T
    speeds[3:6, :count] = turn.T @ linear[:, base].T
    speeds[6:, count:] = np.eye(len(model.speeds))
    return speeds.T @ mass_matrix(model, q[len(q) - len(model.coordinates) :]) @ speeds


@pytest.mark.parametrize("number", range(TREES))
def test_random_files_are_those_of_biorbd(number: int, tmp_path: Path) -> None:
    path = tmp_path / "tree.bioMod"
    model = read(path, random_text(np.random.default_rng([12, number])))
    assert_same(path, model, number)
