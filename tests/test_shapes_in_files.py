"""Bodies of URDF, .bioMod and .osim files look as the formats' own programs have them, and a shape
that cannot be shown is left out by name."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import warnings
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fuzz.meshes import biomesh, dae, obj, ply, stl, vtp
from robots import ARM, HUB, joint, link, robot
from scipy.spatial import cKDTree
from test_mesh_files import CLOSED, CORNER

import somersault as so
from somersault.history import Recording
from somersault.model import Model, body_frames, model_shapes
from somersault.model.read.mesh import MeshFile
from somersault.model.shapes import Mesh, Shape
from somersault.view import frame, page


@pytest.fixture(autouse=True)
def _there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def read(path: str | Path) -> tuple[Model, str]:
    """The model in a file, and all that is said of it."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        model = so.load(path)
    return model, "\n".join(str(one.message) for one in said)


def placed(model: Model, q: np.ndarray) -> list[tuple[Shape, np.ndarray]]:
    """All shapes, and where each stands (3, 4) in the base's axes."""
    rotations, origins = body_frames(model, q)
    return [
        (shape, np.c_[turn @ np.array(shape.rotation), at + turn @ np.array(shape.position)])
        for body, turn, at in zip(model.bodies, rotations, origins, strict=True)
        for shape in body.shapes
    ]


def some_pose(model: Model) -> np.ndarray:
    rng = np.random.default_rng(3)
    q = model.home.copy()
    for one in model.joints:
        q[model.coordinate_slice(one.name)] = 0.4 * rng.normal()
    for one in model.joints:
        if one.follows is not None:
            leader = q[model.coordinate_slice(one.follows.leader)]
            q[model.coordinate_slice(one.name)] = one.follows.offset + one.follows.factor * leader
    return q


# ------------------------------------------------------------------------------------- URDF


def share() -> Path | None:
    try:
        found = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        return None
    first = next((f for f in found if "example-robot-data/robots/" in str(f)), None)
    if first is None:
        return None
    path = Path(str(first.locate())).resolve()
    return next(p.parent for p in path.parents if p.name == "example-robot-data")


SHARE = share()
ROBOTS = [
    "solo_description/robots/solo12", "talos_data/robots/talos_reduced",
    "anymal_c_simple_description/urdf/anymal", "icub_description/robots/icub_reduced",
    "hyq_description/robots/hyq_no_sensors", "panda_description/urdf/panda",
    "romeo_description/urdf/romeo_small", "quadruped_description/urdf/quadruped",
]  # fmt: skip


def in_pinocchio(pin: Any, path: Path, model: Model, q: np.ndarray) -> list[tuple[Any, np.ndarray]]:
    """The visual geometries of a robot in a pose, each with its place (3, 4)."""
    theirs = pin.buildModelFromUrdf(str(path), *([pin.JointModelFreeFlyer()] if model.free else []))
    shown = pin.buildGeomFromUrdf(
        theirs,
        str(path),
        pin.GeometryType.VISUAL,
        package_dirs=[str(SHARE or path.parent), str(path.parent.parent)],
    )
    pose = pin.neutral(theirs)
    for one in model.joints:
        at = theirs.joints[theirs.getJointId(one.name)]
        x = q[model.coordinate_slice(one.name)][0]
        pose[at.idx_q : at.idx_q + at.nq] = [x] if at.nq == 1 else [np.cos(x), np.sin(x)]
    data, places = theirs.createData(), shown.createData()
    pin.updateGeometryPlacements(theirs, data, shown, places, pose)
    return [
        (geometry, place.homogeneous[:3])
        for geometry, place in zip(shown.geometryObjects, places.oMg, strict=True)
    ]


