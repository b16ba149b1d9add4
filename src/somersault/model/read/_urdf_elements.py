"""The links and joints in the text of a URDF file, and whatever else it holds.

Meanings follow urdfdom, ROS's own reader: of two elements where one belongs the first counts; a
joint without an axis is about x; a limit without an end is zero there. It passes over what it
does not know in silence; here that is named, for it is mostly a known word misspelt.
"""

from __future__ import annotations

import difflib
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.model._bodies import Follow
from somersault.model._strange import Strange
from somersault.model.read._xml import Element

Kind = Literal["fixed", "revolute", "continuous", "prismatic", "floating", "planar"]

_LARGEST = 1e15  # beyond any mass, length or inertia; keeps their products finite
_MOST_LINKS = 2000

# The words that say how a robot moves: the children and the attributes of each element.
_CHILDREN: dict[str, tuple[str, ...]] = {
    "robot": ("link", "joint"),
    "link": ("inertial",),
    "inertial": ("origin", "mass", "inertia"),
    "joint": ("origin", "parent", "child", "axis", "limit", "dynamics", "mimic"),
}
_ATTRIBUTES: dict[str, tuple[str, ...]] = {
    "link": ("name", "type"),
    "joint": ("name", "type"),
    "origin": ("xyz", "rpy"),
    "mass": ("value",),
    "inertia": ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"),
    "parent": ("link",),
    "child": ("link",),
    "axis": ("xyz",),
    "limit": ("lower", "upper", "effort", "velocity", "acceleration", "jerk"),
    "dynamics": ("damping", "friction"),
    "mimic": ("joint", "multiplier", "offset"),
}
# Known elements that have no part in flight, and what to call them where they are counted.
_NO_PART: dict[str, dict[str, str]] = {
    "robot": {
        "material": "", "mujoco": "", "transmission": "transmission", "gazebo": "gazebo element",
        "sensor": "sensor", "ros2_control": "ros2_control element", "group": "", "group_state": "",
        "disable_collisions": "", "end_effector": "", "virtual_joint": "", "passive_joint": "",
        "loop_joint": "loop joint", "drake:joint": "", "plugin": "plugin",
    },
    "link": {"visual": "", "collision": "collision shape", "contact": "", "sensor": "sensor"},
    "inertial": {},
    "joint": {"safety_controller": "", "calibration": "", "hardwareInterface": "",
              "hardware_interface": "", "actuator": "", "joint_properties": ""},
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Link:
    """A link: mass, centre of mass in its own axes, and inertia about that in the same axes.

    `given` says whether the file gives them; a link without <inertial> has no mass.
    """

    name: str
    mass: float
    com: Array
    inertia: Array
    given: bool = True

    @property
    def moves(self) -> bool:
        """Whether it takes a force or a torque to move it."""
        return self.mass != 0 or bool(np.any(self.inertia != 0))


@dataclass(frozen=True, slots=True)
class UrdfJoint:
    """A joint as the file gives it; `position` and `rotation` place the child in its parent."""

    name: str
    kind: Kind
    parent: str
    child: str
    position: Array
    rotation: Array
    axis: Array
    limits: tuple[float, float] | None
    damping: float
    mimic: Follow | None


class Elements:
    """The links and joints of a robot, in the order of the file."""

    def __init__(self, file: str, robot: Element) -> None:
        self.file = file
        self.strange = Strange()
        self.no_part: Counter[str] = Counter()
        self._met: set[str] = set()  # what is not understood is named where it first stands
        if robot.tag != "robot":
            raise SomersaultError(
                f"{file} starts with <{robot.tag[:40]}>, and a URDF file with <robot>; is this one?"
            )
        self._sort(robot, "robot", "the robot")
        links = [self._link(element) for element in robot.all("link")]
        if not links:
            xacro = any(e.tag.startswith("xacro:") for e in robot.children)
            mend = "expand it with xacro first" if xacro else "is this a robot?"
            raise SomersaultError(f"{file} has no links; {mend}")
        if len(links) > _MOST_LINKS:
            raise SomersaultError(
                f"{file} has {len(links)} links, more than the {_MOST_LINKS} that are read; "
                "leave some out"
            )
        self.links = {link.name: link for link in links}
        self.joints = [self._joint(element) for element in robot.all("joint")]
        for what, names in (
            ("links", [link.name for link in links]),
            ("joints", [joint.name for joint in self.joints]),
        ):
            twice = [name for name, count in Counter(names).items() if count > 1]
            if twice:
                raise SomersaultError(f"{file} has two {what} named {twice[0]!r}; rename one")

    # --------------------------------------------------------------------- links and joints

    def _link(self, element: Element) -> Link:
        name = self._name(element)
        where = f"link {name!r}"
        self._sort(element, "link", where)
        inertial = element.first("inertial")
        if inertial is None:
            return Link(name, 0.0, np.zeros(3), np.zeros((3, 3)), given=False)
        self._sort(inertial, "inertial", where)
        self._once(inertial, where)
        com, rotation = self.origin(inertial, where)
        mass = self.number(self.needed(inertial, "mass", where), "value", where)
        moments = self.needed(inertial, "inertia", where)
        xx, yy, zz = (self.number(moments, word, where) for word in ("ixx", "iyy", "izz"))
        products = []
        for word in ("ixy", "ixz", "iyz"):
            if word not in moments.attributes:
                self.strange.add("products of inertia that are not given count as zero", where)
            products.append(self.number(moments, word, where, 0.0))
        xy, xz, yz = products
        inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        return Link(name, mass, com, rotation @ inertia @ rotation.T)

    def _joint(self, element: Element) -> UrdfJoint:
        name = self._name(element)
        where = f"joint {name!r}"
        self._sort(element, "joint", where)
        self._once(element, where)
        kind = element.attributes.get("type", "")
        if kind not in get_args(Kind):
            raise self._error(
                element,
                f"{where} is of type {kind[:40]!r}, which URDF does not know; use "
                f"{', '.join(get_args(Kind))}",
            )
        ends = []
        for end in ("parent", "child"):
            link = self.word(self.needed(element, end, where), "link", where)
            if link not in self.links:
                raise self._error(element, f"{where} has the {end} {link!r}, which is no link")
            ends.append(link)
        position, rotation = self.origin(element, where)
        dynamics = element.first("dynamics")
        if dynamics is not None and self.number(dynamics, "friction", where, 0.0) != 0:
            self.strange.add("joints' dry friction is left out", name)
        return UrdfJoint(
            name,
            kind,  # type: ignore[arg-type]
            ends[0],
            ends[1],
            position,
            rotation,
            self._axis(element, kind, where),
            self._limits(element, kind, where),
            self._damping(dynamics, where),
            self._mimic(element, where),
        )

    def _damping(self, dynamics: Element | None, where: str) -> float:
        if dynamics is None:
            return 0.0
        damping = self.number(dynamics, "damping", where, 0.0)
        if damping < 0:
            raise self._error(
                dynamics, f"{where} has the negative damping {damping:g}; make it zero or positive"
            )
        return damping

    def _axis(self, element: Element, kind: str, where: str) -> Array:
        given = element.first("axis")
        if given is None or kind in ("fixed", "floating"):
            return np.array([1.0, 0.0, 0.0])
        axis = self.vector(given, "xyz", where, (1.0, 0.0, 0.0))
        length = math.hypot(*axis)
        if length < 1e-9:
            raise self._error(given, f"{where} has an axis of no length; give its direction")
        return axis / length

    def _limits(self, element: Element, kind: str, where: str) -> tuple[float, float] | None:
        given = element.first("limit")
        if kind not in ("revolute", "prismatic"):
            return None
        if given is None or not {"lower", "upper"} & set(given.attributes):
            self.strange.add(f"joints that are {kind} and say no limits have none", where)
            return None
        try:
            low, high = (
                float(given.attributes.get(end, "0").strip()) for end in ("lower", "upper")
            )
        except ValueError:
            raise self._error(given, f"{where} has limits that are no numbers; correct them") from (
                None
            )
        if math.isnan(low) or math.isnan(high) or max(abs(low), abs(high)) > _LARGEST:
            return None  # written to say that there is none
        if low > high:
            self.strange.add("limits the wrong way round are taken the other way", where)
        return min(low, high), max(low, high)

    def _mimic(self, element: Element, where: str) -> Follow | None:
        given = element.first("mimic")
        if given is None:
            return None
        return Follow(
            self.word(given, "joint", where),
            self.number(given, "multiplier", where, 1.0),
            self.number(given, "offset", where, 0.0),
        )

    def origin(self, element: Element, where: str) -> tuple[Array, Array]:
        """Position in m and rotation (columns: the axes of what stands there)."""
        given = element.first("origin")
        if given is None:
            return np.zeros(3), np.eye(3)
        roll, pitch, yaw = self.vector(given, "rpy", where, (0.0, 0.0, 0.0))
        (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a), math.sin(a)) for a in (roll, pitch, yaw))
        about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
        about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
        about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
        return self.vector(given, "xyz", where, (0.0, 0.0, 0.0)), about_z @ about_y @ about_x

    # ---------------------------------------------------------------------- words and numbers

    def _name(self, element: Element) -> str:
        name = element.attributes.get("name", "")
        if not name:
            raise self._error(element, f"a {element.tag} has no name; name it")
        return name

    def needed(self, element: Element, tag: str, where: str) -> Element:
        child = element.first(tag)
        if child is None:
            raise self._error(element, f"{where} has no <{tag}>, which it needs; add it")
        return child

    def word(self, element: Element, attribute: str, where: str) -> str:
        word = element.attributes.get(attribute, "")
        if not word:
            raise self._error(element, f"the <{element.tag}> of {where} has no {attribute}; add it")
        return word

    def number(
        self, element: Element, attribute: str, where: str, default: float | None = None
    ) -> float:
        return self.numbers(element, attribute, where, 1, None if default is None else [default])[0]

    def vector(
        self,
        element: Element,
        attribute: str,
        where: str,
        default: tuple[float, float, float] | None = None,
    ) -> Array:
        return np.array(self.numbers(element, attribute, where, 3, default))

    def numbers(
        self,
        element: Element,
        attribute: str,
        where: str,
        count: int,
        default: Sequence[float] | None = None,
    ) -> list[float]:
        text = element.attributes.get(attribute)
        if text is None:
            if default is not None:
                return list(default)
            add = "a number" if count == 1 else f"{count} numbers"
            raise self._error(
                element, f"the <{element.tag}> of {where} has no {attribute}; add {add}"
            )
        words = text[:1000].split()
        try:
            values = [float(word) for word in words if "_" not in word]
        except ValueError:
            values = []
        if len(values) != count or not all(abs(value) <= _LARGEST for value in values):
            wanted = "a finite number" if count == 1 else f"{count} finite numbers"
            raise self._error(
                element,
                f"{attribute} of the <{element.tag}> of {where} must be {wanted}, and is "
                f"{text[:40]!r}",
            )
        return values

    def _error(self, element: Element, what: str) -> SomersaultError:
        return SomersaultError(f"{self.file}, line {element.line}: {what}")

    # ----------------------------------------------------------------- what is not understood

    def _once(self, element: Element, where: str) -> None:
        """Name elements that stand twice where one belongs."""
        counts = Counter(child.tag for child in element.children)
        for tag in _CHILDREN[element.tag]:
            if counts[tag] > 1:
                self.strange.add("of two elements where one belongs the first counts", where)

    def _sort(self, element: Element, kind: str, where: str) -> None:
        """Count the children that have no part in flight, and name those that nobody knows."""
        self._attributes(element, kind, where)
        for child in element.children:
            if child.tag in _CHILDREN[kind]:
                if child.tag not in _CHILDREN:
                    self._attributes(child, child.tag, where)
            elif child.tag in _NO_PART[kind]:
                called = _NO_PART[kind][child.tag]
                if called:
                    self.no_part[called] += 1
            else:
                self._unknown(f"<{child.tag[:40]}>", where, child.tag, _CHILDREN[kind])

    def _attributes(self, element: Element, kind: str, where: str) -> None:
        known = _ATTRIBUTES.get(kind, ())
        for attribute in element.attributes if known else ():
            if attribute not in known and not attribute.startswith("xmlns"):
                self._unknown(f"{attribute[:40]} of <{kind}>", where, attribute, known)

    def _unknown(self, what: str, where: str, word: str, known: tuple[str, ...]) -> None:
        if what in self._met:
            return
        self._met.add(what)
        near = difflib.get_close_matches(word[:40].lower(), known, 1, 0.7)
        hint = f" (did you mean {near[0]}?)" if near else ""
        self.strange.add("not understood, and left out", f"{what} in {where}{hint}")
