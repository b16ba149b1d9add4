"""A step of DOP853 for eight flights at once, as LLVM text.

Each lane has its own time, step and fate. Everything is arithmetic on <8 x double> without a
branch, so what a lane does never depends on its neighbours. A lane that finds a change of sign
of the gauge in its step searches for the place with the lengths of its next steps, beside
lanes that fly on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from somersault.engine import _dop853 as table
from somersault.engine._llvm import LANES, VECTOR, number

# Rows of the control block, each of 8 lanes.
TIME, STEP, UNTIL, STATUS, STEPS, HELD_BACK = range(6)
GAUGE, LOW, HIGH, LOW_GAUGE, HIGH_GAUGE, TRIALS = range(6, 12)
CONTROL_ROWS = 12

# Values of STATUS; the last two are never handed back.
FLYING, EVENT, TOO_MANY_STEPS, BROKEN, SEARCHING, EMPTY = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0

_SAFETY, _SHRINK, _GROW = 0.9, 0.2, 6.0
_SHORTEST = 1e-13  # of the time, or of a second: a step below this means the flight broke
_NEAR_ENOUGH = 1e-15  # of an event's time, or of a second
_MOST_TRIALS = 60.0  # of the search for an event
_MASK = f"<{LANES} x i1>"


class _Text:
    """Emits instructions; every method returns the name of its result."""

    def __init__(self, prefix: str) -> None:
        self.lines: list[str] = []
        self._prefix, self._count = prefix, 0

    def emit(self, expression: str) -> str:
        self._count += 1
        name = f"%{self._prefix}{self._count}"
        self.lines.append(f"  {name} = {expression}")
        return name

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

    def either(self, a: str, b: str) -> str:
        return self.emit(f"or {_MASK} {a}, {b}")

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


def step(rows: Rows, event: bool, tolerance: str, limit: str) -> tuple[str, str]:
    """Instructions that take one step of every lane, and the name of the mask (i8) of the lanes
    that stopped: at UNTIL, at an event, or failed.

    They read and write the block %x, the control %c and the slopes %k, whose first is there,
    with the parameters beside the trial state in %z; %g, %w and %v are room for @gauge and
    @longest, and for what @watch reads and writes.
    """
    t = _Text("r")
    time, status, until = t.load("%c", TIME), t.load("%c", STATUS), t.load("%c", UNTIL)
    length, left = t.load("%c", STEP), t.two("fsub", until, time)
    flying = t.test("oeq", status, number(FLYING))
    if rows.watched:
        t.lines.append("  call void @longest(ptr %x, ptr %g)")
        length = t.least(length, t.load("%g", 0))
    clipped = t.both(flying, t.test("oge", length, left))
    taken = t.where(flying, t.where(clipped, left, length), number(0.0))
    search = _Search(t, time, status) if event else None
    if search:
        taken = t.where(search.searching, search.middle, taken)
    new = _stages(t, rows.state, taken, time)
    squared = _error(t, rows.state, taken, tolerance, new)
    t.lines.append(f"  call void @rhs(ptr %z, ptr {t.at('%k', 12 * rows.state)})")
    good = t.both(flying, t.test("ole", squared, number(1.0)))
    accepted = good
    if search:
        accepted, status = search.after(good, taken, status)
    _next_length(t, flying, good, clipped, squared, taken, length)
    # The last step lands on its end exactly, whatever rounding adds.
    arrived = t.where(clipped, until, t.two("fadd", time, taken))
    now = t.where(accepted, arrived, time)
    short_of = t.test("olt", now, until)
    steps = t.load("%c", STEPS)
    steps = t.where(flying, t.two("fadd", steps, number(1.0)), steps)
    t.store("%c", STEPS, steps)
    size = t.most(t.call("fabs", time), number(1.0))
    short = t.test("olt", t.load("%c", STEP), t.two("fmul", size, number(_SHORTEST)))
    short = t.both(t.both(flying, t.neither(good)), short)
    status = t.where(short, number(BROKEN), status)
    # Who is there with the last of them is not one too many, but one more would be.
    full = t.both(t.test("oge", steps, limit), short_of)
    full = t.both(
        t.test("oeq", status, number(FLYING)), t.either(full, t.test("ogt", steps, limit))
    )
    status = t.where(full, number(TOO_MANY_STEPS), status)
    t.store("%c", STATUS, status)
    if rows.watched:
        for row, value in enumerate(_watched(t, rows, time, arrived), rows.before_watched):
            t.store("%x", row, t.where(accepted, value, t.load("%x", row)))
    t.store("%c", TIME, now)
    t.store("%x", rows.state, now)
    for row in range(rows.state):
        t.store("%x", row, t.where(accepted, new[row], t.load("%x", row)))
        slope = t.where(accepted, t.load("%k", 12 * rows.state + row), t.load("%k", row))
        t.store("%k", row, slope)
    there = t.both(t.test("oeq", status, number(FLYING)), t.neither(short_of))
    over = t.both(t.test("ogt", status, number(FLYING)), t.test("olt", status, number(SEARCHING)))
    stopped = t.either(there, over)
    bits = t.emit(f"bitcast {_MASK} {stopped} to i{LANES}")
    return "\n".join(t.lines), bits


class _Search:
    """The search for an event by the lengths of whole steps, which have the full order of the
    method, so that nothing is interpolated: regula falsi in its Illinois form."""

    def __init__(self, t: _Text, time: str, status: str) -> None:
        self._t, self._time = t, time
        self.searching = t.test("oeq", status, number(SEARCHING))
        self._low, self._high = t.load("%c", LOW), t.load("%c", HIGH)
        self._at_low, self._at_high = t.load("%c", LOW_GAUGE), t.load("%c", HIGH_GAUGE)
        across = t.two("fsub", self._high, self._low)
        ratio = t.two("fdiv", across, t.two("fsub", self._at_high, self._at_low))
        secant = t.two("fsub", self._high, t.two("fmul", self._at_high, ratio))
        finite = t.test("olt", t.call("fabs", secant), number(float("inf")))
        half = t.two("fmul", number(0.5), t.two("fadd", self._low, self._high))
        self.middle = t.where(finite, secant, half)

    def after(self, good: str, taken: str, status: str) -> tuple[str, str]:
        """Which lanes go on from the end of this step, and the status of all."""
        t = self._t
        before = t.load("%c", GAUGE)
        t.lines.append("  call void @gauge(ptr %z, ptr %g)")
        gauge = t.load("%g", 0)
        across = t.test("ole", t.two("fmul", before, gauge), number(0.0))
        crossed = t.both(good, t.both(across, t.test("one", before, number(0.0))))
        same = t.test("ogt", t.two("fmul", gauge, self._at_high), number(0.0))
        low = t.where(same, self._low, self._high)
        at_low = t.where(same, t.two("fmul", number(0.5), self._at_low), self._at_high)
        trials = t.two("fadd", t.load("%c", TRIALS), number(1.0))
        apart = t.call("fabs", t.two("fsub", self.middle, low))
        near = t.two("fmul", number(_NEAR_ENOUGH), t.two("fadd", number(1.0), self._time))
        done = t.test("ule", apart, near)
        done = t.either(done, t.test("ueq", gauge, number(0.0)))
        done = t.either(done, t.test("oge", trials, number(_MOST_TRIALS)))
        found = t.both(self.searching, done)
        zero = number(0.0)
        t.store("%c", LOW, t.where(crossed, zero, low))
        t.store("%c", LOW_GAUGE, t.where(crossed, before, at_low))
        t.store("%c", HIGH, taken)
        t.store("%c", HIGH_GAUGE, gauge)
        t.store("%c", TRIALS, t.where(crossed, zero, trials))
        accepted = t.either(t.both(good, t.neither(crossed)), found)
        t.store("%c", GAUGE, t.where(accepted, gauge, before))
        status = t.where(crossed, number(SEARCHING), status)
        return accepted, t.where(found, number(EVENT), status)


def _next_length(
    t: _Text, flying: str, good: str, clipped: str, squared: str, taken: str, length: str
) -> None:
    """What step a lane will try next, into its control."""
    root = t.call("sqrt", squared)
    eighth = t.call("sqrt", t.call("sqrt", t.call("sqrt", root)))
    factor = t.two("fdiv", number(_SAFETY), t.most(eighth, number(_SAFETY / _GROW)))
    sound = t.both(t.test("ord", squared, squared), t.test("oge", factor, number(_SHRINK)))
    factor = t.where(sound, factor, number(_SHRINK))
    # Not longer at once after a step that failed.
    held_back = t.test("ogt", t.load("%c", HELD_BACK), number(0.0))
    factor = t.where(held_back, t.least(factor, number(1.0)), factor)
    wanted = t.two("fmul", taken, factor)
    # A step cut short by the end says little about the next; keep the one before it.
    wanted = t.where(t.both(clipped, good), t.most(length, wanted), wanted)
    t.store("%c", STEP, t.where(flying, wanted, length))
    failed = t.both(flying, t.neither(good))
    t.store("%c", HELD_BACK, t.where(failed, number(1.0), number(0.0)))


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


def renewed(rows: Rows, event: bool, fresh: str) -> str:
    """Instructions that give the lanes of the mask `fresh` (i8) the slope and the gauge of where
    they are."""
    t = _Text("n")
    lanes = t.emit(f"bitcast i{LANES} {fresh} to {_MASK}")
    t.lines.append(f"  call void @rhs(ptr %x, ptr {t.at('%k', rows.state)})")
    for row in range(rows.state):
        t.store("%k", row, t.where(lanes, t.load("%k", rows.state + row), t.load("%k", row)))
    if event:
        t.lines.append("  call void @gauge(ptr %x, ptr %g)")
        t.store("%c", GAUGE, t.where(lanes, t.load("%g", 0), t.load("%c", GAUGE)))
    return "\n".join(t.lines)
