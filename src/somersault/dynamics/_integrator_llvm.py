"""DOP853 over eight flights at once, as LLVM text.

Each lane has its own time, step and fate; a lane that has arrived takes steps of length zero
until the others have. Everything is arithmetic on <8 x double> with no branches but the
loops, so what a lane does never depends on its neighbours.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from somersault.dynamics import _dop853 as table
from somersault.dynamics._llvm import HEADER, LANES, VECTOR, number

# Rows of the control block, each of 8 lanes.
TIME, STEP, END, STATUS, STEPS, GAUGE, TOLERANCE, LIMIT, RATE = range(9)
CONTROL_ROWS = 9

# Values of STATUS.
FLYING, EVENT, TOO_MANY_STEPS, BROKEN = 0.0, 1.0, 2.0, 3.0

_SAFETY, _SHRINK, _GROW = 0.9, 0.2, 6.0
_SHORTEST = 1e-13  # of the time, or of a second: a step below this means the flight broke
_MASK = f"<{LANES} x i1>"


class _Text:
    """Emits instructions; every method returns the name of its result."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self._count = 0

    def emit(self, expression: str) -> str:
        self._count += 1
        self.lines.append(f"  %r{self._count} = {expression}")
        return f"%r{self._count}"

    def at(self, base: str, row: int) -> str:
        return self.emit(f"getelementptr double, ptr {base}, i64 {row * LANES}")

    def load(self, base: str, row: int) -> str:
        return self.emit(f"load {VECTOR}, ptr {self.at(base, row)}, align 64")

    def store(self, base: str, row: int, value: str) -> None:
        self.lines.append(f"  store {VECTOR} {value}, ptr {self.at(base, row)}, align 64")

    def two(self, what: str, a: str, b: str) -> str:
        return self.emit(f"{what} contract {VECTOR} {a}, {b}")

    def fma(self, a: str, b: str, c: str) -> str:
        kind = f"v{LANES}f64"
        return self.emit(
            f"call {VECTOR} @llvm.fmuladd.{kind}({VECTOR} {a}, {VECTOR} {b}, {VECTOR} {c})"
        )

    def call(self, what: str, a: str) -> str:
        return self.emit(f"call {VECTOR} @llvm.{what}.v{LANES}f64({VECTOR} {a})")

    def test(self, how: str, a: str, b: str) -> str:
        return self.emit(f"fcmp {how} {VECTOR} {a}, {b}")

    def both(self, a: str, b: str) -> str:
        return self.emit(f"and {_MASK} {a}, {b}")

    def neither(self, a: str) -> str:
        ones = "<" + ", ".join(["i1 true"] * LANES) + ">"
        return self.emit(f"xor {_MASK} {a}, {ones}")

    def where(self, mask: str, yes: str, no: str) -> str:
        return self.emit(f"select {_MASK} {mask}, {VECTOR} {yes}, {VECTOR} {no}")

    def least(self, a: str, b: str) -> str:
        return self.where(self.test("olt", a, b), a, b)

    def most(self, a: str, b: str) -> str:
        return self.where(self.test("ogt", a, b), a, b)

    def weighted(self, weights: Sequence[float], values: Sequence[str]) -> str:
        """Σ weights · values, the zero weights left out."""
        total = ""
        for weight, value in zip(weights, values, strict=True):
            if weight == 0.0:
                continue
            factor = number(weight)
            total = self.fma(factor, value, total) if total else self.two("fmul", factor, value)
        return total


@dataclass(frozen=True)
class Rows:
    """How many rows a block has: `state`, then the time, then `parameters`, then `watched`."""

    state: int
    parameters: int
    watched: int = 0

    @property
    def before_watched(self) -> int:
        """Where the watched rows begin."""
        return self.state + 1 + self.parameters

    @property
    def inputs(self) -> int:
        """All of them."""
        return self.before_watched + self.watched

    @property
    def outputs(self) -> int:
        """Those that are handed back: the state and what is watched."""
        return self.state + self.watched

    @property
    def look(self) -> int:
        """What `watch` is given: states and slopes at both ends of a step, both times,
        parameters, and what was watched so far."""
        return 4 * self.state + 2 + self.parameters + self.watched


