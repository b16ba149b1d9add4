"""The numbers of a takeoff by name, one for a flight or one for each of many.

A name is ("takeoff", "tilt"), ("angle", joint), ("times", joint, 2), ("bodies.left_arm.mass",) …:
what can differ between flights that share their equations.
"""

from __future__ import annotations

from collections.abc import Mapping

from somersault._core.array import Array

Name = tuple[str | int, ...]
Values = Mapping[Name, "float | Array"]
