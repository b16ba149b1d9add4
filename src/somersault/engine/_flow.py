"""Control flow of compiled code: llvmlite's builder, with loops and with numbers of eight bytes.

All memory here holds doubles, integers and pointers of eight bytes each, so that a place is an
address and a count.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from llvmlite import ir

from somersault.engine._vectors import LANES

INTEGER, DOUBLE, POINTER = ir.IntType(64), ir.DoubleType(), ir.PointerType()
BIT, LANE_BITS, NOTHING = ir.IntType(1), ir.IntType(LANES), ir.VoidType()

_KINDS = {ctypes.c_int64: INTEGER, ctypes.c_double: DOUBLE, ctypes.c_void_p: POINTER}


def integer(value: int) -> ir.Constant:
    """An integer constant."""
    return ir.Constant(INTEGER, value)


def double(value: float) -> ir.Constant:
    """A double constant."""
    return ir.Constant(DOUBLE, value)


class Code:
    """A module of functions that are written with `Flow`, and those of text that they call."""

    def __init__(self) -> None:
        self._module = ir.Module()
        self._module.triple = ""

    def __str__(self) -> str:
        return str(self._module)

    def declared(self, name: str, arguments: Sequence[Any], result: Any = NOTHING) -> Any:
        """A function by its name and types, to be called."""
        return ir.Function(self._module, ir.FunctionType(result, list(arguments)), name)

    def written(
        self, name: str, arguments: Sequence[Any], result: Any = NOTHING
    ) -> tuple[Flow, Sequence[Any]]:
        """What the body of a new function is written with, and its arguments."""
        function = self.declared(name, arguments, result)
        function.attributes.add("nounwind")
        return Flow(function.append_basic_block("entry")), function.args


class Flow(ir.IRBuilder):
    """llvmlite's builder, which stands at the end of a block."""

    def room(self, kind: Any, count: Any = 1) -> Any:
        """Memory of the function for so many numbers; not in a loop."""
        room = self.alloca(kind, count)
        room.align = 64
        return room

    def fill(self, place: Any, count: int, value: Any) -> None:
        """Store one number in so many places."""
        with self.counted(integer(0), integer(count)) as k:
            self.store(value, self.place(place, k))

    def place(self, base: Any, *counts: Any) -> Any:
        """The address so many numbers after `base`."""
        for count in counts:
            base = self.gep(base, [count], source_etype=DOUBLE)
        return base

    def read(self, place: Any, kind: Any = DOUBLE) -> Any:
        """The number at a place."""
        return self.load(place, typ=kind)

    def field(
        self, structure: type[ctypes.Structure], base: Any, name: str, kind: Any = None
    ) -> Any:
        """A field of a structure that starts at `base`; the type `kind` of a pointer to a function
        has to be given."""
        fields = {field[0]: field[1] for field in structure._fields_}
        offset = integer(getattr(structure, name).offset)
        place = self.gep(base, [offset], source_etype=ir.IntType(8))
        return self.load(place, typ=kind or _KINDS[fields[name]])

    @contextmanager
    def counted(self, first: Any, end: Any) -> Iterator[Any]:
        """The body, once for each integer from `first` to before `end`."""
        before, body = self.block, self.append_basic_block("each")
        after = self.append_basic_block("counted")
        self.cbranch(self.icmp_signed("<", first, end), body, after)
        self.position_at_end(body)
        count = self.phi(INTEGER)
        count.add_incoming(first, before)
        yield count
        following = self.add(count, integer(1))
        count.add_incoming(following, self.block)
        self.cbranch(self.icmp_signed("<", following, end), body, after)
        self.position_at_end(after)

    @contextmanager
    def repeated(self) -> Iterator[ir.Block]:
        """The body again and again; `leave_if` goes on after it."""
        body, after = self.append_basic_block("again"), self.append_basic_block("after")
        self.branch(body)
        self.position_at_end(body)
        yield after
        self.branch(body)
        self.position_at_end(after)

    def leave_if(self, condition: Any, after: ir.Block) -> None:
        """Leave a loop for what comes after it."""
        stay = self.append_basic_block("stay")
        self.cbranch(condition, after, stay)
        self.position_at_end(stay)


def copier(code: Code) -> Any:
    """Writes copy(to, to_step, from, from_step, count): it copies numbers so many places apart."""
    flow, (to, to_step, source, source_step, count) = code.written(
        "copy", [POINTER, INTEGER, POINTER, INTEGER, INTEGER]
    )
    with flow.counted(integer(0), count) as k:
        value = flow.read(flow.place(source, flow.mul(k, source_step)))
        flow.store(value, flow.place(to, flow.mul(k, to_step)))
    flow.ret_void()
    return flow.function
