"""Our side of the comparison: kernels, their operations, plain NumPy, and the machine's peak."""

from __future__ import annotations

import ctypes
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache

import casadi as ca
import numpy as np

from somersault.dynamics import Equations
from somersault.engine import LANES, Kernel, compiled
from somersault.engine._kernel import aligned

_COUNTED = (ca.OP_ADD, ca.OP_SUB, ca.OP_MUL, ca.OP_SQ, ca.OP_TWICE, ca.OP_DIV, ca.OP_INV)
_SINE_AND_COSINE = 38  # operations of one reduction and both polynomials, a multiply-add as two
BLOCKS = 256  # a thread's share, small enough to stay in its own cache


@dataclass(frozen=True)
class Compiled:
    """A kernel with what it cost to make."""

    kernel: Kernel
    function: ca.Function
    derive: float  # s
    compile: float  # s

    @property
    def instructions(self) -> int:
        """Of CasADi's list, loads and stores included."""
        return self.function.n_instructions()

    @property
    def operations(self) -> int:
        """Floating-point operations of one evaluation.

        Additions, multiplications and divisions of the instruction list, one each, and for
        sines and cosines what the emitted code does. Signs and selections are not counted.
        """
        f = self.function
        kinds = Counter(f.instruction_id(k) for k in range(f.n_instructions()))
        pairs = max(kinds[ca.OP_SIN], kinds[ca.OP_COS])
        return sum(kinds[kind] for kind in _COUNTED) + _SINE_AND_COSINE * pairs


def forward_dynamics(equations: Equations, attitude_only: bool = False) -> Compiled:
    """Forward dynamics of a model, compiled now.

    With `attitude_only` there is no gravity, and the acceleration of a free base's origin
    is left out: what an integration of attitude and joints in free flight needs.
    """
    start = time.perf_counter()
    expression = equations.expression("forward_dynamics")
    arguments, value = dict(expression.arguments), expression.value
    if attitude_only:
        gravity = arguments.pop("gravity")
        value = ca.substitute(value, gravity, ca.SX.zeros(3))
        value = ca.vertcat(value[:3], value[6:])
    joined = ca.vertcat(*arguments.values())
    function = ca.Function("f", [joined], [ca.cse(ca.densify(value))])
    derived = time.perf_counter()
    kernel = Kernel(function)
    kernel.address  # noqa: B018 (compiles)
    return Compiled(kernel, function, derived - start, time.perf_counter() - derived)


def kernel_timer(kernel: Kernel, threads: int, sample: np.ndarray) -> Callable[[], float]:
    """Seconds an evaluation on that many threads, each on a chunk that stays in its cache.

    `sample` (inputs,) is the first sample; the others lie about it.
    """
    rng = np.random.default_rng(0)
    chunks = []
    for _ in range(threads):
        x, out = aligned((BLOCKS, kernel.inputs, LANES)), aligned((BLOCKS, kernel.outputs, LANES))
        x[...] = sample[:, None] + 0.1 * rng.normal(size=x.shape)
        chunks.append((x, out))
    pool = ThreadPoolExecutor(threads)
    run, rounds = kernel._run, 400

    def work(chunk: tuple[np.ndarray, np.ndarray]) -> None:
        for _ in range(rounds):
            run(*chunk)

    def measure() -> float:
        start = time.perf_counter()
        list(pool.map(work, chunks))
        return (time.perf_counter() - start) / (threads * rounds * BLOCKS * LANES)

    measure()
    return measure


def public_timer(equations: Equations, q: np.ndarray, v: np.ndarray) -> Callable[[], float]:
    """Seconds an evaluation by `Equations.forward_dynamics`, given 65,536 samples."""
    count = 65536
    rng = np.random.default_rng(1)
    many_q = q + 0.1 * rng.normal(size=(count, len(q)))
    many_v = v + 0.1 * rng.normal(size=(count, len(v)))

    def measure() -> float:
        start = time.perf_counter()
        equations.forward_dynamics(many_q, many_v)
        return (time.perf_counter() - start) / count

    measure()
    return measure


def numpy_timer(function: ca.Function, sample: np.ndarray) -> Callable[[], float]:
    """Seconds an evaluation by plain NumPy: each instruction once, over 4096 samples."""
    count = 4096
    x = sample[:, None] + 0.1 * np.random.default_rng(2).normal(size=(len(sample), count))
    program = _program(function)
    np.testing.assert_allclose(
        program(x)[:, :3], np.array(function.map(3)(x[:, :3])), rtol=1e-8, atol=1e-8
    )

    def measure() -> float:
        start = time.perf_counter()
        program(x)
        return (time.perf_counter() - start) / count

    return measure


