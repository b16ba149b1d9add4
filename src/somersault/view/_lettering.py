"""Words on pictures of bytes."""

from __future__ import annotations

from functools import cache
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
