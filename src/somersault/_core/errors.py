"""The one exception that a user's mistake raises."""


class SomersaultError(ValueError):
    """A mistake in what was asked: one sentence that says what is wrong, where, and what to do.

    The command line prints it and exits with 2; in Python it is raised as it is.
    """


class SomersaultWarning(UserWarning):
    """Something in a file or a call was left out because it cannot matter in flight."""
