"""Which moves of a `.osim` file become joints, and which of these follow others.

A coordinate of OpenSim may drive several axes, by lines of any slope, and a
CoordinateCouplerConstraint lets it be driven by another coordinate itself. Here one joint leads
for each coordinate that nothing drives, and all the others that it moves follow that joint.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from somersault.model._bodies import Follow, Joint
from somersault.model._vectors import Vector
from somersault.model.read._follow import leaders
from somersault.model.read._osim_functions import Curve, Line, function
from somersault.model.read._osim_joints import Coordinate, Links, Move
from somersault.model.read._osim_words import Words
from somersault.model.read._xml import Element

_SAME = Line(1.0)


@dataclass(frozen=True, slots=True)
class _Spring:
    """Of a coordinate: N m/rad, rad, N m s/rad, or the same with metres."""

    stiffness: float
    rest: float
    damping: float


@dataclass(frozen=True, slots=True, eq=False)
class _Gear:
    """A move that becomes a joint, whose coordinate is `line` of the coordinate that leads."""

    move: Move
    own: Coordinate
    name: str
    sign: float
    line: Line


class Gears:
    """The joints for all moves of a model, and what had to be left out for them."""

    def __init__(self, words: Words, model: Element, links: Sequence[Links]) -> None:
        self._words = words
        self.constraints: list[str] = []
        moves = [move for link in links for move in link.moves]
        self._coordinates = {m.coordinate.name: m.coordinate for m in moves if m.coordinate}
        curves: dict[str, tuple[str, Curve]] = {}
        follows: dict[str, Follow] = {}
        for element in model.below("ConstraintSet", "objects"):
            self._constrain(element, follows, curves)
        ends = leaders(words.file, follows, self._coordinates)
        self._lines = {name: Line(end.factor, end.offset) for name, end in ends.items()}
        self._leading = {name: end.leader for name, end in ends.items()}
        self.defaults = {name: c.default for name, c in self._coordinates.items()}
        self.defaults |= {name: line(self.defaults[self._leading[name]])
                          for name, line in self._lines.items()}  # fmt: skip
        self.ranges = {name: c.range for name, c in self._coordinates.items()}
        self.ranges |= {name: line.over(self.ranges[self._leading[name]])
                        for name, line in self._lines.items()}  # fmt: skip
        for name, (by, curve) in curves.items():
            self.defaults[name] = curve(self.defaults[by])
            self.ranges[name] = curve.over(self.ranges[by])
        self._springs = self._sprung(model)
        self._gears = self._geared(moves)

    # --------------------------------------------------------------------------- couplers

    def _constrain(
        self, element: Element, follows: dict[str, Follow], curves: dict[str, tuple[str, Curve]]
    ) -> None:
        words = self._words
        enforced = words.text(element, "isEnforced", "true").lower() != "false"
        if not enforced or words.truth(element, "isDisabled"):
            return
        if element.tag == "CoordinateCouplerConstraint":
            leading = words.text(element, "independent_coordinate_names").split()
            name = words.text(element, "dependent_coordinate_name")
            listed = element.below("coupled_coordinates_function")
            if len(leading) == 1 and listed and {name, *leading} <= self._coordinates.keys():
                by = function(words, listed[0])
                scale = words.number(element, "scale_factor", 1.0)
                if isinstance(by, Line):
                    follows.setdefault(
                        name, Follow(leading[0], scale * by.slope, scale * by.offset)
                    )
                    return
                curves[name] = leading[0], Curve(lambda q: scale * by.values(q))
        self.constraints.append(element.attributes.get("name") or element.tag)

    # ---------------------------------------------------------------------------- springs

    def _sprung(self, model: Element) -> dict[str, list[_Spring]]:
        words, found = self._words, dict[str, list[_Spring]]()
        for element in model.below("ForceSet", "objects"):
            off = words.text(element, "appliesForce", "true").lower() == "false"
            if element.tag != "SpringGeneralizedForce" or off or words.truth(element, "isDisabled"):
                continue
            spring = _Spring(
                words.number(element, "stiffness", 0.0),
                words.number(element, "rest_length", 0.0),
                words.number(element, "viscosity", 0.0),
            )
            name = words.text(element, "coordinate").rpartition("/")[2]
            if name not in self._coordinates:
                raise words.error(f"acts on {name!r}, which is no coordinate; name one", element)
            found.setdefault(name, []).append(spring)
        return found

    # ----------------------------------------------------------------------------- joints

    def _geared(self, moves: list[Move]) -> dict[str, list[_Gear]]:
        """The joints that each coordinate leads, the first of them the one that the others
        follow."""
        found: dict[str, list[_Gear]] = {}
        named: set[str] = set()
        for move in sorted(moves, key=lambda move: not move.turns):
            by = move.function
            if move.coordinate is None or not isinstance(by, Line):
                continue
            own = move.coordinate.name
            of = self._lines.get(own, _SAME)
            if by.slope * of.slope == 0:
                continue
            if abs(by.slope) == 1 and own not in named:  # the coordinate itself is the joint's
                named.add(own)
                gear = _Gear(move, move.coordinate, own, by.slope, of)
            else:
                gear = _Gear(move, move.coordinate, f"{own}_{move.name}", 1.0, by.of(of))
            found.setdefault(self._leading.get(own, own), []).append(gear)
        for leading, gears in found.items():
            gears.sort(key=lambda gear: gear.name != leading)
        return found

    def joint(self, move: Move, axis: Vector, anchor: Vector) -> Joint | None:
        """The joint that a move becomes, in the axes of the body that it moves, or None."""
        if move.coordinate is None:
            return None
        own = move.coordinate.name
        leading = self._leading.get(own, own)
        gears = self._gears.get(leading, [])
        gear = next((gear for gear in gears if gear.move is move), None)
        if gear is None:
            return None
        joint = Joint(
            gear.name,
            "hinge" if move.turns else "slide",
            axis=(gear.sign * axis[0], gear.sign * axis[1], gear.sign * axis[2]),
            anchor=anchor,
            reference=gear.line(self.defaults[leading]),
        )
        if gear is gears[0]:
            return self._leader(joint, gear, self._coordinates[leading])
        follow = gear.line.of(gears[0].line.inverse)
        return replace(joint, follows=Follow(gears[0].name, follow.slope, follow.offset))

    def _leader(self, joint: Joint, gear: _Gear, coordinate: Coordinate) -> Joint:
        """The joint with the limits and the springs of the coordinates that it leads."""
        if coordinate.clamped:
            joint = replace(joint, limits=gear.line.over(coordinate.range))
        stiffness = pull = damping = 0.0
        for name, springs in self._springs.items():
            if self._leading.get(name, name) != coordinate.name:
                continue
            line = self._lines.get(name, _SAME).of(gear.line.inverse)  # of the joint's coordinate
            for spring in springs:
                stiffness += spring.stiffness * line.slope**2
                pull += spring.stiffness * line.slope * (spring.rest - line.offset)
                damping += spring.damping * line.slope**2
        rest = pull / stiffness if stiffness else 0.0
        return replace(joint, stiffness=stiffness, rest=rest, damping=damping)

    def stands(self, move: Move) -> float:
        """By how much a move moves in the default pose (rad or m)."""
        return move.function(self.defaults[move.coordinate.name] if move.coordinate else 0.0)

    # ------------------------------------------------------------------------- in words

    @property
    def geared(self) -> tuple[tuple[str, Follow], ...]:
        """Coordinates that are no joint themselves, and a joint that each of them moves."""
        gears = [gear for gears in self._gears.values() for gear in gears]
        joints = {gear.name for gear in gears}
        found: dict[str, Follow] = {}
        for gear in gears:
            name, by = gear.own.name, gear.move.function
            if name not in joints and isinstance(by, Line):
                found.setdefault(name, Follow(gear.name, by.slope, by.offset))
        return tuple(found.items())
