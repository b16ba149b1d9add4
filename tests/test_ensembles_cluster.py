"""A scheduler and workers of their own, hosts that do not see the store, and disks that fill."""

from __future__ import annotations

import contextlib
import os
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import dask
import pytest
from test_ensembles_killed import begun, command, finished, same, spec, whole_of

from somersault import SomersaultError
from somersault.ensembles import tls_files
from somersault.ensembles._scheduler import check_scheduler

pytestmark = pytest.mark.slow
BIN = Path(sys.executable).parent
ROOT = os.geteuid() == 0 and sys.platform == "linux" and shutil.which("ip") is not None


@contextlib.contextmanager
def running(*argument: str) -> Iterator[subprocess.Popen[bytes]]:
    process = subprocess.Popen(
        argument, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )
    try:
        yield process
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, 9)
        process.wait()


def scheduler(port: int, host: str = "127.0.0.1", *more: str) -> contextlib.AbstractContextManager:
    return running(
        str(BIN / "dask"), "scheduler", "--host", host, "--port", str(port), "--no-dashboard",
        "--no-show", *more,
    )  # fmt: skip


def worker(
    address: str, *before: str, more: tuple[str, ...] = ()
) -> contextlib.AbstractContextManager:
    return running(
        *before, str(BIN / "dask"), "worker", address, "--nthreads", "1", "--no-dashboard",
        "--local-directory", "/tmp", "--death-timeout", "30", *more,
    )  # fmt: skip


def free_port() -> int:
    with socket.socket() as some:
        some.bind(("127.0.0.1", 0))
        return some.getsockname()[1]


def answers(port: int, host: str = "127.0.0.1") -> None:
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline:
        with contextlib.suppress(OSError), socket.create_connection((host, port), 1):
            return
        time.sleep(0.1)
    pytest.fail("the scheduler does not start")


def wait_for(store: Path, chunks: int, program: subprocess.Popen[str]) -> None:
    deadline = time.monotonic() + 60
    while finished(store) < chunks and time.monotonic() < deadline:
        assert program.poll() is None, program.communicate()
        time.sleep(0.05)
    assert finished(store) >= chunks


def test_a_scheduler_that_is_killed_and_another_that_goes_on(tmp_path: Path) -> None:
    file, store = spec(tmp_path, 400), tmp_path / "map.zarr"
    port = free_port()
    address = f"tcp://127.0.0.1:{port}"
    with scheduler(port) as first, worker(address), worker(address):
        answers(port)
        program = begun(file, store, "--scheduler", address)
        wait_for(store, 20, program)
        os.killpg(first.pid, 9)
        out, err = program.communicate(timeout=60)
    assert (program.returncode, out) == (2, ""), err
    assert err.count("\n") == 1, err
    assert "scheduler" in err
    assert "again" in err
    done = finished(store)
    assert 20 <= done < 200
    port = free_port()
    address = f"tcp://127.0.0.1:{port}"
    with scheduler(port), worker(address), worker(address):
        answers(port)
        last = subprocess.run(
            command(file, store, "--scheduler", address),
            capture_output=True,
            text=True,
            timeout=120,
        )
    assert (last.returncode, last.stderr) == (0, "")
    same(store, whole_of(file))


@pytest.mark.skipif(not ROOT, reason="only root may mount")
@pytest.mark.parametrize("mode", [("--threads", "2"), ("--workers", "2")])
def test_a_full_disk(tmp_path: Path, mode: tuple[str, str]) -> None:
    file, small = spec(tmp_path, 200), tmp_path / "small"
    small.mkdir()
    made = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1M", "tmpfs", str(small)])
    if made.returncode:
        pytest.skip("may not mount")
    store = small / "map.zarr"
    try:
        full = subprocess.run(
            command(file, store, *mode), capture_output=True, text=True, timeout=120
        )
        assert (full.returncode, full.stdout) == (2, "")
        assert full.stderr.count("\n") == 1, full.stderr
        assert "No space left on device" in full.stderr
        assert "Traceback" not in full.stderr
        assert 0 < finished(store) < 100
        subprocess.run(["mount", "-o", "remount,size=50M", str(small)], check=True)
        last = subprocess.run(
            command(file, store, *mode), capture_output=True, text=True, timeout=120
        )
        assert (last.returncode, last.stderr) == (0, "")
        same(store, whole_of(file))
    finally:
        subprocess.run(["umount", "-l", str(small)])


