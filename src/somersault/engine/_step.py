"""A step of DOP853 for eight flights at once, as vector code.

Each lane has its own time, step and fate. A lane that finds a change of sign of the gauge in its
step searches for the place with the lengths of its next steps, while other lanes fly on.
"""

from __future__ import annotations

from dataclasses import dataclass

from somersault.engine import _dop853 as table
from somersault.engine._vectors import Loop, Vectors, number

# What the functions here are given: rows of memory that hold
BLOCK = "%x"  # the flights, as `Rows` orders them
TRIAL = "%z"  # the trial state, its time and the same parameters
CONTROL = "%c"  # what is below
SLOPES = "%k"  # slopes at the twelve stages, then at the end of the step
LIMIT = "%g"  # one row: what @gauge or @longest gives
LOOK = "%w"  # what @watch reads: `Rows.look`
SEEN = "%v"  # what @watch or @tick gives
MEMORY = (BLOCK, TRIAL, CONTROL, SLOPES, LIMIT, LOOK, SEEN)

# Rows of the control; the last two are the same in all lanes and at all times.
TIME, STEP, UNTIL, STATUS, STEPS, HELD_BACK = range(6)
GAUGE, LOW, HIGH, LOW_GAUGE, HIGH_GAUGE, TRIALS = range(6, 12)
TOLERANCE, MOST_STEPS = 12, 13
CONTROL_ROWS = 14

# Values of STATUS; the last two are never handed back.
FLYING, EVENT, TOO_MANY_STEPS, BROKEN, SEARCHING, EMPTY = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0

_SAFETY, _SHRINK, _GROW = 0.9, 0.2, 6.0
_SHORTEST = 1e-13  # of the time, or of a second: a step below this means the flight broke
_NEAR_ENOUGH = 1e-15  # of an event's time, or of a second
_MOST_TRIALS = 60.0  # of the search for an event


@dataclass(frozen=True)
class Rows:
    """How many rows a block has: `state`, then the time, then `parameters`, then `watched`.

    The last rows of the state are `carried`: they stay as they are but for ticks, at which each is
    given anew.
    """

    state: int
    parameters: int
    watched: int = 0
    carried: int = 0

    @property
    def moving(self) -> int:
        """Those of the state that are integrated."""
        return self.state - self.carried

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

    @property
    def memory(self) -> dict[str, int]:
        """Rows that each part of `MEMORY` needs."""
        sizes = (
            self.inputs, self.before_watched, CONTROL_ROWS, 13 * self.moving, 1, self.look,
            max(self.watched, self.carried, 1),
        )  # fmt: skip
        return dict(zip(MEMORY, sizes, strict=True))


def step(rows: Rows, event: bool) -> str:
    """LLVM text of `i8 step(MEMORY…)`: one step of every lane.

    It returns the lanes that stopped: at UNTIL, at an event, or failed. The first of the slopes
    is that of where a lane is. It calls @rhs, with `event` @gauge, and where there are watched
    rows @watch and @longest.
    """
    v = Vectors()
    time, status = v.load(CONTROL, TIME), v.load(CONTROL, STATUS)
    until, length = v.load(CONTROL, UNTIL), v.load(CONTROL, STEP)
    left = v.sub(until, time)
    flying = v.test("oeq", status, number(FLYING))
    if rows.watched:
        v.call("longest", BLOCK, LIMIT)
        length = v.least(length, v.load(LIMIT, 0))
    clipped = v.both(flying, v.test("oge", length, left))
    taken = v.where(flying, v.where(clipped, left, length), number(0.0))
    search = _Search(v, time, status) if event else None
    if search:
        taken = v.where(search.searching, search.middle, taken)
    _stages(v, rows, taken, time)
    squared = _error(v, rows.moving, taken)
    v.call("rhs", TRIAL, v.at(SLOPES, 12 * rows.moving))
    good = v.both(flying, v.test("ole", squared, number(1.0)))
    accepted = good
    if search:
        accepted, status = search.after(good, taken, status)
    _next_length(v, flying, good, clipped, squared, taken, length)
    # The last step lands on its end exactly, whatever rounding adds.
    arrived = v.where(clipped, until, v.add(time, taken))
    now = v.where(accepted, arrived, time)
    short_of_end = v.test("olt", now, until)
    status = _failed(v, time, status, flying, good, short_of_end)
    v.store(CONTROL, STATUS, status)
    if rows.watched:
        for row, value in enumerate(_watched(v, rows, time, arrived), rows.before_watched):
            v.store(BLOCK, row, v.where(accepted, value, v.load(BLOCK, row)))
    v.store(CONTROL, TIME, now)
    v.store(BLOCK, rows.state, now)
    for row in Loop(v, rows.moving):
        v.store(BLOCK, row, v.where(accepted, v.load(TRIAL, row), v.load(BLOCK, row)))
        last = v.load(SLOPES, row + 12 * rows.moving)
        v.store(SLOPES, row, v.where(accepted, last, v.load(SLOPES, row)))
    at_end = v.both(v.test("oeq", status, number(FLYING)), v.outside(short_of_end))
    over = v.both(v.test("ogt", status, number(FLYING)), v.test("olt", status, number(SEARCHING)))
    return v.function("step", MEMORY, result=v.packed(v.either(at_end, over)))


