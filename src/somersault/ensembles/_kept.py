"""Workers that several ensembles share, one after another."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from distributed import Client


class Kept:
    """Connections to workers that are open, by what was asked for; closed with `stack`."""

    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self._clients: dict[Hashable, Client] = {}

    def client(self, asked: Hashable, opened: Callable[[ExitStack], Any]) -> Client:
        """The connection to what is asked for, opened where it is the first time."""
        if asked not in self._clients:
            self._clients[asked] = opened(self._stack)
        return self._clients[asked]


_KEPT: ContextVar[Kept | None] = ContextVar("kept", default=None)


@contextmanager
def workers_kept() -> Iterator[Kept]:
    """Ensembles that are run within have the same workers, which are ended with it.

    To begin and to end processes takes seconds, of which a search with many small ensembles would
    consist.

    Yields
    ------
    Kept

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.ensembles import workers_kept
    >>> runs = so.flight.flights("furrer", so.Takeoff(spin=8.64), 0.1)
    >>> with workers_kept():  # with workers=2, say, in both
    ...     two = [so.ensemble(runs, size=1), so.ensemble(runs, size=1)]
    >>> two[0].dataset.equals(two[1].dataset)
    True
    """
    outer = _KEPT.get()
    if outer is not None:
        yield outer
        return
    with ExitStack() as stack:
        kept = Kept(stack)
        token = _KEPT.set(kept)
        try:
            yield kept
        finally:
            _KEPT.reset(token)
