"""Segments of the mean young man and woman: de Leva's table.

de Leva P (1996) Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters. J Biomech
29(9):1223-1230, Table 4: 100 men of 1.741 m and 73.0 kg, 15 women of 1.735 m and 61.9 kg.
The three parts of the men's trunk have their common centre of mass 3 mm below that of the
whole trunk's row; so it is printed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from somersault._core.array import Array


@dataclass(frozen=True)
class Segment:
    """One row: percentages of body mass and of the segment's own length (m).

    `com` is measured from the first-named end point; the radii of gyration are about the
    sagittal (front), transverse (left) and longitudinal axes.
    """

    mass: float
    length: float
    com: float
    gyration: tuple[float, float, float]

    def inertia(self, mass: float, length: float) -> Array:
        """Principal inertias (3,) about the centre of mass, kg m², of a segment so heavy (kg)
        and long (m)."""
        radii: Array = np.array(self.gyration) / 100 * length
        return mass * radii**2


@dataclass(frozen=True)
class Table:
    """The segments of one sex, and the height (m) of the person whose lengths they have."""

    height: float
    mass: float
    shoulder_height: float  # mid-hip to mid-shoulder, m
    segments: Mapping[str, Segment]


# End points in the order in which `com` is measured. The trunk is there whole and in parts.
MALE = Table(
    1.741,
    73.0,
    0.5155,
    MappingProxyType(
        {
            "head": Segment(6.94, 0.2429, 50.02, (30.3, 31.5, 26.1)),  # vertex, cervicale
            "trunk": Segment(43.46, 0.6033, 51.38, (32.8, 30.6, 16.9)),  # cervicale, mid-hip
            "upper_trunk": Segment(15.96, 0.2421, 50.66, (50.5, 32.0, 46.5)),  # to xiphion
            "middle_trunk": Segment(16.33, 0.2155, 45.02, (48.2, 38.3, 46.8)),  # to omphalion
            "lower_trunk": Segment(11.17, 0.1457, 61.15, (61.5, 55.1, 58.7)),  # to mid-hip
            "upper_arm": Segment(2.71, 0.2817, 57.72, (28.5, 26.9, 15.8)),  # shoulder, elbow
            "forearm": Segment(1.62, 0.2689, 45.74, (27.6, 26.5, 12.1)),  # elbow, wrist
            "hand": Segment(0.61, 0.1879, 36.24, (28.8, 23.5, 18.4)),  # wrist, third finger tip
            "thigh": Segment(14.16, 0.4222, 40.95, (32.9, 32.9, 14.9)),  # hip, knee
            "shank": Segment(4.33, 0.4403, 43.95, (25.1, 24.6, 10.2)),  # knee, ankle
            "foot": Segment(1.37, 0.2581, 44.15, (25.7, 24.5, 12.4)),  # heel, toe tip
        }
    ),
)
FEMALE = Table(
    1.735,
    61.9,
    0.4979,
    MappingProxyType(
        {
            "head": Segment(6.68, 0.2437, 48.41, (27.1, 29.5, 26.1)),
            "trunk": Segment(42.57, 0.6148, 49.64, (30.7, 29.2, 14.7)),
            "upper_trunk": Segment(15.45, 0.2280, 50.50, (46.6, 31.4, 44.9)),
            "middle_trunk": Segment(14.65, 0.2053, 45.12, (43.3, 35.4, 41.5)),
            "lower_trunk": Segment(12.47, 0.1815, 49.20, (43.3, 40.2, 44.4)),
            "upper_arm": Segment(2.55, 0.2751, 57.54, (27.8, 26.0, 14.8)),
            "forearm": Segment(1.38, 0.2643, 45.59, (26.1, 25.7, 9.4)),
            "hand": Segment(0.56, 0.1701, 34.27, (24.4, 20.8, 15.4)),
            "thigh": Segment(14.78, 0.3685, 36.12, (36.9, 36.4, 16.2)),
            "shank": Segment(4.81, 0.4386, 43.52, (26.7, 26.3, 9.2)),
            "foot": Segment(1.29, 0.2283, 40.14, (29.9, 27.9, 13.9)),
        }
    ),
)
TABLES = MappingProxyType({"male": MALE, "female": FEMALE})

# The table has no breadths between joint centres, and no place of the ankle along the foot: m,
# of a person of 1.741 m.
SHOULDER_HALF_WIDTH = 0.18  # Carl Furrer: Playter (1994), Table 4.1
HIP_HALF_WIDTH = 0.085  # Braune and Fischer (1895): 0.17 m between the hip centres
HEEL_BEHIND_ANKLE = 0.06  # assumed; 0.02 m more or less changes no inertia by 1.1 %