def _failed(v: Vectors, time: str, status: str, flying: str, good: str, short_of_end: str) -> str:
    """The status after a step, which counts, of lanes whose steps became too short or too many."""
    steps = v.load(CONTROL, STEPS)
    steps = v.where(flying, v.add(steps, number(1.0)), steps)
    v.store(CONTROL, STEPS, steps)
    size = v.greatest(v.size(time), number(1.0))
    short = v.test("olt", v.load(CONTROL, STEP), v.mul(size, number(_SHORTEST)))
    short = v.both(v.both(flying, v.outside(good)), short)
    status = v.where(short, number(BROKEN), status)
    # A flight that arrives with the last step allowed has not taken one too many.
    most = v.load(CONTROL, MOST_STEPS)
    full = v.both(v.test("oge", steps, most), short_of_end)
    full = v.both(v.test("oeq", status, number(FLYING)), v.either(full, v.test("ogt", steps, most)))
    return v.where(full, number(TOO_MANY_STEPS), status)


class _Search:
    """The search for an event by the lengths of whole steps, which have the full order of the
    method, so that nothing is interpolated: regula falsi in its Illinois form."""

    def __init__(self, v: Vectors, time: str, status: str) -> None:
        self._v, self._time = v, time
        self.searching = v.test("oeq", status, number(SEARCHING))
        self._low, self._high = v.load(CONTROL, LOW), v.load(CONTROL, HIGH)
        self._at_low, self._at_high = v.load(CONTROL, LOW_GAUGE), v.load(CONTROL, HIGH_GAUGE)
        across = v.sub(self._high, self._low)
        ratio = v.div(across, v.sub(self._at_high, self._at_low))
        secant = v.sub(self._high, v.mul(self._at_high, ratio))
        finite = v.test("olt", v.size(secant), number(float("inf")))
        half = v.mul(number(0.5), v.add(self._low, self._high))
        self.middle = v.where(finite, secant, half)

    def after(self, good: str, taken: str, status: str) -> tuple[str, str]:
        """Which lanes go on from the end of this step, and the status of all."""
        v = self._v
        before = v.load(CONTROL, GAUGE)
        v.call("gauge", TRIAL, LIMIT)
        gauge = v.load(LIMIT, 0)
        across = v.test("ole", v.mul(before, gauge), number(0.0))
        crossed = v.both(good, v.both(across, v.test("one", before, number(0.0))))
        same = v.test("ogt", v.mul(gauge, self._at_high), number(0.0))
        low = v.where(same, self._low, self._high)
        at_low = v.where(same, v.mul(number(0.5), self._at_low), self._at_high)
        trials = v.add(v.load(CONTROL, TRIALS), number(1.0))
        apart = v.size(v.sub(self.middle, low))
        near = v.mul(number(_NEAR_ENOUGH), v.add(number(1.0), self._time))
        done = v.test("ule", apart, near)
        done = v.either(done, v.test("ueq", gauge, number(0.0)))
        done = v.either(done, v.test("oge", trials, number(_MOST_TRIALS)))
        arrived = v.both(self.searching, done)
        zero = number(0.0)
        v.store(CONTROL, LOW, v.where(crossed, zero, low))
        v.store(CONTROL, LOW_GAUGE, v.where(crossed, before, at_low))
        v.store(CONTROL, HIGH, taken)
        v.store(CONTROL, HIGH_GAUGE, gauge)
        v.store(CONTROL, TRIALS, v.where(crossed, zero, trials))
        accepted = v.either(v.both(good, v.outside(crossed)), arrived)
        v.store(CONTROL, GAUGE, v.where(accepted, gauge, before))
        status = v.where(crossed, number(SEARCHING), status)
        return accepted, v.where(arrived, number(EVENT), status)


def _next_length(
    v: Vectors, flying: str, good: str, clipped: str, squared: str, taken: str, length: str
) -> None:
    """What step a lane will try next, into its control."""
    root = v.square_root(squared)
    eighth = v.square_root(v.square_root(v.square_root(root)))
    factor = v.div(number(_SAFETY), v.greatest(eighth, number(_SAFETY / _GROW)))
    sound = v.both(v.test("ord", squared, squared), v.test("oge", factor, number(_SHRINK)))
    factor = v.where(sound, factor, number(_SHRINK))
    # Not longer at once after a step that failed.
    held_back = v.test("ogt", v.load(CONTROL, HELD_BACK), number(0.0))
    factor = v.where(held_back, v.least(factor, number(1.0)), factor)
    wanted = v.mul(taken, factor)
    # A step cut short by the end says little about the next; keep the one before it.
    wanted = v.where(v.both(clipped, good), v.greatest(length, wanted), wanted)
    v.store(CONTROL, STEP, v.where(flying, wanted, length))
    v.store(CONTROL, HELD_BACK, v.indicator(v.both(flying, v.outside(good))))


