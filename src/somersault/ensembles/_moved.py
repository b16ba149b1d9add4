"""From varied quantities to the numbers of a simulation that they move."""

from __future__ import annotations

from collections.abc import Mapping

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.ensembles._vary import Vary
from somersault.simulation import Name, Numbers, Simulation, Target


def moved_by(simulation: Simulation, name: str, vary: Vary) -> tuple[Target, ...]:
    """The numbers that a varied quantity moves, by how much for each unit of it.

    Raises
    ------
    SomersaultError
        For a number that is not there.
    """
    try:
        meant = [target for path in vary.targets for target in simulation.targets(path)]
    except SomersaultError as mistake:
        raise SomersaultError(f"vary.{name}: {mistake}") from None
    return tuple(
        Target(t.name, t.factor * vary.scale, 0.0 if vary.adds else t.offset, t.unit) for t in meant
    )


def unit(vary: Vary, targets: tuple[Target, ...]) -> str:
    """The unit of a varied quantity: as given, else that of all the numbers it moves.

    Empty where those have different units, or a scale comes between.
    """
    if vary.unit or vary.scale != 1:
        return vary.unit
    units = {target.unit for target in targets if target.unit is not None}
    return units.pop() if len(units) == 1 else ""


def check_apart(vary: Mapping[str, Vary], targets: Mapping[str, tuple[Target, ...]]) -> None:
    """SomersaultError where two varied quantities set the same number."""
    owner: dict[Name, str] = {}
    for name, group in targets.items():
        for target in group if vary[name].sets else ():
            if target.name in owner:
                raise SomersaultError(
                    f"vary.{owner[target.name]} and vary.{name} set the same number; "
                    "let one of them be added to it"
                )
            owner[target.name] = name


def moved(
    values: Numbers, vary: Mapping[str, Vary], targets: Mapping[str, tuple[Target, ...]],
    given: Mapping[str, Array],
) -> dict[Name, float | Array]:  # fmt: skip
    """The numbers, with those that are varied as arrays over the runs."""
    numbers = dict(values)
    for name in sorted(targets, key=lambda name: bool(vary[name].adds_to)):  # what is set, first
        for target in targets[name]:
            value = target.factor * given[name] + target.offset
            before = numbers[target.name] if vary[name].adds_to else 0.0
            numbers[target.name] = before + value
    return numbers
