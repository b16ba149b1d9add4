"""Seals: what shows that a chunk on disk is whole, in its place, and of its specification.

The seal of a chunk is the SHA-256 digest of which ensemble it is of, of its number and of the bytes
of its files. It is written when they are all there, so a chunk without one is merely not finished;
one whose seal does not fit is damaged, whatever it was that changed.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from somersault._core.files import make_way, read_bytes
from somersault.engine import cores
from somersault.ensembles._chunks import Chunks
from somersault.ensembles._plan import OVER_TIME, SAMPLE, SEAL, Plan, digest_of

SEAL_BYTES = hashlib.sha256().digest_size


@dataclass(frozen=True)
class Seals:
    """The seals of a store: its place, its chunks, and what each is made of."""

    path: Path
    chunks: Chunks
    of: str
    """Digest of what decides the numbers: specification and versions."""
    variables: tuple[str, ...]
    over_time: tuple[str, ...]
    """The variables that have samples over time, all in the same chunk."""
    drawn: tuple[str, ...]
    """The varied quantities along `sample`, which the first chunk of some samples brings."""
    samples: int
    """How many samples over time there are, 0 without any."""

    def files(self, k: int) -> Iterator[Path]:
        """The files that chunk k writes, but for its seal."""
        place = self.chunks.place(k)
        if brings_samples(self.chunks, k):
            along = str(place[list(self.chunks.dims).index(SAMPLE)])
            for name in self.drawn:
                yield self.path / name / "c" / along
        inner = list(map(str, place))
        for name in self.variables:
            yield self.path.joinpath(name, "c", *inner, *(["0"] if name in self.over_time else []))

    def seal_file(self, k: int) -> Path:
        """Where the seal of chunk k is kept."""
        return self.path.joinpath(SEAL, "c", *map(str, self.chunks.place(k)), "0")

    def make_way(self, k: int) -> None:
        """Remove what else stands where files of chunk k and their folders are to be."""
        for file in (*self.files(k), self.seal_file(k)):
            make_way(file)

    def seal(self, k: int) -> bytes:
        """The seal that fits chunk k as its files are now; OSError where one is missing."""
        digest = hashlib.sha256(f"{self.of} {k}".encode())
        most = most_bytes(math.prod(self.chunks.shape) * max(self.samples, 1))
        for file in self.files(k):
            content = read_bytes(file, most)
            digest.update(f" {len(content)} ".encode())
            digest.update(content)
        return digest.digest()

    def check(self) -> tuple[set[int], set[int]]:
        """Numbers of the chunks that are finished, and of those that are damaged."""
        with ThreadPoolExecutor(cores()) as pool:  # reading and digesting release the interpreter
            states = dict(enumerate(pool.map(self._fits, range(len(self.chunks)))))
        return {k for k, fits in states.items() if fits}, {
            k for k, fits in states.items() if fits is False
        }

    def _fits(self, k: int) -> bool | None:
        """Whether chunk k fits its seal; None where it has none yet."""
        try:
            sealed = read_bytes(self.seal_file(k), SEAL_BYTES + 1)
        except FileNotFoundError:
            return None
        except OSError:
            return False
        try:
            return sealed == self.seal(k)
        except OSError:
            return False


def most_bytes(values: int) -> int:
    """How much of the file of so many values is read: more than it has if it is whole, so that a
    file that has grown, however large, does not fit and takes no memory."""
    return 8 * values + 64  # numbers of at most 8 bytes, and a checksum


def brings_samples(chunks: Chunks, k: int) -> bool:
    """Whether chunk k writes what is drawn: the first for its samples, by all other dimensions."""
    pairs = zip(chunks.dims, chunks.place(k), strict=True)
    return SAMPLE in chunks.dims and not any(i for dim, i in pairs if dim != SAMPLE)


def seals_of_plan(path: Path, plan: Plan, chunks: Chunks) -> Seals:
    """The seals that the store of a plan has."""
    return Seals(
        path,
        chunks,
        plan.digest,
        tuple(plan.variables),
        tuple(name for name, v in plan.variables.items() if v.over_time),
        tuple(plan.along_samples),
        len(plan.simulation.times),
    )


def seals_of_store(path: Path, metadata: dict[str, Any]) -> Seals:
    """The seals of a store whose plan is not at hand.

    `metadata` are those of its group, with those of its arrays in them.
    """
    attributes = metadata["attributes"]
    arrays = metadata["consolidated_metadata"]["metadata"]
    variables = tuple(attributes["variables"])
    dims = {name: tuple(arrays[name]["dimension_names"]) for name in variables}
    over_time = tuple(name for name in variables if OVER_TIME in dims[name])
    last = variables[-1]
    chunks = Chunks(
        dict(zip(dims[last], arrays[last]["shape"], strict=True)), tuple(attributes["chunk"])
    )
    return Seals(
        path,
        chunks,
        digest_of(json.loads(attributes["specification"]), json.loads(attributes["versions"])),
        variables,
        over_time,
        tuple(attributes.get("coordinates", "").split()),
        arrays[OVER_TIME]["shape"][0] if OVER_TIME in arrays else 0,
    )
