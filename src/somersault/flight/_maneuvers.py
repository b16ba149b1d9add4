"""Ready maneuvers: the three techniques of figure 1-1 of Playter (1994), and §6.2 and 6.3.

An athlete in the air cannot change his angular momentum. What he can do is change an inertia
(`inertia_change`), turn himself by a sequence of moves without any momentum (`cat_turn`), or tilt
his principal axes against the momentum, so that a somersault twists (`arm_tilt`, `hula`). In a
`torque_twist` the ground has done it before takeoff.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, name_list, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.attitude import in_sequence
from somersault.dynamics import Equations
from somersault.flight._maneuver import Maneuver
from somersault.flight._takeoff import Takeoff
from somersault.model import Model, load, named_pose
from somersault.model import pose as posed

Keyframes = Mapping[str, Sequence[tuple[float, float]]]
_SIDES = ("left", "right")
_LEGS_APART = {"hip_abduction": math.pi / 4}
_MOST_CYCLES = 1_000  # or twists
_LONGEST = 20.0  # s: whatever has not twisted until then will not
_FINE = 1e-13  # s


def inertia_change(
    model: str | Model = "gymnast",
    *,
    axis: int | None = None,
    poses: tuple[str, str] = ("layout", "tuck"),
    spin: float = 6.0,
    begin: float = 0.1,
    move: float = 0.25,
    duration: float = 0.6,
) -> Maneuver:
    """A spin that is speeded up, or slowed down, by going from one named pose to another.

    `axis` is 2 for a somersault (the default), 3 for a twist upright, as a skater's, or as the
    model's `axes` say; `spin` (rad/s) is its rate in the first pose; the move begins at `begin` and
    takes `move` s. The angular momentum lies along inertial axis `axis`. Raises SomersaultError for
    another axis, and for poses that are none.
    """
    a, _, c = load(model).axes
    axis = a if axis is None else axis
    if isinstance(axis, bool) or axis not in (a, c):
        raise SomersaultError(f"axis is {axis!r}; give {a} for a somersault or {c} for a twist")
    if len(name_list("poses", poses)) != 2:
        raise SomersaultError(f"poses are two, from which to which, and are {poses!r}")
    body, (first, last) = load(model), (_sides(model, name) for name in poses)
    begin, move = _seconds(begin=begin), _seconds(move=move)
    h = number("spin", spin) * _inertia(body, first)[axis - 1, axis - 1] * np.eye(3)[axis - 1]
    moves = _through([(begin, first), (begin + move, last)])
    return Maneuver.moves(
        body, moves, Takeoff(angular_momentum=h.tolist()), _seconds(duration=duration)
    )


def cat_turn(
    model: str | Model = "gymnast",
    *,
    cycles: int = 3,
    torso: float = math.pi / 4,
    legs: Mapping[str, float] | None = None,
    arms: float = math.pi / 2,
    move: float = 0.15,
) -> Maneuver:
    """Turning about the long axis without any angular momentum, as a falling cat does.

    With the legs apart, so that they are hard to turn, and the arms in, the torso is twisted to
    the left by `torso` (rad); then with the arms out to an abduction of `arms` and the legs
    together the torso is twisted back to the right, and it is the legs that turn. That is
    repeated for so many `cycles`; at the end every joint is where it was. `legs` is what the hips
    do while they are hard to turn (rad, by joint; by default 45° apart; {"hip_flexion": 1.57} pikes
    instead). Each move takes `move` s. A negative `torso` turns the other way. How far it turns
    depends on the path alone, not on the time it takes (Frohlich 1979). Raises SomersaultError for
    less than one cycle.
    """
    whole_number("cycles", cycles, 1, _MOST_CYCLES)
    body, straight = load(model), _sides(model, "layout")
    apart = straight | _both(body, _LEGS_APART if legs is None else legs)
    out = straight | _both(body, {"shoulder_abduction": number("arms", arms)})
    twist = number("torso", torso)
    row = [straight, apart, apart | {"torso_twist": twist}]
    for cycle in range(cycles):
        row += [out | {"torso_twist": twist}, out | {"torso_twist": -twist}]
        end = twist if cycle < cycles - 1 else 0.0
        row += [apart | {"torso_twist": -twist}, apart | {"torso_twist": end}]
    row.append(straight)
    span = _seconds(move=move)
    moves = _through([(span * k, pose) for k, pose in enumerate(row)])
    still = Takeoff(angular_momentum=(0.0, 0.0, 0.0))
    return Maneuver.moves(body, moves, still, span * (len(row) - 1))


def arm_tilt(
    model: str | Model = "gymnast",
    *,
    spin: float = 7.0,
    begin: float = 0.1,
    move: float = 0.2,
    raised: float = math.pi,
    lowered: float = 0.12,
    twists: int | None = 1,
    duration: float | None = None,
) -> Maneuver:
    """A layout somersault, arms out, that one arm raised and one lowered make twist.

    From `begin` on the left arm goes to an abduction of `raised`, the right one to `lowered` (rad),
    in `move` s: the body leans against them, its principal axes are tilted, and it twists. After
    `twists` whole twists the same move backwards takes the tilt out again. The moment is found by
    flying: the moves are placed symmetrically about a multiple of half a twist, and then motion
    from there on is the mirror image in time of motion until there (of an athlete without front
    and back exactly, otherwise nearly). None never stops. `spin` is the somersault rate in rad/s;
    `duration` (s) is by default half a second after the last move, or 2 s. Raises SomersaultError
    for less than one twist, and where that many never come.
    """
    body, out = load(model), _sides(model, "T")
    begin, move = _seconds(begin=begin), _seconds(move=move)
    asymmetric = out | {
        "left_shoulder_abduction": number("raised", raised),
        "right_shoulder_abduction": number("lowered", lowered),
    }
    stations = [(begin, out), (begin + move, asymmetric)]
    start = Takeoff(spin=number("spin", spin))
    if twists is None:
        longest = _seconds(duration=2.0 if duration is None else duration)
        return Maneuver.moves(body, _through(stations), start, longest)
    whole_number("twists, unless it is None,", twists, 1, _MOST_CYCLES)
    middle = twist_time(Maneuver.moves(body, _through(stations), start, begin + move), twists / 2)
    again = 2 * middle - begin - move
    stations += [(again, asymmetric), (again + move, out)]
    last = again + move + 0.5 if duration is None else _seconds(duration=duration)
    return Maneuver.moves(body, _through(stations), start, last)


def torque_twist(
    model: str | Model = "gymnast",
    *,
    spin: float = 7.0,
    twist_rate: float = 5.0,
    pose: str = "layout",
    duration: float = 1.2,
) -> Maneuver:
    """A somersault that twists from takeoff on, because the ground has given it both (§6.2).

    Upright at takeoff in a named pose, turning at `spin` about body axis 2 and at `twist_rate`
    about 3 (rad/s; of the model's `axes` the first and the last). The body's long axis is tilted
    from then on against the angular momentum, which lies along inertial axis 2; all that the pose
    does not hold still is left to the flight. Raises SomersaultError for poses that are none.
    """
    body, held = load(model), _sides(model, pose)
    along, _, up = (np.eye(3)[axis - 1] for axis in body.axes)
    omega = number("spin", spin) * along + number("twist_rate", twist_rate) * up
    h = _inertia(body, held) @ omega
    # Momentum (0, h2, h3) of an upright body: turned about axis 1 until it lies along 2.
    front, left, head = in_sequence(h.tolist(), body.axes)
    tilt = -math.copysign(1.0, left) * math.atan2(head, math.hypot(front, left))
    size = math.copysign(float(np.linalg.norm(h)), h @ along)
    start = Takeoff(tilt=tilt, angular_momentum=(size * along).tolist())
    return Maneuver.moves(body, _through([(0.0, held)]), start, _seconds(duration=duration))


def hula(
    model: str | Model = "gymnast",
    *,
    spin: float = 9.0,
    pike: float = 1.4,
    side: float = math.pi / 6,
    arms: str = "T",
    finish: str = "layout",
    begin: float = 0.05,
    quarter: float = 0.2,
    hold: float = 0.0,
    extend: float = 0.2,
    duration: float = 1.0,
) -> Maneuver:
    """A piked somersault that a quarter of a hula movement makes twist (§6.3; Yeadon 1984).

    Piked by `pike` (rad), the arms as in the pose `arms`, the hips swivel from `begin` on, in
    `quarter` s, until the legs are to the left of the body by `side` instead of in front; negative
    is to the right. So they are held for `hold` s, and then extend in `extend` s, while the arms go
    to where the pose `finish` has them. `spin` is the somersault rate at takeoff in rad/s. Raises
    SomersaultError for poses that are none.
    """
    body, end = load(model), _sides(model, finish)
    bent = _sides(model, arms) | _both(body, {"hip_flexion": number("pike", pike)})
    lean = number("side", side)
    swung = bent | _both(body, {"hip_flexion": 0.0})
    swung |= {"left_hip_abduction": lean, "right_hip_abduction": -lean}
    times = np.cumsum(
        [_seconds(begin=begin), _seconds(quarter=quarter), number("hold", hold),
         _seconds(extend=extend)]
    ).tolist()  # fmt: skip
    if hold < 0:
        raise SomersaultError(f"hold {hold:g} s is negative; the hips cannot extend before")
    poses = [bent, swung, swung, end]
    row = list(zip(times, poses, strict=True))
    moves = _through(row if hold > 0 else [row[0], *row[2:]])
    return Maneuver.moves(
        body, moves, Takeoff(spin=number("spin", spin)), _seconds(duration=duration)
    )


def twist_time(maneuver: Maneuver, twists: float) -> float:
    """When so many `twists` have been done, either way, in s: to rounding, by flying until there.

    The joints are held after their last keyframe. Raises SomersaultError where the body does not
    twist so far.
    """
    target = 2 * math.pi * number("twists", twists)
    longest = max(maneuver.duration, 1.0)
    while True:
        flown = maneuver.fly(duration=longest, accuracy=1e-12)
        twist = np.abs(flown.dataset["twist"].values - maneuver.takeoff.twist)
        if twist.max() >= target:
            break
        if longest >= _LONGEST:
            raise SomersaultError(
                f"this maneuver does not twist {twists:g} times in {longest:g} s; tilt it more"
            )
        longest *= 2
    after = int(np.argmax(twist >= target))
    if after == 0:
        return 0.0
    low, high = flown.times[after - 1], flown.times[after]
    from scipy.optimize import brentq

    def missing(time: float) -> float:
        here = maneuver.fly(duration=time, accuracy=1e-12, samples=2).landing.twist
        return abs(here - maneuver.takeoff.twist) - target

    low = max(float(low), 1e-9)
    return float(brentq(missing, low, float(high), xtol=_FINE, rtol=1e-14))


def _through(stations: Sequence[tuple[float, Mapping[str, float]]]) -> dict[str, Any]:
    """Keyframes of every joint through poses (rad by joint) at times (s), none to no purpose."""
    found: dict[str, list[tuple[float, float]]] = {}
    for name in stations[0][1]:
        row = [(time, pose[name]) for time, pose in stations]
        kept = [
            (time, angle)
            for k, (time, angle) in enumerate(row)
            if any(row[n][1] != angle for n in (k - 1, k + 1) if 0 <= n < len(row))
        ]
        found[name] = kept or row[:1]
    return found


def _sides(model: str | Model, name: str) -> dict[str, float]:
    """A named pose of every joint by its own name."""
    pose = named_pose(model, name)
    if "shoulder.1" in pose:
        raise SomersaultError(
            f"{load(model).name} has ball shoulders, which no maneuver moves; give it hinges"
        )
    return _both(load(model), pose)


def _both(model: Model, pose: Mapping[str, float]) -> dict[str, float]:
    """A pose with pairs that are named by what both sides share written out."""
    there = {joint.name for joint in model.joints}
    found = {}
    for name, angle in by_name("legs", pose).items():
        meant = [name] if name in there else [f"{side}_{name}" for side in _SIDES]
        for joint in meant:
            model.joint(joint)
            found[joint] = number(f"joint {name}", angle)
    return found


def _inertia(model: Model, pose: Mapping[str, float]) -> Array:
    """Of the whole body about its centre of mass in a pose, in the base's axes (3, 3)."""
    return Equations(model).inertia(np.asarray(posed(model, pose)))


def _seconds(**given: float) -> float:
    """A duration; SomersaultError unless it is positive."""
    ((name, value),) = given.items()
    if number(name, value) <= 0:
        raise SomersaultError(f"{name} {value:g} s is no duration; give a positive number")
    return float(value)
