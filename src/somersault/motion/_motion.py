"""Motions: what some joints of a model do as time goes on.

A `Motion` is a value, made of one piecewise quintic (`Path`) per joint: from keyframes by
`Motion.moves`, from samples by `sampled_motion`, from files by `read_motion`. It can be
mirrored, stretched and shifted in time, and says whether it fits a model.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, instance, text, truth
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.model import Model, load, mirror_images
from somersault.motion._limits import check_slack, check_within, extremes
from somersault.motion._names import spread
from somersault.motion._path import DEGREE, Path, increasing, moves, polynomial
from somersault.motion._recorded_base import RecordedBase
from somersault.motion._rows import finite, keyframe_table


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
        """Smooth moves through keyframes, each joint with its own.

        Joints are at rest at every keyframe. Between two of them they follow the quintic
        10 s³ − 15 s⁴ + 6 s⁵, which does not overshoot. Before the first keyframe and after the last
        they hold their angle.

        Parameters
        ----------
        model : str or Model
            A shipped model's name, a model file, or a model.
        keyframes : mapping of str to sequence of (float, float)
            Times (s) and angles (rad; m for slides) by joint. A left–right pair may be named once
            by its common name, with the left side's angles; the right side is mirrored.

        Returns
        -------
        Motion

        Raises
        ------
        SomersaultError
            For an unknown joint, an angle outside its limits, or times that do not increase.

        Examples
        --------
        >>> import somersault as so
        >>> raised = so.Motion.moves("furrer", {"shoulder": [(0.0, 0.0), (0.2, 1.2)]})
        >>> raised.joints
        ('left_shoulder', 'right_shoulder')
        """
        model = load(model)
        if not isinstance(keyframes, Mapping):
            raise SomersaultError("keyframes are a dict of joints' names to lists of (time, angle)")
        rows = {name: keyframe_table(name, row) for name, row in keyframes.items()}
        paths = {
            joint: moves(rows[name][:, 0].copy(), offset + factor * rows[name][:, 1])
            for joint, (name, factor, offset) in spread(model, rows).items()
        }
        ends = [time for path in paths.values() for time in path.knots[[0, -1]].tolist()]
        motion = cls(paths, min(ends, default=0.0), max(ends, default=0.0), True, "keyframes")
        motion.check(model)
        return motion

    def __repr__(self) -> str:
        return f"Motion({len(self.paths)} joints, {self.begin:g} to {self.end:g} s, {self.source})"

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints that it moves."""
        return tuple(self.paths)

    @property
    def duration(self) -> float:
        """Seconds from `begin` to `end`."""
        return self.end - self.begin

    def values(self, times: Sequence[float] | Array) -> tuple[Array, Array, Array]:
        """Values, rates and accelerations of the joints at some times.

        Parameters
        ----------
        times : array_like, shape (T,)
            s.

        Returns
        -------
        values, rates, accelerations : numpy.ndarray, shape (T, joints)
            rad or m, per s and per s², in the order of `joints`.

        Raises
        ------
        SomersaultError
            For a time at which a recorded motion is not known.

        Examples
        --------
        >>> import somersault as so
        >>> raised = so.Motion.moves("furrer", {"left_shoulder": [(0.0, 0.0), (0.2, 1.2)]})
        >>> raised.values([0.0, 0.1, 0.2])[0].round(12).tolist()
        [[0.0], [0.6], [1.2]]
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

        Parameters
        ----------
        model : str or Model
            The model that moves; it says which joints are mirror images.

        Returns
        -------
        Motion

        Raises
        ------
        SomersaultError
            For a joint that has no mirror image in the model.

        Examples
        --------
        >>> import somersault as so
        >>> left = so.Motion.moves("furrer", {"left_shoulder": [(0.0, 0.0), (0.2, 1.2)]})
        >>> left.mirrored("furrer").joints
        ('right_shoulder',)
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
        """The same motion in another time, stretched about time 0.

        Parameters
        ----------
        factor : float
            Times are multiplied by it: 2 is half as fast.

        Returns
        -------
        Motion

        Raises
        ------
        SomersaultError
            Unless the factor is positive.

        Examples
        --------
        >>> import somersault as so
        >>> raised = so.Motion.moves("furrer", {"left_shoulder": [(0.0, 0.0), (0.2, 1.2)]})
        >>> raised.scaled(2.0).end
        0.4
        """
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
        """The same motion at a later time.

        Parameters
        ----------
        seconds : float
            By how much later, s; earlier where it is negative.

        Returns
        -------
        Motion

        Raises
        ------
        SomersaultError
            For a delay that is not a finite number.

        Examples
        --------
        >>> import somersault as so
        >>> raised = so.Motion.moves("furrer", {"left_shoulder": [(0.0, 0.0), (0.2, 1.2)]})
        >>> raised.delayed(0.1).begin
        0.1
        """
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
        """Check that a model has these joints and that they stay within their limits.

        The whole path is checked, between knots too: its extremes are the roots of its rate.

        Parameters
        ----------
        model : str or Model

        Raises
        ------
        SomersaultError
            For a joint that the model does not have, a ball joint, or an angle outside the limits
            by more than the motion's slack.

        Examples
        --------
        >>> import somersault as so
        >>> raised = so.Motion.moves("furrer", {"left_shoulder": [(0.0, 0.0), (0.2, 1.2)]})
        >>> raised.check("furrer")
        """
        model = load(model)
        for name, path in self.paths.items():
            joint = model.joint(name)
            if joint.kind == "ball":
                raise SomersaultError(
                    f"joint {name} is a ball, which no motion prescribes; give the model hinges"
                )
            check_within(joint, *extremes(path, self.end), self.slack)

    def joint_paths(self, model: str | Model, duration: float | None = None) -> dict[str, Path]:
        """The path of each joint that the motion moves, checked against a model.

        Parameters
        ----------
        model : str or Model
        duration : float, optional
            s; if it is given, the motion must be known from 0 until then.

        Returns
        -------
        dict of str to Path
            By joint. Joints that the motion does not move are left out.

        Raises
        ------
        SomersaultError
            Where the motion does not fit the model, or is not known for that long.

        Examples
        --------
        >>> import somersault as so
        >>> raised = so.Motion.moves("furrer", {"shoulder": [(0.0, 0.0), (0.2, 1.2)]})
        >>> sorted(raised.joint_paths("furrer", 1.0))
        ['left_shoulder', 'right_shoulder']
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
