"""Plans: what is asked is kept to, the flight agrees, and known optima come out."""

from __future__ import annotations

import json
from math import pi
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

import somersault as so
from somersault.cli import main
from somersault.planning._gauss import gauss_legendre
from somersault.planning._request import requested
from somersault.planning._search import Search

EXAMPLES = Path(__file__).parents[1] / "examples"
ARMS: dict[str, Any] = {
    "torque": 60.0,
    "joints": {"shoulder": (0.2, 2.8)},
    "start": {"shoulder": 2.8},
    "nodes": 20,
    "starts": 2,
    "processes": 1,
}


@pytest.fixture(scope="module")
def twisted() -> so.planning.Plan:
    """One somersault with a full twist, by the arms."""
    return so.plan("furrer", 1, 1, **ARMS)


# ------------------------------------------------------------------------ what is asked, and flown


def test_what_is_asked_is_done(twisted: so.planning.Plan) -> None:
    assert twisted.rotations["somersault"] == pytest.approx(1, abs=1e-6)
    assert twisted.rotations["twist"] == pytest.approx(1, abs=1e-6)
    assert 0.5 <= twisted.duration <= 1.5 + 1e-6
    assert abs(twisted.torques).max() <= 60.0 + 1e-3
    times = np.linspace(0, twisted.duration, 1001)
    angles, rates, _ = twisted.motion.values(times)
    assert twisted.motion.joints == ("left_shoulder", "right_shoulder")
    signs = np.array([1, -1])
    assert (angles * signs).min() >= 0.2 - 1e-6
    assert (angles * signs).max() <= 2.8 + 1e-6
    np.testing.assert_allclose(rates[0], 0, atol=1e-9)


def test_the_flight_agrees(twisted: so.planning.Plan) -> None:
    assert twisted.departure < 1e-4
    landing = twisted.fly().landing
    assert landing.somersault == pytest.approx(2 * pi, abs=1e-3)
    assert landing.twist == pytest.approx(2 * pi, abs=1e-3)
    assert landing.tilt == pytest.approx(0, abs=1e-3)


def test_torques_are_those_of_the_flight(twisted: so.planning.Plan) -> None:
    flown = twisted.fly(samples=twisted.times).joint_torques
    np.testing.assert_allclose(twisted.torques, flown, atol=0.02)


def test_mujoco_moves_the_joints_so_by_the_torques(twisted: so.planning.Plan) -> None:
    """Forward dynamics of others, with the plan's torques at some of its nodes."""
    flight = twisted.fly(samples=twisted.times)
    _, _, accelerations = twisted.motion.values(twisted.times)
    model = mujoco.MjModel.from_xml_string(so.model.mjcf(so.load("furrer")))
    model.opt.gravity[:] = 0
    data = mujoco.MjData(model)
    for k in range(0, len(twisted.times), 4):
        data.qpos[:] = [0, 0, 0, *flight.base_quaternion[k], *flight.joint_coordinates[k]]
        rates = twisted.motion.values(twisted.times[k : k + 1])[1][0]
        data.qvel[:] = [0, 0, 0, *flight.angular_velocity[k], *rates]
        data.qfrc_applied[6:] = twisted.torques[k]
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(data.qacc[6:], accelerations[k], rtol=1e-4, atol=0.05)


def test_more_nodes_agree_better() -> None:
    """With twice as many the error falls to a sixty-fourth, if the plan stays the same."""
    options = {**ARMS, "duration": 1.2, "starts": 1}
    departures = [so.plan("furrer", 1, 1, **{**options, "nodes": n}).departure for n in (10, 20)]
    assert departures[1] < departures[0] / 32


def test_collocation_has_its_order() -> None:
    """y' = cos t · y, whose solution is exp(sin t), collocated with more and more steps."""
    errors = []
    table = gauss_legendre(3)
    assert table.order == 6
    for count in (4, 8, 16):
        step, y = 2.0 / count, 1.0
        for k in range(count):
            rate = np.cos((k + table.stages) * step)
            stages = np.linalg.solve(np.eye(3) - step * table.inner * rate, np.full(3, y))
            y += step * table.weights @ (rate * stages)
        errors.append(abs(y - np.exp(np.sin(2.0))))
    assert np.log2(np.divide(errors[:-1], errors[1:])) == pytest.approx(6, abs=0.3)


