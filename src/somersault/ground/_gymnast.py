"""Who lands, and on what: feet, the strength of the joints, the floor."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass, fields
from typing import Any

from somersault._core.checks import instance, text
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.model import Model


def positive(table: Any, title: str, zero: Container[str] = ()) -> None:
    """SomersaultError unless all numbers of a table are above zero; those named may be `zero`."""
    for field in fields(table):
        value = number(f"{field.name} of {title}", getattr(table, field.name))
        if value < 0 or (value == 0 and field.name not in zero):
            least = "not be negative" if field.name in zero else "be above zero"
            raise SomersaultError(f"{field.name} of {title} must {least}, and is {value:g}")


@dataclass(frozen=True)
class Floor:
    """What is landed on: a plane at the height 0.

    Parameters
    ----------
    friction : float
        Coefficient of dry friction.
    softness : float
        Time constant with which it comes back from being pressed in, s: `solref` of MuJoCo, damped
        critically. With 0.03 s a fall from the high bar presses the feet in by 4 to 5 cm, as into
        a mat.

    Examples
    --------
    >>> from somersault.ground import Floor
    >>> Floor(friction=0.6).softness
    0.03
    """

    friction: float = 1.0
    softness: float = 0.03

    def __post_init__(self) -> None:
        positive(self, "a floor")


@dataclass(frozen=True)
class Feet:
    """The soles, flat with the ankle at a right angle.

    They touch the floor at heel and toes. The numbers are those of an athlete of 1.67 m.

    Parameters
    ----------
    ankle : float
        Height of the ankle above the sole, m: 0.039 of the stature (Winter).
    heel : float
        From the ankle back to the end of the heel, m.
    toes : float
        From the ankle forwards to the tip of the toes, m.
    rounding : float
        Radius of heel and toes, m.
    """

    ankle: float = 0.065
    heel: float = 0.06
    toes: float = 0.188
    rounding: float = 0.015

    def __post_init__(self) -> None:
        positive(self, "feet")
        if self.heel + self.toes <= 2 * self.rounding:
            raise SomersaultError(
                f"feet {self.heel + self.toes:g} m long cannot be rounded with a radius of "
                f"{self.rounding:g} m; give a smaller one"
            )


@dataclass(frozen=True)
class Strength:
    """The greatest torque at each joint, both sides together, N m.

    Parameters
    ----------
    shoulder, hip, knee, ankle : float
        Assumed: those of a strong gymnast whose muscles are being stretched.
    """

    shoulder: float = 250.0
    hip: float = 600.0
    knee: float = 700.0
    ankle: float = 450.0

    def __post_init__(self) -> None:
        positive(self, "strength")


@dataclass(frozen=True)
class Gymnast:
    """A planar body with arms and legs, and what it lands with.

    Parameters
    ----------
    model : Model
        Free, in the plane across axis 2, with the trunk for its base and four hinges; as
        `sagittal(athlete(…, knees=True, ankles=True))` makes one.
    feet : Feet
    strength : Strength
    shoulder, hip, knee, ankle : str
        What the four joints are called.

    Raises
    ------
    SomersaultError
        For a body that is none of the kind.

    Examples
    --------
    >>> import somersault as so
    >>> model = so.sagittal(so.athlete(1.67, 64, knees=True, ankles=True))
    >>> so.ground.Gymnast(model).joints
    ('shoulder_flexion', 'hip_flexion', 'knee', 'ankle')
    """

    model: Model
    feet: Feet = Feet()
    strength: Strength = Strength()
    shoulder: str = "shoulder_flexion"
    hip: str = "hip_flexion"
    knee: str = "knee"
    ankle: str = "ankle"

    def __post_init__(self) -> None:
        model = instance("model", self.model, Model)
        instance("feet", self.feet, Feet)
        instance("strength", self.strength, Strength)
        if not model.free or model.plane != 2 or model.axes[0] != 2:
            raise SomersaultError(
                f"{model.name} does not land by itself: that takes a body in its plane; make one "
                "by sagittal(…)"
            )
        for what in ("shoulder", "hip", "knee", "ankle"):
            text(f"{what} of a gymnast", getattr(self, what))
        if set(model.coordinates) != set(self.joints) or len(set(self.joints)) != 4:
            raise SomersaultError(
                f"a landing takes the joints {', '.join(self.joints)}, and {model.name} has "
                f"{', '.join(model.coordinates) or 'none'}; name them, or take an athlete with "
                "knees and ankles"
            )

    @property
    def joints(self) -> tuple[str, str, str, str]:
        """Names of shoulder, hip, knee and ankle."""
        return self.shoulder, self.hip, self.knee, self.ankle
