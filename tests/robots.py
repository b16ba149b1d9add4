"""Small URDF files in a few words."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

from somersault import SomersaultWarning
from somersault.model import Model, load

Numbers = tuple[float, ...]


def link(name: str, mass: float | None = None, inertia: Numbers = (0, 0, 0), **more: str) -> str:
    """A link whose inertia is diagonal; without a mass it has no <inertial>."""
    own = ""
    if mass is not None:
        xx, yy, zz = inertia
        own = (
            f'<inertial><origin xyz="{more.get("com", "0 0 0")}" rpy="{more.get("rpy", "0 0 0")}"/>'
            f'<mass value="{mass}"/><inertia ixx="{xx}" iyy="{yy}" izz="{zz}" ixy="0" ixz="0" '
            'iyz="0"/></inertial>'
        )
    return f'<link name="{name}">{own}{more.get("more", "")}</link>'


def joint(
    name: str, parent: str, child: str, axis: str = "1 0 0", kind: str = "continuous", **more: str
) -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{more.get("at", "0 0 0")}" rpy="{more.get("rpy", "0 0 0")}"/>'
        f'<axis xyz="{axis}"/>{more.get("more", "")}</joint>'
    )


def robot(*parts: str) -> str:
    return f'<robot name="robot">{"".join(parts)}</robot>'


HUB = link("hub", 5, (0.05, 0.09, 0.1))
ARM = link("arm", 1, (0.02, 0.03, 0.04), com="0 0 -0.2")
MESH = '<{0}><geometry><mesh filename="package://bot/meshes/hub.dae"/></geometry></{0}>'
LIMIT = '<limit lower="{}" upper="{}" effort="1" velocity="1"/>'
BOX = '<collision><geometry><box size="0.1 0.2 0.1"/></geometry></collision>'


def read(text: str | bytes, name: str = "robot.urdf", **how: Any) -> Model:
    """The model in some text, whatever is said of it."""
    path = Path(name)
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SomersaultWarning)
        return load(path, **how)
