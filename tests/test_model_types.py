"""What a `Model` refuses to be, and what it says of itself."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import FrozenInstanceError, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from somersault import SomersaultError, SomersaultWarning
from somersault.model import GROUND, Body, Follow, Joint, Model, as_matrix, load, shipped

NAN, INF = float("nan"), float("inf")
ORIGIN = (0.0, 0.0, 0.0)
UNIT = as_matrix(np.eye(3))
BASE = Body("base", GROUND, 2.0, ORIGIN, UNIT)
HINGE = Joint("hinge", "hinge", axis=(0.0, 1.0, 0.0))
ARM = Body("arm", 0, 1.0, (0.0, 0.0, 0.5), UNIT, joints=(HINGE,))


def model(*bodies: Body, free: bool = True) -> Model:
    return Model("thing", free, bodies)


def diagonal(*values: float) -> Any:
    return as_matrix(np.diag(values))


def turned(angle: float) -> Any:
    c, s = np.cos(angle), np.sin(angle)
    return as_matrix(np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]))


def arm(**changed: Any) -> Callable[[], Model]:
    return lambda: model(BASE, replace(ARM, **changed))


def hinge(**changed: Any) -> Callable[[], Model]:
    return lambda: model(BASE, replace(ARM, joints=(replace(HINGE, **changed),)))


ELBOW = replace(HINGE, name="elbow")
FOREARM = Body("forearm", 1, 0.0, ORIGIN, diagonal(0, 0, 0), joints=(ELBOW,))
HAND = replace(FOREARM, name="hand", mass=1.0, inertia=UNIT)
# What is wrong, and the words that must be in the sentence: the element's name and the matter.
REFUSED: dict[str, tuple[Callable[[], Model], tuple[str, ...]]] = {
    "no bodies": (model, ("no bodies",)),
    "no mass": (lambda: model(replace(BASE, mass=0.0, inertia=diagonal(0, 0, 0))), ("no mass",)),
    "negative mass": (arm(mass=-1.0), ("'arm'", "negative mass")),
    "mass nan": (arm(mass=NAN), ("'arm'", "finite")),
    "com inf": (arm(com=(0.0, INF, 0.0)), ("'arm'", "finite")),
    "inertia nan": (arm(inertia=diagonal(1, NAN, 1)), ("'arm'", "finite")),
    "position inf": (arm(position=(-INF, 0.0, 0.0)), ("'arm'", "finite")),
    "rotation nan": (arm(rotation=diagonal(1, 1, NAN)), ("'arm'", "finite")),
    "rotation left-handed": (arm(rotation=diagonal(1, 1, -1)), ("'arm'", "rotation")),
    "rotation stretched": (arm(rotation=diagonal(1, 1, 1.01)), ("'arm'", "rotation")),
    "inertia lopsided": (
        arm(inertia=((1.0, 0.2, 0.0), (0.1, 1.0, 0.0), (0.0, 0.0, 1.0))),
        ("'arm'", "symmetric"),
    ),
    "two bodies of one name": (arm(name="base"), ("two body", "'base'")),
    "two joints of one name": (arm(joints=(HINGE, HINGE)), ("two joint", "'hinge'")),
    "itself as parent": (arm(parent=1), ("'arm'", "parent")),
    "later parent": (arm(parent=2), ("'arm'", "parent")),
    "parent below the ground": (arm(parent=-2), ("'arm'", "parent")),
    "no joint": (arm(joints=()), ("'arm'", "no joint")),
    "fixed base without joint": (lambda: model(BASE, free=False), ("'base'", "no joint")),
    "two in the air": (arm(parent=GROUND), ("'arm'", "not part of the free body")),
    "base with joints": (lambda: model(replace(BASE, joints=(HINGE,))), ("'base'", "joints")),
    "joint moves no mass": (lambda: model(BASE, ARM, FOREARM), ("'elbow'", "'forearm'", "mass")),
    "axis of no length": (hinge(axis=ORIGIN), ("'hinge'", "axis of length 0")),
    "axis too long": (hinge(axis=(0.0, 1.0, 1.0)), ("'hinge'", "axis of length 1.41")),
    "axis nan": (hinge(axis=(0.0, NAN, 0.0)), ("'hinge'", "finite")),
    "anchor inf": (hinge(anchor=(INF, 0.0, 0.0)), ("'hinge'", "finite")),
    "reference nan": (hinge(reference=NAN), ("'hinge'", "finite")),
    "rest inf": (hinge(rest=INF), ("'hinge'", "finite")),
    "stiffness nan": (hinge(stiffness=NAN), ("'hinge'", "finite")),
    "damping negative": (hinge(damping=-0.1), ("'hinge'", "negative damping")),
    "armature negative": (hinge(armature=-0.1), ("'hinge'", "negative armature")),
    "limits crossed": (hinge(limits=(1.0, -1.0)), ("'hinge'", "limits")),
    "limits inf": (hinge(limits=(-INF, 1.0)), ("'hinge'", "finite")),
}


@pytest.mark.parametrize("what", REFUSED)
def test_refused(what: str) -> None:
    make, told = REFUSED[what]
    with pytest.raises(SomersaultError) as caught:
        make()
    message = str(caught.value)
    assert message.startswith("thing")
    assert "\n" not in message
    for words in told:
        assert words in message


@pytest.mark.parametrize(
    "make",
    [
        arm(),
        arm(inertia=diagonal(1, 1, 2)),  # flat: the sum exactly
        arm(rotation=turned(0.4)),
        hinge(limits=(0.5, 0.5)),
        hinge(kind="slide"),
        hinge(kind="ball"),
        lambda: model(replace(BASE, joints=(HINGE,)), free=False),
        lambda: model(BASE, replace(ARM, mass=0.0, inertia=diagonal(0, 0, 0)), HAND),
        lambda: model(
            replace(BASE, joints=(ELBOW,)), replace(ARM, parent=GROUND), free=False
        ),  # two trees on the ground
    ],
)
def test_accepted(make: Callable[[], Model]) -> None:
    assert make().mass > 0


def test_a_spring_that_pushes_away_is_one_with_a_note() -> None:
    with pytest.warns(SomersaultWarning, match="'hinge' has negative stiffness"):
        assert hinge(stiffness=-3.0)().mass > 0


@settings(derandomize=True, max_examples=60, deadline=None)
@given(st.tuples(*[st.floats(0.01, 10)] * 3))
def test_the_triangle_inequality_decides_what_is_flown_with_a_warning(
    values: tuple[float, ...],
) -> None:
    possible = max(values) <= sum(values) - max(values)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        arm(inertia=diagonal(*values))()
    if caught:
        assert not possible
        assert "sum of the other two" in str(caught[0].message)
    else:
        assert possible or max(values) == pytest.approx(sum(values) - max(values), rel=1e-5)


@pytest.mark.parametrize(
    ("inertia", "how_much"), [((1, 1, 2.1), "1.05 times"), ((1, 1, -0.1), "-0.1 kg m²")]
)
def test_a_body_that_cannot_be_is_named_with_how_much(
    inertia: tuple[float, ...], how_much: str
) -> None:
    with pytest.warns(SomersaultWarning, match=rf"thing: .*arm \({how_much}\)"):
        thing = arm(inertia=diagonal(*inertia))()
    assert load(thing) is thing  # the whole moves as a body can


def test_a_rotor_without_mass_is_named() -> None:
    with pytest.warns(SomersaultWarning, match=r"arm \(without mass\)"):
        model(BASE, replace(ARM, mass=0.0), HAND)


IMPOSSIBLE: dict[str, tuple[Callable[[], Model], tuple[str, ...]]] = {
    "too little inertia": (
        lambda: model(BASE, replace(ARM, mass=0.1, inertia=diagonal(1, -0.9, 1))),
        ("'hinge'", "negative kinetic energy"),
    ),
    "a rod about its own axis": (
        lambda: model(BASE, replace(ARM, com=ORIGIN, inertia=diagonal(1, 0, 1))),
        ("'hinge'", "moves no mass"),
    ),
    "a rod alone": (
        lambda: model(replace(BASE, inertia=diagonal(1, 0, 1))),
        ("turning its base", "moves no mass"),
    ),
    "two hinges about one axis": (
        lambda: model(
            BASE,
            replace(ARM, mass=0.0, inertia=diagonal(0, 0, 0)),
            replace(ARM, name="hand", parent=1, joints=(ELBOW,)),
        ),
        ("joint", "moves no mass"),
    ),
}


@pytest.mark.filterwarnings("ignore::somersault._core.errors.SomersaultWarning")
@pytest.mark.parametrize("what", IMPOSSIBLE)
def test_a_whole_that_cannot_move_is_refused_where_it_is_loaded(what: str) -> None:
    make, told = IMPOSSIBLE[what]
    with pytest.raises(SomersaultError) as caught:
        load(make())
    for words in told:
        assert words in str(caught.value)


@pytest.mark.parametrize(
    ("limits", "reference", "home"),
    [((-2.7, -0.9), 0.0, -0.9), ((0.2, 1.0), 0.0, 0.2), ((-1.0, 1.0), 0.3, 0.3), (None, 0.3, 0.3)],
)
def test_a_joint_drawn_outside_its_range_stands_at_the_nearer_end(
    limits: tuple[float, float] | None, reference: float, home: float
) -> None:
    thing = hinge(limits=limits, reference=reference)()
    (joint,) = thing.joints
    assert thing.home.tolist() == list(joint.home) == [home]
    assert joint.drawn_outside == (home != reference)


def test_a_follower_stands_where_its_leader_has_it() -> None:
    leader = replace(HINGE, limits=(0.2, 1.0))
    follower = replace(ELBOW, follows=Follow("hinge", -2.0, 0.1))
    thing = model(BASE, replace(ARM, joints=(leader,)), replace(HAND, joints=(follower,)))
    assert thing.home.tolist() == pytest.approx([0.2, -0.3])


# --------------------------------------------------------------------------- what it tells


def test_coordinates_and_speeds_are_in_the_order_of_the_joints() -> None:
    ball = Joint("ball", "ball")
    slide = Joint("slide", "slide", reference=0.3)
    thing = model(BASE, replace(ARM, joints=(slide, ball)), replace(ARM, name="other", parent=0))
    assert thing.coordinates == ("slide", "ball.w", "ball.x", "ball.y", "ball.z", "hinge")
    assert thing.speeds == ("slide", "ball.1", "ball.2", "ball.3", "hinge")
    assert thing.home.tolist() == [0.3, 1.0, 0.0, 0.0, 0.0, 0.0]
    for joint in thing.joints:
        assert thing.joint(joint.name) is joint
        own = thing.coordinate_slice(joint.name)
        assert thing.home[own].tolist() == list(joint.home)
        assert len(thing.speeds[thing.speed_slice(joint.name)]) == joint.speeds
    assert thing.mass == pytest.approx(4.0)


def test_an_unknown_joint_is_told_with_those_there_are() -> None:
    with pytest.raises(SomersaultError, match="no joint 'knee'; its joints are hinge"):
        model(BASE, ARM).joint("knee")
    with pytest.raises(SomersaultError, match="no joint 'knee'; it has none"):
        model(BASE).joint("knee")


def test_a_model_is_a_value() -> None:
    one, two = model(BASE, ARM), model(BASE, ARM)
    assert one == two
    assert hash(one) == hash(two)
    assert one.renamed("other") != one
    assert one.renamed("other").bodies == one.bodies
    assert one != model(BASE, replace(ARM, mass=1.5))
    with pytest.raises(FrozenInstanceError):
        one.name = "other"  # type: ignore[misc]
    with pytest.raises(FrozenInstanceError):
        one.bodies[0].mass = 3.0  # type: ignore[misc]


@pytest.mark.parametrize("name", shipped())
def test_shipped_models_are_free_and_leave_nothing_out(name: str) -> None:
    ours = load(name)
    assert ours.free
    assert ours.name == name
    assert ours.ignored == () or name.startswith("biped")  # a robot with motors and ground
    assert load(name) is ours
    assert load(ours) is ours
