"""Mesh files of every kind are read as they were written, and nothing else is read or said."""

from __future__ import annotations

import io
import os
import pickle
import re
import tracemalloc
import warnings
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fuzz.meshes import SHOWN, biomesh, dae, obj, ply, stl, stl_text, vtp
from hypothesis import given, settings
from hypothesis import strategies as st

import somersault as so
from somersault.model.read.mesh import MeshFile, mesh_file
from somersault.model.read.mesh._file import Contents
from somersault.model.read.mesh._formats import ENDINGS, parts_of
from somersault.model.shapes import Mesh

RNG = np.random.default_rng(6)
POINTS = RNG.normal(size=(6, 3)).astype(np.float32).astype(float)
TRIANGLES = [[0, 1, 2], [0, 2, 3], [1, 4, 2]]
POLYGONS = [[0, 1, 2], [2, 3, 4, 5]]  # the same as FANS
FANS = [[0, 1, 2], [2, 3, 4], [2, 4, 5]]


# ------------------------------------------------------------------------------- whole files

WHOLE: dict[str, tuple[str, bytes, Any]] = {
    "stl": (".stl", stl(POINTS, TRIANGLES), TRIANGLES),
    "stl with more behind it": (".STL", stl(POINTS, TRIANGLES) + b"more", TRIANGLES),
    "stl text": (".stl", stl_text(POINTS, TRIANGLES), TRIANGLES),
    "obj": (".obj", obj(POINTS, POLYGONS), FANS),
    "obj counted back": (".obj", obj(POINTS, POLYGONS, back=True), FANS),
    "ply": (".ply", ply(POINTS, POLYGONS), FANS),
    "ply little": (".ply", ply(POINTS, POLYGONS, "binary_little_endian"), FANS),
    "ply big": (".ply", ply(POINTS, POLYGONS, "binary_big_endian"), FANS),
    "biomesh": (".bioMesh", biomesh(POINTS, TRIANGLES), TRIANGLES),
    "dae": (".dae", dae(POINTS, POLYGONS), FANS),
    "vtp": (".vtp", vtp(POINTS, POLYGONS), FANS),
    "vtp strips": (".vtp", vtp(POINTS, [], strips=[[0, 1, 2, 3, 4]]),
                   [[0, 1, 2], [2, 1, 3], [2, 3, 4]]),
}  # fmt: skip
for number, how in enumerate(
    [
        {"form": "binary"},
        {"form": "binary", "pack": "vtkZLibDataCompressor"},
        {"form": "binary", "pack": "vtkLZMADataCompressor", "size": "UInt64"},
        {"form": "appended"},
        {"form": "appended", "order": ">", "size": "UInt64"},
        {"form": "appended", "pack": "vtkZLibDataCompressor"},
        {"form": "appended", "encoding": "base64"},
        {"form": "appended", "encoding": "base64", "pack": "vtkZLibDataCompressor"},
    ]
):
    WHOLE[f"vtp {number}"] = (".vtp", vtp(POINTS, POLYGONS, **how), FANS)


@pytest.mark.parametrize("name", WHOLE)
def test_a_mesh_is_read_as_it_was_written(name: str) -> None:
    ending, data, faces = WHOLE[name]
    (part,) = parts_of(ending, data)
    seen = part.vertices[part.faces]
    np.testing.assert_allclose(seen, POINTS[np.array(faces)], atol=1e-15)
    assert part.color == ((1.0, 0.5, 0.0, 1.0) if ending == ".dae" else None)


def test_every_ending_is_tried() -> None:
    assert {ending.lower() for ending, _, _ in WHOLE.values()} == set(ENDINGS)


def test_a_scene_of_collada_stands_in_its_frames_and_unit() -> None:
    scene = (
        '<node id="a"><translate>1 2 3</translate><rotate>0 0 1 90</rotate><node id="b">'
        f'<scale>-1 2 2</scale>{SHOWN}</node></node><node><instance_node url="#lib"/></node>'
    )
    library = f'<library_nodes><node id="lib">{SHOWN}</node></library_nodes>'
    one, two = parts_of(".dae", dae(POINTS, TRIANGLES, unit=0.01, scene=scene, nodes=library))
    turned = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    wanted = 0.01 * ((POINTS * [-1, 2, 2]) @ turned.T + [1, 2, 3])
    np.testing.assert_allclose(one.vertices, wanted, atol=1e-7)
    assert one.faces.tolist() == np.array(TRIANGLES)[:, ::-1].tolist()  # mirrored
    np.testing.assert_allclose(two.vertices, 0.01 * POINTS, atol=1e-7)


