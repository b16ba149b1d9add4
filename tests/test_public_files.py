"""Every robot that the packages of our tests carry, read or refused for a reason that stands here.

What is read has the mass matrix that the format's own program computes, in ten poses: pinocchio
for URDF, MuJoCo for MJCF.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import mujoco
import numpy as np
import pytest
from _pytest.mark import ParameterSet
from shares import every
from trees import assert_close

import somersault as so
from somersault import SomersaultError, SomersaultWarning
from somersault.model import Model, load

POSES = 10
pytestmark = pytest.mark.filterwarnings(
    "ignore::somersault._core.errors.SomersaultWarning", "ignore::DeprecationWarning"
)


def files_of(package: str, ending: str) -> dict[str, Path]:
    """The files of an installed package by their last three parts."""
    try:
        files = distribution(package).files or []
    except PackageNotFoundError:
        return {}
    found = [Path(str(file.locate())).resolve() for file in files if file.name.endswith(ending)]
    return {"/".join(path.parts[-3:]): path for path in sorted(found)}


LARGE = ("drosophila_fused.xml", "tiago_dual.urdf", "dog_v2/dog.xml")


def read_of(files: dict[str, Path], refused: Callable[[str], bool]) -> list[ParameterSet]:
    """The names of files that are read; the largest take some seconds to derive."""
    return [
        pytest.param(name, marks=[pytest.mark.slow] if name.endswith(LARGE) else [])
        for name in files
        if not refused(name)
    ]


def mass_matrix(model: Model, q: np.ndarray) -> np.ndarray:
    """Of all joints, (ω, v of the base, joint speeds), by the equations of motion."""
    whole = _functions.get(model.bodies)
    if whole is None:
        whole = so.Equations(model).expression("mass_matrix").function()
        _functions.clear()
        _functions[model.bodies] = whole
    return np.array(whole(q, []))


_functions: dict[tuple, object] = {}


def some_pose(model: Model, random: np.random.Generator) -> np.ndarray:
    values: list[float] = []
    for joint in model.joints:
        if joint.kind == "ball":
            quaternion = random.normal(size=4)
            values += (quaternion / np.linalg.norm(quaternion)).tolist()
        else:
            low, high = joint.limits or (joint.reference - 1.5, joint.reference + 1.5)
            values.append(random.uniform(max(low, -3), min(high, 3)))
    return np.array(values)


# ------------------------------------------------------------------------------------ URDF

ROBOTS = files_of("example-robot-data", ".urdf")
REFUSED_ROBOTS = {
    "alex_psyonic_hands.urdf": "'Left_index_q2' mimics 'index_q1', which is no joint",
    "ur3.urdf": "has no links",  # what xacro left of it; pinocchio refuses it too
}


@pytest.mark.skipif(not ROBOTS, reason="needs example-robot-data")
def test_there_are_robots_to_read() -> None:
    assert len(ROBOTS) - len(REFUSED_ROBOTS) >= 66


@pytest.mark.parametrize(
    "name", every(read_of(ROBOTS, lambda n: Path(n).name in REFUSED_ROBOTS), 4)
)
def test_a_robot_has_pinocchios_mass_matrix(name: str) -> None:
    pin = pytest.importorskip("pinocchio")
    model = load(ROBOTS[name])
    theirs = pin.buildModelFromUrdf(
        str(ROBOTS[name]), *([pin.JointModelFreeFlyer()] if model.free else [])
    )
    data = theirs.createData()
    names = {joint.name for joint in model.joints} | {"universe", "root_joint"}
    order = [3, 4, 5, 0, 1, 2] if model.free else []
    order += [theirs.joints[theirs.getJointId(joint.name)].idx_v for joint in model.joints]
    idle = [
        joint.idx_v for n, joint in zip(theirs.names, theirs.joints, strict=True) if n not in names
    ]
    random = np.random.default_rng(4)
    for _ in range(POSES):
        ours = some_pose(model, random)
        q = pin.neutral(theirs)
        for joint in model.joints:
            theirs_too = theirs.joints[theirs.getJointId(joint.name)]
            value = ours[model.coordinate_slice(joint.name)][0]
            at = theirs_too.idx_q
            q[at : at + theirs_too.nq] = (
                value if theirs_too.nq == 1 else (np.cos(value), np.sin(value))
            )
        upper = np.triu(pin.crba(theirs, data, q))
        full = upper + np.triu(upper, 1).T
        assert_close(mass_matrix(model, ours), full[np.ix_(order, order)], 1e-9)
        assert not np.any(np.abs(full[idle]) > 1e-12)  # joints that move nothing


@pytest.mark.parametrize("name", [n for n in ROBOTS if Path(n).name in REFUSED_ROBOTS])
def test_a_robot_that_is_refused_is_refused_for_this(name: str) -> None:
    with pytest.raises(SomersaultError, match=REFUSED_ROBOTS[Path(name).name]):
        load(ROBOTS[name])


# ------------------------------------------------------------------------------------ MJCF

WORLDS = {
    name: path
    for package in ("gymnasium", "dm_control", "mujoco")
    for name, path in files_of(package, ".xml").items()
}
NOTHING, FLUID, PART = "has no bodies", "fluid's drag", "cannot be read as a model"
REFUSED_WORLDS = {
    # Parts, scenes and materials for other files to include, and files with nothing that moves.
    "composer/arena.xml": NOTHING, "duplo/duplo2x4.xml": NOTHING, "dog_v2/dog_base.xml": NOTHING,
    "test_assets/included.xml": NOTHING, "test_assets/lego_brick.xml": "nothing that moves",
    "test_assets/model_with_assetdir.xml": NOTHING, "test_assets/model_with_assets.xml": NOTHING,
    "test_assets/model_with_include.xml": NOTHING, "assets/sphere.xml": NOTHING,
    "test_assets/model_with_nameless_assets.xml": NOTHING, "testdata/msh.xml": NOTHING,
    "test_assets/model_with_separators.xml": NOTHING, "suite/lqr.xml": NOTHING,
    "common/materials.xml": NOTHING, "common/skybox.xml": NOTHING, "common/visual.xml": NOTHING,
    "kinova/common.xml": NOTHING,
    # What MuJoCo cannot read either: meshes and includes that are not shipped, schemas, templates.
    "assets/drosophila.xml": PART, "build_fruitfly/floor.xml": PART,
    "build_fruitfly/fruitfly.xml": PART, "dog_v2/scene.xml": PART, "mjcf/schema.xml": PART,
    "test_assets/attribute_test_schema.xml": PART,
    "test_assets/included_with_invalid_filenames.xml": PART,
    "test_assets/model_with_invalid_filenames.xml": PART, "test_assets/test_model.xml": PART,
    "testing/assets/model_with_assets.xml": PART,
    # What flies otherwise than MuJoCo has it.
    "assets/drosophila_defaults.xml": FLUID, "fruitfly_v2/floor.xml": FLUID,
    "fruitfly_v2/fruitfly.xml": FLUID, "test_assets/arena.xml": FLUID, "suite/swimmer.xml": FLUID,
    "mujoco/assets/swimmer.xml": FLUID, "suite/fish.xml": "tendon 'fins_sym' has stiffness",
    "testdata/model.xml": "gravcomp",
    # What is no tree, or two.
    "suite/dog.xml": "2 free bodies", "suite/quadruped.xml": "2 free bodies",
    "suite/manipulator.xml": "'coupling' closes a loop",
    "suite/stacker.xml": "'coupling' closes a loop",
}  # fmt: skip


def reason(name: str) -> str | None:
    return next((why for end, why in REFUSED_WORLDS.items() if name.endswith(end)), None)


@pytest.mark.parametrize("name", every(read_of(WORLDS, lambda n: reason(n) is not None), 3))
def test_a_world_has_mujocos_mass_matrix(name: str) -> None:
    model = load(WORLDS[name])
    m = mujoco.MjModel.from_xml_path(str(WORLDS[name]))
    d = mujoco.MjData(m)
    names = []
    for j in range(m.njnt):
        body = int(m.jnt_bodyid[j])
        place = "" if m.body_jntnum[body] == 1 else f"_{j - m.body_jntadr[body] + 1}"
        names.append(m.joint(j).name or f"{m.body(body).name or f'body_{body}'}{place}")
    random = np.random.default_rng(5)
    for _ in range(POSES):
        mujoco.mj_resetData(m, d)
        for j in range(m.njnt):
            at, kind = m.jnt_qposadr[j], m.jnt_type[j]
            if kind in (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE):
                d.qpos[at] += random.uniform(-1, 1)
            elif kind == mujoco.mjtJoint.mjJNT_BALL:
                quaternion = random.normal(size=4)
                d.qpos[at : at + 4] = quaternion / np.linalg.norm(quaternion)
        mujoco.mj_forward(m, d)
        theirs = np.zeros((m.nv, m.nv))
        for row, speed in zip(theirs, np.eye(m.nv), strict=True):
            mujoco.mj_mulM(m, d, row, speed)
        # Our speeds from theirs: the base's as it moves, seen in its own axes, and the joints'.
        rows, q = [], []
        if model.free:
            base = m.body(model.bodies[0].name).id
            linear, angular = np.zeros((3, m.nv)), np.zeros((3, m.nv))
            mujoco.mj_jac(m, d, linear, angular, d.xpos[base], base)
            turn = d.xmat[base].reshape(3, 3).T
            rows = [turn @ angular, turn @ linear]
        for joint in model.joints:
            j = names.index(joint.name)
            v, at = m.jnt_dofadr[j], m.jnt_qposadr[j]
            rows.append(np.eye(m.nv)[v : v + joint.speeds])
            q += d.qpos[at : at + joint.coordinates].tolist()
        ours_from_theirs = np.concatenate(rows)
        ours = ours_from_theirs.T @ mass_matrix(model, np.array(q)) @ ours_from_theirs
        assert_close(ours, theirs, 1e-9)


@pytest.mark.parametrize("name", every((n for n in WORLDS if reason(n) is not None), 4))
def test_a_world_that_is_refused_is_refused_for_this(name: str) -> None:
    why = reason(name)
    with pytest.raises(SomersaultError) as caught:
        load(WORLDS[name])
    assert why is not None
    assert why in str(caught.value)
    if why == PART:
        with pytest.raises(ValueError, match="rror"):
            mujoco.MjModel.from_xml_path(str(WORLDS[name]))


def test_where_inertias_come_from_is_known() -> None:
    robots = [path for name, path in ROBOTS.items() if name.endswith("go2.urdf")]
    for path in robots:
        assert {body.inertia_from for body in load(path).bodies} == {"file"}
    worlds = [path for name, path in WORLDS.items() if name.endswith("assets/humanoid.xml")]
    for path in worlds:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SomersaultWarning)
            assert {body.inertia_from for body in load(path).bodies} == {"shapes"}
