"""Left and right: which joints are each other's image, and that they move as images do.

The mirror image of a moved body is computed by MuJoCo, from its mass matrix: moving every joint
as its image must reflect the whole body's inertia, whatever the pose.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import mujoco
import numpy as np
import pytest
from trees import mujoco_addresses, random_tree, to_mujoco

from somersault.model import (
    Body,
    Joint,
    Model,
    Pair,
    as_matrix,
    as_vector,
    common_name,
    load,
    mirror_pairs,
    pose,
)
from somersault.stability import spin

HUMANOIDS = {
    "gymnasium": "envs/mujoco/assets/humanoid.xml",
    "dm_control": "suite/humanoid.xml",
}
SEEDS = range(12)


@cache
def humanoid(package: str) -> Model:
    found = find_spec(package)
    if found is None or found.origin is None:
        pytest.skip(f"{package} is not installed")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return load(Path(found.origin).parent / HUMANOIDS[package])


def inertia(m: mujoco.MjModel, model: Model, q: np.ndarray) -> np.ndarray:
    """Of the whole about its centre of mass, in the base's axes, at joint coordinates q."""
    d = mujoco.MjData(m)
    d.qpos[3:7] = 1.0, 0.0, 0.0, 0.0
    d.qpos[mujoco_addresses(model, m)[0]] = q
    mujoco.mj_forward(m, d)
    moved = np.zeros((6, m.nv))
    for row, speed in zip(moved, np.eye(m.nv), strict=False):
        mujoco.mj_mulM(m, d, row, speed)
    along = moved[:3, 3:6]
    return moved[3:6, 3:6] - along.T @ np.linalg.solve(moved[:3, :3], along)


def moved(m: mujoco.MjModel, model: Model, small: np.ndarray) -> np.ndarray:
    """Joint coordinates after moving from home along the joint speeds."""
    q_at, v_at = mujoco_addresses(model, m)
    q, v = np.zeros(m.nq), np.zeros(m.nv)
    q[3], q[q_at], v[v_at] = 1.0, model.home, small
    mujoco.mj_integratePos(m, q, v, 1.0)
    return q[q_at]


def image(pairs: tuple[Pair, ...], small: np.ndarray) -> np.ndarray:
    """What a mirror shows of a motion of the joints."""
    seen = np.full(len(small), np.nan)
    for pair in pairs:
        seen[pair.left], seen[pair.right] = pair.sign * small[[pair.right, pair.left]]
    return seen


def assert_reflects(model: Model, normal: int, seed: int = 0) -> None:
    """A motion, and its image: one body's inertia is the other's, reflected."""
    rng = np.random.default_rng(seed)
    m, reflect = to_mujoco(model), np.eye(3)
    reflect[normal, normal] = -1.0
    pairs = mirror_pairs(model)
    for _ in range(3):
        motion = rng.normal(size=len(model.speeds)) * 0.6
        one, two = (inertia(m, model, moved(m, model, x)) for x in (motion, image(pairs, motion)))
        np.testing.assert_allclose(
            reflect @ one @ reflect, two, rtol=0, atol=1e-6 * np.abs(one).max()
        )
        # Symmetric: its own image, with nothing across the plane. Antisymmetric: undone by it.
        symmetric = motion + image(pairs, motion)
        across = np.delete(inertia(m, model, moved(m, model, symmetric))[normal], normal)
        assert np.abs(across).max() < 1e-6 * np.abs(one).max()
        antisymmetric = motion - image(pairs, motion)
        np.testing.assert_allclose(image(pairs, antisymmetric), -antisymmetric, atol=1e-12)


# ------------------------------------------------------------------------ models that ship


@pytest.mark.parametrize("name", ["furrer", "doll", "doll_weighted"])
def test_arms_are_a_pair(name: str) -> None:
    """Both hinges turn about +1, so raising both arms is left = −right (eqs. 4.7, 4.8)."""
    model = load(name)
    assert mirror_pairs(model) == (Pair("shoulder", 0, 1, -1),)
    assert_reflects(model, normal=1)
    np.testing.assert_allclose(pose(model, {"shoulder": 1.3}), [1.3, -1.3])


@pytest.mark.parametrize("name", ["furrer", "gymnast", "doll"])
def test_a_clamped_trunk_leaves_its_limbs_their_pairs(name: str) -> None:
    free, clamped = load(name), load(name, base="fixed")
    assert mirror_pairs(clamped) == mirror_pairs(free)