@pytest.mark.parametrize("up", ["X_UP", "Y_UP", "Z_UP"])
def test_a_scene_of_collada_is_not_turned_by_what_it_says_is_up(tmp_path: Path, up: str) -> None:
    """Robots' files are written for RViz, Gazebo and pinocchio (coal), none of which turns them."""
    file = stored(tmp_path, dae(POINTS, TRIANGLES, up=up), "a.dae")
    (part,) = parts_of(".dae", file.read_bytes())
    np.testing.assert_allclose(part.vertices, POINTS, atol=1e-15)
    coal = pytest.importorskip("coal", reason="pinocchio, which reads meshes by coal, is optional")
    theirs = coal.MeshLoader().load(str(file)).vertices()
    used = POINTS[np.unique(TRIANGLES)]  # it sorts them
    np.testing.assert_allclose(in_order(theirs), in_order(used), atol=1e-6)


def in_order(points: Any) -> np.ndarray:
    return np.array(sorted(np.unique(np.round(points, 6), axis=0).tolist()))


def test_a_mesh_without_its_material_is_seen_all_the_same() -> None:
    (part,) = parts_of(".dae", dae(POINTS, POLYGONS, effect="nowhere"))
    assert (len(part.faces), part.color) == (3, None)


# ------------------------------------------------------------------------------- as a shape


def stored(tmp_path: Path, data: bytes, name: str = "a.stl") -> Path:
    (tmp_path / name).write_bytes(data)
    return tmp_path / name


def volume(mesh: Mesh) -> float:
    one, two, three = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    return float(np.einsum("ij,ij->", one, np.cross(two, three)) / 6)


CORNER = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
CLOSED = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]


@pytest.mark.parametrize("scale", [(2.0, 1.0, 1.0), (-2.0, 1.0, 1.0), (-1.0, -1.0, -2.0)])
def test_a_mirrored_mesh_keeps_its_outside_out(tmp_path: Path, scale: Any) -> None:
    file = Contents(stored(tmp_path, stl(CORNER, CLOSED)))
    form = tuple(map(tuple, np.diag(scale).tolist()))
    shape = MeshFile(contents=file, named="a.stl", form=form)
    (mesh,) = shape.solids()
    assert volume(mesh) == pytest.approx(2 / 6)
    mirror = np.diag([1.0, 1.0, -1.0])
    (image,) = shape.placed(np.array([1.0, 2.0, 3.0]), mirror).solids()
    assert volume(image) == pytest.approx(2 / 6)
    seen = image.vertices @ np.array(image.rotation).T + image.position
    there = mesh.vertices @ mirror + [1, 2, 3]
    order, other = (np.lexsort(np.round(points, 9).T) for points in (seen, there))
    np.testing.assert_allclose(seen[order], there[other], atol=1e-12)
    np.testing.assert_allclose(shape.triangles.vertices.max(0), mesh.triangles.vertices.max(0))
    assert len(shape.hull.points) == len(mesh.hull.points) == 4


def test_a_shape_is_sent_without_the_mesh(tmp_path: Path) -> None:
    file = Contents(stored(tmp_path, stl(CORNER, 5000 * CLOSED)))
    shape = MeshFile(contents=file, named="a.stl")
    before = len(pickle.dumps(shape))
    assert len(shape.solids()[0].faces) == 20_000
    assert len(pickle.dumps(shape)) == before < 2000


def test_very_many_triangles_are_made_fewer(tmp_path: Path) -> None:
    angle = np.linspace(0, 2 * np.pi, 601)
    u, v = np.meshgrid(angle, np.linspace(0.1, 3.0, 301))
    ball = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)], -1).reshape(-1, 3)
    here = (np.arange(300)[:, None] * 601 + np.arange(600)).ravel()
    faces = np.concatenate(
        [
            np.stack([here, here + 601, here + 1], -1),
            np.stack([here + 1, here + 601, here + 602], -1),
        ]
    )
    shape = MeshFile(contents=Contents(stored(tmp_path, stl(ball, faces))), named="a.stl")
    (mesh,) = shape.solids()
    assert 20_000 < len(mesh.faces) <= 200_000
    assert np.abs(np.linalg.norm(mesh.vertices, axis=1) - 1).max() < 0.01


# ------------------------------------------------------------------------------- where files are


