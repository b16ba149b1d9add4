"""What every flight must do, whatever it computes with: conservation, symmetry, closed forms."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from trees import unit

import somersault as so
from somersault.attitude import (
    matrix_from_quaternion,
    quaternion_from_angles,
    quaternion_from_matrix,
    quaternion_product,
)
from somersault.flight import Flight, JointTakeoff, Takeoff, fly
from somersault.model import GROUND, Body, Model

SPIN = 8.64  # rad/s
TURN = 2 * np.pi / SPIN
SHOULDERS = {"left_shoulder": 1.0, "right_shoulder": -1.0}
OUTBOARD = so.spin("furrer").outboard_inertias["left_shoulder"]


def arms(stiffness: float, angle: float, **other: Any) -> dict[str, JointTakeoff]:
    """Both arms at a symmetric angle, on springs of a non-dimensional stiffness at SPIN."""
    numbers = {"motion": "sprung", "stiffness": stiffness * SPIN**2 * OUTBOARD, "hold": True}
    return {n: JointTakeoff(angle=s * angle, **(numbers | other)) for n, s in SHOULDERS.items()}


def layout(stiffness: float, angle: float, turns: float, tilt: float = 0.01, **how: Any) -> Flight:
    """From a tilt, with the angular momentum of the steady spin."""
    whole = float(so.spin("furrer", 2, {"shoulder": angle}).principal_inertias[1]) * SPIN
    begun = Takeoff(tilt=tilt, angular_momentum=(0.0, whole, 0.0), joints=arms(stiffness, angle))
    return fly("furrer", begun, turns * TURN, **how)


STABLE, UNSTABLE = (1.2, 1.4), (0.5, 1.3)


# -------------------------------------------------------------------------- conservation


def tumbling(**numbers: Any) -> Flight:
    joints = {
        "left_shoulder": JointTakeoff("sprung", 1.0, rate=0.5, stiffness=20.0, rest=0.7, **numbers),
        "right_shoulder": JointTakeoff("sprung", -1.5, stiffness=12.0, rest=-1.0, **numbers),
    }
    begun = Takeoff(0.2, 0.5, -0.3, angular_velocity=[1.0, 5.0, 2.0], joints=joints)
    return fly("furrer", begun, 3.0)


FLIGHTS = {
    "stable": lambda: layout(*STABLE, 8),
    "unstable": lambda: layout(*UNSTABLE, 8),
    "tumbling": tumbling,
    "damped": lambda: tumbling(damping=1.0),
    "locked": lambda: fly("human_pike", Takeoff(0.1, 0.4, 0.3, spin=6.0), 3.0),
    "free": lambda: fly(
        "doll", Takeoff(tilt=0.2, spin=16.6, joints={n: JointTakeoff("free") for n in SHOULDERS})
    ),
    "prescribed": lambda: fly(
        "furrer",
        Takeoff(
            tilt=0.2,
            spin=6.0,
            joints={"left_shoulder": JointTakeoff("prescribed", times=[0.2, 0.7], angles=[0, 3])},
        ),
        2.0,
    ),
}


@pytest.mark.parametrize("name", FLIGHTS)
def test_angular_momentum_and_energy(name: str) -> None:
    flight = FLIGHTS[name]()
    h = flight.dataset["angular_momentum"].values
    assert np.abs(h - flight.start.momentum).max() < 1e-11 * np.linalg.norm(flight.start.momentum)
    assert flight.momentum_drift < 1e-11
    if name in ("damped", "prescribed"):
        assert flight.energy_drift is None
    else:
        assert flight.energy_drift < 1e-11
    data = flight.dataset
    assert all(np.all(np.isfinite(v)) for v in data.values() if v.dtype.kind == "f")
    norms = np.linalg.norm(data["quaternion"], axis=1)
    np.testing.assert_allclose(norms, 1.0, rtol=0, atol=1e-14)


def test_energy_of_springs() -> None:
    """½ k (q - rest)²; the kinetic energy is the dynamics' own, and tested there."""
    flight = tumbling()
    data = flight.dataset
    q = data["joint_angle"].values
    stretch = q - [0.7, -1.0]
    np.testing.assert_allclose(data["spring_energy"], (stretch**2) @ [10.0, 6.0], rtol=1e-13)


