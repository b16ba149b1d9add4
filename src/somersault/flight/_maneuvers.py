"""Ready maneuvers: the three techniques of figure 1-1 of Playter (1994), and §6.2 and 6.3.

An athlete in the air cannot change his angular momentum. What he can do is change an inertia
(`inertia_change`), turn himself by a sequence of moves without any momentum (`cat_turn`), or tilt
his principal axes against the momentum, so that a somersault twists (`arm_tilt`, `hula`). In a
`torque_twist` the ground has done it before takeoff.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from somersault._core.checks import name_list, shown, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.attitude import in_sequence
from somersault.flight._maneuver import Maneuver
from somersault.flight._poses import both, inertia, named, seconds, through
from somersault.flight._takeoff import Takeoff
from somersault.flight._twist_time import twist_time
from somersault.model import Model, load

_LEGS_APART = {"hip_abduction": math.pi / 4}
_MOST_CYCLES = 1_000  # or twists


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
    """A spin that goes faster, or slower, because the body goes from one named pose to another.

    Parameters
    ----------
    model : str or Model
    axis : int, optional
        2 for a somersault (the default), 3 for a twist upright, as a skater's; or as the model's
        `axes` say. The angular momentum lies along the inertial axis of that number.
    poses : (str, str)
        From which pose to which.
    spin : float
        Rate in the first pose, rad/s.
    begin, move : float
        When the move begins, and how long it takes, s.
    duration : float
        s.

    Returns
    -------
    Maneuver

    Raises
    ------
    SomersaultError
        For another axis, and for poses that do not exist.

    Examples
    --------
    >>> import somersault as so
    >>> tuck = so.inertia_change(poses=("layout", "tuck"))
    >>> bool(tuck.fly().angular_velocity[-1, 1] > 2 * 6.0)
    True
    """
    a, _, c = load(model).axes
    axis = a if axis is None else axis
    if isinstance(axis, bool) or not isinstance(axis, int) or axis not in (a, c):
        raise SomersaultError(
            f"axis is {shown(axis)}; give {a} for a somersault or {c} for a twist"
        )
    if len(name_list("poses", poses)) != 2:
        raise SomersaultError(f"poses are two, from which to which, and are {shown(poses)}")
    body, (first, last) = load(model), (named(model, name) for name in poses)
    begin, move = seconds(begin=begin), seconds(move=move)
    h = number("spin", spin) * inertia(body, first)[axis - 1, axis - 1] * np.eye(3)[axis - 1]
    moves = through([(begin, first), (begin + move, last)])
    return Maneuver.moves(
        body, moves, Takeoff(angular_momentum=h.tolist()), seconds(duration=duration)
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
    """A turn about the long axis without any angular momentum, as a falling cat makes it.

    With the legs apart, so that they are hard to turn, and the arms in, the torso is twisted to the
    left. Then, with the arms out and the legs together, it is twisted back to the right, and it is
    the legs that turn. At the end every joint is where it was. How far the body turns depends on
    the path alone, not on the time that it takes (Frohlich 1979).

    Parameters
    ----------
    model : str or Model
    cycles : int
        How often that is repeated.
    torso : float
        How far the torso is twisted, rad; negative to turn the other way.
    legs : mapping of str to float, optional
        What the hips do while they are hard to turn (rad, by joint): 45° apart by default;
        {"hip_flexion": 1.57} pikes instead.
    arms : float
        Abduction of the arms when they are out, rad.
    move : float
        How long each move takes, s.

    Returns
    -------
    Maneuver

    Raises
    ------
    SomersaultError
        For fewer than one cycle.

    Examples
    --------
    >>> import somersault as so
    >>> bool(abs(so.cat_turn(cycles=1).fly().landing.twist) > 0.3)
    True
    """
    whole_number("cycles", cycles, 1, _MOST_CYCLES)
    body, straight = load(model), named(model, "layout")
    apart = straight | both(body, _LEGS_APART if legs is None else legs)
    out = straight | both(body, {"shoulder_abduction": number("arms", arms)})
    twist = number("torso", torso)
    row = [straight, apart, apart | {"torso_twist": twist}]
    for cycle in range(cycles):
        row += [out | {"torso_twist": twist}, out | {"torso_twist": -twist}]
        end = twist if cycle < cycles - 1 else 0.0
        row += [apart | {"torso_twist": -twist}, apart | {"torso_twist": end}]
    row.append(straight)
    span = seconds(move=move)
    moves = through([(span * k, pose) for k, pose in enumerate(row)])
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
    """A layout somersault, arms out, that twists because one arm is raised and the other lowered.

    The body leans against the arms: its principal axes are tilted against the angular momentum, and
    it twists. After some whole twists the same move backwards takes the tilt out again. The moment
    for it is found by flying: the moves are placed symmetrically about a multiple of half a twist,
    and the motion from there on is then the mirror image in time of the motion until there (exactly
    for an athlete without front and back, nearly for others).

    Parameters
    ----------
    model : str or Model
    spin : float
        Somersault rate, rad/s.
    begin, move : float
        When the first move begins, and how long each takes, s.
    raised, lowered : float
        Abduction of the left and the right arm, rad.
    twists : int or None
        After how many whole twists it stops; None never stops.
    duration : float, optional
        s; half a second after the last move unless it is given, or 2 s where it never stops.

    Returns
    -------
    Maneuver

    Raises
    ------
    SomersaultError
        For fewer than one twist, and where that many never come.

    Examples
    --------
    >>> import math
    >>> import somersault as so
    >>> round(so.arm_tilt().fly().landing.twist / (2 * math.pi), 1)
    1.0
    """
    body, out = load(model), named(model, "T")
    begin, move = seconds(begin=begin), seconds(move=move)
    asymmetric = out | {
        "left_shoulder_abduction": number("raised", raised),
        "right_shoulder_abduction": number("lowered", lowered),
    }
    stations = [(begin, out), (begin + move, asymmetric)]
    start = Takeoff(spin=number("spin", spin))
    if twists is None:
        longest = seconds(duration=2.0 if duration is None else duration)
        return Maneuver.moves(body, through(stations), start, longest)
    whole_number("twists, unless it is None,", twists, 1, _MOST_CYCLES)
    middle = twist_time(Maneuver.moves(body, through(stations), start, begin + move), twists / 2)
    again = 2 * middle - begin - move
    stations += [(again, asymmetric), (again + move, out)]
    last = again + move + 0.5 if duration is None else seconds(duration=duration)
    return Maneuver.moves(body, through(stations), start, last)


def torque_twist(
    model: str | Model = "gymnast",
    *,
    spin: float = 7.0,
    twist_rate: float = 5.0,
    pose: str = "layout",
    duration: float = 1.2,
) -> Maneuver:
    """A somersault that twists from takeoff on, because the ground has given it both (section 6.2).

    The body takes off upright, turning about its axes of somersault and of twist. Its long axis is
    tilted from then on against the angular momentum, which lies along the inertial axis of
    somersault.

    Parameters
    ----------
    model : str or Model
    spin, twist_rate : float
        rad/s about the body's axes of somersault and of twist.
    pose : str
        A named pose, which the flight holds.
    duration : float
        s.

    Returns
    -------
    Maneuver

    Raises
    ------
    SomersaultError
        For a pose that does not exist.

    Examples
    --------
    >>> import somersault as so
    >>> bool(so.torque_twist().fly().landing.twist > 5.0)
    True
    """
    body, held = load(model), named(model, pose)
    along, _, up = (np.eye(3)[axis - 1] for axis in body.axes)
    omega = number("spin", spin) * along + number("twist_rate", twist_rate) * up
    h = inertia(body, held) @ omega
    # Momentum (0, h2, h3) of an upright body: turned about axis 1 until it lies along 2.
    front, left, head = in_sequence(h.tolist(), body.axes)
    tilt = -math.copysign(1.0, left) * math.atan2(head, math.hypot(front, left))
    size = math.copysign(float(np.linalg.norm(h)), h @ along)
    start = Takeoff(tilt=tilt, angular_momentum=(size * along).tolist())
    return Maneuver.moves(body, through([(0.0, held)]), start, seconds(duration=duration))


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

    Piked, the hips swivel until the legs are to the side of the body instead of in front. They are
    held there, and then extend while the arms go to where the last pose has them.

    Parameters
    ----------
    model : str or Model
    spin : float
        Somersault rate at takeoff, rad/s.
    pike : float
        Hip flexion at takeoff, rad.
    side : float
        How far the legs swivel to the left, rad; negative to the right.
    arms, finish : str
        Named poses of the arms at takeoff, and of the body at the end.
    begin, quarter, hold, extend : float
        When the hips begin to swivel, how long that takes, how long they are held, and how long
        they take to extend, s.
    duration : float
        s.

    Returns
    -------
    Maneuver

    Raises
    ------
    SomersaultError
        For poses that do not exist.

    Examples
    --------
    >>> import somersault as so
    >>> bool(abs(so.hula().fly().landing.twist) > 1.0)
    True
    """
    body, end = load(model), named(model, finish)
    bent = named(model, arms) | both(body, {"hip_flexion": number("pike", pike)})
    lean = number("side", side)
    swung = bent | both(body, {"hip_flexion": 0.0})
    swung |= {"left_hip_abduction": lean, "right_hip_abduction": -lean}
    times = np.cumsum(
        [seconds(begin=begin), seconds(quarter=quarter), number("hold", hold),
         seconds(extend=extend)]
    ).tolist()  # fmt: skip
    if hold < 0:
        raise SomersaultError(f"hold {hold:g} s is negative; the hips cannot extend before")
    poses = [bent, swung, swung, end]
    row = list(zip(times, poses, strict=True))
    moves = through(row if hold > 0 else [row[0], *row[2:]])
    return Maneuver.moves(
        body, moves, Takeoff(spin=number("spin", spin)), seconds(duration=duration)
    )
