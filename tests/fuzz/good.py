"""Good files of every format, in a few words of each dialect.

Each is a folder: files by their names, the one to read first; `None` is a pipe that no one writes
to.
"""

# ruff: noqa: E501, C408 (texts of files)

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files
from pathlib import Path

Folder = dict[str, bytes | None]
_ROOT = Path(__file__).parents[2]
_SHIPPED = ("furrer", "gymnast", "book", "doll", "simplest")

_MJCF = """<mujoco model="rich">
  <compiler angle="radian" autolimits="true" eulerseq="xyz"/>
  <option timestep="0.002" gravity="0 0 -9.81"/>
  <default><joint damping="0.1" armature="0.01"/><geom density="900" rgba="1 0 0 1"/>
    <default class="soft"><joint stiffness="3" springref="0.1"/></default></default>
  <asset><material name="skin" rgba="1 0 0 1"/><mesh name="tetra"
    vertex="0 0 0  1 0 0  0 1 0  0 0 1" scale="0.1 0.1 0.1"/></asset>
  <worldbody>
    <light pos="0 0 3"/><camera name="eye" pos="0 -3 1"/><geom type="plane" size="5 5 0.1"/>
    <body name="hips" pos="0 0 1">
      <freejoint name="root"/><geom name="trunk" type="capsule" fromto="0 0 -0.2 0 0 0.3" size="0.1"/>
      <site name="mark"/>
      <body name="left_thigh" pos="0 0.1 -0.2" euler="0 0.1 0">
        <joint name="left_hip" type="ball" range="0 1.2"/>
        <geom type="box" size="0.05 0.05 0.2" pos="0 0 -0.2" mass="8"/>
        <body name="left_shin" pos="0 0 -0.4">
          <joint name="left_knee" axis="0 1 0" range="-2.5 0" class="soft"/>
          <inertial pos="0 0 -0.2" mass="3" diaginertia="0.04 0.04 0.004"/>
          <geom type="mesh" mesh="tetra" contype="0" conaffinity="0"/>
        </body>
      </body>
      <frame pos="0 0 0.3"><body name="arm" quat="0.9 0.1 0.1 0">
        <joint name="shoulder" axis="0 1 0" ref="0.2"/><joint name="reach" type="slide" axis="0 0 1"/>
        <inertial pos="0 0 0.2" mass="2" fullinertia="0.03 0.03 0.003 0.0001 0 0"/>
        <geom type="ellipsoid" size="0.04 0.04 0.2" material="skin"/>
        <body name="hand" pos="0 0 0.4"><joint name="wrist" axis="1 0 0"/>
          <geom type="sphere" size="0.05"/></body>
      </body></frame>
    </body>
  </worldbody>
  <equality><joint joint1="wrist" joint2="shoulder" polycoef="0 0.5 0 0 0"/></equality>
  <actuator><motor joint="left_knee" gear="10"/></actuator>
  <sensor><jointpos joint="left_knee"/></sensor>
  <keyframe><key name="home" qpos="0 0 1 1 0 0 0 1 0 0 0 0 0 0 0"/></keyframe>
</mujoco>"""
_MJCF_PARTS = """<mujoco><include file="beside.xml"/><worldbody><body name="base"><freejoint/>
  <inertial pos="0 0 0" mass="2" diaginertia="1 1.1 1.2"/><body name="arm" pos="0 0 0.1">
  <joint class="weak" name="hinge" axis="0 1 0"/><inertial pos="0 0 0.1" mass="1"
  diaginertia="0.1 0.1 0.1"/></body></body></worldbody></mujoco>"""