@pytest.mark.skipif(SHARE is None, reason="needs example-robot-data")
@pytest.mark.parametrize("name", ROBOTS)
def test_a_robot_looks_as_pinocchio_has_it(name: str) -> None:
    pin = pytest.importorskip("pinocchio")
    path = Path(f"{SHARE}/example-robot-data/robots/{name}.urdf")
    model, said = read(path)
    assert "shapes left out" not in said
    q = some_pose(model)
    theirs, ours = in_pinocchio(pin, path, model, q), placed(model, q)
    assert len(ours) == len(theirs)
    one, other = (np.array([place.ravel() for _, place in row]) for row in (ours, theirs))
    assert cKDTree(other).query(one)[0].max() < 1e-9
    seen, wanted, files, there = [], [], [], []
    for shape, place in ours:
        if not isinstance(shape, MeshFile):
            continue
        files.append(shape.contents.file.resolve())
        for mesh in shape.solids():
            assert isinstance(mesh, Mesh)
            corners = mesh.vertices[np.unique(mesh.faces)]
            seen.append(corners @ place[:, :3].T + place[:, 3])
    for geometry, place in theirs:
        if Path(geometry.meshPath).is_file():
            there.append(Path(geometry.meshPath).resolve())
            corners = np.array(geometry.geometry.vertices())
            wanted.append(corners @ place[:, :3].T + place[:, 3])
    assert sorted(files) == sorted(there)
    points, others = np.concatenate(seen), np.concatenate(wanted)
    # Assimp turns nodes of COLLADA in single precision.
    assert cKDTree(others).query(points)[0].max() < 1e-7
    assert cKDTree(points).query(others)[0].max() < 1e-7


VISUAL = (
    '<visual><origin xyz=".1 .2 .3" rpy=".4 .5 .6"/><geometry>{}</geometry>'
    '<material name="{}">{}</material></visual>'
)
RED, BLUE = '<color rgba="1 0 0 1"/>', '<color rgba="0 0 1 .5"/>'


def test_primitives_and_colours_are_as_in_pinocchio() -> None:
    pin = pytest.importorskip("pinocchio")
    Path("a.stl").write_bytes(stl(CORNER, CLOSED))
    hub = (
        VISUAL.format('<box size=".2 .4 .6"/>', "paint", "")
        + VISUAL.format('<sphere radius=".3"/>', "ink", BLUE)
        + VISUAL.format('<cylinder radius=".1" length=".5"/>', "paint", BLUE)
    )
    address = f"package://{Path.cwd().name}/a.stl"
    arm = VISUAL.format(f'<mesh filename="{address}" scale="1 -2 3"/>', "ink", "")
    text = robot(
        f'<material name="paint">{RED}</material>',
        link("hub", 5, (0.05, 0.09, 0.1), more=hub),
        link("arm", 1, (0.02, 0.03, 0.04)),
        link("glove", more=arm),
        joint("hinge", "hub", "arm", at=".1 0 0"),
        joint("weld", "arm", "glove", kind="fixed", at="0 .5 0", rpy="1 2 3"),
    )
    Path("robot.urdf").write_text(text)
    model, said = read("robot.urdf")
    assert said == ""
    q = some_pose(model)
    theirs, ours = in_pinocchio(pin, Path("robot.urdf").resolve(), model, q), placed(model, q)
    assert [shape.kind for shape, _ in ours] == ["box", "sphere", "cylinder", "mesh file"]
    for (shape, place), (geometry, there) in zip(ours, theirs, strict=True):
        np.testing.assert_allclose(place, there, atol=1e-12)
        np.testing.assert_allclose(shape.color, geometry.meshColor, atol=1e-6)
    box, sphere, cylinder = (shape.sizes for shape, _ in ours[:3])
    np.testing.assert_allclose(box, theirs[0][0].geometry.halfSide)
    assert sphere == (theirs[1][0].geometry.radius,)
    assert cylinder == (theirs[2][0].geometry.radius, theirs[2][0].geometry.halfLength)
    (mesh,) = model_shapes(model)[1]
    assert isinstance(mesh, Mesh)
    np.testing.assert_allclose(np.abs(mesh.vertices).max(0), [1, 2, 3])


def test_a_mesh_keeps_its_own_colour() -> None:
    Path("a.dae").write_bytes(dae(CORNER, CLOSED))
    shown = VISUAL.format('<mesh filename="a.dae"/>', "ink", BLUE)
    Path("robot.urdf").write_text(robot(link("hub", 5, (0.05, 0.09, 0.1), more=shown)))
    model, _ = read("robot.urdf")
    assert [shape.color for shape in model_shapes(model)[0]] == [(1.0, 0.5, 0.0, 1.0)]