def test_dampers_take_energy_away() -> None:
    flight = tumbling(damping=1.0)
    energy = flight.kinetic_energy + flight.spring_energy
    assert np.all(np.diff(energy) <= 1e-12 * energy[0])
    power = (flight.dataset["joint_rate"].values ** 2).sum(1)  # both dampers are 1 N m s/rad
    lost = np.trapezoid(power, flight.times)
    assert energy[0] - energy[-1] == pytest.approx(lost, rel=1e-3)


# --------------------------------------------------------------------------- steady spins


@pytest.mark.parametrize("number", range(6))
def test_held_spins_are_steady(number: int) -> None:
    """Any pose, its principal axis along the momentum, its springs pretensioned."""
    rng = np.random.default_rng([5, number])
    pose = {"left_shoulder": rng.uniform(-0.4, 3.2), "right_shoulder": -rng.uniform(-0.4, 3.2)}
    steady = so.spin("furrer", 2, pose)
    joints = {n: JointTakeoff("sprung", a, stiffness=30.0, hold=True) for n, a in pose.items()}
    attitude = quaternion_from_matrix(steady.principal_axes.T)
    flight = fly("furrer", Takeoff(quaternion=attitude, spin=SPIN, joints=joints), TURN)
    data = flight.dataset
    wanted = SPIN * steady.principal_axes[:, 1]
    # The axes are good to 1e-10, and an unstable pose multiplies that by up to 1e3 in a turn.
    np.testing.assert_allclose(data["angular_velocity"] - wanted, 0, atol=1e-6)
    np.testing.assert_allclose(data["joint_angle"] - list(pose.values()), 0, atol=1e-7)
    np.testing.assert_allclose(data["joint_rate"], 0, atol=1e-6)


@cache
def flow(stiffness: float, angle: float, time: float) -> np.ndarray:
    """∂(deviation at `time`)/∂(deviation at takeoff) of a steady spin, by central differences.

    Over tilt, twist, ω, arm angles and arm rates; the somersault angle changes nothing.
    """
    held = layout(stiffness, angle, 0.1, tilt=0.0).start
    rests = {  # a pretension is a shift of the rest angle
        p.joint.name: p.does.rest + p.does.pretension / p.does.stiffness for p in held.plans
    }
    nominal = np.array([0, 0, 0, SPIN, 0, angle, -angle, 0, 0])

    def after(state: np.ndarray) -> np.ndarray:
        joints = {
            name: replace(j, angle=state[5 + k], rate=state[7 + k], rest=rests[name], hold=False)
            for k, (name, j) in enumerate(arms(stiffness, angle).items())
        }
        begun = Takeoff(tilt=state[0], twist=state[1], angular_velocity=state[2:5], joints=joints)
        data = fly("furrer", begun, time, accuracy=1e-13, samples=2).dataset.isel(time=-1)
        return np.array(
            [data["tilt"], data["twist"], *data["angular_velocity"], *data["joint_angle"],
             *data["joint_rate"]], float,
        )  # fmt: skip

    step = 1e-5
    columns = [(after(nominal + step * e) - after(nominal - step * e)) for e in np.eye(9)]
    return np.column_stack(columns) / (2 * step)


@pytest.mark.parametrize("case", [STABLE, UNSTABLE, (1.8, 1.3)])
def test_small_deviations_have_the_roots_of_the_linear_equations(case: tuple) -> None:
    """Each root in units of Ω: frequencies and growth rates at once, of all modes."""
    stiffness, angle = case
    time = 0.2  # less than half the period of the fastest mode
    found = np.log(np.linalg.eigvals(flow(stiffness, angle, time)).astype(complex)) / time / SPIN
    spin = so.spin("furrer", 2, {"shoulder": angle})
    linear = spin.linear({"left_shoulder": stiffness, "right_shoulder": stiffness})
    # A drift of the somersault angle with its rate is a double root zero; one is left here.
    roots = sorted(linear.roots, key=abs)[1:]
    assert len(roots) == 9
    for root in roots:
        close = 1e-3 if abs(root) > 1e-3 else 1e-2
        assert np.abs(found - root).min() < close
    growing = linear.growth_rate
    assert found.real.max() == pytest.approx(max(growing, 0.0), abs=1e-3)
    assert (growing > 0.05) == (case != STABLE)


