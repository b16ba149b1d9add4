"""Pixels that must be, whatever the renderer."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest

import somersault as so
from somersault.model.shapes import Box, Mesh, Sphere, coarser
from somersault.view import _meshes
from somersault.view._actor import Actor
from somersault.view._canvas import Canvas, Ground, Surface, lamp_direction
from somersault.view._eye import Eye
from somersault.view._ground import BACKDROP
from somersault.view._meshes import figure_of
from somersault.view._stage import Stage

RED, BLUE = (0.8, 0.1, 0.1), (0.1, 0.1, 0.8)
FRONT = Eye(np.zeros(3), 0.0, 0.0, 1.0, 400, 400)


def painted(shape, color, closed=1.0):
    triangles = shape.triangles
    paint = np.tile([*color, closed], (len(triangles.faces), 1))
    return Surface(triangles.faces, paint), triangles.vertices, triangles.normals


def drawn(*shapes, eye=FRONT, ground=None, ghosts=()):
    canvas = Canvas(eye.width, eye.height)
    canvas.begin(eye, ground)
    if ground is not None:
        for surface, points, _ in shapes:
            canvas.shadow(eye, surface, points, ground.level)
    for surface, points, normals in shapes:
        canvas.draw(eye, surface, points, normals)
    for surface, points, normals in ghosts:
        canvas.draw(eye, surface, points, normals, ghost=True)
    canvas.finish(0.5)
    return canvas.image[..., :3].astype(float)


def is_red(image):
    return image[..., 0] > image[..., 2] + 30


def is_blue(image):
    return image[..., 2] > image[..., 0] + 30


def test_a_sphere_fills_the_disc_that_perspective_gives_it():
    """Seen from a distance d, a sphere of radius r is a disc of radius f r / √(d² − r²)."""
    image = drawn(painted(Sphere(radius=0.6), RED))
    radius = FRONT.focal * 0.6 / np.sqrt(FRONT.distance**2 - 0.36)
    inscribed = np.sin(2 * np.pi / 24) / (2 * np.pi / 24)  # a polygon of 24 sides
    assert inscribed**2 < is_red(image).sum() / (np.pi * radius**2) < 1.0
    rows, columns = np.nonzero(is_red(image))
    assert rows.mean() == pytest.approx(199.5, abs=0.6)
    assert columns.mean() == pytest.approx(199.5, abs=0.6)


def test_a_sphere_is_brightest_towards_the_lamp():
    image = drawn(painted(Sphere(radius=0.6), RED)).sum(-1)
    lamp = FRONT.rows @ lamp_direction(FRONT)
    step = 0.75 * FRONT.focal * 0.6 / FRONT.distance * lamp[:2] / np.linalg.norm(lamp[:2])
    near = image[round(200 - step[1]), round(200 + step[0])]
    far = image[round(200 + step[1]), round(200 - step[0])]
    assert near > image[200, 200] * 0.8
    assert near > 1.5 * far


def test_edges_are_smooth():
    """A slanting edge has pixels of shades between the face's and the backdrop's."""
    turn = np.array([[1, 0, 0], [0, 0.96, -0.28], [0, 0.28, 0.96]])
    box = Box(half_sizes=(0.1, 0.4, 0.4), rotation=tuple(map(tuple, turn)))
    image = drawn(painted(box, RED))
    assert len(np.unique(image[100:300, :, 1].round())) > 3


@pytest.mark.parametrize("turned", [False, True])
def test_what_is_nearer_hides_what_is_farther(turned):
    front = painted(Box(half_sizes=(0.1, 0.2, 0.2), position=(0.5, 0.0, 0.0)), RED)
    back = painted(Box(half_sizes=(0.1, 0.3, 0.3), position=(-0.5, 0.0, 0.0)), BLUE)
    image = drawn(*((back, front) if turned else (front, back)))
    assert is_red(image)[190:210, 190:210].all()
    assert is_blue(image).any()


def test_nothing_is_drawn_of_what_is_behind_the_eye():
    behind = painted(Sphere(radius=0.3, position=(10.0, 0.0, 0.0)), RED)
    assert np.array_equal(drawn(behind), drawn())


def test_what_reaches_behind_the_eye_or_beyond_the_edge_does_no_harm():
    wall = painted(Box(half_sizes=(50.0, 30.0, 0.01), position=(0.0, 0.0, -0.5)), RED)
    beside = painted(Sphere(radius=0.3, position=(0.0, 1e6, 0.0)), RED)
    image = drawn(wall, beside)
    assert np.isfinite(image).all()
    big = painted(Sphere(radius=3.0), BLUE)
    assert is_blue(drawn(big)).mean() > 0.9


def test_a_ghost_is_seen_through_and_hidden_by_what_is_before_it():
    solid = painted(Box(half_sizes=(0.1, 0.2, 0.2)), RED)
    veil = painted(Box(half_sizes=(0.1, 0.5, 0.5), position=(-0.5, 0.0, 0.0)), BLUE)
    image = drawn(solid, ghosts=(veil,))
    assert np.array_equal(image[200, 200], drawn(solid)[200, 200])
    through, empty = image[200, 120], drawn()[200, 120]
    full = drawn(veil)[200, 120]
    assert through == pytest.approx((full + empty) / 2, abs=2)


def test_the_shadow_falls_where_the_light_says():
    """A small sphere's shadow is where the ray through its middle meets the ground."""
    eye = Eye(np.zeros(3), 20.0, 35.0, 1.5, 600, 600)
    place = np.array([0.1, -0.2, 0.4])
    ball = painted(Sphere(radius=0.12, position=tuple(place)), RED)
    ground = Ground(-0.6, 10.0, 5.0, (3.3, 4.7))
    image, empty = drawn(ball, eye=eye, ground=ground), drawn(eye=eye, ground=ground)
    dark = (empty - image).min(-1) > 20
    dark &= ~is_red(image)
    lamp = lamp_direction(eye)
    fallen = place - (place[2] + 0.6) / lamp[2] * lamp
    column, row, _ = eye.project(fallen[None])[0]
    rows, columns = np.nonzero(dark)
    assert rows.mean() + 0.5 == pytest.approx(row, abs=2.5)
    assert columns.mean() + 0.5 == pytest.approx(column, abs=2.5)


