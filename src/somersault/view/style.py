"""One look for pictures, films, pages and the report: colours that colour-blind readers tell apart,
in light and dark, and labels on the spot."""

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
NAMES = {
    BLACK: "black", ORANGE: "orange", SKY: "sky blue", GREEN: "green", YELLOW: "yellow",
    BLUE: "blue", VERMILION: "vermilion", PURPLE: "purple", GREY: "grey", PALE: "pale",
}  # fmt: skip
LINES = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)  # one after the other

# By what they are for; of pages and the report in light and in dark, of films in light.
LIGHT = {
    "back": "#f3f5f8", "card": "#ffffff", "ink": "#18212c", "faint": "#5c6773", "edge": "#dde3ea",
    "accent": BLUE, "on-accent": "#ffffff", "good": "#00694d", "bad": "#a63e00",
    "minor": VERMILION, "major": BLUE, "axis": GREEN, "momentum": VERMILION, "spin": GREEN,
    "ball": PALE, "shadow": "#d3d9e0", "path": "#8c99a8",
}  # fmt: skip
DARK = {
    "back": "#0e1218", "card": "#171c24", "ink": "#e8ecf2", "faint": "#9aa5b4", "edge": "#2b333f",
    "accent": SKY, "on-accent": "#0e1218", "good": "#2fc795", "bad": "#ff9a5c",
    "minor": ORANGE, "major": SKY, "axis": "#2fc795", "momentum": ORANGE, "spin": "#2fc795",
    "ball": "#243140", "shadow": "#0d1117", "path": "#77859a",
}  # fmt: skip
DARK_LINES = (SKY, ORANGE, GREEN, PURPLE, YELLOW, VERMILION, DARK["ink"])

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


def rgb(color: str) -> tuple[float, float, float]:
    """Red, green and blue, 0 to 1, of "#rrggbb"."""
    red, green, blue = (int(color[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return red, green, blue


def variables() -> str:
    """CSS that gives every colour as a variable, --ink for one: by what the reader's system likes,
    or as `data-theme` of the root element says."""
    light, dark = (
        "".join(f"--{name}:{color};" for name, color in theme.items()) + f"color-scheme:{scheme}"
        for scheme, theme in (("light", LIGHT), ("dark", DARK))
    )
    return (
        f':root{{{light}}}:root[data-theme="dark"]{{{dark}}}'
        f'@media (prefers-color-scheme:dark){{:root:not([data-theme="light"]){{{dark}}}}}'
    )


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


def literal(words: str) -> str:
    """Words from outside for a picture, in which a dollar sign begins no mathematics."""
    return words.replace("$", r"\$")


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
