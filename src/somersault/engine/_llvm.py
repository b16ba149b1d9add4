"""A CasADi expression as LLVM text: one vector instruction for each scalar one.

Eight samples travel together in the lanes of <8 x double>. A division by the same denominator
is made once and multiplied afterwards, and a sine shares its argument reduction with the
cosine; both change results by no more than a rounding. Sine and cosine are the fdlibm
polynomials after a three-part reduction by π/2 (good to 1 ulp for |x| < 10⁵); the arc tangent
is the Cephes rational approximation.
"""

from __future__ import annotations

import struct
from collections.abc import Callable

import casadi as ca

LANES = 8
VECTOR = f"<{LANES} x double>"
_V = VECTOR
_I = f"<{LANES} x i64>"

_TWO_OVER_PI = 0.6366197723675814
_HALF_PI_PARTS = (1.57079632673412561417e00, 6.07710050630396597660e-11, 2.02226624879595063154e-21)
_ROUNDER = 6755399441055744.0  # 1.5 · 2⁵²: adding it leaves the nearest integer in the low bits
_SINE = (
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
)
_COSINE = (
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
)
_ATAN_P = (
    -8.750608600031904122785e-1,
    -1.615753718733365076637e1,
    -7.500855792314704667340e1,
    -1.228866684490136173410e2,
    -6.485021904942025371773e1,
)
_ATAN_Q = (
    2.485846490142306297962e1,
    1.650270098316988542046e2,
    4.328810604912902668951e2,
    4.853903996359136964868e2,
    1.945506571482613964425e2,
)

_BINARY = {ca.OP_ADD: "fadd", ca.OP_SUB: "fsub", ca.OP_MUL: "fmul"}


HEADER = f"""
declare {VECTOR} @llvm.fmuladd.v{LANES}f64({VECTOR}, {VECTOR}, {VECTOR})
declare {VECTOR} @llvm.sqrt.v{LANES}f64({VECTOR})
declare {VECTOR} @llvm.fabs.v{LANES}f64({VECTOR})
declare {VECTOR} @llvm.floor.v{LANES}f64({VECTOR})
declare {VECTOR} @llvm.copysign.v{LANES}f64({VECTOR}, {VECTOR})
attributes #0 = {{ nounwind "min-legal-vector-width"="512" "prefer-vector-width"="512" }}
"""


def llvm_function(function: ca.Function, name: str) -> str:
    """LLVM text of `void name(ptr x, ptr y)` for one block of lanes; needs `HEADER` before it.

    `function` takes one dense vector and returns one. The block of the input is the doubles
    x[input][lane]; the output likewise. Raises NotImplementedError for an operation that no
    equation here makes.
    """
    return f"""
define void @{name}(ptr noalias nocapture readonly %x, ptr noalias nocapture %y) #0 {{
{_Writer(function).text()}
  ret void
}}
"""


def llvm_module(function: ca.Function, name: str) -> str:
    """LLVM text with `name` as in `llvm_function`, and `name`_many(x, y, blocks) over many."""
    n_in, n_out = function.nnz_in(0), function.nnz_out(0)
    return f"""{HEADER}{llvm_function(function, name)}
define void @{name}_many(ptr noalias nocapture readonly %x, ptr noalias nocapture %y, i64 %n) #0 {{
entry:
  %any = icmp sgt i64 %n, 0
  br i1 %any, label %loop, label %done
loop:
  %b = phi i64 [ 0, %entry ], [ %next, %loop ]
  %xo = mul i64 %b, {n_in * LANES}
  %yo = mul i64 %b, {n_out * LANES}
  %xp = getelementptr double, ptr %x, i64 %xo
  %yp = getelementptr double, ptr %y, i64 %yo
  call void @{name}(ptr %xp, ptr %yp)
  %next = add i64 %b, 1
  %more = icmp slt i64 %next, %n
  br i1 %more, label %loop, label %done
done:
  ret void
}}
"""


def _hex(value: float) -> str:
    return "0x" + struct.pack(">d", value).hex().upper()


def number(value: float) -> str:
    return "<" + ", ".join([f"double {_hex(value)}"] * LANES) + ">"


def _integer(value: int) -> str:
    return "<" + ", ".join([f"i64 {value}"] * LANES) + ">"


