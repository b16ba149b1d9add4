"""From the name of a model to the model: shipped ones, and files in three formats."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from importlib.resources import as_file, files
from pathlib import Path

from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault.attitude import as_axes
from somersault.model._types import Model

_SHIPPED = files("somersault.model") / "shipped"


@cache
def shipped() -> tuple[str, ...]:
    """Names of the models that ship with the package."""
    return tuple(sorted(f.name[:-4] for f in _SHIPPED.iterdir() if f.name.endswith(".xml")))


def load(source: str | os.PathLike[str] | Model, axes: Sequence[int] | None = None) -> Model:
    """A model, by the name of a shipped one or from an MJCF, URDF or bioMod file.

    The format follows the ending: .xml or .mjcf, .urdf, .bioMod. A `Model` is given back as
    it is. What a file holds that has no part in flight is left out with a SomersaultWarning;
    what would change a flight and cannot be carried raises SomersaultError.

    `axes` are the body's axes about which it somersaults, tilts and twists: (2, 1, 3) unless
    said otherwise, whatever the file; (1, 2, 3) for an acrobat of biorbd's with x to his right.
    """
    wanted = None if axes is None else as_axes(axes)
    model = _found(source)
    return model if wanted is None else replace(model, axes=wanted)


def _found(source: str | os.PathLike[str] | Model) -> Model:
    if isinstance(source, Model):
        return source
    try:
        name = os.fspath(source)
        if not isinstance(name, str):
            raise TypeError
    except TypeError:
        raise SomersaultError(
            f"{source!r} is no model; give a shipped model's name, a file, or a Model"
        ) from None
    if name in shipped():
        return _shipped(name)
    path = Path(name)
    model = _read(path)
    if model.ignored:
        warnings.warn(
            f"{path.name}: left out, as they have no part in flight: {', '.join(model.ignored)}",
            SomersaultWarning,
            stacklevel=3,
        )
    return model


@cache
def _shipped(name: str) -> Model:
    from somersault.model.read._mujoco import read_mjcf

    with as_file(_SHIPPED / f"{name}.xml") as path:
        return read_mjcf(path)


def _read(path: Path) -> Model:
    ending = path.suffix.lower()
    if not os.path.isfile(path):  # which, unlike pathlib, takes any name
        if ending == "":
            raise SomersaultError(
                f"no model is called {str(path)!r}: give a file, or one of {', '.join(shipped())}"
            )
        raise SomersaultError(f"there is no model file {str(path)!r}; check the path")
    if ending == ".biomod":
        from somersault.model.read._biomod import read_biomod

        return read_biomod(path)
    if ending in (".xml", ".mjcf"):
        from somersault.model.read._mujoco import read_mjcf

        return read_mjcf(path)
    if ending == ".urdf":
        from somersault.model.read._mujoco import read_urdf

        return read_urdf(path)
    raise SomersaultError(
        f"{path.name} ends in {ending or 'nothing'!r}, which is no model format; "
        "use .xml (MJCF), .urdf or .bioMod"
    )
