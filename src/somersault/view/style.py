"""One look for every picture: colours that colour-blind readers tell apart, labels on the spot."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Okabe and Ito's palette.
BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
YELLOW, BLUE, VERMILION, PURPLE = "#F0E442", "#0072B2", "#D55E00", "#CC79A7"
GREY, PALE = "#6b6b6b", "#dfe9f3"
LIGHT_TO_DARK = ("#b9d3ee", "#5e9bd1", "#1f5fa0", "#0a2342")  # one hue, by darkness

_DOTS = 160  # an inch, of a picture in a file
_SETTINGS: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 10.0,
    "axes.titlesize": 10.5,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "lines.linewidth": 1.8,
    "figure.dpi": 100.0,
    "hatch.color": GREY,
    "hatch.linewidth": 0.6,
    "svg.hashsalt": "somersault",
    "svg.fonttype": "path",
    "path.simplify_threshold": 0.3,
}


@contextmanager
def style() -> Iterator[None]:
    """Draw, and save, within this: fonts, lines, and SVG files that repeat byte for byte."""
    import matplotlib

    with matplotlib.rc_context(_SETTINGS):
        yield


def figure(width: float = 7.2, height: float = 4.6) -> Figure:
    """An empty picture, in inches, that lays itself out. No pyplot, so no window is needed."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained", facecolor="white")


def saved(made: Figure, ending: str) -> bytes:
    """A picture as the bytes of a file, the same whenever it is made.

    Parameters
    ----------
    made : matplotlib.figure.Figure
    ending : {"png", "svg"}

    Returns
    -------
    bytes
    """
    held = io.BytesIO()
    plain = {"Date": None, "Creator": None} if ending == "svg" else {"Software": None}
    made.savefig(held, format=ending, dpi=_DOTS, metadata=plain)
    return held.getvalue()


def label(ax: Axes, x: float, y: float, text: str, color: str = BLACK, **options: Any) -> Any:
    """Words beside what they name, with a white edge so that lines do not cross them out."""
    from matplotlib.patheffects import withStroke

    options = {"fontsize": 9, "ha": "left", "va": "center", "zorder": 10, **options}
    words = ax.text(x, y, text, color=color, **options)
    words.set_in_layout(False)
    words.set_path_effects([withStroke(linewidth=3, foreground="white")])
    return words


def pointer(
    ax: Axes,
    at: tuple[float, float],
    words: tuple[float, float],
    text: str,
    color: str = BLACK,
    **options: Any,
) -> None:
    """A label with a thin line to the point it names."""
    from matplotlib.patheffects import withStroke

    made = ax.annotate(
        text,
        at,
        words,
        color=color,
        zorder=10,
        arrowprops={"arrowstyle": "-", "color": color, "lw": 0.8, "shrinkB": 2},
        **{"fontsize": 9, "ha": "left", "va": "center", **options},
    )
    made.set_in_layout(False)
    made.set_path_effects([withStroke(linewidth=3, foreground="white")])


def darkening() -> Any:
    """Colour map from light to dark, for a parameter that rises."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("darkening", list(LIGHT_TO_DARK))
