"""LLVM code on vectors of eight doubles, written as text: straight lines, and loops over rows.

Eight samples travel together in the lanes of <8 x double>. Nothing here branches by a value, so
what a lane computes never depends on its neighbours. In memory a vector is a row of eight doubles,
and a function is given the first of its rows.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

LANES = 8
VECTOR = f"<{LANES} x double>"
MASK = f"<{LANES} x i1>"
BITS = f"<{LANES} x i64>"
_KIND = f"v{LANES}f64"
_FEW, _TOGETHER = 12, 4  # rows that are written one after another, and in each turn of a loop

_DECLARATIONS = f"""
declare {VECTOR} @llvm.fmuladd.{_KIND}({VECTOR}, {VECTOR}, {VECTOR})
declare {VECTOR} @llvm.sqrt.{_KIND}({VECTOR})
declare {VECTOR} @llvm.fabs.{_KIND}({VECTOR})
declare {VECTOR} @llvm.floor.{_KIND}({VECTOR})
declare {VECTOR} @llvm.copysign.{_KIND}({VECTOR}, {VECTOR})
attributes #0 = {{ nounwind "min-legal-vector-width"="512" "prefer-vector-width"="512" }}
"""


def module(functions: Sequence[str]) -> str:
    """LLVM text of functions made by `Vectors.function`."""
    return "\n".join([_DECLARATIONS, *functions])


def number(value: float) -> str:
    """A constant in all lanes."""
    bits = struct.pack(">d", value).hex().upper()
    return "<" + ", ".join([f"double 0x{bits}"] * LANES) + ">"


@dataclass(frozen=True)
class Row:
    """The row that a loop is at, or so many `more`."""

    name: str
    more: int = 0

    def __add__(self, more: int) -> Row:
        return Row(self.name, self.more + more)


class Vectors:
    """Writes one instruction after another; every method returns the name of its result.

    Values and masks go by their names in LLVM, constants by what `number` gives.
    """

    def __init__(self) -> None:
        self._lines: list[str] = ["entry:"]
        self._count = 0
        self._block = "entry"

    def function(
        self, name: str, rows: Sequence[str], mask: str | None = None, result: str | None = None
    ) -> str:
        """What was written, as a function of the pointers `rows`, none of which overlap.

        It takes lanes as the last argument `mask`, and returns those of `result`, where they are
        given: integers as `packed` makes them.
        """
        arguments = [f"ptr noalias {row}" for row in rows]
        if mask is not None:
            arguments.append(f"i{LANES} {mask}")
        kind = "void" if result is None else f"i{LANES}"
        end = "  ret void" if result is None else f"  ret {kind} {result}"
        head = f"define {kind} @{name}({', '.join(arguments)}) #0 {{"
        return "\n".join([head, *self._lines, end, "}", ""])

    def _emit(self, expression: str) -> str:
        self._count += 1
        name = f"%v{self._count}"
        self._lines.append(f"  {name} = {expression}")
        return name

    def begin_block(self, name: str, branch: str = "br label %{}") -> tuple[list[str], str, str]:
        """A new block, to which `branch` goes: the lines, the block before, and its own name."""
        self._count += 1
        before, self._block = self._block, f"{name}{self._count}"
        self._lines += [f"  {branch.format(self._block)}", f"{self._block}:"]
        return self._lines, before, self._block

    # -------------------------------------------------------------------------- memory

    def at(self, base: str, row: int | Row) -> str:
        """Address of a row."""
        if isinstance(row, int):
            return self._emit(f"getelementptr double, ptr {base}, i64 {row * LANES}")
        return self._emit(f"getelementptr {VECTOR}, ptr {self.at(base, row.more)}, i64 {row.name}")

    def load(self, base: str, row: int | Row) -> str:
        """A row of memory."""
        return self._emit(f"load {VECTOR}, ptr {self.at(base, row)}, align 64")

    def store(self, base: str, row: int | Row, value: str) -> None:
        """A value into a row of memory."""
        self._lines.append(f"  store {VECTOR} {value}, ptr {self.at(base, row)}, align 64")

    def call(self, name: str, *rows: str) -> None:
        """Call another function on rows of memory."""
        self._lines.append(f"  call void @{name}({', '.join(f'ptr {row}' for row in rows)})")

    def copy(self, to: str, to_row: int, base: str, row: int, count: int) -> None:
        """So many rows from one place to another."""
        for k in Loop(self, count):
            self.store(to, k + to_row, self.load(base, k + row))

    # ---------------------------------------------------------------------- arithmetic

    def _two(self, what: str, a: str, b: str) -> str:
        # A product may be contracted with a sum that uses it into one multiply-add.
        return self._emit(f"{what} contract {VECTOR} {a}, {b}")

    def add(self, a: str, b: str) -> str:
        """a + b."""
        return self._two("fadd", a, b)

    def sub(self, a: str, b: str) -> str:
        """a − b."""
        return self._two("fsub", a, b)

    def mul(self, a: str, b: str) -> str:
        """a b."""
        return self._two("fmul", a, b)

    def div(self, a: str, b: str) -> str:
        """a / b."""
        return self._two("fdiv", a, b)

    def negative(self, a: str) -> str:
        """−a."""
        return self._emit(f"fneg {VECTOR} {a}")

    def multiply_add(self, a: str, b: str, c: str) -> str:
        """a b + c, rounded once where the processor can."""
        return self._intrinsic("fmuladd", a, b, c)

    def polynomial(self, z: str, coefficients: Sequence[float]) -> str:
        """c0 + z (c1 + z (c2 + …))."""
        value = number(coefficients[-1])
        for c in reversed(coefficients[:-1]):
            value = self.multiply_add(z, value, number(c))
        return value

    def weighted(self, weights: Sequence[float], values: Sequence[str]) -> str:
        """Σ weights · values, the zero weights left out."""
        total = ""
        for weight, value in zip(weights, values, strict=True):
            if weight == 0.0:
                continue
            factor = number(weight)
            total = self.multiply_add(factor, value, total) if total else self.mul(factor, value)
        return total

    def square_root(self, a: str) -> str:
        """√a."""
        return self._intrinsic("sqrt", a)

    def size(self, a: str) -> str:
        """|a|."""
        return self._intrinsic("fabs", a)

    def floor(self, a: str) -> str:
        """The greatest whole number that is not above a."""
        return self._intrinsic("floor", a)

    def with_sign(self, a: str, sign: str) -> str:
        """|a| with the sign of `sign`."""
        return self._intrinsic("copysign", a, sign)

    def _intrinsic(self, name: str, *values: str) -> str:
        arguments = ", ".join(f"{VECTOR} {value}" for value in values)
        return self._emit(f"call {VECTOR} @llvm.{name}.{_KIND}({arguments})")

    # --------------------------------------------------------------------------- masks

    def test(self, how: str, a: str, b: str) -> str:
        """A mask of the lanes where a comparison holds; `how` is LLVM's name of it: "olt"…"""
        return self._emit(f"fcmp {how} {VECTOR} {a}, {b}")

    def both(self, a: str, b: str) -> str:
        """Lanes of both masks."""
        return self._emit(f"and {MASK} {a}, {b}")

    def either(self, a: str, b: str) -> str:
        """Lanes of one mask or the other."""
        return self._emit(f"or {MASK} {a}, {b}")

    def outside(self, a: str) -> str:
        """Lanes that are not in a mask."""
        ones = "<" + ", ".join(["i1 true"] * LANES) + ">"
        return self._emit(f"xor {MASK} {a}, {ones}")

    def where(self, mask: str, yes: str, no: str) -> str:
        """`yes` in the lanes of a mask, `no` in the others."""
        return self._emit(f"select {MASK} {mask}, {VECTOR} {yes}, {VECTOR} {no}")

    def indicator(self, mask: str) -> str:
        """1 in the lanes of a mask, 0 in the others."""
        return self.where(mask, number(1.0), number(0.0))

    def least(self, a: str, b: str) -> str:
        """a where it is below b, else b."""
        return self.where(self.test("olt", a, b), a, b)

    def greatest(self, a: str, b: str) -> str:
        """a where it is above b, else b."""
        return self.where(self.test("ogt", a, b), a, b)

    def packed(self, mask: str) -> str:
        """A mask as an integer with one bit for each lane, as functions return it."""
        return self._emit(f"bitcast {MASK} {mask} to i{LANES}")

    def unpacked(self, bits: str) -> str:
        """The mask of such an integer."""
        return self._emit(f"bitcast i{LANES} {bits} to {MASK}")

    # ---------------------------------------------------------------------------- bits

    def bits(self, a: str) -> str:
        """The bits of doubles, as integers."""
        return self._emit(f"bitcast {VECTOR} {a} to {BITS}")

    def of_bits(self, a: str) -> str:
        """The doubles with these bits."""
        return self._emit(f"bitcast {BITS} {a} to {VECTOR}")

    def integers(self, what: str, a: str, b: int | str) -> str:
        """One of LLVM's operations on integers, by its name: "and", "shl", "add"…"""
        if isinstance(b, int):
            b = "<" + ", ".join([f"i64 {b}"] * LANES) + ">"
        return self._emit(f"{what} {BITS} {a}, {b}")

    def whole(self, a: str) -> str:
        """Integers as doubles."""
        return self._emit(f"sitofp {BITS} {a} to {VECTOR}")

    def odd(self, a: str) -> str:
        """A mask of the lanes whose integer is odd."""
        return self._emit(f"trunc {BITS} {a} to {MASK}")


