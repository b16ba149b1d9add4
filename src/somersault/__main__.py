"""The program: `somersault` at the shell, and `python -m somersault`."""

import sys

from somersault._core.interrupts import heed


def program() -> None:
    """Run one command; an interrupt ends it, from the first moment on."""
    heed(last_words="somersault: stopped\n")
    from somersault.cli import main

    sys.exit(main())


if __name__ == "__main__":
    program()
