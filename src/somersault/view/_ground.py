"""The backdrop and the ground with its grid, pixel by pixel."""

from __future__ import annotations

from typing import Any

from llvmlite import ir

from somersault.view._lanes import WIDTH, Code, Lanes, begun
from somersault.view.style import LIGHT, rgb

BACKDROP = tuple(255 * part for part in rgb(LIGHT["back"]))
_FLOOR = (252.0, 252.5, 253.0)
_LINE = 46.0  # how much darker a line is
_THIN = 0.012  # of the spacing of the grid: the width of a line

# What `ground` reads: the eye (3), the ray through the middle of the frame (3), what a pixel to
# the right (3) and one up (3) add to it, the middle of the frame in pixels (2), the height of the
# ground, the spacing of the grid, the middle of what is seen of it (2), how far it is seen, and
# whether there is any.
NUMBERS = 20


def ground(module: ir.Module) -> None:
    """Write the function `ground` (width, height, stride, numbers, frame)."""
    code, (width, height, stride, numbers, frame) = begun(module, "ground", 3, 2)
    n = [code.spread(code.fetch(numbers, k)) for k in range(NUMBERS)]
    eye, ray, right, up = n[0:3], n[3:6], n[6:9], n[9:12]
    across, level, spacing, middle, reach, there = n[12:14], n[14], n[15], n[16:18], n[18], n[19]
    drop = eye[2] - level
    with code.each(code.index(0), height) as row:
        v = across[1] - code.spread(code.floats(row) + 0.5)
        with code.each(code.index(0), width, WIDTH) as column:
            u = code.spread(code.floats(column) + 0.5) + code.ramp() - across[0]
            d = [ray[k] + u * right[k] + v * up[k] for k in range(3)]
            down = code.larger(code.like(d[2], 0.0) - d[2], 1e-6)
            t = drop / down
            grid, far = code.like(t, 0.0), code.like(t, 0.0)
            for axis in (0, 1):
                place = eye[axis] + t * d[axis]
                off = (place - middle[axis]) / reach
                far = far + off * off
                steps = [
                    drop * (side[axis] * down + d[axis] * side[2]) / (down * down)
                    for side in (right, up)
                ]
                foot = code.root(steps[0] * steps[0] + steps[1] * steps[1]) / spacing + 1e-7
                grid = code.larger(grid, _lines(code, place / spacing, foot))
            fade = code.like(far, 1.0) / (far * far + 1.0)
            fade = code.where(d[2].test("<", -1e-5), fade * there, code.like(fade, 0.0))
            shown = [
                fade * (floor - back) + back - grid * fade * _LINE
                for floor, back in zip(_FLOOR, BACKDROP, strict=True)
            ]
            red, green, blue = (code.whole(code.within(c, 0.0, 255.0)) for c in shown)
            colour = red | (green << 8) | (blue << 16) | 0xFF << 24
            code.put(colour, frame, row * stride + column)
    code.ret_void()


def _lines(code: Code, place: Lanes, foot: Lanes) -> Lanes:
    """Which share of a pixel, `foot` spacings wide, is covered by lines at whole numbers."""
    away = code.size(place - code.floor(place + 0.5))
    wide = code.larger(foot, _THIN)
    cover = code.within((wide * 0.5 + foot * 0.5 - away) / foot, 0.0, 1.0) * _THIN * 1.0 / wide
    return cover * code.within(code.like(foot, 1.0) - foot * 2.0, 0.0, 1.0)


def numbers_of(*parts: Any) -> list[float]:
    """The numbers of `ground` in a row."""
    return [float(x) for part in parts for x in (part if hasattr(part, "__len__") else (part,))]