class Loop:
    """Writes the same for each of so many rows: one after another where they are few, else in a
    loop over some at a time, since the time of compiling grows faster than the code is long.

    `totals` are what is added up on the way: set them to what they become with a row.
    """

    def __init__(self, v: Vectors, count: int, totals: Sequence[str] = ()) -> None:
        self._v, self._count, self.totals = v, count, list(totals)

    def __iter__(self) -> Iterator[Any]:
        turns = self._count // _TOGETHER if self._count > _FEW else 0
        if turns:
            yield from self._loop(turns)
        yield from range(turns * _TOGETHER, self._count)

    def _loop(self, turns: int) -> Iterator[Row]:
        lines, before, block = self._v.begin_block("each")
        row, first = f"%{block}.row", self.totals
        self.totals = [f"%{block}.total{k}" for k in range(len(first))]
        sums, head = self.totals, len(lines)
        for more in range(_TOGETHER):
            yield Row(row, more)
        following, again = f"%{block}.next", f"%{block}.again"
        heads = [f"  {row} = phi i64 [ 0, %{before} ], [ {following}, %{block} ]"]
        for name, start, last in zip(sums, first, self.totals, strict=True):
            heads.append(f"  {name} = phi {VECTOR} [ {start}, %{before} ], [ {last}, %{block} ]")
        lines[head:head] = heads
        lines += [
            f"  {following} = add i64 {row}, {_TOGETHER}",
            f"  {again} = icmp ult i64 {following}, {turns * _TOGETHER}",
        ]
        self._v.begin_block("after", f"br i1 {again}, label %{block}, label %{{}}")
