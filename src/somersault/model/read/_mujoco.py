"""MJCF and URDF through MuJoCo's own parser, so that defaults, includes, frames and inertias
from geometry mean what they mean there."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np

from somersault._core.errors import SomersaultError
from somersault.attitude import matrix_from_quaternion
from somersault.model._types import GROUND, Body, Joint, Matrix, Model, Vector
from somersault.model._weld import merge_welded
from somersault.model.read._mujoco_shapes import body_shapes
from somersault.model.shapes import Shape

_MOST_BYTES = 50 * 2**20


def read_mjcf(path: Path) -> Model:
    """The model in an MJCF file; SomersaultError if it has none that can fly."""
    return _read(path, None)


def read_urdf(path: Path) -> Model:
    """The robot in a URDF file.

    Its root link is the free base, unless the link is called `world`, which by the custom of
    URDF is the ground.
    """
    return _read(path, _root_link(path))


def _root_link(path: Path) -> str | None:
    """The URDF link that is nobody's child, or None if it is the ground."""
    try:
        robot = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, ValueError, OSError, LookupError):
        return None  # MuJoCo's parser will say what is wrong, and where
    for element in robot.iter():
        element.tag = str(element.tag).rpartition("}")[2]  # whatever the namespace
    children = {child.get("link") for child in robot.findall("./joint/child")}
    names = [link.get("name") for link in robot.findall("./link")]
    roots = [name for name in names if name not in children]
    joints = [joint.get("name") for joint in robot.findall("./joint")]
    twice = next((name for name in joints if joints.count(name) > 1), None)
    if twice is not None:
        raise SomersaultError(f"{path.name} has two joints named {twice!r}; rename one")
    if len(roots) > 1:
        raise SomersaultError(
            f"{path.name} has {len(roots)} links without a parent, {roots[0]!r} and {roots[1]!r} "
            "among them; a robot is one tree, so join them or remove one"
        )
    return roots[0] if roots and roots[0] != "world" else None


def _read(path: Path, free_root: str | None) -> Model:
    import mujoco

    if path.stat().st_size > _MOST_BYTES:
        raise SomersaultError(
            f"{path.name} is larger than 50 MB, which no model is; check the file"
        )
    mujoco.set_mju_user_warning(lambda _: None)  # else it writes a log where one stands
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        if free_root is not None:
            spec.compiler.fusestatic = False  # the root would vanish into the ground
            root = spec.body(free_root)
            if root is None:
                raise ValueError(f"its root link {free_root!r} is not found; save it as UTF-8")
            root.add_freejoint()
        _refuse_muscles(path.name, spec)
        compiled = spec.compile()
    except (ValueError, RuntimeError, OSError, AttributeError, mujoco.FatalError) as error:
        raise SomersaultError(
            f"{path.name} cannot be read as a model: {_one_line(error)}; correct the file"
        ) from None
    try:
        _refuse(path.name, compiled)
        bodies, free = _bodies(path.name, compiled)
    except UnicodeDecodeError:
        raise SomersaultError(
            f"{path.name} has names that are not UTF-8; save it as UTF-8"
        ) from None
    return Model(path.stem, free, merge_welded(bodies, free), _ignored(compiled))


_PLAINER = {
    "mass and inertia of moving bodies must be larger than mjMINVAL": "a body that moves has a "
    "mass or an inertia that is zero, negative or not a number",
    "inertia must satisfy A + B >= C; use 'balanceinertia' to fix": "a body has a principal "
    "inertia that is larger than the sum of the other two, or not a number",
}


def _refuse_muscles(file: str, spec: Any) -> None:
    import mujoco

    for actuator in spec.actuators:
        if actuator.gaintype == mujoco.mjtGain.mjGAIN_MUSCLE:
            raise SomersaultError(
                f"{file}: actuator {actuator.name!r} is a muscle, which pulls even when it is not "
                "driven; remove it"
            )


def _one_line(error: Exception) -> str:
    text = re.sub(r"\s+", " ", str(error)).strip().rstrip(".")
    for theirs, ours in _PLAINER.items():
        text = text.replace(theirs, ours)
    text = re.sub(r"^(XML )?[Ee]rror:\s*", "", text)
    return text[:300] if text else type(error).__name__


