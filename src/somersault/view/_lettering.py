"""Words on pictures of bytes."""

from __future__ import annotations

from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault.view.style import LIGHT, rgb

_MOST_LETTERS = 160
INK, FAINT = LIGHT["ink"], LIGHT["faint"]


def write_on(
    picture: Array, at: tuple[float, float], words: str, size: float, color: str = INK
) -> None:
    """Put a line of words on a picture (height, width, 4), its upper left corner at a pixel; what
    does not fit is cut off."""
    words = "".join(c for c in words[:_MOST_LETTERS] if c.isprintable()) or " "
    mask = _mask(words, max(8, round(size)))
    x, y = (max(0, round(value)) for value in at)
    room = picture[y : y + mask.shape[0], x : x + mask.shape[1], :3]
    share = mask[: room.shape[0], : room.shape[1], None]
    room[:] = (room + share * (np.array(rgb(color)) * 255 - room) + 0.5).astype(np.uint8)


@lru_cache(256)
def lines_of(words: str, size: float, width: float, most: int) -> tuple[str, ...]:
    """Words broken into lines of at most so many pixels, the last cut short with "…" where there
    are more than `most`."""
    lines = [""]
    for word in words[: _MOST_LETTERS * most].split():
        longer = f"{lines[-1]} {word}".strip()
        if not lines[-1] or _width(longer, size) <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    kept = lines[:most]
    if len(lines) > most:
        kept[-1] += "…"
    return tuple(_shortened(line, size, width) for line in kept)


def tidy(value: float, places: int = 2) -> str:
    """A number of so many places, with a real minus, and none before a zero."""
    return f"{round(value, places) + 0.0:.{places}f}".replace("-", "−")


def _shortened(words: str, size: float, width: float) -> str:
    while len(words) > 1 and _width(words, size) > width:
        words = f"{words.rstrip('…')[:-1].rstrip()}…"
    return words


def _width(words: str, size: float) -> float:
    """Of a line, in pixels."""
    return float(_font(max(8, round(size))).getlength(words))


def _mask(words: str, size: int) -> Array:
    from PIL import Image, ImageDraw

    font = _font(size)
    _, _, right, bottom = font.getbbox(words)
    image = Image.new("L", (max(1, int(right) + 1), max(1, int(bottom) + 2)))
    ImageDraw.Draw(image).text((0, 0), words, fill=255, font=font)
    return np.asarray(image, np.float32) / 255


@cache
def _font(size: int) -> Any:
    import matplotlib
    from PIL import ImageFont

    file = Path(matplotlib.get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")
    return ImageFont.truetype(str(file), size)
