"""One picture of how the flights of an ensemble landed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import somersault as so
from somersault.ensembles import landing_map
from somersault.view import landings_picture
from somersault.view.style import BLUE, VERMILION, rgb

LEANT = {"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05])}
CELL, HEAD = (120, 140), 12 + 2 * 26


@pytest.fixture(scope="module")
def twist():
    return so.arm_tilt()


@pytest.fixture(scope="module")
def flights(twist, tmp_path_factory):
    """Twelve flights in a store."""
    store = tmp_path_factory.mktemp("store") / "map.zarr"
    return so.ensemble(twist, vary=LEANT, size=12, seed=3, against=twist.fly(), out=store), store


def image(file: Path) -> np.ndarray:
    from PIL import Image

    return np.asarray(Image.open(file)).astype(int)


def is_of(color: str, cell: np.ndarray) -> bool:
    """Whether a body of one colour stands in a cell: pixels whose hue is that colour's."""
    wanted = np.array(rgb(color))
    pixels = cell.reshape(-1, 3)
    strong = pixels[np.ptp(pixels, axis=1) > 90] / 255
    middle = np.median(strong / strong.max(1, keepdims=True), axis=0)
    return bool(np.abs(middle - wanted / wanted.max()).max() < 0.12)


def cells(picture: np.ndarray, columns: int, count: int) -> list[np.ndarray]:
    width, height = CELL
    return [
        picture[HEAD + k // columns * height :, k % columns * width :][: height - 20, :width]
        for k in range(count)
    ]


def test_bodies_have_the_colour_of_what_became_of_them(flights, tmp_path):
    ensemble, _ = flights
    errors = np.sort(ensemble.dataset.landing_error.values)
    within = float((errors[4] + errors[5]) / 2)
    ensemble.landings(tmp_path / "a.png", tolerance=within, columns=4)
    picture = image(tmp_path / "a.png")
    assert picture.shape == (HEAD + 3 * CELL[1], 4 * CELL[0], 3)
    bodies = cells(picture, 4, 12)  # by their landing errors
    assert [is_of(BLUE, cell) for cell in bodies] == [True] * 5 + [False] * 7
    assert [is_of(VERMILION, cell) for cell in bodies] == [False] * 5 + [True] * 7


def test_bodies_stand_as_flights_flown_one_by_one_land(flights, tmp_path):
    ensemble, _ = flights
    data = ensemble.dataset
    order = np.argsort(data.landing_error.values, kind="stable")
    alone = [
        so.arm_tilt().from_takeoff(so.Takeoff(**changed(data.leant.values[k]))).fly() for k in order
    ]
    poses = so.Recording(
        alone[0].model, np.arange(12.0),
        *(np.array([getattr(one, name)[-1] for one in alone])
          for name in ("base_position", "base_quaternion", "joint_coordinates", "angles")),
    )  # fmt: skip
    words = [""] * 12
    key = [("", ""), ("", "")]
    landings_picture(poses, tmp_path / "alone.png", [BLUE] * 12, words, key, 4)
    ensemble.landings(tmp_path / "a.png", good=data.landing_error < 10.0, columns=4)
    # The ensemble's key is one line: all landed.
    ours = image(tmp_path / "a.png")[HEAD - 26 :]
    theirs = image(tmp_path / "alone.png")[HEAD:]
    for k in range(12):
        top, left = k // 4 * CELL[1], k % 4 * CELL[0]
        part = (slice(top, top + CELL[1] - 20), slice(left, left + CELL[0]))
        assert (np.abs(ours[part] - theirs[part]).max(-1) > 60).mean() < 2e-3


def changed(tilt: float) -> dict:
    """The takeoff of the maneuver with a tilt added."""
    takeoff = so.arm_tilt().takeoff
    plain = {
        name: getattr(takeoff, name)
        for name in ("somersault", "twist", "spin", "angular_momentum", "joints")
    }
    return {**plain, "tilt": takeoff.tilt + tilt}


def test_a_stored_ensemble_is_drawn_by_its_plan(flights, tmp_path):
    ensemble, store = flights
    ensemble.landings(tmp_path / "a.png", tolerance=0.2)
    stored = so.Ensemble.open(store)
    with pytest.raises(so.SomersaultError, match=r"plan=ensembles\.read_ensemble"):
        stored.landings(tmp_path / "b.png", tolerance=0.2)
    assert not (tmp_path / "b.png").exists()
    stored.landings(tmp_path / "b.png", tolerance=0.2, plan=ensemble.plan)
    assert (tmp_path / "b.png").read_bytes() == (tmp_path / "a.png").read_bytes()
    simulation = ensemble.plan.simulation
    other = so.ensembles.plan(simulation, {"x": so.Vary(adds_to="takeoff.tilt", samples=[0.1])})
    with pytest.raises(so.SomersaultError, match="not that of the ensemble"):
        stored.landings(tmp_path / "c.png", plan=other)


def test_a_map_is_drawn_as_a_map(twist, tmp_path):
    ensemble = landing_map(twist, points=5)
    errors = ensemble.dataset.landing_error.values
    within = float(np.median(errors))
    ensemble.landings(tmp_path / "a.png", tolerance=within, size=CELL)
    picture = image(tmp_path / "a.png")[26:]  # a third line of the key says which grids
    landed = np.array([is_of(BLUE, cell) for cell in cells(picture, 5, 25)]).reshape(5, 5)
    assert np.array_equal(landed, errors <= within)


def test_without_a_landing_to_compare_with_colours_say_how_flights_ended(tmp_path, monkeypatch):
    angles = {"arms": so.Vary(sets="joints.shoulder.angle", samples=[0.8, 1.4, 2.0, 1.2])}
    held = so.JointTakeoff.sprung(angle=1.4, K=1.0, hold=True)
    takeoff = so.Takeoff(spin=8.64, tilt=0.01, joints={"shoulder": held})
    flown = so.ensemble("furrer", takeoff, 2.0, angles, until="quarter twist")
    flew = flown.dataset.ended.values == 0
    assert 0 < flew.sum() < 4  # both kinds are there
    said = []
    monkeypatch.setattr("somersault.view.landings_picture", lambda *given, **_: said.append(given))
    flown.landings(tmp_path / "a.png")
    ((poses, _, colors, words, key),) = said
    assert key == [
        (BLUE, f"{flew.sum()} of 4 flew for 2 s"),
        (VERMILION, f"{(~flew).sum()} ended at a quarter twist"),
    ]
    assert colors == [BLUE if one else VERMILION for one in flew]
    assert words == [f"{time:.3g} s" for time in flown.dataset.time.values]
    np.testing.assert_allclose(poses.angles[:, 2], flown.dataset.twist.values, atol=1e-6)


def test_superimposed_poses_that_agree_are_dark(tmp_path):
    flight = so.fly("furrer", so.Takeoff(spin=8.6), 0.5, samples=2)
    rows = {
        name: getattr(flight, name)
        for name in ("base_position", "base_quaternion", "joint_coordinates")
    }

    def poses(*which: int) -> so.Recording:
        picked = {name: x[list(which)] for name, x in rows.items()}
        angles = np.zeros((len(which), 3))
        return so.Recording(flight.model, np.arange(float(len(which))), **picked, angles=angles)

    def drawn(name: str, *which: int) -> np.ndarray:
        shown = poses(*which)
        count = len(which)
        landings_picture(
            shown, tmp_path / name, [BLUE] * count, [""] * count, [(BLUE, "all")],
            superimposed=True, size=(200, 200),
        )  # fmt: skip
        return image(tmp_path / name)[40:, :200]

    one, two, both = drawn("a.png", 0, 0), drawn("b.png", 1, 1), drawn("c.png", 0, 0, 0, 1)
    back = one[0, 0]
    first = (one != back).any(-1) & ~(two != back).any(-1)
    second = (two != back).any(-1) & ~(one != back).any(-1)
    for where, whole, share in ((first, one, 0.75), (second, two, 0.25)):
        expected = back + np.sqrt(share) * (whole[where] - back)
        assert np.abs(both[where] - expected).max() <= 2


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"tolerance": -1.0}, "tolerance"),
        ({"most": 0}, "most must be"),
        ({"most": 1000}, "from 1 to 240"),
        ({"columns": 0}, "columns must be"),
        ({"superimposed": True, "ground": True}, "no ground"),
        ({"colour": "red"}, "no option 'colour'"),
    ],
)
def test_mistakes_are_named_in_a_sentence(flights, tmp_path, options, words):
    with pytest.raises(so.SomersaultError, match=words):
        flights[0].landings(tmp_path / "a.png", **options)
    with pytest.raises(so.SomersaultError, match="another ending"):
        flights[0].landings(tmp_path / "a.jpg")
    assert not list(tmp_path.iterdir())


def test_flights_that_failed_are_left_out_and_counted(tmp_path):
    vary = {"leant": so.Vary(adds_to="takeoff.tilt", samples=[0.0, 0.1, 0.2])}
    with pytest.warns(so.SomersaultWarning, match="broke off"):
        lost = so.ensemble("furrer", so.Takeoff(spin=8.6), 5.0, vary, steps=2)
    with pytest.raises(so.SomersaultError, match="none of these flights"):
        lost.landings(tmp_path / "a.png")


SPEC = """
model = "furrer"
duration = 1.0
[takeoff]
spin = 8.64
[vary.leant]
adds_to = "takeoff.tilt"
normal = [0.0, 0.05]
[sample]
size = 5
"""


def test_the_command_draws_landings(tmp_path):
    (tmp_path / "a.toml").write_text(SPEC)
    run = subprocess.run(
        [sys.executable, "-m", "somersault", "ensemble", "a.toml", "--landings", "a.png"],
        cwd=tmp_path, capture_output=True, encoding="utf-8", timeout=300,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert "landings: a.png" in run.stdout
    assert image(tmp_path / "a.png").shape[1] == 5 * CELL[0]
