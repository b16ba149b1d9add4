"""A model as MJCF, the format of MuJoCo: a file that `load`, MuJoCo and a SPEC can name."""

from __future__ import annotations

import os
from collections.abc import Iterable
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault._core.files import write
from somersault._core.places import check_file
from somersault.attitude import quaternion_from_matrix
from somersault.model._bodies import GROUND, Body, Joint
from somersault.model._model import Model
from somersault.model._vectors import IDENTITY, ZERO
from somersault.model.shapes import Mesh, Shape, lighter

_MOST_TRIANGLES = 60_000  # of a file, whose text would be megabytes
_LEAST = 2e-15  # kg, kg m²: MuJoCo lets nothing move that has less


def write_mjcf(model: Model, path: str | os.PathLike[str]) -> None:
    """Write a model as an MJCF file, whole or not at all.

    Read back by `load` it is the same model: bodies, masses, joints with their ranges, springs,
    dampers and gears, and shapes. Its name is the file's, its bodies are in MuJoCo's order (each
    with all that hangs on it before the next), and what has no mass has 2e-15 kg. The axes of
    somersault, tilt and twist are not in the format: give them to `load` again.

    Parameters
    ----------
    model : Model
    path : path-like
        A name that ends in .xml or .mjcf.

    Raises
    ------
    SomersaultError
        For another ending, and for what MuJoCo would not take: a body with a principal inertia
        that is larger than the sum of the other two, or one called "world".

    Examples
    --------
    >>> import somersault as so
    >>> so.write_mjcf(so.athlete(1.70, 62.0), "me.xml")  # doctest: +SKIP
    >>> so.load("me.xml")  # doctest: +SKIP
    """
    file = check_file(path, (".xml", ".mjcf"))
    write(file, mjcf(instance("model", model, Model)))


def mjcf(model: Model) -> str:
    """The text of the MJCF file that `write_mjcf` writes.

    Parameters
    ----------
    model : Model

    Returns
    -------
    str

    Raises
    ------
    SomersaultError
        For what MuJoCo would not take.
    """
    instance("model", model, Model)
    root = Element("mujoco", model=model.name)
    SubElement(root, "compiler", angle="radian", inertiafromgeom="false", autolimits="false")
    SubElement(root, "option", gravity="0 0 0")
    plain = SubElement(SubElement(root, "default"), "geom")
    plain.attrib |= {"mass": "0", "contype": "0", "conaffinity": "0"}
    assets, world = SubElement(root, "asset"), SubElement(root, "worldbody")
    above = {GROUND: world}
    shapes = lighter(model.solids, _MOST_TRIANGLES)
    for index, body in enumerate(model.bodies):
        base = model.free and index == 0
        above[index] = _add_body(above[body.parent], body, base)
        if base:
            _add_root(above[index], model)
        for number, shape in enumerate(shapes[index]):
            _add_shape(above[index], assets, shape, f"{body.name}.{number}")
    _add_followers(root, model)
    indent(root)
    text = tostring(root, encoding="unicode") + "\n"
    _check(model, text)
    return text


def _add_body(above: Element, body: Body, base: bool) -> Element:
    element = SubElement(above, "body", name=body.name)
    if not base:
        _place(element, np.array(body.position), np.array(body.rotation))
    moments, axes = _principal(np.array(body.inertia))
    inertial = SubElement(element, "inertial", mass=_text([max(body.mass, _LEAST)]))
    _place(inertial, np.array(body.com), axes)
    inertial.attrib |= {"pos": _text(body.com), "diaginertia": _text(moments)}
    for joint in body.joints:
        _add_joint(element, joint)
    return element


def _add_root(element: Element, model: Model) -> None:
    """A free joint; for a base in a plane two slides and the hinge across them."""
    if model.plane is None:
        SubElement(element, "freejoint")
        return
    kinds = ["hinge" if axis == model.plane else "slide" for axis in (1, 2, 3)]
    for kind, axis in sorted(zip(kinds, np.eye(3), strict=True), key=lambda at: at[0] == "hinge"):
        SubElement(element, "joint", type=kind, axis=_text(axis))


