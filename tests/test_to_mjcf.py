"""A model written as MJCF and read back is the same model; its plain form says when two are."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from shares import every
from test_athlete import MEASURED
from trees import drawn, random_state

import somersault as so
from somersault.attitude import matrix_from_quaternion
from somersault.model import (
    GROUND,
    Model,
    body_frames,
    mjcf,
    model_digest,
    model_shapes,
    plain_form,
    write_mjcf,
)
from somersault.model._mass import mass_matrix
from somersault.model.shapes import Box, Capsule, Cylinder, Ellipsoid, Mesh, Sphere

ZERO = (0.0, 0.0, 0.0)
BRICK = ((2e-3, 0.0, 0.0), (0.0, 3e-3, 0.0), (0.0, 0.0, 2e-3))


def read_back(model: Model, folder: Path) -> Model:
    write_mjcf(model, folder / f"{model.name}.xml")
    return so.load(folder / f"{model.name}.xml", model.axes if model.free else None)


def check_same(model: Model, back: Model) -> None:
    """Joints to the digit; frames, masses and mass matrices to rounding."""
    assert (back.name, back.free, back.axes) == (model.name, model.free, model.axes)
    assert sorted(back.coordinates) == sorted(model.coordinates)
    for joint in model.joints:
        again = back.joint(joint.name)
        follows = again.follows and replace(again.follows, offset=round(again.follows.offset, 12))
        assert replace(again, axis=joint.axis, follows=follows) == joint
        np.testing.assert_allclose(again.axis, joint.axis, atol=1e-15)  # normalised again
    rng = np.random.default_rng(6)
    for _ in range(3):
        state = random_state(model, rng)
        theirs, speeds = np.empty(len(back.coordinates)), np.empty(len(back.speeds), int)
        for joint in model.joints:
            own = model.coordinate_slice(joint.name)
            theirs[back.coordinate_slice(joint.name)] = state.q[own]
            at = np.arange(len(model.speeds))[model.speed_slice(joint.name)]
            speeds[back.speed_slice(joint.name)] = at
        ahead = 6 * model.free
        order = np.concatenate([np.arange(ahead), ahead + speeds])
        wanted = mass_matrix(model, state.q)[np.ix_(order, order)]
        found = mass_matrix(back, theirs)
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-12 * np.abs(wanted).max())
        names = [body.name for body in model.bodies]
        for parts, again in zip(
            body_frames(model, state.q), body_frames(back, theirs), strict=True
        ):
            place = [names.index(body.name) for body in back.bodies]
            np.testing.assert_allclose(again, parts[place], rtol=0, atol=1e-13)


@pytest.mark.parametrize("number", every(range(30), 5))
def test_random_trees_come_back(number: int, tmp_path: Path) -> None:
    model, _, _ = drawn(number)
    check_same(model, read_back(model, tmp_path))


@pytest.mark.parametrize("name", so.shipped())
def test_shipped_models_come_back_with_their_shapes(name: str, tmp_path: Path) -> None:
    model = so.load(name)
    back = read_back(model, tmp_path)
    check_same(model, back)
    for one, other in zip(model_shapes(model), model_shapes(back), strict=True):
        assert [(s.kind, s.sizes, s.color) for s in one] == [
            (s.kind, s.sizes, s.color) for s in other
        ]
        for shape, again in zip(one, other, strict=True):
            seen, wanted = again.triangles.vertices, shape.triangles.vertices
            np.testing.assert_allclose(seen, wanted, atol=1e-12)


@pytest.mark.parametrize("shoulders", ["hinges", "ball"])
def test_an_athlete_comes_back(shoulders: str, tmp_path: Path) -> None:
    model = so.athlete(1.62, 57.0, "female", shoulders=shoulders, knees=True)
    back = read_back(model, tmp_path)
    check_same(model, back)
    assert [len(body.shapes) for body in back.bodies] == [len(b.shapes) for b in model.bodies]
    for one, other in zip(model.bodies, back.bodies, strict=True):
        for shape, again in zip(one.shapes, other.shapes, strict=True):
            np.testing.assert_allclose(
                np.sort(again.hull.points, 0), np.sort(shape.hull.points, 0), atol=1e-6
            )


def test_a_measured_athlete_comes_back(tmp_path: Path) -> None:
    model = so.athlete_from_measurements(MEASURED, mass=60.0, name="me")
    back = read_back(model, tmp_path)
    check_same(model, back)


def test_a_saved_athlete_flies_from_a_spec_as_itself(tmp_path: Path) -> None:
    model = so.athlete(1.7, 60.0)
    write_mjcf(model, tmp_path / "me.xml")
    back = so.load(tmp_path / "me.xml")
    takeoff = so.Takeoff(spin=7.0, tilt=0.05)
    one, other = (so.fly(body, takeoff, 1.0).landing for body in (model, back))
    np.testing.assert_allclose(other.quaternion, one.quaternion, rtol=0, atol=1e-9)


def test_what_a_joint_follows_comes_back(tmp_path: Path) -> None:
    model = following()
    back = read_back(model, tmp_path)
    check_same(model, back)
    m = mujoco.MjModel.from_xml_string(mjcf(model))
    coupling = [0.1 + 2.0 * 0.5 - 0.75, 2.0, 0.0, 0.0, 0.0]  # MuJoCo's is from the references
    np.testing.assert_allclose(m.eq_data[0, :5], coupling, atol=1e-15)


def following() -> Model:
    lead = so.Joint("a", "hinge", reference=0.5)
    geared = so.Joint("b", "hinge", reference=0.75, follows=so.model.Follow("a", 2.0, 0.1))
    return Model(
        "geared", True,
        (
            so.Body("base", GROUND, 1.0, ZERO, BRICK),
            so.Body("one", 0, 1.0, ZERO, BRICK, joints=(lead,)),
            so.Body("two", 1, 1.0, ZERO, BRICK, joints=(geared,)),
        ),
    )  # fmt: skip


def test_every_kind_of_shape_is_written(tmp_path: Path) -> None:
    turn = matrix_from_quaternion([0.8, 0.6, 0.0, 0.0])
    pose = {"position": (0.1, 0.2, 0.3), "rotation": tuple(map(tuple, turn.tolist()))}
    points = np.array([[0, 0, 0], [0.3, 0, 0], [0, 0.2, 0], [0, 0, 0.4]])
    shapes = (
        Sphere(radius=0.1, color=(0.1, 0.2, 0.3, 0.5)),
        Capsule(radius=0.1, half_length=0.3, **pose),
        Cylinder(radius=0.1, half_length=0.3, **pose),
        Box(half_sizes=(0.1, 0.2, 0.3), **pose),
        Ellipsoid(semi_axes=(0.1, 0.2, 0.3), **pose),
        Mesh(vertices=points, faces=[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], **pose),
        Mesh(vertices=points, faces=[[0, 2, 1], [0, 1, 3]]),  # open
    )
    model = Model("all", True, (so.Body("base", GROUND, 1.0, ZERO, BRICK, shapes=shapes),))
    back = read_back(model, tmp_path)
    assert back.mass == 1.0  # shapes weigh nothing
    again = back.bodies[0].shapes
    assert [shape.kind for shape in again] == [shape.kind for shape in shapes]
    assert again[0].color == pytest.approx((0.1, 0.2, 0.3, 0.5), abs=1e-7)
    for shape, other in zip(shapes, again, strict=True):
        one, two = (np.ptp(s.triangles.vertices, axis=0) for s in (shape, other))
        np.testing.assert_allclose(two, one, atol=1e-6)


# ------------------------------------------------------------------- hard cases and mistakes


def test_names_that_mean_something_in_xml(tmp_path: Path) -> None:
    name = 'a <b> & "c" é'
    body = so.Body(name, GROUND, 1.0, ZERO, BRICK)
    arm = so.Body("arm<", 0, 1.0, ZERO, BRICK, joints=(so.Joint(name, "hinge"),))
    back = read_back(Model("odd", True, (body, arm)), tmp_path)
    assert [b.name for b in back.bodies] == [name, "arm<"]
    assert back.coordinates == (name,)


def test_rods_points_and_what_has_no_mass(tmp_path: Path) -> None:
    rod = ((0.1, 0.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 0.0))
    turn = matrix_from_quaternion([0.5, 0.5, -0.5, 0.5]) @ matrix_from_quaternion(
        [np.cos(0.4), np.sin(0.4), 0.0, 0.0]
    )
    turned = turn @ np.array(rod) @ turn.T
    plate = ((0.1, 0.0, 0.0), (0.0, 0.2, 0.0), (0.0, 0.0, 0.1 + 0.2))
    nothing = ((0.0,) * 3,) * 3
    bodies = [
        so.Body("rod", GROUND, 1.0, ZERO, tuple(map(tuple, ((turned + turned.T) / 2).tolist()))),
        so.Body("plate", 0, 1.0, ZERO, plate, joints=(so.Joint("a", "hinge"),)),
        so.Body(
            "point", 1, 1.0, (0.0, 0.3, 0.4), nothing, (0, 0, 1.0), joints=(so.Joint("b", "hinge"),)
        ),
        so.Body("none", 0, 0.0, ZERO, nothing, joints=(so.Joint("c", "hinge", limits=(0.0, 0.0)),)),
        so.Body("end", 3, 1.0, ZERO, BRICK, (0, 0, 1.0), joints=(so.Joint("d", "slide"),)),
    ]
    model = Model("thin", True, tuple(bodies))
    back = read_back(model, tmp_path)
    assert back.joint("c").limits == (0.0, pytest.approx(0.0, abs=1e-300))
    wanted = mass_matrix(model, model.home)
    np.testing.assert_allclose(mass_matrix(back, model.home), wanted, atol=1e-12)


def test_what_cannot_be_written_is_said_in_a_sentence(tmp_path: Path) -> None:
    world = Model("a", True, (so.Body("world", GROUND, 1.0, ZERO, BRICK),))
    with pytest.raises(so.SomersaultError, match=r"a cannot be written as MJCF.*world"):
        mjcf(world)
    with pytest.raises(so.SomersaultError, match=r"another ending than \.xml or \.mjcf"):
        write_mjcf(so.load("doll"), tmp_path / "doll.urdf")
    with pytest.raises(so.SomersaultError, match=r"must be a somersault\.Model"):
        write_mjcf("doll", tmp_path / "doll.xml")  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())


# ------------------------------------------------------------------------------ plain form


def test_the_plain_form_holds_what_decides_and_nothing_else() -> None:
    doll = so.load("doll")
    same = replace(
        doll.renamed("other"), ignored=("1 camera",),
        bodies=tuple(replace(body, shapes=()) for body in doll.bodies),
    )  # fmt: skip
    assert plain_form(same) == plain_form(doll)
    assert model_digest(same) == model_digest(doll)
    form = plain_form(doll)
    assert set(form) == {"free", "bodies"}  # what stands at its default is left out
    assert set(form["bodies"][1]) <= {
        "name", "parent", "mass", "com", "inertia", "position", "rotation", "joints",
    }  # fmt: skip


@pytest.mark.parametrize(
    "change",
    [
        {"name": "x"},
        {"limits": (0.0, 1.0)},
        {"stiffness": 1e-16},
        {"follows": so.model.Follow("left_shoulder")},
    ],
)
def test_the_plain_form_tells_joints_apart(change: dict) -> None:
    doll = so.load("doll")
    *before, last = doll.bodies
    joint = replace(last.joints[0], **change)
    other = replace(doll, bodies=(*before, replace(last, joints=(joint,))))
    assert model_digest(other) != model_digest(doll)
    assert model_digest(replace(doll, axes=(3, 1, 2))) != model_digest(doll)


def test_digests_stay_as_they_are() -> None:
    """Stores are known by them."""
    brick = Model("brick", True, (so.Body("brick", GROUND, 1.5, ZERO, BRICK),))
    assert plain_form(brick) == {
        "free": True,
        "bodies": [
            {
                "name": "brick", "parent": -1, "mass": 1.5, "com": [0.0, 0.0, 0.0],
                "inertia": [[2e-3, 0.0, 0.0], [0.0, 3e-3, 0.0], [0.0, 0.0, 2e-3]],
            }
        ],
    }  # fmt: skip
    assert model_digest(brick) == model_digest(replace(brick, name="b"))
    negative = replace(brick, bodies=(replace(brick.bodies[0], com=(-0.0, 0.0, 0.0)),))
    assert negative == brick
    assert model_digest(negative) == model_digest(brick)


def test_a_model_is_shown_in_a_line() -> None:
    assert repr(so.load("gymnast")) == "<Model 'gymnast': 8 bodies, 13 joints, 64 kg, free>"
    rod = so.Body("rod", GROUND, 1.0, ZERO, BRICK, joints=(so.Joint("a", "hinge"),))
    swung = Model("pendulum", False, (rod,))
    assert repr(swung) == "<Model 'pendulum': 1 body, 1 joint, 1 kg, on a fixed base>"