_BESIDE = '<mujocoinclude><default><default class="weak"><joint stiffness="1"/></default></default>\
</mujocoinclude>'
_URDF = """<?xml version="1.0"?>
<robot name="robot">
  <material name="blue"><color rgba="0 0 1 1"/></material>
  <link name="hub">
    <inertial><origin xyz="0 0 0.1" rpy="0 0.1 0"/><mass value="5"/>
      <inertia ixx="0.05" iyy="0.09" izz="0.1" ixy="0.001" ixz="0" iyz="0"/></inertial>
    <visual><geometry><box size="0.1 0.2 0.1"/></geometry><material name="blue"/></visual>
    <collision><geometry><mesh filename="package://bot/hub.stl" scale="1 1 1"/></geometry></collision>
  </link>
  <link name="left_arm"><inertial><origin xyz="0 0 -0.2"/><mass value="1"/>
    <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><origin xyz="0 0 -0.2"/><geometry><cylinder radius="0.04" length="0.4"/></geometry></visual>
  </link>
  <link name="right_arm"><inertial><origin xyz="0 0 -0.2"/><mass value="1"/>
    <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><sphere radius="0.1"/></geometry></visual></link>
  <link name="tool"/>
  <link name="slider"><inertial><mass value="0.3"/>
    <inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="left_shoulder" type="revolute"><parent link="hub"/><child link="left_arm"/>
    <origin xyz="0 0.1 0.3" rpy="0.1 0 0"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="2" effort="10" velocity="3"/><dynamics damping="0.1" friction="0"/></joint>
  <joint name="right_shoulder" type="continuous"><parent link="hub"/><child link="right_arm"/>
    <origin xyz="0 -0.1 0.3"/><axis xyz="1 0 0"/>
    <mimic joint="left_shoulder" multiplier="-1" offset="0.1"/></joint>
  <joint name="grip" type="fixed"><parent link="left_arm"/><child link="tool"/></joint>
  <joint name="rail" type="prismatic"><parent link="right_arm"/><child link="slider"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="0.2" effort="1" velocity="1"/></joint>
  <transmission name="t"><joint name="left_shoulder"/></transmission>
</robot>
"""
_OSIM_BODY = """<Body name="{0}"><mass>{1}</mass><mass_center>0 {2} 0</mass_center>
<inertia>0.03 0.01 0.03 0 0 0</inertia></Body>"""
_OSIM_JOINT = """<{kind} name="{name}"><socket_parent_frame>{parent}_at</socket_parent_frame>
<socket_child_frame>{child}_at</socket_child_frame><coordinates>{coordinates}</coordinates><frames>
<PhysicalOffsetFrame name="{parent}_at"><socket_parent>{path}{parent}</socket_parent>
<translation>0 0.1 0.05</translation><orientation>0 0.2 0</orientation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="{child}_at"><socket_parent>/bodyset/{child}</socket_parent>
<translation>0 0.2 0</translation><orientation>0 0 0</orientation></PhysicalOffsetFrame></frames>
{more}</{kind}>"""
_OSIM_COORDINATE = """<Coordinate name="{0}"><default_value>0.1</default_value><range>-1.5 2</range>
<clamped>true</clamped><locked>false</locked></Coordinate>"""
_OSIM_AXES = """<SpatialTransform><TransformAxis name="rotation1"><coordinates>knee</coordinates>
<axis>0 0 1</axis><LinearFunction><coefficients>1 0</coefficients></LinearFunction></TransformAxis>
<TransformAxis name="rotation2"><coordinates></coordinates><axis>0 1 0</axis><Constant><value>0</value>
</Constant></TransformAxis><TransformAxis name="rotation3"><coordinates></coordinates><axis>1 0 0</axis>
<Constant><value>0</value></Constant></TransformAxis><TransformAxis name="translation1">
<coordinates></coordinates><axis>1 0 0</axis><Constant><value>0.01</value></Constant></TransformAxis>
<TransformAxis name="translation2"><coordinates></coordinates><axis>0 1 0</axis><SimmSpline>
<x>-1 0 1 2</x><y>0.02 0.02 0.02 0.02</y></SimmSpline></TransformAxis>
<TransformAxis name="translation3"><coordinates></coordinates><axis>0 0 1</axis><Constant><value>0</value>
</Constant></TransformAxis></SpatialTransform>"""
_OSIM_3 = """<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="30000"><Model name="old"><BodySet><objects>
<Body name="ground"><mass>0</mass></Body>
<Body name="trunk"><mass>30</mass><mass_center>0 0.2 0</mass_center><inertia_xx>1.2</inertia_xx>
<inertia_yy>0.5</inertia_yy><inertia_zz>1.3</inertia_zz><inertia_xy>0</inertia_xy>
<inertia_xz>0</inertia_xz><inertia_yz>0</inertia_yz><Joint><FreeJoint name="root">
<parent_body>ground</parent_body><location_in_parent>0 1 0</location_in_parent>
<orientation_in_parent>0 0 0</orientation_in_parent><location>0 0 0</location>
<orientation>0 0 0</orientation></FreeJoint></Joint></Body>
<Body name="arm"><mass>3</mass><mass_center>0 -0.2 0</mass_center><inertia_xx>0.05</inertia_xx>
<inertia_yy>0.01</inertia_yy><inertia_zz>0.05</inertia_zz><inertia_xy>0</inertia_xy>
<inertia_xz>0</inertia_xz><inertia_yz>0</inertia_yz><Joint><PinJoint name="shoulder">
<parent_body>trunk</parent_body><location_in_parent>0 0.4 0.2</location_in_parent>
<orientation_in_parent>0 0.1 0</orientation_in_parent><location>0 0 0</location>
<orientation>0 0 0</orientation><CoordinateSet><objects><Coordinate name="flexion">
<default_value>0.2</default_value><range>-1 2</range></Coordinate></objects></CoordinateSet>
<reverse>false</reverse></PinJoint></Joint></Body>
</objects></BodySet></Model></OpenSimDocument>"""
_BIOMOD_MESHES = """version 4
gravity 0 0 -9.81
variables
    $length 0.4
endvariables
segment base
    rt 0 0 0 xyz 0 0 1
    translations xyz
    rotations xyz
    mass 20
    inertia
        1.5 0 0
        0 1.6 0
        0 0 0.4
    com 0 0 0.1
    mesh 0 0 0
    mesh 0 0 0.5
endsegment
segment left_arm
    parent base
    rtinmatrix 1
    rt
        1 0 0 0
        0 1 0 0.2
        0 0 1 0.4
        0 0 0 1
    rotations yx
    rangesq -1 2 -3 0.5
    mass 3
    inertia 0.05 0 0 0 0.05 0 0 0 0.005
    com 0 0 -$length/2
endsegment
marker tip
    parent left_arm
    position 0 0 -0.4
    technical 1
endmarker
"""
_SPECS = (
    """model = "furrer"
duration = 0.3
gravity = [0.0, 0.0, -9.81]
accuracy = 1e-8
samples = 11
steps = 20000
until = "quarter twist"
axes = [2, 1, 3]
base = "free"
[takeoff]
somersault = 0.1
tilt = 0.01
twist = 0.0
angular_velocity = [0.1, 6.0, 0.2]
velocity = [0.5, 0.0, 4.0]
[joints.left_shoulder]
motion = "prescribed"
times = [0.0, 0.1, 0.25]
angles = [1.4, 0.2, 0.3]
[joints.right_shoulder]
motion = "sprung"
angle = -1.4
rate = 0.1
stiffness = 30.0
damping = 0.1
rest = -1.3
""",
    """model = "furrer"
duration = 0.2
[takeoff]
spin = 6.0
[motion]
file = "arms.csv"
cutoff = 6.0
scaled = 1.5
delayed = -0.05
mirrored = true
stop = 0.55
rate = 50.0
[compliance]
natural_frequency = 60.0
damping_ratio = 0.7
pose = 0.1
tape = true
[off_nominal]
somersault = 0.01
tilt = 0.01
""",
    """model = "body.xml"
duration = 0.2
[takeoff]
quaternion = [1.0, 0.0, 0.0, 0.0]
angular_momentum = [0.1, 3.0, 0.2]
[joints.shoulder]
motion = "torque"
times = [0.0, 0.1, 0.2]
torques = [0.0, 1.0, 0.0]
angle = 0.3
[joints.left_knee]
motion = "free"
""",
)
_ENSEMBLES = (
    """model = "furrer"
duration = 0.2
[takeoff]
tilt = 0.01
spin = 8.64
[joints.shoulder]
motion = "sprung"
angle = 1.4
stiffness = 30.0
hold = true
[vary.arm_angle]
sets = "joints.shoulder.angle"
values = {from = 0.4, to = 2.2, count = 3}
unit = "rad"
[vary.K_sh]
sets = "joints.shoulder.stiffness"
values = [0.0, 0.9, 1.8]
scale = 28.735
[report]
quantities = ["somersaults", "tilt", "twist"]
extremes = ["tilt"]
history = ["tilt"]
samples = 5
""",
    """model = "furrer"
duration = 0.2
[takeoff]
spin = 8.64
[joints.shoulder]
motion = "sprung"
angle = 1.5
stiffness = 28.7
[vary.takeoff_tilt]
adds_to = "takeoff.tilt"
normal = [0.0, 0.03]
[vary.stiffer]
sets = "joints.shoulder.stiffness"
uniform = [24.0, 36.0]
[sample]
size = 8
seed = 1
sequence = "random"
[report]
quantities = ["tilt", "landing_error"]
[target]
somersault = 1.7
tilt = 0.0
tolerance = 0.1
""",
)
_TRUNK = ("Ls1L", "Ls2L", "Ls3L", "Ls4L", "Ls5L", "Ls6L", "Ls7L", "Ls8L", "Ls0p", "Ls1p", "Ls2p", "Ls3p",
          "Ls5p", "Ls6p", "Ls7p", "Ls0w", "Ls1w", "Ls2w", "Ls3w", "Ls4w", "Ls4d")  # fmt: skip