def integrator_module(equations: str, rows: Rows, event: bool) -> str:
    """LLVM text with `fly` and `step`.

    `equations` defines @rhs(x, dy); with `event`, @gauge(x, g); and where there are watched rows
    @watch(look, watched), called after each step that counts with the rows of `Rows.look`, and
    @longest(x, step), which bounds a step so that nothing is missed between its ends.

    fly(x, control, samples, out, count, blocks, most): carry each block of lanes to each of
    `count` sample times in turn (a lane stops early at its own END, at a step in which the gauge
    changes sign, or broken), and store the output rows: out[block][sample][row][lane]. In a
    step that holds an event the lane stays at the step's beginning with STEP its length. After
    `most` steps a block is left where it is; called again it goes on as if it had not been.
    step(x, control, y, blocks): one step of length STEP from x, into y[block][row][lane], and
    the gauge after it into the control.
    """
    return "\n".join(
        [
            HEADER,
            equations,
            _arrive(rows, event),
            _single(rows, event),
            _fly(rows, event),
            _many_steps(rows),
        ]
    )


def _watched(t: _Text, rows: Rows, before: str, after: str) -> list[str]:
    """What is watched, after the step from %x to %z between the two times."""
    state = rows.state
    values = [t.load("%x", row) for row in range(state)]
    values += [t.load("%k", row) for row in range(state)]
    values += [t.load("%z", row) for row in range(state)]
    values += [t.load("%k", 12 * state + row) for row in range(state)]
    values += [before, after]
    values += [t.load("%x", row) for row in range(state + 1, rows.inputs)]
    for row, value in enumerate(values):
        t.store("%w", row, value)
    t.lines.append("  call void @watch(ptr %w, ptr %v)")
    return [t.load("%v", row) for row in range(rows.watched)]


def _stages(t: _Text, state: int, step: str, time: str) -> list[str]:
    """All twelve slopes in %k (the first is there), the new state in %z; returns it."""
    for stage, weights in enumerate(table.STAGES, 1):
        for row in range(state):
            slopes = [t.load("%k", j * state + row) if w else "" for j, w in enumerate(weights)]
            ahead = t.fma(step, t.weighted(weights, slopes), t.load("%x", row))
            t.store("%z", row, ahead)
        t.store("%z", state, t.fma(number(table.NODES[stage]), step, time))
        t.lines.append(f"  call void @rhs(ptr %z, ptr {t.at('%k', stage * state)})")
    new = []
    for row in range(state):
        slopes = [t.load("%k", j * state + row) if w else "" for j, w in enumerate(table.WEIGHTS)]
        new.append(t.fma(step, t.weighted(table.WEIGHTS, slopes), t.load("%x", row)))
        t.store("%z", row, new[-1])
    t.store("%z", state, t.two("fadd", time, step))
    return new


def _error(t: _Text, state: int, step: str, tolerance: str, new: list[str]) -> str:
    """Hairer's combined estimate over the tolerance, squared."""
    five = three = number(0.0)
    for row in range(state):
        slopes = [t.load("%k", j * state + row) for j in range(12)]
        size = t.most(t.call("fabs", t.load("%x", row)), t.call("fabs", new[row]))
        scale = t.two("fmul", tolerance, t.two("fadd", size, number(1.0)))
        one_over = t.two("fdiv", number(1.0), scale)
        e5 = t.two("fmul", t.weighted(table.ERROR_5, slopes), one_over)
        e3 = t.two("fmul", t.weighted(table.ERROR_3, slopes), one_over)
        five, three = t.fma(e5, e5, five), t.fma(e3, e3, three)
    below = t.fma(number(0.01), three, five)
    below = t.where(t.test("ueq", below, number(0.0)), number(1e-300), below)
    scaled = t.two("fmul", t.two("fmul", step, step), t.two("fmul", five, five))
    return t.two("fdiv", scaled, t.two("fmul", below, number(float(state))))


