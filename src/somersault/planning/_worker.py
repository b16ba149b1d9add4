"""A process that searches beside others: it reads a task, then jobs, and answers each."""

from __future__ import annotations

import os
import pickle
import sys
from pathlib import Path


def main() -> None:
    """Answer jobs until there are no more."""
    from somersault.engine import use_threads
    from somersault.planning._search import Search

    jobs, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is no answer
    search = Search(pickle.load(jobs))
    while True:
        try:
            job = pickle.load(jobs)
        except EOFError:
            return
        with use_threads(1):  # as many processes as there are cores do the same
            outcome = search.solve(job)
        pickle.dump(outcome, answers)
        answers.flush()


PROGRAM = str(Path(__file__))

if __name__ == "__main__":
    main()