@pytest.mark.parametrize("name", ["book", "human_layout", "simplest"])
def test_nothing_is_paired_without_two_limbs(name: str) -> None:
    assert mirror_pairs(load(name)) == ()


@pytest.mark.parametrize("what", ["mass", "com", "inertia", "position", "axis", "anchor"])
def test_arms_that_differ_are_no_pair(what: str) -> None:
    body, left, right = load("furrer").bodies
    (joint,) = right.joints
    x, y, z = right.position
    changed = {
        "mass": replace(right, mass=right.mass * 1.001),
        "com": replace(right, com=(0.001, 0.0, right.com[2])),
        "inertia": replace(right, inertia=as_matrix(np.array(right.inertia) * 1.001)),
        "position": replace(right, position=(x, y, z + 0.001)),
        "axis": replace(right, joints=(replace(joint, axis=(0.0, 0.6, 0.8)),)),
        "anchor": replace(right, joints=(replace(joint, anchor=(0.0, 0.001, 0.0)),)),
    }
    assert mirror_pairs(Model("lame", True, (body, left, changed[what]))) == ()


def test_a_hinge_is_the_same_anywhere_along_its_axis() -> None:
    body, left, right = load("furrer").bodies
    joint = replace(right.joints[0], anchor=(0.1, 0.0, 0.0))
    assert mirror_pairs(Model("same", True, (body, left, replace(right, joints=(joint,)))))


# --------------------------------------------------------------------- humanoids of others


@pytest.mark.parametrize("package", HUMANOIDS)
def test_humanoids_have_two_sides(package: str) -> None:
    model = humanoid(package)
    names = [joint.name for joint in model.joints]
    limbs = {name.removeprefix("left_") for name in names if name.startswith("left_")}
    pairs = {pair.name: pair for pair in mirror_pairs(model)}
    assert len(limbs) >= 7
    for limb in limbs:
        pair = pairs[limb]
        assert model.speeds[pair.left] == f"left_{limb}"
        assert model.speeds[pair.right] == f"right_{limb}"
    middle = {name: pairs[name] for name in ("abdomen_x", "abdomen_y", "abdomen_z")}
    assert {name: pair.sign for name, pair in middle.items()} == {
        "abdomen_x": -1,
        "abdomen_y": 1,
        "abdomen_z": -1,
    }
    assert all(pair.left == pair.right for pair in middle.values())
    assert len(pairs) == len(limbs) + 3
    assert_reflects(model, normal=1)


# ---------------------------------------------------------------------- bodies made double


def doubled(seed: int, references: bool = True) -> tuple[Model, int]:
    """A symmetric trunk with a random limb and its image, across one of the three planes."""
    rng = np.random.default_rng([8, seed])
    normal = seed % 3
    kinds = ("hinge", "slide", "ball")
    trunk, *limb = random_tree(rng, 2 + seed % 2, True, kinds, armature=False).bodies
    reflect = np.eye(3)
    reflect[normal, normal] = -1.0
    symmetric = np.array(trunk.inertia)
    trunk = replace(
        trunk,
        com=as_vector((np.array(trunk.com) + reflect @ trunk.com) / 2),
        inertia=as_matrix((symmetric + reflect @ symmetric @ reflect) / 2),
    )
    limb = [replace(limb[0], position=as_vector(rng.normal(size=3))), *limb[1:]]
    left = [_named(body, "left", 0) for body in limb]
    right = [_reflected(_named(body, "right", len(limb)), reflect, rng) for body in limb]
    if not references:
        left, right = ([_without_reference(body) for body in side] for side in (left, right))
    return Model("doubled", True, (trunk, *left, *right)), normal


def _named(body: Body, side: str, shift: int) -> Body:
    joints = tuple(replace(joint, name=f"{side}_{joint.name}") for joint in body.joints)
    parent = body.parent + shift if body.parent else 0
    return replace(body, name=f"{side}_{body.name}", parent=parent, joints=joints)


