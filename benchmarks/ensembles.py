"""Ensembles: time, memory, what goes on beside the integration, and what dask adds.

    python benchmarks/ensembles.py [PART ...] [--flights 1000000] [--large 10000000]

Parts: lifetimes, large, outside, cluster, start; all but `large` where none is named. See
README.md beside this file for what each number means.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import machine
import numpy as np

import somersault as so
from somersault.engine import Integrator, cores, use_threads
from somersault.ensembles import Plan, _cluster, _store, carried_out, plan
from somersault.ensembles._begin import create
from somersault.ensembles._carried_out import chunk_size
from somersault.ensembles._chunks import chunked
from somersault.ensembles._seals import Seals
from somersault.flight import JointTakeoff, Takeoff, flights
from somersault.stability import spin as steady_spin

SPIN, TURNS = 8.64, 8  # rad/s; somersaults of a layout flight
DURATION = TURNS * 2 * np.pi / SPIN
GRID = 20  # arm angles, and stiffnesses
TINY = 64  # flights of a chunk that is mostly overhead
PARTS = ("lifetimes", "outside", "cluster", "start", "large")
SPEC = """
model = "furrer"
duration = 1.0
[takeoff]
spin = 8.64
[vary.leant]
adds_to = "takeoff.tilt"
normal = [0.0, 0.05]
[sample]
size = 1000
"""


def lifetimes(count: int) -> Plan:
    """Figure 4-12 with a scatter of tilt and twist at every point: about so many flights."""
    size = max(1, round(count / GRID**2))
    inertia = steady_spin("furrer", 2, {"shoulder": 1.4}).outboard_inertias["left_shoulder"]
    vary = {
        "arm_angle": so.Vary(
            sets="joints.shoulder.angle", values={"from": 0.4, "to": 2.2, "count": GRID}
        ),
        "K_sh": so.Vary(
            sets="joints.shoulder.stiffness", values={"from": 0.0, "to": 1.8, "count": GRID},
            scale=SPIN**2 * inertia,
        ),
        "leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.02]),
        "turned": so.Vary(adds_to="takeoff.twist", normal=[0.0, 0.02]),
    }  # fmt: skip
    joint = JointTakeoff("sprung", angle=1.4, stiffness=30.0, hold=True)
    takeoff = Takeoff(tilt=0.01, spin=SPIN, joints={"shoulder": joint})
    many = flights(
        "furrer", takeoff, DURATION, report=["somersaults", "tilt", "twist"],
        until="quarter twist",
    )  # fmt: skip
    return plan(many, vary, size, seed=1, sequence="sobol")


def load() -> str:
    """Load of the machine, as text."""
    averages = machine.load()
    return f"{averages[0]:.1f}" if averages else "unknown"


def size_of(store: Path) -> tuple[int, int]:
    """Bytes and files of a store."""
    sizes = [f.stat().st_size for f in store.rglob("*") if f.is_file()]
    return sum(sizes), len(sizes)


# ----------------------------------------------------------------- time and memory of a whole


def in_child(count: int, store: Path, *more: str) -> dict[str, Any]:
    """A whole ensemble in a process of its own: wall and processor seconds, peak memory."""
    before = load()
    done = subprocess.run(
        [sys.executable, __file__, "--child", str(store), "--flights", str(count), *more],
        stdout=subprocess.PIPE, check=True, text=True,
    )  # fmt: skip
    total, files = size_of(store)
    return json.loads(done.stdout) | {
        "bytes": total, "files": files, "load_before": before, "load_after": load(),
    }  # fmt: skip


def child(count: int, store: Path, threads: int | None) -> None:
    """Fly an ensemble into a store and print what it took as JSON."""
    import resource

    made = lifetimes(count)
    begun, busy = time.perf_counter(), time.process_time()
    carried_out(made, store, threads=threads)
    taken, busy = time.perf_counter() - begun, time.process_time() - busy
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    found = so.Ensemble.open(store).dataset
    ended = found["ended"].values
    print(json.dumps({
        "flights": made.count, "seconds": taken, "processor_seconds": busy,
        "peak_bytes": peak * (1 if sys.platform == "darwin" else 1024),
        "chunk": chunked(made.dims, chunk_size(made)).size(0),
        "failed": int((ended >= 2).sum()), "to_the_end": float((ended == 0).mean()),
        "mean_time": float(found["time"].mean()), "mean_steps": float(found["steps"].mean()),
    }))  # fmt: skip


def one_by_one(count: int = 200) -> dict[str, float]:
    """Seconds a flight of some of the same flights by `so.fly`, warm, and by `ensemble`."""
    made = lifetimes(GRID**2 * 50)
    places = np.linspace(0, made.count - 1, count).astype(int)
    given = made.varied(0, made.count)
    scale = made.vary["K_sh"].scale
    starts = []
    for k in places:
        joint = JointTakeoff(
            "sprung", angle=given["arm_angle"][k], stiffness=scale * given["K_sh"][k], hold=True
        )
        starts.append(
            Takeoff(
                tilt=0.01 + given["leant"][k], twist=given["turned"][k], spin=SPIN,
                joints={"shoulder": joint},
            )
        )  # fmt: skip

    def fly(start: Takeoff) -> float:
        flown = so.fly("furrer", start, DURATION, accuracy=1e-7, until="quarter twist", samples=2)
        return float(flown.times[-1])

    fly(starts[0])
    busy = time.thread_time()
    with use_threads(1):
        ends = [fly(start) for start in starts]
    alone = (time.thread_time() - busy) / count
    made.run(0, 1)
    busy = time.thread_time()
    with use_threads(1):
        rows = made.run(0, made.count)
    together = (time.thread_time() - busy) / made.count
    # Flights are the same; what `fly` samples is landed on by a shorter step.
    assert np.allclose(rows["time"][places], ends, atol=1e-4), "not the same flights"
    return {"fly": alone, "ensemble": together, "ratio": alone / together}


# --------------------------------------------------------------- beside the integration


class Stopwatch:
    """Processor seconds inside some functions, with those of zarr's thread."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    def around(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        self.seconds.setdefault(name, 0.0)

        def timed(*given: Any, **named: Any) -> Any:
            begun = time.process_time()
            try:
                return function(*given, **named)
            finally:
                self.seconds[name] += time.process_time() - begun

        return timed


