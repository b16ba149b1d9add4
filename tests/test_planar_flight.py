"""Planar models fly in their plane: against equations by hand, MuJoCo, and flights in space."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy
from planes import AXES, InMujoco, random_chain, random_planar_tree, random_takeoff
from scipy.integrate import solve_ivp

import somersault as so
from somersault import cli
from somersault.flight import flights
from somersault.model import Body, Joint, Model, as_matrix

SECONDS = 1.0
G = 9.81
ABOUT = as_matrix(np.diag([1.0, 0.0, 0.0]))  # known about the normal alone


# ------------------------------------------------------------------------- equations by hand

MASSES, INERTIAS = (7.0, 3.0, 2.0), (0.9, 0.2, 0.05)
PIVOTS = (0.35, 0.5)  # m, from the first centre of mass, and from the first pivot, to the next
CENTRES = (0.0, 0.3, 0.2)  # from a link's pivot to its centre of mass


def pendulum(about: Any = ABOUT) -> Model:
    """Three bodies in the y-z plane, turning about x, each hung on the one before."""
    bodies = []
    for k, (mass, inertia) in enumerate(zip(MASSES, INERTIAS, strict=True)):
        rows = as_matrix(inertia * np.array(about))
        if k == 0:
            bodies.append(Body("one", -1, mass, (0.0, 0.0, 0.0), rows))
            continue
        bodies.append(
            Body(
                ("one", "two", "three")[k], k - 1, mass, (0.0, 0.0, -CENTRES[k]), rows,
                position=(0.0, 0.0, -PIVOTS[k - 1]),
                joints=(Joint(f"joint{k}", "hinge", (1.0, 0.0, 0.0)),),
            )
        )  # fmt: skip
    return Model("pendulum", True, tuple(bodies), axes=(1, 2, 3), plane=1)


def by_hand() -> Any:
    """Accelerations of (y, z, θ1, θ2, θ3) by Lagrange's equations, of absolute angles about x."""
    t = sympy.Symbol("t")
    q = [sympy.Function(f"q{k}")(t) for k in range(5)]
    (y, z), angles = q[:2], q[2:]

    def down(angle: Any, length: float) -> sympy.Matrix:
        return sympy.Matrix([length * sympy.sin(angle), -length * sympy.cos(angle)])

    first = sympy.Matrix([y, z])
    hip = first + down(angles[0], PIVOTS[0])
    knee = hip + down(angles[1], PIVOTS[1])
    centres = [first, hip + down(angles[1], CENTRES[1]), knee + down(angles[2], CENTRES[2])]
    kinetic = sum(
        m * c.diff(t).dot(c.diff(t)) / 2 + i * a.diff(t) ** 2 / 2
        for m, i, c, a in zip(MASSES, INERTIAS, centres, angles, strict=True)
    )
    lagrangian = kinetic - sum(m * G * c[1] for m, c in zip(MASSES, centres, strict=True))
    plain, rates, again = (sympy.symbols(f"{name}0:5") for name in ("x", "v", "a"))
    equations = [lagrangian.diff(x.diff(t)).diff(t) - lagrangian.diff(x) for x in q]
    for k, x in enumerate(q):
        equations = [e.subs(x.diff(t, 2), again[k]) for e in equations]
    for k, x in enumerate(q):
        equations = [e.subs(x.diff(t), rates[k]) for e in equations]
    for k, x in enumerate(q):
        equations = [e.subs(x, plain[k]) for e in equations]
    mass = sympy.Matrix(equations).jacobian(again)
    bias = sympy.Matrix(equations).subs(dict.fromkeys(again, 0))
    return sympy.lambdify((plain, rates), (mass, bias), cse=True)


