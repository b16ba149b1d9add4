"""Every reader of the package: good files, ways to spoil them, what is demanded of what is read."""

from __future__ import annotations

import json
import os
import shutil
import stat
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import somersault as so
from somersault.view import picture

from . import good, good_meshes, good_stores, mutations, trees
from .good import Folder
from .good_meshes import MODELS
from .mutations import Change

Use = Callable[[Any, np.random.Generator], None]


@dataclass(frozen=True)
class Reader:
    """One reader.

    `read` has the path of the file; what it gives is looked at by `check` each time, and by `use`,
    which may take half a second, now and then. `commands` are what the command line is asked for,
    with FILE, BESIDE and OUT in the place of the file, of its folder and of a place to write to.
    Files without `endings` keep their names.
    """

    name: str
    good: Callable[[], list[Folder]]
    read: Callable[[Path], Any]
    changes: tuple[Change, ...]
    check: Callable[[Any], None]
    use: Use | None = None
    commands: tuple[tuple[str, ...], ...] = ()
    endings: tuple[str, ...] = (
        ".xml",
        ".mjcf",
        ".urdf",
        ".osim",
        ".bioMod",
        ".XML",
        ".csv",
        ".toml",
        "",
    )
    share: int = 1  # how many of the inputs, against other readers


# ------------------------------------------------------------------------- what is demanded


def sound_model(model: so.Model) -> None:
    """Finite, named apart, and with a positive definite mass matrix where the file draws it.

    The matrix is that of the equations (composite bodies, CasADi), not the reader's own check.
    """
    assert isinstance(model, so.Model)
    assert np.isfinite(model.mass)
    assert model.mass > 0
    assert np.all(np.isfinite(model.home))
    assert len(set(model.coordinates)) == len(model.coordinates)
    for body in model.bodies:
        for values in (body.com, body.inertia, body.position, body.rotation, body.mass):
            assert np.all(np.isfinite(values))
        inertia = np.array(body.inertia)
        assert np.allclose(inertia, inertia.T, rtol=1e-9, atol=0.0)
    for joint in model.joints:
        if joint.limits is not None:
            assert joint.limits[0] <= joint.limits[1]


def flown(model: so.Model, rng: np.random.Generator) -> None:
    """Its mass matrix is positive definite, and it can be flown and spun, or it says why not."""
    if len(model.joints) > 60:
        return
    equations = so.Equations(model)
    try:
        matrix = equations.mass_matrix(model.home)
        assert np.all(np.isfinite(matrix)), "a mass matrix that is not finite"
        scale = np.sqrt(np.diag(matrix))
        assert np.all(scale > 0), "a mass matrix with a diagonal that is not positive"
        assert np.linalg.eigvalsh(matrix / np.outer(scale, scale))[0] > -1e-12, "no mass matrix"
        if model.free:
            flight = so.fly(model, so.Takeoff(spin=1.0), duration=0.01, samples=3)
            assert np.all(np.isfinite(flight.base_quaternion)), "a flight that is not finite"
            if model.joints:
                so.spin(model).linear()
    except so.SomersaultError as mistake:
        one_sentence(mistake)


def sound_motion(motion: so.Motion) -> None:
    """All values at its ends are finite."""
    for rows in motion.values([motion.begin, motion.end]):
        assert np.all(np.isfinite(rows))


def _nothing(_: Any) -> None:
    """Nothing more than that it was read."""


def maneuver_flown(maneuver: so.Maneuver, rng: np.random.Generator) -> None:
    """It flies, or says why not; at most 2,000 steps of it, for the harness."""
    from dataclasses import replace

    try:
        flight = replace(maneuver, steps=min(maneuver.steps, 2000)).fly()
        assert np.all(np.isfinite(flight.base_quaternion))
    except so.SomersaultError as mistake:
        one_sentence(mistake)


def some_run(spec: Any, rng: np.random.Generator) -> None:
    """Its first runs can be run, or it says why not."""
    try:
        spec.plan.run(0, min(2, spec.plan.count))
    except so.SomersaultError as mistake:
        one_sentence(mistake)


def one_sentence(mistake: Exception) -> None:
    """One line, not too long, that can be printed."""
    said = str(mistake)
    assert said.strip(), "an empty message"
    assert "\n" not in said, f"a message of several lines: {said[:300]!r}"
    assert len(said) < 1000, f"a message of {len(said)} characters: {said[:300]!r}"
    assert said.isprintable() or not any(ord(c) < 32 for c in said), (
        f"control characters: {said[:300]!r}"
    )
    said.encode()


# -------------------------------------------------------------------------------- readers


def _keyframes(path: Path) -> so.Motion:
    try:
        moves = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError):  # no JSON, so nothing reaches the package
        raise so.SomersaultError("it is no JSON") from None
    return so.Motion.moves("furrer", moves)


def _ensemble(path: Path) -> Any:
    from somersault.ensembles import read_ensemble

    return read_ensemble(path)


def _column(path: Path) -> Any:
    from somersault.motion import read_column

    return read_column(path)


def _column_sound(columns: Any) -> None:
    assert all(np.all(np.isfinite(row)) for row in columns)


def _seen(path: Path) -> so.Model:
    """The model that names a mesh, once all there is to see of it has been read."""
    model = so.load(next(file for name in MODELS if (file := path.parent / name).exists()))
    for body in model.bodies:
        for shape in body.shapes:
            shape.solids()
    return model


