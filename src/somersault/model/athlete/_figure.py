"""What an athlete looks like: solids through the cross-sections of trunk and limbs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from somersault._core.array import Array
from somersault.model.athlete._de_leva import Segment
from somersault.model.shapes import Color, Ellipsoid, Mesh, loft

_AROUND = 24  # points around a cross-section
_CAP = 4  # rings that round an end
BALL = 0.8  # how far the ball of a joint stands out, over its radius
# kg/m³. The whole body's and, of limbs, Dempster's (1955) as Winter has them, to a few per cent.
_TRUNK, _LIMB = 1000.0, 1080.0
_BROAD = 3.0  # most breadth over depth: a hand's fingers are not one plate
_TAPER = (0.25, 1.2)  # bounds of the far end's area, over the near end's
CLOTH: Color = (0.36, 0.53, 0.74, 1.0)  # trunk and legs; head, arms and feet are bare
SKIN: Color = (0.90, 0.69, 0.46, 1.0)
_INSTEP = 0.55  # from the ankle to the toes, where a foot is broadest
_TOES = 0.35  # of the area there
_THIN = 0.4  # least area there, over the ankle's


def ellipse(half_axes: Array, height: float) -> Array:
    """A cross-section (n, 3) so deep and so broad (2,), counterclockwise from above."""
    angle = 2 * np.pi * (np.arange(_AROUND) + 0.5) / _AROUND  # no point on an axis
    flat = half_axes * np.stack([np.cos(angle), np.sin(angle)], -1)
    return np.concatenate([flat, np.full((_AROUND, 1), height)], 1)


def stadium(radius: float, thickness: float, height: float, along: int) -> Array:
    """Yeadon's cross-section (n, 3): a rectangle that reaches `thickness` to each side along axis
    0 or 1, with half circles of a radius on its ends."""
    ring = ellipse(np.full(2, radius), height)
    ring[:, along] += np.sign(ring[:, along]) * thickness
    return ring


def solid(sections: Sequence[Array], color: Color, below: float = 0.0, above: float = 0.0) -> Mesh:
    """A solid through cross-sections, the lowest first, with its ends rounded so far (m)."""
    angles = np.linspace(0, np.pi / 2, _CAP + 1)[1:-1]
    rings = list(sections)
    if below:
        rings = [_shrunk(rings[0], a, -below) for a in angles[::-1]] + rings
    if above:
        rings += [_shrunk(rings[-1], a, above) for a in angles]
    return replace(loft(rings), color=color)


def _shrunk(ring: Array, angle: float, height: float) -> Array:
    middle = ring.mean(0)
    return middle + np.cos(angle) * (ring - middle) + [0.0, 0.0, np.sin(angle) * height]


# --------------------------------------------------- from a table of masses and radii of gyration


def tapered(
    segment: Segment, mass: float, length: float, top: float = 0.0, color: Color = SKIN
) -> Mesh:
    """A limb's segment so heavy (kg) and long (m), hanging from a height.

    Its cross-sections have areas that change evenly from end to end, so that it has the volume of
    its mass and its centre of mass where the table has it; and the table's ratio of breadth to
    depth.
    """
    near, far = _ends(segment, mass, length)
    sections = [ellipse(far, top - length), ellipse(near, top)]
    return solid(sections, color, *(BALL * end.min() for end in (far, near)))


def foot(segment: Segment, mass: float, length: float, ankle: Array, tip: float) -> Mesh:
    """A pointed foot so heavy and so long from heel to toes, which goes on from the shank's lower
    end `ankle` (2,) at the height 0 to its tip below: what is behind the ankle goes into its
    breadth."""
    middle = _INSTEP * tip
    # The mean area along the foot, were it to change evenly between the three cross-sections.
    mean, start = mass / (_LIMB * -tip), np.pi * ankle.prod()
    area = (mean - _INSTEP / 2 * start) / (_INSTEP / 2 + (1 - _INSTEP) / 2 * (1 + _TOES))
    broad = _half_axes(segment, max(area, _THIN * start), length)
    toes = np.sqrt(_TOES) * broad
    sections = [ellipse(toes, tip), ellipse(broad, middle), ellipse(ankle, 0.0)]
    return solid(sections, SKIN, BALL * toes.min())


def far_end(segment: Segment, mass: float, length: float) -> Array:
    """Half depth and half breadth (2,), m, of a limb's segment where it ends."""
    return _ends(segment, mass, length)[1]


def _ends(segment: Segment, mass: float, length: float) -> tuple[Array, Array]:
    """Half depth and half breadth (2,), m, at the near and the far end."""
    area = mass / (_LIMB * length)
    c = segment.com / 100  # = (A₀ + 2 A₁) / 3 (A₀ + A₁)
    ratio = float(np.clip((3 * c - 1) / (2 - 3 * c), *_TAPER))
    half = _half_axes(segment, area, length)
    near, far = np.sqrt(2 / (1 + ratio)), np.sqrt(2 * ratio / (1 + ratio))
    return near * half, far * half


def trunk_half_axes(segment: Segment, mass: float, length: float) -> Array:
    """Half depth and half breadth (2,), m, of a part of the trunk, taken as elliptic cylinder."""
    return _half_axes(segment, mass / (_TRUNK * length), length)


def head(segment: Segment, length: float, vertex: float) -> Ellipsoid:
    """An ellipsoid about the head's centre of mass that reaches up to the vertex, at that height,
    and is as deep and broad as the one that has its radii of gyration."""
    squares = (np.array(segment.gyration) / 100 * length) ** 2
    front, left, _ = np.sqrt(2.5 * (squares.sum() - 2 * squares)).tolist()
    up = segment.com / 100 * length
    return Ellipsoid(semi_axes=(front, left, up), position=(0.0, 0.0, vertex - up), color=SKIN)


def _half_axes(segment: Segment, area: float, length: float) -> Array:
    """Half depth a and half breadth b of an elliptic cylinder of an area π a b, whose radii of
    gyration about the front and left axes differ as the table's: k₁² − k₂² = (b² − a²)/4."""
    one, two, _ = (np.array(segment.gyration) / 100 * length) ** 2
    half = 2 * (one - two)
    product = area / np.pi
    breadth = min(np.sqrt(half + np.hypot(half, product)), np.sqrt(_BROAD * product))
    return np.array([product / breadth, breadth])
