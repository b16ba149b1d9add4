"""Running and somersaulting: physics that is MuJoCo's, and what an ensemble makes of it."""

from __future__ import annotations

import itertools
import json
import multiprocessing
import os
import pickle
import signal
import time
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

import somersault as so
from somersault import cli
from somersault.history import read_recording
from somersault.robot import Change, Control, End, Flip, Push, Robot, Run, Running, Runs, Start, run
from somersault.simulation import Simulation

G = 9.81


@pytest.fixture(scope="module")
def running() -> Run:
    return run("biped", 30.0)


@pytest.fixture(scope="module")
def flip() -> Run:
    return run("biped", 9.0, flip=3.0, samples=1000)


class TestRunning:
    def test_thirty_seconds_upright_at_its_speed(self, running: Run) -> None:
        assert running.ended == "time over"
        late = running.times > 5
        assert np.abs(np.degrees(running.angles[late])).max() < 12
        assert 0.8 < running.speed[late].mean() < 1.1
        assert np.ptp(running.speed[late]) < 0.4

    def test_alternates_and_flies(self, running: Run) -> None:
        """One foot at a time, in turns, and between them none."""
        down = running.sensed[:, [9, 13]] > 1.0
        assert not down.all(axis=1).any()
        assert 0.4 < (~down.any(axis=1)).mean() < 0.8
        states = [e.state for e in running.events]
        order = {"flight": "compression", "compression": "thrust", "thrust": "flight"}
        assert all(order[a] == b for a, b in itertools.pairwise(states))
        feet = [down[np.searchsorted(running.times, e.time) + 1] for e in running.events
                if e.state == "thrust"]  # fmt: skip
        assert all(a[0] != b[0] for a, b in itertools.pairwise(feet))

    def test_flights_are_parabolas(self, running: Run) -> None:
        """The speed upwards falls by g t in each."""
        ends = [e.time for e in running.events]
        for event, end in list(zip(running.events, ends[1:], strict=False))[6:30]:
            if event.state != "flight":
                continue
            inside = (running.times > event.time + 0.01) & (running.times < end - 0.01)
            slope = np.polyfit(running.times[inside], running.sensed[inside, 5], 1)[0]
            assert slope == pytest.approx(-G, rel=2e-3)

    @pytest.mark.parametrize("speed", [0.0, 0.5, 1.5])
    def test_speed_can_be_changed(self, speed: float) -> None:
        ran = run("biped", 10.0, Control(running=Running(speed=speed)))
        assert ran.ended == "time over"
        assert ran.speed[ran.times > 6].mean() == pytest.approx(speed, abs=0.25)

    def test_turns(self) -> None:
        ran = run("biped", 12.0, Control(running=Running(turn_rate=0.3)))
        assert ran.ended == "time over"
        w, x, y, z = ran.base_quaternion.T
        heading = np.unwrap(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y**2 + z**2)))
        assert heading[-1] == pytest.approx(0.3 * 12, abs=0.35)
        assert ran.speed[ran.times > 6].mean() > 0.7

    def test_changes_its_speed_as_it_runs(self) -> None:
        """Within some steps, and does not fall."""
        slow = Running(speed=0.5)
        ran = run("biped", 9.0, Control(running=slow, change=Change(at=5.0, speed=1.2)))
        assert not ran.fell
        before, after = (ran.times > 3) & (ran.times < 5), ran.times > 7
        assert ran.speed[before].mean() == pytest.approx(0.5, abs=0.15)
        assert ran.speed[after].mean() == pytest.approx(1.2, abs=0.2)
        unchanged = run("biped", 5.0, Control(running=slow))
        early = ran.times < 4.99
        np.testing.assert_array_equal(ran.positions[early], unchanged.positions[:-1][: early.sum()])

    def test_begins_to_turn_as_it_runs(self) -> None:
        """And keeps its speed, which was not asked to change."""
        ran = run("biped", 9.0, Control(change=Change(at=4.0, turn_rate=0.4)))
        assert not ran.fell
        heading = ran.kept["heading"]
        assert np.all(heading[ran.times < 4] == 0)
        w, x, y, z = ran.base_quaternion.T
        faced = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y**2 + z**2))
        assert faced[-1] == pytest.approx(0.4 * 5, abs=0.35)
        assert ran.speed[ran.times > 7].mean() == pytest.approx(1.0, abs=0.25)

    def test_each_of_many_changes_by_itself(self) -> None:
        """By how fast it is at the lift-off of a somersault; one speed is not given."""
        runs = Runs(control=Control(change=Change(at=0.5), flip=Flip(at=3.0)), duration=5.5)
        speeds = so.Vary(sets="change.speed", values=[0.5, 1.0, Change().speed])
        fast = so.ensemble(runs, vary={"speed": speeds}).dataset["lift_off_forward"].values
        assert fast[1] == fast[2] > fast[0] + 0.2

    def test_survives_a_push_and_falls_of_a_great_one(self) -> None:
        """Which is a result, and ends the run."""
        pushed = run("biped", 8.0, Control(push=Push(at=2.0, sideways=120.0)))
        assert not pushed.fell
        assert abs(pushed.sensed[pushed.times > 2.1][0, 4]) > 0.2
        fallen = run("biped", 8.0, Control(push=Push(at=2.0, sideways=3000.0)))
        assert fallen.fell
        assert fallen.ended == "fell before"
        assert fallen.times[-1] < 5


