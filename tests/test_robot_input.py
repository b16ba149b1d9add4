"""What a robot's user can get wrong: numbers of its controller, by all the ways they are given."""

from __future__ import annotations

from pathlib import Path

import pytest

import somersault as so
from somersault import cli
from somersault.robot import (
    Control,
    End,
    Flip,
    Plant,
    Push,
    Running,
    Runs,
    Twist,
    parse_runs,
    run,
    usual,
)

TOO_SMALL = {
    "running.speed_gain": Running(speed_gain=-0.1),
    "running.thrust_factor": Running(thrust_factor=-1.0),
    "running.idle_length": Running(idle_length=0.0),
    "flip.landing_gain": Flip(landing_gain=-1.0),
    "flip.at": Flip(at=-1.0),
    "twist.straddle_gain": Twist(straddle_gain=-4.0),
    "twist.turn_rate": Twist(turn_rate=-1.0),
    "plant.pitch_inertia": Plant(pitch_inertia=0.0),
    "push.duration": Push(duration=-0.1),
    "end.steps_after": End(steps_after=0.0),
}


class TestNumbersTooSmall:
    @pytest.mark.parametrize("name", TOO_SMALL)
    def test_are_refused_by_name(self, name: str) -> None:
        table = name.split(".")[0]
        with pytest.raises(so.SomersaultError, match=f"^{name} must ") as refused:
            Control(**{table: TOO_SMALL[name]})  # type: ignore[arg-type]
        assert "\n" not in str(refused.value)

    @pytest.mark.parametrize("name", TOO_SMALL)
    def test_cannot_begin_in_an_ensemble(self, name: str) -> None:
        table, number = name.split(".")
        values = {**Runs().values, (table, number): getattr(TOO_SMALL[name], number)}
        assert Runs().sound(Runs().values, 1).tolist() == [True]
        assert Runs().sound(values, 1).tolist() == [False]

    @pytest.mark.parametrize("name", ["speed", "turn_rate", "foot_offset"])
    def test_what_may_have_either_sign_may(self, name: str) -> None:
        assert getattr(Control(running=Running(**{name: -0.5})).running, name) == -0.5

    def test_in_a_spec_and_at_the_shell(
        self, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        with pytest.raises(so.SomersaultError, match=r"running\.speed_gain must not be negative"):
            parse_runs({"robot": "biped", "running": {"speed_gain": -0.1}}, tmp_path)
        assert cli.main(["run", "biped", "--flip", "at=-1"]) == 2
        assert "flip.at must not be negative" in capsys.readouterr().err


def test_lengths_that_no_leg_has_cannot_begin_in_an_ensemble() -> None:
    runs = Runs(control=Control(end=End(steps_after=1)), duration=0.3)
    drawn = {"length": so.Vary(sets="flip.leg_length", samples=[0.7, 1.2])}
    with pytest.warns(so.SomersaultWarning, match="1 of 2 runs could not begin"):
        ended = so.ensemble(runs, vary=drawn, size=2).dataset["ended"]
    assert so.ensembles.ended_by(ended, "no start").values.tolist() == [False, True]
    grid = {"length": so.Vary(sets="flip.leg_length", values=[0.7, 1.2])}
    with pytest.raises(so.SomersaultError, match=r"has 1\.2, which ends in 'no start'"):
        so.ensemble(runs, vary=grid)


class TestTimes:
    """A somersault or a push that is to come when the run is over."""

    @pytest.mark.parametrize("table", ["flip", "push"])
    @pytest.mark.parametrize("at", [4.0, 9.0, 5e5])
    def test_are_refused(self, table: str, at: float, tmp_path: Path) -> None:
        spec = {"robot": "biped", "duration": 4.0, table: {"at": at}}
        with pytest.raises(so.SomersaultError, match=f"the run is over at 4; make {table}.at less"):
            parse_runs(spec, tmp_path)

    def test_what_is_never_is_not(self) -> None:
        assert Runs(duration=4.0).control.flip.at == 1e6


def test_a_spec_of_many_runs_is_sent_to_its_command(tmp_path: Path) -> None:
    spec = {"robot": "biped", "sample": {"size": 4}}
    with pytest.raises(so.SomersaultError, match=r"\[sample\] .* somersault ensemble"):
        parse_runs(spec, tmp_path)


class TestUsual:
    def test_the_weighted_robot_runs_on_its_own(self, tmp_path: Path) -> None:
        """With the lighter one's numbers it falls after five seconds."""
        ran = run("biped_weighted", 12.0)
        assert ran.ended == "time over"
        assert 0.8 < ran.speed[ran.times > 5].mean() < 1.1
        assert run("biped_weighted", 12.0, Control()).fell
        for robot in ("biped_weighted", {"model": "biped_weighted"}):
            assert parse_runs({"robot": robot}, tmp_path).control == usual("biped_weighted")

    def test_a_maneuver_that_is_named_is_taken(self, tmp_path: Path) -> None:
        spec = {"robot": "biped_weighted", "maneuver": "somersault"}
        assert parse_runs(spec, tmp_path).control == Control()

    def test_others_have_the_defaults(self) -> None:
        assert usual("biped") == usual("runner.xml") == Control()