_TRUNK_AT = (9, 21, 37, 49, 53, 15, 20, 30, 93, 80, 82, 95, 40, 52, 57, 34, 29, 30, 34, 36, 16)
_ARM = "2L 27 3L 33 4L 52 5L 3 6L 9 7L 18 0p 36 1p 31 2p 26 3p 27 4p 17 5p 22 6p 20 7p 12 4w 6 5w 8.5 6w 8 7w 5"
_LEG = ("1L 10 3L 42 4L 56 5L 82 6L 3 8L 15 9L 21 1p 56 2p 52 3p 37 4p 36 5p 23 6p 32 7p 25 8p 23 9p 19 8w 9 "
        "9w 8 6d 12")  # fmt: skip


def _folder(text: str, name: str, **others: bytes | None) -> Folder:
    return {name: text.encode(), **{key.replace("_", "."): value for key, value in others.items()}}


@cache
def mjcf() -> list[Folder]:
    """Shipped models, one with much of what MJCF has, and one with an included file."""
    shipped = files("somersault.model") / "shipped"
    more: Folder = {"beside.xml": _BESIDE.encode(), "pipe": None}
    texts = [(shipped / f"{name}.xml").read_text(encoding="utf-8") for name in _SHIPPED]
    return [{"main.xml": text.encode(), **more} for text in (*texts, _MJCF, _MJCF, _MJCF_PARTS)]


