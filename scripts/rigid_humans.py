"""Pose a rigid athlete in layout, pike and tuck and write the three MJCF files that ship.

The athlete is the mean man of de Leva (1996): 1.741 m, 73.0 kg. Run it to rewrite
`human_layout.xml`, `human_pike.xml` and `human_tuck.xml`; the same numbers always give the
same bytes.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import looks
import numpy as np

from somersault.model.athlete._de_leva import (
    HEEL_BEHIND_ANKLE,
    HIP_HALF_WIDTH,
    MALE,
    SHOULDER_HALF_WIDTH,
)

SHIPPED = Path(__file__).parents[1] / "src" / "somersault" / "model" / "shipped"
SHOULDER_HEIGHT = MALE.shoulder_height
SEGMENTS = ("head", "trunk", "upper_arm", "forearm", "hand", "thigh", "shank", "foot")
TABLE = {name: MALE.segments[name] for name in SEGMENTS}

FRONT, LEFT, HEAD = np.eye(3)


@dataclass(frozen=True)
class Pose:
    """Hip and knee flexion (rad), and where the left wrist goes.

    Without `wrist` the straight arms hang, abducted by `abduction` (rad). Else the wrist is
    at (fraction down the shank, m to its front, m to its outside); the elbow points outward
    and the hand lies along the shank.
    """

    name: str
    about: str
    hip: float = 0.0
    knee: float = 0.0
    abduction: float = 0.0
    wrist: tuple[float, float, float] | None = None


POSES = (
    Pose(
        "layout",
        "Straight; the straight arms abducted by 0.12 rad, so that the hands clear the thighs.",
        abduction=0.12,
    ),
    Pose(
        "pike",
        "Hips flexed by 2.2 rad, knees straight; wrists beside the middle of the shanks.",
        hip=2.2,
        wrist=(0.5, 0.0, 0.06),
    ),
    Pose(
        "tuck",
        "Hips and knees flexed by 2.4 rad; wrists in front of the middle of the shanks.",
        hip=2.4,
        knee=2.4,
        wrist=(0.5, 0.05, 0.03),
    ),
)


def turn(axis: np.ndarray, angle: float) -> np.ndarray:
    """Rotation matrix about a unit axis (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def along(down: np.ndarray, front: np.ndarray) -> np.ndarray:
    """Axes, as columns, of a segment that runs along `down` with its front nearest `front`."""
    third = -down / np.linalg.norm(down)
    second = np.cross(third, front)
    second /= np.linalg.norm(second)
    return np.column_stack([np.cross(second, third), second, third])


def quaternion(rotation: np.ndarray) -> np.ndarray:
    """Unit quaternion, scalar first and not negative, of a turn by less than half a revolution."""
    w = np.sqrt(max(0.0, 1 + np.trace(rotation))) / 2
    skew = rotation - rotation.T
    return np.array([w, *(np.array([skew[2, 1], skew[0, 2], skew[1, 0]]) / (4 * w))])


def arm(pose: Pose, thigh: np.ndarray, shank: np.ndarray) -> tuple[np.ndarray, ...]:
    """Axes of the left upper arm, forearm and hand in the trunk's, for a posed leg."""
    if pose.wrist is None:
        return (turn(FRONT, pose.abduction),) * 3
    fraction, ahead, outside = pose.wrist
    knee = HIP_HALF_WIDTH * LEFT - TABLE["thigh"].length * thigh[:, 2]
    wrist = knee + shank @ [ahead, outside, -fraction * TABLE["shank"].length]
    reach = wrist - (SHOULDER_HALF_WIDTH * LEFT + SHOULDER_HEIGHT * HEAD)
    upper, fore = TABLE["upper_arm"].length, TABLE["forearm"].length
    distance = np.linalg.norm(reach)
    if distance > upper + fore:
        raise ValueError(f"{pose.name}: the wrist is {distance:.3f} m from the shoulder")
    straight = reach / distance
    outward = LEFT - (LEFT @ straight) * straight
    outward /= np.linalg.norm(outward)
    cosine = (upper**2 + distance**2 - fore**2) / (2 * upper * distance)
    elbow = upper * (cosine * straight + np.sqrt(1 - cosine**2) * outward)
    return along(elbow, FRONT), along(reach - elbow, FRONT), along(-shank[:, 2], shank[:, 0])


def numbers(values: np.ndarray | list[float]) -> str:
    """Numbers as they stand in the file: six decimals are a micrometre and a microradian."""
    return " ".join(f"{value + 0.0:.6f}".rstrip("0").rstrip(".") for value in np.round(values, 6))


def body(
    name: str,
    position: np.ndarray | list[float],
    rotation: np.ndarray,
    children: list[str],
    start: float = 0.0,
) -> list[str]:
    """Lines of one segment that runs down its own axis 3 from `start` above its frame."""
    kind = name.removeprefix("left_").removeprefix("right_")
    segment = TABLE[kind]
    mass = MALE.mass * segment.mass / 100
    inertia = segment.inertia(mass, segment.length)
    centre = start - segment.com / 100 * segment.length
    inertial = (
        f'  <inertial pos="0 0 {numbers([centre])}" mass="{numbers([mass])}"'
        f' diaginertia="{numbers(inertia)}"/>'
    )
    return [
        f'<body name="{name}" pos="{numbers(position)}" quat="{numbers(quaternion(rotation))}">',
        inertial,
        *("  " + line for line in seen(name, segment.length, start)),
        *("  " + line for line in children),
        "</body>",
    ]


def seen(name: str, length: float, start: float) -> list[str]:
    """What a segment looks like."""
    if name == "trunk":
        return [*looks.hips(), *looks.chest(SHOULDER_HEIGHT, length + 0.06)]
    return [looks.head(length, 0.0) if name == "head" else looks.limb(name, length, start)]


def limbs(pose: Pose, side: str) -> list[str]:
    """One arm and one leg; the right ones are the mirror image of the left."""
    mirror = np.diag([1.0, 1.0 if side == "left" else -1.0, 1.0])
    thigh = turn(LEFT, -pose.hip)
    shank = turn(LEFT, pose.knee - pose.hip)
    upper, fore, hand = (mirror @ axes @ mirror for axes in arm(pose, thigh, shank))

    def hang(name: str) -> np.ndarray:
        return -TABLE[name].length * HEAD

    arms = body(
        f"{side}_upper_arm",
        mirror @ (SHOULDER_HALF_WIDTH * LEFT + SHOULDER_HEIGHT * HEAD),
        upper,
        body(
            f"{side}_forearm",
            hang("upper_arm"),
            upper.T @ fore,
            body(f"{side}_hand", hang("forearm"), fore.T @ hand, []),
        ),
    )
    legs = body(
        f"{side}_thigh",
        mirror @ (HIP_HALF_WIDTH * LEFT),
        thigh,
        body(
            f"{side}_shank",
            hang("thigh"),
            thigh.T @ shank,
            body(f"{side}_foot", hang("shank"), np.eye(3), [], start=HEEL_BEHIND_ANKLE),
        ),
    )
    return arms + legs


def mjcf(pose: Pose) -> str:
    """The whole file of one pose."""
    trunk, head = TABLE["trunk"], TABLE["head"]
    parts = body("head", trunk.length * HEAD, np.eye(3), [], start=head.length)
    for side in ("left", "right"):
        parts += limbs(pose, side)
    lines = body("trunk", np.zeros(3), np.eye(3), parts, start=trunk.length)
    lines[:1] = ['<body name="trunk">', "  <freejoint/>"]
    return (
        HEADER.format(name=pose.name, about=pose.about, looks=looks.DEFAULTS)
        + "".join(f"    {line}\n" for line in lines)
        + "  </worldbody>\n</mujoco>\n"
    )


HEADER = """\
<!--
A rigid athlete in the {name} position, for figures 2-5 and 2-6 of Playter (1994).
{about}
Written by scripts/rigid_humans.py; change it there.

The segments are those of the mean man, 1.741 m and 73.0 kg, of de Leva P (1996), Adjustments to
Zatsiorsky-Seluyanov's segment inertia parameters, J Biomech 29(9):1223-1230, Table 4: mass, centre
of mass, radii of gyration (sagittal, transverse, longitudinal: axes 1, 2, 3) and length between
vertex, cervicale, mid-hip, and joint centres. Each is welded to its parent at the pose's angles,
its frame at its upper joint and its inertia as the table gives it, so that every number can be
seen. Shoulder height (0.5155 above the hips) is the same table's.

Not in that table: shoulder half-width 0.18 (Furrer, Playter's Table 4.1); hip half-width 0.085
(Braune and Fischer 1895, 0.17 between the hip centres); pointed feet, along the shanks, with the
ankle 0.06 before the heel (assumed; 0.02 more or less changes no inertia by 1.1 %).

The trunk's frame is the root: origin midway between the hips, axes 1 front, 2 left, 3 head.
SI units. Geoms are pictures without mass; their sizes are not data.
-->
<mujoco model="human_{name}">
  <compiler angle="radian" inertiafromgeom="false"/>
  <option gravity="0 0 0"/>
{looks}  <worldbody>
"""


def main() -> None:
    """Write the three files."""
    for pose in POSES:
        path = SHIPPED / f"human_{pose.name}.xml"
        path.write_text(mjcf(pose), encoding="utf-8", newline="\n")
        print(f"wrote {path.name}")


if __name__ == "__main__":
    main()
