"""Many spins that differ in pose, springs, dampers and bodies, as an ensemble asks for them."""

from __future__ import annotations

import fnmatch
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import text
from somersault._core.errors import SomersaultError
from somersault.dynamics import body_kind, parameter_values
from somersault.model import Model, load, model_digest, sides, spread
from somersault.simulation import ENDED, Endings, Name, Numbers, Simulation, Target, Variable
from somersault.stability._chart import growth_rates
from somersault.stability._grid import unit
from somersault.stability._principal import Axis
from somersault.stability._spin import spin
from somersault.stability._springs import one_number

MARGIN = "stability_margin"
_KINDS = ("pose", "stiffness", "damping")
_OF_BODIES = ("mass", "com", "position")
_TOGETHER = 16_384
_ENDINGS = Endings(("judged", "no spin"), ("no spin",), "no spin", called="spins")


@dataclass(frozen=True, eq=False)
class Spins:
    """Spins of one model, and how stable each is: a `somersault.simulation.Simulation`.

    Made by `spins`. `nominal` has the numbers before anything is varied, `axis` is that of the
    spin, and `lock` are the joints that are rigid.
    """

    model: Model
    nominal: Mapping[Name, float]
    axis: int
    lock: tuple[str, ...]
    varied: tuple[Name, ...] = ()
    endings = _ENDINGS
    times = np.empty(0)
    packages = ("somersault", "casadi", "llvmlite", "numpy", "scipy")
    together = _TOGETHER

    def __repr__(self) -> str:
        return f"Spins({self.name})"

    @property
    def name(self) -> str:
        """The model's."""
        return self.model.name

    @cached_property
    def specification(self) -> dict[str, Any]:
        """All that decides the numbers, as plain data."""
        return {
            "model": self.model.name, "model_sha256": model_digest(self.model), "axis": self.axis,
            "lock": list(self.lock), "spin": {_path(n): x for n, x in self.nominal.items()},
        }  # fmt: skip

    @property
    def values(self) -> Numbers:
        """The nominal numbers: of the pose, of springs and dampers, and of bodies."""
        return self.nominal

    @property
    def variables(self) -> dict[str, Variable]:
        """The stability margin."""
        words = "how fast deviations decay at least, over the spin rate"
        return {MARGIN: Variable("1", words=words)}

    def targets(self, path: str) -> tuple[Target, ...]:
        """The numbers that a name means.

        Parameters
        ----------
        path : str
            As in `growth_rates`: "pose.shoulder", "stiffness.shoulder", "bodies.body.mass". Of
            springs and dampers a * stands for joints alike.

        Returns
        -------
        tuple of Target

        Raises
        ------
        SomersaultError
            For a name that means none of them.
        """
        kind, _, rest = text("the name of a number", path).partition(".")
        names: dict[Name, tuple[float, float]] = {(path,): (1.0, 0.0)}
        if kind in _KINDS and "*" in rest and kind != "pose":
            there = [n for k, n in (n for n in self.nominal if len(n) == 2) if k == kind]
            names = {(kind, n): (1.0, 0.0) for n in fnmatch.filter(map(str, there), rest)}
        elif kind in _KINDS and rest:
            images = sides(self.model, rest).items()
            names = {(kind, n): by if kind == "pose" else (1.0, 0.0) for n, by in images}
        if not names or any(name not in self.nominal for name in names):
            raise SomersaultError(
                f"{path} is no number of these spins; there are "
                f"{', '.join(_path(name) for name in self.nominal)}"
            )
        return tuple(
            Target(name, factor, offset, unit(self.model, _path(name)))
            for name, (factor, offset) in names.items()
        )

    def with_varied(self, names: tuple[Name, ...]) -> Spins:
        """The same spins, ready to differ in some numbers.

        Parameters
        ----------
        names : tuple of tuple
            Of the numbers, as the targets have them.

        Returns
        -------
        Spins
        """
        return Spins(self.model, self.nominal, self.axis, self.lock, names)

    def sound(self, values: Numbers, count: int) -> Array:
        """Whether each is a spin: joints within their limits, masses and dampers not negative.

        Parameters
        ----------
        values : mapping of tuple to float or ndarray, (count,)
        count : int

        Returns
        -------
        ndarray of bool, (count,)
        """
        good = np.ones(count, bool)
        limits = {joint.name: joint.limits for joint in self.model.joints if joint.limits}
        for name in self.varied:
            x = np.asarray(values[name], float)
            good &= np.isfinite(x)
            if name[0] == "pose" and name[1] in limits:
                low, high = limits[str(name[1])]
                good &= (x >= low) & (x <= high)
            elif name[0] == "damping":
                good &= x >= 0
            elif body_kind(str(name[0])) == "mass":
                good &= x > 0
        return good

    def run(self, values: Numbers, count: int) -> dict[str, Array]:
        """How stable each spin is.

        Parameters
        ----------
        values : mapping of tuple to float or ndarray, (count,)
        count : int

        Returns
        -------
        dict of str to ndarray, (count,)
        """
        given = {
            _path(name): values[name]
            for name in self.nominal
            if name in self.varied or (name[0] in _KINDS and self.nominal[name] != 0.0)
        }
        rates = growth_rates(self.model, given, axis=self.axis, lock=self.lock)
        return {
            MARGIN: np.broadcast_to(0.0 - rates, count).copy(),
            ENDED: np.zeros(count, np.uint8),
        }