class _Writer:
    """Walks a function's instruction list and writes a vector instruction for each."""

    def __init__(self, function: ca.Function) -> None:
        self._function = function
        self._lines: list[str] = []
        self._count = 0
        self._slots: dict[int, str] = {}
        self._inverse: dict[str, str] = {}
        self._sincos: dict[str, tuple[str, str]] = {}

    def text(self) -> str:
        f = self._function
        for k in range(f.n_instructions()):
            operation = f.instruction_id(k)
            inputs, outputs = f.instruction_input(k), f.instruction_output(k)
            if operation == ca.OP_INPUT:
                self._slots[outputs[0]] = self._load(inputs[1])
            elif operation == ca.OP_OUTPUT:
                self._store(outputs[1], self._slots[inputs[0]])
            elif operation == ca.OP_CONST:
                self._slots[outputs[0]] = number(f.instruction_constant(k))
            else:
                operands = [self._slots[slot] for slot in inputs]
                self._slots[outputs[0]] = self._apply(operation, operands)
        return "\n".join(self._lines)

    def _emit(self, expression: str) -> str:
        self._count += 1
        name = f"%v{self._count}"
        self._lines.append(f"  {name} = {expression}")
        return name

    def _load(self, index: int) -> str:
        place = self._emit(f"getelementptr double, ptr %x, i64 {index * LANES}")
        return self._emit(f"load {_V}, ptr {place}, align 64")

    def _store(self, index: int, value: str) -> None:
        place = self._emit(f"getelementptr double, ptr %y, i64 {index * LANES}")
        self._lines.append(f"  store {_V} {value}, ptr {place}, align 64")

    def _apply(self, operation: int, x: list[str]) -> str:
        if operation in _BINARY:
            return self._two(_BINARY[operation], x[0], x[1])
        if operation == ca.OP_DIV:
            return self._two("fmul", x[0], self._one_over(x[1]))
        table: dict[int, Callable[[], str]] = {
            ca.OP_NEG: lambda: self._emit(f"fneg {_V} {x[0]}"),
            ca.OP_SQ: lambda: self._two("fmul", x[0], x[0]),
            ca.OP_TWICE: lambda: self._two("fadd", x[0], x[0]),
            ca.OP_INV: lambda: self._one_over(x[0]),
            ca.OP_FMIN: lambda: self._where(
                self._emit(f"fcmp olt {_V} {x[0]}, {x[1]}"), x[0], x[1]
            ),
            ca.OP_FMAX: lambda: self._where(
                self._emit(f"fcmp ogt {_V} {x[0]}, {x[1]}"), x[0], x[1]
            ),
            ca.OP_SQRT: lambda: self._call("sqrt", x[0]),
            ca.OP_FABS: lambda: self._call("fabs", x[0]),
            ca.OP_FLOOR: lambda: self._call("floor", x[0]),
            ca.OP_SIN: lambda: self._sine_cosine(x[0])[0],
            ca.OP_COS: lambda: self._sine_cosine(x[0])[1],
            ca.OP_ATAN2: lambda: self._atan2(x[0], x[1]),
            ca.OP_SIGN: lambda: self._two(
                "fsub", self._less(number(0.0), x[0]), self._less(x[0], number(0.0))
            ),
            ca.OP_LT: lambda: self._less(x[0], x[1]),
            ca.OP_ASSIGN: lambda: x[0],
        }
        if operation not in table:
            raise NotImplementedError(f"CasADi operation {operation} has no vector form here")
        return table[operation]()

    def _two(self, what: str, a: str, b: str) -> str:
        return self._emit(f"{what} contract {_V} {a}, {b}")

    def _call(self, what: str, a: str) -> str:
        return self._emit(f"call {_V} @llvm.{what}.v{LANES}f64({_V} {a})")

    def _fma(self, a: str, b: str, c: str) -> str:
        return self._emit(f"call {_V} @llvm.fmuladd.v{LANES}f64({_V} {a}, {_V} {b}, {_V} {c})")

    def _horner(self, z: str, coefficients: tuple[float, ...]) -> str:
        """c0 + z (c1 + z (c2 + …))."""
        value = number(coefficients[-1])
        for c in reversed(coefficients[:-1]):
            value = self._fma(z, value, number(c))
        return value

    def _one_over(self, a: str) -> str:
        if a not in self._inverse:
            self._inverse[a] = self._two("fdiv", number(1.0), a)
        return self._inverse[a]

    def _where(self, condition: str, yes: str, no: str) -> str:
        return self._emit(f"select <{LANES} x i1> {condition}, {_V} {yes}, {_V} {no}")

    def _bits(self, what: str, a: str, b: str) -> str:
        return self._emit(f"{what} {_I} {a}, {b}")

    def _signed(self, value: str, bit_two: str) -> str:
        """`value`, negated in the lanes where bit 1 of `bit_two` is set."""
        sign = self._bits("shl", self._bits("and", bit_two, _integer(2)), _integer(62))
        bits = self._emit(f"bitcast {_V} {value} to {_I}")
        return self._emit(f"bitcast {_I} {self._bits('xor', bits, sign)} to {_V}")

    def _sine_cosine(self, x: str) -> tuple[str, str]:
        if x in self._sincos:
            return self._sincos[x]
        shifted = self._fma(x, number(_TWO_OVER_PI), number(_ROUNDER))
        quarter = self._emit(f"bitcast {_V} {shifted} to {_I}")
        turns = self._emit(f"fsub {_V} {shifted}, {number(_ROUNDER)}")
        r = x
        for part in _HALF_PI_PARTS:
            r = self._fma(turns, number(-part), r)
        z = self._two("fmul", r, r)
        sine = self._fma(self._two("fmul", z, r), self._horner(z, _SINE), r)
        half = self._fma(z, number(-0.5), number(1.0))
        cosine = self._fma(self._two("fmul", z, z), self._horner(z, _COSINE), half)
        odd = self._emit(f"trunc {_I} {quarter} to <{LANES} x i1>")
        s = self._signed(self._where(odd, cosine, sine), quarter)
        c = self._signed(self._where(odd, sine, cosine), self._bits("add", quarter, _integer(1)))
        self._sincos[x] = (s, c)
        return s, c

    def _less(self, a: str, b: str) -> str:
        below = self._emit(f"fcmp olt {_V} {a}, {b}")
        return self._where(below, number(1.0), number(0.0))

    def _atan2(self, y: str, x: str) -> str:
        """atan2(|y|, x) with the sign of y; 0 at the origin."""
        sign, y = y, self._call("fabs", y)
        steep = self._emit(f"fcmp ogt {_V} {y}, {self._call('fabs', x)}")
        top = self._where(steep, self._emit(f"fneg {_V} {x}"), y)
        bottom = self._where(steep, y, x)
        nowhere = self._emit(f"fcmp oeq {_V} {bottom}, {number(0.0)}")
        bottom = self._where(nowhere, number(1.0), bottom)
        # |top / bottom| ≤ 1 here; above tan(π/8) turn by π/4 once more.
        t = self._emit(f"fdiv {_V} {top}, {bottom}")
        size = self._call("fabs", t)
        wide = self._emit(f"fcmp ogt {_V} {size}, {number(0.41421356237309503)}")
        turned = self._emit(
            f"fdiv {_V} {self._two('fsub', size, number(1.0))}, "
            f"{self._two('fadd', size, number(1.0))}"
        )
        u = self._where(wide, turned, size)
        z = self._two("fmul", u, u)
        p = self._horner(z, tuple(reversed(_ATAN_P)))
        q = self._horner(z, (*reversed(_ATAN_Q), 1.0))
        ratio = self._emit(f"fdiv {_V} {self._two('fmul', z, p)}, {q}")
        angle = self._fma(u, ratio, u)
        quarter = self._where(wide, number(0.7853981633974483), number(0.0))
        angle = self._two("fadd", angle, quarter)
        negative = self._emit(f"fcmp olt {_V} {t}, {number(0.0)}")
        angle = self._where(negative, self._emit(f"fneg {_V} {angle}"), angle)
        behind = self._emit(f"fcmp olt {_V} {x}, {number(0.0)}")
        flat = self._where(behind, number(3.141592653589793), number(0.0))
        offset = self._where(steep, number(1.5707963267948966), flat)
        angle = self._two("fadd", angle, offset)
        return self._emit(f"call {_V} @llvm.copysign.v{LANES}f64({_V} {angle}, {_V} {sign})")
