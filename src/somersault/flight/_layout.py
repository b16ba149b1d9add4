"""Where the numbers of a flight stand: in its state, and among its parameters.

The state is (quaternion, ω, coordinates and speeds of the joints that are part of it), without the
first two where something holds the base. Where no joint is part of it only the attitude is unknown:
then the state is the quaternion alone, and ω is what the angular momentum, three parameters more,
leaves it. Where joints have laws the state ends with what is
carried from tick to tick: the angles as they were last sensed, the state of the noise, the phase
and what waits of the replay, and each joint's own. Parameters are first those that change on the
way (paths, the motor tape, what is sensed of the nominal flight), then those that stay (bodies, the
replay, joints, momentum).
"""

from __future__ import annotations

from dataclasses import dataclass

from somersault._core.errors import SomersaultError
from somersault.flight._playback import Playback
from somersault.flight.behaviours import JointTakeoff
from somersault.laws import STATE as NOISE
from somersault.model import Joint, Model
from somersault.motion import DEGREE, TAPE_DEGREE

ATTITUDE, RATE = 4, 3  # of a state: quaternion and ω
ANGLES = 3  # of what is carried: somersault, tilt and twist
PATH = 1 + DEGREE + 1  # parameters of a path: since when, and its polynomial
TAPED = TAPE_DEGREE + 1  # of each joint on the tape, and of what is sensed: a polynomial


@dataclass(frozen=True)
class Slot:
    """Where one joint's numbers stand: `q`, `u` and `carried` in the state, `paths` and `lasting`
    among the parameters; `tape` the polynomial of its torque on the motor tape."""

    joint: Joint
    kind: JointTakeoff
    q: range
    u: range
    carried: range
    paths: tuple[range, ...]
    lasting: range
    tape: range


@dataclass(frozen=True)
class Layout:
    """The places of all of them; `tape` is where the motor tape's time of origin stands, `sensed`
    and `noise` what is carried of the body, `every` the time between ticks (s) if there are any.
    `replay` is what is carried of the replay and `replay_numbers` its parameters; `nominal` is
    where the polynomials of what is sensed of the nominal flight stand, behind their time of
    origin."""

    slots: tuple[Slot, ...]
    bound: bool
    state: int
    sensed: range
    noise: range
    replay: range
    every: float | None
    changing: int
    nominal: range
    bodies: range
    replay_numbers: range
    momentum: range
    parameters: int
    tape: int | None


def layout(
    model: Model, kinds: tuple[JointTakeoff, ...], bodies: tuple[str, ...], tape: bool,
    playback: Playback | None,
) -> Layout:  # fmt: skip
    """The layout of a model's flight whose joints are of these kinds.

    `bodies` names the numbers of bodies that are parameters; with `tape` the torques of the nominal
    motion act at the joints whose `nominal` behaviour is another. `playback` is of a kind.
    """
    pairs = list(zip(model.joints, kinds, strict=True))
    moving = [joint for joint, kind in pairs if kind.in_state]
    bound = model.free and not moving
    q = (ATTITUDE if bound else ATTITUDE + RATE) if model.free else 0
    u = q + sum(joint.coordinates for joint in moving)
    moved = u + sum(joint.speeds for joint in moving)
    every = _every(pairs, playback)
    sensed = range(moved, moved + (ANGLES if every else 0))
    noisy = any(kind.sensing and kind.sensing.noisy for kind in kinds)
    noisy = noisy or (playback is not None and playback.replay.noisy)
    noise = range(sensed.stop, sensed.stop + (NOISE if noisy else 0))
    replayed = range(noise.stop, noise.stop + (playback.carried if playback else 0))
    carried = replayed.stop
    path, origin = 0, PATH * sum(kind.path_count for kind in kinds)
    taped = origin + 1
    played = sum(is_taped(kind) for kind in kinds) if tape else 0
    sensed_nominal = origin + (1 + TAPED * played if tape else 0)
    errors = len(playback.errors) if playback else 0
    nominal = range(sensed_nominal, sensed_nominal + (1 + TAPED * errors if errors else 0))
    changing = nominal.stop
    lasting = changing + len(bodies)
    of_replay = range(lasting, lasting + (len(playback.parameters) if playback else 0))
    lasting = of_replay.stop
    slots = []
    for joint, kind in pairs:
        n_q, n_u = (joint.coordinates, joint.speeds) if kind.in_state else (0, 0)
        n_p = len(kind.parameters(joint))
        n_t = TAPED if tape and is_taped(kind) else 0
        paths = tuple(range(path + PATH * k, path + PATH * (k + 1)) for k in range(kind.path_count))
        n_c = kind.sensing.carried if kind.sensing else 0
        slot = Slot(
            joint, kind, range(q, q + n_q), range(u, u + n_u), range(carried, carried + n_c), paths,
            range(lasting, lasting + n_p), range(taped, taped + n_t),
        )  # fmt: skip
        slots.append(slot)
        q, u, lasting, taped = q + n_q, u + n_u, lasting + n_p, taped + n_t
        path, carried = path + PATH * kind.path_count, carried + n_c
    momentum = range(lasting, lasting + (RATE if bound else 0))
    return Layout(
        tuple(slots), bound, carried, sensed, noise, replayed, every, changing, nominal,
        range(changing, changing + len(bodies)), of_replay, momentum, momentum.stop,
        origin if tape else None,
    )  # fmt: skip


def _every(pairs: list[tuple[Joint, JointTakeoff]], playback: Playback | None) -> float | None:
    """The time between the ticks of all laws, s; SomersaultError where they differ."""
    every = None if playback is None else playback.replay.every
    for joint, kind in pairs:
        if kind.sensing is None:
            continue
        one = kind.sensing.every
        if every not in (None, one):
            raise SomersaultError(
                f"joint {joint.name} senses every {one:g} s, and another one every {every:g} s; "
                "the laws of a flight have the same ticks, so give them the same time"
            )
        every = one
    return every


def is_taped(kind: JointTakeoff) -> bool:
    """Whether the motor tape acts at a joint: where the nominal flight does something else."""
    return kind.in_state and not kind.nominal().in_state