# ------------------------------------------------------------------------------- bodies


def _bodies(file: str, m: Any) -> tuple[list[Body], bool]:
    """Every body that moves, the free base first, and whether there is one."""
    import mujoco

    free_joint = int(mujoco.mjtJoint.mjJNT_FREE)
    bases = [int(m.jnt_bodyid[j]) for j in range(m.njnt) if m.jnt_type[j] == free_joint]
    if len(bases) > 1:
        names = " and ".join(repr(m.body(b).name) for b in bases[:2])
        raise SomersaultError(
            f"{file} has {len(bases)} free bodies ({names}); a model is one body in the air, so "
            "keep one"
        )
    order = list(range(1, m.nbody))
    if bases:
        moving = [b for b in order if m.body_weldid[b] != 0]
        ours = [b for b in moving if m.body_rootid[b] == m.body_rootid[bases[0]]]
        if m.body_parentid[bases[0]] != 0:
            raise SomersaultError(
                f"{file}: the free joint of {m.body(bases[0]).name!r} must stand directly in the "
                "world; move the body there"
            )
        order = ours + [b for b in moving if b not in ours]
    still = {b: GROUND for b in range(m.nbody) if m.body_weldid[b] == 0}
    index = still | {b: k for k, b in enumerate(order)}
    shapes = body_shapes(m)
    return [
        _body(m, b, index[int(m.body_parentid[b])], b in bases, shapes.get(b, ())) for b in order
    ], bool(bases)


def _body(m: Any, b: int, parent: int, base: bool, shapes: tuple[Shape, ...]) -> Body:
    turn = matrix_from_quaternion(m.body_iquat[b])
    inertia = turn @ np.diag(m.body_inertia[b]) @ turn.T
    first = int(m.body_jntadr[b])
    joints = () if base else tuple(_joint(m, first + k) for k in range(int(m.body_jntnum[b])))
    return Body(
        name=m.body(b).name or f"body_{b}",
        parent=parent,
        mass=float(m.body_mass[b]),
        com=_vector(m.body_ipos[b]),
        inertia=_matrix((inertia + inertia.T) / 2),
        position=_vector(np.zeros(3) if base else m.body_pos[b]),
        rotation=_matrix(np.eye(3) if base else matrix_from_quaternion(m.body_quat[b])),
        joints=joints,
        shapes=shapes,
    )


def _joint(m: Any, j: int) -> Joint:
    import mujoco

    kinds = {
        int(mujoco.mjtJoint.mjJNT_HINGE): "hinge",
        int(mujoco.mjtJoint.mjJNT_SLIDE): "slide",
        int(mujoco.mjtJoint.mjJNT_BALL): "ball",
    }
    kind = kinds[int(m.jnt_type[j])]
    at, dof = int(m.jnt_qposadr[j]), int(m.jnt_dofadr[j])
    ball = kind == "ball"
    limits = (float(m.jnt_range[j][0]), float(m.jnt_range[j][1])) if m.jnt_limited[j] else None
    return Joint(
        name=m.joint(j).name or _unnamed(m, j),
        kind=kind,  # type: ignore[arg-type]
        axis=(1.0, 0.0, 0.0) if ball else _vector(m.jnt_axis[j]),
        anchor=_vector(m.jnt_pos[j]),
        reference=0.0 if ball else float(m.qpos0[at]),
        limits=limits,
        stiffness=float(m.jnt_stiffness[j]),
        rest=0.0 if ball else float(m.qpos_spring[at]),
        damping=float(m.dof_damping[dof]),
        armature=float(m.dof_armature[dof]),
    )


def _unnamed(m: Any, j: int) -> str:
    body = int(m.jnt_bodyid[j])
    name = m.body(body).name or f"body_{body}"
    return name if m.body_jntnum[body] == 1 else f"{name}_{j - int(m.body_jntadr[body]) + 1}"


def _vector(values: Any) -> Vector:
    x, y, z = (float(v) for v in values)
    return x, y, z


def _matrix(rows: Any) -> Matrix:
    return _vector(rows[0]), _vector(rows[1]), _vector(rows[2])


# ----------------------------------------------------------------- what cannot be carried


