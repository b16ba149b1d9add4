"""Motions: what some joints of a model do as time goes on.

A `Motion` is a value, made of one piecewise quintic (`_path.Path`) a joint: from keyframes by
`Motion.moves`, from samples by `_motion_samples.sampled_motion`, from files by
`_motion_files.read_motion`. It can be mirrored, stretched and shifted in time, and says whether
it fits a model.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import degrees, pi

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, instance, text, truth
from somersault._core.errors import SomersaultError
from somersault._core.numbers import MOST, number
from somersault.model import (
    LIMIT_SLACK,
    Joint,
    Model,
    Pair,
    load,
    mirror_images,
    named_pairs,
    sides,
)
from somersault.motion._path import DEGREE, Path, check_rows, increasing, moves, polynomial
from somersault.motion._recorded_base import RecordedBase

_TURNS = 4 * pi  # rad: no joint winds up so far; degrees read as radians soon do
_BETWEEN = 4  # points within each piece at which limits are checked beside its extremes


@dataclass(frozen=True, eq=False)
class Motion:
    """Paths of some joints by name over time, in radians (metres for slides) and seconds.

    `begin` and `end` (s) are the first and last time at which anything is known. A motion that is
    `held` rests before and after (keyframes); one that is not was only recorded between the two,
    and a flight may not go beyond. `source` says in words where it came from and what was done to
    it; `filtered` how far the filter moved the samples of each joint at most (rad, m); `slack`
    how far beyond its limits a joint may be (rad, m); `base` where the base was, if that was
    recorded. Made by `Motion.moves`, `sampled_motion` and `read_motion`. Raises SomersaultError
    for paths that are none.
    """

    paths: Mapping[str, Path]
    begin: float
    end: float
    held: bool
    source: str = ""
    filtered: Mapping[str, float] = field(default_factory=dict)
    slack: float = 0.0
    base: RecordedBase | None = None

    def __post_init__(self) -> None:
        truth("held", self.held)
        text("source", self.source)
        check_slack(self.slack)
        if not number("begin", self.begin) <= number("end", self.end):
            raise SomersaultError(f"a motion from {self.begin:g} to {self.end:g} s ends too soon")
        if not by_name("paths", self.paths):
            raise SomersaultError("a motion without joints moves nothing; name at least one joint")
        for name, path in self.paths.items():
            _check_path(name, instance(f"joint {name}: path", path, Path))
        kept = {n: Path(_kept(p.knots), _kept(p.coefficients)) for n, p in self.paths.items()}
        object.__setattr__(self, "paths", kept)
        object.__setattr__(self, "filtered", by_name("filtered", self.filtered))

    @classmethod
    def moves(
        cls, model: str | Model, keyframes: Mapping[str, Sequence[tuple[float, float]]]
    ) -> Motion:
        """Smooth moves through keyframes (time in s, angle in rad or m), each joint its own.

        At rest at every keyframe; between two of them the quintic 10 s³ − 15 s⁴ + 6 s⁵, which
        does not overshoot; held before the first and after the last. A left–right pair may be
        named once by its common name, with the left side's angles; the right side is mirrored.
        Raises SomersaultError for unknown joints, angles outside their limits, and times that
        do not increase.
        """
        model = load(model)
        if not isinstance(keyframes, Mapping):
            raise SomersaultError("keyframes are a dict of joints' names to lists of (time, angle)")
        rows = {name: _keyframes(name, row) for name, row in keyframes.items()}
        paths = {
            joint: moves(rows[name][:, 0].copy(), offset + factor * rows[name][:, 1])
            for joint, (name, factor, offset) in spread(model, rows).items()
        }
        ends = [time for path in paths.values() for time in path.knots[[0, -1]].tolist()]
        motion = cls(paths, min(ends, default=0.0), max(ends, default=0.0), True, "keyframes")
        motion.check(model)
        return motion

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints that it moves."""
        return tuple(self.paths)

    @property
    def duration(self) -> float:
        """Seconds from `begin` to `end`."""
        return self.end - self.begin

    def values(self, times: Sequence[float] | Array) -> tuple[Array, Array, Array]:
        """Values (rad, m), rates (per s) and accelerations (per s²) at times (T,) in s.

        Each (T, joints), in the order of `joints`. Raises SomersaultError for times at which a
        recorded motion is not known.
        """
        at = finite("times", times)
        if at.size:
            self._covers(float(at.min()), float(at.max()))
        result = np.empty((3, len(at), len(self.paths)))
        for place, path in enumerate(self.paths.values()):
            piece = np.searchsorted(path.knots, at, side="right")
            since = at - path.knots[np.maximum(piece - 1, 0)]
            result[:, :, place] = polynomial(since, tuple(path.coefficients[piece].T))
        return result[0], result[1], result[2]

    def mirrored(self, model: str | Model) -> Motion:
        """The same motion seen in a mirror: left joints do what right ones did, and the reverse.

        Raises SomersaultError for a joint that has no mirror image in the model.
        """
        model = load(model)
        images = mirror_images(model)
        paths = {}
        for name, path in self.paths.items():
            model.joint(name)
            if name not in images:
                raise SomersaultError(
                    f"joint {name} has no mirror image in {model.name}, so the motion has none; "
                    "leave the joint out or make the model symmetric"
                )
            image, factor, offset = images[name]
            paths[image] = path.image(factor, offset)
        filtered = {images[name][0]: moved for name, moved in self.filtered.items()}
        motion = replace(
            self,
            paths=paths,
            filtered=filtered,
            source=f"{self.source}; mirrored".lstrip("; "),
            base=self.base and self.base.mirrored(),
        )
        motion.check(model)
        return motion

    def scaled(self, factor: float) -> Motion:
        """The same motion in `factor` times its time, about time 0: 2 is half as fast."""
        factor = number("factor", factor)
        if factor <= 0:
            raise SomersaultError(f"factor {factor:g} turns time back or stops it; give one over 0")
        paths = {name: path.scaled(factor) for name, path in self.paths.items()}
        return replace(
            self,
            paths=paths,
            begin=self.begin * factor,
            end=self.end * factor,
            source=f"{self.source}; time times {factor:g}".lstrip("; "),
            base=self.base and self.base.at_times(factor, 0.0),
        )

    def delayed(self, seconds: float) -> Motion:
        """The same motion, later by some seconds; earlier where that is negative."""
        delay = number("delay", seconds)
        paths = {name: path.delayed(delay) for name, path in self.paths.items()}
        return replace(
            self,
            paths=paths,
            begin=self.begin + delay,
            end=self.end + delay,
            source=f"{self.source}; delayed by {delay:g} s".lstrip("; "),
            base=self.base and self.base.at_times(1.0, delay),
        )

    def check(self, model: str | Model) -> None:
        """SomersaultError unless a model has these joints and they stay within their limits.

        Over the whole path, between knots too: extremes are found as roots of the rate.
        """
        model = load(model)
        for name, path in self.paths.items():
            joint = model.joint(name)
            if joint.kind == "ball":
                raise SomersaultError(
                    f"joint {name} is a ball, which no motion prescribes; give the model hinges"
                )
            check_within(joint, *_extremes(path, self.end), self.slack)

    def joint_paths(self, model: str | Model, duration: float | None = None) -> dict[str, Path]:
        """The path of each joint that it moves, checked against a model; others are left out.

        With `duration` (s), also that the motion is known from 0 until then. Raises
        SomersaultError where it does not fit.
        """
        self.check(model)
        if duration is not None:
            if number("duration", duration) <= 0:
                raise SomersaultError(f"duration {duration:g} s is none; give a positive number")
            self._covers(0.0, duration)
        if self.held:
            return dict(self.paths)
        known = (self.begin, self.end)
        return {n: Path(p.knots, p.coefficients, known) for n, p in self.paths.items()}

    def _covers(self, first: float, last: float) -> None:
        if not self.held and (first < self.begin - 1e-9 or last > self.end + 1e-9):
            raise SomersaultError(
                f"the motion is recorded from {self.begin:g} to {self.end:g} s and asked for from "
                f"{first:g} to {last:g} s; ask within the recording, or shift it with delayed()"
            )