LEFT_OUT = {
    '<mesh filename="package://bot/hub.dae"/>': r"package://bot/hub.dae \(is not there\)",
    '<mesh filename="/etc/passwd"/>': r"/etc/passwd \(is none of .stl",
    '<mesh filename="a.stl" scale="1 1 0"/>': r"a.stl \(is scaled to nothing",
    '<mesh filename="a.stl" scale="1 1 nan"/>': "scale of the <mesh> of link 'hub' must be",
    '<mesh scale="1 1 1"/>': "the <mesh> of link 'hub' has no filename",
    '<box size="1 1"/>': "size of the <box> of link 'hub' must be",
    "<box/>": "the <box> of link 'hub' has no size; add 3 numbers",
    '<sphere radius="-1"/>': "a sphere has radius -1",
    '<cylinder radius="x" length="1"/>': "radius of the <cylinder> of link 'hub' must be",
    '<teapot size="1"/>': "link 'hub' has a <teapot>",
    "": "a visual of link 'hub' has no shape",
}


@pytest.mark.parametrize("geometry", LEFT_OUT)
def test_a_shape_that_makes_no_sense_is_left_out_by_name(geometry: str) -> None:
    Path("a.stl").write_bytes(stl(CORNER, CLOSED))
    shown = VISUAL.format(geometry, "", "") + VISUAL.format('<sphere radius=".1"/>', "", RED)
    Path("robot.urdf").write_text(robot(link("hub", 5, (0.05, 0.09, 0.1), more=shown)))
    with pytest.warns(so.SomersaultWarning, match=f"shapes left out: .*{LEFT_OUT[geometry]}"):
        model = so.load("robot.urdf")
    assert [shape.kind for shape in model_shapes(model)[0]] == ["sphere"]


def test_a_broken_mesh_is_named_once_when_somebody_looks() -> None:
    Path("a.stl").write_bytes(stl(CORNER, CLOSED)[:-3])
    Path("robot.urdf").write_text(
        robot(
            link(
                "hub", 5, (0.05, 0.09, 0.1), more=VISUAL.format('<mesh filename="a.stl"/>', "", "")
            )
        )
    )
    model, said = read("robot.urdf")
    assert said == ""
    with pytest.warns(so.SomersaultWarning, match=r"robot: shapes left out: a.stl \(is no whole"):
        shown = model_shapes(model)
    assert [shape.kind for shape in shown[0]] == ["sphere"]  # a stick of no length
    model_shapes(model)