@cache
def urdf() -> list[Folder]:
    """A robot with a joint of each kind that moves, shapes, a follower and a transmission."""
    return [_folder(_URDF, "robot.urdf")]


@cache
def osim() -> list[Folder]:
    """Of version 4 with a pin, a ball and a custom joint; of version 3 with a pin."""
    bodies = [("trunk", 30, 0.2), ("thigh", 8, -0.2), ("shank", 3, -0.2), ("arm", 2, -0.1)]
    joints = [
        dict(kind="FreeJoint", name="root", parent="ground", child="trunk", path="/", coordinates=""),
        dict(kind="BallJoint", name="hip", parent="trunk", child="thigh", coordinates="".join(
            _OSIM_COORDINATE.format(f"hip_{k}") for k in range(3))),
        dict(kind="CustomJoint", name="knee_joint", parent="thigh", child="shank", more=_OSIM_AXES,
             coordinates=_OSIM_COORDINATE.format("knee")),
        dict(kind="PinJoint", name="shoulder", parent="trunk", child="arm",
             coordinates=_OSIM_COORDINATE.format("flexion")),
    ]  # fmt: skip
    text = '<?xml version="1.0" encoding="UTF-8" ?>\n<OpenSimDocument Version="40000"><Model name="new">'
    text += "<BodySet><objects>" + "\n".join(_OSIM_BODY.format(*body) for body in bodies)
    text += "</objects></BodySet><JointSet><objects>" + "\n".join(
        _OSIM_JOINT.format(**{"path": "/bodyset/", "more": "", **joint}) for joint in joints
    )
    text += "</objects></JointSet></Model></OpenSimDocument>"
    return [_folder(text, "body.osim"), _folder(_OSIM_3, "body.osim")]


@cache
def biomod() -> list[Folder]:
    """The acrobat of the examples, a diver, a root of two parts, and one with variables."""
    places = (
        "examples/acrobat.bioMod",
        "tests/data/diver.bioMod",
        "tests/data/two_part_root.bioMod",
    )
    texts = [(_ROOT / place).read_text(encoding="utf-8") for place in places]
    return [_folder(text, "body.bioMod") for text in (*texts, _BIOMOD_MESHES)]


def _arms(mark: str = ",", rows: int = 61) -> str:
    head = mark.join(["time [s]", "left_shoulder [rad]", "right_shoulder [deg]"])
    lines = (mark.join(f"{x:.6g}" for x in (k / 100, 1.4 - k / 100, k / 5)) for k in range(rows))
    return "\n".join([head, *lines]) + "\n"


