"""Eight numbers at a time, written as formulas: what the loops over pixels are made of."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from llvmlite import ir

WIDTH = 8
_ONE, _INT, _PLACE = ir.FloatType(), ir.IntType(32), ir.IntType(64)
REALS, WORDS = ir.VectorType(_ONE, WIDTH), ir.VectorType(_INT, WIDTH)
_BYTE, _POINTER = ir.IntType(8), ir.PointerType()
_FAST = ("contract", "arcp", "nsz")


class Lanes:
    """A value of machine code, of one kind with what it is added to: eight floats, eight 32-bit
    words, one float, or one integer."""

    def __init__(self, code: Code, value: Any) -> None:
        self._code, self.value = code, value

    def _with(self, real: str, whole: str, other: Lanes | float) -> Lanes:
        right = self._code.like(self, other)
        if self.real:
            return Lanes(
                self._code, getattr(self._code, real)(self.value, right.value, flags=_FAST)
            )
        return Lanes(self._code, getattr(self._code, whole)(self.value, right.value))

    @property
    def real(self) -> bool:
        """Whether it is of floats."""
        return getattr(self.value.type, "element", self.value.type) == _ONE

    def __add__(self, other: Lanes | float) -> Lanes:
        return self._with("fadd", "add", other)

    def __sub__(self, other: Lanes | float) -> Lanes:
        return self._with("fsub", "sub", other)

    def __mul__(self, other: Lanes | float) -> Lanes:
        return self._with("fmul", "mul", other)

    def __truediv__(self, other: Lanes | float) -> Lanes:
        return self._with("fdiv", "sdiv", other)

    def __and__(self, other: Lanes | int) -> Lanes:
        return self._with("", "and_", other)

    def __or__(self, other: Lanes | int) -> Lanes:
        return self._with("", "or_", other)

    def __lshift__(self, other: int) -> Lanes:
        return self._with("", "shl", other)

    def __rshift__(self, other: int) -> Lanes:
        return self._with("", "lshr", other)

    __radd__, __rmul__ = __add__, __mul__

    def test(self, relation: str, other: Lanes | float) -> Any:
        """Where a relation holds, as LLVM's bits."""
        right = self._code.like(self, other).value
        if self.real:
            return self._code.fcmp_ordered(relation, self.value, right)
        return self._code.icmp_signed(relation, self.value, right)


