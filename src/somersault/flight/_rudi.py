"""The rudi: a front somersault with one and a half twists (Playter 1994, section 6.3.1)."""

from __future__ import annotations

from math import pi

from somersault._core.numbers import number
from somersault.flight._maneuver import Maneuver
from somersault.flight._poses import named, seconds
from somersault.flight._takeoff import Takeoff
from somersault.model import Model, load

_ARM = {
    "shoulder_abduction": pi / 2,
    "shoulder_rotation": 0.0,
    "shoulder_flexion": 0.0,
    "elbow": 0.0,
}
_FIRST = 0.001  # s, before which nothing moves
_APART = 0.01  # s, between one movement of the legs and the next
_CENTRED = 0.12  # s, which the legs take at least to come back under the body


def rudi(
    model: str | Model = "gymnast",
    *,
    spin: float = 12.6,
    duration: float = 1.0731,
    pike: float = 2.3307,
    side: float = 0.2311,
    swing: float = 0.0087,
    swing_time: float = 0.2375,
    extend: float = 0.0028,
    extend_time: float = 0.3262,
    centre: float = -0.2083,
    torso: float = -0.5903,
    wrap: float = 0.0567,
    wrap_time: float = 0.2754,
    early: float = -0.0125,
    stay: float = 0.0927,
    open_time: float = 0.2423,
    late: float = 0.1000,
    back: float = -0.0249,
    back_side: float = -0.4783,
    out_time: float = 0.4500,
    back_time: float = 0.1751,
    back_pike: float = 1.1721,
) -> Maneuver:
    """A somersault forwards with one and a half twists to the right, out of a pike, by the hula.

    The athlete takes off piked, with the arms straight out. The legs swing from before the body to
    its side and then under it, which tilts him, while the arms are wrapped; the arms open, and the
    legs make a part of that movement backwards, which takes the tilt out again. By default it is
    within seven eighths of an athlete's torques (hips 250 N m, shoulders and torso 150, elbows 70).

    Parameters
    ----------
    model : str or Model
        An athlete, by whose named pose "wrap" the arms are wrapped.
    spin : float
        Of the somersault at takeoff, rad/s.
    duration : float
        s.
    pike : float
        Flexion of the hips at takeoff, rad.
    side, swing, swing_time : float
        How far the legs swing to the side (rad), when that begins, and how long it takes (s).
    extend, extend_time : float
        How long after the swing begins the hips extend, and how long that takes, s.
    centre : float
        How long after they are extended the legs are under the body, s.
    torso : float
        Twist of the torso while the legs swing, rad.
    wrap, wrap_time : float
        When the arms come in, and how long that takes, s.
    early : float
        How much later the left arm comes in than the right, s.
    stay, open_time : float
        How long the arms stay in, and how long they take to open, s.
    late : float
        How much later the right arm opens than the left, s.
    back : float
        How long after the arms begin to open the legs swing out again, s.
    back_side, back_pike : float
        How far the legs then go to the side and to the front, rad.
    out_time, back_time : float
        How long that takes, out and back again, s.

    Returns
    -------
    Maneuver

    Raises
    ------
    SomersaultError
        For moves that take no time, and angles beyond the limits of joints.

    Examples
    --------
    >>> import somersault as so
    >>> landing = so.rudi().fly().landing
    >>> round(landing.somersault / 6.2832, 2), round(landing.twist / 6.2832, 2)
    (1.0, -1.5)
    """
    body = load(model)
    for name, time in {
        "swing_time": swing_time, "extend_time": extend_time, "wrap_time": wrap_time, "stay": stay,
        "open_time": open_time, "out_time": out_time, "back_time": back_time,
    }.items():  # fmt: skip
        seconds(**{name: time})
    for name, by in {
        "pike": pike, "side": side, "swing": swing, "extend": extend, "centre": centre,
        "torso": torso, "wrap": wrap, "early": early, "late": late, "back": back,
        "back_side": back_side, "back_pike": back_pike,
    }.items():  # fmt: skip
        number(name, by)
    swung = swing + swing_time
    extending = max(swing + extend, _FIRST)
    straight = max(extending + extend_time, swung + 2 * _APART)
    centred = max(straight + centre, swung + _CENTRED)
    wraps = wrap + max(early, 0.0), wrap + max(-early, 0.0)
    opening = max(wraps) + wrap_time + stay
    opens = opening - min(late, 0.0), opening + max(late, 0.0)
    again = max(opening + back, max(centred, straight) + _APART)
    out = again + out_time
    home = out + back_time
    wrapped = named(body, "wrap")
    moves = {"torso_twist": [(swing, 0.0), (swung, torso), (centred, 0.0)]}
    for k, (arm, leg) in enumerate((("left", 1), ("right", -1))):
        moves[f"{arm}_hip_flexion"] = [
            (extending, pike), (straight, 0.0), (again, 0.0), (out, back_pike), (home, 0.0),
        ]  # fmt: skip
        moves[f"{arm}_hip_abduction"] = [
            (swing, 0.0), (swung, leg * side), (centred, 0.0), (again, 0.0),
            (out, leg * back_side), (home, 0.0),
        ]  # fmt: skip
        for joint, straight_out in _ARM.items():
            angle = wrapped[f"{arm}_{joint}"]
            moves[f"{arm}_{joint}"] = [
                (wraps[k], straight_out), (wraps[k] + wrap_time, angle), (opens[k], angle),
                (opens[k] + open_time, straight_out),
            ]  # fmt: skip
    return Maneuver.moves(body, moves, Takeoff(spin=spin), duration)
