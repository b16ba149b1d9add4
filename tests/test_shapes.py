"""Shapes are closed surfaces where MuJoCo draws them, travel with bodies, and decide nothing."""

from __future__ import annotations

import pickle
import shutil
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from test_athlete import MEASURED
from trees import mujoco_addresses, random_rotation

import somersault as so
from somersault.model import GROUND, Model, body_frames, merge_welded, model_shapes
from somersault.model.athlete._de_leva import HEEL_BEHIND_ANKLE, TABLES
from somersault.model.shapes import (
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    Mesh,
    Shape,
    Sphere,
    Triangles,
    loft,
)
from somersault.view import camera, contact_sheet, draw_pose
from somersault.view import style as look

SHIPPED = files("somersault.model") / "shipped"
KINDS = {
    "sphere": (Sphere(radius=0.3), 4 / 3 * np.pi * 0.3**3),
    "capsule": (
        Capsule(radius=0.2, half_length=0.5),
        np.pi * 0.2**2 * 1.0 + 4 / 3 * np.pi * 0.2**3,
    ),
    "cylinder": (Cylinder(radius=0.2, half_length=0.5), np.pi * 0.2**2),
    "box": (Box(half_sizes=(0.1, 0.2, 0.3)), 8 * 0.1 * 0.2 * 0.3),
    "ellipsoid": (Ellipsoid(semi_axes=(0.1, 0.2, 0.3)), 4 / 3 * np.pi * 0.1 * 0.2 * 0.3),
}


def volume(surface: Triangles) -> float:
    """Enclosed, by the divergence theorem: negative if the faces look inwards."""
    one, two, three = np.moveaxis(surface.vertices[surface.faces], 1, 0)
    return float(np.einsum("ij,ij->", one, np.cross(two, three)) / 6)


def check_closed(surface: Triangles) -> None:
    """Every edge is walked once each way, and normals point out of the faces they belong to."""
    _, place = np.unique(np.round(surface.vertices, 9), axis=0, return_inverse=True)
    faces = place.reshape(-1)[surface.faces]
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).tolist()
    there = {tuple(edge) for edge in edges}
    assert len(there) == len(edges)
    assert all((b, a) in there for a, b in there)
    np.testing.assert_allclose(np.linalg.norm(surface.normals, axis=1), 1, atol=1e-12)
    one, two, three = np.moveaxis(surface.vertices[surface.faces], 1, 0)
    across = np.cross(two - one, three - one)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    assert np.einsum("ij,ikj->ik", across, surface.normals[surface.faces]).min() > 0.6


def tetrahedron(**options: Any) -> Mesh:
    corners = np.array([[0, 0, 0], [0.3, 0, 0], [0, 0.2, 0], [0, 0, 0.4]])
    faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    return Mesh(vertices=corners, faces=faces, **options)


@pytest.mark.parametrize("kind", KINDS)
def test_a_surface_is_closed_and_has_the_volume(kind: str) -> None:
    shape, wanted = KINDS[kind]
    assert shape.kind == kind
    check_closed(shape.triangles)
    assert 0.96 * wanted < volume(shape.triangles) <= (1 + 1e-12) * wanted
    points, radius = shape.hull
    apart = np.linalg.norm(shape.triangles.vertices[:, None] - points, axis=-1)
    spread = np.ptp(shape.triangles.vertices, axis=0)
    np.testing.assert_allclose(spread, np.ptp(points, axis=0) + 2 * radius, rtol=0.02)
    if kind == "sphere":
        np.testing.assert_allclose(apart, 0.3)


@pytest.mark.parametrize("kind", [*KINDS, "mesh"])
def test_a_shape_is_placed_and_mirrored_as_its_points_are(kind: str) -> None:
    rng = np.random.default_rng(4)
    shape = tetrahedron() if kind == "mesh" else KINDS[kind][0]
    shape = shape.placed(rng.normal(size=3), random_rotation(rng))
    for turn in (random_rotation(rng), random_rotation(rng) @ np.diag([1.0, -1.0, 1.0])):
        at = rng.normal(size=3)
        moved = shape.placed(at, turn)
        wanted = shape.triangles.vertices @ turn.T + at
        seen = moved.triangles.vertices
        order, other = (np.lexsort(np.round(points, 9).T) for points in (wanted, seen))
        np.testing.assert_allclose(seen[other], wanted[order], atol=1e-12)
        check_closed(moved.triangles)
        assert volume(moved.triangles) == pytest.approx(volume(shape.triangles))
        assert np.linalg.det(np.array(moved.rotation)) == pytest.approx(1)


