"""A joint that swings."""

from __future__ import annotations

from dataclasses import dataclass

from somersault.flight.behaviours._moving import Moving


@dataclass(frozen=True)
class Free(Moving, motion="free"):
    """A joint that swings from its `angle` and `rate`, with a damper and no spring."""