def _arrive(rows: Rows, event: bool) -> str:
    """arrive(x, control, k, z, …, until): step one block until every lane is there or done."""
    t = _Text()
    state = rows.state
    time, step = t.load("%c", TIME), t.load("%c", STEP)
    end = t.least(t.load("%c", END), "%until")
    status = t.load("%c", STATUS)
    left = t.two("fsub", end, time)
    flying = t.both(t.test("oeq", status, number(FLYING)), t.test("ogt", left, number(0.0)))
    any_flying = t.emit(f"bitcast {_MASK} {flying} to i{LANES}")
    needed = t.emit(f"icmp ne i{LANES} {any_flying}, 0")
    allowed = t.emit("icmp slt i64 %taken, %most")
    go = t.emit(f"and i1 {needed}, {allowed}")
    t.lines += [f"  br i1 {go}, label %advance, label %done", "advance:"]
    if rows.watched:
        t.lines.append("  call void @longest(ptr %x, ptr %g)")
        step = t.least(step, t.load("%g", 0))
    clipped = t.test("oge", step, left)
    taken = t.where(flying, t.where(clipped, left, step), number(0.0))
    new = _stages(t, state, taken, time)
    squared = _error(t, state, taken, t.load("%c", TOLERANCE), new)
    ahead = t.at("%k", 12 * state)
    t.lines.append(f"  call void @rhs(ptr %z, ptr {ahead})")
    accepted = t.both(flying, t.test("ole", squared, number(1.0)))
    crossed = accepted
    if event:
        gauge_before = t.load("%c", GAUGE)
        t.lines.append("  call void @gauge(ptr %z, ptr %g)")
        gauge = t.load("%g", 0)
        across = t.test("olt", t.two("fmul", gauge_before, gauge), number(0.0))
        crossed = t.both(accepted, across)
        kept = t.both(accepted, t.neither(crossed))
        t.store("%c", GAUGE, t.where(kept, gauge, gauge_before))
        accepted = kept
    root = t.call("sqrt", squared)
    eighth = t.call("sqrt", t.call("sqrt", t.call("sqrt", root)))
    factor = t.two("fdiv", number(_SAFETY), t.most(eighth, number(_SAFETY / _GROW)))
    sound = t.both(t.test("ord", squared, squared), t.test("oge", factor, number(_SHRINK)))
    factor = t.where(sound, factor, number(_SHRINK))
    held_back = t.load("%c", RATE)  # 1 after a step that failed: do not grow at once
    factor = t.where(t.test("ogt", held_back, number(0.0)), t.least(factor, number(1.0)), factor)
    wanted = t.two("fmul", taken, factor)
    # A step cut short by the end says little about the next; keep the one before it.
    wanted = t.where(t.both(clipped, accepted), t.most(step, wanted), wanted)
    following = t.where(flying, wanted, step)
    if event:
        following = t.where(crossed, taken, following)
        status = t.where(crossed, number(EVENT), status)
    failed = t.both(flying, t.neither(accepted))
    if event:
        failed = t.both(failed, t.neither(crossed))
    t.store("%c", RATE, t.where(failed, number(1.0), number(0.0)))
    size = t.most(t.call("fabs", time), number(1.0))
    short = t.test("olt", following, t.two("fmul", size, number(_SHORTEST)))
    status = t.where(t.both(failed, short), number(BROKEN), status)
    steps = t.load("%c", STEPS)
    steps = t.where(flying, t.two("fadd", steps, number(1.0)), steps)
    full = t.both(flying, t.test("oge", steps, t.load("%c", LIMIT)))
    untouched = t.test("oeq", status, number(FLYING))
    status = t.where(t.both(full, untouched), number(TOO_MANY_STEPS), status)
    t.store("%c", STEPS, steps)
    t.store("%c", STATUS, status)
    t.store("%c", STEP, following)
    # The last step lands on the end exactly, whatever rounding adds.
    arrived = t.where(clipped, end, t.two("fadd", time, taken))
    now = t.where(accepted, arrived, time)
    if rows.watched:
        for row, value in enumerate(_watched(t, rows, time, arrived), rows.before_watched):
            t.store("%x", row, t.where(accepted, value, t.load("%x", row)))
    t.store("%c", TIME, now)
    t.store("%x", state, now)
    for row in range(state):
        t.store("%x", row, t.where(accepted, new[row], t.load("%x", row)))
        slope = t.where(accepted, t.load("%k", 12 * state + row), t.load("%k", row))
        t.store("%k", row, slope)
    body = "\n".join(t.lines)
    return f"""
define void @arrive(
    ptr %x, ptr %c, ptr %k, ptr %z, ptr %g, ptr %w, ptr %v, {VECTOR} %until, i64 %most) #0 {{
entry:
  br label %again
again:
  %taken = phi i64 [ 0, %entry ], [ %next, %advance ]
{body}
  %next = add i64 %taken, 1
  br label %again
done:
  ret void
}}
"""


def _prepared(t: _Text, rows: Rows) -> None:
    """The parameters beside the trial state in %z, and the first slope in %k."""
    for row in range(rows.before_watched):
        t.store("%z", row, t.load("%x", row))
    t.lines.append("  call void @rhs(ptr %z, ptr %k)")


def _gauged(t: _Text, state: str) -> None:
    """The gauge of a state into the control."""
    t.lines.append(f"  call void @gauge(ptr {state}, ptr %g)")
    t.store("%c", GAUGE, t.load("%g", 0))


