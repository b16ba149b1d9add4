"""How the runs of a dataset ended, as its own attributes say."""

from __future__ import annotations

from typing import TYPE_CHECKING

from somersault._core.checks import one_of
from somersault._core.errors import SomersaultError
from somersault.simulation import NOT_RUN

if TYPE_CHECKING:
    import xarray as xr


def ending_words(ended: xr.DataArray) -> tuple[str, ...]:
    """All endings there can be; a code of `ended` is a place among them."""
    return _listed(ended, "flag_meanings")


def failure_codes(ended: xr.DataArray) -> list[int]:
    """The codes of runs that failed."""
    words = ending_words(ended)
    return [words.index(word) for word in _listed(ended, "failures")]


def success_codes(ended: xr.DataArray) -> list[int]:
    """The codes of attempts that came off; none where runs are no attempts."""
    if "successes" not in ended.attrs:
        return []
    words = ending_words(ended)
    return [words.index(word) for word in _listed(ended, "successes")]


def _listed(ended: xr.DataArray, attribute: str) -> tuple[str, ...]:
    text = getattr(ended, "attrs", {}).get(attribute)
    if not isinstance(text, str):
        raise SomersaultError(
            f"ended has lost its attribute {attribute}, which says what its codes mean; take "
            'dataset["ended"] of an ensemble as it is'
        )
    return tuple(word.replace("_", " ") for word in text.split())


def failed(ended: xr.DataArray) -> xr.DataArray:
    """Whether runs failed: ended in a way that leaves no result.

    Parameters
    ----------
    ended : xarray.DataArray
        `dataset["ended"]` of an ensemble, or a part of it. Runs still to come have not failed.

    Returns
    -------
    xarray.DataArray of bool

    Examples
    --------
    >>> import somersault as so
    >>> vary = {"leant": so.Vary(sets="takeoff.tilt", values=[0.0, 0.1])}
    >>> found = so.ensemble("furrer", so.Takeoff(spin=8.64), 1.0, vary)
    >>> so.ensembles.failed(found.dataset["ended"]).values
    array([False, False])
    """
    codes = failure_codes(ended)
    return ended.isin(codes)


def ended_by(ended: xr.DataArray, ending: str) -> xr.DataArray:
    """Whether runs ended in one way: of flights "duration", "event", "too many steps" …

    Parameters
    ----------
    ended : xarray.DataArray
        `dataset["ended"]` of an ensemble, or a part of it.
    ending : str
        One of the words in its attribute `flag_meanings`, with spaces.

    Returns
    -------
    xarray.DataArray of bool

    Raises
    ------
    SomersaultError
        For a word that is none of them.

    Examples
    --------
    >>> import somersault as so
    >>> found = so.ensemble("furrer", so.Takeoff(spin=8.64), 1.0)
    >>> bool(so.ensembles.ended_by(found.dataset["ended"], "duration").all())
    True
    """
    words = ending_words(ended)
    return ended == words.index(one_of("ended", ending, words))


def run_already(ended: xr.DataArray) -> xr.DataArray:
    """Whether runs are not still to come."""
    return ended != NOT_RUN
