"""Athletes where a model is named: in SPECs and at the shell; any model written as MJCF."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pytest

import somersault as so
from somersault.cli import main
from somersault.ensembles import parse_ensemble

EXAMPLES = Path(__file__).parents[1] / "examples"
HERE = Path(".")


def spec(**athlete: object) -> dict[str, object]:
    return {"duration": 0.4, "takeoff": {"spin": 7.0, "tilt": 0.02}, "athlete": athlete}


def test_a_spec_flies_an_athlete() -> None:
    given = {"height": 1.75, "mass": 70.0, "sex": "female", "knees": True, "name": "Ana"}
    maneuver = so.Maneuver.parse(spec(**given))
    ana = so.athlete(1.75, 70.0, "female", knees=True, name="Ana")
    assert (maneuver.model, maneuver.model.name) == (ana, "Ana")
    flown, alone = maneuver.fly(), so.fly(ana, so.Takeoff(spin=7.0, tilt=0.02), 0.4)
    np.testing.assert_array_equal(flown.angles, alone.angles)


def test_an_ensemble_flies_an_athlete() -> None:
    tables = spec(height=1.75, mass=70)
    tables["vary"] = {"leant": {"sets": "takeoff.tilt", "values": [0.0, 0.1]}}
    simulation = parse_ensemble(tables, HERE).plan.simulation
    own = so.flight.flights(
        so.athlete(1.75, 70.0), so.Takeoff(spin=7.0, tilt=0.02), 0.4, accuracy=1e-7
    )
    assert simulation.specification == own.specification


def test_a_planar_athlete() -> None:
    tables = {**spec(height=1.75, mass=70), "base": "planar", "takeoff": {"spin": 7.0}}
    assert so.Maneuver.parse(tables).model.plane == 2


def test_a_maneuver_of_an_athlete_is_saved_with_its_model(tmp_path: Path) -> None:
    maneuver = so.Maneuver.parse(spec(height=1.75, mass=70))
    maneuver.save(tmp_path / "mine.toml")
    again = so.Maneuver.read(tmp_path / "mine.toml")
    close(again.model, maneuver.model)
    np.testing.assert_allclose(again.fly().angles, maneuver.fly().angles, rtol=0, atol=1e-9)


def test_measurements_are_looked_for_beside_the_spec(tmp_path: Path) -> None:
    pytest.importorskip("yeadon")
    from test_athlete import MEASURED

    (tmp_path / "me.txt").write_text("".join(f"{k}: {v!r}\n" for k, v in MEASURED.items()))
    (tmp_path / "me.toml").write_text(
        'duration = 0.4\n[athlete]\nmeasurements = "me.txt"\nmass = 61\ndensities = "Clauser"\n'
    )
    model = so.Maneuver.read(tmp_path / "me.toml").model
    assert model == so.athlete_from_measurements(MEASURED, mass=61.0, densities="Clauser")


@pytest.mark.parametrize(
    ("athlete", "words"),
    [
        ({"height": 1.75}, "needs height"),
        ({"height": 175, "mass": 70}, "centimetres"),
        ({"height": 1.75, "mass": "70"}, "athlete.mass must be a number"),
        ({"stature": 1.75, "mass": 70}, "athlete.stature is no key"),
        ({"height": 1.75, "mass": 70, "densities": "Clauser"}, "athlete.densities is given"),
        ({"measurements": "me.txt", "sex": "male"}, "athlete.sex is given"),
        ({"height": 1.75, "mass": 70, "sex": "cat"}, "sex is 'cat'"),
    ],
)
def test_a_mistake_in_an_athlete_is_a_sentence(athlete: dict[str, object], words: str) -> None:
    with pytest.raises(so.SomersaultError, match=words) as mistake:
        so.Maneuver.parse(spec(**athlete))
    assert "\n" not in str(mistake.value)


def test_a_spec_has_a_model_or_an_athlete() -> None:
    with pytest.raises(so.SomersaultError, match="this one has both"):
        so.Maneuver.parse({"model": "furrer", **spec(height=1.75, mass=70)})
    with pytest.raises(so.SomersaultError, match=r"model is missing; name one, or .*athlete"):
        so.Maneuver.parse({"duration": 1.0})


# -------------------------------------------------------------------------------- at the shell


def close(one: so.Model, other: so.Model) -> None:
    """The same but for the last bit or two of what is turned."""
    assert [body.name for body in one.bodies] == [body.name for body in other.bodies]
    for a, b in zip(one.bodies, other.bodies, strict=True):
        assert (a.mass, a.com, a.position, a.parent) == (b.mass, b.com, b.position, b.parent)
        assert a.joints == b.joints
        size = np.abs(np.array(a.inertia)).max()
        np.testing.assert_allclose(a.inertia, b.inertia, rtol=0, atol=4e-16 * size)
        np.testing.assert_allclose(a.rotation, b.rotation, rtol=0, atol=4e-16)


def test_an_athlete_is_written_at_the_shell(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "me.xml"
    asked = ["height=1.75", "mass=70", "sex=female", "knees=true"]
    assert main(["models", "--athlete", *asked, "--out", str(file)]) == 0
    assert f"written to {file}" in capsys.readouterr().out
    close(so.load(file), so.athlete(1.75, 70.0, "female", knees=True))
    assert main(["models", "--athlete", "height=1.75", "mass=70", "--json"]) == 0
    (record,) = json.loads(capsys.readouterr().out)
    assert record["mass"] == pytest.approx(70.0, rel=1e-12)


@pytest.mark.parametrize("source", ["urdf", "bioMod", "osim"])
def test_any_model_is_written_as_mjcf_with_the_same_dynamics(
    source: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from test_notes import urdf

    file = {
        "urdf": lambda: urdf(tmp_path, '<axis xyz="0 0.6 0.8"/><origin rpy=".1 .2 .3"/>'),
        "bioMod": lambda: EXAMPLES / "acrobat.bioMod",
        "osim": lambda: osim(tmp_path),
    }[source]()
    out = tmp_path / "same.xml"
    assert main(["models", str(file), "--out", str(out)]) == 0
    capsys.readouterr()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", so.SomersaultWarning)
        one, other = so.load(file), so.load(out)
    assert all(joint.kind != "ball" for joint in one.joints)
    place = [one.coordinates.index(name) for name in other.coordinates]  # in MuJoCo's order
    q = np.random.default_rng(5).uniform(-1, 1, (4, len(one.coordinates)))
    ours = so.Equations(one).mass_matrix(q)
    theirs = so.Equations(other).mass_matrix(q[:, place])
    rows = [*range(6), *(6 + k for k in place)]
    wanted = ours[:, rows][:, :, rows]
    np.testing.assert_allclose(theirs, wanted, rtol=0, atol=1e-13 * np.abs(ours).max())


def osim(folder: Path) -> Path:
    from osims import random_tree, version_4

    file = folder / "tree.osim"
    file.write_text(version_4(*random_tree(np.random.default_rng(3))))
    return file


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["furrer", "book", "--out", "x.xml"], "--out writes one model, and 2 are named"),
        (["--out", "x.xml"], "and 0 are named"),
        (["furrer", "--out", "x.urdf"], "has another ending than .xml or .mjcf"),
        (["--athlete", "height"], "takes KEY=X"),
        (["--athlete", "hight=1.75", "mass=70"], "hight is no key of --athlete"),
    ],
)
def test_a_mistake_at_the_shell_is_a_sentence(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["models", *arguments]) == 2
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1
    assert not Path("x.xml").exists()
