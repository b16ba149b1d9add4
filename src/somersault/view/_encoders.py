"""Frames to the bytes of a film, one class for each kind of file."""

from __future__ import annotations

import importlib.util
import io
from abc import ABC, abstractmethod
from collections.abc import Mapping
from fractions import Fraction
from typing import Any, ClassVar, cast

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError

# With two a film was, once in a hundred times, another one byte for byte. With one it still may be,
# in a few hundred times, where the height is no multiple of 16: x264 fills up the last blocks.
_THREADS = 1


class Encoder(ABC):
    """A film that grows by frames (height, width, 4) of bytes.

    Parameters
    ----------
    size : (int, int)
        Width and height.
    fps : int
        Frames per second.
    """

    ending: ClassVar[str]
    most_pixels: ClassVar[float] = np.inf  # in all frames together

    @abstractmethod
    def __init__(self, size: tuple[int, int], fps: int) -> None: ...

    @classmethod
    @abstractmethod
    def check(cls) -> None:
        """SomersaultError unless films of this kind can be made here."""

    @abstractmethod
    def add(self, frame: Array) -> None:
        """One more frame."""

    @abstractmethod
    def finished(self) -> bytes:
        """The file."""


class _Video(Encoder):
    """Through PyAV, which brings FFmpeg."""

    container: ClassVar[str]
    codec: ClassVar[str]
    options: ClassVar[Mapping[str, str]]

    def __init__(self, size: tuple[int, int], fps: int) -> None:
        import av

        self._held = io.BytesIO()
        self._file = av.open(self._held, "w", format=self.container)
        stream = cast(Any, self._file.add_stream(self.codec, fps, options=dict(self.options)))
        stream.width, stream.height = size
        stream.pix_fmt = "yuv420p"
        context = stream.codec_context
        context.thread_count = _THREADS
        context.time_base = Fraction(1, fps)
        context.colorspace = context.color_primaries = context.color_trc = 1  # ITU-R BT.709
        self._stream = stream
        self._count = 0

    @classmethod
    def check(cls) -> None:
        """SomersaultError without PyAV."""
        if importlib.util.find_spec("av") is None:
            raise SomersaultError(
                f"{cls.ending} films need PyAV; pip install somersault[film], or write a .gif"
            )

    def add(self, frame: Array) -> None:
        """One more frame."""
        import av

        raw = av.VideoFrame.from_ndarray(np.ascontiguousarray(frame), format="rgba")
        flat = raw.reformat(format="yuv420p", dst_colorspace="ITU709")
        flat.pts, flat.time_base = self._count, self._stream.codec_context.time_base
        self._count += 1
        self._file.mux(self._stream.encode(flat))

    def finished(self) -> bytes:
        """The file."""
        self._file.mux(self._stream.encode(None))
        self._file.close()
        return self._held.getvalue()


class Mp4(_Video):
    """H.264, which everything plays."""

    ending, container, codec = ".mp4", "mp4", "libx264"
    options: ClassVar[Mapping[str, str]] = {
        "preset": "veryfast", "crf": "19", "movflags": "+faststart",
    }  # fmt: skip


class WebM(_Video):
    """VP9, free of patents."""

    ending, container, codec = ".webm", "webm", "libvpx-vp9"
    options: ClassVar[Mapping[str, str]] = {
        "deadline": "realtime", "cpu-used": "7", "crf": "30", "b": "0", "row-mt": "1",
    }  # fmt: skip


class Gif(Encoder):
    """GIF by Pillow, which matplotlib brings; its delays are hundredths of a second."""

    ending = ".gif"
    most_pixels = 5e8  # they are all in memory at once, a byte each

    def __init__(self, size: tuple[int, int], fps: int) -> None:
        self._fps = fps
        self._frames: list[Any] = []

    @classmethod
    def check(cls) -> None:
        """They can be made everywhere."""

    def add(self, frame: Array) -> None:
        """One more frame, in the colours of the first."""
        from PIL import Image

        image = Image.fromarray(np.ascontiguousarray(frame[..., :3]))
        if not self._frames:
            self._frames.append(image.quantize(255, dither=Image.Dither.NONE))
        else:
            palette = self._frames[0]
            self._frames.append(image.quantize(palette=palette, dither=Image.Dither.NONE))

    def finished(self) -> bytes:
        """The file."""
        ends = np.round(100 * np.arange(len(self._frames) + 1) / self._fps).astype(int)
        delays = (10 * np.maximum(2, np.diff(ends))).tolist()
        held = io.BytesIO()
        self._frames[0].save(
            held, "GIF", save_all=True, append_images=self._frames[1:], duration=delays, loop=0
        )
        return held.getvalue()


ENCODERS: Mapping[str, type[Encoder]] = {kind.ending: kind for kind in (Mp4, WebM, Gif)}
