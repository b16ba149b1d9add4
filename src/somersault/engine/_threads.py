"""How many threads compiled code uses, the threads, and how it is stopped."""

from __future__ import annotations

import ctypes
import os
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from typing import Any

_chosen: ContextVar[int | None] = ContextVar("threads", default=None)


class Stop:
    """Tells compiled code in other threads to give up what it does.

    Attributes
    ----------
    address : int
        Of an integer of eight bytes, which is 0 until it is to stop.
    """

    def __init__(self) -> None:
        self._flag = ctypes.c_int64(0)
        self.address = ctypes.addressof(self._flag)

    @property
    def is_set(self) -> bool:
        """Whether it is to stop."""
        return self._flag.value != 0

    def set(self) -> None:
        """From now on nothing that heeds this goes on."""
        self._flag.value = 1

    @contextmanager
    def heeded(self) -> Iterator[None]:
        """What this thread computes within the block heeds it.

        Yields
        ------
        None
        """
        before = _stop.set(self)
        try:
            yield
        finally:
            _stop.reset(before)


_stop: ContextVar[Stop | None] = ContextVar("stop", default=None)


def heeded_stop() -> Stop:
    """What tells compiled code of this thread to give up."""
    stop = _stop.get()
    return Stop() if stop is None else stop


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


def together(run: Callable[..., Any], rows: Sequence[tuple], stop: Stop | None = None) -> None:
    """Calls of compiled code, one for each row of arguments, side by side on threads.

    An interrupt sets `stop`, and is raised when all calls are over: they work in memory of the
    caller. The main thread runs none itself, for it would not hear of the interrupt.
    """
    if len(rows) == 1 and (stop is None or threading.current_thread() is not _MAIN):
        run(*rows[0])
    else:
        calls: list[Future[Any]] = []
        try:
            calls.extend(pool().submit(run, *row) for row in rows)
            while wait(calls, _OFTEN).not_done:
                pass
        except BaseException:
            if stop is not None:
                stop.set()
            _wait_whatever_comes(calls)
            raise
        for call in calls:
            call.result()
    if stop is not None and stop.is_set:
        raise CancelledError


_MAIN = threading.main_thread()
_OFTEN = 0.1  # s: not every system ends a wait for an interrupt


def _wait_whatever_comes(calls: Sequence[Future[Any]]) -> None:
    while True:
        try:
            wait(calls)
            return
        except KeyboardInterrupt:
            continue


@cache
def _pool(count: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(count, thread_name_prefix="somersault")