@pytest.mark.slow
def test_a_seed_gives_one_plan_whatever_the_processes(twisted: so.planning.Plan) -> None:
    again = so.plan("furrer", 1, 1, **{**ARMS, "processes": 2})
    assert again.angles.tobytes() == twisted.angles.tobytes()
    assert again.attempts == twisted.attempts


def test_a_plan_is_a_maneuver_like_any_other(twisted: so.planning.Plan, tmp_path: Path) -> None:
    twisted.maneuver.save(tmp_path / "plan.toml")
    landed = so.Maneuver.read(tmp_path / "plan.toml").fly().landing
    assert landed.twist == twisted.fly().landing.twist
    soft = twisted.maneuver.compliant(60.0, pose={"shoulder": 1.5}).fly().landing
    assert soft.twist == pytest.approx(2 * pi, abs=0.01)  # by its motor tape


def test_joints_that_do_not_move_are_locked() -> None:
    options = {**ARMS, "joints": {"left_shoulder": (0.2, 2.8)}, "start": {"shoulder": 1.0}}
    plan = so.plan("furrer", 1, 0.5, **options)
    assert plan.motion.joints == ("left_shoulder",)
    np.testing.assert_allclose(plan.fly().joint_coordinates[:, 1], -1.0, atol=1e-12)


def test_gears_springs_and_balls() -> None:
    """A joint on a spring, one geared to it, and a ball that is locked: torques are what the flight
    needs at both joints of the gears, less what spring and damper do."""
    inertia = ((0.3, 0, 0), (0, 0.2, 0), (0, 0, 0.1))
    along, centre = (1.0, 0.0, 0.0), (0.0, 0.0, -0.3)
    up = so.Joint("up", "hinge", along, limits=(-3.0, 3.0), stiffness=5.0, damping=0.3)
    low = so.Joint("low", "hinge", along, follows=so.model.Follow("up", 0.5, 0.1))
    bodies = (
        so.Body("trunk", -1, 30.0, (0.0, 0.0, 0.0), ((4.0, 0, 0), (0, 4.2, 0), (0, 0, 0.5))),
        so.Body("arm", 0, 4.0, centre, inertia, position=(0.0, 0.2, 0.4), joints=(up,)),
        so.Body("hand", 1, 2.0, centre, inertia, position=(0.0, 0.0, -0.5), joints=(low,)),
        so.Body("other", 0, 4.0, centre, inertia, joints=(so.Joint("ball", "ball"),)),
    )
    plan = so.plan(
        so.Model("geared", True, bodies), 1, 0.25, torque=80.0, landing={"tilt": (-0.3, 0.3)},
        nodes=20, starts=1, processes=1,
    )  # fmt: skip
    assert plan.motion.joints == ("up",)
    assert plan.departure < 1e-4
    flight = plan.fly(samples=plan.times)
    q, needed = flight.joint_coordinates, flight.joint_torques.to_numpy()
    rates = plan.motion.values(plan.times)[1][:, 0]
    np.testing.assert_allclose(q[:, 1], 0.1 + 0.5 * q[:, 0], atol=1e-12)
    muscles = needed[:, 0] + 0.5 * needed[:, 1] + 5.0 * q[:, 0] + 0.3 * rates
    np.testing.assert_allclose(plan.torques.to_numpy()[:, 0], muscles, atol=1e-4)


# ---------------------------------------------------------------------------- optima in closed form


def rotors(inner: float, outer: float) -> so.Model:
    """Two bodies that turn against each other about the axis of somersault."""

    def moments(about: float) -> Any:
        return ((2.0, 0, 0), (0, about, 0), (0, 0, 2.5))

    hinge = so.Joint("hinge", "hinge", (0.0, 1.0, 0.0))
    still = (0.0, 0.0, 0.0)
    bodies = (
        so.Body("inner", -1, 1.0, still, moments(inner)),
        so.Body("outer", 0, 1.0, still, moments(outer), joints=(hinge,)),
    )
    return so.Model("rotors", True, bodies)


