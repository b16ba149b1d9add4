"""Programs of ours that read what others wrote, with limits of time and memory.

Some libraries go on for ever, or ask for all memory there is, over a few strange bytes. Such a file
is read by a process that ends by itself, and here by what that process says of it.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys

from somersault._core.stages import stage

SECONDS = 10  # of one processor
WAIT = 60  # s, where the machine has much else to do
MORE_BYTES = 2**31  # above what the process takes before it reads
_TOO_LONG = "takes more than {} s to read"


class Ended(Exception):  # noqa: N818
    """A program ended before it had answered: how, in words that go on from a file's name."""


def answer(program: str, *arguments: str) -> bytes:
    """What a program, a Python file, writes to its standard output.

    Behind its arguments it is given the limits, with which it calls `limit`.

    Raises
    ------
    Ended
        If a limit ended it, or anything else before it had answered.
    """
    limits = [str(x) for x in (SECONDS, WAIT, MORE_BYTES)]
    alike = {
        "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
        "OPENBLAS_NUM_THREADS": "1",  # threads and arenas of many cores would count as memory
        "MALLOC_ARENA_MAX": "2",
        "MUJOCO_GL": "disable",  # nothing is drawn: it starts sooner without a look for GLFW
    }
    try:
        with stage("reading"):
            done = subprocess.run(
                [sys.executable, "-P", program, *arguments, *limits], stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=os.environ | alike,
                timeout=WAIT, check=False,
            )  # fmt: skip
    except subprocess.TimeoutExpired:
        raise Ended(_TOO_LONG.format(WAIT)) from None
    if done.returncode or not done.stdout:
        raise Ended(_how(-done.returncode))
    return done.stdout


def _how(number: int) -> str:
    """How a program ended without an answer, by the number of its signal, negative if none."""
    known = {s.value: s.name for s in signal.Signals}
    name = known.get(number, f"exit code {-number}")
    times = {"SIGXCPU": SECONDS, "SIGALRM": WAIT}
    if name in times:
        return _TOO_LONG.format(times[name])
    return f"ends the program that reads it ({name}), perhaps for want of memory"


def limit(seconds: str, wait: str, more_bytes: str) -> None:
    """End this process by itself: after so much time, at an interrupt, and with its parent."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # libraries would not come back to Python for it
    if hasattr(signal, "alarm"):
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.alarm(int(wait))
    try:
        import resource
    except ImportError:  # Windows: the parent's clock alone
        return
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds) + 1))
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
        with open("/proc/self/statm") as file:
            most = int(file.read().split()[0]) * resource.getpagesize() + int(more_bytes)
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