class TestSomersault:
    def test_the_steps_of_table_3_2_one_after_another(self, flip: Run) -> None:
        states = [e.state for e in flip.events]
        first = states.index("hurdle compression")
        assert states[first : first + 11] == [
            "hurdle compression", "hurdle thrust", "hurdle", "flip compression", "flip thrust",
            "tuck", "servo", "window", "landing compression", "landing thrust", "landing hop",
        ]  # fmt: skip
        assert flip.began("hurdle compression") >= 3.0
        assert "hurdle" not in states[first + 3 :]

    def test_turns_over_once_and_runs_on(self, flip: Run) -> None:
        before, after = flip.angles[flip.times < 3, 0], flip.angles[flip.times > 7, 0]
        assert np.abs(np.degrees(before)).max() < 10
        np.testing.assert_allclose(np.degrees(after), 360, atol=12)
        assert not flip.fell
        assert flip.outcome["steps_after"] >= 5

    def test_lands_where_it_is_told(self, flip: Run) -> None:
        assert flip.outcome["landing_somersault"] == pytest.approx(np.radians(350), abs=0.06)
        assert flip.outcome["landing_inclination"] == pytest.approx(
            flip.outcome["landing_wanted"], abs=0.05
        )
        other = run("biped", 5.2, Control(flip=Flip(attitude=np.radians(340))), flip=3.0)
        assert other.outcome["landing_somersault"] == pytest.approx(np.radians(340), abs=0.06)

    def test_keeps_its_momentum_in_the_air(self, flip: Run) -> None:
        """Angular, about the centre of mass, by MuJoCo; as well as its integrator can."""
        m, inside = flip.robot.machine.mujoco, _airborne(flip)
        data, spins = mujoco.MjData(m), []
        for q, v in zip(flip.positions[inside], flip.rates[inside], strict=True):
            data.qpos, data.qvel = q, v
            mujoco.mj_forward(m, data)
            mujoco.mj_subtreeVel(m, data)
            spins.append(data.subtree_angmom[1].copy())
        spins = np.array(spins)
        assert spins[0, 1] > 10
        assert np.abs(spins - spins[0]).max() < 0.02 * spins[0, 1]

    def test_legs_keep_within_their_lengths_in_the_air(self, flip: Run) -> None:
        inside = _airborne(flip)
        columns = [flip.model.coordinates.index(f"{side}_leg") for side in ("left", "right")]
        lengths = 0.647 + flip.joint_coordinates[inside][:, columns]
        assert lengths.min() > 0.647 - 0.01
        assert lengths.max() < 0.862 + 0.01

    def test_events_are_when_the_feet_say_so(self, flip: Run) -> None:
        down = (flip.sensed[:, [9, 13]] > 1.0).any(axis=1)
        touched = flip.times[(flip.times > flip.began("tuck") + 0.1) & down][0]
        assert flip.began("landing compression") == pytest.approx(touched, abs=2e-3)

    def test_a_wrong_estimate_of_lift_off_ends_elsewhere(self) -> None:
        """+10 %: it takes the flight for longer, and has turned less far when it lands."""
        control = Control(errors=so.robot.Errors(lift_off_speed=0.10))
        ran = run("biped", 5.2, control, flip=3.0)
        assert np.degrees(ran.outcome["landing_somersault"]) < 335

    def test_tuck_servo_and_window_each_do_something(self) -> None:
        """Without the servo it lands otherwise; without the window its legs are as they were."""
        without = run("biped", 5.2, Control(flip=Flip(servo=0.0, held_length=0.66)), flip=3.0)
        assert np.degrees(without.outcome["landing_somersault"]) > 365
        closed = run("biped", 5.2, Control(flip=Flip(window=-1.0)), flip=3.0)
        assert "window" not in [e.state for e in closed.events]
        body, legs = (closed.outcome[f"landing_{x}"] for x in ("somersault", "inclination"))
        hips = np.remainder(legs - body + np.pi, 2 * np.pi) - np.pi
        assert hips == pytest.approx(0.436, abs=0.08)


def _airborne(ran: Run) -> np.ndarray:
    return (ran.times > ran.began("tuck") + 0.003) & (
        ran.times < ran.began("landing compression") - 0.003
    )


