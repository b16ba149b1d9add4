"""Chapter 5's launcher and experiment: what is conserved, ordered and counted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from somersault.flight import JointTakeoff, fly
from somersault.thesis.ch5 import _five_springs as springs_tried
from somersault.thesis.ch5 import _launch_results as launches
from somersault.thesis.ch5 import _launch_scatter as likelihood
from somersault.thesis.ch5 import _launcher as launcher
from somersault.thesis.ch5 import _no_ceiling as no_ceiling
from somersault.thesis.ch5 import _release_and_flight as launches_of_one
from somersault.thesis.ch5 import _shoulder_friction as friction
from somersault.thesis.ch5 import _simulated_launches as experiment
from somersault.thesis.ch5._doll import BEST, WEIGHTED, shoulder_inertia
from somersault.thesis.ch5._launcher import ARMS, BAR_HEIGHT, RELEASE, SPIN, launch
from somersault.thesis.ch5._pulleys import BEST_AT, OMITTED, RADII, SPRINGS, on_pulleys
from somersault.thesis.ch5._simulated_launches import SCATTER, Outcome, Scatter

# ---------------------------------------------------------------------------- launcher


def test_the_swing_reaches_its_rate_and_keeps_its_energy() -> None:
    made = launch()
    data = made.swing.dataset
    assert made.swing.ended == "event"
    assert made.swing.q[-1, 0] == pytest.approx(RELEASE, abs=1e-12)
    assert made.swing.u[-1, 0] == pytest.approx(SPIN, abs=1e-4)
    # Nothing is lost but the trembling of the rods, which are damped.
    assert np.ptp(data["energy"].values) < 1e-6


def test_letting_the_doll_go_changes_nothing() -> None:
    assert launches_of_one.carried(launch()) < 1e-10


def test_it_flies_in_its_plane_as_a_stone_does() -> None:
    made = launch()
    out = made.out
    v = np.array(made.release.takeoff.velocity)
    assert v == pytest.approx(
        SPIN * out * np.array([-np.cos(RELEASE), 0.0, np.sin(RELEASE)]), rel=1e-4, abs=1e-9
    )
    assert made.release.centre[2] == pytest.approx(BAR_HEIGHT - out * np.cos(RELEASE), abs=1e-6)
    flight = fly(made.doll, made.release.takeoff, made.time(), gravity=(0, 0, -9.81), samples=2)
    caught = flight.dataset["centre_of_mass"].values[-1]
    assert caught[2] == pytest.approx(launcher.CATCH, abs=1e-12)
    assert made.path.at([made.time()])[0, 2] == pytest.approx(launcher.CATCH, abs=1e-12)


def test_a_larger_clamp_throws_higher_as_reckoned_by_hand() -> None:
    made = launcher.Launch(0.27)
    fit = launches_of_one._fit(0.27)
    assert made.path.climb == pytest.approx(fit.climb, rel=1e-4)
    assert made.out == pytest.approx(launch().out + 0.05, abs=1e-6)


def test_rods_press_until_the_release_and_not_after() -> None:
    made = launch()
    assert made.rod_torque.min() > 0.04
    # On the rod's side of the shoulder: centrifugal about the bar, weight, and pretension.
    arm = made.doll.bodies[1]
    lever = -arm.com[2]
    out = launcher.REACH + launcher.HEAD - 0.0664
    pushed = arm.mass * SPIN**2 * lever * np.sin(ARMS) * (out + lever * np.cos(ARMS))
    own = (arm.inertia[1][1] - arm.inertia[2][2]) * SPIN**2 * np.sin(ARMS) * np.cos(ARMS)
    weight = arm.mass * 9.81 * lever * np.sin(ARMS) * np.cos(RELEASE)
    wanted = pushed + own + weight - made.pretension
    assert made.rod_torque[-1] == pytest.approx(wanted, rel=2e-3)
    assert launches_of_one._free_load(made, 1.0) == pytest.approx(0.0, abs=1e-4)
    assert launches_of_one._free_load(made, 1.2) == pytest.approx(-0.2 * made.pretension, abs=1e-4)


# -------------------------------------------------------------------------- experiment


def test_springs_are_those_of_pulleys() -> None:
    assert on_pulleys(1.0) == pytest.approx([(r / RADII[0]) ** 2 for r in RADII])
    assert SPRINGS[BEST_AT] == pytest.approx(BEST)
    assert pytest.approx([SPRINGS[-1], OMITTED]) == [BEST * 2.56, BEST * 1.44]
    assert list(SPRINGS) == sorted(SPRINGS)


@pytest.fixture(scope="module")
def few() -> Outcome:
    return experiment.sprung(SPRINGS, SCATTER, 200).with_(experiment.clamped(SCATTER, 200))


def test_the_six_conditions_come_in_the_laboratorys_order(few: Outcome) -> None:
    soft = few.mean[:BEST_AT]
    assert few.mean[BEST_AT] > soft.max() > soft.min() > few.mean[-1]
    assert few.mean[BEST_AT] > few.mean[-2] > few.mean[-1]
    assert few.share.argmax() == BEST_AT
    assert few.deviation.argmin() in (BEST_AT, len(SPRINGS))


def test_clamped_arms_are_never_stable() -> None:
    assert not experiment.clamped(SCATTER, 2000).stable.any()


def test_a_launch_is_the_flight_of_its_draws() -> None:
    """One launch of the ensemble, flown by itself from the numbers it drew."""
    from somersault.ensembles._vary import draws

    vary = SCATTER.vary(True)
    place = np.array([7])
    drawn = {name: float(x[0]) for name, x in draws(vary, "random", 3, place).items()}
    arm = JointTakeoff(
        "sprung", angle=ARMS + drawn["arms"], stiffness=2.1 * SPIN**2 * shoulder_inertia(WEIGHTED),
        pretension=drawn["tension"], hold=True,
    )  # fmt: skip
    nominal = launcher.takeoff({"shoulder": arm})
    takeoff = replace(
        nominal, tilt=drawn["tilted"], twist=drawn["twisted"], tilt_rate=drawn["tilting"],
        twist_rate=drawn["twisting"],
    )  # fmt: skip
    flight = fly(WEIGHTED, takeoff, launch().time(), until="quarter twist", samples=2)
    found = experiment.sprung([2.1], SCATTER, 8, seed=3)
    turns = (flight.landing.somersault - RELEASE) / (2 * np.pi)
    assert found.somersaults[0, 7] == pytest.approx(turns, abs=1e-3)
    assert found.stable[0, 7] == (flight.ended == "duration")


def test_no_scatter_no_failure() -> None:
    calm = Scatter(1e-9, 1e-9, 1e-9, 1e-9)
    found = experiment.sprung([BEST, 1.18], calm, 8)
    assert found.stable.all()
    turns = launch().time() * SPIN / (2 * np.pi)
    assert found.somersaults == pytest.approx(turns, abs=1e-4)


def test_seeds_fix_the_draws() -> None:
    one, other = (experiment.sprung([0.5], SCATTER, 20, seed) for seed in (1, 2))
    again = experiment.sprung([0.5], SCATTER, 20, 1)
    assert np.array_equal(one.somersaults, again.somersaults)
    assert not np.array_equal(one.somersaults, other.somersaults)


def test_twenty_launches_have_draws_of_their_own() -> None:
    found = experiment.twenty()
    assert found.somersaults.shape == (6, 20)
    assert np.array_equal(found.somersaults[0], experiment.twenty().somersaults[0])
    near = experiment.sprung([SPRINGS[1]], SCATTER, 20, experiment.SEED)
    assert not np.allclose(found.somersaults[1], near.somersaults[0])


# ---------------------------------------------------------------------------- likelihood


def test_chances_are_those_of_a_hand_count() -> None:
    """Against ten thousand experiments drawn from the launches themselves."""
    ours = likelihood.chances(experiment.many()).each
    seen = launches.repeated()
    low, high = likelihood.OCCASIONALLY
    soft = (seen["mean"] >= 2) & (seen["stable"] >= low) & (seen["stable"] <= high)
    counted = soft.mean(0)
    counted[BEST_AT] = (seen["stable"][:, BEST_AT] == 18).mean()
    counted[-2] = (seen["stable"][:, -2] == 0).mean()
    about = np.abs(seen["mean"][:, -1] - 1) <= 0.25
    counted[-1] = (about & (seen["stable"][:, -1] == 0)).mean()
    assert ours == pytest.approx(counted, abs=0.06)


def test_a_scatter_too_large_or_too_small_is_refused() -> None:
    def together(scatter: Scatter) -> float:
        found = experiment.sprung(SPRINGS, scatter, 256)
        return likelihood.chances(found.with_(experiment.clamped(scatter, 256))).together

    right = together(SCATTER)
    assert right > 0.02
    for off in (0.3, 3.0):
        wrong = Scatter(
            off * SCATTER.attitude, off * SCATTER.rates, off * SCATTER.arms,
            off * SCATTER.pretension,
        )  # fmt: skip
        assert together(wrong) < 0.1 * right


def test_intervals_are_clopper_and_pearsons() -> None:
    stable = np.zeros((1, 20), bool)
    stable[0, :18] = True
    span = launches.intervals(Outcome(np.zeros((1, 20)), stable))
    assert float(span["low"][0]) == pytest.approx(0.6830, abs=1e-4)
    assert float(span["high"][0]) == pytest.approx(0.9877, abs=1e-4)
    assert experiment.at_least(np.array(0.9), 18) == pytest.approx(0.6769, abs=1e-4)


# ------------------------------------------------------------------------------- entries


def test_friction_makes_every_spin_grow() -> None:
    rates = friction.growth()
    assert rates[:, 0] == pytest.approx(0.0, abs=1e-9)
    assert np.all(np.diff(rates, axis=1) > 0)


def test_the_two_to_one_resonance_is_between_the_modes() -> None:
    import somersault as so

    at = no_ceiling.resonance()
    system = so.spin(WEIGHTED, 2, {"shoulder": ARMS}).linear(stiffness={"shoulder": at})
    modes = [(m.name, m.root.imag) for m in system.modes if m.root.imag > 1e-3]
    slow = min(f for name, f in modes if name.startswith("antisymmetric"))
    both = next(f for name, f in modes if name.startswith("symmetric"))
    assert both == pytest.approx(2 * slow, rel=2e-3)


@pytest.mark.slow
def test_entries_say_why_claims_fail() -> None:
    made = (
        launches_of_one.sec_5_4, launches.fig_5_7, launches.fig_5_8, likelihood.launch_scatter,
        springs_tried.five_springs, no_ceiling.no_ceiling, friction.shoulder_friction,
    )  # fmt: skip
    results = [make() for make in made]
    claims = [claim for result in results for claim in result.claims]
    assert len({claim.id for claim in claims}) == len(claims) > 40
    assert {claim.id for claim in claims if not claim.holds} == {
        "fig5-7.variance-softest",
        "ch5-ceiling.best",
        "ch5-ceiling.resonance",
    }
    assert all(claim.note for claim in claims if not claim.holds)
    assert all(result.figure is not None for result in results)
