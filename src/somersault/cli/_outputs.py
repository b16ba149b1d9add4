"""What commands write: found to be possible first, written last, and told of in between."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURES = (".png", ".svg")
PICTURE_ENDINGS = " or ".join(PICTURES)


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