@pytest.mark.parametrize("seen", ["nothing", "another folder"])
@pytest.mark.skipif(not ROOT, reason="only root may make network namespaces")
def test_a_worker_on_another_host_that_does_not_see_the_store(tmp_path: Path, seen: str) -> None:
    """Its rows travel back through the program, also where its own disk has such a path."""
    file, shared = spec(tmp_path, 100), tmp_path / "shared"
    shared.mkdir()
    store = shared / "map.zarr"
    name, port = f"so{os.getpid()}", free_port()
    net = f"10.213.{os.getpid() % 256}"  # two of these tests may run at once
    here, there = f"{net}.1", f"{net}.2"
    steps = [
        f"ip netns add {name}",
        f"ip link add {name}a type veth peer name {name}b netns {name}",
        f"ip addr add {here}/30 dev {name}a",
        f"ip link set {name}a up",
        f"ip -n {name} addr add {there}/30 dev {name}b",
        f"ip -n {name} link set {name}b up",
        f"ip -n {name} link set lo up",
    ]
    try:
        for step in steps:
            if subprocess.run(step.split(), capture_output=True).returncode:
                pytest.skip("may not make network namespaces")
        address = f"tcp://{here}:{port}"
        hide = f"mount -t tmpfs tmpfs {shared} && "
        if seen == "another folder":
            hide += f"mkdir {store} && "
        other = ("ip", "netns", "exec", name, "unshare", "-m", "sh", "-c", f'{hide} exec "$@"', "-")
        with scheduler(port, here), worker(address, *other):
            answers(port, here)
            last = subprocess.run(
                command(file, store, "--scheduler", address), capture_output=True, text=True,
                timeout=120,
            )  # fmt: skip
        assert last.returncode == 0, last.stderr
        assert last.stderr.startswith(f"note: {address} is reached in the clear")
        assert last.stderr.count("\n") == 1, last.stderr
        same(store, whole_of(file))
    finally:
        subprocess.run(["ip", "netns", "del", name], capture_output=True)
        subprocess.run(["ip", "link", "del", f"{name}a"], capture_output=True)


def test_a_worker_with_a_copy_of_the_store_at_the_same_path(tmp_path: Path) -> None:
    """It may write there, but the program must not take that for its own store."""
    if not ROOT:
        pytest.skip("only root may mount")
    file, shared = spec(tmp_path, 100), tmp_path / "shared"
    store = shared / "map.zarr"
    part = subprocess.run(command(file, store, "--threads", "1"), capture_output=True)
    assert part.returncode == 0
    for ended in (store / "ended" / "c").rglob("*"):
        if ended.is_file():
            ended.unlink()
    port = free_port()
    address = f"tcp://127.0.0.1:{port}"
    copy = tmp_path / "copy"
    shutil.copytree(shared, copy)
    other = ("unshare", "-m", "sh", "-c", f'mount --bind {copy} {shared} && exec "$@"', "-")
    with scheduler(port), worker(address, *other):
        answers(port)
        last = subprocess.run(
            command(file, store, "--scheduler", address),
            capture_output=True,
            text=True,
            timeout=120,
        )
    if last.returncode == 0:
        same(store, whole_of(file))
    else:
        assert (last.returncode, last.stderr.count("\n")) == (2, 1)


# ------------------------------------------------------------------------------------------- TLS


def certificate(folder: Path, name: str) -> dict[str, Path]:
    """A certificate that is its own authority, and its key."""
    files = {"ca": folder / f"{name}.pem", "key": folder / f"{name}-key.pem"}
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj",
         f"/CN={name}", "-keyout", str(files["key"]), "-out", str(files["ca"])],
        check=True, capture_output=True,
    )  # fmt: skip
    return {"ca": files["ca"], "cert": files["ca"], "key": files["key"]}


def options(files: dict[str, Path], *ca: str) -> tuple[str, ...]:
    return ("--tls-ca" + "".join(ca), str(files["ca"]), "--tls-cert", str(files["cert"]),
            "--tls-key", str(files["key"]))  # fmt: skip


@pytest.mark.skipif(shutil.which("openssl") is None, reason="needs openssl to make certificates")
def test_a_cluster_with_certificates(tmp_path: Path) -> None:
    """Whoever has one that its authority signed may come in, and nobody else."""
    ours, others = (certificate(tmp_path, name) for name in ("ours", "others"))
    mixed = {**ours, "cert": others["cert"], "key": others["key"]}
    file, store = spec(tmp_path, 20), tmp_path / "map.zarr"
    port = free_port()
    address = f"tls://127.0.0.1:{port}"
    theirs = options(ours, "-file")
    with (
        scheduler(port, "127.0.0.1", "--protocol", "tls", *theirs),
        worker(address, more=theirs),
    ):
        answers(port)
        last = subprocess.run(
            command(file, store, "--scheduler", address, *options(ours)),
            capture_output=True, text=True, timeout=300,
        )  # fmt: skip
        assert (last.returncode, last.stderr) == (0, "")
        same(store, whole_of(file))
        for at, security, words in (
            (address, tls_files(**others), "that your authority has not signed"),
            (address, tls_files(**mixed), "does not take your certificate"),
            (address, None, "needs certificates; give --tls-ca"),
            (f"tcp://127.0.0.1:{port}", tls_files(**ours), "write tls:// in front"),
            (f"tcp://127.0.0.1:{port}", None, "speaks TLS; write tls:// in front"),
        ):
            with pytest.raises(SomersaultError, match=words) as mistake:
                check_scheduler(at, security)
            assert "\n" not in str(mistake.value)
        own = {"ca-file": ours["ca"], "client.cert": ours["cert"], "client.key": ours["key"]}
        with dask.config.set({f"distributed.comm.tls.{key}": str(own[key]) for key in own}):
            check_scheduler(address, None)
    port = free_port()
    with scheduler(port):
        answers(port)
        with pytest.raises(SomersaultError, match="speaks no TLS"):
            check_scheduler(f"tls://127.0.0.1:{port}", tls_files(**ours))