def test_the_least_effort_is_a_cubic() -> None:
    """With constant inertias, from rest to rest, ∫τ² is least along 3 s² − 2 s³."""
    inner, outer, time, turns = 3.0, 2.0, 0.8, 0.1
    plan = so.plan(
        rotors(inner, outer), turns, 0, torque=100.0, duration=time, rest_at_end=True,
        takeoff={"momentum": [0.0, 0.0, 0.0]}, nodes=10, starts=1, processes=1,
    )  # fmt: skip
    swing = -2 * pi * turns * (inner + outer) / outer
    s = np.linspace(0, 1, 101)
    angles, _, _ = plan.motion.values(s * time)
    np.testing.assert_allclose(angles[:, 0], swing * (3 * s**2 - 2 * s**3), atol=1e-4)
    reduced = inner * outer / (inner + outer)
    effort = 12 * (reduced * swing) ** 2 / time**3 / 100.0**2
    assert plan.attempts[0].objective == pytest.approx(effort, rel=1e-5)


def test_the_most_rotation_takes_all_torque() -> None:
    """With the joint's end free, the base turns furthest by one torque all the time."""
    inner, outer, time, torque = 3.0, 2.0, 0.8, 5.0
    plan = so.plan(
        rotors(inner, outer), "most", 0, torque=torque, duration=time, effort=0.0,
        takeoff={"momentum": [0.0, 0.0, 0.0]}, nodes=10, starts=1, processes=1,
    )  # fmt: skip
    turned = torque / inner * time**2 / 2
    assert plan.angles[-1, 0] == pytest.approx(turned, rel=1e-6)
    np.testing.assert_allclose(plan.torques, -torque, rtol=1e-4)


# ------------------------------------------------------------------------------------- derivatives


def test_derivatives_are_those_of_differences() -> None:
    task = requested(
        so.load("furrer"), 1, "most", 60.0, (0.5, 1.5), None, {"shoulder": 1.0}, None, False,
        {"spin": (2.0, 9.0)}, None, None, 30.0, 0.01,
    )  # fmt: skip
    program = Search(task).grid(4).program
    rng = np.random.default_rng(0)
    x = rng.normal(scale=0.4, size=program.unknowns)
    x[-1] = 1.1  # the duration
    multipliers = rng.normal(size=len(program.low))
    slopes = program.slopes(x)
    shape = (len(program.low), program.unknowns)
    jacobian, hessian = np.zeros(shape), np.zeros((program.unknowns,) * 2)
    jacobian[program.jacobian.rows, program.jacobian.columns] = program.jacobian.values(slopes)
    bends = program.hessian.values(program.curvatures(x, 0.7, multipliers))
    hessian[program.hessian.rows, program.hessian.columns] = bends
    hessian = np.triu(hessian) + np.triu(hessian, 1).T

    def gradient(at: np.ndarray) -> np.ndarray:
        own = program.slopes(at)
        cost = np.zeros(program.unknowns)
        cost[program.gradient.columns] = program.gradient.values(own)
        slope = np.zeros(shape)
        slope[program.jacobian.rows, program.jacobian.columns] = program.jacobian.values(own)
        return 0.7 * cost + multipliers @ slope

    for k in range(program.unknowns):
        step = np.zeros(program.unknowns)
        step[k] = 1e-6
        ends = [program.constraints(y, program.outputs(y)) for y in (x + step, x - step)]
        np.testing.assert_allclose((ends[0] - ends[1]) / 2e-6, jacobian[:, k], atol=2e-5)
        bend = (gradient(x + step) - gradient(x - step)) / 2e-6
        np.testing.assert_allclose(bend, hessian[k], rtol=1e-4, atol=1e-4)