def test_a_mesh_is_smooth_where_it_bends_little_and_has_edges_where_it_bends_much() -> None:
    ball = Sphere(radius=1.0).triangles
    smooth = Mesh(vertices=ball.vertices, faces=ball.faces).triangles
    np.testing.assert_allclose(np.einsum("ij,ij->i", smooth.normals, smooth.vertices), 1, atol=0.02)
    box = Box(half_sizes=(1.0, 2.0, 3.0)).triangles
    apart = box.vertices[box.faces].reshape(-1, 3)  # every triangle with corners of its own
    sharp = Mesh(vertices=apart, faces=np.arange(36).reshape(-1, 3)).triangles
    assert len(sharp.vertices) == 24
    assert set(np.abs(sharp.normals).max(1)) == {1.0}
    check_closed(sharp)


def test_triangles_without_area_are_left_out() -> None:
    shape = tetrahedron()
    faces = np.concatenate([shape.faces, [[0, 0, 1], [2, 2, 2]]])
    check_closed(Mesh(vertices=shape.vertices, faces=faces).triangles)
    flat = Mesh(vertices=np.eye(3), faces=[[0, 1, 2]])
    assert len(flat.hull.points) == 3
    line = Mesh(vertices=np.zeros((3, 3)), faces=[[0, 1, 2]])
    assert np.isfinite(line.triangles.normals).all()


def test_a_loft_goes_through_its_sections() -> None:
    angle = 2 * np.pi * np.arange(40) / 40
    rings = [
        np.stack([r * np.cos(angle), r * np.sin(angle), np.full(40, z)], -1)
        for z, r in ((0.0, 0.3), (1.0, 0.1))
    ]
    cone = loft(rings)
    check_closed(cone.triangles)
    assert volume(cone.triangles) == pytest.approx(np.pi / 3 * (0.09 + 0.03 + 0.01), rel=0.01)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Sphere(radius=0.0), "a sphere has radius 0.0"),
        (lambda: Capsule(radius=0.1, half_length=np.nan), "a capsule has half_length nan"),
        (lambda: Box(half_sizes=(1.0, -1.0, 1.0)), "a box has half_sizes"),
        (lambda: Sphere(radius=1.0, color=(1.0, 2.0, 0.0, 1.0)), "0 to 1"),
        (lambda: Sphere(radius=1.0, position=(np.inf, 0.0, 0.0)), "not finite"),
        (lambda: Mesh(vertices=np.zeros((3, 2)), faces=[[0, 1, 2]]), "finite vertices"),
        (lambda: Mesh(vertices=np.zeros((3, 3)), faces=[[0, 1, 3]]), "outside its 3"),
        (lambda: Mesh(vertices=np.zeros((3, 3)), faces=np.zeros((0, 3), int)), "needs faces"),
        (lambda: Mesh(vertices=np.zeros((3, 3)), faces=[[0.0, 1.0, 2.0]]), "needs faces"),
    ],
)
def test_what_is_no_shape_is_refused(make: Any, said: str) -> None:
    with pytest.raises(so.SomersaultError, match=said):
        make()


@pytest.mark.parametrize("kind", [*KINDS, "mesh"])
def test_a_shape_is_sent_without_what_follows_from_it(kind: str) -> None:
    shape = tetrahedron() if kind == "mesh" else KINDS[kind][0]
    before = len(pickle.dumps(shape))
    seen = shape.triangles
    again = pickle.loads(pickle.dumps(shape))
    assert len(pickle.dumps(shape)) == before
    np.testing.assert_array_equal(again.triangles.vertices, seen.vertices)


# ------------------------------------------------------------------------- read from MJCF


def drawn_by_mujoco(path: str) -> tuple[Model, Any, Any, np.ndarray]:
    """A model, MuJoCo's own of the same file in a random pose, and that pose."""
    ours = so.load(Path(path))
    m = mujoco.MjModel.from_xml_path(path)
    d = mujoco.MjData(m)
    q = ours.home + np.random.default_rng(2).uniform(-0.4, 0.4, len(ours.home))
    d.qpos[mujoco_addresses(ours, m)[0]] = q
    mujoco.mj_kinematics(m, d)
    return ours, m, d, q


