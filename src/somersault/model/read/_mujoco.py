"""MJCF through MuJoCo's own parser, so that defaults, includes, frames and inertias from geometry
mean what they mean there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from somersault._core.errors import SomersaultError
from somersault._core.notes import listed, note
from somersault.attitude import matrix_from_quaternion
from somersault.model._base import Base, rooted
from somersault.model._bodies import GROUND, Body, Follow, Joint
from somersault.model._model import Model
from somersault.model._vectors import Matrix, Vector
from somersault.model.read._apart import compiled_model
from somersault.model.read._follow import leaders
from somersault.model.read._mujoco_shapes import body_shapes
from somersault.model.read._xml import MOST_BYTES


def read_mjcf(path: Path, base: Base | None = None) -> Model:
    """The model in an MJCF file.

    Parameters
    ----------
    path : Path
    base : {"free", "planar", "fixed"}, optional
        Let go of what the file fixes to the world, or hold the free body.

    Raises
    ------
    SomersaultError
        If the file has no model, or none that can fly.
    """
    if path.stat().st_size > MOST_BYTES:
        raise SomersaultError(
            f"{path.name} is larger than 50 MB, which no model is; check the file"
        )
    compiled, from_shapes = compiled_model(path)
    try:
        _refuse(path.name, compiled)
        bodies, free = _bodies(path.name, compiled, from_shapes)
        left_out = _left_out(compiled)
        dry = [_joint_name(compiled, j) for j in range(compiled.njnt) if _has_friction(compiled, j)]
        turned = [_joint_name(compiled, j) for j in range(compiled.njnt) if _turned(compiled, j)]
    except UnicodeDecodeError:
        raise SomersaultError(
            f"{path.name} has names that are not UTF-8; save it as UTF-8"
        ) from None
    on = rooted(path.name, bodies, free, base)
    if not on.bodies and bodies:
        raise SomersaultError(
            f"{path.name} has nothing that moves, so nothing can fly; give its body a free joint, "
            'or base = "free"'
        )
    if dry:
        note(f"{path.name}: joints' dry friction (frictionloss) is left out: {listed(dry)}")
    if turned:
        note(
            f"{path.name}: ranges the wrong way round count for nothing, as in MuJoCo: "
            f"{listed(turned)}"
        )
    left_out += [f"body {name}, fixed to the ground" for name in on.still]
    if any(joint.damping for joint in on.let_go):
        left_out.append("the dampings of the root")
    return Model(path.stem, on.free, on.bodies, tuple(left_out), on.axes, on.plane)


# ------------------------------------------------------------------------------- bodies


def _bodies(file: str, m: Any, from_shapes: list[bool]) -> tuple[list[Body], bool]:
    """Every body, a free base first, and whether there is one."""
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
        if m.body_parentid[bases[0]] != 0:
            raise SomersaultError(
                f"{file}: the free joint of {m.body(bases[0]).name!r} must stand directly in the "
                "world; move the body there"
            )
        ours = [b for b in order if m.body_rootid[b] == m.body_rootid[bases[0]]]
        order = ours + [b for b in order if b not in ours]
    index = {0: GROUND} | {b: k for k, b in enumerate(order)}
    follows = _follows(file, m)
    shapes = body_shapes(m)
    bodies = [
        replace(
            _body(m, b, index[int(m.body_parentid[b])], b in bases, follows),
            shapes=shapes.get(b, ()),
            inertia_from="shapes" if from_shapes[b] else "file",
        )
        for b in order
    ]
    return bodies, bool(bases)


def _body(m: Any, b: int, parent: int, base: bool, follows: dict[str, Follow]) -> Body:
    turn = matrix_from_quaternion(m.body_iquat[b])
    inertia = turn @ np.diag(m.body_inertia[b]) @ turn.T
    first = int(m.body_jntadr[b])
    joints = (
        () if base else tuple(_joint(m, first + k, follows) for k in range(int(m.body_jntnum[b])))
    )
    return Body(
        name=m.body(b).name or f"body_{b}",
        parent=parent,
        mass=float(m.body_mass[b]),
        com=_vector(m.body_ipos[b]),
        inertia=_matrix((inertia + inertia.T) / 2),
        position=_vector(np.zeros(3) if base else m.body_pos[b]),
        rotation=_matrix(np.eye(3) if base else matrix_from_quaternion(m.body_quat[b])),
        joints=joints,
    )


def _joint(m: Any, j: int, follows: dict[str, Follow]) -> Joint:
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
    name = _joint_name(m, j)
    return Joint(
        name=name,
        kind=kind,  # type: ignore[arg-type]
        axis=(1.0, 0.0, 0.0) if ball else _vector(m.jnt_axis[j]),
        anchor=_vector(m.jnt_pos[j]),
        reference=0.0 if ball else float(m.qpos0[at]),
        limits=limits,
        stiffness=float(m.jnt_stiffness[j]),
        rest=0.0 if ball else float(m.qpos_spring[at]),
        damping=float(m.dof_damping[dof]),
        armature=float(m.dof_armature[dof]),
        follows=follows.get(name),
    )


def _joint_name(m: Any, j: int) -> str:
    """Its own, or where it has none its body's, numbered where that has several."""
    if m.joint(j).name:
        return str(m.joint(j).name)
    body = int(m.jnt_bodyid[j])
    name = m.body(body).name or f"body_{body}"
    return name if m.body_jntnum[body] == 1 else f"{name}_{j - int(m.body_jntadr[body]) + 1}"