# ---------------------------------------------------------------------------------------- mistakes


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"duration": (1.5, 0.5)}, "duration goes from 1.5 to 0.5, which is empty"),
        ({"duration": 0.0}, "duration must be positive"),
        ({"joints": ["elbow"]}, "elbow"),
        ({"joints": {"nope": (0.0, 1.0)}}, "has no joint 'nope'"),
        ({"joints": {"shoulder": (2.8, 0.2)}}, "joints shoulder goes from 2.8 to 0.2"),
        ({"start": {"shoulder": 3.0}}, "start left_shoulder=3 is outside its range, 0.2 to 2.8"),
        ({"end": {"shoulder": 0.1}}, "end left_shoulder=0.1 is outside its range"),
        ({"torque": -5.0}, "torque must be a positive number"),
        ({"torque": {"left_shoulder": 5.0}}, "torque of joint right_shoulder is missing"),
        ({"twists": "many"}, "twists must be a number or 'most', and is 'many'"),
        ({"somersaults": "most", "twists": "most"}, "cannot both be the most"),
        ({"takeoff": {"lean": 1.0}}, "takeoff 'lean' is nothing there is"),
        ({"takeoff": {"spin": 5.0, "momentum": [0, 1, 0]}}, "spin and momentum; give one"),
        ({"landing": {"tilt": 1.2}}, "landing tilt is 1.2 rad, outside of -1 to 1 aloft"),
        ({"aloft": {"tilt": (-2.0, 2.0)}}, "somersault and twist have no meaning"),
        ({"model": so.load("furrer", base="planar")}, "is not free in space"),
        ({"fastest": 0.0}, "fastest must be a positive rate"),
        ({"nodes": 1}, "nodes must be a whole number from 4"),
    ],
)
def test_a_mistake_is_a_sentence(given: dict[str, Any], said: str) -> None:
    asked = {"model": "furrer", "somersaults": 1, "twists": 1, **ARMS, **given}
    with pytest.raises(so.SomersaultError, match=r"^[^\n]*$") as mistake:
        so.plan(**asked)
    assert said in str(mistake.value)


def test_torques_that_do_not_suffice_are_blamed() -> None:
    with pytest.raises(so.SomersaultError, match="no plan found from the one start: ") as mistake:
        so.plan("furrer", 1, 2, **{**ARMS, "torque": 1.0, "nodes": 10, "starts": 1})
    assert "give more torque" in str(mistake.value)


