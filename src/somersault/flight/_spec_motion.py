"""The tables of a SPEC that change a takeoff: a motion from a file, compliance, an attitude off."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from somersault._core.errors import SomersaultError
from somersault.flight._compliance import compliant, off_nominal
from somersault.flight._plans import by_joint
from somersault.flight._prescribed import prescribed
from somersault.flight._takeoff import Takeoff
from somersault.flight.behaviours import JointTakeoff
from somersault.model import Model
from somersault.motion import read_motion
from somersault.spec import Unfit, read_as

Pose = float | str | Mapping[str, Any]
Gain = float | Mapping[str, Any]
_READ = ("names", "ignore_others", "degrees", "cutoff", "rate", "start", "stop", "gap", "slack")


@dataclass(frozen=True)
class Recording:
    """[motion]: the recording in a `file`, mirrored, scaled and delayed in this order; the other
    keys are those of `read_motion`, and a `cutoff` of 0 filters nothing."""

    file: str
    names: Mapping[str, str] | None = None
    ignore_others: bool | None = None
    degrees: bool | None = None
    cutoff: float | None = None
    rate: float | None = None
    start: float | None = None
    stop: float | None = None
    gap: float | None = None
    slack: float | None = None
    mirrored: bool = False
    scaled: float | None = None
    delayed: float | None = None

    def joints(
        self, model: Model, duration: float, others: Mapping[str, JointTakeoff]
    ) -> dict[str, JointTakeoff]:
        """What every joint does that is recorded, or that `others` name, which override it."""
        options: dict[str, Any] = {
            key: getattr(self, key) for key in _READ if getattr(self, key) is not None
        }
        if options.get("cutoff") == 0:
            options["cutoff"] = None
        motion = read_motion(self.file, model, **options)
        if self.mirrored:
            motion = motion.mirrored(model)
        if self.scaled is not None:
            motion = motion.scaled(self.scaled)
        if self.delayed is not None:
            motion = motion.delayed(self.delayed)
        return {**prescribed(model, motion, duration), **by_joint(model, others)}


@dataclass(frozen=True)
class Compliance:
    """[compliance]: the body gives way about what it prescribes; keys as in `compliant`."""

    natural_frequency: Gain | None = None
    pose: Pose | None = None
    damping_ratio: Gain = 0.7
    tape: bool = True
    stop_stiffness: float = 0.0
    stop_damping: float = 0.0

    def applied(self, model: Model, takeoff: Takeoff) -> Takeoff:
        """The takeoff of a body that gives way so."""
        if self.natural_frequency is None or self.pose is None:
            raise SomersaultError(
                "compliance needs natural_frequency (rad/s) and pose: a time of the motion (s), "
                'joint angles by name, "following", or an athlete\'s named pose like "wrap"'
            )
        return compliant(
            model, takeoff, self.natural_frequency, self.damping_ratio, pose=self.pose,
            tape=self.tape, stop_stiffness=self.stop_stiffness, stop_damping=self.stop_damping,
        )  # fmt: skip


@dataclass(frozen=True)
class OffNominal:
    """[off_nominal]: how far off its attitude a takeoff is, rad."""

    somersault: float = 0.0
    tilt: float = 0.0
    twist: float = 0.0

    def applied(self, model: Model, takeoff: Takeoff) -> Takeoff:
        """The takeoff so far off."""
        off = {"somersault": self.somersault, "tilt": self.tilt, "twist": self.twist}
        return off_nominal(model, takeoff, **off)


def _pose(value: Any, _: Any) -> Any:
    one = isinstance(value, int | float) and not isinstance(value, bool)
    if not one and not isinstance(value, str | Mapping):
        raise Unfit("a time (s), joint angles by name or the name of a pose", value)
    return value


def _gain(value: Any, _: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, int | float | Mapping):
        raise Unfit("a number, or numbers by joint", value)
    return value


read_as(Pose | None, _pose)
for _kind in (Gain, Gain | None):
    read_as(_kind, _gain)
