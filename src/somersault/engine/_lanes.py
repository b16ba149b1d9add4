"""Which flight is in which lane, as LLVM text: a lane whose flight is over takes the next one.

Flights stand in rows and are taken from a queue that all threads share, so no lane waits for a
slower neighbour and no thread for another. Which lane flies a flight does not show in it.
"""

from __future__ import annotations

from somersault.engine import _step as one
from somersault.engine._llvm import HEADER, LANES, VECTOR, number
from somersault.engine._step import Rows

# Places in a job, of eight bytes each.
(
    FIRST, STILL, STILL_BY, TABLE, TABLE_BY, ENDS, ENDS_BY, SAMPLES, SAMPLES_BY, OUT, LAST, NEXT,
    COUNT, SAMPLE_COUNT, PIECES, TOLERANCE, LIMIT, FIRST_STEP,
) = range(18)  # fmt: skip
JOB = 18
LAST_MORE = 3  # of a row of LAST, after the outputs: time, status, steps

_SLOPE, _EMPTY = 1, 2  # what serving a lane leaves to be done


def module(equations: str, rows: Rows, changing: int, event: bool) -> str:
    """LLVM text with `fly(job)`.

    `equations` defines @rhs(x, dy); with `event`, @gauge(x, g); and where there are watched rows
    @watch(look, watched), called after each step that counts with the rows of `Rows.look`, and
    @longest(x, step), which bounds a step so that nothing is missed between its ends.

    A job is an array of addresses and numbers. FIRST (COUNT, outputs) has states and watched rows
    at time 0; the first `changing` parameters of flight i, piece p are TABLE[i · TABLE_BY + p ·
    changing …] until ENDS[i · ENDS_BY + p], the others STILL[i · STILL_BY …]. OUT (COUNT,
    SAMPLE_COUNT, outputs) receives what there is at each of SAMPLES[i · SAMPLES_BY …], or was at
    the end of a flight that ended before, and LAST (COUNT, outputs + 3) what there is at the end,
    when that was, the status and the steps. NEXT is the flight that is next, and the only thing
    that threads share.
    """
    return "\n".join(
        [HEADER, equations, _COPY, _parameters(rows, changing), _keep(rows), _serve(rows),
         _fly(rows, event)]
    )  # fmt: skip


def _job(name: str, place: int, kind: str = "i64") -> str:
    return f"""
  %{name}.at = getelementptr i64, ptr %job, i64 {place}
  %{name} = load {kind}, ptr %{name}.at"""


# count numbers from one place to another, a lane's numbers being 8 apart and a row's 1
_COPY = """
define internal void @copy(ptr %to, i64 %toby, ptr %from, i64 %fromby, i64 %count) {
entry:
  %none = icmp sle i64 %count, 0
  br i1 %none, label %done, label %again
again:
  %i = phi i64 [ 0, %entry ], [ %n, %again ]
  %f = mul i64 %i, %fromby
  %t = mul i64 %i, %toby
  %fp = getelementptr double, ptr %from, i64 %f
  %tp = getelementptr double, ptr %to, i64 %t
  %value = load double, ptr %fp
  store double %value, ptr %tp
  %n = add i64 %i, 1
  %over = icmp sge i64 %n, %count
  br i1 %over, label %done, label %again
done:
  ret void
}
"""


def _parameters(rows: Rows, changing: int) -> str:
    """still(…): a flight's lasting parameters into its lane; piece(…): those of a piece."""

    def into(to: str, row: int) -> str:
        return f"""
  %{to}.row = getelementptr double, ptr %{to}, i64 {row * LANES}
  %{to}.to = getelementptr double, ptr %{to}.row, i64 %lane"""

    def copied(to: str, count: int) -> str:
        return f"""
  call void @copy(ptr %{to}.to, i64 {LANES}, ptr %from, i64 1, i64 {count})"""

    ahead, still = rows.state + 1, rows.parameters - changing
    return f"""
define internal void @still(ptr %job, ptr %x, ptr %z, i64 %lane, i64 %flight) {{
{_job("still", STILL, "ptr")}{_job("by", STILL_BY)}
  %offset = mul i64 %flight, %by
  %from = getelementptr double, ptr %still, i64 %offset
{into("x", ahead + changing)}{into("z", ahead + changing)}
{copied("x", still)}{copied("z", still)}
  ret void
}}

define internal void @piece(ptr %job, ptr %x, ptr %z, i64 %lane, i64 %flight, i64 %piece) {{
{_job("table", TABLE, "ptr")}{_job("by", TABLE_BY)}
  %row = mul i64 %flight, %by
  %within = mul i64 %piece, {changing}
  %offset = add i64 %row, %within
  %from = getelementptr double, ptr %table, i64 %offset
{into("x", ahead)}{into("z", ahead)}
{copied("x", changing)}{copied("z", changing)}
  ret void
}}
"""


