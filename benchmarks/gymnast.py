"""A gymnast of thirteen hinges, the size of the one in Playter (1994), section 6.3.1.

Three hinges in each shoulder, one in each elbow, two in each hip, and one in the torso about
which the upper body twists against the lower: with the attitude of the pelvis 16 rotational
degrees of freedom. The thesis does not print its masses; these are round numbers for a man
of 74 kg, on which the cost of the equations does not depend. SI units; axes 1 front, 2 left,
3 head; arms and legs hang straight down at zero.
"""

from __future__ import annotations

from somersault.model import GROUND, Body, Joint, Model

FRONT, LEFT, HEAD = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def _diagonal(x: float, y: float, z: float):
    return (x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z)


def gymnast() -> Model:
    """The model, in free flight, without springs."""
    bodies = [
        Body("pelvis", GROUND, 20.0, (0.0, 0.0, 0.05), _diagonal(0.2, 0.18, 0.15)),
        Body(
            "torso",
            0,
            25.0,
            (0.0, 0.0, 0.2),
            _diagonal(0.9, 0.8, 0.3),
            position=(0.0, 0.0, 0.1),
            joints=(Joint("torso_twist", "hinge", HEAD),),
        ),
    ]
    for side, name in ((1.0, "left"), (-1.0, "right")):
        shoulder = tuple(
            Joint(f"{name}_shoulder_{k}", "hinge", axis)
            for k, axis in enumerate((FRONT, LEFT, HEAD), 1)
        )
        bodies += [
            Body(
                f"{name}_upper_arm",
                1,
                2.0,
                (0.0, 0.0, -0.14),
                _diagonal(0.012, 0.012, 0.003),
                position=(0.0, side * 0.18, 0.4),
                joints=shoulder,
            ),
            Body(
                f"{name}_forearm",
                len(bodies),
                1.5,
                (0.0, 0.0, -0.15),
                _diagonal(0.012, 0.012, 0.001),
                position=(0.0, 0.0, -0.28),
                joints=(Joint(f"{name}_elbow", "hinge", LEFT),),
            ),
        ]
    for side, name in ((1.0, "left"), (-1.0, "right")):
        hip = (
            Joint(f"{name}_hip_pike", "hinge", LEFT),
            Joint(f"{name}_hip_spread", "hinge", FRONT),
        )
        bodies.append(
            Body(
                f"{name}_leg",
                0,
                11.0,
                (0.0, 0.0, -0.4),
                _diagonal(0.9, 0.9, 0.05),
                position=(0.0, side * 0.09, 0.0),
                joints=hip,
            )
        )
    return Model("gymnast", True, tuple(bodies))