def _principal(inertia: Array) -> tuple[Array, Array]:
    """Principal moments, none below what MuJoCo takes nor by rounding above the sum of the other
    two, and axes."""
    if np.count_nonzero(inertia - np.diag(np.diagonal(inertia))):
        moments, axes = np.linalg.eigh(inertia)
        axes = axes * np.sign(np.linalg.det(axes))
    else:
        moments, axes = np.diagonal(inertia).copy(), np.eye(3)
    size = moments.max()
    least = moments < 1e-12 * size  # rounding, of a thin rod
    moments = np.maximum(np.where(least, 0.0, moments), _LEAST)
    excess = 2 * moments.max() - moments.sum()
    if 0 < excess < 1e-9 * size:
        moments = moments + (moments < moments.max()) * excess * (1 + 1e-9)
    return moments, axes


def _add_joint(element: Element, joint: Joint) -> None:
    own = SubElement(element, "joint", name=joint.name, type=joint.kind)
    if joint.kind != "ball":
        own.set("axis", _text(joint.axis))
    numbers = {
        "ref": joint.reference,
        "springref": joint.rest,
        "stiffness": joint.stiffness,
        "damping": joint.damping,
        "armature": joint.armature,
    }
    own.attrib |= {name: _text([x]) for name, x in numbers.items() if x}
    if joint.anchor != ZERO:
        own.set("pos", _text(joint.anchor))
    if joint.limits is not None:
        low, high = joint.limits
        own.attrib |= {"limited": "true", "range": _text([low, max(high, np.nextafter(low, 9e9))])}


def _add_shape(element: Element, assets: Element, shape: Shape, name: str) -> None:
    if isinstance(shape, Mesh):
        if len(shape.vertices) < 4:  # too few for MuJoCo, and nothing to see
            return
        mesh = SubElement(assets, "mesh", name=name, inertia="shell")
        mesh.set("vertex", _text(np.ravel(shape.vertices)))
        mesh.set("face", " ".join(map(str, np.ravel(shape.faces).tolist())))
        geom = SubElement(element, "geom", type="mesh", mesh=name)
    else:
        geom = SubElement(element, "geom", type=shape.kind, size=_text(shape.sizes))
    _place(geom, np.array(shape.position), np.array(shape.rotation))
    if shape.color is not None:
        geom.set("rgba", _text(shape.color))


def _add_followers(root: Element, model: Model) -> None:
    """Couplings: MuJoCo's are between displacements from the references."""
    coupled = [joint for joint in model.joints if joint.follows is not None]
    constraints = SubElement(root, "equality") if coupled else root
    for joint in coupled:
        assert joint.follows is not None
        factor, leader = joint.follows.factor, model.joint(joint.follows.leader)
        offset = joint.follows.offset + factor * leader.reference - joint.reference
        link = SubElement(constraints, "joint", joint1=joint.name, joint2=leader.name)
        link.set("polycoef", _text([offset, factor, 0.0, 0.0, 0.0]))


def _place(element: Element, position: Array, rotation: Array) -> None:
    if position.any():
        element.set("pos", _text(position))
    if not np.array_equal(rotation, IDENTITY):
        element.set("quat", _text(quaternion_from_matrix(rotation)))


def _text(numbers: Iterable[float]) -> str:
    """Numbers with all their digits."""
    return " ".join(repr(float(x)).removesuffix(".0") for x in numbers)


def _check(model: Model, text: str) -> None:
    """SomersaultError if MuJoCo would not take it."""
    import mujoco

    try:
        mujoco.MjModel.from_xml_string(text)
    except (ValueError, mujoco.FatalError) as error:
        reason = " ".join(str(error).split()).rstrip(".")
        raise SomersaultError(
            f"{model.name} cannot be written as MJCF: {reason[:200]}; change the model"
        ) from None
