"""What differs between the flights of an ensemble, and by how much."""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from scipy import special

from somersault._core.array import Array
from somersault._core.checks import name_list, shown, text, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats, number, numbers

SEQUENCES = ("random", "sobol", "halton", "saltelli")
_EDGE = 2.0**-54  # keeps draws inside (0, 1), where every distribution is finite
_MOST = 10**7  # values of one grid, which are all held in memory
_LONGEST = 300  # characters of a list that a message shows

# Of each distribution: what its numbers are, and its quantile function.
DISTRIBUTIONS: dict[str, tuple[str, Any]] = {
    "uniform": ("[low, high]", lambda u, low, high: low + (high - low) * u),
    "normal": ("[mean, standard deviation]", lambda u, mean, sd: mean + sd * special.ndtri(u)),
    "truncated_normal": (
        "[mean, standard deviation, low, high]",
        lambda u, mean, sd, low, high: np.clip(
            mean
            + sd
            * special.ndtri(
                special.ndtr((low - mean) / sd)
                + u * (special.ndtr((high - mean) / sd) - special.ndtr((low - mean) / sd))
            ),
            low,
            high,
        ),
    ),
    "triangular": (
        "[low, most likely, high]",
        lambda u, low, mode, high: np.where(
            u * (high - low) < mode - low,
            low + np.sqrt(u * (high - low) * (mode - low)),
            high - np.sqrt((1 - u) * (high - low) * (high - mode)),
        ),
    ),
    "lognormal": (
        "[median, standard deviation of the logarithm]",
        lambda u, median, sd: median * np.exp(sd * special.ndtri(u)),
    ),
}


@dataclass(frozen=True)
class Vary:
    """One varied quantity: which numbers it is, and the values it takes.

    Its values are a grid (`values`), along a dimension of its own, or run along the dimension
    `sample`, with the same draws at every point of the grids: `samples` one by one, or one of the
    distributions.

    Parameters
    ----------
    sets, adds_to : str or sequence of str
        The numbers that it sets, or is added to; several are moved together. Of flights they are
        named "takeoff.tilt", "takeoff.angular_momentum.2", "joints.NAME.angle" (or what else the
        joint's behaviour has: rate, stiffness, damping, rest, pretension …; a pair by its common
        name), "joints.NAME.times" for all of them or "joints.NAME.times.2" for one (from 1),
        "joints.NAME.gains.k" and "replay.gains.k" (or another gain, noise or bound of a law),
        "bodies.NAME.mass" (moments of inertia go along with it), "bodies.NAME.com.1",
        "bodies.NAME.position.3".
    values : sequence of float or mapping
        A grid: a list, or {"from": …, "to": …, "count": …}.
    samples : sequence of float
        One for each sample.
    uniform : (low, high)
    normal : (mean, standard deviation)
    truncated_normal : (mean, standard deviation, low, high)
    triangular : (low, most likely, high)
    lognormal : (median, standard deviation of the logarithm)
    scale : float
        The numbers are set to, or moved by, `scale` times the quantity.
    unit : str
        Of the quantity; by default that of the numbers, where they have the same and `scale` is 1.

    Examples
    --------
    >>> import somersault as so
    >>> so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.02]).distribution
    'normal'
    >>> so.Vary(sets="joints.shoulder.angle", values={"from": 0.0, "to": 2.0, "count": 3}).grid
    array([0., 1., 2.])
    """

    sets: str | Sequence[str] = ()
    adds_to: str | Sequence[str] = ()
    values: Sequence[float] | Array | Mapping[str, float] | None = None
    samples: Sequence[float] | Array | None = None
    uniform: Sequence[float] | None = None
    normal: Sequence[float] | None = None
    truncated_normal: Sequence[float] | None = None
    triangular: Sequence[float] | None = None
    lognormal: Sequence[float] | None = None
    scale: float = 1.0
    unit: str = ""

    @property
    def distribution(self) -> str | None:
        """Name of the distribution it is drawn from."""
        return next((d for d in DISTRIBUTIONS if getattr(self, d) is not None), None)

    @property
    def targets(self) -> tuple[str, ...]:
        """Names of the numbers that it sets or is added to."""
        return _names(self.sets) or _names(self.adds_to)

    @property
    def adds(self) -> bool:
        """Whether it is added to numbers, and does not set them."""
        return bool(_names(self.adds_to))

    @cached_property
    def grid(self) -> Array | None:
        """The values of a grid."""
        return None if self.values is None else _listed(self.values)

    def quantile(self, u: Array) -> Array:
        """Values of the distribution at some probabilities.

        Parameters
        ----------
        u : ndarray, (n,)
            In (0, 1).

        Returns
        -------
        ndarray, (n,)
            Where the distribution function is u; inf where that is too large for a number.

        Examples
        --------
        >>> import numpy as np
        >>> import somersault as so
        >>> so.Vary("takeoff.tilt", uniform=[0.0, 0.2]).quantile(np.array([0.25, 0.5]))
        array([0.05, 0.1 ])
        """
        assert self.distribution is not None
        given = [float(x) for x in getattr(self, self.distribution)]
        with np.errstate(over="ignore"):
            return DISTRIBUTIONS[self.distribution][1](floats("u", u), *given)