def test_a_triple_pendulum_in_the_air_moves_by_lagranges_equations() -> None:
    model = pendulum()
    joints = {
        "joint1": so.JointTakeoff.free(angle=0.7, rate=-2.0),
        "joint2": so.JointTakeoff.free(angle=-0.4, rate=3.0),
    }
    takeoff = so.Takeoff(somersault=0.3, spin=2.5, velocity=(0.0, 1.0, 3.0), joints=joints)
    flight = so.fly(model, takeoff, SECONDS, gravity=(0.0, 0.0, -G), accuracy=1e-12)
    lagrange = by_hand()
    angles, rates = np.array([0.3, 1.0, 0.6]), np.array([2.5, 0.5, 3.5])

    def slope(_: float, x: np.ndarray) -> np.ndarray:
        mass, bias = lagrange(x[:5], x[5:])
        return np.concatenate([x[5:], -np.linalg.solve(mass, bias).ravel()])

    # The base moves so that the whole's centre of mass has the velocity of the takeoff.
    ways = np.stack([np.cos(angles), np.sin(angles)], 1)  # in which the end of each link moves
    of_two = PIVOTS[0] * rates[0] * ways[0] + CENTRES[1] * rates[1] * ways[1]
    of_three = PIVOTS[0] * rates[0] * ways[0] + PIVOTS[1] * rates[1] * ways[1]
    of_three = of_three + CENTRES[2] * rates[2] * ways[2]
    moved = (MASSES[1] * of_two + MASSES[2] * of_three) / sum(MASSES)
    begin = flight.base_position[0, 1:]
    x0 = np.concatenate([begin, angles, np.array([1.0, 3.0]) - moved, rates])
    end = solve_ivp(slope, (0, SECONDS), x0, "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    landing = flight.landing
    found = [landing.somersault, landing.joints["joint1"], landing.joints["joint2"]]
    wanted = [end[2], end[3] - end[2], end[4] - end[3]]
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-10)
    np.testing.assert_allclose(flight.base_position[-1], [0.0, *end[:2]], rtol=0, atol=1e-10)
    assert flight.angular_velocity[-1, 0] == pytest.approx(end[7], abs=1e-9)
    assert (landing.tilt, landing.twist) == (0.0, 0.0)


# ------------------------------------------------------------------------------------ MuJoCo


def as_modelled(model: Model, begun: dict[str, np.ndarray]) -> dict[str, so.JointTakeoff]:
    """Every joint sprung as its model has it, or free, from a random start."""
    joints = {}
    for joint in model.joints:
        at, speed = model.coordinate_slice(joint.name), model.speed_slice(joint.name)
        kind = so.JointTakeoff.sprung if joint.stiffness else so.JointTakeoff.free
        q, u = begun["q"][at], begun["u"][speed]
        if joint.kind == "ball":
            vector = 2 * np.arccos(q[0]) * q[1:] / np.linalg.norm(q[1:])
            joints[joint.name] = kind(angle=tuple(vector), rate=tuple(u))
        else:
            joints[joint.name] = kind(angle=float(q[0]), rate=float(u[0]))
    return joints


