"""What a benchmark says of the machine, and how it ends."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any


def load() -> tuple[float, ...] | None:
    """The machine's load averages, where it tells them."""
    return os.getloadavg() if hasattr(os, "getloadavg") else None


def finish(report: dict[str, Any], after: object, out: Path | None) -> None:
    """Add the load `after` to a report, print it, and write all of it as JSON if that is asked."""
    report["load_after"] = after
    print(f"\nload of the machine after: {after}")
    if out is not None:
        out.write_text(json.dumps(report, indent=2) + "\n")
