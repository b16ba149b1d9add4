"""How many threads compiled code uses, and the threads."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache

_chosen: ContextVar[int | None] = ContextVar("threads", default=None)


def threads() -> int:
    """How many threads compiled code uses.

    Returns
    -------
    int
        The number that `use_threads` set, or one for each core.
    """
    return _chosen.get() or cores()


@cache
def cores() -> int:
    """Cores that this process may use.

    Returns
    -------
    int
    """
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


@contextmanager
def use_threads(count: int | None) -> Iterator[None]:
    """Within the block, compiled code uses this many threads.

    Parameters
    ----------
    count : int or None
        None: one for each core.

    Yields
    ------
    None

    Examples
    --------
    >>> from somersault.engine import threads, use_threads
    >>> with use_threads(1):
    ...     threads()
    1
    """
    before = _chosen.set(count)
    try:
        yield
    finally:
        _chosen.reset(before)


def pool() -> ThreadPoolExecutor:
    """The threads of compiled code, kept from one call to the next.

    Returns
    -------
    concurrent.futures.ThreadPoolExecutor
        With as many threads as `threads` says.
    """
    return _pool(threads())


@cache
def _pool(count: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(count, thread_name_prefix="somersault")
