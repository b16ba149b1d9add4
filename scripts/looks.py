"""How the people that ship look: the geoms of their segments, in MJCF.

Trunk and legs are clothed, the rest is bare. Thicknesses are chosen, for a man of 1.741 m; lengths
are those of his segments, in m.
"""

from __future__ import annotations

from collections.abc import Sequence

DEFAULTS = """\
  <default>
    <geom type="capsule" mass="0" contype="0" conaffinity="0" rgba="0.36 0.53 0.74 1"/>
    <default class="bare">
      <geom rgba="0.90 0.69 0.46 1"/>
    </default>
  </default>
"""
_RADII = {"upper_arm": 0.042, "forearm": 0.034, "thigh": 0.070, "shank": 0.048}
_BARE = ("upper_arm", "forearm", "hand", "foot")


def limb(name: str, length: float, top: float = 0.0) -> str:
    """A segment of an arm or a leg, hanging from a height over its frame."""
    kind = name.removeprefix("left_").removeprefix("right_")
    bare = kind in _BARE
    middle = top - length / 2
    if kind == "hand":
        return _ellipsoid(name, middle, (0.02, 0.036, length / 2), bare)
    if kind == "foot":
        return _ellipsoid(name, middle, (0.034, 0.042, length / 2), bare)
    return _capsule(name, (0.0, top), (0.0, top - length), _RADII[kind], bare)


def hips(size: float = 1.0) -> list[str]:
    """The trunk between its origin, midway between the hips, and the ribs."""
    return [
        _ellipsoid("hips", 0.06 * size, _times(size, 0.105, 0.155, 0.13)),
        _ellipsoid("waist", 0.22 * size, _times(size, 0.095, 0.130, 0.18)),
    ]


def chest(shoulder_height: float, neck: float, size: float = 1.0) -> list[str]:
    """The trunk from the ribs up, with the neck, whose upper end is at a height too."""
    low = shoulder_height - 0.03 * size
    return [
        _ellipsoid("chest", shoulder_height - 0.12 * size, _times(size, 0.11, 0.155, 0.19)),
        _capsule("shoulders", (0.12 * size, low), (-0.12 * size, low), 0.05 * size),
        _capsule("neck", (0.0, shoulder_height), (0.0, neck), 0.05 * size, bare=True),
    ]


def head(length: float, bottom: float, size: float = 1.0) -> str:
    """The head and what of the neck goes with it, up to the vertex."""
    up = 0.122 * size
    return _ellipsoid("head", bottom + length - up, (0.1 * size, 0.082 * size, up), bare=True)


def _times(size: float, *lengths: float) -> list[float]:
    return [size * length for length in lengths]


def _capsule(
    name: str, start: Sequence[float], end: Sequence[float], radius: float, bare: bool = False
) -> str:
    """From one place to another, (left, up) each, or with its rounded ends between heights."""
    (y, z), (other, low) = start, end
    if y == other:  # a limb: its ends at the joints
        z, low = z - radius / 2, low + radius / 2
    return _geom(name, f'fromto="{_words(0, y, z, 0, other, low)}" size="{_words(radius)}"', bare)


def _ellipsoid(name: str, height: float, axes: Sequence[float], bare: bool = False) -> str:
    pose = f'type="ellipsoid" pos="{_words(0, 0, height)}" size="{_words(*axes)}"'
    return _geom(name, pose, bare)


def _geom(name: str, shape: str, bare: bool) -> str:
    dress = ' class="bare"' if bare else ""
    return f'<geom name="{name}"{dress} {shape}/>'


def _words(*values: float) -> str:
    return " ".join(f"{value + 0.0:.4f}".rstrip("0").rstrip(".") for value in values)
