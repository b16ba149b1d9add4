"""Figures 6-7 and 6-8: the 3D Biped with a weight turns round in its somersault."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault import rigid
from somersault._core.array import Array
from somersault.attitude import matrix_from_quaternion
from somersault.dynamics import Equations
from somersault.robot import Run
from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result
from somersault.thesis._motion import Motion
from somersault.thesis.ch3._biped import inertia
from somersault.thesis.ch3._measured import between, between_times, excerpt, lines
from somersault.thesis.ch6._half_twist_runs import AT, BACKWARDS, nominal, weak
from somersault.thesis.ch6._torque_twist_tilt import half_twist
from somersault.thesis.ch6._weighted_biped import weighted

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PICTURES = 12
_OFF = 0.005  # s after which no foot touches the ground any more
_SHOWN = 4.0  # s, as in figure 6-8
_LENGTH = 0.75  # m of the legs
_ON_ITS_SIDE = 70.0  # degrees of tilt from which a body lies on its side
_UPRIGHT = 30.0  # and up to which its long axis stays near to the plane of its somersault
_KEPT = 0.02  # of the angular momentum, which MuJoCo's integrator may lose in a flight
_EVENTS = ("flip compression", "tuck", "landing compression")


def fig_6_7() -> Result:
    """The half twist as a sequence of pictures."""
    from somersault.view import contact_sheet

    run = nominal()
    times = np.linspace(run.began("flip compression"), run.began("landing hop") + 0.1, _PICTURES)
    return Result(
        "A sequence of pictures of the simulated 3D Biped somersaulting with a twist. It lands "
        "facing the opposite direction it started from.",
        "The model `biped_weighted`, seen from its left as it runs up; from the flip step to the "
        "hop after the landing.",
        (),
        contact_sheet(run, times.tolist(), columns=6, view=(90.0, 6.0)),
        motion=Motion(
            {"the half twist": excerpt(run, AT, AT + 5)}, 0.5,
            {"vectors": ("momentum",), "camera": (60.0, 12.0)},
        ),
    )  # fmt: skip


def fig_6_8() -> Result:
    """Height and angles over time, and what the section says of them."""
    run = nominal()
    out = run.outcome
    air = between(run, "tuck", "landing compression")
    rates = np.degrees(run.rates[:, 3:6])
    first, last = (between_times(run, run.began(s) - 0.002, run.times[-1])[0] for s in _EVENTS[:2])
    off, kind = _tilt_of_momentum(run)
    facing = np.degrees(out["landing_twist"])
    late = run.times > run.times[-1] - 4.0
    heading = np.degrees(run.kept["heading"][-1])
    lean = np.degrees(np.arccos(_turns(run, np.flatnonzero(late))[:, 2, 2])).max()
    bare, heavy = (half_twist(x) for x in (np.diag(inertia(_LENGTH)), weighted(_LENGTH)))
    ours = np.degrees(np.abs(np.arcsin(-_turns(run, air)[:, 1, 2]))).max()
    where, of_6_8 = "§6.4", "§6.4, Figure 6-8"
    tilts = [np.degrees(x.momentum) for x in (bare, heavy)]
    claims = (
        statement(
            "sec6-4.torque-twist", where, "it accelerates its torso in somersault and twist during "
            "the stance prior to take-off", "accelerates", f"from {rates[first, 1]:.0f} to "
            f"{rates[last, 1]:.0f} deg/s of somersault, from {rates[first, 2]:.0f} to "
            f"{rates[last, 2]:.0f} deg/s about its long axis",
            bool(np.all(rates[last, 1:] > rates[first, 1:] + 100)),
        ),
        statement(
            "sec6-4.tilted", where, "the two components give a momentum that is tilted with "
            "respect to the principal axes", "tilted", f"{np.degrees(off):.1f}° from the "
            f"somersault axis at lift-off; curves around the {kind} axis",
            bool(kind == "minor" and off > np.radians(5)),
            "By the package's own equations, from the joints and rates of the run.",
        ),
        statement(
            "sec6-4.harder", where, "without the weight the robot requires significantly more tilt "
            "for a twisting somersault than a human, and with it", "significantly more",
            f"half a twist in one somersault of the rigid robot takes a momentum tilted by "
            f"{tilts[0]:.0f}°, with the weight {tilts[1]:.0f}°", bool(tilts[0] > 2 * tilts[1]),
            f"Upright, legs of {_LENGTH} m. Roll and yaw inertia are assumed.",
        ),
        statement(
            "sec6-4.side", where, "without the weight the twisting somersault would force the "
            "robot to lie on its side some time during flight", "on its side",
            f"tilted by up to {np.degrees(bare.tilt):.0f}°",
            bool(np.degrees(bare.tilt) > _ON_ITS_SIDE), "The rigid robot, as before.",
        ),
        statement(
            "sec6-4.upright", where, "with it the long axis stays closer to the vertical, as a "
            "human's does", "closer", f"tilted by up to {ours:.0f}°, of the rigid robot "
            f"{np.degrees(heavy.tilt):.0f}°", bool(ours < _UPRIGHT),
        ),
        statement(
            "fig6-8.backwards", of_6_8, "it lands facing the opposite direction it started from",
            "opposite", f"turned by {facing:.0f}°, somersaulted by "
            f"{np.degrees(out['landing_somersault']):.0f}°", bool(abs(facing - 180) < BACKWARDS),
        ),
        statement(
            "fig6-8.runs-on", of_6_8, "on landing it regains balance, to continue stable dynamic "
            "running", "regains", f"{int(out['steps_after'])} steps after it, {run.ended}; in the "
            f"last 4 s heading {heading:.0f}°, at {run.speed[late].mean():.2f} m/s, at most "
            f"{lean:.0f}° from the vertical",
            bool(not run.fell and out["steps_after"] >= 15 and abs(heading - 180) < 10
                 and abs(run.speed[late].mean() - 1) < 0.25 and lean < 15),
        ),
        number(
            "fig6-8.time", of_6_8, "time in the air, by lift-off speed and heights", _parabola(run),
            out["flight_time"], "s", 0.012, "The time axis of the figure is not legible. Predicted "
            "from the state at lift-off and touchdown (equation 3.1).",
        ),
        statement(
            "fig6-8.singularity", of_6_8, "it passes through a singularity of the Euler angles "
            "somersault, tilt and twist", "at about 1.2 s", f"tilt is at most {ours:.0f}° in this "
            "run: it does not come near to one", bool(ours > 80),
            "In this sequence the singularity is at a tilt of 90°, on the robot's side, which the "
            "weight is there to avoid. In the sequence of yaw, pitch and roll every somersault "
            "passes through one.",
        ),
        statement(
            "fig6-8.unharmed", of_6_8, "discontinuities of the angles do not affect the simulation",
            "not", *_unharmed(run),
        ),
        statement(
            "sec6-4.power", where, "the real robot's actuators were too weak for it", "too weak",
            f"with the hips' torque of `biped` {_fate(weak())}",
            bool(weak().fell and not _is_backwards(weak())),
            "The same controller, not tuned for weaker hips.",
        ),
    )  # fmt: skip
    return Result(
        "Hopping height, somersault, tilt and twist of the 3D Biped during a front somersault with "
        "half a twist. The robot passes through an Euler angle singularity at about 1.2 s.",
        f"It is in the air for {out['flight_time']:.2f} s and lands turned by {facing:.0f}°. "
        "Angles in the sequence of equation 2.2, twist between −180 and 180°.",
        claims,
        _draw(run),
    )


def _turns(run: Run, rows: Array) -> Array:
    return matrix_from_quaternion(run.base_quaternion[rows])


def _is_backwards(run: Run) -> bool:
    return bool(abs(np.degrees(run.outcome["landing_twist"]) - 180) < BACKWARDS)


def _fate(run: Run) -> str:
    facing = np.degrees(run.outcome["landing_twist"])
    landed = f"lands turned by {facing:.0f}°" if np.isfinite(facing) else "never lands on its feet"
    return f"it {landed}, {run.ended}"


def _momentum(run: Run, rows: Array) -> Array:
    """Angular momentum about the centre of mass in the torso's axes, kg m²/s."""
    m, model, moving = run.robot.machine.mujoco, run.model, run.rates[rows]
    columns = [int(m.joint(name).dofadr[0]) for name in model.coordinates]
    still = np.zeros((len(rows), 3))  # the centre of mass does not matter
    rates = np.concatenate([moving[:, 3:6], still, moving[:, columns]], 1)
    found: Array = Equations(model).momentum(run.joint_coordinates[rows], rates)[:, :3]
    return found