def test_the_grid_stands_where_the_ground_says():
    eye = Eye(np.zeros(3), 0.0, 60.0, 2.0, 600, 600)
    image = drawn(eye=eye, ground=Ground(0.0, 1.0, 50.0, (0.0, 0.0)))[..., 1]
    for point in ((0.0, 0.5), (1.0, 0.3), (-0.4, 1.0)):
        column, row, _ = eye.project(np.array([[*point, 0.0]]))[0]
        near = image[int(row) - 2 : int(row) + 3, int(column) - 2 : int(column) + 3]
        assert near.min() < image[int(row) + 14, int(column) + 14] - 8


def test_a_frame_forgets_the_one_before():
    canvas = Canvas(200, 100)
    eye = Eye(np.zeros(3), 0.0, 0.0, 1.0, 200, 100)
    canvas.begin(eye, None)
    canvas.finish()
    empty = canvas.image.copy()
    surface, points, normals = painted(Sphere(radius=0.5), RED)
    for shift in (0.0, 0.7):
        canvas.begin(eye, None)
        canvas.draw(eye, surface, points + np.array([0, shift, 0]), normals)
        canvas.finish()
    canvas.begin(eye, None)
    canvas.finish()
    assert np.array_equal(canvas.image, empty)


def test_an_open_surface_is_seen_from_both_sides():
    corners = np.array([[0.0, -0.5, -0.5], [0.0, 0.5, -0.5], [0.0, 0.5, 0.5], [0.0, -0.5, 0.5]])
    for faces in ([[0, 1, 2], [0, 2, 3]], [[2, 1, 0], [3, 2, 0]]):
        plate = Mesh(vertices=corners, faces=np.array(faces))
        assert is_red(drawn(painted(plate, RED, closed=0.0)))[200, 200]


