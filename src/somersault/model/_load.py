"""From the name of a model to the model: shipped ones, and files."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from importlib.resources import as_file, files
from pathlib import Path
from typing import get_args

from somersault._core.checks import one_of, shown
from somersault._core.degrees import limits_in_degrees
from somersault._core.errors import SomersaultError
from somersault._core.files import check_is_file
from somersault._core.notes import listed, note
from somersault.attitude import as_axes
from somersault.model._base import Base, rebased
from somersault.model._formats import endings, reader
from somersault.model._mass import check_mass_matrix
from somersault.model._model import Model

_SHIPPED = files("somersault.model") / "shipped"


@cache
def shipped() -> tuple[str, ...]:
    """Names of the models that ship with the package.

    Returns
    -------
    tuple of str
        In alphabetical order.

    Examples
    --------
    >>> import somersault as so
    >>> "furrer" in so.shipped()
    True
    """
    return tuple(sorted(f.name[:-4] for f in _SHIPPED.iterdir() if f.name.endswith(".xml")))


def load(
    source: str | os.PathLike[str] | Model,
    axes: Sequence[int] | None = None,
    base: Base | None = None,
) -> Model:
    """A model, by the name of a shipped one or from an MJCF, URDF, bioMod or osim file.

    The format follows the ending (.xml or .mjcf, .urdf, .bioMod, .osim), and of .xml the root
    element. What a file holds that has no part in flight is left out with a SomersaultWarning,
    and what is strange in it read as its own format's programs read it, likewise.

    Parameters
    ----------
    source : str, path or Model
        A `Model` is given back as it is.
    axes : sequence of int, optional
        The body's axes about which it somersaults, tilts and twists: (2, 1, 3) unless said
        otherwise, whatever the file; (1, 2, 3) for an acrobat of biorbd's with x to his right. A
        planar model somersaults about the axis across its plane.
    base : {"free", "planar", "fixed"}, optional
        "free" lets go, in space, of what the file fixes to the ground, or of the body on joints
        there; "planar" does so in the plane that the file has, or else across the axis of
        somersault; "fixed" holds the base that the file has free. By default what the file says:
        in MJCF a free joint, in a .bioMod the root's six degrees of freedom, in any format the
        three of a plane; a URDF's root link is free unless it is called `world` or is a mere frame,
        without mass and with one joint on it.

    Returns
    -------
    Model

    Raises
    ------
    SomersaultError
        For a file that is none, or describes no body that can fly.

    Examples
    --------
    >>> import somersault as so
    >>> so.load("gymnast").free
    True
    >>> so.load("gymnast", base="fixed").free
    False
    """
    wanted = None if axes is None else as_axes(axes)
    if base is not None:
        one_of("base", base, get_args(Base))
    model = _found(source, base)
    if wanted is not None:
        plane = wanted[0] if base == "planar" else model.plane
        model = replace(model, axes=wanted, plane=plane)
    check_mass_matrix(model)
    return model


def _found(source: str | os.PathLike[str] | Model, base: Base | None) -> Model:
    if isinstance(source, Model):
        return rebased(source, base)
    try:
        name = os.fspath(source)
        if not isinstance(name, str):
            raise TypeError
    except TypeError:
        raise SomersaultError(
            f"{shown(source)} is no model; give a shipped model's name, a file, or a Model"
        ) from None
    if name in shipped():
        return rebased(_shipped(name), base)
    path = Path(name)
    model = _read(path, base)
    if not model.name.isascii():  # a file's name may be no text, and a model's is written to files
        text = model.name.encode(errors="surrogateescape").decode(errors="replace")
        model = replace(model, name=text)
    if model.ignored:
        left_out = ", ".join(model.ignored)
        note(f"{path.name}: left out, as they have no part in flight: {left_out}")
    outside = [
        f"{joint.name} ({joint.home[0]:g})"
        for joint in model.joints
        if joint.drawn_outside and joint.follows is None
    ]
    if outside:
        note(
            f"{path.name}: joints drawn outside their ranges stand at the nearer end where nothing "
            f"else is said of them: {listed(outside)}"
        )
    in_degrees = [
        f"{joint.name} ({joint.limits[0]:g} to {joint.limits[1]:g})"
        for joint in model.joints
        if joint.kind == "hinge" and joint.limits and limits_in_degrees(joint.limits)
    ]
    if in_degrees:
        note(
            f"{path.name}: limits of joints are in rad, and these look like degrees: "
            f"{listed(in_degrees)}"
        )
    return model


@cache
def _shipped(name: str) -> Model:
    from somersault.model.read._mujoco import read_mjcf

    with as_file(_SHIPPED / f"{name}.xml") as path:
        return read_mjcf(path)


def _read(path: Path, base: Base | None) -> Model:
    ending = path.suffix.lower()
    if not os.path.isfile(path):  # which, unlike pathlib, takes any name
        if ending == "" and not os.path.exists(path):
            raise SomersaultError(
                f"no model is called {str(path)!r}: give a file, or one of {', '.join(shipped())}"
            )
        check_is_file("model file", path)
    read = reader(ending)
    if read is None:
        raise SomersaultError(
            f"{path.name} ends in {ending or 'nothing'!r}, which is no model format; use "
            f"{', '.join(endings())}"
        )
    return read(path, base)
