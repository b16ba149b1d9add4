"""Pages hold what the motion was, below 1.5 MB, and show text as text."""

from __future__ import annotations

import base64
import json
import os
import re
import shutil
import subprocess
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import somersault as so
from somersault import rigid
from somersault.attitude import matrix_from_quaternion
from somersault.cli import main
from somersault.flight import Flight, principal_axes_along
from somersault.history import Recording
from somersault.model import body_frames
from somersault.model.shapes import Mesh
from somersault.view import check_page, page

ROOT = Path(__file__).parents[1]
WEB = ROOT / "web"
COMMITTED = ROOT / "src" / "somersault" / "view" / "web"
MOST_BYTES = 1_500_000
KINDS = {"f4": "<f4", "u2": "<u2", "u4": "<u4"}


@cache
def tilted_book() -> Flight:
    return so.fly("book", so.Takeoff(spin=6.0, tilt=0.1, velocity=(1.0, 0.0, 3.0)), 2.0)


@cache
def twister() -> Flight:
    return so.arm_tilt(duration=0.6).fly()


def record_of(path: Path) -> dict:
    text = path.read_text(encoding="utf-8")
    found = re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.DOTALL)
    assert found is not None
    return json.loads(found[1])


def numbers(block: dict) -> np.ndarray:
    return np.frombuffer(base64.b64decode(block["base64"]), KINDS[block["type"]])


def test_bodies_stand_where_the_flight_has_them(tmp_path: Path) -> None:
    flight = twister()
    page(flight, tmp_path / "a.html")
    told = record_of(tmp_path / "a.html")["flights"][0]
    times = numbers(told["times"])
    frames = numbers(told["frames"]).reshape(len(times), len(flight.model.bodies), 7)
    keep = np.searchsorted(flight.times, times - 1e-5)
    rotations, origins = body_frames(flight.model, flight.joint_coordinates[keep])
    turns = matrix_from_quaternion(flight.base_quaternion[keep])
    places = np.einsum("tij,tbj->tbi", turns, origins) + flight.base_position[keep][:, None]
    np.testing.assert_allclose(frames[..., :3], places, atol=2e-6)  # 2-1-3 has the stage's axes
    np.testing.assert_allclose(
        matrix_from_quaternion(frames[..., 3:].astype(float)),
        turns[:, None] @ rotations,
        atol=2e-6,
    )


def test_the_sphere_is_that_of_the_principal_axes(tmp_path: Path) -> None:
    flight = twister()
    page(flight, tmp_path / "a.html")
    told = record_of(tmp_path / "a.html")["flights"][0]
    keep = np.searchsorted(flight.times, numbers(told["times"]) - 1e-5)
    about = principal_axes_along(flight)
    inertias = numbers(told["sphere"]["inertias"]).reshape(-1, 3)
    np.testing.assert_allclose(inertias, about.inertias[keep], rtol=1e-6)
    turn = matrix_from_quaternion(flight.base_quaternion) @ about.axes
    h = np.einsum("tij,ti->tj", turn, flight.angular_momentum)
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    direction = numbers(told["sphere"]["direction"]).reshape(-1, 3)
    np.testing.assert_allclose(direction, h[keep], atol=1e-6)


def test_a_rigid_body_stays_on_its_energy_curve(tmp_path: Path) -> None:
    flight = tilted_book()
    page(flight, tmp_path / "a.html")
    sphere = record_of(tmp_path / "a.html")["flights"][0]["sphere"]
    inertias = numbers(sphere["inertias"]).reshape(-1, 3).astype(float)
    direction = numbers(sphere["direction"]).reshape(-1, 3).astype(float)
    energy = np.sum(direction**2 / inertias, 1)
    assert np.ptp(energy) < 1e-5 * energy[0]
    least, _, greatest = rigid.energy_bounds(inertias[0], 1.0)
    assert least < energy[0] / 2 < greatest


def test_a_page_of_two_long_flights_is_small(tmp_path: Path) -> None:
    long = so.fly("gymnast", so.Takeoff(spin=6.0, tilt=0.1), 4.0, samples=4001)
    page([long, long], tmp_path / "a.html", labels=["one", "two"])
    assert (tmp_path / "a.html").stat().st_size < MOST_BYTES
    assert len(record_of(tmp_path / "a.html")["models"]) == 1