def globe(rings):
    """A sphere of 2 rings² triangles."""
    up = np.linspace(0, np.pi, rings + 1)
    around = np.linspace(0, 2 * np.pi, rings, endpoint=False)
    points = np.stack([
        np.outer(np.sin(up), np.cos(around)), np.outer(np.sin(up), np.sin(around)),
        np.outer(np.cos(up), np.ones(rings)),
    ], -1).reshape(-1, 3)  # fmt: skip
    row, column = np.meshgrid(np.arange(rings), np.arange(rings), indexing="ij")
    a = row * rings + column
    b = row * rings + (column + 1) % rings
    faces = np.stack([np.stack([a, a + rings, b], -1), np.stack([b, a + rings, b + rings], -1)])
    return Mesh(vertices=points, faces=faces.reshape(-1, 3))


def test_a_million_triangles_become_few_and_keep_their_outline():
    mesh = globe(720)
    assert len(mesh.faces) > 1_000_000
    start = time.monotonic()
    few = coarser(mesh, 20_000)
    assert len(few.faces) <= 20_000
    assert time.monotonic() - start < 30  # some 2 s on an idle core
    whole, seen = (is_red(drawn(painted(m, RED, closed=0.0))).sum() for m in (globe(90), few))
    assert seen == pytest.approx(whole, rel=0.02)


def test_a_model_of_too_many_triangles_is_refused(monkeypatch):
    monkeypatch.setattr(_meshes, "_MOST_READ", 100)
    book = so.load("book")
    body = book.bodies[0]
    heavy = replace(book, bodies=(replace(body, shapes=(globe(20),)),))
    with pytest.raises(so.SomersaultError, match="too many to draw"):
        figure_of(heavy)


def test_vectors_are_those_of_the_flight():
    """Differences of what a history holds give its angular momentum and velocity."""
    flight = so.fly("furrer", so.Takeoff(spin=8.0, tilt=0.1), 1.0, samples=400)
    found = Actor(flight, flight.times[1:-1]).vectors
    inner = flight.angular_momentum[1:-1]
    assert np.abs(found["momentum"] - inner).max() < 2e-3 * np.linalg.norm(inner[0])


def test_an_eye_that_follows_sees_a_flight_as_if_it_stayed_in_place():
    frames = []
    for velocity in ([0.0, 0.0, 0.0], [3.0, 0.0, 2.0]):
        flight = so.fly("book", so.Takeoff(spin=3.0, velocity=velocity), 1.0)
        actor = Actor(flight, np.linspace(0, 1, 5))
        stage = Stage([actor], [], 320, 180, (30.0, 10.0), ground=False)
        frames.append([stage.draw([k]).astype(int) for k in range(5)])
    for still, flying in zip(*frames, strict=True):
        assert (np.abs(still - flying).max(-1) > 40).mean() < 1e-3
    assert np.abs(frames[0][0] - frames[0][3]).max() > 40


def test_an_eye_that_stands_still_sees_the_whole_way():
    flight = so.fly("book", so.Takeoff(spin=3.0, velocity=[0.0, 3.0, 0.0]), 1.0)
    actor = Actor(flight, np.linspace(0, 1, 5))
    stage = Stage([actor], [], 320, 180, (0.0, 10.0), follow=False, ground=False)
    places = []
    for k in range(5):
        away = np.abs(stage.draw([k])[..., :3].astype(int) - BACKDROP).max(-1) > 10
        assert not away[[0, -1]].any()
        assert not away[:, [0, -1]].any()
        places.append(np.nonzero(away)[1].mean())
    assert (np.diff(places) > 30).all()  # to the body's left, at the viewer's right
