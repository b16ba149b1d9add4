"""How long a stable spin lasts: ten thousand somersaults, at the edge of its region and within."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.dynamics import Equations
from somersault.ensembles import Vary, ended_by, ensemble, fraction
from somersault.flight import JointTakeoff, Report, Takeoff
from somersault.model import Model, load
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import MODEL, NOMINAL, STIFFNESS, shoulder_inertia
from somersault.thesis.ch4._layout_takeoff import SPIN, TURN

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

MOST = 10_000  # somersaults
SCATTER = (0.001, 0.003, 0.01)  # rad, standard deviations of tilt and twist at takeoff
DISTANCES = np.array([0.003, 0.01, 0.03, 0.06, 0.1, 0.15])  # of K_sh from the edge
_EARLY = 100  # turns: a spin that lasts so long is not lost at once
_STARTS = 40
_ACCURACY, _COARSER, _FINER = 1e-9, 1e-6, 1e-12  # rad
_STEPS = 3_000_000
_DRIFT = 1e-8
_CHECKED = (0.03, 0.06)  # distances at which tolerances are compared
_WHERE = "§4.3.3"
_VELOCITIES = tuple(f"angular_velocity_{k}" for k in (1, 2, 3))
_WHEEL = (1, 2, 3)  # axes of a cartwheel: it turns about the first


@dataclass(frozen=True)
class Kind:
    """A spin about one axis of the athlete at an arm angle (rad), and an edge of its region."""

    name: str
    axis: int
    angle: float
    upper: bool = False

    @property
    def signature(self) -> str:
        """Of the energy, a little within."""
        (stiffness,) = self.stiffness(DISTANCES[:1])
        steady = st.spin(MODEL, self.axis, {"shoulder": self.angle})
        return steady.linear({"shoulder": float(stiffness)}).energy_signature

    @property
    def model(self) -> Model:
        """The athlete, with the axis of this spin as that of somersaults."""
        return load(MODEL, axes=None if self.axis == 2 else _WHEEL)

    @property
    def edge(self) -> float:
        """K_sh there."""
        ((low, high), *_) = st.stable_ranges(
            MODEL, (STIFFNESS, -2.0, 4.0), pose={"shoulder": self.angle}, axis=self.axis
        )
        return high if self.upper else low

    def stiffness(self, distances: Array) -> Array:
        """K_sh at distances within the region."""
        return self.edge + (-distances if self.upper else distances)

    def takeoff(self, stiffness: float) -> Takeoff:
        """The steady spin with its momentum along the axis."""
        inertia = st.principal_inertias(MODEL, {"shoulder": self.angle})
        h = np.where(np.arange(3) == self.axis - 1, SPIN * inertia, 0.0)
        arms = JointTakeoff(
            "sprung",
            angle=self.angle,
            stiffness=stiffness * SPIN**2 * shoulder_inertia(),
            hold=True,
        )
        return Takeoff(angular_momentum=tuple(h.tolist()), joints={"shoulder": arms})


LOWER = Kind("layout, lower edge", 2, NOMINAL)
UPPER = Kind("layout, upper edge", 2, NOMINAL, upper=True)
WHEEL = Kind("cartwheel", 1, 0.8)  # an arm angle at which the edge is a spring that pulls back
KINDS = (LOWER, UPPER, WHEEL)


@cache
def lives(
    kind: Kind, scatter: float, distances: tuple[float, ...] = tuple(DISTANCES.tolist()),
    accuracy: float = _ACCURACY,
) -> xr.Dataset:  # fmt: skip
    """Flights (K_sh, sample) of ten thousand turns, or until a quarter twist; the same draws for
    all."""
    stiffness = kind.stiffness(np.array(distances))
    vary = {
        "K_sh": Vary(
            sets="joints.shoulder.stiffness", values=stiffness, unit="1",
            scale=SPIN**2 * shoulder_inertia(),
        ),
        "tilted": Vary(adds_to="takeoff.tilt", normal=[0.0, scatter]),
        "twisted": Vary(adds_to="takeoff.twist", normal=[0.0, scatter]),
    }  # fmt: skip
    speeds = kind.model.speeds
    history = (*_VELOCITIES, *speeds, *(f"{name}_rate" for name in speeds))
    report = Report(("somersaults",), history=history, samples=2)
    return ensemble(
        kind.model, kind.takeoff(float(stiffness[0])), MOST * TURN, vary, size=_STARTS, seed=4,
        report=report, accuracy=accuracy, until="quarter twist", steps=_STEPS,
    ).dataset  # fmt: skip


def lasting(flown: xr.Dataset) -> xr.Dataset:
    """The share that lasts, with its interval, by K_sh."""
    return fraction(ended_by(flown["ended"], "duration"))


def late(flown: xr.Dataset) -> tuple[int, int]:
    """How many are lost after a hundred turns, and how many last so long."""
    turns = flown["time"].values / TURN
    lost = ~ended_by(flown["ended"], "duration").values
    return int((lost & (turns > _EARLY)).sum()), int((turns > _EARLY).sum())


def drifts(kind: Kind, flown: xr.Dataset) -> tuple[float, float]:
    """The largest relative change of energy and of angular momentum, of flights that last."""
    model, equations = kind.model, Equations(MODEL)
    rates = (f"{name}_rate" for name in model.speeds)
    omega, q, u = (
        np.stack([flown[f"{name}_history"].values for name in names], -1)
        for names in (_VELOCITIES, model.speeds, tuple(rates))
    )
    mass = equations.mass_matrix(q)
    coupled = np.concatenate([omega, u], -1)
    others = [0, 1, 2, *range(6, mass.shape[-1])]
    # The centre of mass stays, so the base's origin moves as the rest makes it.
    momentum = (mass[..., 3:6, :][..., others] @ coupled[..., None])[..., 0]
    velocity = -np.linalg.solve(mass[..., 3:6, 3:6], momentum[..., None])[..., 0]
    v = np.concatenate([omega, velocity, u], -1)
    angular = np.linalg.norm((mass[..., :3, :] @ v[..., None])[..., 0], axis=-1)
    steady = st.spin(MODEL, kind.axis, {"shoulder": kind.angle})
    away = q - steady.pose
    k = flown["K_sh"].values[:, None, None] * SPIN**2 * shoulder_inertia()
    held = np.array([steady.holding_torques[name] for name in model.speeds]) * SPIN**2
    kinetic = np.einsum("...i,...ij,...j->...", v, mass, v) / 2
    energy = kinetic + k * (away**2).sum(-1) / 2 - away @ held
    size = kinetic[..., 0]
    of_energy = np.abs(energy[..., 1] - energy[..., 0]) / size
    of_momentum = np.abs(angular[..., 1] / angular[..., 0] - 1)
    lasts = ended_by(flown["ended"], "duration").values
    return float(of_energy[lasts].max()), float(of_momentum[lasts].max())


def long_lives() -> Result:
    """Shares that last, by distance from the edge."""
    rows = []
    for kind in KINDS:
        for scatter in SCATTER:
            found, (lost, _) = lasting(lives(kind, scatter)), late(lives(kind, scatter))
            shares = (
                f"{100 * f:.0f} ({100 * a:.0f} to {100 * b:.0f})"
                for f, a, b in zip(
                    *(found[n].values for n in ("fraction", "low", "high")), strict=True
                )
            )
            rows.append((kind.name, f"{scatter:g}", *shares, str(lost)))
    return Result(
        "Linear analysis predicts neutral stability alone, so nothing can be concluded of the "
        "non-linear system even for small perturbations; simulations of 2000 s suggest that it may "
        "last as long as energy is conserved.",
        f"{MOST:,} somersaults from {_STARTS} starts with normal tilt and twist, at distances of "
        f"K_sh from the edges of the region at Γ = {NOMINAL:g}. The layout somersault is "
        f"{LOWER.signature} at both edges: at the lower one two modes of opposite energy meet, at "
        "the upper one the slow mode's frequency vanishes. The cartwheel (axis 1, Γ = "
        f"{WHEEL.angle:g}) is {WHEEL.signature}: what lies inside the barrier of its energy stays "
        "there for ever, by a theorem (Lagrange and Dirichlet); what does not goes soon. Of the "
        f"gyroscopic ones some are lost only after hundreds or thousands of turns.",
        tuple(_claims()),
        _draw(),
        Table(
            ("spin", "scatter (rad)", *(f"{d:g} from the edge" for d in DISTANCES),
             f"lost after {_EARLY} turns"), tuple(rows),
        ),
    )  # fmt: skip


def _claims() -> list[Claim]:
    inside = [lasting(lives(kind, SCATTER[0])).isel(K_sh=slice(-3, None)) for kind in KINDS]
    all_last = all(bool((found.fraction == 1).all()) for found in inside)
    least = min(float(found.low.min()) for found in inside)
    falling = [[float(lasting(lives(kind, s)).fraction.mean()) for s in SCATTER] for kind in KINDS]
    layout = [late(lives(kind, s)) for kind in (LOWER, UPPER) for s in SCATTER]
    wheel = [late(lives(WHEEL, s)) for s in SCATTER]
    lost, of = (sum(pair[k] for pair in layout) for k in (0, 1))
    lost_wheel, of_wheel = (sum(pair[k] for pair in wheel) for k in (0, 1))
    by_kind = [drifts(kind, lives(kind, s)) for kind in KINDS for s in SCATTER]
    energy, momentum = (max(pair[k] for pair in by_kind) for k in (0, 1))
    return [
        statement(
            "sec4-3-lives.indefinite", _WHERE, "the maneuver may remain stable indefinitely as "
            "long as energy is conserved", "indefinitely", f"with a scatter of {SCATTER[0]:g} rad "
            f"and {DISTANCES[-3]:g} or more from the edge all last {MOST:,} somersaults (95 % "
            f"confidence for each spring: more than {100 * least:.0f} %)", all_last,
            "Not for ever: a gyroscopic spin has no theorem for that. At some springs in between "
            "none lasts: see the resonances.",
        ),
        statement(
            "sec4-3-lives.size", _WHERE, "stability to perturbations depends upon their size",
            "depends", "; ".join(
                f"{kind.name}: " + ", ".join(f"{100 * x:.0f} %" for x in shares)
                for kind, shares in zip(KINDS, falling, strict=True)
            ) + f" last, over all distances, at scatters of {', '.join(f'{s:g}' for s in SCATTER)}",
            all(a >= b for x in falling for a, b in pairwise(x)) and falling[0][0] > falling[0][-1],
        ),
        statement(
            "sec4-3-lives.late", "ours", "a definite spin that is not lost at once is not lost at "
            "all, and a gyroscopic one may be", "by theorem", f"of the definite ones that lasted "
            f"{_EARLY} turns {lost_wheel} of {of_wheel} were lost later, of the gyroscopic ones "
            f"{lost} of {of}", lost_wheel == 0 < lost,
            "A definite energy is a barrier, which is crossed at once or never. Modes of opposite "
            "energy can grow together, and motions of some size wander until they find a way out.",
        ),
        _tolerance(),
        statement(
            "sec4-3-lives.drift", _WHERE, f"energy and momentum are conserved over {MOST:,} "
            f"somersaults (to {_DRIFT:g})", "conserved", "of all flights that last, energy drifts "
            f"by at most {energy:.0e} of itself, and angular momentum by {momentum:.0e}",
            max(energy, momentum) < _DRIFT,
        ),
    ]  # fmt: skip


def _tolerance() -> Claim:
    """Individual lives depend on rounding where motion is chaotic; shares do not."""
    usual, *others = (
        lives(LOWER, SCATTER[-1], _CHECKED, accuracy) for accuracy in (_ACCURACY, _COARSER, _FINER)
    )
    share = lasting(usual)
    same = [float((abs(x["time"] - usual["time"]) < TURN).mean()) for x in others]
    within = all(
        bool(((share.low <= s.fraction) & (s.fraction <= share.high)).all())
        for s in map(lasting, others)
    )
    shown = "; ".join(
        f"{accuracy:g} rad (energy drifts by {drifts(LOWER, d)[0]:.0e}): "
        + ", ".join(f"{100 * x:.0f} %" for x in lasting(d).fraction.values)
        for accuracy, d in zip((_ACCURACY, _COARSER, _FINER), (usual, *others), strict=True)
    )
    return statement(
        "sec4-3-lives.tolerance", "ours", "what share lasts does not depend on the integration's "
        "tolerance", "does not", f"{shown} last, at distances of "
        f"{' and '.join(f'{d:g}' for d in _CHECKED)}; the same life to a turn have "
        f"{100 * min(same):.0f} % of the starts", within,
        "Holds if shares are within the 95 % interval of each other. Single lives that end late "
        "are chaotic, and differ.",
    )  # fmt: skip


def _draw() -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.6, 3.9)
    colors = (look.BLUE, look.GREEN, look.VERMILION)
    for ax, kind in zip(picture.subplots(1, 3, sharey=True), KINDS, strict=True):
        for scatter, color in zip(SCATTER, colors, strict=True):
            found = lasting(lives(kind, scatter))
            share = 100 * found.fraction.values
            reach = np.abs(100 * np.array([found.low.values, found.high.values]) - share)
            ax.errorbar(
                DISTANCES, share, reach, color=color, marker="o", ms=4, lw=1.2, capsize=2,
                label=f"{scatter:g} rad",
            )  # fmt: skip
        ax.set(xscale="log", ylim=(-3, 103), title=f"{kind.name}: {kind.signature}")
        ax.set_xlabel("distance of $K_{sh}$ from the edge")
    picture.axes[0].set_ylabel(f"lasts {MOST:,} somersaults (%)")
    picture.axes[-1].legend(title="tilt and twist", loc="lower right", frameon=False)
    return picture
