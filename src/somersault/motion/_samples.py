"""Motions from samples: evenly spaced, low-pass filtered, and made quintic splines.

The filter is the one usual in biomechanics (Winter 2009, Biomechanics and Motor Control of Human
Movement, 4th ed., section 3.4.4; Robertson et al. 2014, Research Methods in Biomechanics, 2nd ed.,
ch. 12): a Butterworth of order two, forwards and backwards in time, so of order four and without
lag, its own cut-off raised so that both passes together have 1/√2 of the amplitude at the one
that is asked for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import factorial
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, text
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats, number
from somersault.model import Model, load
from somersault.motion._jumps import refuse_jumps, without_turns
from somersault.motion._limits import check_slack, check_within
from somersault.motion._motion import Motion
from somersault.motion._names import spread
from somersault.motion._path import DEGREE, Path
from somersault.motion._rows import finite

# Gait is filtered at 6 Hz; that would move an arm that drops by 1.5 rad in 0.2 s, as twisting
# gymnasts' do, by 0.03 rad. At 10 Hz it is 0.005 rad, no more than cameras err.
CUTOFF = 10.0  # Hz
SLACK = 0.02  # rad: a degree, about what filter and spline overshoot where a limb stops at a limit
MOST_SAMPLES = 200_000
FEWEST_SAMPLES = DEGREE + 1
SLOWEST = 1.0  # Hz; a flight of a second or two cannot be told from less
_PASSES = 2
_GAP = 2.5  # median steps: one lost sample is bridged, two are a gap
_EVEN = 1e-3  # of a step
_SLOWEST_CUTOFF = 1e-4  # of the rate: below it rounding moves the samples by more than 1e-9


def sampled_motion(
    model: str | Model,
    times: Sequence[float] | Array,
    values: Mapping[str, Sequence[float] | Array],
    *,
    cutoff: float | None = CUTOFF,
    rate: float | None = None,
    start: float | None = None,
    stop: float | None = None,
    gap: float | None = None,
    slack: float = SLACK,
    source: str = "samples",
) -> Motion:
    """A motion through samples of joints' angles.
     Times that are uneven by more than a thousandth of a step are made even by a cubic spline, at
    their mean rate. Then all samples are low-pass filtered, and a quintic spline is laid through
    them: angle, rate, acceleration and two more derivatives are continuous. An angle that jumps by
    a whole turn between two samples goes on, with a SomersaultWarning; any other jump is refused.

    Parameters
    ----------
    model : str or Model
        A shipped model's name, a model file, or a model.
    times : array_like, shape (T,)
        Increasing, s.
    values : mapping of str to array_like, shape (T,)
        Angles (rad; m for slides) by joint. A left–right pair may be given once by its common name,
        with the left side's angles.
    cutoff : float or None
        Of the low-pass filter, Hz; None for no filter.
    rate : float, optional
        How many knots a second the spline has, Hz; by default as many as there are samples. Every
        knot costs a flight time.
    start, stop : float, optional
        A part of the samples, in their own time, s; it is taken after filtering. The motion's time
        0 is `start`, by default the first sample.
    gap : float, optional
        The longest step between samples that is accepted, s; by default 2.5 median steps.
    slack : float
        By how much samples and path may be beyond the joints' limits, rad or m.
    source : str
        What a message calls the samples.

    Returns
    -------
    Motion

    Raises
    ------
    SomersaultError
        For samples that are refused: jumps, gaps, angles beyond limits, unknown joints, numbers
        that are not finite, and a part or a filter that does not fit them.

    Examples
    --------
    >>> import numpy as np
    >>> import somersault as so
    >>> times = np.linspace(0.0, 1.0, 101)
    >>> swung = so.sampled_motion("furrer", times, {"left_shoulder": 0.5 * times})
    >>> swung.joints, swung.end
    (('left_shoulder',), 1.0)
    """
    model = load(model)
    text("source", source)
    at = _times(times, gap)
    first = float(at[0]) if start is None else number("start", start)
    last = float(at[-1]) if stop is None else number("stop", stop)
    if not at[0] <= first < last <= at[-1]:
        raise SomersaultError(
            f"start {first:g} and stop {last:g} s are no part of samples from {at[0]:g} to "
            f"{at[-1]:g} s; choose a part of them"
        )
    rows = {name: _row(name, row, at) for name, row in by_name("samples", values).items()}
    joints = spread(model, rows)
    if not joints:
        raise SomersaultError("samples of no joint make no motion; name at least one joint")
    raw = np.stack([c + k * rows[name] for name, k, c in joints.values()], 1)
    slack = check_slack(slack)
    chosen = (at >= first) & (at <= last)
    for column, name in enumerate(joints):
        joint = model.joint(name)
        if joint.kind == "hinge":
            raw[:, column] = without_turns(name, source, at, raw[:, column])
        check_within(joint, raw[chosen, column], at[chosen], slack)
        if joint.kind == "hinge":
            refuse_jumps(name, at, raw[:, column], first, last)
    even, samples, said = _even(at, raw)
    frequency = (len(even) - 1) / float(even[-1] - even[0])
    if frequency < SLOWEST:
        raise SomersaultError(
            f"samples at {frequency:.3g} Hz are too few for a flight, which needs "
            f"{SLOWEST:g} Hz; if the times are milliseconds, give seconds, or call the "
            "column time [ms]"
        )
    smooth = _filtered(samples, frequency, cutoff)
    moved = np.abs(smooth - samples).max(0)
    knots = _knots(first, last, frequency if rate is None else number("rate", rate))
    if len(knots) != len(even) or np.abs(knots - even).max() > _EVEN / frequency:
        smooth = _spline(even, smooth)(knots)
    motion = Motion(
        _paths(tuple(joints), knots - first, smooth),
        begin=0.0,
        end=last - first,
        held=False,
        source=f"{source}: {len(at)} samples{said}, {_told(cutoff, moved, tuple(joints))}",
        filtered=dict(zip(joints, moved.tolist(), strict=True)),
        slack=slack,
    )
    motion.check(model)
    return motion


def low_pass(samples: Array, rate: float, cutoff: float) -> Array:
    """Samples without their high frequencies, filtered forwards and backwards, so without lag.

    A Butterworth filter of order two, whose own cutoff is raised so that after both passes the
    amplitude at `cutoff` is 1/√2 of what it was (Winter 2009, §3.4.4).

    Parameters
    ----------
    samples : ndarray, shape (T, ...)
    rate : float
        Samples per second, Hz.
    cutoff : float
        Hz.

    Returns
    -------
    ndarray, shape (T, ...)

    Raises
    ------
    SomersaultError
        For samples that are not finite, and a cutoff that is not between 0 and half the rate.
    """
    from scipy.signal import butter, sosfiltfilt

    samples = floats("samples", samples)
    if not samples.ndim or not len(samples) or not np.all(np.isfinite(samples)):
        raise SomersaultError("samples must be finite numbers along a first dimension of time")
    rate, cutoff = number("rate", rate), number("cutoff", cutoff)
    if not rate * _SLOWEST_CUTOFF <= cutoff < rate / 2:
        raise SomersaultError(
            f"samples at {rate:.4g} Hz cannot be filtered at {cutoff:g} Hz; give a cutoff from "
            f"{rate * _SLOWEST_CUTOFF:.4g} to {rate / 2:.4g}, or none to filter nothing (0 in a "
            "SPEC), and see that times are in seconds"
        )
    once = np.tan(np.pi * cutoff / rate) / (2 ** (1 / _PASSES) - 1) ** 0.25
    sections = butter(2, np.arctan(once) * rate / np.pi, fs=rate, output="sos")
    # Beyond the ends the samples go on point-symmetrically, for as long as the filter remembers.
    beyond = min(len(samples) - 1, int(np.ceil(3 * rate / cutoff)))
    return sosfiltfilt(sections, samples, axis=0, padtype="odd", padlen=beyond)


def _times(times: Sequence[float] | Array, gap: float | None) -> Array:
    """Increasing times without gaps, (T,)."""
    at = finite("times", times)
    if len(at) < FEWEST_SAMPLES:
        raise SomersaultError(
            f"{len(at)} samples are too few for a quintic spline; give {FEWEST_SAMPLES} at least, "
            "or keyframes"
        )
    if len(at) > MOST_SAMPLES:
        raise SomersaultError(
            f"{len(at)} samples are too many; give {MOST_SAMPLES} at most, of the flight alone"
        )
    steps = np.diff(at)
    wrong = int(np.argmin(steps))
    if steps[wrong] <= 0:
        what = "occurs twice" if steps[wrong] == 0 else f"comes before {at[wrong + 1]:g} s"
        raise SomersaultError(
            f"time {at[wrong]:g} s {what}; sort the samples by time, each time once"
        )
    median = float(np.median(steps))
    longest = _GAP * median if gap is None else number("gap", gap)
    widest = int(np.argmax(steps))
    if steps[widest] > longest:
        raise SomersaultError(
            f"samples are missing between {at[widest]:g} and {at[widest + 1]:g} s (the median step "
            f"is {median:g} s); fill the gap, take a part with start and stop, or set gap"
        )
    return at


def _row(name: str, row: Sequence[float] | Array, at: Array) -> Array:
    values = finite(f"joint {name}", row)
    if len(values) != len(at):
        raise SomersaultError(
            f"joint {name} has {len(values)} values at {len(at)} times; give one a time"
        )
    return values


def _even(at: Array, samples: Array) -> tuple[Array, Array, str]:
    """Evenly spaced times and samples (T, joints), and in words what was done for it."""
    even = np.linspace(at[0], at[-1], len(at))
    step = float(even[1] - even[0])
    if np.abs(at - even).max() <= _EVEN * step:
        return even, samples, f" at {1 / step:.6g} Hz"
    return even, _spline(at, samples, 3)(even), f", uneven, made even at {1 / step:.6g} Hz"


def _filtered(samples: Array, rate: float, cutoff: float | None) -> Array:
    if cutoff is None:
        return samples
    return low_pass(samples, rate, cutoff)


def _knots(first: float, last: float, rate: float) -> Array:
    """Evenly spaced times from first to last, about `rate` a second."""
    steps = (last - first) * rate
    if not FEWEST_SAMPLES - 1.5 < steps < MOST_SAMPLES:
        raise SomersaultError(
            f"{last - first:g} s at {rate:g} Hz is too short or too long for a quintic spline; "
            f"give a part and a rate with {FEWEST_SAMPLES} to {MOST_SAMPLES} samples"
        )
    return np.linspace(first, last, round(steps) + 1)


def _spline(times: Array, samples: Array, degree: int = DEGREE) -> Any:
    from scipy.interpolate import make_interp_spline

    return make_interp_spline(times, samples, k=degree)


def _paths(joints: tuple[str, ...], times: Array, samples: Array) -> dict[str, Path]:
    """One quintic spline a joint, through samples (T, joints).

    The first and last pieces go on beyond the ends, so that rates there are the recording's.
    """
    spline = _spline(times, samples)
    starts = spline.t[DEGREE : len(times)]  # of its pieces; at the ends it repeats knots
    taylor = [spline(starts, nu=k) / factorial(k) for k in range(DEGREE + 1)]
    pieces = np.stack(taylor, -1)  # (pieces, joints, powers)
    whole = np.concatenate([pieces[:1], pieces])
    return {name: Path(starts, whole[:, k]) for k, name in enumerate(joints)}


def _told(cutoff: float | None, moved: Array, joints: tuple[str, ...]) -> str:
    if cutoff is None:
        return "not filtered"
    worst = int(np.argmax(moved))
    return (
        f"Butterworth low-pass of order 4 without lag, -3 dB at {cutoff:g} Hz, which moved them by "
        f"{moved[worst]:.2g} at most ({joints[worst]})"
    )