def _watched(v: Vectors, rows: Rows, before: str, after: str) -> list[str]:
    """What is watched, after the step from the block to the trial between the two times."""
    state, moving, at = rows.state, rows.moving, 0
    for block, slopes in ((BLOCK, 0), (TRIAL, 12 * moving)):
        v.copy(LOOK, at, block, 0, state)
        v.copy(LOOK, at + state, SLOPES, slopes, moving)
        for row in range(moving, state):
            v.store(LOOK, at + state + row, number(0.0))
        at += 2 * state
    v.store(LOOK, at, before)
    v.store(LOOK, at + 1, after)
    v.copy(LOOK, at + 2, BLOCK, state + 1, rows.inputs - state - 1)
    v.call("watch", LOOK, SEEN)
    return [v.load(SEEN, row) for row in range(rows.watched)]


def _stages(v: Vectors, rows: Rows, step: str, time: str) -> None:
    """All twelve slopes (the first is there), and the new state in the trial."""
    moving = rows.moving
    for stage, weights in enumerate(table.STAGES, 1):
        _ahead(v, moving, step, weights)
        v.store(TRIAL, rows.state, v.multiply_add(number(table.NODES[stage]), step, time))
        v.call("rhs", TRIAL, v.at(SLOPES, stage * moving))
    _ahead(v, moving, step, table.WEIGHTS)
    v.store(TRIAL, rows.state, v.add(time, step))


def _ahead(v: Vectors, moving: int, step: str, weights: tuple[float, ...]) -> None:
    """y + h Σ weights · slopes, in the trial."""
    for row in Loop(v, moving):
        slopes = [v.load(SLOPES, row + j * moving) if w else "" for j, w in enumerate(weights)]
        ahead = v.multiply_add(step, v.weighted(weights, slopes), v.load(BLOCK, row))
        v.store(TRIAL, row, ahead)


def _error(v: Vectors, state: int, step: str) -> str:
    """Hairer's combined estimate over the tolerance, squared, from the block to the trial."""
    tolerance = v.load(CONTROL, TOLERANCE)
    sums = Loop(v, state, [number(0.0)] * 2)
    for row in sums:
        slopes = [v.load(SLOPES, row + j * state) for j in range(12)]
        size = v.greatest(v.size(v.load(BLOCK, row)), v.size(v.load(TRIAL, row)))
        scale = v.mul(tolerance, v.add(size, number(1.0)))
        one_over = v.div(number(1.0), scale)
        e5 = v.mul(v.weighted(table.ERROR_5, slopes), one_over)
        e3 = v.mul(v.weighted(table.ERROR_3, slopes), one_over)
        five, three = sums.totals
        sums.totals = [v.multiply_add(e5, e5, five), v.multiply_add(e3, e3, three)]
    five, three = sums.totals
    below = v.multiply_add(number(0.01), three, five)
    below = v.where(v.test("ueq", below, number(0.0)), number(1e-300), below)
    scaled = v.mul(v.mul(step, step), v.mul(five, five))
    return v.div(scaled, v.mul(below, number(float(state))))


def renew(rows: Rows, event: bool) -> str:
    """LLVM text of `void renew(MEMORY…, i8 lanes)`, which gives lanes the slope and the gauge of
    where they are."""
    v = Vectors()
    lanes = v.unpacked("%lanes")
    v.call("rhs", BLOCK, v.at(SLOPES, rows.moving))
    for row in Loop(v, rows.moving):
        new = v.load(SLOPES, row + rows.moving)
        v.store(SLOPES, row, v.where(lanes, new, v.load(SLOPES, row)))
    if event:
        v.call("gauge", BLOCK, LIMIT)
        v.store(CONTROL, GAUGE, v.where(lanes, v.load(LIMIT, 0), v.load(CONTROL, GAUGE)))
    return v.function("renew", MEMORY, mask="%lanes")


def carry(rows: Rows) -> str:
    """LLVM text of `void carry(MEMORY…, i8 lanes)`, which gives lanes what @tick makes of where
    they are for what they carry."""
    v = Vectors()
    lanes = v.unpacked("%lanes")
    v.call("tick", BLOCK, SEEN)
    for k in range(rows.carried):
        row = rows.moving + k
        value = v.where(lanes, v.load(SEEN, k), v.load(BLOCK, row))
        for block in (BLOCK, TRIAL):
            v.store(block, row, value)
    return v.function("carry", MEMORY, mask="%lanes")