def test_deviation_grows_until_it_is_large() -> None:
    """A tilt of 1e-8, to 1e-3, by the same factor in every half wave of the growing mode."""
    stiffness, angle = UNSTABLE
    spin = so.spin("furrer", 2, {"shoulder": angle})
    linear = spin.linear({"left_shoulder": stiffness, "right_shoulder": stiffness})
    tilting = linear.subsystem("tilt")  # arms that move alike grow faster, and are not excited
    fastest = tilting.roots[np.argmax(tilting.roots.real + 1e-9 * tilting.roots.imag)]
    assert fastest.imag > 0.5
    half_wave = np.pi / fastest.imag / SPIN
    times = half_wave * np.arange(1, 601) / 100
    data = layout(*UNSTABLE, 10, tilt=1e-8, accuracy=1e-13, samples=times).dataset
    size = np.hypot(data["tilt"], data["twist"]).values
    factors = size[400:] / size[300:-100]
    np.testing.assert_allclose(factors, np.exp(np.pi * fastest.real / fastest.imag), rtol=0.02)


def test_deviation_stays_small_in_a_stable_layout() -> None:
    data = layout(*STABLE, 100, tilt=1e-3).dataset
    assert np.abs(data["tilt"]).max() < 5e-3
    assert np.abs(data["twist"]).max() < 2e-2


# --------------------------------------------------------------------------- rigid bodies


