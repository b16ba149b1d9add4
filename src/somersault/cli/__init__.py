"""The command line: thin commands over the package.

Every command prints for people, or with --json for programs; a mistake gets one sentence on
standard error and exit code 2.
"""

from __future__ import annotations

import argparse
import codecs
import os
import re
import sys
import warnings
from importlib import import_module

from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault._core.stages import told, wipe

TYPE_CHECKING = False  # typing's, which takes time to import
if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from typing import Any, NoReturn, TextIO

# Each command and what it is about; the rest stands in a module of its name, which is imported when
# the command is given.
_COMMANDS = {
    "models": "The models that ship, what was understood of a file, athletes, any model as MJCF.",
    "stability": "Is a steady spin of a model stable, how fast does it go wrong, and why.",
    "map": "The momentum sphere of a rigid model: its energies, separatrix and kinds of motion.",
    "fly": "One free flight, from a takeoff described in a TOML file.",
    "plan": "A maneuver that is found: with the most twist, or with the least effort.",
    "run": "A robot that runs on two legs, and somersaults on the way.",
    "ensemble": "Many flights that differ in what a TOML file varies; goes on if stopped.",
    "design": "The numbers of a body or a motion that are most reliable over a scatter of starts.",
    "equations": "The equations of motion of a small model as LaTeX, of any model as C.",
    "reproduce": "Regenerate the figures and tables of the thesis, and check its every number.",
}


class _Parser(argparse.ArgumentParser):
    """argparse, but a mistake is one sentence without the usage in front."""

    def error(self, message: str) -> NoReturn:
        needed = re.match(r"the following arguments are required: ([A-Z].*)", message)
        if needed:
            in_front = "; write it in front of the options" if " " in self.prog else ""
            message = f"{needed[1]} is missing{in_front}"
        _say(f"{self.prog}: {message}; see {self.prog} --help")
        raise SystemExit(2)


class _CommandParser(_Parser):
    """The parser of one command, filled in when the command is given."""

    def __init__(self, *given: Any, **named: Any) -> None:
        super().__init__(*given, **{"formatter_class": _Help} | named)
        self._filled = False

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the words behind the command."""
        if not self._filled:
            self._filled = True
            command = import_module(f"somersault.cli._{self.prog.split()[-1]}")
            self.epilog = command.EXAMPLES
            command.add_arguments(self)
            self.set_defaults(run=command.run)
        return super().parse_known_args(args, namespace)


class _Help(argparse.RawDescriptionHelpFormatter):
    """Help whose usage line has what must be given in front of the options: one that takes several
    values would swallow what stands behind it."""

    def add_usage(
        self,
        usage: str | None,
        actions: Iterable[argparse.Action],
        groups: Iterable[argparse._MutuallyExclusiveGroup],
        prefix: str | None = None,
    ) -> None:
        """The usage line of a command."""
        names = [
            self._format_args(action, self._get_default_metavar_for_positional(action))
            for action in actions
            if not action.option_strings
        ]
        super().add_usage(" ".join(["%(prog)s", *names, "[options]"]), actions, groups, prefix)


def _parser() -> argparse.ArgumentParser:
    from somersault import __version__

    parser = _Parser(
        prog="somersault",
        description="Bodies in the air: which spins are stable, and which springs make them so.",
        epilog="Example: somersault stability furrer --pose shoulder=1.4 --stiffness shoulder=1.2",
    )
    parser.add_argument("--version", action="version", version=f"somersault {__version__}")
    commands = parser.add_subparsers(
        title="commands", metavar="COMMAND", required=True, parser_class=_CommandParser
    )
    for name, about in _COMMANDS.items():
        commands.add_parser(name, help=about, description=about)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    codecs.register_error(_NAMES, _bytes_of_name)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a Windows console would not know Ω
            stream.reconfigure(encoding="utf-8", errors=_NAMES)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("default", SomersaultWarning)
            warnings.showwarning = _notes()
            chosen = _parser().parse_args(arguments)
            with told():
                chosen.run(chosen)
            if sys.stdout is not None:
                sys.stdout.flush()  # what cannot be written is found out here
    except SomersaultError as mistake:
        _say(f"somersault: {mistake}")
        return 2
    except BrokenPipeError:
        sys.stderr.close()  # the reader has gone; say nothing more to it
        return 0
    except OSError as trouble:
        where = f" {trouble.filename}" if trouble.filename else ""
        _say(f"somersault: cannot write{where}: {trouble.strerror}")
        _drop_output()
        return 2
    except KeyboardInterrupt:  # where nobody heeds interrupts: main was called in Python
        _say("somersault: stopped")
        return 130
    return 0


def _say(sentence: str) -> None:
    """One line on standard error; of very long words that somebody gave, the beginning."""
    print(re.sub(r"(\S{100})\S{100,}", r"\1…", sentence), file=sys.stderr)


def _drop_output() -> None:
    """Where standard output is what cannot be written, do not try again at the end."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


_NAMES = "somersault.names"


def _bytes_of_name(error: UnicodeError) -> tuple[str | bytes, int]:
    """A file's name that is no text comes out as the bytes that it is."""
    try:
        return codecs.lookup_error("surrogateescape")(error)
    except UnicodeError:
        return codecs.lookup_error("backslashreplace")(error)


def _notes() -> Callable[..., None]:
    """What prints warnings of ours, each sentence once, whoever forgot that it was given."""
    given: set[str] = set()

    def show(
        message: Warning | str,
        category: type[Warning],
        filename: str,
        lineno: int,
        file: TextIO | None = None,
        line: str | None = None,
    ) -> None:
        if issubclass(category, SomersaultWarning) and str(message) not in given:
            given.add(str(message))
            wipe()
            print(f"note: {message}", file=sys.stderr)

    return show