class TestHistory:
    def test_is_a_history_of_its_model(self, flip: Run) -> None:
        """Feet by our own kinematics are where MuJoCo's sensors have them."""
        from somersault.model import body_frames

        assert flip.base_position.shape == (len(flip.times), 3)
        assert np.all(np.diff(flip.times) > 0)
        names = [body.name for body in flip.model.bodies]
        for k in (0, 3000, 4500, 5000):
            rotations, places = body_frames(flip.model, flip.joint_coordinates[k])
            for side, column in (("left", 6), ("right", 10)):
                b = names.index(f"{side}_lower_leg")
                foot = places[b] + rotations[b] @ [0, 0, -0.622]
                turn = so.attitude.matrix_from_quaternion(flip.base_quaternion[k])
                world = flip.base_position[k] + turn @ foot
                # Sensors are of the step before, half a millisecond earlier.
                np.testing.assert_allclose(world, flip.sensed[k, column : column + 3], atol=8e-3)

    def test_saved_and_read_again(self, flip: Run, tmp_path: Path) -> None:
        flip.save(tmp_path / "run.nc")
        again = read_recording(tmp_path / "run.nc", flip.model)
        np.testing.assert_array_equal(again.base_position, flip.base_position)
        np.testing.assert_array_equal(again.angles, flip.angles)
        assert flip.frame(4.0, size=(96, 64)).shape == (64, 96, 3)


# ------------------------------------------------------------------------------- ensembles

VARY = {
    "start": so.Vary(adds_to="start.forward", normal=[0.0, 0.05]),
    "torque": so.Vary(sets="errors.torque", normal=[0.0, 0.03]),
}
NOMINAL = Control(flip=Flip(at=0.5), end=End(steps_after=2))


def attempts() -> Runs:
    return Runs(control=NOMINAL, duration=6.0)


@pytest.fixture(scope="module")
def together() -> so.Ensemble:
    return so.ensemble(attempts(), vary=VARY, size=20, seed=3, threads=1)


class TestAttempts:
    def test_are_a_simulation(self) -> None:
        runs = attempts()
        assert isinstance(runs, Simulation)
        assert runs.name == "biped"
        assert runs.targets("flip.torque")[0].name == ("flip", "torque")
        with pytest.raises(so.SomersaultError, match=r"\[flip\] has at"):
            runs.targets("flip.torqe")
        with pytest.raises(so.SomersaultError, match="tables are start"):
            runs.targets("takeoff.tilt")
        again = pickle.loads(pickle.dumps(runs))
        assert again.specification == runs.specification

    def test_each_is_the_run_of_its_numbers(self, together: so.Ensemble) -> None:
        """One by one, by the function that gives histories."""
        data = together.dataset
        for k in (0, 7, 19):
            control = replace(
                NOMINAL, start=replace(Start(), forward=0.8 + float(data.start[k])),
                errors=replace(NOMINAL.errors, torque=float(data.torque[k])),
            )  # fmt: skip
            alone = so.robot.run_of(Runs(control=control, duration=6.0))
            for name, value in alone.outcome.items():
                assert float(data[name][k]) == value, name

    @pytest.mark.parametrize(("threads", "chunk"), [(2, None), (2, 7), (1, 3)])
    def test_same_bits_however_carried_out(
        self, together: so.Ensemble, threads: int, chunk: int | None
    ) -> None:
        other = so.ensemble(
            attempts(), vary=VARY, size=20, seed=3, threads=threads, chunk=chunk
        ).dataset
        for name, values in together.dataset.data_vars.items():
            assert values.values.tobytes() == other[name].values.tobytes(), name

    def test_same_bits_after_a_kill(self, together: so.Ensemble, tmp_path: Path) -> None:
        store = tmp_path / "attempts.zarr"
        process = multiprocessing.get_context("spawn").Process(target=_attempt, args=(store,))
        process.start()
        until = time.monotonic() + 120
        while not list(store.glob("ended/c/*")) and time.monotonic() < until:
            time.sleep(0.02)
        os.kill(process.pid or 0, signal.SIGKILL)
        process.join()
        done = len(list(store.glob("ended/c/*")))
        assert 0 < done < 10
        other = so.ensemble(attempts(), vary=VARY, size=20, seed=3, out=store).dataset
        for name, values in together.dataset.data_vars.items():
            assert values.values.tobytes() == other[name].values.tobytes(), name

    @pytest.mark.slow
    def test_same_bits_from_workers(self, together: so.Ensemble) -> None:
        other = so.ensemble(attempts(), vary=VARY, size=20, seed=3, chunk=8, workers=2).dataset
        for name, values in together.dataset.data_vars.items():
            assert values.values.tobytes() == other[name].values.tobytes(), name

    def test_falls_are_results_and_nonsense_no_start(self) -> None:
        vary = {"torque": so.Vary(sets="flip.torque", values=[0.0, 115.0, 400.0]),
                "friction": so.Vary(sets="plant.friction", samples=[1.0, -1.0])}  # fmt: skip
        with pytest.warns(so.SomersaultWarning, match="3 of 6 runs could not begin"):
            data = so.ensemble(attempts(), vary=vary, size=2).dataset
        words = data["ended"].attrs["flag_meanings"].split()
        ended = [[words[code] for code in row] for row in data["ended"].values]
        assert [row[1] for row in ended] == ["no_start"] * 3
        assert [row[0] for row in ended][1] == "ran_on"
        assert {row[0] for row in ended} & {"fell_landing", "fell_before"}
        assert data["ended"].attrs["failures"] == "broke_off no_start"

    def test_success_is_summed_up(self, together: so.Ensemble) -> None:
        share = so.ensembles.summary(together.dataset)["successes"]
        ran_on = so.ensembles.ended_by(together.dataset["ended"], "ran on")
        assert share["fraction"] == float(ran_on.mean())
        assert share["low"] < share["fraction"] <= share["high"]