@pytest.mark.parametrize("name", ["book", "human_layout", "human_pike", "furrer"])
def test_rigid_flights_are_solutions_of_eulers_equations(name: str) -> None:
    omega = np.array([0.7, 4.0, -1.1])
    begun = Takeoff(0.3, -0.2, 0.9, angular_velocity=omega)
    flight = fly(name, begun, 3.0, samples=31, accuracy=1e-11)
    inertia = flight.system.equations.inertia(flight.start.q)

    def rate(_: float, y: np.ndarray) -> np.ndarray:
        turning = 0.5 * quaternion_product(y[:4], np.concatenate([[0.0], y[4:]]))
        alpha = np.linalg.solve(inertia, -np.cross(y[4:], inertia @ y[4:]))
        return np.concatenate([turning, alpha])

    start = np.concatenate([quaternion_from_angles(0.3, -0.2, 0.9), omega])
    found = solve_ivp(
        rate, (0, 3), start, t_eval=flight.times, method="DOP853", rtol=1e-12, atol=1e-13
    )
    np.testing.assert_allclose(flight.dataset["quaternion"], found.y[:4].T, rtol=0, atol=1e-9)
    np.testing.assert_allclose(flight.dataset["angular_velocity"], found.y[4:].T, rtol=0, atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_symmetric_body_whose_axis_moves(seed: int) -> None:
    """R(t) = exp(h t/I) R₀ exp(e₃ (1 - J/I) ω₃ t): Drake's free body, its spin about any axis."""
    rng = np.random.default_rng(seed)
    across, along = 0.04, 0.02
    inertia = ((across, 0.0, 0.0), (0.0, across, 0.0), (0.0, 0.0, along))
    model = Model("disc", True, (Body("disc", GROUND, 1.3, (0.1, -0.2, 0.3), inertia),))
    omega, attitude = rng.normal(size=3) * 4, unit(rng, 4)
    begun = Takeoff(quaternion=attitude, angular_velocity=omega)
    flight = fly(model, begun, 5.0, samples=26, accuracy=1e-10)
    first = matrix_from_quaternion(attitude)
    h = first @ (np.array([across, across, along]) * omega)
    for t, q in zip(flight.times, flight.dataset["quaternion"].values, strict=True):
        outer = Rotation.from_rotvec(h * t / across).as_matrix()
        inner = Rotation.from_rotvec([0, 0, (1 - along / across) * omega[2] * t]).as_matrix()
        np.testing.assert_allclose(
            matrix_from_quaternion(q), outer @ first @ inner, rtol=0, atol=1e-9
        )


# ----------------------------------------------------------------------------- symmetries


def path_of(flight: Flight) -> np.ndarray:
    data = flight.dataset
    angles = [data[name].values for name in ("somersault", "tilt", "twist")]
    return np.column_stack([*angles, data["joint_angle"].values])


@pytest.mark.parametrize("factor", [0.1, 3.0])
def test_scaling(factor: float) -> None:
    """Faster by c, springs stiffer by c², dampers by c, a time shorter by c: the same path."""

    def flown(c: float) -> np.ndarray:
        joints = {
            name: JointTakeoff(
                "sprung", s * 1.2, rate=0.3 * c, stiffness=20 * c**2, damping=0.5 * c, rest=s
            )
            for name, s in SHOULDERS.items()
        }
        begun = Takeoff(tilt=0.1, twist=0.2, spin=6.0 * c, joints=joints)
        return path_of(fly("furrer", begun, 2.0 / c, samples=41, accuracy=1e-11))

    np.testing.assert_allclose(flown(factor), flown(1.0), rtol=0, atol=1e-8)


def test_time_reversal() -> None:
    there = tumbling()
    q, u = (rows[-1] for rows in there._joints)
    joints = {
        p.joint.name: JointTakeoff.sprung(a, -r, stiffness=p.does.stiffness, rest=p.does.rest)
        for p, a, r in zip(there.start.plans, q, u, strict=True)
    }
    end = there.landing
    begun = Takeoff(
        quaternion=end.quaternion, angular_velocity=-end.angular_velocity, joints=joints
    )
    back = fly("furrer", begun, 3.0)
    state = back.states[-1]
    state[4:7] *= -1
    state[9:] *= -1
    np.testing.assert_allclose(state, there.states[0], rtol=0, atol=1e-8)


def test_velocity_and_gravity_move_only_the_centre_of_mass() -> None:
    begun = Takeoff(tilt=0.1, spin=SPIN, joints=arms(*UNSTABLE))
    v, g = np.array([1.0, -2.0, 3.0]), np.array([0.1, 0.2, -9.81])
    still = fly("furrer", begun, 1.3)
    moving = fly("furrer", replace(begun, velocity=v), 1.3, gravity=g)
    assert np.array_equal(still.states, moving.states)
    t = moving.times[:, None]
    np.testing.assert_allclose(
        moving.dataset["centre_of_mass"], v * t + g * t**2 / 2, rtol=1e-14, atol=1e-15
    )
    assert not np.any(still.dataset["centre_of_mass"])


def test_left_and_right() -> None:
    """Mirrored in the plane of the somersault: tilt, twist and the arms change their sign."""

    def flown(side: int) -> np.ndarray:
        joints = {
            ("left_shoulder", "right_shoulder")[::side][0]: JointTakeoff(
                "sprung", side * 1.1, rate=side * 0.4, stiffness=20.0, rest=side * 1.0
            ),
            ("left_shoulder", "right_shoulder")[::side][1]: JointTakeoff(
                "sprung", side * -0.6, stiffness=25.0, rest=side * -1.3
            ),
        }
        begun = Takeoff(0.3, side * 0.2, side * 0.5, spin=6.0, joints=joints)
        path = path_of(fly("furrer", begun, 3.0))
        return path if side > 0 else path[:, [0, 1, 2, 4, 3]] * [1, -1, -1, -1, -1]

    np.testing.assert_allclose(flown(-1), flown(1), rtol=0, atol=1e-8)


# -------------------------------------------------------------------------- what is counted


@pytest.mark.parametrize("samples", [2, 9, 400])
@pytest.mark.parametrize("spin", [SPIN, -SPIN])
def test_somersaults_are_counted_through_turns(samples: int, spin: float) -> None:
    begun = Takeoff(spin=spin, joints=arms(*STABLE))
    flight = fly("furrer", begun, 8 * TURN, samples=samples)
    assert len(flight.times) == samples
    assert flight.landing.somersault == pytest.approx(np.sign(spin) * 16 * np.pi, abs=1e-8)
    np.testing.assert_allclose(flight.dataset["somersault"], spin * flight.times, rtol=0, atol=1e-8)


@pytest.mark.parametrize("samples", [2, 300, 3000])
def test_turns_are_counted_near_the_singularity(samples: int) -> None:
    """Arms drawn in hasten the twist, and tilt goes by a right angle at a distance of 1.5°:
    well defined, so that it must be counted the same however few samples are kept."""
    joints = {
        name: JointTakeoff("prescribed", times=[0, 0.3], angles=[side * 1.56, 0])
        for name, side in SHOULDERS.items()
    }
    begun = Takeoff(tilt=1.13, angular_velocity=[-0.76, 7.05, 6.67], joints=joints)
    fine = fly("furrer", begun, 3.0, samples=30_000)
    assert 0.005 < np.abs(np.cos(fine.dataset["tilt"].values)).min() < 0.1
    flight = fly("furrer", begun, 3.0, samples=samples)
    assert flight.landing.twist == pytest.approx(fine.landing.twist, abs=1e-6)
    assert flight.landing.somersault == pytest.approx(fine.landing.somersault, abs=1e-6)


def test_the_end_is_the_duration_whatever_is_sampled() -> None:
    """Samples are what is kept; the flight lasts as long as was asked."""
    whole = layout(*STABLE, 2)
    part = layout(*STABLE, 2, samples=[0.1, 0.5])
    assert part.landing.time == pytest.approx(2 * TURN, abs=1e-12)
    assert part.landing.somersault == pytest.approx(whole.landing.somersault, abs=1e-8)


@pytest.mark.parametrize("case", [UNSTABLE, (1.8, 1.3), (0.2, 0.4)])
def test_quarter_twist(case: tuple) -> None:
    """cos Θ cos Ψ is zero, to rounding, whatever samples were asked for; so is h·e2 here."""
    found = [layout(*case, 10, until="quarter twist", samples=n) for n in (2, 30, 1000)]
    for flight in found:
        end = flight.landing
        assert end.ended == "event"
        assert flight.dataset.attrs["ended"] == "event"
        h = flight.system.equations.momentum(flight._joints[0][-1], flight._speeds[-1])[:3]
        assert abs(h[1]) < 1e-11 * np.linalg.norm(h)  # the attitude is exact, h kept to 1e-12
        turned = matrix_from_quaternion(end.quaternion).T @ flight.start.momentum
        assert abs(turned[1]) < 1e-11 * np.linalg.norm(h)
        assert abs(np.cos(end.twist)) < 1e-10
        assert np.all(np.abs(flight.dataset["twist"].values[:-1]) < np.pi / 2)
    ends = [[f.landing.time, f.landing.somersault, f.landing.tilt, f.landing.twist] for f in found]
    np.testing.assert_allclose(ends, ends[:1] * 3, rtol=0, atol=1e-7)


@pytest.mark.parametrize(
    ("case", "lasts"),
    [((1.2, 1.4), None), ((1.0, 1.6), None), ((0.5, 1.3), 2.3), ((1.8, 1.3), 2.7)],
)
def test_lifetimes_of_the_layout(case: tuple, lasts: float | None) -> None:
    """Somersaults before a quarter twist, from a tilt of 0.01 (errata's reference numbers)."""
    begun = Takeoff(tilt=0.01, spin=SPIN, joints=arms(*case))
    flight = fly("furrer", begun, 8.2 * TURN, until="quarter twist")
    if lasts is None:
        assert flight.ended == "duration"
        assert flight.landing.somersault > 16 * np.pi
    else:
        assert flight.ended == "event"
        assert flight.landing.time / TURN == pytest.approx(lasts, abs=0.05)  # nominal turns
