"""Straight-line LLVM code on vectors of eight doubles, written as text.

Eight samples travel together in the lanes of <8 x double>. Nothing here branches, so what a lane
computes never depends on its neighbours. In memory a vector is a row of eight doubles, and a
function is given the first of its rows.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence

LANES = 8
VECTOR = f"<{LANES} x double>"
MASK = f"<{LANES} x i1>"
BITS = f"<{LANES} x i64>"
_KIND = f"v{LANES}f64"

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


class Vectors:
    """Writes one instruction after another; every method returns the name of its result.

    Values and masks go by their names in LLVM, constants by what `number` gives.
    """

    def __init__(self) -> None:
        self._lines: list[str] = []
        self._count = 0

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

    # -------------------------------------------------------------------------- memory

    def at(self, base: str, row: int) -> str:
        """Address of a row."""
        return self._emit(f"getelementptr double, ptr {base}, i64 {row * LANES}")

    def load(self, base: str, row: int) -> str:
        """A row of memory."""
        return self._emit(f"load {VECTOR}, ptr {self.at(base, row)}, align 64")

    def store(self, base: str, row: int, value: str) -> None:
        """A value into a row of memory."""
        self._lines.append(f"  store {VECTOR} {value}, ptr {self.at(base, row)}, align 64")

    def call(self, name: str, *rows: str) -> None:
        """Call another function on rows of memory."""
        self._lines.append(f"  call void @{name}({', '.join(f'ptr {row}' for row in rows)})")

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
