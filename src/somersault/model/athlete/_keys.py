"""An athlete as a table of keys: [athlete] of a SPEC, and `--athlete` of a command."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from somersault._core.errors import SomersaultError
from somersault.model._model import Model
from somersault.model.athlete._measured import athlete_from_measurements
from somersault.model.athlete._stature import athlete


@dataclass(frozen=True)
class AthleteKeys:
    """An athlete by height and mass, as for `athlete`, or by a file of measurements, as for
    `athlete_from_measurements`.

    Parameters
    ----------
    height, mass, sex
        As in `athlete`: m, kg.
    measurements, densities
        The file, and the densities, as in `athlete_from_measurements`; a `mass` goes with them too.
    shoulders, knees, ankles, name
        As in both.
    """

    height: float | None = None
    mass: float | None = None
    sex: str | None = None
    measurements: str | None = None
    densities: str | None = None
    shoulders: str | None = None
    knees: bool = False
    ankles: bool = False
    name: str | None = None

    def model(self) -> Model:
        """The athlete.

        Returns
        -------
        Model

        Raises
        ------
        SomersaultError
            For keys that do not go together, and for what no athlete has.
        """
        given: dict[str, Any] = {
            field.name: value
            for field in fields(self)
            if (value := getattr(self, field.name)) is not None
        }
        if self.measurements is not None:
            _refuse(given, ("height", "sex"), "measurements say that themselves")
            return athlete_from_measurements(given.pop("measurements"), **given)
        _refuse(given, ("densities",), "it goes with measurements")
        if self.height is None or self.mass is None:
            raise SomersaultError("an athlete needs height (m) and mass (kg), or measurements")
        return athlete(**given)


def _refuse(given: dict[str, Any], names: tuple[str, ...], why: str) -> None:
    for name in names:
        if name in given:
            raise SomersaultError(f"athlete.{name} is given, but {why}; leave it out")
