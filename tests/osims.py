"""`.osim` texts in the dialects of OpenSim 3 and 4, and what OpenSim makes of them."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from trees import State, evaluated, random_inertia, unit

from somersault.dynamics import Equations
from somersault.model import Model, body_frames, centre_of_mass

AXES = [f"{kind}{number}" for kind in ("rotation", "translation") for number in (1, 2, 3)]
COUNTS = {
    "WeldJoint": 0, "PinJoint": 1, "SliderJoint": 1, "UniversalJoint": 2, "BallJoint": 3,
    "GimbalJoint": 3, "PlanarJoint": 3, "FreeJoint": 6,
}  # fmt: skip
needs_opensim = pytest.mark.skipif(
    find_spec("opensim") is None, reason="opensim, the reference reader, is optional"
)


# ------------------------------------------------------------------------------- to write


@dataclass(frozen=True)
class Bone:
    """A body of a text."""

    name: str
    mass: float = 1.0
    com: Sequence[float] = (0.0, 0.0, 0.0)
    inertia: Sequence[float] = (0.1, 0.1, 0.1, 0.0, 0.0, 0.0)  # xx, yy, zz, xy, xz, yz


@dataclass(frozen=True)
class Hinge:
    """A joint of a text: `at` and `to` are its places and angles in parent and child.

    `coordinates` are names, each with what stands in its element; `axes` those of a CustomJoint:
    coordinate, axis, and the function's element.
    """

    kind: str
    name: str
    parent: str
    child: str
    coordinates: dict[str, str] = field(default_factory=dict)
    axes: dict[str, tuple[str, Sequence[float], str]] = field(default_factory=dict)
    at: tuple[Sequence[float], Sequence[float]] = ((0, 0, 0), (0, 0, 0))
    to: tuple[Sequence[float], Sequence[float]] = ((0, 0, 0), (0, 0, 0))


def numbers(row: Any) -> str:
    return " ".join(repr(float(x)) for x in np.ravel(row))


def element(tag: str, content: str, name: str = "") -> str:
    return f'<{tag} name="{name}">{content}</{tag}>' if name else f"<{tag}>{content}</{tag}>"


def line(slope: float, offset: float = 0.0) -> str:
    return element("LinearFunction", element("coefficients", numbers([slope, offset])))


def constant(value: float) -> str:
    return element("Constant", element("value", numbers(value)))


def spline(x: Sequence[float], y: Sequence[float], kind: str = "SimmSpline") -> str:
    return element(kind, element("x", numbers(x)) + element("y", numbers(y)))


def document(content: str, version: int) -> str:
    text = element("Model", content, "model")
    return (
        f'<?xml version="1.0" encoding="UTF-8" ?>\n<OpenSimDocument Version="{version}">{text}'
        "</OpenSimDocument>\n"
    )


def version_4(bones: Sequence[Bone], hinges: Sequence[Hinge], more: str = "") -> str:
    bodies = "".join(
        element(
            "Body",
            element("mass", repr(bone.mass))
            + element("mass_center", numbers(bone.com))
            + element("inertia", numbers(bone.inertia)),
            bone.name,
        )
        for bone in bones
    )
    joints = "".join(map(_joint_4, hinges))
    sets = element("BodySet", element("objects", bodies), "bodyset")
    sets += element("JointSet", element("objects", joints), "jointset")
    return document(sets + more, 40000)


def _joint_4(hinge: Hinge) -> str:
    def frame(body: str, place: Any) -> str:
        path = "/ground" if body == "ground" else f"/bodyset/{body}"
        return element(
            "PhysicalOffsetFrame",
            element("socket_parent", path)
            + element("translation", numbers(place[0]))
            + element("orientation", numbers(place[1])),
            f"{body}_offset",
        )

    content = element("socket_parent_frame", f"{hinge.parent}_offset")
    content += element("socket_child_frame", f"{hinge.child}_offset")
    content += element("coordinates", _coordinates(hinge)) if hinge.coordinates else ""
    content += element("frames", frame(hinge.parent, hinge.at) + frame(hinge.child, hinge.to))
    if hinge.axes:
        content += element(
            "SpatialTransform",
            "".join(
                element(
                    "TransformAxis",
                    element("coordinates", by) + element("axis", numbers(axis)) + function,
                    name,
                )
                for name, (by, axis, function) in six_axes(hinge.axes).items()
            ),
        )
    return element(hinge.kind, content, hinge.name)


def six_axes(axes: dict[str, Any]) -> dict[str, Any]:
    """All axes of a CustomJoint: those that are left out do nothing, in any other direction."""
    found: dict[str, Any] = {}
    for three in (AXES[:3], AXES[3:]):
        given = [np.array(axes[name][1], float) for name in three if name in axes]
        for name in three:
            if name not in axes:
                others = (e for e in np.eye(3) if all(np.abs(e @ g) < 0.9 for g in given))
                given.append(next(others))
            found[name] = axes.get(name, ("", given[-1], constant(0.0)))
    return found


def _coordinates(hinge: Hinge) -> str:
    return "".join(element("Coordinate", more, name) for name, more in hinge.coordinates.items())


def version_3(
    bones: Sequence[Bone], hinges: Sequence[Hinge], more: str = "", version: int = 30000
) -> str:
    of = {hinge.child: hinge for hinge in hinges}
    bodies = element("Body", element("mass", "0"), "ground")
    for bone in bones:
        content = element("mass", repr(bone.mass)) + element("mass_center", numbers(bone.com))
        for which, value in zip(("xx", "yy", "zz", "xy", "xz", "yz"), bone.inertia, strict=True):
            content += element(f"inertia_{which}", repr(float(value)))
        content += element("Joint", _joint_3(of[bone.name]))
        bodies += element("Body", content, bone.name)
    return document(element("BodySet", element("objects", bodies)) + more, version)


def _joint_3(hinge: Hinge) -> str:
    content = element("parent_body", hinge.parent)
    content += element("location_in_parent", numbers(hinge.at[0]))
    content += element("orientation_in_parent", numbers(hinge.at[1]))
    content += element("location", numbers(hinge.to[0]))
    content += element("orientation", numbers(hinge.to[1]))
    content += element("CoordinateSet", element("objects", _coordinates(hinge)))
    content += element("reverse", "false")
    if hinge.axes:
        content += element(
            "SpatialTransform",
            "".join(
                element(
                    "TransformAxis",
                    element("coordinates", by)
                    + element("axis", numbers(axis))
                    + element("function", function),
                    name,
                )
                for name, (by, axis, function) in six_axes(hinge.axes).items()
            ),
        )
    return element(hinge.kind, content, hinge.name)


# --------------------------------------------------------------------------- random trees


def random_tree(rng: np.random.Generator) -> tuple[list[Bone], list[Hinge]]:
    """Two to six bodies on joints of all kinds; some without mass in the middle of a chain."""
    bones, hinges = [], []
    count = int(rng.integers(2, 7))
    for number in range(count):
        parent = "ground" if number == 0 else f"b{rng.integers(number)}"
        massless = 0 < number < count - 1 and rng.integers(4) == 0
        if massless:
            bones.append(Bone(f"b{number}", 0.0, rng.normal(size=3), (0,) * 6))
        else:
            mass = float(rng.uniform(0.5, 3))
            (xx, xy, xz), (_, yy, yz), (_, _, zz) = random_inertia(rng, mass)
            inertia = xx, yy, zz, xy, xz, yz
            bones.append(Bone(f"b{number}", mass, rng.normal(size=3) * 0.2, inertia))
        hinges.append(_random_joint(rng, number, parent, massless))
    # On a body without mass something heavy must hang.
    heavy = [Bone(f"h{n}", 1.0, (0.1, 0.2, 0.3)) for n, b in enumerate(bones) if b.mass == 0]
    for bone in heavy:
        hinges.append(
            Hinge("PinJoint", f"k{bone.name}", f"b{bone.name[1:]}", bone.name,
                  {f"q{bone.name}": ""}, at=_place(rng), to=_place(rng))
        )  # fmt: skip
    return [*bones, *heavy], hinges


def _random_joint(rng: np.random.Generator, number: int, parent: str, massless: bool) -> Hinge:
    kinds = ["PinJoint", "SliderJoint", "UniversalJoint"] if massless else [*COUNTS, "CustomJoint"]
    kind = str(rng.choice(kinds))
    if number == 0:
        kind = str(rng.choice(["FreeJoint", "FreeJoint", "CustomJoint", "PinJoint", "PlanarJoint"]))
    place = {"at": _place(rng), "to": _place(rng)}
    name, child = f"j{number}", f"b{number}"
    if kind == "CustomJoint":
        coordinates, axes = _random_axes(rng, number, six=number == 0)
        return Hinge(kind, name, parent, child, coordinates, axes, **place)
    names = [f"q{number}_{k}" for k in range(COUNTS[kind])]
    more = element("default_value", numbers(rng.normal() * 0.3)) * int(rng.integers(2))
    return Hinge(kind, name, parent, child, dict.fromkeys(names, more), **place)


def _random_axes(rng: np.random.Generator, number: int, six: bool) -> tuple[Any, Any]:
    """Turns and shifts by lines, some by one coordinate, about any independent axes."""
    coordinates: dict[str, str] = {}
    axes: dict[str, tuple[str, Sequence[float], str]] = {}
    rows = [_independent(rng), _independent(rng)]
    for place, name in enumerate(AXES):
        axis = rows[place // 3][place % 3]
        own = f"q{number}_{place}"
        sign = float(rng.choice([-1.0, 1.0]))
        choice = 0 if six or place == 0 else int(rng.integers(4))
        if choice == 0:
            coordinates[own] = element("default_value", numbers(rng.normal() * 0.3))
            axes[name] = own, axis, line(sign, 0.0 if six else 0.2 * float(rng.normal()))
        elif choice == 1:
            by = str(rng.choice(list(coordinates)))
            axes[name] = by, axis, line(float(rng.normal()), float(rng.normal()) * 0.1)
        else:
            # OpenSim's own rates are wrong where a constant turn stands between two that vary.
            turn = 0.0 if name == "rotation2" else float(rng.normal()) * 0.2
            axes[name] = "", axis, constant(turn)
    return coordinates, axes


def _independent(rng: np.random.Generator) -> np.ndarray:
    while True:
        rows = np.array([unit(rng, 3) for _ in range(3)])
        if rng.integers(2):
            rows = np.eye(3)[rng.permutation(3)]
        if abs(np.linalg.det(rows)) > 0.3:
            return rows


def _place(rng: np.random.Generator) -> tuple[Sequence[float], Sequence[float]]:
    if rng.integers(2):
        return (0, 0, 0), (0, 0, 0)
    return rng.normal(size=3) * 0.3, rng.normal(size=3)


# ------------------------------------------------------------------------------ to compare


def poses(model: Model, rng: np.random.Generator, count: int = 10) -> list[dict[str, float]]:
    """Random values of all joints, those that follow following, and of the base's."""
    found = []
    for _ in range(count):
        pose = {
            joint.name: joint.reference + (0.2 if joint.kind == "slide" else 1.0) * rng.normal()
            for joint in model.joints
            if joint.follows is None
        }
        for joint in model.joints:
            if joint.follows is not None:
                follow = joint.follows
                pose[joint.name] = follow.factor * pose[follow.leader] + follow.offset
        root = (joint for body in model.file_coordinates.root for joint in body.joints)
        found.append(pose | {joint.name: rng.normal() for joint in root})
    return found


