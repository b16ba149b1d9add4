"""An interrupt ends a program at once, whatever it is doing, and leaves nothing behind.

Python raises KeyboardInterrupt in the main thread, between two of its own instructions: not while
compiled code runs, and libraries swallow it or turn it into other errors. A program that calls
`heed` has a thread that waits for signals instead. That thread lets a file be finished that is just
being written, ends the child processes, removes what is only temporary, and ends the program.
"""

from __future__ import annotations

import atexit
import os
import signal
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress

_lock = threading.RLock()
_temporary: set[str] = set()
_ending = threading.Event()
_PATIENCE = 0.3  # s for a file to be finished, and again for children to end
_MOST = 3.0  # s, after which the program ends even if that is not done: a disk hangs, say
_TO_STOP = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)


def heed(signals: Sequence[signal.Signals] = _TO_STOP, last_words: str = "") -> None:
    """From now on these signals end the process; to be called once, in the main thread.

    The exit code is 128 and the signal's number, 130 for an interrupt. Signals that are ignored
    stay ignored. Child processes do not hear interrupts: the program ends them.
    """
    heeded = [s for s in signals if signal.getsignal(s) is not signal.SIG_IGN]
    receiving, sending = os.pipe()
    if hasattr(os, "set_blocking"):
        os.set_blocking(sending, False)
    signal.set_wakeup_fd(sending, warn_on_full_buffer=False)
    for s in heeded:
        signal.signal(s, lambda number, frame: None)
    watch = threading.Thread(target=_watch, args=(receiving, heeded, last_words), daemon=True)
    watch.start()
    atexit.register(_finish, heeded)
    if signal.SIGINT in heeded:
        _mask_interrupts("SIG_BLOCK")  # in this thread, those it starts, and all children


@contextmanager
def children_unaware() -> Iterator[None]:
    """Processes begun within do not hear interrupts; one that comes meanwhile is raised after."""
    from multiprocessing import resource_tracker

    came: list[int] = []
    handler = signal.getsignal(signal.SIGINT)
    in_charge = threading.current_thread() is threading.main_thread() and callable(handler)
    if in_charge:
        signal.signal(signal.SIGINT, lambda number, frame: came.append(number))
    before = _mask_interrupts("SIG_BLOCK")
    # It unblocks interrupts when it starts, for this thread and what that begins later; and when
    # it cleans up after a program that was ended, it would warn of having had to.
    sys.warnoptions.append("ignore")  # which it is started with
    resource_tracker.ensure_running()
    sys.warnoptions.remove("ignore")
    _mask_interrupts("SIG_BLOCK")
    try:
        yield
    finally:
        if before is not None and signal.SIGINT not in before:
            _mask_interrupts("SIG_UNBLOCK")
        if in_charge:
            signal.signal(signal.SIGINT, handler)
    if came:
        raise KeyboardInterrupt


@contextmanager
def unbroken() -> Iterator[None]:
    """What is written within is finished before the program is ended, unless it takes long."""
    with _lock:
        yield


@contextmanager
def removed_after(path: str | os.PathLike[str]) -> Iterator[None]:
    """Whatever is at a path is removed afterwards, and when the program is ended."""
    name = os.fspath(path)
    with _lock:
        _temporary.add(name)
    try:
        yield
    finally:
        with _lock:
            _remove(name)
            _temporary.discard(name)


def _mask_interrupts(how: str) -> set[int] | None:
    """Block or unblock interrupts in this thread; those blocked before. None on Windows."""
    if not hasattr(signal, "pthread_sigmask"):
        return None
    return signal.pthread_sigmask(getattr(signal, how), [signal.SIGINT])


def _finish(heeded: Sequence[signal.Signals]) -> None:
    """All is done, and Python puts its things away: its own handlers too, so that a signal would
    end the process in the middle of that, with another exit code. Or all has failed, because an
    interrupt is just ending what this process waited for; then that goes on."""
    if _ending.is_set():
        threading.Event().wait(2 * _MOST)  # the thread that watches ends the process
    for s in heeded:
        signal.signal(s, signal.SIG_IGN)


def _watch(receiving: int, heeded: Sequence[int], last_words: str) -> None:
    if signal.SIGINT in heeded:
        _mask_interrupts("SIG_UNBLOCK")
    while (number := os.read(receiving, 1)[0]) not in heeded:
        pass
    code = 128 + number
    _ending.set()
    late = threading.Timer(_MOST, os._exit, [code])
    late.daemon = True
    try:
        late.start()
        _end(last_words)
    finally:
        os._exit(code)


def _end(last_words: str) -> None:
    sys.setswitchinterval(1e-4)  # s: the main thread, which may be busy, gives way sooner
    if os.isatty(2):
        last_words = f"\r\x1b[2K\x1b[?25h{last_words}"  # a progress bar goes, the cursor is back
    with suppress(OSError):
        os.write(2, last_words.encode())
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # those who are ended have nothing to say
    _lock.acquire(timeout=_PATIENCE)  # for good: nothing is begun any more
    _end_children()
    for name in _temporary.copy():
        _remove(name)


def _end_children() -> None:
    if hasattr(os, "waitid"):
        try:
            os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
        except ChildProcessError:  # there are none
            return
    import psutil

    tracking = sys.modules.get("multiprocessing.resource_tracker")
    # It cleans up after a program that has ended, and then ends.
    tracker = None if tracking is None else tracking._resource_tracker._pid

    def children() -> list[psutil.Process]:
        return [p for p in psutil.Process().children(recursive=True) if p.pid != tracker]

    alive = children()
    for process in alive:
        with suppress(psutil.Error):
            process.terminate()
    psutil.wait_procs(alive, _PATIENCE)
    for process in children():  # those begun again meanwhile among them
        with suppress(psutil.Error):
            process.kill()


def _remove(name: str) -> None:
    """Remove a file or a folder with all that is in it; others may still be writing into it."""
    import shutil

    for _ in range(20):
        if os.path.isdir(name) and not os.path.islink(name):
            shutil.rmtree(name, ignore_errors=True)
        else:
            with suppress(OSError):
                os.unlink(name)
        if not os.path.lexists(name):
            return
