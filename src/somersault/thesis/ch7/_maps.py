"""How long layouts last on springs, by a law, and with both: over the law's delay and the scatter
of starts, and over springs and gains (section 7.4)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.ensembles import Vary, ensemble, fraction
from somersault.flight import JointTakeoff, Takeoff, flights, fly
from somersault.stability import feedback
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch1._stabiliser import (
    ARMS,
    MODEL,
    MOVES,
    PATIENT,
    QUICK,
    RATE,
    TURN,
    layout,
    loop,
    moved,
)
from somersault.thesis.ch7._together import (
    DAMPING,
    EVERY,
    FASTEST,
    HELD,
    MANY,
    SOMERSAULT,
    STIFFNESS,
    TICKS,
    percent,
    sprung,
)

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WHERE = "§7.4"
_SIZE, _SEED = 100, 4
_SCATTERS = np.geomspace(0.003, 0.1, 8)  # deviations of tilt and twist, rad
_LATE = np.arange(13)  # ticks
_QUICK, _HUMAN = 2, 8  # ticks: 40 and 162 ms
# A sampled law is later than its delay: a rate that is reached by the next tick by a tick, on
# average, and a torque that holds until then by half a tick.
_RAMP, _HOLDS = 1.0, 0.5
_WIDE = 0.06  # rad: the scatter of the map of springs and gains
_SPRINGS, _GAINS = np.linspace(0.5, 1.8, 14), np.linspace(-0.5, 0.0, 11)
_FLOWN = 20  # starts whose torques are looked at,
_SECONDS = 3 * SOMERSAULT  # for so long


def _lasting(
    arms: JointTakeoff, scatter: float, also: Mapping[str, Vary] | None = None
) -> xr.Dataset:
    """The share of starts that last, with its interval of 95 %; the same starts in each case."""
    vary = dict(also or {})
    for name in ("tilt", "twist"):
        vary[f"takeoff_{name}"] = Vary(sets=f"takeoff.{name}", normal=[0.0, scatter])
    one = flights(
        MODEL, Takeoff(spin=RATE, joints={"shoulder": arms}), MANY * SOMERSAULT, report=["twist"],
        until="quarter twist",
    )  # fmt: skip
    time = ensemble(one, vary=vary, size=_SIZE, seed=_SEED).dataset["time"]
    return fraction(time > (MANY - 1e-6) * SOMERSAULT)


def _over_scatter(arms: JointTakeoff) -> Array:
    return np.array([float(_lasting(arms, float(s))["fraction"]) for s in _SCATTERS])


@dataclass(frozen=True)
class _Delays:
    """Shares that last, (scatters, delays); of springs alone, (scatters,)."""

    springs: Array
    laws: Mapping[tuple[float, float], Array]
    both: Array

    @property
    def law(self) -> Array:
        """With the better of the two laws."""
        return np.maximum.reduce(list(self.laws.values()))

    @property
    def better(self) -> Array:
        """Where both together are better than either."""
        return self.both > np.maximum(self.springs[:, None], self.law)

    @property
    def worse(self) -> Array:
        """Where one of them is better than both together."""
        return self.both < np.maximum(self.springs[:, None], self.law)


@cache
def _by_delay() -> _Delays:
    laws = {
        gains: [_over_scatter(moved(gains, EVERY, int(n), most_rate=FASTEST)) for n in _LATE]
        for gains in (QUICK, PATIENT)
    }
    both = [_over_scatter(sprung(HELD[1], int(n))) for n in _LATE]
    alone = _over_scatter(JointTakeoff.sprung(angle=ARMS, K=STIFFNESS, hold=True))
    return _Delays(
        alone, {gains: np.column_stack(x) for gains, x in laws.items()}, np.column_stack(both)
    )


@cache
def _by_gain() -> tuple[Array, Array]:
    """Shares that last with both, (springs, gains), and with undamped springs alone."""
    stiffness = {"K": Vary(sets="joints.shoulder.K", values=_SPRINGS)}
    gain = {"k": Vary(sets="joints.shoulder.gains.k", values=_GAINS * RATE**2)}
    both = _lasting(sprung(HELD[1], _HUMAN), _WIDE, stiffness | gain)
    alone = _lasting(JointTakeoff.sprung(angle=ARMS, K=1.0, hold=True), _WIDE, stiffness)
    return both["fraction"].values, alone["fraction"].values


def _growth(stiffness: float, gain: float) -> float:
    """Of small motions with both, at the human delay."""
    linear = layout().spin.linear({"shoulder": stiffness}, {"shoulder": DAMPING})
    loop = feedback(linear, MOVES, "torque", {"twist": gain})
    return loop.growth_rate((_HUMAN + _HOLDS) * TURN / TICKS)


@dataclass(frozen=True)
class _Torques:
    """Of a shoulder, besides what holds the steady spin, N m: root of the mean square of all and of
    what the law commands, and the greatest of all."""

    all: float
    law: float
    peak: float


@cache
def _torques() -> dict[str, _Torques]:
    """In the same starts, until three somersaults."""
    starts = np.random.default_rng(_SEED).normal(0.0, 0.03, (_FLOWN, 2))
    cases = {
        "springs": JointTakeoff.sprung(angle=ARMS, K=STIFFNESS, hold=True),
        "law": moved(QUICK, EVERY, 2, most_rate=FASTEST),
        "both": sprung(HELD[1], _HUMAN),
    }
    steady = layout().spin
    hold = np.array(list(steady.holding_torques.values())) * RATE**2
    inertia = np.array(list(steady.outboard_inertias.values()))
    found = {}
    for name, arms in cases.items():
        every, commanded = [], []
        for tilt, twist in starts:
            takeoff = Takeoff(
                spin=RATE, tilt=float(tilt), twist=float(twist), joints={"shoulder": arms}
            )
            data = fly(MODEL, takeoff, _SECONDS, samples=721)
            torque = data.joint_torques.values - hold
            moved_by = data.dataset["joint_angle"].values - [ARMS, -ARMS]
            spring = 0.0 if name == "law" else STIFFNESS * inertia * RATE**2 * moved_by
            damper = DAMPING * inertia * RATE * data.dataset["joint_rate"].values
            every.append(torque)
            commanded.append(torque + spring + (damper if name == "both" else 0.0))
        rms = [float(np.sqrt(np.mean(np.square(x)))) for x in (every, commanded)]
        found[name] = _Torques(rms[0], rms[1], float(np.abs(every).max()))
    return found


def maps() -> Result:
    """Where both together are better than springs or a law alone."""
    found, (both, alone) = _by_delay(), _by_gain()
    edges = {gains: loop(*gains).stable_delays()[0][1] / TURN for gains in (QUICK, PATIENT)}
    beyond = {gains: edge * TICKS < _LATE + _RAMP for gains, edge in edges.items()}
    inside = {gains: float(shares[0, ~beyond[gains]].min()) for gains, shares in found.laws.items()}
    outside = {gains: float(shares[0, beyond[gains]].max()) for gains, shares in found.laws.items()}
    human = int(np.flatnonzero(_LATE == _HUMAN)[0])
    late = _LATE >= _HUMAN
    quick = _LATE <= _QUICK
    best, single = np.unravel_index(both.argmax(), both.shape), float(alone.max())
    torques = _torques()
    stable = np.array([[_growth(float(K), float(k)) < 0 for k in _GAINS] for K in _SPRINGS])
    claims = (
        statement(
            "sec7-4-maps.both", _WHERE, "at a person's delay springs and a law together are better "
            "than either alone, whatever the scatter", "not said",
            f"at {1000 * _HUMAN * EVERY:.0f} ms and more both are better in "
            f"{int(found.better[:, late].sum())} of {found.better[:, late].size} places of the map "
            f"and worse in {int(found.worse[:, late].sum())}; for a scatter of "
            f"{_SCATTERS[-2]:.2g} rad {percent(found.both[-2, human])} last, "
            f"{percent(found.springs[-2])} on springs, {percent(found.law[-2, human])} by a law",
            not found.worse[:, late].any() and bool(found.better[:, late].any()),
            "Ours. In the other places they are equal.",
        ),
        statement(
            "sec7-4-maps.quick", _WHERE, "a law that acts at once does better alone where the "
            "scatter is large", "not said",
            f"of starts within {_SCATTERS[-1]:g} rad {percent(found.law[-1, quick].min())} at "
            f"least last by a law alone up to {1000 * _QUICK * EVERY:.0f} ms late, "
            f"{percent(found.both[-1, quick].max())} at most with both and "
            f"{percent(found.springs[-1])} on springs",
            found.law[-1, quick].min() > max(found.both[-1, quick].max(), found.springs[-1]),
            f"Ours. Before {1000 * _HUMAN * EVERY:.0f} ms one alone is better than both in "
            f"{int(found.worse[:, ~late].sum())} of {found.worse[:, ~late].size} places of the "
            "map.",
        ),
        statement(
            "sec7-4-maps.edge", _WHERE, "the delay at which a law alone fails is that of small "
            "motions", "not said",
            " and ".join(
                f"{name}: {percent(inside[gains])} at least last up to {edges[gains]:.3f} of a "
                f"somersault, {percent(outside[gains])} at most beyond"
                for name, gains in (("quick", QUICK), ("patient", PATIENT))
            ),
            min(inside.values()) > 0.5 > max(outside.values()),
            f"Ours. For the least scatter, {_SCATTERS[0]:g} rad. To the delay a tick is added, in "
            "which a sampled rate is reached.",
        ),
        statement(
            "sec7-4-maps.spring", _WHERE, "for a person's delay the best spring and gain together "
            "are better than the best spring alone", "not said",
            f"with K_sh = {_SPRINGS[best[0]]:.1f} and a torque of −{-_GAINS[best[1]]:.2f} kg m² Ω² "
            f"times the twist {percent(both.max())} last, with the best springs alone "
            f"{percent(single)} (K_sh = {_SPRINGS[alone.argmax()]:.1f}); of places where small "
            f"motions decay {percent(both[stable].mean())} last on average, elsewhere "
            f"{percent(both[~stable].mean())}",
            both.max() > single and both[stable].mean() > 2 * both[~stable].mean(),
            f"Ours. Scatter {_WIDE} rad, {1000 * _HUMAN * EVERY:.0f} ms.",
        ),
        statement(
            "sec7-4-maps.torque", _WHERE, "springs spare the muscles", "not said",
            f"besides what holds the steady spin a shoulder has {torques['springs'].all:.1f} N m "
            f"(rms) on springs, {torques['law'].all:.1f} by a quick law and "
            f"{torques['both'].all:.1f} with both, of which {torques['both'].law:.2f} are the "
            f"law's; {torques['springs'].peak:.0f}, {torques['law'].peak:.0f} and "
            f"{torques['both'].peak:.0f} N m at most",
            torques["both"].law < 0.25 * torques["law"].all,
            f"Ours. {_FLOWN} starts within 0.03 rad, {_SECONDS / SOMERSAULT:.0f} somersaults. "
            "Holds if the law of both commands less than a quarter of what the law alone takes.",
        ),
    )  # fmt: skip
    return Result(
        "The thesis compares an active and a passive layout in words.",
        f"The share of {_SIZE} starts that last {MANY} somersaults without a quarter twist, the "
        "same starts in each place of a map. Left: by the better of two laws of twist and twist "
        "rate; dashed are the delays beyond which small motions grow with the quick and with the "
        "patient one. Middle: on damped springs with a torque by the twist; crosses where springs "
        f"or a law alone are better. Right: the same {1000 * _HUMAN * EVERY:.0f} ms late for a "
        f"scatter of {_WIDE} rad; small motions decay within the line.",
        claims,
        _draw(found, edges, both),
        table=_table(torques),
    )


def _table(torques: Mapping[str, _Torques]) -> Table:
    rows = [
        (name, f"{one.all:.2f}", "" if name == "springs" else f"{one.law:.2f}", f"{one.peak:.1f}")
        for name, one in torques.items()
    ]
    return Table(("arms", "torque (N m, rms)", "of the law (N m, rms)", "peak (N m)"), tuple(rows))


def _draw(found: _Delays, edges: Mapping[tuple[float, float], float], both: Array) -> Figure:
    from matplotlib.colors import LinearSegmentedColormap

    from somersault.view import style as look

    picture = look.figure(11.0, 3.9)
    left, middle, right = picture.subplots(1, 3)
    shades = LinearSegmentedColormap.from_list("shares", look.LIGHT_TO_DARK)
    delays = _LATE / TICKS

    def shown(ax: Axes, x: Array, y: Array, shares: Array) -> None:
        mesh = ax.pcolormesh(x, y, 100 * shares, cmap=shades, vmin=0, vmax=100, shading="nearest")
        if ax is right:
            picture.colorbar(mesh, ax=ax, label=f"last {MANY} somersaults, %")

    for ax, shares, title in ((left, found.law, "By a law"), (middle, found.both, "Both")):
        shown(ax, delays, _SCATTERS, shares)
        ax.set(yscale="log", xlabel="delay, somersaults", ylabel="scatter, rad", title=title)
        ax.set_ylim(_SCATTERS[0] / 1.28, _SCATTERS[-1] * 1.28)
    for edge in edges.values():
        left.axvline(edge - _RAMP / TICKS, color=look.VERMILION, ls="--", lw=1.5)
    at, worse = np.meshgrid(delays, _SCATTERS), found.worse
    middle.plot(at[0][worse], at[1][worse], "x", color=look.VERMILION, ms=5)
    shown(right, _GAINS, _SPRINGS, both)
    fine = np.linspace(_GAINS[0], _GAINS[-1], 31), np.linspace(_SPRINGS[0], _SPRINGS[-1], 31)
    growth = [[_growth(float(K), float(k)) for k in fine[0]] for K in fine[1]]
    right.contour(*fine, growth, [0.0], colors=[look.VERMILION], linewidths=1.5)
    right.set(xlabel="torque by the twist, kg m² Ω²", ylabel="stiffness K_sh")
    right.set_title(f"Both, {1000 * _HUMAN * EVERY:.0f} ms late")
    return picture
