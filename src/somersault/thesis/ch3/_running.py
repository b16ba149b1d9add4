"""Section 3.4: running, its speed, and how great a push it survives."""

from __future__ import annotations

from functools import cache

import numpy as np

from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch3._runs import at_speed, pushed, running

_SPEEDS = (0.0, 0.5, 1.0, 1.5)  # m/s
_PUSHES = (50.0, 100.0, 150.0, 200.0, 300.0, 400.0)  # N for a tenth of a second
_SETTLED = 5.0  # s


@cache
def survived(sideways: bool) -> float:
    """The greatest of the pushes that it survives, and all smaller ones with it, N s."""
    most = 0.0
    for newtons in _PUSHES:
        if pushed(newtons, sideways).fell:
            break
        most = newtons / 10
    return most


def sec_3_4() -> Result:
    """Balance by three control tasks."""
    run = running()
    late = run.times > _SETTLED
    angles = np.abs(np.degrees(run.angles[late])).max(0)
    lift = run.sensed[:, 5][late].max()
    down = (run.sensed[:, [9, 13]] > 1.0)[late]
    rows = [(speed, at_speed(speed)) for speed in _SPEEDS]
    reached = [float(r.speed[r.times > _SETTLED].mean()) for _, r in rows]
    falls = [r.fell for _, r in rows]
    ahead, aside = survived(False), survived(True)
    claims = (
        number(
            "sec3-4.speed", "§3.4", "it runs at about 1 m/s", 1.0, float(run.speed[late].mean()),
            "m/s", 0.15,
        ),
        statement(
            "sec3-4.balance", "§3.4", "it maintains balance while running", "maintained",
            f"for {run.times[-1]:.0f} s, {int(run.kept['steps'][-1])} steps: {run.ended}",
            not run.fell,
        ),
        statement(
            "sec3-4.posture", "§3.3.3", "its body somersault angle stays close to zero, but it "
            "tilts and twists in phase with the stepping cycle", "tilts and twists",
            f"at most {angles[0]:.1f}° of somersault, {angles[1]:.1f}° of tilt, {angles[2]:.1f}° "
            f"of twist", bool(angles.max() < 12 and angles[1] > 0.5),
        ),
        statement(
            "sec3-4.gait", "§3.4", "with an alternating gait, one foot at a time, and flights",
            "alternating", f"both feet down {100 * down.all(1).mean():.0f} %, none "
            f"{100 * (~down.any(1)).mean():.0f} % of the time; lifts off with up to {lift:.2f} m/s",
            bool(not down.all(1).any() and (~down.any(1)).mean() > 0.3),
        ),
        statement(
            "sec3-4.placement", "§3.4", "in flight it positions the foot to control forward "
            "velocity", "controls", "asked for " + ", ".join(f"{s:g}" for s in _SPEEDS)
            + " m/s it runs at " + ", ".join(f"{s:.2f}" for s in reached),
            bool(not any(falls) and np.all(np.diff(reached) > 0.3)),
        ),
        statement(
            "sec3-4.push", "§3.4", "it keeps its balance when it is disturbed", "keeps",
            f"survives pushes of {ahead:.0f} N s forwards and {aside:.0f} N s sideways, which "
            f"change its speed by {ahead / 31.44:.2f} and {aside / 31.44:.2f} m/s",
            min(ahead, aside) >= 10,
            "The greatest of " + ", ".join(f"{n / 10:g}" for n in _PUSHES) + " N s such that no "
            "smaller one makes it fall, at one moment of the stride.",
        ),
    )  # fmt: skip
    table = Table(
        ("asked for (m/s)", "runs at (m/s)"),
        tuple((f"{s:g}", f"{v:.2f}") for s, v in zip(_SPEEDS, reached, strict=True)),
    )
    return Result(
        "Hip torques keep posture in stance, the leg adds energy to its spring, and in flight the "
        "foot goes where it controls forward velocity.",
        "The model biped run by these three, with the numbers of `somersault.robot.Running`.",
        claims,
        table=table,
    )
