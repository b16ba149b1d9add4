"""What a worker process of this machine does first."""

from __future__ import annotations

import signal
from typing import Any

from somersault._core.interrupts import heed


def dask_setup(worker: Any) -> None:
    """Called by dask: when the program ends its worker, that finishes the file it is writing."""
    heed([signal.SIGTERM])
