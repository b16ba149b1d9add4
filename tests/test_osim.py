"""The reader of `.osim` files against OpenSim itself, and what it leaves out or refuses."""

from __future__ import annotations

import contextlib
import os
import re
import string
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from osims import (
    Bone,
    Hinge,
    assert_same,
    constant,
    document,
    element,
    in_opensim,
    in_their_coordinates,
    line,
    needs_opensim,
    numbers,
    poses,
    random_tree,
    spline,
    version_3,
    version_4,
)  # fmt: skip
from shares import every

import somersault as so
from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault.model import Model, body_frames

TREES = 24


def read(folder: Path, text: str | bytes, name: str = "model.osim") -> Model:
    """The model of a text, its warnings silenced."""
    return noted(folder, text, name)[0]


def noted(folder: Path, text: str | bytes, name: str = "model.osim") -> tuple[Model, list[str]]:
    """The model of a text, and what was said of it."""
    path = folder / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", SomersaultWarning)
        model = so.load(path)
    return model, [str(w.message) for w in caught if w.category is SomersaultWarning]


def six(child: str, kind: str = "FreeJoint", parent: str = "ground") -> Hinge:
    """A free joint whose coordinates are called x0 … x5."""
    return Hinge(kind, "base", parent, child, {f"x{k}": "" for k in range(6)})


def pin(name: str, parent: str, child: str, more: str = "", **places: Any) -> Hinge:
    return Hinge("PinJoint", f"{name}_joint", parent, child, {name: more}, **places)


def custom(child: str, parent: str = "ground", **axes: tuple[str, Any, str]) -> Hinge:
    """A CustomJoint with its axes by name; its coordinates have no properties."""
    names = dict.fromkeys(by for by, _, _ in axes.values() if by)
    return Hinge("CustomJoint", f"{child}_joint", parent, child, dict.fromkeys(names, ""), axes)


X, Y, Z = np.eye(3)
HIPS = Bone("hips", 12, (0.01, 0.02, 0), (0.1, 0.09, 0.06, 0.001, 0, 0.002))
LEG = Bone("leg", 9, (0, -0.2, 0.01), (0.13, 0.03, 0.14, 0, 0.001, 0))
SHANK = Bone("shank", 4, (0, -0.18, 0), (0.05, 0.005, 0.05, 0, 0, 0))


# ------------------------------------------------------------------------ against OpenSim