def nameable(model: Model) -> set[str]:
    """Names under which a motion may be given: joints, and pairs by what they share."""
    return {joint.name for joint in model.joints} | set(_pairs(model))


def spread(model: Model, names: Iterable[str]) -> dict[str, tuple[str, float, float]]:
    """For each joint that is meant: the name it was given by, and its own angle from that name's.

    The angle is offset + factor · the one given; (name, factor, offset). Raises SomersaultError
    for unknown joints and those given twice.
    """
    pairs = _pairs(model)
    joints: dict[str, tuple[str, float, float]] = {}
    for name in names:
        meant = sides(model, name) if name in pairs else {name: (1.0, 0.0)}
        for joint, (factor, offset) in meant.items():
            model.joint(joint)
            if joint in joints:
                raise SomersaultError(f"joint {joint} is given twice, alone and with its pair")
            joints[joint] = (name, factor, offset)
    return joints


def finite(what: str, values: Sequence[float] | Array) -> Array:
    """A row of finite numbers; SomersaultError naming `what`, and which, for anything else."""
    try:
        row = np.asarray(values, float)
    except (TypeError, ValueError, OverflowError):
        row = np.empty((0, 0))
    if row.ndim != 1:
        raise SomersaultError(f"{what} must be a row of numbers; give a list of them")
    wrong = np.flatnonzero(~(np.abs(row) <= MOST))
    if wrong.size:
        raise SomersaultError(
            f"{what} must be finite and below 1e9, and number {wrong[0] + 1} is "
            f"{row[wrong[0]]:g}; correct it or leave it out"
        )
    return row