def _tilt_of_momentum(run: Run) -> tuple[float, str]:
    """Of the momentum from the somersault axis at lift-off, rad; and around which axis a rigid
    robot in that posture would go on turning."""
    row = between_times(run, run.began("tuck") + _OFF, run.times[-1])[:1]
    inertias, axes = np.linalg.eigh(Equations(run.model).inertia(run.joint_coordinates[row[0]]))
    along = axes.T @ _momentum(run, row)[0]
    tilt = np.arccos(abs(along[2]) / np.linalg.norm(along))  # the last one is the major axis
    return float(tilt), rigid.kind_of_motion(inertias, along / inertias)


def _parabola(run: Run) -> float:
    """Equation 3.1 for the run's lift-off and the height at which it landed, s."""
    speed = run.outcome["lift_off_speed"]
    up, down = (
        float(run.sensed[np.searchsorted(run.times, run.began(state)), 2])
        for state in ("tuck", "landing compression")
    )
    return float((speed + np.sqrt(speed**2 + 2 * 9.81 * (up - down))) / 9.81)


def _unharmed(run: Run) -> tuple[str, bool]:
    """The drawn twist jumps; attitude and momentum do not."""
    after = between_times(run, run.began("tuck"), AT + _SHOWN)
    jump = np.abs(np.diff(_drawn(run)[after, 2])).max()
    turns = _turns(run, after)
    steps = np.einsum("tij,tik->tjk", turns[:-1], turns[1:])
    turned = np.degrees(np.arccos(np.clip((np.trace(steps, axis1=1, axis2=2) - 1) / 2, -1, 1)))
    # Not where feet still touch the ground.
    air = between(run, "tuck", "landing compression")[5:-5]
    spins = np.einsum("tij,tj->ti", _turns(run, air), _momentum(run, air))
    lost = np.abs(spins - spins[0]).max() / np.linalg.norm(spins[0])
    return (
        f"twist jumps by {jump:.0f}° in a millisecond, in which the body turns by "
        f"{turned.max():.1f}° at most; momentum stays within {100 * lost:.1f} % in the air",
        bool(jump > 180 and turned.max() < 1.5 and lost < _KEPT),
    )


def _drawn(run: Run) -> Array:
    """Somersault, tilt and twist in degrees, (T, 3), the twist within half a turn of zero."""
    angles: Array = np.degrees(run.angles)
    angles[:, 2] = (angles[:, 2] + 180) % 360 - 180
    return angles


def _draw(run: Run) -> Figure:
    from somersault.view import style as look

    picture = look.figure(7.2, 6.4)
    axes = list(picture.subplots(4, sharex=True))
    shown = (run.times > AT) & (run.times < AT + _SHOWN)
    somersault, tilt, twist = _drawn(run).T
    twist[:-1][np.abs(np.diff(twist)) > 180] = np.nan  # no line from one end to the other
    rows = (run.positions[:, 2], somersault, tilt, twist)
    words = ("hip height (m)", "somersault (°)", "tilt (°)", "twist (°)")
    for ax, values, label in zip(axes, rows, words, strict=True):
        ax.plot(run.times[shown], values[shown], color=look.BLUE)
        ax.set_ylabel(label)
    lines(run, axes, _EVENTS)
    axes[-1].set_xlabel("time (s)")
    return picture