@pytest.mark.filterwarnings("ignore::somersault.SomersaultWarning")  # of what a robot has besides
@pytest.mark.parametrize("name", so.shipped())
def test_shapes_of_shipped_models_are_where_mujoco_has_them(name: str) -> None:
    model, m, d, q = drawn_by_mujoco(str(SHIPPED / f"{name}.xml"))
    base = d.body(model.bodies[0].name)
    turn, at = (base.xmat.reshape(3, 3), base.xpos) if model.free else (np.eye(3), np.zeros(3))
    rotations, origins = body_frames(model, q)
    seen = [
        np.concatenate(
            [
                at + turn @ (origins[k] + rotations[k] @ np.array(shape.position)),
                np.ravel(turn @ rotations[k] @ np.array(shape.rotation)),
                np.pad(shape.sizes, (0, 3 - len(shape.sizes))),
            ]
        )
        for k, shapes in enumerate(model_shapes(model))
        for shape in shapes
    ]
    there = [g for g in range(m.ngeom) if m.geom_bodyid[g]]
    sizes = m.geom_size * (m.geom_size > 0)
    wanted = [np.concatenate([d.geom_xpos[g], d.geom_xmat[g], sizes[g]]) for g in there]
    order, other = np.lexsort(np.round(seen, 6).T), np.lexsort(np.round(wanted, 6).T)
    np.testing.assert_allclose(np.array(seen)[order], np.array(wanted)[other], atol=1e-12)