def outside(count: int, folder: Path, most: int = 4) -> dict[str, float]:
    """Shares of chunks of the default size, flown and written in one thread."""
    made = lifetimes(count)
    chunks = chunked(made.dims, chunk_size(made))
    store = folder / "outside.zarr"
    create(store, made, chunks)
    made.run(0, 8)  # compiles
    watch, engine = Stopwatch(), made.simulation.batch.system.integrator
    engine.__dict__["_fly"] = watch.around("machine code", engine._fly)
    plain = Integrator.solve
    Integrator.solve = watch.around("solve", plain)  # type: ignore[method-assign]
    write, seal = watch.around("written", _store.write), Seals.seal
    Seals.seal = watch.around("sealed", seal)  # type: ignore[method-assign]
    # Chunks spread over the map: some fall early, some last.
    which = np.linspace(0, len(chunks) - 1, min(most, len(chunks))).astype(int)
    begun = time.process_time()
    try:
        with use_threads(1):
            for k in which:
                write(store, made, chunks, int(k), made.run(*chunks.runs(int(k))))
    finally:
        Integrator.solve, Seals.seal = plain, seal  # type: ignore[method-assign]
        del engine.__dict__["_fly"]
    whole = time.process_time() - begun
    flown = sum(chunks.size(int(k)) for k in which)
    return {
        "chunk": chunks.size(0), "chunks": len(which), "seconds_a_chunk": whole / len(which),
        "seconds_a_flight": whole / flown,
        "outside_machine_code": 1 - watch.seconds["machine code"] / whole,
        "outside_solve": 1 - watch.seconds["solve"] / whole,
        "writing": watch.seconds["written"] / whole,
        "sealing": watch.seconds["sealed"] / whole,
        "written_seconds_a_chunk": watch.seconds["written"] / len(which),
    }  # fmt: skip