@pytest.mark.parametrize("plane", [1, 2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_flights_are_those_of_mujoco_on_two_slides_and_a_hinge(seed: int, plane: int) -> None:
    """Joints in the plane and, in half of the cases, any joints of a base that is held in it."""
    rng = np.random.default_rng([seed, plane, 7])
    model = (random_chain if seed % 2 else random_planar_tree)(rng, plane)
    joints = as_modelled(model, random_takeoff(rng, model))
    takeoff = so.Takeoff(somersault=0.4, spin=float(rng.normal()), joints=joints)
    flight = so.fly(model, takeoff, SECONDS, accuracy=1e-11)
    if flight.conservative:
        assert flight.energy_drift is not None
        assert flight.energy_drift < 1e-9
    assert flight.momentum_drift < 1e-10
    step, own_error, before = 1e-3, np.inf, np.zeros(0)
    while own_error > 1e-9:
        theirs = InMujoco(model, step)
        theirs.begin(flight)
        end, step = theirs.end(SECONDS), step / 2
        own_error = np.abs(end - before).max() / 15 if before.size else np.inf  # of order four
        before = end
        assert step > 1e-5
    q, u = (rows[-1] for rows in flight._joints)
    landing = flight.landing
    ours = np.concatenate([[landing.somersault], q, landing.angular_velocity[plane - 1 : plane], u])
    scale = np.where(np.arange(len(ours)) > len(q), 20.0, 1.0)  # rates are as much larger
    assert np.all(np.abs(ours - end) < 1e-8 * scale * np.maximum(1.0, np.abs(end)))
    across = [k for k in range(3) if k != plane - 1]
    assert np.all(flight.angular_velocity[:, across] == 0.0)
    assert np.ptp(flight.base_position[:, plane - 1]) < 1e-15


# ---------------------------------------------------------------------- the same in space

PATH = {"times": [0.1, 0.4], "angles": [0.1, 1.2]}
JOINTS: dict[str, dict[str, so.JointTakeoff]] = {
    "free": {"hip_flexion": so.JointTakeoff.free(angle=0.5, rate=1.0)},
    "sprung": {
        "hip_flexion": so.JointTakeoff.sprung(angle=0.5, K=1.5, B=0.2, hold=True),
        "shoulder_flexion": so.JointTakeoff.sprung(angle=0.2, stiffness=9.0, rest=0.4),
    },
    "prescribed": {"hip_flexion": so.JointTakeoff.prescribed(**PATH)},
    "prescribed beside free": {
        "hip_flexion": so.JointTakeoff.prescribed(**PATH),
        "shoulder_flexion": so.JointTakeoff.free(angle=0.3),
    },
    "torque": {
        "hip_flexion": so.JointTakeoff.torque(times=[0.0, 0.5, 1.0], torques=[0.0, 30.0, -30.0]),
    },
    "coupled": {
        "left_hip_flexion": so.JointTakeoff.sprung(angle=0.6, stiffness=40.0, rest=0.0),
        "right_hip_flexion": so.JointTakeoff.coupled(leader="left_hip_flexion"),
    },
}


def assert_same(space: so.Flight, planar: so.Flight) -> None:
    assert (planar.ended, planar.model.plane) == ("duration", 2)
    np.testing.assert_allclose(planar.states, space.states, rtol=0, atol=1e-11)
    np.testing.assert_allclose(planar.angles[:, 0], space.angles[:, 0], rtol=0, atol=1e-11)
    assert np.all(planar.angles[:, 1:] == 0.0)
    for name in ("centre_of_mass", "base_position"):
        np.testing.assert_allclose(
            getattr(planar, name), getattr(space, name), rtol=0, atol=1e-12, err_msg=name
        )
    for name in ("angular_momentum", "kinetic_energy", "spring_energy", "joint_torques"):
        one, other = (np.asarray(getattr(flight, name)) for flight in (planar, space))
        size = max(1.0, np.abs(other).max())
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-9 * size, err_msg=name)
    assert planar.momentum_drift < 1e-12


@pytest.mark.parametrize("joints", JOINTS.values(), ids=JOINTS)
def test_in_its_plane_of_symmetry_a_body_flies_as_in_space(
    joints: dict[str, so.JointTakeoff],
) -> None:
    takeoff = so.Takeoff(somersault=0.2, spin=4.0, velocity=(0.5, 0.0, 3.0), joints=joints)
    space, planar = (
        so.fly(so.load("gymnast", base=base), takeoff, 1.0, gravity=(0.0, 0.0, -G), accuracy=1e-10)
        for base in ("free", "planar")
    )  # fmt: skip
    assert_same(space, planar)


@pytest.mark.parametrize("tape", [True, False])
def test_compliant_bodies_fly_in_the_plane_as_in_space(tape: bool) -> None:
    takeoff = so.Takeoff(spin=4.0, joints=JOINTS["prescribed"])
    found = []
    for base in ("free", "planar"):
        model = so.load("gymnast", base=base)
        soft = so.compliant(model, takeoff, 25.0, pose=0.3, tape=tape)
        found.append(so.fly(model, replace(soft, somersault=0.1), 0.8, accuracy=1e-10))
    assert_same(*found)


def test_a_takeoff_by_momentum_is_one_by_spin() -> None:
    model = so.load("gymnast", base="planar")
    joints = JOINTS["free"]
    spun = so.Takeoff(somersault=0.7, spin=4.0, joints=joints)
    kept = so.with_momentum(model, spun)
    assert kept.angular_momentum is not None
    assert [bool(h) for h in kept.angular_momentum] == [False, True, False]
    turned = so.Takeoff(somersault=0.7, angular_velocity=(0.0, 4.0, 0.0), joints=joints)
    attitude = so.Takeoff(
        quaternion=(np.cos(0.35), 0.0, np.sin(0.35), 1e-17), spin=4.0, joints=joints
    )
    one, *others = (so.fly(model, t, 1.0).states[-1] for t in (spun, kept, turned, attitude))
    for other in others:
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-9)


def test_turns_are_counted() -> None:
    model = pendulum()
    flight = so.fly(model, so.Takeoff(spin=-9.0), 7.0)
    assert flight.landing.somersault == pytest.approx(-63.0, abs=1e-8)
    assert flight.momentum_drift < 1e-12


def test_what_moves_across_the_plane_leaves_the_base_in_it() -> None:
    """The centre of mass falls in the plane, and goes across it with an arm that does."""
    model = so.load("gymnast", base="planar")
    raised = so.JointTakeoff.prescribed(times=[0.1, 0.6], angles=[0.0, 1.5])
    takeoff = so.Takeoff(spin=3.0, velocity=(1, 0, 2), joints={"left_shoulder_abduction": raised})
    flight = so.fly(model, takeoff, 1.0, gravity=(0, 0, -G))
    assert np.ptp(flight.base_position[:, 1]) < 1e-15
    assert np.ptp(flight.centre_of_mass[:, 1]) > 1e-3
    fallen = flight.ballistic_path.at(flight.times)
    np.testing.assert_array_equal(flight.centre_of_mass[:, [0, 2]], fallen[:, [0, 2]])
    assert flight.momentum_drift < 1e-12
    assert np.abs(flight.external_moment[:, 1]).max() < 1e-10
    assert np.abs(flight.external_moment[:, [0, 2]]).max() > 0.1  # of what holds it in the plane


