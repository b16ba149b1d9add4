"""Small deviations fly as the linear equations say: two derivations of one motion."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation
from trees import random_tree

import somersault as so

SMALL = 1e-6
RATE = 5.0


def predicted(system: so.LinearSpin, start: dict[str, float], angle: float) -> dict[str, float]:
    """Linear deviations after the spin has turned by `angle`, joints starting at rest.

    The attitude rates at the start are those that keep the angular momentum: with A, B the
    attitude and joint columns of M and h = M_a ẋ + P x of the spin, zero.
    """
    n = len(system.M)
    c, k = system.G + system.D, system.K + system.K_springs
    inverse = np.linalg.inv(system.M)
    flow = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ k, -inverse @ c]])
    x = np.array([start.get(name, 0.0) for name in system.coordinates])
    before, about, after = turns = system.attitude.places()
    held = np.array([-k[after] @ x, system.G[about] @ x, k[before] @ x])
    rates = np.zeros(n)
    rates[turns] = -np.linalg.solve(system.M[np.ix_(turns, turns)], held)
    end = expm(flow * angle) @ np.concatenate([x, rates])
    return dict(zip(system.coordinates, end[:n], strict=True))


def flown(spin: so.Spin, flight: so.Flight) -> np.ndarray:
    """Turns about the principal axes nearest 1, 2, 3 from the steady attitude, at the end."""
    end = flight.landing
    axis = spin.principal_axes[:, spin.axis - 1]
    first = flight.start.quaternion

    def turned(quaternion: np.ndarray) -> Rotation:
        return Rotation.from_quat(quaternion, scalar_first=True)

    undeviated = turned(first) * turned(deviation(spin)).inv()
    steady = undeviated * Rotation.from_rotvec(axis * RATE * end.time)
    return spin.principal_axes.T @ (steady.inv() * turned(end.quaternion)).as_rotvec()


def deviation(spin: so.Spin) -> np.ndarray:
    """The turn that every test here starts with."""
    turn = spin.principal_axes @ (SMALL * np.array([2.0, 0.0, 1.0]))
    return Rotation.from_rotvec(turn).as_quat(scalar_first=True)


@pytest.mark.parametrize(("k", "b"), [(0.5, 0.0), (1.2, 0.0), (1.2, 0.3)])
def test_layout(k: float, b: float) -> None:
    spin = so.spin("furrer", pose={"shoulder": 1.3})
    system = spin.linear({"shoulder": k}, {"shoulder": b})
    start = {"tilt": 2 * SMALL, "twist": SMALL, "antisymmetric shoulder": 3 * SMALL}
    moved = {"left_shoulder": 3 * SMALL, "right_shoulder": 3 * SMALL}
    flight = so.deviated_flight(
        spin, RATE, 1.5, tilt=2 * SMALL, twist=SMALL, joints=moved,
        stiffness={"shoulder": k}, damping={"shoulder": b},
    )  # fmt: skip
    wanted = predicted(system, start, RATE * 1.5)
    end = flight.landing
    largest = max(abs(x) for x in wanted.values())
    assert end.tilt == pytest.approx(wanted["tilt"], abs=1e-4 * largest)
    assert end.twist == pytest.approx(wanted["twist"], abs=1e-4 * largest)
    arms = (end.joints["left_shoulder"] + end.joints["right_shoulder"]) / 2
    assert arms == pytest.approx(wanted["antisymmetric shoulder"], abs=1e-4 * largest)


@pytest.mark.parametrize("axis", [1, 2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_random_trees(seed: int, axis: int) -> None:
    rng = np.random.default_rng(seed)
    model = random_tree(rng, bodies=3, free=True, kinds=("hinge", "slide"))
    spin = so.spin(model, axis)
    stiffness = {joint.name: 2.0 for joint in model.joints}
    damping = {joint.name: 0.2 for joint in model.joints}
    system = spin.linear(stiffness, damping)
    flight = so.deviated_flight(
        spin, RATE, 0.4, tilt=2 * SMALL, twist=SMALL, stiffness=stiffness, damping=damping,
        accuracy=1e-12,
    )  # fmt: skip
    names = {1: "tilt", 2: "somersault", 3: "twist"}
    start = {"tilt": 2 * SMALL, "twist": SMALL}
    wanted = predicted(system, start, RATE * 0.4)
    found = flown(spin, flight)
    largest = max(abs(x) for x in wanted.values())
    for number, name in names.items():
        assert found[number - 1] == pytest.approx(wanted[name], abs=2e-4 * largest)
    for joint in model.joints:
        moved = flight.landing.joints[joint.name] - joint.reference
        assert moved == pytest.approx(wanted[joint.name], abs=2e-4 * largest)


def test_an_undeviated_spin_stays() -> None:
    spin = so.spin("furrer", pose={"left_shoulder": 0.7, "right_shoulder": -2.1})
    flight = so.deviated_flight(spin, 8.0, 1.0, stiffness={"shoulder": 1.0})
    for name, angle in (("left_shoulder", 0.7), ("right_shoulder", -2.1)):
        assert flight.landing.joints[name] == pytest.approx(angle, abs=1e-9)
    np.testing.assert_allclose(flown_rate(flight), 8.0, rtol=1e-9)


def test_a_ball_that_has_to_be_held_is_refused(tmp_path) -> None:
    """An arm stands up and the other down: the ball of the head is not at rest by itself."""
    arm = (
        '<body name="{0}_arm" pos="0 {1} 0.45"><joint name="{0}" axis="1 0 0"/>'
        '<inertial pos="0 0 -0.35" mass="{2}" diaginertia="0.12 0.12 0.01"/></body>'
    )
    file = tmp_path / "ball.xml"
    file.write_text(
        '<mujoco><compiler angle="radian"/><worldbody><body name="trunk"><freejoint/>'
        '<inertial pos="0.03 0 0" mass="50" diaginertia="8.0 7.6 0.9"/>'
        + arm.format("left", 0.2, 4) + arm.format("right", -0.2, 3.3)
        + '<body name="head" pos="0 0 0.3"><joint name="neck" type="ball"/>'
        '<inertial pos="0 0 0.1" mass="6" diaginertia="0.05 0.05 0.05"/></body>'
        "</body></worldbody></mujoco>"
    )  # fmt: skip
    spin = so.spin(str(file), pose={"left": 1.3, "right": -1.3})
    springs = {"left": 1.0, "right": 1.0, "neck": 6.0}
    with pytest.raises(so.SomersaultError, match="ball neck has to be held"):
        so.deviated_flight(spin, RATE, 1.0, stiffness=springs)
    so.deviated_flight(spin, RATE, 0.1, stiffness=springs, lock=["neck"])


def flown_rate(flight: so.Flight) -> float:
    return float(np.linalg.norm(flight.landing.angular_velocity))


def test_a_picture_can_be_drawn(tmp_path) -> None:
    spin = so.spin("furrer", pose={"shoulder": 1.3})
    flight = so.deviated_flight(spin, 8.64, 1.0, tilt=0.01, stiffness={"shoulder": 1.2})
    picture = flight.plot()
    assert [ax.get_ylabel() for ax in picture.axes] == [
        "somersaults",
        "tilt, twist (rad)",
        "joints (rad, m)",
    ]
    picture.savefig(tmp_path / "flight.png")
