"""Delayed feedback, against Lambert's W, the method of steps, and inverted pendulums."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import lambertw

import somersault as so
from somersault.stability import DelayedFeedback, feedback

SOMERSAULT = 2 * np.pi


def scalar(a: float, b: float) -> DelayedFeedback:
    return DelayedFeedback(np.array([[a]]), np.ones(1), np.array([b]))


@pytest.mark.parametrize(
    ("a", "b", "delay"), [(-1.0, 0.5, 0.7), (0.3, -1.2, 0.4), (0.0, -2.0, 2.0)]
)
def test_roots_of_one_number_are_lamberts(a: float, b: float, delay: float) -> None:
    """s = a + W_k(b τ exp(−a τ)) / τ on the branches k."""
    found = scalar(a, b).roots(delay, 7)
    branches = np.array([lambertw(b * delay * np.exp(-a * delay), k) for k in range(-5, 5)])
    expected = a + branches / delay
    for root in found:
        assert np.abs(expected - root).min() < 1e-12 * (1 + abs(root))
    greatest = np.sort(expected.real)[::-1][: len(found)]
    np.testing.assert_allclose(np.sort(found.real)[::-1], greatest, atol=1e-10)


def test_a_pendulum_upside_down() -> None:
    """ẍ − σ² x = −(k x + c ẋ)(t − τ) is stable for some gains where τ < √2 / σ, and for none beyond
    (Stépán, Retarded Dynamical Systems, 1989)."""
    sigma = 0.8
    matrix, drive = np.array([[0.0, 1.0], [sigma**2, 0.0]]), np.array([0.0, 1.0])
    best = 0.0
    for k in np.linspace(1.0001, 1.5, 30) * sigma**2:
        for c in np.linspace(0.2, 3.0, 60) * sigma:
            ranges = DelayedFeedback(matrix, drive, -np.array([k, c])).stable_delays()
            best = max([best, *(end for _, end in ranges)])
    assert 0.95 * np.sqrt(2) / sigma < best < np.sqrt(2) / sigma


def random_loop(seed: int) -> DelayedFeedback:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 6))
    matrix = rng.normal(size=(n, n)) - 1.5 * np.eye(n)
    return DelayedFeedback(matrix, rng.normal(size=n), rng.normal(size=n))


@pytest.mark.parametrize("seed", range(20))
def test_ranges_are_where_the_greatest_root_decays(seed: int) -> None:
    """Two ways to the same thing: crossings of the axis, and all the roots."""
    loop = random_loop(seed)
    ranges = loop.stable_delays(4.0)
    for delay in np.linspace(0.013, 3.97, 9):
        inside = any(a < delay < b for a, b in ranges)
        edge = min([abs(delay - e) for r in ranges for e in r] + [9.0])
        if edge > 1e-3:
            assert inside == (loop.growth_rate(delay) < 0)


@pytest.mark.parametrize("seed", [1, 5, 8])
def test_the_greatest_root_is_how_the_method_of_steps_grows(seed: int) -> None:
    """Integrated from delay to delay by SciPy, with a constant past."""
    loop, delay = random_loop(seed), 0.9
    first = loop.roots(delay, 8)
    y, past = np.ones(len(loop.matrix)), [lambda t: np.ones(len(loop.matrix))]
    values, times = [], []
    for k in range(20):
        late = past[-1]

        def slope(t, y, late=late):
            return loop.matrix @ y + loop.drive * (loop.sensed @ late(t - delay))

        span = (k * delay, (k + 1) * delay)
        part = solve_ivp(
            slope, span, y, rtol=1e-11, atol=1e-300, dense_output=True, method="DOP853"
        )
        y = part.y[:, -1]
        past.append(part.sol)
        times.append(np.linspace(*span, 50, endpoint=False))
        values.append(part.sol(times[-1])[0])
    time, value = np.concatenate(times)[500:1000], np.concatenate(values)[500:1000]
    since = time - time[0]
    basis = np.exp(np.outer(since, first - first[0].real))
    columns = np.concatenate([basis.real, basis.imag], 1)
    level = value * np.exp(-since * first[0].real)
    left = level - columns @ np.linalg.lstsq(columns, level, rcond=None)[0]
    assert np.abs(left).max() < 1e-5 * np.abs(level).max()


def layout() -> so.stability.LinearSpin:
    return so.spin("furrer", pose={"shoulder": 1.3}).linear()


def loop(**gains: float) -> DelayedFeedback:
    return feedback(layout(), "antisymmetric shoulder", "rate", gains)


def test_arms_in_a_layout_are_a_pendulum_upside_down() -> None:
    """With arms that move at a rate by twist and twist rate, −(k x + c ẋ) of the rigid body's
    own growth σ."""
    p, q = loop(twist=1.0).polynomials
    rigid = so.spin("furrer", pose={"shoulder": 1.3}).linear(lock="all").growth_rate
    np.testing.assert_allclose(p, [1.0, 0.0, -(rigid**2)], atol=1e-12)
    limit = -(rigid**2) / q[-1]  # the gain at which a root is 0
    assert limit == pytest.approx(-0.711, abs=5e-4)
    assert loop(twist=0.999 * limit, twist_rate=-1.0).stable_delays() == ()
    assert loop(twist=1.001 * limit, twist_rate=-1.0).stable_delays() != ()
    assert loop(twist=1.5 * limit).stable_delays() == ()  # by the twist alone


@pytest.mark.parametrize("within", [True, False])
def test_flights_move_as_the_roots_say(within: bool) -> None:
    """Sampled often, a small twist is the sum of the slowest motions, with the delay and the tick
    in which the arms come to their rate."""
    gains, rate, often = {"twist": -0.8, "twist_rate": -1.3}, 8.0, 160
    longest = loop(**gains).stable_delays()[0][1]
    every, ticks = longest / rate / often, (3 if within else 5) * often // 4
    law = so.JointTakeoff.rate_law(
        angle=1.3, law="k * twist + c * twist_rate", every=every, delay=every * ticks,
        gains={"k": -0.8 * rate, "c": -1.3},
    )  # fmt: skip
    momentum = so.spin("furrer", pose={"shoulder": 1.3}).principal_inertias[1] * rate
    takeoff = so.Takeoff(
        joints={"shoulder": law}, angular_momentum=[0.0, momentum, 0.0], twist=1e-6
    )
    flight = so.fly("furrer", takeoff, 3.0, accuracy=1e-11, samples=301)
    roots = loop(**gains).roots(every * (ticks + 1) * rate, 6) * rate
    since, twist = flight.times[50:], flight.angles[50:, 2]
    basis = np.exp(np.outer(since - 0.5, roots - roots[0].real))
    columns = np.concatenate([basis.real, basis.imag], 1)
    level = twist * np.exp(-(since - 0.5) * roots[0].real)
    left = level - columns @ np.linalg.lstsq(columns, level, rcond=None)[0]
    assert np.abs(left).max() < 0.02 * np.abs(level).max()
    assert (roots[0].real < 0) == within == (np.abs(twist[-80:]).max() < np.abs(twist[:80]).max())


def test_torques_hold_as_springs_do() -> None:
    """Without a delay a torque −k of the arms' own angle is a spring of that stiffness."""
    stiff = 1.2
    bare = layout()
    arm = bare.coordinates.index("antisymmetric shoulder")
    sprung = so.spin("furrer", pose={"shoulder": 1.3}).linear({"shoulder": stiff})
    gain = sprung.K_springs[arm, arm] / 2  # of each arm
    held = feedback(
        bare, "antisymmetric shoulder", "torque", {"antisymmetric shoulder": -gain}
    ).roots(0.0)
    expected = sprung.system.parts("twist")[0].roots()
    for root in held:
        assert np.abs(expected - root).min() < 1e-7


MISTAKES = {
    "no joint": (("twist", "rate", {"twist": 1.0}), "no joint motion"),
    "no coordinate": (("elbow", "rate", {"twist": 1.0}), "no coordinate"),
    "nothing sensed of that name": (
        ("antisymmetric shoulder", "rate", {"somersault": 1.0}), "no coordinate",
    ),
    "another command": (("antisymmetric shoulder", "power", {"twist": 1.0}), "commands"),
    "no number": (("antisymmetric shoulder", "rate", {"twist": "much"}), "gains.twist"),
}  # fmt: skip


@pytest.mark.parametrize("what", MISTAKES)
def test_mistakes_are_refused_in_a_sentence(what: str) -> None:
    arguments, words = MISTAKES[what]
    with pytest.raises(so.SomersaultError, match=words):
        feedback(layout(), *arguments)