# ---------------------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"tilt": 0.1}, "takeoff tilt is 0.1"),
        ({"twist": 0.1}, "takeoff twist is 0.1"),
        ({"spin": 1.0, "tilt_rate": 0.1}, "takeoff tilt_rate is 0.1"),
        ({"spin": 1.0, "twist_rate": 0.1}, "takeoff twist_rate is 0.1"),
        ({"quaternion": (1.0, 0.0, 0.1, 0.0)}, "takeoff quaternion is 0.1 in its y"),
        ({"angular_velocity": (1.0, 0.0, 0.1)}, "takeoff angular_velocity is 0.1 along axis 3"),
        ({"angular_momentum": (1.0, 0.1, 0.0)}, "takeoff angular_momentum is 0.1 along axis 2"),
        ({"velocity": (0.1, 0.0, 1.0)}, "takeoff velocity is 0.1 along axis 1"),
    ],
)
def test_takeoffs_out_of_the_plane_are_refused_by_name(given: dict[str, Any], named: str) -> None:
    takeoff = so.Takeoff(**given)
    for call in (lambda: so.fly(pendulum(), takeoff), lambda: flights(pendulum(), takeoff)):
        with pytest.raises(so.SomersaultError, match=named) as mistake:
            call()
        assert "moves only in the plane across its axis 1" in str(mistake.value)


def test_gravity_and_events_out_of_the_plane_are_refused() -> None:
    with pytest.raises(so.SomersaultError, match="gravity is 1 along axis 1"):
        so.fly(pendulum(), gravity=(1.0, 0.0, -9.81))
    with pytest.raises(so.SomersaultError, match="'quarter twist' never comes"):
        so.fly(pendulum(), until="quarter twist")
    with pytest.raises(so.SomersaultError, match="takeoff twist is"):
        so.Maneuver(pendulum(), so.Takeoff(spin=1.0)).off_nominal(twist=0.1).fly()


def test_the_plane_may_stand_anywhere() -> None:
    flight = so.fly(pendulum(), so.Takeoff(position=(2.0, 0.0, 1.0), spin=3.0))
    assert np.all(flight.base_position[:, 0] == 2.0)


# ---------------------------------------------------------------------- many, files, the shell


def test_an_ensemble_is_of_flights_in_the_plane(tmp_path: Path) -> None:
    model, joints = pendulum(), {"joint1": so.JointTakeoff.free(angle=0.5)}
    takeoff = so.Takeoff(spin=4.0, joints=joints)
    spins = [3.0, 4.0, 5.5]
    vary = {"spin": so.Vary(sets="takeoff.spin", values=spins)}
    report = so.Report(("somersault", "tilt", "twist", "joint1"), extremes=("tilt",))
    found = so.ensemble(model, takeoff, 1.0, vary, report=report, out=tmp_path / "e.zarr")
    data = found.dataset
    for k, spin in enumerate(spins):
        end = so.fly(model, replace(takeoff, spin=spin), 1.0, accuracy=1e-7).landing
        assert float(data.somersault[k]) == pytest.approx(end.somersault, abs=1e-9)
        assert float(data.joint1[k]) == pytest.approx(end.joints["joint1"], abs=1e-7)
    for name in ("tilt", "twist", "least_tilt", "greatest_tilt"):
        assert np.all(data[name] == 0.0)


@pytest.mark.parametrize("name", ["takeoff.tilt", "takeoff.twist_rate"])
def test_an_ensemble_varies_nothing_out_of_the_plane(name: str, tmp_path: Path) -> None:
    vary = {"off": so.Vary(adds_to=name, values=[0.0, 0.1])}
    with pytest.raises(so.SomersaultError, match=f"{name} would turn pendulum out of the plane"):
        so.ensemble(pendulum(), so.Takeoff(spin=1.0), 1.0, vary, out=tmp_path / "e.zarr")
    vary = {"off": so.Vary(sets="takeoff.angular_momentum.2", values=[0.0, 0.1])}
    takeoff = so.Takeoff(angular_momentum=(1.0, 0.0, 0.0))
    with pytest.raises(so.SomersaultError, match=r"angular_momentum\.2 would turn pendulum out"):
        so.ensemble(pendulum(), takeoff, 1.0, vary, out=tmp_path / "e.zarr")


