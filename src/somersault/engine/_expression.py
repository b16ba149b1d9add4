"""A CasADi expression as vector code: one instruction for each of its scalar ones.

A division by the same denominator is made once and multiplied afterwards, and a sine shares its
argument reduction with the cosine; both change results by no more than a rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import accumulate
from typing import NamedTuple

import casadi as ca

from somersault.engine._derivative import derivative
from somersault.engine._elementary import arc_tangent, logarithm
from somersault.engine._shared import Shared
from somersault.engine._vectors import Vectors, number


class Direction(NamedTuple):
    """Along what a function of one vector is differentiated.

    Attributes
    ----------
    values : sequence of int
        For each of the vector's numbers the row where it stands.
    slopes : sequence of int or None
        The row where its derivative stands; None where that is zero.
    """

    values: Sequence[int]
    slopes: Sequence[int | None]


def expression(
    function: ca.Function,
    name: str,
    rows: Sequence[int] | None = None,
    slopes: Sequence[int | None] | None = None,
) -> str:
    """LLVM text of `void name(ptr x, ptr y)` for one block of lanes.

    `function` takes dense vectors and returns one. The rows of x are those of its arguments, one
    after another, unless `rows` says where each stands; the rows of y are its result's. Where
    `slopes` says in which rows of x there are derivatives of the arguments, those of the result
    stand behind it.

    Raises
    ------
    NotImplementedError
        For an operation that no equation here makes.
    """
    v = Shared()
    first_rows = list(accumulate((function.nnz_in(k) for k in range(function.n_in())), initial=0))
    rows = range(first_rows[-1]) if rows is None else rows
    values: dict[int, str] = {}
    changes: dict[int, str | None] = {}
    for k in range(function.n_instructions()):
        operation = function.instruction_id(k)
        inputs, outputs = function.instruction_input(k), function.instruction_output(k)
        if operation == ca.OP_OUTPUT:
            v.store("%y", outputs[1], values[inputs[0]])
            if slopes is not None:
                behind = outputs[1] + function.nnz_out(0)
                v.store("%y", behind, changes[inputs[0]] or number(0.0))
            continue
        change: str | None = None
        if operation == ca.OP_INPUT:
            argument, element = inputs
            place = first_rows[argument] + element
            value = v.load("%x", rows[place])
            if slopes is not None and (row := slopes[place]) is not None:
                change = v.load("%x", row)
        elif operation == ca.OP_CONST:
            value = number(function.instruction_constant(k))
        elif operation in _OPERATIONS:
            operands = [values[slot] for slot in inputs]
            value = _OPERATIONS[operation](v, *operands)
            change = derivative(v, operation, value, operands, [changes[slot] for slot in inputs])
        else:
            raise NotImplementedError(f"CasADi operation {operation} has no vector form here")
        values[outputs[0]], changes[outputs[0]] = value, change
    return v.function(name, ["%x", "%y"])


_OPERATIONS: dict[int, Callable[..., str]] = {
    ca.OP_ASSIGN: lambda v, a: a,
    ca.OP_ADD: Vectors.add,
    ca.OP_SUB: Vectors.sub,
    ca.OP_MUL: Vectors.mul,
    ca.OP_DIV: lambda v, a, b: v.mul(a, v.inverse(b)),
    ca.OP_INV: Shared.inverse,
    ca.OP_NEG: Vectors.negative,
    ca.OP_SQ: lambda v, a: v.mul(a, a),
    ca.OP_TWICE: lambda v, a: v.add(a, a),
    ca.OP_SQRT: Vectors.square_root,
    ca.OP_FABS: Vectors.size,
    ca.OP_FLOOR: Vectors.floor,
    ca.OP_SIGN: Shared.sign,
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
