"""A CasADi expression as vector code: one instruction for each of its scalar ones.

A division by the same denominator is made once and multiplied afterwards, and a sine shares its
argument reduction with the cosine; both change results by no more than a rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import accumulate

import casadi as ca

from somersault.engine._elementary import arc_tangent, logarithm, sine_cosine
from somersault.engine._vectors import Vectors, number


def expression(function: ca.Function, name: str) -> str:
    """LLVM text of `void name(ptr x, ptr y)` for one block of lanes.

    `function` takes dense vectors and returns one. The rows of x are those of its arguments, one
    after another; the rows of y are its result's.

    Raises
    ------
    NotImplementedError
        For an operation that no equation here makes.
    """
    v = _Shared()
    first_rows = list(accumulate((function.nnz_in(k) for k in range(function.n_in())), initial=0))
    slots: dict[int, str] = {}
    for k in range(function.n_instructions()):
        operation = function.instruction_id(k)
        inputs, outputs = function.instruction_input(k), function.instruction_output(k)
        if operation == ca.OP_INPUT:
            argument, element = inputs
            slots[outputs[0]] = v.load("%x", first_rows[argument] + element)
        elif operation == ca.OP_OUTPUT:
            v.store("%y", outputs[1], slots[inputs[0]])
        elif operation == ca.OP_CONST:
            slots[outputs[0]] = number(function.instruction_constant(k))
        elif operation in _OPERATIONS:
            operands = [slots[slot] for slot in inputs]
            slots[outputs[0]] = _OPERATIONS[operation](v, *operands)
        else:
            raise NotImplementedError(f"CasADi operation {operation} has no vector form here")
    return v.function(name, ["%x", "%y"])


class _Shared(Vectors):
    """Vector code that makes a quotient's denominator and an angle's reduction only once."""

    def __init__(self) -> None:
        super().__init__()
        self._inverses: dict[str, str] = {}
        self._sines_cosines: dict[str, tuple[str, str]] = {}

    def inverse(self, a: str) -> str:
        """1 / a."""
        if a not in self._inverses:
            self._inverses[a] = self.div(number(1.0), a)
        return self._inverses[a]

    def sine_cosine(self, a: str) -> tuple[str, str]:
        """sin a and cos a."""
        if a not in self._sines_cosines:
            self._sines_cosines[a] = sine_cosine(self, a)
        return self._sines_cosines[a]

    def holds(self, how: str, a: str, b: str) -> str:
        """1 where a comparison holds, else 0; `how` is LLVM's name of it."""
        return self.indicator(self.test(how, a, b))

    def true(self, a: str) -> str:
        """A mask of the lanes where a is not 0."""
        return self.test("une", a, number(0.0))


_OPERATIONS: dict[int, Callable[..., str]] = {
    ca.OP_ASSIGN: lambda v, a: a,
    ca.OP_ADD: Vectors.add,
    ca.OP_SUB: Vectors.sub,
    ca.OP_MUL: Vectors.mul,
    ca.OP_DIV: lambda v, a, b: v.mul(a, v.inverse(b)),
    ca.OP_INV: _Shared.inverse,
    ca.OP_NEG: Vectors.negative,
    ca.OP_SQ: lambda v, a: v.mul(a, a),
    ca.OP_TWICE: lambda v, a: v.add(a, a),
    ca.OP_SQRT: Vectors.square_root,
    ca.OP_FABS: Vectors.size,
    ca.OP_FLOOR: Vectors.floor,
    ca.OP_SIGN: lambda v, a: v.sub(v.holds("olt", number(0.0), a), v.holds("olt", a, number(0.0))),
    ca.OP_FMIN: Vectors.least,
    ca.OP_FMAX: Vectors.greatest,
    ca.OP_LT: lambda v, a, b: v.holds("olt", a, b),
    ca.OP_LE: lambda v, a, b: v.holds("ole", a, b),
    ca.OP_EQ: lambda v, a, b: v.holds("oeq", a, b),
    ca.OP_NE: lambda v, a, b: v.holds("une", a, b),
    ca.OP_AND: lambda v, a, b: v.indicator(v.both(v.true(a), v.true(b))),
    ca.OP_OR: lambda v, a, b: v.indicator(v.either(v.true(a), v.true(b))),
    ca.OP_NOT: lambda v, a: v.holds("oeq", a, number(0.0)),
    ca.OP_IF_ELSE_ZERO: lambda v, a, b: v.where(v.true(a), b, number(0.0)),
    ca.OP_SIN: lambda v, a: v.sine_cosine(a)[0],
    ca.OP_COS: lambda v, a: v.sine_cosine(a)[1],
    ca.OP_ATAN2: arc_tangent,
    ca.OP_LOG: logarithm,
}
