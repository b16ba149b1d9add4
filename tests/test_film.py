"""Films are whole, last as long as they should, and are made without a screen."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
import warnings
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import somersault as so
from somersault.view import film, frame, picture, stroboscopic_picture

SIZE = (160, 90)
EXAMPLE = Path(__file__).parents[1] / "examples" / "layout.toml"


@pytest.fixture(scope="module")
def flight():
    return so.fly("furrer", so.Takeoff(spin=8.6, tilt=0.05), 0.5)


def read(path):
    """Frames of a film (n, height, width, 3), and how long it lasts, by PyAV."""
    av = pytest.importorskip("av")
    with av.open(str(path)) as file:
        frames = [f.to_ndarray(format="rgb24") for f in file.decode(video=0)]
        stream = file.streams.video[0]
        rate = float(stream.average_rate)
        length = file.duration / av.time_base
    return np.array(frames), rate, length


@pytest.mark.parametrize("ending", ["mp4", "webm", "gif"])
@pytest.mark.parametrize(("speed", "fps", "count"), [(1.0, 20, 11), (0.25, 10, 21)])
def test_a_film_lasts_as_long_as_it_should(flight, tmp_path, ending, speed, fps, count):
    file = tmp_path / f"a.{ending}"
    flight.film(file, fps=fps, speed=speed, size=SIZE)
    frames, rate, length = read(file)
    assert frames.shape == (count, 90, 160, 3)
    assert rate == pytest.approx(fps, rel=0.02)
    assert length == pytest.approx(count / fps, rel=0.11)


@pytest.mark.parametrize("ending", ["mp4", "webm", "gif"])
def test_the_frames_of_a_film_are_the_frames(flight, tmp_path, ending):
    file = tmp_path / f"a.{ending}"
    flight.film(file, fps=10, size=SIZE, vectors="momentum")
    frames, _, _ = read(file)
    for k in (0, 3, 5):
        seen = flight.frame(k / 10, size=SIZE, vectors="momentum").astype(float)
        assert np.abs(frames[k] - seen).mean() < 4
    assert np.abs(frames[0].astype(float) - frames[3]).mean() > 4


def test_any_name_can_be_written(flight):
    """Names of models come from files: long ones are cut, and signs that are none left out."""
    plain = flight.frame(0.1, size=SIZE)
    for name in ("x" * 1_000_000, "two\nlines\x00", "", "</script>", "体操 🤸"):
        seen = frame(flight, 0.1, size=SIZE, labels=[name])
        assert np.array_equal(seen[80:], plain[80:])


def test_a_long_label_is_broken_and_charts_keep_their_room(flight):
    short = frame([flight, flight], 0.1, size=(640, 360), labels=["one", "two"], charts=True)
    names = ["a name of many words " * 9, "$\\frac{$ is not mathematics"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # matplotlib's, where charts find no room
        long = frame([flight, flight], 0.1, size=(640, 360), labels=names, charts=True)
    # The last chart stands as it did: nothing is squeezed out at the left or the right.
    assert np.array_equal(long[340:, 404:], short[340:, 404:])
    first = slice(0, 201)  # the left panel: more lines, the last of them cut with "…"
    assert (long[20:60, first] != short[20:60, first]).any()
    assert np.array_equal(long[120:, first], short[120:, first])


def test_an_arrow_is_told_as_long_as_it_is_at_the_moment(monkeypatch):
    said = []
    monkeypatch.setattr(
        "somersault.view._scene.write_on", lambda p, at, words, *_: said.append(words)
    )
    takeoff = so.Takeoff(spin=8.6, tilt=0.3)
    flight = so.fly("book", takeoff, 1.0, samples=2001)
    flight.frame(0.7, size=SIZE, vectors=["spin"])
    omega = np.linalg.norm(flight.angular_velocity[1400])
    assert said[-1] == f"angular velocity {omega:.3g} rad/s"
    assert f"{omega:.3g}" != f"{np.linalg.norm(flight.angular_velocity[0]):.3g}"


@pytest.mark.parametrize("time", [-0.1, 0.6])
def test_there_is_nothing_to_be_seen_before_the_beginning_and_after_the_end(flight, tmp_path, time):
    for draw in (
        lambda: flight.frame(time, size=SIZE),
        lambda: flight.picture(tmp_path / "a.png", [0.0, time], size=SIZE),
        lambda: stroboscopic_picture(flight, tmp_path / "a.png", [0.0, time], size=SIZE),
    ):
        with pytest.raises(so.SomersaultError, match=f"{time} s .* from 0 to 0.5 s"):
            draw()
    # Beside one that flies on it stays as it landed.
    longer = so.fly("furrer", so.Takeoff(spin=8.6), 0.7)
    frame([flight, longer], 0.6, size=SIZE)
    flight.frame(0.1 + 0.2 + 0.2 + 1e-12, size=SIZE)


def test_films_repeat(flight, tmp_path):
    for name in ("a.mp4", "b.mp4"):
        flight.film(tmp_path / name, fps=10, size=SIZE)
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()


def test_charts_stand_beside_and_their_line_goes_along(flight, tmp_path):
    places = []
    for moment in (0.1, 0.3):
        seen = flight.frame(moment, size=(640, 360), charts=True)
        plain = flight.frame(moment, size=(640, 360))
        assert np.abs(seen[:, 410:].astype(int) - plain[:, 410:]).max() > 100
        columns = seen[20:80, 460:620].astype(int).sum(-1).max(0)  # beside the axis
        assert columns.min() < 600
        places.append(columns.argmin())
    assert places[1] == pytest.approx(places[0] + 0.2 / 0.5 * 170, abs=2)


def test_histories_stand_side_by_side(flight, tmp_path):
    other = so.fly("furrer", so.Takeoff(spin=-8.6), 0.5)
    both = frame([flight, other], 0.1, size=(320, 180), labels=["one", "two"]).astype(int)
    assert np.abs(both[:, :160] - both[:, 160:]).max() > 100
    alike = frame([flight, flight], 0.1, size=(320, 180)).astype(int)
    assert np.array_equal(alike[:, :160], alike[:, 160:])


def test_a_ghost_is_another_flight(flight):
    other = so.fly("furrer", so.Takeoff(spin=4.0), 0.5)
    plain = flight.frame(0.2, size=SIZE).astype(int)
    assert np.array_equal(flight.frame(0.2, size=SIZE, ghosts=()), plain)
    assert np.abs(flight.frame(0.2, size=SIZE, ghosts=other) - plain).max() > 20


def test_swings_and_recordings_are_filmed(flight, tmp_path):
    model = flight.model
    recording = so.Recording(
        model, flight.times, flight.base_position, flight.base_quaternion, flight.joint_coordinates
    )
    assert np.array_equal(frame(recording, 0.2, size=SIZE), flight.frame(0.2, size=SIZE))
    arm = so.load("simplest", base="fixed")
    arm_swing = so.swing(arm, {"arm": 0.4}, 0.5)
    arm_swing.film(tmp_path / "swing.gif", fps=10, size=SIZE, charts=False)
    assert read(tmp_path / "swing.gif")[0].shape[0] == 6


def test_pictures(flight, tmp_path):
    from PIL import Image

    flight.picture(tmp_path / "one.png", 0.1, size=SIZE)
    assert Image.open(tmp_path / "one.png").size == SIZE
    flight.picture(tmp_path / "sheet.png", [0.0, 0.1, 0.2], columns=2, size=(100, 120))
    assert Image.open(tmp_path / "sheet.png").size == (200, 240)
    picture(flight, tmp_path / "all.png")
    assert Image.open(tmp_path / "all.png").size == (1440, 640)


@pytest.mark.parametrize("follow", [True, False])
def test_a_picture_is_a_frame_of_the_film(tmp_path, follow):
    from PIL import Image

    rising = so.Takeoff(spin=8.6, velocity=(2.0, 0.0, 3.0))
    flight = so.fly("furrer", rising, 0.5, gravity=(0.0, 0.0, -9.81))
    flight.picture(tmp_path / "one.png", 0.2, size=SIZE, follow=follow)
    flight.picture(tmp_path / "two.png", [0.2, 0.1], size=SIZE, follow=follow)
    seen = flight.frame(0.2, size=SIZE, follow=follow)
    assert np.array_equal(np.asarray(Image.open(tmp_path / "one.png")), seen)
    both = np.asarray(Image.open(tmp_path / "two.png")).astype(int)[:, : SIZE[0]]
    assert (np.abs(both - seen).max(-1) > 40).mean() < 0.01  # edges fall otherwise


def test_a_stroboscope_shows_the_parabola(tmp_path):
    from PIL import Image

    start = so.Takeoff(velocity=[2.0, 0.0, 3.0])
    flight = so.fly("book", start, 0.6, gravity=[0.0, 0.0, -9.81])
    stroboscopic_picture(flight, tmp_path / "a.png", 3, size=(640, 360), ground=False)
    image = np.asarray(Image.open(tmp_path / "a.png")).astype(int)
    red = image[..., 0] - image[..., 2] > 25
    columns = red.any(0)
    groups = np.flatnonzero(np.diff(columns.astype(int)) == 1)
    assert len(groups) == 3  # three books beside one another, the middle one highest
    tops = [red[:, start + 5].argmax() for start in groups]
    assert tops[1] < min(tops[0], tops[2]) - 20
    with pytest.raises(so.SomersaultError, match="stays in place"):
        so.fly("book", so.Takeoff(spin=1.0), 1.0).stroboscopic_picture(tmp_path / "b.png")


def test_attitudes_turn_evenly_between_samples():
    """Of a body that turns evenly, frames between samples far apart are where they should be."""
    often = so.fly("book", so.Takeoff(spin=6.0), 0.5, samples=101)
    seldom = so.Recording(
        often.model,
        *(x[::20] for x in (often.times, often.base_position, often.base_quaternion,
                            often.joint_coordinates)),
    )  # fmt: skip
    for moment in (0.05, 0.235, 0.49):
        away = np.abs(
            often.frame(moment, size=SIZE)[40:].astype(int) - frame(seldom, moment, size=SIZE)[40:]
        )
        assert (away.max(-1) > 60).mean() < 2e-3


BARE = """
import re, sys
from pathlib import Path
sys.modules.update({name: None for name in
    ("mujoco", "OpenGL", "glfw", "tkinter", "PyQt5", "PyQt6", "vtk", "wgpu")})
