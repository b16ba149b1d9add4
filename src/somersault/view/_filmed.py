"""What can be looked at: films, pictures and pages as methods of a history."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from somersault._core.array import Array

if TYPE_CHECKING:
    from somersault.history import History


class Filmed:
    """Films, pictures and pages of a history, as methods of its own."""

    def film(
        self,
        path: str | os.PathLike[str],
        fps: int = 30,
        speed: float = 1.0,
        beside: History | Sequence[History] = (),
        **look: Any,
    ) -> None:
        """Write a film: `view.film` of it, and of others beside it.

        Parameters
        ----------
        path : path-like
            A .mp4, .webm or .gif file.
        fps : int
            Frames per second.
        speed : float
            Seconds of the motion in a second of the film.
        beside : History or sequence of History
            Others, to its right.
        **look
            size, camera, follow, vectors, charts, ghosts, labels, ground: see `view.Look`.

        Examples
        --------
        >>> import somersault as so
        >>> flight = so.fly("furrer", so.Takeoff(spin=8.6, tilt=0.05), 0.1)
        >>> flight.film("layout.gif", speed=0.5, size=(160, 90))
        """
        from somersault.view._film import film
        from somersault.view._look import several

        film([self, *several("beside", beside, 0)], path, fps, speed, **look)  # type: ignore[list-item]

    def frame(self, time: float, **look: Any) -> Array:
        """One frame of a film as (height, width, 3) bytes: `view.frame` of it.

        Parameters
        ----------
        time : float
            s.
        **look
            As of a film.

        Returns
        -------
        ndarray of uint8, (height, width, 3)

        Examples
        --------
        >>> import somersault as so
        >>> flight = so.fly("furrer", so.Takeoff(spin=8.6, tilt=0.05), 0.1)
        >>> flight.frame(0.05, size=(160, 90)).shape
        (90, 160, 3)
        """
        from somersault.view._stills import frame

        return frame(self, time, **look)  # type: ignore[arg-type]

    def page(self, path: str | os.PathLike[str], title: str | None = None) -> None:
        """Write a page that plays it in a browser, without a network: `view.page` of it.

        Parameters
        ----------
        path : path-like
            A .html file.
        title : str, optional
            The heading; the model's name, if it is not given.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> import somersault as so
        >>> flight = so.fly("furrer", so.Takeoff(spin=8.6, tilt=0.05), 0.1)
        >>> with TemporaryDirectory() as folder:
        ...     flight.page(f"{folder}/layout.html")
        """
        from somersault.view._page import page

        page(self, path, title=title)  # type: ignore[arg-type]

    def picture(
        self,
        path: str | os.PathLike[str],
        times: float | Sequence[float] | Array | None = None,
        columns: int = 6,
        **look: Any,
    ) -> None:
        """Write a frame or a contact sheet as .png: `view.picture` of it.

        Parameters
        ----------
        path : path-like
            A .png file.
        times : float or sequence of float, optional
            s; twelve from beginning to end, if they are not given.
        columns : int
            Frames in a row.
        **look
            As of a film; `size` is that of each frame.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> import somersault as so
        >>> flight = so.fly("furrer", so.Takeoff(spin=8.6, tilt=0.05), 0.1)
        >>> with TemporaryDirectory() as folder:
        ...     flight.picture(f"{folder}/layout.png", [0.0, 0.1], size=(160, 90))
        """
        from somersault.view._stills import picture

        picture(self, path, times, columns, **look)  # type: ignore[arg-type]

    def stroboscopic_picture(
        self,
        path: str | os.PathLike[str],
        times: int | Sequence[float] | Array = 9,
        **look: Any,
    ) -> None:
        """Write all poses of its way in one .png: `view.stroboscopic_picture` of it.

        Parameters
        ----------
        path : path-like
            A .png file.
        times : int or sequence of float
            s, or how many from beginning to end.
        **look
            As of a film.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> import somersault as so
        >>> rising = so.Takeoff(spin=8.6, velocity=(2.0, 0.0, 3.0))
        >>> flight = so.fly("furrer", rising, 0.6, gravity=(0.0, 0.0, -9.81))
        >>> with TemporaryDirectory() as folder:
        ...     flight.stroboscopic_picture(f"{folder}/layout.png", 3, size=(160, 90))
        """
        from somersault.view._stills import stroboscopic_picture

        stroboscopic_picture(self, path, times, **look)  # type: ignore[arg-type]