def test_where_a_mesh_may_be(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    robot = tmp_path / "work" / "bot_description" / "urdf"
    meshes = robot.parent / "meshes"
    other = tmp_path / "ros" / "hand"
    for folder in (robot, meshes, other):
        folder.mkdir(parents=True)
    hub, thumb = stored(meshes, b"", "hub 1.stl"), stored(other, b"", "thumb.stl")
    for name in (
        "../meshes/hub 1.stl", "..\\meshes\\hub 1.stl",
        "package://bot_description/meshes/hub 1.stl",
        "package://another_name/meshes/hub 1.stl", f"file://{meshes}/hub%201.stl", str(hub),
    ):  # fmt: skip
        assert mesh_file(name, robot).resolve() == hub, name
    assert mesh_file("hub 1.stl", robot, [meshes]) == hub
    with pytest.raises(so.SomersaultError, match="is not there"):
        mesh_file("package://hand/thumb.stl", robot)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "ros"))
    assert mesh_file("package://hand/thumb.stl", robot) == thumb


def test_nothing_but_meshes_of_this_machine_is_opened(tmp_path: Path) -> None:
    stored(tmp_path, b"root:x:0:0", "passwd")
    (tmp_path / "folder.stl").mkdir()
    os.mkfifo(tmp_path / "pipe.stl")
    os.symlink("/dev/zero", tmp_path / "zero.stl")
    with open(tmp_path / "huge.stl", "wb") as file:
        file.truncate(10 * 2**30)
    for name, reason in {
        "passwd": "is none of .stl", "../" * 9 + "etc/passwd": "is none of .stl",
        "file:///etc/passwd": "is none of .stl", "http://example.org/a.stl": "not on this machine",
        "file://host/a.stl": "not on this machine", "//host/share/a.stl": "not on this machine",
        "\\\\host\\share\\a.stl": "not on this machine", "a\0b.stl": "is not there",
        "x" * 5000 + ".stl": "is not there", "folder.stl": "a folder, a pipe or a device",
        "pipe.stl": "a folder, a pipe or a device", "zero.stl": "a folder, a pipe or a device",
        "huge.stl": "larger than 100 MB", "": "is none of .stl",
    }.items():  # fmt: skip
        with pytest.raises(so.SomersaultError, match=reason):
            mesh_file(name, tmp_path)


def test_what_is_in_a_file_that_is_no_mesh_is_not_said(tmp_path: Path) -> None:
    for ending in ENDINGS:
        path = stored(
            tmp_path, b"<secret a='1'>root:x:0:0</secret>\nv secret f secret\n", "a" + ending
        )
        with pytest.raises(so.SomersaultError) as caught:
            MeshFile(contents=Contents(path), named="a").solids()
        assert "secret" not in str(caught.value)
        assert "root" not in str(caught.value)


# ------------------------------------------------------------------------------- hostile files


def bomb(blocks: int, size: int, said: int) -> bytes:
    """Points of a few kilobytes that unpack to blocks of a size, and say that it is another."""
    block = zlib.compress(bytes(size), 9)
    data = np.array([blocks, said, 0, *blocks * [len(block)]], "<u4").tobytes() + blocks * block
    file = vtp(POINTS, FANS, "appended", "vtkZLibDataCompressor").replace(b"\n_", b"\n_" + data)
    return re.sub(rb'offset="\d+"', b'offset="0"', file)


def laughing() -> bytes:
    nodes = "".join(
        f'<node id="n{k + 1}">' + 10 * f'<instance_node url="#n{k}"/>' + "</node>"
        for k in range(12)
    )
    nodes = f'<library_nodes><node id="n0"/>{nodes}</library_nodes>'
    scene = '<node><instance_node url="#n12"/></node>'
    return dae(POINTS, FANS, nodes=nodes, scene=scene)


def zipped() -> bytes:
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w") as file:
        file.writestr("a.dae", dae(POINTS, FANS))
    return held.getvalue()