MESHED = """
<mujoco>
  <asset>
    <mesh name="wedge" vertex="0 0 0  .3 0 0  0 .2 0  0 0 .4" face="0 2 1 0 1 3 1 2 3 2 0 3"
      scale="1 2 1" refpos=".01 .02 0"/>
    <material name="red" rgba="1 0 0 1"/>
  </asset>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="trunk">
      <freejoint/>
      <geom type="sphere" size=".1" group="2" rgba="0 1 0 .5"/>
      <geom type="box" size=".3 .3 .3" group="3"/>
      <geom type="box" size=".3 .3 .3" rgba="0 0 0 0"/>
      <body name="welded" pos="0 0 .5" euler="0 90 0">
        <geom name="wedge" type="mesh" mesh="wedge" pos=".1 .2 .3" euler="20 30 40" material="red"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def test_meshes_groups_colors_and_welds(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(MESHED)
    with pytest.warns(so.SomersaultWarning):
        model, m, d, _ = drawn_by_mujoco(str(tmp_path / "a.xml"))
    (shapes,) = model_shapes(model)
    assert [shape.kind for shape in shapes] == ["sphere", "mesh"]  # not group 3, nor transparent
    assert [shape.color for shape in shapes] == [(0.0, 1.0, 0.0, 0.5), (1.0, 0.0, 0.0, 1.0)]
    g, mesh = m.geom("wedge").id, m.geom("wedge").dataid[0]
    first, count = m.mesh_vertadr[mesh], m.mesh_vertnum[mesh]
    wanted = m.mesh_vert[first : first + count] @ d.geom_xmat[g].reshape(3, 3).T + d.geom_xpos[g]
    wedge = shapes[1]
    assert isinstance(wedge, Mesh)
    seen = wedge.vertices @ np.array(wedge.rotation).T + wedge.position
    np.testing.assert_allclose(seen, wanted, atol=1e-7)  # MuJoCo keeps meshes in single precision
    assert volume(wedge.triangles) == pytest.approx(2 * 0.3 * 0.2 * 0.4 / 6, rel=1e-5)


def test_hidden_geoms_are_shown_where_there_are_no_others(tmp_path: Path) -> None:
    text = MESHED.replace('group="2"', 'group="4"').replace('name="wedge" type', 'group="5" type')
    (tmp_path / "a.xml").write_text(text)
    with pytest.warns(so.SomersaultWarning):
        model = so.load(tmp_path / "a.xml")
    assert [shape.kind for shape in model_shapes(model)[0]] == ["sphere", "box", "mesh"]


# ----------------------------------------------------------------------------- travelling


def copied(tmp_path: Path) -> Model:
    shutil.copy(str(SHIPPED / "gymnast.xml"), tmp_path / "mine.xml")
    return so.load(tmp_path / "mine.xml")


def with_a_spring(_: Path) -> Model:
    doll = so.load("doll")
    trunk, left, right = doll.bodies
    joint = replace(left.joints[0], stiffness=0.123)
    return replace(doll, bodies=(trunk, replace(left, joints=(joint,)), right))


def hung(_: Path) -> Model:
    zero = (0.0, 0.0, 0.0)
    bar = so.Joint("bar", "hinge", (0.0, 1.0, 0.0))
    carrier = so.Body(
        "bar", GROUND, 0.0, zero, (zero,) * 3, joints=(bar,),
        shapes=(Cylinder(radius=0.01, half_length=1.0),),
    )  # fmt: skip
    return so.mounted(so.load("doll"), carrier, (0.0, 0.0, -0.3)).held


def measured(_: Path) -> Model:
    return so.athlete_from_measurements(MEASURED)


@pytest.mark.parametrize(
    ("make", "counts"),
    [
        (copied, [2, 4, 1, 2, 1, 2, 3, 3]),
        (lambda _: so.athlete(1.7, 65.0), [1, 3, 1, 2, 1, 2, 3, 3]),
        (lambda _: so.athlete(1.6, 50.0, "female", shoulders="ball", knees=True), None),
        (measured, [2, 2, 1, 1, 1, 1, 3, 3]),  # what is clothed, and what is bare
        (with_a_spring, [4, 1, 1]),
        (lambda _: so.load("doll").renamed("mine"), [4, 1, 1]),
        (lambda _: so.load("furrer", axes=(3, 2, 1)), [5, 1, 1]),
        (hung, [5, 1, 1]),
    ],
)
def test_every_model_is_drawn_with_its_own_shapes(make: Any, counts: Any, tmp_path: Path) -> None:
    model = make(tmp_path)
    shapes = model_shapes(model)
    assert shapes == tuple(body.shapes for body in model.bodies)
    if counts is not None:
        assert [len(body) for body in shapes] == counts
    with look.style():
        ax = look.figure().add_subplot()
        draw_pose(ax, model, model.home, np.eye(3), camera(30, 10))
    assert len(ax.patches) == sum(map(len, shapes))


def test_the_doll_on_a_bar_hangs_below_it() -> None:
    held, doll = hung(Path()), so.load("doll")
    of_bar, *of_doll = held.bodies[0].shapes
    assert of_bar.kind == "cylinder"
    for one, other in zip(of_doll, doll.bodies[0].shapes, strict=True):
        np.testing.assert_allclose(np.array(other.position) - [0, 0, 0.3], one.position)
        assert one.rotation == other.rotation


def test_a_model_without_shapes_is_drawn_from_joint_to_joint() -> None:
    doll = so.load("doll")
    bare = replace(doll, bodies=tuple(replace(body, shapes=()) for body in doll.bodies))
    sticks = model_shapes(bare)
    assert {shape.kind for body in sticks for shape in body} <= {"capsule", "sphere"}
    assert all(sticks)
    ends = [stick.hull.points for stick in sticks[0]]
    for arm in bare.bodies[1:]:
        joint = np.array(arm.position) + np.array(arm.rotation) @ arm.joints[0].anchor
        assert any(np.abs(end - joint).max(1).min() < 1e-12 for end in ends)


# ------------------------------------------------------------------------ deciding nothing


def test_models_that_differ_in_shapes_alone_are_equal() -> None:
    doll = so.load("doll")
    bare = replace(doll, bodies=tuple(replace(body, shapes=()) for body in doll.bodies))
    assert bare == doll
    assert hash(bare) == hash(doll)
    assert "Capsule" not in repr(doll.bodies)
    assert model_shapes(bare) != model_shapes(doll)


def test_equal_models_are_each_drawn_with_their_own_shapes() -> None:
    """Whatever is kept for a model must not give another's shapes to a picture."""
    doll = so.load("doll")
    ball = (Sphere(radius=0.5),)
    other = replace(doll, bodies=tuple(replace(body, shapes=ball) for body in doll.bodies))
    for model in (doll, other, doll):
        with look.style():
            ax = look.figure().add_subplot()
            draw_pose(ax, model, model.home, np.eye(3), camera(30, 10))
        assert len(ax.patches) == sum(len(body.shapes) for body in model.bodies)