def check_slack(slack: float) -> float:
    """How far beyond its limits a joint may be; SomersaultError for what is negative."""
    if number("slack", slack) < 0:
        raise SomersaultError(f"slack must not be negative, and is {slack:g}")
    return float(slack)


def check_within(joint: Joint, values: Array, times: Array, slack: float) -> None:
    """SomersaultError where a joint's values (K,) at times (K,) go beyond its limits by `slack`.

    Says so where they look like degrees.
    """
    largest = float(np.abs(values).max(initial=0.0))
    unit = "m" if joint.kind == "slide" else "rad"
    if joint.limits is None:
        if joint.kind == "hinge" and largest > _TURNS:
            raise SomersaultError(
                f"joint {joint.name} reaches {largest:g} rad, which looks like degrees; say that "
                "they are degrees, convert them, or give the joint limits in the model"
            )
        return
    least, most = joint.limits
    beyond = np.maximum(least - values, values - most)
    worst = int(np.argmax(beyond))
    if beyond[worst] <= max(slack, LIMIT_SLACK):
        return
    angle = float(values[worst])
    if joint.kind == "hinge" and largest > 2 * pi:
        mend = "which looks like degrees; say that they are degrees, or convert them"
    else:
        mend = "so change the motion, or the limits in the model"
    shown = f"{angle:.6g} {unit}" + (f" ({degrees(angle):.4g}°)" if unit == "rad" else "")
    raise SomersaultError(
        f"joint {joint.name}: {shown} at {times[worst]:.6g} s is outside its limits {least:g} to "
        f"{most:g}, {mend}"
    )


def _kept(values: Array) -> Array:
    """A copy that nobody writes to."""
    kept = np.array(values, float)
    kept.flags.writeable = False
    return kept


def _check_path(name: str, path: Path) -> None:
    shape = (len(path.knots) + 1, DEGREE + 1)
    if path.knots.ndim != 1 or not path.knots.size or path.coefficients.shape != shape:
        raise SomersaultError(f"joint {name}: a path has K knots and (K + 1, 6) coefficients")
    if not (np.all(np.isfinite(path.knots)) and np.all(np.isfinite(path.coefficients))):
        raise SomersaultError(f"joint {name}: its path holds numbers that are not finite")
    if not increasing(path.knots):
        raise SomersaultError(
            f"joint {name}: its knots are closer than a microsecond; stretch the motion in time"
        )


def _keyframes(name: str, rows: Sequence[tuple[float, float]]) -> Array:
    """Times and angles of one joint, (K, 2)."""
    try:
        table = np.asarray(rows, float)
    except (TypeError, ValueError, OverflowError):
        table = np.empty(0)
    if table.ndim != 2 or table.shape[1] != 2:
        raise SomersaultError(f"joint {name}: keyframes are a list of (time, angle) pairs")
    times, angles = (
        finite(f"joint {name}: {what}", column)
        for what, column in zip(("times", "angles"), table.T, strict=True)
    )
    try:
        check_rows(times, angles, "angles")
    except SomersaultError as mistake:
        raise SomersaultError(f"joint {name}: its motion {mistake}; put them in order") from None
    return table


def _pairs(model: Model) -> dict[str, Pair]:
    """Pairs of hinges or slides of either side, by the name that they share."""
    joints = {joint.name for joint in model.joints if joint.kind != "ball"}
    return {n: pair for n, pair in named_pairs(model).items() if model.speeds[pair.left] in joints}


def _extremes(path: Path, end: float) -> tuple[Array, Array]:
    """Values and times among which are a path's least and greatest until `end`."""
    from scipy.interpolate import PPoly

    breaks = np.append(path.knots, end) if end > path.knots[-1] else path.knots
    if len(breaks) == 1:
        return path.coefficients[-1:, 0], breaks
    pieces = PPoly(path.coefficients[1 : len(breaks)].T[::-1], breaks)
    turning = pieces.derivative().roots(extrapolate=False)
    inside = breaks[:-1, None] + np.diff(breaks)[:, None] * np.linspace(0, 1, _BETWEEN + 2)[1:-1]
    times = np.concatenate([breaks, inside.ravel(), turning[np.isfinite(turning)]])
    return pieces(times), times
