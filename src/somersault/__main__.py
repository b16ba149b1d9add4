"""The program: `somersault` at the shell, and `python -m somersault`."""

import sys


def program() -> None:
    """Run one command; an interrupt ends it, from the first moment on."""
    _hold_interrupts()
    from somersault._core.interrupts import heed

    heed(last_words="somersault: stopped\n")
    from somersault.cli import main

    sys.exit(main())


def _hold_interrupts() -> None:
    """One that comes before anybody heeds them waits until then; Windows has no such thing."""
    import _signal  # type: ignore[import-not-found]  # the part of it that costs nothing

    if hasattr(_signal, "pthread_sigmask"):
        _signal.pthread_sigmask(_signal.SIG_BLOCK, [_signal.SIGINT])


if __name__ == "__main__":
    program()
