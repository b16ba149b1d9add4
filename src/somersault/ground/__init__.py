"""Landings: a planar gymnast on the ground of MuJoCo, and the law by which it stands."""

from somersault.ground._gymnast import Feet, Floor, Gymnast, Strength
from somersault.ground._land import STANDS, TICK, land
from somersault.ground._law import LandingLaw
from somersault.ground._stance import Stance

__all__ = ["STANDS", "TICK", "Feet", "Floor", "Gymnast", "LandingLaw", "Stance", "Strength", "land"]