def _keep(rows: Rows) -> str:
    """keep(…): what a lane hands back, into a row; show(…): into the one of a sample."""
    return f"""
define internal void @keep(ptr %x, i64 %lane, ptr %to) {{
  %state = getelementptr double, ptr %x, i64 %lane
  call void @copy(ptr %to, i64 1, ptr %state, i64 {LANES}, i64 {rows.state})
  %after = getelementptr double, ptr %to, i64 {rows.state}
  %watched.row = getelementptr double, ptr %x, i64 {rows.before_watched * LANES}
  %watched = getelementptr double, ptr %watched.row, i64 %lane
  call void @copy(ptr %after, i64 1, ptr %watched, i64 {LANES}, i64 {rows.watched})
  ret void
}}

define internal void @show(ptr %job, ptr %x, i64 %lane, i64 %flight, i64 %sample) {{
{_job("out", OUT, "ptr")}{_job("k", SAMPLE_COUNT)}
  %row = mul i64 %flight, %k
  %at = add i64 %row, %sample
  %place = mul i64 %at, {rows.outputs}
  %to = getelementptr double, ptr %out, i64 %place
  call void @keep(ptr %x, i64 %lane, ptr %to)
  ret void
}}
"""


def _serve(rows: Rows) -> str:
    """serve(…): see to a lane that stopped; tells what is left to be done for it."""
    own = "\n".join(
        f"  %{name}.row = getelementptr double, ptr %c, i64 {row * LANES}\n"
        f"  %{name}.p = getelementptr double, ptr %{name}.row, i64 %lane"
        for name, row in (
            ("time", one.TIME), ("step", one.STEP), ("until", one.UNTIL), ("status", one.STATUS),
            ("steps", one.STEPS), ("held", one.HELD_BACK),
        )
    )  # fmt: skip
    last = rows.outputs + LAST_MORE
    return f"""
define internal i64 @serve(
    ptr %job, ptr %x, ptr %z, ptr %c, ptr %who, ptr %pieces, ptr %samples, i64 %lane) {{
entry:
{own}
  %who.p = getelementptr i64, ptr %who, i64 %lane
  %piece.p = getelementptr i64, ptr %pieces, i64 %lane
  %sample.p = getelementptr i64, ptr %samples, i64 %lane
  %left = alloca i64
  store i64 0, ptr %left
{_job("when", SAMPLES, "ptr")}{_job("whenby", SAMPLES_BY)}{_job("k", SAMPLE_COUNT)}
{_job("ends", ENDS, "ptr")}{_job("endsby", ENDS_BY)}{_job("p", PIECES)}
  %status = load double, ptr %status.p
  %empty = fcmp oeq double %status, {_scalar(one.EMPTY)}
  br i1 %empty, label %fetch, label %look
look:
  %flying = fcmp oeq double %status, {_scalar(one.FLYING)}
  br i1 %flying, label %sample, label %finish

sample:
  %flight = load i64, ptr %who.p
  %time = load double, ptr %time.p
  %s = load i64, ptr %sample.p
  %some = icmp slt i64 %s, %k
  br i1 %some, label %due, label %ending
due:
  %ts.row = mul i64 %flight, %whenby
  %ts.place = add i64 %ts.row, %s
  %ts.p = getelementptr double, ptr %when, i64 %ts.place
  %ts = load double, ptr %ts.p
  %reached = fcmp oge double %time, %ts
  br i1 %reached, label %show, label %ending
show:
  call void @show(ptr %job, ptr %x, i64 %lane, i64 %flight, i64 %s)
  %s.next = add i64 %s, 1
  store i64 %s.next, ptr %sample.p
  br label %sample

ending:
  %sample.time = phi double [ {_scalar(float("inf"))}, %sample ], [ %ts, %due ]
  %piece = load i64, ptr %piece.p
  %ends.row = mul i64 %flight, %endsby
  %ends.place = add i64 %ends.row, %piece
  %end.p = getelementptr double, ptr %ends, i64 %ends.place
  %end = load double, ptr %end.p
  %over = fcmp oge double %time, %end
  br i1 %over, label %following, label %go
following:
  %piece.next = add i64 %piece, 1
  %final = icmp sge i64 %piece.next, %p
  br i1 %final, label %finish, label %change
change:
  store i64 %piece.next, ptr %piece.p
  call void @piece(ptr %job, ptr %x, ptr %z, i64 %lane, i64 %flight, i64 %piece.next)
  store i64 {_SLOPE}, ptr %left
  br label %sample
go:
  %sooner = fcmp olt double %sample.time, %end
  %until = select i1 %sooner, double %sample.time, double %end
  store double %until, ptr %until.p
  %done = load i64, ptr %left
  ret i64 %done

finish:
  %whose = load i64, ptr %who.p
  %s.now = load i64, ptr %sample.p
  br label %rest
rest:
  %r = phi i64 [ %s.now, %finish ], [ %r.next, %fill ]
  %more = icmp slt i64 %r, %k
  br i1 %more, label %fill, label %final.row
fill:
  call void @show(ptr %job, ptr %x, i64 %lane, i64 %whose, i64 %r)
  %r.next = add i64 %r, 1
  br label %rest
final.row:
{_job("last", LAST, "ptr")}
  %last.place = mul i64 %whose, {last}
  %last.to = getelementptr double, ptr %last, i64 %last.place
  call void @keep(ptr %x, i64 %lane, ptr %last.to)
  %told = getelementptr double, ptr %last.to, i64 {rows.outputs}
  call void @copy(ptr %told, i64 1, ptr %time.p, i64 0, i64 1)
  %told.1 = getelementptr double, ptr %told, i64 1
  call void @copy(ptr %told.1, i64 1, ptr %status.p, i64 0, i64 1)
  %told.2 = getelementptr double, ptr %told, i64 2
  call void @copy(ptr %told.2, i64 1, ptr %steps.p, i64 0, i64 1)
  br label %fetch

fetch:
{_job("next", NEXT, "ptr")}{_job("count", COUNT)}
  %new = atomicrmw add ptr %next, i64 1 monotonic
  %there = icmp slt i64 %new, %count
  br i1 %there, label %load, label %none
none:
  store double {_scalar(one.EMPTY)}, ptr %status.p
  ret i64 {_EMPTY}
load:
  store i64 %new, ptr %who.p
  store i64 0, ptr %piece.p
  store i64 0, ptr %sample.p
{_job("first", FIRST, "ptr")}
  %first.place = mul i64 %new, {rows.outputs}
  %from = getelementptr double, ptr %first, i64 %first.place
  %x.to = getelementptr double, ptr %x, i64 %lane
  call void @copy(ptr %x.to, i64 {LANES}, ptr %from, i64 1, i64 {rows.state})
  %watched.from = getelementptr double, ptr %from, i64 {rows.state}
  %watched.row = getelementptr double, ptr %x, i64 {rows.before_watched * LANES}
  %watched.to = getelementptr double, ptr %watched.row, i64 %lane
  call void @copy(ptr %watched.to, i64 {LANES}, ptr %watched.from, i64 1, i64 {rows.watched})
  %clock.row = getelementptr double, ptr %x, i64 {rows.state * LANES}
  %clock = getelementptr double, ptr %clock.row, i64 %lane
  store double 0.0, ptr %clock
  call void @still(ptr %job, ptr %x, ptr %z, i64 %lane, i64 %new)
  call void @piece(ptr %job, ptr %x, ptr %z, i64 %lane, i64 %new, i64 0)
{_job("begin", FIRST_STEP, "double")}
  store double 0.0, ptr %time.p
  store double %begin, ptr %step.p
  store double {_scalar(one.FLYING)}, ptr %status.p
  store double 0.0, ptr %steps.p
  store double 0.0, ptr %held.p
  store i64 {_SLOPE}, ptr %left
  br label %sample
}}
"""