def test_meshes_are_made_coarser(tmp_path: Path) -> None:
    angle = np.linspace(0, 2 * np.pi, 401)[:-1]
    rings = np.linspace(-1, 1, 300)
    points = np.stack(
        [np.outer(np.ones(300), np.cos(angle)), np.outer(np.ones(300), np.sin(angle)),
         np.outer(rings, np.ones(400))], -1,
    ).reshape(-1, 3)  # fmt: skip
    here = np.arange(299 * 400)
    faces = np.concatenate(
        [np.stack([here, here + 1, here + 400], 1), np.stack([here + 1, here + 401, here + 400], 1)]
    )
    faces = faces[faces.max(1) < len(points)]
    flight = tilted_book()
    mesh = Mesh(vertices=points, faces=faces)
    body = replace(flight.model.bodies[0], shapes=(mesh,))
    heavy = replace(flight, model=replace(flight.model, bodies=(body,)))
    page(heavy, tmp_path / "a.html")
    shape = record_of(tmp_path / "a.html")["models"][0]["bodies"][0]["shapes"][0]
    kept = numbers(shape["faces"]).reshape(-1, 3)
    assert 2_000 < len(kept) <= 12_000
    radius = np.linalg.norm(numbers(shape["vertices"]).reshape(-1, 3)[:, :2], axis=1)
    np.testing.assert_allclose(radius, 1, atol=0.02)


def test_on_a_fixed_base_there_is_no_sphere(tmp_path: Path) -> None:
    pendulum = so.load("gymnast", base="fixed")
    q = pendulum.home
    still = Recording(
        pendulum, [0.0, 1.0], np.zeros((2, 3)), [[1.0, 0, 0, 0]] * 2, np.tile(q, (2, 1))
    )
    page(still, tmp_path / "a.html")
    told = record_of(tmp_path / "a.html")["flights"][0]
    assert told["sphere"] is None
    assert told["vectors"]["momentum"]["longest"] == 0
    assert [panel["unit"] for panel in told["panels"]] == ["°"]


def test_what_cannot_be_a_page_is_one_sentence(tmp_path: Path) -> None:
    flight = tilted_book()
    with pytest.raises(so.SomersaultError, match=r"other ending than \.html"):
        page(flight, tmp_path / "a.pdf")
    with pytest.raises(so.SomersaultError, match="2 labels; give one for each"):
        page(flight, tmp_path / "a.html", labels=["a", "b"])
    with pytest.raises(so.SomersaultError, match="flights, swings or recordings"):
        page([flight, 3], tmp_path / "a.html")  # type: ignore[list-item]
    with pytest.raises(so.SomersaultError, match="1 to 12"):
        page([], tmp_path / "a.html")
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root writes everywhere")
def test_a_folder_that_cannot_be_written_is_noticed(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(so.SomersaultError, match="cannot be written"):
        check_page(tmp_path / "a.html")


def test_the_place_is_checked_before_flying(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    for place in (tmp_path / "a.txt", tmp_path / "file" / "a.html"):
        assert main(["fly", str(tmp_path / "there_is_no.toml"), "--page", str(place)])
        said = capsys.readouterr().err
        assert said.count("\n") == 1
        assert "there_is_no" not in said


def test_fly_writes_a_page(tmp_path: Path) -> None:
    spec = tmp_path / "book.toml"
    spec.write_text('model = "book"\nduration = 1.0\n[takeoff]\nspin = 6.0\ntilt = 0.1\n')
    assert not main(["fly", str(spec), "--page", str(tmp_path / "book.html")])
    assert record_of(tmp_path / "book.html")["title"] == "book"
    assert [path.name for path in tmp_path.glob("book.h*")] == ["book.html"]


def test_no_text_ends_its_element(tmp_path: Path) -> None:
    evil = "</script><script>alert(1)</script><!--"
    page(tilted_book(), tmp_path / "a.html", labels=[evil], title=evil)
    text = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert text.count("</script") == 2  # the data's and the script's own
    assert "<script>alert" not in text
    assert record_of(tmp_path / "a.html")["flights"][0]["label"] == evil


def test_pages_carry_the_licences() -> None:
    notices = (COMMITTED / "NOTICES.txt").read_text(encoding="utf-8")
    assert "three 0." in notices
    assert "uplot 1." in notices
    assert notices.count("Permission is hereby granted") == 2
    assert (COMMITTED / "page.js").stat().st_size < 800_000


def test_the_lock_file_holds_no_addresses() -> None:
    lock = json.loads((WEB / "package-lock.json").read_text(encoding="utf-8"))
    assert not [name for name, entry in lock["packages"].items() if "resolved" in entry]


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("npm") is None, reason="npm is not there")
def test_the_script_is_built_from_its_source(tmp_path: Path) -> None:
    web, out = tmp_path / "web", tmp_path / "out"
    shutil.copytree(WEB, web, ignore=shutil.ignore_patterns("node_modules"))
    for command in (["npm", "ci", "--ignore-scripts"], ["node", "build.mjs", str(out)]):
        ran = subprocess.run(command, cwd=web, capture_output=True, encoding="utf-8", timeout=300)
        assert ran.returncode == 0, ran.stderr
    for name in ("page.js", "NOTICES.txt"):
        assert (out / name).read_bytes() == (COMMITTED / name).read_bytes(), (
            f"{name} is not what web/ builds: run `npm ci && npm run build` there"
        )
