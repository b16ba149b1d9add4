"""What the machine could do at best: multiply-adds without end."""

from __future__ import annotations

import ctypes
import math
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np

from somersault.engine import LANES, compiled, compiled_function

_CHAINS = 12  # independent multiply-adds in flight, more than any core's latency × width
_TIMES = 2_000_000


def aligned(shape: tuple[int, ...]) -> np.ndarray:
    """An empty array whose data start on a 64-byte boundary, as the vector loads need."""
    count = math.prod(shape)
    raw = np.empty(count + LANES)
    start = (-raw.ctypes.data % 64) // 8
    return raw[start : start + count].reshape(shape)


@cache
def _peak() -> Callable[..., None]:
    """Nothing but independent multiply-adds."""
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
    engine = compiled(f"""
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
    pointers = ctypes.c_void_p, ctypes.c_void_p
    return compiled_function(engine, "peak", *pointers, ctypes.c_int64)


def peak_timer(threads: int) -> Callable[[], float]:
    """Seconds a floating-point operation in nothing but fused multiply-adds, two each."""
    call = _peak()
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