def _scalar(value: float) -> str:
    return number(value).rpartition(" ")[2].rstrip(">")


def _fly(rows: Rows, event: bool) -> str:
    """fly(job): the flights of the queue, eight at a time, until there are none."""
    step, stopped = one.step(rows, event, "%tolerance", "%limit")
    all_lanes = (1 << LANES) - 1
    return f"""
define void @fly(ptr %job) #0 {{
entry:
{_memory(rows)}
{_job("bound", TOLERANCE, "double")}{_splat("tolerance", "%bound")}
{_job("most", LIMIT, "double")}{_splat("limit", "%most")}
  br label %serving

advance:
{step}
  %any = icmp ne i{LANES} {stopped}, 0
  br i1 %any, label %serving, label %advance

serving:
  %bits = phi i{LANES} [ {all_lanes}, %entry ], [ {stopped}, %advance ]
  br label %lane
lane:
  %l = phi i64 [ 0, %serving ], [ %l.next, %next ]
  %fresh = phi i{LANES} [ 0, %serving ], [ %fresh.next, %next ]
  %l.bits = trunc i64 %l to i{LANES}
  %shifted = lshr i{LANES} %bits, %l.bits
  %stands = trunc i{LANES} %shifted to i1
  br i1 %stands, label %serve, label %next
serve:
  %left = call i64 @serve(
    ptr %job, ptr %x, ptr %z, ptr %c, ptr %who, ptr %pieces, ptr %samples, i64 %l)
  %wants = icmp eq i64 %left, {_SLOPE}
  %one = zext i1 %wants to i{LANES}
  %bit = shl i{LANES} %one, %l.bits
  %fresh.more = or i{LANES} %fresh, %bit
  %gone = icmp eq i64 %left, {_EMPTY}
  br i1 %gone, label %leave, label %next
leave:
  %before = load i64, ptr %active
  %after = sub i64 %before, 1
  store i64 %after, ptr %active
  br label %next
next:
  %fresh.next = phi i{LANES} [ %fresh, %lane ], [ %fresh.more, %serve ], [ %fresh.more, %leave ]
  %l.next = add i64 %l, 1
  %again = icmp slt i64 %l.next, {LANES}
  br i1 %again, label %lane, label %served
served:
  %flying = load i64, ptr %active
  %over = icmp eq i64 %flying, 0
  br i1 %over, label %finished, label %slopes
slopes:
  %needed = icmp ne i{LANES} %fresh.next, 0
  br i1 %needed, label %renew, label %advance
renew:
{one.renewed(rows, event, "%fresh.next")}
  br label %advance

finished:
  ret void
}}
"""