def _names(given: Any) -> tuple[Any, ...]:
    if isinstance(given, str):
        return (given,) if given else ()
    try:
        return tuple(given)
    except TypeError:
        return ()


def _listed(values: Any) -> Array:
    if isinstance(values, Mapping):
        return np.linspace(values["from"], values["to"], int(values["count"]))
    return np.asarray(values, float)


def written(vary: Vary) -> Any:
    """The numbers that it was given: its grid, its samples, or those of its distribution."""
    if vary.grid is not None:
        return vary.grid
    return vary.samples if vary.distribution is None else getattr(vary, vary.distribution)


def check(name: str, vary: Vary) -> None:
    """SomersaultError, naming the key, unless a varied quantity makes sense."""
    where = f"vary.{name}"
    if not isinstance(vary, Vary):
        raise SomersaultError(f"{where} must be a somersault.Vary, and is {shown(vary)}")
    for what in ("sets", "adds_to"):
        if not isinstance(getattr(vary, what), str):
            name_list(f"{where}.{what}", getattr(vary, what))
    named = vary.targets and all(isinstance(t, str) for t in vary.targets)
    if bool(_names(vary.sets)) == bool(_names(vary.adds_to)) or not named:
        raise SomersaultError(
            f"{where} must have either sets or adds_to, with the names of numbers like "
            "'takeoff.tilt' or 'joints.shoulder.stiffness'"
        )
    number(f"{where}.scale", vary.scale)
    text(f"{where}.unit", vary.unit)
    sources = [s for s in ("values", "samples", *DISTRIBUTIONS) if getattr(vary, s) is not None]
    if len(sources) != 1:
        said = " and ".join(sources) or "none"
        raise SomersaultError(
            f"{where} needs one of values, samples, {', '.join(DISTRIBUTIONS)}; it has {said}"
        )
    if vary.values is not None:
        _check_grid(f"{where}.values", vary.values)
    elif vary.samples is not None:
        if not _row(f"{where}.samples", vary.samples).size:
            raise SomersaultError(f"{where}.samples is empty; give at least one number")
    else:
        _check_distribution(where, vary)


def _check_grid(where: str, values: Any) -> None:
    if isinstance(values, Mapping):
        if set(values) != {"from", "to", "count"}:
            raise SomersaultError(f"{where} must be a list, or have from, to and count")
        for key in ("from", "to"):
            number(f"{where}.{key}", values[key])
        count = values["count"]
        whole_number(f"{where}.count", int(count) if _is_whole(count) else count, 1, _MOST)
        if (values["count"] > 1) == (values["from"] == values["to"]):
            raise SomersaultError(
                f"{where} goes from {values['from']} to {values['to']} in {values['count']} "
                "values; an empty range has one value, and any other at least two"
            )
    listed = _row(where, _listed(values) if isinstance(values, Mapping) else values)
    if not listed.size:
        raise SomersaultError(f"{where} is empty; give at least one number")
    if len(np.unique(listed)) < len(listed):
        raise SomersaultError(f"{where} has the same number twice; leave one out")


def _is_whole(count: Any) -> bool:
    """Whether a float is meant as a whole number, as 1e3 is."""
    return isinstance(count, float) and count.is_integer()


def _row(where: str, given: Any) -> Array:
    """As `numbers`; what it says of very many is cut short."""
    try:
        return numbers(where, given)
    except SomersaultError as mistake:
        said = " ".join(str(mistake).split())
        raise SomersaultError(said if len(said) < _LONGEST else f"{said[:_LONGEST]} …") from None


