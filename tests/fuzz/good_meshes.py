"""Mesh files of every format, each beside a model that shows it and a flight of that."""

from __future__ import annotations

from functools import cache

import numpy as np

from .good import Folder
from .meshes import biomesh, dae, obj, ply, stl, stl_text, vtp

_POINTS = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]])
_FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
_URDF = """<robot name="bot"><link name="hub"><inertial><mass value="5"/>
<inertia ixx="0.05" iyy="0.09" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><mesh filename="{}" scale="1 2 1"/></geometry></visual></link></robot>"""
_BIOMOD = """version 4
segment hub
translations xyz
rotations xyz
mass 5
inertia 0.05 0 0 0 0.09 0 0 0 0.1
meshfile {}
endsegment
"""
_OSIM = """<OpenSimDocument Version="40000"><Model name="hub"><BodySet><objects><Body name="hub">
<mass>5</mass><mass_center>0 0 0</mass_center><inertia>0.05 0.09 0.1 0 0 0</inertia>
<attached_geometry><Mesh name="m"><mesh_file>{}</mesh_file></Mesh></attached_geometry></Body>
</objects></BodySet><JointSet><objects><FreeJoint name="root"><socket_parent_frame>/ground
</socket_parent_frame><socket_child_frame>/bodyset/hub</socket_child_frame></FreeJoint></objects>
</JointSet></Model></OpenSimDocument>"""
_MJCF = """<mujoco><asset><mesh name="m" file="{}"/></asset><worldbody><body name="hub">
<freejoint/><inertial pos="0 0 0" mass="5" diaginertia="0.05 0.09 0.1"/>
<geom type="mesh" mesh="m" contype="0" conaffinity="0"/></body></worldbody></mujoco>"""
_MODELS = {"hub.urdf": _URDF, "hub.bioMod": _BIOMOD, "hub.osim": _OSIM, "hub.xml": _MJCF}
MODELS = tuple(_MODELS)
_SPEC = 'model = "{}"\nduration = 0.05\nsamples = 3\n[takeoff]\nspin = 5.0\n'


@cache
def meshes() -> list[Folder]:
    """In turn by a URDF, a .bioMod and an .osim; what MuJoCo reads by an MJCF file as well."""
    files = [
        ("hub.stl", stl(_POINTS, _FACES)),
        ("hub.stl", stl_text(_POINTS, _FACES)),
        ("hub.obj", obj(_POINTS, _FACES)),
        ("hub.obj", obj(_POINTS, _FACES, back=True)),
        ("hub.ply", ply(_POINTS, _FACES)),
        ("hub.ply", ply(_POINTS, _FACES, "binary_little_endian")),
        ("hub.bioMesh", biomesh(_POINTS, _FACES)),
        ("hub.dae", dae(_POINTS, _FACES)),
        ("hub.dae", dae(_POINTS, _FACES, unit=0.01)),
        ("hub.vtp", vtp(_POINTS, _FACES)),
        ("hub.vtp", vtp(_POINTS, _FACES, form="binary", pack="vtkZLibDataCompressor")),
        ("hub.vtp", vtp(_POINTS, _FACES, form="binary", pack="vtkLZMADataCompressor")),
        ("hub.vtp", vtp(_POINTS, _FACES, form="appended", strips=[[0, 1, 2, 3]])),
        ("hub.vtp", vtp(_POINTS, _FACES, form="appended", encoding="base64")),
    ]
    folders = [_shown(*file, MODELS[k % 3]) for k, file in enumerate(files)]
    return [*folders, _shown(*files[0], "hub.xml"), _shown(*files[2], "hub.xml")]


def _shown(name: str, data: bytes, model: str) -> Folder:
    return {
        name: data,
        model: _MODELS[model].format(name).encode(),
        "main.toml": _SPEC.format(model).encode(),
    }
