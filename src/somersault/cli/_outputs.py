"""What commands write: found to be possible first, written last, and told of in between."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations, permutations
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from somersault._core.errors import SomersaultError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from somersault.flight import Flight
    from somersault.robot import Run

PICTURES = (".png", ".svg")
PICTURE_ENDINGS = " or ".join(PICTURES)


def check_apart(spec: Path, *outputs: Path | None) -> None:
    """SomersaultError where an output would replace a SPEC, or a file that it names."""
    from somersault.spec import read_toml

    named = [spec, *(spec.parent / name for name in _texts(read_toml(spec)))]
    for output in filter(None, outputs):
        require_other(output, named)


def require_other(output: Path, inputs: Iterable[Path]) -> None:
    """SomersaultError where an output is one of the files that are read."""
    if os.path.exists(output):
        for file in inputs:
            if os.path.exists(file) and os.path.samefile(file, output):
                raise SomersaultError(f"{output} is read here; give what is written another name")


def check_distinct(*outputs: Path | None) -> None:
    """SomersaultError where one output would replace another, or be inside of it."""
    given = [output for output in outputs if output is not None]
    for one, other in combinations(given, 2):
        if os.path.realpath(one) == os.path.realpath(other):
            raise SomersaultError(f"{other} is to be written twice; give each output its own name")
    for one, other in permutations(given, 2):
        if Path(os.path.realpath(one)) in Path(os.path.realpath(other)).parents:
            raise SomersaultError(
                f"{other} would be inside of {one}, which is written too; give a place outside of "
                "it"
            )


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str) and "\0" not in value:
        yield value
    elif isinstance(value, dict | list):
        for part in value.values() if isinstance(value, dict) else value:
            yield from _texts(part)


class Writing:
    """Blocks in which files are written; where a disk is full the command goes on, to print what
    it has found, and the trouble is raised in the end."""

    def __init__(self) -> None:
        self._trouble: OSError | None = None

    def __enter__(self) -> None:
        """What is written begins."""

    def __exit__(
        self,
        kind: type[BaseException] | None,
        trouble: BaseException | None,
        traceback: TracebackType | None,
    ) -> bool:
        if not isinstance(trouble, OSError):
            return False
        self._trouble = self._trouble or trouble
        return True

    def finish(self) -> None:
        """Raise the first trouble that there was."""
        if self._trouble is not None:
            raise self._trouble


def save_picture(path: Path, figure: Figure) -> None:
    """Write a picture by its file's ending, the same bytes on every day."""
    from somersault._core.files import write
    from somersault.view.style import saved

    write(path, saved(figure, path.suffix.lower()[1:]))


# ------------------------------------------------------------------------------------- a motion


def add_motion_outputs(parser: argparse.ArgumentParser) -> None:
    """Declare what can be written of one motion."""
    parser.add_argument(
        "--out", type=Path, metavar="FILE", help="write its history, .nc (NetCDF) or .csv"
    )
    add_views(parser)


def add_views(parser: argparse.ArgumentParser) -> None:
    """Declare what one motion can be seen in."""
    parser.add_argument(
        "--video", type=Path, metavar="FILE", help="write a film of it, .mp4, .webm or .gif"
    )
    parser.add_argument(
        "--page", type=Path, metavar="FILE", help="write a page that plays it in a browser, .html"
    )


def check_motion_outputs(chosen: argparse.Namespace) -> None:
    """SomersaultError unless all that is asked for of one motion can be written."""
    from somersault._core.datasets import check_history_file

    if chosen.out is not None:
        check_history_file(chosen.out)
    check_views(chosen)


def check_views(chosen: argparse.Namespace) -> None:
    """SomersaultError unless a film and a page can be written, and each file apart."""
    if chosen.video is not None:
        from somersault.view import check_film

        check_film(chosen.video)
    if chosen.page is not None:
        from somersault.view import check_page

        check_page(chosen.page)
    check_distinct(chosen.out, chosen.video, chosen.page)


def write_motion(
    motion: Flight | Run, chosen: argparse.Namespace, **film: Any
) -> tuple[Writing, dict[str, str]]:
    """Write what is asked for of one motion; to be finished when the rest has been told.

    `film` says how it is filmed. With it comes what was written: the files by what is in them.
    """
    writing, written = Writing(), dict[str, str]()
    if chosen.out is not None:
        with writing:
            motion.save(chosen.out)
            written["history"] = str(chosen.out)
    write_views(motion, chosen, writing, written, **film)
    return writing, written


def write_views(
    motion: Flight | Run, chosen: argparse.Namespace, writing: Writing, written: dict[str, str],
    **film: Any,
) -> None:  # fmt: skip
    """Write a film and a page of one motion where they are asked for, and what was `written`."""
    if chosen.video is not None:
        with writing:
            motion.film(chosen.video, **film)
            written["film"] = str(chosen.video)
    if chosen.page is not None:
        with writing:
            motion.page(chosen.page)
            written["page"] = str(chosen.page)


def written_lines(written: Mapping[str, str]) -> list[str]:
    """What people are told of files that were written."""
    return [f"  {what}: {file}" for what, file in written.items()]