import somersault as so
flight = so.fly(so.athlete(1.70, 65.0), so.Takeoff(spin=8.6, tilt=0.05), 0.2)
flight.film("a.gif", fps=10, size=(160, 90))
flight.picture("a.png", 0.1, charts=True)
flight.page("a.html")
assert "matplotlib.pyplot" not in sys.modules
maps = Path("/proc/self/maps")
if maps.exists():
    graphics = r"/lib(?:GL|EGL|GLX|OpenGL|GLdispatch|OSMesa|X11|vulkan|gbm|glfw)[-.\\w]*"
    assert not re.findall(graphics, maps.read_text())
"""
# Whatever graphics library there is becomes an empty file, for this process alone.
HIDDEN = """
for file in $(ls /usr/lib*/lib*.so* /usr/lib/*/lib*.so* 2>/dev/null |
        grep -E '/lib(GL|EGL|OpenGL|OSMesa|X11|vulkan|gbm|gallium|drm)'); do
    mount --bind /dev/null "$(readlink -f "$file")" || exit 77
done
exec "$@"
"""


def bare(folder, *before):
    """`env -i`: not even a home; nothing that could help a renderer of somebody else's."""
    kept = ("SYSTEMROOT", "LD_LIBRARY_PATH")
    environment = {k: v for k, v in os.environ.items() if k in kept}
    environment["PYTHONPATH"] = str(Path(so.__file__).parents[1])
    run = subprocess.run(
        [*before, sys.executable, "-c", BARE], cwd=folder, env=environment, timeout=600,
        capture_output=True, encoding="utf-8",
    )  # fmt: skip
    if before and run.returncode in (1, 77, 126, 127) and "mount" in run.stderr + run.stdout:
        pytest.skip("libraries can be hidden by root alone")
    assert run.returncode == 0, run.stderr
    assert read(folder / "a.gif")[0].shape == (3, 90, 160, 3)


def test_neither_screen_nor_environment_nor_mujoco_is_needed(tmp_path):
    bare(tmp_path)


@pytest.mark.skipif(
    not (sys.platform == "linux" and shutil.which("unshare") and os.geteuid() == 0),
    reason="libraries can be hidden by root alone",
)
def test_no_graphics_library_is_needed(tmp_path):
    before = [shutil.which("unshare"), "--mount", shutil.which("sh"), "-c", HIDDEN, "sh"]
    bare(tmp_path, *before)


def test_without_pyav_one_is_told_what_to_install(flight, tmp_path, monkeypatch):
    from somersault.view import _encoders

    monkeypatch.setattr(_encoders.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(so.SomersaultError, match=r"pip install somersault\[film\]"):
        flight.film(tmp_path / "a.mp4")
    flight.film(tmp_path / "a.gif", fps=4, size=SIZE)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"size": (161, 90)}, "even numbers"),
        ({"size": (10, 90)}, "width of size must be a whole number from 64"),
        ({"size": (100_000, 90)}, "from 64 to 4096"),
        ({"size": "large"}, "like \\(1280, 720\\)"),
        ({"size": (float("nan"), 90)}, "whole number"),
        ({"fps": 0}, "fps must be"),
        ({"fps": 30.5}, "fps must be"),
        ({"speed": 0.0}, "more than 0"),
        ({"speed": float("inf")}, "speed must be"),
        ({"speed": 1e-7}, "frames"),
        ({"speed": 0.01}, "too many for a .gif"),
        ({"camera": (0, 100)}, "elevation"),
        ({"camera": 3}, "camera must be 2 numbers"),
        ({"vectors": ("torque",)}, "there is no vector 'torque'"),
        ({"ghosts": 3}, "ghosts must be flights"),
        ({"beside": ["furrer"]}, "beside must be flights"),
        ({"labels": ["a", "b"]}, "2 labels for 1"),
        ({"charts": True, "size": (320, 180)}, "no room for charts"),
        ({"charts": 1}, "true or false"),
        ({"colour": "red"}, "no option 'colour'"),
    ],
)
def test_mistakes_are_named_in_a_sentence(flight, tmp_path, options, words):
    with pytest.raises(so.SomersaultError, match=words):
        flight.film(tmp_path / "a.gif", **options)
    assert not list(tmp_path.iterdir())


def test_files_are_refused_before_anything_is_drawn(flight, tmp_path):
    other = "another ending"
    for name, words in (("a.avi", other), ("a", other), ("", "path of a file")):
        with pytest.raises(so.SomersaultError, match=words):
            film(flight, tmp_path / name if name else "")
    (tmp_path / "folder.mp4").mkdir()
    with pytest.raises(so.SomersaultError, match="is a folder"):
        film(flight, tmp_path / "folder.mp4")
    (tmp_path / "file").write_text("")
    with pytest.raises(so.SomersaultError, match=r"a\.mp4 cannot be written"):
        film(flight, tmp_path / "file" / "a.mp4")


def test_a_flight_that_broke_off_is_refused(flight, tmp_path):
    model, count = flight.model, len(flight.times)
    numbers = {"base_position": np.full((count, 3), np.nan), "angles": np.zeros((count, 3))}
    for name in ("times", "base_quaternion", "joint_coordinates"):
        numbers[name] = getattr(flight, name)
    with pytest.raises(so.SomersaultError, match="not finite"):
        film(SimpleNamespace(model=model, **numbers), tmp_path / "a.gif", size=SIZE)


def command(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "somersault", *map(str, arguments)],
        capture_output=True, encoding="utf-8", timeout=300,
    )  # fmt: skip


def test_the_command_checks_the_place_before_it_flies(tmp_path):
    for file in (tmp_path / "a.avi", "/proc/a.mp4" if os.path.isdir("/proc") else tmp_path):
        start = time.monotonic()
        run = command("fly", EXAMPLE, "--video", file)
        assert run.returncode == 2
        assert len(run.stderr.strip().splitlines()) == 1
        assert not run.stdout
        assert time.monotonic() - start < 60


@pytest.mark.slow
def test_the_command_writes_a_film(tmp_path):
    file = tmp_path / "a.mp4"
    run = command("fly", EXAMPLE, "--video", file, "--json")
    assert run.returncode == 0, run.stderr
    frames, rate, _ = read(file)
    assert rate == 30
    assert frames.shape[1:] == (720, 1280, 3)