def test_what_is_no_number_is_no_plan_either(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(so.SomersaultError, match="no plan found from the one start: "):
        so.plan("furrer", 1, 1, **{**ARMS, "torque": 1e-300, "nodes": 6, "starts": 1})
    assert capfd.readouterr() == ("", "")


# --------------------------------------------------------------------------- the published acrobat


@pytest.mark.slow
def test_the_acrobat_twists_more_than_five_times() -> None:
    """Bioptim's example, from many starts."""
    import runpy

    example = runpy.run_path(str(EXAMPLES / "plan_twist.py"))
    acrobat = so.load(example["ACROBAT"], axes=(1, 2, 3))
    plan = so.plan(acrobat, 1, "most", torque=100.0, nodes=100, starts=24, **example["ASKED"])
    assert plan.rotations["twist"] > 5.2
    assert plan.departure < 1e-3
    assert abs(plan.fly(samples=plan.times).joint_torques).max() < 100.1


# ------------------------------------------------------------------------------------ the command

SPEC = """
model = "furrer"
[plan]
twists = 1
torque = 60.0
nodes = 20
starts = 2
[plan.joints]
shoulder = [0.2, 2.8]
[plan.start]
shoulder = 2.8
"""


def test_the_command_plans_and_another_flies_it(
    twisted: so.planning.Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "asked.toml").write_text(SPEC)
    found, page = tmp_path / "found.toml", tmp_path / "found.html"
    words = ["plan", str(tmp_path / "asked.toml"), "--processes", "1"]
    assert main([*words, "--out", str(found), "--page", str(page), "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["turns"] == twisted.rotations
    assert record["duration"] == twisted.duration
    assert [one["solved"] for one in record["starts"]] == [a.solved for a in twisted.attempts]
    assert record["greatest_torques"].keys() == {"left_shoulder", "right_shoulder"}
    assert max(record["greatest_torques"].values()) <= 60.0 + 1e-3
    assert page.read_text(encoding="utf-8").startswith("<!doctype html")
    assert main(["fly", str(found), "--json"]) == 0
    landed = json.loads(capsys.readouterr().out)["final"]
    assert landed["twist"] == pytest.approx(2 * pi, abs=1e-3)
    assert landed["somersault"] == pytest.approx(2 * pi, abs=1e-3)


def test_what_the_command_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("asked.toml").write_text(
        'model = "furrer"\n[plan]\ntorque = 60.0\nnodes = 10\ntwists = 0\n'
    )
    assert main(["plan", "asked.toml", "--processes", "1"]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0].startswith("furrer, ")
    assert "somersault 1.0000" in said[0]
    assert "of 4 starts come to a plan" in said[2]
    assert sorted(file.name for file in tmp_path.iterdir()) == ["asked.toml"]


@pytest.mark.parametrize(
    ("spec", "said"),
    [
        ('model = "furrer"', "a plan's SPEC needs a table [plan]"),
        ('model = "furrer"\n[plan]', "plan.torque is missing"),
        ("[plan]\ntorque = 1.0", "model is missing"),
        ('model = "furrer"\n[plan]\ntorqe = 1.0', "plan.torqe is no key of a SPEC"),
        (
            'model = "furrer"\nduration = 1.0\n[plan]\ntorque = 1.0',
            "duration is no key of a plan's",
        ),
        ('model = "furrer"\n[plan]\ntorque = -1.0', "torque must be a positive number"),
        ('model = "furrer"\n[plan]\ntorque = 60.0\njoints = ["nose"]', "nose"),
    ],
)
def test_a_mistake_in_a_spec_is_a_sentence(spec: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "asked.toml").write_text(spec)
    with pytest.raises(so.SomersaultError) as raised:
        so.planning.read_plan(tmp_path / "asked.toml").run(processes=1)
    assert said in str(raised.value)


def test_the_example_in_toml_asks_what_the_example_in_python_does() -> None:
    import runpy

    example = runpy.run_path(str(EXAMPLES / "plan_twist.py"))
    spec = so.planning.read_plan(EXAMPLES / "plan_twist.toml")
    assert spec.model == so.load(example["ACROBAT"], axes=(1, 2, 3))
    assert (spec.asked.nodes, spec.asked.starts) == (example["NODES"], example["STARTS"])
    assert (spec.asked.somersaults, spec.asked.twists, spec.asked.torque) == (1, "most", 100.0)
    for key, ranges in example["ASKED"].items():
        table = getattr(spec.asked, key)
        assert table.keys() == ranges.keys()
        for name, ends in ranges.items():
            np.testing.assert_allclose(table[name], ends, rtol=1e-7)


# ------------------------------------------------------------------------------- springs for a plan


def test_a_plan_gets_springs_with_which_it_lands_from_other_starts(
    twisted: so.planning.Plan,
) -> None:
    """The chosen ones are flown again, from starts of our own, each flight by itself."""
    soft = twisted.maneuver.compliant(10.0, pose={"shoulder": 1.5})
    nominal = twisted.fly()
    springs, dampers = "joints.shoulder.stiffness", "joints.shoulder.damping"
    found = so.design(
        so.flight.flights(
            soft.model, soft.takeoff, soft.duration, report=["landing_error"], against=nominal
        ),
        choose={
            "frequency": so.Choose(
                multiplies={springs: 2, dampers: 1}, between=(0.1, 4.0), scale="log", start=1.0
            )
        },
        vary={
            angle: so.Vary(adds_to=f"takeoff.{angle}", normal=[0.0, 0.02])
            for angle in ("tilt", "twist")
        },
        objective=so.designs.Mean("landing_error"),
        size=16,
        evaluations=24,
        held_out=128,
    )
    assert found.figure < found.first_figure / 3
    chosen = twisted.maneuver.compliant(10.0 * found.best["frequency"], pose={"shoulder": 1.5})
    target = so.flight.landing_target(nominal)
    errors = []
    for maneuver in (soft, chosen):
        own = []
        for tilt, twist in np.random.default_rng(3).normal(0, 0.02, (12, 2)):
            landed = maneuver.off_nominal(tilt=tilt, twist=twist).fly().landing
            angles = {name: getattr(landed, name) for name in ("somersault", "tilt", "twist")}
            own.append(so.flight.landing_error(target, {**angles, **landed.joints}))
        errors.append(np.mean(own))
    assert errors[1] < errors[0] / 3