def _refuse(file: str, m: Any) -> None:
    """Refuse what would change a flight and that a `Model` does not hold."""
    for j in range(m.njnt):
        _refuse_joint(file, m, j)
    if np.any(m.body_gravcomp):
        b = int(np.flatnonzero(m.body_gravcomp)[0])
        raise SomersaultError(
            f"{file}: body {m.body(b).name or b!r} has gravcomp, which would hold it up in the "
            "air; set it to 0"
        )
    if m.neq:
        name = m.equality(0).name
        raise SomersaultError(
            f"{file}: equality constraint {name or 0!r} closes a loop or couples joints, which a "
            "tree of bodies cannot carry; remove it"
        )
    if m.nflex:
        raise SomersaultError(
            f"{file}: flex {_flex_name(m)!r} is a deformable body; replace it by rigid ones"
        )
    if m.nplugin:
        raise SomersaultError(
            f"{file}: plugin {m.plugin(0).name or 0!r} computes forces outside the model; remove it"
        )
    for t in range(m.ntendon):
        force = max(
            np.max(np.abs(values[t]))
            for values in (
                m.tendon_stiffness,
                m.tendon_stiffnesspoly,
                m.tendon_damping,
                m.tendon_dampingpoly,
                m.tendon_armature,
                m.tendon_frictionloss,
                m.tendon_limited,
            )
        )
        if force > 0:
            raise SomersaultError(
                f"{file}: tendon {m.tendon(t).name or t!r} has stiffness, damping, friction, "
                "armature or limits, which cannot be carried; remove them or the tendon"
            )
    if m.opt.density > 0 or m.opt.viscosity > 0 or np.any(m.opt.wind):
        raise SomersaultError(
            f"{file}: option density, viscosity or wind asks for a fluid's drag, which flights do "
            "not have; set them to 0"
        )


def _flex_name(m: Any) -> str | int:
    import mujoco

    return mujoco.mj_id2name(m, mujoco.mjtObj.mjOBJ_FLEX, 0) or 0


def _refuse_joint(file: str, m: Any, j: int) -> None:
    import mujoco

    kind, dof = int(m.jnt_type[j]), int(m.jnt_dofadr[j])
    free = kind == int(mujoco.mjtJoint.mjJNT_FREE)
    count = 6 if free else 3 if kind == int(mujoco.mjtJoint.mjJNT_BALL) else 1
    where = f"{file}: joint {m.joint(j).name or _unnamed(m, j)!r}"
    own = slice(dof, dof + count)
    if np.any(m.dof_frictionloss[own]):
        raise SomersaultError(f"{where} has dry friction (frictionloss), not carried; remove it")
    if np.any(m.jnt_stiffnesspoly[j]) or np.any(m.dof_dampingpoly[own]):
        raise SomersaultError(
            f"{where} has a polynomial spring or damper; only linear ones are carried, so give one "
            "stiffness and one damping"
        )
    if m.jnt_plasticadr[j] >= 0:
        raise SomersaultError(f"{where} has a yielding spring, not carried; make it elastic")
    if free and (
        np.any(m.dof_damping[own]) or np.any(m.dof_armature[own]) or m.jnt_stiffness[j] != 0
    ):
        raise SomersaultError(
            f"{where} holds the free body by a spring, damper or armature, which nothing in the "
            "air does; set them to 0"
        )


def _ignored(m: Any) -> tuple[str, ...]:
    """What has no part in flight, with how many of each there are."""
    contacts = int(np.count_nonzero(m.geom_contype | m.geom_conaffinity))
    counts = {
        "geom that could touch": contacts,
        "mesh": m.nmesh,
        "skin": m.nskin,
        "camera": m.ncam,
        "light": m.nlight,
        "site": m.nsite,
        "sensor": m.nsensor,
        "actuator": m.nu,
        "tendon without force": m.ntendon,
        "keyframe": m.nkey,
    }
    plural = {"mesh": "meshes", "geom that could touch": "geoms that could touch"}
    plural["tendon without force"] = "tendons without force"
    return tuple(
        f"{count} {name if count == 1 else plural.get(name, name + 's')}"
        for name, count in counts.items()
        if count
    )