def test_flights_of_equal_models_are_each_drawn_with_their_own_shapes() -> None:
    """They share one compiled system."""
    doll = so.load("doll")
    ball = (Sphere(radius=0.5),)
    other = replace(doll, bodies=tuple(replace(body, shapes=ball) for body in doll.bodies))
    one, two = (so.fly(model, so.Takeoff(spin=5.0), 0.1) for model in (doll, other))
    assert one.system is two.system
    assert one.model is doll
    assert two.model is other
    for flight, count in ((one, 6), (two, 3)):
        assert len(contact_sheet(flight, [0.0, 0.1]).axes[0].patches) == 2 * count
    swung = so.swing(hung(Path()), {"bar": 0.1}, 0.1)
    assert len(contact_sheet(swung, [0.0]).axes[0].patches) == 7


def test_bodies_that_become_one_keep_all_their_shapes() -> None:
    rng = np.random.default_rng(8)
    turn = random_rotation(rng)
    inertia = tuple(map(tuple, np.eye(3).tolist()))
    ball = Sphere(radius=0.1, position=(0.1, 0.2, 0.3))
    base = so.Body("base", GROUND, 1.0, (0.0, 0.0, 0.0), inertia, shapes=(ball,))
    part = replace(
        base, name="part", parent=0, position=(1.0, 0.0, 0.0),
        rotation=tuple(map(tuple, turn.tolist())),
    )  # fmt: skip
    far = replace(part, name="far", parent=1)
    (whole,) = merge_welded([base, part, far], free=True)
    places = np.array([shape.position for shape in whole.shapes])
    one = np.array([1.0, 0.0, 0.0])
    own = np.array(ball.position)
    wanted = [own, one + turn @ own, one + turn @ (one + turn @ own)]
    np.testing.assert_allclose(places, wanted, atol=1e-14)


# ------------------------------------------------------------------------------- athletes


def solids(model: Model) -> list[Shape]:
    return [shape for body in model.bodies for shape in body.shapes]


@pytest.mark.parametrize("sex", ["male", "female"])
@pytest.mark.parametrize(("height", "mass"), [(1.75, 70.0), (1.5, 45.0), (1.9, 95.0)])
def test_an_athlete_is_as_tall_and_as_bulky_as_its_measurements(
    sex: Any, height: float, mass: float
) -> None:
    model = so.athlete(height, mass, sex, knees=True)
    surfaces = [shape.triangles for shape in solids(model)]
    for surface in surfaces:
        check_closed(surface)
    assert 0.9 < 1050 * sum(map(volume, surfaces)) / mass < 1.2  # caps overlap at the joints
    _, origins = body_frames(model, model.home)
    heights = np.concatenate(
        [
            origins[k, 2] + shape.triangles.vertices[:, 2]
            for k, body in enumerate(model.bodies)
            for shape in body.shapes
        ]
    )
    table = TABLES[sex]
    parts = ("lower_trunk", "middle_trunk", "upper_trunk", "head")
    vertex = sum(table.segments[part].length for part in parts) * height / table.height
    assert heights.max() == pytest.approx(vertex, abs=1e-12)
    leg = sum(table.segments[part].length for part in ("thigh", "shank", "foot"))
    toes = leg * height / table.height - HEEL_BEHIND_ANKLE * height / TABLES["male"].height
    assert 0 < -toes - heights.min() < 0.03  # their tips are round


def test_left_and_right_of_an_athlete_are_images(tmp_path: Path) -> None:
    for model in (so.athlete(1.7, 65.0), measured(tmp_path)):
        left, right = (
            np.concatenate(
                [
                    shape.triangles.vertices
                    for body in model.bodies
                    for shape in body.shapes
                    if body.name == f"{side}_upper_arm"
                ]
            )
            for side in ("left", "right")
        )
        image = left * [1.0, -1.0, 1.0]
        order, other = (np.lexsort(np.round(points, 8).T) for points in (image, right))
        np.testing.assert_allclose(right[other], image[order], atol=1e-12)


def test_a_measured_athlete_has_the_volume_of_yeadons(tmp_path: Path) -> None:
    yeadon = pytest.importorskip("yeadon")
    model = measured(tmp_path)
    human = yeadon.Human(MEASURED)
    wanted = sum(
        solid.mass / solid.density
        for segment in (human.P, human.T, human.C)
        for solid in segment.solids
    )
    trunk = [shape for body in model.bodies[:2] for shape in body.shapes]
    for shape in trunk:
        check_closed(shape.triangles)
    assert sum(volume(shape.triangles) for shape in trunk) == pytest.approx(wanted, rel=0.02)