class Code(ir.IRBuilder):
    """llvmlite's builder with `Lanes`, and with loops."""

    def like(self, pattern: Lanes, value: Lanes | float) -> Lanes:
        """A number as lanes of some kind; lanes as they are."""
        if isinstance(value, Lanes):
            return value
        return self.constant(pattern.value.type, value)

    def constant(self, kind: Any, value: float) -> Lanes:
        """One number, in each lane."""
        plain = float(value) if getattr(kind, "element", kind) == _ONE else int(value)
        lanes = [plain] * WIDTH if isinstance(kind, ir.VectorType) else plain
        return Lanes(self, ir.Constant(kind, lanes))

    def spread(self, one: Lanes) -> Lanes:
        """One number in each lane."""
        kind = ir.VectorType(one.value.type, WIDTH)
        first = self.insert_element(ir.Constant(kind, ir.Undefined), one.value, _INT(0))
        zeros = ir.Constant(WORDS, [0] * WIDTH)
        return Lanes(self, self.shuffle_vector(first, ir.Constant(kind, ir.Undefined), zeros))

    def ramp(self) -> Lanes:
        """0, 1, … 7 as floats."""
        return Lanes(self, ir.Constant(REALS, [float(k) for k in range(WIDTH)]))

    def where(self, bits: Any, yes: Lanes, no: Lanes) -> Lanes:
        """One or the other in each lane."""
        return Lanes(self, self.select(bits, yes.value, no.value))

    def larger(self, one: Lanes, other: Lanes | float) -> Lanes:
        """The larger in each lane."""
        right = self.like(one, other)
        return self.where(one.test(">", right), one, right)

    def smaller(self, one: Lanes, other: Lanes | float) -> Lanes:
        """The smaller in each lane."""
        right = self.like(one, other)
        return self.where(one.test("<", right), one, right)

    def within(self, value: Lanes, least: Lanes | float, most: Lanes | float) -> Lanes:
        """A value, no less and no more than two others."""
        return self.smaller(self.larger(value, least), most)

    def root(self, value: Lanes) -> Lanes:
        """Square root."""
        return self._rounded("sqrt", value)

    def size(self, value: Lanes) -> Lanes:
        """Absolute value."""
        return self._rounded("fabs", value)

    def floor(self, value: Lanes) -> Lanes:
        """The whole number below."""
        return self._rounded("floor", value)

    def _rounded(self, name: str, value: Lanes) -> Lanes:
        kind = value.value.type
        whole = f"llvm.{name}.{'v8f32' if isinstance(kind, ir.VectorType) else 'f32'}"
        function = self.module.globals.get(whole) or ir.Function(
            self.module, ir.FunctionType(kind, [kind]), whole
        )
        return Lanes(self, self.call(function, [value.value]))

    def whole(self, value: Lanes) -> Lanes:
        """Floats as integers, cut off: words of lanes, an index of one."""
        kind = WORDS if isinstance(value.value.type, ir.VectorType) else _PLACE
        return Lanes(self, self.fptosi(value.value, kind))

    def floats(self, value: Lanes) -> Lanes:
        """Integers as floats."""
        kind = REALS if isinstance(value.value.type, ir.VectorType) else _ONE
        return Lanes(self, self.sitofp(value.value, kind))

    def any_of(self, bits: Any) -> Any:
        """Whether a relation holds in any lane."""
        return self.icmp_unsigned("!=", self.bitcast(bits, _BYTE), _BYTE(0))

    def at(self, base: Any, index: Lanes, kind: Any = _ONE) -> Any:
        """The address of an element of four bytes."""
        return self.gep(base, [index.value], source_etype=kind)

    def fetch(self, base: Any, index: Lanes | int, kind: Any = _ONE) -> Lanes:
        """One element of four bytes, or the eight from there on."""
        place = self.index(index) if isinstance(index, int) else index
        return Lanes(self, self.load(self.at(base, place), typ=kind, align=4))

    def put(self, value: Lanes, base: Any, index: Lanes) -> None:
        """Store what `fetch` reads."""
        self.store(value.value, self.at(base, index), align=4)

    def index(self, value: int) -> Lanes:
        """An index."""
        return self.constant(_PLACE, value)

    def corner(self, base: Any, index: Lanes) -> Lanes:
        """One of the 32-bit indices of a face, as an index."""
        return Lanes(self, self.sext(self.fetch(base, index, _INT).value, _PLACE))

    @contextmanager
    def each(self, first: Lanes, end: Lanes, step: int = 1) -> Iterator[Lanes]:
        """The body, for each index from `first` to before `end`."""
        before, body = self.block, self.append_basic_block("each")
        after = self.append_basic_block("done")
        self.cbranch(first.test("<", end), body, after)
        self.position_at_end(body)
        count = self.phi(_PLACE)
        count.add_incoming(first.value, before)
        yield Lanes(self, count)
        following = Lanes(self, self.add(count, _PLACE(step)))
        count.add_incoming(following.value, self.block)
        self.cbranch(following.test("<", end), body, after)
        self.position_at_end(after)


def begun(module: ir.Module, name: str, indices: int, pointers: int) -> tuple[Code, list[Any]]:
    """What a new function of so many indices and then so many pointers is written with, and its
    arguments."""
    kinds = [_PLACE] * indices + [_POINTER] * pointers
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), kinds), name)
    function.attributes.add("nounwind")
    code = Code(function.append_basic_block("entry"))
    arguments = [Lanes(code, a) if a.type == _PLACE else a for a in function.args]
    return code, arguments
