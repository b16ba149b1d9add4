"""Compiled functions over many samples, and integrations of many states: it knows no bodies."""

from somersault.engine._integrator import MOST_STEPS, STATUS, Integrator, Pieces, Solution
from somersault.engine._kernel import (
    LANES,
    Kernel,
    compiled,
    cores,
    pool,
    processor,
    threads,
    use_threads,
)

__all__ = [
    "LANES",
    "MOST_STEPS",
    "STATUS",
    "Integrator",
    "Kernel",
    "Pieces",
    "Solution",
    "compiled",
    "cores",
    "pool",
    "processor",
    "threads",
    "use_threads",
]
