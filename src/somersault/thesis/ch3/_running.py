"""Section 3.4: running, its speed, and how great a push it survives."""

from __future__ import annotations

from functools import cache

import numpy as np

from somersault.ensembles import Vary, ended_by, ensemble
from somersault.robot import Control, Push, Runs
from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch3._runs import at_speed, running

_SPEEDS = (0.0, 0.5, 1.0, 1.5)  # m/s
_PUSHES = {"forward": (-400.0, 400.0), "sideways": (-300.0, -200.0, 200.0, 300.0)}
"""N for a tenth of a second, either way."""
_MOMENTS = {"from": 2.8, "to": 3.68, "count": 12}  # s, over a step of each leg
_SETTLED = 5.0  # s


@cache
def falls(way: str) -> dict[float, int]:
    """By pushes, N, how often it falls of one, within five seconds: each at so many moments."""
    runs = Runs(control=Control(push=Push()), duration=8.7)
    vary = {
        "push": Vary(sets=f"push.{way}", values=_PUSHES[way]),
        "moment": Vary(sets="push.at", values=_MOMENTS),
    }
    fell = ended_by(ensemble(runs, vary=vary).dataset["ended"], "fell before").sum("moment")
    return dict(zip(_PUSHES[way], fell.values.tolist(), strict=True))


def _words(fell: dict[float, int]) -> str:
    moments = _MOMENTS["count"]
    return ", ".join(f"{count} of {moments} pushes of {n / 10:+.0f}" for n, count in fell.items())


def sec_3_4() -> Result:
    """Balance by three control tasks."""
    run = running()
    late = run.times > _SETTLED
    angles = np.abs(np.degrees(run.angles[late])).max(0)
    lift = run.sensed[:, 5][late].max()
    down = (run.sensed[:, [9, 13]] > 1.0)[late]
    rows = [(speed, at_speed(speed)) for speed in _SPEEDS]
    reached = [float(r.speed[r.times > _SETTLED].mean()) for _, r in rows]
    ahead, aside = falls("forward"), falls("sideways")
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
            bool(not any(r.fell for _, r in rows) and np.all(np.diff(reached) > 0.3)),
        ),
        statement(
            "sec3-4.push", "§3.4", "it keeps its balance when it is disturbed", "keeps",
            f"falls after {_words(ahead)} N s forwards and {_words(aside)} N s to its left",
            not any(ahead.values()) and not any(aside[n] for n in (-200.0, 200.0)),
            "Of pushes at so many moments over a step of each leg; 20 N s change its speed by 0.64 "
            "m/s. It keeps its balance if it falls of none but those of 30 N s sideways.",
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