def _memory(rows: Rows) -> str:
    """Room for a block of flights, with nothing in any lane."""
    sizes = {
        "x": rows.inputs, "z": rows.before_watched, "c": one.CONTROL_ROWS, "k": 13 * rows.state,
        "g": 1, "w": rows.look, "v": max(rows.watched, 1),
    }  # fmt: skip
    room = [
        f"  %{name} = alloca [{count * LANES} x double], align 64" for name, count in sizes.items()
    ]
    room += [f"  %{name} = alloca [{LANES} x i64]" for name in ("who", "pieces", "samples")]
    room += ["  %zero = alloca double", "  store double 0.0, ptr %zero"]
    room += [
        f"  call void @copy(ptr %{name}, i64 1, ptr %zero, i64 0, i64 {sizes[name] * LANES})"
        for name in ("x", "z", "c", "k")
    ]
    room += [
        f"  %empty = getelementptr double, ptr %c, i64 {one.STATUS * LANES}",
        f"  store {VECTOR} {number(one.EMPTY)}, ptr %empty, align 64",
        f"  %active = alloca i64\n  store i64 {LANES}, ptr %active",
    ]
    return "\n".join(room)


def _splat(name: str, value: str) -> str:
    lanes = ", ".join(["i32 0"] * LANES)
    return f"""
  %{name}.1 = insertelement {VECTOR} poison, double {value}, i32 0
  %{name} = shufflevector {VECTOR} %{name}.1, {VECTOR} poison, <{LANES} x i32> <{lanes}>"""
