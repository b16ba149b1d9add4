"""The doll's torsional springs (§5.2.1): linear springs on pulleys of three radii.

A linear spring on a pulley is a torsional one with the stiffness times the radius squared, so one
linear spring gives three of them, as 1 : 0.5625 : 0.3906.
"""

from __future__ import annotations

from somersault.thesis.ch5._doll import BEST

RADII = (1 / 2, 3 / 8, 5 / 16)  # inches
SHARES = tuple((radius / RADII[0]) ** 2 for radius in RADII)


def on_pulleys(largest: float) -> tuple[float, ...]:
    """The three K_sh of a linear spring that has this one on the largest pulley."""
    return tuple(largest * share for share in SHARES)


# Ours: two linear springs, the one of 0.82 on its smallest pulley, the other 0.6 on its largest.
# The first one's 1.18, on the middle pulley, is not among the five (`_springs_tried` says why).
STIFF = on_pulleys(BEST / SHARES[2])
SOFT = on_pulleys(0.6)
SPRINGS = tuple(sorted((STIFF[0], STIFF[2], *SOFT)))
OMITTED = STIFF[1]
BEST_AT = SPRINGS.index(STIFF[2])
