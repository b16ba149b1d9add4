"""`plan`: a maneuver that is found by optimal control."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from typing import Any

from somersault._core.checks import whole_number
from somersault._core.notes import note
from somersault._core.stages import told
from somersault.engine import cores
from somersault.model import Model, load
from somersault.planning._asked import Ranged
from somersault.planning._plan import Plan, as_plan
from somersault.planning._request import Turns, requested
from somersault.planning._search import Search
from somersault.planning._starts import searched

_MOST_NODES = 2000
_MOST_STARTS = 10_000
_FAR = 1e-3  # rad between plan and flight that is worth a note


def plan(
    model: str | Model,
    somersaults: Turns = 1,
    twists: Turns = "most",
    *,
    torque: Ranged | Mapping[str, Ranged],
    duration: Ranged = (0.5, 1.5),
    joints: Iterable[str] | Mapping[str, Ranged] | None = None,
    start: Mapping[str, Ranged] | None = None,
    end: Mapping[str, Ranged] | None = None,
    rest_at_end: bool = False,
    takeoff: Mapping[str, Any] | None = None,
    landing: Mapping[str, Ranged] | None = None,
    aloft: Mapping[str, Ranged] | None = None,
    fastest: float | Mapping[str, float] | None = None,
    effort: float = 0.01,
    nodes: int = 50,
    starts: int = 4,
    seed: int = 0,
    processes: int | None = None,
) -> Plan:
    """The maneuver with the most twist, or with the least effort of those that do what is asked.

    By direct collocation (Gauss and Legendre, order six) and IPOPT. The centre of mass falls by
    itself and the angular momentum stays, so that only the attitude is integrated; joints go along
    cubics from node to node. What is found is the best near a start, and the best of several
    starts need not be the best there is.

    Parameters
    ----------
    model : str or Model
        Free in space. Its axes say about which it somersaults, tilts and twists.
    somersaults, twists : float or "most"
        Turns from takeoff to landing; of one of them "most" may be asked. With numbers for both
        the plan is that of the least effort, the mean square of the torques.
    torque : float, (float, float) or mapping
        Bounds of what muscles or motors do, N m (N): one number for ± that, or two; for all joints
        that move, or by joint. The model's own springs and dampers come on top.
    duration : float or (float, float)
        Of the flight, s, or between what it is to be.
    joints : list of str, or mapping, optional
        The joints that move, and from where to where (rad, m) where that is less than their
        limits; all others are locked. By default all hinges and slides move.
    start, end : mapping, optional
        Pose at takeoff and at landing: a number, or a range, by joint. What is not named begins as
        drawn, and may end anywhere. Joints begin at rest.
    rest_at_end : bool
        Whether joints end at rest too.
    takeoff : mapping, optional
        `somersault`, `tilt` and `twist` (rad), 0 where they are not given; `spin`, `tilt_rate` and
        `twist_rate` (rad/s), of which spin is free and the others 0; or `momentum`, three in
        inertial axes (kg m²/s). Each is a number or a range.
    landing : mapping, optional
        `somersault`, `tilt` and `twist` at landing, rad, in place of what the turns ask for, and
        of 0 for tilt. Each is a number or a range.
    aloft : mapping, optional
        Ranges of the three during the flight, rad; by default tilt is kept within ±1.
        At ±π/2 somersault and twist have no meaning, so ±1.5 is the most.
    fastest : float or mapping, optional
        The joints' greatest rates, rad/s (m/s).
    effort : float
        rad: what a second at full torque of one joint counts against the angle that is to be great.
    nodes : int
        Intervals of the collocation.
    starts : int
        How many are tried. Four, or a third if that is more, are drawn at random, the others leap
        from the best so far. With many nodes they are tried on few, and the best two refined.
    seed : int
        Decides the starts: the same seed gives the same plan.
    processes : int, optional
        How many are searched at once; as many as there are cores unless it is given.

    Returns
    -------
    Plan
        With a SomersaultWarning where its flight departs from it by more than 0.01 rad.

    Raises
    ------
    SomersaultError
        For bounds that are empty, joints that are not there, poses out of range; and where no start
        comes to a plan.

    Examples
    --------
    >>> import somersault as so
    >>> arms = {"shoulder": (0.2, 2.8)}
    >>> plan = so.plan("furrer", 1, 1, torque=60.0, joints=arms, start={"shoulder": 2.8}, nodes=20)
    >>> plan
    Plan(furrer, 1.5 s, turns: somersault 1.00, tilt 0.00, twist 1.00)
    """
    begun = time.monotonic()
    task = requested(
        load(model), somersaults, twists, torque, duration, joints, start, end, rest_at_end,
        takeoff, landing, aloft, fastest, effort,
    )  # fmt: skip
    nodes = whole_number("nodes", nodes, 4, _MOST_NODES)
    starts = whole_number("starts", starts, 1, _MOST_STARTS)
    seed = whole_number("seed", seed, 0, 2**63 - 1)
    most = cores() if processes is None else whole_number("processes", processes, 1, 1024)
    with told():
        here = Search(task)
        outcome, attempts = searched(here, nodes, starts, seed, min(most, starts))
        result = as_plan(task, here.grid(nodes), outcome, attempts, time.monotonic() - begun)
        if result.departure > _FAR:
            note(
                f"the flight of this plan departs from it by {result.departure:.2g} rad; give it "
                "more nodes"
            )
    return result