_NUMPY: dict[int, Callable[..., np.ndarray]] = {
    ca.OP_ADD: np.add,
    ca.OP_SUB: np.subtract,
    ca.OP_MUL: np.multiply,
    ca.OP_DIV: np.divide,
    ca.OP_NEG: np.negative,
    ca.OP_SQ: np.square,
    ca.OP_TWICE: lambda a: a + a,
    ca.OP_INV: lambda a: 1.0 / a,
    ca.OP_SIN: np.sin,
    ca.OP_COS: np.cos,
    ca.OP_SQRT: np.sqrt,
    ca.OP_FABS: np.abs,
    ca.OP_SIGN: np.sign,
    ca.OP_ATAN2: np.arctan2,
    ca.OP_ASSIGN: np.positive,
}


def _program(f: ca.Function) -> Callable[[np.ndarray], np.ndarray]:
    """The instruction list as NumPy calls over a whole batch."""
    steps = [
        (f.instruction_id(k), f.instruction_input(k), f.instruction_output(k))
        for k in range(f.n_instructions())
    ]
    numbers = {
        k: f.instruction_constant(k) for k, step in enumerate(steps) if step[0] == ca.OP_CONST
    }

    def run(x: np.ndarray) -> np.ndarray:
        slots: list = [None] * f.sz_w()
        out = np.empty((f.nnz_out(0), x.shape[1]))
        for k, (operation, inputs, outputs) in enumerate(steps):
            if operation == ca.OP_INPUT:
                slots[outputs[0]] = x[inputs[1]]
            elif operation == ca.OP_OUTPUT:
                out[outputs[1]] = slots[inputs[0]]
            elif operation == ca.OP_CONST:
                slots[outputs[0]] = numbers[k]
            else:
                slots[outputs[0]] = _NUMPY[operation](*(slots[slot] for slot in inputs))
        return out

    return run


# ------------------------------------------------------------------------ the machine's peak

_CHAINS = 12  # independent multiply-adds in flight, more than any core's latency × width
_TIMES = 2_000_000


@cache
def _peak_engine():
    vector = f"<{LANES} x double>"
    near_one = "<" + ", ".join(["double 0x3FEFFFFFFFFFFFFE"] * LANES) + ">"
    lines = [
        f"  %a{k} = phi {vector} [ zeroinitializer, %entry ], [ %b{k}, %loop ]"
        for k in range(_CHAINS)
    ]
    lines += [
        f"  %b{k} = call {vector} @llvm.fma.v{LANES}f64({vector} %a{k}, {vector} {near_one}, "
        f"{vector} %x{k})"
        for k in range(_CHAINS)
    ]
    total = [f"  %s0 = fadd {vector} %b0, %b0"]
    total += [f"  %s{k} = fadd {vector} %s{k - 1}, %b{k}" for k in range(1, _CHAINS)]
    loads = [
        f"  %p{k} = getelementptr double, ptr %x, i64 {LANES * (k % 2)}\n"
        f"  %x{k} = load {vector}, ptr %p{k}, align 64"
        for k in range(_CHAINS)
    ]
    newline = "\n"
    return compiled(f"""
declare {vector} @llvm.fma.v{LANES}f64({vector}, {vector}, {vector})
define void @peak(ptr %x, ptr %y, i64 %n) #0 {{
entry:
{newline.join(loads)}
  br label %loop
loop:
  %i = phi i64 [ 0, %entry ], [ %next, %loop ]
{newline.join(lines)}
  %next = add i64 %i, 1
  %more = icmp slt i64 %next, %n
  br i1 %more, label %loop, label %done
done:
{newline.join(total)}
  store {vector} %s{_CHAINS - 1}, ptr %y, align 64
  ret void
}}
attributes #0 = {{ nounwind "min-legal-vector-width"="512" "prefer-vector-width"="512" }}
""")


def peak_timer(threads: int) -> Callable[[], float]:
    """Seconds a floating-point operation in nothing but fused multiply-adds, two each."""
    address = _peak_engine().get_function_address("peak")
    call = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64)(address)
    rows = [aligned((2, LANES)) for _ in range(threads)]
    outs = [aligned((1, LANES)) for _ in range(threads)]
    for row in rows:
        row[...] = 1e-3
    pool = ThreadPoolExecutor(threads)

    def measure() -> float:
        start = time.perf_counter()
        pairs = zip(rows, outs, strict=True)
        list(pool.map(lambda a: call(a[0].ctypes.data, a[1].ctypes.data, _TIMES), pairs))
        return (time.perf_counter() - start) / (threads * _TIMES * _CHAINS * LANES * 2)

    measure()
    return measure