ENTITY = b'<!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/passwd">]>\n'
CUBE = np.vstack([POINTS[:5], [[np.nan, 0, 0]]])
HOSTILE: dict[str, tuple[str, bytes, str]] = {
    "a bomb": (".vtp", bomb(64, 2**24, 2**24), "more than 200 MB"),
    "a bomb that lies": (".vtp", bomb(1, 2**28, 64), "no whole mesh"),
    "entities": (".dae", dae(POINTS, FANS).replace(b"<COLLADA", ENTITY + b"<COLLADA"), "not plain"),
    "entities of VTK": (".vtp", ENTITY + vtp(POINTS, FANS), "not plain XML"),
    "a laughing scene": (".dae", laughing(), "more than 20000 parts"),
    "a zip": (".dae", zipped(), "not plain XML"),
    "faces out of range": (".obj", obj(POINTS, [[0, 1, 6]]), "outside its 6"),
    "faces before the first": (".obj", obj(POINTS, [[-1, 1, 2]]), "a corner outside|no whole"),
    "not a number": (".ply", ply(CUBE, TRIANGLES), "finite"),
    "infinite": (".stl", stl(np.inf * POINTS, TRIANGLES), "finite"),
    "no triangle": (".stl", stl(POINTS, np.empty((0, 3), int)), "no triangles"),
    "lines": (".obj", obj(POINTS, [[0, 1]]), "no triangles"),
    "huge counts": (".stl", bytes(80) + b"\xff\xff\xff\xff", "no whole mesh"),
    "huge counts of PLY": (".ply", ply(POINTS, FANS).replace(b"face 3", b"face 3000000000"),
                           "no whole mesh"),
    "no properties": (".ply", b"ply\nformat ascii 1.0\nelement x 999999999\nend_header\n",
                      "no whole mesh"),
    "huge polygons": (".dae", dae(POINTS, POLYGONS).replace(b"<vcount>3 4", b"<vcount>3 2000000000"
                      ), "no whole mesh|no triangles"),
    "huge words": (".obj", b"v 1 2 " + b"9" * 10**6 + b"\nf 1 1 1\n" + b"v 1 1 1\n" * 10**5,
                   "finite|no whole"),
    "offsets that go back": (".vtp", vtp(POINTS, FANS).replace(b">3 6 9<", b">9 6 3<"), "no whole"),
    "another kind": (".vtp", vtp(POINTS, FANS).replace(b"PolyData", b"ImageData"), "no whole mesh"),
    "a compressor nobody has": (".vtp", vtp(POINTS, FANS).replace(
        b'version="1.0"', b'compressor="vtkLZ4DataCompressor"'), "no whole mesh"),
    "nothing": (".dae", b"", "not plain XML"),
    "a corner that is no number": (".ply", ply(POINTS, FANS).replace(b"\n3 0 1 2", b"\n3 0 nan 2"),
                                   "outside|no whole"),
    "a length below nothing": (".ply", ply(POINTS, FANS).replace(b"\n3 0 1 2", b"\n-1 0 1 2"),
                               "no whole"),
    "too far away": (".stl", stl(1e20 * POINTS, TRIANGLES), "below 1e9"),
}  # fmt: skip


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_mesh_is_refused_in_a_sentence(name: str, tmp_path: Path) -> None:
    """And nothing else is said."""
    ending, data, reason = HOSTILE[name]
    path = stored(tmp_path, data, "a" + ending)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(so.SomersaultError, match=reason):
            MeshFile(contents=Contents(path), named="a").solids()


def test_thousands_of_faces_at_one_vertex_take_no_more_memory_than_elsewhere() -> None:
    """A cone: its sides are so narrow that each may have the normal that it has."""
    angles = np.linspace(0, 2 * np.pi, 3000, endpoint=False)
    rim = np.stack([np.cos(angles), np.sin(angles), np.zeros(3000)], -1)
    here = np.arange(3000)
    faces = np.stack([here, (here + 1) % 3000, np.full(3000, 3000)], -1)
    cone = Mesh(vertices=np.vstack([rim, [[0.0, 0.0, 1.0]]]), faces=faces)
    tracemalloc.start()
    try:
        surface = cone.triangles
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert most < 2**25
    out = surface.vertices * [1.0, 1.0, 0.0]
    steep = surface.normals[np.linalg.norm(out, axis=1) > 0.5]  # at the rim
    assert np.abs(steep[:, 2] - np.sqrt(0.5)).max() < 1e-5
    tip = surface.normals[np.linalg.norm(out, axis=1) < 0.5]
    assert np.abs(tip[:, 2] - np.sqrt(0.5)).max() < 1e-5  # of the sides, and not their mean


def test_a_bomb_is_not_unpacked() -> None:
    data = bomb(1, 2**28, 64)
    tracemalloc.start()
    with pytest.raises(so.SomersaultError):
        parts_of(".vtp", data)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 2**25


def test_a_shape_scaled_to_nothing_is_refused(tmp_path: Path) -> None:
    flat = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.0))
    with pytest.raises(so.SomersaultError, match="give it a scale"):
        MeshFile(contents=Contents(tmp_path / "a.stl"), named="a", form=flat)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(
    name=st.sampled_from(sorted(WHOLE)),
    cut=st.floats(0, 1),
    changes=st.lists(st.tuples(st.floats(0, 1), st.binary(max_size=3)), max_size=4),
)
def test_whatever_is_in_a_mesh_it_is_read_or_refused(name: str, cut: float, changes: Any) -> None:
    ending, data, _ = WHOLE[name]
    for at, new in changes:
        place = int(at * len(data))
        data = data[:place] + new + data[place + 1 :]
    if not changes:
        data = data[: int(cut * len(data))]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            for part in parts_of(ending, data):
                Mesh(vertices=part.vertices, faces=part.faces)
        except so.SomersaultError:
            pass
