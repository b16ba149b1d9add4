"""`plan`: a maneuver that is found by optimal control."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from typing import Any, Literal

import numpy as np

from somersault._core.checks import by_name, shown, truth, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault._core.numbers import number
from somersault._core.stages import stage, told
from somersault.engine import cores
from somersault.model import Model, load
from somersault.planning._asked import (
    ANGLES,
    MOST_TILT,
    RATES,
    Ranged,
    at_end,
    attitude,
    moving_joints,
    ranged,
    takeoff_rates,
)
from somersault.planning._ipopt import Outcome
from somersault.planning._plan import Attempt, Plan, as_plan
from somersault.planning._processes import Processes, searching
from somersault.planning._search import Draw, Job, Leap, Refine, Search
from somersault.planning._task import Task
from somersault.planning._unmet import reason

_COARSE = 40  # nodes: beyond this starts are tried on so many, and the best are refined
_ROUND = 4  # starts
_REFINED = 2  # of the solved starts
_MOST_NODES = 2000
_MOST_STARTS = 10_000
_FAR = 1e-2  # rad between plan and flight that is worth a note
_TILT = 1.0  # rad to either side, unless more or less is asked for
_MOST_TURNED = 1e3  # rad, of an angle on the way

Turns = float | Literal["most"]


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
    task = _task(
        load(model), somersaults, twists, torque, duration, joints, start, end, rest_at_end,
        takeoff, landing, aloft, fastest, effort,
    )  # fmt: skip
    nodes = whole_number("nodes", nodes, 4, _MOST_NODES)
    starts = whole_number("starts", starts, 1, _MOST_STARTS)
    seed = whole_number("seed", seed, 0, 2**63 - 1)
    most = cores() if processes is None else whole_number("processes", processes, 1, 1024)
    with told():
        here = Search(task)
        outcome, attempts = _searched(here, nodes, starts, seed, min(most, starts))
        result = as_plan(task, here.grid(nodes), outcome, attempts, time.monotonic() - begun)
        if result.departure > _FAR:
            note(
                f"the flight of this plan departs from it by {result.departure:.2g} rad; give it "
                "more nodes"
            )
    return result


def _searched(
    here: Search, nodes: int, starts: int, seed: int, count: int
) -> tuple[Outcome, tuple[Attempt, ...]]:
    """The best outcome, and what came of each start."""
    first = min(nodes, _COARSE)
    with searching(here, count) as search:
        outcomes = _tried(here, search, first, starts, seed)
        attempts = tuple(Attempt(o.status, o.iterations, o.objective, o.solved) for o in outcomes)
        solved = sorted((o for o in outcomes if o.solved), key=_objective)
        if not solved:
            tried = "the one start" if starts == 1 else f"any of {starts} starts"
            nearest = min(outcomes, key=lambda o: o.missed)
            why = reason(here.grid(first), nearest)
            raise SomersaultError(f"no plan found from {tried}: {why}")
        if first == nodes:
            return solved[0], attempts
        while solved:
            best, solved = solved[:_REFINED], solved[_REFINED:]
            with stage("planning: best starts refined", len(best)) as told_of:
                fine = search.solve([Refine(nodes, first, o.x) for o in best], told_of)
            good = [o for o in fine if o.solved]
            if good:
                return min(good, key=_objective), attempts
    raise SomersaultError(
        f"no plan found: what is solved on {first} nodes is not on {nodes}; give other nodes, or "
        "more starts"
    )


def _tried(
    here: Search, search: Processes, intervals: int, starts: int, seed: int
) -> list[Outcome]:
    """Outcomes of all starts: those that are drawn, and then leaps from the best so far.

    Leaps go in rounds of a fixed size, so that processes do not matter.
    """
    drawn = starts if starts <= _ROUND else max(_ROUND, starts // 3)
    wild = here.task.most is not None
    with stage("planning: starts tried", starts) as told_of:
        draws = [Draw(intervals, (seed, k), wild and k % 2 == 1) for k in range(drawn)]
        outcomes = search.solve(draws, told_of)
        while len(outcomes) < starts:
            numbers = range(len(outcomes), min(len(outcomes) + _ROUND, starts))
            solved = [o for o in outcomes if o.solved]
            jobs: list[Job]
            if solved:
                best = min(solved, key=_objective)
                jobs = [Leap(intervals, best.x, (seed, k)) for k in numbers]
            else:
                jobs = [Draw(intervals, (seed, k), wild and k % 2 == 1) for k in numbers]
            outcomes += search.solve(jobs, told_of)
    return outcomes


def _objective(outcome: Outcome) -> float:
    return outcome.objective


def _task(
    model: Model,
    somersaults: Turns,
    twists: Turns,
    torque: Ranged | Mapping[str, Ranged],
    duration: Ranged,
    joints: Iterable[str] | Mapping[str, Ranged] | None,
    start: Mapping[str, Ranged] | None,
    end: Mapping[str, Ranged] | None,
    rest_at_end: bool,
    takeoff: Mapping[str, Any] | None,
    landing: Mapping[str, Ranged] | None,
    aloft: Mapping[str, Ranged] | None,
    fastest: float | Mapping[str, float] | None,
    effort: float,
) -> Task:
    """What is asked, checked."""
    if not model.free or model.plane is not None:
        raise SomersaultError(
            f"{model.name} is not free in space, and a plan flies there; load it with base='free'"
        )
    begin = by_name("start", start)
    moving = moving_joints(model, joints, begin, torque, fastest)
    first = at_end(moving, "start", begin)
    last = at_end(moving, "end", by_name("end", end))
    for name in last:
        if name not in moving.joints:
            raise SomersaultError(f"end {name}: that joint does not move; name it in joints")
    home = dict(zip(model.coordinates, moving.still.tolist(), strict=True))
    at_start = [first.get(name, (home[name],) * 2) for name in moving.joints]
    ranges = zip(moving.joints, moving.low.tolist(), moving.high.tolist(), strict=True)
    at_landing = [last.get(name, (low, high)) for name, low, high in ranges]
    most, turns = _turns(somersaults, twists)
    ahead = by_name("takeoff", takeoff)
    begins = attitude("takeoff", ahead, np.zeros((3, 2)), (*RATES, "momentum"))
    usual = begins[[0, 1, 2], [0, 0, 0]][:, None] + turns
    lands = attitude("landing", by_name("landing", landing), usual, ())
    everywhere = np.array([[-_MOST_TURNED, _MOST_TURNED]] * 3)
    everywhere[1] = -_TILT, _TILT
    flies = attitude("aloft", by_name("aloft", aloft), everywhere, ())
    _check_attitudes(begins, lands, flies)
    rates, momentum = takeoff_rates(ahead)
    shortest, longest = ranged("duration", duration)
    if shortest <= 0 or not np.isfinite(longest):
        raise SomersaultError(f"duration must be positive and finite, and is {shown(duration)}")
    if number("effort", effort) < 0:
        raise SomersaultError(f"effort must not be negative, and is {effort:g}")
    return Task(
        model, moving, begins, lands, flies, rates, momentum, np.array(at_start),
        np.array(at_landing), truth("rest_at_end", rest_at_end), (shortest, longest), most,
        effort if most is not None else 1.0,
    )  # fmt: skip


def _turns(somersaults: Turns, twists: Turns) -> tuple[int | None, np.ndarray]:
    """Which angle is to be great, and how far each turns, (3, 2)."""
    most = None
    result = np.zeros((3, 2))
    for name, place, turns in (("somersaults", 0, somersaults), ("twists", 2, twists)):
        if isinstance(turns, str):
            if turns != "most":
                raise SomersaultError(f"{name} must be a number or 'most', and is {shown(turns)}")
            if most is not None:
                raise SomersaultError(
                    "somersaults and twists cannot both be the most; give a number for one"
                )
            most = place
            result[place] = -np.inf, np.inf
        else:
            result[place] = 2 * np.pi * number(name, turns)
    return most, result


def _check_attitudes(begins: np.ndarray, lands: np.ndarray, flies: np.ndarray) -> None:
    for k, name in enumerate(ANGLES):
        least, most = flies[k]
        if name == "tilt" and (least < -MOST_TILT or most > MOST_TILT):
            raise SomersaultError(
                f"aloft tilt from {least:g} to {most:g} comes to π/2, where somersault and twist "
                f"have no meaning; keep it within {MOST_TILT:g}"
            )
        for what, (low, high) in (("takeoff", begins[k]), ("landing", lands[k])):
            if high < least or low > most:
                where = f"{low:g}" if low == high else f"{low:g} to {high:g}"
                raise SomersaultError(
                    f"{what} {name} is {where} rad, outside of {least:g} to {most:g} aloft"
                )