def test_an_unseen_mesh_is_not_read(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("a.stl").write_bytes(stl(CORNER, CLOSED))
    shown = VISUAL.format('<mesh filename="a.stl"/>', "", "")
    Path("robot.urdf").write_text(
        robot(link("hub", 5, (0.05, 0.09, 0.1), more=shown), ARM, joint("hinge", "hub", "arm"))
    )
    monkeypatch.setattr(MeshFile, "solids", lambda self: pytest.fail("read"))
    model, _ = read("robot.urdf")
    so.fly(model, so.Takeoff(spin=1.0), 0.1)
    bare = robot(HUB, ARM, joint("hinge", "hub", "arm"))
    Path("bare.urdf").write_text(bare)
    assert so.load("bare.urdf").renamed("robot") == model  # shapes decide nothing


@pytest.mark.skipif(SHARE is None, reason="needs example-robot-data")
def test_a_robot_with_many_triangles_is_pictured_and_paged(tmp_path: Path) -> None:
    model, _ = read(
        f"{SHARE}/example-robot-data/robots/anymal_b_simple_description/robots/anymal.urdf"
    )
    assert sum(len(s.faces) for r in model_shapes(model) for s in r if isinstance(s, Mesh)) > 3e5
    still = Recording(model, [0.0], np.zeros((1, 3)), [[1.0, 0, 0, 0]], [model.home])
    picture = frame(still, 0.0, size=(320, 180))
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 300
    page(still, tmp_path / "a.html")
    assert (tmp_path / "a.html").stat().st_size < 1_200_000


# ----------------------------------------------------------------------------------- .bioMod

MASS = "com 0 0 0\nmass 1\ninertia .1 0 0 0 .1 0 0 0 .1\n"
POINTS = CORNER + np.array([0.1, -0.2, 0.3])
OWN = (
    "mesh 0 0 .1\nmesh .1 0 .2\nmeshrt .1 .2 .3 xyz 1 2 3\nmesh .3 .3 .3\nmesh 0 .1 .2\n"
    "meshscale 1 -2 3\npatch 0 1 2\npatch 1 2 3\n"
)
MESHES = {
    "a.stl": stl(POINTS, CLOSED), "a.obj": obj(POINTS, CLOSED), "a.ply": ply(POINTS, CLOSED),
    "a.bioMesh": biomesh(POINTS, CLOSED),
}  # fmt: skip


def test_segments_look_as_biorbd_has_them() -> None:
    biorbd = pytest.importorskip("biorbd")
    text = f"version 4\nsegment A\ntranslations xyz\nrotations xyz\n{MASS}{OWN}endsegment\n"
    for number, (name, data) in enumerate(MESHES.items()):
        Path(name).write_bytes(data)
        text += (
            f"segment S{number}\nparent A\nrtinmatrix 0\nrt .1 .2 .3 xyz {number} 0 1\n"
            f"rotations xz\n{MASS}meshfile {name}\nmeshscale 1 2 -3\nmeshrt .3 .2 .1 zyx .1 .2 .3\n"
            f"meshscale .5 .5 .7\nmeshcolor 1 0 {number / 10}\nendsegment\n"
        )
    Path("a.bioMod").write_text(text)
    model, said = read("a.bioMod")
    assert said == ""
    theirs = biorbd.Model("a.bioMod")
    pose = np.random.default_rng(4).normal(size=theirs.nbQ())
    base = theirs.globalJCS(pose, 0).to_array()
    rotations, origins = body_frames(model, pose[6:])
    wanted = theirs.meshPoints(pose)
    for number, (row, turn, at) in enumerate(
        zip(model_shapes(model), rotations, origins, strict=True)
    ):
        (mesh,) = row
        assert isinstance(mesh, Mesh)
        points = mesh.vertices @ np.array(mesh.rotation).T + mesh.position
        points = (points @ turn.T + at) @ base[:3, :3].T + base[:3, 3]
        there = np.array([point.to_array() for point in wanted[number]])
        np.testing.assert_allclose(points, there, atol=1e-12)
        assert mesh.color == (None if number == 0 else (1.0, 0.0, (number - 1) / 10, 1.0))


def test_points_without_triangles_are_a_line() -> None:
    points = "mesh 0 0 0\nmesh 0 0 1\nmesh 0 0 1\nmesh .5 0 1\n"
    segment = f"segment A\ntranslations xyz\nrotations xyz\n{MASS}{points}endsegment\n"
    Path("a.bioMod").write_text("version 4\n" + segment)
    model, said = read("a.bioMod")
    assert said == ""
    ((mesh,),) = model_shapes(model)
    assert isinstance(mesh, Mesh)
    corners = mesh.vertices[mesh.faces]
    one, two, three = np.moveaxis(corners, 1, 0)
    enclosed = np.einsum("ij,ij->", one, np.cross(two, three)) / 6
    hexagon = 6 * 0.5 * 0.02**2 * np.sin(np.pi / 3)
    assert enclosed == pytest.approx(1.5 * hexagon)  # two rods, whose faces look outwards
    np.testing.assert_allclose(mesh.vertices.max(0), [0.5, 0.02, 1.02], atol=0.003)


@pytest.mark.parametrize(
    ("look", "said"),
    [
        ("meshfile ../no.stl", r"\.\./no.stl \(is not there\)"),
        ("meshfile a.bioMod", r"a.bioMod \(is none of"),
        ("mesh 0 0 0\nmesh 1 0 0\npatch 0 1 2", "a corner outside its 2"),
    ],
)
def test_a_segments_look_that_makes_no_sense_is_left_out(look: str, said: str) -> None:
    segment = f"segment A\ntranslations xyz\nrotations xyz\n{MASS}{look}\nendsegment\n"
    Path("a.bioMod").write_text("version 4\n" + segment)
    with pytest.warns(so.SomersaultWarning, match=f"shapes left out: .*{said}"):
        so.load("a.bioMod")


# ------------------------------------------------------------------------------------- .osim

BODY = "<mass>1</mass><mass_center>0 0 0</mass_center><inertia>.1 .1 .1 0 0 0</inertia>"
LOOK = "<Appearance><opacity>{}</opacity><color>{}</color></Appearance>"
FOUR = f"""<OpenSimDocument Version="40000"><Model name="m"><Ground name="ground"/>
<BodySet name="bodyset"><objects><Body name="a"><components><PhysicalOffsetFrame name="off">
<attached_geometry><Mesh name="g"><scale_factors>1 -1 3</scale_factors>
{LOOK.format(1, "1 0 0")}<mesh_file>b.vtp</mesh_file></Mesh></attached_geometry>
<socket_parent>..</socket_parent><translation>.1 .2 .3</translation>
<orientation>.4 .5 .6</orientation></PhysicalOffsetFrame></components><attached_geometry>
<Sphere name="s">{LOOK.format(0.5, "0 1 0")}<radius>.1</radius></Sphere>
<Cylinder name="c"><radius>.1</radius><half_height>.3</half_height></Cylinder>
<Brick name="k"><half_lengths>.1 .2 .3</half_lengths></Brick>
<Ellipsoid name="e"><radii>.1 .2 .3</radii></Ellipsoid>
<Mesh name="h"><Appearance><visible>false</visible></Appearance><mesh_file>b.vtp</mesh_file></Mesh>
</attached_geometry>{BODY}</Body><Body name="b"><attached_geometry><Mesh name="m">
<mesh_file>b.vtp</mesh_file></Mesh></attached_geometry>{BODY}</Body></objects></BodySet>
<JointSet name="jointset"><objects><FreeJoint name="f">
<socket_parent_frame>/ground</socket_parent_frame><socket_child_frame>/bodyset/a</socket_child_frame>
</FreeJoint><PinJoint name="p"><socket_parent_frame>/bodyset/a/off</socket_parent_frame>
<socket_child_frame>/bodyset/b</socket_child_frame><coordinates><Coordinate name="p"/></coordinates>
</PinJoint></objects></JointSet></Model></OpenSimDocument>"""
THREE = """<OpenSimDocument Version="30000"><Model name="m"><BodySet name=""><objects>
<Body name="ground"/><Body name="a"><mass>1</mass><mass_center>0 0 0</mass_center>
<inertia_xx>.1</inertia_xx><inertia_yy>.1</inertia_yy><inertia_zz>.1</inertia_zz>
<inertia_xy>0</inertia_xy><inertia_xz>0</inertia_xz><inertia_yz>0</inertia_yz>
<Joint><FreeJoint name="f"><parent_body>ground</parent_body></FreeJoint></Joint>
<VisibleObject name=""><GeometrySet name=""><objects><DisplayGeometry>
<geometry_file>b.vtp</geometry_file><color>1 0.5 0</color><transform>.1 .2 .3 .4 .5 .6</transform>
<scale_factors>1 2 3</scale_factors><display_preference>4</display_preference>
<opacity>.5</opacity></DisplayGeometry></objects></GeometrySet><scale_factors>2 2 .5</scale_factors>
<transform>.3 .2 .1 1 2 3</transform></VisibleObject></Body></objects></BodySet></Model>
</OpenSimDocument>"""
IN_OPENSIM = """
import json, sys
import opensim

class Take(opensim.DecorativeGeometryImplementation):
    def __init__(self):
        super().__init__()
        self.seen = []
    def take(self, kind, g):
        turn, at = g.getTransform().R().convertRotationToBodyFixedXYZ(), g.getTransform().p()
        scale, color = g.getScaleFactors(), g.getColor()
        rows = [[v.get(k) for k in range(3)] for v in (turn, at, scale, color)]
        self.seen.append([kind, int(g.getBodyId()), *rows, g.getOpacity()])
    def implementSphereGeometry(self, g): self.take("sphere", g)
    def implementCylinderGeometry(self, g): self.take("cylinder", g)
    def implementBrickGeometry(self, g): self.take("box", g)
    def implementEllipsoidGeometry(self, g): self.take("ellipsoid", g)
    def implementMeshFileGeometry(self, g): self.take("mesh file", g)

model = opensim.Model(sys.argv[1])
shown, take = opensim.ArrayDecorativeGeometry(), Take()
model.generateDecorations(True, model.getDisplayHints(), model.initSystem(), shown)
for k in range(shown.size()):
    shown.at(k).implementGeometry(take)
print("seen", json.dumps(take.seen))
"""


@pytest.mark.parametrize("text", [FOUR, THREE], ids=["4", "3"])
def test_bodies_look_as_opensim_has_them(text: str, tmp_path: Path) -> None:
    from scipy.spatial.transform import Rotation

    Path("Geometry").mkdir()
    Path("Geometry/b.vtp").write_bytes(vtp(CORNER, CLOSED))
    Path("m.osim").write_text('<?xml version="1.0"?>' + text)
    run = subprocess.run(
        [sys.executable, "-c", IN_OPENSIM, "m.osim"], capture_output=True, encoding="utf-8",
        env={**os.environ, "OPENSIM_HOME": ""}, timeout=300,
    )  # fmt: skip
    if "No module named 'opensim'" in run.stderr:
        pytest.skip("OpenSim, the reference, is optional")
    line = next(line for line in run.stdout.splitlines() if line.startswith("seen"))
    wanted = {(kind, body): rest for kind, body, *rest in json.loads(line[5:])}
    model, said = read("m.osim")
    assert "shapes" not in said
    seen = {(s.kind, k + 1): s for k, body in enumerate(model.bodies) for s in body.shapes}
    assert seen.keys() == wanted.keys()
    for key, shape in seen.items():
        turn, at, scale, color, opacity = wanted[key]
        place = Rotation.from_euler("XYZ", turn).as_matrix()
        if shape.kind == "cylinder":  # OpenSim's is along y
            place = place @ Rotation.from_euler("x", -np.pi / 2).as_matrix()
        np.testing.assert_allclose(shape.rotation, place, atol=1e-6)
        np.testing.assert_allclose(shape.position, at, atol=1e-5)  # OpenSim writes six digits
        np.testing.assert_allclose(np.diag(getattr(shape, "form", np.eye(3))), scale, atol=1e-12)
        np.testing.assert_allclose(shape.color or (1, 1, 1, 1), [*color, opacity], atol=1e-12)
    if text == FOUR:
        sizes = {shape.kind: shape.sizes for shape in seen.values() if shape.sizes}
        assert sizes == {
            "sphere": (0.1,), "cylinder": (0.1, 0.3), "box": (0.1, 0.2, 0.3),
            "ellipsoid": (0.1, 0.2, 0.3),
        }  # fmt: skip


def test_a_scaled_sphere_is_an_ellipsoid_and_a_cone_has_its_tip() -> None:
    more = (
        '<Sphere name="s"><scale_factors>1 2 3</scale_factors><radius>.1</radius></Sphere>'
        '<Cone name="n"><origin>0 0 1</origin><direction>0 2 0</direction><height>.5</height>'
        '<base_radius>.2</base_radius></Cone><Torus name="t"/>'
    )
    Path("m.osim").write_text(FOUR.replace('<Mesh name="m">', f'{more}<Mesh name="m">'))
    model, said = read("m.osim")
    assert "Torus 't' is of a kind that is not drawn" in said
    assert "b.vtp (is not there)" in said
    ball, cone = model_shapes(model)[1]
    np.testing.assert_allclose(ball.triangles.vertices.max(0), [0.1, 0.2, 0.3], rtol=0.01)
    points = cone.triangles.vertices
    np.testing.assert_allclose(points.min(0), [-0.2, 0, 0.8], atol=0.005)
    np.testing.assert_allclose(points[points[:, 1].argmax()], [0, 0.5, 1], atol=0.001)
