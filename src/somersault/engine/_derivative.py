"""How the result of an instruction changes with its operands, as vector code.

It is written right behind the instruction, while what both need is still in registers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import casadi as ca

from somersault.engine._shared import Shared
from somersault.engine._vectors import number

# The part of a derivative that one operand's own has in it: of the code, the instruction's result,
# its operands, and that operand's derivative.
_Part = Callable[[Shared, str, Sequence[str], str], str]


def derivative(
    v: Shared, operation: int, result: str, operands: Sequence[str], slopes: Sequence[str | None]
) -> str | None:
    """The derivative of a result, from those of its operands; None stands for zero.

    Raises
    ------
    NotImplementedError
        For an operation that no equation here makes.
    """
    if operation in _STEPS or not any(slopes):
        return None
    if operation not in _PARTS:
        raise NotImplementedError(f"CasADi operation {operation} has no derivative here")
    total: str | None = None
    for part, slope in zip(_PARTS[operation], slopes, strict=True):
        if part is not None and slope is not None:
            own = part(v, result, operands, slope)
            total = own if total is None else v.add(total, own)
    return total


def _of_fraction(v: Shared, a: str, b: str) -> str:
    """1 / (a² + b²), which the derivatives of an angle have in them."""
    return v.inverse(v.multiply_add(a, a, v.mul(b, b)))


def _zero_unless(v: Shared, mask: str, slope: str) -> str:
    return v.where(mask, slope, number(0.0))


# Those whose results only jump.
_STEPS = {
    ca.OP_FLOOR, ca.OP_SIGN, ca.OP_LT, ca.OP_LE, ca.OP_EQ, ca.OP_NE, ca.OP_AND, ca.OP_OR, ca.OP_NOT,
}  # fmt: skip

_PARTS: dict[int, tuple[_Part | None, ...]] = {
    ca.OP_ASSIGN: (lambda v, r, x, s: s,),
    ca.OP_ADD: (lambda v, r, x, s: s, lambda v, r, x, s: s),
    ca.OP_SUB: (lambda v, r, x, s: s, lambda v, r, x, s: v.negative(s)),
    ca.OP_MUL: (lambda v, r, x, s: v.mul(x[1], s), lambda v, r, x, s: v.mul(x[0], s)),
    ca.OP_DIV: (
        lambda v, r, x, s: v.mul(s, v.inverse(x[1])),
        lambda v, r, x, s: v.negative(v.mul(v.mul(r, v.inverse(x[1])), s)),
    ),
    ca.OP_INV: (lambda v, r, x, s: v.negative(v.mul(v.mul(r, r), s)),),
    ca.OP_NEG: (lambda v, r, x, s: v.negative(s),),
    ca.OP_SQ: (lambda v, r, x, s: v.mul(v.add(x[0], x[0]), s),),
    ca.OP_TWICE: (lambda v, r, x, s: v.add(s, s),),
    ca.OP_SQRT: (lambda v, r, x, s: v.mul(v.mul(number(0.5), v.inverse(r)), s),),
    ca.OP_FABS: (lambda v, r, x, s: v.mul(v.sign(x[0]), s),),
    ca.OP_FMIN: (
        lambda v, r, x, s: _zero_unless(v, v.test("olt", x[0], x[1]), s),
        lambda v, r, x, s: _zero_unless(v, v.outside(v.test("olt", x[0], x[1])), s),
    ),
    ca.OP_FMAX: (
        lambda v, r, x, s: _zero_unless(v, v.test("ogt", x[0], x[1]), s),
        lambda v, r, x, s: _zero_unless(v, v.outside(v.test("ogt", x[0], x[1])), s),
    ),
    ca.OP_IF_ELSE_ZERO: (None, lambda v, r, x, s: _zero_unless(v, v.true(x[0]), s)),
    ca.OP_SIN: (lambda v, r, x, s: v.mul(v.sine_cosine(x[0])[1], s),),
    ca.OP_COS: (lambda v, r, x, s: v.negative(v.mul(v.sine_cosine(x[0])[0], s)),),
    ca.OP_ATAN2: (
        lambda v, r, x, s: v.mul(v.mul(x[1], _of_fraction(v, *x)), s),
        lambda v, r, x, s: v.negative(v.mul(v.mul(x[0], _of_fraction(v, *x)), s)),
    ),
    ca.OP_LOG: (lambda v, r, x, s: v.mul(v.inverse(x[0]), s),),
}