def _attempt(store: Path) -> None:
    so.ensemble(attempts(), vary=VARY, size=20, seed=3, out=store, chunk=2, threads=1)


# ---------------------------------------------------------------------------------- mistakes

SPEC = """
robot = "biped"
duration = 6.0
[flip]
at = 0.5
[end]
steps_after = 2
"""


class TestMistakes:
    @pytest.mark.parametrize(
        ("control", "says"),
        [
            (lambda: Control(running=Running(pitch_stiffness=-1.0)), "pitch_stiffness must not be"),
            (lambda: Control(flip=Flip(torque=float("nan"))), "flip.torque must be a finite"),
            (lambda: Runs(control=Control(running=Running(leg_length=1.2))), "do not reach"),
            (lambda: Runs(duration=0.0), "duration of a run"),
            (lambda: run("biped", samples=300), "divide 1000"),
            (lambda: run(Robot("doll")), "left leg"),
        ],
    )
    def test_get_a_sentence(self, control: object, says: str) -> None:
        with pytest.raises(so.SomersaultError, match=says) as mistake:
            control()  # type: ignore[operator]
        assert "\n" not in str(mistake.value)


class TestCommand:
    def test_json(self, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
        page, out = tmp_path / "run.html", tmp_path / "run.nc"
        arguments = ["run", "biped", "--flip", "at=0.5", "--duration", "4", "--json"]
        assert cli.main([*arguments, "--page", str(page), "--out", str(out)]) == 0
        record = json.loads(capsys.readouterr().out)
        assert record["somersaults"] == 1
        assert record["fell"] is False
        assert next(state for _, state in record["events"]) == "flight"
        assert page.stat().st_size > 10_000
        assert out.is_file()

    def test_spec_for_one_and_for_many(
        self, capsys: pytest.CaptureFixture[str], tmp_path: Path
    ) -> None:
        spec = tmp_path / "run.toml"
        spec.write_text(SPEC)
        assert cli.main(["run", str(spec)]) == 0
        assert "ran on" in capsys.readouterr().out
        spec.write_text(SPEC + '[vary.torque]\nsets = "errors.torque"\nvalues = [-0.05, 0.05]\n')
        assert cli.main(["ensemble", str(spec), "--json"]) == 0
        record = json.loads(capsys.readouterr().out)
        assert record["ended"] == {"ran on": 2}
        assert record["successes"]["fraction"] == 1.0
        assert cli.main(["ensemble", str(spec)]) == 0
        assert "biped: 2 runs (torque 2)" in capsys.readouterr().out

    @pytest.mark.parametrize(
        ("arguments", "says"),
        [
            (["run", "bipet"], "bipet"),
            (["run", "biped", "--flip", "at=20"], "over at"),
            (["run", "biped", "--flip", "at=abc"], "KEY=NUMBER"),
            (["run", "biped", "--flip", "at=abc"], "--flip at=5"),
            (["run", "biped", "--flip", "torque=100"], "does not say when"),
            (["run", "who.bioMod"], "MJCF"),
            (["run", "biped", "--flip", "att=2"], "att is no key"),
            (["run", "biped", "--video", "flip.doc"], "another ending"),
            (["run", "biped", "--duration", "-1"], "duration of a run"),
        ],
    )
    def test_mistakes_exit_2_with_a_sentence(
        self, arguments: list[str], says: str, capsys: pytest.CaptureFixture[str]
    ) -> None:
        assert cli.main(arguments) == 2
        error = capsys.readouterr().err
        assert says in error
        assert error.count("\n") == 1
