"""Triangles to samples, and samples to pixels: the machine code of the renderer.

A picture has 2 × 2 samples for each pixel. A sample has a nearness, 1 over its distance from the
eye (0 where nothing is), and a colour: red, green, blue and cover, a byte each, lowest first.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from typing import Any

from llvmlite import ir

from somersault.engine import compiled, compiled_function
from somersault.view._ground import ground
from somersault.view._lanes import REALS, WIDTH, WORDS, Code, Lanes, begun

_SLACK = -1e-5  # of a triangle: what rounding may take from its edge
_INDEX, _POINTER = ctypes.c_int64, ctypes.c_void_p

# How light falls, as shares of a surface's colour: everywhere, from the sky, from the lamp; and
# the white of its reflection.
_EVERYWHERE, _SKY, _LAMP, _GLOSS = 0.45, 0.24, 0.44, 0.12


@cache
def functions() -> dict[str, Callable[..., None]]:
    """The compiled functions.

    `solid` and `flat` (faces, width, height, stride, corners, places, normals, paints, light,
    near, samples): draw triangles, shaded or as one colour of the paint. `resolve` (left, right,
    top, bottom, sample stride, stride, solid samples, ghost samples, near, opacity, frame): put
    samples on a frame, and forget them.
    `ground` (width, height, stride, numbers, frame): paint the backdrop.
    """
    module = ir.Module()
    module.triple = ""
    _triangles(module, "solid", shaded=True)
    _triangles(module, "flat", shaded=False)
    _resolve(module)
    ground(module)
    engine = compiled(str(module))
    counts = {"solid": (4, 7), "flat": (4, 7), "resolve": (6, 5), "ground": (3, 2)}
    return {
        name: compiled_function(engine, name, *[_INDEX] * indices, *[_POINTER] * pointers)
        for name, (indices, pointers) in counts.items()
    }


def _triangles(module: ir.Module, name: str, shaded: bool) -> None:
    code, arguments = begun(module, name, 4, 7)
    count, width, height, stride, corners, places, normals, paints, light, near, samples = arguments
    with code.each(code.index(0), count) as face:
        three = [code.corner(corners, face * 3 + k) for k in range(3)]
        x, y, z = ([code.fetch(places, corner * 3 + axis) for corner in three] for axis in range(3))
        area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
        closed = code.fetch(paints, face * 4 + 3).test(">", 0.5)
        away = area.test(">=", 0.0)  # y runs down: what faces the eye runs round the other way
        seen = code.and_(area.test("!=", 0.0), code.not_(code.and_(away, closed)))
        for nearness in z:  # behind the eye, or not a number
            seen = code.and_(seen, nearness.test(">", 0.0))
        with code.if_then(seen):
            paint = [code.fetch(paints, face * 4 + k) for k in range(3)]
            turn = code.where(away, code.like(area, -1.0), code.like(area, 1.0))
            corner_normals = [
                [code.fetch(normals, corner * 3 + axis) * turn for corner in three]
                for axis in range(3)
            ]
            _one(
                code, x, y, z, area, (width, height, stride), (near, samples),
                _shade(code, light, corner_normals, paint) if shaded else _plain(code, paint),
                shaded,
            )  # fmt: skip
    code.ret_void()


def _one(
    code: Code,
    x: list[Lanes],
    y: list[Lanes],
    z: list[Lanes],
    area: Lanes,
    size: tuple[Lanes, Lanes, Lanes],
    rooms: tuple[Any, Any],
    colour: Callable[[Lanes, Lanes], Lanes],
    deep: bool,
) -> None:
    """The samples of one triangle: those whose middle is in it."""
    width, height, stride = size
    near, samples = rooms
    left, right = _span(code, x, width)
    top, bottom = _span(code, y, height)
    scale = code.like(area, 1.0) / area
    dx = [code.spread((x[k] - x[0]) * scale) for k in (1, 2)]
    dy = [code.spread((y[k] - y[0]) * scale) for k in (1, 2)]
    depths = [code.spread(z[0]), *(code.spread(z[k] - z[0]) for k in (1, 2))]
    start = code.spread(x[0])
    with code.each(top, bottom) as row:
        down = code.spread(code.floats(row) + 0.5 - y[0])
        with code.each(left, right, WIDTH) as column:
            along = code.spread(code.floats(column) + 0.5) + code.ramp() - start
            one = along * dy[1] - down * dx[1]
            two = down * dx[0] - along * dy[0]
            inside = code.and_(one.test(">=", _SLACK), two.test(">=", _SLACK))
            inside = code.and_(inside, (one + two).test("<=", 1.0 - _SLACK))
            place = row * stride + column
            nearness = depths[0] + one * depths[1] + two * depths[2]
            if deep:
                held = code.fetch(near, place, REALS)
                inside = code.and_(inside, nearness.test(">", held))
            with code.if_then(code.any_of(inside)):
                if deep:
                    code.put(code.where(inside, nearness, held), near, place)
                before = code.fetch(samples, place, WORDS)
                code.put(code.where(inside, colour(one, two), before), samples, place)


def _span(code: Code, ends: list[Lanes], most: Lanes) -> tuple[Lanes, Lanes]:
    """First sample with its middle beyond the least of three, and the one after the last."""
    limit = code.floats(most)
    least = code.smaller(code.smaller(ends[0], ends[1]), ends[2])
    largest = code.larger(code.larger(ends[0], ends[1]), ends[2])
    first, after = (code.within(value + 0.5, 0.0, limit) for value in (least, largest))
    return code.whole(first), code.whole(after)


def _plain(code: Code, paint: list[Lanes]) -> Callable[[Lanes, Lanes], Lanes]:
    """The first of a paint as cover of black: a shadow."""
    cover = code.spread(Lanes(code, code.trunc(code.whole(paint[0]).value, ir.IntType(32)))) << 24
    return lambda one, two: cover


def _shade(
    code: Code, light: Any, normals: list[list[Lanes]], paint: list[Lanes]
) -> Callable[[Lanes, Lanes], Lanes]:
    """The colour of a surface by its normal: of sky and lamp, and of what is reflected."""
    base = [[code.spread(n[0]), *(code.spread(n[k] - n[0]) for k in (1, 2))] for n in normals]
    lamp, half, sky = (
        [code.spread(code.fetch(light, 3 * row + axis)) for axis in range(3)] for row in range(3)
    )
    paints = [code.spread(value * 255.0) for value in paint]

    def colour(one: Lanes, two: Lanes) -> Lanes:
        normal = [n[0] + one * n[1] + two * n[2] for n in base]
        length = code.root(_dot(normal, normal) + 1e-12)
        lit = code.larger(_dot(normal, lamp) / length, 0.0)
        glare = code.larger(_dot(normal, half) / length, 0.0)
        for _ in range(5):
            glare = glare * glare
        strength = lit * _LAMP + _dot(normal, sky) / length * (_SKY / 2) + (_EVERYWHERE + _SKY / 2)
        white = glare * (_GLOSS * 255.0)
        bytes_ = [code.within(p * strength + white, 0.0, 255.0) + 0.5 for p in paints]
        red, green, blue = (code.whole(code.smaller(b, 255.0)) for b in bytes_)
        return red | (green << 8) | (blue << 16) | 0xFF << 24

    return colour


def _dot(one: list[Lanes], other: list[Lanes]) -> Lanes:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def _resolve(module: ir.Module) -> None:
    code, arguments = begun(module, "resolve", 6, 5)
    left, right, top, bottom, wide, stride, solid, ghost, near, opacity, frame = arguments
    veil = code.spread(code.fetch(opacity, 0))
    with code.each(top, bottom) as row, code.each(left, right, WIDTH) as column:
        first = row * 2 * wide + column * 2
        places = [first, first + WIDTH, first + wide, first + wide + WIDTH]
        pixel = row * stride + column
        under = code.fetch(frame, pixel, WORDS)
        channels = [code.floats((under >> 8 * k) & 0xFF) for k in range(3)]
        for samples, share in ((solid, None), (ghost, veil)):
            sums = _sums(code, samples, places)
            clear = code.like(sums[3], 1.0) - sums[3] * (1 / 255)
            if share is None:
                channels = [s + c * clear for s, c in zip(sums, channels, strict=False)]
            else:
                hidden = code.like(share, 1.0) - share * sums[3] * (1 / 255)
                channels = [s * share + c * hidden for s, c in zip(sums, channels, strict=False)]
        red, green, blue = (code.whole(code.smaller(c + 0.5, 255.0)) for c in channels)
        code.put(red | (green << 8) | (blue << 16) | 0xFF << 24, frame, pixel)
        for place in places:
            code.put(code.constant(WORDS, 0), solid, place)
            code.put(code.constant(WORDS, 0), ghost, place)
            code.put(code.constant(REALS, 0.0), near, place)
    code.ret_void()


def _sums(code: Code, samples: Any, places: list[Lanes]) -> list[Lanes]:
    """Means of the four samples of eight pixels, of red, green, blue and cover."""
    upper, upper_end, lower, lower_end = (code.fetch(samples, p, WORDS) for p in places)
    sums = []
    for k in range(4):
        ends = [
            ((a >> 8 * k) & 0xFF) + ((b >> 8 * k) & 0xFF)
            for a, b in ((upper, lower), (upper_end, lower_end))
        ]
        even, odd = (
            Lanes(
                code,
                code.shuffle_vector(
                    ends[0].value,
                    ends[1].value,
                    ir.Constant(WORDS, [2 * lane + side for lane in range(WIDTH)]),
                ),
            )
            for side in (0, 1)
        )
        sums.append(code.floats(even + odd) * 0.25)
    return sums
