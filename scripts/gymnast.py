"""Write the gymnast that ships, `gymnast.xml`: an athlete of de Leva's proportions.

Run it to rewrite the file; the same numbers always give the same bytes.
"""

from __future__ import annotations

from pathlib import Path

import looks
import numpy as np

from somersault.attitude import quaternion_from_matrix
from somersault.model import Body, Joint, Model, athlete
from somersault.model.athlete._de_leva import HEEL_BEHIND_ANKLE, MALE

PATH = Path(__file__).parents[1] / "src" / "somersault" / "model" / "shipped" / "gymnast.xml"
HEIGHT = 1.67  # m
MASS = 64.0  # kg

HEADER = """\
<!--
A gymnast with the thirteen joints of Playter (1994), section 6.3.1: three hinges in each shoulder,
one at each elbow, two in each hip, and one in the torso, by which the upper body twists against the
lower. Written by scripts/gymnast.py; change it there.

  size      height {height:g}, the mean of the men in artistic gymnastics at the Olympic Games of
            2012 (1.669); mass {mass:g}, chosen: body mass index {index:.1f}.
  segments  de Leva P (1996), Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters,
            J Biomech 29(9):1223-1230, Table 4, men: mass, centre of mass, radii of gyration
            (sagittal, transverse, longitudinal: axes 1, 2, 3) and length between vertex,
            cervicale, xiphion, mid-hip and joint centres. Lengths times {height:g}/{standard:g},
            masses times {mass:g}/100. Shoulder height over the hips is the same table's.
  bodies    pelvis = lower and middle trunk; torso = upper trunk and head; forearm = forearm and
            hand; leg = thigh, shank and foot. A body's numbers follow from its rows by the
            parallel-axis theorem. The torso's joint is at the xiphion.
  breadths  not in that table: shoulder half-width 0.18 (Furrer, Playter's Table 4.1) and hip
            half-width 0.085 (Braune and Fischer 1895), of a man of {standard:g}; pointed feet along
            the shanks, the ankle 0.06 before the heel (assumed).
  frames    axes 1 front, 2 left, 3 head; the root's origin is midway between the hips. At zero
            the arms hang, turned inward by 30 degrees, and all frames are parallel but the
            forearms', which turn with the arms.
  hinges    positive is anatomical flexion, abduction and inward rotation on both sides, and the
            torso turning to the left. A shoulder's hinges act in the order abduction, rotation,
            flexion; the first and last align at a rotation of 90 degrees, which its range leaves
            out.
  ranges    American Academy of Orthopaedic Surgeons (1965) Joint Motion, with these changes, in
            degrees: shoulder abduction -45 to 190; shoulder rotation -72 to 72 from the 30 inward;
            elbow 0 to 150; hip flexion to 160, 40 of them the lumbar spine's, which has no joint.

SI units and radians. Geoms are pictures without mass; their sizes are not data.
-->
<mujoco model="gymnast">
  <compiler angle="radian" inertiafromgeom="false"/>
  <option gravity="0 0 0"/>
{looks}  <worldbody>
"""


def numbers(values: object) -> str:
    """Numbers as they stand in the file: nine decimals, a nanometre and a gram mm²."""
    rounded = np.round(np.ravel(np.asarray(values, float)), 9) + 0.0
    return " ".join(f"{value:.9f}".rstrip("0").rstrip(".") for value in rounded)


def geoms(name: str) -> list[str]:
    """What a body looks like: its segments, seen from its frame."""
    kind = name.removeprefix("left_").removeprefix("right_")
    side = name[: -len(kind)]
    size = HEIGHT / MALE.height
    long = {row: size * segment.length for row, segment in MALE.segments.items()}
    waist = long["lower_trunk"] + long["middle_trunk"]
    ankle = -long["thigh"] - long["shank"]
    upper = long["upper_trunk"]
    if kind == "pelvis":
        return looks.hips(size)
    if kind == "torso":
        chest = looks.chest(size * MALE.shoulder_height - waist, upper + 0.06 * size, size)
        return [*chest, looks.head(long["head"], upper, size)]
    tops = {
        "upper_arm": {"upper_arm": 0.0},
        "forearm": {"forearm": 0.0, "hand": -long["forearm"]},
        "leg": {"thigh": 0.0, "shank": -long["thigh"], "foot": ankle + size * HEEL_BEHIND_ANKLE},
    }
    return [looks.limb(side + row, long[row], top) for row, top in tops[kind].items()]


def joint(hinge: Joint) -> str:
    """One hinge through the origin of its body's frame."""
    return (
        f'<joint name="{hinge.name}" type="hinge" axis="{numbers(hinge.axis)}"'
        f' range="{numbers(hinge.limits)}"/>'
    )


def body(model: Model, index: int) -> list[str]:
    """Lines of one body and all that hangs from it."""
    own: Body = model.bodies[index]
    turn = numbers(quaternion_from_matrix(np.array(own.rotation)))
    turned = "" if turn == "1 0 0 0" else f' quat="{turn}"'
    placed = "" if index == 0 else f' pos="{numbers(own.position)}"{turned}'
    inertia = np.array(own.inertia)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    inside = ["<freejoint/>"] if index == 0 else [joint(hinge) for hinge in own.joints]
    inside += [
        f'<inertial pos="{numbers(own.com)}" mass="{numbers(own.mass)}"'
        f' fullinertia="{numbers(inertia)}"/>',
        *geoms(own.name),
    ]
    for child, other in enumerate(model.bodies):
        if other.parent == index:
            inside += body(model, child)
    return [f'<body name="{own.name}"{placed}>', *("  " + line for line in inside), "</body>"]


def mjcf() -> str:
    """The whole file."""
    return (
        HEADER.format(
            height=HEIGHT,
            mass=MASS,
            index=MASS / HEIGHT**2,
            standard=MALE.height,
            looks=looks.DEFAULTS,
        )
        + "".join(f"    {line}\n" for line in body(athlete(HEIGHT, MASS), 0))
        + "  </worldbody>\n</mujoco>\n"
    )


def main() -> None:
    """Write the file."""
    PATH.write_text(mjcf(), encoding="utf-8", newline="\n")
    print(f"wrote {PATH.name}")


if __name__ == "__main__":
    main()