def _reflected(body: Body, reflect: np.ndarray, rng: np.random.Generator) -> Body:
    def of_joint(joint: Joint) -> Joint:
        turns = -reflect if joint.kind == "hinge" else reflect
        way = rng.choice([-1.0, 1.0]) if joint.kind != "ball" else 1.0
        axis = joint.axis if joint.kind == "ball" else as_vector(way * turns @ joint.axis)
        return replace(joint, axis=axis, anchor=as_vector(reflect @ joint.anchor))

    return replace(
        body,
        com=as_vector(reflect @ body.com),
        inertia=as_matrix(reflect @ np.array(body.inertia) @ reflect),
        position=as_vector(reflect @ body.position),
        rotation=as_matrix(reflect @ np.array(body.rotation) @ reflect),
        joints=tuple(map(of_joint, body.joints)),
    )


def _without_reference(body: Body) -> Body:
    return replace(body, joints=tuple(replace(joint, reference=0.0) for joint in body.joints))


@pytest.mark.parametrize("seed", SEEDS)
def test_a_limb_and_its_image_are_paired(seed: int) -> None:
    """Hinges, slides and balls, whichever way the axes of the image point."""
    model, normal = doubled(seed)
    pairs = mirror_pairs(model)
    assert sorted(i for p in pairs for i in (p.left, p.right)) == list(range(len(model.speeds)))
    for pair in pairs:
        left, right = model.speeds[pair.left], model.speeds[pair.right]
        assert (left, right) == (f"left_{pair.name}", f"right_{pair.name}")
    assert_reflects(model, normal, seed)


@pytest.mark.parametrize("references", [False, True], ids=["zeroed", "with references"])
@pytest.mark.parametrize("seed", SEEDS)
def test_a_pose_by_the_common_name_is_symmetric(seed: int, references: bool) -> None:
    """Wherever the file puts the zero of a joint: the inertia has nothing across the plane."""
    model, normal = doubled(seed, references)
    rng = np.random.default_rng(seed)
    q = pose(model, {pair.name: rng.normal() * 0.4 for pair in mirror_pairs(model)})
    whole = inertia(to_mujoco(model), model, q)
    assert np.abs(np.delete(whole[normal], normal)).max() < 1e-6 * np.abs(whole).max()


def test_what_a_mirror_keeps_apart_stays_apart_in_the_equations() -> None:
    """Spins across the plane: tilt and twist go with what is antisymmetric (section 4.2)."""
    body, left, right = load("furrer").bodies
    nod = Joint("nod", "hinge", axis=(0.0, 1.0, 0.0))
    shake = Joint("shake", "hinge", axis=(0.0, 0.0, 1.0))
    head = replace(left, name="head", position=(0.0, 0.0, 0.5), joints=(nod, shake))
    legs = [
        replace(left, name=f"{side}_leg", position=(0.0, y, -0.2), joints=(_hip(side),))
        for side, y in (("left", 0.1), ("right", -0.1))
    ]
    whole = Model("whole", True, (body, left, right, head, *legs))
    assert {p.name: p.sign for p in mirror_pairs(whole)} == {
        "shoulder": -1,
        "hip": 1,
        "nod": 1,
        "shake": -1,
    }
    system = spin(whole, 2, {"shoulder": 1.2, "hip": 0.4, "nod": 0.3}).linear()
    assert [set(group) for group in system.subsystems] == [
        {"tilt", "twist", "antisymmetric shoulder", "antisymmetric hip", "shake"},
        {"somersault", "symmetric shoulder", "symmetric hip", "nod"},
    ]


def _hip(side: str) -> Joint:
    return Joint(f"{side}_hip", "hinge", axis=(0.0, 1.0, 0.0))


@pytest.mark.parametrize(
    ("left", "right", "common"),
    [
        ("left_shoulder", "right_shoulder", "shoulder"),
        ("shoulder_left", "shoulder_right", "shoulder"),
        ("l_hip.x", "r_hip.x", "hip.x"),
        ("hip_l_x", "hip_r_x", "hip_x"),
        ("LeftKnee", "RightKnee", "Knee"),
        ("L_knee", "R_knee", "knee"),
        ("neck", "neck", "neck"),
        ("left", "right", "left+right"),
        ("hip_1", "hip_4", "hip_1+hip_4"),
        ("pelvis_lrot", "pelvis_rrot", "pelvis_lrot+pelvis_rrot"),
    ],
)
def test_common_names(left: str, right: str, common: str) -> None:
    assert common_name(left, right) == common
