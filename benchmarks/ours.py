"""Our side of the comparison: kernels, their operations, and plain NumPy."""

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
from limits import aligned

from somersault.dynamics import Equations
from somersault.engine import LANES, Kernel, compiled, compiled_function, use_threads

_COUNTED = (ca.OP_ADD, ca.OP_SUB, ca.OP_MUL, ca.OP_SQ, ca.OP_TWICE, ca.OP_DIV, ca.OP_INV)
_SINE_AND_COSINE = 38  # operations of one reduction and both polynomials, a multiply-add as two
_TURNS = 30
MANY = 65_536  # samples of a public call
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
    kernel.block  # noqa: B018 (compiles)
    return Compiled(kernel, function, derived - start, time.perf_counter() - derived)


@dataclass(frozen=True)
class Chunk:
    """Samples that stay in a core's cache, as a kernel takes them, and room for the results."""

    kernel: Kernel
    x: np.ndarray
    out: np.ndarray

    @property
    def samples(self) -> int:
        """How many they are."""
        return BLOCKS * LANES

    def run(self) -> None:
        """Call the kernel for one block after another."""
        strides = (self.kernel.inputs * LANES, self.kernel.outputs * LANES)
        x, out = self.x.ctypes.data, self.out.ctypes.data
        _blocks()(self.kernel.block, x, out, *strides, BLOCKS)


def chunk(kernel: Kernel, sample: np.ndarray, rng: np.random.Generator) -> Chunk:
    """Samples about one, (inputs,)."""
    x, out = aligned((BLOCKS, kernel.inputs, LANES)), aligned((BLOCKS, kernel.outputs, LANES))
    x[...] = sample[:, None] + 0.1 * rng.normal(size=x.shape)
    return Chunk(kernel, x, out)


def kernel_timer(kernel: Kernel, threads: int, sample: np.ndarray) -> Callable[[], float]:
    """Seconds an evaluation on that many threads, each on a chunk about `sample` of its own."""
    rng = np.random.default_rng(0)
    chunks = [chunk(kernel, sample, rng) for _ in range(threads)]
    pool = ThreadPoolExecutor(threads)
    rounds = 400

    def work(own: Chunk) -> None:
        for _ in range(rounds):
            own.run()

    def measure() -> float:
        start = time.perf_counter()
        list(pool.map(work, chunks))
        return (time.perf_counter() - start) / (threads * rounds * chunks[0].samples)

    measure()
    return measure


@cache
def _blocks() -> Callable[..., None]:
    """A loop that calls a kernel for one block of lanes after another."""
    pointer, integer = ctypes.c_void_p, ctypes.c_int64
    arguments = pointer, pointer, pointer, integer, integer, integer
    return compiled_function(compiled(_BLOCKS), "blocks", *arguments)


_BLOCKS = """
define void @blocks(ptr %kernel, ptr %x, ptr %y, i64 %xby, i64 %yby, i64 %n) {
entry:
  br label %loop
loop:
  %i = phi i64 [ 0, %entry ], [ %next, %loop ]
  %xo = mul i64 %i, %xby
  %yo = mul i64 %i, %yby
  %xp = getelementptr double, ptr %x, i64 %xo
  %yp = getelementptr double, ptr %y, i64 %yo
  call void %kernel(ptr %xp, ptr %yp)
  %next = add i64 %i, 1
  %more = icmp slt i64 %next, %n
  br i1 %more, label %loop, label %done
done:
  ret void
}
"""


def public_timer(equations: Equations, q: np.ndarray, v: np.ndarray) -> Callable[[], float]:
    """Seconds an evaluation by `Equations.forward_dynamics`, given many samples."""
    many_q, many_v = _many(q, v)

    def measure() -> float:
        start = time.perf_counter()
        equations.forward_dynamics(many_q, many_v)
        return (time.perf_counter() - start) / MANY

    measure()
    return measure


def public_cost(
    equations: Equations, kernel: Kernel, sample: np.ndarray, q: np.ndarray, v: np.ndarray
) -> dict[str, float]:
    """The same call beside its kernel, and beside copying its bytes, in turns: nanoseconds of
    processor time an evaluation, on one thread, which other work on the machine hardly changes."""
    many_q, many_v = _many(q, v)
    own = chunk(kernel, sample, np.random.default_rng(0))
    moved = 8 * (len(q) + len(v) + equations.speeds)  # bytes of a sample, in and out
    source = np.ones(MANY * moved // 16)
    target = np.ones_like(source)

    def spent(what: Callable[[], object], samples: int) -> float:
        start = time.thread_time()
        what()
        return (time.thread_time() - start) / samples * 1e9

    times = []
    with use_threads(1):
        for _ in range(_TURNS):
            call = spent(lambda: equations.forward_dynamics(many_q, many_v), MANY)
            alone = spent(lambda: [own.run() for _ in range(8)], 8 * own.samples)
            copying = spent(lambda: np.copyto(target, source), MANY)
            times.append((call, alone, copying, call / alone))
    call, alone, copying, ratio = np.median(times[1:], axis=0).tolist()
    return {"bytes": moved, "ns": call, "kernel": alone, "copying": copying, "over_kernel": ratio}


def _many(q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(1)
    shapes = (MANY, len(q)), (MANY, len(v))
    return q + 0.1 * rng.normal(size=shapes[0]), v + 0.1 * rng.normal(size=shapes[1])


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