def _opensim(rows: int = 40, header: str = "inDegrees=yes") -> str:
    lines = "\n".join(f"{k / 50:.4f}\t{k / 2:.4f}\t{-k / 5:.4f}" for k in range(rows))
    return (
        f"arms\nversion=1\nnRows={rows}\nnColumns=3\n{header}\nendheader\n"
        f"time\tleft_shoulder\tright_shoulder\n{lines}\n"
    )


@cache
def csv() -> list[Folder]:
    """Recordings of two arms between commas, semicolons, tabs and spaces."""
    tables = [_arms(), _arms(";").replace(".", ","), _arms("\t"), _arms().replace(",", ", ")]
    return [_folder(text, "arms.csv") for text in tables]


@cache
def opensim_tables() -> list[Folder]:
    """A motion, in OpenSim's format and in SIMM's, and a storage."""
    simm = _opensim(header="Angles are in degrees.").replace("nRows=40", "datarows 40")
    return [
        _folder(_opensim(), "arms.mot"),
        _folder(simm, "arms.mot"),
        _folder(_opensim().replace("arms", "arms\nDataType=double", 1), "arms.sto"),
    ]


@cache
def column() -> list[Folder]:
    """A torque against time."""
    times = "".join(f"{k}\t{k * k}\n" for k in range(5))
    return [
        _folder("time [ms],hip\n0,0\n100,25\n200,12.5\n", "hip.csv"),
        _folder(f"hip\nnRows=5\nnColumns=2\nendheader\ntime\thip\n{times}", "hip.sto"),
    ]


@cache
def spec() -> list[Folder]:
    """Flights with keyframes and springs, with a recording, and of a model beside it."""
    beside: Folder = {"arms.csv": _arms().encode(), "body.xml": _MJCF.encode(), "pipe": None}
    return [{"main.toml": text.encode(), **beside} for text in _SPECS]


@cache
def ensemble() -> list[Folder]:
    """A grid and draws."""
    return [_folder(text, "main.toml") for text in _ENSEMBLES]


@cache
def measurements() -> list[Folder]:
    """Of nobody, in centimetres."""
    pairs = dict(zip(_TRUNK, _TRUNK_AT, strict=True))
    lines = [f"{name}: {value}" for name, value in pairs.items()]
    for sides, row in (("ab", _ARM), ("jk", _LEG)):
        words = row.split()
        lines += [
            f"L{s}{name}: {v}"
            for s in sides
            for name, v in zip(words[::2], words[1::2], strict=True)
        ]
    text = "# nobody\nmeasurementconversionfactor: 0.01\ntotalmass: 70\n" + "\n".join(lines) + "\n"
    return [_folder(text, "body.txt")]


@cache
def keyframes() -> list[Folder]:
    """Moves of the arms as JSON."""
    moves = {"left_shoulder": [[0.0, 1.4], [0.2, 0.1], [0.3, 0.4]], "right_shoulder": [[0.1, -1.4]]}
    return [_folder(json.dumps(moves, indent=1), "moves.json")]


@cache
def saved() -> list[Folder]:
    """Maneuvers that the package wrote, of a shipped model and of one that is written beside."""
    from tempfile import TemporaryDirectory

    import somersault as so

    body = so.athlete(1.7, 65.0)
    hula = so.Maneuver(body, so.Takeoff(spin=5.0), 0.3)
    moves = so.Maneuver.moves(
        "furrer", {"left_shoulder": [(0.0, 1.4), (0.2, 0.1)]}, so.Takeoff(spin=5.0), 0.3
    )
    folders = []
    for maneuver in (hula, moves):
        with TemporaryDirectory() as place:
            maneuver.save(f"{place}/main.toml")
            folders.append(
                {
                    file.name: file.read_bytes()
                    for file in sorted(Path(place).iterdir(), key=lambda f: f.suffix)
                }
            )
    return folders  # type: ignore[return-value]


@cache
def flights() -> list[Folder]:
    """A flight as NetCDF."""
    from tempfile import TemporaryDirectory

    import somersault as so

    flight = so.fly("furrer", so.Takeoff(spin=5.0), 0.1)
    with TemporaryDirectory() as place:
        flight.save(f"{place}/flight.nc")
        return [{"flight.nc": Path(place, "flight.nc").read_bytes()}]
