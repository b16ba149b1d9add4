"""Another robot than the 3D Biped, and the numbers for one of another size."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest
from test_shipped_models import SHIPPED

import somersault as so
from somersault.robot import Control, Push, Robot, Runs, run, similar, unit
from somersault.robot._units import _POWERS

EXAMPLES = Path(__file__).parents[1] / "examples"


@pytest.fixture
def robots():  # type: ignore[no-untyped-def]
    spec = importlib.util.spec_from_file_location("examples_robots", EXAMPLES / "robots.py")
    assert spec is not None
    assert spec.loader is not None
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    return example


def test_another_robot_runs_and_somersaults(robots) -> None:  # type: ignore[no-untyped-def]
    """Of twice the mass, with longer legs, another shape and other names."""
    robot = robots.runner()
    assert robot.machine.mass == pytest.approx(60)
    ran = run(robot, 12.0, robots.runner_control(), flip=3.0)
    assert ran.ended == "time over"
    assert ran.outcome["steps_after"] >= 10
    assert np.degrees(ran.outcome["landing_somersault"]) == pytest.approx(350, abs=6)
    assert ran.model.name == "runner"


def test_a_similar_robot_does_exactly_the_same(tmp_path: Path) -> None:
    """Grown eightfold in mass and twice in length, all its numbers by their units, it moves alike,
    √2 times as slowly; nearly, as the controller's period does not grow along."""
    mass, length = 8.0, 2.0
    text = (SHIPPED / "biped.xml").read_text(encoding="utf-8")

    def grown(match: re.Match[str], factor: float) -> str:
        numbers = " ".join(repr(float(x) * factor) for x in match[2].split())
        return f'{match[1]}="{numbers}"'

    def scale(name: str, factor: float, inside: str = "") -> None:
        nonlocal text
        text = re.sub(
            rf'(?<=\s)({name})="([-\d. e]+)"(?=[^>]*{inside})', lambda m: grown(m, factor), text
        )

    text = text.split("-->")[1]
    for name in ("pos", "fromto"):
        scale(name, length)
    text = re.sub(r'size="([\d. ]+)"', lambda m: 'size="' + " ".join(
        repr(float(x) * length) for x in m[1].split()) + '"', text)  # fmt: skip
    text = text.replace('size="0.0 0.0 2.0"', 'size="0 0 1"')
    text = re.sub(r'mass="([\d.]+)"', lambda m: f'mass="{float(m[1]) * mass!r}"', text)
    scale("diaginertia", mass * length**2)
    scale("armature", mass * length**2)
    scale("ctrlrange", mass * length)
    scale("forcerange", mass)
    text = text.replace('kp="15000"', f'kp="{15000 * mass / length!r}"')
    text = text.replace('kp="60000"', f'kp="{60000 * mass / length!r}"')
    text = text.replace('kv="60"', f'kv="{60 * mass / length**0.5!r}"')
    text = text.replace('kv="300"', f'kv="{300 * mass / length**0.5!r}"')
    text = text.replace('range="-0.15 0.225"', f'range="{-0.15 * length} {0.225 * length}"')
    text = text.replace('friction="1 0.03 0.0001"', f'friction="1 {0.03 * length} 0.0002"')
    for name in ("solref", "solreflimit"):
        text = text.replace(f'{name}="0.004 1"', f'{name}="{0.004 * length**0.5!r} 1"')
    file = tmp_path / "giant.xml"
    file.write_text(text, encoding="utf-8")
    giant = Robot(str(file), shortest=0.647 * length, longest=0.862 * length)
    assert giant.machine.mass == pytest.approx(31.44 * mass)
    slow = length**0.5
    small = run("biped", 3.0, flip=1.0)
    large = run(giant, 3.0 * slow, similar(Control(), mass, length), flip=1.0 * slow)
    for state in ("hurdle", "tuck", "servo"):
        assert large.began(state) / slow == pytest.approx(small.began(state), abs=0.02)
    for name in ("landing_somersault", "landing_inclination"):
        assert large.outcome[name] == pytest.approx(small.outcome[name], abs=0.05)
    assert large.outcome["lift_off_speed"] / slow == pytest.approx(
        small.outcome["lift_off_speed"], rel=0.02
    )


def test_a_robot_that_falls_before_its_somersault_is_told(robots, capsys) -> None:  # type: ignore[no-untyped-def]
    fallen = run("biped", 2.0, Control(push=Push(at=0.1, sideways=5000.0)), flip=1.0)
    robots.told("biped", fallen)
    said = capsys.readouterr().out
    assert said.startswith("biped: fell before after ")
    assert said.endswith(" s, without a landing\n")


class TestUnits:
    def test_every_number_has_one(self) -> None:
        """And only those without a unit are called pure numbers."""
        units = {name: unit(*name) for name in Control().numbers()}
        assert set(units.values()) <= set(_POWERS)
        pure = {name for name, of in units.items() if of == "1"}
        tables = {"running", "flip", "twist", "end"}
        assert {table for table, _ in pure} == {"plant", "errors", *tables}
        assert {name for table, name in pure if table in tables} == {
            "thrust_factor", "friction", "servo", "steps_after", "pace", "straddle_gain",
        }  # fmt: skip

    def test_of_some(self) -> None:
        for name, expected in {
            "flip.torque": "N m", "errors.torque": "1", "push.sideways": "N", "hips.x_damping":
            "N m s/rad", "start.sideways": "m/s", "plant.torque": "1", "running.speed_gain": "s",
            "flip.landing_stiffness": "N m/rad", "push.at": "s", "errors.yaw": "rad/s",
        }.items():  # fmt: skip
            assert unit(*name.split(".")) == expected
            assert Runs().targets(name)[0].unit == expected

    def test_growing_and_shrinking_again_changes_nothing(self) -> None:
        there = similar(Control(), 3.0, 1.7)
        back = similar(there, 1 / 3.0, 1 / 1.7)
        for name, value in Control().numbers().items():
            assert back.numbers()[name] == pytest.approx(value, rel=1e-12)
        never = ("running", "speed_change"), ("flip", "at"), ("push", "at"), ("end", "steps_after")
        assert all(there.numbers()[name] == 1e6 for name in never)
        assert there.running.speed == pytest.approx(1.7**0.5)
        with pytest.raises(so.SomersaultError, match="must be positive"):
            similar(Control(), -1.0, 1.0)
