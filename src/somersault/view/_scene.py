"""All that a film shows: histories side by side, words, and charts, frame by frame."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.view._actor import Actor, values_at
from somersault.view._canvas import blank
from somersault.view._lettering import FAINT, INK, lines_of, tidy, write_on
from somersault.view._look import Look
from somersault.view._stage import VECTORS, Stage
from somersault.view._timeline import Timeline

if TYPE_CHECKING:
    from somersault.history import History

_CHARTS = 0.37  # of the width
_WORDS = 0.028  # of the height: the size of letters
_LABEL_LINES = 3
_NAMES = {"momentum": ("angular momentum", "kg m²/s"), "spin": ("angular velocity", "rad/s")}


class Scene:
    """Histories at some moments, ready to be drawn.

    Parameters
    ----------
    histories : sequence of History
        Side by side.
    moments : ndarray, (T,)
        s.
    look : Look
    note : str
        What stands behind the time: how slow it is.
    """

    def __init__(
        self, histories: Sequence[History], moments: Array, look: Look, note: str = ""
    ) -> None:
        self._moments, self._look, self._note = moments, look, note
        self._histories = histories
        labels = look.labels
        if labels is None:
            labels = [h.model.name for h in histories] if len(histories) > 1 else [""]
        if len(labels) != len(histories):
            raise SomersaultError(
                f"there are {len(labels)} labels for {len(histories)} histories; give one for each"
            )
        self._labels = labels
        self._picture = blank(*look.size)
        width, height = look.size
        left = width
        self._timeline = None
        if look.charts:
            left = width - round(_CHARTS * width)
            shown = [*histories, *look.others]
            names = [*labels, *(f"ghost of {ghost.model.name}" for ghost in look.others)]
            names[0] = names[0] or histories[0].model.name
            self._timeline = Timeline(shown, names, width - left, height)
        edges = np.linspace(0, left, len(histories) + 1).astype(int)
        self._edges = list(pairwise(edges.tolist()))
        ghosts = [Actor(ghost, moments) for ghost in look.others]
        self._stages = [
            Stage(
                [Actor(history, moments)], ghosts, end - start, height, look.camera,
                look.follow, look.vectors, look.ground,
            )
            for history, (start, end) in zip(histories, self._edges, strict=True)
        ]  # fmt: skip
        radius = max(stage.radius for stage in self._stages)
        for stage in self._stages:  # one scale for all
            stage.radius = radius
        self._angles = [values_at(h.times, h.angles, moments) for h in histories]

    def frame(self, k: int) -> Array:
        """The picture (height, width, 4) at a moment, valid until the next."""
        picture = self._picture
        for index, (start, end) in enumerate(self._edges):
            panel = picture[:, start:end]
            panel[:] = self._stages[index].draw([k])
            self._write(panel, index, k)
        if self._timeline is not None:
            panel = picture[:, self._edges[-1][1] :]
            panel[:] = self._timeline.picture
            self._timeline.mark(panel, float(self._moments[k]))
        return picture

    def _write(self, panel: Array, index: int, k: int) -> None:
        height, width = panel.shape[:2]
        size = max(9.0, min(_WORDS * height, 0.045 * width))
        margin, step = 0.8 * size, 1.5 * size
        y = margin
        label = self._labels[index]
        for line in lines_of(label, 1.05 * size, width - 2 * margin, _LABEL_LINES) if label else ():
            write_on(panel, (margin, y), line, 1.05 * size)
            y += step
        for line in self._lines(index, k):
            write_on(panel, (margin, y), line, size, FAINT if label else INK)
            y += step
        y = height - margin - step * len(self._look.vectors)
        for name in self._look.vectors:
            write_on(panel, (margin, y), self._said(index, name, k), 0.9 * size, VECTORS[name])
            y += step

    def _lines(self, index: int, k: int) -> list[str]:
        times = self._histories[index].times
        moment = np.clip(self._moments[k], times[0], times[-1])  # it waits for the others
        time = f"{tidy(moment)} s{self._note}"
        if not self._histories[index].model.free:
            return [time]
        somersault, _, twist = self._angles[index][k] / (2 * np.pi)
        return [time, f"somersault {tidy(somersault)} turns", f"twist {tidy(twist)} turns"]

    def _said(self, index: int, name: str, k: int) -> str:
        """What an arrow is, and how long at a moment."""
        actor = self._stages[index].actors[0]
        words, unit = _NAMES[name]
        if not actor.longest[name]:
            return f"no {words}"
        return f"{words} {np.linalg.norm(actor.vectors[name][k]):.3g} {unit}"
