"""Pictures that commands write."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from somersault._core.errors import SomersaultError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURES = ".png or .svg"


def check_picture(option: str, path: Path) -> None:
    """SomersaultError unless pictures can be written to a file of that name."""
    if path.suffix.lower() not in (".png", ".svg"):
        raise SomersaultError(f"{option} {path} is no picture; let it end in {PICTURES}")


def save_picture(path: Path, figure: Figure) -> None:
    """Write a picture by its file's ending, the same bytes on every day."""
    from somersault._core.files import write
    from somersault.view.style import saved

    write(path, saved(figure, path.suffix.lower()[1:]))