def _drawn(model: so.Model) -> None:
    """What can be read of it is finite, and the rest has been left out."""
    sound_model(model)
    for row in model.solids:
        for solid in row:
            assert np.all(np.isfinite(solid.triangles.vertices))


def _pictured(model: so.Model, rng: np.random.Generator) -> None:
    flight = so.fly(model, so.Takeoff(spin=5.0), 0.05, samples=3)
    with tempfile.TemporaryDirectory() as place:
        picture(flight, Path(place, "picture.png"))


def _opened(path: Path) -> Any:
    return so.Ensemble.open(path).dataset.load()


def _healed(path: Path) -> Any:
    """What is left of a store, and the rest run again, in a copy of it; as it is, it is opened only
    if nothing is lost."""
    damaged = next(place for place in path.parents if place.name == good_stores.STORE)
    try:
        _as_it_was(_opened(damaged))
    except so.SomersaultError as mistake:
        one_sentence(mistake)
    with tempfile.TemporaryDirectory() as place:
        store = Path(place, good_stores.STORE)
        shutil.copytree(damaged, store, symlinks=True, copy_function=_copied)
        dataset = good_stores.carried_on(store)
        assert os.listdir(place) == [store.name]
        _as_it_was(_opened(store))
    return dataset


def _copied(source: str, to: str) -> None:
    if stat.S_ISFIFO(os.lstat(source).st_mode):
        os.mkfifo(to)
    else:
        shutil.copy2(source, to, follow_symlinks=False)


def _as_it_was(dataset: Any) -> None:
    """To the last bit the numbers that were computed."""
    whole = good_stores.whole()
    assert set(dataset.variables) == set(whole.variables)
    for name, variable in whole.variables.items():
        np.testing.assert_array_equal(dataset[name].values, variable.values, err_msg=str(name))


XML: tuple[Change, ...] = (*(trees.changed,) * 5, *mutations.TEXT[::2], trees.deep)
TOML = (*mutations.TEXT, *(mutations.literal,) * 6)
TABLES = (".csv", ".tsv", ".txt", ".mot", ".sto", ".CSV", ".nc", "")
_MODEL_COMMANDS = (("models", "FILE", "--json"), ("stability", "FILE", "--json"))

READERS = {
    reader.name: reader
    for reader in (
        Reader("mjcf", good.mjcf, so.load, XML, sound_model, flown, _MODEL_COMMANDS, share=4),
        Reader("urdf", good.urdf, so.load, XML, sound_model, flown, _MODEL_COMMANDS, share=4),
        Reader("osim", good.osim, so.load, XML, sound_model, flown, _MODEL_COMMANDS, share=4),
        Reader(
            "biomod",
            good.biomod,
            so.load,
            mutations.TEXT,
            sound_model,
            flown,
            _MODEL_COMMANDS,
            share=4,
        ),
        Reader(
            "spec",
            good.spec,
            so.Maneuver.read,
            TOML,
            _nothing,
            maneuver_flown,
            (("fly", "FILE", "--json"), ("fly", "FILE", "--out", "OUT.nc")),
            share=3,
        ),
        Reader(
            "saved",
            good.saved,
            so.Maneuver.read,
            TOML,
            _nothing,
            maneuver_flown,
            (("fly", "FILE", "--json"),),
        ),
        Reader(
            "ensemble",
            good.ensemble,
            _ensemble,
            TOML,
            _nothing,
            some_run,
            (("ensemble", "FILE", "--out", "OUT.zarr", "--json"),),
            share=3,
        ),
        Reader(
            "csv",
            good.csv,
            lambda path: so.read_motion(path, "furrer", cutoff=6.0),
            mutations.TEXT,
            sound_motion,
            endings=TABLES,
            share=2,
        ),
        Reader(
            "opensim",
            good.opensim_tables,
            lambda path: so.read_motion(path, "furrer"),
            mutations.TEXT,
            sound_motion,
            endings=TABLES,
            share=2,
        ),
        Reader("column", good.column, _column, mutations.TEXT, _column_sound, endings=TABLES),
        Reader(
            "measurements",
            good.measurements,
            so.athlete_from_measurements,
            mutations.TEXT,
            sound_model,
            endings=TABLES,
        ),
        Reader("keyframes", good.keyframes, _keyframes, TOML, sound_motion, endings=(".json",)),
        Reader(
            "flight",
            good.flights,
            lambda path: so.read_recording(path, so.load("furrer")),
            (),
            _nothing,
            endings=TABLES,
        ),
        Reader(
            "mesh",
            good_meshes.meshes,
            _seen,
            (*mutations.TEXT, *(trees.changed,) * 4, trees.deep),
            _drawn,
            _pictured,
            (("fly", "BESIDE/main.toml", "--page", "OUT.html"),),
            endings=(),  # by another name it would not be found
            share=2,
        ),
        Reader("chunk", good_stores.chunks, _healed, (), _as_it_was, endings=()),
        Reader("metadata", good_stores.metadata, _healed, TOML, _as_it_was, endings=()),
        Reader("netcdf", good_stores.netcdf, _opened, (), _nothing, endings=(".nc", "")),
    )
}
