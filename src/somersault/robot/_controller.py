"""States as one expression: what is sensed and remembered, to what is done and remembered next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import casadi as ca

from somersault.engine import ClosedLoop
from somersault.robot._commands import Command
from somersault.robot._control import NEVER, Control, Running, Symbolic
from somersault.robot._expressions import all_of, choose, clip, vector
from somersault.robot._robot import PERIOD, SENSORS, Robot
from somersault.robot._sensed import Sensed, sensed
from somersault.robot._somersault import KICK
from somersault.robot._states import Now, State

FELL, RAN_ON = 1.0, 2.0  # why a run is over

REMEMBERED = {
    "over": 0.0, "clock": 0.0, "state": 0.0, "since": 0.0, "side": 1.0, "steps": 0.0,
    "heading": 0.0, "somersault": 0.0, "tilt": 0.0, "twist": 0.0, "turns": 0.0,
    "steps_after": 0.0, "left_piston": 0.0,
    "right_piston": 0.0, "length": 0.0, "right_length": 0.0, "flip_time": 0.0,
    "lift_off_time": 0.0, "lift_off_speed": 0.0, "lift_off_estimate": 0.0, "lift_off_height": 0.0,
    "lift_off_forward": 0.0, "lift_off_rate": 0.0, "lift_off_somersault": 0.0,
    "servo_time": 0.0, "servo_rate": 0.0, "window_time": 0.0,
    "servo_length": 0.0, "time_left": 0.0, "turning_left": 0.0, "landing_time": 0.0,
    "landing_somersault": 0.0, "landing_rate": 0.0, "landing_tilt": 0.0, "landing_twist": 0.0,
    "landing_inclination": 0.0, "landing_wanted": 0.0, "landing_forward": 0.0,
    "greatest_tilt": 0.0, "greatest_torque": 0.0,
    "course": 0.0, "to_turn": 0.0, "straddle": 0.0,
}  # fmt: skip
"""What a controller remembers, and what of it at the start."""


class Controller:
    """The controller of a robot that is in one of some states.

    Parameters
    ----------
    robot : Robot
    states : sequence of State
        The first is that at the start.
    """

    def __init__(self, robot: Robot, states: Sequence[State]) -> None:
        self.robot, self.states = robot, tuple(states)
        self.names = tuple(state.name for state in states)

    @cached_property
    def loop(self) -> ClosedLoop:
        """Compiled, and joined to what MuJoCo keeps."""
        m = self.robot.machine.mujoco
        qpos, qvel = ca.SX.sym("qpos", m.nq), ca.SX.sym("qvel", m.nv)
        sensors = ca.SX.sym("sensors", SENSORS)
        kept = ca.SX.sym("kept", len(REMEMBERED))
        numbers = ca.SX.sym("numbers", len(Control().numbers()))
        result = self._result(qpos, qvel, sensors, kept, numbers)
        result = ca.densify(ca.cse(result))
        function = ca.Function("controller", [qpos, qvel, sensors, kept, numbers], [result])
        return ClosedLoop(function, (m.nu, 6, len(REMEMBERED)))

    def _result(self, qpos: Any, qvel: Any, sensors: Any, kept: Any, numbers: Any) -> Any:
        before = dict(zip(REMEMBERED, ca.vertsplit(kept), strict=True))
        control = Symbolic(iter(ca.vertsplit(numbers)))
        control.running = _at(before["clock"], control)
        robot = self.robot
        pistons = (before["left_piston"], before["right_piston"])
        here = sensed(robot, qpos, qvel, sensors, before["heading"], before["somersault"], pistons)
        now = Now(
            here, before, control, robot.machine, before["since"], before["clock"],
            robot.shortest, robot.longest,
        )  # fmt: skip
        after = dict(before)
        after["clock"] = before["clock"] + PERIOD
        after["since"] = before["since"] + PERIOD
        most = control.twist.turn_rate * PERIOD
        turned = clip(before["to_turn"], -most, most)
        after["to_turn"] = before["to_turn"] - turned
        after["heading"] = before["heading"] + control.running.turn_rate * PERIOD + turned
        after["somersault"] = here.somersault
        after |= _attitude(here)
        commands = self._commands_and_changes(now, after)
        after["left_piston"], after["right_piston"] = (
            piston + clip(c.length - piston, -c.piston_speed * PERIOD, c.piston_speed * PERIOD)
            for piston, c in zip(pistons, commands, strict=True)
        )
        over = choose(
            here.hip_height < control.end.fall_height, FELL,
            choose(before["steps_after"] >= control.end.steps_after, RAN_ON, 0.0),
        )  # fmt: skip
        after["over"] = over
        airborne = all_of(before["lift_off_time"] > 0, before["turns"] < 0.5)
        after["greatest_tilt"] = choose(
            airborne, ca.fmax(before["greatest_tilt"], ca.fabs(after["tilt"])),
            before["greatest_tilt"],
        )  # fmt: skip
        drive, greatest = self._drive(commands, (after["left_piston"], after["right_piston"]))
        after["greatest_torque"] = ca.fmax(before["greatest_torque"], greatest)
        return ca.vertcat(over, drive, self._pushes(now), *(after[name] for name in REMEMBERED))

    def _commands_and_changes(self, now: Now, after: dict[str, Any]) -> list[Command]:
        """The commands of the state that it is in; what is remembered is changed in `after`."""
        before, chosen = now.kept, None
        for code, state in enumerate(self.states):
            here = before["state"] == code
            commands = state.commands(now)
            chosen = commands if chosen is None else [
                Command(*(
                    choose(here, getattr(new, part), getattr(old, part))
                    for part in ("torques", "length", "piston_speed")
                ))
                for new, old in zip(commands, chosen, strict=True)
            ]  # fmt: skip
            for name, value in state.keeps(now).items():
                after[name] = choose(here, value, after[name])
            free = here  # whether no exit before this one held
            for way in state.exits(now):
                taken = all_of(free, way.when)
                for name, value in way.keep.items():
                    after[name] = choose(taken, value, after[name])
                after["state"] = choose(taken, self.names.index(way.to), after["state"])
                after["since"] = choose(taken, 0.0, after["since"])
                free = all_of(free, ca.logic_not(way.when))
        assert chosen is not None
        return list(chosen)

    def _drive(self, commands: Sequence[Command], pistons: Sequence[Any]) -> tuple[Any, Any]:
        """What MuJoCo's actuators are told, and the greatest torque in parts of what there is."""
        machine = self.robot.machine
        told: list[Any] = [0.0] * machine.mujoco.nu
        shares = []
        sides = zip(("left", "right"), commands, pistons, machine.resting, strict=True)
        for side, command, piston, resting in sides:
            at = machine.address_of[side]
            for k, (motor, limit) in enumerate(zip(at.motors, at.limits, strict=True)):
                told[motor] = clip(command.torques[k], -limit, limit)
                shares.append(ca.fabs(told[motor]) / limit)
            for actuator in at.pistons:
                told[actuator] = piston - float(resting)
        greatest = shares[0]
        for share in shares[1:]:
            greatest = ca.fmax(greatest, share)
        return vector(told), greatest

    def _pushes(self, now: Now) -> Any:
        """Force and moment on the torso, in the world's axes."""
        push, errors = now.control.push, now.control.errors
        pushed = all_of(now.clock >= push.at, now.clock < push.at + push.duration)
        kicked = all_of(now.kept["state"] == self.names.index("hurdle"), now.since < KICK)
        machine = now.machine
        force = [
            choose(pushed, one, 0.0) + choose(kicked, machine.mass * other / KICK, 0.0)
            for one, other in (
                (push.forward, errors.forward), (push.sideways, errors.sideways),
                (push.upward, errors.upward),
            )
        ]  # fmt: skip
        turning = (errors.roll, errors.pitch, errors.yaw)
        moment = [
            choose(kicked, float(inertia) * rate / KICK, 0.0)
            for inertia, rate in zip(machine.inertias, turning, strict=True)
        ]
        return vector([*force, *moment])


def _at(clock: Any, control: Symbolic) -> Running:
    """[running] at a time, with what [change] makes of it."""
    changed = {}
    for name in ("speed", "turn_rate"):
        before, then = getattr(control.running, name), getattr(control.change, name)
        given = ca.fabs(then) < NEVER / 2
        changed[name] = choose(all_of(clock >= control.change.at, given), then, before)
    return replace(control.running, **changed)


def _attitude(here: Sensed) -> dict[str, Any]:
    """Tilt and twist, rad."""
    row = here.attitude[1, :]
    return {
        "tilt": ca.atan2(-row[2], ca.sqrt(row[0] ** 2 + row[1] ** 2)),
        "twist": ca.atan2(row[0], row[1]),
    }
