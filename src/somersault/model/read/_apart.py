"""MJCF files of others, compiled where they cannot hurt.

A few words in a file can ask MuJoCo for a thousand million bodies, or for the memory of ten
machines. A file that is short and holds nothing but bodies costs no more than its length, and is
compiled here; any other is compiled in a process of its own, within limits.
"""

from __future__ import annotations

import json
import os
import re
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from somersault._core import limited
from somersault._core.errors import SomersaultError
from somersault.model.read import _compiled
from somersault.model.read._compiled import REFUSALS, compile_file
from somersault.model.read._xml import Element, read_xml

_SHORT = 2**16  # bytes
_HARMLESS = {
    "mujoco", "compiler", "option", "flag", "default", "worldbody", "body", "frame", "freejoint",
    "joint", "geom", "inertial", "site", "camera", "light", "actuator", "motor", "position",
    "contact", "exclude",
}  # fmt: skip
_SIZED = "user"  # an attribute: every element of its kind gets as many numbers as the longest has
_MOST_FILES = 100  # that include one another


_PLAINER = {
    "mass and inertia of moving bodies must be larger than mjMINVAL": "a body that moves has a "
    "mass or an inertia that is zero, negative or not a number",
    "inertia must satisfy A + B >= C; use 'balanceinertia' to fix": "a body has a principal "
    "inertia that is larger than the sum of the other two, or not a number",
}
_NO_MEMORY = re.compile("allocate memory|unknown exception|bad_alloc")  # as MuJoCo says it


def compiled_model(path: Path) -> tuple[Any, list[bool]]:
    """The compiled model in a file, and of each body whether its inertia is made from its geoms.

    Raises
    ------
    SomersaultError
        For a file that is no model, or takes too long or too much memory.
    """
    try:
        root = read_xml(path)
    except SomersaultError:  # which MuJoCo may read nevertheless
        root = None
    if root is not None:
        if path.stat().st_size <= _SHORT and _is_harmless(root):
            try:
                return compile_file(str(path))
            except REFUSALS as error:
                raise _refusal(path, str(error)) from None
        _refuse_pipes(path, root)
    return _apart(path)


def _is_harmless(root: Element) -> bool:
    return all(
        element.tag in _HARMLESS and _SIZED not in element.attributes
        for element in (root, *root.descendants())
    )


def _apart(path: Path) -> tuple[Any, list[bool]]:
    import mujoco

    try:
        said = limited.answer(_compiled.__file__, os.path.abspath(path))
    except limited.Ended as end:
        raise SomersaultError(f"{path.name} {end}; make what it repeats or fills smaller") from None
    head, _, binary = said.partition(b"\n")
    answer = json.loads(head)
    if "error" in answer:
        raise _refusal(path, answer["error"])
    return mujoco.MjModel.from_binary_path("model.mjb", {"model.mjb": binary}), answer[
        "from_shapes"
    ]


def _refusal(path: Path, said: str) -> SomersaultError:
    """What MuJoCo says of a file, in a sentence."""
    if _NO_MEMORY.search(said):
        return SomersaultError(
            f"{path.name} asks for more than {limited.MORE_BYTES / 2**30:g} GB of memory, "
            "which no model needs; correct the numbers in it"
        )
    text = re.sub(r"\s+", " ", said).strip().rstrip(".")
    for theirs, ours in _PLAINER.items():
        text = text.replace(theirs, ours)
    text = re.sub(r"^(XML )?[Ee]rror:\s*", "", text)[:300]
    return SomersaultError(
        f"{path.name} cannot be read as a model: {text or 'it is none'}; correct the file"
    )


def _refuse_pipes(path: Path, root: Element) -> None:
    """SomersaultError if one of the files that it names is a pipe or a device: nobody waits for
    those."""
    for name, place in _named(path, root):
        try:
            mode = place.stat().st_mode
        except (OSError, ValueError):
            continue
        if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
            raise SomersaultError(
                f"{path.name}: {name!r} is no file but a pipe or a device; give a file in its place"
            )


def _named(path: Path, root: Element) -> Iterator[tuple[str, Path]]:
    """Names of files in a file and in those that it includes, and where each may be."""
    waiting, seen = [root], {path}
    folders = {path.parent}
    while waiting:
        elements = [*waiting.pop().descendants()]
        for element in elements:
            for key in ("assetdir", "meshdir", "texturedir"):
                if key in element.attributes:
                    folders.add(path.parent / element.attributes[key])
        for element in elements:
            name = element.attributes.get("file")
            if name is None:
                continue
            for place in {folder / part for folder in folders for part in (name, Path(name).name)}:
                yield name, place
                new = element.tag == "include" and place not in seen and place.is_file()
                if new and len(seen) < _MOST_FILES:
                    seen.add(place)
                    try:
                        waiting.append(read_xml(place))
                    except SomersaultError:
                        continue