def _check_distribution(where: str, vary: Vary) -> None:
    kind = vary.distribution
    assert kind is not None
    form = DISTRIBUTIONS[kind][0]
    given = numbers(f"{where}.{kind}", getattr(vary, kind))
    wanted = form.count(",") + 1
    if len(given) != wanted:
        raise SomersaultError(f"{where}.{kind} must be {form}, and is {given.tolist()}")
    ends = {"uniform": (0, 1), "truncated_normal": (2, 3), "triangular": (0, 2)}.get(kind)
    if ends is not None and not given[ends[0]] < given[ends[1]]:
        raise SomersaultError(
            f"{where}.{kind} is an empty range; it must be {form}, low below high"
        )
    if kind == "triangular" and not given[0] <= given[1] <= given[2]:
        raise SomersaultError(f"{where}.{kind} must be {form}, in rising order")
    if kind in ("normal", "truncated_normal", "lognormal") and given[1] <= 0:
        raise SomersaultError(f"{where}.{kind} must be {form}, and that deviation positive")
    if kind == "truncated_normal" and not (
        (given[2] - given[0]) / given[1] < 8 and (given[3] - given[0]) / given[1] > -8
    ):
        raise SomersaultError(f"{where}.{kind} keeps nothing of its bell: the range is too far off")
    if kind == "lognormal" and given[0] <= 0:
        raise SomersaultError(f"{where}.{kind} must be {form}, and its median positive")


def draws(vary: Mapping[str, Vary], sequence: str, seed: int, places: Array) -> dict[str, Array]:
    """Values of what is drawn or listed, at rising places (n,) along `sample`.

    Every place has its own draw, the same whichever others are asked for with it.
    """
    if not len(places):
        return {name: np.empty(0) for name in vary}
    first, last = int(places[0]), int(places[-1])
    within = places - first
    drawn = [name for name, v in vary.items() if v.distribution is not None]
    values = {}
    uniforms = _uniforms(drawn, sequence, seed, first, last + 1 - first)
    for name, v in vary.items():
        if v.samples is not None:
            values[name] = np.asarray(v.samples, float)[places]
        elif v.distribution is not None:
            u = np.clip(uniforms[name], _EDGE, 1 - _EDGE)
            values[name] = v.quantile(u)[within]
    return values


def _uniforms(
    names: list[str], sequence: str, seed: int, first: int, count: int
) -> dict[str, Array]:
    """Draws from (0, 1), each quantity's `count` of them from the `first` on."""
    if sequence == "random":
        return {name: _random(name, seed, first, count) for name in names}
    size = len(names)
    if sequence == "saltelli":
        return dict(zip(names, _saltelli(size, seed, first, count), strict=True))
    engine = deepcopy(_engine(sequence, size, seed))
    points = _points(engine, first, count)
    return {name: np.ascontiguousarray(points[:, k]) for k, name in enumerate(names)}


@lru_cache(maxsize=16)
def _engine(sequence: str, size: int, seed: int) -> Any:
    """As it begins: to be copied, for drawing changes it."""
    from scipy.stats import qmc

    if sequence == "halton":
        return qmc.Halton(size, rng=seed)
    return qmc.Sobol(size, rng=seed, bits=32)  # with more, scipy's engine cannot skip


def _points(engine: Any, first: int, count: int) -> Array:
    from scipy.stats import qmc

    if isinstance(engine, qmc.Halton):
        engine.num_generated = first  # its fast_forward would draw all that it skips
        return engine.random(count)
    if first:  # Sobol's engine does not know how to skip none
        engine.fast_forward(first)
        return engine.random(count)
    # From the first on it would warn of any number that is no power of 2.
    return engine.random(1 << (count - 1).bit_length())[:count]


def _random(name: str, seed: int, first: int, count: int) -> Array:
    """A stream of the quantity's own, so that others may come and go."""
    stream = np.random.SeedSequence([seed, zlib.crc32(name.encode())])
    return np.random.Generator(np.random.PCG64DXSM(stream).advance(first)).random(count)


def _saltelli(size: int, seed: int, first: int, count: int) -> Array:
    """Saltelli's design for first-order and total indices, (size, count).

    Samples come in groups of size + 2: a point A, then A with one coordinate after another taken
    from a second point B, then B itself.
    """
    group = size + 2
    begin, end = first // group, (first + count - 1) // group + 1
    engine = deepcopy(_engine("sobol", 2 * size, seed))
    points = _points(engine, begin, end - begin)
    a, b = points[:, :size], points[:, size:]
    whole = np.repeat(a[:, None], group, 1)
    for k in range(size):
        whole[:, 1 + k, k] = b[:, k]
    whole[:, -1] = b
    flat = whole.reshape(-1, size)[first - begin * group :][:count]
    return np.ascontiguousarray(flat.T)
