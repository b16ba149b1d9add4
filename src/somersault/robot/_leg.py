"""Which parts of a model are a leg."""

from __future__ import annotations

from dataclasses import dataclass

from somersault._core.checks import name_list, shown, text
from somersault._core.errors import SomersaultError


@dataclass(frozen=True)
class Leg:
    """Which parts of a model are a leg.

    Parameters
    ----------
    hip : tuple of str
        The hinges about the body's axes 2, 1 and 3, from the torso outwards: fore and aft, sideways
        and about the leg. A motor acts on each.
    slide : str
        The joint by which the leg gets longer.
    foot : str
        The sphere that it stands on.
    spring : str
        The actuator that pushes the leg to its piston's length, of the kind `position`.
    stop : str
        The one that pulls it back to that.

    Examples
    --------
    >>> from somersault.robot import Leg
    >>> Leg.called("left").hip
    ('left_hip_y', 'left_hip_x', 'left_hip_z')
    """

    hip: tuple[str, str, str]
    slide: str
    foot: str
    spring: str
    stop: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "hip", name_list("hip of a leg", self.hip))
        if len(self.hip) != 3:
            raise SomersaultError(f"hip of a leg must be three joints, and is {shown(self.hip)}")
        for part in ("slide", "foot", "spring", "stop"):
            text(f"{part} of a leg", getattr(self, part))

        if len(set(self.parts)) < len(self.parts):
            twice = next(part for part in self.parts if self.parts.count(part) > 1)
            raise SomersaultError(
                f"a leg cannot have {shown(twice[1])} twice; name each of its parts"
            )

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """What each part is in a model, a joint, geom or actuator, and its name there."""
        joints = [("joint", name) for name in (*self.hip, self.slide)]
        actuators = [("actuator", self.spring), ("actuator", self.stop)]
        return (*joints, ("geom", self.foot), *actuators)

    @classmethod
    def called(cls, side: str) -> Leg:
        """A leg whose parts have the names that they have in the model `biped`.

        Parameters
        ----------
        side : str
            "left" or "right".

        Returns
        -------
        Leg
        """
        side = text("side", side)
        hip = (f"{side}_hip_y", f"{side}_hip_x", f"{side}_hip_z")
        return cls(hip, f"{side}_leg", f"{side}_foot", f"{side}_spring", f"{side}_stop")
