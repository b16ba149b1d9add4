"""Bodies in the air: what they are made of, and where they are read from."""

from somersault.model._load import load, shipped
from somersault.model._types import GROUND, Body, Joint, Model

__all__ = ["GROUND", "Body", "Joint", "Model", "load", "shipped"]