# ----------------------------------------------------------------------------- on dask


@contextmanager
def dask(workers: int) -> Iterator[tuple[Any, Any, list[Any]]]:
    """A client of a scheduler with workers of one thread: it, and their processes."""
    import psutil
    from distributed import Client

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
    shell = [sys.executable, "-m", "dask"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    host, port = address.split(":")
    begun = [
        psutil.Popen(
            [*shell, "scheduler", "--host", host, "--port", port, "--no-dashboard", "--no-show"],
            **quiet,
        )
    ]
    more = ["--nthreads", "1", "--no-dashboard", "--local-directory", tempfile.gettempdir()]
    try:
        begun += [
            psutil.Popen([*shell, "worker", f"tcp://{address}", *more], **quiet)
            for _ in range(workers)
        ]
        with Client(f"tcp://{address}", timeout=60) as client:
            client.wait_for_workers(workers, timeout=60)
            pids = client.run(os.getpid)
            yield client, begun[0], [psutil.Process(pid) for pid in pids.values()]
    finally:
        for process in begun:
            for own in (*process.children(recursive=True), process):
                own.kill()
            process.wait()


def _seconds(processes: list[Any]) -> float:
    """Processor seconds of processes."""
    return sum(sum(p.cpu_times()[:2]) for p in processes)


def _wanted(processes: list[Any]) -> dict[str, float]:
    """Seconds that each thread ran or waited for a processor that others had; Linux only."""
    found = {}
    for p in processes:
        for file in Path(f"/proc/{p.pid}/task").glob("*/schedstat"):
            ran, waited, _ = file.read_text().split()
            found[f"{p.pid}/{file.parent.name}"] = (int(ran) + int(waited)) * 1e-9
    return found


def _busy(before: dict[str, float], after: dict[str, float], seconds: float) -> float | None:
    """The share of the time in which the busiest thread of each worker had something to do."""
    most: dict[str, float] = {}
    for name, value in after.items():
        who = name.partition("/")[0]
        most[who] = max(most.get(who, 0.0), value - before.get(name, 0.0))
    return sum(most.values()) / len(most) / seconds if most else None


def on_dask(workers: int, made: Plan, most: int, count: int, store: Path, seen: bool) -> dict:
    """Some chunks of at most so many flights on warm workers of one thread each.

    `seen`: the workers write into the store. Otherwise rows travel back, and the program writes.
    """
    chunks = chunked(made.dims, most)
    create(store, made, chunks)
    path = str(store) if seen else None

    def put(k: int, rows: Any) -> None:
        _store.write(store, made, chunks, k, rows)

    with dask(workers) as (client, scheduler, theirs), _cluster._unlogged():
        shared = client.scatter(made, broadcast=True, hash=False)
        client.run(_warm, made)
        which = np.linspace(0, len(chunks) - 1, min(count, len(chunks))).astype(int).tolist()
        before, own = _seconds(theirs), time.process_time()
        governed, wanted = _seconds([scheduler]), _wanted(theirs)
        begun = time.perf_counter()
        for _ in _cluster._as_done(client, shared, chunks, which, put, path, 1, made.versions):
            pass
        taken = time.perf_counter() - begun
        own, used = time.process_time() - own, _seconds(theirs) - before
        governed = _seconds([scheduler]) - governed
        busy = _busy(wanted, _wanted(theirs), taken)
    flown = sum(chunks.size(k) for k in which)
    return {
        "workers": workers, "chunk": chunks.size(0), "chunks": len(which), "flights": flown,
        "seconds": taken, "seconds_a_chunk": taken / len(which), "busy": busy,
        "program": own / len(which), "scheduler": governed / len(which),
        "workers_processor": used / len(which), "bytes_a_chunk": size_of(store)[0] / len(which),
    }  # fmt: skip


def _warm(made: Plan) -> None:
    made.run(0, 8)


def cluster(count: int, folder: Path, most: int, rounds: int) -> dict[str, Any]:
    """What dask adds to a chunk, and one worker against two."""
    made = lifetimes(count)
    found: dict[str, Any] = {}
    tiny = lifetimes(GRID**2 * TINY)
    chunks = chunked(tiny.dims, TINY)
    which = np.linspace(0, len(chunks) - 1, 16 * most).astype(int).tolist()
    tiny.run(0, 8)
    with use_threads(1):
        begun = time.thread_time()
        for k in which:
            tiny.run(*chunks.runs(k))
        found["tiny_flown"] = (time.thread_time() - begun) / len(which)
    for seen in (True, False):
        name = "tiny_seen" if seen else "tiny_not_seen"
        found[name] = on_dask(1, tiny, TINY, 16 * most, folder / f"{name}.zarr", seen)
    for k in range(rounds):
        for workers in (1, 2):
            store = folder / f"w{workers}{k}.zarr"
            one = on_dask(workers, made, chunk_size(made), most, store, True)
            found.setdefault(f"workers_{workers}", []).append(one | {"load": load()})
    one = on_dask(1, made, chunk_size(made), max(2, most // 4), folder / "far.zarr", False)
    found["far"] = one
    return found


# ---------------------------------------------------------------------------- starting


def start(folder: Path, repeats: int = 7) -> dict[str, float]:
    """Seconds of the command that prints its help, and of one that finds all done."""
    spec, store = folder / "small.toml", folder / "small.zarr"
    spec.write_text(SPEC)
    shell = [sys.executable, "-m", "somersault", "ensemble"]
    work = [*shell, str(spec), "--out", str(store)]
    subprocess.run(work, check=True, stdout=subprocess.DEVNULL)

    def seconds(command: list[str]) -> float:
        taken = []
        for _ in range(repeats):
            begun = time.perf_counter()
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            taken.append(time.perf_counter() - begun)
        return min(taken)

    return {"help": seconds([*shell, "--help"]), "finished": seconds(work)}


# --------------------------------------------------------------------------- the table


def _line(name: str, row: dict[str, Any]) -> str:
    each = 1e6 / row["flights"]
    return (
        f"{name}: {row['flights']:,} flights, {row['mean_time']:.2f} s and {row['mean_steps']:.0f} "
        f"steps a flight, {100 * row['to_the_end']:.0f} % to the end, {row['failed']} failed\n"
        f"  {row['seconds']:.1f} s, {row['seconds'] * each:.1f} us a flight (load "
        f"{row['load_before']} before, {row['load_after']} after); of processors "
        f"{row['processor_seconds']:.1f} s, {row['processor_seconds'] * each:.1f} us a flight\n"
        f"  chunks of {row['chunk']:,}; store {row['bytes'] / 1e6:.1f} MB in {row['files']} files; "
        f"peak memory {row['peak_bytes'] / 2**20:.0f} MiB"
    )


def _print_cluster(row: dict[str, Any]) -> None:
    flown = row["tiny_flown"] * 1e3
    print(f"chunks of {row['tiny_seen']['chunk']} on one worker; {flown:.1f} ms of flying:")
    for name, what in (("tiny_seen", "worker writes"), ("tiny_not_seen", "rows travel back")):
        one = row[name]
        whole = one["seconds_a_chunk"] * 1e3
        print(f"  {what}: {whole:.1f} ms a chunk, {whole - flown:.1f} ms added; {_shares(one)}")
    for workers in (1, 2):
        for one in row[f"workers_{workers}"]:
            print(
                f"  workers {workers}, {one['chunks']} chunks of {one['chunk']:,}: "
                f"{one['flights'] / one['seconds']:,.0f} flights/s (load {one['load']}), "
                f"{one['workers_processor'] / one['chunk'] * 1e6:.1f} us of a processor a flight, "
                f"{one['bytes_a_chunk'] / 1e6:.2f} MB a chunk; {_shares(one)}"
            )
    one = row["far"]
    print(f"  rows of {one['chunk']:,} travelling back: {_shares(one)}")
    print(f"  two workers over one: {_ratio(row)}")


def _shares(one: dict[str, Any]) -> str:
    names = {"worker": "workers_processor", "program": "program", "scheduler": "scheduler"}
    told = ", ".join(f"{name} {one[key] * 1e3:.1f}" for name, key in names.items())
    return f"ms of processors a chunk: {told}"


def _ratio(row: dict[str, Any]) -> str:
    """Two workers over one, by the clock and as if both cores had been free."""

    def middle(of: Callable[[dict[str, Any]], float]) -> list[float]:
        return [statistics.median(map(of, row[f"workers_{n}"])) for n in (1, 2)]

    rate = middle(lambda r: r["flights"] / r["seconds"])
    told = f"{rate[1] / rate[0]:.2f} by the clock"
    if row["workers_1"][0]["busy"] is None:
        return told
    busy, cost = middle(lambda r: r["busy"]), middle(lambda r: r["workers_processor"])
    free = 2 * cost[0] / cost[1] * busy[1] / busy[0]
    return (
        f"{told}; two had work {100 * busy[1]:.0f} % of the time, one {100 * busy[0]:.0f} %, and a "
        f"flight took {cost[1] / cost[0]:.2f} times the processor: {free:.2f} were both free"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS))
    parser.add_argument("--flights", type=int, default=1_000_000, help="of lifetimes")
    parser.add_argument("--large", type=int, default=10_000_000, help="flights of `large`")
    parser.add_argument("--chunks", type=int, default=12, help="that workers are timed over")
    parser.add_argument("--rounds", type=int, default=3, help="of one and two workers in turn")
    parser.add_argument("--threads", type=int, help="of lifetimes and large")
    parser.add_argument("--json", type=Path, help="write the numbers here as well")
    parser.add_argument("--child", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child is not None:
        child(options.flights, options.child, options.threads)
        return
    for part in options.parts:
        if part not in PARTS:
            parser.error(f"no part is called {part!r}; there are {', '.join(PARTS)}")
    parts = options.parts or [part for part in PARTS if part != "large"]
    print(f"{cores()} cores; load of the machine before: {load()}", flush=True)
    more = [] if options.threads is None else ["--threads", str(options.threads)]
    report: dict[str, Any] = {"cores": cores(), "load_before": load()}
    folder = Path(tempfile.mkdtemp(prefix="somersault-ensembles-"))
    try:
        for part in parts:
            if part in ("lifetimes", "large"):
                count = options.flights if part == "lifetimes" else options.large
                row = in_child(count, folder / f"{part}.zarr", *more)
                print(_line(part, row), flush=True)
                if part == "lifetimes":
                    row["one by one"] = one = one_by_one()
                    print(
                        f"  us of a processor a flight: by `so.fly` {one['fly'] * 1e6:,.0f}, "
                        f"in an ensemble {one['ensemble'] * 1e6:.1f}; {one['ratio']:.0f} times",
                        flush=True,
                    )  # fmt: skip
                shutil.rmtree(folder / f"{part}.zarr")
            elif part == "outside":
                row = outside(options.flights, folder)
                print(
                    f"outside: of {row['chunks']} chunks of {row['chunk']:,} in one thread, "
                    f"{row['seconds_a_flight'] * 1e6:.1f} us a flight: "
                    f"{100 * row['outside_machine_code']:.1f} % outside machine code, "
                    f"{100 * row['outside_solve']:.1f} % outside `Integrator.solve`; writing "
                    f"{100 * row['writing']:.1f} %, of which seals "
                    f"{100 * row['sealing']:.1f} %, {row['written_seconds_a_chunk'] * 1e3:.0f} ms "
                    f"a chunk (aim: less than 5 %); load {load()}",
                    flush=True,
                )
            elif part == "cluster":
                row = cluster(options.flights, folder, options.chunks, options.rounds)
                _print_cluster(row)
            else:
                row = start(folder)
                print(
                    f"start: --help {row['help']:.2f} s (aim: less than 0.5), a finished ensemble "
                    f"{row['finished']:.2f} s; load {load()}",
                    flush=True,
                )
            report[part] = row
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    machine.finish(report, load(), options.json)


if __name__ == "__main__":
    main()
