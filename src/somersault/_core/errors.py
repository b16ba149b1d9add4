"""The one exception that a user's mistake raises, and the one warning."""

_MOST = 800  # characters of a sentence, however long the name or the value is that it quotes


class SomersaultError(ValueError):
    """A mistake in what was asked: one sentence that says what is wrong, where, and what to do.

    The command line prints it and exits with 2; in Python it is raised as it is. It is one line
    that any stream can take, whatever stands in the names that it quotes.
    """

    def __init__(self, said: str) -> None:
        super().__init__(one_line(said))


class SomersaultWarning(UserWarning):
    """Something that was accepted and is strange, or was left out as it cannot matter in flight.

    It points at the line that called the package; the command line prints it as a note.
    """

    def __init__(self, said: str) -> None:
        super().__init__(one_line(said))


def one_line(text: str) -> str:
    """A text without line ends, control characters and what is not Unicode, cut in its middle if it
    is very long."""
    if len(text) > _MOST:
        text = f"{text[: _MOST * 3 // 4]} … {text[-_MOST // 4 :]}"
    if text.isprintable():
        return text
    plain = " ".join(text.split())
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in plain)