@pytest.fixture(scope="module")
def trees(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Random trees in both dialects: the model, poses, and what OpenSim makes of them."""
    folder = tmp_path_factory.mktemp("trees")
    cases, requests = {}, []
    for number in range(TREES):
        tree = random_tree(np.random.default_rng([14, number]))
        for version, written in ((3, version_3(*tree)), (4, version_4(*tree))):
            name = f"tree{number}_{version}"
            model = read(folder, written, f"{name}.osim")
            drawn = poses(model, np.random.default_rng(number))
            theirs = [in_their_coordinates(model, pose) for pose in drawn]
            requests.append({"file": str(folder / f"{name}.osim"), "hold": False, "poses": theirs})
            cases[name] = model, drawn
    answers = in_opensim(requests)
    return {n: (*case, a) for (n, case), a in zip(cases.items(), answers, strict=True)}


@needs_opensim
@pytest.mark.parametrize("version", [3, 4])
@pytest.mark.parametrize("number", every(range(TREES), 4))
def test_random_trees_are_those_of_opensim(
    number: int, version: int, trees: dict[str, Any]
) -> None:
    assert_same(*trees[f"tree{number}_{version}"])


def against_opensim(
    folder: Path, text: str, hold: bool = False, count: int = 3
) -> tuple[Model, dict[str, Any]]:
    """The model of a text, after it was compared with OpenSim's in some poses."""
    model = read(folder, text)
    drawn = poses(model, np.random.default_rng(5), count)
    theirs = [in_their_coordinates(model, pose) for pose in drawn]
    path = str(folder / "model.osim")
    answer = in_opensim([{"file": path, "hold": hold, "poses": theirs}])[0]
    assert_same(model, drawn, answer)
    return model, answer


KNEE = [0, 0.6, 1.2, 1.8, 2.4], [0, 0.004, 0.003, -0.002, -0.006]


# A whole body in the style of the models of gait: names and joints as there, numbers of its own.
def acrobat(write: Any) -> str:
    def clamped(low: float, high: float, default: float = 0.0) -> str:
        return (
            element("default_value", numbers(default))
            + element("range", numbers([low, high]))
            + element("clamped", "true")
        )

    def ball(name: str, parent: str, child: str, at: Any, side: float, names: list[str]) -> Hinge:
        axes = {f"rotation{k + 1}": (n, a, line(s)) for k, (n, a, s) in enumerate(
            zip(names, (Z, X, Y), (1.0, side, side), strict=True))}  # fmt: skip
        return Hinge("CustomJoint", name, parent, child, dict.fromkeys(names, clamped(-2, 2)),
                     axes, at=(at, (0, 0, 0)))  # fmt: skip

    root = {f"pelvis_{n}": "" for n in ("tilt", "list", "rotation", "tx", "ty", "tz")}
    axes = dict(zip(
        [f"rotation{k}" for k in (1, 2, 3)] + [f"translation{k}" for k in (1, 2, 3)],
        [(n, a, line(1.0)) for n, a in zip(root, (Z, X, Y, X, Y, Z), strict=True)],
        strict=True,
    ))  # fmt: skip
    bones = [
        Bone("pelvis", 11.2, (-0.07, 0, 0), (0.095, 0.083, 0.055, 0, 0, 0)),
        Bone("torso", 30.1, (-0.03, 0.31, 0), (1.41, 0.72, 1.38, 0, 0, 0)),
    ]
    hinges = [
        Hinge("CustomJoint", "ground_pelvis", "ground", "pelvis", root, axes),
        ball("back", "pelvis", "torso", (-0.1, 0.08, 0), 1.0,
             ["lumbar_extension", "lumbar_bending", "lumbar_rotation"]),
    ]  # fmt: skip
    for side, sign in (("r", 1.0), ("l", -1.0)):
        bones += [
            Bone(f"femur_{side}", 8.9, (0, -0.17, 0), (0.128, 0.034, 0.135, 0, 0, 0)),
            Bone(f"tibia_{side}", 3.6, (0, -0.19, 0), (0.048, 0.005, 0.049, 0, 0, 0)),
            Bone(f"patella_{side}", 0.08, (0.002, 0.01, 0), (1e-5, 1e-5, 1e-5, 0, 0, 0)),
            Bone(f"foot_{side}", 1.4, (0.1, -0.03, 0), (0.002, 0.005, 0.005, 0, 0, 0)),
            Bone(f"humerus_{side}", 2.0, (0, -0.16, 0), (0.012, 0.004, 0.013, 0, 0, 0)),
            Bone(f"hand_{side}", 1.6, (0, -0.15, 0), (0.02, 0.002, 0.02, 0, 0, 0)),
        ]
        knee = Hinge(
            "CustomJoint", f"knee_{side}", f"femur_{side}", f"tibia_{side}",
            {f"knee_angle_{side}": clamped(0, 2.4, 0.2)},
            {
                "rotation1": (f"knee_angle_{side}", -Z, line(1.0)),
                "translation1": (f"knee_angle_{side}", X, spline(*KNEE)),
                "translation2": ("", Y, constant(-0.002)),
            },
            at=((0.004, -0.4, 0), (0, 0, 0)),
        )  # fmt: skip
        kneecap = Hinge(
            "CustomJoint", f"patellofemoral_{side}", f"femur_{side}", f"patella_{side}",
            {f"knee_beta_{side}": ""},
            {"rotation1": (f"knee_beta_{side}", -Z, line(0.8, 0.1)),
             "translation1": ("", X, constant(0.05))},
            at=((0.0, -0.38, 0), (0, 0, 0)),
        )  # fmt: skip
        hinges += [
            ball(f"hip_{side}", "pelvis", f"femur_{side}", (-0.07, -0.06, 0.08 * sign), sign,
                 [f"hip_{n}_{side}" for n in ("flexion", "adduction", "rotation")]),
            knee,
            kneecap,
            pin(f"ankle_angle_{side}", f"tibia_{side}", f"foot_{side}", clamped(-0.7, 0.5),
                at=((0, -0.41, 0), (0.17, sign * 0.11, 0)), to=((0, 0, 0), (0.17, sign * 0.11, 0))),
            ball(f"shoulder_{side}", "torso", f"humerus_{side}", (0.003, 0.37, 0.17 * sign), sign,
                 [f"arm_{n}_{side}" for n in ("flex", "add", "rot")]),
            pin(f"elbow_flex_{side}", f"humerus_{side}", f"hand_{side}", clamped(0, 2.6),
                at=((0.01, -0.29, 0), (0, 0, 0)), to=((0, 0, 0), (0, 0, 0))),
        ]  # fmt: skip
    more = element("gravity", "0 -9.81 0")
    more += element(
        "ForceSet",
        element(
            "objects", element("CoordinateActuator", element("coordinate", "elbow_flex_r"), "a")
        ),
    )
    couplers = "".join(
        element(
            "CoordinateCouplerConstraint",
            element("coupled_coordinates_function", line(1.0))
            + element("independent_coordinate_names", f"knee_angle_{side}")
            + element("dependent_coordinate_name", f"knee_beta_{side}"),
            f"kneecap_{side}",
        )
        for side in "rl"
    )
    more += element("ConstraintSet", element("objects", couplers))
    text: str = write(bones, hinges, more)
    return text


@needs_opensim
@pytest.mark.parametrize("write", [version_3, version_4])
def test_a_whole_body_is_that_of_opensim_with_its_curves_held(write: Any, tmp_path: Path) -> None:
    model, answer = against_opensim(tmp_path, acrobat(write), hold=True, count=10)
    assert model.free
    assert model.mass == pytest.approx(11.2 + 30.1 + 2 * (8.9 + 3.6 + 0.08 + 1.4 + 2 + 1.6))
    names = {joint.name for joint in model.joints}
    assert names >= {"hip_flexion_r", "knee_angle_l", "lumbar_rotation", "elbow_flex_l"}
    for name in names & set(answer["coordinates"]):
        joint, there = model.joint(name), answer["coordinates"][name]
        if joint.follows is None:
            assert joint.limits == (tuple(there["range"]) if there["clamped"] else None)
            assert joint.reference == there["default"]
    for side in "rl":
        follow = model.joint(f"knee_beta_{side}_rotation1").follows
        assert follow == so.model.Follow(f"knee_angle_{side}", 0.8, 0.1)


def test_an_acrobat_flies_and_its_pairs_are_found(tmp_path: Path) -> None:
    model = so.load(read(tmp_path, acrobat(version_4)), axes=(3, 1, 2))
    takeoff = so.Takeoff(spin=6.0, joints=so.prescribed(
        model, so.Motion.moves(model, {"arm_flex_r": [(0.0, 0.0), (0.4, 1.2)]})))  # fmt: skip
    flight = so.fly(model, takeoff, 0.8)
    assert flight.momentum_drift < 1e-9


@needs_opensim
def test_functions_are_those_of_opensim(tmp_path: Path) -> None:
    # Held at several defaults, a curve's value is where the body stands.
    x, y = [-1.0, -0.2, 0.5, 1.1, 1.9, 2.5], [0.3, -0.1, 0.2, 0.5, 0.1, 0.05]
    gcv = element("GCVSpline", element("half_order", "3") + element("error_variance", "0")
                  + element("x", numbers(x)) + element("weights", numbers([1] * 6))
                  + element("y", numbers(y)))  # fmt: skip
    functions = {
        "simm": spline(x, y),
        "three": spline(x[:3], y[:3]),
        "pieces": spline(x, y, "PiecewiseLinearFunction"),
        "gcv": gcv,
        "cubic": element("PolynomialFunction", element("coefficients", "0.3 -0.2 0.1 0.05")),
        "scaled": element("MultiplierFunction", element("function", spline(x, y))
                          + element("scale", "1.7")),
    }  # fmt: skip
    cases, requests = [], []
    for name, function in functions.items():
        for default in (-1.4, -0.6, 0.8, 2.2, 2.9):
            if name == "gcv" and not x[0] < default < x[-1]:
                continue  # beyond its points OpenSim's own is wild
            hinge = custom("leg", "hips", rotation1=("q", Z, line(1.0)),
                           translation2=("q", Y, function))  # fmt: skip
            hinge.coordinates["q"] = element("default_value", repr(default))
            file = f"{name}{default}.osim"
            model = read(tmp_path, version_4([HIPS, LEG], [six("hips"), hinge]), file)
            pose = poses(model, np.random.default_rng(0), 1)
            cases.append((model, pose))
            requests.append({"file": str(tmp_path / file), "hold": True, "poses": pose})
    for case, answer in zip(cases, in_opensim(requests), strict=True):
        assert_same(*case, answer)


@needs_opensim
def test_joints_written_from_the_other_end(tmp_path: Path) -> None:
    """The ground as a child, and a joint whose child carries its parent."""
    six_names = {f"x{k}": "" for k in range(6)}
    hinges = [
        Hinge("FreeJoint", "base", "hips", "ground", six_names, at=((0.1, 0, 0), (0.2, 0.3, 0))),
        Hinge("UniversalJoint", "hip", "leg", "hips", {"a": "", "b": ""},
              at=((0, 0.1, 0.2), (0.3, 0, 0)), to=((0, -0.1, 0), (0, 0.4, 0))),
    ]  # fmt: skip
    model, _ = against_opensim(tmp_path, version_4([HIPS, LEG], hinges))
    assert model.free
    assert [joint.name for joint in model.joints] == ["b", "a"]
    text = version_3(
        [HIPS, LEG], [six("hips"), pin("q", "hips", "leg", at=((0, -1, 0), (1, 0, 0)))]
    )
    against_opensim(tmp_path, text.replace("<reverse>false", "<reverse>true", 2))


@needs_opensim
def test_a_model_of_opensim_2(tmp_path: Path) -> None:
    knee = pin("q", "hips", "leg", at=((0, -0.1, 0), (0.1, 0.2, 0.3)))
    against_opensim(tmp_path, version_3([HIPS, LEG], [six("hips"), knee], version=20302))


@needs_opensim
def test_a_body_without_a_joint_is_free(tmp_path: Path) -> None:
    model, answer = against_opensim(tmp_path, version_4([LEG, HIPS], [pin("q", "hips", "leg")]))
    assert model.free
    assert model.bodies[0].name == "hips"
    root = [joint.name for body in model.file_coordinates.root for joint in body.joints]
    assert set(root) <= set(answer["coordinates"])


@needs_opensim
def test_frames_offset_from_frames_and_paths_of_all_kinds(tmp_path: Path) -> None:
    text = version_4([HIPS, LEG], [six("hips"), pin("q", "hips", "leg")])
    within = element(
        "components",
        element(
            "PhysicalOffsetFrame",
            element("socket_parent", "..") + element("translation", "0.1 0.2 0.3")
            + element("orientation", "0.4 0.5 0.6"),
            "socket",
        ),
    )  # fmt: skip
    start = text.index('<Body name="hips">') + len('<Body name="hips">')
    text = text[:start] + within + text[start:]
    offset = 'name="hips_offset"><socket_parent>/bodyset/hips<'
    assert text.count(offset) == 2
    last = text.rindex(offset)
    path = offset.replace("/bodyset/hips<", "../../../bodyset/hips/socket<")
    text = text[:last] + path + text[last + len(offset) :]
    model, _ = against_opensim(tmp_path, text)
    assert model.bodies[1].position == pytest.approx((0.1, 0.2, 0.3))


@needs_opensim
def test_rates_follow_positions_where_opensim_has_them_otherwise(tmp_path: Path) -> None:
    """A constant turn between two that vary: OpenSim 4.6 forgets it in its velocities."""
    hinge = custom("leg", "hips", rotation1=("a", X, line(1.0)),
                   rotation2=("", Y, constant(0.4)), rotation3=("b", Z, line(1.0)))  # fmt: skip
    text = version_4([HIPS, LEG], [six("hips"), hinge])
    with pytest.raises(AssertionError, match=r"rtol=0, atol"):
        against_opensim(tmp_path, text)
    model = read(tmp_path, text)
    pose = {"a": 0.3, "b": 0.5}
    steps = [pose | {"b": pose["b"] + step} for step in (0.0, 1e-6, -1e-6)]
    path = str(tmp_path / "model.osim")
    theirs = in_opensim([{"file": path, "hold": False, "poses": steps}])[0]["poses"]
    for step, there in zip(steps, theirs, strict=True):
        turn = body_frames(model, [step[joint.name] for joint in model.joints])[0][1]
        np.testing.assert_allclose(turn, np.array(there["frames"]["leg"])[:, :3], atol=1e-12)
    turns = [np.array(there["frames"]["leg"])[:, :3] for there in theirs]
    moved = (turns[1] - turns[2]) / 2e-6 @ turns[0].T
    speed = next(k for k, rates in enumerate(theirs[0]["rates"]) if rates["b"] == 1.0)
    said = theirs[0]["motions"][speed]["leg"][:3]
    assert np.abs(np.array([moved[2, 1], moved[0, 2], moved[1, 0]]) - said).max() > 0.01


# -------------------------------------------------------------------------- what is meant


def test_a_coordinate_of_several_axes_leads_the_first(tmp_path: Path) -> None:
    hinge = custom(
        "leg", "hips", rotation1=("q", Z, line(-1.0, 0.1)), rotation2=("q", X, line(0.5, 0.2)),
        translation1=("q", Y, line(0.03)),
    )  # fmt: skip
    hinge.coordinates["q"] = element("default_value", "0.4")
    model, said = noted(tmp_path, version_4([HIPS, LEG], [six("hips"), hinge]))
    by_name = {joint.name: joint for joint in model.joints}
    assert set(by_name) == {"q", "q_rotation2", "q_translation1"}
    # In the body's axes, which the second axis turns by 0.5 · 0.4 + 0.2 in the default pose.
    assert by_name["q"].axis == pytest.approx((0, -np.sin(0.4), -np.cos(0.4)))
    assert by_name["q"].follows is None
    assert by_name["q"].reference == 0.4
    assert by_name["q_rotation2"].follows == so.model.Follow("q", 0.5, 0.2)
    assert by_name["q_translation1"].follows == so.model.Follow("q", 0.03, 0.0)
    assert model.home == pytest.approx([0.012, 0.4, 0.4])
    assert said == []


def test_a_coordinate_that_is_no_angle_leads_a_joint_of_another_name(tmp_path: Path) -> None:
    hinge = custom("leg", "hips", rotation1=("q", Z, line(0.25, 0.1)))
    more = element("ForceSet", element("objects", element(
        "SpringGeneralizedForce", element("coordinate", "q") + element("stiffness", "2")
        + element("rest_length", "0.6") + element("viscosity", "0.5"), "spring")))  # fmt: skip
    model, said = noted(tmp_path, version_4([HIPS, LEG], [six("hips"), hinge], more))
    joint = model.joint("q_rotation1")
    assert model.file_coordinates.gears == (("q", so.model.Follow("q_rotation1", 0.25, 0.1)),)
    assert joint.stiffness == pytest.approx(32)  # 2 N m/rad of q, which turns four times as far
    assert joint.rest == pytest.approx(0.25 * 0.6 + 0.1)
    assert joint.damping == pytest.approx(8)
    assert said == [
        "model.osim: joints whose value is only proportional to the file's coordinate: "
        "q_rotation1 (0.25 q)"
    ]


def test_coordinates_that_are_coupled_in_a_row_follow_the_first(tmp_path: Path) -> None:
    def coupler(name: str, by: str, function: str, more: str = "") -> str:
        return element(
            "CoordinateCouplerConstraint",
            element("coupled_coordinates_function", function)
            + element("independent_coordinate_names", by)
            + element("dependent_coordinate_name", name) + more,
            f"{name}_by_{by}",
        )  # fmt: skip

    hinges = [six("hips"), pin("a", "hips", "leg"), pin("b", "leg", "shank"),
              pin("c", "shank", "foot"), pin("d", "foot", "toes")]  # fmt: skip
    bones = [HIPS, LEG, SHANK, Bone("foot"), Bone("toes")]
    hinges[1].coordinates["a"] = element("default_value", "0.3")
    rules = coupler("b", "a", line(2.0, 0.1))
    rules += coupler("c", "b", spline([0, 1], [0.2, -0.3]), element("scale_factor", "2"))
    rules += coupler("d", "a", line(9.0), element("isEnforced", "false"))
    text = version_4(bones, hinges, element("ConstraintSet", element("objects", rules)))
    model, said = noted(tmp_path, text)
    assert model.joint("b").follows == so.model.Follow("a", 2.0, 0.1)
    follow = model.joint("c").follows  # 2 (0.2 - 0.5 b) with b = 2 a + 0.1
    assert follow is not None
    assert (follow.leader, follow.factor, follow.offset) == ("a", -2.0, pytest.approx(0.3))
    assert model.joint("d").follows is None
    assert model.home == pytest.approx([0.3, 0.7, -0.3, 0.0])
    assert said == []
    with pytest.raises(SomersaultError, match="mimics itself"):
        read(tmp_path, text.replace("independent_coordinate_names>a<",
                                    "independent_coordinate_names>c<", 1))  # fmt: skip


def test_curves_are_held_and_how_far_they_go_is_said(tmp_path: Path) -> None:
    x = [0.0, 0.5, 1.0, 1.5, 2.0]
    cubic = [0.01 * q**3 for q in x]  # which a spline of OpenSim's kind gives exactly
    pieces = spline(x, [q**2 * 0.1 for q in x], "PiecewiseLinearFunction")
    hinge = custom("leg", "hips", rotation1=("q", Z, line(1.0)), rotation2=("q", Y, pieces),
                   translation1=("q", X, spline(x, cubic)))  # fmt: skip
    hinge.coordinates["q"] = element("default_value", "1") + element("range", "0 1.75")
    model, said = noted(tmp_path, version_4([HIPS, LEG], [six("hips"), hinge]))
    assert [joint.name for joint in model.joints] == ["q"]
    far = 0.1 * ((2.25 + 4) / 2) - 0.1, 0.01 * (1.75**3 - 1)
    assert said == [
        "model.osim: held where the default pose has them, as lines are carried and curves are "
        f"not: leg_joint (at most {far[0]:.3g} rad and {far[1]:.3g} m off)"
    ]


def test_points_on_a_line_are_a_line(tmp_path: Path) -> None:
    for kind in ("SimmSpline", "PiecewiseLinearFunction", "NaturalCubicSpline"):
        function = spline([-1.7, 0.1, 2.0], [-1.7, 0.1, 2.0], kind)
        hinge = custom("leg", "hips", rotation1=("q", Z, function))
        model, said = noted(tmp_path, version_4([HIPS, LEG], [six("hips"), hinge]))
        assert [joint.name for joint in model.joints] == ["q"]
        assert said == []


def test_springs_on_one_coordinate_add_up(tmp_path: Path) -> None:
    def spring(k: float, rest: float, b: float, more: str = "") -> str:
        return element(
            "SpringGeneralizedForce",
            element("coordinate", "/jointset/q_joint/q") + element("stiffness", repr(k))
            + element("rest_length", repr(rest)) + element("viscosity", repr(b)) + more,
        )  # fmt: skip

    forces = spring(3.0, 0.2, 0.1) + spring(1.0, -0.2, 0.3)
    forces += spring(50.0, 1.0, 9.0, element("appliesForce", "false"))
    more = element("ForceSet", element("objects", forces))
    model = read(tmp_path, version_4([HIPS, LEG], [six("hips"), pin("q", "hips", "leg")], more))
    joint = model.joint("q")
    assert (joint.stiffness, joint.rest, joint.damping) == pytest.approx((4.0, 0.1, 0.4))


def test_only_ranges_that_are_kept_are_limits(tmp_path: Path) -> None:
    ranged = element("range", "-0.5 1.5")
    for more, limits in ((ranged, None), (ranged + element("clamped", "true"), (-0.5, 1.5))):
        text = version_4([HIPS, LEG], [six("hips"), pin("q", "hips", "leg", more)])
        assert read(tmp_path, text).joint("q").limits == limits


def test_defaults_of_the_file_hold_for_what_is_left_out(tmp_path: Path) -> None:
    default = element("range", "-0.5 1.5") + element("clamped", "true")
    more = element("defaults", element("Coordinate", default, "default"))
    text = version_4([HIPS, LEG], [six("hips"), pin("q", "hips", "leg")], more)
    assert read(tmp_path, text).joint("q").limits == (-0.5, 1.5)


def test_what_acts_and_what_does_not_is_said(tmp_path: Path) -> None:
    forces = [
        "Thelen2003Muscle", "Millard2012EquilibriumMuscle", "HuntCrossleyForce",
        "CoordinateActuator", "BushingForce", "CoordinateLimitForce", "Blankevoort1991Ligament",
    ]  # fmt: skip
    objects = "".join(element(kind, "", f"f{k}") for k, kind in enumerate(forces))
    more = element("gravity", "0 -9.8 0") + element("ForceSet", element("objects", objects))
    more += element("ConstraintSet", element("objects", element("WeldConstraint", "", "shut")))
    more += element("MarkerSet", element("objects", element("Marker", "", "m") * 3))
    locked = pin("q", "hips", "leg", element("locked", "true"))
    model, said = noted(tmp_path, version_4([HIPS, LEG], [six("hips"), locked], more))
    assert model.ignored == ("gravity", "3 markers")
    assert said == [
        "model.osim: acting in the file, but left out of flights: 2 muscles, 1 contact force, "
        "1 actuator, 1 BushingForce, 1 joint limit force, 1 ligament, 1 constraint (shut)",
        "model.osim: locked in the file, and here at their default values unless a flight moves "
        "them: q",
        "model.osim: left out, as they have no part in flight: gravity, 3 markers",
    ]


def test_two_coordinates_of_one_name_are_told_apart(tmp_path: Path) -> None:
    hinges = [
        six("hips"),
        pin("q", "hips", "leg"),
        Hinge("PinJoint", "knee", "leg", "shank", {"q": ""}),
    ]
    model = read(tmp_path, version_4([HIPS, LEG, SHANK], hinges))
    assert [joint.name for joint in model.joints] == ["q_joint_q", "knee_q"]


def test_sockets_as_versions_between_three_and_four_wrote_them(tmp_path: Path) -> None:
    text = version_4([HIPS, LEG], [six("hips"), Q])
    wanted = read(tmp_path, text)
    named = re.sub("socket_(parent_frame|child_frame|parent)>", r"socket_\1_connectee_name>", text)
    assert read(tmp_path, named) == wanted
    connector = (
        r'<connectors><Connector_PhysicalFrame_ name="\1"><connectee_name>\2</connectee_name>'
        r"</Connector_PhysicalFrame_></connectors>"
    )
    old = re.sub(r"<socket_(parent)>([^<]*)</socket_parent>", connector, text)
    assert read(tmp_path, old) == wanted


def test_a_planar_root_is_held_if_asked_and_a_fixed_one_stays_on_the_ground(
    tmp_path: Path,
) -> None:
    planar = Hinge("PlanarJoint", "root", "ground", "hips", dict.fromkeys(("tilt", "tx", "ty"), ""))
    text = version_4([HIPS, LEG], [planar, pin("q", "hips", "leg")])
    read(tmp_path, text)
    model = so.load(tmp_path / "model.osim", base="fixed")
    assert not model.free
    assert [joint.name for joint in model.joints] == ["tx", "ty", "tilt", "q"]
    fixed = Hinge("WeldJoint", "root", "ground", "hips")
    model = read(tmp_path, version_4([HIPS, LEG], [fixed, pin("q", "hips", "leg")]))
    assert not model.free
    assert model.mass == LEG.mass
    assert model.ignored == ("body hips, fixed to the ground",)


def test_what_opensim_forgives_is_forgiven(tmp_path: Path) -> None:
    text = version_4([HIPS, LEG], [six("hips"), pin("q", "hips", "leg")])
    odd = "<!-- -- <!--a--><credits>Müller & Söhne</credits>"
    odd += '<HuntCrossleyForce::ContactParametersSet name="x"/>'
    odd_text = text.replace("<BodySet", odd + "<BodySet")
    wanted = read(tmp_path, text)
    assert read(tmp_path, odd_text.encode("utf-8")) == wanted
    assert read(tmp_path, odd_text.encode("latin-1")) == wanted


# ------------------------------------------------------------------------------- mistakes

Q = pin("q", "hips", "leg")
GOOD = version_4([HIPS, LEG], [six("hips"), Q])


def changed(old: str, new: str, text: str = GOOD) -> str:
    assert old in text
    return text.replace(old, new, 1)


MISTAKES = {
    "no XML": ("hello", "is not XML"),
    "cut off": (GOOD[:-40], "is not XML"),
    "entities": ('<!DOCTYPE x [<!ENTITY a "b">]>' + GOOD.partition("\n")[2], "declares the entity"),
    "no model": ("<OpenSimDocument/>", "has no Model element"),
    "nothing": (document("", 40000), "nothing in it moves"),
    "no mass": (changed("<mass>12</mass>", ""), "Body 'hips' has no mass; give it one"),
    "word": (changed("<mass>12<", "<mass>heavy<"), "mass of Body 'hips' is 'heavy', which is not"),
    "nan": (changed("<mass>12<", "<mass>nan<"), "which is not a finite number"),
    "large": (changed("<mass>12<", "<mass>1e300<"), "which is not a finite number"),
    "negative": (changed("<mass>12<", "<mass>-12<"), "the negative mass -12"),
    "two numbers": (changed("<mass_center>0.01 0.02 0.0<", "<mass_center>0 1<"), "not 3 finite"),
    "kind": (GOOD.replace("PinJoint", "ScapulothoracicJoint"), "of a kind that is not supported"),
    "no socket": (changed("socket_parent_frame>ground_offset</socket_parent_frame", "a/"),
                  "has no socket_parent_frame"),
    "no frame": (changed(">ground_offset<", ">floor<"), "frame 'floor', of which there are 0"),
    "itself": (changed("<socket_parent>/ground<", "<socket_parent>../ground_offset<"),
               "is offset from itself"),
    "another file": (changed('<BodySet name="bodyset">', '<BodySet file="/etc/passwd">'),
                     "is in another file, '/etc/passwd'"),
    "same name": (GOOD.replace('<Body name="leg"', '<Body name="hips"'), "or that of another body"),
    "loop": (version_4([HIPS, LEG], [six("hips"), Q, pin("r", "ground", "leg")]), "cut the loop"),
    "two trees": (version_4([HIPS, LEG], [six("hips"), pin("r", "ground", "leg")]),
                  "not part of the free body"),
    "coordinates": (version_4([HIPS], [Hinge("WeldJoint", "w", "ground", "hips", {"q": ""})]),
                    "has 1 coordinates, and its kind has 0"),
    "range": (changed('<Coordinate name="q"></C',
                      '<Coordinate name="q"><range>2 1</range><clamped>true</clamped></C'),
              "a range from 2 down to 1"),
    "axis": (version_4([HIPS], [custom("hips", rotation1=("q", (0, 0, 0), line(1.0)))]),
             "an axis of length zero"),
    "same axes": (version_4([HIPS], [custom("hips", rotation1=("q", Z, line(1.0)),
                                            rotation3=("", Z, constant(0.0)))]),
                  "rotation1 and rotation3 about the same axis"),
    "two at once": (version_4([HIPS], [custom("hips", rotation1=("q r", X, line(1.0)))]),
                    "moved by 2 coordinates at once, q and r"),
    "no coordinate": (version_4([HIPS], [custom("hips", rotation1=("", X, line(1.0)))]),
                      "a function but no coordinate"),
    "function": (version_4([HIPS], [custom("hips", rotation1=("q", X, element("Sine", "")))]),
                 "Sine is a function that is not supported"),
    "points": (version_4([HIPS], [custom("hips", rotation1=("q", X, spline([1, 0], [0, 1])))]),
               "two or more points with increasing x"),
    "smoothed": (version_4([HIPS], [custom("hips", rotation1=("q", X, spline(
        [0, 1], [0, 1], "GCVSpline").replace("<x>", "<error_variance>1</error_variance><x>")))]),
                 "smooths its points"),
    "spring": (version_4([HIPS], [six("hips")], element("ForceSet", element("objects", element(
        "SpringGeneralizedForce", element("coordinate", "knee"))))), "acts on 'knee'"),
    "massless": (version_4([HIPS, Bone("leg", 0.0)], [six("hips"), Q]), "moves no mass"),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_named(mistake: str, tmp_path: Path) -> None:
    text, words = MISTAKES[mistake]
    with pytest.raises(SomersaultError, match=re.escape(words)) as caught:
        read(tmp_path, text)
    assert str(caught.value).startswith("model")
    assert "\n" not in str(caught.value)


def test_files_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(SomersaultError, match="more than 100 levels"):
        read(tmp_path, "<a>" * 1000)
    with pytest.raises(SomersaultError, match="larger than 50 MB"):
        read(tmp_path, b" " * (50 * 2**20 + 1))
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe.osim")
        with pytest.raises(SomersaultError, match="no model file"):
            so.load(tmp_path / "pipe.osim")


SCRAPS = ["1e400", "nan", "-", "<a>", "</Body>", "<!--", "&", "\0", "é", "/>", "0", '"', "ground"]
ACROBAT = acrobat(version_4)
words = st.sampled_from([*SCRAPS, *re.findall(r"[^<>\s]+", ACROBAT)[:200]])


@settings(derandomize=True, max_examples=150, deadline=None)
@given(
    changes=st.lists(
        st.tuples(st.integers(0, len(ACROBAT)), st.integers(0, 30), words), min_size=1, max_size=4
    )
)
def test_no_damage_to_a_file_escapes_as_another_error(
    changes: list[tuple[int, int, str]], tmp_path_factory: pytest.TempPathFactory
) -> None:
    text = ACROBAT
    for start, length, word in changes:
        text = text[:start] + word + text[start + length :]
    with contextlib.suppress(SomersaultError):
        assert np.isfinite(read(tmp_path_factory.getbasetemp(), text).mass)


@settings(derandomize=True, max_examples=100, deadline=None)
@given(data=st.one_of(st.binary(), st.text(string.printable).map(str.encode)), header=st.booleans())
def test_no_garbage_escapes_as_another_error(
    data: bytes, header: bool, tmp_path_factory: pytest.TempPathFactory
) -> None:
    with pytest.raises(SomersaultError):
        read(tmp_path_factory.getbasetemp(), b"<OpenSimDocument><Model>" * header + data)