def spins(
    model: str | Model,
    *,
    pose: Mapping[str, float] | None = None,
    stiffness: Mapping[str, float] | None = None,
    damping: Mapping[str, float] | None = None,
    axis: Axis | str | int | None = None,
    lock: str | Iterable[str] = (),
) -> Simulation:
    """Spins that an ensemble may vary, and a design choose: how stable each is for small motions.

    They report "stability_margin", the least rate at which deviations decay, in units of Ω:
    negative where one grows, and 0 where a spin is stable without damping.

    Parameters
    ----------
    model : str or Model
        A shipped model's name, a model file, or a model.
    pose, stiffness, damping : mapping of str to float, optional
        As for `spin` and `Spin.linear`.
    axis : {"minor", "intermediate", "major", 1, 2, 3}, optional
        As for `spin`, in this pose; all spins are about the same axis of the body.
    lock : str or iterable of str
        As for `Spin.linear`.

    Returns
    -------
    Simulation

    Raises
    ------
    SomersaultError
        As for `spin` and `Spin.linear`.

    Examples
    --------
    Which share of shoulder springs near K = 1.1 makes a layout stable?

    >>> import somersault as so
    >>> layouts = so.stability.spins("furrer", pose={"shoulder": 1.3}, stiffness={"shoulder": 1.1})
    >>> off = {"softer": so.Vary(adds_to="stiffness.shoulder", normal=[0.0, 0.2])}
    >>> margins = so.ensemble(layouts, vary=off, size=1000).dataset["stability_margin"]
    >>> 0.7 < float((margins >= 0).mean()) < 0.8
    True
    """
    body = load(model)
    about = spin(body, axis=axis, pose=pose)
    _ = about.linear(stiffness, damping, lock)  # refuses what is none
    locked = (lock,) if isinstance(lock, str) else tuple(lock)
    nominal: dict[Name, float] = {}
    followers = {joint.name for joint in body.joints if joint.follows is not None}
    balls = {joint.name for joint in body.joints if joint.kind == "ball"}
    home = dict(zip(body.coordinates, body.home, strict=True))
    for kind, given in zip(_KINDS, (pose, stiffness, damping), strict=True):
        named = spread(body, given or {}, mirrored=kind == "pose")
        for speed in body.speeds:
            if kind == "pose" and speed in followers:
                continue
            drawn = 0.0 if kind != "pose" or speed.split(".")[0] in balls else home[speed]
            nominal[kind, speed] = one_number(f"{kind} of {speed}", named.get(speed, drawn))
    for path, value in parameter_values(body).items():
        if body_kind(path) in _OF_BODIES:
            nominal[path,] = value
    return Spins(body, nominal, about.axis, locked)


def _path(name: Name) -> str:
    return ".".join(map(str, name))
