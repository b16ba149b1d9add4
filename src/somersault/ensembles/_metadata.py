"""What a store says of itself, and how it shows that it says so truly.

The metadata of the group are one JSON file, which has those of all arrays in it, and two digests:
`digest` of itself, and `fixed` of the coordinates that are written when the store is begun.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from somersault._core.errors import SomersaultError
from somersault._core.files import read_bytes
from somersault._core.files import write as write_file
from somersault.ensembles._labels import FORMAT
from somersault.ensembles._plan import SEAL
from somersault.ensembles._seals import most_bytes, seals_of_store

GROUP = "zarr.json"
_MOST_BYTES = 2**28  # of metadata
_FAMILY = FORMAT.rpartition(" ")[0]


class DamagedMetadataError(SomersaultError):
    """A store that was an ensemble's, and does not say any more which."""


def sign(folder: Path) -> None:
    """Put both digests into the metadata of a store that has all its metadata and coordinates."""
    file = folder / GROUP
    metadata = json.loads(file.read_bytes())
    metadata["attributes"]["fixed"] = _digest_of_coordinates(folder, metadata)
    metadata["attributes"]["digest"] = _digest(metadata)
    write_file(file, json.dumps(metadata, indent=2))


def read_metadata(path: Path) -> dict[str, Any]:
    """The metadata of a store, whole and true; SomersaultError for what is none."""
    known: Any = None
    try:
        metadata = json.loads(read_bytes(path / GROUP, _MOST_BYTES))
        known = metadata["attributes"]["format"]
        if known == FORMAT and metadata["attributes"]["digest"] == _digest(metadata):
            return dict(metadata)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        pass
    if (path / SEAL).is_dir():
        raise DamagedMetadataError(
            f"{path / GROUP} is damaged; run the same ensemble into this store again, which mends "
            "it, or write to another place"
        )
    if isinstance(known, str) and known.startswith(_FAMILY):
        raise SomersaultError(
            f"{path} was begun by a version of somersault that did not seal its stores; go on "
            "with that, or write to another place"
        )
    raise SomersaultError(f"{path} is there, but is no ensemble; write to another place")


def arrays_of(metadata: dict[str, Any]) -> dict[str, Any]:
    """The metadata of each array, by its name, as the group has them."""
    return dict(metadata["consolidated_metadata"]["metadata"])


def damaged_arrays(path: Path, metadata: dict[str, Any]) -> list[str]:
    """Arrays whose files of metadata are not what the group says they are."""
    return [name for name, said in arrays_of(metadata).items() if _read(path / name) != said]


def coordinates_are_whole(path: Path, metadata: dict[str, Any]) -> bool:
    """Whether the coordinates that a store was begun with are as they were."""
    try:
        return bool(_digest_of_coordinates(path, metadata) == metadata["attributes"]["fixed"])
    except OSError:
        return False


def fixed_coordinates(metadata: dict[str, Any]) -> list[str]:
    """The coordinates that are written when a store is begun: grids and times."""
    attributes = metadata["attributes"]
    later = {*attributes["variables"], *attributes.get("coordinates", "").split(), SEAL}
    return sorted(set(arrays_of(metadata)) - later)


def chunk_of_array(array: Path) -> tuple[int, ...] | None:
    """The shape of an array's chunks, as its own metadata have it; None where they do not."""
    try:
        shape = _read(array)["chunk_grid"]["configuration"]["chunk_shape"]
        return tuple(length for length in shape if isinstance(length, int) and length > 0)
    except (KeyError, TypeError):
        return None


def require_whole(path: Path) -> None:
    """SomersaultError where a store that is read without its plan is damaged."""
    metadata = read_metadata(path)
    seals = seals_of_store(path, metadata)
    _, damaged = seals.check()
    what = f"{len(damaged)} of its {len(seals.chunks):,} chunks are" if damaged else ""
    if not coordinates_are_whole(path, metadata):
        what = "its coordinates are"
    if what:
        raise SomersaultError(
            f"{path} is not what was written: {what} damaged; run the same ensemble into this "
            "store again, which mends it"
        )


def _digest(metadata: dict[str, Any]) -> str:
    """Of the metadata of a group, but for the digest that is in them."""
    said = {name: x for name, x in metadata["attributes"].items() if name != "digest"}
    text = json.dumps({**metadata, "attributes": said}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _digest_of_coordinates(path: Path, metadata: dict[str, Any]) -> str:
    digest = hashlib.sha256()
    for name in fixed_coordinates(metadata):
        digest.update(f" {name} ".encode())
        (length,) = arrays_of(metadata)[name]["shape"]
        digest.update(read_bytes(path / name / "c" / "0", most_bytes(length)))
    return digest.hexdigest()


def _read(array: Path) -> Any:
    try:
        return json.loads(read_bytes(array / GROUP, _MOST_BYTES))
    except (OSError, ValueError, RecursionError):
        return None