def _single(rows: Rows, event: bool) -> str:
    """single(x, control, …, y): one step of one block."""
    t = _Text()
    _prepared(t, rows)
    time, step = t.load("%c", TIME), t.load("%c", STEP)
    new = _stages(t, rows.state, step, time)
    if rows.watched:
        t.lines.append(f"  call void @rhs(ptr %z, ptr {t.at('%k', 12 * rows.state)})")
        new += _watched(t, rows, time, t.two("fadd", time, step))
    if event:
        _gauged(t, "%z")
    for row, value in enumerate(new):
        t.store("%y", row, value)
    body = "\n".join(t.lines)
    return f"""
define void @single(
    ptr %x, ptr %c, ptr %k, ptr %z, ptr %g, ptr %w, ptr %v, ptr %y) #0 {{
{body}
  ret void
}}
"""


def _memory(rows: Rows) -> str:
    return f"""  %k = alloca [{13 * rows.state * LANES} x double], align 64
  %z = alloca [{rows.before_watched * LANES} x double], align 64
  %g = alloca [{LANES} x double], align 64
  %w = alloca [{rows.look * LANES} x double], align 64
  %v = alloca [{max(rows.watched, 1) * LANES} x double], align 64"""


def _fly(rows: Rows, event: bool) -> str:
    t = _Text()
    _prepared(t, rows)
    if event:
        _gauged(t, "%x")
    prepare = "\n".join(t.lines)
    t = _Text()
    t._count = 10000
    kept = [*range(rows.state), *range(rows.before_watched, rows.inputs)]
    for place, row in enumerate(kept):
        t.store("%to", place, t.load("%x", row))
    keep = "\n".join(t.lines)
    splat = ", ".join([f"i32 {0}"] * LANES)
    return f"""
define void @fly(ptr %xs, ptr %cs, ptr %samples, ptr %out, i64 %count, i64 %blocks, i64 %most) #0 {{
entry:
{_memory(rows)}
  br label %block
block:
  %b = phi i64 [ 0, %entry ], [ %bn, %blockend ]
  %more = icmp slt i64 %b, %blocks
  br i1 %more, label %start, label %finished
start:
  %xo = mul i64 %b, {rows.inputs * LANES}
  %co = mul i64 %b, {CONTROL_ROWS * LANES}
  %x = getelementptr double, ptr %xs, i64 %xo
  %c = getelementptr double, ptr %cs, i64 %co
{prepare}
  br label %sample
sample:
  %s = phi i64 [ 0, %start ], [ %sn, %store ]
  %left = icmp slt i64 %s, %count
  br i1 %left, label %carry, label %blockend
carry:
  %tp = getelementptr double, ptr %samples, i64 %s
  %ts = load double, ptr %tp
  %t1 = insertelement {VECTOR} poison, double %ts, i32 0
  %until = shufflevector {VECTOR} %t1, {VECTOR} poison, <{LANES} x i32> <{splat}>
  call void @arrive(
    ptr %x, ptr %c, ptr %k, ptr %z, ptr %g, ptr %w, ptr %v, {VECTOR} %until, i64 %most)
  br label %store
store:
  %ob = mul i64 %b, %count
  %os = add i64 %ob, %s
  %oo = mul i64 %os, {rows.outputs * LANES}
  %to = getelementptr double, ptr %out, i64 %oo
{keep}
  %sn = add i64 %s, 1
  br label %sample
blockend:
  %bn = add i64 %b, 1
  br label %block
finished:
  ret void
}}
"""


def _many_steps(rows: Rows) -> str:
    return f"""
define void @step(ptr %xs, ptr %cs, ptr %ys, i64 %blocks) #0 {{
entry:
{_memory(rows)}
  br label %block
block:
  %b = phi i64 [ 0, %entry ], [ %bn, %start ]
  %more = icmp slt i64 %b, %blocks
  br i1 %more, label %start, label %finished
start:
  %xo = mul i64 %b, {rows.inputs * LANES}
  %co = mul i64 %b, {CONTROL_ROWS * LANES}
  %yo = mul i64 %b, {rows.outputs * LANES}
  %x = getelementptr double, ptr %xs, i64 %xo
  %c = getelementptr double, ptr %cs, i64 %co
  %y = getelementptr double, ptr %ys, i64 %yo
  call void @single(
    ptr %x, ptr %c, ptr %k, ptr %z, ptr %g, ptr %w, ptr %v, ptr %y)
  %bn = add i64 %b, 1
  br label %block
finished:
  ret void
}}
"""