def test_a_maneuver_in_a_plane_is_a_file(tmp_path: Path) -> None:
    for model in (so.load("gymnast", base="planar"), random_chain(np.random.default_rng(3), 1)):
        maneuver = so.Maneuver(model, so.Takeoff(somersault=0.1, spin=3.0), 0.5)
        maneuver.save(tmp_path / "plane.toml")
        again = so.Maneuver.read(tmp_path / "plane.toml")
        assert (again.model.plane, again.model.axes) == (model.plane, AXES[model.plane or 0])
        one, other = (m.fly().landing.quaternion for m in (maneuver, again))
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-12)


def test_a_spec_may_say_on_which_base(tmp_path: Path) -> None:
    tables = {"model": "gymnast", "base": "planar", "takeoff": {"spin": 3.0}}
    planar = so.Maneuver.parse(tables)
    assert planar.model.plane == 2
    planar.save(tmp_path / "planar.toml")
    assert 'base = "planar"' in (tmp_path / "planar.toml").read_text()
    assert so.Maneuver.read(tmp_path / "planar.toml").model == planar.model
    with pytest.raises(so.SomersaultError, match="base is 'flat'; give 'free' or 'planar'"):
        so.Maneuver.parse({**tables, "base": "flat"})
    (tmp_path / "biped.bioMod").write_text(
        BIPED.replace("a 2 0 0 0 0 0 0 0 0", "a 2 0 0 0 2 0 0 0 2")
    )
    with pytest.warns(so.SomersaultWarning, match="as these have: Leg"):
        space = so.Maneuver.parse({"model": "biped.bioMod", "base": "free"}, tmp_path)
    assert (space.model.free, space.model.plane) == (True, None)


BIPED = """version 4
segment Pelvis
translations yz
rotations x
mass 40
com 0 0 0.2
inertia 2 0 0 0 0 0 0 0 0
endsegment
segment Leg
parent Pelvis
rotations x
mass 20
com 0 0 -0.4
inertia 1.2 0 0 0 0 0 0 0 0
endsegment
"""
SPEC = """model = "biped.bioMod"
duration = 1.0
gravity = [0.0, 0.0, -9.81]
[takeoff]
spin = 6.0
velocity = [0.0, 1.0, 4.0]
[joints.Leg_RotX]
motion = "free"
angle = 0.6
"""


def test_the_shell_flies_a_planar_biomod(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "biped.bioMod").write_text(BIPED)
    (tmp_path / "flight.toml").write_text(SPEC)
    assert cli.main(["fly", str(tmp_path / "flight.toml"), "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert (record["final"]["tilt"], record["final"]["twist"]) == (0.0, 0.0)
    assert record["final"]["somersault"] > 3.0
    assert record["momentum_drift"] < 1e-12
    assert record["energy_drift"] < 1e-9


def test_a_swing_on_the_bar_ends_in_a_flight_in_the_plane() -> None:
    none = (0.0, 0.0, 0.0)
    bar = Joint("bar", "hinge", (1.0, 0.0, 0.0))
    clamp = Body("hands", -1, 0.0, none, (none, none, none), joints=(bar,))
    mount = so.mounted(pendulum(np.eye(3)), clamp, position=(0.0, 0.0, -0.5))
    swung = so.swing(mount.held, {"bar": 1.4, "joint1": 0.3}, 1.0)
    let_go = so.released(swung, mount)
    flight = so.fly(mount.rider, let_go.takeoff, 0.6, gravity=(0.0, 0.0, -G))
    assert flight.momentum_drift < 1e-12
    last = swung.dataset.isel(time=-1)
    assert flight.angular_velocity[0, 0] == pytest.approx(float(last.rate[0]), rel=1e-12)
    whole = flight.kinetic_energy[0] + 0.5 * mount.rider.mass * np.sum(flight.velocity**2)
    assert whole == pytest.approx(float(last.kinetic_energy), rel=1e-12)


def test_planar_flights_are_seen() -> None:
    from somersault.view import contact_sheet

    flight = so.fly("gymnast", so.Takeoff(spin=4.0), 0.5)
    flat = so.fly(so.load("gymnast", base="planar"), so.Takeoff(spin=4.0), 0.5)
    for one in (flight, flat):
        assert contact_sheet(one, [0.0, 0.25, 0.5]).axes
    assert flat.plot().axes