def _vector(values: Any) -> Vector:
    x, y, z = (float(v) for v in values)
    return x, y, z


def _matrix(rows: Any) -> Matrix:
    return _vector(rows[0]), _vector(rows[1]), _vector(rows[2])


# ------------------------------------------------------------------------ coupled joints


def _follows(file: str, m: Any) -> dict[str, Follow]:
    """What joints follow, by the equality constraints that couple two of them linearly."""
    import mujoco

    follows: dict[str, Follow] = {}
    for e in range(m.neq):
        if not m.eq_active0[e]:
            continue
        where = f"{file}: equality constraint {m.equality(e).name or e!r}"
        one, other = int(m.eq_obj1id[e]), int(m.eq_obj2id[e])
        joints = m.eq_type[e] == mujoco.mjtEq.mjEQ_JOINT
        if not joints or other < 0 or np.any(m.eq_data[e, 2:5]):
            raise SomersaultError(
                f"{where} closes a loop, holds a joint, or couples in a way that is not linear, "
                "which a tree of bodies cannot carry; remove it"
            )
        name = _joint_name(m, one)
        if name in follows:
            raise SomersaultError(f"{where} couples joint {name!r} a second time; remove it")
        # y − y0 = a0 + a1 (x − x0), about where the file draws both
        y0, x0 = (float(m.qpos0[m.jnt_qposadr[j]]) for j in (one, other))
        offset, factor = (float(number) for number in m.eq_data[e, :2])
        follows[name] = Follow(_joint_name(m, other), factor, y0 + offset - factor * x0)
    return leaders(file, follows, [_joint_name(m, j) for j in range(m.njnt)])


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
            )
        )
        if force > 0:
            raise SomersaultError(
                f"{file}: tendon {m.tendon(t).name or t!r} has stiffness, damping or armature, "
                "which cannot be carried; remove them or the tendon"
            )
    if m.opt.density > 0 or m.opt.viscosity > 0 or np.any(m.opt.wind):
        raise SomersaultError(
            f"{file}: option density, viscosity or wind asks for a fluid's drag, which flights do "
            "not have; set them to 0"
        )


def _flex_name(m: Any) -> str | int:
    import mujoco

    return mujoco.mj_id2name(m, mujoco.mjtObj.mjOBJ_FLEX, 0) or 0


def _has_friction(m: Any, j: int) -> bool:
    dof = int(m.jnt_dofadr[j])
    return bool(m.dof_frictionloss[dof] != 0)


def _turned(m: Any, j: int) -> bool:
    """Whether a joint's range is the wrong way round."""
    low, high = m.jnt_range[j]
    return bool(low > high)


def _refuse_joint(file: str, m: Any, j: int) -> None:
    import mujoco

    kind, dof = int(m.jnt_type[j]), int(m.jnt_dofadr[j])
    free = kind == int(mujoco.mjtJoint.mjJNT_FREE)
    count = 6 if free else 3 if kind == int(mujoco.mjtJoint.mjJNT_BALL) else 1
    where = f"{file}: joint {_joint_name(m, j)!r}"
    own = slice(dof, dof + count)
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


def _left_out(m: Any) -> list[str]:
    """What has no part in flight, with how many of each there are."""
    contacts = int(np.count_nonzero(m.geom_contype | m.geom_conaffinity))
    counts = {
        "geom that could touch": contacts,
        "skin": m.nskin,
        "camera": m.ncam,
        "light": m.nlight,
        "site": m.nsite,
        "sensor": m.nsensor,
        "actuator": m.nu,
        "tendon": m.ntendon,
        "inactive equality constraint": int(m.neq - np.count_nonzero(m.eq_active0)),
        "keyframe": m.nkey,
    }
    plural = {"geom that could touch": "geoms that could touch"}
    return [
        f"{count} {name if count == 1 else plural.get(name, name + 's')}"
        for name, count in counts.items()
        if count
    ]
