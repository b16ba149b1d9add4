"""A search in several processes at once.

IPOPT's linear solver runs once at a time in a process, so threads would wait for one another. The
processes are programs of ours, and not forks: they need no guard in the user's own script.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress
from queue import SimpleQueue
from typing import Any

from somersault._core.errors import SomersaultError
from somersault._core.interrupts import children_unaware
from somersault._core.stages import Stage
from somersault.planning._ipopt import Outcome
from somersault.planning._search import Job, Search
from somersault.planning._worker import PROGRAM


class Processes:
    """Searches side by side, each in a process of its own; one alone is in this one."""

    def __init__(self, here: Search, children: Sequence[subprocess.Popen[bytes]]) -> None:
        self._here = None if children else here
        self._free: SimpleQueue[subprocess.Popen[bytes]] = SimpleQueue()
        for child in children:
            self._free.put(child)
        self._threads = ThreadPoolExecutor(max(len(children), 1))

    def close(self) -> None:
        """Ask for nothing more."""
        self._threads.shutdown(cancel_futures=True)

    def solve(self, jobs: Sequence[Job], stage: Stage) -> list[Outcome]:
        """What becomes of each job."""
        if self._here is not None:
            answers: Any = map(self._here.solve, jobs)
        else:
            answers = self._threads.map(self._asked, jobs)
        outcomes = []
        for outcome in answers:
            outcomes.append(outcome)
            stage.advance()
        return outcomes

    def _asked(self, job: Job) -> Outcome:
        child = self._free.get()
        try:
            _send(child, job)
            assert child.stdout is not None
            outcome: Outcome = pickle.load(child.stdout)
            return outcome
        except (OSError, EOFError, pickle.UnpicklingError):
            raise SomersaultError(
                "a process that searches for the plan ended before it had answered, perhaps for "
                "want of memory; give processes=1, or fewer nodes"
            ) from None
        finally:
            self._free.put(child)


@contextmanager
def searching(here: Search, count: int) -> Iterator[Processes]:
    """So many processes that search as `here` does, which end with this.

    Parameters
    ----------
    here : Search
        In this process; with a count of one, what searches.
    count : int
    """
    children: list[subprocess.Popen[bytes]] = []
    with ExitStack() as ending:
        if count > 1:
            with children_unaware():
                for _ in range(count):
                    children.append(_child())
                    ending.callback(_end, children[-1])
            for child in children:
                _send(child, here.task)
        search = Processes(here, children)
        ending.callback(search.close)
        for child in children:
            ending.callback(child.kill)  # first, so that nobody waits for an answer
        yield search


def _child() -> subprocess.Popen[bytes]:
    alike = {"PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.Popen(
        [sys.executable, "-P", PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL, env=os.environ | alike,
    )  # fmt: skip


def _end(child: subprocess.Popen[bytes]) -> None:
    child.kill()
    child.wait()
    for pipe in (child.stdin, child.stdout):
        with suppress(OSError):  # what was still to be sent
            if pipe is not None:
                pipe.close()


def _send(child: subprocess.Popen[bytes], what: Any) -> None:
    assert child.stdin is not None
    pickle.dump(what, child.stdin)
    child.stdin.flush()