def in_their_coordinates(model: Model, pose: dict[str, float]) -> dict[str, float]:
    """A pose with the file's coordinates where these are no joints."""
    gears = model.file_coordinates.gears
    return pose | {c: (pose[by.leader] - by.offset) / by.factor for c, by in gears}


def in_opensim(requests: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """What OpenSim answers, in a process of its own."""
    program = Path(__file__).with_name("opensim_reference.py")
    asked = subprocess.run(
        [sys.executable, str(program)], input=json.dumps(requests), capture_output=True, text=True,
        check=False, timeout=300,
    )  # fmt: skip
    assert asked.returncode == 0, asked.stderr
    answers: list[dict[str, Any]] = json.loads(asked.stdout)
    return answers


def assert_same(
    model: Model, given: list[dict[str, float]], theirs: dict[str, Any], tolerance: float = 1e-9
) -> None:
    """Mass, bodies' frames, centre of mass and mass matrix as OpenSim has them, in every pose."""
    assert "error" not in theirs, theirs
    assert model.mass == pytest.approx(theirs["mass"], abs=tolerance)
    equations = Equations(model)
    for pose, there in zip(given, theirs["poses"], strict=True):
        q = np.array([pose[joint.name] for joint in model.joints])
        base = np.vstack([there["frames"][model.bodies[0].name], [0, 0, 0, 1]])
        if not model.free:
            base = np.eye(4)
        turns, places = body_frames(model, q)
        for body, turn, place in zip(model.bodies, turns, places, strict=True):
            frame = base[:3, :3] @ turn, base[:3, :3] @ place + base[:3, 3]
            expected = np.array(there["frames"][body.name])
            np.testing.assert_allclose(np.column_stack(frame), expected, atol=tolerance)
        com = base[:3, :3] @ centre_of_mass(model, q) + base[:3, 3]
        np.testing.assert_allclose(com, there["com"], atol=tolerance)
        still = np.zeros(6 * model.free + len(q))
        state = State(np.array([1.0, 0, 0, 0]), q, still, np.zeros(len(q)), np.zeros(3))
        ours = evaluated(equations, state, state.v, False, ("mass_matrix",))["mass_matrix"]
        unit_speeds = zip(there["rates"], there["motions"], strict=True)
        speeds = np.array([_speeds(model, base[:3, :3], *unit) for unit in unit_speeds]).T
        expected = np.array(there["mass_matrix"])
        found = speeds.T @ ours @ speeds
        np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * np.abs(expected).max())


def _speeds(
    model: Model, turn: np.ndarray, rates: dict[str, float], motions: dict[str, list[float]]
) -> list[float]:
    """Our speeds where theirs give these rates of coordinates and motions of bodies."""
    speeds: list[float] = []
    if model.free:
        motion = np.array(motions[model.bodies[0].name]).reshape(2, 3)
        speeds += (motion @ turn).ravel().tolist()
    gears = {by.leader: by.factor * rates[c] for c, by in model.file_coordinates.gears}

    def rate(name: str) -> float:
        if name in rates or name in gears:
            return rates[name] if name in rates else gears[name]
        follow = model.joint(name).follows
        assert follow is not None
        return follow.factor * rate(follow.leader)

    return speeds + [rate(joint.name) for joint in model.joints]
