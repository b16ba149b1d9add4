"""The input of a number: a good file, spoilt in a few ways that follow from the seed."""

from __future__ import annotations

import os
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import mutations
from .good import Folder
from .mutations import pick
from .readers import Reader

_STRANGE = ("folder", "pipe", "loop", "device", "nothing", "empty")
_STEMS = ("\udce9", "a b", "é", "%s", "-x", "'", "x" * 200)  # the first is not UTF-8
_MOST_BYTES = 2_000_000  # of a spoilt file: size alone is not what is sought


@dataclass(frozen=True)
class Input:
    """A folder of files, the name of the one to read, and what was done to it."""

    files: Folder
    name: str
    done: tuple[str, ...]

    @property
    def size(self) -> int:
        """Bytes of the file to read."""
        return len(self.files.get(self.name) or b"")

    def write(self, folder: Path) -> Path:
        """Write it to an empty folder; the path of the file to read."""
        for name, data in self.files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            if data is None:
                os.mkfifo(folder / name)
            else:
                (folder / name).write_bytes(data)
        main = folder / self.name
        main.parent.mkdir(parents=True, exist_ok=True)
        strange = self.done[0] if self.done and self.done[0] in _STRANGE else ""
        if strange == "folder":
            main.mkdir()
        elif strange == "pipe":
            os.mkfifo(main)
        elif strange in ("loop", "device"):
            main.symlink_to(main if strange == "loop" else "/dev/zero")
        return main


def spoilt(reader: Reader, seed: int, number: int) -> Input:
    """The input of that number."""
    rng = np.random.default_rng([seed, zlib.crc32(reader.name.encode()), number])
    folder = dict(pick(rng, reader.good()))
    name = next(iter(folder))
    data = folder[name] or b""
    if rng.uniform() < 0.01:
        what = pick(rng, _STRANGE)
        folder.pop(name)
        if what == "empty":
            folder = {name: b"", **folder}
        return Input(folder, name, (what,))
    done: list[str] = []
    for _ in range(int(pick(rng, (1, 1, 1, 2, 2, 3, 4)))):
        data = _changed(reader, data, rng, done)[:_MOST_BYTES]
    if reader.endings and rng.uniform() < 0.03:
        stem = pick(rng, (name.rpartition(".")[0], *_STEMS))
        new = stem + pick(rng, reader.endings)
        if new not in folder:
            folder.pop(name)
            name = new
            done.append(f"called {name}")
    return Input({name: data, **{k: v for k, v in folder.items() if k != name}}, name, tuple(done))


def _changed(reader: Reader, data: bytes, rng: np.random.Generator, done: list[str]) -> bytes:
    if not reader.changes or rng.uniform() < 0.12:
        if rng.uniform() < 0.15:
            done.append("spliced")
            other = pick(rng, reader.good())
            return mutations.spliced(data, next(iter(other.values())) or b"", rng)
        change = pick(rng, mutations.BYTES)
        done.append(change.__name__)
        return change(data, rng)
    change_text = pick(rng, reader.changes)
    done.append(change_text.__name__)
    try:
        text = data.decode("utf-8", "surrogateescape")
        return change_text(text, rng).encode("utf-8", "surrogateescape")
    except UnicodeError:
        return data
