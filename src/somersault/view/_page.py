"""A page that plays motions in a browser, without a network."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.checks import name_list, text
from somersault._core.errors import SomersaultError
from somersault._core.files import write
from somersault._core.places import check_file
from somersault.view import style as look
from somersault.view._look import several
from somersault.view._page_flight import flight_record
from somersault.view._page_model import model_record

if TYPE_CHECKING:
    from somersault.history import History
    from somersault.model import Model

ENDINGS = (".html", ".htm")
_MOST_FLIGHTS = 12
_MOST_NUMBERS = 110_000  # of all flights together: a page is to stay below 1.5 MB
_MOST_SAMPLES, _FEWEST_SAMPLES = 1000, 60
_MOST_SHAPE_BYTES = 480_000  # of all models together
_PALETTE = {
    "light": {**look.LIGHT, "lines": look.LINES},
    "dark": {**look.DARK, "lines": look.DARK_LINES},
}


def page(
    histories: History | Sequence[History],
    path: str | os.PathLike[str],
    labels: Sequence[str] | None = None,
    title: str | None = None,
) -> None:
    """Write a page that plays one history, or several to choose from.

    It is one file that any browser opens, from a disk and without a network: the body, which one
    turns and scrubs through, time histories, and the momentum sphere of what flies freely.

    Parameters
    ----------
    histories : History or sequence of History
        Flights, swings, recordings.
    path : path-like
        A .html file, written whole or not at all.
    labels : sequence of str, optional
        What each is called; without them the names of their models, numbered where there are
        several.
    title : str, optional
        The heading: the name of the model, if it is not given.

    Raises
    ------
    SomersaultError
        For what is no history, for more than twelve, and a file of another kind or a place where
        it cannot be written.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.view import page
    >>> flights = [so.fly("book", so.Takeoff(spin=6.0, tilt=x), 2.0) for x in (0.01, 0.1)]
    >>> page(flights, "book.html", labels=["a little tilt", "more"])  # doctest: +SKIP
    """
    file = check_page(path)
    row = several("histories", histories, 1, _MOST_FLIGHTS)
    names = _labels(row, labels)
    if title is not None:
        text("title", title)
    heading = title or row[0].model.name
    write(file, _document(heading, page_record(row, names, heading)))


def check_page(path: str | os.PathLike[str]) -> Path:
    """The place of a page, if one can be written there.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    pathlib.Path

    Raises
    ------
    SomersaultError
        For another ending than .html and .htm, and for a place where no page can be written.

    Examples
    --------
    >>> from somersault.view import check_page
    >>> check_page("layout.html").name
    'layout.html'
    """
    return check_file(path, ENDINGS)


def page_record(histories: Sequence[History], labels: Sequence[str], title: str) -> dict[str, Any]:
    """Everything that the script of a page is told."""
    models: list[Model] = []
    places = []
    for history in histories:
        known = [k for k, model in enumerate(models) if model is history.model]
        places.append(known[0] if known else len(models))
        if not known:
            models.append(history.model)
    numbers = sum(7 * len(h.model.bodies) + len(h.model.coordinates) + 16 for h in histories)
    samples = int(np.clip(_MOST_NUMBERS / numbers, _FEWEST_SAMPLES, _MOST_SAMPLES))
    return {
        "title": title,
        "palette": _PALETTE,
        "models": [model_record(model, _MOST_SHAPE_BYTES // len(models)) for model in models],
        "flights": [
            flight_record(history, label, place, samples)
            for history, label, place in zip(histories, labels, places, strict=True)
        ],
    }


def _document(title: str, record: dict[str, Any]) -> str:
    # No text of ours or of a model's ends the element that it stands in.
    data = json.dumps(record, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    notices = _asset("NOTICES.txt").replace("--", "- -")
    # In the strings of a script a backslash before these changes nothing.
    script = _asset("page.js").replace("</script", "<\\/script").replace("<!--", "<\\!--")
    return "\n".join(
        [
            "<!doctype html>",
            '<html lang="en">',
            '<meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            '<link rel="icon" href="data:,">',
            f"<title>{html.escape(title)}</title>",
            f"<style>{look.variables()}</style>",
            f"<!--\n{notices}-->",
            '<body><div id="page"></div>',
            f'<script id="data" type="application/json">{data}</script>',
            f"<script>{script}</script>",
            "",
        ]
    )


@cache
def _asset(name: str) -> str:
    return (files("somersault.view") / "web" / name).read_text(encoding="utf-8")


def _labels(histories: Sequence[History], labels: Sequence[str] | None) -> list[str]:
    if labels is None:
        names = [history.model.name for history in histories]
        return names if len(names) == 1 else [f"{k}. {name}" for k, name in enumerate(names, 1)]
    given = [labels] if isinstance(labels, str) else list(name_list("labels", labels))
    if len(given) != len(histories):
        raise SomersaultError(
            f"there are {len(histories)} histories and {len(given)} labels; give one for each"
        )
    return given
