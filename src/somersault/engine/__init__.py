"""Compiled functions over many samples, and integrations of many states: it knows no bodies."""

from somersault.engine._clock import CLOCK, clock_at
from somersault.engine._closed_loop import ClosedLoop, System
from somersault.engine._expression import Direction
from somersault.engine._integrator import MOST_STEPS, STATUS, Integrator, Pieces, Solution
from somersault.engine._kernel import Kernel
from somersault.engine._machine import compiled, compiled_function, processor
from somersault.engine._threads import Stop, cores, pool, threads, use_threads
from somersault.engine._vectors import LANES

__all__ = [
    "CLOCK",
    "LANES",
    "MOST_STEPS",
    "STATUS",
    "ClosedLoop",
    "Direction",
    "Integrator",
    "Kernel",
    "Pieces",
    "Solution",
    "Stop",
    "System",
    "clock_at",
    "compiled",
    "compiled_function",
    "cores",
    "pool",
    "processor",
    "threads",
    "use_threads",
]
